/* Following a cone through a skin, step by step, over the voxels that fit its width. */
#ifndef VTS_RENDER_SKIN_MARCH_H
#define VTS_RENDER_SKIN_MARCH_H

#include "render/skin_walk.h"
#include "shape/solid.h"

enum { MOST_MATTER_HITS = 12 };

typedef struct TraceCounters {
    uint64_t camera_rays, shadow_rays, steps, voxels_visited;
    uint64_t places;    /* in media */
    uint64_t triangles; /* of texels, drawn by beams */
    uint64_t left_out;  /* objects around a ray that there was no room for, see MOST_ENCLOSURES */
    SolidWork functions; /* of isosurfaces; counted for a picture as a whole */
} TraceCounters;

static inline void trace_counters_add(TraceCounters *sum, const TraceCounters *c) {
    sum->camera_rays += c->camera_rays;
    sum->shadow_rays += c->shadow_rays;
    sum->steps += c->steps;
    sum->voxels_visited += c->voxels_visited;
    sum->places += c->places;
    sum->triangles += c->triangles;
    sum->left_out += c->left_out;
    solid_work_add(&sum->functions, &c->functions);
}

/* How the way through texture space is followed (Neyret 1998, footnote 7). */
typedef enum RayPath {
    RAY_PATH_BOX,      /* quadratics, as long as they are true to a voxel: the default */
    RAY_PATH_STRAIGHT, /* one chord through each box, as N98 has it */
    RAY_PATH_EXACT,    /* a quadratic for each step */
} RayPath;

typedef struct MarchSettings {
    OpacityModel opacity;
    RayPath path;
    bool slab;            /* the coarsest voxels alone */
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
    float sky;            /* how much of the sky it sees: 1 where that is not asked */
    Vec3f place;          /* texel space, for its pigment */
    float width;          /* of the cone there, texel space */
    float lod;            /* of the voxels */
    const BuiltTexel *texel;
} MatterHit;

typedef struct SkinSegment {
    double t0, t1;
    float transmittance;  /* of the whole segment, < 1 */
    float depth;          /* −ln of it */
    float area;           /* of matter as seen along the cone, for each unit of area across it; some of it hides behind other */
    float gamma_area;     /* area weighted by gamma, texel.h's: whether it is one sheet or many pieces */
    float sheet_area;     /* the same without walls and insides of solids */
    float voxel_world;    /* side of the voxels used, in scene units, along the cone */
    MatterHit hits[MOST_MATTER_HITS];
    int hit_count;
} SkinSegment;

/* A copy met on the way, and up to which t nothing of each of its layers can be met; layers past the last share it. */
enum { LAYERS_APART = 4 };
typedef struct CopyOnWay {
    TexelCopy copy;
    uint32_t cone; /* the number of the cone that clear_until holds for */
    double clear_until[LAYERS_APART];
} CopyOnWay;

/* The copies around one tile. */
typedef struct TileCopies {
    const PlacedTexel *placed; /* NULL: nothing kept */
    int64_t iu, iv;
    uint32_t part; /* of the surface, and whether it is the rim's: which copies stand there */
    bool rim;
    int count;
    CopyOnWay *copies; /* room for all that may be around it */
} TileCopies;
enum { TILES_KEPT = 16 }; /* by the low bits of iu and iv; they stay from cone to cone, whose neighbours meet the same tiles */

/* The voxels that fit the cone in the space of one texel. */
typedef struct VoxelFit {
    float lod;   /* not clamped above */
    float voxel; /* side of the voxels wanted, texel space */
    float width; /* of the cone, texel space */
    float coarsening; /* 2^lod, of lod clamped to the levels there are */
} VoxelFit;

/* A piece of the way on which texture coordinates are a quadratic of t, through the exact ones at both ends and in the
 * middle: "one more inversion at the chord's midpoint" (texels.md). */
typedef struct MarchSpan {
    double t0, t1;
    Vec3 c0, c1, c2;   /* (u, v, w') = c0 + c1·s + c2·s², s = t − t0 */
    TexturePlace place; /* in the middle: gradients for shading and opacity */
    SkinPoint middle;
    VoxelFit *fits;    /* of each texel of the skin */
    double straight;   /* from any t of the span, the length over which the path stays near its tangent */
    double step;       /* length of a step in t */
    float voxel_world; /* side of the finest voxels wanted along the cone, scene units */
    float finest_world; /* of the finest voxels there are */
    bool leaves;       /* the layer ends at t1 */
    bool coarsest;     /* of no texel there are voxels as wide as the cone: one stands for the whole */
} MarchSpan;

typedef struct SkinMarch {
    const CompiledSkin *skin;
    const Cone *cone;
    const MarchSettings *settings;
    TraceCounters *counters;
    bool shade;           /* fill MatterHit.s and .place */
    bool inside;          /* the layer goes on at `at`, where point and place are and the next span begins */
    double t, t_max, at;
    SkinPoint point;
    TexturePlace place;
    SkinStretch stretch;  /* of the way, in which `at` lies */
    MarchSpan span;       /* holds for t in [span.t0, span.t1] */
    int entries, steps_left;
    bool fitted;          /* span.step is of this cone */
    int coarser;          /* levels above what fits */
    uint32_t number;      /* of the cone and its levels, counted up by each begin */
    TileCopies *tiles;    /* [texel][tiles_kept] */
    int tiles_kept;       /* TILES_KEPT, or 1 of a texel that is placed as an object */
    bool confined;        /* to its stretch */
    struct SkinSheets *sheets; /* of a skin that overlaps, else NULL: all else then only says where they begin */
} SkinMarch;

/* Gives the march its memory, once; the rest is set by each begin. */
void skin_march_init(SkinMarch *march, const CompiledSkin *skin, Arena *arena);

/* What a march needs room for: texels of a skin, and copies around a tile. */
typedef struct SkinRoom {
    size_t texels, copies;
} SkinRoom;
/* Makes room for the skin, too. */
void skin_march_ask_room(const CompiledSkin *skin, SkinRoom *room);
/* One that follows any skin of one cell that there is room for and that does not overlap: whoever begins sets `skin` before. */
void skin_march_init_shared(SkinMarch *march, const SkinRoom *room, Arena *arena);

/* Start outside or anywhere: looks for the first entry in [t_min, t_max]. */
void skin_march_begin(SkinMarch *march, const Cone *cone, double t_min, double t_max,
                      const MarchSettings *settings, TraceCounters *counters, bool shade);
/* Starts `reach` voxels before a known point of the skin, which is the cone's place at t = 0, or where the layer begins
 * if that is nearer; `tolerance` is that of finding places in the skin. Returns that length in scene units: the first t is its negative. */
double skin_march_begin_around(SkinMarch *march, const Cone *cone, const SkinPoint *point, double reach, double tolerance, double t_max,
                               const MarchSettings *settings, TraceCounters *counters);
/* One that follows single stretches only. */
void skin_march_init_confined(SkinMarch *march, const CompiledSkin *skin, Arena *arena);
/* Along one stretch only, with the cone and settings of another march of the same skin. */
void skin_march_begin_stretch(SkinMarch *march, const SkinMarch *like, const SkinStretch *stretch);
/* A guess of the place in the skin at t of the current segment, for skin_locate(): where shadows start. */
SkinPoint skin_march_guess(const SkinMarch *march, double t);
/* From here on voxels are so many levels coarser than fits the cone, and steps as much longer. */
void skin_march_coarsen(SkinMarch *march, int levels);
/* The next segment that holds matter, in order of t; false when there is none before t_max. */
bool skin_march_next(SkinMarch *march, SkinSegment *segment);

#endif
