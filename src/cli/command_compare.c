/* vts compare: the error between two pictures, as text or JSON. */
#include "cli/command.h"
#include "cli/complaint.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct Metric {
    const char *name;
    size_t offset; /* of a double in VtsDifference */
} Metric;
static const Metric METRICS[] = {
    {"rmse", offsetof(VtsDifference, rmse)},
    {"psnr", offsetof(VtsDifference, psnr)},
    {"flip", offsetof(VtsDifference, flip)},
    {"max", offsetof(VtsDifference, largest)},
};
enum { METRIC_COUNT = sizeof METRICS / sizeof *METRICS };

static const Metric *find_metric(const char *name, size_t size) {
    for (int i = 0; i < METRIC_COUNT; i++)
        if (strlen(METRICS[i].name) == size && memcmp(METRICS[i].name, name, size) == 0) return &METRICS[i];
    return NULL;
}

bool compare_metrics_valid(const char *names) {
    for (const char *p = names; *p;) {
        size_t size = strcspn(p, ",");
        if (!find_metric(p, size)) return false;
        p += size + (p[size] == ',');
    }
    return *names != '\0';
}

static double metric_value(const Metric *metric, const VtsDifference *d) {
    double value;
    memcpy(&value, (const char *)d + metric->offset, sizeof value);
    return value;
}

/* JSON has no infinity. */
static void print_json(const VtsDifference *d, const char *names) {
    printf("{\"width\":%d,\"height\":%d", d->width, d->height);
    for (const char *p = names; *p;) {
        size_t size = strcspn(p, ",");
        double value = metric_value(find_metric(p, size), d);
        if (isfinite(value))
            printf(",\"%.*s\":%.9g", (int)size, p, value);
        else
            printf(",\"%.*s\":null", (int)size, p);
        p += size + (p[size] == ',');
    }
    printf(",\"max_at\":[%d,%d],\"not_finite\":%zu}\n", d->x, d->y, d->not_finite);
}

static void print_text(const VtsDifference *d, const char *names) {
    for (const char *p = names; *p;) {
        size_t size = strcspn(p, ",");
        const Metric *metric = find_metric(p, size);
        printf("%s %.6g", metric->name, metric_value(metric, d));
        if (metric->offset == offsetof(VtsDifference, largest)) printf(" at %d,%d", d->x, d->y);
        putchar('\n');
        p += size + (p[size] == ',');
    }
}

int command_compare(Settings *settings) {
    if (settings->scenes.count != 2)
        return complain_usage(settings, "two pictures are compared, %zu given", settings->scenes.count);
    VtsDifference d;
    char error[1024];
    VtsStatus status = vts_compare(settings->scenes.items[0], settings->scenes.items[1], settings->diff, &d, error, sizeof error);
    if (status != VTS_OK) {
        complain(settings, "%s", error);
        return (int)status;
    }
    if (d.not_finite)
        complain_warning(settings, "%zu samples are infinite or no numbers", d.not_finite);
    const char *names = settings->metrics ? settings->metrics : "rmse,psnr,flip";
    if (settings->json)
        print_json(&d, names);
    else
        print_text(&d, names);
    return VTS_OK;
}
