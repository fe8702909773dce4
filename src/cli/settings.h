/* What a command line asks for. */
#ifndef VTS_CLI_SETTINGS_H
#define VTS_CLI_SETTINGS_H

#include "vts.h"

typedef enum ProgressStyle { PROGRESS_AUTO, PROGRESS_BAR, PROGRESS_PLAIN, PROGRESS_NONE } ProgressStyle;

typedef struct PairList {
    VtsPair *items;
    size_t count;
} PairList;

typedef struct TextList {
    const char **items;
    size_t count;
} TextList;

/* Some of a film's frames: first, first + step, … up to last. */
typedef struct FrameRange {
    int first, last, step;
} FrameRange;

typedef struct FrameList {
    FrameRange *items;
    size_t count;
} FrameList;

/* A film: POV-Ray's animation loop, or what the scene's `animation` says; frames.h. */
typedef struct Animation {
    bool on;                     /* there is one */
    bool frames_given, first_clock_given, last_clock_given, cyclic_given; /* on the command line */
    bool timed;                  /* by fps; else seconds are the clock */
    bool first_only;             /* of its frames the first one is done */
    int first_frame, last_frame; /* that the clocks belong to */
    int step;                    /* from one frame that is done to the next */
    double subset_first,
        subset_last; /* that are done: numbers of frames or, below 1, shares of them all; 0: all */
    double first_clock, last_clock;
    double shutter;      /* the part of a frame's time that it is exposed */
    bool shutter_given;  /* on the command line */
    double fps;      /* 0: as the scene says */
    bool cyclic;     /* the last clock is that of the frame after the last */
    FrameList asked; /* --frames; none: the subset */
} Animation;

typedef struct Settings {
    const char *program; /* how errors call us: "vts render" */
    VtsOptions options;  /* pointers into the lists below are set by settings_finish() */
    TextList scenes;
    const char *output;         /* NULL: by the scene's name */
    const char *suffix;         /* of pictures whose name has none; ".png" */
    const char *save;           /* of texel: the file, or NULL */
    const char *report;         /* file, "-" for stdout, or NULL */
    const char *metrics, *diff; /* of compare; NULL: the usual ones, no picture */
    bool json;
    TextList methods;           /* of chart: "quadrature,ray_path", "volume.method=path,two_pass" */
    const char *axes;           /* of chart: "cpu_s,rmse", or NULL */
    TextList references;        /* of chart: one picture or two, or none */
    const char *keep;           /* of chart: a folder for its pictures, or NULL */
    int repeats;                /* of chart: renderings of each point; 0: 1 */
    ProgressStyle progress;
    bool verbose, quiet;        /* quiet: no warnings */
    bool help;
    int regions[2];             /* of farm: columns and rows that a picture is cut into; 0: it is not */
    int chunk, at_once;         /* of farm: frames of a job, tasks of an array that run together; 0: not said */
    bool dry_run;               /* of farm slurm */
    const char *script;         /* of farm slurm; NULL: by the scene's name */
    TextList sbatch;            /* options for it */
    TextList passed;            /* of farm: arguments that its jobs get as they are */
    bool scene_passed;          /* the scene's name is among them */
    double wait; /* of stitch: seconds for which the next part may be missing; 0: none */
    bool resume; /* pictures that are there are not drawn again */
    bool dumps; /* `dump` was given */
    VtsDump dump;
    bool output_as_povray; /* from +O: a folder or a name without suffix is completed */
    double rows[2],
        columns[2]; /* POV-Ray's partial picture: numbers from 1, or shares below 1; 0: not given */
    Animation animation;
    PairList declares, limits, knobs, sweeps;
    TextList includes, read_folders, write_folders;
    char **owned; /* texts that the settings free */
    size_t owned_count;
} Settings;

void settings_init(Settings *settings, const char *program);
void settings_free(Settings *settings);

void settings_add(TextList *list, const char *text);
void settings_add_frames(Settings *settings, FrameRange range);
/* "NAME=VALUE"; false when there is no name or no '='. */
bool settings_add_pair(Settings *settings, PairList *list, const char *text);
/* A copy of `size` bytes that lives as long as the settings. */
const char *settings_copy(Settings *settings, const char *text, size_t size);

/* Makes `options` complete. NULL, or what is wrong. */
const char *settings_finish(Settings *settings);

/* The same without a film's numbers. */
const char *settings_output_name(Settings *settings, const char *scene);
/* Where the picture of a scene goes: what was asked for, else the scene's name in the working folder; in a film as
 * film_output() says. */
const char *settings_output(Settings *settings, const char *scene);

#endif
