/* Which points a chart has, and which of them are worth having. */
#include "cli/chart.h"
#include "cli/complaint.h"

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

/* A method's curves over all sweeps, or one curve over its values. */
static int add_method(Settings *settings, Chart *chart, const char *knob) {
    const char *const *values = vts_setting_values(knob);
    if (!values) {
        int status = check(settings, knob, "1");
        return status != 0 ? status : complain_usage(settings, "the values of '%s' are numbers: give some to --sweep", knob);
    }
    for (; *values; values++) {
        for (size_t i = 0; i < settings->sweeps.count; i++) {
            const VtsPair *sweep = &settings->sweeps.items[i];
            if (strcmp(sweep->name, knob) == 0) return complain_usage(settings, "'%s' cannot be both swept and a method", knob);
            int status = add_curve(settings, chart, sweep, (VtsPair){knob, *values});
            if (status != 0) return status;
        }
        if (settings->sweeps.count) continue;
        ChartPoint *point = add_point(chart);
        if (!point) return VTS_ERROR_MEMORY;
        *point = (ChartPoint){.curve = knob, .label = *values, .method = {knob, *values}};
    }
    return 0;
}

int chart_plan(Settings *settings, Chart *chart) {
    if (settings->sweeps.count == 0 && !settings->methods)
        return complain_usage(settings, "what is to be charted? Give --sweep KNOB=VALUE,VALUE or --methods KNOB");
    ChartPoint *plain = add_point(chart);
    if (!plain) return VTS_ERROR_MEMORY;
    plain->label = "as it is";
    int status = 0;
    for (size_t i = 0; i < settings->sweeps.count && !settings->methods && status == 0; i++)
        status = add_curve(settings, chart, &settings->sweeps.items[i], (VtsPair){0});
    const char *rest = settings->methods, *knob;
    while (status == 0 && (knob = next_word(settings, &rest))) status = add_method(settings, chart, knob);
    if (status == 0 && chart->count == 1) return complain_usage(settings, "there are no values to chart");
    return status;
}

/* ---- afterwards ---- */

double chart_seconds(const ChartPoint *point) { return point->measure.build_user_s + point->measure.render_user_s; }

/* Times of one and the same rendering differ by a few hundredths: what is better by less than that is not better. */
static const double CLEARLY = 0.97;

static bool beats(const ChartPoint *a, const ChartPoint *b) {
    double ta = chart_seconds(a), tb = chart_seconds(b), ea = a->measure.rmse, eb = b->measure.rmse;
    return ta <= tb && ea <= eb && (ta < CLEARLY * tb || ea < CLEARLY * eb);
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
            if (is_same_rendering(&chart->points[i].measure, &other->measure) && chart_seconds(other) < chart_seconds(&chart->points[i]))
                chart->points[i].measure = other->measure;
        }
}

void chart_find_front(Chart *chart) {
    share_times(chart);
    for (size_t i = 0; i < chart->count; i++) {
        bool beaten = false;
        for (size_t k = 0; k < chart->count; k++) beaten |= beats(&chart->points[k], &chart->points[i]);
        chart->points[i].on_front = !beaten;
    }
}

double chart_least_error(const Chart *chart) {
    double least = 0;
    for (size_t i = 0; i < chart->count; i++) {
        double error = chart->points[i].measure.rmse;
        if (error > 0 && (least == 0 || error < least)) least = error;
    }
    return least;
}
