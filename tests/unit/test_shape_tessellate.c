/* Tessellations against closed forms: closedness, area, volume, tolerance, normals, texture coordinates. */
#include "object_parts.h"
#include "base/random.h"
#include "shape/tessellate.h"
#include "shape/tessellate_solids.h"
#include "shape/weld.h"

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

static Arena *test_arena(void **state) { return *state; }

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

/* ---- measures ---- */

static Vec3 corner(const TriangleSoup *soup, size_t t, int i) {
    return soup->vertices.items[soup->triangles.items[t].vertex[i]].position;
}

static Vec3 twice_area(const TriangleSoup *soup, size_t t) {
    Vec3 a = corner(soup, t, 0);
    return vec3_cross(vec3_sub(corner(soup, t, 1), a), vec3_sub(corner(soup, t, 2), a));
}

static double soup_area(const TriangleSoup *soup) {
    double sum = 0;
    for (size_t t = 0; t < soup->triangles.count; t++) sum += vec3_length(twice_area(soup, t)) / 2;
    return sum;
}

/* Positive when the winding looks outwards. */
static double soup_volume(const TriangleSoup *soup) {
    double sum = 0;
    for (size_t t = 0; t < soup->triangles.count; t++)
        sum += vec3_dot(corner(soup, t, 0), twice_area(soup, t)) / 6;
    return sum;
}

/* Every edge of the solid triangles, found by exact place, runs once each way (or equally often). */
static bool is_watertight(Arena *arena, const TriangleSoup *soup) {
    size_t count = soup->vertices.count, edge_count = 0;
    Vec3 *points = arena_new_array(arena, Vec3, count);
    uint32_t *place = arena_new_array(arena, uint32_t, count);
    WeldEdge *edges = arena_new_array(arena, WeldEdge, 3 * soup->triangles.count);
    for (size_t i = 0; i < count; i++) points[i] = soup->vertices.items[i].position;
    uint32_t places = weld_points(points, count, 0, arena, place);
    for (uint32_t t = 0; t < soup->triangles.count; t++) {
        const uint32_t *v = soup->triangles.items[t].vertex;
        if (!soup->triangles.items[t].solid) continue;
        for (uint8_t e = 0; e < 3; e++) {
            uint32_t a = place[v[e]], b = place[v[(e + 1) % 3]];
            if (a != b) edges[edge_count++] = (WeldEdge){a < b ? a : b, a < b ? b : a, t, e, a < b};
        }
    }
    weld_sort_edges(edges, edge_count, places, arena);
    for (size_t i = 0, end; i < edge_count; i = end) {
        int balance = 0;
        for (end = i; end < edge_count && edges[end].lo == edges[i].lo && edges[end].hi == edges[i].hi;
             end++) {
            balance += edges[end].forward ? 1 : -1;
        }
        if (balance) return false;
    }
    return edge_count > 0;
}

static void assert_near(double value, double expected, double tolerance) {
    if (!(fabs(value - expected) <= tolerance))
        print_error("%.17g, expected %.17g ± %g\n", value, expected, tolerance);
    assert_true(fabs(value - expected) <= tolerance);
}

static Object object_of(ObjectKind kind) {
    Object object = {.kind = (uint8_t)kind};
    return object;
}

static Object sphere(Vec3 center, double radius) {
    Object object = object_of(OBJECT_SPHERE);
    object.as.sphere.center = center;
    object.as.sphere.radius = radius;
    return object;
}

static Object cone(Vec3 base, double base_radius, Vec3 cap, double cap_radius, bool open) {
    Object object = object_of(OBJECT_CONE);
    object.as.cone.base = base;
    object.as.cone.cap = cap;
    object.as.cone.base_radius = base_radius;
    object.as.cone.cap_radius = cap_radius;
    object.as.cone.open = open;
    return object;
}

static Object torus(double major, double minor) {
    Object object = object_of(OBJECT_TORUS);
    object.as.torus.major_radius = major;
    object.as.torus.minor_radius = minor;
    return object;
}

static Object box(Vec3 a, Vec3 b) {
    Object object = object_of(OBJECT_BOX);
    object.as.box.corner1 = a;
    object.as.box.corner2 = b;
    return object;
}

