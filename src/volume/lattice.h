/* Densities that rays go through: numbers at the middles of cells, trilinear between them, and beyond the outermost middles as those are. */
#ifndef VTS_VOLUME_LATTICE_H
#define VTS_VOLUME_LATTICE_H

#include "base/arena.h"
#include "base/vec.h"

/* A place is told in cells: number i of an axis lies at i + 1, and the whole reaches from 1/2 to size + 1/2. */
typedef struct Lattice {
    int size[3];         /* cells of the density */
    int nodes[3];        /* size + 2: one more to both sides, as the outermost */
    float *values;       /* x fastest */
    int blocks[3];
    float *block_most;   /* the largest number that is met within each block of cells between nodes */
    float most;
} Lattice;

/* Zeroed numbers; set those of cells with lattice_set(), then call lattice_finish(). */
void lattice_init(Lattice *lattice, const int size[3], Arena *arena);
void lattice_set(Lattice *lattice, int x, int y, int z, float value);
/* Carries the outermost numbers outwards, and finds what is empty. */
void lattice_finish(Lattice *lattice);

/* The number at a place, which is moved to the rim when it lies outside. */
double lattice_value(const Lattice *lattice, Vec3 place);
/* A lattice over the same place with at most as many cells along each axis: means over those of `from`. */
void lattice_coarsen(Lattice *lattice, const Lattice *from, const int size[3], Arena *arena);
/* The same with no number above `most`. */
void lattice_clamp(Lattice *lattice, const Lattice *from, float most, Arena *arena);
/* The mean over all cells. */
double lattice_mean(const Lattice *lattice);

/* A ray through the lattice, cell by cell. */
typedef struct LatticeWalk {
    const Lattice *lattice;
    Ray ray;          /* in cells, any length of direction */
    double t, t_end;
    int cell[3];      /* between nodes cell and cell + 1 */
    int step[3];
    double next[3], width[3]; /* t of the next wall of each axis; between walls */
} LatticeWalk;

/* A piece of the ray within one cell, where something is. */
typedef struct LatticePiece {
    double t0, t1;
    double length;    /* the integral of density over t */
    int cell[3];
} LatticePiece;

/* From t0 to t1, both within the lattice but for rounding. */
void lattice_walk_begin(LatticeWalk *walk, const Lattice *lattice, const Ray *ray, double t0, double t1);
/* The next piece that is not empty; false at the end. The integral is exact: along a ray the density within a cell is a cubic, which
 * Gauss' and Legendre's rule of two points integrates as it is. */
bool lattice_walk_next(LatticeWalk *walk, LatticePiece *piece);
/* Where within a piece the integral from its beginning reaches `length`, between 0 and piece->length. */
double lattice_piece_invert(const LatticeWalk *walk, const LatticePiece *piece, double length);

#endif
