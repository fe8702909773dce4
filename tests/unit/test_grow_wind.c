/* Wind against its formula in long double, and what must hold whatever blows. */
#include "base/random.h"
#include "grow/wind.h"
#include "tape/noise.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

static double draw(uint64_t i, uint32_t k, double low, double high) { return low + (high - low) * random_unit(random_hash(0x57494e44, i, k, 0)); }

static WindField some_wind(uint64_t i) {
    return (WindField){.direction = vec3_normalize(vec3(draw(i, 0, -1, 1), draw(i, 1, -0.3, 0.3), draw(i, 2, -1, 1))),
                       .speed = draw(i, 3, -20, 20), .strength = draw(i, 4, 0, 3), .gust_wavelength = draw(i, 5, 0.1, 50),
                       .gust_amplitude = draw(i, 6, 0, 1), .gust_sharpness = draw(i, 7, 0.2, 6), .turbulence_amplitude = draw(i, 8, 0, 1),
                       .turbulence_scale = draw(i, 9, 0.1, 30), .turbulence_octaves = 1 + (int)(i % 5), .turbulence_seed = (uint32_t)i,
                       .stiffness = draw(i, 10, 0.1, 10)};
}

static Vec3 some_place(uint64_t i, uint32_t k) { return vec3(draw(i, k, -100, 100), draw(i, k + 1, -5, 5), draw(i, k + 2, -100, 100)); }

static void gusts_follow_the_formula(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 10000; i++) {
        WindField w = some_wind(i);
        w.turbulence_amplitude = 0;
        Vec3 p = some_place(i, 20), d = w.direction;
        double t = draw(i, 30, 0, 60);
        const long double x = (long double)p.x, y = (long double)p.y, z = (long double)p.z, dx = (long double)d.x, dy = (long double)d.y, dz = (long double)d.z;
        long double s = x * dx + y * dy + z * dz - (long double)w.speed * (long double)t;
        long double wave = (1 + sinl(2 * 3.14159265358979323846264338327950288L * s / (long double)w.gust_wavelength)) / 2;
        long double along = (long double)w.strength * (1 + (long double)w.gust_amplitude * (2 * powl(wave, (long double)w.gust_sharpness) - 1));
        Vec3 f = wind_force(&w, p, t);
        long double most = fabsl((long double)f.x - along * dx) + fabsl((long double)f.y - along * dy) + fabsl((long double)f.z - along * dz);
        assert_true(most < 1e-9L); /* s/λ up to 1e4 turns */
    }
}

/* The end of a round is its beginning: force, and how fast it changes. */
static void a_cyclic_wind_comes_again(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 2000; i++) {
        WindField w = some_wind(i);
        double cycle = draw(i, 40, 0.5, 20), speed = w.speed, waves = wind_make_cyclic(&w, cycle), e = 1e-5 * cycle;
        assert_true(waves >= 1 && fabs(fabs(w.speed) * cycle / w.gust_wavelength - waves) < 1e-9 * waves && speed * w.speed > 0);
        assert_true(fabs(w.speed - speed) * cycle <= w.gust_wavelength * (waves > 1 ? 0.5 + 1e-9 : 1));
        Vec3 p = some_place(i, 20), first = wind_force(&w, p, 0);
        assert_true(vec3_length(vec3_sub(wind_force(&w, p, cycle), first)) < 1e-9);
        assert_true(vec3_length(vec3_sub(wind_force(&w, p, 3 * cycle), first)) < 1e-9);
        Vec3 before = wind_force(&w, p, cycle - e), after = wind_force(&w, p, e);
        double fastest = w.strength * (w.gust_amplitude * 2 * w.gust_sharpness * VTS_PI / w.gust_wavelength + 20 * w.turbulence_amplitude * w.turbulence_octaves / w.turbulence_scale) * fabs(w.speed);
        if (w.gust_sharpness >= 1) assert_true(vec3_length(vec3_sub(before, first)) < 2 * fastest * e + 1e-6);
        /* No kink: the two halves of the step are the same, but for what bends within it. */
        if (w.gust_sharpness >= 2 && fastest * e < 1e-3)
            assert_true(vec3_length(vec3_sub(vec3_add(before, after), vec3_scale(first, 2))) < 0.3 * fastest * e + 1e-6);
    }
}

