/* The curves of POV-Ray's `assumed_gamma`: numbers that are light to the power of 1/gamma, or sent through the sRGB curve. Beyond [0, 1]
 * curves go on; what is below 0 is mirrored. */
#ifndef VTS_BASE_GAMMA_H
#define VTS_BASE_GAMMA_H

#include <math.h>

#define GAMMA_SRGB (-1.0) /* in place of an exponent: IEC 61966-2-1 */

/* Light of a number. */
static inline double gamma_to_light(double value, double gamma) {
    double v = fabs(value);
    if (gamma == 1) return value;
    if (gamma == GAMMA_SRGB) v = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    else v = pow(v, gamma);
    return copysign(v, value);
}

/* The number for light. */
static inline double gamma_from_light(double light, double gamma) {
    double v = fabs(light);
    if (gamma == 1) return light;
    if (gamma == GAMMA_SRGB) v = v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
    else v = pow(v, 1 / gamma);
    return copysign(v, light);
}

#endif
