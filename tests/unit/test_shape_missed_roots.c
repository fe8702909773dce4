/* No root is missed, whatever the noise: rays against a dense search. A larger number of rays: VTS_RAYS in the environment. */
#include "shape/line_roots.h"

#include "base/random.h"
#include "tape/interval.h"
#include "tape/noise.h"
#include "tape/noise_interval.h"
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

static double at(const Line *line, double t) {
    Vec3 p = vec3_madd(line->origin, line->direction, t);
    double out;
    tape_eval_once(line->tape, (double[]){p.x, p.y, p.z}, &out);
    return out;
}

/* How many of the rays have an earlier change of sign among so many samples than is found. */
static int missed(Kind kind, double radius, int rays, int samples) {
    Arena arena;
    int out = 0, met = 0;
    arena_init(&arena, NULL, 0);
    const Interval box[3] = {interval(-3 * radius, 3 * radius), interval(-3 * radius, 3 * radius), interval(-3 * radius, 3 * radius)};
    const Tape *tape = rough_ball(&arena, kind, radius);
    TapeSum sum = tape_sum_of(tape, box, &arena);
    for (uint64_t i = 0; i < (uint64_t)rays; i++) {
        Vec3 from = vec3_scale(vec3_normalize(vec3(unit(i, 0) - 0.5, unit(i, 1) - 0.5, unit(i, 2) - 0.5)), 2.5 * radius);
        Vec3 to = vec3_scale(vec3(unit(i, 3) - 0.5, unit(i, 4) - 0.5, unit(i, 5) - 0.5), 2 * radius);
        Line line = {.tape = tape, .origin = from, .direction = vec3_normalize(vec3_sub(to, from)), .method = LINE_AFFINE_OPTIMISED, .sum = i % 4 ? &sum : NULL};
        double end = 2.9 * radius, t = end;
        bool falling, found = line_first_root(&line, 0, end, &t, &falling, NULL), above = at(&line, 0) > 0;
        met += found;
        for (int k = 1; k <= samples; k++) {
            double s = end * k / samples;
            if ((at(&line, s) > 0) == above) continue;
            out += !found || t > s;
            break;
        }
        if (found) assert_true(fabs(at(&line, t)) < 1e-7 * radius);
    }
    assert_true(met > rays / 4);
    arena_destroy(&arena);
    return out;
}

static void none_is_missed(void **state) {
    static const double radii[] = {1, 1e3, 6.4e6};
    const char *asked = getenv("VTS_RAYS");
    int rays = asked ? atoi(asked) : 90;
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (size_t r = 0; r < VTS_ARRAY_COUNT(radii); r++) assert_int_equal(missed((Kind)kind, radii[r], rays, 500), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(none_is_missed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
