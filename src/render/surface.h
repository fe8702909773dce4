/* Explicit surfaces in full, as POV-Ray 3.7 has them: what lights, mirrors and glass make of a line of sight. Where skins stand in the
 * scene, mirrors show them and they dim what passes. */
#ifndef VTS_RENDER_SURFACE_H
#define VTS_RENDER_SURFACE_H

#include "render/compile.h"
#include "render/draw.h"
#include "render/lighting.h"

/* An object that a ray is inside of. */
typedef struct Enclosure {
    const Interior *interior; /* or NULL: it is there because it keeps fogs and media out */
    uint64_t filled;          /* as SurfaceHit's */
    bool hollow;
    Affine to_interior;       /* as SurfaceHit's */
} Enclosure;
enum { MOST_ENCLOSURES = 64 }; /* of more, the innermost are left out, and counted; each leg of a line of sight has as many on the stack */

/* One leg of a line of sight: from the eye, a mirror, or glass. */
typedef struct Leg {
    Cone cone;
    double clear;       /* what is nearer is not met: where the leg begins */
    RayPurpose purpose;
    int level;          /* legs before it, and it once it was begun; going on straight through something clear does not count */
    float weight;       /* the most that its light makes in the eye */
    int wave;           /* which colour of a dispersed ray; -1: all */
    int gathers;        /* so many directions from surfaces lead to it; 0: it comes from the eye */
    int enclosure_count;
    /* The last field: only those that count are set. */
    Enclosure enclosures[MOST_ENCLOSURES];
} Leg;

/* How a surface's light depends on the colour of its pigment: `lit` for each unit of it, beside what does not. */
typedef struct SurfaceTint {
    const Texture *texture; /* of one layer, which alone is seen; NULL: the light is no such sum */
    Vec3f color, lit;
} SurfaceTint;

/* What one worker needs. */
typedef struct SurfaceTracer {
    const CompiledScene *compiled;
    TraceCounters *counters;
    uint64_t seed;      /* of what is sampled: for each line of sight anew */
    const Draw *draw;   /* of the line of sight, by which those of one pixel share what is sampled; NULL: each by its seed */
    double part;        /* of its pixel's lines of sight, what one of these is; 0: all */
    /* Matter of skins: what a cone gathers of it before t_max, the air before it included, and what shows of the rest; NULL: none. */
    Vec3f (*matter)(void *skins, const Cone *cone, double t_max, float *transmittance);
    /* The share of light that passes it, to a place that is seen from the direction `to_eye`. */
    float (*passing)(void *skins, const Cone *cone, double t_max, Vec3 to_eye);
    double bumps;       /* how wide bumps are smoothed, against the cone; 0: as wide */
    bool exact;         /* of a ray without width, so that any number of them may be asked */
    void *skins;
    bool no_volumes;    /* whoever asks sees to what volumes take of light */
    SurfaceTint *tint;  /* gets that of the surface that is asked for next; NULL: not wanted */
    struct RadiosityAsk *asks; /* it is not light that is wanted, but the places that radiosity lights; else NULL */
    double media_slack; /* so much more than else may be wrong with what media take of light, for many ways count together; 0: 1 */
} SurfaceTracer;

/* A leg that is in nothing. */
void surface_leg(const Cone *cone, Leg *leg);
/* The first leg of a line of sight, in what holds the eye. */
void surface_eye_leg(const CompiledScene *compiled, const Cone *cone, Leg *leg);
/* Whether fogs and media are there: within all that is hollow. */
bool surface_in_air(const Enclosure *enclosures, int count);

/* What comes from the surface that the leg has met back along it: its own light, and what it mirrors and lets through. Without the air
 * and matter before it. */
Vec3f surface_radiance(SurfaceTracer *tracer, const Leg *leg, const SurfaceHit *hit);

/* The texture and its colour alone, where light is such a sum; else its texture is NULL. */
void surface_tint(const Cone *cone, const SurfaceHit *hit, SurfaceTint *out);

/* Of it what the surface mirrors and lets through alone. */
Vec3f surface_beyond(SurfaceTracer *tracer, const Leg *leg, const SurfaceHit *hit);

