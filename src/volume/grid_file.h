/* Files of densities. */
#ifndef VTS_VOLUME_GRID_FILE_H
#define VTS_VOLUME_GRID_FILE_H

#include "base/strbuf.h"
#include "volume/grid.h"

typedef enum GridSample { GRID_UINT8, GRID_UINT16, GRID_FLOAT } GridSample;

/* What a raw file does not say itself. */
typedef struct GridRaw {
    int size[3]; /* x fastest */
    GridSample sample;
    bool big; /* endian */
} GridRaw;

/* POV-Ray's df3: three big-endian 16-bit sizes, then that many whole numbers of 1, 2 or 4 bytes, big-endian; scaled to [0, 1]. */
bool grid_decode_df3(const unsigned char *bytes, size_t size, Arena *arena, DensityGrid *out, StrBuf *error);
/* Numbers alone: whole ones are scaled to [0, 1]; floats are as they are, what is negative or no number is 0. */
bool grid_decode_raw(const unsigned char *bytes, size_t size, const GridRaw *raw, Arena *arena, DensityGrid *out, StrBuf *error);

/* The same from files, all in `arena`. raw NULL: df3. False with a line in `error`. */
bool grid_load(const char *path, const GridRaw *raw, Arena *arena, DensityGrid *out, StrBuf *error);

#endif
