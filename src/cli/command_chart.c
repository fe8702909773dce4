/* vts chart: renders a scene with several settings, and tells what each costs and how far off it is. */
#include "cli/chart.h"
#include "cli/command.h"
#include "cli/complaint.h"
#include "cli/frames.h"
#include "cli/interrupt.h"
#include "cli/report_file.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A noise above this share of the smallest error is worth a warning. */
static const double NOTICEABLE_NOISE = 0.2;

typedef struct Work {
    Settings *settings;
    Console console;
    Chart chart;
    VtsReference *reference;
    const char *plot, *csv; /* paths */
} Work;

/* A call of a session, for command_with_session(). */
typedef struct ReferenceCall {
    const char *scene, *paths[2];
    VtsReference **reference;
} ReferenceCall;
typedef struct PointCall {
    const char *scene, *picture;
    const VtsReference *reference;
    VtsMeasure *measure;
} PointCall;

static VtsStatus make_reference(VtsSession *session, const void *context) {
    const ReferenceCall *call = context;
    return vts_reference_make(session, call->scene, call->paths, call->reference);
}

static VtsStatus measure(VtsSession *session, const void *context) {
    const PointCall *call = context;
    return vts_measure(session, call->scene, call->reference, call->picture, call->measure);
}

/* ---- files ---- */

static const char *with_suffix(Settings *settings, const char *path, const char *suffix) {
    char text[PATH_MAX];
    const char *dot = strrchr(path, '.'), *slash = strrchr(path, '/');
    int stem = dot && (!slash || dot > slash) ? (int)(dot - path) : (int)strlen(path);
    int length = snprintf(text, sizeof text, "%.*s%s", stem, path, suffix);
    return length > 0 && (size_t)length < sizeof text ? settings_copy(settings, text, (size_t)length) : NULL;
}

/* A name in the folder of --keep, out of characters that every file system takes; NULL without the option. */
static const char *kept(Settings *settings, const char *name) {
    char path[PATH_MAX];
    if (!settings->keep) return NULL;
    int folder = snprintf(path, sizeof path, "%s/", settings->keep);
    int length = folder < 0 ? -1 : snprintf(path, sizeof path, "%s/%s", settings->keep, name);
    if (length < 0 || (size_t)length >= sizeof path) return NULL;
    for (char *c = path + folder; *c; c++)
        if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._+-", *c)) *c = '_';
    return settings_copy(settings, path, (size_t)length);
}

static const char *picture_of(Settings *settings, const ChartPoint *p) {
    char name[256];
    if (!p->curve) return kept(settings, "plain.png");
    int size = p->method.name ? snprintf(name, sizeof name, "%s-%s", p->method.name, p->method.value) : 0;
    if (p->swept.name && size >= 0 && (size_t)size < sizeof name)
        size += snprintf(name + size, sizeof name - (size_t)size, "%s%s-%s", size ? "-" : "", p->swept.name, p->swept.value);
    if (size < 0 || (size_t)size + 5 > sizeof name) return NULL;
    strcat(name, ".png");
    return kept(settings, name);
}

static int choose_places(Work *w) {
    Settings *settings = w->settings;
    settings->suffix = ".svg";
    w->plot = settings_output(settings, w->chart.scene);
    w->csv = with_suffix(settings, w->plot, ".csv");
    if (!chart_terminal(w->plot)) return complain_usage(settings, "'%s': the plot's name must end in .svg, .png or .pdf", w->plot);
    if (!w->csv || !report_file_possible(settings, w->plot) || !report_file_possible(settings, w->csv)) return VTS_ERROR_FILE;
    if (settings->keep && mkdir(settings->keep, 0777) != 0 && errno != EEXIST) {
        complain(settings, "cannot make the folder '%s': %s", settings->keep, strerror(errno));
        return VTS_ERROR_FILE;
    }
    return 0;
}

/* ---- measuring ---- */

static int load_reference(Work *w) {
    char why[1024];
    const TextList *given = &w->settings->references;
    const char *paths[2] = {given->items[0], given->count > 1 ? given->items[1] : NULL};
    VtsStatus status = vts_reference_load(paths, &w->reference, why, sizeof why);
    if (status != VTS_OK) complain(w->settings, "%s", why);
    return (int)status;
}

static int find_reference(Work *w) {
    if (w->settings->references.count) return load_reference(w);
    ReferenceCall call = {w->chart.scene, {kept(w->settings, "reference-1.exr"), kept(w->settings, "reference-2.exr")}, &w->reference};
    w->chart.rays = 2 * ((w->settings->options.reference_samples + 1) / 2);
    const char *type = w->settings->options.float_type;
    w->settings->options.float_type = "float";
    int status = command_with_session(w->settings, &w->console, w->chart.scene, make_reference, &call);
    w->settings->options.float_type = type;
    return status;
}

/* The settings of the command line, and the point's over them. */
static VtsPair *settings_of(const PairList *knobs, const ChartPoint *point, size_t *count) {
    VtsPair *pairs = malloc((knobs->count + 2) * sizeof *pairs);
    if (!pairs) return NULL;
    *count = knobs->count;
    if (*count) memcpy(pairs, knobs->items, *count * sizeof *pairs);
    if (point->method.name) pairs[(*count)++] = point->method;
    if (point->swept.name) pairs[(*count)++] = point->swept;
    return pairs;
}