/* Turbulence alone keeps its strength all the way round, and wind that stands still stays as it is. */
static void a_cyclic_flow_is_as_strong_in_the_middle(void **state) {
    (void)state;
    WindField w = {.direction = {1, 0, 0}, .speed = 5, .strength = 1, .gust_wavelength = 1, .turbulence_amplitude = 1, .turbulence_scale = 1,
                   .turbulence_octaves = 2, .turbulence_seed = 9};
    assert_true(wind_make_cyclic(&w, 4) == 0 && w.speed == 5);
    double sums[4] = {0};
    for (uint64_t i = 0; i < 20000; i++)
        for (int k = 0; k < 4; k++) {
            Vec3 f = vec3_sub(wind_force(&w, some_place(i, 20), k), w.direction);
            sums[k] += vec3_dot(f, f);
        }
    for (int k = 1; k < 4; k++) assert_true(fabs(sqrt(sums[k] / sums[0]) - 1) < 0.03);
    w.speed = 0;
    assert_true(vec3_length(vec3_sub(wind_force(&w, vec3(0.3, 0.2, 0.7), 2), wind_force(&w, vec3(0.3, 0.2, 0.7), 0))) < 1e-12);
}

static void turbulence_is_a_sum_of_octaves_that_the_wind_carries(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 2000; i++) {
        WindField w = some_wind(i), calm = w;
        calm.turbulence_amplitude = 0;
        Vec3 p = some_place(i, 20);
        double t = draw(i, 30, 0, 60);
        Vec3 carried = vec3_madd(p, w.direction, -w.speed * t), sum = vec3_splat(0);
        for (int k = 0; k < w.turbulence_octaves; k++) {
            double frequency = pow(2, k) / w.turbulence_scale;
            Vec3 n = noise_perlin3(vec3_scale(carried, frequency), w.turbulence_seed + (uint32_t)k);
            sum = vec3_add(sum, vec3_scale(n, pow(0.5, k)));
        }
        Vec3 expected = vec3_add(wind_force(&calm, p, t), vec3_scale(sum, w.strength * w.turbulence_amplitude));
        assert_true(vec3_length(vec3_sub(wind_force(&w, p, t), expected)) < 1e-9);
        /* The same air later is further along the wind. */
        Vec3 later = wind_force(&w, vec3_madd(p, w.direction, w.speed * 2.5), t + 2.5);
        assert_true(vec3_length(vec3_sub(later, wind_force(&w, p, t))) < 1e-7);
    }
}

static void bending_keeps_the_length_and_turns_towards_the_force(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 10000; i++) {
        Vec3 h = vec3_scale(some_place(i, 40), pow(10, draw(i, 50, -6, 4))), force = some_place(i, 60);
        double stiffness = pow(10, draw(i, 51, -3, 3)), length = vec3_length(h);
        Vec3 bent = wind_bend(h, force, stiffness);
        assert_true(fabs(vec3_length(bent) - length) <= 1e-12 * length);
        assert_true(vec3_dot(bent, force) >= vec3_dot(h, force) - 1e-12 * length * vec3_length(force));
    }
    Vec3 h = vec3(0, 2, 0), across = wind_bend(h, vec3(1, 0, 0), 1);
    assert_true(fabs(across.x - sqrt(2)) < 1e-15 && fabs(across.y - sqrt(2)) < 1e-15); /* 45 degrees */
    assert_memory_equal(&h, &(Vec3[]){wind_bend(h, vec3(0, -1, 0), 1)}, sizeof h); /* nothing is left of it */
    assert_memory_equal(&h, &(Vec3[]){wind_bend(h, vec3(0, 0, 0), 1)}, sizeof h);
    Vec3 none = wind_bend(vec3_splat(0), vec3(1, 0, 0), 1);
    assert_true(vec3_length(none) == 0);
}

static void force_is_continuous_in_time(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 2000; i++) {
        WindField w = some_wind(i);
        w.gust_sharpness = fmax(1, w.gust_sharpness);
        Vec3 p = some_place(i, 20);
        double t = draw(i, 30, 0, 60), step = 1e-7;
        /* Gusts rise by at most 2π·sharpness·|speed|/λ a second, an octave of Perlin's noise by about 2 each length of its own. */
        double steepest = w.strength * fabs(w.speed) * (2 * VTS_PI * w.gust_amplitude * w.gust_sharpness / w.gust_wavelength +
                                                        6 * w.turbulence_amplitude * w.turbulence_octaves / w.turbulence_scale);
        assert_true(vec3_length(vec3_sub(wind_force(&w, p, t + step), wind_force(&w, p, t))) <= steepest * step + 1e-10);
    }
}

