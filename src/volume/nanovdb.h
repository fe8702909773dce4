/* NanoVDB files: grids of numbers in sparse trees (Museth, *NanoVDB: A GPU-Friendly and Portable VDB Data Structure*, 2021), read by the file's public layout. */
#ifndef VTS_VOLUME_NANOVDB_H
#define VTS_VOLUME_NANOVDB_H

#include "volume/grid_file.h"

/* The grid of this name, or the first (name NULL), as cells of the box that its root says is filled. Numbers are floats of 32 bits, or such as are packed in 4, 8, 16 or as many bits
 * as each leaf needs; files are not compressed, or by ZIP. out->place is where the file says that the box lies. Every offset is checked. False with a line in `error`. */
bool nanovdb_decode(const unsigned char *bytes, size_t size, const char *name, Arena *arena, DensityGrid *out, StrBuf *error);
bool nanovdb_load(const char *path, const char *name, Arena *arena, DensityGrid *out, StrBuf *error);

#endif
