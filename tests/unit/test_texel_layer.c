/* Building voxels: area and projected area against the exact surface, determinism, degenerate content. */
#include "texel_measures.h"

#include "texel/voxel_layer.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <cmocka.h>

static VoxelLayer *build(const TestMesh *mesh, TexelBuildOptions options, TexelBuildStats *stats) {
    TexelMesh view = scene_view(mesh);
    if (!(options.extent.x > 0)) options.extent = vec3f(1, 1, 1);
    return voxel_layer_build(&view, &options, stats);
}

/* Largest rms error allowed at the finest level and at any, and of any single direction at the finest. */
static void check_areas(const char *name, TestMesh mesh, int resolution, double walls, double finest,
                        double any, double direction) {
    TexelBuildStats stats;
    VoxelLayer *layer = build(&mesh, (TexelBuildOptions){.resolution = resolution}, &stats);
    assert_non_null(layer);
    for (int level = 0; level < stats.levels; level++) {
        AreaError e = measure_area_error(layer, level, &mesh, walls);
        print_message("%-16s %4d³ total %+.4f, directions rms %.4f worst %.4f\n", name,
                      stats.size[0] >> level, e.total, e.rms, e.worst);
        assert_true(e.rms < (level == 0 ? finest : any));
        if (level == 0) assert_true(e.worst < direction);
    }
    voxel_layer_destroy(layer);
    scene_free(&mesh);
}

static void test_projected_area_of_leaves(void **state) {
    (void)state;
    check_areas("600 leaves", scene_leaves(600, .035, 1), 64, .5, .005, .02, .01);
    check_areas("60 leaves", scene_leaves(60, .05, 2), 64, .5, .005, .05, .01);
    check_areas("sheet", scene_sheet(vec3(0, 0, 1), .45), 64, .5, .01, .01, .02);
    check_areas("tilted sheet", scene_sheet(vec3_normalize(vec3(.3, .2, .93)), .4), 64, .5, .01, .01, .02);
}

/* Thin blades neither vanish nor fatten, from any direction, at any level. */
static void test_projected_area_of_grass(void **state) {
    (void)state;
    check_areas("grass 64", scene_grass(300, .6, .012, 3), 64, .5, .01, .03, .02);
    check_areas("grass 128", scene_grass(300, .6, .006, 4), 128, .5, .01, .03, .02);
}

/* The walls of thick solids each count at fine levels (each must be able to be opaque alone). */
static void test_walls_of_thick_solids_stand_alone(void **state) {
    (void)state;
    TestMesh meshes[] = {scene_sphere(vec3(.5, .5, .5), .4, 48),
                         scene_box(vec3(.23, .31, .17), vec3(.71, .77, .83))};
    const double limits[] = {.005, .03}; /* at 8³ the box is mostly edges */
    for (size_t i = 0; i < VTS_ARRAY_COUNT(meshes); i++) {
        VoxelLayer *layer = build(&meshes[i], (TexelBuildOptions){.resolution = 64}, NULL);
        for (int level = 0; level < 4; level++) {
            AreaError e = measure_area_error(layer, level, &meshes[i], 1);
            print_message("solid %zu level %d: total %+.4f, directions rms %.4f worst %.4f\n", i, level,
                          e.total, e.rms, e.worst);
            assert_true(fabs(e.total) < .01);
            assert_true(e.rms < limits[i]);
        }
        /* And as a whole, in one voxel, the silhouette counts once. */
        AreaError e = measure_area_error(layer, 6, &meshes[i], .5);
        print_message("solid %zu in one voxel: total %+.4f, directions rms %.4f\n", i, e.total, e.rms);
        assert_true(fabs(e.total) < .02);
        assert_true(e.rms < .105); /* a box is no ellipsoid */
        voxel_layer_destroy(layer);
        scene_free(&meshes[i]);
    }
}

