/* The mesh of the ground: no cracks, errors within what is allowed, holes that stay open, the same at each call. */
#include "base/random.h"
#include "terrain/ground_mesh.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct Arenas {
    Arena scratch, kept;
} Arenas;

static int set_up(void **state) {
    static Arenas arenas;
    arena_init(&arenas.scratch, NULL, 0);
    arena_init(&arenas.kept, NULL, 0);
    *state = &arenas;
    return 0;
}

static int tear_down(void **state) {
    Arenas *arenas = *state;
    arena_destroy(&arenas->scratch);
    arena_destroy(&arenas->kept);
    return 0;
}

/* ---- grounds ---- */

static Vec3 flat_place(const void *map, double column, double row, double height) {
    (void)map;
    return vec3(10 * column, height, -10 * row);
}

/* Noise of several octaves: each a hash, bilinear between its own lattice. */
static double octave(int column, int row, int side) {
    int c = column / side, r = row / side;
    double u = (double)(column % side) / side, v = (double)(row % side) / side, corner[4];
    for (int k = 0; k < 4; k++)
        corner[k] = (double)(random_hash((uint64_t)(c + (k & 1)), (uint64_t)(r + (k >> 1)), (uint64_t)side, 7) >> 11) * 0x1p-53;
    return (corner[0] * (1 - u) + corner[1] * u) * (1 - v) + (corner[2] * (1 - u) + corner[3] * u) * v;
}

static double rough_height(const void *map, int column, int row) {
    (void)map;
    double sum = 0;
    for (int side = 64; side >= 1; side /= 2) sum += 3 * side * octave(column, row, side);
    return sum;
}

static double sloping_height(const void *map, int column, int row) { return (void)map, 3 * column - 2 * row; }

static double holed_height(const void *map, int column, int row) {
    bool hole = (column >= 30 && column <= 45 && row >= 20 && row <= 50) || (column == 70 && row == 11);
    return hole ? (double)NAN : rough_height(map, column, row);
}

static double empty_height(const void *map, int column, int row) { return (void)map, (void)column, (void)row, NAN; }

static GroundSource ground(int columns, int rows, double (*height)(const void *, int, int)) {
    return (GroundSource){.columns = columns, .rows = rows, .height = height, .place = flat_place, .spacing = 10};
}

typedef struct Allowance {
    Vec3 eye;
    double even, by_distance, side;
} Allowance;

static void allow(const void *context, const GroundSpot *spot, double *error, double *side) {
    const Allowance *a = context;
    double distance = fmax(0, vec3_length(vec3_sub(spot->centre, a->eye)) - spot->radius);
    *error = a->even + a->by_distance * distance;
    *side = a->side;
}

static MeshData build(Arenas *arenas, const GroundSource *source, const Allowance *allowance, bool every_post) {
    GroundErrors errors;
    MeshData mesh;
    const GroundDetail detail = {.allow = allow, .context = allowance, .every_post = every_post};
    ground_errors_build(source, NULL, &arenas->kept, &errors);
    assert_true(ground_mesh_build(source, &errors, &detail, &arenas->scratch, &arenas->kept, &mesh, NULL));
    return mesh;
}

/* ---- what is measured ---- */

typedef struct Edge {
    uint32_t low, high;
    bool forwards;
} Edge;

static int compare_edges(const void *x, const void *y) {
    const Edge *a = x, *b = y;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    return a->high == b->high ? 0 : a->high < b->high ? -1 : 1;
}

static bool on_border(const GroundSource *source, Vec3 a, Vec3 b) {
    double right = 10.0 * (source->columns - 1), bottom = -10.0 * (source->rows - 1);
    return (a.x == 0 && b.x == 0) || (a.x == right && b.x == right) || (a.z == 0 && b.z == 0) || (a.z == bottom && b.z == bottom);
}

