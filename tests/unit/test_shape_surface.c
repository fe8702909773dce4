/* Surfaces of skins: adjacency, fronts, seams, normals, deforms. */
#include "base/random.h"
#include "shape/surface_mesh.h"

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

static int set_up(void **state) {
    static Arena arena;
    arena_init(&arena, NULL, 0);
    *state = &arena;
    return 0;
}

static int tear_down(void **state) {
    arena_destroy(*state);
    return 0;
}

/* ---- makers ---- */

typedef Vec3 (*GridFunction)(double u, double v);

static Surface patches(Arena *arena, int nu, int nv, GridFunction f) {
    Vec3 *points = arena_new_array(arena, Vec3, (size_t)((nu + 1) * (nv + 1)));
    for (int i = 0; i <= nu; i++) {
        for (int j = 0; j <= nv; j++) points[i * (nv + 1) + j] = f((double)i / nu, (double)j / nv);
    }
    return (Surface){
        .kind = SURFACE_PATCHES, .nu = nu, .nv = nv, .points = points, .transform = transform_identity()};
}

static Surface of_object(const Object *object) {
    return (Surface){.kind = SURFACE_OBJECT, .object = object, .transform = transform_identity()};
}

static Object object_of(ObjectKind kind) { return (Object){.kind = (uint8_t)kind}; }

static Object ball(void) {
    Object object = object_of(OBJECT_SPHERE);
    object.as.sphere.center = vec3(1, 2, 3);
    object.as.sphere.radius = 2;
    return object;
}

static SurfaceMesh mesh_of(Arena *arena, const Surface *surface, double tolerance) {
    const SurfaceMeshOptions options = {.tolerance = tolerance};
    SurfaceMesh mesh;
    ShapeRefusal refusal;
    assert_true(surface_mesh_build(surface, &options, arena, &mesh, &refusal));
    return mesh;
}

/* ---- checks ---- */

static Vec3 vertex(const SurfaceMesh *mesh, size_t cell, int corner) {
    const SurfaceCell *c = &mesh->cells[cell];
    return mesh->vertices[c->vertex[corner % c->corner_count]];
}

static Vec3 area_vector(const SurfaceMesh *mesh, size_t cell) {
    Vec3 sum = vec3_splat(0), a = vertex(mesh, cell, 0);
    for (int i = 1; i + 1 < mesh->cells[cell].corner_count; i++) {
        sum = vec3_add(
            sum, vec3_cross(vec3_sub(vertex(mesh, cell, i), a), vec3_sub(vertex(mesh, cell, i + 1), a)));
    }
    return vec3_scale(sum, 0.5);
}

static double volume(const SurfaceMesh *mesh) {
    double sum = 0;
    for (size_t c = 0; c < mesh->cell_count; c++) {
        Vec3 a = vertex(mesh, c, 0);
        for (int i = 1; i + 1 < mesh->cells[c].corner_count; i++) {
            sum += vec3_dot(a, vec3_cross(vertex(mesh, c, i), vertex(mesh, c, i + 1))) / 6;
        }
    }
    return sum;
}

/* Neighbours name each other, share both vertices and run along the edge in opposite ways. Returns the number of borders,
 * *seams that of seams. */
static size_t check_mesh(const SurfaceMesh *mesh, size_t *seams) {
    size_t borders = 0;
    *seams = 0;
    for (size_t c = 0; c < mesh->cell_count; c++) {
        const SurfaceCell *cell = &mesh->cells[c];
        for (int e = 0; e < cell->corner_count; e++) {
            SurfaceNeighbour n = mesh->neighbours[c][e];
            uint32_t from = cell->vertex[e], to = cell->vertex[(e + 1) % cell->corner_count];
            assert_true(from < mesh->vertex_count && cell->uv[e] < mesh->uv_count);
            if (from == to) continue;
            if (n.cell < 0) {
                borders++;
                continue;
            }
            const SurfaceCell *other = &mesh->cells[n.cell];
            assert_int_equal(mesh->neighbours[n.cell][n.edge].cell, c);
            assert_int_equal(mesh->neighbours[n.cell][n.edge].edge, e);
            assert_int_equal(other->vertex[n.edge], to);
            assert_int_equal(other->vertex[(n.edge + 1) % other->corner_count], from);
            assert_int_equal(mesh->neighbours[n.cell][n.edge].seam, n.seam);
            *seams += n.seam;
        }
    }
    for (size_t i = 0; i < mesh->vertex_count; i++)
        assert_true(fabs(vec3_length(mesh->normals[i]) - 1) < 1e-12);
    return borders;
}

