/* What is seen of a layer's triangles along a direction: of each place of a grid, the height of what is met first from above. */
#ifndef VTS_TEXEL_VOXEL_VIEW_H
#define VTS_TEXEL_VOXEL_VIEW_H

#include "texel/texel.h"

/* Places each way; a power of two. */
enum { VIEW_GRID = 128, VIEW_PLACES = VIEW_GRID * VIEW_GRID };

/* The layer seen along a direction d (d.y > 0), on the plane y = 0: from `origin`, `size` wide; a period of what is cyclic. Axes: x, z. */
typedef struct LayerView {
    Vec3f d, extent;
    float slope_x, slope_z; /* d / d.y */
    float origin[2], size[2];
    bool cyclic[2];
    float turned[2]; /* how far the least of the mesh lies away from the extent along cyclic axes, in whole turns */
    bool contained;  /* nothing of the mesh lies beyond the extent, but along cyclic axes */
    float shift[2];  /* of a place's middle, in places */
} LayerView;

/* Of unit length are 127; to which side is all the same. */
typedef struct ViewNormal {
    int8_t x, y, z;
    bool solid; /* a wall of a closed solid */
} ViewNormal;

/* The share of the view that the triangles hide; < 0 where that is not known: no memory, or triangles that are so large that no texel has them.
 * top[VIEW_PLACES], x first, gets the heights, below 0 where nothing is, and `normal`, if it is not NULL, of what is there the normals. Each triangle's vertices are within the mesh. */
double layer_view_hidden(const LayerView *view, const TexelMesh *mesh, float *top, ViewNormal *normal);

#endif
