/* Tips of height vectors on springs against closed forms, and what must hold for all of them, from limp to rigid. */
#include "base/random.h"
#include "grow/tips.h"
#include "grow/wind.h"

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 400 };

/* Height vectors on a plane, and where their tips are. */
typedef struct Field {
    Arena arena;
    Vec3 feet[MOST], heights[MOST], start[MOST], places[MOST];
    TipsEdge edges[2 * MOST];
    TipsSpec spec;
    WindField wind;
    SpringNet *net;
} Field;

static WindField steady(double strength) {
    return (WindField){.direction = {1, 0, 0}, .strength = strength, .gust_wavelength = 1, .gust_sharpness = 1, .turbulence_scale = 1, .stiffness = 1};
}

static WindField breeze(void) {
    return (WindField){.direction = {0.6, 0, 0.8}, .speed = 5, .strength = 1, .gust_wavelength = 3, .gust_amplitude = 0.4, .gust_sharpness = 2,
                       .turbulence_amplitude = 0.5, .turbulence_scale = 1, .turbulence_octaves = 3, .turbulence_seed = 4, .stiffness = 1};
}

/* nx × nz of them, so far apart, of one length. */
static void lay(Field *f, int nx, int nz, double apart, double length, double stiffness, double damping) {
    memset(f, 0, sizeof *f);
    arena_init(&f->arena, NULL, 0);
    size_t edges = 0;
    for (int i = 0; i < nx; i++)
        for (int j = 0; j < nz; j++) {
            uint32_t k = (uint32_t)(i * nz + j);
            f->feet[k] = vec3(apart * i, 0, apart * j);
            f->heights[k] = f->start[k] = vec3(0, length, 0);
            if (i + 1 < nx) f->edges[edges++] = (TipsEdge){k, k + (uint32_t)nz};
            if (j + 1 < nz) f->edges[edges++] = (TipsEdge){k, k + 1};
        }
    f->spec = (TipsSpec){.count = (size_t)(nx * nz), .feet = f->feet, .heights = f->heights, .edges = f->edges, .edge_count = edges,
                         .stiffness = stiffness, .damping = damping};
}

static void follow(Field *f, double time) {
    if (!f->net) f->net = tips_create(&f->spec, &f->arena);
    assert_true(net_follow(f->net, time, NULL, f->spec.count, f->places));
}

static Vec3 height_of(const Field *f, size_t i) { return vec3_sub(f->places[i], f->feet[i]); }
static double apart(Vec3 a, Vec3 b) { return vec3_length(vec3_sub(a, b)); }
static Vec3 turned(double length, double angle) { return vec3(length * sin(angle), length * cos(angle), 0); }

/* ---- closed forms ---- */

/* A tip alone is a pendulum: θ″ = −K·sin θ, whose quarter of a swing from θ₀ takes (π/2)/(√K·agm(1, cos(θ₀/2))). */
static void a_tip_alone_swings_as_a_pendulum(void **state) {
    (void)state;
    for (double stiffness = 1; stiffness < 2000; stiffness *= 10)
        for (double angle = 0.1; angle < 2.6; angle += 0.8) {
            Field f;
            lay(&f, 1, 1, 1, 0.7, stiffness, 0);
            f.start[0] = turned(0.7, angle);
            f.spec.start = f.start;
            double a = 1, g = cos(angle / 2);
            for (int k = 0; k < 20; k++) {
                double mean = (a + g) / 2;
                g = sqrt(a * g), a = mean;
            }
            double quarter = VTS_PI / 2 / (sqrt(stiffness) * a), step = quarter / 200, now = 0;
            for (follow(&f, 0); height_of(&f, 0).x > 0; now += step) follow(&f, now + step);
            assert_true(fabs(now - quarter) < 0.015 * quarter);
            arena_destroy(&f.arena);
        }
}

/* Where all are alike neighbours pull nothing: they come to rest where wind_bend() has them. */
static void at_rest_it_is_the_winds_own_bending(void **state) {
    (void)state;
    for (double stiffness = 1; stiffness < 1e10; stiffness *= 10)
        for (double strength = 0.1; strength < 100; strength *= 9) {
            Field f;
            lay(&f, 5, 4, 0.3, 0.5, stiffness, 4 * sqrt(stiffness));
            f.wind = steady(strength);
            f.spec.wind = &f.wind, f.spec.start = f.start; /* upright */
            follow(&f, fmin(40 / sqrt(stiffness) + 0.5, 30));
            Vec3 expected = wind_bend(vec3(0, 0.5, 0), vec3(strength, 0, 0), 1);
            for (size_t i = 0; i < f.spec.count; i++) assert_true(apart(height_of(&f, i), expected) < 1e-3 * 0.5);
            arena_destroy(&f.arena);
        }
}

