/* What places in a texel see of the sky, against rays through the geometry and closed forms. */
#include "texel/texel_sky.h"
#include "texel_scenes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static TexelSky *sky_of(const TestMesh *mesh, int resolution, unsigned repeated, VoxelLayer **layer) {
    TexelMesh view = scene_view(mesh);
    TexelBuildOptions options = {.resolution = resolution,
                                 .extent = {1, 1, 1},
                                 .cyclic = repeated & (TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z)};
    *layer = voxel_layer_build(&view, &options, NULL);
    const VoxelLayer *layers[] = {*layer};
    return texel_sky_build(layers, 1,
                           &(TexelSkyOptions){.opacity = OPACITY_CORRELATED, .repeated = repeated});
}

static void test_empty_texels_see_everything(void **state) {
    (void)state;
    TestMesh empty = {0};
    VoxelLayer *layer;
    TexelSky *sky = sky_of(&empty, 32, 0, &layer);
    RandomStream r = {1};
    for (int i = 0; i < 100; i++) {
        SkyView v = texel_sky_at(sky, vec3f_from(scene_point(&r, 0)));
        Vec3f d = vec3f_from(scene_direction(&r));
        assert_true(fabsf(sky_view_toward(&v, d) - 1) < .02f);
        assert_true(fabsf(sky_view_hemisphere(&v, d) - 1) < .02f && fabsf(sky_view_cosine(&v, d) - 1) < .02f);
    }
    texel_sky_destroy(sky);
    voxel_layer_destroy(layer);
}

/* The means over hemispheres are those of the directional function, where no clamping interferes. */
static void test_means_are_integrals(void **state) {
    (void)state;
    RandomStream r = {2};
    SkyView v = {.mean = .5f, .first = {.1f, -.2f, .05f}, .second = {.05f, -.1f, .05f, .06f, -.03f, .02f}};
    for (int i = 0; i < 8; i++) {
        Vec3 n = scene_direction(&r);
        double even = 0, cosine = 0;
        enum { SAMPLES = 20000 };
        for (int k = 0; k < SAMPLES; k++) {
            Vec3 d = scene_spread_direction(k, SAMPLES);
            double c = vec3_dot(d, n);
            if (c <= 0) continue;
            even += (double)sky_view_toward(&v, vec3f_from(d)) * 2 / SAMPLES;
            cosine += (double)sky_view_toward(&v, vec3f_from(d)) * c * 4 / SAMPLES;
        }
        assert_true(fabs((double)sky_view_hemisphere(&v, vec3f_from(n)) - even) < 2e-3);
        assert_true(fabs((double)sky_view_cosine(&v, vec3f_from(n)) - cosine) < 2e-3);
    }
}

/* A sheet over the whole layer hides the sky from below it and none from above. */
static void test_a_roof_hides_the_sky(void **state) {
    (void)state;
    TestMesh roof = {0};
    uint32_t q[4];
    for (int i = 0; i < 4; i++) q[i] = scene_vertex(&roof, vec3(i == 1 || i == 2, .5, i >= 2));
    scene_quad(&roof, q[0], q[1], q[2], q[3], false);
    /* Something small to look from. */
    scene_leaf(&roof, vec3(.3, .2, .7), vec3(0, 1, 0), .01);
    scene_leaf(&roof, vec3(.3, .8, .7), vec3(0, 1, 0), .01);
    VoxelLayer *layer;
    TexelSky *sky = sky_of(&roof, 64, TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z, &layer);
    SkyView below = texel_sky_at(sky, vec3f(.3f, .2f, .7f)), above = texel_sky_at(sky, vec3f(.3f, .8f, .7f));
    Vec3f up = vec3f(0, 1, 0), down = vec3f(0, -1, 0);
    print_message("below a roof: mean %.3f up %.3f down %.3f; above: up %.3f down %.3f\n", (double)below.mean,
                  (double)sky_view_cosine(&below, up), (double)sky_view_cosine(&below, down),
                  (double)sky_view_cosine(&above, up), (double)sky_view_cosine(&above, down));
    assert_true(fabsf(below.mean - .5f) < .05f && sky_view_cosine(&below, up) < .16f &&
                sky_view_cosine(&below, down) > .9f);
    assert_true(sky_view_cosine(&above, up) > .9f && sky_view_cosine(&above, down) < .16f);
    texel_sky_destroy(sky);
    voxel_layer_destroy(layer);
    scene_free(&roof);
}