static TriangleSoup soup_of(Arena *arena, const Object *object, double tolerance, int parts) {
    const TessellateOptions options = {.tolerance = tolerance, .parts = parts};
    TriangleSoup soup = {0};
    ShapeRefusal refusal;
    assert_true(tessellate(object, NULL, &options, arena, &soup, &refusal));
    return soup;
}

/* ---- the circle's points ---- */

static void turns_are_exact_on_axes_and_near_everywhere(void **state) {
    (void)state;
    for (int n = 1; n <= 200; n++) {
        for (int i = -n; i <= 2 * n; i++) {
            double c, s;
            tessellate_turn(i, n, &c, &s);
            assert_near(c, cos(2 * VTS_PI * i / n), 1e-13);
            assert_near(s, sin(2 * VTS_PI * i / n), 1e-13);
            if (4 * i % n == 0) assert_true(c * s == 0);
        }
    }
}

/* ---- single solids ---- */

static void spheres_have_their_area_and_nearly_their_volume(void **state) {
    Arena *arena = test_arena(state);
    double last = 1;
    for (int parts = 1; parts <= 16; parts *= 2) {
        Object object = sphere(vec3(0.3, -2, 5), 1.7);
        TriangleSoup soup = soup_of(arena, &object, 1, parts);
        assert_int_equal(soup.triangles.count, 8 * parts * parts);
        assert_true(is_watertight(arena, &soup));
        assert_near(soup_area(&soup), 4 * VTS_PI * 1.7 * 1.7, 1e-11);
        double bias = 1 - soup_volume(&soup) / (4 * VTS_PI / 3 * 1.7 * 1.7 * 1.7);
        assert_true(bias > 0 && bias < last);
        last = bias / 3; /* converges as 1/parts²: at least by 3 from one to the next */
    }
    assert_true(last < 2e-3);
}

static void closed_cones_are_closed_and_walls_have_their_area(void **state) {
    Arena *arena = test_arena(state);
    RandomStream random = {1};
    for (int i = 0; i < 200; i++) {
        Vec3 base = vec3(random_next_unit(&random), random_next_unit(&random), random_next_unit(&random));
        Vec3 cap = i % 10 == 0 ? vec3_add(base, vec3(0, 0, i % 20 ? -1 : 1))
                               : vec3(random_next_unit(&random) * 3, random_next_unit(&random),
                                      random_next_unit(&random));
        double r0 = i % 7 == 0 ? 0 : random_next_unit(&random), r1 = i % 7 == 1   ? 0
                                                                     : i % 7 == 2 ? r0
                                                                                  : random_next_unit(&random);
        double h = vec3_length(vec3_sub(cap, base));
        Object object = cone(base, r0, cap, r1, false);
        TriangleSoup soup = soup_of(arena, &object, 1e-4, 0);
        assert_true(is_watertight(arena, &soup));
        assert_near(soup_volume(&soup), VTS_PI * h / 3 * (r0 * r0 + r0 * r1 + r1 * r1),
                    1e-4 * (soup_area(&soup) + h));
        double slant = sqrt(h * h + (r0 - r1) * (r0 - r1));
        assert_near(soup_area(&soup), VTS_PI * ((r0 + r1) * slant + r0 * r0 + r1 * r1), 1e-11);
        object.as.cone.open = true;
        TriangleSoup wall = soup_of(arena, &object, 1e-4, 0);
        assert_near(soup_area(&wall), VTS_PI * (r0 + r1) * sqrt(h * h + (r0 - r1) * (r0 - r1)), 1e-11);
        for (size_t t = 0; t < wall.triangles.count; t++) assert_false(wall.triangles.items[t].solid);
    }
}

static void cylinder_walls_have_their_area_however_coarse(void **state) {
    Arena *arena = test_arena(state);
    for (int parts = 1; parts < 5; parts++) {
        Object object = cone(vec3(1, 2, 3), 0.5, vec3(-1, 2.5, 7), 0.5, true);
        TriangleSoup soup = soup_of(arena, &object, 1, parts);
        assert_near(soup_area(&soup), VTS_PI * vec3_length(vec3(2, 0.5, 4)), 1e-12);
    }
}

