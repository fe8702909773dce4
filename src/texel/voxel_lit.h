/* What voxels by themselves make of the light on what is seen, and by how much they are wrong.
 *
 * Between a place that is seen and the light, voxels know how much matter there is on the mean; of the places in a voxel it is those that the eye
 * sees. At each coarse level the light on them is taken to a power, for pairs of directions to the eye and to the light, such that its mean over all
 * that is seen is what the triangles say (voxel_pairs.h); where eye and light are nearly one, what is missing of the peak there is added. Likewise the normals that voxels know are those of all matter that faces the eye, of which other
 * matter hides some, not all alike: of a bough the eye sees the upper side and the tips. What light makes of either side of them gets a factor. */
#ifndef VTS_TEXEL_VOXEL_LIT_H
#define VTS_TEXEL_VOXEL_LIT_H

#include "texel/voxel_pairs.h"

/* What the triangles of all layers say. */
typedef struct LitTruth {
    const PairView *views; /* PAIR_NODES, of which voxel_layer_pair() has made pairs.lit */
    int grid;
    const PairShade *shades; /* what voxel_layer_pair() told */
    const PairBeside *beside;
    size_t triangles;
} LitTruth;

/* Layers that stand among each other, of one size and resolution. */
typedef struct LitLayers {
    const VoxelLayer *const *layers;
    size_t count;
    Vec3f extent;
} LitLayers;

/* Sets the powers and factors of layer->pairs for the `levels` coarsest levels, by what the voxels of all layers hide. They are trimmed, and the pairs of `layer` are known.
 * False if the pool was cancelled. */
bool voxel_layer_find_powers(VoxelLayer *layer, const LitTruth *truth, const LitLayers *among, int levels, Pool *pool);
/* All 1. */
void voxel_layer_forget_powers(VoxelLayer *layer);

/* Directions of texel space, of any length, to the eye and to the light: which share of a light comes to matter that is seen, if voxels of the level `lod`,
 * which may be coarser than the coarsest, make it `share`; and to the ground that is seen under the layer, if they let `through` come there. */
float voxel_layer_light_on_matter(const VoxelLayer *layer, float lod, Vec3f to_eye, Vec3f to_light, float share);
float voxel_layer_light_on_ground(const VoxelLayer *layer, float lod, Vec3f to_eye, Vec3f to_light, float through);
/* How much more or less than by the normals of the voxels the light makes of matter that is seen with voxels of the level `lod`: on the side towards the
 * eye, and on the other. > 0. */
void voxel_layer_facing(const VoxelLayer *layer, float lod, Vec3f to_eye, Vec3f to_light, float factor[2]);

#endif
