/* Inside of a heightmap, for the files that make and read it. */
#ifndef VTS_TERRAIN_HEIGHTMAP_PARTS_H
#define VTS_TERRAIN_HEIGHTMAP_PARTS_H

#include "terrain/geoid.h"
#include "terrain/heightmap.h"
#include "terrain/map_layer.h"

/* The geoid's undulation at every step-th post of the lattice, bilinear between: places need not be computed for every post. */
typedef struct Undulation {
    int step, columns, rows;
    const float *nodes; /* NULL: none is added */
    float low, high;
} Undulation;

struct Heightmap {
    HeightmapExtent extent;
    MapLayer *layers; /* the first on top */
    int layer_count;
    Georeference lattice;
    int period; /* of a lattice that goes around */
    Undulation undulation;
    Hash128 hash;
};

/* What is added to a layer's heights at a point of the lattice. */
double undulation_at(const Undulation *undulation, double column, double row);
static inline bool layer_gets_geoid(const MapLayer *layer) { return layer->place.heights != GEO_HEIGHTS_ELLIPSOID; }

/* heightmap_frame.c: the lattice of all layers, what of the globe it covers, and the geoid on it. False with a line in `error`. */
bool heightmap_make_lattice(Heightmap *map, Arena *arena, StrBuf *error);
bool heightmap_add_geoid(Heightmap *map, const HeightmapOptions *options, Arena *arena, StrBuf *error);

#endif
