/* Which points a chart has, and which of them are worth having. */
#include "cli/chart.h"
#include "cli/complaint.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static ChartPoint *add_point(Chart *chart) {
    ChartPoint *larger = realloc(chart->points, (chart->count + 1) * sizeof *larger);
    if (!larger) return NULL;
    chart->points = larger;
    larger[chart->count] = (ChartPoint){0};
    return &larger[chart->count++];
}

void chart_free(Chart *chart) {
    free(chart->points);
    chart->points = NULL;
    chart->count = 0;
}

static int check(const Settings *settings, const char *knob, const char *value) {
    char why[512];
    if (vts_setting_check(knob, value, why, sizeof why) == VTS_OK) return 0;
    return complain_usage(settings, "%s", why);
}

/* The next of some words between commas; NULL when there is none left. */
static const char *next_word(Settings *settings, const char **text) {
    if (!*text || !**text) return NULL;
    size_t size = strcspn(*text, ",");
    const char *word = settings_copy(settings, *text, size);
    *text += size + ((*text)[size] == ',');
    return word;
}

static const char *name_curve(Settings *settings, const VtsPair *sweep, const VtsPair *method) {
    char name[256];
    if (!method->name) return sweep->name;
    if (settings->sweeps.count > 1)
        snprintf(name, sizeof name, "%s %s, %s", method->name, method->value, sweep->name);
    else
        snprintf(name, sizeof name, "%s %s", method->name, method->value);
    return settings_copy(settings, name, strlen(name));
}

static int add_curve(Settings *settings, Chart *chart, const VtsPair *sweep, VtsPair method) {
    const char *curve = name_curve(settings, sweep, &method), *rest = sweep->value, *value;
    while ((value = next_word(settings, &rest))) {
        int status = check(settings, sweep->name, value);
        if (status != 0) return status;
        ChartPoint *point = add_point(chart);
        if (!point) return VTS_ERROR_MEMORY;
        *point = (ChartPoint){.curve = curve, .label = value, .swept = {sweep->name, value}, .method = method};
    }
    return 0;
}

/* Its curves over all sweeps, or a point. */
static int add_method(Settings *settings, Chart *chart, VtsPair method) {
    int status = check(settings, method.name, method.value);
    for (size_t i = 0; i < settings->sweeps.count && status == 0; i++) {
        const VtsPair *sweep = &settings->sweeps.items[i];
        if (strcmp(sweep->name, method.name) == 0) return complain_usage(settings, "'%s' cannot be both swept and a method", method.name);
        status = add_curve(settings, chart, sweep, method);
    }
    if (settings->sweeps.count || status != 0) return status;
    ChartPoint *point = add_point(chart);
    if (!point) return VTS_ERROR_MEMORY;
    *point = (ChartPoint){.curve = method.name, .label = method.value, .method = method};
    return 0;
}

/* All that the knob has names for. */
static int add_all_methods(Settings *settings, Chart *chart, const char *knob) {
    const char *const *values = vts_setting_values(knob);
    if (!values) {
        int status = strchr(knob, '.') ? 0 : check(settings, knob, "1");
        return status != 0 ? status : complain_usage(settings, "which values of '%s'? --methods %s=VALUE,VALUE, or give some to --sweep", knob, knob);
    }
    int status = 0;
    for (; *values && status == 0; values++) status = add_method(settings, chart, (VtsPair){knob, *values});
    return status;
}

/* KNOB,KNOB or KNOB=VALUE,VALUE */
static int add_methods(Settings *settings, Chart *chart, const char *text) {
    const char *equals = strchr(text, '='), *word, *rest = equals ? equals + 1 : text;
    const char *knob = equals ? settings_copy(settings, text, (size_t)(equals - text)) : NULL;
    int status = 0;
    while (status == 0 && (word = next_word(settings, &rest)))
        status = knob ? add_method(settings, chart, (VtsPair){knob, word}) : add_all_methods(settings, chart, word);
    return status;
}

int chart_plan(Settings *settings, Chart *chart) {
    const TextList *methods = &settings->methods;
    if (settings->sweeps.count == 0 && methods->count == 0)
        return complain_usage(settings, "what is to be charted? Give --sweep KNOB=VALUE,VALUE or --methods KNOB");
    ChartPoint *plain = add_point(chart);
    if (!plain) return VTS_ERROR_MEMORY;
    plain->label = "as it is";
    int status = 0;
    for (size_t i = 0; i < settings->sweeps.count && methods->count == 0 && status == 0; i++)
        status = add_curve(settings, chart, &settings->sweeps.items[i], (VtsPair){0});
    for (size_t i = 0; i < methods->count && status == 0; i++) status = add_methods(settings, chart, methods->items[i]);
    if (status == 0 && chart->count == 1) return complain_usage(settings, "there are no values to chart");
    return status;
}

/* ---- axes ---- */

