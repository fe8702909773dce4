/* From the scene graph to what rays can be traced against: hierarchies, built texels, skins, lights. */
#ifndef VTS_RENDER_COMPILE_H
#define VTS_RENDER_COMPILE_H

#include "base/diag.h"
#include "base/pool.h"
#include "base/progress.h"
#include "render/beam_allot.h"
#include "render/budget.h"
#include "render/hierarchy.h"
#include "render/skin.h"
#include "render/skin_march.h"
#include "render/terrain_view.h"
#include "render/view.h"
#include "shape/box_tree.h"
#include "texel/texel_cache.h"

/* How fine a texel is in one frame of a film: BuiltTexel has both. */
typedef struct TexelFrame {
    int finest_seen, built;
} TexelFrame;

/* What a frame of a film tells those after it: what trial pixels have shown (beam_pilot.c), for scenes that hardly differ, and how fine texels are. */
typedef struct PilotResult {
    bool known;                 /* what trial pixels have shown */
    double factor, voxel_error; /* of the planned distances; of CompiledScene */
    bool alone;                 /* voxels are drawn alone; voxel_error is then that of the picture */
    double planned;             /* what they were told at: the least of these distances, and */
    Vec3 lamps;                 /* the lamps' sum, by brightness and direction (those at a place: towards it from the middle of what is exact), and */
    double bright;              /* the sum of their brightness */
    double worth;   /* of samples (beam_worth.c); 0: not told */
    const TexelFrame *texels; /* of CompiledScene, in its order: others build none coarser, so that what they share is built once; NULL: not told */
    size_t texel_count;
    bool elsewhere; /* all this is to be told by another scene first: one with texels is not compiled further than to its skins, and */
    bool asked;     /* this becomes true */
} PilotResult;

typedef struct CompileOptions {
    Pool *pool;
    MemoryBudget *memory;
    TexelCache *texels; /* voxels built before, and those from files; may be NULL if the scene has none from files */
    const Progress *progress;
    int width, height;
    int texel_resolution; /* to build texels at, as far as they allow it; 0: what the view can see */
    const atomic_bool *interrupted;
    bool exact; /* for the reference: texels and skins keep their geometry, no voxels are built */
    const struct NetStates *net_states; /* of springs in skins; NULL: they are followed from their beginning */
    struct VolumeMemo *volume_memo; /* NULL: nothing is kept of volumes */
    struct ExactMemo *exact_memo; /* of audits; NULL: nothing is kept of texels' triangles */
    PilotResult *pilot; /* is used if it is known, else becomes known; NULL: trial pixels are drawn, and forgotten */
    bool film;  /* one of several pictures in a row: skins are drawn so much better that what changes between two is right to max_error */
} CompileOptions;

enum { EYE_FILLINGS = 12 };

