/* Following rays through skins: nothing leaks and nothing is counted twice, against exact lengths; opacity against rays
 * through the source triangles. */
#include "skin_scenes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

/* ---- lengths ---- */

typedef struct Travel {
    double length, first, last, optical_depth;
    int segments;
    bool disordered;
} Travel;

static Travel travel(SkinScene *s, const Cone *cone, double t_max) {
    TraceCounters counters = {0};
    SkinSegment segment;
    Travel out = {.first = VTS_INFINITY, .last = -VTS_INFINITY};
    skin_march_begin(&s->march, cone, 0, t_max, &s->compiled.march, &counters, false);
    while (skin_march_next(&s->march, &segment)) {
        out.disordered |= segment.t0 < out.last - 1e-9 * (1 + fabs(segment.t0)) || segment.t1 < segment.t0;
        out.length += segment.t1 - segment.t0;
        out.first = fmin(out.first, segment.t0);
        out.last = fmax(out.last, segment.t1);
        out.optical_depth -= log((double)segment.transmittance);
        out.segments++;
    }
    return out;
}

typedef struct LengthErrors {
    double sum, worst, least, bias;
    int rays, bad;
} LengthErrors;

static void add_error(LengthErrors *e, double got, double want, double unit) {
    double error = (got - want) / unit;
    e->sum += error * error;
    e->bias += error;
    e->worst = fmax(e->worst, fabs(error));
    e->least = fmin(e->least, error);
    e->bad += fabs(error) > .05;
    e->rays++;
}

static void print_errors(const char *what, const LengthErrors *e, const char *unit) {
    printf("%-28s %6d rays: mean error %+.1e, rms %.1e, worst %.1e, least %+.1e %s, %d beyond .05\n", what, e->rays, e->bias / e->rays,
           sqrt(e->sum / e->rays), e->worst, e->least, unit, e->bad);
}

/* Every voxel of the texel holds matter, so that segments fill the layer: their sum is the chord. */
static void chords_of_a_ball_are_whole(void **state) {
    (void)state;
    static BallMesh ball;
    static const struct { Vec3 center; double radius, height, width; const char *name; } cases[] = {
        {{0, 0, 0}, 1, .2, .001, "thin cones"},
        {{0, 0, 0}, 1, .2, .05, "wide cones"},
        {{5e4, 0, 1e5}, 100, .1, .001, "far from the origin"},
        {{0, 0, 0}, 1e-3, .4, 1e-6, "small"}};
    for (size_t c = 0; c < VTS_ARRAY_COUNT(cases); c++) {
        RandomStream r = {10 + c};
        double radius = cases[c].radius, height = cases[c].height;
        SkinScene s;
        ball_make(&ball, 2);
        skin_scene_begin(&s);
        skin_scene_fill(&s, 8, 6000, .1, TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z, 3);
        skin_scene_ball(&s, &ball, cases[c].center, radius, height);
        s.skin.mapping.repeat_u = 8, s.skin.mapping.repeat_v = 4;
        assert_int_equal(skin_scene_compile(&s), COMPILE_OK);
        LengthErrors errors[4] = {{0}};
        static const char *const aims[4] = {"at vertices", "at edges", "anywhere", "along walls"};
        for (int i = 0; i < 4000; i++) {
            const uint32_t *f = ball.triangles[(size_t)between(&r, 0, (double)ball.triangle_count)];
            Vec3 on = ball.vertices[f[0]], d = spread_direction(&r);
            if (i % 4 == 1) on = vec3_lerp(ball.vertices[f[0]], ball.vertices[f[1]], random_next_unit(&r));
            if (i % 4 == 2) on = spread_direction(&r);
            if (i % 4 == 3) {
                Vec3 along = vec3_normalize(vec3_sub(ball.vertices[f[1]], ball.vertices[f[0]]));
                d = vec3_normalize(vec3_madd(vec3_scale(along, between(&r, -1, 1)), on, between(&r, -1, 1)));
            }
            Vec3 target = vec3_madd(cases[c].center, on, radius * (1 + height * random_next_unit(&r)));
            Cone cone = {vec3_madd(target, d, i % 6 == 5 ? 0 : -3 * radius), d, cases[c].width * radius, 0};
            Ray ray = {cone.origin, d};
            LayerParts parts = ball_layer_parts(&ball, cases[c].center, radius, height, &ray, 0);
            Travel way = travel(&s, &cone, VTS_INFINITY);
            assert_false(way.disordered);
            add_error(&errors[i % 4], way.length, layer_length(&parts), radius * height);
        }
        printf("%s\n", cases[c].name);
        for (int k = 0; k < 4; k++) {
            print_errors(aims[k], &errors[k], "heights");
            /* Nothing leaks, nothing is counted twice; slivers of a thousandth of a step are passed over. */
            assert_true(errors[k].worst < .001);
            assert_true(fabs(errors[k].bias / errors[k].rays) < 1e-5);
            assert_int_equal(errors[k].bad, 0);
        }
        skin_scene_end(&s);
    }
}

