/* Normals under the mapping (Neyret 1998, Fig. 11): a layer that is sheared, bent and stretched 1:5, whose light is known from S' = cof(A) S cof(A)ᵗ,
 * A being the mapping's derivative; A S Aᵗ and S itself are shown to be far off. */
#include "analytic.h"

enum { CELLS = 24, TILES = 8 };
static const double LAYER = 0.2, SLOPE = 0.5, DIFFUSE = 0.6;

/* Tents: y = 0.25 + SLOPE·(distance of x from whole numbers + that of z). Nothing hides anything from above. */
static const char scene_text[] =
    "global_settings { %s }\n"
    "camera { orthographic location <0, 9, 0> direction <0, -1, 0> right 0.6*x up 3*z }\n"
    "background { rgb 0 }\n"
    "light_source { <%g, %g, %g>, rgb 1 parallel point_at 0 shadowless }\n"
    "#declare Roof = function(x, z) { 0.25 + 0.5*(min(x, 1 - x) + min(z, 1 - z)) }\n"
    "#declare Tents = texel { resolution 64 cyclic x + z layer { mesh { #for (I, 0, 1) #for (J, 0, 1)\n"
    "    #local P00 = <I/2, Roof(I/2, J/2), J/2>; #local P10 = <(I + 1)/2, Roof((I + 1)/2, J/2), J/2>;\n"
    "    #local P01 = <I/2, Roof(I/2, (J + 1)/2), (J + 1)/2>; #local P11 = <(I + 1)/2, Roof((I + 1)/2, (J + 1)/2), (J + 1)/2>;\n"
    "    triangle { P00, P10, P11 } triangle { P00, P11, P01 } #end #end }\n"
    "  texture { pigment { rgb 1 } finish { ambient %g diffuse %g } } } }\n"
    "#declare N = 24;\n"
    "#declare P = array[N + 1][N + 1];\n"
    "#declare H = array[N + 1][N + 1];\n"
    "#for (I, 0, N) #for (J, 0, N)\n"
    "  #local U = I/N - 0.5; #local V = J/N - 0.5;\n"
    "  #declare P[I][J] = <U, 0.8*U*U + 0.1*sin(6*V), 5*V>;\n"
    "  #declare H[I][J] = <0.5 + 0.4*V, 1 + 0.5*U, 0.9 - U>;\n"
    "#end #end\n"
    "skin { surface { patch_grid N, N points P height_vectors H } texel { Tents } mapping { repeat <8, 8> height 0.2 } }\n";

/* The same mapping: (x, y, z) of a texel that is spread over the whole surface, and its derivative. */
static Vec3 mapped(Vec3 p, Mat3 *derivative) {
    double u = p.x / TILES - 0.5, v = p.z / TILES - 0.5, h = LAYER * p.y;
    Vec3 height = vec3(0.5 + 0.4 * v, 1 + 0.5 * u, 0.9 - u);
    derivative->c[0] = vec3_scale(vec3(1, 1.6 * u + 0.5 * h, -h), 1.0 / TILES);
    derivative->c[1] = vec3_scale(height, LAYER);
    derivative->c[2] = vec3_scale(vec3(0.4 * h, 0.6 * cos(6 * v), 5), 1.0 / TILES);
    return vec3_madd(vec3(u, 0.8 * u * u + 0.1 * sin(6 * v), 5 * v), height, h);
}

typedef enum NormalRule { BY_COFACTOR, BY_DERIVATIVE, UNTRANSFORMED, NORMAL_RULES } NormalRule;
static const char *const rule_names[NORMAL_RULES] = {"cof(A) S cof(A)'", "A S A'", "S"};

static Vec3 apply(const Mat3 *m, Vec3 v) { return vec3_madd(vec3_madd(vec3_scale(m->c[0], v.x), m->c[1], v.y), m->c[2], v.z); }

static double lambert(Vec3 n, Vec3 light) {
    n = vec3_normalize(n.y < 0 ? vec3_negate(n) : n);
    return fmax(0, vec3_dot(n, light));
}

/* The mean light of what the camera sees, if normals went by each rule: over the sheet, weighted by its area as seen from above. */
static void predict(Vec3 light, double mean[NORMAL_RULES]) {
    enum { STEPS = 64 * TILES };
    double sum[NORMAL_RULES] = {0}, weight = 0;
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < STEPS; j++) {
            double x = (i + 0.5) * TILES / STEPS, z = (j + 0.5) * TILES / STEPS, fx = x - floor(x), fz = z - floor(z);
            double along_x = fx < 0.5 ? SLOPE : -SLOPE, along_z = fz < 0.5 ? SLOPE : -SLOPE;
            Mat3 a;
            Vec3 n = vec3(-along_x, 1, -along_z), at = mapped(vec3(x, 0.25 + SLOPE * (fmin(fx, 1 - fx) + fmin(fz, 1 - fz)), z), &a);
            if (fabs(at.x) > 0.3 || fabs(at.z) > 1.5) continue;
            Mat3 cofactor = mat3_cofactor(&a);
            Vec3 normal[NORMAL_RULES] = {apply(&cofactor, n), apply(&a, n), n};
            double area = fabs(normal[BY_COFACTOR].y);
            for (int k = 0; k < NORMAL_RULES; k++) sum[k] += area * lambert(normal[k], light);
            weight += area;
        }
    for (int k = 0; k < NORMAL_RULES; k++) mean[k] = sum[k] / weight;
}

