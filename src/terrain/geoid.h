/* The geoid: how far the level of the sea lies above the ellipsoid, from a grid of undulations in NOAA's .gtx format. */
#ifndef VTS_TERRAIN_GEOID_H
#define VTS_TERRAIN_GEOID_H

#include "base/arena.h"
#include "base/hash.h"
#include "base/strbuf.h"

typedef struct Geoid {
    const char *path;
    double west, south, step_east, step_north; /* degrees; of the first node, and between nodes */
    int columns, rows;
    bool around;         /* columns go once around the globe */
    const float *nodes;  /* metres, rows from the south; NaN: not known */
    Hash128 hash;
} Geoid;

/* Reads "egm96_15", looked for as egm96_15.gtx in the folders and in those of PROJ's data, or the file of a path, which
 * has a slash, into the arena. False
 * with a line in `error`. */
bool geoid_load(Geoid *geoid, const char *name, const char *const *folders, size_t folder_count, Arena *arena, StrBuf *error);
/* Bilinear between nodes, metres; false where the grid has none. */
bool geoid_undulation(const Geoid *geoid, double latitude, double longitude, double *out);

#endif
