/* Tubes round the y axis, their distance from it a polynomial of y. */
#include "tape/internal_parts.h"

#include <math.h>

enum { MOST_TUBES = 100000, MOST_UNROLLED = 64 };

static const double FARTHEST = 10000;

static int tubes(double count) { return count > 0 ? (int)double_min(count, MOST_TUBES) : 0; }

/* p[3] = how many, then the coefficients, the constant first. */
double internal_polytubes(const double *p) {
    double y = p[1], radius = p[4] + y * (p[5] + y * (p[6] + y * (p[7] + y * p[8]))), nearest = FARTHEST;
    for (int i = 0, count = tubes(p[3]); i < count; i++) {
        double angle = 2 * VTS_PI / p[3] * i;
        double x = p[0] - radius * sin(angle), z = p[2] - radius * cos(angle), across = sqrt(x * x + z * z);
        nearest = across < nearest ? across : nearest;
    }
    return nearest;
}

bool unroll_polytubes(TapeBuilder *b, const TapeRef *in, Span span, TapeRef *out) {
    double count;
    if (!tape_is_constant(b, in[3], &count) || tubes(count) > MOST_UNROLLED) return false;
    TapeRef radius = in[8], nearest = tape_constant(b, FARTHEST);
    for (int k = 7; k >= 4; k--) radius = tape_binary(b, TAPE_ADD, in[k], tape_binary(b, TAPE_MUL, in[1], radius, span), span);
    for (int i = 0; i < tubes(count); i++) {
        double angle = 2 * VTS_PI / count * i;
        const double way[2] = {sin(angle), cos(angle)};
        TapeRef square[2];
        for (int k = 0; k < 2; k++) {
            TapeRef off = tape_binary(b, TAPE_MUL, radius, tape_constant(b, way[k]), span);
            square[k] = tape_unary(b, TAPE_SQR, tape_binary(b, TAPE_SUB, in[2 * k], off, span), span);
        }
        TapeRef across = tape_unary(b, TAPE_SQRT, tape_binary(b, TAPE_ADD, square[0], square[1], span), span);
        nearest = tape_binary(b, TAPE_MIN, across, nearest, span);
    }
    return *out = nearest, true;
}
