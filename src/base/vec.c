#include "base/vec.h"

#include <string.h>

Mat3 mat3_multiply(const Mat3 *a, const Mat3 *b) {
    return (Mat3){{mat3_apply(a, b->c[0]), mat3_apply(a, b->c[1]), mat3_apply(a, b->c[2])}};
}

Mat3 mat3_transpose(const Mat3 *m) {
    return (Mat3){{vec3(m->c[0].x, m->c[1].x, m->c[2].x), vec3(m->c[0].y, m->c[1].y, m->c[2].y),
                   vec3(m->c[0].z, m->c[1].z, m->c[2].z)}};
}

bool mat3_invert(const Mat3 *m, Mat3 *out) {
    Mat3 cofactor = mat3_cofactor(m);
    double determinant = vec3_dot(m->c[0], cofactor.c[0]);
    double inverse = 1 / determinant;
    if (determinant == 0 || !isfinite(inverse)) {
        *out = (Mat3){0};
        return false;
    }
    Mat3 t = mat3_transpose(&cofactor);
    for (int i = 0; i < 3; i++) out->c[i] = vec3_scale(t.c[i], inverse);
    return true;
}

void sym3f_eigen(const Sym3f *s, float values[3], Vec3f vectors[3]) {
    double a[3][3] = {{(double)s->xx, (double)s->xy, (double)s->xz},
                      {(double)s->xy, (double)s->yy, (double)s->yz},
                      {(double)s->xz, (double)s->yz, (double)s->zz}};
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int sweep = 0; sweep < 16; sweep++) {
        double off = fabs(a[0][1]) + fabs(a[0][2]) + fabs(a[1][2]);
        if (off <= 1e-15 * (fabs(a[0][0]) + fabs(a[1][1]) + fabs(a[2][2]))) break;
        for (int p = 0; p < 2; p++)
            for (int q = p + 1; q < 3; q++) {
                if (a[p][q] == 0) continue;
                double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
                double t = copysign(1.0, theta) / (fabs(theta) + sqrt(theta * theta + 1));
                double c = 1 / sqrt(t * t + 1), sn = t * c;
                for (int k = 0; k < 3; k++) {
                    double kp = a[k][p], kq = a[k][q];
                    a[k][p] = c * kp - sn * kq;
                    a[k][q] = sn * kp + c * kq;
                }
                for (int k = 0; k < 3; k++) {
                    double pk = a[p][k], qk = a[q][k];
                    a[p][k] = c * pk - sn * qk;
                    a[q][k] = sn * pk + c * qk;
                    double vp = v[k][p], vq = v[k][q];
                    v[k][p] = c * vp - sn * vq;
                    v[k][q] = sn * vp + c * vq;
                }
            }
    }
    int order[3] = {0, 1, 2};
    for (int i = 0; i < 2; i++)
        for (int j = i + 1; j < 3; j++)
            if (a[order[j]][order[j]] > a[order[i]][order[i]]) {
                int swap = order[i];
                order[i] = order[j];
                order[j] = swap;
            }
    for (int i = 0; i < 3; i++) {
        int k = order[i];
        values[i] = (float)a[k][k];
        if (vectors) vectors[i] = vec3f((float)v[0][k], (float)v[1][k], (float)v[2][k]);
    }
}

Sym3f sym3f_congruence(const Sym3f *s, const Mat3 *m) {
    Mat3 full = {{vec3((double)s->xx, (double)s->xy, (double)s->xz), vec3((double)s->xy, (double)s->yy, (double)s->yz),
                  vec3((double)s->xz, (double)s->yz, (double)s->zz)}};
    Mat3 transposed = mat3_transpose(m), ms = mat3_multiply(m, &full), r = mat3_multiply(&ms, &transposed);
    return (Sym3f){(float)r.c[0].x, (float)r.c[1].y, (float)r.c[2].z, (float)r.c[1].x, (float)r.c[2].x, (float)r.c[2].y};
}

static Transform from_linear(Mat3 linear, Vec3 offset) {
    Transform t = {.linear = linear, .offset = offset};
    mat3_invert(&linear, &t.inverse_linear);
    return t;
}

