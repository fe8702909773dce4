/* Colour maps, layers and uniform pigments: closed forms, and colours that POV-Ray gives. */
#include "base/random.h"
#include "pattern/pattern.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const Vec3 no_normal = {0, 0, 0};
static const Color black = {0, 0, 0, 0, 0}, white = {1, 1, 1, 0, 0}, red = {1, 0, 0, 0, 0},
                   green = {0, 1, 0, 0, 0}, blue = {0, 0, 1, 0, 0};

static Pigment make_pigment(PatternKind kind) {
    Pigment pigment = pigment_default();
    pigment.kind = kind;
    pigment.direction = vec3(1, 0, 0);
    return pigment;
}

static void expect_color(const Pigment *pigment, double x, double y, double z, Color expected) {
    Color c = pigment_color(pigment, vec3(x, y, z), no_normal, 0);
    const double got[5] = {c.red, c.green, c.blue, c.filter, c.transmit};
    const double want[5] = {expected.red, expected.green, expected.blue, expected.filter, expected.transmit};
    for (int k = 0; k < 5; k++)
        if (fabs(got[k] - want[k]) > 1e-6)
            fail_msg("at %g %g %g: component %d is %.9g, expected %.9g", x, y, z, k, got[k], want[k]);
}

static void maps_interpolate_as_povrays(void **state) {
    (void)state;
    const ColorMapEntry entries[] = {
        {0.2, red, NULL}, {0.5, green, NULL}, {0.5, blue, NULL}, {0.8, white, NULL}};
    Pigment p = make_pigment(PATTERN_GRADIENT);
    p.entries = entries, p.entry_count = 4;
    expect_color(&p, 0, 0, 0, red);
    expect_color(&p, 0.1, 0, 0, red);
    expect_color(&p, 0.2, 0, 0, red);
    expect_color(&p, 0.5, 0, 0, green);
    expect_color(&p, 0.8, 0, 0, white);
    expect_color(&p, 1, 0, 0, white);
    expect_color(&p, 2, 0, 0, red);
    expect_color(&p, -1, 0, 0, red);
    expect_color(&p, -0.3, 0, 0, (Color){0.666667, 0.666667, 1, 0, 0});
    expect_color(&p, 1000.35, 0, 0, (Color){0.5, 0.5, 0, 0, 0});
}

static void filter_and_transmit_interpolate_too(void **state) {
    (void)state;
    const ColorMapEntry entries[] = {{0, {1, 0, 0, 0.2, 0.4}, NULL}, {1, {0, 1, 0, 0.6, 0.2}, NULL}};
    Pigment p = make_pigment(PATTERN_GRADIENT);
    p.entries = entries, p.entry_count = 2;
    expect_color(&p, 0.5, 0, 0, (Color){0.5, 0.5, 0, 0.4, 0.3});
    p.frequency = -1;
    expect_color(&p, 0.3, 0, 0, (Color){0.3, 0.7, 0, 0.48, 0.26});
}

static void default_maps_are_povrays(void **state) {
    (void)state;
    Pigment marble = make_pigment(PATTERN_MARBLE), wood = make_pigment(PATTERN_WOOD),
            radial = make_pigment(PATTERN_RADIAL), onion = make_pigment(PATTERN_ONION),
            checker = make_pigment(PATTERN_CHECKER), hexagon = make_pigment(PATTERN_HEXAGON);
    expect_color(&marble, 0, 0, 0, (Color){0.9, 0.8, 0.8, 0, 0});
    expect_color(&marble, 0.225, 0, 0, (Color){0.9, 0.44, 0.44, 0, 0});
    expect_color(&marble, 0.48, 0, 0, black);
    expect_color(&wood, 0.2, 0, 0, (Color){0.666, 0.312, 0.2, 0, 0});
    expect_color(&wood, 0.5, 0, 0, (Color){0.4, 0.1333, 0.066, 0, 0});
    expect_color(&radial, -0.00001, 0, -1, (Color){0.750756, 1, 0.249244, 0, 0});
    expect_color(&onion, 0.25, 0, 0, (Color){0.25, 0.25, 0.25, 0, 0});
    expect_color(&checker, 0.5, 0.5, 0.5, blue);
    expect_color(&checker, 1.5, 0.5, 0.5, green);
    expect_color(&checker, 1, 1, 1, green); /* a surface in the border belongs to the upper block */
    expect_color(&hexagon, 0.1, 0, 0.1, blue);
    expect_color(&hexagon, 1.6, 0, 0.2, red);
    expect_color(&hexagon, 0.2, 0, 1.6, green);
}