/* A closed cylinder thinner than a voxel is seen once, not once for each wall, wherever the grid cuts it. */
static void test_thin_solids_count_once(void **state) {
    (void)state;
    const double radius[] = {.004, .0008}; /* 0.5 and 0.1 voxels across at 64³ */
    const double limits[] = {.024, .024};
    for (int i = 0; i < 2; i++) {
        TestMesh mesh = scene_cylinder(vec3(.2, .1, .3), vec3(.7, .9, .6), radius[i], 12);
        VoxelLayer *layer = build(&mesh, (TexelBuildOptions){.resolution = 64}, NULL);
        for (int level = 0; level < 7; level++) {
            AreaError e = measure_area_error(layer, level, &mesh, .5);
            print_message("cylinder of %.2f voxels, level %d: total %+.4f, directions rms %.4f worst %.4f\n",
                          radius[i] * 128, level, e.total, e.rms, e.worst);
            assert_true(e.rms < (level < 2 ? limits[i] : .025));
        }
        voxel_layer_destroy(layer);
        scene_free(&mesh);
    }
}

static double total_area(const VoxelLayer *layer, int level) {
    double seen[MEASURE_DIRECTIONS];
    return measure_area(layer, level, seen);
}

static void test_area_is_conserved_and_cut(void **state) {
    (void)state;
    TestMesh mesh = {0};
    scene_leaf(&mesh, vec3(0, .5, 1), vec3_normalize(vec3(.2, 1, .3)), .2); /* over an edge of the extent */
    const double exact = 1.5 * sqrt(3.0) * .2 * .2 / 2;                     /* half the hexagon's area */
    const struct {
        unsigned cyclic;
        double share;
    } cases[] = {
        {TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z, 1}, {TEXEL_CYCLIC_X, .5}, {TEXEL_CYCLIC_Z, .5}, {0, .25}, {7, 1}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        VoxelLayer *layer =
            build(&mesh, (TexelBuildOptions){.resolution = 32, .cyclic = cases[i].cyclic}, NULL);
        for (int level = 0; level < 6; level++)
            assert_true(fabs(total_area(layer, level) / (exact * cases[i].share) - 1) <
                        (cases[i].share < .5 ? .06 : .01));
        voxel_layer_destroy(layer);
    }
    scene_free(&mesh);
}

/* Content far outside lies in the extent after whole turns; a triangle may span several extents, and counts once where it lies upon itself. */
static void test_content_wraps(void **state) {
    (void)state;
    TestMesh near = {0}, far = {0}, wide = {0};
    for (int i = 0; i < 2; i++) {
        TestMesh *m = i ? &far : &near;
        double shift = i ? 7 : 0;
        uint32_t a = scene_vertex(m, vec3(.25 + shift, .25, .125)),
                 b = scene_vertex(m, vec3(.75 + shift, .25, .25));
        scene_triangle(m, a, b, scene_vertex(m, vec3(.5 + shift, .75, .5)), false);
    }
    TexelBuildOptions options = {.resolution = 64, .cyclic = TEXEL_CYCLIC_X};
    VoxelLayer *one = build(&near, options, NULL), *other = build(&far, options, NULL);
    assert_true(hash_equal(voxel_layer_hash(one), voxel_layer_hash(other)));
    voxel_layer_destroy(one);
    voxel_layer_destroy(other);
    uint32_t a = scene_vertex(&wide, vec3(-1, .3, .5)), b = scene_vertex(&wide, vec3(2.5, .3, .5));
    scene_triangle(&wide, a, b, scene_vertex(&wide, vec3(0, .8, .5)), false);
    VoxelLayer *layer = build(&wide, options, NULL);
    double once = 0; /* of each height, as wide as the extent at most */
    for (int i = 0; i < 1000; i++) once += .5e-3 * double_min(1, 3.5 * (1 - (i + .5) / 1000));
    double got = total_area(layer, 0) / (once / 2);
    printf("upon itself: %.3f of what is seen\n", got);
    assert_true(got > .99 && got < 1.15); /* but in voxels in which it begins or ends */
    voxel_layer_destroy(layer);
    scene_free(&near);
    scene_free(&far);
    scene_free(&wide);
}

