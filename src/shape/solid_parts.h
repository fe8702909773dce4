/* What some solids prepared for rays, for those who need their surfaces as such. `data` is what SolidOps.prepare gave. */
#ifndef VTS_SHAPE_SOLID_PARTS_H
#define VTS_SHAPE_SOLID_PARTS_H

#include "scene/scene.h"
#include "shape/outline.h"
#include "shape/soup.h"

/* sor: the radius squared at a share (0 … 1) of the height of a piece, and its slope; false when there is no such piece. */
typedef struct SorPlace {
    double y, square, slope;
} SorPlace;
bool solid_sor_at(const void *data, size_t piece, double share, SorPlace *out);

/* polygon: its outline in the plane origin + a·x + b·y. */
typedef struct PlanarOutline {
    const Outline *outline;
    Vec3 origin, a, b;
} PlanarOutline;
PlanarOutline solid_polygon_outline(const void *data);
/* text: a letter in the plane z = 0; false when there is none of that number. */
bool solid_text_letter(const void *data, size_t index, PlanarOutline *out, double *thickness);

/* bicubic_patch, parametric: a place (u and v from 0 to 1 over all of it) and its unit normal, or zero. */
void solid_sheet_at(const void *data, double u, double v, Vec3 *p, Vec3 *normal);

/* blob: the strongest parts at a place of its surface, at most `most`, with shares that add up to 1, and how many. Those without a texture
 * are one, with `part` -1, which comes last. */
typedef struct BlobShare {
    int part;
    double weight;
} BlobShare;
size_t solid_blob_shares(const Solid *solid, Vec3 p, BlobShare *out, size_t most);

/* mesh: u and v where a triangle is met, by the shares of its second and third corner; zero without uv_vectors. */
TexCoord solid_mesh_uv(const MeshData *mesh, uint32_t triangle, double u, double v);

/* height_field: heights over the unit square of x and z, row after row from z = 0 on. */
typedef struct HeightGrid {
    const float *heights;
    uint32_t columns, rows;
    double water_level; /* what is lower is not there */
    bool smooth;
} HeightGrid;
HeightGrid solid_height_grid(const void *data);
Vec3 solid_height_normal(const void *data, uint32_t column, uint32_t row);

#endif
