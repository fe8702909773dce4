/* gamito SCENE STDLIB [STEP [NOISE [METHODS]]]: tables 1 to 3 of Gamito & Maddock 2007: bounds a ray and time of their four methods for equation 17 with
 * three noises (or one: 0 to 2; or some methods: sum of 1, 2, 4, 8, 16), seen 800 × 600 as in gamito.vts, of every STEP-th row and column (16); and of isosurface's own method on the same rays.
 * gamito check SPANS: whether bounds of random pieces hold the function's values. Exit status 1: those of a sound arithmetic do not.
 *
 * Sound: equations 7 and 13 with absolute values, and a piece that equation 16 made short is bounded again before it counts. "as printed":
 * neither. Roundings are not counted here, as in the paper; those of isosurface's methods are. */
#include "base/random.h"
#include "base/stopwatch.h"
#include "bench_scene.h"
#include "shape/line_roots.h"
#include "tape/noise.h"
#include "tape/noise_nodes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    WIDTH = 800,
    HEIGHT = 600,
    OCTAVES = 4,
    IMPULSES = 2,
    MOST_PERLIN = 216,
    MOST_CELLS = 216,
    MOST_STACK = 512
};

typedef enum GamitoNoise { PERLIN, SPARSE, WORLEY } GamitoNoise;

static const double WORLEY_MOST = 3.4642, EPSILON = 1e-4, RADIUS = 2.26;

typedef struct GamitoRay {
    double from[3], way[3];
} GamitoRay;

/* centre + slope·s + error·e along the piece. */
typedef struct Bounds {
    double centre, slope, error;
} Bounds;

typedef Bounds Extension(const GamitoRay *ray, double a, double b, GamitoNoise noise);

typedef struct Range {
    double low, high;
} Range;

/* ---- curves as lines ---- */

typedef struct Linear {
    double alpha, beta, delta;
} Linear;

typedef Linear CurveLine(Range r, bool slopes);
typedef double Curve(double t);

/* The chord's slope, or none; the rest is least and most at the ends or where the derivative is that slope. */
static double chord(Curve *curve, Range r, bool slopes) {
    return slopes && r.high - r.low > 1e-12 ? (curve(r.high) - curve(r.low)) / (r.high - r.low) : 0;
}

static Linear line_between(Curve *curve, Range r, double alpha, const double *places, int count) {
    double a = curve(r.low) - alpha * r.low, b = curve(r.high) - alpha * r.high, least = fmin(a, b),
           most = fmax(a, b);
    for (int k = 0; k < count; k++)
        if (places[k] > r.low && places[k] < r.high) {
            double rest = curve(places[k]) - alpha * places[k];
            least = fmin(least, rest), most = fmax(most, rest);
        }
    return (Linear){alpha, (least + most) / 2, (most - least) / 2};
}

static double fade(double t) {
    t = fmin(fabs(t), 1);
    return 1 - t * t * t * (t * (t * 6 - 15) + 10);
}

static Linear fade_line(Range r, bool slopes) {
    double alpha = chord(fade, r, slopes), q = 1 - 4 * sqrt(fabs(alpha) / 30), s = sqrt(fmax(q, 0)),
           side = alpha > 0 ? -0.5 : 0.5;
    return line_between(fade, r, alpha, (double[]){-1, 0, 1, side * (1 - s), side * (1 + s)}, 5);
}

static double kernel(double t) {
    double slope;
    return t < 1 ? sparse_kernel(t * t, &slope) : 0;
}

static Linear kernel_line(Range r, bool slopes) {
    r.low = fmax(r.low, 0), r.high = fmax(r.high, r.low);
    double alpha = chord(kernel, r, slopes), s = asin(fmin(1, -2 * alpha / VTS_PI)) / VTS_PI;
    return line_between(kernel, r, alpha, (double[]){1, s, 1 - s}, 3);
}

static double root(double t) { return sqrt(fmax(t, 0)); }

