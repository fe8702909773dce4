/* What voxels by themselves make of the light on what is seen, and by how much they are wrong.
 *
 * Between a place that is seen and the light, voxels know how much matter there is on the mean; of the places in a voxel it is those that the eye
 * sees. At each coarse level the light on them is taken to a power, for pairs of directions to the eye and to the light, such that its mean over all
 * that is seen is what the triangles say (voxel_pairs.h). */
#ifndef VTS_TEXEL_VOXEL_LIT_H
#define VTS_TEXEL_VOXEL_LIT_H

#include "texel/voxel_pairs.h"

/* What the triangles of a layer say. */
typedef struct LitTruth {
    const PairView *views; /* PAIR_NODES, of which voxel_layer_pair() has made pairs.lit */
    int grid;
    float lit_beside;      /* pair_lit_beside() */
    float open_beside;     /* pair_open_beside() */
    size_t triangles;
} LitTruth;

/* Sets the powers of layer->pairs for the `levels` coarsest levels. The layer is trimmed, and its pairs are known. False if the pool was cancelled. */
bool voxel_layer_find_powers(VoxelLayer *layer, const LitTruth *truth, Vec3f extent, int levels, Pool *pool);
/* 1 throughout. */
void voxel_layer_forget_powers(VoxelLayer *layer);

/* Directions of texel space, of any length, to the eye and to the light: the powers for light on matter, found with voxels of the level `lod`, and for
 * that on the ground under the layer. > 0. */
float voxel_layer_matter_power(const VoxelLayer *layer, float lod, Vec3f to_eye, Vec3f to_light);
float voxel_layer_ground_power(const VoxelLayer *layer, float lod, Vec3f to_eye, Vec3f to_light);

#endif