/* Sheets exactly in planes between voxels and bricks, and in the extent's own faces, count once. */
static void test_sheets_in_grid_planes(void **state) {
    (void)state;
    const float planes[] = {0, .125f, .25f, .5f, 1};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(planes); i++)
        for (int axis = 0; axis < 3; axis++) {
            TestMesh m = {0};
            uint32_t v[4];
            for (int k = 0; k < 4; k++) {
                double c[3] = {0, 0, 0};
                c[axis] = (double)planes[i];
                c[(axis + 1) % 3] = k == 1 || k == 2 ? .75 : .25;
                c[(axis + 2) % 3] = k >= 2 ? .75 : .25;
                v[k] = scene_vertex(&m, vec3(c[0], c[1], c[2]));
            }
            scene_quad(&m, v[0], v[1], v[2], v[3], false);
            VoxelLayer *layer = build(&m, (TexelBuildOptions){.resolution = 32}, NULL);
            for (int level = 0; level < 6; level++)
                assert_true(fabs(total_area(layer, level) / .125 - 1) < .01);
            voxel_layer_destroy(layer);
            scene_free(&m);
        }
}

static void test_same_bytes_for_any_threads(void **state) {
    (void)state;
    TestMesh mesh = scene_leaves(700, .04, 5);
    TestMesh solid = scene_sphere(vec3(.1, .5, .95), .3, 24);
    TestMesh *meshes[] = {&mesh, &solid};
    for (int i = 0; i < 2; i++) {
        TexelBuildOptions options = {.resolution = 128, .cyclic = TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z};
        VoxelLayer *layer = build(meshes[i], options, NULL);
        Hash128 expected = voxel_layer_hash(layer);
        voxel_layer_destroy(layer);
        for (int threads = 1; threads <= 3; threads++) {
            options.pool = pool_create(threads);
            layer = build(meshes[i], options, NULL);
            assert_true(hash_equal(voxel_layer_hash(layer), expected));
            voxel_layer_destroy(layer);
            pool_destroy(options.pool);
        }
        scene_free(meshes[i]);
    }
}

static void test_sizes(void **state) {
    (void)state;
    const struct {
        int resolution;
        Vec3f extent;
        int size[3], levels;
    } cases[] = {
        {1, {1, 1, 1}, {1, 1, 1}, 1},
        {2, {1, 1, 1}, {2, 2, 2}, 2},
        {100, {1, .5f, .25f}, {128, 64, 32}, 8},
        {64, {.01f, 1, .3f}, {1, 64, 16}, 7},
        {16, {1, .7f, .72f}, {16, 8, 16}, 5},
        {1024, {.004f, .004f, 1}, {4, 4, 1024}, 11},
    };
    TestMesh mesh = scene_leaves(20, .1, 6);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        TexelBuildStats stats;
        TexelBuildOptions options = {
            .resolution = cases[i].resolution, .extent = cases[i].extent, .cyclic = 7};
        VoxelLayer *layer = build(&mesh, options, &stats);
        assert_non_null(layer);
        assert_int_equal(stats.levels, cases[i].levels);
        double area = total_area(layer, 0);
        for (int k = 0; k < 3; k++) assert_int_equal(stats.size[k], cases[i].size[k]);
        for (int level = 0; level < stats.levels; level++) {
            int size[3];
            voxel_layer_size(layer, level, size);
            for (int k = 0; k < 3; k++) assert_int_equal(size[k], int_max(1, cases[i].size[k] >> level));
            assert_true(fabs(total_area(layer, level) / area - 1) <
                        .015); /* levels keep the area, coded to 0.8 % */
        }
        voxel_layer_destroy(layer);
    }
    scene_free(&mesh);
}

