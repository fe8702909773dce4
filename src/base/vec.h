/* Vectors, 3×3 matrices and affine transforms. Doubles: positions of a scene; floats: voxels and pixels.
 * The scene is left-handed with y up, as POV-Ray's; nothing here depends on it. */
#ifndef VTS_BASE_VEC_H
#define VTS_BASE_VEC_H

#include "base/common.h"

#include <math.h>

typedef struct Vec3 {
    double x, y, z;
} Vec3;

typedef struct Vec3f {
    float x, y, z;
} Vec3f;

/* Columns: m · v = c[0]·v.x + c[1]·v.y + c[2]·v.z. */
typedef struct Mat3 {
    Vec3 c[3];
} Mat3;

/* A symmetric 3×3 matrix: an ellipsoid, a normal distribution. */
typedef struct Sym3f {
    float xx, yy, zz, xy, xz, yz;
} Sym3f;

/* Affine: p → linear·p + offset, kept with its inverse. */
/* A linear map and a shift: what a Transform is without its inverse. */
typedef struct Affine {
    Mat3 linear;
    Vec3 offset;
} Affine;

typedef struct Transform {
    Mat3 linear;
    Vec3 offset;
    Mat3 inverse_linear; /* of `linear`; zero where `linear` is singular */
} Transform;

typedef struct Box3 {
    Vec3 min, max; /* empty when min > max in any axis */
} Box3;

typedef struct Ray {
    Vec3 origin, direction; /* direction need not be of unit length unless said */
} Ray;

/* The width of the bundle that a ray stands for is start + spread·t, in lengths of its direction: whatever space the ray is seen in, it
 * has the same. Zeros: a line. */
typedef struct RayWidth {
    double start, spread;
} RayWidth;

