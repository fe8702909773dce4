/* Explicit objects under one hierarchy (Embree): triangles as they are, solids by exact intersection. */
#ifndef VTS_RENDER_HIERARCHY_H
#define VTS_RENDER_HIERARCHY_H

#include "base/diag.h"
#include "render/look.h"
#include "render/vista.h"
#include "scene/scene.h"
#include "shape/solid.h"

typedef struct Hierarchy Hierarchy;
struct Interior;
struct Blockers;

/* What a ray is for: `no_image`, `no_reflection`, `no_shadow` and `no_radiosity` hide objects from each. */
typedef enum RayPurpose { RAY_SEES, RAY_MIRRORS, RAY_SHADOWS, RAY_GATHERS } RayPurpose;

/* A further look of a surface, which has so much of it. */
typedef struct LookShare {
    const Look *look;
    double weight;
    Transform space; /* as SurfaceHit has it */
} LookShare;

enum { LOOK_SHARES = 7 };

typedef struct SurfaceHit {
    double t;
    Vec3 normal;       /* unit, turned towards the ray's origin; of smooth triangles the interpolated one */
    Vec3 flat;         /* of the surface itself: on which side of it a place lies */
    uint32_t object;   /* tells the drawn part from others, until the program ends: for telling edges */
    uint32_t number;   /* of the drawn part, from 1, the same in every run; a float holds it */
    const Look *look;
    Transform space;   /* object space of the texture → scene */
    TexCoord uv;       /* on the surface, as POV-Ray has it */
    bool leaving;      /* the ray comes out of the solid's inside; of sheets: meets their back */
    const Object *solid; /* whose surface it is, within sets and copies */
    const struct Interior *interior; /* what fills it, its own or of a set around it; or NULL */
    bool both_sides;   /* lights shine on both of its sides */
    uint64_t filled;   /* tells the object that has that interior from its copies; without one, that has the surface */
    bool hollow;       /* it is, so that air goes on in it, and media show */
    Affine to_interior; /* scene → space of the object that has the interior; unset where it has no media */
    int share_count;   /* where several looks blend: all but `look`, which has the rest; it is clear or mirrors if any does */
    LookShare shares[LOOK_SHARES];
} SurfaceHit;

/* An interior that a place lies in, and of which object. */
typedef struct Filling {
    const struct Interior *interior;
    uint64_t filled; /* as SurfaceHit has it */
    bool hollow;
    Affine to_interior;
} Filling;

/* For about so many rays, by which it is told how much building is worth. NULL after a diagnostic. */
Hierarchy *hierarchy_build(const Scene *scene, double rays, Arena *arena, DiagList *diags);
void hierarchy_destroy(Hierarchy *hierarchy);
size_t hierarchy_object_count(const Hierarchy *hierarchy);
/* How far from its true place, at most, a surface about this point may be met: some steps of floats that count from the middle of all
 * that is bounded. */
double hierarchy_coarseness(const Hierarchy *hierarchy, Vec3 point);
/* Whether something lets light through, so that shadows have colours. */
bool hierarchy_is_clear(const Hierarchy *hierarchy);
/* Whether a hit may have `shares`. */
bool hierarchy_blends(const Hierarchy *hierarchy);
/* Whether nothing mirrors or lets light through. */
bool hierarchy_is_plain(const Hierarchy *hierarchy);
/* Adds what functions have cost rays so far. */
void hierarchy_work(const Hierarchy *hierarchy, SolidWork *sum);
/* What the eye can see, for vista_of(); `object` as SurfaceHit has it, plus 1. */
const VistaPieces *hierarchy_pieces(const Hierarchy *hierarchy);
/* What may block light on its way (blockers.h); NULL in scenes without media. */
const struct Blockers *hierarchy_blockers(const Hierarchy *hierarchy);
/* Starts Embree if it is not yet, which takes as long as thousands of rays: a hierarchy of few things does without, skins do not. False
 * after a diagnostic. */
bool hierarchy_start_embree(Hierarchy *hierarchy, DiagList *diags);
/* Embree, which lives as long as the hierarchy; its device is NULL until it is started. */
const struct Embree *hierarchy_embree(const Hierarchy *hierarchy);

/* A box around everything that is drawn, empty if nothing is; false when there is something endless. */
bool hierarchy_bounds(const Hierarchy *hierarchy, Box3 *box);
/* Nearest hit with t in (t_min, t_max); unit direction. */
bool hierarchy_intersect(const Hierarchy *hierarchy, const Ray *ray, double t_min, double t_max, SurfaceHit *hit);
/* The same for rays of any purpose. */
bool hierarchy_meet(const Hierarchy *hierarchy, RayPurpose purpose, const Ray *ray, double t_min, double t_max, SurfaceHit *hit);
/* The same, but where the look is the same everywhere `space` and `uv` are not told. */
bool hierarchy_glimpse(const Hierarchy *hierarchy, RayPurpose purpose, const Ray *ray, double t_min, double t_max, SurfaceHit *hit);
/* Both of these for bundles of rays; `places`: as hierarchy_meet(). */
bool hierarchy_meet_wide(const Hierarchy *hierarchy, RayPurpose purpose, const Ray *ray, RayWidth width, double t_min, double t_max, bool places,
                         SurfaceHit *hit);
bool hierarchy_occluded_wide(const Hierarchy *hierarchy, const Ray *ray, RayWidth width, double t_min, double t_max);
/* Whether anything that casts shadows lies between. */
bool hierarchy_occluded(const Hierarchy *hierarchy, const Ray *ray, double t_min, double t_max);
/* The interiors that the point lies in: at most `most`, each once; meshes are not asked. Returns how many. */
size_t hierarchy_inside(const Hierarchy *hierarchy, Vec3 point, Filling *out, size_t most);

#endif
