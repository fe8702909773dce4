/* vts chart: renders a scene with several settings, and tells what each costs and how far off it is. */
#include "cli/chart.h"
#include "cli/command.h"
#include "cli/complaint.h"
#include "cli/frames.h"
#include "cli/interrupt.h"
#include "cli/report_file.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
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
    VtsReference **references; /* of each frame; NULL: not needed yet */
    const char *plot, *csv; /* paths */
} Work;

/* One point, for command_with_session(). */
typedef struct PointCall {
    const Work *work;
    const char *picture;
    VtsMeasure *measure;
} PointCall;

/* ---- frames ---- */

/* Without a film the session stays what it is. */
static void enter(const Work *w, VtsSession *session, int frame) {
    film_enter(w->settings, w->settings->animation.on ? session : NULL, frame);
}

/* The name of a frame's picture, where there are several frames; NULL stays NULL. */
static const char *of_frame(const Work *w, const char *path) { return path && w->chart.frames > 1 ? film_output(w->settings, path) : path; }

/* Sums of squares where means of squares are wanted. */
typedef struct Sums {
    double squares, noise, coded, flicker, flicker_noise;
    long long pairs;
} Sums;

static double square(double x) { return x * x; }

static void add_frame(const Work *w, long long k, const VtsMeasure *m, VtsMeasure *sum, Sums *sums) {
    const VtsDifference *d = &m->difference;
    double noise = vts_reference_noise(w->references[k]), before = k ? vts_reference_noise(w->references[k - 1]) : 0;
    sum->parse_wall_s += m->parse_wall_s, sum->build_wall_s += m->build_wall_s, sum->render_wall_s += m->render_wall_s;
    sum->parse_user_s += m->parse_user_s, sum->build_user_s += m->build_user_s, sum->render_user_s += m->render_user_s;
    sum->camera_rays += m->camera_rays, sum->shadow_rays += m->shadow_rays;
    sum->steps += m->steps, sum->voxels_visited += m->voxels_visited;
    if (m->texel_bytes > sum->texel_bytes) sum->texel_bytes = m->texel_bytes;
    if (d->largest > sum->difference.largest) sum->difference.largest = d->largest;
    sum->difference.width = d->width, sum->difference.height = d->height;
    sum->difference.not_finite += d->not_finite;
    sum->difference.flip += d->flip / (double)w->chart.frames;
    sums->squares += square(d->rmse);
    sums->coded += pow(10, -d->psnr / 10);
    if (noise > 0) sums->noise += square(noise);
    if (m->flicker < 0) return;
    sums->flicker += square(m->flicker);
    sums->flicker_noise += square(fmax(noise, 0)) + square(fmax(before, 0));
    sums->pairs++;
}

static void finish_frames(const Work *w, const Sums *sums, VtsMeasure *sum) {
    double frames = (double)w->chart.frames;
    sum->difference.rmse = sqrt(sums->squares / frames);
    sum->difference.psnr = -10 * log10(sums->coded / frames);
    sum->rmse = sqrt(fmax(sums->squares - sums->noise, 0) / frames);
    sum->flicker = sums->pairs ? sqrt(fmax(sums->flicker - sums->flicker_noise, 0) / (double)sums->pairs) : -1;
}

/* All frames in one session, as a film is drawn. */
static VtsStatus measure(VtsSession *session, const void *context) {
    const PointCall *call = context;
    const Work *w = call->work;
    FrameCursor cursor = {0};
    Sums sums = {0};
    VtsStatus status = VTS_OK;
    *call->measure = (VtsMeasure){0};
    for (long long k = 0; status == VTS_OK && film_next(w->settings, &cursor); k++) {
        VtsMeasure one;
        enter(w, session, cursor.frame);
        status = vts_measure(session, w->chart.scene, w->references[k], of_frame(w, call->picture), &one);
        if (status == VTS_OK) add_frame(w, k, &one, call->measure, &sums);
    }
    finish_frames(w, &sums, call->measure);
    return status;
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
        if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._+-#", *c)) *c = '_';
    return settings_copy(settings, path, (size_t)length);
}

