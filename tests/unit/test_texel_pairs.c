/* What eye and light have in common, against rays through the triangles. */
#include "texel/voxel_lit.h"

#include "base/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { BLADES = 40, DENSE = 500 };

typedef struct Meadow {
    Vec3f vertices[3 * DENSE];
    int blades;
    VoxelLayer *layer;
} Meadow;

/* Triangles that stand anywhere in a unit cube, `wide` at the foot, all leaning a little. */
static void grow(Meadow *m, int blades, float wide, int resolution) {
    static uint32_t triangles[DENSE][3];
    m->blades = blades;
    for (int i = 0; i < blades; i++) {
        float x = random_unitf(random_hash((uint64_t)i, 0, 0, 7)), z = random_unitf(random_hash((uint64_t)i, 1, 0, 7));
        float turn = 6.28f * random_unitf(random_hash((uint64_t)i, 2, 0, 7)), lean = 0.2f * random_unitf(random_hash((uint64_t)i, 3, 0, 7));
        Vec3f across = {wide / 2 * cosf(turn), 0, wide / 2 * sinf(turn)};
        m->vertices[3 * i] = vec3f(x - across.x, 0, z - across.z);
        m->vertices[3 * i + 1] = vec3f(x + across.x, 0, z + across.z);
        m->vertices[3 * i + 2] = vec3f(x + lean * sinf(turn), 0.9f, z - lean * cosf(turn));
        for (int k = 0; k < 3; k++) triangles[i][k] = (uint32_t)(3 * i + k);
    }
    TexelMesh mesh = {.vertices = m->vertices, .vertex_count = 3 * (size_t)blades, .triangles = (const uint32_t(*)[3])triangles, .triangle_count = (size_t)blades};
    TexelBuildOptions options = {.resolution = resolution, .extent = {1, 1, 1}, .cyclic = TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z};
    m->layer = voxel_layer_build(&mesh, &options, NULL);
    assert_non_null(m->layer);
}

/* The nearest t in (from, …] at which the ray meets a blade, copies around included; INFINITY. */
static double meet(const Meadow *m, Vec3 from, Vec3 d, double after) {
    double nearest = INFINITY;
    for (int i = 0; i < m->blades; i++)
        for (int copy = 0; copy < 49; copy++) {
            Vec3 shift = {copy % 7 - 3, 0, copy / 7 - 3}, p[3];
            for (int k = 0; k < 3; k++) p[k] = vec3_add(vec3_from_f(m->vertices[3 * i + k]), shift);
            Vec3 e1 = vec3_sub(p[1], p[0]), e2 = vec3_sub(p[2], p[0]), h = vec3_cross(d, e2), s = vec3_sub(from, p[0]), q = vec3_cross(s, e1);
            double det = vec3_dot(e1, h), u = vec3_dot(s, h) / det, v = vec3_dot(d, q) / det, t = vec3_dot(e2, q) / det;
            if (u >= 0 && v >= 0 && u + v <= 1 && t > after && t < nearest) nearest = t;
        }
    return nearest;
}

typedef struct Shares {
    double seen, matter_lit, ground_lit, through; /* of the view, of what is seen of both, and what of the light reaches the ground */
} Shares;

/* Of side × side places. */
static Shares shares_of(const Meadow *m, int side, Vec3 eye, Vec3 light) {
    int matter = 0, lit = 0, ground = 0, ground_lit = 0, reached = 0;
    for (int i = 0; i < side * side; i++) {
        Vec3 foot = {(i % side + 0.5) / side, 0, (i / side + 0.5) / side}, high = vec3_madd(foot, eye, 1 / eye.y);
        bool open = isinf(meet(m, foot, light, 1e-9));
        double t = meet(m, high, vec3_negate(eye), 0);
        reached += open;
        if (t < 1 / eye.y) matter++, lit += isinf(meet(m, vec3_madd(high, eye, -t), light, 1e-6));
        else ground++, ground_lit += open;
    }
    return (Shares){matter / (double)(side * side), lit / (double)matter, ground_lit / (double)ground, reached / (double)(side * side)};
}

enum { TURNS = 4 };
static Vec3 turned(Vec3 d, int turn) {
    for (int i = 0; i < turn; i++) d = vec3(-d.z, d.y, d.x);
    return vec3_normalize(d);
}

