/* Patterns against POV-Ray's own values. */
#include "pattern/numbers.h"
#include "pattern/pattern.h"
#include "tape/noise.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#ifndef POV_PATTERNS
#define POV_PATTERNS "pov_patterns.inc"
#endif

typedef struct Expectation {
    PatternKind kind;
    Vec3 direction;
    int modifiers;
    Vec3 place;
    double value;
} Expectation;

static const Expectation expectations[] = {
#include POV_PATTERNS
};

static Pigment make_pigment(PatternKind kind) {
    Pigment pigment = pigment_default();
    pigment.kind = kind;
    pigment.direction = vec3(1, 0, 0);
    return pigment;
}

static Transform chain(Vec3 scale, Vec3 rotate, Vec3 translate) {
    Transform s = transform_scale(scale), r = transform_rotate(rotate), t = transform_translate(translate);
    Transform sr = transform_then(&s, &r);
    return transform_then(&sr, &t);
}

static void modify(Pigment *pigment, int modifiers) {
    switch (modifiers) {
    case 1: pigment->turbulence = vec3_splat(0.5); break;
    case 2:
        pigment->turbulence = vec3(0.3, 0.6, 0.2);
        pigment->octaves = 3, pigment->lambda = 2.5, pigment->omega = 0.6;
        break;
    case 3: pigment->frequency = 2.5, pigment->phase = 0.3; break;
    case 4:
        pigment->turbulence = vec3_splat(0.4);
        pigment->transform = chain(vec3_splat(2), vec3(10, 20, 30), vec3(1, 2, 3));
        break;
    default: break;
    }
}

static void gives_povrays_values(void **state) {
    (void)state;
    int wrong = 0;
    for (size_t k = 0; k < VTS_ARRAY_COUNT(expectations); k++) {
        const Expectation *e = &expectations[k];
        if (e->kind == PATTERN_HEXAGON && e->modifiers == 3) continue; /* is counted, not mapped */
        Pigment pigment = make_pigment(e->kind);
        pigment.direction = e->direction;
        modify(&pigment, e->modifiers);
        double value = pigment_value(&pigment, e->place, vec3(0, 0, 0));
        if (fabs(value - e->value) < 1e-9) continue;
        print_error("kind %d, modifiers %d at %.17g %.17g %.17g: %.12g, POV-Ray %.12g\n", (int)e->kind,
                    e->modifiers, e->place.x, e->place.y, e->place.z, value, e->value);
        wrong++;
    }
    assert_int_equal(wrong, 0);
}

/* Those that are written down are those of the noise. */
static void water_comes_from_the_noise(void **state) {
    (void)state;
    for (int i = 0; i < 20; i++) {
        Vec3 source = water_source(i), noise = vec3_normalize(noise_pov_vector(vec3(i, 0, 0)));
        assert_true(vec3_length(vec3_sub(source, noise)) < 1e-15);
    }
}

/* z² + c counted out, one iteration after the other. */
static double counted_out(const FractalSettings *f, double x, double y) {
    double re = x, im = y, nearest = x * x + y * y;
    for (int i = 0; i < f->iterations; i++) {
        const double next = re * re - im * im + x;
        im = 2 * re * im + y, re = next;
        nearest = fmin(nearest, re * re + im * im);
        if (re * re + im * im > 4) return (double)i / f->iterations;
    }
    const double values[] = {1, sqrt(nearest), re, im, re * re, im * im, re * re + im * im};
    return values[f->interior];
}

/* Cycles that are left out change nothing, not even which place of them is the last; nor do places side by side. */
static void fractals_skip_whole_cycles(void **state) {
    (void)state;
    Pigment pigment = make_pigment(PATTERN_MANDEL);
    FractalSettings *f = &pigment.fractal;
    f->exponent = 2, f->exterior = 1, f->exterior_factor = f->interior_factor = 1;
    for (int k = 0; k < 4000; k++) {
        const double x = -2 + 2.6 * (k % 63) / 62, y = -1.2 + 2.4 * (k / 63) / 63;
        f->interior = k % 7, f->iterations = 1 + k * 37 % 3001;
        const Vec3 places[FRACTAL_LANES] = {vec3(x, y, 0), vec3(x / 3, 0, 0), vec3(-x, y / 2, 0), vec3(y, 1e200 * (k % 2), 0)};
        double values[FRACTAL_LANES];
        fractal_numbers(&pigment, places, values);
        for (int i = 0; i < FRACTAL_LANES; i++) {
            const double counted = counted_out(f, places[i].x, places[i].y);
            assert_true(fractal_number(&pigment, places[i]) == counted);
            assert_true(values[i] == counted);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gives_povrays_values),
        cmocka_unit_test(water_comes_from_the_noise),
        cmocka_unit_test(fractals_skip_whole_cycles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
