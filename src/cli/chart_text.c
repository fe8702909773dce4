/* A chart as numbers (CSV) and as a script for gnuplot. */
#include "cli/chart.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- the machine ---- */

/* The processor's name in /proc, where there is one. */
static void read_processor(char *out, size_t size) {
    char line[256];
    snprintf(out, size, "unknown processor");
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && fgets(line, sizeof line, file)) {
        char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !colon) continue;
        line[strcspn(line, "\n")] = '\0';
        snprintf(out, size, "%s", colon[1] ? colon + 2 : "");
        break;
    }
    if (file) fclose(file);
}

const char *chart_processor(Settings *settings) {
    char name[200];
    read_processor(name, sizeof name);
    return settings_copy(settings, name, strlen(name));
}

int chart_threads(const Settings *settings) {
    return settings->options.threads ? settings->options.threads : (int)sysconf(_SC_NPROCESSORS_ONLN);
}

#if defined(__clang__)
#define COMPILER "clang " __clang_version__
#elif defined(__GNUC__)
#define COMPILER "gcc " __VERSION__
#else
#define COMPILER "unknown compiler"
#endif
const char *chart_compiler(void) { return COMPILER; }

static void put_pairs(FILE *out, const char *option, const PairList *pairs) {
    for (size_t i = 0; i < pairs->count; i++) fprintf(out, "%s %s=%s ", option, pairs->items[i].name, pairs->items[i].value);
}

static void put_frames(FILE *out, const FrameList *frames) {
    for (size_t i = 0; i < frames->count; i++)
        fprintf(out, "%s%d-%dx%d", i ? "," : "--frames ", frames->items[i].first, frames->items[i].last, frames->items[i].step);
    if (frames->count) fputc(' ', out);
}

const char *chart_options(Settings *settings) {
    const VtsOptions *o = &settings->options;
    const Animation *a = &settings->animation;
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return "";
    put_pairs(out, "--declare", &settings->declares);
    put_pairs(out, "--set", &settings->knobs);
    put_frames(out, &a->asked);
    if (o->clock_set) fprintf(out, "--clock %.17g ", o->clock);
    if (a->shutter_given) fprintf(out, "--shutter %.17g ", a->shutter);
    if (a->fps > 0) fprintf(out, "--fps %.17g ", a->fps);
    if (o->seed) fprintf(out, "--seed %llu ", (unsigned long long)o->seed);
    if (o->exposure != 0) fprintf(out, "--exposure %.17g ", o->exposure);
    if (settings->references.count == 0) fprintf(out, "--samples %d ", o->reference_samples);
    for (size_t i = 0; i < settings->references.count; i++) fprintf(out, "--reference %s ", settings->references.items[i]);
    fclose(out);
    const char *kept = text ? settings_copy(settings, text, size ? size - 1 : 0) : "";
    free(text);
    return kept;
}

/* ---- CSV ---- */

static void put_text(FILE *out, const char *text) {
    fputc('"', out);
    for (const char *c = text ? text : ""; *c; c++) {
        if (*c == '"') fputc('"', out);
        fputc(*c, out);
    }
    fputc('"', out);
}

static void put_row(FILE *out, const Chart *chart, const ChartPoint *p, const Settings *settings, const char *processor) {
    const VtsMeasure *m = &p->measure;
    const char *texts[] = {p->curve, p->swept.name, p->swept.value, p->method.name, p->method.value};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        put_text(out, texts[i]);
        fputc(',', out);
    }
    fprintf(out, "%d,%d,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,", !p->curve, p->on_front, chart_seconds(p),
            m->build_wall_s + m->render_wall_s, m->build_user_s, m->render_user_s, m->build_wall_s, m->render_wall_s, m->parse_user_s,
            m->parse_wall_s);
    fprintf(out, "%.8f,%.8f,", m->rmse, m->difference.rmse);
    if (chart->noise >= 0) fprintf(out, "%.8f", chart->noise);
    fprintf(out, ",%.4f,%.6f,%.6f,%llu,%llu,%llu,%llu,%zu,", m->difference.psnr, m->difference.flip, m->difference.largest,
            m->camera_rays, m->shadow_rays, m->steps, m->voxels_visited, m->texel_bytes);
    put_text(out, p->picture);
    fputc(',', out);
    put_text(out, chart->scene);
    fprintf(out, ",%d,%d,%d,", m->difference.width, m->difference.height, chart_threads(settings));
    put_text(out, vts_version());
    fputc(',', out);
    put_text(out, COMPILER);
    fputc(',', out);
    put_text(out, processor);
    fprintf(out, ",%lld,", chart->frames);
    if (m->flicker >= 0) fprintf(out, "%.8f", m->flicker);
    fputc(',', out);
    put_text(out, chart_commit);
    fputc(',', out);
    put_text(out, chart->options);
    fputc('\n', out);
}