/* Along a row L²·u″ = u, so that what one end is pushed by is e⁻¹ of it a height further, however many stand between. */
static void neighbours_within_a_height_follow(void **state) {
    (void)state;
    for (int fine = 4; fine <= 16; fine *= 2) {
        Field f;
        double length = 0.5;
        lay(&f, 6 * fine + 1, 1, length / fine, length, 40, 8);
        for (size_t i = 0; i < f.spec.count; i++) f.start[i] = turned(length, 0);
        f.start[0] = turned(length, 0.05);
        f.spec.start = f.start;
        follow(&f, 0);
        f.net->masses[0].weight = 1e-12; /* held there */
        follow(&f, 6);
        double whole = height_of(&f, 0).x;
        for (int heights = 1; heights <= 3; heights++)
            assert_true(fabs(height_of(&f, (size_t)(heights * fine)).x / whole - exp(-heights)) < 0.02);
        arena_destroy(&f.arena);
    }
}

/* ---- whatever the springs ---- */

static void energy_and_length_keep_their_bounds_from_limp_to_rigid(void **state) {
    (void)state;
    double stiffness = 1e-3;
    for (int q = 0; q < 13; q++, stiffness *= 10) {
        Field f;
        lay(&f, 6, 5, q % 2 ? 0.05 : 0.8, 0.5, stiffness, 0);
        for (size_t i = 0; i < f.spec.count; i++) {
            double up = 2 * random_unit(random_hash(i, (uint64_t)q, 0, 0)) - 1, round = 2 * VTS_PI * random_unit(random_hash(i, (uint64_t)q, 1, 0));
            f.start[i] = vec3_scale(vec3(sqrt(1 - up * up) * cos(round), up, sqrt(1 - up * up) * sin(round)), 0.5);
        }
        f.spec.start = f.start;
        follow(&f, 0);
        double start = net_energy(f.net), stored = 0;
        for (size_t i = 0; i < f.spec.count; i++) stored += stiffness / 2 * pow(apart(f.start[i], f.heights[i]), 2);
        assert_true(start >= stored * (1 - 1e-9)); /* it counts what it should */
        for (int frame = 1; frame <= 48; frame++) {
            follow(&f, frame / 24.0);
            assert_true(net_energy(f.net) <= 1.01 * start);
            double moving = 0;
            for (size_t i = 0; i < f.spec.count; i++) {
                assert_true(fabs(vec3_length(height_of(&f, i)) - 0.5) < 1e-9);
                moving += vec3_length_squared(f.net->masses[i].speed) / 2;
            }
            assert_true(moving <= 1.01 * start);
        }
        arena_destroy(&f.arena);
    }
}

static void a_time_alone_is_that_time_of_the_whole_run(void **state) {
    (void)state;
    static const double rates[] = {24, 25, 7, 300};
    for (size_t r = 0; r < VTS_ARRAY_COUNT(rates); r++) {
        Field run, alone;
        lay(&run, 8, 8, 0.3, 0.5, 40, 2), lay(&alone, 8, 8, 0.3, 0.5, 40, 2);
        run.wind = alone.wind = breeze();
        run.spec.wind = &run.wind, alone.spec.wind = &alone.wind;
        int last = (int)(1.7 * rates[r]);
        for (int frame = 0; frame <= last; frame++) follow(&run, frame / rates[r]);
        follow(&alone, last / rates[r]);
        assert_memory_equal(run.places, alone.places, sizeof run.places);
        assert_true(apart(height_of(&run, 5), wind_bend(run.heights[5], wind_force(&run.wind, run.feet[5], last / rates[r]), 1)) > 1e-3);
        arena_destroy(&run.arena), arena_destroy(&alone.arena);
    }
}

static void the_first_moment_is_the_winds(void **state) {
    (void)state;
    Field f;
    lay(&f, 4, 4, 0.3, 0.5, 40, 2);
    f.wind = breeze();
    f.spec.wind = &f.wind, f.spec.begins = 1.25;
    follow(&f, 0);
    for (size_t i = 0; i < f.spec.count; i++)
        assert_true(apart(height_of(&f, i), wind_bend(f.heights[i], wind_force(&f.wind, f.feet[i], 1.25), 1)) < 1e-12);
    arena_destroy(&f.arena);
}

