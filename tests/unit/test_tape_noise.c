/* Perlin's noise against a second, plain implementation in long double and against what is known of it. */
#include "base/random.h"
#include "tape/noise.h"
#include "tape/tape_rows.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { ARRAY = 150 };

/* ---- a plain implementation: the sum over the cell's corners of weight · gradient · offset ---- */

/* The published permutation in hexadecimal digits. */
static const char table[] =
    "97A0895B5A0F830DC95F6035C2E907E18C24671E458E086325F0150A17BE0694F778EA4B001AC53E5EFCDBCB75230B20"
    "39B12158ED953857AE147D88ABA844AF4AA547868B301BA64D929EE7536FE57A3CD385E6DC695C29372EF528F4668F36"
    "41193FA101D85049D14C84BBD05912A9C8C4878274BC9F56A4646DC6ADBA034034D9E2FA7C7B05CA2693767EFF5255D4"
    "CFCE3BE32F103A11B6BD1C2ADFB7AAD577F898022C9AA346DD99659BA72BAC09811627FD13626C6E4F71E0E8B2B97068"
    "DAF661E4FB22F2C1EED2900CBFB3A2F1513391EBF90EEF6B31C0D61FB5C76A9DB854CCB07379322D7F0496FE8AECCD5D"
    "DE72431D1848F38D80C34E42D73D9CB4";

static int digit(char c) { return c <= '9' ? c - '0' : c - 'A' + 10; }

static void read_table(int *p) {
    int count = 0;
    for (const char *c = table; *c; c++) {
        if (count < 512) p[count / 2] = count % 2 ? p[count / 2] * 16 + digit(*c) : digit(*c);
        count++;
    }
    assert_int_equal(count, 512);
}

