/* Decimal numbers as they stand in texts, with a point whatever the locale of the program is. */
#ifndef VTS_BASE_DECIMAL_H
#define VTS_BASE_DECIMAL_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/common.h"

/* Digits as they are read, without the point. */
typedef struct Decimal {
    uint64_t digits; /* as a whole number; of more than 19 it is none */
    size_t count;    /* of digits after leading zeros */
    size_t after_point;
} Decimal;

static inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

/* Reads digits onto those that are there, leading zeros not counted; where they end. `at` ends with a zero byte, as all texts here. */
static inline const char *decimal_digits(const char *at, Decimal *d) {
    if (d->count == 0)
        while (*at == '0') at++;
    const char *begin = at;
    for (; is_digit(*at); at++) d->digits = d->digits * 10 + (uint64_t)(*at - '0');
    d->count += (size_t)(at - begin);
    return at;
}

/* Reads [digits] ["." [digits]], no sign and no exponent; where it ends, `at` itself if nothing of it stands there. */
static inline const char *decimal_read(const char *at, Decimal *out) {
    *out = (Decimal){0};
    at = decimal_digits(at, out);
    if (*at != '.') return at;
    const char *point = ++at;
    at = decimal_digits(at, out);
    out->after_point = (size_t)(at - point);
    return at;
}

/* The number itself; false where it has too many digits for that. Clinger 1990: whole numbers below 2^53 and powers of ten to 10^22 are
 * exact doubles, and so one division of them rounds as it should. */
static inline bool decimal_value(const Decimal *d, double *out) {
    static const double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    if (d->count > 15 || d->after_point >= VTS_ARRAY_COUNT(powers)) return false;
    *out = (double)d->digits / powers[d->after_point];
    return true;
}

/* As C's strtod() in the locale "C", errno and all. */
double decimal_strtod(const char *text, char **end);
/* As C's vsnprintf() in the locale "C". */
int decimal_vsnprintf(char *out, size_t size, const char *format, va_list args);

#endif