static Linear root_line(Range r, bool slopes) {
    r.low = fmax(r.low, 0), r.high = fmax(r.high, r.low);
    double alpha = chord(root, r, slopes);
    return line_between(root, r, alpha, (double[]){alpha > 0 ? 1 / (4 * alpha * alpha) : 0}, 1);
}

static Linear absolute_line(Range r, bool slopes) {
    return line_between(fabs, r, chord(fabs, r, slopes), (double[]){0}, 1);
}

/* ---- lattices ---- */

typedef struct Nodes {
    double low[3], high[3], count;
} Nodes;

static Nodes nodes_around(Range x, Range y, Range z, double before, double behind) {
    Nodes n = {{floor(x.low) + before, floor(y.low) + before, floor(z.low) + before},
               {floor(x.high) + behind, floor(y.high) + behind, floor(z.high) + behind},
               1};
    for (int k = 0; k < 3; k++) n.count *= n.high[k] - n.low[k] + 1;
    return n;
}

/* ---- intervals ---- */

static void ia_begin(void) {}
static Range ia_along(double a, double b) { return (Range){a, b}; }
static Range ia_constant(double c) { return (Range){c, c}; }
static Range ia_scale(Range a, double k) {
    return k < 0 ? (Range){a.high * k, a.low * k} : (Range){a.low * k, a.high * k};
}
static Range ia_shift(Range a, double c) { return (Range){a.low + c, a.high + c}; }
static Range ia_add(Range a, Range b) { return (Range){a.low + b.low, a.high + b.high}; }
static Range ia_mul(Range a, Range b) {
    double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
    return (Range){fmin(fmin(p, q), fmin(r, s)), fmax(fmax(p, q), fmax(r, s))};
}
static Range ia_line(Range a, Linear l) {
    return ia_add(ia_scale(a, l.alpha), (Range){l.beta - l.delta, l.beta + l.delta});
}
static Range ia_range(Range a) { return a; }
/* The lesser of two. */
static Range ia_either(Range a, Range b) { return (Range){fmin(a.low, b.low), fmin(a.high, b.high)}; }
static Bounds ia_bounds(Range a) { return (Bounds){(a.low + a.high) / 2, 0, (a.high - a.low) / 2}; }
enum { ia_slopes = 0 };

#define FORM    Range
#define F(name) ia_##name
#include "gamito_forms.inc"
#undef F
#undef FORM

/* ---- reduced affine arithmetic ---- */

static Bounds ra_along(double a, double b) { return (Bounds){(a + b) / 2, (b - a) / 2, 0}; }
static Bounds ra_constant(double c) { return (Bounds){c, 0, 0}; }
static Bounds ra_shift(Bounds a, double c) { return (Bounds){a.centre + c, a.slope, a.error}; }
static Range ra_range(Bounds a) {
    double radius = fabs(a.slope) + fabs(a.error);
    return (Range){a.centre - radius, a.centre + radius};
}
static Bounds ra_line(Bounds a, Linear l) {
    return (Bounds){l.alpha * a.centre + l.beta, l.alpha * a.slope, fabs(l.alpha * a.error) + l.delta};
}
static double ra_square(Bounds a, Bounds b) {
    return (fabs(a.slope) + fabs(a.error)) * (fabs(b.slope) + fabs(b.error));
}

static Bounds ra_either(Bounds a, Bounds b) { return (void)b, a; } /* not used: it has slopes */

static void ra_begin(void) {}
static Bounds ra_scale(Bounds a, double k) { return (Bounds){a.centre * k, a.slope * k, a.error * fabs(k)}; }
static Bounds ra_add(Bounds a, Bounds b) {
    return (Bounds){a.centre + b.centre, a.slope + b.slope, a.error + b.error};
}
static Bounds ra_mul(Bounds a, Bounds b) {
    return (Bounds){a.centre * b.centre, a.centre * b.slope + b.centre * a.slope,
                    fabs(a.centre * b.error) + fabs(b.centre * a.error) + ra_square(a, b)};
}
static Bounds ra_bounds(Bounds a) { return a; }
enum { ra_slopes = 1 };

