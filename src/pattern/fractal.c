/* Escape-time fractals in x and y. The operations keep POV-Ray's order: iterated, other roundings soon show. */
#include "pattern/numbers.h"

typedef struct Complex {
    double re, im;
} Complex;

static double square(double a) { return a * a; }
static double norm(Complex z) { return z.re * z.re + z.im * z.im; }

static double binomial(int n, int k) {
    double product = 1;
    for (int i = 1; i <= k; i++) product = product * (n - k + i) / i;
    return product;
}

/* zⁿ from the binomial series. */
static Complex general_power(Complex z, int n) {
    Complex sum = {pow(z.re, n), 0};
    for (int k = 1; k <= n; k++) {
        double term = (k & 2 ? -1 : 1) * binomial(n, k) * pow(z.re, n - k) * pow(z.im, k);
        if (k % 2)
            sum.im += term;
        else
            sum.re += term;
    }
    return sum;
}

static Complex power(Complex z, int n) {
    double a = z.re, b = z.im, a2 = a * a, b2 = b * b;
    switch (n) {
    case 2: return (Complex){a2 - b2, 2 * a * b};
    case 3: return (Complex){a2 * a - 3 * a * b2, 3 * a2 * b - b2 * b};
    case 4: return (Complex){a2 * a2 - 6 * a2 * b2 + b2 * b2, 4 * (a2 * a * b - a * b2 * b)};
    default: return general_power(z, n);
    }
}

static Complex squared_quotient(Complex u, Complex v) {
    double scale = v.re * v.re + v.im * v.im;
    double a = (u.re * v.re + u.im * v.im) / scale, b = (u.im * v.re - u.re * v.im) / scale;
    return (Complex){a * a - b * b, 2 * a * b};
}

/* ((z² + c - 1) / (2z + c - 2))² */
static Complex magnet1(Complex z, Complex c) {
    double a = z.re, b = z.im;
    return squared_quotient((Complex){a * a - b * b + c.re - 1, 2 * a * b + c.im},
                            (Complex){2 * a + c.re - 2, 2 * b + c.im});
}

/* ((z³ + 3(c - 1)z + (c - 1)(c - 2)) / (3z² + 3(c - 2)z + (c - 1)(c - 2) + 1))² */
static Complex magnet2(Complex z, Complex c) {
    double a = z.re, b = z.im, a2 = a * a, b2 = b * b, c1 = c.re - 1, c2 = c.re - 2;
    double re = c1 * c2 - c.im * c.im, im = (c1 + c2) * c.im;
    Complex u = {a2 * a - 3 * a * b2 + 3 * (a * c1 - b * c.im) + re,
                 3 * a2 * b - b2 * b + 3 * (a * c.im + b * c1) + im};
    Complex v = {3 * (a2 - b2) + 3 * (a * c2 - b * c.im) + re + 1, 6 * a * b + 3 * (a * c.im + b * c2) + im};
    return squared_quotient(u, v);
}

static Complex step(const FractalSettings *f, Complex z, Complex c) {
    if (f->magnet) return f->magnet == 1 ? magnet1(z, c) : magnet2(z, c);
    Complex next = power(z, f->exponent);
    return (Complex){next.re + c.re, next.im + c.im};
}

/* Magnets end far away or near their fixed point 1. */
static bool escaped(const FractalSettings *f, Complex z) {
    if (!f->magnet) return norm(z) > 4;
    return norm(z) > 10000 || square(z.re - 1) + square(z.im) < 1 / 10000.;
}

static double remainder_of(int iterations, double period, double factor) {
    int whole = period >= 1 && period < 1e9 ? (int)period : 0;
    return whole ? iterations % whole / factor : 0;
}

static double exterior(const FractalSettings *f, int iterations, Complex z) {
    double factor = f->exterior_factor;
    switch (f->exterior) {
    case 0: return factor;
    case 1: return (double)iterations / f->iterations;
    case 2: return z.re * factor;
    case 3: return z.im * factor;
    case 4: return z.re * z.re * factor;
    case 5: return z.im * z.im * factor;
    case 6: return sqrt(norm(z)) * factor;
    case 7: return remainder_of(iterations, factor, factor);
    case 8: return remainder_of(iterations, 1 + factor, factor);
    default: return 0;
    }
}

/* Number 6 multiplies only the second square: POV-Ray's. */
static double interior(const FractalSettings *f, Complex z, double nearest) {
    double factor = f->interior_factor;
    switch (f->interior) {
    case 0: return factor;
    case 1: return sqrt(nearest) * factor;
    case 2: return z.re * factor;
    case 3: return z.im * factor;
    case 4: return z.re * z.re * factor;
    case 5: return z.im * z.im * factor;
    case 6: return z.re * z.re + z.im * z.im * factor;
    default: return 0;
    }
}

