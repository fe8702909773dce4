/* A ray's way through a skin by adjacency: the exit from one cell is the entry into the next, at the same t and the same place of the
 * shared wall, so that the stretches of a way follow each other without gap or overlap. For skins whose sheets do not overlap. */
#ifndef VTS_RENDER_SKIN_WALK_H
#define VTS_RENDER_SKIN_WALK_H

#include "render/skin_cross.h"

enum { NO_FACE = -1 };

typedef struct SkinStretch {
    double t0, t1;
    SkinPoint start, end; /* places at t0 and t1, both of one cell */
    int exit;             /* the face at t1; NO_FACE: t_max was reached, or no exit was found, and the end lies at the start */
} SkinStretch;

/* Two t nearer than this are one, as far as rounding can tell in the cell. */
double skin_hair(const SkinCell *cell, const Ray *ray, double t);
/* The stretch through the cell of `start` from t on. */
SkinStretch skin_stretch_from(const CompiledSkin *skin, const Ray *ray, SkinPoint start, double t, double t_max);
/* Whether the layer goes on behind the stretch's exit. */
bool skin_stretch_goes_on(const CompiledSkin *skin, const SkinStretch *stretch);
/* The next stretch, from the exit of the last. */
SkinStretch skin_stretch_next(const CompiledSkin *skin, const Ray *ray, const SkinStretch *last, double t_max);
/* The first stretch at or after t_min, wherever it is; false when there is none. */
bool skin_stretch_first(const CompiledSkin *skin, const Ray *ray, double t_min, double t_max, SkinStretch *out);
/* The first stretch behind the end of one at which the layer does not go on. */
bool skin_stretch_again(const CompiledSkin *skin, const Ray *ray, const SkinStretch *last, double t_max, SkinStretch *out);

#endif