/* `film`: a name for pictures of frames. */
static const char *picture_of(Settings *settings, const ChartPoint *p, bool film) {
    const char *suffix = film ? "-####.png" : ".png";
    char name[256];
    if (!p->curve) return kept(settings, film ? "plain-####.png" : "plain.png");
    int size = p->method.name ? snprintf(name, sizeof name, "%s-%s", p->method.name, p->method.value) : 0;
    if (p->swept.name && size >= 0 && (size_t)size < sizeof name)
        size += snprintf(name + size, sizeof name - (size_t)size, "%s%s-%s", size ? "-" : "", p->swept.name, p->swept.value);
    if (size < 0 || (size_t)size + strlen(suffix) + 1 > sizeof name) return NULL;
    strcat(name, suffix);
    return kept(settings, name);
}

static int choose_places(Work *w) {
    Settings *settings = w->settings;
    settings->suffix = ".svg";
    w->plot = settings_output_name(settings, w->chart.scene);
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

static VtsStatus load_reference(Work *w, const char *const paths[2], VtsReference **out) {
    char why[1024];
    VtsStatus status = vts_reference_load(paths, out, why, sizeof why);
    if (status != VTS_OK) complain(w->settings, "%s", why);
    return status;
}

/* The pictures that are given, or those that --keep has left; else they are drawn. */
static VtsStatus find_reference(Work *w, VtsSession *session, VtsReference **out) {
    const TextList *given = &w->settings->references;
    bool film = w->chart.frames > 1;
    const char *names[2] = {kept(w->settings, film ? "reference-1-####.exr" : "reference-1.exr"), kept(w->settings, film ? "reference-2-####.exr" : "reference-2.exr")};
    if (given->count) names[0] = given->items[0], names[1] = given->count > 1 ? given->items[1] : NULL;
    const char *paths[2] = {of_frame(w, names[0]), of_frame(w, names[1])};
    bool left = w->settings->resume && w->chart.known && paths[0] && paths[1] && film_is_drawn(paths[0]) && film_is_drawn(paths[1]);
    return given->count || left ? load_reference(w, paths, out) : vts_reference_make(session, w->chart.scene, paths, out);
}

static VtsStatus find_all_references(VtsSession *session, const void *context) {
    Work *w = *(Work *const *)context;
    FrameCursor cursor = {0};
    VtsStatus status = VTS_OK;
    for (long long k = 0; status == VTS_OK && film_next(w->settings, &cursor); k++) {
        enter(w, session, cursor.frame);
        status = find_reference(w, session, &w->references[k]);
    }
    return status;
}

/* Of the mean over frames; negative: not known. */
static double noise_of(const Work *w) {
    double sum = 0;
    for (long long k = 0; k < w->chart.frames; k++) {
        double noise = vts_reference_noise(w->references[k]);
        if (noise < 0) return -1;
        sum += noise * noise;
    }
    return sqrt(sum / (double)w->chart.frames);
}

static int need_references(Work *w) {
    VtsOptions *options = &w->settings->options;
    if (w->references) return VTS_OK;
    w->references = calloc((size_t)w->chart.frames, sizeof(VtsReference *));
    if (!w->references) return VTS_ERROR_MEMORY;
    const char *type = options->float_type;
    options->float_type = "float";
    int status = command_with_session(w->settings, &w->console, w->chart.scene, find_all_references, &w);
    options->float_type = type;
    if (status == VTS_OK) w->chart.noise = noise_of(w);
    /* What the scene says it says once: of the reference, or of the first point. */
    w->console.quiet = w->settings->references.count == 0;
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
    PointCall call = {w, first ? point->picture : NULL, &got};
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

/* The text of a file, which the caller frees; NULL when there is none. */
static char *read_text(const char *path) {
    FILE *file = fopen(path, "r");
    char *text = NULL;
    size_t size = 0;
    ssize_t length = file ? getdelim(&text, &size, '\0', file) : -1;
    if (file) fclose(file);
    if (length >= 0) return text;
    free(text);
    return NULL;
}

/* Whether the numbers were written after the scene, whose includes are not looked at. */
static bool is_newer(const char *path, const char *scene) {
    struct stat numbers, text;
    if (stat(path, &numbers) != 0 || stat(scene, &text) != 0) return false;
    return numbers.st_mtim.tv_sec > text.st_mtim.tv_sec ||
           (numbers.st_mtim.tv_sec == text.st_mtim.tv_sec && numbers.st_mtim.tv_nsec >= text.st_mtim.tv_nsec);
}

static void take_over(Work *w) {
    char *text = w->settings->resume && is_newer(w->csv, w->chart.scene) ? read_text(w->csv) : NULL;
    if (!text) return;
    size_t done = chart_resume(&w->chart, w->settings, text);
    w->chart.known = done > 0;
    if (done) fprintf(stderr, "%s: note: %zu of %zu points are in '%s'\n", w->settings->program, done, w->chart.count, w->csv);
    free(text);
}

static int write_csv(const Work *w) {
    char *csv = chart_csv(&w->chart, w->settings);
    int status = !csv ? VTS_ERROR_MEMORY : report_file_write(w->settings, w->csv, csv) ? VTS_OK : VTS_ERROR_FILE;
    free(csv);
    return status;
}

/* After each point the numbers so far are written, for --resume. */
static int measure_all(Work *w) {
    int status = VTS_OK;
    for (size_t i = 0; i < w->chart.count && status == VTS_OK; i++) {
        ChartPoint *point = &w->chart.points[i];
        point->picture = picture_of(w->settings, point, w->chart.frames > 1);
        if (point->done || (status = need_references(w)) != VTS_OK) continue;
        status = measure_point(w, i);
        w->console.quiet = true;
        if (status != VTS_OK) break;
        point->done = true;
        status = write_csv(w);
    }
    console_clear(&w->console);
    return status;
}

/* ---- telling ---- */

static void judge_noise(const Work *w) {
    double least = chart_least_error(&w->chart);
    size_t below = 0;
    for (size_t i = 0; i < w->chart.count; i++) below += w->chart.y->value(&w->chart.points[i]) <= 0;
    if (below) complain_warning(w->settings, "%zu of the points are nearer to the reference than its noise and not drawn", below);
    if (w->chart.noise > NOTICEABLE_NOISE * least && least > 0)
        complain_warning(w->settings, "the noise of the reference, RMSE %.2g, is more than a fifth of the smallest error, %.2g; more --samples make it less",
                         w->chart.noise, least);
}

static int draw_plot(const Work *w) {
    if (!chart_is_drawn(&w->chart)) {
        complain_warning(w->settings, "no point has a place on axes that are logarithms: nothing is drawn; the numbers are in '%s'", w->csv);
        return VTS_OK;
    }
    char *script = chart_script(&w->chart, w->settings, chart_terminal(w->plot));
    if (!script) return VTS_ERROR_MEMORY;
    PlotStatus plot = chart_plot(w->settings, script, w->plot);
    if (plot == PLOT_NO_PROGRAM) fprintf(stderr, "%s: note: gnuplot, which draws the plot, was not found; the numbers are in '%s'\n", w->settings->program, w->csv);
    free(script);
    return plot == PLOT_FAILED ? VTS_ERROR_FILE : VTS_OK;
}

/* The points as a table, the fastest of each curve and all. */
static void print_table(const Chart *chart) {
    bool film = chart->frames > 1;
    printf("%-34s %9s %10s %8s %8s%s %12s\n", "", "CPU s", "RMSE", "PSNR", "FLIP", film ? "    flicker" : "", "voxels");
    for (size_t i = 0; i < chart->count; i++) {
        const ChartPoint *p = &chart->points[i];
        char name[200], flicker[32] = "";
        snprintf(name, sizeof name, "%s%s%s", p->curve ? p->curve : "", p->curve ? ": " : "", p->label);
        if (film) snprintf(flicker, sizeof flicker, " %10.6f", p->measure.flicker);
        printf("%-34s %9.3f %10.6f %8.2f %8.4f%s %12llu%s\n", name, chart_seconds(p), p->measure.rmse, p->measure.difference.psnr,
               p->measure.difference.flip, flicker, p->measure.voxels_visited, p->on_front ? "  on the front" : "");
    }
}

static int chart(Work *w) {
    int status = choose_places(w);
    if (status != 0) return status;
    w->chart.frames = film_count(w->settings);
    w->chart.options = chart_options(w->settings);
    if (w->settings->references.count == 0) w->chart.rays = 2 * ((w->settings->options.reference_samples + 1) / 2);
    if (strcmp(w->chart.y->name, "flicker") == 0 && w->chart.frames < 2) return complain_usage(w->settings, "flicker is between frames: --frames names two or more");
    take_over(w);
    status = measure_all(w);
    if (status != 0) return status;
    chart_find_front(&w->chart);
    judge_noise(w);
    print_table(&w->chart);
    status = write_csv(w);
    return status == VTS_OK ? draw_plot(w) : status;
}

/* ---- before ---- */

/* Values that the scene's blocks are to read: all of them in one go, each over the one before. */
static VtsStatus check_blocks(Work *w, VtsSession *session) {
    const PairList *knobs = &w->settings->knobs;
    bool any = false;
    for (size_t i = knobs->count; i < w->settings->options.setting_count; i++) any |= strchr(w->settings->options.settings[i].name, '.') != NULL;
    return any ? vts_check(session, w->chart.scene) : VTS_OK;
}

static VtsStatus enter_first(VtsSession *session, const void *context) {
    Work *w = *(Work *const *)context;
    VtsStatus status = film_enter_first(session, w->settings, w->chart.scene);
    return status == VTS_OK ? check_blocks(w, session) : status;
}

/* The session that looks for a film reads the scene with all values of all points. */
static int look(Work *w) {
    const PairList *knobs = &w->settings->knobs;
    VtsPair *all = malloc((knobs->count + 2 * w->chart.count + 1) * sizeof *all);
    VtsOptions *options = &w->settings->options;
    size_t count = knobs->count;
    if (!all) return VTS_ERROR_MEMORY;
    if (count) memcpy(all, knobs->items, count * sizeof *all);
    for (size_t i = 0; i < w->chart.count; i++) {
        const ChartPoint *p = &w->chart.points[i];
        if (p->method.name) all[count++] = p->method;
        if (p->swept.name) all[count++] = p->swept;
    }
    options->settings = all, options->setting_count = count;
    int status = command_with_session(w->settings, &w->console, w->chart.scene, enter_first, &w);
    options->settings = knobs->items, options->setting_count = knobs->count;
    free(all);
    return status;
}

int command_chart(Settings *settings) {
    if (settings->scenes.count == 0) return complain_usage(settings, "no scene given");
    if (settings->scenes.count > 1)
        return complain_usage(settings, "one scene at a time, not also '%s'", settings->scenes.items[1]);
    if (settings->repeats == 0) settings->repeats = 1;
    Work work = {.settings = settings, .chart = {.scene = settings->scenes.items[0], .noise = -1, .frames = 1}};
    console_init(&work.console, settings);
    int status = chart_choose_axes(settings, &work.chart);
    if (status == 0) status = chart_plan(settings, &work.chart);
    if (status == 0) status = look(&work);
    if (status == VTS_OK) status = chart(&work);
    for (long long k = 0; work.references && k < work.chart.frames; k++) vts_reference_free(work.references[k]);
    free(work.references);
    chart_free(&work.chart);
    return status;
}
