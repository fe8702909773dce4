/* A texel as it is: the source triangles of its layers in texel space (texel.h) under one tree, nothing prefiltered.
 * What of the content lies beyond a cyclic axis has been moved in from the other side, what lies beyond another is cut off. */
#ifndef VTS_RENDER_EXACT_TEXEL_H
#define VTS_RENDER_EXACT_TEXEL_H

#include "base/arena.h"
#include "render/curve.h"
#include "texel/facet_normals.h"

typedef struct ExactTexel ExactTexel;

typedef struct ExactTexelHit {
    double s;     /* of the whole curve */
    size_t layer; /* in the order in which they were added */
    Vec3 corner, edge[2]; /* of the triangle, where this curve meets it: period added */
    Vec3 period;  /* of texel space in which the hit lies: the hit − period is within the texel */
    Vec3 normal;  /* unit, of the triangle; which side is the front is not told */
    const FacetNormals *round; /* at its corners; or NULL */
} ExactTexelHit;

/* What a curve stands for: the way itself, which may be `margin` away from it, in texel space. settle() moves a hit from the curve to
 * the way, and tells the nearest s so far by lowering *nearest when it accepts it; it returns true when nothing else is wanted. */
typedef struct ExactWay {
    double margin;
    double *nearest; /* of the whole curve */
    bool (*settle)(void *context, ExactTexelHit *hit);
    void *context;
} ExactWay;

/* An empty texel in `arena`. `extent` and `cyclic` as for TexelBuildOptions. */
ExactTexel *exact_texel_begin(Vec3f extent, unsigned cyclic, Arena *arena);
/* Copies a layer's triangles into `arena`, the same as before. Those that are no numbers or wrap around too often (as voxel_layer_build() has it) are left out. */
void exact_texel_add_layer(ExactTexel *texel, const TexelMesh *mesh, Arena *arena);
/* Builds the tree, once, after the last layer, and puts the triangles in its order; `scratch` is left as it was. */
void exact_texel_commit(ExactTexel *texel, Arena *arena, Arena *scratch);
/* How many triangles there are, repetitions included. */
size_t exact_texel_triangles(const ExactTexel *texel);

/* Settles what the curve meets, at an s of its own from s0 on and at one of the whole below *way->nearest: triangles within the texel's
 * box and its repetitions along the axes `repeat` (a subset of the cyclic ones), give or take the margin. True when settle() was. */
bool exact_texel_shoot(const ExactTexel *texel, const Curve *curve, double s0, unsigned repeat, const ExactWay *way);
/* Whether a point of the hit's plane, period included, is within `margin` of the triangle and of the texel's box. */
bool exact_texel_covers(const ExactTexel *texel, const ExactTexelHit *hit, Vec3 point, double margin);
/* The unit normal of what the triangle stands for, at a point of the hit's plane, period included: on the side of hit->normal. */
Vec3 exact_texel_normal(const ExactTexelHit *hit, Vec3 point);

#endif
