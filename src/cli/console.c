#include "cli/console.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

static const double REDRAW_S = 0.1;

double console_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

void console_init(Console *console, const Settings *settings) {
    const char *term = getenv("TERM");
    bool terminal = isatty(STDERR_FILENO) && term && strcmp(term, "dumb") != 0;
    ProgressStyle style = settings->progress;
    if (style == PROGRESS_AUTO) style = terminal ? PROGRESS_BAR : PROGRESS_NONE;
    *console = (Console){
        .style = style, .terminal = terminal, .verbose = settings->verbose, .unwarned = settings->quiet, .dumping = settings->dumps};
}

void console_clear(Console *console) {
    if (console->bar_shown) fputs("\r\033[K", stderr);
    console->bar_shown = false;
}

void console_note(Console *console, const char *format, ...) {
    if (!console->verbose) return;
    va_list args;
    va_start(args, format);
    console_clear(console);
    vfprintf(stderr, format, args);
    fputc('\n', stderr);
    va_end(args);
}

static void show_text(void *context, VtsStream stream, const char *text) {
    Console *console = context;
    size_t size = strlen(text);
    if (size == 0 || console->quiet) return;
    console_clear(console);
    fwrite(text, 1, size, console->dumping && stream == VTS_STREAM_STATISTICS ? stdout : stderr);
    console->within_line = text[size - 1] != '\n';
}

static void show_diagnostic(void *context, const char *text, bool is_error) {
    Console *console = context;
    size_t size = strlen(text);
    if (console->quiet || (console->unwarned && !is_error)) return; /* whoever fails tells what vts_diagnostics() has */
    console_clear(console);
    if (console->within_line) fputc('\n', stderr);
    console->within_line = false;
    console->diagnostics_shown = true;
    fputs(text, stderr);
    if (size == 0 || text[size - 1] != '\n') fputc('\n', stderr);
}

static int terminal_columns(void) {
    struct winsize size;
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
    return 80;
}

/* "1:05", or "2:10:00". */
static void format_time(char *out, size_t size, double seconds) {
    long all = lround(seconds < 359999 ? seconds : 359999);
    if (all >= 3600)
        snprintf(out, size, "%ld:%02ld:%02ld", all / 3600, all / 60 % 60, all % 60);
    else
        snprintf(out, size, "%ld:%02ld", all / 60, all % 60);
}

/* What the pictures of a film still take, as far as those tell that are drawn. */
static void film_left(const Console *console, double now, char *out, size_t size) {
    if (console->works_drawn == 0) return;
    double mean = (console->work_start_s - console->works_start_s) / (double)console->works_drawn;
    double left = mean * (double)(console->works - console->works_done) - fmin(mean, now - console->work_start_s);
    char time[24];
    format_time(time, sizeof time, fmax(left, 0));
    snprintf(out, size, ", %s in all", time);
}

void console_expect_works(Console *console, long long count) { console->works = count; }

void console_begin_work(Console *console) {
    console->work_start_s = console_now();
    if (console->works_drawn == 0) console->works_start_s = console->work_start_s;
    if (console->works) snprintf(console->part, sizeof console->part, "%lld/%lld ", console->works_done + 1, console->works);
}

void console_end_work(Console *console) {
    console_clear(console);
    console->works_done++;
    console->works_drawn++;
    console->stage[0] = '\0';
}

void console_skip_work(Console *console) { console->works_done++; }

static void draw_bar(Console *console, double share, double now) {
    enum { NARROWEST = 10, WIDEST = 40, LONGEST_LINE = 256 };
    double spent = now - console->stage_start_s;
    char left[64] = "";
    if (share > 0.01 && spent > 0.5) {
        format_time(left, sizeof left, spent * (1 - share) / share);
        strcat(left, " left");
    }
    film_left(console, now, left + strlen(left), sizeof left - strlen(left));
    int columns = terminal_columns();
    int room = columns - (int)strlen(console->part) - (int)strlen(console->stage) - (int)strlen(left) - 12;
    int cells = room < NARROWEST ? 0 : room > WIDEST ? WIDEST : room;
    char bar[WIDEST + 1];
    for (int i = 0; i < cells; i++) bar[i] = i < (int)(share * cells) ? '#' : '-';
    bar[cells] = '\0';
    char line[LONGEST_LINE];
    snprintf(line, sizeof line, "%s%s %3d %% %s%s%s %s", console->part, console->stage, (int)(share * 100), cells ? "[" : "",
             bar, cells ? "]" : "", left);
    fprintf(stderr, "\r\033[K%.*s", columns - 1, line);
    fflush(stderr);
    console->bar_shown = true;
    console->last_drawn_s = now;
}

static void begin_stage(Console *console, const char *stage, double now) {
    if (console->stage[0]) console_note(console, "%s: %.2f s", console->stage, now - console->stage_start_s);
    snprintf(console->stage, sizeof console->stage, "%s", stage);
    console->stage_start_s = now;
    console->last_drawn_s = 0;
    console->last_tenth = -1;
}

static void show_progress(void *context, const char *stage, size_t done, size_t total) {
    Console *console = context;
    double now = console_now();
    if (strncmp(stage, console->stage, sizeof console->stage - 1) != 0) begin_stage(console, stage, now);
    double share = total > 0 ? (double)done / (double)total : 0;
    if (share > 1) share = 1;
    if (console->style == PROGRESS_BAR && !console->within_line && now - console->last_drawn_s >= REDRAW_S) {
        draw_bar(console, share, now);
    } else if (console->style == PROGRESS_PLAIN && (int)(share * 10) > console->last_tenth) {
        console->last_tenth = (int)(share * 10);
        fprintf(stderr, "%s%s %d %%\n", console->part, console->stage, console->last_tenth * 10);
    }
}

void console_attach(Console *console, VtsOptions *options) {
    const char *no_colour = getenv("NO_COLOR");
    options->context = console;
    options->on_text = show_text;
    options->on_diagnostic = show_diagnostic;
    options->on_progress = show_progress;
    options->colour = console->terminal && !(no_colour && *no_colour);
}
