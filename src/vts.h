/* vts: scenes of grass, forest, fur and cloud, from a script. The public C API.
 *
 *   #include <vts.h>
 *   int main(void) {
 *       VtsOptions options = vts_options_default();
 *       options.width = 320;
 *       options.height = 240;
 *       VtsSession *session = vts_session_create(&options, NULL);
 *       VtsStatus status = vts_render(session, "lawn.vts", "lawn.png");
 *       if (status != VTS_OK) fputs(vts_diagnostics(session), stderr);
 *       vts_session_destroy(session);
 *       return status;
 *   }
 *
 * No global state: sessions are independent; one session is used by one thread at a time (it starts its own workers).
 * Nothing here prints or exits: text goes to the callbacks of VtsOptions, errors into vts_diagnostics() and the status. */
#ifndef VTS_H
#define VTS_H

#include <stdbool.h>
#include <stddef.h>

#if defined(__GNUC__)
#define VTS_API __attribute__((visibility("default")))
#else
#define VTS_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The exit statuses of the program. */
typedef enum VtsStatus {
    VTS_OK = 0,
    VTS_ERROR_SCENE = 1,        /* the scene is wrong: anything located in its text */
    VTS_ERROR_USAGE = 2,        /* an option has no meaning or no valid value */
    VTS_ERROR_FILE = 3,         /* the named file, or the output, could not be read or written */
    VTS_ERROR_MEMORY = 4,       /* the memory limit was hit */
    VTS_INTERRUPTED = 130       /* vts_interrupt() */
} VtsStatus;

typedef enum VtsStream { VTS_STREAM_DEBUG, VTS_STREAM_WARNING, VTS_STREAM_RENDER, VTS_STREAM_STATISTICS } VtsStream;

typedef struct VtsPair {
    const char *name, *value;
} VtsPair;

/* All strings are borrowed: they must live as long as the session. */
typedef struct VtsOptions {
    int width, height;               /* of the picture; default 768 × 576 */
    int threads;                     /* 0: all processors */
    double clock;                    /* the language's `clock`; default 0 */
    bool clock_set;                  /* clock was given */
    int frame, first_frame, last_frame; /* `frame_number` and the like; default 1, 1, 1: no film, they read as 0 */
    double first_clock, last_clock;  /* `initial_clock`, `final_clock`; default 0, 1 */
    double clock_delta;              /* from one frame to the next; default 1 */
    double time;                     /* in seconds, what winds run by, if time_set; else it is the clock */
    bool time_set;
    double fps;                      /* by which `time` follows from the frame, counted from the first one; default 0: it does not */
    double shutter_clock, shutter_time; /* how far clock and time go while the picture is exposed; default 0: not at all */
    double cycle;                    /* seconds after which a film begins again; default 0: it does not */
    unsigned long long seed;         /* for sampling */
    double max_error;                /* RMSE a user accepts; 0: what the scene says, else 1/255 */
    int samples;                     /* a pixel where it needs several, 1 to 256; 0: by max_error */
    int reference_samples;           /* rays of a pixel of vts_reference(), 1 to 65536; default 64 */
    double exposure;                 /* EV, the picture is multiplied by 2^exposure */
    bool resume;                     /* tiles of this picture that another vts_render() or vts_reference() left unfinished are taken over */
    bool alpha;                      /* transparent background */
    const char *preview;             /* "host:port" of a viewer that speaks tev's protocol; NULL: none. One that does not answer is warned of */
    const char *aovs;                /* further channels of EXR pictures, "depth,normal"; NULL: none */
    int region[4];                   /* x0, y0, x1, y1 (x1, y1 exclusive) in pixels; all 0: the whole picture */
    size_t memory_limit;             /* bytes; 0: none */
    const char *cache_dir;           /* built texels are kept there from one run to the next; NULL: nowhere */
    const char *const *include_dirs; /* searched in order after the including file's folder */
    size_t include_dir_count;
    const char *stdlib_dir;          /* NULL: found beside the program or as installed */
    const char *program_dir;         /* folder of the running program, for finding stdlib and the picture module; may be NULL */
    const VtsPair *declares;         /* NAME=VALUE; a value that is a number is a float, else a string */
    size_t declare_count;
    const VtsPair *limits;           /* --limit NAME=N */
    size_t limit_count;
    const VtsPair *settings;         /* --set KNOB=VALUE */
    size_t setting_count;
    const char *const *allow_read;   /* folders that scenes may read besides their own and the include path */
    size_t allow_read_count;
    const char *const *allow_write;  /* folders that scenes may write */
    size_t allow_write_count;
    const char *float_type;          /* "half" or "float" for EXR output; NULL: half */
    /* Called with the text of #debug, #render, #statistics and #warning as it is printed. NULL: dropped. */
    void (*on_text)(void *context, VtsStream stream, const char *text);
    /* Called with the complete text of each diagnostic (with excerpt and notes) at the end of the stage that found it. */
    void (*on_diagnostic)(void *context, const char *text, bool is_error);
    /* Called often during long work, from one thread at a time. */
    void (*on_progress)(void *context, const char *stage, size_t done, size_t total);
    void *context;
    bool colour;                     /* ANSI colours in diagnostics */
    bool unreported;                 /* nobody asks for vts_report(): nothing is done for it alone */
} VtsOptions;