/* A wind that goes round moves them as it did a round before, once the start is forgotten. */
static void rounds_come_again(void **state) {
    (void)state;
    static const double stiffness[] = {4, 40, 4000}, damping[] = {2, 3, 9, 30};
    for (size_t a = 0; a < VTS_ARRAY_COUNT(stiffness); a++)
        for (size_t b = 0; b < VTS_ARRAY_COUNT(damping); b++) {
            Field first, second;
            SkinSprings springs = {true, stiffness[a], damping[b]};
            lay(&first, 4, 4, 0.3, 0.5, stiffness[a], damping[b]), lay(&second, 4, 4, 0.3, 0.5, stiffness[a], damping[b]);
            first.wind = breeze();
            first.wind.strength = 0.4;
            wind_make_cyclic(&first.wind, 2.5);
            double lead = tips_lead(&springs, &first.wind);
            assert_true(lead > 0 && fabs(lead / 2.5 - round(lead / 2.5)) < 1e-9);
            first.spec.wind = second.spec.wind = &first.wind;
            first.spec.begins = second.spec.begins = -lead;
            follow(&first, lead), follow(&second, lead + 2.5);
            for (size_t i = 0; i < first.spec.count; i++) assert_true(apart(height_of(&first, i), height_of(&second, i)) < 0.01 * 0.5);
            arena_destroy(&first.arena), arena_destroy(&second.arena);
        }
}

static void lying_down_is_the_lowest(void **state) {
    (void)state;
    Vec3 up = vec3(0, 2, 0), foot = vec3(1, 1, 1), down = vec3(2, 0, 1), found = tips_height(foot, up, down, up);
    assert_true(fabs(vec3_length(found) - 2) < 1e-12 && fabs(found.y - 0.1) < 1e-12 && found.x > 1.9);
    Vec3 pressed = vec3_scale(vec3_normalize(vec3(1, -1, 0)), 2); /* the wind itself presses lower */
    found = tips_height(foot, up, vec3_add(foot, pressed), pressed);
    assert_true(apart(found, pressed) < 1e-12);
    assert_true(apart(tips_height(foot, up, foot, pressed), pressed) == 0);
    assert_true(apart(tips_height(foot, up, vec3((double)NAN, 0, 0), up), up) == 0);
}

static void numbers_past_all_measure_do_no_harm(void **state) {
    (void)state;
    static const double numbers[] = {0, 1e-300, 1e-12, 1e12, 1e300, (double)INFINITY, (double)NAN};
    for (size_t a = 0; a < VTS_ARRAY_COUNT(numbers); a++)
        for (int which = 0; which < 6; which++) {
            Field f;
            lay(&f, 3, 3, 0.3, 0.5, 40, 2);
            f.wind = breeze();
            f.spec.wind = &f.wind;
            bool positive = numbers[a] > 0 && isfinite(numbers[a]);
            if (which < 2 && !positive) continue; /* the language lets only such through */
            *(which == 0 ? &f.spec.stiffness : which == 1 ? &f.spec.damping : which == 2 ? &f.heights[4].y : which == 3 ? &f.feet[4].x
              : which == 4 ? &f.wind.strength : &f.wind.speed) = numbers[a];
            follow(&f, 0.3);
            for (size_t i = 0; i < f.spec.count && which < 2; i++) {
                Vec3 h = tips_height(f.feet[i], f.heights[i], f.places[i], f.heights[i]);
                assert_true(vec3_is_finite(h) && fabs(vec3_length(h) - 0.5) < 1e-6);
            }
            arena_destroy(&f.arena);
        }
}

static void keys_differ(void **state) {
    (void)state;
    Field f;
    lay(&f, 3, 3, 0.3, 0.5, 40, 2);
    f.wind = breeze();
    wind_force(&f.wind, f.feet[0], 0);
    Hash128 plain = tips_hash(&f.spec);
    f.spec.wind = &f.wind;
    assert_false(hash_equal(plain, tips_hash(&f.spec)));
    f.spec.wind = NULL, f.spec.damping = 3;
    assert_false(hash_equal(plain, tips_hash(&f.spec)));
    f.spec.damping = 2, f.heights[7].x = 0.1;
    assert_false(hash_equal(plain, tips_hash(&f.spec)));
    f.heights[7].x = 0;
    assert_true(hash_equal(plain, tips_hash(&f.spec)));
    arena_destroy(&f.arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tip_alone_swings_as_a_pendulum),
        cmocka_unit_test(at_rest_it_is_the_winds_own_bending),
        cmocka_unit_test(neighbours_within_a_height_follow),
        cmocka_unit_test(energy_and_length_keep_their_bounds_from_limp_to_rigid),
        cmocka_unit_test(a_time_alone_is_that_time_of_the_whole_run),
        cmocka_unit_test(the_first_moment_is_the_winds),
        cmocka_unit_test(rounds_come_again),
        cmocka_unit_test(lying_down_is_the_lowest),
        cmocka_unit_test(numbers_past_all_measure_do_no_harm),
        cmocka_unit_test(keys_differ),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
