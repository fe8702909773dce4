#include "render/ndf.h"

#include "texel/visible_normals.h"

#include <math.h>

enum { MOST_POINTS = 30 };

/* Points of the unit disc; the weights sum to 1. */
typedef struct DiscRule {
    int count;
    float x[MOST_POINTS], y[MOST_POINTS], weight[MOST_POINTS];
} DiscRule;

/* Two rings at the Gauss points of the radius squared, (1 ± 1/√3)/2, each with half of the weight. The light lies towards
 * +x; how the rings are turned against it matters as much as their number, and was found by trying. */
/* 3 points from 0.5 rad, 5 from 0.3 rad. */
static const DiscRule ring8 = {
    8,
    {0.40342544f, -0.39257807f, -0.01084737f, 0.84840934f, 0.01257405f, -0.84063815f, -0.53211700f, 0.51177175f},
    {0.22039232f, 0.23918052f, -0.45957285f, 0.26244376f, 0.88798481f, 0.28636103f, -0.71100396f, -0.72578565f},
    {0.16666667f, 0.16666667f, 0.16666667f, 0.10000000f, 0.10000000f, 0.10000000f, 0.10000000f, 0.10000000f}};

/* 8 points from 0, 8 from 22.5 degrees. */
static const DiscRule ring16 = {
    16,
    {0.45970084f, 0.32505758f, 0.00000000f, -0.32505758f, -0.45970084f, -0.32505758f, -0.00000000f, 0.32505758f,
     0.82047324f, 0.33985114f, -0.33985114f, -0.82047324f, -0.82047324f, -0.33985114f, 0.33985114f, 0.82047324f},
    {0.00000000f, 0.32505758f, 0.45970084f, 0.32505758f, 0.00000000f, -0.32505758f, -0.45970084f, -0.32505758f,
     0.33985114f, 0.82047324f, 0.82047324f, 0.33985114f, -0.33985114f, -0.82047324f, -0.82047324f, -0.33985114f},
    {0.06250000f, 0.06250000f, 0.06250000f, 0.06250000f, 0.06250000f, 0.06250000f, 0.06250000f, 0.06250000f,
     0.06250000f, 0.06250000f, 0.06250000f, 0.06250000f, 0.06250000f, 0.06250000f, 0.06250000f, 0.06250000f}};

/* The cells of a 4 × 4 grid over [-1, 1]² whose centres lie in the disc: 12 of 16, as in Neyret 1998 fig. 5. */
static const DiscRule grid16 = {
    12,
    {-0.25000000f, 0.25000000f, -0.75000000f, -0.25000000f, 0.25000000f, 0.75000000f, -0.75000000f, -0.25000000f,
     0.25000000f, 0.75000000f, -0.25000000f, 0.25000000f},
    {-0.75000000f, -0.75000000f, -0.25000000f, -0.25000000f, -0.25000000f, -0.25000000f, 0.25000000f, 0.25000000f,
     0.25000000f, 0.25000000f, 0.75000000f, 0.75000000f},
    {0.08333333f, 0.08333333f, 0.08333333f, 0.08333333f, 0.08333333f, 0.08333333f, 0.08333333f, 0.08333333f,
     0.08333333f, 0.08333333f, 0.08333333f, 0.08333333f}};

/* The lit lune: the part of the hemisphere over the disc that the light reaches, between two half planes through the axis that is
 * square to both eye and light. Three of Legendre's points in the sine of the latitude, five in the longitude; nearly exact for
 * a sphere, whose integrand is cos² latitude · cos φ · cos(φ − light). */
static void add_lune(DiscRule *rule, float from, float to) {
    static const float sine[3] = {-0.77459667f, 0, 0.77459667f}, cosine[3] = {0.63245553f, 1, 0.63245553f};
    static const float height[3] = {0.35136418f, 0.88888889f, 0.35136418f}; /* Legendre's weights · cosine: what the disc makes of the area */
    static const float node[5] = {0.04691008f, 0.23076534f, 0.5f, 0.76923466f, 0.95308992f};
    static const float width[5] = {0.11846344f, 0.23931434f, 0.28444444f, 0.23931434f, 0.11846344f};
    for (int j = 0; j < 5; j++) {
        float phi = from + (to - from) * node[j], weight = (to - from) * width[j] * cosf(phi) / (float)VTS_PI;
        for (int i = 0; i < 3; i++) {
            rule->x[rule->count] = cosine[i] * sinf(phi);
            rule->y[rule->count] = sine[i];
            rule->weight[rule->count++] = height[i] * weight;
        }
    }
}

/* The light is `angle` from the eye on the hemisphere, towards +x; `both`: what is lit from behind as well. */
static void lay_lunes(DiscRule *rule, float angle, bool both) {
    const float quarter = (float)VTS_PI / 2;
    rule->count = 0;
    add_lune(rule, angle - quarter, quarter);
    if (both) add_lune(rule, -quarter, angle - quarter);
}