static void boxes_are_exact(void **state) {
    Arena *arena = test_arena(state);
    for (int parts = 0; parts < 4; parts++) {
        Object object = box(vec3(1, 5, -1), vec3(-0.1, 2, 0.7));
        TriangleSoup soup = soup_of(arena, &object, 1, parts);
        assert_true(is_watertight(arena, &soup));
        assert_near(soup_volume(&soup), 1.1 * 3 * 1.7, 1e-12);
        assert_near(soup_area(&soup), 2 * (1.1 * 3 + 3 * 1.7 + 1.7 * 1.1), 1e-12);
    }
}

static void tori_and_discs_have_their_area(void **state) {
    Arena *arena = test_arena(state);
    for (int parts = 2; parts <= 8; parts *= 2) {
        Object ring = torus(2, 0.5), plate = object_of(OBJECT_DISC);
        TriangleSoup soup = soup_of(arena, &ring, 1, parts);
        assert_true(is_watertight(arena, &soup));
        assert_near(soup_area(&soup) / (4 * VTS_PI * VTS_PI), 1, 1e-6);
        assert_near(soup_volume(&soup) / (2 * VTS_PI * VTS_PI * 0.5), 1, 0.5 / (parts * parts));
        Object spindle = torus(0.5, 2), point = torus(0, 1);
        Object barely = torus(1, 1.0000001);
        TriangleSoup almost = soup_of(arena, &barely, 1, parts);
        assert_near(soup_area(&almost) / (4 * VTS_PI * VTS_PI), 1, 0.01);
        TriangleSoup lemonless = soup_of(arena, &spindle, 1, parts), round = soup_of(arena, &point, 1, parts);
        double pole = acos(0.25);
        assert_true(is_watertight(arena, &lemonless) && is_watertight(arena, &round));
        assert_true(soup_volume(&lemonless) > 0);
        assert_near(soup_area(&lemonless) / (4 * VTS_PI * 2 * (0.5 * (VTS_PI - pole) + 2 * sin(pole))), 1,
                    1e-5);
        assert_near(soup_area(&round), 4 * VTS_PI, 1e-4);
        plate.as.disc.center = vec3(1, 2, 3);
        plate.as.disc.normal = vec3(0, -3, 0.1);
        plate.as.disc.radius = 2;
        plate.as.disc.hole_radius = parts == 4 ? 0 : 0.5;
        TriangleSoup flat = soup_of(arena, &plate, 1, parts);
        assert_near(soup_area(&flat), VTS_PI * (4 - (parts == 4 ? 0 : 0.25)), 1e-12);
        for (size_t t = 0; t < flat.triangles.count; t++)
            assert_true(vec3_dot(twice_area(&flat, t), plate.as.disc.normal) > 0);
    }
}

/* ---- tolerance: points all over the triangles against the distance from the surface ---- */

static double sphere_distance(const Object *o, Vec3 p) {
    return vec3_length(vec3_sub(p, o->as.sphere.center)) - o->as.sphere.radius;
}
static double torus_distance(const Object *o, Vec3 p) {
    return hypot(hypot(p.x, p.z) - o->as.torus.major_radius, p.y) - o->as.torus.minor_radius;
}
static double wall_distance(const Object *o, Vec3 p) { return hypot(p.x, p.z) - o->as.cone.base_radius; }

static double largest_distance(const TriangleSoup *soup, const Object *object,
                               double (*distance)(const Object *, Vec3)) {
    double largest = 0;
    for (size_t t = 0; t < soup->triangles.count; t++) {
        for (int i = 0; i <= 6; i++) {
            for (int j = 0; j <= 6 - i; j++) {
                Vec3 p = vec3_add(vec3_scale(corner(soup, t, 0), i / 6.0),
                                  vec3_scale(corner(soup, t, 1), j / 6.0));
                p = vec3_madd(p, corner(soup, t, 2), (6 - i - j) / 6.0);
                largest = double_max(largest, fabs(distance(object, p)));
            }
        }
    }
    return largest;
}