typedef enum VtsDump { VTS_DUMP_TOKENS, VTS_DUMP_AST, VTS_DUMP_SCENE, VTS_DUMP_TAPE, VTS_DUMP_COMPILED } VtsDump;

typedef struct VtsSession VtsSession;

VTS_API VtsOptions vts_options_default(void);
VTS_API const char *vts_version(void);

/* NULL when an option's value is out of range or memory is short; *error (if not NULL) then says why (static text). */
VTS_API VtsSession *vts_session_create(const VtsOptions *options, const char **error);
VTS_API void vts_session_destroy(VtsSession *session);

/* Reads and evaluates; what a scene writes stays in memory. */
VTS_API VtsStatus vts_check(VtsSession *session, const char *scene_path);
/* Evaluates as a program: #debug and file writes happen. */
VTS_API VtsStatus vts_run(VtsSession *session, const char *scene_path);
/* Renders to `output_path`, whose suffix names the format. The file appears whole or not at all. */
VTS_API VtsStatus vts_render(VtsSession *session, const char *scene_path, const char *output_path);

/* What the scene's `animation` says. */
typedef struct VtsFilm {
    bool exists; /* the scene has one */
    bool wrong;  /* the scene fails before it can be told; vts_check() tells why */
    int frames;  /* counted from 1 */
    double fps, first_clock, last_clock;
    bool cyclic; /* last_clock is that of the frame after the last */
    double shutter;
} VtsFilm;
/* Reads the scene, silently, as far as its `animation`. A scene that is wrong has none. */
VTS_API VtsStatus vts_film(VtsSession *session, const char *scene_path, VtsFilm *out);
/* The calls after this one are about another frame: takes over `frame` to `cycle` from the options, and forgets texts and names. What
 * has been built is kept, and used again where it comes out the same; warnings are told once; vts_report() has all frames so far. */
VTS_API void vts_set_frame(VtsSession *session, const VtsOptions *frame);

/* The same scene with nothing prefiltered, for measuring vts_render() by: exact geometry inside the texels, rays of no width,
 * hard shadows. Takes long. */
VTS_API VtsStatus vts_reference(VtsSession *session, const char *scene_path, const char *output_path);
/* Evaluates (as vts_check) and passes the printed form of one stage to on_text(VTS_STREAM_STATISTICS). */
VTS_API VtsStatus vts_dump(VtsSession *session, const char *scene_path, VtsDump stage);

/* Builds the texel that `name` was declared as ("Grass", "Trees[2]"), as finely as it asks for (128 if it leaves that open), whatever
 * is seen of it. `save_path` (or NULL) gets it as a .vtx file, `picture_path` (or NULL) a picture of it alone. vts_report() is then a
 * table as text. VTS_ERROR_USAGE when there is no such texel. */
VTS_API VtsStatus vts_texel(VtsSession *session, const char *scene_path, const char *name, const char *save_path, const char *picture_path);

/* What is in a file: a map of heights, a texel, a volume, a geoid or a picture. vts_report() is then that as lines of text or, if `json`, as
 * one JSON object. VTS_ERROR_FILE when it is none of these. */
VTS_API VtsStatus vts_info(VtsSession *session, const char *path, bool json);

typedef struct VtsDifference {
    int width, height;
    double rmse;       /* over pixels and channels, linear light clamped to [0,1] */
    double psnr;       /* dB, after the sRGB curve; infinite for equal pictures */
    double flip;       /* mean of FLIP (Andersson et al. 2020) at 67 pixels per degree, in [0,1] */
    double largest;    /* largest difference of a sample, linear and clamped */
    int x, y;          /* where that is */
    size_t not_finite; /* samples that are infinite or NaN in either picture */
} VtsDifference;
/* Compares two pictures; VTS_ERROR_USAGE when their sizes differ. `map_path`, if not NULL, gets the map of FLIP's errors: as numbers in .exr and .pfm, else in
 * colours. When it fails, `error` (if not NULL) holds one line of text. */
