/* No root is missed, whatever the noise: rays against places along them where a reference of its own, in extended precision, has the function's sign. More
 * rays, other numbers of places: VTS_RAYS and VTS_PLACES in the environment. */
#include "shape/line_roots.h"

#include "base/random.h"
#include "tape/interval.h"
#include "tape/noise.h"
#include "tape/noise_interval.h"
#include "tape/node_cache.h"
#include "tape/noise_nodes_forms.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

static double unit(uint64_t i, uint32_t k) { return random_unit(random_hash(0x6D697373, i, k, 0)); }
static TapeRef times(TapeBuilder *b, TapeRef x, double k) { return tape_binary(b, TAPE_MUL, x, tape_constant(b, k), (Span){0}); }
static TapeRef plus(TapeBuilder *b, TapeRef x, TapeRef y) { return tape_binary(b, TAPE_ADD, x, y, (Span){0}); }

/* ---- noises of points as externals of a tape ---- */

enum { LAST = 3, IMPULSES = 2 };

static void nodes(const void *data, const double *in, double *out) {
    (void)data;
    noise_worley_nearest(vec3(in[0], in[1], in[2]), LAST, out);
}
static void node_bounds(const void *data, const Interval *in, Interval *out) {
    (void)data;
    for (int k = 0; k <= LAST; k++) out[k] = interval_worley(in, k);
}
static void node_forms(const void *data, int count, const AffineForm *in, AffineForm *out, struct NodeCache *cells) {
    (void)data;
    affine_worley(count, in, LAST, out, cells);
}
static void impulses(const void *data, const double *in, double *out) {
    (void)data;
    *out = noise_sparse_convolution(vec3(in[0], in[1], in[2]), IMPULSES);
}
static void impulse_bounds(const void *data, const Interval *in, Interval *out) {
    (void)data;
    *out = interval_sparse_convolution(in, IMPULSES);
}
static void impulse_forms(const void *data, int count, const AffineForm *in, AffineForm *out, struct NodeCache *cells) {
    (void)data;
    affine_sparse_convolution(count, in, IMPULSES, out, cells);
}
static const TapeExternal worley = {
    .name = "worley", .input_count = 3, .output_count = LAST + 1, .eval = nodes, .bound = node_bounds, .forms = node_forms, .hash = {1, 1}};
static const TapeExternal sparse = {
    .name = "sparse", .input_count = 3, .output_count = 1, .eval = impulses, .bound = impulse_bounds, .forms = impulse_forms, .hash = {2, 2}};

typedef enum Kind { PERLIN, POV, SPARSE, WORLEY_1, WORLEY_2, WORLEY_3, WORLEY_4, RIDGES, KINDS } Kind;

static TapeRef noise(TapeBuilder *b, Kind kind, const TapeRef p[3]) {
    TapeRef out[LAST + 1];
    switch (kind) {
    case PERLIN: return tape_ternary(b, TAPE_PERLIN, p[0], p[1], p[2], (Span){0});
    case POV: return tape_ternary(b, TAPE_POV_NOISE, p[0], p[1], p[2], (Span){0});
    case SPARSE: tape_call(b, &sparse, p, out, (Span){0}); return out[0];
    case RIDGES: tape_call(b, &worley, p, out, (Span){0}); return tape_binary(b, TAPE_SUB, out[1], out[0], (Span){0});
    default: tape_call(b, &worley, p, out, (Span){0}); return out[kind - WORLEY_1];
    }
}

/* |p| − R + R·Σ 0.3·2⁻ᵒ·noise(2ᵒ⁺²·p/R): three octaves on a ball. */
static const Tape *rough_ball(Arena *arena, Kind kind, double radius) {
    TapeBuilder *b = tape_builder_create(arena, 3);
    TapeRef p[3], square = tape_constant(b, 0);
    for (int k = 0; k < 3; k++) p[k] = tape_input(b, k), square = plus(b, square, tape_unary(b, TAPE_SQR, p[k], (Span){0}));
    TapeRef f = plus(b, tape_unary(b, TAPE_SQRT, square, (Span){0}), tape_constant(b, -radius));
    for (int o = 0; o < 3; o++) {
        TapeRef at[3];
        for (int k = 0; k < 3; k++) at[k] = times(b, p[k], ldexp(4, o) / radius);
        f = plus(b, f, times(b, noise(b, kind, at), 0.3 * radius * ldexp(1, -o)));
    }
    return tape_finish(b, &f, 1);
}