/* The colour with which the surface that the cone has met gives back diffuse light, all layers together, and its topmost normal. */
void surface_glance(const Cone *cone, const SurfaceHit *hit, Vec3f *color, Vec3 *normal);

/* ---- surface_light.c: what a finish does with light ---- */

/* A layer of a texture where a ray has met it. */
typedef struct SurfaceLayer {
    const Finish *finish;
    Vec3 normal;     /* perturbed, unit */
    Vec3f color;     /* of the pigment */
    Vec3f above;     /* what the layers over it let through, of light that comes back */
    float opaque;    /* 1 - filter - transmit: of diffuse light */
    double film;     /* thickness of the thin layer on it */
} SurfaceLayer;

/* The thickness of a finish's thin layer at a place of the scene. */
double surface_film(const Finish *finish, Vec3 point);

/* What a thin layer makes of light that comes or is mirrored under this cosine: a factor, 1 where the finish has none. */
Vec3f surface_thin_layer(const SurfaceLayer *layer, Vec3 view, double cosine, Vec3 wavelengths);

/* What a layer sends along −view of light that comes this way, for each unit of it; `view` is the ray's direction.
 * `both_sides`: of `double_illuminate`. `place`: where, for grain and thickness. *diffuse gets the factor of the pigment's colour in it. */
Vec3f surface_layer_light(const SurfaceLayer *layer, Vec3 view, const LightRay *way, bool both_sides, Vec3 wavelengths, uint64_t seed, float *diffuse);

/* ---- surface_bend.c: directions and shares of what is mirrored and bent; pure ---- */

Vec3 surface_mirrored(Vec3 direction, Vec3 normal, Vec3 flat);
/* `ratio`: the index of refraction before over that behind. False where all is reflected. The normal is against the direction. */
bool surface_bent(Vec3 direction, Vec3 normal, double ratio, Vec3 *out);
/* Fresnel's equations for unpolarized light; `ratio`: the index behind over that before. */
double surface_fresnel(double cosine, double ratio);
/* The share that a finish mirrors of light under this angle. */
Vec3f surface_reflectivity(const Finish *finish, Vec3f pigment, double cosine, double ratio);
/* What is left of light that went so far in an interior. */
Vec3f surface_faded(const Interior *interior, double distance);

/* ---- surface_shadow.c ---- */

/* The index of the enclosure that the surface bounds, or −1. */
int surface_enclosure(const Enclosure *enclosures, int count, const SurfaceHit *hit);
/* Steps over the surface: into its object, or out. */
void surface_cross(const SurfaceTracer *tracer, Enclosure *enclosures, int *count, const SurfaceHit *hit);
/* What comes along the ray past explicit objects, volumes and media in objects, between `clear` and `distance`. */
Vec3f surface_open(SurfaceTracer *tracer, const Ray *ray, double distance, const Leg *leg, double clear);
/* The share of light from one place of the light, to a point within volumes (clear: 0) or beside a surface, near to which nothing is met. */
Vec3f surface_shadow_way(SurfaceTracer *tracer, const Light *light, const LightRay *way, const Leg *leg, Vec3 point, double clear);
/* The share of a light's colours that comes to the point, `bias` beside which rays begin; `width` and `spread`: of the cone that saw it. */
Vec3f surface_shadow(SurfaceTracer *tracer, const Light *light, const LightRay *ray, const Leg *leg, Vec3 point, double bias,
                     uint64_t seed);

/* ---- surface_sky.c ---- */

/* A place that ambient light comes to. */
typedef struct SkyPlace {
    Vec3 point;         /* beside the surface, on the side that is seen */
    Vec3 flat, normal;  /* unit, to that side: of the surface, and that by which it is lit */
    double clear;       /* what is nearer is not met */
    const Leg *leg;     /* that has met it */
    bool even;          /* light comes alike from all directions, not by the cosine */
} SkyPlace;

/* The share of an even sky's light that comes to the place, past explicit objects and skins; `worth`: the most that all of it makes in the eye. */
Vec3f surface_sky(SurfaceTracer *tracer, const SkyPlace *place, float worth, uint64_t seed);

#endif
