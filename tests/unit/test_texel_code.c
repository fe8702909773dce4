/* The eight-byte code of a voxel: what comes back, and that it is a distribution whatever went in. */
#include "base/random.h"
#include "texel/voxel_cell.h"
#include "texel/voxel_code.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

typedef struct Shape {
    double axes[3]; /* projections along the eigenvectors, before normalisation */
    Mat3 frame;
} Shape;

static double next_normal(RandomStream *r) {
    double sum = 0;
    for (int i = 0; i < 12; i++) sum += random_next_unit(r);
    return sum - 6;
}

static Vec3 random_direction(RandomStream *r) {
    double x = next_normal(r), y = next_normal(r), z = next_normal(r);
    return vec3_normalize(vec3(x, y, z));
}

static Shape random_shape(RandomStream *r, double a, double b, double c) {
    Shape s = {.axes = {a, b, c}};
    s.frame.c[0] = random_direction(r);
    vec3_frame(s.frame.c[0], &s.frame.c[1], &s.frame.c[2]);
    return s;
}

/* frame · diag(axes^power) · frameᵗ */
static Sym3f shape_power(const Shape *s, int power, double scale) {
    double m[3][3] = {{0}};
    for (int e = 0; e < 3; e++) {
        const double v[3] = {s->frame.c[e].x, s->frame.c[e].y, s->frame.c[e].z};
        double value = pow(s->axes[e] * scale, power);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) m[i][j] += value * v[i] * v[j];
    }
    return (Sym3f){(float)m[0][0], (float)m[1][1], (float)m[2][2],
                   (float)m[0][1], (float)m[0][2], (float)m[1][2]};
}

/* Mean over directions of |diag(axes) d|, by the midpoint rule. */
static double mean_projection(const double axes[3]) {
    enum { N = 48 };
    double sum = 0;
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            double z = (i + .5) / N, r = sqrt(1 - z * z), phi = (j + .5) / N * VTS_PI / 2;
            sum += vec3_length(vec3(axes[0] * r * cos(phi), axes[1] * r * sin(phi), axes[2] * z));
        }
    return sum / (N * N);
}

static double sigma(const Sym3f *s, Vec3 d) {
    return sqrt((double)float_max(0, sym3f_quadratic(s, vec3f_from(d))));
}

/* Largest error of the projected area over directions, relative to its mean; and that the result is positive definite. */
static double round_trip_error(RandomStream *r, const Shape *shape) {
    double scale = 1 / mean_projection(shape->axes), worst = 0;
    Sym3f s = shape_power(shape, 2, scale), root = shape_power(shape, 1, scale);
    VoxelSample out;
    voxel_code_unpack(voxel_code_pack(1, .5f, &root), &out);
    float values[3];
    sym3f_eigen(&out.s, values, NULL);
    assert_true(values[2] > 0);
    for (int i = 0; i < 50; i++) {
        Vec3 d = random_direction(r);
        worst = fmax(worst, fabs(sigma(&out.s, d) - sigma(&s, d)));
    }
    return worst;
}

static void test_shapes_come_back(void **state) {
    (void)state;
    const double rough = (double)VOXEL_ROUGHNESS;
    const struct {
        const char *name;
        double axes[3];
    } kinds[] = {{"disc", {1, rough, rough}}, {"disc .1", {1, .1, .1}}, {"needle", {1, 1, rough}},
                 {"needle .1", {1, 1, .1}},   {"sphere", {1, 1, 1}},    {"blade", {1, .3, rough}},
                 {"random", {0, 0, 0}}};
    RandomStream r = {11};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(kinds); k++) {
        double worst = 0, sum = 0;
        for (int i = 0; i < 400; i++) {
            const double *a = kinds[k].axes;
            bool any = a[0] == 0;
            Shape s = any ? random_shape(&r, 1, fmax(rough, random_next_unit(&r)),
                                         fmax(rough, random_next_unit(&r)))
                          : random_shape(&r, a[0], a[1], a[2]);
            double error = round_trip_error(&r, &s);
            worst = fmax(worst, error);
            sum += error;
        }
        print_message("%-10s largest error of the projected area: mean %.4f, worst %.4f\n", kinds[k].name,
                      sum / 400, worst);
        assert_true(worst < .0125);
        assert_true(sum / 400 < .008);
    }
}

