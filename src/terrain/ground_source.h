/* A field of heights as what draws it sees it: posts in columns and rows, and the surface between them, which is bilinear. Whoever
 * knows where the numbers come from, and where on the globe they stand, fills one in. */
#ifndef VTS_TERRAIN_GROUND_SOURCE_H
#define VTS_TERRAIN_GROUND_SOURCE_H

#include "base/vec.h"

typedef struct GroundSource {
    int columns, rows; /* posts; at least 2 each */
    /* The height of a post, in metres; NaN: there is none. Thread-safe. */
    double (*height)(const void *map, int column, int row);
    /* The same for columns x rows posts from (column, row) on, all within the map, one row after the other. May be NULL. */
    void (*block)(const void *map, int column, int row, int columns, int rows, float *heights);
    /* Where the point of this height stands, in the frame of the scene; columns and rows may be fractions. Thread-safe. */
    Vec3 (*place)(const void *map, double column, double row, double height);
    const void *map;
    double spacing; /* metres between neighbouring posts, the largest */
    double bend;    /* an edge of the length s, straight in columns and rows, leaves its chord by at most bend · s² */
} GroundSource;

/* Between posts; NaN beside one that is missing, and outside of the map. */
double ground_source_height(const GroundSource *source, double column, double row);
/* The same, and beyond the last column and row a ground that goes on as if turned about it by half a turn: what triangles that the
 * border cuts stand on. Columns and rows from 0 on. */
double ground_source_beyond(const GroundSource *source, double column, double row);
double ground_source_post(const GroundSource *source, int column, int row);

#endif
