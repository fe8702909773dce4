/* Cells whose mapping is not one to one: telling them apart for certain, finding every place of a point in them, and the pieces of a
 * ray that pass through them, sheet by sheet. */
#ifndef VTS_RENDER_SKIN_FOLD_H
#define VTS_RENDER_SKIN_FOLD_H

#include "render/skin.h"

/* How det J behaves over the cell up to the height w_most. Bernstein's coefficients of det J decide where they are of one sign, the
 * corners where they are not; between the two the cell is subdivided, and counts as folded when that has not decided. */
CellSide skin_cell_side(const SkinCell *cell, double w_most);
/* The largest share of its height, found to a thousandth, up to which the cell does not fold; at most `most`. */
double skin_cell_unfolded_height(const SkinCell *cell, double most);

/* All places in the cell (with a hair's margin) that the mapping takes to `world`: for prisms by the cubic in w whose zeros are the
 * heights at which the triangle's plane passes the point; for hexahedra by subdivision until each part is one to one. */
enum { MOST_PREIMAGES = 8 };
int skin_cell_preimages(const SkinCell *cell, Vec3 world, double tolerance, SkinPoint out[MOST_PREIMAGES]);

/* Where the ray runs through the cell, one to one: `middle` is its place half way between t0 and t1. In a folded cell pieces of several
 * sheets overlap. */
typedef struct SkinPiece {
    double t0, t1;
    SkinPoint middle;
} SkinPiece;
enum { MOST_PIECES = 160 };
/* Of cell `number`, in no order; returns how many. What touches a fold in less than a sixty-fourth of the cell may be left out. */
int skin_cell_pieces(const SkinCell *cell, int32_t number, const Ray *ray, double t_min, double t_max, SkinPiece out[MOST_PIECES]);
/* The first `most` to begin, of all cells of a skin, in the order of t0; returns how many there are. */
int skin_first_pieces(const CompiledSkin *skin, const Ray *ray, double t_min, double t_max, SkinPiece *out, int most);

#endif
