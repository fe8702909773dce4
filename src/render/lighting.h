/* What lights, sky and fog give at a place, before shadows: common to all ways of gathering light. */
#ifndef VTS_RENDER_LIGHTING_H
#define VTS_RENDER_LIGHTING_H

#include "render/look.h"

typedef struct LightRay {
    Vec3 direction;  /* unit, towards the light */
    double distance; /* VTS_INFINITY for parallel light */
    Vec3f color;     /* arriving, unshadowed */
    bool highlights; /* whether it makes any: lights without shadows make none, as in POV-Ray */
} LightRay;

/* From its middle: what a light without an area sends, and what the highlights and tones of all lights are calculated with. */
LightRay light_ray(const Light *light, Vec3 point);

/* Whether its shadows are soft: then a shadow is the mean over places of the light, and the tone that of light_ray(). */
bool light_is_area(const Light *light);
/* The place of the light at (u, v) of the unit square as it is seen from the point: evenly spread (u, v) give POV-Ray's mean. The middle
 * for a light without an area. */
Vec3 light_place(const Light *light, Vec3 point, double u, double v);
/* One of counts[0] × counts[1] places that count alike, of a light with an area: its own lights, where these are as many. */
Vec3 light_member(const Light *light, Vec3 point, const int at[2], const int counts[2]);
/* What comes from that place: direction and distance are those of a shadow ray. */
LightRay light_ray_from(const Light *light, Vec3 point, Vec3 place);
/* How much wider a cone towards the light grows per unit of length so that it ends as large as the light's area. */
double light_spread(const Light *light, const LightRay *ray);
/* Whether the light shines on what belongs to this group (NULL: none). */
bool light_shines_on(const Light *light, const LightGroup *group);

/* Whether nothing is dark for it: without shadows, a light that is projected through something still lights nothing beside that. */
static inline bool light_comes_everywhere(const Light *light) { return light->shadowless && !light->projected_through; }

/* What matter of this pigment colour sends to the eye of light that comes unshadowed: `shade` of its normals. */
Vec3f light_tone(const LightRay *ray, const NdfShade *shade, const Look *look, Vec3f color);

/* Sky sphere and background along a unit direction; `spread` is the angle over which the sky is averaged. */
Vec3f sky_radiance(const Scene *scene, Vec3 direction, double spread);
/* What fogs and rainbows do to light on a leg of its way: color·keep + alpha·add. */
typedef struct Air {
    Vec3f keep, add;
    float cover; /* share that volumes hide */
} Air;
static inline Air air_clear(void) { return (Air){{1, 1, 1}, {0, 0, 0}, 0}; }

/* air.c. Between the origin and what is seen at t (VTS_INFINITY: the sky) along the unit direction. */
Air air_between(const Scene *scene, const Ray *ray, double t);
/* What fogs alone let through of light to t: lights with media_attenuation go through them (measured), not through rainbows. */
Vec3f air_fog_passing(const Scene *scene, const Ray *ray, double t);
/* `color` is multiplied by `alpha`. */
static inline Vec3f air_over(const Air *air, Vec3f color, float alpha) {
    return vec3f_madd(vec3f_mul(color, air->keep), air->add, alpha);
}

#endif