/* The twelve edge directions, then the four repeated ones, in the order of the paper's hash codes. */
static const int directions[16][3] = {
    {1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
    {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1}, {1, 1, 0}, {0, -1, 1}, {-1, 1, 0}, {0, -1, -1}};

static long double weight(long double t) {
    t = fabsl(t);
    return 1 - t * t * t * (t * (t * 6 - 15) + 10);
}

static int wrap(long double whole) {
    long double r = fmodl(whole, 256);
    return (int)(r < 0 ? r + 256 : r);
}

static long double plain_noise(const int *p, long double x, long double y, long double z) {
    long double sum = 0;
    for (int corner = 0; corner < 8; corner++) {
        long double i = floorl(x) + (corner & 1), j = floorl(y) + (corner >> 1 & 1),
                    k = floorl(z) + (corner >> 2);
        int h = p[(p[(p[wrap(i)] + wrap(j)) & 255] + wrap(k)) & 255] & 15;
        long double dx = x - i, dy = y - j, dz = z - k;
        sum += weight(dx) * weight(dy) * weight(dz) *
               (directions[h][0] * dx + directions[h][1] * dy + directions[h][2] * dz);
    }
    return sum;
}

static double span(RandomStream *random, double size) { return size * (2 * random_next_unit(random) - 1); }

static void agrees_with_the_plain_implementation(void **state) {
    (void)state;
    int p[256];
    read_table(p);
    RandomStream random = {1};
    static const double sizes[] = {1, 10, 300, 1e5, 1e9};
    for (int n = 0; n < 50000; n++) {
        double size = sizes[n % 5];
        double x = span(&random, size), y = span(&random, size), z = span(&random, size);
        long double expected = plain_noise(p, (long double)x, (long double)y, (long double)z);
        assert_true(fabsl((long double)noise_perlin(vec3(x, y, z)) - expected) < 4e-15L);
    }
}

static void the_table_is_a_permutation(void **state) {
    (void)state;
    int p[256], seen[256] = {0};
    read_table(p);
    for (int i = 0; i < 256; i++) seen[p[i]]++;
    for (int i = 0; i < 256; i++) assert_int_equal(seen[i], 1);
}

static void gives_the_published_value(void **state) {
    (void)state;
    /* what the author's own program gives */
    assert_true(fabs(noise_perlin(vec3(3.14, 42, 7)) - 0.13691995878400012) < 1e-15);
}

static void is_zero_at_lattice_points(void **state) {
    (void)state;
    RandomStream random = {2};
    for (int n = 0; n < 2000; n++) {
        double size = n & 1 ? 300 : 1e12;
        Vec3 p = vec3(floor(span(&random, size)), floor(span(&random, size)), floor(span(&random, size)));
        assert_true(noise_perlin(p) == 0);
    }
    assert_true(noise_perlin(vec3(1e300, -0x1p60, 0x1p1000)) == 0);
}

static void repeats_after_256_however_far(void **state) {
    (void)state;
    RandomStream random = {3};
    for (int n = 0; n < 5000; n++) {
        /* multiples of 1/1024: sums with whole numbers below 2⁴² are exact */
        Vec3 p = vec3((double)(random_next(&random) % 262144) / 1024,
                      (double)(random_next(&random) % 262144) / 1024,
                      (double)(random_next(&random) % 262144) / 1024);
        double far = 256 * floor(span(&random, 1e9));
        assert_true(noise_perlin(p) == noise_perlin(vec3(p.x + far, p.y, p.z)));
        assert_true(noise_perlin(p) == noise_perlin(vec3(p.x, p.y - far, p.z)));
        assert_true(noise_perlin(p) == noise_perlin(vec3(p.x, p.y, p.z + far)));
    }
}

static void is_smooth_across_cells(void **state) {
    (void)state;
    /* value and slope from both sides of the faces */
    RandomStream random = {4};
    const double h = 1e-5;
    for (int n = 0; n < 2000; n++) {
        double y = span(&random, 50), z = span(&random, 50), face = floor(span(&random, 50));
        double left = noise_perlin(vec3(face - h, y, z)), here = noise_perlin(vec3(face, y, z)),
               right = noise_perlin(vec3(face + h, y, z));
        assert_true(fabs((right - here) / h - (here - left) / h) < 1e-3);
    }
}

static void stays_near_one(void **state) {
    (void)state;
    RandomStream random = {5};
    double low = 0, high = 0, sum = 0, squares = 0;
    enum { COUNT = 200000 };
    for (int n = 0; n < COUNT; n++) {
        double v = noise_perlin(vec3(span(&random, 128), span(&random, 128), span(&random, 128)));
        low = fmin(low, v), high = fmax(high, v), sum += v, squares += v * v;
    }
    assert_true(low > -1.05 && low < -0.7 && high < 1.05 && high > 0.7);
    assert_true(fabs(sum / COUNT) < 0.005);
    assert_true(sqrt(squares / COUNT) > 0.2 && sqrt(squares / COUNT) < 0.35);
}

static void is_undefined_only_where_the_place_is(void **state) {
    (void)state;
    const double bad[3] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    for (int k = 0; k < 3; k++) {
        assert_true(isnan(noise_perlin(vec3(bad[k], 0.5, 0.5))));
        assert_true(isnan(noise_perlin(vec3(0.5, bad[k], 0.5))));
        assert_true(isnan(noise_perlin(vec3(0.5, 0.5, bad[k]))));
    }
    assert_true(isfinite(noise_perlin(vec3(1.7e308, -1.7e308, 0.3))));
    assert_true(isfinite(noise_perlin(vec3(-1e-320, 5e-324, 0.3))));
}

static void seeds_are_unrelated(void **state) {
    (void)state;
    enum { COUNT = 20000 };
    RandomStream random = {6};
    double products[5] = {0}, squares = 0;
    for (int n = 0; n < COUNT; n++) {
        Vec3 p = vec3(span(&random, 100), span(&random, 100), span(&random, 100));
        double a = noise_perlin_seeded(p, 1), b = noise_perlin_seeded(p, 2);
        Vec3 v = noise_perlin3(p, 9);
        assert_true(a == noise_perlin_seeded(p, 1));
        products[0] += a * b, products[1] += v.x * v.y, products[2] += v.y * v.z, products[3] += v.x * v.z;
        products[4] += v.x * noise_perlin3(p, 10).x;
        squares += a * a;
    }
    for (int k = 0; k < 5; k++) assert_true(fabs(products[k] / squares) < 0.03);
}

static void fbm_is_a_sum_of_octaves(void **state) {
    (void)state;
    RandomStream random = {7};
    for (int n = 0; n < 1000; n++) {
        Vec3 p = vec3(span(&random, 10), span(&random, 10), span(&random, 10));
        long double sum = 0;
        for (int k = 0; k < 6; k++)
            sum += powl(0.6L, k) * (long double)noise_perlin(vec3_scale(p, pow(2, k)));
        assert_true(fabsl((long double)noise_fbm(p, 6, 2, 0.6) - sum) < 1e-14L);
        assert_true(noise_fbm(p, 0, 2, 0.6) == 0);
    }
}

/* ---- arrays ---- */

typedef struct Arrays {
    double x[ARRAY], y[ARRAY], z[ARRAY], out[ARRAY];
} Arrays;

static double awkward(RandomStream *random) {
    static const double values[] = {0, -0.0, 1, -1, 0x1p30, -0x1p30, 0x1p31, 1e300, 5e-324, -5e-324, 0x1p52};
    uint64_t k = random_next(random) % (VTS_ARRAY_COUNT(values) + 2);
    if (k < VTS_ARRAY_COUNT(values)) return values[k];
    return k == VTS_ARRAY_COUNT(values) ? (double)NAN : (double)INFINITY;
}

/* Places on a line whose steps are of any size, so that there are long runs in one cell, short ones and none. */
static void fill_arrays(Arrays *a, size_t count, bool tame, RandomStream *random) {
    double step = exp2(12 * random_next_unit(random) - 10);
    Vec3 at = vec3(span(random, 1e4), span(random, 50), span(random, 3));
    for (size_t l = 0; l < count; l++) {
        at = vec3_add(at, vec3(span(random, step), span(random, step), span(random, step)));
        a->x[l] = at.x, a->y[l] = at.y, a->z[l] = floor(at.z * 64) / 64;
        if (!tame && random_next(random) % 16 == 0) a->x[l] = awkward(random);
        if (!tame && random_next(random) % 16 == 0) a->z[l] = awkward(random);
    }
}

static void check_row(TapeRow3 *row, double (*one)(Vec3), Arrays *a, size_t count) {
    row(a->out, a->x, a->y, a->z, count);
    for (size_t l = 0; l < count; l++) {
        double expected = one(vec3(a->x[l], a->y[l], a->z[l]));
        assert_true(isnan(expected) ? isnan(a->out[l]) : !memcmp(&expected, &a->out[l], sizeof expected));
    }
}

static void arrays_give_the_same_bits(void **state) {
    (void)state;
    RandomStream random = {31};
    Arrays a;
    for (int i = 0; i < 2000; i++) {
        size_t count = (size_t)(random_next(&random) % (ARRAY + 1));
        fill_arrays(&a, count, i % 3 != 0, &random);
        check_row(row_PERLIN, noise_perlin, &a, count);
        check_row(row_POV_NOISE, noise_pov, &a, count);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_table_is_a_permutation),
        cmocka_unit_test(agrees_with_the_plain_implementation),
        cmocka_unit_test(gives_the_published_value),
        cmocka_unit_test(is_zero_at_lattice_points),
        cmocka_unit_test(repeats_after_256_however_far),
        cmocka_unit_test(is_smooth_across_cells),
        cmocka_unit_test(stays_near_one),
        cmocka_unit_test(is_undefined_only_where_the_place_is),
        cmocka_unit_test(seeds_are_unrelated),
        cmocka_unit_test(fbm_is_a_sum_of_octaves),
        cmocka_unit_test(arrays_give_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