/* ---- patches ---- */

static Vec3 hill(double u, double v) { return vec3(16 * (u - 0.5), 2 * exp(-u * u - v), 16 * (v - 0.5)); }
static Vec3 hill_from_below(double u, double v) { return hill(1 - u, v); }

static void a_grid_looks_up_and_knows_its_neighbours(void **state) {
    for (int below = 0; below < 2; below++) {
        Surface surface = patches(*state, 5, 7, below ? hill_from_below : hill);
        SurfaceMesh mesh = mesh_of(*state, &surface, 0.1);
        size_t seams, borders = check_mesh(&mesh, &seams);
        assert_int_equal(mesh.cell_count, 35);
        assert_int_equal(mesh.vertex_count, 48);
        assert_int_equal(borders, 24);
        assert_int_equal(seams, 0);
        for (size_t c = 0; c < mesh.cell_count; c++) {
            assert_true(area_vector(&mesh, c).y > 0);
            assert_int_equal(mesh.cells[c].corner_count, 4);
            assert_false(mesh.cells[c].degenerate);
            /* The cell's first corner is grid point (i, j). */
            TexCoord uv = mesh.uvs[mesh.cells[c].uv[0]];
            assert_true(uv.u == (double)(c / 7) / 5 && uv.v == (double)(c % 7) / 7);
        }
        for (size_t i = 0; i < mesh.vertex_count; i++) assert_true(mesh.normals[i].y > 0.5);
        assert_true(mesh.bounds.min.x == -8 && mesh.bounds.max.z == 8);
    }
}

static Vec3 tube(double u, double v) { return vec3(cos(2 * VTS_PI * u), 5 * v, sin(2 * VTS_PI * u)); }
static Vec3 ring(double u, double v) {
    double r = 2 + 0.5 * cos(2 * VTS_PI * v);
    return vec3(r * cos(2 * VTS_PI * u), 0.5 * sin(2 * VTS_PI * v), r * sin(2 * VTS_PI * u));
}
static Vec3 globe(double u, double v) {
    return vec3(sin(VTS_PI * v) * cos(2 * VTS_PI * u), cos(VTS_PI * v),
                sin(VTS_PI * v) * sin(2 * VTS_PI * u));
}
static Vec3 moebius(double u, double v) {
    double turn = 2 * VTS_PI * u, r = 2 + (v - 0.5) * cos(turn / 2);
    return vec3(r * cos(turn), (v - 0.5) * sin(turn / 2), r * sin(turn));
}

static void grids_that_close_are_joined_at_a_seam(void **state) {
    size_t seams;
    Surface open = patches(*state, 12, 4, tube), closed = patches(*state, 12, 8, ring);
    SurfaceMesh mesh = mesh_of(*state, &open, 1);
    assert_int_equal(check_mesh(&mesh, &seams), 24);
    assert_int_equal(seams, 8); /* 4 edges, from both sides */
    assert_int_equal(mesh.vertex_count, 60);
    mesh = mesh_of(*state, &closed, 1);
    assert_int_equal(check_mesh(&mesh, &seams), 0);
    assert_int_equal(seams, 2 * (12 + 8));
    assert_int_equal(mesh.vertex_count, 96);
    assert_true(volume(&mesh) > 0);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        Vec3 p = mesh.vertices[i], middle = vec3_scale(vec3_normalize(vec3(p.x, 0, p.z)), 2);
        assert_true(vec3_dot(mesh.normals[i], vec3_sub(p, middle)) > 0.45);
    }
}

static void poles_collapse_without_harm(void **state) {
    size_t seams;
    Surface surface = patches(*state, 16, 9, globe);
    SurfaceMesh mesh = mesh_of(*state, &surface, 1);
    assert_int_equal(check_mesh(&mesh, &seams), 0);
    assert_int_equal(mesh.vertex_count, 16 * 8 + 2);
    assert_true(volume(&mesh) > 3.5);
    for (size_t i = 0; i < mesh.vertex_count; i++)
        assert_true(vec3_dot(mesh.normals[i], mesh.vertices[i]) > 0.99);
    for (size_t c = 0; c < mesh.cell_count; c++) assert_false(mesh.cells[c].degenerate);
}