static void tolerance_is_kept_and_not_wasted(void **state) {
    Arena *arena = test_arena(state);
    for (double tolerance = 0.1; tolerance > 5e-5; tolerance /= 3) {
        Object ball = sphere(vec3(1, 1, 1), 1.5), ring = torus(2, 0.6);
        Object wall = cone(vec3(0, 0, 0), 0.8, vec3(0, 2, 0), 0.8, true);
        TriangleSoup a = soup_of(arena, &ball, tolerance, 0), b = soup_of(arena, &ring, tolerance, 0);
        TriangleSoup c = soup_of(arena, &wall, tolerance, 0);
        double of_ball = largest_distance(&a, &ball, sphere_distance),
               of_ring = largest_distance(&b, &ring, torus_distance);
        double of_wall = largest_distance(&c, &wall, wall_distance);
        assert_true(of_ball <= tolerance && of_ring <= tolerance && of_wall <= tolerance);
        if (tolerance < 0.005)
            assert_true(of_ball > 0.5 * tolerance && of_ring > 0.4 * tolerance && of_wall > 0.5 * tolerance);
    }
}

static void tolerance_is_that_of_the_output(void **state) {
    Arena *arena = test_arena(state);
    Object ball = sphere(vec3(0, 0, 0), 1), large = ball;
    const Transform wide = transform_scale(vec3(100, 1, 100));
    large.place = PLACE(wide);
    ball.as.sphere.radius = 100;
    TriangleSoup a = soup_of(arena, &ball, 0.1, 0), b = soup_of(arena, &large, 0.1, 0);
    assert_int_equal(a.triangles.count, b.triangles.count);
}

/* ---- normals, windings, texture coordinates ---- */

static void check_attributes(const TriangleSoup *soup) {
    for (size_t i = 0; i < soup->vertices.count; i++) {
        const SoupVertex *vertex = &soup->vertices.items[i];
        assert_near(vec3_length(vertex->normal), 1, 1e-9);
        assert_true(vertex->uv.u >= 0 && vertex->uv.u <= 1 && vertex->uv.v >= 0 && vertex->uv.v <= 1);
    }
    for (size_t t = 0; t < soup->triangles.count; t++) {
        Vec3 sum = vec3_splat(0);
        for (int i = 0; i < 3; i++)
            sum = vec3_add(sum, soup->vertices.items[soup->triangles.items[t].vertex[i]].normal);
        assert_true(vec3_dot(sum, twice_area(soup, t)) > 0);
    }
}

static void attributes_survive_any_transform(void **state) {
    Arena *arena = test_arena(state);
    const Transform transforms[3] = {
        transform_identity(), transform_scale(vec3(-1, 0.2, 3)),
        transform_matrix((const double[12]){1, 0.3, 0, 0, 1, 0.5, 0.2, 0, -1, 7, 8, 9})};
    Object objects[6] = {sphere(vec3(0, 0, 0), 1),
                         box(vec3(-1, -1, -1), vec3(1, 2, 1)),
                         torus(1, 0.3),
                         cone(vec3(0, 0, 0), 1, vec3(0, 1, 1), 0, false),
                         cone(vec3(0, 0, 0), 1, vec3(0, 1, 1), 0.5, true),
                         cone(vec3(3, 0, 0), 0, vec3(0, 1, 0), 0.5, false)};
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < 3; k++) {
            objects[i].place = PLACE(transforms[k]);
            TriangleSoup soup = soup_of(arena, &objects[i], 0.02, 0);
            check_attributes(&soup);
            if (i != 4) assert_true(is_watertight(arena, &soup) && soup_volume(&soup) > 0);
        }
    }
}

static void flattened_solids_are_finite(void **state) {
    Object ball = sphere(vec3(0, 0, 0), 1);
    const Transform flat = transform_scale(vec3(1, 0, 1));
    ball.place = PLACE(flat);
    TriangleSoup soup = soup_of(test_arena(state), &ball, 0.01, 0);
    for (size_t i = 0; i < soup.vertices.count; i++) {
        assert_true(vec3_is_finite(soup.vertices.items[i].position) &&
                    vec3_is_finite(soup.vertices.items[i].normal));
    }
}

/* ---- meshes ---- */

