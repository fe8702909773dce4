/* Perturbed normals and textures of textures, against closed forms. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "pattern/pattern.h"
#include "scene/scene.h"
#include "tape/noise.h"

static const Vec3 up = {0, 1, 0};

static Normal normal_of(const Pigment *pattern, NormalForm form, double amount) {
    return (Normal){.form = form, .pattern = pattern, .amount = amount, .accuracy = 0.02, .facet_size = 0.1};
}

static Texture texture_with(const Pigment *pigment, const Finish *finish, const Normal *normal) {
    return (Texture){.pigment = pigment, .finish = finish, .normal = normal, .transform = transform_identity()};
}

static Vec3 bent(const Texture *texture, Vec3 point, double footprint) {
    SurfacePlace place = {.point = point, .normal = up, .footprint = footprint};
    TexturePart part;
    assert_int_equal(texture_parts(texture, &place, &part, 1), 1);
    return texture_layer_normal(&part, part.texture, up, 1);
}

static void assert_vec(Vec3 a, Vec3 b, double tolerance) {
    if (!(vec3_length(vec3_sub(a, b)) <= tolerance))
        fail_msg("<%.9g, %.9g, %.9g> is not <%.9g, %.9g, %.9g>", a.x, a.y, a.z, b.x, b.y, b.z);
}

static const ColorMapEntry ramp[2] = {{.position = 0}, {.position = 1}};

/* Four corners of a tetrahedron see 4/3 of a constant slope; POV-Ray takes a tenth of it. */
static void test_a_slope_tilts_the_normal(void **state) {
    (void)state;
    Pigment pattern = pigment_default();
    Finish finish = finish_default();
    pattern.kind = PATTERN_GRADIENT, pattern.direction = vec3(1, 0, 0), pattern.entries = ramp, pattern.entry_count = 2;
    Normal normal = normal_of(&pattern, NORMAL_GRADIENT, 0.6);
    Texture texture = texture_with(&pattern, &finish, &normal);
    Vec3 expected = vec3_normalize(vec3(-0.6 * 0.1 * 4 / 3, 1, 0));
    assert_vec(bent(&texture, vec3(0.4, 0, 0.2), 0), expected, 1e-6);
    assert_vec(bent(&texture, vec3(0.4, 0, 0.2), 0.05), expected, 1e-6);
    normal.accuracy = 0.1; /* the strength does not depend on it */
    assert_vec(bent(&texture, vec3(0.4, 0, 0.2), 0), expected, 1e-6);
    SlopeEntry slopes[2] = {{0, 0, 0}, {1, 1, 0}}; /* 3t² − 2t³: slope 6t(1 − t) */
    normal.slopes = slopes, normal.slope_count = 2, normal.accuracy = 0.001;
    assert_vec(bent(&texture, vec3(0.5, 0, 0), 0), vec3_normalize(vec3(-0.6 * 0.1 * 4 / 3 * 1.5, 1, 0)), 1e-5);
}

static void test_bumps_add_the_noise(void **state) {
    (void)state;
    Pigment pattern = pigment_default();
    Finish finish = finish_default();
    Normal normal = normal_of(&pattern, NORMAL_BUMPS, 0.4);
    Texture texture = texture_with(&pattern, &finish, &normal);
    for (int k = 0; k < 50; k++) {
        Vec3 p = vec3(0.37 * k, 0.1, 1.3 - 0.21 * k);
        assert_vec(bent(&texture, p, 0), vec3_normalize(vec3_madd(up, noise_pov_vector(p), 0.4)), 1e-12);
        assert_vec(bent(&texture, p, 100), up, 0.01); /* what is far finer than the footprint is not seen */
    }
}

/* Scaled down ten times, normals are bent as before, at places ten times nearer; unscaled, the tilt grows with the slope. */
static void test_bump_scale(void **state) {
    (void)state;
    Pigment pattern = pigment_default();
    Finish finish = finish_default();
    pattern.transform = transform_scale(vec3_splat(0.1));
    Normal normal = normal_of(&pattern, NORMAL_BUMPS, 0.4);
    Texture texture = texture_with(&pattern, &finish, &normal);
    Vec3 p = vec3(0.13, 0, 0.27), noise = noise_pov_vector(vec3_scale(p, 10));
    assert_vec(bent(&texture, p, 0), vec3_normalize(vec3_madd(up, noise, 0.4)), 1e-9);
    normal.unscaled = true; /* the normal is a tenth as long in pattern space */
    assert_vec(bent(&texture, p, 0), vec3_normalize(vec3_madd(up, noise, 4)), 1e-9);
}

static void test_maps_choose_textures(void **state) {
    (void)state;
    Pigment pattern = pigment_default(), black = pigment_default(), white = pigment_default();
    Finish finish = finish_default();
    white.color = (Color){1, 1, 1, 0, 0};
    pattern.kind = PATTERN_GRADIENT, pattern.direction = vec3(1, 0, 0), pattern.entries = ramp, pattern.entry_count = 2;
    Texture a = texture_with(&black, &finish, NULL), b = texture_with(&white, &finish, NULL);
    const Texture *const both[2] = {&a, &b};
    TextureMap map = {.pattern = &pattern, .textures = both, .count = 2};
    Texture whole = texture_with(&black, &finish, NULL);
    whole.map = &map;
    SurfacePlace place = {.point = vec3(0.25, 0, 0), .normal = up};
    TexturePart parts[4];
    assert_int_equal(texture_parts(&whole, &place, parts, 4), 2);
    assert_true(parts[0].texture == &a && fabs(parts[0].weight - 0.75) < 1e-9);
    assert_true(parts[1].texture == &b && fabs(parts[1].weight - 0.25) < 1e-9);
    assert_int_equal(texture_parts(&whole, &place, parts, 1), 1); /* the heaviest alone */
    assert_true(parts[0].texture == &a && parts[0].weight == 1);
    pattern.kind = PATTERN_CHECKER;
    place.footprint = 1000; /* a checkerboard to the horizon is grey */
    assert_true(fabs(texture_look(&whole, place.point, up, 1000).color.red - 0.5) < 0.01);
}

static void test_uv_plane(void **state) {
    (void)state;
    Pigment inner = pigment_default(), outer = pigment_default();
    Finish finish = finish_default();
    inner.kind = PATTERN_GRADIENT, inner.direction = vec3(0, 1, 0);
    const ColorMapEntry entry = {.pigment = &inner};
    outer.kind = PATTERN_UV, outer.entries = &entry, outer.entry_count = 1;
    Texture texture = texture_with(&outer, &finish, NULL);
    SurfacePlace place = {.point = vec3(7, 8, 9), .normal = up, .surface = {.uv = {0.2, 0.7}}};
    TexturePart part;
    assert_int_equal(texture_parts(&texture, &place, &part, 1), 1);
    assert_true(fabs(texture_layer_color(&part, &texture, up).green - 0.7) < 1e-6);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_slope_tilts_the_normal), cmocka_unit_test(test_bumps_add_the_noise),
        cmocka_unit_test(test_bump_scale),               cmocka_unit_test(test_maps_choose_textures),
        cmocka_unit_test(test_uv_plane),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
