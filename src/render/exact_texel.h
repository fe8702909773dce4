/* A texel as it is: the source triangles of its layers in texel space (texel.h) under one hierarchy, nothing prefiltered.
 * What of the content lies beyond a cyclic axis has been moved in from the other side, what lies beyond another is cut off. */
#ifndef VTS_RENDER_EXACT_TEXEL_H
#define VTS_RENDER_EXACT_TEXEL_H

#include "base/arena.h"
#include "texel/texel.h"

typedef struct ExactTexel ExactTexel;

typedef struct ExactTexelHit {
    double s;     /* the hit is at from + s·along */
    size_t layer; /* in the order in which they were added */
    Vec3 corner;  /* of the triangle, where this ray meets it: period added */
    Vec3 period;  /* of texel space in which the hit lies: corner − period is within the texel or cut by its walls */
    Vec3 normal;  /* unit; which side is the front is not told */
} ExactTexelHit;

/* An empty texel in `arena`. `extent` and `cyclic` as for TexelBuildOptions. */
ExactTexel *exact_texel_begin(Vec3f extent, unsigned cyclic, size_t layers, Arena *arena);
/* Copies a layer's triangles. Those that are no numbers or wrap around too often (as voxel_layer_build() has it) are left out. */
void exact_texel_add_layer(ExactTexel *texel, const TexelMesh *mesh, Arena *arena);
/* Builds the hierarchy; takes nothing from an arena. False when Embree is out of memory. */
bool exact_texel_commit(ExactTexel *texel, void *embree_device);
/* Also of NULL, and of one that was never committed. The triangles belong to the arena. */
void exact_texel_destroy(ExactTexel *texel);
/* How many there are, repetitions included. */
size_t exact_texel_triangles(const ExactTexel *texel);

/* The first triangle on from + s·along, s in [s0, s1], endlessly repeated along cyclic axes. `hit` NULL: whether there is any. */
bool exact_texel_shoot(const ExactTexel *texel, Vec3 from, Vec3 along, double s0, double s1, ExactTexelHit *hit);

#endif
