/* Densities: grids and their files, voxels filled from them, and the flakes that stand for them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"
#include "texel/texel_content.h"
#include "texel/texel_field.h"
#include "volume/grid.h"
#include "volume/grid_file.h"

#include <stdlib.h>
#include <string.h>

typedef struct Made {
    Arena arena;
    DensityGrid grid;
    Pigment pattern;
    DensityField density;
    TexelLayer layer;
    TexelDef def;
    const TexelField *field;
} Made;

static void begin(Made *m, int x, int y, int z, float (*number)(int, int, int)) {
    *m = (Made){0};
    arena_init(&m->arena, NULL, 0);
    float *values = arena_new_array(&m->arena, float, (size_t)x * (size_t)y * (size_t)z);
    for (int k = 0, i = 0; k < z; k++)
        for (int j = 0; j < y; j++)
            for (int h = 0; h < x; h++) values[i++] = number(h, j, k);
    m->grid = (DensityGrid){.size = {x, y, z}, .values = values};
    m->pattern = pigment_default();
    m->pattern.kind = PATTERN_DENSITY;
    m->pattern.density = &m->grid;
    m->density = (DensityField){.pattern = &m->pattern, .in_bounds = true, .high = 1, .extinction = 20};
    m->layer.density = &m->density;
    m->def = (TexelDef){.bounds = {{0, 0, 0}, {1, 1, 1}}, .layers = &m->layer, .layer_count = 1};
    m->field = texel_field_make(&m->def, &m->layer, &m->arena);
}

static void end(Made *m) { arena_destroy(&m->arena); }

static VoxelLayer *build(const Made *m, int resolution) {
    TexelMesh none = {0};
    TexelBuildOptions options = {.resolution = resolution, .extent = texel_extent(&m->def), .cyclic = m->def.cyclic, .field = m->field};
    VoxelLayer *layer = voxel_layer_build(&none, &options, NULL);
    assert_non_null(layer);
    return layer;
}

/* The sum of density · volume over the voxels of a level: half of all area. */
static double matter(const VoxelLayer *layer, int level) {
    int size[3];
    double sum = 0;
    voxel_layer_size(layer, level, size);
    for (int z = 0; z < size[2]; z++)
        for (int y = 0; y < size[1]; y++)
            for (int x = 0; x < size[0]; x++) {
                VoxelSample v;
                Vec3f at = {((float)x + 0.5F) / (float)size[0], ((float)y + 0.5F) / (float)size[1], ((float)z + 0.5F) / (float)size[2]};
                if (voxel_layer_sample(layer, level, at, &v)) sum += (double)v.density / ((double)size[0] * size[1] * size[2]);
            }
    return sum;
}

static float everywhere(int x, int y, int z) {
    (void)x, (void)y, (void)z;
    return 0.5F;
}

/* A cloud that is alike everywhere, around a torus: its extinction, from everywhere, at all levels. */
static void a_uniform_cloud_is_its_extinction(void **state) {
    (void)state;
    Made m;
    begin(&m, 4, 4, 4, everywhere);
    m.def.cyclic = 7;
    m.field = texel_field_make(&m.def, &m.layer, &m.arena);
    VoxelLayer *layer = build(&m, 16);
    for (int level = 0; level < voxel_layer_levels(layer); level++) {
        VoxelSample v;
        assert_true(voxel_layer_sample(layer, level, vec3f(0.4F, 0.7F, 0.2F), &v));
        assert_true(fabs((double)v.density - 10) < 0.2);
        assert_true(v.gamma == 0);
        assert_true(fabs((double)(v.s.xx - v.s.yy)) < 0.02 && fabs((double)v.s.xy) < 0.02);
    }
    voxel_layer_destroy(layer);
    end(&m);
}

static float blob(int x, int y, int z) {
    double r = hypot(hypot(x - 11.5, y - 11.5), z - 11.5) / 8;
    return r < 1 ? (float)(1 - r) : 0;
}