#define FORM    Bounds
#define F(name) ra_##name
#include "gamito_forms.inc"
#undef F

/* As printed: private errors cancel. */
#define pr_begin    ra_begin
#define pr_along    ra_along
#define pr_constant ra_constant
#define pr_shift    ra_shift
#define pr_range    ra_range
#define pr_line     ra_line
#define pr_either   ra_either
#define pr_slopes   ra_slopes
static Bounds pr_scale(Bounds a, double k) { return (Bounds){a.centre * k, a.slope * k, a.error * k}; }
static Bounds pr_add(Bounds a, Bounds b) {
    return (Bounds){a.centre + b.centre, a.slope + b.slope, a.error + b.error};
}
static Bounds pr_mul(Bounds a, Bounds b) {
    return (Bounds){a.centre * b.centre, a.centre * b.slope + b.centre * a.slope,
                    fabs(a.centre * b.error + b.centre * a.error) + ra_square(a, b)};
}
static Bounds pr_bounds(Bounds a) { return (Bounds){a.centre, a.slope, fabs(a.error)}; }

#define F(name) pr_##name
#include "gamito_forms.inc"
#undef F
#undef FORM

/* ---- standard affine arithmetic ---- */

typedef struct Symbol {
    uint32_t number; /* 0: the place on the piece */
    double value;
} Symbol;

/* Sorted by number. The symbols live until the next aa_begin(). */
typedef struct Standard {
    double centre;
    uint32_t count;
    Symbol *symbols;
} Standard;

/* Of one evaluation; this program has one thread. */
static struct {
    Symbol *symbols;
    size_t used, room;
    uint32_t next;
} pool;

static Symbol *aa_room(size_t count) {
    if (pool.used + count > pool.room) {
        fprintf(stderr, "gamito: too many symbols\n");
        exit(3);
    }
    pool.used += count;
    return pool.symbols + pool.used - count;
}

static void aa_begin(void) {
    if (!pool.symbols) {
        pool.room = (size_t)1 << 26;
        pool.symbols = malloc(pool.room * sizeof *pool.symbols);
        if (!pool.symbols) exit(3);
    }
    pool.used = 0, pool.next = 1;
}

static Standard aa_constant(double c) { return (Standard){c, 0, NULL}; }

static Standard aa_along(double a, double b) {
    Standard out = {(a + b) / 2, 1, aa_room(1)};
    out.symbols[0] = (Symbol){0, (b - a) / 2};
    return out;
}

/* x·a + y·b + rest, without the rounds of their products. */
static Standard aa_combine(Standard a, double x, Standard b, double y, double rest) {
    Standard out = {x * a.centre + y * b.centre, 0, aa_room((size_t)a.count + b.count + 1)};
    uint32_t i = 0, j = 0;
    while (i < a.count || j < b.count) {
        bool left = j == b.count || (i < a.count && a.symbols[i].number <= b.symbols[j].number);
        bool right = i == a.count || (j < b.count && b.symbols[j].number <= a.symbols[i].number);
        uint32_t number = left ? a.symbols[i].number : b.symbols[j].number;
        out.symbols[out.count++] =
            (Symbol){number, (left ? x * a.symbols[i].value : 0) + (right ? y * b.symbols[j].value : 0)};
        i += left, j += right;
    }
    if (rest > 0) out.symbols[out.count++] = (Symbol){pool.next++, rest};
    pool.used = (size_t)(out.symbols - pool.symbols) + out.count;
    return out;
}

static double aa_radius(Standard a) {
    double sum = 0;
    for (uint32_t k = 0; k < a.count; k++) sum += fabs(a.symbols[k].value);
    return sum;
}

