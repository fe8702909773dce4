/* A texel as it is: the source triangles of its layers in texel space (texel.h) under one tree, nothing prefiltered.
 * What of the content lies beyond a cyclic axis has been moved in from the other side, what lies beyond another is cut off. */
#ifndef VTS_RENDER_EXACT_TEXEL_H
#define VTS_RENDER_EXACT_TEXEL_H

#include "base/arena.h"
#include "render/curve.h"
#include "texel/texel.h"

typedef struct ExactTexel ExactTexel;

typedef struct ExactTexelHit {
    double s;     /* of the curve */
    size_t layer; /* in the order in which they were added */
    Vec3 corner;  /* of the triangle, where this curve meets it: period added */
    Vec3 period;  /* of texel space in which the hit lies: the hit − period is within the texel */
    Vec3 normal;  /* unit; which side is the front is not told */
} ExactTexelHit;

/* An empty texel in `arena`. `extent` and `cyclic` as for TexelBuildOptions. */
ExactTexel *exact_texel_begin(Vec3f extent, unsigned cyclic, size_t layers, Arena *arena);
/* Copies a layer's triangles. Those that are no numbers or wrap around too often (as voxel_layer_build() has it) are left out. */
void exact_texel_add_layer(ExactTexel *texel, const TexelMesh *mesh, Arena *arena);
/* Builds the tree, once, after the last layer; `scratch` is left as it was. */
void exact_texel_commit(ExactTexel *texel, Arena *arena, Arena *scratch);
/* How many triangles there are, repetitions included. */
size_t exact_texel_triangles(const ExactTexel *texel);

/* The first triangle on the curve at an s in [s0, s1], within the texel's box and its repetitions along the axes `repeat` (a
 * subset of the cyclic ones). `hit` NULL: whether there is any. */
bool exact_texel_shoot(const ExactTexel *texel, const Curve *curve, double s0, double s1, unsigned repeat, ExactTexelHit *hit);

#endif