/* ---- the function once more, in long double ---- */

typedef struct Place {
    long double x[3];
} Place;

static long double fade(Kind kind, long double t) { return kind == PERLIN ? t * t * t * (t * (t * 6 - 15) + 10) : t * t * (3 - 2 * t); }

/* What a lattice noise holds at a corner follows from its value and gradient there. */
static long double lattice(Kind kind, Place p) {
    long double sum = 0, in[3];
    double low[3];
    for (int k = 0; k < 3; k++) low[k] = (double)floorl(p.x[k]), in[k] = p.x[k] - (long double)low[k];
    for (int c = 0; c < 8; c++) {
        const int side[3] = {c & 1, c >> 1 & 1, c >> 2};
        Vec3 corner = vec3(low[0] + side[0], low[1] + side[1], low[2] + side[2]);
        double g[3], value = kind == PERLIN ? noise_perlin_gradient(corner, g) : noise_pov_gradient3(corner, g);
        long double own = (long double)value, weight = 1;
        for (int k = 0; k < 3; k++) {
            own += (long double)g[k] * (in[k] - side[k]);
            weight *= side[k] ? fade(kind, in[k]) : 1 - fade(kind, in[k]);
        }
        sum += weight * own;
    }
    return kind == PERLIN ? sum : fminl(fmaxl(sum, 0), 1);
}

static NodeCell cell_by(Place p, int x, int y, int z) {
    return (NodeCell){(int64_t)floorl(p.x[0]) + x, (int64_t)floorl(p.x[1]) + y, (int64_t)floorl(p.x[2]) + z};
}

static long double square_to(Place p, Vec3 node) {
    long double x = p.x[0] - (long double)node.x, y = p.x[1] - (long double)node.y, z = p.x[2] - (long double)node.z;
    return x * x + y * y + z * z;
}

static long double convolution(Place p) {
    long double sum = 0;
    for (int c = 0; c < 27; c++) {
        NodeCell cell = cell_by(p, c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1);
        uint64_t own = node_cell_bits(cell, SPARSE_KIND);
        for (int k = 0; k < IMPULSES; k++) {
            double weight;
            long double square = square_to(p, sparse_impulse(cell, own, k, &weight));
            if (square < 1) sum += (long double)weight * (1 + cosl(3.14159265358979323846264L * sqrtl(square))) / 2;
        }
    }
    return sum / sqrtl(IMPULSES);
}

/* Every cell has a node: the four nearest are less than two cells away along each axis, or those of further cells are no nearer. */
static void distances(Place p, long double out[LAST + 1]) {
    static const int order[5] = {0, -1, 1, -2, 2};
    long double gaps[3][5];
    for (int k = 0; k <= LAST; k++) out[k] = 1e9L;
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 5; j++) {
            long double in = p.x[k] - floorl(p.x[k]), gap = order[j] > 0 ? order[j] - in : order[j] < 0 ? in - order[j] - 1 : 0;
            gaps[k][j] = gap * gap;
        }
    for (int c = 0; c < 125; c++) {
        const int at[3] = {c % 5, c / 5 % 5, c / 25}, off[3] = {order[at[0]], order[at[1]], order[at[2]]};
        if (gaps[0][at[0]] + gaps[1][at[1]] + gaps[2][at[2]] > out[LAST]) continue;
        NodeCell cell = cell_by(p, off[0], off[1], off[2]);
        uint64_t own = node_cell_bits(cell, WORLEY_KIND);
        for (int n = worley_node_count(own); n-- > 0;) {
            long double square = square_to(p, worley_node(cell, own, n));
            int k = LAST;
            if (!(square < out[k])) continue;
            for (; k > 0 && square < out[k - 1]; k--) out[k] = out[k - 1];
            out[k] = square;
        }
    }
    for (int k = 0; k <= LAST; k++) out[k] = sqrtl(out[k]);
}