static Standard aa_scale(Standard a, double k) { return aa_combine(a, k, aa_constant(0), 0, 0); }
static Standard aa_shift(Standard a, double c) { return (Standard){a.centre + c, a.count, a.symbols}; }
static Standard aa_add(Standard a, Standard b) { return aa_combine(a, 1, b, 1, 0); }
static Standard aa_mul(Standard a, Standard b) {
    Standard out = aa_combine(a, b.centre, b, a.centre, aa_radius(a) * aa_radius(b));
    out.centre = a.centre * b.centre;
    return out;
}
static Standard aa_line(Standard a, Linear l) {
    return aa_shift(aa_combine(a, l.alpha, aa_constant(0), 0, l.delta), l.beta);
}
static Range aa_range(Standard a) {
    double radius = aa_radius(a);
    return (Range){a.centre - radius, a.centre + radius};
}
static Standard aa_either(Standard a, Standard b) { return (void)b, a; }
static Bounds aa_bounds(Standard a) {
    double slope = a.count && a.symbols[0].number == 0 ? a.symbols[0].value : 0;
    return (Bounds){a.centre, slope, aa_radius(a) - fabs(slope)};
}
enum { aa_slopes = 1 };

#define FORM    Standard
#define F(name) aa_##name
#include "gamito_forms.inc"

/* ---- figure 1 ---- */

typedef struct Piece {
    double a, b;
    Bounds g;
} Piece;

typedef struct Method {
    const char *name;
    Extension *extension;
    bool optimised, verified;
    double printed[3]; /* bounds a ray in the paper, by noise; 0: not there */
    double seconds[3]; /* of the paper's pictures */
} Method;

static const Method methods[] = {
    {"interval", ia_equation_17, false, false, {82.04, 51.95, 50.30}, {606.2, 1676.4, 2002.2}},
    {"affine", aa_equation_17, false, false, {38.24, 26.76, 37.16}, {2563.3, 2306.5, 12077.1}},
    {"reduced_affine", ra_equation_17, false, false, {38.24, 26.76, 48.37}, {410.2, 742.0, 1981.0}},
    {"reduced_affine_optimised", ra_equation_17, true, true, {11.92, 14.84, 22.80}, {242.9, 412.5, 939.2}},
    {"  as printed", pr_equation_17, true, false, {11.92, 14.84, 22.80}, {242.9, 412.5, 939.2}},
};
enum { METHODS = sizeof methods / sizeof *methods };

static bool may_hold(Bounds g) { return fabs(g.centre) <= fabs(g.slope) + g.error; }

/* Equation 16. */
static void optimise(Piece *piece) {
    double t0 = (piece->a + piece->b) / 2, t1 = (piece->b - piece->a) / 2;
    if (piece->g.slope == 0) return;
    double at = t0 - piece->g.centre / piece->g.slope * t1, off = fabs(piece->g.error / piece->g.slope) * t1;
    piece->a = fmax(piece->a, at - off), piece->b = fmin(piece->b, at + off);
}

static bool find(const Method *method, const GamitoRay *ray, GamitoNoise noise, double from, double to,
                 double *t, uint64_t *count) {
    Piece stack[MOST_STACK] = {{from, to, method->extension(ray, from, to, noise)}};
    int used = 1;
    ++*count;
    while (used > 0 && used + 2 <= MOST_STACK) {
        Piece piece = stack[--used];
        if (piece.b - piece.a < EPSILON) return *t = piece.a, true;
        if (method->optimised) {
            optimise(&piece);
            if (!(piece.a <= piece.b)) continue;
            if (method->verified && piece.b - piece.a < EPSILON) {
                piece.g = method->extension(ray, piece.a, piece.b, noise);
                ++*count;
                if (!may_hold(piece.g)) continue;
            }
            if (piece.b - piece.a < EPSILON) return *t = piece.a, true;
        }
        double middle = (piece.a + piece.b) / 2;
        Piece halves[2] = {{middle, piece.b, method->extension(ray, middle, piece.b, noise)},
                           {piece.a, middle, method->extension(ray, piece.a, middle, noise)}};
        *count += 2;
        for (int k = 0; k < 2; k++)
            if (may_hold(halves[k].g)) stack[used++] = halves[k];
    }
    return false;
}

/* ---- rays ---- */

