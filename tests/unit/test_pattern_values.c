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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gives_povrays_values),
        cmocka_unit_test(water_comes_from_the_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
