/* How far two pictures are apart. */
#ifndef VTS_IMAGE_METRICS_H
#define VTS_IMAGE_METRICS_H

#include "image/image.h"

typedef struct ImageDifference {
    double rmse;       /* over pixels and channels, linear light clamped to [0,1] */
    double psnr;       /* dB, of the same after the sRGB curve, peak 1; infinite for equal pictures */
    double largest;    /* largest difference of a sample, linear and clamped */
    int x, y;          /* where that is */
    size_t not_finite; /* samples that are infinite or NaN in either picture; NaN counts as 0 in the above */
} ImageDifference;

/* Compares R G B, where both pictures have them; else Y with Y; else the first channels. A grey picture beside a colour
 * one is taken as R = G = B. False when the sizes differ. */
bool image_compare(const Image *a, const Image *b, ImageDifference *out, StrBuf *error);

/* Test less reference of every pixel and colour, linear light clamped to [0, 1]: 3 * width * height floats. Both have the same size. */
void image_subtract(const Image *reference, const Image *test, float *out);

#endif
