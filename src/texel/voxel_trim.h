/* Trimming coarse levels: how much their optical depth has to be multiplied by to hide as much as the triangles do.
 *
 * A voxel knows the area in it, how that is turned, and by gamma how it lies along the three axes. What it cannot know is how matter of
 * one voxel stands before that of the next, nor how it thins out within the voxel: blades that are broad at the foot hide more of a
 * horizontal ray's neighbours than of a steep one. So the whole layer is looked through once, along some directions, and each
 * coarse level gets, for each, the factor by which its voxels hide on the whole what the triangles hide. */
#ifndef VTS_TEXEL_VOXEL_TRIM_H
#define VTS_TEXEL_VOXEL_TRIM_H

#include "texel/texel.h"

/* Factors are held within these. */
#define TRIM_LEAST 0.015625f
#define TRIM_MOST  2.0f

/* Sets layer->trim, of OPACITY_CORRELATED, from the triangles. 1 throughout where there is nothing to compare: cyclic along y, more triangles
 * than are worth it, or out of all proportion, no memory. `views` gets what the triangles show. The same for any number of threads. */
typedef struct LayerViews LayerViews; /* layer_views.h */
void voxel_layer_trim(VoxelLayer *layer, const TexelMesh *mesh, Vec3f extent, LayerViews *views, Pool *pool);
/* All layers of a texel, or the one it has, each trimmed, and what its triangles showed then: multiplies their factors so that together they hide what
 * the triangles of all hide, and sets what eye and light have in common (voxel_pairs.h) in the layer of most voxels. Nothing where some of it is not
 * known. The views are used up. */
void voxel_layers_join(VoxelLayer *const *layers, LayerViews *const *views, size_t count, Vec3f extent, Pool *pool);
/* Whether any factor is not 1. */
bool voxel_layer_is_trimmed(const VoxelLayer *layer);
/* 1 throughout. */
void voxel_layer_forget_trim(VoxelLayer *layer);

/* The factor on the depth of a step between the levels around `lod`. `step` need not be of unit length. */
float voxel_layer_trim_at(const VoxelLayer *layer, float lod, Vec3f step);

#endif