static void test_density_and_gamma(void **state) {
    (void)state;
    RandomStream r = {12};
    const Sym3f root = {1, 1, 1, 0, 0, 0};
    for (int i = 0; i < 20000; i++) {
        float density = exp2f((float)(random_next_unit(&r) * 31.9 - 18)),
              gamma = (float)random_next_unit(&r) * 2.08f - .36f;
        VoxelSample out;
        voxel_code_unpack(voxel_code_pack(density, gamma, &root), &out);
        assert_true(fabsf(out.density / density - 1) < .0079f);
        assert_true(fabsf(out.gamma - gamma) < .041f);
    }
    const float extremes[] = {0x1p-30f, 1e-38f, 16000, 1e30f};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(extremes); i++) {
        VoxelSample out;
        voxel_code_unpack(voxel_code_pack(extremes[i], 1, &root), &out);
        assert_true(out.density > 0 && isfinite(out.density));
        assert_true(fabsf(out.gamma - 1) < .041f);
    }
}

/* Any bits are a valid voxel: nothing in the renderer can be broken by a stored code. */
static void test_any_bits(void **state) {
    (void)state;
    RandomStream r = {13};
    for (int i = 0; i < 100000; i++) {
        uint64_t bits = random_next(&r);
        VoxelSample out;
        voxel_code_unpack((VoxelCode){(uint32_t)bits, (uint32_t)(bits >> 32)}, &out);
        assert_true(out.density >= 0 && isfinite(out.density) && out.gamma > -.5f && out.gamma < 2.6f);
        Vec3 d = random_direction(&r);
        assert_true(sym3f_quadratic(&out.s, vec3f_from(d)) >= -1e-5f);
    }
}

/* The S of a cell is normalised to unit mean projected area, for any mixture of normals. */
static void test_cells_have_unit_mean(void **state) {
    (void)state;
    RandomStream r = {14};
    const float sides[3] = {1, 1, 1};
    for (int i = 0; i < 300; i++) {
        VoxelCell cell = {.sheet = .25f};
        int count = 1 + i % 5;
        for (int n = 0; n < count; n++) {
            Vec3 d = random_direction(&r);
            double w = .25 * random_next_unit(&r);
            const double squares[6] = {d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.x * d.z, d.y * d.z};
            for (int k = 0; k < 6; k++) cell.normals[k] += (float)(w * squares[k]);
        }
        VoxelMatter m = voxel_cell_matter(&cell, &(VoxelSurround){0}, sides, 1, 0, true);
        double sum = 0;
        enum { N = 4000 };
        for (int k = 0; k < N; k++) {
            double z = 1 - (2 * k + 1.0) / N, phi = k * VTS_PI * (3 - sqrt(5.0)), s = sqrt(1 - z * z);
            Vec3f d = vec3f((float)(s * cos(phi)), (float)(s * sin(phi)), (float)z);
            sum += (double)vec3f_length(vec3f(m.root.xx * d.x + m.root.xy * d.y + m.root.xz * d.z,
                                              m.root.xy * d.x + m.root.yy * d.y + m.root.yz * d.z,
                                              m.root.xz * d.x + m.root.yz * d.y + m.root.zz * d.z));
        }
        assert_true(fabs(sum / N - 1) < .006);
        assert_true(fabsf(m.density - .125f) < 1e-6f);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shapes_come_back),
        cmocka_unit_test(test_density_and_gamma),
        cmocka_unit_test(test_any_bits),
        cmocka_unit_test(test_cells_have_unit_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
