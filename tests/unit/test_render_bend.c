/* Directions and shares of what surfaces mirror and bend, against closed forms. */
#include "render/surface.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

static const Vec3 up = {0, 1, 0};

static Vec3 falling(double degrees) { return vec3(sin(degrees * VTS_RADIANS), -cos(degrees * VTS_RADIANS), 0); }

static void mirrors_keep_the_angle(void **state) {
    (void)state;
    for (double a = 0; a < 90; a += 7.5) {
        Vec3 out = surface_mirrored(falling(a), up, up);
        assert_true(vec3_length(vec3_sub(out, vec3(sin(a * VTS_RADIANS), cos(a * VTS_RADIANS), 0))) < 1e-12);
    }
}

/* However a bump turns the normal, nothing is mirrored into the surface. */
static void mirrors_never_look_inside(void **state) {
    (void)state;
    for (double a = 0; a < 90; a += 5)
        for (double tilt = -80; tilt <= 80; tilt += 5) {
            Vec3 normal = vec3(sin(tilt * VTS_RADIANS), cos(tilt * VTS_RADIANS), 0), out = surface_mirrored(falling(a), normal, up);
            assert_true(out.y > -1e-12 && fabs(vec3_length(out) - 1) < 1e-12);
        }
}

static void light_bends_as_snell_says(void **state) {
    (void)state;
    for (double a = 0; a < 90; a += 7.5)
        for (double ior = 1.1; ior < 2.5; ior += 0.3) {
            Vec3 in, out;
            assert_true(surface_bent(falling(a), up, 1 / ior, &in));
            assert_true(fabs(sin(a * VTS_RADIANS) - ior * in.x) < 1e-12 && in.y < 0);
            assert_true(surface_bent(in, up, ior, &out)); /* and through the other side of a slab it goes on as it came */
            assert_true(vec3_length(vec3_sub(out, falling(a))) < 1e-9);
        }
}

static void beyond_the_critical_angle_all_is_reflected(void **state) {
    (void)state;
    double critical = asin(1 / 1.5) / VTS_RADIANS;
    Vec3 out;
    assert_true(surface_bent(falling(critical - 0.01), up, 1.5, &out));
    assert_false(surface_bent(falling(critical + 0.01), up, 1.5, &out));
    assert_true(surface_fresnel(cos((critical + 0.01) * VTS_RADIANS), 1 / 1.5) == 1);
    assert_true(surface_fresnel(cos((critical - 1) * VTS_RADIANS), 1 / 1.5) < 0.7);
}

/* Rs = ((cos i − n cos t) / (cos i + n cos t))², Rp likewise; the mean of both. */
static void shares_are_fresnels(void **state) {
    (void)state;
    for (double a = 0; a < 90; a += 3.7)
        for (double n = 0.6; n < 2.6; n += 0.45) {
            double i = a * VTS_RADIANS, sine = sin(i) / n;
            if (sine >= 1) continue;
            double c = cos(i), t = sqrt(1 - sine * sine), s = (c - n * t) / (c + n * t), p = (t - n * c) / (t + n * c);
            assert_true(fabs(surface_fresnel(c, n) - (s * s + p * p) / 2) < 1e-12);
        }
    assert_true(fabs(surface_fresnel(1, 1.5) - 0.04) < 1e-12);
    assert_true(surface_fresnel(0, 1.5) == 1);
}

static void reflection_goes_from_the_first_colour_to_the_second(void **state) {
    (void)state;
    Finish f = finish_default();
    f.reflection_min = (Color){0.1, 0.2, 0.3, 0, 0};
    f.reflection_max = (Color){0.9, 0.8, 0.7, 0, 0};
    f.reflection_falloff = 2;
    Vec3f white = {1, 1, 1}, red = {1, 0, 0};
    Vec3f straight = surface_reflectivity(&f, white, 1, 1), grazing = surface_reflectivity(&f, white, 0, 1), between = surface_reflectivity(&f, white, 0.5, 1);
    assert_true(fabsf(straight.x - 0.1f) < 1e-6f && fabsf(grazing.z - 0.7f) < 1e-6f);
    assert_true(fabsf(between.x - (0.1f + 0.25f * 0.8f)) < 1e-6f);
    f.reflection_metallic = 1; /* coloured straight on, white at the rim */
    straight = surface_reflectivity(&f, red, 1, 1), grazing = surface_reflectivity(&f, red, 0, 1);
    assert_true(fabsf(straight.y) < 1e-3f && fabsf(grazing.y - 0.8f) < 1e-3f);
}

static void interiors_swallow_light(void **state) {
    (void)state;
    Interior in = interior_default();
    assert_true(surface_faded(&in, 5).x == 1);
    in.fade_distance = 2, in.fade_power = 2;
    in.fade_color = (Color){0.5, 0, 1, 0, 0};
    Vec3f half = surface_faded(&in, 2), far = surface_faded(&in, 1e6);
    assert_true(fabsf(half.x - 0.75f) < 1e-6f && fabsf(half.y - 0.5f) < 1e-6f && fabsf(half.z - 1) < 1e-6f);
    assert_true(fabsf(far.x - 0.5f) < 1e-6f && far.y < 1e-6f);
    in.fade_power = 1000; /* Beer's law */
    for (double d = 0.5; d < 10; d += 0.7) assert_true(fabsf(surface_faded(&in, d).y - (float)exp(-d / 2)) < 1e-6f);
}

static void enclosures_open_and_close(void **state) {
    (void)state;
    Interior glass = interior_default();
    Enclosure e[MOST_ENCLOSURES];
    const CompiledScene compiled = {.solids_matter = false};
    TraceCounters counters = {0};
    const SurfaceTracer tracer = {.compiled = &compiled, .counters = &counters};
    int count = 0;
    for (int pass = 0; pass < 2; pass++) { /* in through many, and out again in the same order */
        for (uint64_t k = 1; k <= 5; k++) {
            SurfaceHit hit = {.interior = &glass, .filled = k};
            surface_cross(&tracer, e, &count, &hit);
        }
        assert_int_equal(count, pass == 0 ? 5 : 0);
    }
    for (uint64_t k = 1; k <= 3 * MOST_ENCLOSURES; k++) {
        SurfaceHit hit = {.interior = &glass, .filled = k};
        surface_cross(&tracer, e, &count, &hit);
    }
    assert_int_equal(count, MOST_ENCLOSURES);
    assert_int_equal(counters.left_out, 2 * MOST_ENCLOSURES);
    assert_true(e[count - 1].filled == MOST_ENCLOSURES);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mirrors_keep_the_angle),     cmocka_unit_test(mirrors_never_look_inside),
        cmocka_unit_test(light_bends_as_snell_says),  cmocka_unit_test(beyond_the_critical_angle_all_is_reflected),
        cmocka_unit_test(shares_are_fresnels),        cmocka_unit_test(reflection_goes_from_the_first_colour_to_the_second),
        cmocka_unit_test(interiors_swallow_light),    cmocka_unit_test(enclosures_open_and_close),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