static void blocks_fill_up_with_their_own_colours(void **state) {
    (void)state;
    const ColorMapEntry entries[] = {{0, white, NULL}};
    Pigment p = make_pigment(PATTERN_CHECKER);
    p.entries = entries, p.entry_count = 1;
    expect_color(&p, 0.5, 0.5, 0.5, white);
    expect_color(&p, 1.5, 0.5, 0.5, green);
}

static void pigments_of_a_map_inherit_its_space(void **state) {
    (void)state;
    Pigment inner = make_pigment(PATTERN_GRADIENT), outer = make_pigment(PATTERN_GRADIENT),
            checker = make_pigment(PATTERN_CHECKER), third = inner;
    const ColorMapEntry ramp[] = {{0, black, NULL}, {1, white, NULL}};
    inner.entries = ramp, inner.entry_count = 2;
    third = inner;
    third.transform = transform_scale(vec3_splat(3));
    const ColorMapEntry entries[] = {{0, black, &inner}, {1, black, &inner}},
                        blocks[] = {{0, black, &inner}, {1, black, &third}};
    outer.direction = vec3(0, 1, 0);
    outer.entries = entries, outer.entry_count = 2;
    outer.transform = transform_scale(vec3_splat(10));
    expect_color(&outer, 2, 1, 0, (Color){0.2, 0.2, 0.2, 0, 0});
    checker.entries = blocks, checker.entry_count = 2;
    checker.transform = outer.transform;
    expect_color(&checker, 2, 1, 1, (Color){0.2, 0.2, 0.2, 0, 0});
    expect_color(&checker, 12, 1, 1, (Color){0.4, 0.4, 0.4, 0, 0});
    /* turbulence is inherited too */
    outer.transform = transform_identity();
    outer.turbulence = vec3_splat(1);
    expect_color(&outer, 2.3, 1.4, 0, (Color){0.036378, 0.036378, 0.036378, 0, 0});
}

static void functions_are_patterns(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    TapeBuilder *b = tape_builder_create(&arena, 3);
    TapeRef x = tape_input(b, 0);
    Pigment p = make_pigment(PATTERN_FUNCTION);
    p.function = tape_finish(b, &x, 1);
    expect_color(&p, -0.3, 0, 0, (Color){0.7, 0.7, 0.7, 0, 0});
    expect_color(&p, 1, 0, 0, white);
    expect_color(&p, 0.25, 0, 0, (Color){0.25, 0.25, 0.25, 0, 0});
    expect_color(&p, (double)NAN, 0, 0, black);
    arena_destroy(&arena);
}

static void slopes_go_by_the_angle(void **state) {
    (void)state;
    Pigment p = make_pigment(PATTERN_SLOPE);
    p.direction = vec3(0, 2, 0);
    assert_true(fabs(pigment_value(&p, no_normal, vec3(0, 1, 0)) - 1) < 1e-9);
    assert_true(fabs(pigment_value(&p, no_normal, vec3(0, -1, 0))) < 1e-9);
    assert_true(fabs(pigment_value(&p, no_normal, vec3(1, 0, 0)) - 0.5) < 1e-9);
    assert_true(fabs(pigment_value(&p, no_normal, vec3(sqrt(0.75), 0.5, 0)) - 2.0 / 3) < 1e-9);
}

static void knows_uniform_pigments(void **state) {
    (void)state;
    Color color;
    Pigment solid = make_pigment(PATTERN_SOLID), p = make_pigment(PATTERN_BOZO),
            nested = make_pigment(PATTERN_WOOD);
    solid.color = red;
    assert_true(pigment_is_uniform(&solid, &color) && color.red == 1);
    assert_false(pigment_is_uniform(&p, &color));
    const ColorMapEntry same[] = {{0, green, NULL}, {1, green, NULL}},
                        mixed[] = {{0, green, NULL}, {1, black, &solid}},
                        reds[] = {{0, red, NULL}, {1, black, &solid}};
    p.entries = same, p.entry_count = 2;
    assert_true(pigment_is_uniform(&p, &color) && color.green == 1);
    nested.entries = mixed, nested.entry_count = 2;
    assert_false(pigment_is_uniform(&nested, &color));
    nested.entries = reds;
    assert_true(pigment_is_uniform(&nested, &color) && color.red == 1);
    Pigment checker = make_pigment(PATTERN_CHECKER);
    checker.entries = same, checker.entry_count = 1;
    assert_false(pigment_is_uniform(&checker, &color));
}