/* Whether the iteration from z never ends otherwise than by its count, as it comes back to where it was to the last bit (Brent 1980): then only
 * the place in the cycle counts. */
typedef struct Cycle {
    Complex mark;
    int marked, next; /* iterations */
} Cycle;

/* The iteration to go on with: `i`, or one that as many whole cycles lie before the last. */
static int behind_cycles(Cycle *cycle, Complex z, int i, int iterations) {
    if (z.re == cycle->mark.re && z.im == cycle->mark.im) {
        const int length = i - cycle->marked;
        cycle->next = iterations;
        return i + (iterations - 1 - i) / length * length;
    }
    if (i == cycle->next) cycle->mark = z, cycle->marked = i, cycle->next = i < iterations / 2 ? 2 * i : iterations;
    return i;
}

/* What most pictures ask for: z² + c. */
static double square_number(const FractalSettings *f, Complex z, Complex c) {
    double nearest = norm(z);
    Cycle cycle = {{NAN, NAN}, 0, 8};
    for (int i = 0; i < f->iterations; i++) {
        const double re = z.re * z.re - z.im * z.im + c.re, im = 2 * z.re * z.im + c.im;
        const double reach = re * re + im * im;
        z.re = re, z.im = im;
        nearest = nearest < reach ? nearest : reach;
        if (reach > 4) return exterior(f, i, z);
        if (cycle.next < f->iterations) i = behind_cycles(&cycle, z, i, f->iterations);
    }
    return interior(f, z, nearest);
}

/* ---- side by side ---- */

/* Two doubles are a register of every x86-64; of wider vectors some compilers compare the numbers one by one where there is no AVX. */
enum { PAIRS = FRACTAL_LANES / 2 };
typedef double Pair __attribute__((vector_size(16)));
typedef int64_t PairBits __attribute__((vector_size(16)));

typedef struct Orbits {
    Pair re[PAIRS], im[PAIRS], nearest[PAIRS]; /* nearest: the least of the squares of their sizes so far */
} Orbits;

/* Iterations of square_number() in lanes: each waits for the one before it, so that several take hardly longer than one. Whoever has
 * ended stays at 0 for good, where it neither escapes nor meets its mark. */
typedef struct Squares {
    const FractalSettings *settings;
    Orbits now;
    Pair c_re[PAIRS], c_im[PAIRS], mark_re[PAIRS], mark_im[PAIRS];
    int marked, next; /* as a Cycle's, in iterations that are done */
    bool done[FRACTAL_LANES];
    int left;
    PairBits escaping[PAIRS], returned[PAIRS]; /* in how many of the iterations that were made last; returned: by what of it is real, at least */
} Squares;

static inline void iterate_pair(Squares *s, int h, int count) {
    Pair re = s->now.re[h], im = s->now.im[h], nearest = s->now.nearest[h];
    PairBits escaping = {0}, returned = {0};
    for (int i = 0; i < count; i++) {
        const Pair next_re = re * re - im * im + s->c_re[h], next_im = 2 * re * im + s->c_im[h];
        const Pair reach = next_re * next_re + next_im * next_im;
        const PairBits nearer = nearest < reach;
        nearest = (Pair)((nearer & (PairBits)nearest) | (~nearer & (PairBits)reach));
        re = next_re, im = next_im;
        escaping -= reach > 4;
        returned -= re == s->mark_re[h];
    }
    s->now.re[h] = re, s->now.im[h] = im, s->now.nearest[h] = nearest;
    s->escaping[h] = escaping, s->returned[h] = returned;
}

static inline void iterate(Squares *s, int count) {
    for (int h = 0; h < PAIRS; h++) iterate_pair(s, h, count);
}

static double lane(const Pair pairs[PAIRS], int k) { return pairs[k / 2][k % 2]; }

static Complex place_of(const Squares *s, int k) { return (Complex){lane(s->now.re, k), lane(s->now.im, k)}; }

static void end_lane(Squares *s, int k, double value, double values[FRACTAL_LANES]) {
    values[k] = value;
    s->now.re[k / 2][k % 2] = s->now.im[k / 2][k % 2] = s->c_re[k / 2][k % 2] = s->c_im[k / 2][k % 2] = 0;
    s->mark_re[k / 2][k % 2] = NAN;
    s->done[k] = true;
    s->left--;
}