/* Every edge belongs to two triangles that run along it in opposite ways, or lies on the map's border; returns how many do neither. */
static size_t cracks(const GroundSource *source, const MeshData *mesh) {
    size_t count = 3 * mesh->triangle_count, open = 0;
    Edge *edges = malloc(count * sizeof *edges);
    for (size_t i = 0; i < count; i++) {
        const uint32_t *t = mesh->triangles[i / 3];
        uint32_t from = t[i % 3], to = t[(i + 1) % 3];
        edges[i] = (Edge){from < to ? from : to, from < to ? to : from, from < to};
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0, next; i < count; i = next) {
        for (next = i; next < count && compare_edges(&edges[i], &edges[next]) == 0;) next++;
        bool pair = next - i == 2 && edges[i].forwards != edges[i + 1].forwards;
        bool border = next - i == 1 && on_border(source, mesh->vertices[edges[i].low], mesh->vertices[edges[i].high]);
        open += !pair && !border;
    }
    free(edges);
    return open;
}

static double plan_area(const MeshData *mesh) {
    double sum = 0;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangles[i];
        Vec3 a = mesh->vertices[t[0]];
        sum += fabs(vec3_cross(vec3_sub(mesh->vertices[t[1]], a), vec3_sub(mesh->vertices[t[2]], a)).y) / 2;
    }
    return sum;
}

/* The most that triangles are off the ground at random places in them, over what is allowed there. */
static double worst_error(const GroundSource *source, const MeshData *mesh, const Allowance *allowance) {
    double worst = 0;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangles[i];
        for (uint64_t k = 0; k < 20; k++) {
            double u = (double)(random_hash(i, k, 1, 0) >> 11) * 0x1p-53, v = (double)(random_hash(i, k, 2, 0) >> 11) * 0x1p-53;
            if (u + v > 1) u = 1 - u, v = 1 - v;
            Vec3 a = mesh->vertices[t[0]], p = vec3_madd(vec3_madd(a, vec3_sub(mesh->vertices[t[1]], a), u), vec3_sub(mesh->vertices[t[2]], a), v);
            double column = double_clamp(p.x / 10, 0, source->columns - 1), row = double_clamp(-p.z / 10, 0, source->rows - 1);
            double miss = fabs(p.y - ground_source_height(source, column, row));
            double allowed = allowance->even + allowance->by_distance * vec3_length(vec3_sub(p, allowance->eye));
            worst = fmax(worst, miss / allowed);
        }
    }
    return worst;
}

/* ---- tests ---- */

static const int sizes[][2] = {{2, 2}, {3, 2}, {65, 65}, {100, 37}, {2, 129}, {130, 131}};

static void meshes_have_no_cracks_and_cover_the_map(void **state) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(sizes); i++) {
        for (int eye = 0; eye < 3; eye++) {
            const GroundSource source = ground(sizes[i][0], sizes[i][1], rough_height);
            const Allowance near = {{90 + 400 * eye, 150, -120}, 0.01, 0.01, HUGE_VAL};
            MeshData mesh = build(*state, &source, &near, false);
            assert_int_equal(cracks(&source, &mesh), 0);
            double area = 100.0 * (source.columns - 1) * (source.rows - 1);
            assert_true(fabs(plan_area(&mesh) - area) < 1e-9 * area);
            for (size_t k = 0; k < mesh.vertex_count; k++) assert_true(mesh.normals[k].y > 0);
        }
    }
}

static void errors_stay_within_what_is_allowed(void **state) {
    const GroundSource source = ground(130, 131, rough_height);
    const Allowance coarse = {{300, 200, -300}, 0.5, 0.05, HUGE_VAL}, fine = {{300, 200, -300}, 0.02, 0.002, HUGE_VAL};
    MeshData few = build(*state, &source, &coarse, false), many = build(*state, &source, &fine, false);
    assert_true(few.triangle_count * 4 < many.triangle_count);
    assert_true(worst_error(&source, &few, &coarse) <= 1);
    assert_true(worst_error(&source, &many, &fine) <= 1);
    /* The bound is no wild guess either: somewhere a good part of it is used. */
    assert_true(worst_error(&source, &few, &coarse) > 0.2);
}