/* Where nothing is, the sky is that of the nearest matter: beside a wall that stands alone, of its sides. */
static void test_air_has_the_sky_of_what_is_near(void **state) {
    (void)state;
    TestMesh wall = {0};
    uint32_t q[4];
    for (int i = 0; i < 4; i++) q[i] = scene_vertex(&wall, vec3(.5, i == 1 || i == 2, i >= 2));
    scene_quad(&wall, q[0], q[1], q[2], q[3], false);
    VoxelLayer *layer;
    TexelSky *sky = sky_of(&wall, 64, 0, &layer);
    SkyView near = texel_sky_at(sky, vec3f(.55f, .5f, .5f)), far = texel_sky_at(sky, vec3f(.95f, .5f, .5f)), left = texel_sky_at(sky, vec3f(.05f, .5f, .5f));
    assert_true(fabsf(near.mean - far.mean) < .15f && far.first.x > .3f && left.first.x < -.3f);
    texel_sky_destroy(sky);
    voxel_layer_destroy(layer);
    scene_free(&wall);
}

static double seen_along(const TestMesh *mesh, Vec3 at, Vec3 d) {
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        Vec3 a = vec3_from_f(mesh->vertices[mesh->triangles[t][0]]),
             b = vec3_from_f(mesh->vertices[mesh->triangles[t][1]]),
             c = vec3_from_f(mesh->vertices[mesh->triangles[t][2]]);
        Vec3 ab = vec3_sub(b, a), ac = vec3_sub(c, a), p = vec3_cross(d, ac), s = vec3_sub(at, a),
             q = vec3_cross(s, ab);
        double det = vec3_dot(ab, p), u = vec3_dot(s, p) / det, v = vec3_dot(d, q) / det;
        if (u >= 0 && v >= 0 && u + v <= 1 && vec3_dot(ac, q) / det > 2.5 / 64) return 0;
    }
    return 1;
}

/* Hemispheres before leaves against rays through the triangles: what is left is that neighbours see different things. */
static void test_leaves_against_rays(void **state) {
    (void)state;
    TestMesh mesh = scene_leaves(300, .06, 1);
    VoxelLayer *layer;
    TexelSky *sky = sky_of(&mesh, 64, 0, &layer);
    RandomStream r = {4};
    double rms = 0, bias = 0, spread = 0;
    enum { PLACES_TESTED = 60, RAYS = 800 };
    for (int i = 0; i < PLACES_TESTED; i++) {
        const Vec3f *leaf =
            mesh.vertices + (size_t)i * 30; /* a hexagon's corners: its middle, and its normal */
        Vec3 at = vec3_scale(vec3_add(vec3_from_f(leaf[0]), vec3_from_f(leaf[3])), .5);
        Vec3 n = vec3_normalize(vec3_cross(vec3_sub(vec3_from_f(leaf[1]), vec3_from_f(leaf[0])),
                                           vec3_sub(vec3_from_f(leaf[2]), vec3_from_f(leaf[0]))));
        double truth = 0;
        for (int k = 0; k < RAYS; k++) {
            Vec3 d = scene_direction(&r);
            if (vec3_dot(d, n) < 0) d = vec3_negate(d);
            double c = vec3_dot(d, n);
            truth += 2 * c * seen_along(&mesh, at, d) / RAYS;
        }
        SkyView v = texel_sky_at(sky, vec3f_from(at));
        double error = (double)sky_view_cosine(&v, vec3f_from(n)) - truth;
        rms += error * error / PLACES_TESTED;
        bias += error / PLACES_TESTED;
        spread += truth / PLACES_TESTED;
    }
    print_message("leaves: mean seen %.3f, bias %+.3f, rms error %.3f\n", spread, bias, sqrt(rms));
    assert_true(sqrt(rms) < .1 && fabs(bias) < .05);
    texel_sky_destroy(sky);
    voxel_layer_destroy(layer);
    scene_free(&mesh);
}