char *chart_csv(const Chart *chart, Settings *settings) {
    char *text = NULL;
    const char *processor = chart_processor(settings);
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    fputs("curve,knob,value,method,method_value,default,front,cpu_s,wall_s,build_cpu_s,render_cpu_s,build_wall_s,render_wall_s,"
          "parse_cpu_s,parse_wall_s,rmse,rmse_measured,reference_noise,psnr,flip,max,camera_rays,shadow_rays,steps,voxels_visited,"
          "texel_bytes,picture,scene,width,height,threads,version,compiler,processor,frames,flicker,commit,options\n",
          out);
    for (size_t i = 0; i < chart->count; i++)
        if (chart->points[i].done) put_row(out, chart, &chart->points[i], settings, processor);
    return fclose(out) == 0 ? text : NULL;
}

/* ---- the script ---- */

/* In single quotes, where gnuplot reads nothing but '' for '. */
static void put_quoted(FILE *out, const char *text) {
    fputc('\'', out);
    for (const char *c = text; *c; c++) {
        if (*c == '\'') fputc('\'', out);
        fputc((unsigned char)*c < ' ' ? ' ' : *c, out);
    }
    fputc('\'', out);
}

/* What a logarithm has room for. */
static bool is_drawn(const Chart *chart, const ChartPoint *p) { return p->done && chart->x->value(p) > 0 && chart->y->value(p) > 0; }

bool chart_is_drawn(const Chart *chart) {
    bool any = false;
    for (size_t i = 0; i < chart->count; i++) any |= is_drawn(chart, &chart->points[i]);
    return any;
}

static void put_point(FILE *out, const Chart *chart, const ChartPoint *p) {
    fprintf(out, "%.6g\t%.6g\t", chart->x->value(p), chart->y->value(p));
    for (const char *c = p->label; *c; c++) fputc((unsigned char)*c < ' ' ? ' ' : *c, out);
    fputc('\n', out);
}

static bool starts_curve(const Chart *chart, size_t i) {
    const char *curve = chart->points[i].curve;
    return curve && (i == 0 || !chart->points[i - 1].curve || strcmp(curve, chart->points[i - 1].curve) != 0);
}

/* One past the last point of the curve that starts at i; *drawn tells whether any of them is. */
static size_t end_of_curve(const Chart *chart, size_t i, bool *drawn) {
    size_t k = i;
    *drawn = false;
    for (; k < chart->count && (k == i || !starts_curve(chart, k)); k++) *drawn |= is_drawn(chart, &chart->points[k]);
    return k;
}

/* Each under the number of its first point; gnuplot complains of empty ones. */
static void put_curves(FILE *out, const Chart *chart) {
    bool drawn;
    for (size_t i = 1, end; i < chart->count; i = end) { /* the scene as it is has no curve */
        end = end_of_curve(chart, i, &drawn);
        if (!drawn) continue;
        fprintf(out, "$curve%zu << EOD\n", i);
        for (size_t k = i; k < end; k++)
            if (is_drawn(chart, &chart->points[k])) put_point(out, chart, &chart->points[k]);
        fputs("EOD\n", out);
    }
}

/* Few points: each is put where it belongs. */
static void sort_front(const Chart *chart, const ChartPoint **front, size_t count) {
    for (size_t i = 1; i < count; i++)
        for (size_t k = i; k > 0 && chart->x->value(front[k]) < chart->x->value(front[k - 1]); k--) {
            const ChartPoint *other = front[k];
            front[k] = front[k - 1];
            front[k - 1] = other;
        }
}

static bool put_front(FILE *out, const Chart *chart) {
    const ChartPoint **front = malloc((chart->count + 1) * sizeof *front);
    size_t count = 0;
    if (!front) return false;
    for (size_t i = 0; i < chart->count; i++)
        if (chart->points[i].on_front && is_drawn(chart, &chart->points[i])) front[count++] = &chart->points[i];
    sort_front(chart, front, count);
    fputs("$front << EOD\n", out);
    for (size_t i = 0; i < count; i++) put_point(out, chart, front[i]);
    fputs("EOD\n", out);
    if (is_drawn(chart, &chart->points[0])) {
        fputs("$plain << EOD\n", out);
        put_point(out, chart, &chart->points[0]);
        fputs("EOD\n", out);
    }
    free(front);
    return true;
}

/* A range with marks at 1, 1.5, 2 … of each decade: gnuplot's own are whole decades, of which a chart may show none. */
static void put_axis(FILE *out, char axis, double least, double most) {
    static const double marks[] = {1, 1.5, 2, 3, 4, 5, 7};
    bool wide = most > 100 * least;
    fprintf(out, "set %crange [%g:%g]\nset %ctics (", axis, least, most, axis);
    bool first = true;
    for (int decade = (int)floor(log10(least)); decade <= (int)ceil(log10(most)); decade++)
        for (size_t i = 0; i < sizeof marks / sizeof *marks; i += wide ? 5 : 1) {
            double mark = marks[i] * pow(10, decade);
            if (mark < least || mark > most) continue;
            fprintf(out, "%s%g", first ? "" : ", ", mark);
            first = false;
        }
    fputs(")\n", out);
}