static long double exact_noise(Kind kind, Place p) {
    long double nearest[LAST + 1];
    if (kind == PERLIN || kind == POV) return lattice(kind, p);
    if (kind == SPARSE) return convolution(p);
    distances(p, nearest);
    return kind == RIDGES ? nearest[1] - nearest[0] : nearest[kind - WORLEY_1];
}

/* rough_ball(), in radii. */
static long double exact_at(Kind kind, double radius, const Line *line, double t) {
    const double origin[3] = {line->origin.x, line->origin.y, line->origin.z}, along[3] = {line->direction.x, line->direction.y, line->direction.z};
    Place p;
    long double square = 0;
    for (int k = 0; k < 3; k++) p.x[k] = ((long double)origin[k] + (long double)t * (long double)along[k]) / (long double)radius, square += p.x[k] * p.x[k];
    long double sum = sqrtl(square) - 1;
    for (int o = 0; o < 3; o++) {
        Place q;
        for (int k = 0; k < 3; k++) q.x[k] = ldexpl(p.x[k], o + 2);
        sum += ldexpl(0.3L, -o) * exact_noise(kind, q);
    }
    return sum;
}

/* ---- and for lattice noises, which are polynomials, in 113 bits, where compilers have them ---- */

#if defined(__SIZEOF_FLOAT128__)
__extension__ typedef __float128 Quad;

static Quad quad_fade(Kind kind, Quad t) { return kind == PERLIN ? t * t * t * (t * (t * 6 - 15) + 10) : t * t * (3 - 2 * t); }

static Quad quad_noise(Kind kind, const Quad p[3]) {
    Quad sum = 0, in[3];
    double low[3];
    for (int k = 0; k < 3; k++) {
        low[k] = floor((double)p[k]);
        if ((Quad)low[k] > p[k]) low[k] -= 1; /* the double was rounded up to the wall */
        in[k] = p[k] - (Quad)low[k];
    }
    for (int c = 0; c < 8; c++) {
        const int side[3] = {c & 1, c >> 1 & 1, c >> 2};
        Vec3 corner = vec3(low[0] + side[0], low[1] + side[1], low[2] + side[2]);
        double g[3], value = kind == PERLIN ? noise_perlin_gradient(corner, g) : noise_pov_gradient3(corner, g);
        Quad own = (Quad)value, weight = 1;
        for (int k = 0; k < 3; k++) {
            own += (Quad)g[k] * (in[k] - side[k]);
            weight *= side[k] ? quad_fade(kind, in[k]) : 1 - quad_fade(kind, in[k]);
        }
        sum += weight * own;
    }
    if (kind == POV) sum = sum < 0 ? 0 : sum > 1 ? 1 : sum;
    return sum;
}

/* Whether rough_ball() is above 0: |p| > h is p² > h², if h is not below 0. */
static bool quad_is_above(Kind kind, double radius, const Line *line, Quad t) {
    const double origin[3] = {line->origin.x, line->origin.y, line->origin.z}, along[3] = {line->direction.x, line->direction.y, line->direction.z};
    Quad p[3], square = 0, h = 1;
    for (int k = 0; k < 3; k++) p[k] = ((Quad)origin[k] + t * (Quad)along[k]) / (Quad)radius, square += p[k] * p[k];
    for (int o = 0; o < 3; o++) {
        Quad q[3];
        for (int k = 0; k < 3; k++) q[k] = p[k] * (4 << o);
        h -= (Quad)0.3 / (1 << o) * quad_noise(kind, q);
    }
    return h < 0 || square > h * h;
}

