/* prove_noise: proves the bounds of the lattice noises and of their derivatives along unit directions (noise.h, noise_taylor.h), for
 * all that a lattice may hold. Exit status 1: one could not be proved.
 *
 * In a cell the noise is the sum over its corners c of W_c·(w/2 + g·(p − c)), W_c a product of three curves. Its m-th derivative along d
 * is a sum over the corners of
 *
 *     w/2·Dᵐ W_c + g·(Dᵐ W_c (p − c) + m Dᵐ⁻¹ W_c d),
 *
 * linear in what the lattice holds at that corner. So the largest over all lattices is a sum of eight support functions: with
 * Perlin's twelve gradients the two largest absolute components of the second bracket, with POV-Ray's weights in [-1, 1] the sum of all.
 *
 * The claim for d = (1, a, b), the largest component first: that sum is at most bound·|d|ᵐ. Boxes of (x, y, z, a, b) are divided until
 * it is proved in each. On a box each bracket is a linear function of the place in it and a rest (affine arithmetic of five symbols).
 * Support functions are convex and add up to at most those of the linear parts and those of the rests; |d|ᵐ is convex and above its
 * tangent plane. So linear part less plane is convex, and largest at one of the 32 corners of the box.
 *
 * Mirroring an axis and exchanging axes map cells on cells: x, y, z in [0, 1/2] and the first component of d the largest are all there is.
 * Roundings are below 2⁻⁴⁰ of the sums, whose terms are below 2¹⁰ times the bound; ROUNDING of the bound is left to them. */
#include "tape/noise.h"
#include "tape/noise_taylor.h"

#include <stdio.h>
#include <string.h>

enum { SYMBOLS = 5, CORNERS = 1 << SYMBOLS, MOST_DEPTH = 120, X = 0, Y = 1, Z = 2, A = 3, B = 4 };

static const double ROUNDING = 0x1p-26;

/* centre + Σ slope·s + error·e */
typedef struct Form {
    double centre, slope[SYMBOLS], error;
} Form;

typedef struct Box {
    double middle[SYMBOLS], half[SYMBOLS];
    int depth;
} Box;

typedef struct Claim {
    const char *name;
    const double *curve; /* coefficients of t⁰ … t⁵ */
    bool weights;        /* a value and gradients in [-1, 1]; else Perlin's directions */
    int order;
    double bound;
} Claim;

static Form plus(Form a, Form b) {
    a.centre += b.centre, a.error += b.error;
    for (int k = 0; k < SYMBOLS; k++) a.slope[k] += b.slope[k];
    return a;
}

static Form times(Form a, double by) {
    a.centre *= by, a.error *= fabs(by);
    for (int k = 0; k < SYMBOLS; k++) a.slope[k] *= by;
    return a;
}

/* Squares of symbols are in [0, 1]: half of them goes to the centre. */
static Form product(Form a, Form b) {
    Form out = {.centre = a.centre * b.centre};
    double sum_a = 0, sum_b = 0, squares = 0, both = 0;
    for (int k = 0; k < SYMBOLS; k++) {
        double square = a.slope[k] * b.slope[k];
        out.slope[k] = a.centre * b.slope[k] + b.centre * a.slope[k];
        out.centre += square / 2, squares += fabs(square) / 2, both += fabs(square);
        sum_a += fabs(a.slope[k]), sum_b += fabs(b.slope[k]);
    }
    out.error = squares + (sum_a * sum_b - both) + (fabs(a.centre) + sum_a) * b.error +
                (fabs(b.centre) + sum_b) * a.error + a.error * b.error;
    return out;
}

static Form variable(const Box *box, int k) {
    Form out = {.centre = box->middle[k]};
    out.slope[k] = box->half[k];
    return out;
}

/* The i-th derivative of the curve, by its Taylor polynomial about the middle. */
static Form curve(const double *coefficients, int derivative, const Box *box, int axis) {
    double c[6], m = box->middle[axis], h = 1;
    Form out = {0};
    memcpy(c, coefficients, sizeof c);
    for (int i = 0; i < derivative; i++) {
        for (int k = 0; k < 5; k++) c[k] = c[k + 1] * (k + 1);
        c[5] = 0;
    }
    for (int i = 0; i < 6; i++) /* about m */
        for (int k = 4; k >= i; k--) c[k] += m * c[k + 1];
    for (int k = 0; k < 6; k++, h *= box->half[axis]) {
        double term = c[k] * h;
        if (k == 0)
            out.centre += term;
        else if (k == 1)
            out.slope[axis] = term;
        else if (k % 2 == 0)
            out.centre += term / 2, out.error += fabs(term) / 2;
        else
            out.error += fabs(term);
    }
    return out;
}

enum { MOST_ORDER = 3 };

typedef struct Cell {
    Form curves[3][MOST_ORDER +
                   1]; /* of an axis, by derivative, times that power of the direction's component */
    Form place[3], along[3];
} Cell;

static Cell cell_of(const Claim *claim, const Box *box) {
    Cell cell;
    cell.along[0] = (Form){.centre = 1}, cell.along[1] = variable(box, A), cell.along[2] = variable(box, B);
    for (int k = 0; k < 3; k++) {
        Form power = {.centre = 1};
        cell.place[k] = variable(box, k);
        for (int i = 0; i <= claim->order; i++) {
            cell.curves[k][i] = product(curve(claim->curve, i, box, k), power);
            power = product(power, cell.along[k]);
        }
    }
    return cell;
}

