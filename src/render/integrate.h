/* The light that a cone gathers: skins, explicit objects, sky, composited from front to back. */
#ifndef VTS_RENDER_INTEGRATE_H
#define VTS_RENDER_INTEGRATE_H

#include "render/aov_trace.h"
#include "render/compile.h"
#include "render/draw.h"
#include "render/film.h"
#include "render/lighting.h"
#include "render/skin_light.h"
#include "render/surface.h"

enum { MOST_SHADE_RECORDS = 256 };

typedef struct ShadeRecord ShadeRecord;

/* What one worker needs; sized once, so that tracing allocates nothing. */
typedef struct Tracer {
    const CompiledScene *compiled;
    SkinFront front;
    SkinLight light;
    ShadeRecord *records;
    Vec3f *direct;             /* [record][light] */
    LightRay *light_rays;      /* [light], at the segment that is being shaded */
    uint64_t seed;             /* of what is sampled in this pixel */
    double part;               /* of its lines of sight, what one of these is; 0: all */
    Draw draw;                 /* likewise, of samples that follow each other in one pixel: lens, lights, glossy directions */
    SurfaceTint *tint;         /* gets how the light of the next surface depends on its colour; NULL: not wanted */
    MatterAov *matter;         /* gets what a cone sees of skins; NULL: not wanted */
    TraceCounters counters;
} Tracer;

/* A cone that stands for samples which go over from exact geometry to voxels at different distances: the share[i] of them sees
 * voxels of a skin from exact_to · factor[i] on. Shares sum to 1. count 0: all of them see everything from the eye on. */
enum { MOST_CONE_STARTS = 8 };
typedef struct ConeStart {
    int count;
    float share[MOST_CONE_STARTS], factor[MOST_CONE_STARTS]; /* factors ascending */
} ConeStart;

void tracer_init(Tracer *tracer, const CompiledScene *compiled, Arena *arena);

/* Surfaces whose mirrors show the tracer's skins. */
SurfaceTracer tracer_of_surfaces(Tracer *tracer);

/* `hit` (NULL: nothing) is the nearest explicit surface on the cone's axis. *reaching gets the share of the light from
 * there that is not hidden by skins. */
Radiance trace_cone(Tracer *tracer, const Cone *cone, const SurfaceHit *hit, float *reaching);

/* The light that a cone gathers from the skins alone, before t_max; *transmittance gets what shows of the rest. */
Vec3f trace_skins(Tracer *tracer, const Cone *cone, const ConeStart *start, double t_max, float *transmittance);

#endif
