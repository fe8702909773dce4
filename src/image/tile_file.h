/* What is done of a picture that is being drawn, kept in a file beside it, so that another run may go on where one was killed. Believes
 * nothing that it reads: a record that is broken, and all behind it, is as good as none. */
#ifndef VTS_IMAGE_TILE_FILE_H
#define VTS_IMAGE_TILE_FILE_H

#include "base/common.h"

typedef struct TileFile TileFile;

/* What tiles must agree in to belong to one picture. */
typedef struct TileFileKey {
    uint64_t picture; /* of everything that pixels depend on */
    int32_t region[4], channels;
    uint32_t tiles;
} TileFileKey;

/* A file for the picture at `picture_path`; what an older one has of the same picture is taken over if `resume`, else it goes. Tiles are
 * written once `delay` seconds have passed; unless `resume` there is no file before. NULL when memory is short and, if `resume`, when no file
 * can be made: pictures do without. */
TileFile *tile_file_open(const char *picture_path, const TileFileKey *key, bool resume, double delay);
/* The samples of a tile, `count` of them; false when it is not there. Thread-safe, as is the next. */
bool tile_file_read(TileFile *file, uint32_t tile, float *samples, size_t count);
/* Keeps a tile; where that fails the file is as it was, and takes no more. */
void tile_file_write(TileFile *file, uint32_t tile, const float *samples, size_t count);
/* How many tiles were taken over when it was opened. 0 for NULL. */
uint32_t tile_file_taken(const TileFile *file);
/* `finished`: the picture is written, and the file goes. NULL is fine. */
void tile_file_close(TileFile *file, bool finished);

#endif
