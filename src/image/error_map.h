/* Maps of errors as pictures. */
#ifndef VTS_IMAGE_ERROR_MAP_H
#define VTS_IMAGE_ERROR_MAP_H

#include "image/image.h"

/* A value in [0, 1] as linear R G B, dark to light through violet, red and yellow: lightness rises evenly, so that the map reads in
 * grey, too. NaN is 1. */
void error_color(double value, float rgb[3]);

/* Saves a map of width × height values: as one float channel Y where the format holds floats, else in the colours above.
 * False with a line in `error`. */
bool error_map_save(const float *map, int width, int height, const char *path, MemoryBudget *budget, StrBuf *error);

#endif