static void layers_show_what_is_below(void **state) {
    (void)state;
    Finish finish = {.diffuse = 0.6}, other = {.diffuse = 0.1};
    Pigment top = make_pigment(PATTERN_SOLID), bottom = top, glass = top;
    top.color = (Color){1, 0, 0, 0, 0.25};
    bottom.color = (Color){0, 0.5, 1, 0, 0};
    glass.color = (Color){0.5, 1, 0, 1, 0};
    Texture below = {.pigment = &bottom, .finish = &other, .transform = transform_identity()};
    Texture above = {.pigment = &top, .finish = &finish, .transform = transform_identity(), .under = &below};
    SurfaceLook look = texture_look(&above, no_normal, no_normal, 0);
    assert_ptr_equal(look.finish, &finish);
    assert_true(fabs(look.color.red - 0.75) < 1e-12 && fabs(look.color.green - 0.125) < 1e-12);
    assert_true(fabs(look.color.blue - 0.25) < 1e-12 && look.color.transmit == 0);
    above.pigment = &glass; /* a filter alone: the product of the colours */
    look = texture_look(&above, no_normal, no_normal, 0);
    assert_true(fabs(look.color.red) < 1e-12 && fabs(look.color.green - 0.5) < 1e-12 &&
                fabs(look.color.blue) < 1e-12);
    above.under = NULL; /* one layer keeps its colour as it is */
    look = texture_look(&above, no_normal, no_normal, 0);
    assert_true(look.color.filter == 1 && look.color.red == 0.5);
}

static void layers_stand_in_texture_space(void **state) {
    (void)state;
    Pigment checker = make_pigment(PATTERN_CHECKER);
    Finish finish = {.diffuse = 0.6};
    Texture texture = {
        .pigment = &checker, .finish = &finish, .transform = transform_translate(vec3(1, 0, 0))};
    assert_true(texture_look(&texture, vec3(0.5, 0.5, 0.5), no_normal, 0).color.green == 1);
    assert_true(texture_look(&texture, vec3(1.5, 0.5, 0.5), no_normal, 0).color.blue == 1);
}

/* From far away a noise shows the mean of its map, rare colours of the map's ends included; of granite, whose values lean to
 * one side, half of these. */
static void rare_values_of_noises_are_seen_from_afar(void **state) {
    (void)state;
    static const PatternKind kinds[] = {PATTERN_BOZO, PATTERN_GRANITE, PATTERN_WRINKLES};
    const ColorMapEntry rare[] = {{0, {0, 0, 0, 0, 0}, NULL}, {0.7, {0, 0, 0, 0, 0}, NULL}, {0.7, {1, 1, 1, 0, 0}, NULL}, {1, {1, 1, 1, 0, 0}, NULL}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(kinds); i++) {
        Pigment pigment = make_pigment(kinds[i]);
        pigment.entries = rare;
        pigment.entry_count = VTS_ARRAY_COUNT(rare);
        double sum = 0;
        enum { POINTS = 20000 };
        for (uint64_t k = 0; k < POINTS; k++) {
            Vec3 p = vec3(random_unit(random_hash(k, 1, 0, 0)), random_unit(random_hash(k, 2, 0, 0)), random_unit(random_hash(k, 3, 0, 0)));
            sum += pigment_color(&pigment, vec3_scale(p, 100), no_normal, 0).red;
        }
        double near = sum / POINTS, far = pigment_color(&pigment, vec3(0.3, 0.2, 0.1), no_normal, 1000).red;
        assert_true(near > 0.03 && near < 0.12);
        assert_true(far > 0.5 * near && far < 1.25 * near);
    }
}

