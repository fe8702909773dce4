/* Following a cone through a skin, step by step, over the voxels that fit its width. */
#ifndef VTS_RENDER_SKIN_MARCH_H
#define VTS_RENDER_SKIN_MARCH_H

#include "render/skin.h"

enum { MOST_MATTER_HITS = 12, MOST_PLACED_TEXELS = 8 };

typedef struct TraceCounters {
    uint64_t camera_rays, shadow_rays, steps, voxels_visited;
} TraceCounters;

typedef struct MarchSettings {
    OpacityModel opacity;
    float voxel_width;    /* side of the voxels to use, in footprints of the cone: 1 = voxels as wide as the cone */
    float step;           /* length of a step in voxels */
} MarchSettings;

/* Matter met in one step, for shading. */
typedef struct MatterHit {
    const TexelMatter *matter;
    const Look *look;     /* the texel's own or the skin's */
    Vec3f tint;
    float share;          /* of the step's optical depth */
    Sym3f s;              /* world space, any scale */
    Vec3f place;          /* in the texel's bounds, for its pigment: fractions of the box */
    const BuiltTexel *texel;
} MatterHit;

typedef struct SkinSegment {
    double t0, t1;
    float transmittance;  /* of the whole segment, < 1 */
    SkinPoint point;      /* at its middle */
    float voxel_world;    /* side of the voxels used, in scene units, along the cone */
    MatterHit hits[MOST_MATTER_HITS];
    int hit_count;
} SkinSegment;

typedef struct CopyCache {
    int64_t iu, iv;
    int count; /* -1: nothing cached */
    TexelCopy copies[MOST_COPIES];
} CopyCache;

typedef struct SkinMarch {
    const CompiledSkin *skin;
    const Cone *cone;
    const MarchSettings *settings;
    TraceCounters *counters;
    bool shade;           /* fill MatterHit.s and .place */
    bool inside;
    double t, t_max;
    SkinPoint point;
    TexturePlace place;   /* at t, when inside */
    int entries;
    CopyCache caches[MOST_PLACED_TEXELS];
} SkinMarch;

/* Start outside or anywhere: looks for the first entry in [t_min, t_max]. */
void skin_march_begin(SkinMarch *march, const CompiledSkin *skin, const Cone *cone, double t_min, double t_max,
                      const MarchSettings *settings, TraceCounters *counters, bool shade);
/* Start at a known point of the skin, which is the cone's place at t_min. */
void skin_march_begin_at(SkinMarch *march, const CompiledSkin *skin, const Cone *cone, const SkinPoint *point, double t_min,
                         double t_max, const MarchSettings *settings, TraceCounters *counters, bool shade);
/* Goes on by dt without looking at what is there: past the matter that the cone starts in. */
void skin_march_skip(SkinMarch *march, double dt);
/* The next segment that holds matter, in order of t; false when there is none before t_max. */
bool skin_march_next(SkinMarch *march, SkinSegment *segment);

#endif
