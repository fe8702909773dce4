/* Closed solids in texels: where their inside is, that it is opaque at every scale, and mixtures of normals at their limits. */
#include "texel_measures.h"

#include "texel/voxel_cell.h"
#include "texel/voxel_fill.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void append(TestMesh *m, TestMesh part) {
    uint32_t first = (uint32_t)m->vertex_count;
    for (size_t i = 0; i < part.vertex_count; i++) scene_vertex(m, vec3_from_f(part.vertices[i]));
    for (size_t i = 0; i < part.triangle_count; i++) {
        const uint32_t *t = part.triangles[i];
        scene_triangle(m, first + t[0], first + t[1], first + t[2], part.solid[i]);
    }
    scene_free(&part);
}

/* ---- where the inside is ---- */

typedef struct Ball {
    Vec3 middle;
    double radius;
} Ball;

/* Share of the finest voxels' middles for which the builder and the balls disagree, not nearer to a surface than `margin`. */
static double wrong_middles(const TestMesh *mesh, const Ball *balls, int count, unsigned cyclic,
                            double margin) {
    enum { SIDE = 32 };
    TexelMesh view = scene_view(mesh);
    TexelBuildOptions options = {.resolution = SIDE, .extent = {1, 1, 1}, .cyclic = cyclic};
    VoxelLayer *layer = voxel_layer_create(&options);
    VoxelFill fill;
    assert_true(voxel_fill_build(&fill, &view, layer, NULL));
    int wrong = 0;
    for (int v = 0; v < SIDE * SIDE * SIDE; v++) {
        const int at[3] = {v % SIDE, v / SIDE % SIDE, v / SIDE / SIDE};
        double nearest = 1e9;
        for (int i = 0; i < count; i++) {
            double d[3], m[3] = {balls[i].middle.x, balls[i].middle.y, balls[i].middle.z};
            for (int k = 0; k < 3; k++) {
                d[k] = (at[k] + .5) / SIDE - m[k];
                if (cyclic >> k & 1) d[k] -= floor(d[k] + .5);
            }
            nearest = fmin(nearest, sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) - balls[i].radius);
        }
        bool inside = voxel_fill_column(&fill, at[0], at[1] & ~7, at[2]) >> (at[1] & 7) & 1;
        if (fabs(nearest) > margin) wrong += inside != (nearest < 0);
    }
    voxel_fill_free(&fill, NULL);
    voxel_layer_destroy(layer);
    return wrong / (double)(SIDE * SIDE * SIDE);
}

static void test_insides_are_found(void **state) {
    (void)state;
    const Ball balls[] = {{{.4, .5, .45}, .3}, {{.6, .45, .6}, .25}, {{.95, .02, .98}, .2}};
    TestMesh mesh = {0};
    for (int i = 0; i < 2; i++)
        append(&mesh, scene_sphere(balls[i].middle, balls[i].radius, 48)); /* one through the other */
    assert_true(wrong_middles(&mesh, balls, 2, 0, .01) == 0);
    append(&mesh, scene_sphere(balls[2].middle, balls[2].radius, 48)); /* over the edges of the texel */
    assert_true(wrong_middles(&mesh, balls, 3, TEXEL_CYCLIC_X | TEXEL_CYCLIC_Y | TEXEL_CYCLIC_Z, .01) == 0);
    assert_true(wrong_middles(&mesh, balls, 3, TEXEL_CYCLIC_X, .01) == 0); /* cut off along y and z */
    for (size_t i = 0; i < mesh.triangle_count; i++) {                     /* inside out */
        uint32_t swap = mesh.triangles[i][1];
        mesh.triangles[i][1] = mesh.triangles[i][2];
        mesh.triangles[i][2] = swap;
    }
    assert_true(wrong_middles(&mesh, balls, 3, 7, .01) == 0);
    scene_free(&mesh);
}

/* A solid that is not closed after all has no inside below its hole, and nothing runs out of the texel. */
static void test_holes_hold_nothing(void **state) {
    (void)state;
    TestMesh mesh = scene_box(vec3(.2, .2, .2), vec3(.8, .8, .8));
    mesh.triangle_count -= 12;
    append(&mesh, scene_box(vec3(.2, .2, .2), vec3(.8, .8, .8)));
    size_t kept = 0;
    for (size_t i = 0; i < mesh.triangle_count; i++) { /* without its lid */
        bool lid = true;
        for (int k = 0; k < 3; k++) lid = lid && mesh.vertices[mesh.triangles[i][k]].y > .7f;
        if (!lid) memmove(mesh.triangles[kept++], mesh.triangles[i], sizeof *mesh.triangles);
    }
    assert_int_equal(kept, 10);
    mesh.triangle_count = kept;
    assert_true(wrong_middles(&mesh, NULL, 0, 0, .01) == 0);
    mesh.vertices[3].x = NAN;
    mesh.vertices[5].y = 3e38f;
    wrong_middles(&mesh, NULL, 0, 7, .01);
    scene_free(&mesh);
}