static void test_degenerate_content(void **state) {
    (void)state;
    TestMesh empty = {0}, bad = {0};
    VoxelSample v;
    VoxelLayer *layer = build(&empty, (TexelBuildOptions){.resolution = 64}, NULL);
    assert_non_null(layer);
    assert_false(voxel_layer_sample(layer, 0, vec3f(.5f, .5f, .5f), &v));
    assert_true(voxel_layer_skip(layer, 0, vec3f(.5f, .5f, .5f), vec3f(1, 0, 0), .25f) == .25f);
    voxel_layer_destroy(layer);

    uint32_t a = scene_vertex(&bad, vec3(.5, .5, .5)), b = scene_vertex(&bad, vec3(.6, .5, .5));
    uint32_t c = scene_vertex(&bad, vec3(.7, .5, .5)), invalid = scene_vertex(&bad, vec3(nan(""), 0, 0));
    uint32_t infinite = scene_vertex(&bad, vec3(HUGE_VAL, 0, 0)),
             huge = scene_vertex(&bad, vec3(3e38, 3e38, .3));
    scene_triangle(&bad, a, a, b, false);
    scene_triangle(&bad, a, b, c, true);
    scene_triangle(&bad, a, b, invalid, false);
    scene_triangle(&bad, a, infinite, b, false);
    scene_triangle(&bad, a, b, 1000, false);
    for (unsigned cyclic = 0; cyclic < 8; cyclic += 7) {
        layer = build(&bad, (TexelBuildOptions){.resolution = 16, .cyclic = cyclic}, NULL);
        assert_non_null(layer);
        assert_int_equal(layer->level[0].code_count, 0);
        voxel_layer_destroy(layer);
    }
    scene_triangle(&bad, a, b, huge, false);
    scene_triangle(&bad, a, huge, scene_vertex(&bad, vec3(-3e38, .5, -1e20)), true);
    scene_triangle(&bad, a, b, scene_vertex(&bad, vec3(.55, .5, .5 + 1e-7)), true);
    for (unsigned cyclic = 0; cyclic < 8; cyclic++) {
        layer = build(&bad, (TexelBuildOptions){.resolution = 16, .cyclic = cyclic}, NULL);
        assert_non_null(layer); /* whatever it holds, it was built in finite time */
        voxel_layer_destroy(layer);
    }
    scene_free(&bad);
}

/* At the largest resolution, memory follows the content, not the volume (8 GB if dense). */
static void test_few_triangles_at_large_resolution(void **state) {
    (void)state;
    TestMesh mesh = scene_leaves(5, .01, 7);
    TexelBuildStats stats;
    MemoryBudget budget = {.limit = (size_t)96 << 20};
    VoxelLayer *layer = build(&mesh, (TexelBuildOptions){.resolution = 1024, .memory = &budget}, &stats);
    assert_non_null(layer);
    assert_true(stats.bytes < (size_t)32 << 20);
    assert_true(atomic_load(&budget.used) == stats.bytes);
    voxel_layer_destroy(layer);
    assert_true(atomic_load(&budget.used) == 0);
    scene_free(&mesh);
}

static void test_memory_may_run_out(void **state) {
    (void)state;
    TestMesh mesh = scene_leaves(200, .05, 8);
    bool built = false;
    for (size_t limit = 1000; !built; limit = limit * 5 / 4) {
        MemoryBudget budget = {.limit = limit};
        VoxelLayer *layer = build(&mesh, (TexelBuildOptions){.resolution = 64, .memory = &budget}, NULL);
        built = layer != NULL;
        voxel_layer_destroy(layer);
        assert_true(atomic_load(&budget.used) == 0);
        assert_true(limit < (size_t)1 << 30);
    }
    scene_free(&mesh);
}

static void cancel_soon(void *context, const char *stage, size_t done, size_t total) {
    assert_string_equal(stage, "leaves");
    assert_true(done <= total);
    if (done > 3) pool_cancel(context);
}

static void test_progress_and_cancelling(void **state) {
    (void)state;
    TestMesh mesh = scene_leaves(500, .05, 9);
    Pool *pool = pool_create(2);
    Progress progress = {cancel_soon, pool};
    TexelBuildOptions options = {.resolution = 128, .pool = pool, .progress = &progress, .name = "leaves"};
    assert_null(build(&mesh, options, NULL));
    pool_destroy(pool);
    scene_free(&mesh);
}

/* ---- filtering ---- */