/* Voxels coarser than the grid, as fine, and finer: the same matter, that of the grid's cells. */
static void matter_is_conserved(void **state) {
    (void)state;
    Made m;
    begin(&m, 24, 24, 24, blob);
    double cells = 0;
    for (int i = 0; i < 24 * 24 * 24; i++) cells += (double)m.grid.values[i] * 20 / (24.0 * 24 * 24);
    static const int resolutions[] = {8, 16, 32, 64};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(resolutions); i++) {
        VoxelLayer *layer = build(&m, resolutions[i]);
        for (int level = 0; level < voxel_layer_levels(layer); level++)
            assert_true(fabs(matter(layer, level) - cells) < 0.02 * cells);
        voxel_layer_destroy(layer);
    }
    end(&m);
}

static float ramp(int x, int y, int z) {
    (void)x, (void)z;
    return y < 12 ? 1 : 0;
}

/* At its rim a solid faces outwards. */
static void rims_face_along_the_gradient(void **state) {
    (void)state;
    Made m;
    VoxelSample v;
    begin(&m, 24, 24, 24, ramp);
    VoxelLayer *layer = build(&m, 32);
    assert_true(voxel_layer_sample(layer, 0, vec3f(0.5F, 0.51F, 0.5F), &v));
    assert_true(v.s.yy > 2 * v.s.xx);
    assert_true(voxel_layer_sample(layer, 0, vec3f(0.5F, 0.25F, 0.5F), &v));
    assert_true(fabs((double)(v.s.yy / v.s.xx) - 1) < 0.05);
    assert_false(voxel_layer_sample(layer, 0, vec3f(0.5F, 0.75F, 0.5F), &v));
    voxel_layer_destroy(layer);
    end(&m);
}

static double triangle_area(const TexelMesh *mesh, size_t i) {
    Vec3 p[3];
    for (int k = 0; k < 3; k++) p[k] = vec3_from_f(mesh->vertices[mesh->triangles[i][k]]);
    return vec3_length(vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]))) / 2;
}

/* Flakes have the area of the voxels, and lie where these are. */
static void flakes_stand_for_the_field(void **state) {
    (void)state;
    Made m;
    TexelMesh mesh;
    begin(&m, 24, 24, 24, blob);
    m.density.extinction = 2; /* so thin that nothing is hidden */
    VoxelLayer *layer = build(&m, 32);
    texel_field_flakes(m.field, texel_extent(&m.def), 20000, &m.arena, &mesh);
    assert_true(mesh.triangle_count > 19990 && mesh.triangle_count <= 20001);
    double area = 0, inside = 0, half = 0;
    for (size_t i = 0; i < mesh.triangle_count; i++) {
        double a = triangle_area(&mesh, i);
        area += a;
        Vec3 p = vec3_from_f(mesh.vertices[mesh.triangles[i][0]]);
        double r = vec3_length(vec3_sub(p, vec3_splat(0.5)));
        if (r < 8 / 24.0 + 0.05) inside += a;
        if (p.y < 0.5) half += a;
    }
    assert_true(fabs(area / 2 - matter(layer, 0)) < 0.02 * matter(layer, 0));
    assert_true(inside > 0.999 * area);
    assert_true(fabs(half / area - 0.5) < 0.02);
    voxel_layer_destroy(layer);
    end(&m);
}

static void the_range_bounds_the_grid(void **state) {
    (void)state;
    Made m;
    RandomStream random = {5};
    begin(&m, 24, 19, 7, blob);
    GridRange range = grid_range(&m.grid, &m.arena);
    for (int i = 0; i < 2000; i++) {
        Vec3 p = vec3(random_next_unit(&random), random_next_unit(&random), random_next_unit(&random));
        Box3 box = {vec3_sub(p, vec3_splat(0.3 * random_next_unit(&random))), vec3_add(p, vec3_splat(0.3 * random_next_unit(&random)))};
        for (unsigned cyclic = 0; cyclic < 8; cyclic++)
            assert_true(grid_value(&m.grid, cyclic, p) <= grid_range_most(&range, cyclic, box) + 1e-7);
    }
    end(&m);
}

static float at_far_rim(int x, int y, int z) {
    (void)y, (void)z;
    return x == 31 ? 1 : 0;
}

