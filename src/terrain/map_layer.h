/* Maps of one lattice, as one field of posts. */
#ifndef VTS_TERRAIN_MAP_LAYER_H
#define VTS_TERRAIN_MAP_LAYER_H

#include "base/hash.h"
#include "terrain/map_file.h"
#include "terrain/post_fill.h"
#include "terrain/post_ranges.h"

/* One file of a layer, its first post at (column, row) of the layer's lattice. */
typedef struct MapTile {
    const char *path;
    Georeference place;
    int columns, rows;
    int column, row;
} MapTile;

typedef struct MapTileList {
    MapTile *items;
    size_t count, capacity;
} MapTileList;

typedef struct PostRectList {
    PostRect *items;
    size_t count, capacity;
} PostRectList;

typedef struct MapLayer {
    Georeference place; /* of the lattice */
    int columns, rows;  /* posts, 2 at least: of a single one the edges of its pixel are made */
    bool around;        /* the last column is the first, once around the globe */
    MapTileList tiles;
    PostRectList rects; /* where the tiles are, disjoint */
    Posts posts;
    PostRanges ranges;
    double spacing;     /* metres, the larger one, in the middle */
    double blend;       /* posts over which it fades towards its border where others lie */
    size_t post_count, void_count;
} MapLayer;

/* Takes a file into a layer whose lattice it shares, or into an empty one. False where it does not fit. */
bool map_layer_add(MapLayer *layer, const char *path, const Georeference *place, int columns, int rows, Arena *arena);
/* To be called when all tiles are in. */
void map_layer_close(MapLayer *layer, Arena *arena);
/* Reads a tile's heights, where there are none yet. Adds to the hash. */
bool map_layer_read(MapLayer *layer, const MapTile *tile, const double *nodata, Arena *arena, Hash128 *hash, StrBuf *error);

/* The lattice's point of a place; in a layer that goes around, within it. */
bool map_layer_from_geo(const MapLayer *layer, GeoPlace place, double *column, double *row);
/* Bilinear between posts; false outside of the posts and where one is missing. */
bool map_layer_height(const MapLayer *layer, double column, double row, double *height);
/* The same, continued straight by a post beyond the layer's border, and how much it counts where other layers lie: from 0 there to 1 well inside. */
bool map_layer_blended(const MapLayer *layer, double column, double row, double *height, double *weight);

/* Whether two affine maps or systems are the same; by how much the second begins behind the first, in posts. */
bool map_lattice_offset(const Georeference *a, const Georeference *b, int columns, int rows, double *column, double *row);
/* Posts once around the globe, 0: not a whole number of them, or no such map. */
int map_lattice_period(const Georeference *place);

#endif
