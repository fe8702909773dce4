/* Rays through the bins in which volumes keep their light. */
#ifndef VTS_RENDER_VOLUME_BINS_H
#define VTS_RENDER_VOLUME_BINS_H

#include "render/volume_light.h"

/* A ray through the bins of one volume. */
typedef struct BinWalk {
    const CompiledVolume *volume;
    double t, t_end; /* it is within the bin from t to bin_walk_wall() */
    size_t bin;
    int at[3], step[3];
    double next[3], width[3]; /* t of the next wall of each axis; between walls */
} BinWalk;

/* Where the ray is within the box of the volume's bins between t0 and t1; false where it is not. */
bool bin_walk_begin(BinWalk *walk, const CompiledVolume *volume, const Ray *ray, double t0, double t1);
double bin_walk_wall(const BinWalk *walk);
/* Into the next bin; false at the end. */
bool bin_walk_step(BinWalk *walk);

/* The same through all volumes at once, which may overlap. */
typedef struct BinSweep {
    BinWalk *walks; /* those still to come, or under way */
    int count;
    double t0, t1; /* the piece */
} BinSweep;

/* `walks` has room for all of the set's volumes. */
void bin_sweep_begin(BinSweep *sweep, BinWalk *walks, const VolumeSet *set, const Ray *ray, double t0,
                     double t1);
/* The next piece of the ray that is within one bin of each volume that it is in; false at the end. */
bool bin_sweep_next(BinSweep *sweep);
/* Whether the piece is within this walk's volume. */
static inline bool bin_sweep_has(const BinSweep *sweep, const BinWalk *walk) { return walk->t <= sweep->t0; }

#endif
