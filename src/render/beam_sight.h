/* The parts of the tracer of a tile: how its pixels are aimed at, what they see, and what light falls on that. Of beam_tile.c and the
 * files beam_aim.c, beam_surface.c, beam_sight.c and beam_light.c alone. */
#ifndef VTS_RENDER_BEAM_SIGHT_H
#define VTS_RENDER_BEAM_SIGHT_H

#include "render/beam_sky.h"
#include "render/beam_tile.h"

#include <stddef.h>

enum { BEAM_NOTHING = -1, BEAM_EDGE = BEAM_TILE + 2 };
/* 1/√2: where the first of the samples goes over; the last does twice as far away. */
#define BEAM_LEAST_FADE 0.70710678118654752

/* An explicit surface, as one ray has met it. */
typedef struct SeenSurface {
    const SurfaceHit *hit;      /* NULL: the ray met none */
    double key_x, key_y, key_0; /* of its tangent plane in the beam */
    float bend;                 /* how far the surface may lie beside that plane where it stands for a whole pixel; else 0 */
} SeenSurface;

/* Hits side by side, each with no more looks than it has: most have one of eight that there may be, and where none may have more there is no room for them. */
typedef struct HitPool {
    unsigned char *bytes;
    size_t used;
} HitPool;
static inline size_t beam_hit_room(int shares) {
    enum { ALIGNMENT = 16 };
    return (offsetof(SurfaceHit, shares) + (size_t)shares * sizeof(LookShare) + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
}

/* Samples of one pixel that see the same thing. */
typedef struct Sight {
    int pixel;            /* in the tile */
    int first, count;     /* its samples are linked: next[] */
    float t;              /* of the first; VTS_INFINITY of the sky */
    Vec3f up;             /* of the layer; zero of explicit objects */
    float sky;            /* the share of the sky that it sees, where its texel knows; below 0 where it must be asked for */
    Vec3f normal, flat, bias; /* bias: to add to a place on it so that it lies on the side of the eye */
    float clear;          /* from how far beside it explicit surfaces are asked for: more than what they deviate from the planes of pixels */
    const Look *look;     /* NULL: the sky */
    const SurfaceHit *surface;
    Vec3f view;           /* from the first sample to the eye: across a horizon the pixel's own direction is another side's */
    Vec3f color, light;   /* pigment; what it sends to the eye, so far */
    int odd;              /* how many of its samples have odd numbers, and what these alone see of the light */
    Vec3f odd_light;
    Vec3f tone;           /* of the light that is being asked for, without shadows */
    uint32_t begin;       /* of its points */
    bool asked;           /* whether it has any */
    bool narrow;          /* its samples lie together in a part of the pixel, and are looked at by a cone as wide as that */
    bool beyond;          /* its samples may see voxels before it, and get the shadows of voxels; else all before it is exact */
    Vec3 point;           /* the mean of its samples on a facet; that of the first on explicit objects */
} Sight;

struct BeamTracer {
    const CompiledScene *compiled;
    Allotment allotment;   /* samples of the pixels, before this pass and in it */
    int most_in_pass;      /* samples of a pixel */
    bool first_pass;
    BeamPlan plan;
    double tile_noise; /* squared, of a pixel of the last tile */
    double squared_error, squared_noise; /* summed over the pixels of all tiles: what voxels are wrong by, and noise */
    uint64_t pixel_count, sample_count, shaded_count;
    uint64_t seed;
    Tracer volumes;        /* empty where no voxels are seen */
    Beam beam;
    Vec3 corner, right, down; /* the line through (x, y): along corner + right·x + down·y, or from there */
    Cone cones[BEAM_TILE * BEAM_TILE]; /* of the pixels */
    uint8_t shade[BEAM_TILE * BEAM_TILE]; /* what of a pixel explicit objects shadow: some of it, none of it */
    BeamDraft draft;
    ShadowScratch shadow;
    /* of the tile's pixels and a border of one around */
    SeenSurface pixels[BEAM_EDGE * BEAM_EDGE];
    SeenSurface *surfaces; /* of samples that were asked for one by one */
    uint32_t surface_count;
    HitPool pixel_hits, sample_hits; /* of those and these */
    /* per sample */
    float *fade;           /* the factor of exact_to */
    int32_t *surface;      /* into `surfaces`; BEAM_NOTHING: its pixel's */
    int32_t *next;         /* sample of the same sight, or BEAM_NOTHING */
    Vec3f *points;         /* where the light is asked for */
    uint8_t *hidden;
    float *distance;
    SkyScratch sky;        /* and what goes with it: for scenes with light of the sky alone */
    Vec3f *sky_up, *sky_flat;
    uint8_t *sky_turn;
    Sight *sights;
    uint32_t sight_count;
    int x0, y0, columns, rows;
    bool bounded;
    Box3 explicit_bounds;
    TraceCounters counters;
    AovSum *aovs;          /* of the tile's pixels; NULL: not wanted */
};

/* Samples that a pixel will have after this pass. */
static inline int beam_samples_of(const BeamTracer *tr, int pixel) { return tr->allotment.taken[pixel] + tr->allotment.asked[pixel]; }

/* Of the line through (x, y) of the tile: from `origin` along `direction`, whose length is that of one unit of q.z. */
typedef struct BeamLine {
    Vec3 origin, direction;
    double length;
} BeamLine;


/* ---- beam_aim.c: the beam and its samples ---- */

/* The camera's lines through the tile become the tracer's beam. */
void beam_aim(BeamTracer *tracer);
/* Lays the samples of a pass: for any count of them, and of passes, of low discrepancy. */
void beam_lay_samples(BeamTracer *tracer);
BeamLine beam_line_at(const BeamTracer *tracer, double x, double y);
/* How far from the eye something of the key is, along the line. */
double beam_line_distance(const BeamTracer *tracer, const BeamLine *line, float key);
/* The line of a sample, and what it has met at *t along it. */
BeamLine beam_sample_line(const BeamTracer *tracer, uint32_t sample);
Vec3 beam_sample_point(const BeamTracer *tracer, uint32_t sample, double *t);
/* How far from the eye the sample's t would be, if it went over to voxels where the mean sample does. */
static inline double beam_faded_distance(const BeamTracer *tracer, uint32_t sample, double t) { return t / (double)tracer->fade[sample]; }

/* ---- beam_surface.c: explicit surfaces ---- */

/* Asks for those behind all samples; they become the samples' keys. */
void beam_see_surfaces(BeamTracer *tracer);
/* What was found behind a sample of the pixel. */
const SeenSurface *beam_surface_of(const BeamTracer *tracer, int pixel, uint32_t sample);

/* ---- beam_sight.c: what each sample sees ---- */

/* Sorts the samples of each pixel by what they see, and by whether voxels may lie before it. */
void beam_gather_sights(BeamTracer *tracer);
/* The mean of the lines to the samples of a sight, as wide as the pixel or as a narrow sight's part of it, and how far along it they lie (VTS_INFINITY of the sky). The line
 * through the pixel's middle would end before what they see or behind it, by more than a thin layer's height. */
Cone beam_sight_cone(const BeamTracer *tracer, const Sight *sight, double *t);

/* ---- beam_ambient.c ---- */

/* Ambient and emitted light of all sights: sets their `light`. */
void beam_add_ambient(BeamTracer *tracer);

/* ---- beam_light.c ---- */

/* Adds what explicit surfaces mirror and let through. */
void beam_add_beyond(BeamTracer *tracer);
/* Adds what a light sends by way of them. */
void beam_add_light(BeamTracer *tracer, const Light *light);

#endif