Transform transform_identity(void) {
    static const Mat3 unit = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return (Transform){.linear = unit, .inverse_linear = unit};
}

Transform transform_of(const Affine *affine) { return from_linear(affine->linear, affine->offset); }

bool transform_is_identity(const Transform *t) {
    static const Mat3 unit = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return t->offset.x == 0 && t->offset.y == 0 && t->offset.z == 0 && memcmp(&t->linear, &unit, sizeof unit) == 0;
}

Transform transform_translate(Vec3 by) {
    Transform t = transform_identity();
    t.offset = by;
    return t;
}

Transform transform_scale(Vec3 by) {
    return from_linear((Mat3){{vec3(by.x, 0, 0), vec3(0, by.y, 0), vec3(0, 0, by.z)}}, vec3(0, 0, 0));
}

Transform transform_axis_rotate(Vec3 axis, double degrees) {
    /* Rodrigues' formula. POV-Ray's left-handed rotation is the right-handed formula read in left-handed axes:
     * rotating x by 90 degrees about z gives y, and by 90 degrees about y gives -z. */
    Vec3 k = vec3_normalize(axis);
    double c = cos(degrees * VTS_RADIANS), s = sin(degrees * VTS_RADIANS);
    Mat3 linear;
    Vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 3; i++)
        linear.c[i] = vec3_add(vec3_madd(vec3_scale(unit[i], c), vec3_cross(k, unit[i]), s),
                               vec3_scale(k, vec3_dot(k, unit[i]) * (1 - c)));
    return (Transform){.linear = linear, .inverse_linear = mat3_transpose(&linear)};
}

Transform transform_rotate(Vec3 degrees) {
    Transform x = transform_axis_rotate(vec3(1, 0, 0), degrees.x);
    Transform y = transform_axis_rotate(vec3(0, 1, 0), degrees.y);
    Transform z = transform_axis_rotate(vec3(0, 0, 1), degrees.z);
    Transform xy = transform_then(&x, &y);
    return transform_then(&xy, &z);
}

Transform transform_matrix(const double m[12]) {
    return from_linear((Mat3){{vec3(m[0], m[1], m[2]), vec3(m[3], m[4], m[5]), vec3(m[6], m[7], m[8])}},
                       vec3(m[9], m[10], m[11]));
}

Transform transform_then(const Transform *a, const Transform *b) {
    return (Transform){.linear = mat3_multiply(&b->linear, &a->linear),
                       .offset = transform_point(b, a->offset),
                       .inverse_linear = mat3_multiply(&a->inverse_linear, &b->inverse_linear)};
}

Transform transform_inverse(const Transform *t) {
    return (Transform){.linear = t->inverse_linear,
                       .offset = vec3_negate(mat3_apply(&t->inverse_linear, t->offset)),
                       .inverse_linear = t->linear};
}

bool transform_is_singular(const Transform *t) { return mat3_determinant(&t->inverse_linear) == 0; }

Box3 box3_transform(const Transform *t, Box3 b) {
    if (box3_is_empty(b)) return b;
    Box3 out = box3_empty();
    for (int i = 0; i < 8; i++)
        out = box3_add_point(out, transform_point(t, vec3(i & 1 ? b.max.x : b.min.x, i & 2 ? b.max.y : b.min.y,
                                                          i & 4 ? b.max.z : b.min.z)));
    return out;
}

static bool clip_axis(double origin, double direction, double lo, double hi, double *t_near, double *t_far) {
    if (direction == 0) return origin >= lo && origin <= hi;
    double a = (lo - origin) / direction, b = (hi - origin) / direction;
    *t_near = fmax(*t_near, fmin(a, b));
    *t_far = fmin(*t_far, fmax(a, b));
    return *t_near <= *t_far;
}

bool box3_clip_ray(Box3 b, const Ray *ray, double *t_near, double *t_far) {
    return clip_axis(ray->origin.x, ray->direction.x, b.min.x, b.max.x, t_near, t_far) &&
           clip_axis(ray->origin.y, ray->direction.y, b.min.y, b.max.y, t_near, t_far) &&
           clip_axis(ray->origin.z, ray->direction.z, b.min.z, b.max.z, t_near, t_far);
}