/* ---- paths ---- */

static double path_coordinate_error(const SkinMarch *m, double t, Vec3 world) {
    double s = t - m->span.t0;
    Vec3 got = vec3_madd(vec3_madd(m->span.c0, m->span.c1, s), m->span.c2, s * s);
    SkinPoint p = skin_march_guess(m, t);
    bool seam = false;
    if (skin_locate(m->skin, world, 1e-12, &p, &seam) != SKIN_INSIDE) return 0;
    TexturePlace place = skin_texture_place(&m->skin->cells[p.cell], &p);
    Vec3 off = vec3_sub(got, vec3(place.u, place.v, place.w));
    off.x -= round(off.x); /* u runs around the ball */
    return vec3_length(off);
}

static int compare_numbers(const void *a, const void *b) {
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

enum { MOST_PLACES = 200000 };

/* How far the march's texture coordinates are from those of the mapping: the 95th percentile over its steps. (Where a step crosses the
 * edge of two facets both are off, as the mapping has a kink there.) */
static double path_error(SkinScene *s, const BallMesh *ball, RayPath path, uint64_t *steps) {
    RandomStream r = {77};
    MarchSettings settings = s->compiled.march;
    TraceCounters counters = {0};
    SkinSegment segment;
    double *errors = malloc(MOST_PLACES * sizeof *errors);
    size_t count = 0;
    assert_non_null(errors);
    settings.path = path;
    for (int i = 0; i < 400; i++) {
        Vec3 on = ball->vertices[(size_t)between(&r, 0, (double)ball->vertex_count)], d = spread_direction(&r);
        if (fabs(on.y) > .8) continue; /* coordinates are crowded at the poles */
        Cone cone = {vec3_madd(vec3_scale(on, between(&r, 1, 1.5)), d, -4), d, .01, 0};
        skin_march_begin(&s->march, &cone, 0, VTS_INFINITY, &settings, &counters, false);
        while (skin_march_next(&s->march, &segment) && count < MOST_PLACES) {
            double t = (segment.t0 + segment.t1) / 2;
            errors[count++] = path_coordinate_error(&s->march, t, cone_point(&cone, t));
        }
    }
    *steps = counters.steps;
    qsort(errors, count, sizeof *errors, compare_numbers);
    double result = errors[count * 95 / 100];
    printf("%zu places, median %.1e, 99 %%: %.1e, worst %.1e\n", count, errors[count / 2], errors[count * 99 / 100], errors[count - 1]);
    free(errors);
    return result;
}

/* Large cells under a high layer, whose height vectors spread: straight ways bend in texture space. */
static void paths_bend_with_the_layer(void **state) {
    (void)state;
    static BallMesh ball;
    SkinScene s;
    ball_make(&ball, 1);
    skin_scene_begin(&s);
    skin_scene_fill(&s, 64, 6000, .1, TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z, 3);
    skin_scene_ball(&s, &ball, vec3(0, 0, 0), 1, .5);
    s.skin.mapping.repeat_u = 8, s.skin.mapping.repeat_v = 4;
    assert_int_equal(skin_scene_compile(&s), COMPILE_OK);
    uint64_t steps[3];
    double straight = path_error(&s, &ball, RAY_PATH_STRAIGHT, &steps[0]), box = path_error(&s, &ball, RAY_PATH_BOX, &steps[1]);
    double exact = path_error(&s, &ball, RAY_PATH_EXACT, &steps[2]);
    printf("texture coordinates off by, in tiles: straight %.1e, box %.1e, exact %.1e (%llu, %llu, %llu steps)\n", straight, box, exact,
           (unsigned long long)steps[0], (unsigned long long)steps[1], (unsigned long long)steps[2]);
    assert_true(box < straight / 10);
    assert_true(exact < box / 3);
    assert_true(box < 1.0 / 64); /* a voxel */
    skin_scene_end(&s);
}

/* ---- transmittance ---- */

/* What parallel light sees of the texel's triangles, repeated over the plane: the share of the tile that stays free, along a
 * direction that falls by 1 while it moves by (sx, sz). Points of a grid, each tested against each triangle's shadow. */
enum { SHADOW_GRID = 512 };

static double free_share(const SkinScene *s, double sx, double sz) {
    static bool covered[SHADOW_GRID][SHADOW_GRID];
    memset(covered, 0, sizeof covered);
    for (size_t i = 0; i < s->leaf_mesh.triangle_count; i++) {
        double x[3], z[3];
        for (int k = 0; k < 3; k++) {
            Vec3 v = s->leaf_mesh.vertices[s->leaf_mesh.triangles[i][k]];
            x[k] = (v.x + sx * v.y) * SHADOW_GRID, z[k] = (v.z + sz * v.y) * SHADOW_GRID;
        }
        double area = (x[1] - x[0]) * (z[2] - z[0]) - (x[2] - x[0]) * (z[1] - z[0]);
        int x0 = (int)floor(fmin(x[0], fmin(x[1], x[2]))), x1 = (int)ceil(fmax(x[0], fmax(x[1], x[2])));
        int z0 = (int)floor(fmin(z[0], fmin(z[1], z[2]))), z1 = (int)ceil(fmax(z[0], fmax(z[1], z[2])));
        for (int iz = z0; iz <= z1; iz++)
            for (int ix = x0; ix <= x1; ix++) {
                bool in = true;
                for (int k = 0; k < 3 && in; k++) {
                    int n = (k + 1) % 3;
                    double side = (x[n] - x[k]) * (iz + .5 - z[k]) - (ix + .5 - x[k]) * (z[n] - z[k]);
                    in = area > 0 ? side >= 0 : side <= 0;
                }
                if (in) covered[iz & (SHADOW_GRID - 1)][ix & (SHADOW_GRID - 1)] = true;
            }
    }
    size_t free_count = 0;
    for (int iz = 0; iz < SHADOW_GRID; iz++)
        for (int ix = 0; ix < SHADOW_GRID; ix++) free_count += !covered[iz][ix];
    return (double)free_count / (SHADOW_GRID * SHADOW_GRID);
}

static Vec3 plain_foot(double u, double v) { return vec3(8 * u, 0, 8 * v); }

/* Mean transmittance over a tile of cones `width` tiles wide along (sx, -1, sz). */
static double mean_transmittance(SkinScene *s, double width, double sx, double sz) {
    int n = int_clamp((int)ceil(2 / width), 5, 48);
    double sum = 0;
    Vec3 d = vec3_normalize(vec3(sx, -1, sz));
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++) {
            Vec3 on = vec3(3 + (i + .5) / n, .5, 3 + (k + .5) / n);
            Cone cone = {vec3_madd(on, d, -2), d, width, 0};
            sum += exp(-travel(s, &cone, VTS_INFINITY).optical_depth);
        }
    return sum / (n * n);
}

