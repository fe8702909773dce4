/* Random spans and places in them, the nasty ones among them, for tests of bounds. VTS_SPANS in the environment: how many of each operation. */
#ifndef VTS_TESTS_BOUNDS_SAMPLE_H
#define VTS_TESTS_BOUNDS_SAMPLE_H

#include "base/random.h"
#include "tape/tape_interval.h"

#include <stdlib.h>

/* How many spans a test takes of each operation. */
static inline uint64_t span_count(uint64_t usual) {
    const char *asked = getenv("VTS_SPANS");
    return asked ? strtoull(asked, NULL, 10) : usual;
}

static inline uint64_t bits(uint64_t i, uint32_t k) { return random_hash(0x696E7476, i, k, 0); }
static inline double unit(uint64_t i, uint32_t k) { return random_unit(bits(i, k)); }

static const double special[] = {0, -0.0, 1, -1, 0.5, 2, -2, 3, 10, VTS_PI, -VTS_PI, VTS_PI / 2, DBL_MAX, -DBL_MAX, DBL_MIN, -DBL_MIN, DBL_TRUE_MIN, -DBL_TRUE_MIN,
                                 HUGE_VAL, -HUGE_VAL, 0x1p53, 0x1p62, -0x1p63, 1e300, 1e-300, 0.9999999999999999, 1.0000000000000002, 255.5, 256};

/* A number of any size: small ones with few digits, any exponent, special ones. */
static inline double some_number(uint64_t i, uint32_t k) {
    switch (bits(i, k) % 8) {
    case 0: return special[bits(i, k + 1) % VTS_ARRAY_COUNT(special)];
    case 1: return ldexp(unit(i, k + 1) - 0.5, (int)(bits(i, k + 2) % 2100) - 1050);
    case 2: return floor(20 * unit(i, k + 1)) - 10;
    case 3: return ldexp(unit(i, k + 1) - 0.5, (int)(bits(i, k + 2) % 40) - 20);
    default: return 8 * (unit(i, k + 1) - 0.5);
    }
}

static inline Interval some_interval(uint64_t i, uint32_t k) {
    double a = some_number(i, k), b = some_number(i, k + 3);
    if (bits(i, k + 6) % 4 == 0) b = a;
    if (bits(i, k + 6) % 4 == 1) b = a + ldexp(unit(i, k + 3), -(int)(bits(i, k + 7) % 50));
    return interval(fmin(a, b), fmax(a, b));
}

/* Ends, middles, special values within. */
static inline double some_place(Interval a, uint64_t i, uint32_t k) {
    uint64_t kind = bits(i, k) % 8;
    if (kind == 0) return a.low;
    if (kind == 1) return a.high;
    if (kind == 2) {
        double x = special[bits(i, k + 1) % VTS_ARRAY_COUNT(special)];
        return interval_holds(a, x) ? x : a.low;
    }
    double u = unit(i, k + 1), x = isfinite(a.high - a.low) ? a.low + u * (a.high - a.low) : u * a.low + (1 - u) * a.high;
    if (kind == 3 && a.low > 0) x = exp(log(a.low) + u * (log(a.high) - log(a.low)));
    return interval_holds(a, x) ? x : a.high;
}

/* All operations with operands. */
static const struct {
    TapeOp op;
    const char *name;
    int arity;
} operations[] = {
#define ROW_0(name)
#define ROW_1(name) {TAPE_##name, #name, 1},
#define ROW_2(name) {TAPE_##name, #name, 2},
#define ROW_3(name) {TAPE_##name, #name, 3},
#define TAPE_OP(name, arity, text) ROW_##arity(name)
#include "tape/tape_ops.def"
#undef TAPE_OP
};

#endif