/* Once more, from nothing; the times of the fastest are kept. */
static int measure_once(Work *w, ChartPoint *point, bool first) {
    VtsMeasure got;
    PointCall call = {w->chart.scene, first ? point->picture : NULL, w->reference, &got};
    int status = command_with_session(w->settings, &w->console, w->chart.scene, measure, &call);
    if (status != VTS_OK) return status;
    ChartPoint other = {.measure = got};
    if (first || chart_seconds(&other) < chart_seconds(point)) point->measure = got;
    return VTS_OK;
}

static int measure_point(Work *w, size_t index) {
    ChartPoint *point = &w->chart.points[index];
    VtsOptions *options = &w->settings->options;
    size_t count = 0;
    VtsPair *pairs = settings_of(&w->settings->knobs, point, &count);
    if (!pairs) return VTS_ERROR_MEMORY;
    point->picture = picture_of(w->settings, point);
    options->settings = pairs;
    options->setting_count = count;
    snprintf(w->console.part, sizeof w->console.part, "%zu/%zu ", index + 1, w->chart.count);
    int status = VTS_OK;
    for (int i = 0; i < w->settings->repeats && status == VTS_OK; i++) status = measure_once(w, point, i == 0);
    options->settings = w->settings->knobs.items;
    options->setting_count = w->settings->knobs.count;
    free(pairs);
    return status;
}

static int measure_all(Work *w) {
    int status = find_reference(w);
    if (status == VTS_OK) w->chart.noise = vts_reference_noise(w->reference);
    /* What the scene says it says once: of the reference, or of the first point. */
    w->console.quiet = w->settings->references.count == 0;
    for (size_t i = 0; i < w->chart.count && status == VTS_OK; i++) {
        status = measure_point(w, i);
        w->console.quiet = true;
    }
    console_clear(&w->console);
    return status;
}

/* ---- telling ---- */

static void judge_noise(const Work *w) {
    double least = chart_least_error(&w->chart);
    size_t below = 0;
    for (size_t i = 0; i < w->chart.count; i++) below += w->chart.points[i].measure.rmse <= 0;
    if (below) complain_warning(w->settings, "%zu of the points are nearer to the reference than its noise and not drawn", below);
    if (w->chart.noise > NOTICEABLE_NOISE * least && least > 0)
        complain_warning(w->settings, "the noise of the reference, RMSE %.2g, is more than a fifth of the smallest error, %.2g; more --samples make it less",
                         w->chart.noise, least);
}

static int write_results(const Work *w) {
    char *csv = chart_csv(&w->chart, w->settings), *script = chart_script(&w->chart, w->settings, chart_terminal(w->plot));
    int status = !csv || !script ? VTS_ERROR_MEMORY : report_file_write(w->settings, w->csv, csv) ? VTS_OK : VTS_ERROR_FILE;
    if (status == VTS_OK && chart_least_error(&w->chart) > 0) { /* a logarithm has room for something */
        PlotStatus plot = chart_plot(w->settings, script, w->plot);
        if (plot == PLOT_FAILED) status = VTS_ERROR_FILE;
        if (plot == PLOT_NO_PROGRAM) fprintf(stderr, "%s: note: gnuplot, which draws the plot, was not found; the numbers are in '%s'\n", w->settings->program, w->csv);
    }
    free(csv);
    free(script);
    return status;
}

/* The points as a table, the fastest of each curve and all. */
static void print_table(const Chart *chart) {
    printf("%-34s %9s %10s %8s %8s %12s\n", "", "CPU s", "RMSE", "PSNR", "FLIP", "voxels");
    for (size_t i = 0; i < chart->count; i++) {
        const ChartPoint *p = &chart->points[i];
        char name[200];
        snprintf(name, sizeof name, "%s%s%s", p->curve ? p->curve : "", p->curve ? ": " : "", p->label);
        printf("%-34s %9.3f %10.6f %8.2f %8.4f %12llu%s\n", name, chart_seconds(p), p->measure.rmse, p->measure.difference.psnr,
               p->measure.difference.flip, p->measure.voxels_visited, p->on_front ? "  on the front" : "");
    }
}

static int chart(Work *w) {
    int status = chart_plan(w->settings, &w->chart);
    if (status == 0) status = choose_places(w);
    if (status == 0) status = measure_all(w);
    if (status != 0) return status;
    chart_find_front(&w->chart);
    judge_noise(w);
    print_table(&w->chart);
    return write_results(w);
}

static VtsStatus enter_first(VtsSession *session, const void *context) {
    const Work *w = context;
    return film_enter_first(session, w->settings, w->chart.scene);
}

int command_chart(Settings *settings) {
    if (settings->scenes.count == 0) return complain_usage(settings, "no scene given");
    if (settings->scenes.count > 1)
        return complain_usage(settings, "one scene at a time, not also '%s'", settings->scenes.items[1]);
    if (settings->repeats == 0) settings->repeats = 1;
    Work work = {.settings = settings, .chart = {.scene = settings->scenes.items[0], .noise = -1}};
    console_init(&work.console, settings);
    int status = command_with_session(settings, &work.console, work.chart.scene, enter_first, &work);
    if (status == VTS_OK) status = chart(&work);
    chart_free(&work.chart);
    vts_reference_free(work.reference);
    return status;
}
