/* What lights, sky and fog give at a place, before shadows: common to all ways of gathering light. */
#ifndef VTS_RENDER_LIGHTING_H
#define VTS_RENDER_LIGHTING_H

#include "render/look.h"

typedef struct LightRay {
    Vec3 direction;  /* unit, towards the light */
    double distance; /* VTS_INFINITY for parallel light */
    Vec3f color;     /* arriving, unshadowed */
} LightRay;

LightRay light_ray(const Light *light, Vec3 point);

/* What matter of this pigment colour sends to the eye for one unit of light: `shade` of its normals. */
Vec3f shade_tone(const NdfShade *shade, const Look *look, Vec3f color);

/* Sky sphere and background along a unit direction; `spread` is the angle over which the sky is averaged. */
Vec3f sky_radiance(const Scene *scene, Vec3 direction, double spread);
/* POV-Ray's constant fog, exp(−t / distance), over what is seen at t; `color` is multiplied by `alpha`. */
Vec3f fog_over(const Scene *scene, Vec3f color, float alpha, double t);

#endif