static const Vec3 tetrahedron[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const uint32_t tetrahedron_faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

static void closed_parts_of_meshes_are_solid(void **state) {
    Arena *arena = test_arena(state);
    Vec3 vertices[9];
    uint32_t faces[6][3];
    memcpy(vertices, tetrahedron, sizeof tetrahedron);
    memcpy(faces, tetrahedron_faces, sizeof tetrahedron_faces);
    for (int i = 0; i < 5; i++) vertices[4 + i] = vec3(i, 3, i * i);
    memcpy(faces[4], (const uint32_t[3]){4, 5, 6}, sizeof faces[4]);
    memcpy(faces[5], (const uint32_t[3]){6, 7, 8}, sizeof faces[5]);
    const MeshData mesh = {.vertices = vertices,
                           .vertex_count = 9,
                           .triangles = (const uint32_t(*)[3])faces,
                           .triangle_count = 6};
    Object object = object_of(OBJECT_TRIANGLES);
    object.as.mesh = &mesh;
    for (int parts = 0; parts < 5; parts++) {
        TriangleSoup soup = soup_of(arena, &object, 1, parts);
        size_t each = parts > 1 ? (size_t)(parts * parts) : 1;
        assert_int_equal(soup.triangles.count, 6 * each);
        for (size_t t = 0; t < 6 * each; t++) assert_int_equal(soup.triangles.items[t].solid, t < 4 * each);
        assert_true(is_watertight(arena, &soup));
        soup.triangles.count = 4 * each;
        assert_near(soup_volume(&soup), 1.0 / 6, 1e-15);
    }
}

static void meshes_that_make_no_sense_are_refused(void **state) {
    const uint32_t faces[1][3] = {{0, 1, 4}};
    const Vec3 broken[4] = {{0, 0, 0}, {1, (double)NAN, 0}, {0, 1, 0}, {0, 0, 1}};
    MeshData mesh = {.vertices = tetrahedron, .vertex_count = 4, .triangles = faces, .triangle_count = 1};
    Object object = object_of(OBJECT_TRIANGLES);
    const TessellateOptions options = {.tolerance = 1};
    TriangleSoup soup = {0};
    ShapeRefusal refusal = {0};
    object.span = (Span){1, 20, 30};
    object.as.mesh = &mesh;
    assert_false(tessellate(&object, NULL, &options, test_arena(state), &soup, &refusal));
    assert_non_null(refusal.reason);
    assert_int_equal(refusal.span.begin, 20);
    mesh.vertices = broken;
    mesh.triangles = tetrahedron_faces;
    assert_false(tessellate(&object, NULL, &options, test_arena(state), &soup, &refusal));
}

/* ---- trees ---- */

static Transform random_transform(RandomStream *random) {
    Vec3 angles =
        vec3(360 * random_next_unit(random), 360 * random_next_unit(random), 360 * random_next_unit(random));
    Vec3 size = vec3(0.2 + random_next_unit(random),
                     (random_next_unit(random) < 0.5 ? -1 : 1) * (0.2 + random_next_unit(random)),
                     0.2 + random_next_unit(random));
    Transform turn = transform_rotate(angles), scale = transform_scale(size),
              move = transform_translate(angles);
    scale = transform_then(&scale, &turn);
    return transform_then(&scale, &move);
}

/* Returns the tree's volume: of the children, times the determinants. */
static double random_tree(Arena *arena, RandomStream *random, int depth, Object *out) {
    double u = random_next_unit(random), volume = 0;
    *out = object_of(OBJECT_UNION);
    if (depth == 0 && u < 0.5)
        *out = box(vec3(0, 0, 0), vec3(1, 2, 3)), volume = 6;
    else if (depth == 0)
        *out = sphere(vec3(1, 2, 3), 0.5), volume = 4 * VTS_PI / 3 * 0.125;
    const Object **items = arena_new_array(arena, const Object *, 4);
    for (size_t i = 0; depth > 0 && i < 4; i++) {
        Object *child = arena_new(arena, Object);
        volume += random_tree(arena, random, depth - 1, child);
        items[i] = child;
    }
    if (depth > 0) out->as.group = arena_copy(arena, GROUP(items, 4), sizeof(ObjectGroup));
    const Transform place = random_transform(random);
    out->place = arena_copy(arena, PLACE(place), sizeof(Affine));
    return volume * fabs(mat3_determinant(&place.linear));
}

static void random_trees_have_their_volume_and_are_closed(void **state) {
    Arena *arena = test_arena(state);
    RandomStream random = {7};
    for (int i = 0; i < 20; i++) {
        Object tree;
        double volume = random_tree(arena, &random, i % 4, &tree);
        TriangleSoup soup = soup_of(arena, &tree, 1e-3, 0);
        assert_true(is_watertight(arena, &soup));
        Vec3 middle = soup.vertices.items[0].position; /* volumes far from the origin cancel badly */
        for (size_t k = 0; k < soup.vertices.count; k++) {
            soup.vertices.items[k].position = vec3_sub(soup.vertices.items[k].position, middle);
        }
        assert_near(soup_volume(&soup) / volume, 1, 0.02);
    }
}

static void what_has_no_triangles_is_refused_with_its_place(void **state) {
    static const ObjectKind kinds[] = {OBJECT_PLANE, OBJECT_INTERSECTION, OBJECT_DIFFERENCE,
                                       OBJECT_TEXEL, OBJECT_UNMODELLED,   OBJECT_PARTICLES};
    const TessellateOptions options = {.tolerance = 1};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(kinds); i++) {
        Object bad = object_of(kinds[i]), good = sphere(vec3(0, 0, 0), 1), tree = object_of(OBJECT_UNION);
        const Object *children[2] = {&good, &bad};
        TriangleSoup soup = {0};
        ShapeRefusal refusal = {0};
        Object endless = object_of(OBJECT_PLANE);
        const Object *only[1] = {&endless};
        endless.as.plane.normal = vec3(0, 1, 0);
        endless.span = bad.span = (Span){1, 100, 110};
        const ObjectGroup alone = {.items = only, .count = 1};
        if (object_has_group(&bad)) bad.as.group = &alone;
        tree.as.group = GROUP(children, 2);
        assert_false(tessellate(&tree, NULL, &options, test_arena(state), &soup, &refusal));
        assert_non_null(refusal.reason);
        assert_int_equal(refusal.span.begin, 100);
    }
}

