/* The sRGB curve (IEC 61966-2-1). */
#ifndef VTS_IMAGE_SRGB_H
#define VTS_IMAGE_SRGB_H

#include <math.h>

/* Linear light in [0, 1] → code value in [0, 1]; NaN → 0, outside is clamped. */
static inline double srgb_encode(double linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 1;
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

/* Code value → linear light; below 0 is clamped, above 1 the curve goes on. */
static inline double srgb_decode(double code) {
    if (!(code > 0)) return 0;
    return code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4);
}

#endif
