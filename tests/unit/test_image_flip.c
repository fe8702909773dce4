/* FLIP against a direct transcription of the paper's formulas in long double: whole two-dimensional kernels, no separation. */
#include "image/flip.h"

#include "base/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef long double Real;
typedef struct {
    Real v[3];
} Color3;

static const Real M[3][3] = {{10135552.0L / 24577794, 8788810.0L / 24577794, 4435075.0L / 24577794},
                             {2613072.0L / 12288897, 8788810.0L / 12288897, 887015.0L / 12288897},
                             {1425312.0L / 73733382, 8788810.0L / 73733382, 70074185.0L / 73733382}};

static Color3 relative_xyz(Color3 c) {
    Color3 o;
    for (int i = 0; i < 3; i++)
        o.v[i] = (M[i][0] * c.v[0] + M[i][1] * c.v[1] + M[i][2] * c.v[2]) / (M[i][0] + M[i][1] + M[i][2]);
    return o;
}

/* Solves M c = xyz by Cramer's rule. */
static Real det3(Real a[3][3]) {
    return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
           a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

static Color3 from_relative_xyz(Color3 xyz) {
    Real full[3][3];
    memcpy(full, M, sizeof full);
    Real whole = det3(full);
    Color3 o;
    for (int c = 0; c < 3; c++) {
        Real a[3][3];
        memcpy(a, M, sizeof a);
        for (int i = 0; i < 3; i++) a[i][c] = xyz.v[i] * (M[i][0] + M[i][1] + M[i][2]);
        o.v[c] = det3(a) / whole;
    }
    return o;
}

static Real curve(Real t) {
    Real d = 6.0L / 29;
    return t > d * d * d ? cbrtl(t) : t / (3 * d * d) + 4.0L / 29;
}

static Color3 lab(Color3 c) {
    Color3 x = relative_xyz(c);
    Real l = 116 * curve(x.v[1]) - 16;
    return (Color3){{l, .01L * l * 500 * (curve(x.v[0]) - curve(x.v[1])), .01L * l * 200 * (curve(x.v[1]) - curve(x.v[2]))}};
}

static Real distance(Color3 a, Color3 b) {
    Real p = a.v[1] - b.v[1], q = a.v[2] - b.v[2];
    return fabsl(a.v[0] - b.v[0]) + sqrtl(p * p + q * q);
}

static Color3 pixel_of(const Image *image, int x, int y) {
    x = x < 0 ? 0 : x >= image->width ? image->width - 1 : x;
    y = y < 0 ? 0 : y >= image->height ? image->height - 1 : y;
    const float *p = image_pixel(image, x, y);
    Color3 c;
    for (int i = 0; i < 3; i++) c.v[i] = p[i] < 0 ? 0 : p[i] > 1 ? 1 : (Real)p[i];
    return c;
}

static Color3 opponent(Color3 c) {
    Color3 x = relative_xyz(c);
    return (Color3){{116 * x.v[1] - 16, 500 * (x.v[0] - x.v[1]), 200 * (x.v[1] - x.v[2])}};
}

static const Real PI = 3.14159265358979323846264338327950288L;

static Color3 seen(const Image *image, int x, int y, Real ppd) {
    static const Real a[3][2] = {{1, 0}, {1, 0}, {34.1L, 13.5L}}, b[3][2] = {{.0047L, 1e-5L}, {.0053L, 1e-5L}, {.04L, .025L}};
    int r = (int)ceill(3 * sqrtl(.04L / (2 * PI * PI)) * ppd);
    Color3 sum = {{0, 0, 0}}, weight = {{0, 0, 0}};
    for (int j = -r; j <= r; j++)
        for (int i = -r; i <= r; i++) {
            Color3 o = opponent(pixel_of(image, x + i, y + j));
            Real z = ((Real)i * i + (Real)j * j) / (ppd * ppd);
            for (int c = 0; c < 3; c++) {
                Real w = 0;
                for (int k = 0; k < 2; k++) w += a[c][k] * sqrtl(PI / b[c][k]) * expl(-PI * PI * z / b[c][k]);
                sum.v[c] += w * o.v[c];
                weight.v[c] += w;
            }
        }
    for (int c = 0; c < 3; c++) sum.v[c] /= weight.v[c];
    Real Y = (sum.v[0] + 16) / 116;
    Color3 rgb = from_relative_xyz((Color3){{Y + sum.v[1] / 500, Y, Y - sum.v[2] / 200}});
    for (int c = 0; c < 3; c++) rgb.v[c] = rgb.v[c] < 0 ? 0 : rgb.v[c] > 1 ? 1 : rgb.v[c];
    return lab(rgb);
}

static Real feature(const Image *image, int x, int y, Real ppd, bool point) {
    Real s = .5L * .082L * ppd, plus = 0, minus = 0;
    int r = (int)ceill(3 * s);
    for (int j = -r; j <= r; j++)
        for (int i = -r; i <= r; i++) {
            Real g = expl(-((Real)i * i + (Real)j * j) / (2 * s * s)), w = (point ? (Real)i * i / (s * s) - 1 : -(Real)i) * g;
            *(w > 0 ? &plus : &minus) += fabsl(w);
        }
    Real gx = 0, gy = 0;
    for (int j = -r; j <= r; j++)
        for (int i = -r; i <= r; i++) {
            Real g = expl(-((Real)i * i + (Real)j * j) / (2 * s * s)), w = (point ? (Real)i * i / (s * s) - 1 : -(Real)i) * g;
            w /= w > 0 ? plus : minus;
            gx += w * (opponent(pixel_of(image, x + i, y + j)).v[0] + 16) / 116;
            gy += w * (opponent(pixel_of(image, x + j, y + i)).v[0] + 16) / 116;
        }
    return sqrtl(gx * gx + gy * gy);
}

static Real exact(const Image *a, const Image *b, int x, int y, Real ppd) {
    Real limit = powl(distance(lab((Color3){{0, 1, 0}}), lab((Color3){{0, 0, 1}})), .7L);
    Real e = powl(distance(seen(a, x, y, ppd), seen(b, x, y, ppd)), .7L);
    e = e < .4L * limit ? .95L / (.4L * limit) * e : .95L + (e - .4L * limit) / (.6L * limit) * .05L;
    Real edge = fabsl(feature(a, x, y, ppd, false) - feature(b, x, y, ppd, false));
    Real point = fabsl(feature(a, x, y, ppd, true) - feature(b, x, y, ppd, true));
    Real f = sqrtl((edge > point ? edge : point) / sqrtl(2));
    return powl(e, 1 - f);
}

static void fill(Image *image, int width, int height, uint64_t seed) {
    assert_true(image_init(image, width, height, 3, NULL, NULL, NULL));
    for (int i = 0; i < width * height * 3; i++) image->pixels[i] = (float)(1.2 * random_unit(random_mix(seed + (uint64_t)i)) - 0.1);
}

static void is_the_papers(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++) {
        Image a, b;
        fill(&a, 17 + k, 13, 1000 * (uint64_t)k);
        fill(&b, 17 + k, 13, 1000 * (uint64_t)k + 500);
        /* The second case differs little. */
        for (int i = 0; k == 1 && i < 18 * 13 * 3; i++) b.pixels[i] = a.pixels[i] + .05f * b.pixels[i];
        Real ppd = k == 2 ? 30 : (Real)FLIP_PIXELS_PER_DEGREE, sum = 0, worst = 0;
        double mean;
        float *map = flip_map(&a, &b, (double)ppd, &mean, NULL);
        assert_non_null(map);
        for (int y = 0; y < a.height; y++)
            for (int x = 0; x < a.width; x++) {
                Real e = exact(&a, &b, x, y, ppd), off = fabsl(e - (Real)map[y * a.width + x]);
                sum += e;
                worst = off > worst ? off : worst;
            }
        printf("largest deviation %Lg\n", worst);
        assert_true(worst < 1e-6L);
        assert_true(fabsl(sum / (a.width * a.height) - (Real)mean) < 1e-7L);
        free(map);
        image_free(&a);
        image_free(&b);
    }
}

