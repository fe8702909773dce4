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
    bool on_front;       /* none is both faster and nearer to the reference, one of them by 3 % */
} ChartPoint;

typedef struct Chart {
    ChartPoint *points; /* those of a curve in a row; the scene as it is comes first */
    size_t count;
    const char *scene;
    int rays;     /* of a pixel of the reference; 0: not known */
    double noise; /* RMSE of the reference; negative: not known */
} Chart;

/* The points that --sweep and --methods ask for. 0, or VTS_ERROR_USAGE after saying what is wrong. */
int chart_plan(Settings *settings, Chart *chart);
void chart_free(Chart *chart);

/* The coordinates of a point: user seconds of building and rendering, and RMSE without the reference's noise (0: below it). */
double chart_seconds(const ChartPoint *point);
/* Marks the points on the front. Points that came out as the same rendering get the times of the fastest. */
void chart_find_front(Chart *chart);
/* The smallest RMSE above 0, or 0. */
double chart_least_error(const Chart *chart);

/* As text that the caller frees; NULL when memory is short. */
char *chart_csv(const Chart *chart, const Settings *settings);
char *chart_script(const Chart *chart, const Settings *settings, const char *terminal);

/* Lets gnuplot draw the script into a file, which appears whole or not at all. */
typedef enum PlotStatus { PLOT_DONE, PLOT_NO_PROGRAM, PLOT_FAILED } PlotStatus;
PlotStatus chart_plot(const Settings *settings, const char *script, const char *path);
/* gnuplot's terminal for the suffix of a file's name; NULL when there is none. */
const char *chart_terminal(const char *path);

#endif
