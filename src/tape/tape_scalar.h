/* The reference arithmetic: what each operation of tape_ops.def does to doubles. The batch evaluator runs these same
 * functions over arrays, or those of tape_rows.h, which are equal bit for bit. */
#ifndef VTS_TAPE_TAPE_SCALAR_H
#define VTS_TAPE_TAPE_SCALAR_H

#include "tape/elementary.h"
#include "tape/noise.h"

#include <math.h>

static inline double scalar_ADD(double a, double b) { return a + b; }
static inline double scalar_SUB(double a, double b) { return a - b; }
static inline double scalar_MUL(double a, double b) { return a * b; }
static inline double scalar_DIV(double a, double b) { return a / b; }
static inline double scalar_NEG(double a) { return -a; }
static inline double scalar_SQR(double a) { return a * a; }
static inline double scalar_ABS(double a) { return fabs(a); }
static inline double scalar_MIN(double a, double b) { return a < b ? a : b; }
static inline double scalar_MAX(double a, double b) { return a > b ? a : b; }

static inline double scalar_LT(double a, double b) { return a < b ? 1.0 : 0.0; }
static inline double scalar_LE(double a, double b) { return a <= b ? 1.0 : 0.0; }
static inline double scalar_GT(double a, double b) { return a > b ? 1.0 : 0.0; }
static inline double scalar_GE(double a, double b) { return a >= b ? 1.0 : 0.0; }
static inline double scalar_EQ(double a, double b) { return a == b ? 1.0 : 0.0; }
static inline double scalar_NE(double a, double b) { return a != b ? 1.0 : 0.0; }
static inline double scalar_AND(double a, double b) { return a != 0 && b != 0 ? 1.0 : 0.0; }
static inline double scalar_OR(double a, double b) { return a != 0 || b != 0 ? 1.0 : 0.0; }
static inline double scalar_SELECT(double a, double b, double c) { return a < 0 ? b : c; }

static inline double scalar_FLOOR(double a) { return floor(a); }
static inline double scalar_CEIL(double a) { return ceil(a); }
static inline double scalar_INT(double a) { return trunc(a); }
static inline double scalar_IDIV(double a, double b) { return trunc(a / b); }
static inline double scalar_MOD(double a, double b) { return fmod(a, b); }
static inline double scalar_FOLD(double a, double b) { return fabs(fmod(fabs(a), b) - fabs(b) / 2); }

static inline bool scalar_fits_integer(double a) { return fabs(a) < 0x1p63; }
static inline double scalar_BITWISE_AND(double a, double b) {
    return scalar_fits_integer(a) && scalar_fits_integer(b) ? (double)((int64_t)a & (int64_t)b) : (double)NAN;
}
static inline double scalar_BITWISE_OR(double a, double b) {
    return scalar_fits_integer(a) && scalar_fits_integer(b) ? (double)((int64_t)a | (int64_t)b) : (double)NAN;
}
static inline double scalar_BITWISE_XOR(double a, double b) {
    return scalar_fits_integer(a) && scalar_fits_integer(b) ? (double)((int64_t)a ^ (int64_t)b) : (double)NAN;
}

static inline double scalar_SQRT(double a) { return sqrt(a); }
static inline double scalar_EXP(double a) { return elementary_exp(a); }
static inline double scalar_LN(double a) { return elementary_ln(a); }
static inline double scalar_LOG(double a) { return log10(a); }
static inline double scalar_POW(double a, double b) { return pow(a, b); }
static inline double scalar_SIN(double a) { return elementary_sin(a); }
static inline double scalar_COS(double a) { return elementary_cos(a); }
static inline double scalar_TAN(double a) { return elementary_tan(a); }
static inline double scalar_ASIN(double a) { return asin(a); }
static inline double scalar_ACOS(double a) { return acos(a); }
static inline double scalar_ATAN(double a) { return elementary_atan(a); }
static inline double scalar_ATAN2(double a, double b) { return elementary_atan2(a, b); }
static inline double scalar_SINH(double a) { return sinh(a); }
static inline double scalar_COSH(double a) { return cosh(a); }
static inline double scalar_TANH(double a) { return tanh(a); }
static inline double scalar_ASINH(double a) { return asinh(a); }
static inline double scalar_ACOSH(double a) { return acosh(a); }
static inline double scalar_ATANH(double a) { return atanh(a); }
static inline double scalar_DEGREES(double a) { return a * (180.0 / VTS_PI); }
static inline double scalar_RADIANS(double a) { return a * VTS_RADIANS; }

static inline double scalar_PERLIN(double a, double b, double c) { return noise_perlin(vec3(a, b, c)); }
static inline double scalar_POV_NOISE(double a, double b, double c) { return noise_pov(vec3(a, b, c)); }

#endif