static void one_sided_surfaces_are_cut_once(void **state) {
    size_t seams;
    Surface surface = patches(*state, 20, 2, moebius);
    SurfaceMesh mesh = mesh_of(*state, &surface, 1);
    size_t borders = check_mesh(&mesh, &seams);
    assert_in_range(borders, 2 * 20 + 2 * 2, 2 * 20 + 2 * 4); /* the cut may have a step */
}

static void given_heights_decide_the_front_and_are_interpolated(void **state) {
    Surface surface = patches(*state, 3, 3, hill);
    Vec3 heights[16];
    for (int i = 0; i < 16; i++) heights[i] = vec3(0.1 * (i / 4), -2, 0.3);
    surface.height_vectors = heights;
    surface.subdivide = 2;
    SurfaceMesh mesh = mesh_of(*state, &surface, 1);
    assert_int_equal(mesh.cell_count, 36);
    for (size_t c = 0; c < mesh.cell_count; c++) {
        assert_true(area_vector(&mesh, c).y < 0);
        TexCoord uv = mesh.uvs[mesh.cells[c].uv[2]];
        Vec3 h = mesh.height_vectors[mesh.cells[c].vertex[2]];
        assert_true(vec3_length(vec3_sub(h, vec3(0.3 * uv.u, -2, 0.3))) < 1e-12);
    }
    surface.transform = transform_scale(vec3(2, 3, -4));
    mesh = mesh_of(*state, &surface, 1);
    assert_true(fabs(mesh.height_vectors[0].y + 6) < 1e-12 && fabs(mesh.height_vectors[0].z + 1.2) < 1e-12);
}

/* ---- objects ---- */

static void closed_solids_have_no_borders_and_look_out(void **state) {
    Object objects[4] = {ball(), object_of(OBJECT_BOX), object_of(OBJECT_CONE), object_of(OBJECT_TORUS)};
    objects[1].as.box.corner1 = vec3(1, 1, 1);
    objects[1].as.box.corner2 = vec3(0, 3, 2);
    objects[2].as.cone.base_radius = 1;
    objects[2].as.cone.cap = vec3(1, 1, 0);
    objects[3].as.torus.major_radius = 2;
    objects[3].as.torus.minor_radius = 0.7;
    for (int i = 0; i < 4; i++) {
        for (int n = 0; n < 4; n++) {
            Surface surface = of_object(&objects[i]);
            size_t seams;
            surface.subdivide = n;
            surface.transform = n == 3 ? transform_scale(vec3(1, -2, 1)) : transform_identity();
            SurfaceMesh mesh = mesh_of(*state, &surface, 0.05);
            assert_int_equal(check_mesh(&mesh, &seams), 0);
            assert_true(seams > 0 && volume(&mesh) > 0);
            if (n > 0 && i == 0) assert_int_equal(mesh.cell_count, 8 * n * n);
            if (n > 0 && i == 1) assert_int_equal(mesh.cell_count, 12 * n * n);
        }
    }
}

static void normals_of_spheres_are_exact_and_of_boxes_shared(void **state) {
    Object sphere = ball(), box = object_of(OBJECT_BOX);
    Surface round = of_object(&sphere), square = of_object(&box);
    SurfaceMesh mesh = mesh_of(*state, &round, 0.1);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        Vec3 out = vec3_normalize(vec3_sub(mesh.vertices[i], sphere.as.sphere.center));
        assert_true(vec3_dot(out, mesh.normals[i]) > 1 - 1e-9);
    }
    box.as.box.corner1 = vec3(-1, -1, -1);
    box.as.box.corner2 = vec3(1, 1, 1);
    mesh = mesh_of(*state, &square, 0.1);
    assert_int_equal(mesh.vertex_count, 8);
    for (size_t i = 0; i < 8; i++) assert_true(vec3_dot(mesh.normals[i], mesh.vertices[i]) > sqrt(3) - 1e-9);
}

