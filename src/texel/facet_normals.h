/* Normals at the corners of a triangle, of surfaces that are rounder than their triangles: 12 bytes each. */
#ifndef VTS_TEXEL_FACET_NORMALS_H
#define VTS_TEXEL_FACET_NORMALS_H

#include "texel/texel.h"

/* Unit vectors as points of an octahedron folded open (Cigolle et al. 2014), 1e-4 exact; zero vectors stay zero. */
typedef struct FacetNormals {
    int16_t corner[3][2];
} FacetNormals;

/* The normals of a mesh's triangle, to the outside of its winding. False where it is flat: when it has none, or they agree with its own to a
 * thousandth. */
bool facet_normals_of(const TexelMesh *mesh, size_t triangle, Vec3f normals[3]);
FacetNormals facet_normals_pack(const Vec3f normals[3]);
/* At corner 0 + s·(corner 1 − corner 0) + t·(corner 2 − corner 0): no unit vector; zero where nothing is known. */
Vec3f facet_normals_at(const FacetNormals *normals, float s, float t);

#endif