/* A thin cylinder through `c` along `axis`, open at its ends, as sheets. */
static void add_needle(TestMesh *m, Vec3 c, Vec3 axis, double length, double radius) {
    enum { SIDES = 16 };
    Vec3 s, t;
    uint32_t ring[2][SIDES];
    vec3_frame(axis, &s, &t);
    for (int end = 0; end < 2; end++)
        for (int i = 0; i < SIDES; i++) {
            double phi = 2 * VTS_PI * i / SIDES;
            Vec3 p = vec3_madd(vec3_madd(c, s, radius * cos(phi)), t, radius * sin(phi));
            ring[end][i] = scene_vertex(m, vec3_madd(p, axis, (end - .5) * length));
        }
    for (int i = 0; i < SIDES; i++) scene_quad(m, ring[0][i], ring[0][(i + 1) % SIDES], ring[1][(i + 1) % SIDES], ring[1][i], false);
}

typedef enum MixtureKind { TWO_DISCS, EIGHT_DISCS, TWO_NEEDLES, EIGHT_NEEDLES } MixtureKind;

/* Each in a voxel of its own of 2³, turned at random; for needles their axes. */
static TestMesh random_mixture(MixtureKind kind, RandomStream *r) {
    TestMesh m = {0};
    int count = kind == TWO_DISCS || kind == TWO_NEEDLES ? 2 : 8;
    for (int i = 0; i < count; i++) {
        int at = count == 2 ? 7 * i : i;
        Vec3 c = vec3(.25 + .5 * (at & 1), .25 + .5 * (at >> 1 & 1), .25 + .5 * (at >> 2)), d = scene_direction(r);
        if (kind == TWO_DISCS || kind == EIGHT_DISCS) scene_leaf(&m, c, d, .2);
        else add_needle(&m, c, d, .4, .004);
    }
    return m;
}

/* Of the projected area, relative to its mean, when all is one voxel. */
static double mixture_error(MixtureKind kind, TexelFiltering filtering) {
    enum { MIXTURES = 60 };
    RandomStream r = {40 + (uint64_t)kind};
    double sum = 0;
    for (int i = 0; i < MIXTURES; i++) {
        TestMesh mesh = random_mixture(kind, &r);
        VoxelLayer *layer = build(&mesh, (TexelBuildOptions){.resolution = 2, .filtering = filtering}, NULL);
        AreaError e = measure_area_error(layer, 1, &mesh, .5);
        assert_true(fabs(e.total) < .03); /* area is conserved by both */
        sum += e.rms * e.rms / MIXTURES;
        voxel_layer_destroy(layer);
        scene_free(&mesh);
    }
    return sqrt(sum);
}

static void test_filters(void **state) {
    (void)state;
    static const struct { MixtureKind kind; const char *name; double linear, published; } cases[] = {
        {TWO_DISCS, "2 discs", .11, .14}, {EIGHT_DISCS, "8 discs", .08, .10},
        {TWO_NEEDLES, "2 needles", .045, .37}, {EIGHT_NEEDLES, "8 needles", .035, .08}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        double linear = mixture_error(cases[i].kind, TEXEL_FILTER_LINEAR), published = mixture_error(cases[i].kind, TEXEL_FILTER_PUBLISHED);
        printf("%-10s rms error of the projected area: linear %.3f, published %.3f\n", cases[i].name, linear, published);
        assert_true(linear < cases[i].linear);
        assert_true(published > cases[i].published); /* what it is kept to show */
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_filters),
        cmocka_unit_test(test_projected_area_of_leaves),
        cmocka_unit_test(test_projected_area_of_grass),
        cmocka_unit_test(test_walls_of_thick_solids_stand_alone),
        cmocka_unit_test(test_thin_solids_count_once),
        cmocka_unit_test(test_area_is_conserved_and_cut),
        cmocka_unit_test(test_content_wraps),
        cmocka_unit_test(test_sheets_in_grid_planes),
        cmocka_unit_test(test_same_bytes_for_any_threads),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_degenerate_content),
        cmocka_unit_test(test_few_triangles_at_large_resolution),
        cmocka_unit_test(test_memory_may_run_out),
        cmocka_unit_test(test_progress_and_cancelling),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
