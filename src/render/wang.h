/* `tiling wang`: cyclic texels laid so that no period shows and nothing is cut.
 *
 * Wang tiles (Cohen, Shade, Hiller & Deussen 2003; of volumes Decaudin & Neyret 2004) are square pieces whose edges have colours; where
 * tiles meet, colours agree. What must agree is what crosses the edge. So the things in a texel are sorted by what they cross: those within
 * the tile, those that cross its border along x, those that cross it along z, and those at its corners. Each of the four sorts is a texel
 * of its own, on the grid of tiles moved by half a tile so that it holds its things whole. Which member of the family it is taken from, and how it is turned,
 * a hash tells for each place of each grid: the colours of edges and corners are those choices, and any four of them fit. */
#ifndef VTS_RENDER_WANG_H
#define VTS_RENDER_WANG_H

#include "scene/scene.h"

/* Bit 0: the grid is moved by half a tile along x; bit 1: along z. */
enum { WANG_GRIDS = 4 };

typedef struct WangParts {
    const TexelDef *whole[WANG_GRIDS]; /* NULL: nothing lies so */
    const TexelDef *rest;              /* cyclic as it was, of what fits none, as it is too large; NULL: nothing */
} WangParts;

/* Sorts the contents of a texel that is cyclic along x or z. Unions, particles and meshes that are too large are taken apart: into their
 * objects, particles, and pieces that hang together; L-systems are not. Things of different layers that lie on one another stay together.
 * Densities and texels from files are all rest. The parts come from the arena. */
WangParts wang_split(const TexelDef *def, Arena *arena);

/* Which members of a family fit beside each other where their rests cross the border, as classes: along x those of one class_x, along z
 * those of one class_z. */
typedef struct WangBorders {
    const uint32_t *class_x, *class_z; /* of each member */
} WangBorders;

/* A part of a mesh or of particles by itself: which ones, in ascending order. wang_pieces.c */
typedef struct WangPieces {
    const Object *object;
    size_t count;      /* of pieces */
    size_t unit_count; /* of particles or triangles */
    const uint32_t *piece; /* of each unit: 0 … count − 1 */
    const Box3 *bounds;    /* of each piece, in the object's parent's space */
} WangPieces;
/* False for what has no loose parts. */
bool wang_pieces_of(const Object *object, Arena *arena, WangPieces *out);
/* The object with some of its units alone. */
const Object *wang_pieces_pick(const WangPieces *pieces, const uint32_t *units, size_t count, Arena *arena);

#endif