static void test_same_for_any_threads_and_all_memory_returned(void **state) {
    (void)state;
    TestMesh mesh = scene_grass(100, .6, .012, 3);
    VoxelLayer *layer;
    TexelSky *one = sky_of(&mesh, 64, TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z, &layer);
    const VoxelLayer *layers[] = {layer, layer};
    MemoryBudget memory = {.limit = (size_t)1 << 30};
    Pool *pool = pool_create(3);
    TexelSkyOptions options = {.opacity = OPACITY_CORRELATED,
                               .repeated = TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z,
                               .pool = pool,
                               .memory = &memory};
    TexelSky *other = texel_sky_build(layers, 1, &options), *two = texel_sky_build(layers, 2, &options);
    double darker = 0, brighter = 0;
    Vec3f ways[SKY_WAYS];
    float none_open[SKY_WAYS] = {0};
    for (int i = 0; i < SKY_WAYS; i++) ways[i] = texel_sky_way(i);
    for (int i = 0; i < 50; i++) {
        Vec3f p = vec3f((float)(i % 5) / 5, .1f + (float)(i % 3) / 4, (float)(i % 7) / 7),
              up = vec3f(0, 1, 0);
        SkyView a = texel_sky_at(one, p), b = texel_sky_at(other, p), c = texel_sky_at(two, p);
        assert_memory_equal(&a, &b, sizeof a);
        float flat = texel_sky_seen(one, p, ways, none_open, vec3f(1, .1f, .3f)), steep = texel_sky_seen(one, p, ways, none_open, vec3f(.1f, 1, .3f));
        assert_true(flat == texel_sky_seen(other, p, ways, none_open, vec3f(1, .1f, .3f)) && flat >= 0 && flat <= 1);
        brighter += (double)(flat - steep) / 50;
        darker += (double)(sky_view_hemisphere(&a, up) - sky_view_hemisphere(&c, up)) / 50;
    }
    assert_true(darker > .03);   /* two layers in one place hide more */
    assert_true(brighter > .03); /* of what stands on the same place the eye sees what the sky sees, the more the flatter it looks */
    assert_int_equal(atomic_load(&memory.used), texel_sky_bytes(other) + texel_sky_bytes(two));
    texel_sky_destroy(other);
    texel_sky_destroy(two);
    assert_int_equal(atomic_load(&memory.used), 0);
    MemoryBudget none = {.limit = 100};
    options.memory = &none;
    assert_null(texel_sky_build(layers, 1, &options));
    SkyView absurd = texel_sky_at(one, vec3f(NAN, 1e30f, -INFINITY));
    assert_true(isfinite(absurd.mean));
    assert_true(isfinite(texel_sky_seen(one, vec3f(.5f, .5f, .5f), ways, none_open, vec3f(NAN, 1e30f, 0))));
    texel_sky_destroy(one);
    voxel_layer_destroy(layer);
    pool_destroy(pool);
    scene_free(&mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_empty_texels_see_everything),
        cmocka_unit_test(test_means_are_integrals),
        cmocka_unit_test(test_a_roof_hides_the_sky), cmocka_unit_test(test_air_has_the_sky_of_what_is_near),
        cmocka_unit_test(test_leaves_against_rays),
        cmocka_unit_test(test_same_for_any_threads_and_all_memory_returned),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
