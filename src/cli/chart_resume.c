/* Points of a chart that were measured before, out of its CSV file. */
#include "cli/chart.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_FIELDS = 64 };

/* One line, its fields unquoted in place. */
typedef struct Row {
    char *fields[MOST_FIELDS];
    size_t count;
} Row;

/* Reads a field that begins at `at`, and ends it with a zero. What comes after its comma; NULL at the end of the line. */
static char *read_field(char *at, char **field) {
    bool quoted = *at == '"';
    char *out = at += quoted;
    *field = out;
    for (; *at && (quoted || *at != ','); at++) {
        if (quoted && *at == '"' && *++at != '"') break;
        *out++ = *at;
    }
    bool more = *at == ',';
    *out = '\0';
    return more ? at + 1 : NULL;
}

static Row read_row(char *line) {
    Row row = {.count = 0};
    while (line && row.count < MOST_FIELDS) line = read_field(line, &row.fields[row.count++]);
    return row;
}

static const char *field_of(const Row *header, const Row *row, const char *name) {
    for (size_t i = 0; i < header->count && i < row->count; i++)
        if (strcmp(header->fields[i], name) == 0) return row->fields[i];
    return "";
}

typedef enum NumberKind { A_DOUBLE, A_COUNT, AN_INT, A_SIZE } NumberKind;
typedef struct Column {
    const char *name;
    NumberKind kind;
    size_t offset; /* in VtsMeasure */
} Column;
#define FIELD(name) offsetof(VtsMeasure, name)
static const Column columns[] = {
    {"build_cpu_s", A_DOUBLE, FIELD(build_user_s)},   {"render_cpu_s", A_DOUBLE, FIELD(render_user_s)},
    {"build_wall_s", A_DOUBLE, FIELD(build_wall_s)},  {"render_wall_s", A_DOUBLE, FIELD(render_wall_s)},
    {"parse_cpu_s", A_DOUBLE, FIELD(parse_user_s)},   {"parse_wall_s", A_DOUBLE, FIELD(parse_wall_s)},
    {"rmse", A_DOUBLE, FIELD(rmse)},                  {"rmse_measured", A_DOUBLE, FIELD(difference.rmse)},
    {"psnr", A_DOUBLE, FIELD(difference.psnr)},       {"flip", A_DOUBLE, FIELD(difference.flip)},
    {"max", A_DOUBLE, FIELD(difference.largest)},     {"camera_rays", A_COUNT, FIELD(camera_rays)},
    {"shadow_rays", A_COUNT, FIELD(shadow_rays)},     {"steps", A_COUNT, FIELD(steps)},
    {"voxels_visited", A_COUNT, FIELD(voxels_visited)}, {"texel_bytes", A_SIZE, FIELD(texel_bytes)},
    {"width", AN_INT, FIELD(difference.width)},       {"height", AN_INT, FIELD(difference.height)},
};

static bool read_number(const Column *column, const char *text, VtsMeasure *out) {
    char *end, *field = (char *)out + column->offset;
    double number = strtod(text, &end);
    if (end == text || *end) return false;
    unsigned long long counted = strtoull(text, NULL, 10);
    size_t size = (size_t)counted;
    int whole = (int)strtol(text, NULL, 10);
    switch (column->kind) {
    case A_DOUBLE: memcpy(field, &number, sizeof number); break;
    case A_COUNT: memcpy(field, &counted, sizeof counted); break;
    case A_SIZE: memcpy(field, &size, sizeof size); break;
    case AN_INT: memcpy(field, &whole, sizeof whole); break;
    }
    return true;
}

static bool read_measure(const Row *header, const Row *row, VtsMeasure *out) {
    char *end;
    *out = (VtsMeasure){.flicker = -1};
    for (size_t i = 0; i < sizeof columns / sizeof *columns; i++)
        if (!read_number(&columns[i], field_of(header, row, columns[i].name), out)) return false;
    const char *flicker = field_of(header, row, "flicker");
    double number = strtod(flicker, &end);
    if (end != flicker) out->flicker = number;
    return true;
}

/* ---- whether it is the same ---- */

static bool is_text(const Row *header, const Row *row, const char *name, const char *text) {
    return strcmp(field_of(header, row, name), text ? text : "") == 0;
}

static bool is_count(const Row *header, const Row *row, const char *name, long long count) {
    char text[32];
    snprintf(text, sizeof text, "%lld", count);
    return is_text(header, row, name, text);
}

/* Sessions give the same pixels on any machine, but not the same times. */
static bool is_of_chart(const Row *header, const Row *row, const Chart *chart, const Settings *settings, const char *processor) {
    return is_text(header, row, "scene", chart->scene) && is_text(header, row, "options", chart->options) && is_text(header, row, "version", vts_version()) &&
           is_text(header, row, "commit", chart_commit) && is_text(header, row, "compiler", chart_compiler()) && is_text(header, row, "processor", processor) &&
           is_count(header, row, "threads", chart_threads(settings)) && is_count(header, row, "frames", chart->frames) &&
           is_count(header, row, "width", settings->options.width) && is_count(header, row, "height", settings->options.height);
}

static bool is_point(const Row *header, const Row *row, const ChartPoint *p) {
    return is_text(header, row, "curve", p->curve) && is_text(header, row, "knob", p->swept.name) && is_text(header, row, "value", p->swept.value) &&
           is_text(header, row, "method", p->method.name) && is_text(header, row, "method_value", p->method.value);
}

static void take_over(Chart *chart, const Row *header, const Row *row) {
    char *end;
    VtsMeasure measure;
    if (!read_measure(header, row, &measure)) return;
    const char *noise = field_of(header, row, "reference_noise");
    double number = strtod(noise, &end);
    for (size_t i = 0; i < chart->count; i++) {
        ChartPoint *point = &chart->points[i];
        if (point->done || !is_point(header, row, point)) continue;
        point->measure = measure;
        point->done = true;
        chart->noise = end != noise ? number : -1;
    }
}

static size_t count_done(const Chart *chart) {
    size_t done = 0;
    for (size_t i = 0; i < chart->count; i++) done += chart->points[i].done;
    return done;
}

/* Ends the line with a zero; what comes after it, NULL at the end of the text. */
static char *end_line(char *line) {
    char *end = line + strcspn(line, "\n");
    if (!*end) return NULL;
    *end = '\0';
    return end + 1;
}

size_t chart_resume(Chart *chart, Settings *settings, const char *csv) {
    char *text = strdup(csv), *line = text, *rest = text ? end_line(text) : NULL;
    const char *processor = chart_processor(settings);
    Row header = line ? read_row(line) : (Row){.count = 0};
    while ((line = rest)) {
        rest = end_line(line);
        Row row = read_row(line);
        if (row.count == header.count && is_of_chart(&header, &row, chart, settings, processor)) take_over(chart, &header, &row);
    }
    free(text);
    return count_done(chart);
}
