#include "render/ndf.h"

#include <math.h>

enum { MOST_POINTS = 16 };

/* Points of the unit disc with equal weights 1/count; the radius of a ring halves the area of its annulus. */
typedef struct DiscRule {
    int count;
    float x[MOST_POINTS], y[MOST_POINTS];
} DiscRule;

#define RING3 0.4330127f /* sqrt(3/16) */
#define RING5 0.8291562f /* sqrt(11/16) */
static const DiscRule ring8 = {
    8,
    {RING3, RING3 * -0.5f, RING3 * -0.5f, RING5, RING5 *0.30901699f, RING5 * -0.80901699f, RING5 * -0.80901699f,
     RING5 *0.30901699f},
    {0, RING3 *0.8660254f, RING3 * -0.8660254f, 0, RING5 *0.95105652f, RING5 *0.58778525f, RING5 * -0.58778525f,
     RING5 * -0.95105652f}};

#define C8 0.70710678f
#define INNER8 0.5f       /* sqrt(1/4) */
#define OUTER8 0.8660254f /* sqrt(3/4) */
static const DiscRule ring16 = {
    16,
    {OUTER8, OUTER8 *C8, 0, -OUTER8 *C8, -OUTER8, -OUTER8 *C8, 0, OUTER8 *C8, INNER8 *0.92387953f, INNER8 *0.38268343f,
     INNER8 * -0.38268343f, INNER8 * -0.92387953f, INNER8 * -0.92387953f, INNER8 * -0.38268343f, INNER8 *0.38268343f,
     INNER8 *0.92387953f},
    {0, OUTER8 *C8, OUTER8, OUTER8 *C8, 0, -OUTER8 *C8, -OUTER8, -OUTER8 *C8, INNER8 *0.38268343f, INNER8 *0.92387953f,
     INNER8 *0.92387953f, INNER8 *0.38268343f, INNER8 * -0.38268343f, INNER8 * -0.92387953f, INNER8 * -0.92387953f,
     INNER8 * -0.38268343f}};

/* The cells of a 4 × 4 grid over [-1, 1]² whose centres lie in the disc: 12 of 16, as in Neyret 1998 fig. 5. */
static const DiscRule grid16 = {
    12,
    {-0.25f, 0.25f, -0.75f, -0.25f, 0.25f, 0.75f, -0.75f, -0.25f, 0.25f, 0.75f, -0.25f, 0.25f},
    {-0.75f, -0.75f, -0.25f, -0.25f, -0.25f, -0.25f, 0.25f, 0.25f, 0.25f, 0.25f, 0.75f, 0.75f}};

static const DiscRule *rule_of(Quadrature quadrature) {
    return quadrature == QUADRATURE_RING16 ? &ring16 : quadrature == QUADRATURE_GRID16 ? &grid16 : &ring8;
}

/* A frame about the view direction whose first axis points towards the light, so that the rings meet the terminator alike
 * whatever the orientation of the matter. */
static void view_frame(Vec3f view, Vec3f light, Vec3f *k, Vec3f *j) {
    Vec3f across = vec3f_sub(light, vec3f_scale(view, vec3f_dot(view, light)));
    float length = vec3f_length(across);
    if (length < 1e-4f) {
        Vec3 s, t;
        vec3_frame(vec3_from_f(view), &s, &t);
        across = vec3f_from(s);
        length = 1;
    }
    *k = vec3f_scale(across, 1 / length);
    *j = vec3f_cross(view, *k);
}

static float bilinear_form(const Sym3f *s, Vec3f a, Vec3f b) {
    return a.x * (s->xx * b.x + s->xy * b.y + s->xz * b.z) + a.y * (s->xy * b.x + s->yy * b.y + s->yz * b.z) +
           a.z * (s->xz * b.x + s->yz * b.y + s->zz * b.z);
}

/* The linear map that takes the unit hemisphere over the apparent disc to (unnormalised) visible normals: the rows of
 * Heitz et al. 2015, supplemental code of SGGX sampling, derived from the Cholesky factor of S in the view's frame. */
typedef struct VisibleNormals {
    Vec3f m[3]; /* normal = disc.x·m[0] + disc.y·m[1] + height·m[2] */
} VisibleNormals;

static VisibleNormals visible_normals(const Sym3f *s, Vec3f view, Vec3f k, Vec3f j) {
    float ii = bilinear_form(s, view, view), jj = bilinear_form(s, j, j), kk = bilinear_form(s, k, k);
    float ji = bilinear_form(s, j, view), ki = bilinear_form(s, k, view), kj = bilinear_form(s, k, j);
    float sqrt_ii = sqrtf(float_max(ii, 1e-20f));
    float minor = sqrtf(float_max(jj * ii - ji * ji, 1e-30f)); /* second pivot times sqrt(ii) */
    float det = kk * (jj * ii - ji * ji) - kj * (kj * ii - ji * ki) + ki * (kj * ji - jj * ki);
    float a = sqrtf(float_max(det, 0)) / minor;
    float b = (kj * ii - ki * ji) / (minor * sqrt_ii);
    VisibleNormals out;
    out.m[0] = vec3f_scale(k, a);
    out.m[1] = vec3f_add(vec3f_scale(k, b), vec3f_scale(j, minor / sqrt_ii));
    out.m[2] = vec3f_scale(vec3f_add(vec3f_add(vec3f_scale(k, ki), vec3f_scale(j, ji)), vec3f_scale(view, ii)), 1 / sqrt_ii);
    return out;
}