static void mark_lanes(Squares *s, int made) {
    for (int h = 0; h < PAIRS; h++) s->mark_re[h] = s->now.re[h], s->mark_im[h] = s->now.im[h];
    for (int k = 0; k < FRACTAL_LANES; k++)
        if (s->done[k]) s->mark_re[k / 2][k % 2] = NAN;
    s->marked = made, s->next = made < s->settings->iterations / 2 ? 2 * made : s->settings->iterations;
}

/* The last place of a lane that is back at its mark: what whole cycles leave. */
static Complex behind_mark(const Squares *s, int k, int made) {
    Complex z = place_of(s, k);
    for (int rest = (s->settings->iterations - made) % (made - s->marked); rest > 0; rest--)
        z = (Complex){z.re * z.re - z.im * z.im + lane(s->c_re, k), 2 * z.re * z.im + lane(s->c_im, k)};
    return z;
}

/* Those that end with the last of the iterations made. */
static void end_lanes(Squares *s, int made, double values[FRACTAL_LANES]) {
    for (int k = 0; k < FRACTAL_LANES; k++)
        if (s->escaping[k / 2][k % 2])
            end_lane(s, k, exterior(s->settings, made - 1, place_of(s, k)), values);
        else if (s->returned[k / 2][k % 2] && lane(s->now.im, k) == lane(s->mark_im, k))
            end_lane(s, k, interior(s->settings, behind_mark(s, k, made), lane(s->now.nearest, k)), values);
}

static bool something_ends(const Squares *s) {
    PairBits any = {0};
    for (int h = 0; h < PAIRS; h++) any |= s->escaping[h] | s->returned[h];
    return (any[0] | any[1]) != 0;
}

/* A few at once, and one by one where one of them was too far. */
static void square_numbers(Squares *s, double values[FRACTAL_LANES]) {
    enum { AT_ONCE = 4 };
    const int iterations = s->settings->iterations;
    for (int h = 0; h < PAIRS; h++) {
        s->now.nearest[h] = s->now.re[h] * s->now.re[h] + s->now.im[h] * s->now.im[h];
        s->mark_re[h] = s->mark_im[h] = (Pair){NAN, NAN};
    }
    s->next = 8, s->left = FRACTAL_LANES;
    for (int made = 0; made < iterations && s->left > 0;) {
        const Orbits before = s->now;
        const int ahead = iterations - made < AT_ONCE ? iterations - made : AT_ONCE;
        if (ahead == AT_ONCE) iterate(s, AT_ONCE);
        if (ahead < AT_ONCE || something_ends(s)) {
            s->now = before;
            for (int i = 1; i <= ahead; i++) {
                iterate(s, 1);
                end_lanes(s, made + i, values);
            }
        }
        made += ahead;
        if (made >= s->next) mark_lanes(s, made);
    }
    for (int k = 0; k < FRACTAL_LANES; k++)
        if (!s->done[k]) values[k] = interior(s->settings, place_of(s, k), lane(s->now.nearest, k));
}

void fractal_numbers(const Pigment *pigment, const Vec3 p[FRACTAL_LANES], double values[FRACTAL_LANES]) {
    const FractalSettings *f = &pigment->fractal;
    const bool julia = pigment->kind == PATTERN_JULIA;
    if (f->magnet || f->exponent != 2) {
        for (int k = 0; k < FRACTAL_LANES; k++) values[k] = fractal_number(pigment, p[k]);
        return;
    }
    Squares squares = {.settings = f};
    for (int k = 0; k < FRACTAL_LANES; k++) {
        squares.now.re[k / 2][k % 2] = p[k].x, squares.now.im[k / 2][k % 2] = p[k].y;
        squares.c_re[k / 2][k % 2] = julia ? f->re : p[k].x, squares.c_im[k / 2][k % 2] = julia ? f->im : p[k].y;
    }
    square_numbers(&squares, values);
}

/* ---- one place ---- */

double fractal_number(const Pigment *pigment, Vec3 p) {
    const FractalSettings *f = &pigment->fractal;
    bool julia = pigment->kind == PATTERN_JULIA || pigment->kind == PATTERN_MAGNET_JULIA;
    bool from_zero = pigment->kind == PATTERN_MAGNET_MANDEL;
    Complex place = {p.x, p.y}, c = julia ? (Complex){f->re, f->im} : place;
    Complex z = from_zero ? (Complex){0, 0} : place;
    if (!f->magnet && f->exponent == 2) return square_number(f, z, c);
    double nearest = from_zero ? 10000 : norm(z);
    for (int i = 0; i < f->iterations; i++) {
        z = step(f, z, c);
        nearest = fmin(nearest, norm(z));
        if (escaped(f, z)) return exterior(f, i, z);
        if (isnan(z.re) && isnan(z.im)) break; /* for good */
    }
    return interior(f, z, nearest);
}