static inline Vec3 vec3(double x, double y, double z) { return (Vec3){x, y, z}; }
static inline Vec3 vec3_splat(double s) { return (Vec3){s, s, s}; }
static inline Vec3 vec3_add(Vec3 a, Vec3 b) { return (Vec3){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline Vec3 vec3_sub(Vec3 a, Vec3 b) { return (Vec3){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline Vec3 vec3_scale(Vec3 a, double s) { return (Vec3){a.x * s, a.y * s, a.z * s}; }
static inline Vec3 vec3_mul(Vec3 a, Vec3 b) { return (Vec3){a.x * b.x, a.y * b.y, a.z * b.z}; }
static inline Vec3 vec3_negate(Vec3 a) { return (Vec3){-a.x, -a.y, -a.z}; }
/* a + s·b */
static inline Vec3 vec3_madd(Vec3 a, Vec3 b, double s) { return (Vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z}; }
static inline Vec3 vec3_lerp(Vec3 a, Vec3 b, double t) { return vec3_madd(vec3_scale(a, 1 - t), b, t); }
static inline double vec3_dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline Vec3 vec3_cross(Vec3 a, Vec3 b) {
    return (Vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline double vec3_length_squared(Vec3 a) { return vec3_dot(a, a); }
static inline double vec3_length(Vec3 a) { return sqrt(vec3_dot(a, a)); }
/* The zero vector stays zero. */
static inline Vec3 vec3_normalize(Vec3 a) {
    double length = vec3_length(a);
    return length > 0 ? vec3_scale(a, 1 / length) : a;
}
/* Of each coordinate the lesser and the greater, or the one that is a number: like fmin and fmax, which compilers call from the library. */
static inline Vec3 vec3_min(Vec3 a, Vec3 b) {
    return (Vec3){a.x < b.x || b.x != b.x ? a.x : b.x, a.y < b.y || b.y != b.y ? a.y : b.y, a.z < b.z || b.z != b.z ? a.z : b.z};
}
static inline Vec3 vec3_max(Vec3 a, Vec3 b) {
    return (Vec3){a.x > b.x || b.x != b.x ? a.x : b.x, a.y > b.y || b.y != b.y ? a.y : b.y, a.z > b.z || b.z != b.z ? a.z : b.z};
}
static inline bool vec3_is_finite(Vec3 a) { return isfinite(a.x) && isfinite(a.y) && isfinite(a.z); }
static inline double vec3_get(Vec3 a, int axis) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; }
/* Two unit vectors that make an orthonormal frame with the unit vector n (Duff et al. 2017). */
static inline void vec3_frame(Vec3 n, Vec3 *s, Vec3 *t) {
    double sign = copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    *s = vec3(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    *t = vec3(b, sign + n.y * n.y * a, -n.y);
}

static inline Vec3f vec3f(float x, float y, float z) { return (Vec3f){x, y, z}; }
static inline Vec3f vec3f_from(Vec3 a) { return (Vec3f){(float)a.x, (float)a.y, (float)a.z}; }
static inline Vec3 vec3_from_f(Vec3f a) { return (Vec3){(double)a.x, (double)a.y, (double)a.z}; }
static inline Vec3f vec3f_add(Vec3f a, Vec3f b) { return (Vec3f){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline Vec3f vec3f_sub(Vec3f a, Vec3f b) { return (Vec3f){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline Vec3f vec3f_scale(Vec3f a, float s) { return (Vec3f){a.x * s, a.y * s, a.z * s}; }
static inline Vec3f vec3f_mul(Vec3f a, Vec3f b) { return (Vec3f){a.x * b.x, a.y * b.y, a.z * b.z}; }
static inline Vec3f vec3f_madd(Vec3f a, Vec3f b, float s) { return (Vec3f){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z}; }
static inline float vec3f_dot(Vec3f a, Vec3f b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline Vec3f vec3f_cross(Vec3f a, Vec3f b) {
    return (Vec3f){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline float vec3f_length(Vec3f a) { return sqrtf(vec3f_dot(a, a)); }
static inline Vec3f vec3f_normalize(Vec3f a) {
    float length = vec3f_length(a);
    return length > 0 ? vec3f_scale(a, 1 / length) : a;
}

static inline Vec3 mat3_apply(const Mat3 *m, Vec3 v) {
    return vec3_madd(vec3_madd(vec3_scale(m->c[0], v.x), m->c[1], v.y), m->c[2], v.z);
}
/* mᵗ · v */
static inline Vec3 mat3_apply_transposed(const Mat3 *m, Vec3 v) {
    return vec3(vec3_dot(m->c[0], v), vec3_dot(m->c[1], v), vec3_dot(m->c[2], v));
}
static inline double mat3_determinant(const Mat3 *m) { return vec3_dot(m->c[0], vec3_cross(m->c[1], m->c[2])); }
/* The cofactor matrix det(m)·m⁻ᵗ: a polynomial, finite for singular m. Normals (times area) transform by it. */
static inline Mat3 mat3_cofactor(const Mat3 *m) {
    return (Mat3){{vec3_cross(m->c[1], m->c[2]), vec3_cross(m->c[2], m->c[0]), vec3_cross(m->c[0], m->c[1])}};
}
Mat3 mat3_multiply(const Mat3 *a, const Mat3 *b); /* a·b */
Mat3 mat3_transpose(const Mat3 *m);
/* The inverse; zero and false where m is singular. */
bool mat3_invert(const Mat3 *m, Mat3 *out);

/* vᵗ S v */
static inline Sym3f sym3f_madd(const Sym3f *a, const Sym3f *b, float f) {
    return (Sym3f){a->xx + f * b->xx, a->yy + f * b->yy, a->zz + f * b->zz, a->xy + f * b->xy, a->xz + f * b->xz, a->yz + f * b->yz};
}
static inline float sym3f_quadratic(const Sym3f *s, Vec3f v) {
    return s->xx * v.x * v.x + s->yy * v.y * v.y + s->zz * v.z * v.z +
           2 * (s->xy * v.x * v.y + s->xz * v.x * v.z + s->yz * v.y * v.z);
}
/* Eigenvalues, largest first, and unit eigenvectors (Jacobi rotations; `vectors` may be NULL). */
void sym3f_eigen(const Sym3f *s, float values[3], Vec3f vectors[3]);
/* M S Mᵗ for M given by its columns. */
Sym3f sym3f_congruence(const Sym3f *s, const Mat3 *m);

/* Transforms as POV-Ray writes them; angles in degrees, left-handed. */
Transform transform_identity(void);
Transform transform_of(const Affine *affine);
bool transform_is_identity(const Transform *t);
/* The same, in line: for asking often. */
static inline bool transform_is_unit(const Transform *t) {
    const Vec3 *c = t->linear.c;
    return c[0].x == 1 && c[1].y == 1 && c[2].z == 1 && c[0].y == 0 && c[0].z == 0 && c[1].x == 0 && c[1].z == 0 && c[2].x == 0 &&
           c[2].y == 0 && t->offset.x == 0 && t->offset.y == 0 && t->offset.z == 0;
}
Transform transform_translate(Vec3 by);
Transform transform_scale(Vec3 by);
Transform transform_rotate(Vec3 degrees);          /* about x, then y, then z */
Transform transform_axis_rotate(Vec3 axis, double degrees);
Transform transform_matrix(const double m[12]);    /* POV-Ray's matrix <…>: rows are the images of x, y, z, origin */
/* First a, then b. */
Transform transform_then(const Transform *a, const Transform *b);
Transform transform_inverse(const Transform *t);
bool transform_is_singular(const Transform *t);
static inline Vec3 transform_point(const Transform *t, Vec3 p) { return vec3_add(mat3_apply(&t->linear, p), t->offset); }
static inline Vec3 transform_vector(const Transform *t, Vec3 v) { return mat3_apply(&t->linear, v); }
static inline Vec3 transform_point_back(const Transform *t, Vec3 p) {
    return mat3_apply(&t->inverse_linear, vec3_sub(p, t->offset));
}
static inline Vec3 transform_vector_back(const Transform *t, Vec3 v) { return mat3_apply(&t->inverse_linear, v); }
/* A normal of the untransformed surface → the normal of the transformed one, not normalised. */
static inline Vec3 transform_normal(const Transform *t, Vec3 n) { return mat3_apply_transposed(&t->inverse_linear, n); }

static inline Box3 box3_empty(void) {
    return (Box3){{VTS_INFINITY, VTS_INFINITY, VTS_INFINITY}, {-VTS_INFINITY, -VTS_INFINITY, -VTS_INFINITY}};
}
static inline bool box3_is_empty(Box3 b) { return !(b.min.x <= b.max.x && b.min.y <= b.max.y && b.min.z <= b.max.z); }
static inline Box3 box3_add_point(Box3 b, Vec3 p) { return (Box3){vec3_min(b.min, p), vec3_max(b.max, p)}; }
static inline Box3 box3_union(Box3 a, Box3 b) { return (Box3){vec3_min(a.min, b.min), vec3_max(a.max, b.max)}; }
Box3 box3_transform(const Transform *t, Box3 b);
/* Where the ray is inside the box, within [*t_near, *t_far], which it narrows; false when nowhere. */
bool box3_clip_ray(Box3 b, const Ray *ray, double *t_near, double *t_far);

#endif