/* ---- interruption ---- */

typedef struct Impatience {
    atomic_bool given_up;
    size_t told, most;
} Impatience;

static void give_up_after(void *context, const char *stage, size_t done, size_t total) {
    Impatience *i = context;
    assert_string_equal(stage, "set");
    assert_true(done < total);
    if (i->told++ == i->most) i->given_up = true;
}

static void sets_tell_how_far_they_are_and_may_be_interrupted(void **state) {
    const ObjectKind kind = OBJECT_SPHERE;
    Object parts[6];
    const Object *items[6];
    for (int i = 0; i < 6; i++) {
        parts[i] = (Object){.kind = kind, .as.sphere = {{0.3 * i, 0, 0}, 0.5}};
        items[i] = &parts[i];
    }
    ObjectGroup group = {.items = items, .count = 6};
    const Object set = {.kind = OBJECT_MERGE, .as.group = &group};
    for (size_t most = 0; most < 7; most += 3) {
        Impatience impatience = {false, 0, most};
        const Progress progress = {give_up_after, &impatience};
        const TessellateOptions options = {.tolerance = 0.01, .interrupted = &impatience.given_up, .progress = &progress, .stage = "set"};
        TriangleSoup soup = {0};
        ShapeRefusal refusal = {0};
        bool done = tessellate(&set, NULL, &options, test_arena(state), &soup, &refusal);
        assert_int_equal(done, most >= 6);
        assert_int_equal(refusal.reason != NULL, !done);
        assert_int_equal(impatience.told, most >= 6 ? 6 : most + 1);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(turns_are_exact_on_axes_and_near_everywhere),
        TEST(spheres_have_their_area_and_nearly_their_volume),
        TEST(closed_cones_are_closed_and_walls_have_their_area),
        TEST(cylinder_walls_have_their_area_however_coarse),
        TEST(boxes_are_exact),
        TEST(tori_and_discs_have_their_area),
        TEST(tolerance_is_kept_and_not_wasted),
        TEST(tolerance_is_that_of_the_output),
        TEST(attributes_survive_any_transform),
        TEST(flattened_solids_are_finite),
        TEST(closed_parts_of_meshes_are_solid),
        TEST(meshes_that_make_no_sense_are_refused),
        TEST(random_trees_have_their_volume_and_are_closed),
        TEST(what_has_no_triangles_is_refused_with_its_place),
        TEST(sets_tell_how_far_they_are_and_may_be_interrupted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