double chart_seconds(const ChartPoint *point) { return point->measure.build_user_s + point->measure.render_user_s; }
static double wall(const ChartPoint *p) { return p->measure.build_wall_s + p->measure.render_wall_s; }
static double camera_rays(const ChartPoint *p) { return (double)p->measure.camera_rays; }
static double shadow_rays(const ChartPoint *p) { return (double)p->measure.shadow_rays; }
static double steps(const ChartPoint *p) { return (double)p->measure.steps; }
static double voxels(const ChartPoint *p) { return (double)p->measure.voxels_visited; }
static double bytes(const ChartPoint *p) { return (double)p->measure.texel_bytes; }
static double rmse(const ChartPoint *p) { return p->measure.rmse; }
static double flip(const ChartPoint *p) { return p->measure.difference.flip; }
static double coded(const ChartPoint *p) { return pow(10, -p->measure.difference.psnr / 20); }
static double flicker(const ChartPoint *p) { return p->measure.flicker; }

static const ChartAxis across[] = {
    {"cpu_s", "building and rendering, CPU seconds (user)", chart_seconds},
    {"wall_s", "building and rendering, seconds of wall clock", wall},
    {"camera_rays", "rays from the eye", camera_rays},
    {"shadow_rays", "rays towards lights", shadow_rays},
    {"steps", "steps through skins", steps},
    {"voxels_visited", "voxels read", voxels},
    {"texel_bytes", "memory of texels, bytes", bytes},
};
static const ChartAxis upward[] = {
    {"rmse", "RMSE, linear light in [0, 1]", rmse},
    {"flip", "mean FLIP", flip},
    {"psnr", "RMSE after the sRGB curve (0.1: PSNR of 20 dB, 0.01: 40 dB)", coded},
    {"flicker", "flicker: RMSE of the change from frame to frame", flicker},
};

static const ChartAxis *find_axis(const ChartAxis *axes, size_t count, const char *name, size_t size) {
    for (size_t i = 0; i < count; i++)
        if (strlen(axes[i].name) == size && memcmp(axes[i].name, name, size) == 0) return &axes[i];
    return NULL;
}

int chart_choose_axes(const Settings *settings, Chart *chart) {
    enum { ACROSS = sizeof across / sizeof *across, UPWARD = sizeof upward / sizeof *upward };
    const char *text = settings->axes ? settings->axes : "cpu_s,rmse", *comma = strchr(text, ',');
    if (comma) {
        chart->x = find_axis(across, ACROSS, text, (size_t)(comma - text));
        chart->y = find_axis(upward, UPWARD, comma + 1, strlen(comma + 1));
    }
    if (chart->x && chart->y) return 0;
    return complain_usage(settings, "--axes '%s': X,Y with X one of cpu_s, wall_s, camera_rays, shadow_rays, steps, voxels_visited, texel_bytes, and Y one of rmse, flip, psnr, flicker", text);
}

/* ---- afterwards ---- */

/* Times of one and the same rendering differ by a few hundredths: what is better by less than that is not better. Equal errors are printed with
 * some digits, and read again. */
static const double CLEARLY = 0.97, NEARLY = 1.001;

static bool beats(const Chart *chart, const ChartPoint *a, const ChartPoint *b) {
    double ta = chart->x->value(a), tb = chart->x->value(b), ea = chart->y->value(a), eb = chart->y->value(b);
    return a->done && ta <= NEARLY * tb && ea <= NEARLY * eb && (ta < CLEARLY * tb || ea < CLEARLY * eb);
}

/* The scene as it is, say, and the value that it has anyway. */
static bool is_same_rendering(const VtsMeasure *a, const VtsMeasure *b) {
    return a->difference.rmse == b->difference.rmse && a->difference.flip == b->difference.flip && a->steps == b->steps &&
           a->voxels_visited == b->voxels_visited && a->shadow_rays == b->shadow_rays;
}

/* What was rendered twice has the lesser of both times. */
static void share_times(Chart *chart) {
    for (size_t i = 0; i < chart->count; i++)
        for (size_t k = 0; k < chart->count; k++) {
            const ChartPoint *other = &chart->points[k];
            if (!other->done || !chart->points[i].done) continue;
            if (is_same_rendering(&chart->points[i].measure, &other->measure) && chart_seconds(other) < chart_seconds(&chart->points[i]))
                chart->points[i].measure = other->measure;
        }
}

void chart_find_front(Chart *chart) {
    share_times(chart);
    for (size_t i = 0; i < chart->count; i++) {
        bool beaten = !chart->points[i].done;
        for (size_t k = 0; k < chart->count; k++) beaten |= beats(chart, &chart->points[k], &chart->points[i]);
        chart->points[i].on_front = !beaten;
    }
}

double chart_least_error(const Chart *chart) {
    double least = 0;
    for (size_t i = 0; i < chart->count; i++) {
        double error = chart->points[i].done ? chart->y->value(&chart->points[i]) : 0;
        if (error > 0 && (least == 0 || error < least)) least = error;
    }
    return least;
}
