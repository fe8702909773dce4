/* From what the scene says is in a texel to triangles in texel space, which the voxels are built from. */
#ifndef VTS_TEXEL_TEXEL_CONTENT_H
#define VTS_TEXEL_TEXEL_CONTENT_H

#include "scene/scene.h"
#include "shape/tessellate.h"
#include "texel/texel.h"

/* Extent of texel space: the bounds scaled so that their longest side is 1. */
Vec3f texel_extent(const TexelDef *def);
Vec3f texel_extent_of(Box3 bounds);
/* Scene space (as the layers' contents are written) → texel space. */
Transform texel_space(const TexelDef *def);

typedef struct TexelMeshOptions {
    double tolerance;               /* the largest distance from the true surface, in texel space */
    const atomic_bool *interrupted; /* or NULL */
    const Progress *progress;       /* or NULL */
    size_t flakes;                  /* triangles that a density is made of; 0: as many as tell it well */
} TexelMeshOptions;

/* The contents of one layer as triangles in texel space, in `arena`. False, with *refusal filled, for contents that have no finite boundary or
 * are not modelled, and when interrupted. True with a reason in *refusal (else NULL) where something is coarser than the tolerance. */
bool texel_layer_mesh(const TexelDef *def, const TexelLayer *layer, const TexelMeshOptions *how, Arena *arena, TexelMesh *out,
                      ShapeRefusal *refusal);

#endif