static void windings_are_made_consistent(void **state) {
    RandomStream random = {1};
    Object sphere = ball();
    Surface surface = of_object(&sphere);
    SurfaceMesh whole = mesh_of(*state, &surface, 0.05);
    uint32_t(*faces)[3] = arena_push(*state, whole.cell_count * sizeof *faces);
    for (size_t c = 0; c < whole.cell_count; c++) {
        bool turn = random_next_unit(&random) < 0.5;
        for (int i = 0; i < 3; i++) faces[c][i] = whole.cells[c].vertex[turn ? 2 - i : i];
    }
    MeshData data = {.vertices = whole.vertices,
                     .vertex_count = whole.vertex_count,
                     .triangle_count = whole.cell_count,
                     .triangles = (const uint32_t(*)[3])faces};
    Object object = object_of(OBJECT_TRIANGLES);
    Surface shuffled = of_object(&object);
    size_t seams;
    object.as.mesh = &data;
    shuffled.uv = SURFACE_UV_SPHERICAL;
    SurfaceMesh mesh = mesh_of(*state, &shuffled, 1);
    assert_int_equal(check_mesh(&mesh, &seams), 0);
    assert_true(seams > 0);
    assert_true(fabs(volume(&mesh) / volume(&whole) - 1) < 1e-12);
    data.triangle_count = 1; /* open, no normals: looks up */
    mesh = mesh_of(*state, &shuffled, 1);
    assert_true(area_vector(&mesh, 0).y > 0);
}

static void edges_of_three_cells_are_borders_and_thin_cells_are_marked(void **state) {
    static const Vec3 vertices[6] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 0, -1}, {2, 0, 0}};
    static const uint32_t faces[5][3] = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {0, 1, 5}, {3, 3, 4}};
    const MeshData data = {.vertices = vertices, .vertex_count = 6, .triangles = faces, .triangle_count = 5};
    Object object = object_of(OBJECT_TRIANGLES);
    Surface surface = of_object(&object);
    size_t seams;
    object.as.mesh = &data;
    SurfaceMesh mesh = mesh_of(*state, &surface, 1);
    check_mesh(&mesh, &seams);
    assert_int_equal(mesh.cell_count, 5);
    for (int c = 0; c < 4; c++) assert_int_equal(mesh.neighbours[c][0].cell, -1);
    for (int c = 0; c < 5; c++) assert_int_equal(mesh.cells[c].degenerate, c >= 3);
}

static void given_normals_and_vectors_are_kept(void **state) {
    static const Vec3 vertices[3] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, down[1] = {{0.6, -0.8, 0}};
    static const Vec3 uvs[3] = {{0.1, 0.2, 0}, {0.3, 0.4, 0}, {0.5, 0.7, 0}},
                      w[3] = {{0, 0.5, 0}, {0.1, 0.5, 0}, {0.3, 1, 0}};
    static const Vec3 heights[3] = {{0, -3, 0}, {1, -3, 0}, {0, -3, 2}};
    static const uint32_t faces[1][3] = {{0, 1, 2}}, zeros[1][3] = {{0, 0, 0}};
    const MeshData data = {.vertices = vertices,
                           .vertex_count = 3,
                           .normals = down,
                           .normal_count = 1,
                           .uvs = uvs,
                           .uv_count = 3,
                           .triangles = faces,
                           .triangle_count = 1,
                           .normal_triangles = zeros,
                           .w_vectors = w};
    Object object = object_of(OBJECT_TRIANGLES);
    Surface surface = of_object(&object);
    object.as.mesh = &data;
    SurfaceMesh mesh = mesh_of(*state, &surface, 1);
    assert_true(area_vector(&mesh, 0).y < 0);
    assert_null(mesh.height_vectors);
    for (int i = 0; i < 3; i++) {
        uint32_t v = mesh.cells[0].vertex[i], k = 0;
        while (vertices[k].x != mesh.vertices[v].x || vertices[k].z != mesh.vertices[v].z) k++;
        assert_true(vec3_length(vec3_sub(mesh.normals[v], down[0])) < 1e-12);
        assert_true(vec3_length(vec3_sub(mesh.w_vectors[v], w[k])) < 1e-12);
        assert_true(mesh.uvs[mesh.cells[0].uv[i]].v == uvs[k].y);
    }
    surface.object_height_vectors = heights;
    surface.subdivide = 3;
    mesh = mesh_of(*state, &surface, 1);
    assert_int_equal(mesh.cell_count, 9);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        Vec3 p = mesh.vertices[i];
        assert_true(vec3_length(vec3_sub(mesh.height_vectors[i], vec3(p.x, -3, 2 * p.z))) < 1e-12);
    }
}

