/* vts chart: the points to be measured, and what is written about them. */
#ifndef VTS_CLI_CHART_H
#define VTS_CLI_CHART_H

#include "cli/settings.h"

typedef struct ChartPoint {
    const char *curve; /* NULL: the scene as it is, without a curve */
    const char *label; /* the value that changes along the curve */
    VtsPair swept, method; /* names NULL: none */
    VtsMeasure measure;
    const char *picture; /* where it is kept, or NULL */
    bool done;           /* `measure` holds what was measured */
    bool on_front;       /* none is both faster and nearer to the reference, one of them by 3 % */
} ChartPoint;

/* What an axis shows; less is better. Values of 0 and below have no place on it. */
typedef struct ChartAxis {
    const char *name, *label;
    double (*value)(const ChartPoint *point);
} ChartAxis;

typedef struct Chart {
    ChartPoint *points; /* those of a curve in a row; the scene as it is comes first */
    size_t count;
    const char *scene;
    const char *options; /* of the command line, that all points have in common */
    long long frames;    /* of a film, over which measures are taken; 1: a picture */
    int rays;     /* of a pixel of the reference; 0: not known */
    double noise; /* RMSE of the reference; negative: not known */
    bool known;   /* some points were taken over from an earlier run */
    const ChartAxis *x, *y;
} Chart;

/* Of the build: "1a2b3c4", with "-dirty" where files differ from it; "" where it is not known. */
extern const char chart_commit[];

/* The points that --sweep and --methods ask for. 0, or VTS_ERROR_USAGE after saying what is wrong. */
int chart_plan(Settings *settings, Chart *chart);
void chart_free(Chart *chart);

/* User seconds of building and rendering. */
double chart_seconds(const ChartPoint *point);
/* Sets the axes by "X,Y", NULL: "cpu_s,rmse". 0, or VTS_ERROR_USAGE after saying which there are. */
int chart_choose_axes(const Settings *settings, Chart *chart);
/* Marks the points on the front. Points that came out as the same rendering get the times of the fastest. */
void chart_find_front(Chart *chart);
/* The smallest error above 0, or 0. */
double chart_least_error(const Chart *chart);

/* What two charts have to have in common for points of one to be points of the other, but for what CSV tells by itself. */
const char *chart_options(Settings *settings);
const char *chart_processor(Settings *settings);
int chart_threads(const Settings *settings);
const char *chart_compiler(void);

/* Takes over points that were measured before, from the text of a CSV file: those of the same program, machine, scene and options. How many. */
size_t chart_resume(Chart *chart, Settings *settings, const char *csv);

/* Whether any point has a place on both axes. */
bool chart_is_drawn(const Chart *chart);

/* As text that the caller frees; NULL when memory is short. */
char *chart_csv(const Chart *chart, Settings *settings);
char *chart_script(const Chart *chart, Settings *settings, const char *terminal);

/* Lets gnuplot draw the script into a file, which appears whole or not at all. */
typedef enum PlotStatus { PLOT_DONE, PLOT_NO_PROGRAM, PLOT_FAILED } PlotStatus;
PlotStatus chart_plot(const Settings *settings, const char *script, const char *path);
/* gnuplot's terminal for the suffix of a file's name; NULL when there is none. */
const char *chart_terminal(const char *path);

#endif
