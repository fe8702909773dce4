#include "texel/visible_normals.h"

#include <math.h>

static float bilinear_form(const Sym3f *s, Vec3f a, Vec3f b) {
    return a.x * (s->xx * b.x + s->xy * b.y + s->xz * b.z) + a.y * (s->xy * b.x + s->yy * b.y + s->yz * b.z) +
           a.z * (s->xz * b.x + s->yz * b.y + s->zz * b.z);
}

/* Products of three entries stay within floats for any scale of S. Where the mapping is singular there may be nothing left of
 * S: that is shaded as a sphere. */
static Sym3f of_unit_trace(const Sym3f *s) {
    float trace = s->xx + s->yy + s->zz, f = 1 / trace;
    if (!(trace > 0 && f > 0) || !isfinite(f)) return (Sym3f){1.0f / 3, 1.0f / 3, 1.0f / 3, 0, 0, 0};
    return (Sym3f){s->xx * f, s->yy * f, s->zz * f, s->xy * f, s->xz * f, s->yz * f};
}

/* Below the rounding of S in floats. */
static const float LEAST_PIVOT = 1e-10f;

VisibleNormals visible_normals(const Sym3f *any, Vec3f view) {
    Sym3f unit = of_unit_trace(any);
    Vec3 k_axis, j_axis;
    vec3_frame(vec3_from_f(view), &k_axis, &j_axis);
    Vec3f k = vec3f_from(k_axis), j = vec3f_from(j_axis);
    const Sym3f *s = &unit;
    float ii = float_max(bilinear_form(s, view, view), LEAST_PIVOT), jj = bilinear_form(s, j, j), kk = bilinear_form(s, k, k);
    float ji = bilinear_form(s, j, view), ki = bilinear_form(s, k, view), kj = bilinear_form(s, k, j);
    float sqrt_ii = sqrtf(ii);
    float minor = sqrtf(float_max(jj * ii - ji * ji, LEAST_PIVOT * LEAST_PIVOT)); /* second pivot times sqrt(ii) */
    float det = kk * (jj * ii - ji * ji) - kj * (kj * ii - ji * ki) + ki * (kj * ji - jj * ki);
    float a = sqrtf(float_max(det, 0)) / minor;
    float b = (kj * ii - ki * ji) / (minor * sqrt_ii);
    VisibleNormals out;
    out.m[0] = vec3f_scale(k, a);
    out.m[1] = vec3f_add(vec3f_scale(k, b), vec3f_scale(j, minor / sqrt_ii));
    out.m[2] = vec3f_scale(vec3f_add(vec3f_add(vec3f_scale(k, ki), vec3f_scale(j, ji)), vec3f_scale(view, ii)), 1 / sqrt_ii);
    return out;
}
