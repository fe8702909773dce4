/* The tilings of the x-z plane that are drawn. */
#ifndef VTS_PATTERN_TILING_H
#define VTS_PATTERN_TILING_H

#include "base/vec.h"

/* POV-Ray's number for a tile's kind and how near its rim is: of N kinds the k-th (from 0) goes from k/N in the middle to (k + 1)/N at
 * the rim. `tiling`: 1 to TILING_MOST, else 0.5. */
double tiling_number(int tiling, Vec3 p);

#endif