/* Between the last cell and the first of a cyclic axis there is the half of a cell on both sides. */
static void the_range_sees_across_the_rim(void **state) {
    (void)state;
    Made m;
    begin(&m, 32, 1, 1, at_far_rim);
    GridRange range = grid_range(&m.grid, &m.arena);
    Box3 box = {vec3(0, 0.4, 0.4), vec3(0.01, 0.6, 0.6)};
    assert_true(grid_value(&m.grid, 1, vec3(0.001, 0.5, 0.5)) > 0.4);
    assert_true(grid_range_most(&range, 1, box) >= grid_value(&m.grid, 1, vec3(0.001, 0.5, 0.5)));
    assert_true(grid_range_most(&range, 0, box) == 0);
    end(&m);
}

/* An extinction past what floats hold: opaque, and every number one. */
static void matter_beyond_all_measure_is_finite(void **state) {
    (void)state;
    Made m;
    begin(&m, 4, 4, 4, everywhere);
    m.density.extinction = 1e300;
    VoxelLayer *layer = build(&m, 16);
    VoxelSample v;
    assert_true(voxel_layer_sample(layer, 2, vec3f(0.5F, 0.5F, 0.5F), &v));
    assert_true(isfinite(v.density) && v.density > 1000);
    voxel_layer_destroy(layer);
    end(&m);
}

static void files_are_read_and_damage_is_refused(void **state) {
    (void)state;
    static const unsigned char df3[] = {0, 2, 0, 1, 0, 2, 0, 51, 102, 255};
    unsigned char copy[sizeof df3];
    Arena arena;
    DensityGrid grid;
    arena_init(&arena, NULL, 0);
    assert_true(grid_decode_df3(df3, sizeof df3, &arena, &grid, NULL));
    assert_true(grid.size[0] == 2 && grid.size[1] == 1 && grid.size[2] == 2);
    assert_true(fabsf(grid.values[1] - 0.2F) < 1e-6F && grid.values[3] == 1);
    for (size_t n = 0; n < sizeof df3; n++) assert_false(grid_decode_df3(df3, n, &arena, &grid, NULL));
    RandomStream random = {9};
    for (int i = 0; i < 5000; i++) {
        memcpy(copy, df3, sizeof df3);
        for (int k = 0; k < 3; k++) copy[random_next(&random) % sizeof copy] = (unsigned char)random_next(&random);
        size_t size = random_next(&random) % (sizeof copy + 1);
        if (grid_decode_df3(copy, size, &arena, &grid, NULL))
            assert_true((size_t)grid.size[0] * (size_t)grid.size[1] * (size_t)grid.size[2] <= size);
    }
    GridRaw raw = {{2, 1, 1}, GRID_FLOAT, true};
    static const unsigned char floats[] = {0x3f, 0x80, 0, 0, 0x7f, 0xc0, 0, 0}; /* 1 and NaN */
    assert_true(grid_decode_raw(floats, sizeof floats, &raw, &arena, &grid, NULL));
    assert_true(grid.values[0] == 1 && grid.values[1] == 0);
    raw = (GridRaw){{65536, 65536, 65536}, GRID_UINT8, false};
    assert_false(grid_decode_raw(floats, sizeof floats, &raw, &arena, &grid, NULL));
    arena_destroy(&arena);
}

static void fractals_can_be_stopped(void **state) {
    (void)state;
    static const int size[3] = {12, 8, 4};
    atomic_bool interrupted = false;
    Arena arena;
    DensityGrid grid;
    arena_init(&arena, NULL, 0);
    assert_true(grid_fractal(size, 2.5, 0, 1, &interrupted, &arena, &grid));
    assert_int_equal(grid.size[2], 4);
    interrupted = true;
    assert_false(grid_fractal(size, 2.5, 0, 1, &interrupted, &arena, &grid));
    arena_destroy(&arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_uniform_cloud_is_its_extinction), cmocka_unit_test(matter_is_conserved),
        cmocka_unit_test(rims_face_along_the_gradient),      cmocka_unit_test(flakes_stand_for_the_field),
        cmocka_unit_test(the_range_bounds_the_grid),         cmocka_unit_test(files_are_read_and_damage_is_refused),
        cmocka_unit_test(the_range_sees_across_the_rim),     cmocka_unit_test(matter_beyond_all_measure_is_finite),
        cmocka_unit_test(fractals_can_be_stopped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
