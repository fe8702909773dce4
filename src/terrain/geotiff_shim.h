/* What libgeotiff, libtiff and PROJ do for us: the interface of the module vts_geotiff, which is loaded when the first GeoTIFF is opened
 * or a coordinate system is asked for that is not arithmetic (geotiff_module.h). Plain facts; what they mean is decided by
 * georeference_tiff.c and projection_epsg.c. */
#ifndef VTS_TERRAIN_GEOTIFF_SHIM_H
#define VTS_TERRAIN_GEOTIFF_SHIM_H

#include "base/common.h"

/* Changes with every change of this file; a module with another number is not used. */
enum { GEOTIFF_SHIM_VERSION = 1, GEOTIFF_ERROR_SIZE = 256, GEOTIFF_PARAMETERS = 10, GEOTIFF_TIE_POINTS = 4096 };

enum { GEOTIFF_MODEL_NONE, GEOTIFF_MODEL_PROJECTED, GEOTIFF_MODEL_GEOGRAPHIC, GEOTIFF_MODEL_GEOCENTRIC };

/* A coordinate system, after the lists have been asked for what the keys leave out. Codes are those of GeoTIFF and EPSG; 32767 means
 * "given by what follows", 0 that nothing is known. */
typedef struct GeotiffSystem {
    int model;
    int projected, geographic, datum;
    char datum_name[64];
    double semi_major, semi_minor; /* metres */
    double prime_meridian;         /* degrees */
    double degrees;                /* of one angular unit */
    double metres;                 /* of one unit of length */
    int method;                    /* of projection: GeoTIFF's CT_ codes */
    int parameter_count;
    struct {
        int key; /* of GeoTIFF */
        double value; /* degrees, metres */
    } parameters[GEOTIFF_PARAMETERS];
    int shift_count; /* 0, 3 or 7: of the datum to WGS84, given by the file */
    double shift[7]; /* metres, seconds of arc, parts per million */
} GeotiffSystem;

typedef struct GeotiffTie {
    double pixel[2], place[2];
} GeotiffTie;

typedef struct GeotiffFile {
    uint32_t width, height;
    int bits, channels, sample_format; /* TIFF's: 1 unsigned, 2 signed, 3 floating-point */
    bool has_keys;
    GeotiffSystem system;
    bool point;       /* pixels are points */
    bool above_ellipsoid; /* the geographic system has heights of its own */
    int vertical;           /* code of the vertical system; 0: not given */
    double vertical_metres; /* of one vertical unit, negative for depths; 0: not given */
    bool has_scale, has_matrix;
    double scale[2];
    double matrix[6];       /* x = m0 column + m1 row + m2, y likewise */
    size_t tie_count;
    GeotiffTie *ties;       /* the first GEOTIFF_TIE_POINTS; malloc() */
    char *nodata, *metadata; /* texts of GDAL's tags, or NULL; malloc() */
} GeotiffFile;

typedef struct GeotiffShim {
    int version; /* GEOTIFF_SHIM_VERSION */
    /* Tags of the first picture of a file. False with a line of text in `error`, and nothing to release. */
    bool (*read)(const char *path, GeotiffFile *file, char error[GEOTIFF_ERROR_SIZE]);
    void (*release)(GeotiffFile *file);
    /* The system with this code, projected or geographic. False when the lists do not know it. */
    bool (*system)(int code, GeotiffSystem *system);
} GeotiffShim;

/* The one symbol of the module. */
VTS_EXPORT const GeotiffShim *vts_geotiff_shim(void);

#endif
