/* Matrices, transforms and boxes, against POV-Ray's conventions and their definitions. */
#include "base/random.h"
#include "base/vec.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

static double centered(RandomStream *r) { return 2 * random_next_unit(r) - 1; }
static Vec3 random_vec(RandomStream *r) { return vec3(centered(r), centered(r), centered(r)); }
static Mat3 random_mat(RandomStream *r) { return (Mat3){{random_vec(r), random_vec(r), random_vec(r)}}; }

static void assert_near(Vec3 a, Vec3 b, double tolerance) { assert_true(vec3_length(vec3_sub(a, b)) <= tolerance); }

/* ---- rotations ---- */

static const Vec3 X = {1, 0, 0}, Y = {0, 1, 0}, Z = {0, 0, 1};

static Vec3 rotated(Vec3 v, Vec3 degrees) {
    Transform t = transform_rotate(degrees);
    return transform_point(&t, v);
}

/* What POV-Ray's vrotate() and vaxis_rotate() give. */
static void rotations_are_pov_rays(void **state) {
    (void)state;
    assert_near(rotated(X, vec3(0, 90, 0)), vec3_negate(Z), 1e-15);
    assert_near(rotated(Z, vec3(0, 90, 0)), X, 1e-15);
    assert_near(rotated(Y, vec3(90, 0, 0)), Z, 1e-15);
    assert_near(rotated(Z, vec3(90, 0, 0)), vec3_negate(Y), 1e-15);
    assert_near(rotated(X, vec3(0, 0, 90)), Y, 1e-15);
    assert_near(rotated(Y, vec3(0, 0, 90)), vec3_negate(X), 1e-15);
    assert_near(rotated(Z, vec3(90, 90, 90)), X, 1e-14); /* x, then y, then z: z → -y → -y → x */
    assert_near(rotated(vec3(1, 2, 3), vec3(30, 0, 0)), vec3(1, 2 * cos(VTS_PI / 6) - 3 * .5, 2 * .5 + 3 * cos(VTS_PI / 6)), 1e-14);
    for (int i = 0; i < 360; i += 30) { /* about an axis of the scene both are the same */
        Transform axis = transform_axis_rotate(vec3(0, 5, 0), i);
        assert_near(transform_point(&axis, vec3(1, 2, 3)), rotated(vec3(1, 2, 3), vec3(0, i, 0)), 1e-14);
    }
    Transform third = transform_axis_rotate(vec3(1, 1, 1), 120);
    assert_near(transform_point(&third, X), Y, 1e-14);
    assert_near(transform_point(&third, Y), Z, 1e-14);
}

static void matrices_are_rows_of_images(void **state) {
    (void)state;
    const double m[12] = {1, 2, 3, 4, 5, 7, 8, 9, 11, 20, 30, 40};
    Transform t = transform_matrix(m);
    assert_near(transform_point(&t, vec3(0, 0, 0)), vec3(20, 30, 40), 0);
    assert_near(transform_point(&t, X), vec3(21, 32, 43), 0);
    assert_near(transform_point(&t, Y), vec3(24, 35, 47), 0);
    assert_near(transform_vector(&t, Z), vec3(8, 9, 11), 0);
}

/* ---- transforms ---- */

static Transform random_transform(RandomStream *r) {
    double m[12];
    for (int i = 0; i < 12; i++) m[i] = 3 * centered(r);
    return transform_matrix(m);
}

