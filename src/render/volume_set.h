/* Volumes made ready for rays: densities as lattices, what they fill, and what their light pass has left. */
#ifndef VTS_RENDER_VOLUME_SET_H
#define VTS_RENDER_VOLUME_SET_H

#include "base/random.h"
#include "render/compile.h"
#include "render/surface.h"
#include "shape/body.h"
#include "volume/lattice.h"
#include "volume/phase_spread.h"

typedef struct VolumeLight VolumeLight;

typedef struct CompiledVolume {
    const Volume *volume;
    Lattice lattice;          /* by two passes: no denser than bins can tell, see volumes_cap() */
    const Lattice *dense;     /* as dense as it is, where that is more; NULL: it is no more */
    Affine to_cells;          /* scene → the lattice's cells */
    Mat3 from_cells;          /* of vectors, back */
    const Body *body;         /* what it fills; NULL: all of the lattice's box */
    const Object *container;
    Transform body_place;     /* the body's own space → scene */
    Box3 bounds;              /* scene */
    double scattering[3], absorption[3], extinction[3];
    Phase phase;
    double moments[PHASE_MOMENTS];
    double thinned[3];        /* extinction, where light that a forward peak of the phase function turns aside goes on */
    const PhaseSpread *spread;/* of that peak; NULL: none */
    double peak_share;        /* how often it turns light on a way of thinned depth 1 */
    bool casts, seen;         /* shadows; in the picture */
    VolumeLight *light;       /* volume_light.h; NULL: nothing was kept */
} CompiledVolume;

typedef struct VolumeSet {
    CompiledVolume *items;
    size_t count;
    Box3 bounds;
    VolumeMethod method;
    bool rays_are_paths;      /* of a line of sight; else those of a light pass, which paths may do without */
    int orders;               /* 0: all */
    bool sky;                 /* light comes from the sky too */
    int looks;                /* of bins at those around them, one after the other, see volumes_shoot() */
    double fineness;          /* of bins, lamps' nodes and steps: 1 where max_error is no smaller than a step of eight-bit pictures, more below */
} VolumeSet;

/* The set as the two passes see light that was scattered before: forward peaks of phase functions, which harmonics of low degrees cannot have, turn nothing aside (Wiscombe
 * 1977). On the arena; with its volumes' `light` still to be made. */
VolumeSet *volumes_without_peaks(const VolumeSet *set, Arena *arena);
/* What is denser than light that is kept can tell apart is as dense as that for light within: sets `dense`. The set's methods must be known. volume_cap.c */
void volumes_cap(VolumeSet *set, Arena *arena);
/* The scene's volumes without their light; NULL where there are none. False after a diagnostic. */
bool volumes_compile(CompiledScene *compiled, DiagList *diags);

/* ---- along rays of unit direction ---- */

typedef struct VolumeSpan {
    double t0, t1;
} VolumeSpan;
enum { VOLUME_MOST_SPANS = 32 };
/* Where between t0 and t1 the ray is within the volume, ascending; more pieces than there is room for are joined. */
int volume_spans(const CompiledVolume *volume, const Ray *ray, double t0, double t1, VolumeSpan spans[VOLUME_MOST_SPANS]);
/* The same ray in the lattice's cells, same t. */
Ray volume_ray_in_cells(const CompiledVolume *volume, const Ray *ray);
/* The integral of density over length, as light within goes. */
double volume_length(const CompiledVolume *volume, const Ray *ray, double t0, double t1);
/* The same of all there is. */
double volume_whole_length(const CompiledVolume *volume, const Ray *ray, double t0, double t1);
/* Where it reaches `length`; false where it does not. */
bool volume_reach(const CompiledVolume *volume, const Ray *ray, double t0, double t1, double length, double *t);
/* The share of light that passes all volumes that cast shadows; what is not seen is left out of sights. */
Vec3f volumes_passing(const VolumeSet *set, const Ray *ray, double t0, double t1, RayPurpose purpose);
/* The share that passes all volumes up to t1, or is turned aside by forward peaks alone. */
Vec3f volumes_passing_thinned(const VolumeSet *set, const Ray *ray, double t1);
static inline bool volume_counts(const CompiledVolume *v, RayPurpose purpose) { return purpose == RAY_SHADOWS ? v->casts : purpose == RAY_SEES ? v->seen : true; }

/* ---- light ---- */

/* How light of a colour 1 is counted: POV-Ray's colours make a white sheet that faces the light as bright as they are, so that pi of
 * them arrives on each unit of area. */
#define VOLUME_IRRADIANCE VTS_PI

/* What volumes make of what is seen at t_max along the cone: color·keep + add, and how much of it they cover. */
Air volumes_air(SurfaceTracer *tracer, const Cone *cone, double t_max);
/* Whether there is nothing in the air of the scene: no volumes, media, fogs or rainbows. */
bool air_is_clear(const CompiledScene *compiled);
/* The same with fogs, rainbows and media. */
Air air_along(SurfaceTracer *tracer, const Leg *leg, double t_max);
/* On the first leg. */
Air air_from_eye(SurfaceTracer *tracer, const Cone *cone, double t_max);

/* Light scattered towards the ray's origin before t_max, by one path, drawn by `seed`: unbiased. volume_path.c */
Vec3f volumes_path(SurfaceTracer *tracer, const Ray *ray, double t_max, uint64_t seed);
/* A place where light that goes along a ray collides with a volume. */
typedef struct Collision {
    const CompiledVolume *volume;
    double t;
} Collision;
/* Draws the first before t_max and multiplies the weights of the three colours by what is scattered there over its chance; false where light
 * passes, with weights by which it does. volume_path.c */
bool volume_collide(const VolumeSet *set, RandomStream *random, double weight[3], const Ray *ray, double t_max, RayPurpose purpose, Collision *out);
/* Ends what is small against `whole` by lot. */
bool volume_survives(RandomStream *random, double weight[3], double whole);
/* To the next surface along the ray, at which scattered light ends; infinite and !*met where there is none. */
double volume_clear_way(const CompiledScene *compiled, const Ray *ray, bool *met);
/* The share of light that comes from the light, one place of it, to a place in volumes: past surfaces, and through volumes. */
Vec3f volume_lit(SurfaceTracer *tracer, const Light *light, const LightRay *way, Vec3 point);

/* By what was kept. volume_view.c */
Air volumes_gather(SurfaceTracer *tracer, const Cone *cone, double t_max, double *mean_t);

#endif