VTS_API VtsStatus vts_compare(const char *reference_path, const char *test_path, const char *map_path, VtsDifference *out,
                              char *error, size_t error_size);

/* Joins pictures that were drawn with options.region, of one scene, frame and size, into the one that would have been drawn without: the
 * same pixels in all channels. Parts may overlap. VTS_ERROR_USAGE when parts are missing or belong to another picture; VTS_ERROR_FILE when
 * a file cannot be read or written. When it fails, `error` (if not NULL) holds one line of text. */
VTS_API VtsStatus vts_stitch(const char *const *part_paths, size_t count, const char *output_path, char *error, size_t error_size);

/* Makes an animated GIF of pictures of equal size and 8 bits, each shown for 1/fps seconds, as near as hundredths come to it. VTS_ERROR_USAGE
 * without pictures or for fps that is not above 0. When it fails, no file is left, and `error` (if not NULL) holds one line of text. */
VTS_API VtsStatus vts_make_gif(const char *const *picture_paths, size_t count, double fps, const char *output_path, char *error, size_t error_size);

/* What renderings are measured by: a picture in memory, and how noisy it is. */
typedef struct VtsReference VtsReference;

/* Draws two references with half of options.reference_samples each (at least one ray) and different seeds, and keeps their mean, and their
 * difference as the measure of its noise. paths[0] and paths[1] (or NULL) get the two. *out is the caller's, NULL on failure. */
VTS_API VtsStatus vts_reference_make(VtsSession *session, const char *scene_path, const char *const paths[2], VtsReference **out);
/* The same from two pictures drawn before; or of one, paths[1] being NULL, whose noise is then not known. When it fails, `error` (if not
 * NULL) holds one line of text. */
VTS_API VtsStatus vts_reference_load(const char *const paths[2], VtsReference **out, char *error, size_t error_size);
VTS_API void vts_reference_free(VtsReference *reference);
/* RMSE of the reference against one without noise; negative: not known. */
VTS_API double vts_reference_noise(const VtsReference *reference);

/* One rendering: its time in seconds, wall clock and user time of all threads, what it counted, and how far off it is. */
typedef struct VtsMeasure {
    double parse_wall_s, build_wall_s, render_wall_s;
    double parse_user_s, build_user_s, render_user_s;
    unsigned long long camera_rays, shadow_rays, steps, voxels_visited; /* the same on every machine */
    size_t texel_bytes;
    VtsDifference difference;
    double rmse; /* difference.rmse without the reference's noise: the root of the difference of squares, 0 where that is below the noise */
    double flicker; /* RMS over pixels and channels of the change of (picture - reference) since the frame that this session measured before, the
                     * noise of both references in it; negative: there was none */
} VtsMeasure;

/* Renders as vts_render() does and compares with the reference; `picture_path` (or NULL) gets the picture. To be called with a session that
 * has built nothing yet, or what it has kept is not measured. VTS_ERROR_USAGE when the reference has another size. */
VTS_API VtsStatus vts_measure(VtsSession *session, const char *scene_path, const VtsReference *reference, const char *picture_path,
                              VtsMeasure *out);

/* Whether VtsOptions.settings may hold this pair: VTS_OK, or VTS_ERROR_USAGE with a line of text in `error` (if not NULL). */
VTS_API VtsStatus vts_setting_check(const char *knob, const char *value, char *error, size_t error_size);
/* The values of a knob that has names for them, the default first, ended by NULL; NULL for any other knob. */
VTS_API const char *const *vts_setting_values(const char *knob);

/* All diagnostics so far as text; "" when none. Valid until the next call with this session. */
VTS_API const char *vts_diagnostics(const VtsSession *session);
/* The report of the last vts_render() or vts_reference() as JSON (--report), vts_texel()'s table, or what vts_info() tells; "" before. Valid until the next call. */
VTS_API const char *vts_report(const VtsSession *session);
/* From any thread or a signal handler: the running call stops soon and returns VTS_INTERRUPTED. */
VTS_API void vts_interrupt(VtsSession *session);

#ifdef __cplusplus
}
#endif
#endif