static bool ray_at(int x, int y, GamitoRay *ray, double *from, double *to) {
    Vec3 o = vec3(0, -5, 0),
         d = vec3_normalize(vec3(((x + 0.5) / WIDTH - 0.5) * 0.88, 1, (0.5 - (y + 0.5) / HEIGHT) * 0.66));
    double b = vec3_dot(o, d), disc = b * b - (vec3_dot(o, o) - RADIUS * RADIUS);
    *ray = (GamitoRay){{o.x, o.y, o.z}, {d.x, d.y, d.z}};
    if (disc <= 0) return false;
    *from = -b - sqrt(disc), *to = -b + sqrt(disc);
    return true;
}

typedef struct Sum {
    double rays, hits, ways, seconds, differ;
    uint64_t bounds;
} Sum;

static void print_sum(const char *name, const Sum *s, double printed, double seconds) {
    printf("| %-24s | %7.2f | %10.0f | %8.1f s |", name, (double)s->bounds / s->rays, s->rays / s->seconds,
           s->seconds / s->rays * WIDTH * HEIGHT);
    printf(printed > 0 ? " %6.2f | %8.1f s |" : "        |            |", printed, seconds);
    printf(" %5.0f | %5.0f |\n", s->hits, s->differ);
    fflush(stdout);
}

/* Distances of the hits of our own method, by ray; below 0: none. */
static Sum own(const Tape *tape, int step, double *distances) {
    Arena arena;
    arena_init(&arena, NULL, 0);
    const Interval box[3] = {interval(-RADIUS, RADIUS), interval(-RADIUS, RADIUS), interval(-RADIUS, RADIUS)};
    TapeSum sum = tape_sum_of(tape, box, &arena);
    Line line = {.tape = tape, .method = LINE_AFFINE_OPTIMISED, .sum = &sum};
    Sum s = {0};
    double start = stopwatch_cpu();
    for (int y = 0; y < HEIGHT; y += step)
        for (int x = 0; x < WIDTH; x += step) {
            GamitoRay ray;
            LineWork work = {0};
            double from, to, t = -1;
            bool falling;
            size_t at = (size_t)s.rays++;
            distances[at] = -1;
            if (!ray_at(x, y, &ray, &from, &to)) continue;
            line.origin = vec3(ray.from[0], ray.from[1], ray.from[2]),
            line.direction = vec3(ray.way[0], ray.way[1], ray.way[2]);
            if (line_first_root(&line, from, to, &t, &falling, &work)) s.hits++, distances[at] = t;
            s.bounds += work.bounds;
        }
    s.seconds = stopwatch_cpu() - start;
    arena_destroy(&arena);
    return s;
}

static Sum theirs(const Method *method, GamitoNoise noise, int step, const double *distances) {
    Sum s = {0};
    double start = stopwatch_cpu();
    for (int y = 0; y < HEIGHT; y += step)
        for (int x = 0; x < WIDTH; x += step) {
            GamitoRay ray;
            double from, to, t = -1, expected = distances[(size_t)s.rays++];
            bool hit = ray_at(x, y, &ray, &from, &to) && find(method, &ray, noise, from, to, &t, &s.bounds);
            s.hits += hit;
            s.differ += hit != (expected >= 0) || (hit && fabs(t - expected) > 2 * EPSILON);
        }
    s.seconds = stopwatch_cpu() - start;
    return s;
}

static const char *const noises[] = {"perlin", "sparse_convolution, K = 2", "worley, F1"};

static void tables(const Scene *scene, int step, int noise, int which) {
    double *distances = malloc(sizeof *distances * WIDTH * HEIGHT);
    for (int n = 0; n < 3 && distances; n++) {
        if (noise >= 0 && n != noise) continue;
        printf("\n%s\n| method | bounds a ray | rays/s | 800 x 600 | paper: bounds | paper: time | hits | "
               "differ |\n",
               noises[n]);
        Sum ours = own(scene->objects[n]->as.solid->as.isosurface.function, step, distances);
        for (int m = 0; m < METHODS; m++) {
            if (!(which >> m & 1)) continue;
            Sum s = theirs(&methods[m], (GamitoNoise)n, step, distances);
            print_sum(methods[m].name, &s, methods[m].printed[n], methods[m].seconds[n]);
        }
        print_sum("auto", &ours, 0, 0);
    }
    free(distances);
}