static void skies_have_layers(void **state) {
    (void)state;
    Pigment day = make_pigment(PATTERN_GRADIENT), clouds = make_pigment(PATTERN_SOLID);
    day.direction = vec3(0, 1, 0);
    clouds.color = (Color){1, 1, 1, 0, 0.5};
    const Pigment *layers[] = {&day, &clouds};
    Scene scene = {.sky_emission = {1, 1, 1, 0, 0}, .background = {0.1, 0.2, 0.3, 0, 0}, .sky_layers = layers};
    assert_true(sky_color(&scene, vec3(0, 1, 0), 0).green == 0.2);
    scene.sky_layer_count = 1;
    assert_true(fabs(sky_color(&scene, vec3(0.6, 0.8, 0), 0).green - 0.8) < 1e-9);
    scene.sky_layer_count = 2;
    assert_true(fabs(sky_color(&scene, vec3(0.6, 0.8, 0), 0).green - 0.9) < 1e-9);
}

/* POV-Ray's own pixels: two clear layers over <.2, .4, .6>, as version 3.7 and as 3.6 lays them; with and without emission. */
static void skies_of_two_versions(void **state) {
    (void)state;
    Pigment low = make_pigment(PATTERN_SOLID), high = make_pigment(PATTERN_SOLID);
    low.color = (Color){0.9, 0.8, 0.7, 0.6, 0.3};
    high.color = (Color){0.3, 0.5, 0.7, 0.4, 0.2};
    const Pigment *layers[] = {&low, &high};
    static const struct {
        bool old;
        Color emission, seen;
    } cases[] = {{false, {1, 1, 1, 0, 0}, {0.2026, 0.3568, 0.5210, 0, 0}},
                 {true, {1, 1, 1, 0, 0}, {0.1990, 0.3104, 0.4286, 0, 0}},
                 {false, {0.5, 0.7, 0.8, 0, 0}, {0.1282, 0.2872, 0.4582, 0, 0}},
                 {true, {0.5, 0.7, 0.8, 0, 0}, {0.1120, 0.2360, 0.3642, 0, 0}}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        Scene scene = {.sky_emission = cases[i].emission, .background = {0.2, 0.4, 0.6, 0, 0}, .sky_layers = layers, .sky_layer_count = 2, .old_sky = cases[i].old};
        Color seen = sky_color(&scene, vec3(0, 1, 0), 0);
        assert_true(fabs(seen.red - cases[i].seen.red) < 1e-4);
        assert_true(fabs(seen.green - cases[i].seen.green) < 1e-4);
        assert_true(fabs(seen.blue - cases[i].seen.blue) < 1e-4);
    }
}

static void absurd_places_are_harmless(void **state) {
    (void)state;
    const double places[] = {1e18, -1e300, (double)INFINITY, (double)NAN, 5e-324};
    for (int kind = 0; kind <= PATTERN_FUNCTION; kind++)
        for (size_t k = 0; k < VTS_ARRAY_COUNT(places); k++)
            for (int wide = 0; wide < 2; wide++) {
                Pigment p = make_pigment((PatternKind)kind);
                p.turbulence = vec3_splat(kind & 1 ? 0.5 : 0);
                Color c = pigment_color(&p, vec3(places[k], 1, places[k]), vec3(0, 1, 0), wide ? 0.3 : 0);
                if (isfinite(places[k]) && fabs(places[k]) < 1e20) assert_true(c.red >= 0 && c.red <= 1);
            }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_interpolate_as_povrays),
        cmocka_unit_test(filter_and_transmit_interpolate_too),
        cmocka_unit_test(default_maps_are_povrays),
        cmocka_unit_test(blocks_fill_up_with_their_own_colours),
        cmocka_unit_test(pigments_of_a_map_inherit_its_space),
        cmocka_unit_test(functions_are_patterns),
        cmocka_unit_test(slopes_go_by_the_angle),
        cmocka_unit_test(knows_uniform_pigments),
        cmocka_unit_test(layers_show_what_is_below),
        cmocka_unit_test(layers_stand_in_texture_space),
        cmocka_unit_test(rare_values_of_noises_are_seen_from_afar),
        cmocka_unit_test(skies_have_layers),
        cmocka_unit_test(skies_of_two_versions),
        cmocka_unit_test(absurd_places_are_harmless),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
