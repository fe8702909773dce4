/* Words that every file of vts uses: fixed-width types, small arithmetic, format checking. */
#ifndef VTS_BASE_COMMON_H
#define VTS_BASE_COMMON_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define VTS_ARRAY_COUNT(a) (sizeof(a) / sizeof((a)[0]))

#if defined(__GNUC__)
#define VTS_PRINTF(fmt_index, first_arg) __attribute__((format(printf, fmt_index, first_arg)))
#define VTS_NORETURN                     __attribute__((noreturn))
#define VTS_NOINLINE                     __attribute__((noinline))
#define VTS_EXPORT                       __attribute__((visibility("default")))
#else
#define VTS_PRINTF(fmt_index, first_arg)
#define VTS_NORETURN
#define VTS_NOINLINE
#define VTS_EXPORT
#endif

#define VTS_PI      3.14159265358979323846
#define VTS_INFINITY ((double)INFINITY)
#define VTS_RADIANS (VTS_PI / 180.0) /* degrees times this are radians */

static inline double double_min(double a, double b) { return a < b ? a : b; }
static inline double double_max(double a, double b) { return a > b ? a : b; }
static inline double double_clamp(double x, double lo, double hi) { return x < lo ? lo : x > hi ? hi : x; }
static inline float float_min(float a, float b) { return a < b ? a : b; }
static inline float float_max(float a, float b) { return a > b ? a : b; }
static inline float float_clamp(float x, float lo, float hi) { return x < lo ? lo : x > hi ? hi : x; }
static inline int int_min(int a, int b) { return a < b ? a : b; }
static inline int int_max(int a, int b) { return a > b ? a : b; }
static inline int int_clamp(int x, int lo, int hi) { return x < lo ? lo : x > hi ? hi : x; }
/* The whole part of x within [lo, hi]; NaN counts as 0. */
static inline int double_to_int(double x, int lo, int hi) {
    return x > lo && x < hi ? (int)x : x >= hi ? hi : x <= lo ? lo : int_clamp(0, lo, hi);
}
static inline size_t size_min(size_t a, size_t b) { return a < b ? a : b; }
static inline size_t size_max(size_t a, size_t b) { return a > b ? a : b; }

#endif