/* Whether the sign changes as it is said to, within 2⁻³⁸ of the way. */
static bool changes_sign(Kind kind, double radius, const Line *line, double t, bool falling) {
    Quad off = (Quad)(0x1p-38 * fmax(fabs(t), 2.5 * radius));
    return kind > POV || (quad_is_above(kind, radius, line, (Quad)t - off) == falling && quad_is_above(kind, radius, line, (Quad)t + off) != falling);
}
#else
static bool changes_sign(Kind kind, double radius, const Line *line, double t, bool falling) {
    (void)kind, (void)radius, (void)line, (void)t, (void)falling;
    return true;
}
#endif

static double at(const Line *line, double t) {
    Vec3 p = vec3_madd(line->origin, line->direction, t);
    double out;
    tape_eval_once(line->tape, (double[]){p.x, p.y, p.z}, &out);
    return out;
}

/* What doubles cannot tell from 0, in radii. */
static const long double UNSURE = 1e-11L;

static int number_of(const char *name, int usual) {
    const char *asked = getenv(name);
    return asked ? atoi(asked) : usual;
}

/* How many of the rays have, before the change of sign that is found, a place of the other sign. */
static int missed(Kind kind, double radius, int rays, int places) {
    Arena arena;
    int out = 0, met = 0, unchanged = 0;
    arena_init(&arena, NULL, 0);
    NodeCache *cells = arena_new(&arena, NodeCache);
    node_cache_begin(cells);
    const Interval box[3] = {interval(-3 * radius, 3 * radius), interval(-3 * radius, 3 * radius), interval(-3 * radius, 3 * radius)};
    const Tape *tape = rough_ball(&arena, kind, radius);
    TapeSum sum = tape_sum_of(tape, box, &arena);
    for (uint64_t i = 0; i < (uint64_t)rays; i++) {
        Vec3 from = vec3_scale(vec3_normalize(vec3(unit(i, 0) - 0.5, unit(i, 1) - 0.5, unit(i, 2) - 0.5)), 2.5 * radius);
        Vec3 to = vec3_scale(vec3(unit(i, 3) - 0.5, unit(i, 4) - 0.5, unit(i, 5) - 0.5), 2 * radius);
        Line line = {.tape = tape, .origin = from, .direction = vec3_normalize(vec3_sub(to, from)), .method = LINE_AFFINE_OPTIMISED, .sum = i % 4 ? &sum : NULL,
                     .cells = i % 3 ? cells : NULL};
        double end = 2.9 * radius, t = end;
        bool falling, found = line_first_root(&line, 0, end, &t, &falling, NULL), above = exact_at(kind, radius, &line, 0) > 0;
        met += found;
        for (int k = 0; k < places; k++) {
            double s = t * (k + unit(i, 10 + (uint32_t)k)) / places;
            long double there = exact_at(kind, radius, &line, s);
            if (fabsl(there) < UNSURE || (there > 0) == above) continue;
            out++;
            break;
        }
        unchanged += found && !changes_sign(kind, radius, &line, t, falling);
        if (found) assert_true(fabs(at(&line, t)) < 1e-7 * radius && fabsl(exact_at(kind, radius, &line, t)) < 1e-9L);
    }
    assert_true(met > rays / 5);
    assert_true(unchanged <= rays / 20000); /* two zeros as near as that */
    arena_destroy(&arena);
    return out;
}

static void none_is_missed(void **state) {
    static const double radii[] = {1, 1e3, 6.4e6};
    int rays = number_of("VTS_RAYS", 120), places = number_of("VTS_PLACES", 50);
    (void)state;
    /* What is made of Worley's nodes shares its noise's rays. */
    for (int kind = 0; kind < KINDS; kind++)
        for (size_t r = 0; r < VTS_ARRAY_COUNT(radii); r++) {
            int share = kind < WORLEY_1 ? rays : (rays + 4) / (KINDS - WORLEY_1);
            assert_int_equal(missed((Kind)kind, radii[r], share, places), 0);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(none_is_missed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