static void shares_are_those_of_rays(void **state) {
    (void)state;
    static const struct {
        Vec3 eye, light;
    } ways[] = {{{0.3, 1, 0.2}, {0.9, 1, -0.4}}, {{-0.8, 1, 0.5}, {0.7, 1, -0.2}}, {{0.8, 1, 0.3}, {0.8, 1, 0.31}}, {{0.8, 1, 0.3}, {0.7, 1, 0.45}}, {{0.1, 1, -1.2}, {0.8, 1, -0.7}}};
    Meadow m;
    int close = 0;
    grow(&m, BLADES, 0.12f, 32);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(ways); i++) {
        Shares truth = {0, 0, 0, 0};
        double lit = 0, spot = 0, ground = 0;
        for (int turn = 0; turn < TURNS; turn++) { /* what so few blades show along one pair of directions is chance */
            Vec3 eye = turned(ways[i].eye, turn), light = turned(ways[i].light, turn);
            Shares found = shares_of(&m, 30, eye, light);
            double near = (double)pair_peak(&m.layer->pairs.spot, vec3f_from(eye), vec3f_from(light));
            lit += (double)voxel_layer_lit_pair(m.layer, vec3f_from(eye), vec3f_from(light)) / TURNS;
            spot += near / TURNS, ground += (found.through + (1 - found.through) * near) / TURNS;
            truth.seen += found.seen / TURNS, truth.matter_lit += found.matter_lit / TURNS;
            truth.ground_lit += found.ground_lit / TURNS, truth.through += found.through / TURNS;
        }
        print_message("seen %.3f: matter lit %.3f, rays %.3f; ground lit %.3f, rays %.3f, through %.3f\n", truth.seen, lit, truth.matter_lit, ground, truth.ground_lit,
                      truth.through);
        assert_true(fabs(lit - truth.matter_lit) < 0.08);
        /* Far from the light's own direction gaps may exclude each other, as they happen to in a period of few blades. */
        if (spot > 0.1) assert_true(fabs(ground - truth.ground_lit) < 0.5 * fabs(truth.through - truth.ground_lit));
        close += spot > 0.1;
    }
    assert_true(close >= 2);
    voxel_layer_destroy(m.layer);
}

/* What stands close behind a blade shades it, however close. */
static void shares_of_dense_matter_are_those_of_rays(void **state) {
    (void)state;
    static const Vec3 ways[][2] = {{{0.3, 1, 0.2}, {0.9, 1, -0.4}}, {{-0.8, 1, 0.5}, {0.7, 1, -0.2}}, {{0.1, 1, -1.2}, {0.8, 1, -0.7}}};
    Meadow m;
    double off = 0;
    grow(&m, DENSE, 0.04f, 32);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(ways); i++) {
        Vec3 eye = vec3_normalize(ways[i][0]), light = vec3_normalize(ways[i][1]);
        Shares truth = shares_of(&m, 24, eye, light);
        double lit = (double)voxel_layer_lit_pair(m.layer, vec3f_from(eye), vec3f_from(light));
        print_message("seen %.3f: matter lit %.3f, rays %.3f\n", truth.seen, lit, truth.matter_lit);
        off += (lit - truth.matter_lit) / VTS_ARRAY_COUNT(ways);
    }
    assert_true(fabs(off) < 0.03);
    voxel_layer_destroy(m.layer);
}

static void wide_blades_have_a_wide_spot(void **state) {
    (void)state;
    Meadow thin, wide;
    grow(&thin, BLADES, 0.04f, 32);
    grow(&wide, BLADES, 0.16f, 32);
    assert_true(thin.layer->pairs.spot.at[0][0] > 0 && wide.layer->pairs.spot.at[0][0] > 1.5f * thin.layer->pairs.spot.at[0][0]);
    voxel_layer_destroy(thin.layer);
    voxel_layer_destroy(wide.layer);
}

/* Cones of the eye may be thinner than the finest voxels. */
static void finest_voxels_have_powers_for_thin_cones(void **state) {
    (void)state;
    const Vec3f eye = pair_direction(1), light = pair_direction(0);
    Meadow m;
    grow(&m, DENSE, 0.04f, 8);
    float fine = logf(voxel_layer_light_on_matter(m.layer, 0, eye, light, 0.5f)) / logf(0.5f), finer = logf(voxel_layer_light_on_matter(m.layer, -8, eye, light, 0.5f)) / logf(0.5f);
    print_message("powers: eye's and light's voxels the finest %.3f, the cones thinner by far %.3f\n", (double)fine, (double)finer);
    assert_true(fabsf(logf(fine)) > 0.05f);
    assert_true(fabsf(logf(finer)) > 0.05f);
    voxel_layer_destroy(m.layer);
}

static void odd_directions_are_harmless(void **state) {
    (void)state;
    static const Vec3f odd[] = {{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, {NAN, 1, 0}, {INFINITY, 1, 0}, {0, 1e-30f, 0}, {1e30f, 1e30f, 0}};
    Meadow m;
    grow(&m, BLADES, 0.1f, 32);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(odd); i++)
        for (size_t k = 0; k < VTS_ARRAY_COUNT(odd); k++) {
            float lit = voxel_layer_lit_pair(m.layer, odd[i], odd[k]), spot = pair_peak(&m.layer->pairs.spot, odd[i], odd[k]);
            assert_true(lit == -1 || (lit >= 0 && lit <= 1));
            assert_true(spot >= 0 && spot <= 1);
        }
    voxel_layer_forget_pairs(m.layer);
    assert_false(voxel_layer_is_paired(m.layer));
    assert_true(voxel_layer_lit_pair(m.layer, vec3f(0, 1, 0), vec3f(0, 1, 0)) < 0);
    voxel_layer_destroy(m.layer);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(shares_are_those_of_rays), cmocka_unit_test(shares_of_dense_matter_are_those_of_rays), cmocka_unit_test(wide_blades_have_a_wide_spot),
                                       cmocka_unit_test(finest_voxels_have_powers_for_thin_cones), cmocka_unit_test(odd_directions_are_harmless)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