static void a_plane_is_two_triangles_and_what_the_border_adds(void **state) {
    const GroundSource square = ground(129, 129, sloping_height), odd = ground(100, 37, sloping_height);
    const Allowance any = {{0, 0, 0}, 1e-6, 0, HUGE_VAL};
    assert_int_equal(build(*state, &square, &any, false).triangle_count, 2);
    MeshData mesh = build(*state, &odd, &any, false);
    assert_in_range(mesh.triangle_count, 2, 6);
    assert_true(worst_error(&odd, &mesh, &any) < 1e-3);
    assert_int_equal(cracks(&odd, &mesh), 0);
}

static void sides_are_no_longer_than_asked(void **state) {
    const GroundSource source = ground(129, 129, sloping_height);
    const Allowance short_sides = {{0, 0, 0}, 1, 0, 45};
    MeshData mesh = build(*state, &source, &short_sides, false);
    for (size_t i = 0; i < mesh.triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            Vec3 side = vec3_sub(mesh.vertices[mesh.triangles[i][k]], mesh.vertices[mesh.triangles[i][(k + 1) % 3]]);
            assert_true(hypot(side.x, side.z) <= 45);
        }
}

static void every_post_is_a_vertex_where_all_are_asked_for(void **state) {
    const GroundSource source = ground(60, 41, rough_height);
    const Allowance any = {{0, 0, 0}, 1e9, 0, HUGE_VAL};
    MeshData mesh = build(*state, &source, &any, true);
    assert_int_equal(mesh.vertex_count, 60 * 41);
    assert_int_equal(mesh.triangle_count, 2 * 59 * 40);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        Vec3 p = mesh.vertices[i];
        assert_true(p.y == rough_height(NULL, (int)lround(p.x / 10), (int)lround(-p.z / 10)));
    }
}

static void holes_stay_open(void **state) {
    const GroundSource source = ground(100, 90, holed_height);
    const Allowance fine = {{0, 0, 0}, 0.5, 0, HUGE_VAL}, coarse = {{0, 0, 0}, 25, 0, HUGE_VAL};
    double open = 100.0 * (17 * 32 + 2 * 2), all = 100.0 * 99 * 89;
    MeshData mesh = build(*state, &source, &fine, false);
    assert_true(fabs(plan_area(&mesh) - (all - open)) < 1e-6 * all);
    for (size_t i = 0; i < mesh.vertex_count; i++) assert_true(vec3_is_finite(mesh.vertices[i]));
    assert_true(worst_error(&source, &mesh, &fine) <= 1);
    /* Coarser ones leave out, or fill, no more than a strip of what is allowed. */
    mesh = build(*state, &source, &coarse, false);
    assert_true(fabs(plan_area(&mesh) - (all - open)) < 40 * 2 * 10.0 * (17 + 32 + 4));
    const GroundSource nothing = ground(50, 50, empty_height);
    assert_int_equal(build(*state, &nothing, &fine, false).triangle_count, 0);
}

static void meshes_are_the_same_each_time_and_limits_hold(void **state) {
    const GroundSource source = ground(130, 131, rough_height);
    const Allowance near = {{90, 150, -120}, 0.01, 0.01, HUGE_VAL};
    MeshData a = build(*state, &source, &near, false), b = build(*state, &source, &near, false);
    assert_int_equal(a.vertex_count, b.vertex_count);
    assert_memory_equal(a.vertices, b.vertices, a.vertex_count * sizeof(Vec3));
    assert_memory_equal(a.triangles, b.triangles, a.triangle_count * sizeof *a.triangles);
    GroundErrors errors;
    Arenas *arenas = *state;
    ground_errors_build(&source, NULL, &arenas->kept, &errors);
    const GroundDetail little = {.allow = allow, .context = &near, .most_vertices = 100};
    assert_false(ground_mesh_build(&source, &errors, &little, &arenas->scratch, &arenas->kept, &a, NULL));
    assert_int_equal(a.triangle_count, 0);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(meshes_have_no_cracks_and_cover_the_map),
        TEST(errors_stay_within_what_is_allowed),
        TEST(a_plane_is_two_triangles_and_what_the_border_adds),
        TEST(sides_are_no_longer_than_asked),
        TEST(every_post_is_a_vertex_where_all_are_asked_for),
        TEST(holes_stay_open),
        TEST(meshes_are_the_same_each_time_and_limits_hold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