/* The outside wins over normals that look in; the larger area wins where normals of an open part disagree. */
static void normals_that_disagree_are_overruled(void **state) {
    static const Vec3 corners[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const uint32_t sides[4][3] = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
    static const Vec3 strip[5] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 5, 0}},
                      ways[2] = {{0, 0, -1}, {0, 0, 1}};
    static const uint32_t pieces[3][3] = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}},
                          piece_ways[3][3] = {{0, 0, 0}, {1, 1, 1}, {1, 1, 1}};
    Vec3 inwards[4];
    for (int i = 0; i < 4; i++) inwards[i] = vec3_normalize(vec3_sub(vec3_splat(0.25), corners[i]));
    const MeshData closed = {.vertices = corners,
                             .vertex_count = 4,
                             .normals = inwards,
                             .normal_count = 4,
                             .triangles = sides,
                             .triangle_count = 4};
    const MeshData open = {.vertices = strip,
                           .vertex_count = 5,
                           .normals = ways,
                           .normal_count = 2,
                           .triangles = pieces,
                           .triangle_count = 3,
                           .normal_triangles = piece_ways};
    Object object = object_of(OBJECT_TRIANGLES);
    Surface surface = of_object(&object);
    object.as.mesh = &closed;
    SurfaceMesh mesh = mesh_of(*state, &surface, 1);
    assert_true(volume(&mesh) > 0.1);
    for (size_t i = 0; i < 4; i++)
        assert_true(vec3_dot(mesh.normals[i], vec3_sub(mesh.vertices[i], vec3_splat(0.25))) > 0);
    object.as.mesh = &open;
    mesh = mesh_of(*state, &surface, 1);
    for (size_t c = 0; c < 3; c++) assert_true(area_vector(&mesh, c).z > 0);
}

static void generated_coordinates_cover_the_unit_square(void **state) {
    Object box = object_of(OBJECT_BOX);
    Surface surface = of_object(&box);
    box.as.box.corner1 = vec3(-3, 1, 5);
    box.as.box.corner2 = vec3(4, 2, 9);
    surface.subdivide = 6;
    for (int kind = 0; kind < 3; kind++) {
        Box3 range = box3_empty();
        surface.uv = (SurfaceUv[]){SURFACE_UV_PLANAR, SURFACE_UV_CYLINDRICAL, SURFACE_UV_SPHERICAL}[kind];
        surface.uv_axis = kind == 1 ? vec3(0, 0, 2) : vec3(0, 0, 0);
        SurfaceMesh mesh = mesh_of(*state, &surface, 1);
        for (size_t c = 0; c < mesh.cell_count; c++) {
            double lo = 9, hi = -9;
            for (int i = 0; i < 3; i++) {
                TexCoord uv = mesh.uvs[mesh.cells[c].uv[i]];
                range = box3_add_point(range, vec3(uv.u, uv.v, 0));
                lo = double_min(lo, uv.u);
                hi = double_max(hi, uv.u);
            }
            assert_true(hi - lo <= 0.5); /* no cell spans the seam the wrong way */
        }
        assert_true(range.min.x >= 0 && range.min.x < 0.02 && range.min.y >= 0 && range.min.y < 0.02);
        assert_true(range.max.x > 0.98 && range.max.x <= (kind ? 1.5 : 1) && range.max.y > 0.98 &&
                    range.max.y <= 1);
    }
}

