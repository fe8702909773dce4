/* Radiosity: light that surfaces send each other, and that the sky sends them, as the mean over the hemisphere above a place. It varies slowly:
 * it is gathered at few places, from how much it changes about each (Ward, Rubinstein & Clear 1988; gradients: Ward & Heckbert 1992), and
 * blended between these. All are chosen before the picture is drawn, so that pixels do not depend on who draws them. */
#ifndef VTS_RENDER_RADIOSITY_H
#define VTS_RENDER_RADIOSITY_H

#include "render/surface.h"

/* A place of a surface that light comes to. */
typedef struct RadiosityPlace {
    Vec3 point;        /* beside the surface, on the side that is seen */
    Vec3 flat, normal; /* unit, to that side: of the surface, and that by which it is lit */
    double clear;      /* what is nearer is not met */
    double width;      /* of the cone that has met it */
    double distance;   /* it went so far */
    int gathers;       /* as Leg's */
    float worth;       /* the most that light of brightness 1 makes in the eye */
} RadiosityPlace;

/* Where a tracer is asked for places: no more than `most`. */
typedef struct RadiosityAsk {
    RadiosityPlace *places;
    int count, most;
} RadiosityAsk;

typedef struct RadiosityKept RadiosityKept;

/* Whether surfaces are lit by each other, or asked where. */
static inline bool radiosity_is_on(const SurfaceTracer *tracer) { return tracer->compiled->radiosity || tracer->asks; }
/* The mean light from all sides, by the cosine, times the scene's brightness; nothing, and the place noted, where the tracer asks. */
Vec3f radiosity_light(SurfaceTracer *tracer, const RadiosityPlace *place, uint64_t seed);

/* Gathers for all that the eye sees, when all else is compiled, if the scene wants it and has no skins. False when interrupted. radiosity_build.c */
bool radiosity_build(CompiledScene *compiled);

/* ---- parts ---- */

/* Light that was gathered at a place, and how it changes: of red, green and blue. */
typedef struct RadiosityEntry {
    Vec3 point, normal;
    double radius;      /* of a ball in which it may count */
    float light[3];
    Vec3 turning[3];    /* for each radian that the normal turns about this axis */
    Vec3 moving[3];     /* for each unit of length */
} RadiosityEntry;

#define RADIOSITY_REACH 2.5
typedef struct RadiosityEntries {
    const RadiosityEntry *items;
    size_t count;
    double reach;        /* of a ball its entry counts so many radii far */
    const BoxTree *tree; /* NULL: none yet */
} RadiosityEntries;

struct RadiosityKept {
    RadiosityEntries seen;   /* by the eye, in mirrors and through glass as well */
    RadiosityEntries others; /* by those, roughly: of all bounces but the first */
    bool others_known;
};

/* A hemisphere's directions: rows × columns, of equal weight. */
typedef struct RadiosityNet {
    int rows, columns;
} RadiosityNet;
enum { RADIOSITY_MOST_ROWS = 16, RADIOSITY_MOST_COLUMNS = 48 };

/* What comes from all sides, by rays; entry->radius is the mean distance of what is met. Calls for `gathers` + 1. */
void radiosity_gather(SurfaceTracer *tracer, const RadiosityPlace *place, RadiosityNet net, uint64_t seed, RadiosityEntry *entry);
/* How much the entries say of a place, 0: nothing; their mean is *light. `part`: of what they may be wrong by. */
double radiosity_blend(const RadiosityEntries *entries, Vec3 point, Vec3 normal, double part, Vec3f *light);

#endif
