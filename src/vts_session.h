/* Inside of a session, for the files that make up the library's calls. */
#ifndef VTS_VTS_SESSION_H
#define VTS_VTS_SESSION_H

#include "vts.h"
#include "vts_moments.h"

#include "eval/eval.h"
#include "grow/spring_net.h"
#include "image/image.h"
#include "render/render.h"

#include <setjmp.h>

struct VtsSession {
    VtsOptions options;
    MemoryBudget memory;
    jmp_buf out_of_memory; /* valid while `guarded` */
    Pool *pool;
    char stage[64]; /* of the work that is being done */
    AovPlan aovs;
    struct Preview *preview;
    const char *scene_name; /* of the picture that is being drawn */
    TexelCache *texels; /* built and loaded, from one call to the next */
    Progress progress;
    atomic_bool interrupted; /* set from signal handlers and other threads */
    /* of the session */
    Arena arena;
    SourceSet sources;
    DiagList diags;
    Interner names;
    StrBuf stdlib, printed, report;
    const Diagnostic *last_printed;
    StrBuf frames;      /* of the report, so far */
    bool in_film, renew; /* vts_set_frame() was called; what the calls before have read is to be forgotten */
    bool probing;       /* nothing is told */
    double moment;      /* of the exposure, 0 to 1, that the scene is evaluated at; */
    bool audits;        /* pictures are audited, for the report */
    bool silent;        /* after the first one errors alone are told */
    /* of one call */
    Arena parse, scene_arena, compiled_arena;
    const Scene *scene;
    Scene scene_with_settings;
    CompiledScene compiled;
    Image picture;
    MomentMean blurred, scout; /* vts_shutter.c */
    struct VolumeMemo *volume_memo; /* of films, */
    struct ExactMemo *exact_memo;   /* likewise */
    PilotResult pilot;
    struct FilmPilot {
        bool told;            /* by this frame */
        int frame;
        PilotResult result;   /* not known where nothing of it was needed */
        TexelFrame *texels;   /* of it */
    } film_pilot;
    struct KeptStates *nets; /* followed so far; NULL: none */
    uint64_t key;   /* of the picture that is being drawn: session_key() */
    TileFile *kept; /* what is done of it; or NULL */
    const char *kept_at; /* and of pictures of moments: beside this picture; or NULL */
    double keeps_from;   /* moments, on the wall's clock */
    uint64_t tiles_taken; /* over from another run, of pictures of moments that are done */
    float *last_error; /* of the picture that vts_measure() drew last, NULL: none */
    int last_error_size[2];
    double started_wall, started_cpu;
};

typedef struct EvalMode {
    bool writes_in_memory, is_program, print_tokens, print_ast, ends_at_film;
} EvalMode;

/* Stages of a call. Those that return a status have told why it is not VTS_OK. */

/* vts_film.c: vts_film() without its guard. */
VtsStatus session_film(VtsSession *session, const char *scene_path, VtsFilm *out);

/* Evaluates the scene into session->scene. */
VtsStatus session_evaluate(VtsSession *session, const char *path, EvalMode mode);
/* Prepares session->scene for drawing, or for the reference (exact); texel_resolution: see CompileOptions. */
VtsStatus session_compile(VtsSession *session, bool exact, int texel_resolution);
/* What drawing a moment differs by from the usual: RenderOptions' noise and tiles. */
typedef struct MomentPlan {
    uint64_t seed;
    double noise;
    const bool *tiles;
    const int *region; /* NULL: as in the options */
    float *tile_noise;
    int samples;  /* 0: the usual */
    bool unseen;  /* by viewers */
    bool apart;   /* nothing of it is kept for other runs */
} MomentPlan;
/* Draws session->compiled into session->picture. */
VtsStatus session_draw(VtsSession *session, bool exact, const MomentPlan *plan, RenderStats *stats);
/* vts_shutter.c: the same over the time that the picture is exposed. Leaves scene and compiled scene of some moment of it. */
VtsStatus session_expose(VtsSession *session, const char *scene_path, bool exact, RenderStats *stats);
struct Preview *session_connect_preview(VtsSession *session);
/* vts_film.c: session_compile() of what is evaluated, with what one frame of each second tells for all of it. */
VtsStatus session_compile_frame(VtsSession *session, const char *scene_path, bool exact);
/* vts_shutter.c: evaluates once more, silently, and compiles. */
VtsStatus session_repeat(VtsSession *session, const char *scene_path, bool exact);

/* vts_nets.c: states of cloths and springs, kept in memory as long as each frame asks for them, and in the session's cache folder. */
NetStates session_net_states(VtsSession *session);
/* Before a frame: lets go what the last one did not ask for; all of it. */
void session_trim_nets(VtsSession *session, bool all);

/* Pixels of the picture that are wanted: x0, y0, x1, y1. */
void session_region(const VtsSession *session, int out[4]);
/* Whether the picture is exposed for more than a moment. */
bool session_is_blurred(const VtsSession *session);

/* vts_resume.c: a file beside the picture for what is done of it, closed by end of the call. */
void session_keep_tiles(VtsSession *session, const char *output_path);
/* Of blurred pictures: the same for the next of their moments, of the tiles that the region holds. */
void session_keep_moment(VtsSession *session, int moment, const int region[4]);
/* What the moments have made so far of such a picture, between two of them. */
typedef struct ExposureState {
    int *moments;
    bool *scouting;
    RenderStats *stats;
    MomentMean *mean, *scout;
} ExposureState;
/* Keeps it in another file, from time to time; takes it over from there, or leaves it as it is. */
void session_save_moments(VtsSession *session, const ExposureState *state, const int region[4]);
void session_restore_moments(VtsSession *session, const ExposureState *state, const int region[4]);
/* The picture is written, and the files go. */
void session_forget_tiles(VtsSession *session);

/* vts_stitch.c: of the texts that were read and of every option that pixels depend on, but the region. */
uint64_t session_key(const VtsSession *session, bool exact);
/* The picture says which part it is, if it is one. */
void session_mark_part(VtsSession *session);
VtsStatus session_save_picture(VtsSession *session, const char *scene_path, const char *output_path);
/* VTS_ERROR_FILE, reported, when the output is a file that the scene was read from. */
VtsStatus session_spare_sources(VtsSession *session, const char *output_path);
/* Tells that there is no picture, and why. */
VtsStatus session_file_error(VtsSession *session, const StrBuf *why);
/* Passes on what was found since the last time. */
void session_print_diagnostics(VtsSession *session);

/* vts_knobs.c: sets what --set KNOB=VALUE means; false with a line in `why` when it means nothing. */
bool knob_set(const char *name, const char *value, GlobalSettings *settings, StrBuf *why);

/* vts_compare.c: the difference of two pictures, and FLIP's map, which the caller frees; NULL with a line in `why`. */
float *difference_map(const Image *reference, const Image *test, VtsDifference *out, StrBuf *why);

/* vts_chart.c: an empty one, NULL without memory; vts_reference_make() and vts_measure() without their guards. */
VtsReference *reference_create(void);
VtsStatus session_make_reference(VtsSession *session, const char *scene_path, const char *const paths[2], VtsReference *reference);
VtsStatus session_measure(VtsSession *session, const char *scene_path, const VtsReference *reference, const char *picture_path,
                          VtsMeasure *out);

/* vts_texel.c: vts_texel() without its guard. */
VtsStatus session_texel(VtsSession *session, const char *scene_path, const char *name, const char *save_path,
                        const char *picture_path);

/* vts_info.c: vts_info() without its guard. */
VtsStatus session_info(VtsSession *session, const char *path, bool json);

#endif