/* ---- containment ---- */

static double unit(uint64_t i, uint32_t k) { return random_unit(random_hash(0x67616D69, i, k, 0)); }

static double value(const GamitoRay *ray, double t, GamitoNoise noise) {
    Vec3 p =
        vec3(ray->from[0] + t * ray->way[0], ray->from[1] + t * ray->way[1], ray->from[2] + t * ray->way[2]);
    double sum = vec3_length(p) - 1;
    for (int k = 0; k < OCTAVES; k++) {
        Vec3 at = vec3_scale(p, ldexp(4, k));
        double n = noise == PERLIN   ? noise_perlin(at)
                   : noise == SPARSE ? noise_sparse_convolution(at, IMPULSES)
                                     : noise_worley(at, 0);
        sum += 0.6 * pow(2, -0.8 * k) * n;
    }
    return sum;
}

static uint64_t misses(const Method *method, GamitoNoise noise, uint64_t spans) {
    uint64_t missed = 0;
    for (uint64_t i = 0; i < spans; i++) {
        double a = 5 * unit(i, 0), b = a + pow(10, -6 * unit(i, 1));
        GamitoRay ray = {{unit(i, 2) * 4 - 2, unit(i, 3) * 4 - 2, unit(i, 4) * 4 - 2}, {0, 0, 0}};
        Vec3 way = vec3_normalize(vec3(unit(i, 5) - 0.5, unit(i, 6) - 0.5, i % 16 ? unit(i, 7) - 0.5 : 0));
        ray.way[0] = way.x, ray.way[1] = way.y, ray.way[2] = way.z;
        Bounds g = method->extension(&ray, a, b, noise);
        bool held = true;
        for (uint32_t k = 0; k < 4; k++) {
            double s = k == 0 ? -1 : k == 1 ? 1 : 2 * unit(i, 8 + k) - 1;
            double off = fabs(value(&ray, (a + b) / 2 + s * (b - a) / 2, noise) - (g.centre + g.slope * s));
            held &= off <= g.error + 1e-12;
        }
        missed += !held;
    }
    return missed;
}

static int check(uint64_t spans) {
    bool sound = true;
    for (int n = 0; n < 3; n++)
        for (int m = 0; m < METHODS; m++) {
            if (methods[m].verified) continue; /* the same arithmetic as the one before */
            uint64_t count = methods[m].extension == aa_equation_17 ? spans / 50 : spans,
                     missed = misses(&methods[m], (GamitoNoise)n, count);
            bool printed = methods[m].extension == pr_equation_17;
            printf("%-26s %-24s %llu of %llu pieces not held\n", noises[n], methods[m].name,
                   (unsigned long long)missed, (unsigned long long)count);
            fflush(stdout);
            sound &= printed || !missed;
        }
    return sound ? 0 : 1;
}

int main(int argc, char **argv) {
    if (argc < 3)
        return fprintf(stderr, "usage: gamito SCENE STDLIB [STEP [NOISE [METHODS]]] | gamito check SPANS\n"),
               2;
    if (strcmp(argv[1], "check") == 0) return check(strtoull(argv[2], NULL, 10));
    BenchScene bench;
    const Scene *scene = bench_scene_load(&bench, argv[1], argv[2], WIDTH, HEIGHT);
    int step = argc > 3 ? atoi(argv[3]) : 16;
    if (!scene || scene->object_count < 3 || step < 1)
        return fprintf(stderr, "gamito: no three isosurfaces in %s\n", argv[1]), 1;
    tables(scene, step, argc > 4 ? atoi(argv[4]) : -1, argc > 5 ? atoi(argv[5]) : 31);
    return 0;
}