/* Few places and many triangles: duplicates, slivers, edges of many cells, one-sided parts. */
static void any_heap_of_triangles_gives_a_consistent_mesh(void **state) {
    RandomStream random = {12};
    for (int round = 0; round < 400; round++) {
        Vec3 places[12];
        uint32_t faces[24][3];
        size_t count = 1 + (size_t)(random_next(&random) % 24), seams;
        uint64_t most = 4 + random_next(&random) % 9;
        for (int i = 0; i < 12; i++) {
            places[i] = vec3((double)(random_next(&random) % 3), (double)(random_next(&random) % 3),
                             (double)(random_next(&random) % 3));
        }
        for (size_t t = 0; t < count; t++) {
            for (int i = 0; i < 3; i++) faces[t][i] = (uint32_t)(random_next(&random) % most);
        }
        const MeshData data = {.vertices = places,
                               .vertex_count = 12,
                               .triangles = (const uint32_t(*)[3])faces,
                               .triangle_count = count};
        Object object = object_of(OBJECT_TRIANGLES);
        Surface surface = of_object(&object);
        object.as.mesh = &data;
        surface.subdivide = 1 + round % 2;
        surface.uv = (SurfaceUv)(round % 4);
        SurfaceMesh mesh = mesh_of(*state, &surface, 1);
        check_mesh(&mesh, &seams);
        assert_int_equal(mesh.cell_count <= count * (size_t)(surface.subdivide * surface.subdivide), true);
        for (size_t i = 0; i < mesh.uv_count; i++)
            assert_true(isfinite(mesh.uvs[i].u) && isfinite(mesh.uvs[i].v));
        for (size_t c = 0; c < mesh.cell_count; c++) {
            assert_int_equal(mesh.cells[c].degenerate, vec3_length(area_vector(&mesh, c)) < 1e-9);
        }
    }
}

/* Grids whose points fall together at random: patches with collapsed sides, patches that are their own neighbours. */
static void any_grid_gives_a_consistent_mesh(void **state) {
    RandomStream random = {13};
    for (int round = 0; round < 400; round++) {
        Surface surface =
            patches(*state, 1 + (int)(random_next(&random) % 4), 1 + (int)(random_next(&random) % 4), hill);
        Vec3 *points = arena_new_array(*state, Vec3, (size_t)((surface.nu + 1) * (surface.nv + 1)));
        for (int i = 0; i < (surface.nu + 1) * (surface.nv + 1); i++) {
            points[i] = vec3((double)(random_next(&random) % 2), (double)(random_next(&random) % 3),
                             (double)(random_next(&random) % 2));
        }
        surface.points = points;
        size_t seams;
        SurfaceMesh mesh = mesh_of(*state, &surface, 1);
        check_mesh(&mesh, &seams);
        assert_int_equal(mesh.cell_count, surface.nu * surface.nv);
    }
}

/* ---- deform ---- */

static void wave(const void *data, const double *in, double *out) {
    (void)data;
    out[0] = in[0];
    out[1] = in[1] + 0.3 * sin(2 * in[0]) * cos(in[2]);
    out[2] = in[2] + 0.5 * in[1];
}

static const Tape *wave_tape(Arena *arena) {
    static const TapeExternal external = {.name = "wave", .input_count = 3, .output_count = 3, .eval = wave};
    TapeBuilder *builder = tape_builder_create(arena, 3);
    TapeRef inputs[3], outputs[3];
    for (int i = 0; i < 3; i++) inputs[i] = tape_input(builder, i);
    tape_call(builder, &external, inputs, outputs, (Span){0});
    return tape_finish(builder, outputs, 3);
}

static void deforms_are_followed_within_tolerance(void **state) {
    Object box = object_of(OBJECT_BOX);
    Surface surface = of_object(&box);
    size_t seams, last = 0;
    box.as.box.corner1 = vec3(-3, 0, -3);
    box.as.box.corner2 = vec3(3, 1, 3);
    surface.deform = wave_tape(*state);
    for (double tolerance = 0.1; tolerance > 0.001; tolerance /= 4) {
        SurfaceMesh mesh = mesh_of(*state, &surface, tolerance);
        double largest = 0;
        assert_int_equal(check_mesh(&mesh, &seams), 0);
        assert_true(mesh.cell_count > last);
        last = mesh.cell_count;
        for (size_t c = 0; c < mesh.cell_count; c++) {
            Vec3 middle = vec3_splat(0);
            for (int i = 0; i < 3; i++) middle = vec3_madd(middle, vertex(&mesh, c, i), 1.0 / 3);
            /* Vertical distance from the top of the deformed box: z = z0 + y0/2 with y0 = 1. */
            double y = 1 + 0.3 * sin(2 * middle.x) * cos(middle.z - 0.5);
            bool top = true;
            for (int i = 0; i < 3; i++) {
                Vec3 p = vertex(&mesh, c, i);
                top = top && fabs(p.y - 1 - 0.3 * sin(2 * p.x) * cos(p.z - 0.5)) < 1e-9;
            }
            if (top) largest = double_max(largest, fabs(middle.y - y));
        }
        assert_true(largest > 0 && largest < 1.2 * tolerance);
    }
}

