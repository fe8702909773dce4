/* Shading of matter that is known by its distribution of normals: the integral of the local lighting model over the normals
 * that the viewer sees (Neyret 1998 sec. IV-B, with the visible-normal parametrisation of Heitz et al. 2015). */
#ifndef VTS_RENDER_NDF_H
#define VTS_RENDER_NDF_H

#include "base/vec.h"

enum { NDF_RING_POINTS = 8 };

/* How the points of the integral are laid. Measured errors of the Lambert term are in doc/texels.md. */
typedef enum Quadrature {
    QUADRATURE_RING8,  /* two rings of 3 and 5 points, turned towards the light: the default */
    QUADRATURE_RING16, /* two rings of 8 */
    QUADRATURE_GRID16, /* Neyret 1998: a 4 × 4 grid over the rectangle that bounds the apparent ellipse */
    QUADRATURE_LUNE,   /* 3 × 5 Gauss points over the part that the light reaches, for each side that scatters */
} Quadrature;

/* The local lighting model: a two-sided sheet that scatters light from the front and lets some through from behind. */
typedef struct SheetLook {
    float diffuse, transmission, brilliance;
    float specular, inverse_roughness; /* Blinn's half-vector lobe */
    float phong, phong_size;           /* lobe about the mirrored view ray */
} SheetLook;

typedef struct NdfShade {
    float diffuse;   /* factor of pigment × light */
    float highlight; /* factor of light alone (or of pigment × light for metals) */
} NdfShade;

/* s       SGGX matrix in world space, any scale, positive definite
 * view    unit vector from the matter to the eye
 * light   unit vector to the light */
NdfShade ndf_shade(Quadrature quadrature, const Sym3f *s, Vec3f view, Vec3f light, const SheetLook *look);

/* The normal to shade with of a surface whose facets are flat and which is rounder than they are, all unit: on the side of the eye where the facet
 * is seen, and never beyond the rim. `view` points to the eye; `normal` is on the side of `flat`. */
Vec3f sheet_normal(Vec3f normal, Vec3f flat, Vec3f view);

/* The same model on one normal (exact geometry): n is turned towards the eye by the callee. */
NdfShade sheet_shade(Vec3f n, Vec3f view, Vec3f light, const SheetLook *look);

#endif