static const DiscRule *rule_of(Quadrature quadrature) {
    return quadrature == QUADRATURE_RING16 ? &ring16 : quadrature == QUADRATURE_GRID16 ? &grid16 : &ring8;
}

/* x^e for x in [0, 1] where a lobe needs no more than three digits. */
static float lobe_power(float x, float e) { return x > 0 ? expf(e * logf(x)) : 0; }

static float highlight(float n_h, float r_l, float facing, const SheetLook *look) {
    float sum = 0;
    if (look->specular > 0) sum += look->specular * lobe_power(n_h, look->inverse_roughness);
    if (look->phong > 0) sum += look->phong * lobe_power(r_l, look->phong_size);
    return facing > 0 ? sum : 0;
}

Vec3f sheet_normal(Vec3f normal, Vec3f flat, Vec3f view) {
    if (vec3f_dot(flat, view) < 0) normal = vec3f_scale(normal, -1), flat = vec3f_scale(flat, -1);
    float n_v = vec3f_dot(normal, view);
    Vec3f on_rim = n_v < 0 ? vec3f_normalize(vec3f_madd(normal, view, -n_v)) : normal;
    return vec3f_dot(on_rim, on_rim) > 0.5f ? on_rim : flat;
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

/* Turns the disc about the view so that its first axis points towards the light as the ellipsoid sees it: the rings then meet
 * the terminator alike however the matter is stretched. */
static void turn_to_light(VisibleNormals *visible, Vec3f light) {
    float x = vec3f_dot(visible->m[0], light), y = vec3f_dot(visible->m[1], light);
    float length = sqrtf(x * x + y * y);
    if (!(length > 1e-6f)) return;
    float c = x / length, s = y / length;
    Vec3f first = vec3f_madd(vec3f_scale(visible->m[0], c), visible->m[1], s);
    visible->m[1] = vec3f_madd(vec3f_scale(visible->m[1], c), visible->m[0], -s);
    visible->m[0] = first;
}

NdfShade ndf_shade(Quadrature quadrature, const Sym3f *s, Vec3f view, Vec3f light, const SheetLook *look) {
    VisibleNormals visible = visible_normals(s, view);
    turn_to_light(&visible, light);
    /* One row of dot products for the normals, then plain loops over the points. */
    float nl[3], nv[3], norm[6];
    for (int i = 0; i < 3; i++) {
        nl[i] = vec3f_dot(visible.m[i], light);
        nv[i] = vec3f_dot(visible.m[i], view);
    }
    DiscRule lunes;
    if (quadrature == QUADRATURE_LUNE) lay_lunes(&lunes, atan2f(nl[0], nl[2]), look->transmission > 0);
    const DiscRule *rule = quadrature == QUADRATURE_LUNE ? &lunes : rule_of(quadrature);
    norm[0] = vec3f_dot(visible.m[0], visible.m[0]);
    norm[1] = vec3f_dot(visible.m[1], visible.m[1]);
    norm[2] = vec3f_dot(visible.m[2], visible.m[2]);
    norm[3] = 2 * vec3f_dot(visible.m[0], visible.m[1]);
    norm[4] = 2 * vec3f_dot(visible.m[0], visible.m[2]);
    norm[5] = 2 * vec3f_dot(visible.m[1], visible.m[2]);
    float cos_light[MOST_POINTS], cos_view[MOST_POINTS];
    for (int i = 0; i < rule->count; i++) {
        float x = rule->x[i], y = rule->y[i], z = sqrtf(float_max(0, 1 - x * x - y * y));
        float inverse = 1 / sqrtf(float_max(norm[0] * x * x + norm[1] * y * y + norm[2] * z * z + norm[3] * x * y +
                                                norm[4] * x * z + norm[5] * y * z, 1e-30f));
        cos_light[i] = (x * nl[0] + y * nl[1] + z * nl[2]) * inverse;
        cos_view[i] = (x * nv[0] + y * nv[1] + z * nv[2]) * inverse;
    }
    float front = 0, back = 0;
    for (int i = 0; i < rule->count; i++) {
        float lit = cos_light[i] > 0 ? cos_light[i] : 0;
        front += rule->weight[i] * (look->brilliance == 1 ? lit : lobe_power(lit, look->brilliance));
        back += rule->weight[i] * (cos_light[i] < 0 ? -cos_light[i] : 0);
    }
    NdfShade out = {look->diffuse * front + look->transmission * back, 0};
    if (look->specular > 0 || look->phong > 0) {
        /* n · half = (n·view + n·light) / |view + light|;  mirrored · light = 2 (n·view)(n·light) − view·light */
        float view_light = vec3f_dot(view, light);
        float inverse_half = 1 / sqrtf(float_max(2 + 2 * view_light, 1e-12f));
        for (int i = 0; i < rule->count; i++)
            out.highlight += rule->weight[i] * highlight((cos_view[i] + cos_light[i]) * inverse_half,
                                                         2 * cos_view[i] * cos_light[i] - view_light, cos_light[i], look);
    }
    return out;
}