/* Of the weight of a corner, 1 − curve on the near sides. */
static Form side(const Cell *cell, int axis, int derivative, bool far) {
    Form f = cell->curves[axis][derivative];
    if (far) return f;
    f = times(f, -1);
    if (derivative == 0) f.centre += 1;
    return f;
}

static Form weight(const Cell *cell, int corner, int order) {
    static const double factorial[] = {1, 1, 2, 6};
    Form sum = {0};
    for (int i = 0; i <= order; i++)
        for (int j = 0; i + j <= order; j++) {
            int k = order - i - j;
            Form term = product(product(side(cell, 0, i, corner & 1), side(cell, 1, j, corner >> 1 & 1)),
                                side(cell, 2, k, corner >> 2));
            sum = plus(sum, times(term, factorial[order] / (factorial[i] * factorial[j] * factorial[k])));
        }
    return sum;
}

static double support(const Claim *claim, const double v[4]) {
    double x = fabs(v[1]), y = fabs(v[2]), z = fabs(v[3]);
    return claim->weights ? fabs(v[0]) + x + y + z : x + y + z - fmin(x, fmin(y, z));
}

static void brackets(const Claim *claim, const Cell *cell, int corner, Form out[4]) {
    int m = claim->order;
    Form highest = weight(cell, corner, m), lower = m > 0 ? weight(cell, corner, m - 1) : (Form){0};
    out[0] = times(highest, 0.5);
    for (int k = 0; k < 3; k++) {
        Form from = cell->place[k];
        from.centre -= corner >> k & 1;
        out[k + 1] = plus(product(highest, from), times(product(lower, cell->along[k]), m));
    }
}

/* Linear parts at a corner of the box. */
static double at_corner(const Claim *claim, Form all[8][4], int signs) {
    double sum = 0;
    for (int c = 0; c < 8; c++) {
        double v[4];
        for (int j = 0; j < 4; j++) {
            v[j] = all[c][j].centre;
            for (int k = 0; k < SYMBOLS; k++)
                v[j] += signs >> k & 1 ? all[c][j].slope[k] : -all[c][j].slope[k];
        }
        sum += support(claim, v);
    }
    return sum;
}

static bool proved(const Claim *claim, const Box *box) {
    Cell cell = cell_of(claim, box);
    Form all[8][4];
    double rest = 0, a = box->middle[A], b = box->middle[B], m = claim->order;
    for (int c = 0; c < 8; c++) {
        brackets(claim, &cell, c, all[c]);
        rest +=
            support(claim, (double[]){all[c][0].error, all[c][1].error, all[c][2].error, all[c][3].error});
    }
    double length = pow(1 + a * a + b * b, m / 2), tilt = m * pow(1 + a * a + b * b, m / 2 - 1);
    for (int s = 0; s < CORNERS; s++) {
        double plane = length + tilt * a * (s >> A & 1 ? box->half[A] : -box->half[A]) +
                       tilt * b * (s >> B & 1 ? box->half[B] : -box->half[B]);
        if (!(at_corner(claim, all, s) + rest <= claim->bound * (plane - ROUNDING))) return false;
    }
    return true;
}

/* Directions matter less than places. */
static int longest(const Claim *claim, const Box *box) {
    int at = 0;
    for (int k = 1; k < (claim->order ? SYMBOLS : 3); k++)
        if (box->half[k] * (k < A ? 4 : 1) > box->half[at] * (at < A ? 4 : 1)) at = k;
    return at;
}

static bool prove(const Claim *claim, uint64_t *boxes) {
    static Box stack[MOST_DEPTH + 2];
    int count = 1;
    stack[0] =
        (Box){{0.25, 0.25, 0.25, 0, 0}, {0.25, 0.25, 0.25, claim->order ? 1 : 0, claim->order ? 1 : 0}, 0};
    while (count > 0) {
        Box box = stack[--count];
        ++*boxes;
        if (proved(claim, &box)) continue;
        if (box.depth >= MOST_DEPTH) return false;
        int k = longest(claim, &box);
        box.depth++, box.half[k] /= 2;
        for (int side_ = -1; side_ <= 1; side_ += 2) {
            stack[count] = box;
            stack[count++].middle[k] += side_ * box.half[k];
        }
    }
    return true;
}

int main(void) {
    static const double perlin[6] = {0, 0, 0, 10, -15, 6}, pov[6] = {0, 0, 3, -2, 0, 0};
    const double scale = 0.48985582; /* of POV-Ray's noise: see noise_pov.c */
    const Claim claims[] = {
        {"perlin", perlin, false, 0, NOISE_PERLIN_MOST},
        {"perlin'", perlin, false, 1, NOISE_PERLIN_STEEPEST},
        {"perlin''", perlin, false, 2, NOISE_PERLIN_CURVATURE},
        {"perlin'''", perlin, false, 3, NOISE_PERLIN_THIRD},
        {"pov'", pov, true, 1, NOISE_POV_STEEPEST / scale},
        {"pov''", pov, true, 2, NOISE_POV_CURVATURE / scale},
        {"pov'''", pov, true, 3, NOISE_POV_THIRD / scale},
    };
    bool all = true;
    for (size_t i = 0; i < sizeof claims / sizeof *claims; i++) {
        uint64_t boxes = 0;
        bool ok = prove(&claims[i], &boxes);
        all &= ok;
        printf("%-10s at most %-9.6g %s, %llu boxes\n", claims[i].name, claims[i].bound,
               ok ? "proved" : "NOT proved", (unsigned long long)boxes);
        fflush(stdout);
    }
    return all ? 0 : 1;
}