static void height_vectors_follow_the_derivative_of_a_deform(void **state) {
    Surface surface = patches(*state, 4, 4, hill);
    Vec3 heights[25];
    for (int i = 0; i < 25; i++) heights[i] = vec3(0.2, 1, 0);
    surface.height_vectors = heights;
    surface.subdivide = 1;
    surface.deform = wave_tape(*state);
    SurfaceMesh mesh = mesh_of(*state, &surface, 1);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        Vec3 p = hill((double)(i / 5) / 4, (double)(i % 5) / 4);
        Vec3 expected = vec3(0.2, 1 + 0.2 * 0.6 * cos(2 * p.x) * cos(p.z), 0.5);
        assert_true(vec3_length(vec3_sub(mesh.height_vectors[i], expected)) < 1e-6);
    }
}

/* ---- refusals, drawing ---- */

static void what_has_no_surface_is_refused(void **state) {
    Object plane = object_of(OBJECT_PLANE);
    Surface endless = of_object(&plane), broken = patches(*state, 1, 1, hill);
    const Vec3 points[4] = {{0, 0, 0}, {1, 0, 0}, {0, (double)INFINITY, 0}, {1, 1, 1}};
    const SurfaceMeshOptions options = {.tolerance = 1};
    SurfaceMesh mesh;
    ShapeRefusal refusal = {0};
    plane.span = (Span){1, 5, 9};
    assert_false(surface_mesh_build(&endless, &options, *state, &mesh, &refusal));
    assert_int_equal(refusal.span.begin, 5);
    broken.points = points;
    broken.span = (Span){1, 6, 9};
    assert_false(surface_mesh_build(&broken, &options, *state, &mesh, &refusal));
    assert_int_equal(refusal.span.begin, 6);
}

static Vec3 saddle(double u, double v) { return vec3(u, u * v, v); }

static void surfaces_are_drawn_within_tolerance(void **state) {
    Surface surface = patches(*state, 1, 1, saddle);
    Object object = object_of(OBJECT_SURFACE);
    object.as.surface = &surface;
    for (double tolerance = 0.1; tolerance > 1e-4; tolerance /= 4) {
        const TessellateOptions options = {.tolerance = tolerance};
        TriangleSoup soup = {0};
        ShapeRefusal refusal;
        assert_true(tessellate(&object, NULL, &options, *state, &soup, &refusal));
        for (size_t t = 0; t < soup.triangles.count; t++) {
            const uint32_t *v = soup.triangles.items[t].vertex;
            for (int e = 0; e < 3; e++) {
                Vec3 p = vec3_lerp(soup.vertices.items[v[e]].position,
                                   soup.vertices.items[v[(e + 1) % 3]].position, 0.5);
                assert_true(fabs(p.y - p.x * p.z) <= tolerance);
            }
        }
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(a_grid_looks_up_and_knows_its_neighbours),
        TEST(grids_that_close_are_joined_at_a_seam),
        TEST(poles_collapse_without_harm),
        TEST(one_sided_surfaces_are_cut_once),
        TEST(given_heights_decide_the_front_and_are_interpolated),
        TEST(closed_solids_have_no_borders_and_look_out),
        TEST(normals_of_spheres_are_exact_and_of_boxes_shared),
        TEST(windings_are_made_consistent),
        TEST(edges_of_three_cells_are_borders_and_thin_cells_are_marked),
        TEST(given_normals_and_vectors_are_kept),
        TEST(normals_that_disagree_are_overruled),
        TEST(generated_coordinates_cover_the_unit_square),
        TEST(any_heap_of_triangles_gives_a_consistent_mesh),
        TEST(any_grid_gives_a_consistent_mesh),
        TEST(deforms_are_followed_within_tolerance),
        TEST(height_vectors_follow_the_derivative_of_a_deform),
        TEST(what_has_no_surface_is_refused),
        TEST(surfaces_are_drawn_within_tolerance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