static Picture draw_text(const Bench *b, const char *text, int samples, bool reference) {
    VtsOptions o = options_of_size(64, 64);
    o.reference_samples = samples;
    bench_write(b, text);
    VtsSession *session = vts_session_create(&o, NULL);
    assert_non_null(session);
    VtsStatus status = reference ? vts_reference(session, b->scene, b->output) : vts_render(session, b->scene, b->output);
    if (status != VTS_OK) fputs(vts_diagnostics(session), stdout);
    assert_int_equal(status, VTS_OK);
    vts_session_destroy(session);
    return picture_read(b->output);
}

static Picture draw(const Bench *b, const char *setting, bool reference, Vec3 light, bool lit) {
    static char text[4096];
    const int samples = 16;
    snprintf(text, sizeof text, scene_text, setting, light.x, light.y, light.z, lit ? 0.0 : 1.0, lit ? DIFFUSE : 0.0);
    return draw_text(b, text, samples, reference);
}

/* Where matter that glows covers pixels, what the lit one is to it: its light. */
static double mean_light(const Bench *b, const char *setting, bool reference, Vec3 light) {
    Picture lit = draw(b, setting, reference, light, true), glowing = draw(b, setting, reference, light, false);
    double cover = picture_mean(&glowing), result = picture_mean(&lit) / (DIFFUSE * cover);
    assert_true(cover > 0.9 && cover < 1.001);
    picture_free(&lit);
    picture_free(&glowing);
    return result;
}

/* What may be off; a wrong rule is off by four times as much. */
static const double GEOMETRY_BOUND = 0.005, VOXEL_BOUND = 0.02;

static void normals_go_by_the_cofactor(void **state) {
    static const Vec3 lights[] = {{30, 20, 0}, {-30, 20, 0}, {0, 15, 30}, {0, 15, -30}, {20, 15, -20}};
    double far[NORMAL_RULES] = {0};
    int bad = 0;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(lights); i++) {
        double rule[NORMAL_RULES];
        predict(vec3_normalize(lights[i]), rule);
        double exact = mean_light(*state, "detail exact", true, lights[i]), beams = mean_light(*state, "detail exact", false, lights[i]);
        double voxels = mean_light(*state, "detail voxels", false, lights[i]);
        printf("light from <%g, %g, %g>: reference %.4f, beams %.4f, voxels %.4f;", lights[i].x, lights[i].y, lights[i].z, exact, beams, voxels);
        for (int k = 0; k < NORMAL_RULES; k++) {
            printf(" %s %.4f", rule_names[k], rule[k]);
            far[k] = fmax(far[k], fabs(rule[k] - exact));
        }
        printf("\n");
        bad += fabs(exact - rule[BY_COFACTOR]) > GEOMETRY_BOUND || fabs(beams - exact) > GEOMETRY_BOUND || fabs(voxels - exact) > VOXEL_BOUND;
    }
    assert_int_equal(bad, 0);
    assert_true(far[BY_DERIVATIVE] > 4 * VOXEL_BOUND && far[UNTRANSFORMED] > 4 * VOXEL_BOUND);
}

/* ---- what is rounder than its triangles ---- */

/* The middle of a glossy ball, leant over and squashed by its layer, or by a matrix. */
static const char ball_text[] =
    "camera { orthographic location <0.8, 4, -3> direction <0, -3.65, 3.6> right 0.3*x up 0.3*vnormalize(vcross(<0, -3.65, 3.6>, x)) }\n"
    "light_source { <-20, 30, -25>, rgb 1 parallel point_at 0 shadowless }\n"
    "#declare Shine = texture { pigment { rgb 0.5 } finish { ambient 0.1 diffuse 0.5 phong 0.9 phong_size 40 } }\n"
    "#if (%d)\n"
    "  sphere { <0.5, 0.5, 0.5>, 0.4 texture { Shine } matrix <1, 0, 0, 0.6, 0.7, 0.2, 0, 0, 1, 0, 0, 0> }\n"
    "#else\n"
    "  global_settings { detail exact }\n"
    "  #declare Foot = array[2][2] { { <0, 0, 0>, <0, 0, 1> }, { <1, 0, 0>, <1, 0, 1> } }\n"
    "  #declare Lean = array[2][2] { { <0.6, 0.7, 0.2>, <0.6, 0.7, 0.2> }, { <0.6, 0.7, 0.2>, <0.6, 0.7, 0.2> } }\n"
    "  #declare Ball = texel { layer { sphere { <0.5, 0.5, 0.5>, 0.4 } texture { Shine } } }\n"
    "  skin { surface { patch_grid 1, 1 points Foot height_vectors Lean } texel { Ball } mapping { repeat <1, 1> height 1 } }\n"
    "#end\n";

static Picture draw_ball(const Bench *b, bool explicitly, bool reference) {
    static char text[4096];
    const int samples = 4;
    snprintf(text, sizeof text, ball_text, explicitly);
    return draw_text(b, text, samples, reference);
}

static void balls_shine_as_round_ones(void **state) {
    Picture sphere = draw_ball(*state, true, false), beams = draw_ball(*state, false, false), exact = draw_ball(*state, false, true);
    Difference of_beams = picture_difference(&beams, &sphere), of_reference = picture_difference(&exact, &sphere);
    printf("a glossy ball, against a sphere: beams %.4f (at most %.3f), reference %.4f (%.3f)\n", of_beams.rms, of_beams.most, of_reference.rms, of_reference.most);
    assert_true(of_beams.rms < 0.002 && of_reference.rms < 0.002);
    picture_free(&sphere);
    picture_free(&beams);
    picture_free(&exact);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test_setup_teardown(normals_go_by_the_cofactor, bench_set_up, bench_tear_down),
                                       cmocka_unit_test_setup_teardown(balls_shine_as_round_ones, bench_set_up, bench_tear_down)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