static void flat(Image *image, float r, float g, float b) {
    assert_true(image_init(image, 40, 30, 3, NULL, NULL, NULL));
    for (int i = 0; i < 40 * 30; i++) memcpy(image->pixels + 3 * i, (float[]){r, g, b}, 3 * sizeof(float));
}

static void ends_of_the_range(void **state) {
    (void)state;
    Image green, blue;
    flat(&green, 0, 1, 0);
    flat(&blue, 0, 0, 1);
    double mean;
    float *map = flip_map(&green, &green, FLIP_PIXELS_PER_DEGREE, &mean, NULL);
    assert_true(mean == 0);
    free(map);
    map = flip_map(&green, &blue, FLIP_PIXELS_PER_DEGREE, &mean, NULL);
    assert_true(fabs(mean - 1) < 1e-6); /* the farthest colours */
    free(map);
    image_free(&green);
    image_free(&blue);
    /* Not finite: black, and no trap. */
    flat(&green, NAN, INFINITY, -INFINITY);
    flat(&blue, 0, 1, 0);
    map = flip_map(&green, &blue, FLIP_PIXELS_PER_DEGREE, &mean, NULL);
    assert_true(mean < 1e-6);
    free(map);
    image_free(&green);
    image_free(&blue);
}

static void sizes_must_agree(void **state) {
    (void)state;
    Image a, b;
    fill(&a, 4, 4, 1);
    fill(&b, 4, 5, 1);
    double mean;
    StrBuf error = {0};
    assert_null(flip_map(&a, &b, 67, &mean, &error));
    assert_string_equal(error.data, "pictures of different size: 4 x 4 and 4 x 5");
    strbuf_free(&error);
    image_free(&a);
    image_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(is_the_papers), cmocka_unit_test(ends_of_the_range),
                                       cmocka_unit_test(sizes_must_agree)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
