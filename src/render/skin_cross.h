/* Where a ray crosses the walls, foot and top of a cell of a skin. */
#ifndef VTS_RENDER_SKIN_CROSS_H
#define VTS_RENDER_SKIN_CROSS_H

#include "render/skin.h"

/* Faces 0 … 3 stand over the edges as surface_mesh.h numbers them. */
enum { FACE_FOOT = 4, FACE_TOP = 5 };
enum { MOST_CROSSINGS = 16 }; /* two on each bilinear face, with some to spare for the seams of neighbouring faces */

typedef struct SkinCrossing {
    double t;
    double a, b, w;
    int face;
    double outward; /* cosine-like: what the ray's direction has along the face's normal, outward where the cell's det J > 0 */
} SkinCrossing;

/* All crossings with t in (t_min, t_max), ascending; faces reach a ten-millionth beyond their edges, so that no ray slips between
 * two. What lies within a face crosses it nowhere. Returns their number. */
int skin_cell_cross(const SkinCell *cell, const Ray *ray, double t_min, double t_max, SkinCrossing *out);

#endif
