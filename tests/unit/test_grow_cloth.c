/* Cloth against closed forms, and what must hold for every sheet, from limp to rigid. */
#include "grow/cloth.h"
#include "grow/wind.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct Sheet {
    Arena arena;
    ClothSpec spec;
    SpringNet *cloth;
    Vec3 *places, *rest;
    size_t bytes;
} Sheet;

static Sheet lay(const ClothSpec *spec) {
    Sheet s = {.spec = *spec, .bytes = cloth_mass_count(spec) * sizeof(Vec3)};
    arena_init(&s.arena, NULL, 0);
    s.cloth = cloth_create(spec, &s.arena);
    s.places = malloc(s.bytes), s.rest = malloc(s.bytes);
    net_follow(s.cloth, 0, NULL, cloth_mass_count(&s.spec), s.rest);
    return s;
}

static void fold(Sheet *s) {
    arena_destroy(&s->arena);
    free(s->places);
    free(s->rest);
}

static Vec3 place(const Sheet *s, int i, int j) { return s->places[(size_t)i * ((size_t)s->spec.nv + 1) + (size_t)j]; }
static Vec3 rest(const Sheet *s, int i, int j) { return s->rest[(size_t)i * ((size_t)s->spec.nv + 1) + (size_t)j]; }
static double length(Vec3 a, Vec3 b) { return vec3_length(vec3_sub(a, b)); }

static ClothSpec flag(double stiffness, unsigned pins) {
    ClothSpec s = cloth_default();
    s.width = 1.5, s.height = 1, s.nu = 12, s.nv = 8, s.stiffness = stiffness, s.pins = pins, s.damping = 0;
    return s;
}

static void assert_near(double found, double expected, double most) { assert_true(fabs(found - expected) <= most); }

/* ---- closed forms ---- */

/* Springs along one side only hang by themselves: at the distance a below the pins the pull is what hangs below, so that
 * the place there is a + m·g/(K·w)·(a − a²/(2·h)). */
static void a_hanging_sheet_stretches_as_its_weight_says(void **state) {
    (void)state;
    ClothSpec spec = {.width = 0.7, .height = 2, .nu = 3, .nv = 40, .mass = 0.3, .stiffness = 60, .damping = 4, .elongation = 1,
                      .gravity = {0, -9.81, 0}, .pins = CLOTH_PIN_TOP};
    Sheet s = lay(&spec);
    net_follow(s.cloth, 12, NULL, cloth_mass_count(&s.spec), s.places);
    double strain = spec.mass * 9.81 / (spec.stiffness * spec.width);
    for (int j = 0; j <= spec.nv; j++) {
        double a = spec.height * (1 - (double)j / spec.nv), expected = spec.height / 2 - (a + strain * (a - a * a / (2 * spec.height)));
        assert_near(place(&s, 1, j).y, expected, 1e-3);
        assert_near(place(&s, 1, j).x, rest(&s, 1, j).x, 1e-8);
    }
    fold(&s);
}

/* Between two pins, as far apart as it is long, a row of springs hangs as an elastic catenary: with H the pull across, EA the
 * stiffness, w the weight of a unit and L the length at rest, the span is H·L/EA + 2·H/w·asinh(w·L/(2·H)) and the sag is
 * w·L²/(8·EA) + H/w·(√(1 + (w·L/(2·H))²) − 1). */
static void a_row_between_two_pins_is_an_elastic_catenary(void **state) {
    (void)state;
    for (double stiffness = 20; stiffness < 3000; stiffness *= 10) {
        ClothSpec spec = {.width = 2, .height = 0.1, .nu = 32, .nv = 1, .mass = 0.1, .stiffness = stiffness, .damping = 4, .elongation = 5,
                          .gravity = {0, -9.81, 0}, .pins = CLOTH_PIN_LEFT | CLOTH_PIN_RIGHT};
        Sheet s = lay(&spec);
        net_follow(s.cloth, 10, NULL, cloth_mass_count(&s.spec), s.places);
        double ea = stiffness * spec.height / 2, w = spec.mass / 2 * 9.81 / spec.width, l = spec.width, low = 1e-9, high = 1e6;
        for (int k = 0; k < 200; k++) {
            double h = sqrt(low * high), span = h * l / ea + 2 * h / w * asinh(w * l / (2 * h));
            *(span < l ? &low : &high) = h;
        }
        double tilt = w * l / (2 * low), sag = w * l * l / (8 * ea) + low / w * (sqrt(1 + tilt * tilt) - 1);
        double found = rest(&s, 16, 0).y - place(&s, 16, 0).y;
        assert_true(fabs(found - sag) < 0.015 * sag);
        fold(&s);
    }
}

