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

/* POV-Ray's animation loop. */
typedef struct Animation {
    bool on;
    int first_frame, last_frame; /* that the clocks belong to */
    int step;                    /* from one frame that is done to the next */
    double subset_first,
        subset_last; /* that are done: numbers of frames or, below 1, shares of them all; 0: all */
    double first_clock, last_clock;
    bool cyclic; /* the last clock is that of the frame after the last */
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
    const char *methods;        /* of chart: "quadrature,ray_path", or NULL */
    TextList references;        /* of chart: one picture or two, or none */
    const char *keep;           /* of chart: a folder for its pictures, or NULL */
    int repeats;                /* of chart: renderings of each point; 0: 1 */
    ProgressStyle progress;
    bool verbose;
    bool help;
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
/* "NAME=VALUE"; false when there is no name or no '='. */
bool settings_add_pair(Settings *settings, PairList *list, const char *text);
/* A copy of `size` bytes that lives as long as the settings. */
const char *settings_copy(Settings *settings, const char *text, size_t size);

/* Makes `options` complete. NULL, or what is wrong. */
const char *settings_finish(Settings *settings);

/* The frames to do: 1 to 1 without an animation. */
void settings_frames(const Settings *settings, int *first, int *last);
/* Sets the options for one of them. */
void settings_enter_frame(Settings *settings, int frame);

/* Where the picture of a scene goes: what was asked for, else the scene's name in the working folder; in an animation with
 * the frame's number before the suffix, as wide as the last one's. */
const char *settings_output(Settings *settings, const char *scene);

#endif