/* A margin of a factor on both sides, which gnuplot does not leave on logarithmic axes. */
static void put_ranges(FILE *out, const Chart *chart) {
    double t0 = HUGE_VAL, t1 = 0, e0 = HUGE_VAL, e1 = 0;
    for (size_t i = 0; i < chart->count; i++) {
        const ChartPoint *p = &chart->points[i];
        if (!is_drawn(chart, p)) continue;
        t0 = fmin(t0, chart->x->value(p)), t1 = fmax(t1, chart->x->value(p));
        e0 = fmin(e0, chart->y->value(p)), e1 = fmax(e1, chart->y->value(p));
    }
    if (!(t1 > 0)) return;
    put_axis(out, 'x', t0 / 1.2, t1 * 1.4);
    put_axis(out, 'y', e0 / 1.2, e1 * 1.2);
}

static void put_caption(FILE *out, const Chart *chart, Settings *settings) {
    char line[800];
    const VtsDifference *d = &chart->points[0].measure.difference;
    const char *slash = strrchr(chart->scene, '/');
    int size = snprintf(line, sizeof line, "%s, %d x %d pixels", slash ? slash + 1 : chart->scene, d->width, d->height);
    if (chart->frames > 1 && size > 0 && (size_t)size < sizeof line) snprintf(line + size, sizeof line - (size_t)size, ", %lld frames", chart->frames);
    fputs("set title ", out);
    put_quoted(out, line);
    snprintf(line, sizeof line, "vts %s%s%s, %s; %s, %d threads", vts_version(), *chart_commit ? ", " : "", chart_commit, COMPILER, chart_processor(settings), chart_threads(settings));
    fputs("\nset label 1 ", out);
    put_quoted(out, line);
    fputs(" at screen 0.02, 0.05 font ',10'\nset label 2 ", out);
    size = chart->rays ? snprintf(line, sizeof line, "reference of %d rays a pixel; ", chart->rays) : snprintf(line, sizeof line, "reference from a file; ");
    bool subtracted = strcmp(chart->y->name, "rmse") == 0 || strcmp(chart->y->name, "flicker") == 0;
    if (chart->noise >= 0)
        snprintf(line + size, sizeof line - (size_t)size, "its noise, RMSE %.2g, is %s", chart->noise, subtracted ? "subtracted" : "in the errors");
    else
        snprintf(line + size, sizeof line - (size_t)size, "its noise is not known");
    put_quoted(out, line);
    fputs(" at screen 0.02, 0.025 font ',10'\n", out);
}

/* All of it may be nearer to the reference than its noise. */
static bool has_front(const Chart *chart) {
    bool any = false;
    for (size_t i = 0; i < chart->count; i++) any |= chart->points[i].on_front && is_drawn(chart, &chart->points[i]);
    return any;
}

static void put_plot(FILE *out, const Chart *chart) {
    const bool front = has_front(chart);
    size_t number = 0;
    bool drawn;
    fputs("plot NaN notitle", out);
    if (front) fputs(", \\\n  $front using 1:2 with lines dashtype 2 linewidth 2 linecolor rgb '#a0a0a0' title 'Pareto front'", out);
    for (size_t i = 1, end; i < chart->count; i = end) {
        end = end_of_curve(chart, i, &drawn);
        if (!drawn) continue;
        fprintf(out, ", \\\n  $curve%zu using 1:2 with linespoints linetype %zu pointtype 7 pointsize 0.7 title ", i, ++number);
        put_quoted(out, chart->points[i].curve);
        fprintf(out, ", \\\n  $curve%zu using 1:2:3 with labels left offset 0.8, 0.5 font ',9' notitle", i);
    }
    if (front) fputs(", \\\n  $front using 1:2 with points pointtype 6 pointsize 1.6 linecolor rgb '#606060' title 'on the front'", out);
    if (is_drawn(chart, &chart->points[0]))
        fputs(", \\\n  $plain using 1:2 with points pointtype 12 pointsize 2.4 linewidth 2 linecolor rgb '#c00000' title 'as the scene has it'", out);
    fputc('\n', out);
}

char *chart_script(const Chart *chart, Settings *settings, const char *terminal) {
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    fprintf(out, "set terminal %s\nset encoding utf8\nset datafile separator \"\\t\"\n", terminal);
    fputs("set logscale xy\nset grid\nset key outside top center horizontal\nset bmargin at screen 0.18\n"
          "set xlabel ",
          out);
    put_quoted(out, chart->x->label);
    fputs("\nset ylabel ", out);
    put_quoted(out, chart->y->label);
    fputc('\n', out);
    put_caption(out, chart, settings);
    put_ranges(out, chart);
    put_curves(out, chart);
    bool done = put_front(out, chart);
    put_plot(out, chart);
    if (fclose(out) == 0 && done) return text;
    free(text);
    return NULL;
}