static void transforms_compose_and_go_back(void **state) {
    (void)state;
    RandomStream r = {1};
    for (int i = 0; i < 1000; i++) {
        Transform a = random_transform(&r), b = random_transform(&r), ab = transform_then(&a, &b), back = transform_inverse(&ab);
        if (fabs(mat3_determinant(&a.linear)) < .5 || fabs(mat3_determinant(&b.linear)) < .5) continue;
        Vec3 p = random_vec(&r), q = transform_point(&ab, p);
        assert_near(q, transform_point(&b, transform_point(&a, p)), 1e-12);
        assert_near(transform_point_back(&ab, q), p, 1e-9);
        assert_near(transform_point(&back, q), p, 1e-9);
        assert_near(transform_vector_back(&ab, transform_vector(&ab, p)), p, 1e-9);
        /* A normal stays at right angles to what lay in the surface. */
        Vec3 n = random_vec(&r), in = vec3_cross(n, random_vec(&r));
        double turned = vec3_dot(transform_normal(&ab, n), transform_vector(&ab, in));
        assert_true(fabs(turned) < 1e-9 * (1 + vec3_length(transform_normal(&ab, n)) * vec3_length(transform_vector(&ab, in))));
        assert_false(transform_is_singular(&ab));
    }
    Transform flat = transform_scale(vec3(1, 0, 1));
    assert_true(transform_is_singular(&flat));
    assert_near(transform_point_back(&flat, vec3(1, 2, 3)), vec3(0, 0, 0), 0);
}

static void inverses_and_cofactors(void **state) {
    (void)state;
    RandomStream r = {2};
    for (int i = 0; i < 1000; i++) {
        Mat3 m = random_mat(&r), inverse, cofactor = mat3_cofactor(&m);
        double det = mat3_determinant(&m);
        assert_true(mat3_invert(&m, &inverse));
        Mat3 unit = mat3_multiply(&m, &inverse);
        double bound = 1e-13 / (det * det);
        assert_near(unit.c[0], X, bound);
        assert_near(unit.c[1], Y, bound);
        assert_near(unit.c[2], Z, bound);
        for (int k = 0; k < 3; k++) { /* cof = det · m⁻ᵗ */
            Mat3 t = mat3_transpose(&inverse);
            assert_near(cofactor.c[k], vec3_scale(t.c[k], det), 1e-13 / fabs(det) + 1e-13);
        }
    }
    Mat3 flat = {{{1, 2, 3}, {2, 4, 6}, {0, 0, 1}}}, out;
    assert_false(mat3_invert(&flat, &out));
    assert_near(out.c[2], vec3(0, 0, 0), 0);
    Mat3 tiny = {{{1e-200, 0, 0}, {0, 1e-200, 0}, {0, 0, 1e-200}}}; /* the determinant is no number of ours */
    assert_false(mat3_invert(&tiny, &out));
}

/* ---- symmetric matrices ---- */

static void eigenvalues_rebuild_the_matrix(void **state) {
    (void)state;
    RandomStream r = {3};
    for (int i = 0; i < 2000; i++) {
        double size = pow(10, 6 * centered(&r));
        Sym3f s = {(float)(size * centered(&r)), (float)(size * centered(&r)), (float)(size * centered(&r)), (float)(size * centered(&r)),
                   (float)(size * centered(&r)), (float)(size * centered(&r))};
        if (i % 4 == 1) s.xy = s.xz = s.yz = 0;
        if (i % 4 == 2) s = (Sym3f){s.xx, s.xx, s.zz, 0, 0, 0}; /* a double one */
        if (i % 4 == 3) { /* n nᵗ: two zeros */
            Vec3f n = vec3f((float)centered(&r), (float)centered(&r), (float)centered(&r));
            s = (Sym3f){n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.x * n.z, n.y * n.z};
            size = 1;
        }
        float values[3];
        Vec3f axes[3];
        sym3f_eigen(&s, values, axes);
        assert_true(values[0] >= values[1] && values[1] >= values[2]);
        Sym3f back = {0, 0, 0, 0, 0, 0};
        for (int k = 0; k < 3; k++) {
            Vec3f a = axes[k];
            assert_true(fabsf(vec3f_length(a) - 1) < 1e-6f && fabsf(vec3f_dot(a, axes[(k + 1) % 3])) < 1e-6f);
            back.xx += values[k] * a.x * a.x, back.yy += values[k] * a.y * a.y, back.zz += values[k] * a.z * a.z;
            back.xy += values[k] * a.x * a.y, back.xz += values[k] * a.x * a.z, back.yz += values[k] * a.y * a.z;
        }
        double error = fabs((double)(back.xx - s.xx)) + fabs((double)(back.yy - s.yy)) + fabs((double)(back.zz - s.zz)) +
                       fabs((double)(back.xy - s.xy)) + fabs((double)(back.xz - s.xz)) + fabs((double)(back.yz - s.yz));
        assert_true(error < 3e-6 * size);
        float alone[3];
        sym3f_eigen(&s, alone, NULL);
        assert_true(alone[0] == values[0] && alone[2] == values[2]);
    }
}