/* ---- that it is opaque ---- */

static void test_solids_are_opaque_at_all_levels(void **state) {
    (void)state;
    RandomStream r = {3};
    TestMesh meshes[] = {scene_sphere(vec3(.5, .5, .5), .4, 48),
                         scene_box(vec3(.125, .25, .25), vec3(.75, .75, .875)),
                         scene_cylinder(vec3(.3, .1, .4), vec3(.7, .9, .6), .2, 32)};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(meshes); i++) {
        TexelMesh view = scene_view(&meshes[i]);
        TexelBuildOptions options = {.resolution = 128, .extent = {1, 1, 1}};
        VoxelLayer *layer = voxel_layer_build(&view, &options, NULL);
        for (int level = 0; level < 6; level++) {
            float h = (float)(1 << level) / 128;
            double worst = 0, clear = 1;
            for (int k = 0; k < 300; k++) {
                Vec3 d = scene_direction(&r);
                worst = fmax(worst, scene_march(layer, (float)level, OPACITY_CORRELATED, h, vec3(.5, .5, .5),
                                                d, (double)h / 2));
                Vec3 beside = vec3((double)h / 8, random_next_unit(&r),
                                   (double)h / 8); /* along the edge of the texel */
                clear = fmin(clear, scene_march(layer, (float)level, OPACITY_CORRELATED, h, beside,
                                                vec3(0, 1, 0), (double)h / 2));
            }
            print_message("solid %zu, voxels of %.3f: lets %.4f through at most, %.4f beside it\n", i,
                          (double)h, worst, clear);
            if (level < 6 - (int)i)
                assert_true(worst < .005); /* a slanted stem is so from six voxels' thickness on */
            if (level < 3) assert_true(clear == 1);
        }
        voxel_layer_destroy(layer);
        scene_free(&meshes[i]);
    }
}

/* Only next to walls the inside is stored: voxels grow with the surface, not with the volume. */
static void test_the_deep_inside_is_not_stored(void **state) {
    (void)state;
    TestMesh mesh = scene_box(vec3(.05, .05, .05), vec3(.95, .95, .95));
    TexelMesh view = scene_view(&mesh);
    size_t inside[2] = {0};
    for (int i = 0; i < 2; i++) {
        TexelBuildOptions options = {.resolution = 64 << i, .extent = {1, 1, 1}};
        VoxelLayer *layer = voxel_layer_build(&view, &options, NULL);
        const VoxelLevel *finest = &layer->level[0];
        for (size_t k = 0; k < finest->code_count; k++) inside[i] += voxel_code_is_inside(finest->codes[k]);
        assert_true(inside[i] > 0 && inside[i] < 3 * (finest->code_count - inside[i]));
        voxel_layer_destroy(layer);
    }
    print_message("inside: %zu voxels at 64³, %zu at 128³\n", inside[0], inside[1]);
    assert_true(inside[1] < 5 * inside[0]);
    scene_free(&mesh);
}

/* ---- mixtures of normals ---- */

typedef struct Facet {
    Vec3 normal; /* of a sheet; the axis of a needle */
    bool needle;
} Facet;

static void add_facet(VoxelCell *cell, const Facet *f, float area) {
    Vec3 n = f->normal;
    double m[6] = {n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.x * n.z, n.y * n.z};
    for (int k = 0; k < 6 && f->needle; k++) m[k] = ((k < 3) - m[k]) / 2; /* its normals are all around it */
    cell->sheet += area;
    for (int k = 0; k < 6; k++) cell->normals[k] += area * (float)m[k];
}

/* Projected area of the mixture and of its voxel, relative to the mean: rms, mean (`total`) and largest difference over
 * directions. */
