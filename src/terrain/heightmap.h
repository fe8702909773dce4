/* Heights of the ground from files of mapping agencies: one map or a mosaic of several, read whole, kept as compactly as the samples
 * allow (most posts take two bytes, an even plain none), and never changed afterwards: all queries are thread-safe.
 *
 * Maps that share a lattice (the tiles of one product) are joined post by post. Others lie over each other, the first named on top,
 * and are blended over some posts along their borders. All of them are seen through one lattice, that of the finest map, continued over
 * the area of all: whole numbers (column, row) are posts, columns counted from the left and rows from the top, as in Georeference. The
 * ground is bilinear between posts, and reaches from the first to the last of them.
 *
 * Heights are metres: above the ellipsoid where a geoid was named or the map says so, else as the file counts them, above the sea. */
#ifndef VTS_TERRAIN_HEIGHTMAP_H
#define VTS_TERRAIN_HEIGHTMAP_H

#include "base/diag.h"
#include "base/hash.h"
#include "terrain/georeference.h"

typedef struct Heightmap Heightmap;

typedef enum HeightmapVoids {
    HEIGHTMAP_FILL, /* as a membrane that is fastened to the rim of the void; never above or below the rim's heights */
    HEIGHTMAP_HOLES /* no ground there */
} HeightmapVoids;

/* Where a map lies by the scene's word, whatever the file says: by the corners of its outer edges (area) or its outer posts. */
typedef struct HeightmapPlace {
    Projection projection;
    double west_south[2], east_north[2]; /* in the projection's units */
    bool area;
} HeightmapPlace;

typedef struct HeightmapOptions {
    const HeightmapPlace *place; /* NULL: as the file says, or files beside it. For a single file only */
    HeightmapVoids voids;
    bool has_nodata;
    double nodata;     /* this sample means "no data", besides the one that the file names */
    const char *geoid; /* "egm96_15", or the path of a .gtx file, with a slash in it: heights above it become heights above the ellipsoid; NULL: none */
    const char *const *folders; /* where a geoid is looked for, before the folders of PROJ's data */
    size_t folder_count;
} HeightmapOptions;

/* What was read, for people. Texts and items belong to the Heightmap. */
typedef struct HeightmapFile {
    const char *path;
    const char *format;  /* "GeoTIFF", "SRTM .hgt" … */
    const char *samples; /* "16-bit signed" … */
    const char *system;  /* projection_describe()'s */
    const char *remark;  /* NULL, or what was taken for granted */
    int columns, rows;
    Georeference place;
} HeightmapFile;

typedef struct HeightmapExtent {
    int columns, rows; /* posts of the lattice, 2 to 2^30 */
    double west, south, east, north; /* box of the posts' places: degrees, west in [-180, 180), west <= east <= west + 360 */
    bool around;           /* columns go once around the globe; the last lies where the first does */
    double column_spacing, row_spacing; /* metres between neighbouring posts in the map's middle */
    double lowest, highest; /* of what is given; low > high: nothing is */
    double nodata_share;    /* of the files' posts, before any filling */
    const char *system;     /* of the lattice */
    const char *geoid;      /* path of the geoid that was added; NULL: none */
    const HeightmapFile *files;
    size_t file_count;
} HeightmapExtent;

/* Reads the files into `arena`; NULL after an error, which names the file and the cause, at `span`. Warnings too are for the user. What
 * is read counts against the arena's budget. Paths are opened as they are. */
const Heightmap *heightmap_open(const char *const *paths, size_t count, const HeightmapOptions *options, Arena *arena, DiagList *diags,
                                Span span);

const HeightmapExtent *heightmap_extent(const Heightmap *map);
/* Equal maps, equal hash: files' samples and places, and options. */
Hash128 heightmap_hash(const Heightmap *map);

/* The place of a point of the lattice; its height is set to 0. False where the lattice is no point of the globe (far outside). */
bool heightmap_to_geo(const Heightmap *map, double column, double row, GeoPlace *out);
/* The way back; columns of a map that goes around are within it. False where the place is none of the lattice's projection; points
 * outside of the map are fine. */
bool heightmap_from_geo(const Heightmap *map, GeoPlace place, double *column, double *row);

/* The ground at a place (its height is not used), or at a point of the lattice. False: outside, or a hole. */
bool heightmap_height(const Heightmap *map, GeoPlace place, double *height);
bool heightmap_at(const Heightmap *map, double column, double row, double *height);

/* The height of a post, quickly; NaN for holes and outside. */
float heightmap_post(const Heightmap *map, int column, int row);
/* Every step-th post: columns x rows heights from (column, row) on, rows one after the other, NaN for holes and what lies outside.
 * Returns whether all are there. */
bool heightmap_block(const Heightmap *map, int column, int row, int step, int columns, int rows, float *heights);

/* What the ground between two posts and all posts between them lies in: never too narrow, and at most some posts too wide. False where
 * nothing is there. *whole (or NULL): there is neither hole nor outside in it. Takes about as long for any area. */
bool heightmap_range(const Heightmap *map, int column0, int row0, int column1, int row1, double *low, double *high, bool *whole);

#endif
