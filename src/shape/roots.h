/* Real zeros of polynomials in one variable. */
#ifndef VTS_SHAPE_ROOTS_H
#define VTS_SHAPE_ROOTS_H

#include "base/common.h"

enum { ROOTS_HIGHEST_DEGREE = 40 };

/* Zeros in [lo, hi] of c[0] + c[1] x + … + c[degree] x^degree where it changes its sign, ascending, each to some roundings of
 * what the coefficients allow; returns their number. A place that the graph only touches may give none or two. Leading
 * zeros are allowed; for a polynomial that vanishes everywhere, or with coefficients that are not finite, 0. */
int roots_in(const double *c, int degree, double lo, double hi, double *out);
/* The same over all reals. */
int roots_real(const double *c, int degree, double *out);
/* The polynomial's value. */
double roots_value(const double *c, int degree, double x);

/* The zero between a and b of a continuous function with `at_a` and `at_b` there, of which just one is above 0: to `close`, or to
 * what doubles can tell. */
double roots_between(double (*f)(const void *context, double x), const void *context, double a, double at_a, double b, double at_b,
                     double close);

/* out[0 .. a + b] = the product of polynomials of degrees a and b; out must not overlap. */
void roots_multiply(const double *a, int a_degree, const double *b, int b_degree, double *out);

#endif
