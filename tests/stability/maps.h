/* Maps of heights that tests write beside their scene. */
#ifndef VTS_TESTS_MAPS_H
#define VTS_TESTS_MAPS_H

#include "../analytic/analytic.h"

typedef double PostHeight(int column, int row);

/* An ESRI grid `name` whose outer posts' middles are `west`, `south` in degrees; rows go from north to south. */
static inline void map_write(const Bench *b, const char *name, int columns, int rows, double west, double south, double cell, PostHeight *height) {
    char path[128];
    snprintf(path, sizeof path, "%s/%s", b->folder, name);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f, "ncols %d\nnrows %d\nxllcenter %.12g\nyllcenter %.12g\ncellsize %.12g\nNODATA_value -9999\n", columns, rows, west, south, cell);
    for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++) fprintf(f, "%.9g%c", height(c, r), c + 1 < columns ? ' ' : '\n');
    fclose(f);
}

static inline void map_remove(const Bench *b, const char *name) {
    char path[128];
    snprintf(path, sizeof path, "%s/%s", b->folder, name);
    remove(path);
}

#endif