/* x^e for x in [0, 1] where a lobe needs no more than three digits. */
static float lobe_power(float x, float e) { return x > 0 ? expf(e * logf(x)) : 0; }

static float highlight(float n_h, float r_l, float facing, const SheetLook *look) {
    float sum = 0;
    if (look->specular > 0) sum += look->specular * lobe_power(n_h, look->inverse_roughness);
    if (look->phong > 0) sum += look->phong * lobe_power(r_l, look->phong_size);
    return facing > 0 ? sum : 0;
}

NdfShade sheet_shade(Vec3f n, Vec3f view, Vec3f light, const SheetLook *look) {
    float n_v = vec3f_dot(n, view);
    if (n_v < 0) {
        n = vec3f_scale(n, -1);
        n_v = -n_v;
    }
    float n_l = vec3f_dot(n, light);
    float front = float_max(n_l, 0), back = float_max(-n_l, 0);
    if (look->brilliance != 1) front = lobe_power(front, look->brilliance);
    NdfShade out = {look->diffuse * front + look->transmission * back, 0};
    if (look->specular > 0 || look->phong > 0) {
        Vec3f half = vec3f_normalize(vec3f_add(view, light));
        Vec3f mirrored = vec3f_sub(vec3f_scale(n, 2 * n_v), view);
        out.highlight = highlight(vec3f_dot(n, half), vec3f_dot(mirrored, light), n_l, look);
    }
    return out;
}

NdfShade ndf_shade(Quadrature quadrature, const Sym3f *s, Vec3f view, Vec3f light, const SheetLook *look) {
    const DiscRule *rule = rule_of(quadrature);
    Vec3f k, j;
    view_frame(view, light, &k, &j);
    VisibleNormals visible = visible_normals(s, view, k, j);
    /* One row of dot products for the normals, then plain loops over the points. */
    float nl[3], nv[3], norm[6];
    for (int i = 0; i < 3; i++) {
        nl[i] = vec3f_dot(visible.m[i], light);
        nv[i] = vec3f_dot(visible.m[i], view);
    }
    norm[0] = vec3f_dot(visible.m[0], visible.m[0]);
    norm[1] = vec3f_dot(visible.m[1], visible.m[1]);
    norm[2] = vec3f_dot(visible.m[2], visible.m[2]);
    norm[3] = 2 * vec3f_dot(visible.m[0], visible.m[1]);
    norm[4] = 2 * vec3f_dot(visible.m[0], visible.m[2]);
    norm[5] = 2 * vec3f_dot(visible.m[1], visible.m[2]);
    float cos_light[MOST_POINTS], cos_view[MOST_POINTS];
    for (int i = 0; i < rule->count; i++) {
        float x = rule->x[i], y = rule->y[i], z = sqrtf(1 - x * x - y * y);
        float inverse = 1 / sqrtf(float_max(norm[0] * x * x + norm[1] * y * y + norm[2] * z * z + norm[3] * x * y +
                                                norm[4] * x * z + norm[5] * y * z, 1e-30f));
        cos_light[i] = (x * nl[0] + y * nl[1] + z * nl[2]) * inverse;
        cos_view[i] = (x * nv[0] + y * nv[1] + z * nv[2]) * inverse;
    }
    float front = 0, back = 0;
    for (int i = 0; i < rule->count; i++) {
        float lit = cos_light[i] > 0 ? cos_light[i] : 0;
        front += look->brilliance == 1 ? lit : lobe_power(lit, look->brilliance);
        back += cos_light[i] < 0 ? -cos_light[i] : 0;
    }
    float weight = 1 / (float)rule->count;
    NdfShade out = {(look->diffuse * front + look->transmission * back) * weight, 0};
    if (look->specular > 0 || look->phong > 0) {
        /* n · half = (n·view + n·light) / |view + light|;  mirrored · light = 2 (n·view)(n·light) − view·light */
        float view_light = vec3f_dot(view, light);
        float inverse_half = 1 / sqrtf(float_max(2 + 2 * view_light, 1e-12f));
        for (int i = 0; i < rule->count; i++)
            out.highlight += highlight((cos_view[i] + cos_light[i]) * inverse_half,
                                       2 * cos_view[i] * cos_light[i] - view_light, cos_light[i], look);
        out.highlight *= weight;
    }
    return out;
}