static void a_loose_sheet_falls_as_things_fall(void **state) {
    (void)state;
    for (double stiffness = 1e-3; stiffness < 1e10; stiffness *= 1e4) {
        ClothSpec spec = flag(stiffness, 0);
        Sheet s = lay(&spec);
        net_follow(s.cloth, 1, NULL, cloth_mass_count(&s.spec), s.places);
        Vec3 middle = vec3_splat(0);
        for (size_t i = 0; i < cloth_mass_count(&spec); i++) {
            assert_near(s.places[i].y - s.rest[i].y, -9.81 / 2, 0.02);
            middle = vec3_madd(middle, vec3_sub(s.places[i], s.rest[i]), 1.0 / (double)cloth_mass_count(&spec));
        }
        assert_near(middle.y, -9.81 / 2, 0.005);
        fold(&s);
    }
}

static void a_wind_from_the_front_pushes_with_its_force_on_the_area(void **state) {
    (void)state;
    WindField wind = {.direction = {0, 0, 1}, .strength = 0.8, .gust_wavelength = 1, .gust_sharpness = 1, .turbulence_scale = 1, .stiffness = 1};
    ClothSpec spec = flag(100, 0);
    spec.wind = &wind, spec.gravity = vec3_splat(0), spec.unrest = 0;
    Sheet s = lay(&spec);
    net_follow(s.cloth, 0.5, NULL, cloth_mass_count(&s.spec), s.places);
    double expected = 0.5 * 0.25 * 0.8 * spec.width * spec.height / spec.mass;
    for (size_t i = 0; i < cloth_mass_count(&spec); i++) assert_near(s.places[i].z, expected, 0.005 * expected);
    fold(&s);
}

/* ---- whatever the sheet ---- */

static const unsigned pinnings[] = {CLOTH_PIN_LEFT, CLOTH_PIN_TOP, CLOTH_PIN_CORNERS, CLOTH_PIN_LEFT | CLOTH_PIN_RIGHT, 0};

static double height_energy(const Sheet *s) {
    double sum = 0, cell = s->spec.mass / (s->spec.nu * s->spec.nv);
    for (int i = 0; i <= s->spec.nu; i++)
        for (int j = 0; j <= s->spec.nv; j++) {
            double share = (i == 0 || i == s->spec.nu ? 0.5 : 1) * (j == 0 || j == s->spec.nv ? 0.5 : 1);
            sum += cell * share * 9.81 * place(s, i, j).y;
        }
    return sum;
}

/* Over all springs that may not be stretched too far: how far they are. */
static double longest(const Sheet *s) {
    double most = 0;
    for (int i = 0; i <= s->spec.nu; i++)
        for (int j = 0; j <= s->spec.nv; j++)
            for (int k = 0; k < 4; k++) {
                int to_i = i + (k != 1), to_j = j + (k == 1 || k == 2) - (k == 3);
                if (to_i > s->spec.nu || to_j > s->spec.nv || to_j < 0) continue;
                most = fmax(most, length(place(s, i, j), place(s, to_i, to_j)) / length(rest(s, i, j), rest(s, to_i, to_j)));
            }
    return most;
}

static void energy_and_length_keep_their_bounds_from_limp_to_rigid(void **state) {
    (void)state;
    double stiffness = 1e-3;
    for (int q = 0; q < 13; q++, stiffness *= 10) {
        ClothSpec spec = flag(stiffness, pinnings[q % (int)VTS_ARRAY_COUNT(pinnings)]);
        spec.elongation = q % 3 == 0 ? 0 : 0.1;
        Sheet s = lay(&spec);
        double start = net_energy(s.cloth), hundredth = 0.01 * spec.mass * 9.81 * spec.height;
        for (int frame = 1; frame <= 48; frame++) {
            net_follow(s.cloth, frame / 24.0, NULL, cloth_mass_count(&s.spec), s.places);
            for (size_t i = 0; i < cloth_mass_count(&spec); i++) assert_true(vec3_is_finite(s.places[i]));
            assert_true(net_energy(s.cloth) <= start + hundredth);
            assert_true(height_energy(&s) <= start + hundredth);
            assert_true(longest(&s) <= (1 + spec.elongation) * 1.003);
            for (int j = 0; spec.pins & CLOTH_PIN_LEFT && j <= spec.nv; j++) assert_memory_equal(&s.places[j], &s.rest[j], sizeof(Vec3));
        }
        fold(&s);
    }
}

