/* What the program shows while it works: diagnostics, the scene's own texts, progress. One Console owns the terminal's
 * last line, so that a bar and a text never mix. */
#ifndef VTS_CLI_CONSOLE_H
#define VTS_CLI_CONSOLE_H

#include "cli/settings.h"

typedef struct Console {
    ProgressStyle style; /* never PROGRESS_AUTO */
    bool terminal;       /* stderr is one that understands control sequences */
    bool verbose;
    bool dumping;     /* VTS_STREAM_STATISTICS is the result and goes to stdout */
    bool bar_shown;   /* the last line holds a bar */
    bool within_line; /* the last text did not end its line: no bar now */
    bool diagnostics_shown;
    bool unwarned;      /* warnings are dropped */
    bool quiet;         /* the scene has spoken before: its texts and diagnostics are dropped */
    char part[48];      /* of a larger work, before each stage: "3/12 " */
    long long works, works_done; /* pictures of a film that are wanted, and drawn or found so far; 0: no film */
    double works_start_s, work_start_s;
    long long works_drawn;
    char stage[64];       /* that progress was last told of */
    double stage_start_s; /* on a monotonic clock */
    double last_drawn_s;
    int last_tenth; /* of the stage, for plain progress */
} Console;

void console_init(Console *console, const Settings *settings);
/* Sets the callbacks, their context and the colours of `options`. */
void console_attach(Console *console, VtsOptions *options);
/* Removes the bar: before any other text, and at the end. */
void console_clear(Console *console);
/* A line of our own on stderr when --verbose was given. */
void console_note(Console *console, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* What follows are so many pictures, of which the time left over is told as well. Each is begun and ended, or skipped. */
void console_expect_works(Console *console, long long count);
void console_begin_work(Console *console);
void console_end_work(Console *console);
void console_skip_work(Console *console);

/* Seconds on a monotonic clock. */
double console_now(void);

#endif
