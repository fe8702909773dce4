/* Where the samples of a map lie on the globe. Columns count from the left, rows from the top; whole numbers are samples: the middles
 * of pixels where these are areas, the posts where they are points. */
#ifndef VTS_TERRAIN_GEOREFERENCE_H
#define VTS_TERRAIN_GEOREFERENCE_H

#include "terrain/projection.h"

typedef enum GeoHeights {
    GEO_HEIGHTS_UNKNOWN, /* nothing is said: above the sea, as a rule */
    GEO_HEIGHTS_GEOID,   /* above the sea */
    GEO_HEIGHTS_ELLIPSOID,
} GeoHeights;

typedef struct Georeference {
    bool placed;         /* the map lies somewhere: all down to `area` means something */
    bool has_projection; /* `projection` does, at least */
    Projection projection;
    double x[3], y[3];   /* x = x[0] + x[1] column + x[2] row, in the projection's units; y likewise */
    GeoPlace middle;     /* of the map: longitudes are taken near it, so that no map is torn at 180 degrees */
    double middle_x;     /* the same in the projection */
    double period;       /* of x around the globe, 0: it has none */
    bool area;           /* pixels are areas: the map reaches half a sample beyond its outer ones */
    /* height = (sample · scale + offset) · unit */
    double scale, offset;
    double unit; /* metres */
    GeoHeights heights;
    int vertical_epsg; /* of the vertical system, 0: not given */
    bool has_nodata;
    double nodata; /* the sample that says that there is none; compare after rounding both to the file's type */
} Georeference;

/* No place; heights are samples. */
void georeference_init(Georeference *reference);
/* Places a map by the corners of its outer edges (area) or by its outer samples (point), in the projection's units. In longitude and
 * latitude an east that is not beyond west is taken once more around the globe. False where the map has no extent. */
bool georeference_from_corners(Georeference *reference, const Projection *projection, const double west_south[2], const double east_north[2],
                               int columns, int rows, bool area);
/* Places it by x[3] and y[3] as above. False where these are not finite or fold the map into a line, or where its middle is nowhere on
 * the globe. */
bool georeference_from_affine(Georeference *reference, const Projection *projection, const double x[3], const double y[3], int columns, int rows,
                              bool area);

/* Whether such a map lies within longitudes from -360 to 360 and latitudes from -90 to 90: what files are taken to mean that do not say. */
bool georeference_looks_like_degrees(const double x[3], const double y[3], int columns, int rows);

/* The place of a sample, or between samples; its height is set to 0. */
bool georeference_to_geo(const Georeference *reference, double column, double row, GeoPlace *out);
bool georeference_from_geo(const Georeference *reference, GeoPlace place, double *column, double *row);

/* What a TIFF says of itself, whether it is a GeoTIFF or not (`placed` is false then). */
typedef struct TiffFacts {
    int width, height;
    int bits, channels;
    bool is_float, is_signed;
} TiffFacts;
typedef enum GeoreferenceStatus {
    GEOREFERENCE_OK,
    GEOREFERENCE_UNREADABLE, /* no TIFF, cut short, the module is missing */
    GEOREFERENCE_REFUSED,    /* a TIFF whose place cannot be used: its datum, its projection; the rest is filled in */
} GeoreferenceStatus;
/* Reads the tags of the first picture of a TIFF (`facts` may be NULL). Otherwise than OK: with a line of text in `error`. */
GeoreferenceStatus georeference_read_tiff(const char *path, Georeference *reference, TiffFacts *facts, StrBuf *error);

#endif