/* Springs are as stiff as asked as long as steps can tell: without damping a sheet that is let go stretched keeps what it has. */
static void little_is_lost_where_springs_are_soft(void **state) {
    (void)state;
    ClothSpec spec = {.width = 0.2, .height = 1, .nu = 1, .nv = 12, .mass = 0.2, .stiffness = 100, .elongation = 1, .gravity = {0, -9.81, 0}, .pins = CLOTH_PIN_TOP};
    Sheet s = lay(&spec);
    double deepest = 0, again = 0;
    for (int frame = 0; frame < 480; frame++) {
        net_follow(s.cloth, frame / 240.0, NULL, cloth_mass_count(&s.spec), s.places);
        double depth = -0.5 - place(&s, 0, 0).y;
        if (frame < 120) deepest = fmax(deepest, depth);
        if (frame > 360) again = fmax(again, depth);
    }
    assert_true(deepest > 1.7 * 0.5 * spec.mass * 9.81 / (spec.stiffness * spec.width)); /* it swings to twice the rest */
    assert_true(again > 0.6 * deepest);
    fold(&s);
}

static WindField breeze(void) {
    return (WindField){.direction = {0.6, 0, 0.8}, .speed = 5, .strength = 2, .gust_wavelength = 3, .gust_amplitude = 0.4, .gust_sharpness = 2,
                       .turbulence_amplitude = 0.5, .turbulence_scale = 1, .turbulence_octaves = 3, .turbulence_seed = 4, .stiffness = 1};
}

static void a_time_alone_is_that_time_of_the_whole_run(void **state) {
    (void)state;
    WindField wind = breeze();
    ClothSpec spec = flag(60, CLOTH_PIN_LEFT);
    spec.wind = &wind;
    static const double rates[] = {24, 25, 29.97, 7, 300};
    for (size_t r = 0; r < VTS_ARRAY_COUNT(rates); r++) {
        Sheet run = lay(&spec), alone = lay(&spec);
        int last = (int)(1.7 * rates[r]);
        for (int frame = 0; frame <= last; frame++) net_follow(run.cloth, frame / rates[r], NULL, cloth_mass_count(&run.spec), run.places);
        net_follow(alone.cloth, last / rates[r], NULL, cloth_mass_count(&alone.spec), alone.places);
        assert_memory_equal(run.places, alone.places, run.bytes);
        assert_true(length(place(&run, 12, 0), rest(&run, 12, 0)) > 0.05);
        fold(&run);
        fold(&alone);
    }
}

static void places_go_on_without_jumps(void **state) {
    (void)state;
    WindField wind = breeze();
    ClothSpec spec = flag(60, CLOTH_PIN_LEFT);
    spec.wind = &wind;
    Sheet s = lay(&spec);
    Vec3 before = place(&s, 0, 0);
    for (int k = 0; k <= 2000; k++) {
        net_follow(s.cloth, 0.5 + k / 2000.0, NULL, cloth_mass_count(&s.spec), s.places);
        Vec3 now = place(&s, 12, 0);
        if (k) assert_true(length(now, before) < 30 / 2000.0); /* 30 units a second */
        before = now;
    }
    fold(&s);
}

static void the_wind_does_what_energy_there_is(void **state) {
    (void)state;
    WindField wind = breeze();
    ClothSpec spec = flag(1e6, CLOTH_PIN_LEFT);
    spec.wind = &wind, spec.damping = 0.3;
    Sheet s = lay(&spec);
    for (int frame = 0; frame < 96; frame++) {
        net_follow(s.cloth, frame / 24.0, NULL, cloth_mass_count(&s.spec), s.places);
        assert_true(net_energy(s.cloth) <= s.cloth->limit * (1 + 1e-9) + 1e-9);
    }
    fold(&s);
}

