/* One map as a file: its size, its place, and its samples from top to bottom. Nothing that a file says is trusted. */
#ifndef VTS_TERRAIN_MAP_FILE_H
#define VTS_TERRAIN_MAP_FILE_H

#include "terrain/georeference.h"

enum { MAP_LARGEST_SIDE = 1 << 20 };
#define MAP_LARGEST_COUNT ((size_t)1 << 32) /* posts of one file */

typedef struct MapFile MapFile;
struct MapFile {
    const char *path;    /* borrowed */
    const char *format;  /* "SRTM .hgt" */
    const char *samples; /* "16-bit signed" */
    int columns, rows;
    /* Where it says it lies; its nodata, scale, offset and unit hold whether or not it is placed. */
    Georeference place;
    StrBuf misplaced; /* why it is not placed, what would help: a line; when it is placed: what was taken for granted, or nothing */
    bool small_samples; /* floats hold samples without loss, and the most negative number of 16 bits is a void */
    /* The next `count` rows. */
    bool (*read)(MapFile *file, int count, float *samples, StrBuf *error);
    void (*close)(MapFile *file);
    void *state;
};

/* Opens what the file's content, or else its name, says it is. False with a line in `error`, without the path; nothing is left open then.
 * A file that is not placed is no error yet. */
bool map_file_open(MapFile *file, const char *path, StrBuf *error);
/* The next rows, samples as stored; NaN where there is none: by the file's word, `nodata` (or NULL), or because it is no height. */
bool map_file_read(MapFile *file, int count, const double *nodata, float *samples, StrBuf *error);
void map_file_close(MapFile *file);

/* The readers. Each sets what is in MapFile but `path`, from a file that is known to be there. */
bool map_open_hgt(MapFile *file, StrBuf *error);
bool map_open_grid(MapFile *file, StrBuf *error);
bool map_open_dem(MapFile *file, StrBuf *error);
bool map_open_picture(MapFile *file, StrBuf *error);
bool map_open_tiff(MapFile *file, StrBuf *error);

/* Appends a line; false, for returning it. */
bool map_fail(StrBuf *error, const char *format, ...) VTS_PRINTF(2, 3);

#endif