/* vᵗ (M S Mᵗ) v = (Mᵗ v)ᵗ S (Mᵗ v) */
static void congruence_is_what_it_says(void **state) {
    (void)state;
    RandomStream r = {4};
    for (int i = 0; i < 1000; i++) {
        Sym3f s = {(float)centered(&r), (float)centered(&r), (float)centered(&r), (float)centered(&r), (float)centered(&r), (float)centered(&r)};
        Mat3 m = random_mat(&r);
        Sym3f t = sym3f_congruence(&s, &m);
        Vec3 v = random_vec(&r);
        float left = sym3f_quadratic(&t, vec3f_from(v)), right = sym3f_quadratic(&s, vec3f_from(mat3_apply_transposed(&m, v)));
        assert_true(fabsf(left - right) < 1e-5f);
    }
}

/* ---- frames and boxes ---- */

static void frames_are_orthonormal(void **state) {
    (void)state;
    RandomStream r = {5};
    for (int i = 0; i < 1000; i++) {
        Vec3 n = vec3_normalize(i % 3 ? random_vec(&r) : vec3(1e-9 * centered(&r), 1e-9 * centered(&r), i & 1 ? -1 : 1)), s, t;
        vec3_frame(n, &s, &t);
        assert_true(fabs(vec3_length(s) - 1) < 1e-12 && fabs(vec3_length(t) - 1) < 1e-12);
        assert_true(fabs(vec3_dot(n, s)) < 1e-12 && fabs(vec3_dot(n, t)) < 1e-12 && fabs(vec3_dot(s, t)) < 1e-12);
        assert_near(vec3_cross(s, t), n, 1e-12);
    }
}

static void boxes_clip_rays(void **state) {
    (void)state;
    RandomStream r = {6};
    for (int i = 0; i < 3000; i++) {
        Box3 b = box3_add_point(box3_add_point(box3_empty(), random_vec(&r)), random_vec(&r));
        Ray ray = {vec3_scale(random_vec(&r), 2), random_vec(&r)};
        if (i % 5 == 0) ray.direction.y = 0;
        double lo = -1, hi = 1, first = 2, last = -2;
        for (int k = 0; k <= 2000; k++) {
            double t = -1 + k / 1000.0;
            Vec3 p = vec3_madd(ray.origin, ray.direction, t);
            bool in = p.x >= b.min.x && p.x <= b.max.x && p.y >= b.min.y && p.y <= b.max.y && p.z >= b.min.z && p.z <= b.max.z;
            if (in) first = fmin(first, t), last = fmax(last, t);
        }
        bool hit = box3_clip_ray(b, &ray, &lo, &hi);
        if (first <= last) {
            assert_true(hit && lo <= first + 1e-12 && hi >= last - 1e-12 && first - lo < .00101 && hi - last < .00101);
        } else if (hit) {
            assert_true(hi - lo < .00101);
        }
    }
    assert_true(box3_is_empty(box3_empty()));
    Transform t = transform_rotate(vec3(0, 90, 0));
    Box3 turned = box3_transform(&t, (Box3){{1, 2, 3}, {2, 4, 6}});
    assert_near(turned.min, vec3(3, 2, -2), 1e-12);
    assert_near(turned.max, vec3(6, 4, -1), 1e-12);
    assert_true(box3_is_empty(box3_transform(&t, box3_empty())));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rotations_are_pov_rays),         cmocka_unit_test(matrices_are_rows_of_images),
        cmocka_unit_test(transforms_compose_and_go_back), cmocka_unit_test(inverses_and_cofactors),
        cmocka_unit_test(eigenvalues_rebuild_the_matrix), cmocka_unit_test(congruence_is_what_it_says),
        cmocka_unit_test(frames_are_orthonormal),         cmocka_unit_test(boxes_clip_rays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