typedef struct CompiledScene {
    const Scene *scene;
    const CompileOptions *options; /* while it is being compiled */
    Arena *arena;
    Arena scratch;        /* of building; a field, so that it is released when building breaks off */
    View view;
    Hierarchy *hierarchy; /* explicit objects */
    CompiledSkin *skins;
    size_t skin_count;
    const BoxTree *skin_tree; /* over the bounds of the skins */
    ExactSkins *exact;    /* the skins' geometry, for the reference; else NULL */
    struct RigidCopies *rigid; /* copies that rays meet, or NULL */
    struct WangKept *wang; /* texels taken apart */
    struct VolumeSet *volumes; /* clouds, or NULL */
    const struct Projections *projections; /* what lights are projected through, or NULL */
    bool solids_matter;   /* there are fogs or media: what is not hollow keeps them out */
    Filling eye_fillings[EYE_FILLINGS]; /* what holds the camera's location */
    size_t eye_filling_count;
    bool exact_paths;     /* one path of light through volumes for each sample, of which there are many */
    BuiltTexel **texels;  /* every texel built, for the report */
    size_t texel_count;
    BuiltTerrains terrains; /* for the report, too */
    MarchSettings march, shadow_march;
    Quadrature quadrature;
    TexelFiltering filtering;
    double shadow_aperture;
    bool secondary;       /* some explicit objects mirror or let light through: lines of sight go on from them */
    bool clear_shadows;   /* some explicit objects let light through */
    bool voxels;          /* skins have voxels, not exact geometry alone */
    double accepted_error; /* the RMSE that the scene accepts, */
    double max_error;     /* and of one frame of it: films have less */
    Budget budget;        /* who makes how much of it */
    float opaque_below;   /* what skins let through that is less than this is taken to look like themselves */
    float dark_below;     /* light of which skins leave less than this share is gone */
    int most_samples;     /* a pixel, to keep it */
    int samples;          /* a pixel, of the first pass of what is drawn by beams */
    AllotPlan allot;      /* the samples of what is drawn by beams; how many that are of a pixel, and the RMSE that they leave, where blocks have told: */
    double allot_samples, allot_error;
    const PilotResult *told; /* that trial pixels need not tell again; NULL: there is none */
    PilotResult *tells;      /* that they become known by; NULL: nobody wants to know */
    int split;            /* cones per pixel side where explicit edges cross the pixel */
    double volume_rays;     /* that the light pass of volumes has shot, and */
    double volume_error;    /* the RMSE to be expected of what it kept; negative: not known */
    bool volume_light_kept; /* from the frame before */
    int trials;           /* blocks of trial pixels drawn for this picture */
    double build_seconds;
    Box3 exact_bounds;    /* of the skins that beams draw, those of `rigid` not counted */
    double all_exact_to;  /* the least exact_to of all skins, 0 of those that are voxels alone */
    double least_tile;    /* the smallest of the skins' tiles, scene units; VTS_INFINITY: there are none */
    double nearest;       /* nearer to the eye than this nothing is drawn by beams */
    const struct RadiosityKept *radiosity; /* radiosity.h; NULL: surfaces send each other no light */
    double voxel_error;   /* expected RMSE of pixels at the distance all_exact_to that are drawn from voxels, falling with it; of the whole picture where auto has chosen
                           * voxels alone; < 0: not known */
} CompiledScene;

typedef enum CompileStatus { COMPILE_OK, COMPILE_FAILED /* see diags */, COMPILE_INTERRUPTED } CompileStatus;

/* `arena` owns the result but for the voxels and hierarchies: compiled_scene_destroy() releases those. */
CompileStatus compile_scene(const Scene *scene, const CompileOptions *options, Arena *arena, DiagList *diags, CompiledScene *out);
void compiled_scene_destroy(CompiledScene *compiled);
/* A skin whose bounds a ray meets, from t on. */
typedef struct SkinMet {
    uint32_t skin;
    double t;
} SkinMet;
/* The skins whose bounds the ray meets between t = 0 and t_max, by t, then by number. `met` has room for all skins; returns how many. */
size_t compiled_skins_met(const CompiledScene *compiled, const Ray *ray, double t_max, SkinMet *met);
void compiled_scene_print(const CompiledScene *compiled, StrBuf *out);

/* ---- parts, for compile.c ---- */

/* Cells, and what lies on them; of the texels only their looks. skin_build.c */
bool skin_compile(const Skin *skin, CompiledScene *compiled, DiagList *diags, CompiledSkin *out);
/* The longest cells that show all that changes along the skin: 0 where no length is told, HUGE_VAL where nothing changes. */
double skin_longest_cell(const Skin *skin);
/* The side of a tile of the skin's texels, scene units: area of the surface against that of its tiles; 0 where there are none. beam_plan.c */
double skin_tile_size(const CompiledSkin *skin);
/* Tells the skin's texels how fine they are seen where they are nearest. skin_resolution.c */
void skin_ask_triangles(CompiledSkin *skin, const CompiledScene *compiled);
/* Asks them for the resolution that the view can see where voxels are drawn. skin_resolution.c */
void skin_ask_voxels(CompiledSkin *skin, const CompileOptions *options, const CompiledScene *compiled);
/* When the texels are built: what only they tell, and the hierarchy over the cells. False when Embree is out of memory. */
bool skin_finish(CompiledSkin *skin, const CompileOptions *options, CompiledScene *compiled);
/* Lays a family down as the next of the skin's texels, if there is anything in it: its seed, share and look, those of texel `index` of the scene's skin.
 * How copies lie is left to the caller. skin_build.c */