/* A thick flat skin, one tile for each unit, seen by cones from a voxel to several tiles wide. */
static void a_slab_is_as_transparent_as_its_leaves(void **state) {
    (void)state;
    static const struct { size_t leaves; double size; unsigned cyclic; bool turned; double coarse; const char *name; } cases[] = {
        {60, .07, TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z, false, .10, "sparse"},
        {300, .05, TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z, false, .24, "half covered"},
        {1500, .04, TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z, false, .34, "dense"},
        {300, .05, 0, false, .24, "half covered, copies"},
        {300, .05, 0, true, .20, "half covered, turned copies"}};
    static const double widths[] = {1.0 / 128, 1.0 / 32, 1.0 / 8, 1.0 / 2, 1, 4}, slants[][2] = {{0, 0}, {.6, .3}};
    for (size_t c = 0; c < VTS_ARRAY_COUNT(cases); c++) {
        SkinScene s;
        skin_scene_begin(&s);
        skin_scene_fill(&s, 64, cases[c].leaves, cases[c].size, cases[c].cyclic, 9);
        Vec3 *v = (Vec3 *)s.leaf_mesh.vertices; /* nothing is cut off at the bounds */
        for (size_t i = 0; i < s.leaf_mesh.vertex_count; i++)
            v[i] = vec3(cases[c].cyclic ? v[i].x : .1 + .8 * v[i].x, .1 + .8 * v[i].y, cases[c].cyclic ? v[i].z : .1 + .8 * v[i].z);
        skin_scene_grid(&s, 4, 4, plain_foot, NULL);
        s.skin.mapping.repeat_u = s.skin.mapping.repeat_v = 8;
        if (cases[c].turned) s.skin.jitter.instance = (InstanceJitter){.present = true, .rotate = 360, .density = 1};
        assert_int_equal(skin_scene_compile(&s), COMPILE_OK);
        for (size_t k = 0; k < VTS_ARRAY_COUNT(slants); k++) {
            double truth = free_share(&s, slants[k][0], slants[k][1]);
            printf("%-28s slant %.1f: true %.3f, cones", cases[c].name, slants[k][0], truth);
            for (size_t w = 0; w < VTS_ARRAY_COUNT(widths); w++) {
                double got = mean_transmittance(&s, widths[w], slants[k][0], slants[k][1]);
                printf("  %.3f: %.3f", widths[w], got);
                /* `coarse`: voxels that are not small against the box lose what interpolation carries over its sides. */
                assert_true(fabs(got - truth) < (widths[w] < .2 ? .04 : cases[c].coarse));
            }
            printf("\n");
        }
        skin_scene_end(&s);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chords_of_a_ball_are_whole),
        cmocka_unit_test(paths_bend_with_the_layer),
        cmocka_unit_test(a_slab_is_as_transparent_as_its_leaves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