static void the_shortest_wave_is_known(void **state) {
    (void)state;
    WindField w = {.strength = 1, .gust_wavelength = 12, .gust_amplitude = 0.5, .turbulence_amplitude = 0.2, .turbulence_scale = 16, .turbulence_octaves = 3};
    assert_true(wind_wavelength(&w) == 4);
    w.turbulence_amplitude = 0;
    assert_true(wind_wavelength(&w) == 12);
    w.gust_amplitude = 0;
    assert_true(isinf(wind_wavelength(&w)));
}

static void the_strongest_forces_lay_flat(void **state) {
    (void)state;
    for (int exponent = 5; exponent <= 300; exponent += 5) {
        Vec3 bent = wind_bend(vec3(0, 0.5, 0), vec3(0, 0, -pow(10, exponent)), 1);
        assert_true(fabs(vec3_length(bent) - 0.5) < 1e-12 && bent.x == 0);
        assert_true(fabs(bent.z + 0.5) < 1e-8 && bent.y > 4e-5 && bent.y < 6e-5);
    }
}

/* The mean over a wave, by sums. */
static void short_waves_leave_their_mean(void **state) {
    (void)state;
    static const double sharpness[] = {0.01, 1, 2, 7.5, 30};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(sharpness); i++) {
        WindField w = {.direction = {1, 0, 0}, .strength = 2, .gust_wavelength = 3, .gust_amplitude = 0.7, .gust_sharpness = sharpness[i],
                       .turbulence_amplitude = 0.4, .turbulence_scale = 8, .turbulence_octaves = 4, .turbulence_seed = 5};
        WindField bare = w, smooth = w;
        bare.turbulence_amplitude = 0;
        enum { STEPS = 100000 };
        double sum = 0;
        for (int k = 0; k < STEPS; k++) sum += wind_force(&bare, vec3(3.0 * (k + 0.5) / STEPS, 0, 0), 0).x;
        wind_smooth(&smooth, 4);
        assert_int_equal(smooth.turbulence_octaves, 2);
        WindField half = smooth; /* whose waves are of three quarters of that length */
        half.turbulence_amplitude = 0;
        for (int k = 0; k < 20; k++) {
            Vec3 p = some_place((uint64_t)k, 40);
            assert_true(fabs(wind_force(&half, p, k).x - (wind_force(&bare, p, k).x + sum / STEPS) / 2) < 1e-3);
        }
        assert_true(wind_wavelength(&smooth) == 3);
        wind_smooth(&smooth, 100);
        assert_true(isinf(wind_wavelength(&smooth)));
        for (int k = 0; k < 20; k++) {
            Vec3 f = wind_force(&smooth, some_place((uint64_t)k, 40), k);
            assert_true(fabs(f.x - sum / STEPS) < 1e-3 && f.y == 0 && f.z == 0);
        }
    }
    WindField sharp = {.direction = {1, 0, 0}, .strength = 1, .gust_wavelength = 1, .gust_amplitude = 1, .gust_sharpness = 1e300};
    wind_smooth(&sharp, 2);
    assert_true(fabs(wind_force(&sharp, vec3(5, 0, 0), 0).x) < 1e-9);
    WindField long_waves = {.strength = 1, .gust_wavelength = 3, .gust_amplitude = 0.7, .gust_sharpness = 2, .turbulence_octaves = 1, .turbulence_scale = 8}, same = long_waves;
    wind_smooth(&same, 3);
    assert_true(same.gust_amplitude == long_waves.gust_amplitude && same.gust_wavelength == 3 && same.turbulence_octaves == 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gusts_follow_the_formula),
        cmocka_unit_test(a_cyclic_wind_comes_again), cmocka_unit_test(a_cyclic_flow_is_as_strong_in_the_middle),
        cmocka_unit_test(turbulence_is_a_sum_of_octaves_that_the_wind_carries),
        cmocka_unit_test(bending_keeps_the_length_and_turns_towards_the_force),
        cmocka_unit_test(force_is_continuous_in_time),
        cmocka_unit_test(the_shortest_wave_is_known),
        cmocka_unit_test(the_strongest_forces_lay_flat),
        cmocka_unit_test(short_waves_leave_their_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