PlacedTexel *skin_place_family(CompiledSkin *skin, size_t index, const TexelDef *const *defs, size_t count, CompiledScene *compiled);
/* The same by wang.h, for families of texels that are cyclic; false, after a warning, for others. skin_wang.c */
bool skin_place_wang(CompiledSkin *skin, size_t index, const TexelDef *const *defs, size_t count, CompiledScene *compiled, DiagList *diags);
/* The texel of a definition, made known at the first time; looks alone. */
BuiltTexel *texel_ask(const TexelDef *def, CompiledScene *compiled);
/* When all skins have asked: how fine triangles and voxels are, in powers of two where frames of films share them. skin_resolution.c */
void texels_settle_triangles(CompiledScene *compiled);
void texels_settle_voxels(CompiledScene *compiled);
/* Its voxels, as fine as was settled; or its exact geometry, for the reference. */
bool texel_build(BuiltTexel *texel, const CompileOptions *options, CompiledScene *compiled, DiagList *diags);
/* Triangles for beams of the skin's texels, as far as they may be seen nearer than voxels are planned to begin (`everything`: all); false after a
 * diagnostic or when interrupted. beam_plan.c */
bool beam_build_skin(CompiledSkin *skin, bool everything, CompiledScene *compiled, DiagList *diags);
/* Whether there is so little of all skins that are not rigid that drawing them whole takes no longer than voxels would; they then have triangles for beams. False after a
 * diagnostic or when interrupted. beam_plan.c */
bool beam_build_whole(CompiledScene *compiled, DiagList *diags, bool *whole);
/* Up to which distance the skin is drawn as exact geometry; `everything`: to the last. After beam_build_skin. beam_plan.c */
void beam_plan_skin(CompiledSkin *skin, bool everything, CompiledScene *compiled);
/* Moves the distances at which voxels begin to where they are as right as max_error asks, by what a few pixels tell; sets voxel_error. When all
 * else is compiled. beam_pilot.c */
void beam_pilot(CompiledScene *compiled);
/* Shares max_error out among samples, sky and media, by what trial pixels tell; nothing where there is only one of them. When all else is
 * compiled. budget_trial.c */
void budget_trial(CompiledScene *compiled);
/* Voxels may make this part of the error that is accepted: the rest is left to noise, and to what differs from frame to frame. Where exact geometry would be
 * noisier than that error with all the samples it may have, they may make all of it. */
#define VOXELS_SHARE 0.6
/* What light on the ground is off by where it is drawn as terrain_view.c has it, of the same. */
#define TERRAIN_SHARE 0.75
/* Voxels are built for distances from this part of the planned one on. */
#define EARLIEST_VOXELS 0.4
/* Of the scene's knob `detail`. */
typedef enum Detail { DETAIL_AUTO, DETAIL_EXACT, DETAIL_VOXELS, DETAIL_SLAB } Detail;
/* How near triangles are to what they stand for, in texel space; and of how many a density is made, 0: as many as tell it well. */
typedef struct TexelFineness {
    double tolerance;
    size_t flakes;
} TexelFineness;
/* A layer's triangles in compiled->scratch; false after a diagnostic. */
bool texel_mesh_layer(const BuiltTexel *texel, const TexelLayer *layer, const TexelFineness *how, CompiledScene *compiled, DiagList *diags,
                      TexelMesh *mesh);
/* As TexelFineness; more triangles than `most` (0: any number) are not made. */
typedef struct ExactMaking {
    double tolerance;
    size_t flakes, most;
    Arena *arena; /* of the triangles; NULL: the compiled scene's */
} ExactMaking;
/* All matter of a texel as its source triangles, for the reference; false after a diagnostic, or silently where there would be too many. exact_build.c */
bool exact_build_texel(BuiltTexel *texel, const ExactMaking *how, CompiledScene *compiled, DiagList *diags);

#endif