static AreaError mixture_error(const Facet *facets, int count) {
    VoxelCell cell = {.sheet = 0};
    for (int i = 0; i < count; i++) add_facet(&cell, &facets[i], 1.0f / (float)count);
    const float sides[3] = {1, 1, 1};
    VoxelMatter m = voxel_cell_matter(&cell, &(VoxelSurround){0}, sides, 1, 0, true);
    AreaError e = {0};
    for (int k = 0; k < MEASURE_DIRECTIONS * 4; k++) {
        Vec3 d = scene_spread_direction(k, MEASURE_DIRECTIONS * 4);
        double truth = 0;
        for (int i = 0; i < count; i++) {
            double c = vec3_dot(facets[i].normal, d);
            truth += (facets[i].needle ? sqrt(fmax(0, 1 - c * c)) * 4 / VTS_PI : 2 * fabs(c)) /
                     count; /* of mean 1 */
        }
        Vec3f w = vec3f_from(d), b = vec3f(m.root.xx * w.x + m.root.xy * w.y + m.root.xz * w.z,
                                           m.root.xy * w.x + m.root.yy * w.y + m.root.yz * w.z,
                                           m.root.xz * w.x + m.root.yz * w.y + m.root.zz * w.z);
        double error = (double)vec3f_length(b) * (double)m.density * 2 - truth;
        e.rms += error * error / (MEASURE_DIRECTIONS * 4);
        e.total += fabs(error) / (MEASURE_DIRECTIONS * 4);
        e.worst = fmax(e.worst, fabs(error));
    }
    e.rms = sqrt(e.rms);
    return e;
}

/* Two facets at an angle θ: the mean error falls nearly with θ² (Neyret 1998 sec. IV-C; θ² ln 1/θ), and at a right angle it is bounded. */
static void test_two_facets(void **state) {
    (void)state;
    double last = 0;
    for (double angle = 90; angle > 5; angle /= 2) {
        double half = angle / 2 * VTS_RADIANS;
        const Facet pair[2] = {{vec3(sin(half), cos(half), 0), false},
                               {vec3(-sin(half), cos(half), 0), false}};
        AreaError e = mixture_error(pair, 2);
        print_message("two facets at %4.1f degrees: mean %.4f, rms %.4f, worst %.4f\n", angle, e.total, e.rms,
                      e.worst);
        if (angle == 90)
            assert_true(e.rms < .105 && e.worst < .26);
        else if (angle < 20)
            assert_true(e.total < last / 2.2 || e.total < .007); /* roughness .01 is the floor */
        last = e.total;
    }
}

static void test_mixtures(void **state) {
    (void)state;
    static const struct {
        const char *name;
        int discs, needles;
        double limit; /* of the rms over mixtures */
    } kinds[] = {{"a disc", 1, 0, .012},     {"a needle", 0, 1, .012},    {"two discs", 2, 0, .09},
                 {"eight discs", 8, 0, .07}, {"two needles", 0, 2, .045}, {"eight needles", 0, 8, .03},
                 {"four of each", 4, 4, .05}};
    RandomStream r = {6};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(kinds); k++) {
        double sum = 0;
        enum { MIXTURES = 400 };
        for (int i = 0; i < MIXTURES; i++) {
            Facet facets[16];
            int count = kinds[k].discs + kinds[k].needles;
            for (int f = 0; f < count; f++) facets[f] = (Facet){scene_direction(&r), f >= kinds[k].discs};
            AreaError e = mixture_error(facets, count);
            assert_true(isfinite(e.rms));
            sum += e.rms * e.rms / MIXTURES;
        }
        print_message("%-14s rms %.4f\n", kinds[k].name, sqrt(sum));
        assert_true(sqrt(sum) < kinds[k].limit);
    }
}

/* Nothing at all, and normals that are nearly nothing. */
static void test_zero_matrices(void **state) {
    (void)state;
    const float sides[3] = {1, 1, 1};
    for (int i = 0; i < 4; i++) {
        VoxelCell cell = {.sheet = i & 1 ? 1e-30f : 1, .normals = {i & 2 ? 1e-30f : 1e-38f, 0, 0, 0, 0, 0}};
        VoxelMatter m = voxel_cell_matter(&cell, &(VoxelSurround){0}, sides, 1, 1, true);
        VoxelCode code = voxel_code_pack(m.density, m.gamma, &m.root);
        VoxelSample v;
        voxel_code_unpack(code, &v);
        assert_true(isfinite(v.density) && isfinite(v.gamma) && isfinite(v.s.xx) && isfinite(v.s.yz));
        assert_true(opacity_transmittance(OPACITY_CORRELATED, &v, 1, vec3f(.1f, .2f, .3f)) > 0);
    }
    VoxelSample none = {0};
    for (int m = 0; m < MEASURE_MODELS; m++)
        assert_true(opacity_transmittance(measure_models[m], &none, 1, vec3f(1e30f, 0, 0)) == 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_insides_are_found),
        cmocka_unit_test(test_holes_hold_nothing),
        cmocka_unit_test(test_solids_are_opaque_at_all_levels),
        cmocka_unit_test(test_the_deep_inside_is_not_stored),
        cmocka_unit_test(test_two_facets),
        cmocka_unit_test(test_mixtures),
        cmocka_unit_test(test_zero_matrices),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