static void numbers_past_all_measure_do_no_harm(void **state) {
    (void)state;
    static const double numbers[] = {1e-300, 1e-12, 1e12, 1e300};
    for (size_t a = 0; a < 4; a++)
        for (int which = 0; which < 5; which++) {
            ClothSpec spec = flag(50, CLOTH_PIN_CORNERS);
            spec.nu = 4, spec.nv = 3;
            *(which == 0 ? &spec.mass : which == 1 ? &spec.stiffness : which == 2 ? &spec.gravity.x : which == 3 ? &spec.damping : &spec.width) = numbers[a];
            Sheet s = lay(&spec);
            net_follow(s.cloth, 0.25, NULL, cloth_mass_count(&s.spec), s.places);
            assert_memory_equal(s.places, s.rest, sizeof(Vec3));
            if (which == 1 || which == 3)
                for (size_t i = 0; i < cloth_mass_count(&spec); i++) assert_true(vec3_is_finite(s.places[i]));
            fold(&s);
        }
}

static void an_interruption_is_heard(void **state) {
    (void)state;
    ClothSpec spec = flag(60, CLOTH_PIN_LEFT);
    Sheet s = lay(&spec);
    atomic_bool stop = true;
    assert_false(net_follow(s.cloth, 10, &stop, cloth_mass_count(&s.spec), s.places));
    assert_true(net_follow(s.cloth, 0, &stop, cloth_mass_count(&s.spec), s.places));
    fold(&s);
}

/* Saved and taken up again, a sheet goes on as if nothing had happened. */
static void states_go_on(void **state) {
    (void)state;
    ClothSpec spec = flag(60, CLOTH_PIN_LEFT);
    Sheet through = lay(&spec), first = lay(&spec), second = lay(&spec);
    double *numbers = malloc(net_state_count(first.cloth) * sizeof *numbers);
    net_follow(through.cloth, 1.3, NULL, cloth_mass_count(&through.spec), through.places);
    net_follow(first.cloth, 0.71, NULL, cloth_mass_count(&first.spec), first.places);
    net_save_state(first.cloth, numbers);
    assert_int_equal(first.cloth->tick, net_tick_of(0.71));
    assert_true(net_load_state(second.cloth, numbers));
    net_follow(second.cloth, 1.3, NULL, cloth_mass_count(&second.spec), second.places);
    assert_memory_equal(second.places, through.places, through.bytes);
    numbers[7] = (double)NAN;
    assert_false(net_load_state(first.cloth, numbers));
    free(numbers);
    fold(&through), fold(&first), fold(&second);
}

/* Whatever changes a sheet's movement changes its key. */
static void keys_differ(void **state) {
    (void)state;
    ClothSpec plain = flag(60, CLOTH_PIN_LEFT), other = plain;
    assert_true(hash_equal(cloth_spec_hash(&plain), cloth_spec_hash(&other)));
    other.damping += 0.01;
    assert_false(hash_equal(cloth_spec_hash(&plain), cloth_spec_hash(&other)));
    other = plain, other.pins |= CLOTH_PIN_TOP;
    assert_false(hash_equal(cloth_spec_hash(&plain), cloth_spec_hash(&other)));
    other = plain, other.gravity.x = 1;
    assert_false(hash_equal(cloth_spec_hash(&plain), cloth_spec_hash(&other)));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(states_go_on), cmocka_unit_test(keys_differ),
        cmocka_unit_test(a_hanging_sheet_stretches_as_its_weight_says),
        cmocka_unit_test(a_row_between_two_pins_is_an_elastic_catenary),
        cmocka_unit_test(a_loose_sheet_falls_as_things_fall),
        cmocka_unit_test(a_wind_from_the_front_pushes_with_its_force_on_the_area),
        cmocka_unit_test(energy_and_length_keep_their_bounds_from_limp_to_rigid),
        cmocka_unit_test(little_is_lost_where_springs_are_soft),
        cmocka_unit_test(a_time_alone_is_that_time_of_the_whole_run),
        cmocka_unit_test(places_go_on_without_jumps),
        cmocka_unit_test(the_wind_does_what_energy_there_is),
        cmocka_unit_test(numbers_past_all_measure_do_no_harm),
        cmocka_unit_test(an_interruption_is_heard),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
