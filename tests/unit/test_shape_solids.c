/* Rays against every kind of solid, proved by what is inside: the surface is met where, and only where, the inside begins or
 * ends, and normals stand on it. Where shapes of different kinds are the same body, they give the same numbers. */
#include "object_parts.h"
#include "scene/scene_hash.h"
#include "shape/extent.h"
#include "shape/roots.h"
#include "tape/tape.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

#include <string.h>

static Arena arena;
static uint64_t state = 12345;

static double uniform(double lo, double hi) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return lo + (hi - lo) * (double)(state >> 11) / 9007199254740992.0;
}

static Vec3 random_point(double size) {
    return vec3(uniform(-size, size), uniform(-size, size), uniform(-size, size));
}

static int setup(void **context) {
    (void)context;
    arena_init(&arena, NULL, 0);
    return 0;
}

static int teardown(void **context) {
    (void)context;
    arena_destroy(&arena);
    return 0;
}

static void move(Object *object, Transform transform) { object->place = arena_copy(&arena, PLACE(transform), sizeof(Affine)); }

static Object solid_object(Solid solid) {
    Solid *kept = arena_copy(&arena, &solid, sizeof solid);
    solid_rehash(kept);
    Object object = {
        .kind = OBJECT_SOLID, .as.solid = kept};
    return object;
}

/* ---- the bodies ---- */

static Object sphere(Vec3 center, double radius) {
    Object o = {.kind = OBJECT_SPHERE};
    o.as.sphere.center = center;
    o.as.sphere.radius = radius;
    return o;
}

static Object container_box(Vec3 lo, Vec3 hi) {
    Object o = {.kind = OBJECT_BOX};
    o.as.box.corner1 = lo;
    o.as.box.corner2 = hi;
    return o;
}

static Object unit_quadric(void) {
    Solid s = {.kind = SOLID_QUADRIC};
    s.as.quadric.squares = vec3(1, 1, 1);
    s.as.quadric.constant = -1;
    return solid_object(s);
}

static Object unit_poly(void) {
    static const double c[10] = {1, 0, 0, 0, 1, 0, 0, 1, 0, -1};
    return solid_object((Solid){.kind = SOLID_POLYNOMIAL, .as.polynomial = {2, c, 10}});
}

/* (x² + y² + z² + R² - r²)² - 4R²(x² + z²) */
static Object quartic_torus(double major, double minor) {
    double k = major * major - minor * minor, *c = arena_new_array(&arena, double, 35);
    size_t n = 0;
    for (int i = 4; i >= 0; i--)
        for (int j = 4 - i; j >= 0; j--)
            for (int m = 4 - i - j; m >= 0; m--, n++) {
                bool even = i % 2 == 0 && j % 2 == 0 && m % 2 == 0;
                int order = i + j + m;
                if (even && order == 4) c[n] = i == 4 || j == 4 || m == 4 ? 1 : 2;
                if (even && order == 2) c[n] = 2 * k - (j == 2 ? 0 : 4 * major * major);
                if (order == 0) c[n] = k * k;
            }
    return solid_object((Solid){.kind = SOLID_POLYNOMIAL, .as.polynomial = {4, c, 35}});
}

static Object blob_of(const BlobPart *parts, size_t count, double threshold) {
    return solid_object((Solid){
        .kind = SOLID_BLOB, .as.blob = {.threshold = threshold, .parts = arena_copy(&arena, parts, count * sizeof *parts), .count = count}});
}

static Object some_blob(void) {
    const BlobPart parts[] = {
        {{0, 0, 0}, {0, 0, 0}, 1, 1, transform_scale(vec3(1, 1.3, 0.8)), NULL},
        {{0.2, 0.1, 0}, {1, 0.5, 0.4}, 0.6, 1.2, transform_identity(), NULL},
        {{-0.3, 0.4, 0.1}, {-0.3, 0.4, 0.1}, 0.7, -0.9, transform_identity(), NULL},
    };
    return blob_of(parts, 3, 0.4);
}

static Object turned(SolidKind kind, CurveKind curve, const Point2 *points, size_t count) {
    return solid_object(
        (Solid){.kind = kind,
                .as.turned = {curve, arena_copy(&arena, points, count * sizeof *points), count, false}});
}

static Object some_lathe(CurveKind curve) {
    static const Point2 line[] = {{0, -1}, {1, -0.6}, {0.4, 0.2}, {0.9, 0.7}, {0, 1}};
    static const Point2 smooth[] = {{-0.5, -1.2}, {0, -1}, {1, -0.6},  {0.4, 0.2},
                                    {0.9, 0.7},   {0, 1},  {-0.5, 0.9}};
    static const Point2 bezier[] = {{0, -1},    {1.5, -1},  {0.2, 0}, {0.6, 0.3},
                                    {0.6, 0.3}, {0.8, 0.5}, {0.5, 1}, {0, 1}};
    if (curve == CURVE_LINEAR) return turned(SOLID_LATHE, curve, line, 5);
    if (curve == CURVE_BEZIER) return turned(SOLID_LATHE, curve, bezier, 8);
    return turned(SOLID_LATHE, curve, curve == CURVE_CUBIC ? smooth : smooth, curve == CURVE_CUBIC ? 7 : 6);
}

static Object some_sor(void) {
    static const Point2 points[] = {{0.3, -1.3}, {0.5, -1}, {1, -0.3}, {0.4, 0.4}, {0.7, 1}, {0.7, 1.2}};
    return turned(SOLID_SOR, CURVE_CUBIC, points, 6);
}

static Object some_prism(CurveKind curve, bool conic) {
    static const Point2 line[] = {{-1, -1},     {1, -0.8}, {0.2, 0.1},   {0.9, 1},    {-1, -1},
                                  {-0.5, -0.7}, {0, -0.6}, {-0.1, -0.3}, {-0.5, -0.7}};
    static const Point2 cubic[] = {{-0.8, 0.8}, {-0.8, -0.8}, {0.9, -0.7},  {0.2, 0.1},
                                   {0.8, 0.8},  {-0.8, 0.8},  {-0.8, -0.8}, {0.9, -0.7}};
    static const Point2 bezier[] = {{-0.8, 0}, {-0.8, 1.4}, {0.9, 1},    {0.8, 0},
                                    {0.8, 0},  {0.3, -0.9}, {-0.2, 0.3}, {-0.8, 0}};
    const Point2 *points = curve == CURVE_LINEAR ? line : curve == CURVE_BEZIER ? bezier : cubic;
    size_t count = curve == CURVE_LINEAR ? 9 : curve == CURVE_QUADRATIC ? 7 : 8;
    Solid s = {.kind = SOLID_PRISM};
    s.as.prism.curve = curve;
    s.as.prism.conic = conic;
    s.as.prism.low = conic ? 0.3 : -0.6;
    s.as.prism.high = conic ? 1.1 : 0.5;
    s.as.prism.points = points;
    s.as.prism.count = count;
    return solid_object(s);
}

static Object some_sweep(CurveKind curve) {
    static const SweepSphere spheres[] = {{{-1, -0.5, 0}, 0.3},
                                          {{-0.4, 0.5, 0.3}, 0.25},
                                          {{0.3, -0.4, -0.3}, 0.4},
                                          {{0.6, 0.6, 0.2}, 0.2},
                                          {{1, 0, 0.6}, 0.15}};
    return solid_object((Solid){.kind = SOLID_SWEEP, .as.sweep = {curve, spheres, 5}});
}

static Object some_ovus(double bottom, double top) {
    return solid_object((Solid){.kind = SOLID_OVUS, .as.ovus = {bottom, top}});
}

static Object super(double e, double n) {
    return solid_object((Solid){.kind = SOLID_SUPERELLIPSOID, .as.superellipsoid = {e, n}});
}

static Object height_field(void) {
    enum { SIDE = 23 };
    double *heights = arena_new_array(&arena, double, SIDE *SIDE);
    for (int i = 0; i < SIDE * SIDE; i++) heights[i] = 0.5 + 0.4 * sin(i % SIDE * 0.7) * cos(i / SIDE * 0.5);
    Solid s = {.kind = SOLID_HEIGHT_FIELD};
    s.as.field.columns = s.as.field.rows = SIDE;
    s.as.field.heights = heights;
    return solid_object(s);
}

/* x² + y² + z² - 1 + 0.3 sin(5x) sin(5y) */
static Object isosurface(bool wavy, double half) {
    TapeBuilder *b = tape_builder_create(&arena, 3);
    Span none = {0};
    TapeRef sum = tape_constant(b, -1);
    for (int i = 0; i < 3; i++)
        sum = tape_binary(b, TAPE_ADD, sum,
                          tape_binary(b, TAPE_MUL, tape_input(b, i), tape_input(b, i), none), none);
    if (wavy) {
        TapeRef waves = tape_constant(b, 0.3);
        for (int i = 0; i < 2; i++)
            waves = tape_binary(
                b, TAPE_MUL, waves,
                tape_unary(b, TAPE_SIN, tape_binary(b, TAPE_MUL, tape_constant(b, 5), tape_input(b, i), none),
                           none),
                none);
        sum = tape_binary(b, TAPE_ADD, sum, waves, none);
    }
    Object box = container_box(vec3_splat(-half), vec3_splat(half));
    Solid s = {.kind = SOLID_ISOSURFACE};
    s.as.isosurface.function = tape_finish(b, &sum, 1);
    s.as.isosurface.container = arena_copy(&arena, &box, sizeof box);
    s.as.isosurface.accuracy = 0.001;
    s.as.isosurface.max_gradient = 6;
    return solid_object(s);
}

static Object set_of(ObjectKind kind, const Object *children, size_t count) {
    const Object **items = arena_new_array(&arena, const Object *, count);
    for (size_t i = 0; i < count; i++) items[i] = arena_copy(&arena, &children[i], sizeof *children);
    Object o = {.kind = (uint8_t)kind};
    o.as.group = arena_copy(&arena, GROUP(items, count), sizeof(ObjectGroup));
    return o;
}

static Object some_set(ObjectKind kind) {
    Object children[3] = {sphere(vec3(0, 0, 0), 0.8),
                          container_box(vec3(-0.2, -0.3, -0.9), vec3(0.9, 0.6, 0.5)), unit_poly()};
    move(&children[2], transform_scale(vec3(0.5, 0.9, 0.4)));
    return set_of(kind, children, 3);
}

/* ---- the proof ---- */

enum { MOST_HITS = 64 };

static int all_hits(ShapeTracer *tracer, const Object *o, const Ray *ray, TraceHit hits[MOST_HITS]) {
    int count = 0;
    double from = 0;
    while (count < MOST_HITS && shape_trace(tracer, o, ray, from, &hits[count])) {
        from = hits[count].t + 1e-9;
        count++;
    }
    return count;
}

static bool inside_at(ShapeTracer *tracer, const Object *o, const Ray *ray, double t) {
    return shape_trace_inside(tracer, o, vec3_madd(ray->origin, ray->direction, t));
}

/* Where brute marching sees a change, bisection tells the place, and a hit must be there. Changes closer to each other than
 * the march's step may stay unseen; hits where nothing changes may only touch or lie within rounding of another. */
static void check_ray(ShapeTracer *tracer, const Object *o, const Ray *ray, const char *name,
                      double near_error) {
    enum { STEPS = 700 };
    const double far = 7;
    TraceHit hits[MOST_HITS];
    int count = all_hits(tracer, o, ray, hits);
    bool in = inside_at(tracer, o, ray, 1e-7);
    for (int i = 1; i <= STEPS; i++) {
        double a = (i - 1) * far / STEPS + 1e-7, b = i * far / STEPS + 1e-7;
        bool there = inside_at(tracer, o, ray, b);
        if (there == in) continue;
        for (int k = 0; k < 60; k++) {
            double middle = (a + b) / 2;
            if (inside_at(tracer, o, ray, middle) == in)
                a = middle;
            else
                b = middle;
        }
        double nearest = VTS_INFINITY;
        for (int k = 0; k < count; k++) nearest = double_min(nearest, fabs(hits[k].t - a));
        if (nearest > near_error)
            fail_msg("%s: inside changes at t = %.17g, the nearest hit is %g away", name, a, nearest);
        in = there;
    }
}

static void check_hits(ShapeTracer *tracer, const Object *o, const Ray *ray, const char *name, bool outward) {
    const double off = 1e-5;
    TraceHit hits[MOST_HITS];
    int count = all_hits(tracer, o, ray, hits);
    for (int k = 0; k < count; k++) {
        double slant = vec3_dot(hits[k].normal, ray->direction);
        bool alone = (k == 0 || hits[k].t - hits[k - 1].t > 1e-3) &&
                     (k + 1 == count || hits[k + 1].t - hits[k].t > 1e-3);
        assert_true(fabs(vec3_length(hits[k].normal) - 1) < 1e-9);
        if (fabs(slant) < 0.05 || !alone) continue;
        bool before = inside_at(tracer, o, ray, hits[k].t - off),
             after = inside_at(tracer, o, ray, hits[k].t + off);
        if (before == after) continue; /* an edge */
        if (outward && before != (slant > 0))
            fail_msg("%s: the normal at t = %.17g looks inward", name, hits[k].t);
    }
}

static void prove(Object o, const char *name, double size, double near_error, bool outward) {
    ShapeTracer *tracer = shape_tracer_create(&arena);
    Transform moves[] = {transform_identity(), transform_rotate(vec3(20, 40, 60))};
    Transform shift = transform_translate(vec3(0.1, -0.2, 0.3)),
              stretch = transform_scale(vec3(0.8, 1.1, 0.9));
    moves[1] = transform_then(&moves[1], &stretch);
    moves[1] = transform_then(&moves[1], &shift);
    int met = 0;
    for (int i = 0; i < 120; i++) {
        move(&o, moves[i % 2]);
        Vec3 from = vec3_scale(vec3_normalize(random_point(1)), 3), to = random_point(size);
        const Ray ray = {from, vec3_normalize(vec3_sub(to, from))};
        TraceHit hit;
        met += shape_trace(tracer, &o, &ray, 0, &hit);
        check_ray(tracer, &o, &ray, name, near_error);
        check_hits(tracer, &o, &ray, name, outward);
    }
    if (met < 20) fail_msg("%s: only %d rays of 120 met it", name, met);
}

static void test_algebraic(void **context) {
    (void)context;
    prove(unit_quadric(), "quadric", 0.8, 1e-8, true);
    prove(unit_poly(), "poly", 0.8, 1e-8, true);
    prove(quartic_torus(0.8, 0.3), "quartic", 0.8, 1e-7, true);
    prove(super(0.5, 0.3), "superellipsoid", 0.8, 1e-8, true);
    prove(super(1.6, 1.2), "superellipsoid 2", 0.6, 1e-8, true);
    prove(super(2.5, 3), "superellipsoid 3", 0.3, 1e-6, true);
}

static void test_round(void **context) {
    (void)context;
    prove(some_ovus(0.8, 0.4), "ovus", 0.8, 1e-8, true);
    prove(some_ovus(0.5, 0.8), "ovus wide", 0.8, 1e-8, true);
    prove(some_ovus(0.4, 0.9), "ovus single", 0.8, 1e-8, true);
    prove(some_blob(), "blob", 0.8, 1e-7, true);
    prove(some_sweep(CURVE_LINEAR), "sphere_sweep linear", 0.8, 1e-7, true);
    prove(some_sweep(CURVE_CUBIC), "sphere_sweep cubic", 0.8, 1e-6, true);
    prove(some_sweep(CURVE_B_SPLINE), "sphere_sweep b", 0.4, 1e-6, true);
}

static void test_turned(void **context) {
    (void)context;
    prove(some_lathe(CURVE_LINEAR), "lathe linear", 0.8, 1e-7, true);
    prove(some_lathe(CURVE_QUADRATIC), "lathe quadratic", 0.8, 1e-6, true);
    prove(some_lathe(CURVE_CUBIC), "lathe cubic", 0.8, 1e-6, true);
    prove(some_lathe(CURVE_BEZIER), "lathe bezier", 0.8, 1e-6, true);
    prove(some_sor(), "sor", 0.8, 1e-7, true);
}

static void test_prisms(void **context) {
    static const char *const names[] = {"prism linear", "prism quadratic", "prism cubic", "prism bezier"};
    (void)context;
    for (CurveKind curve = CURVE_LINEAR; curve <= CURVE_BEZIER; curve++) {
        prove(some_prism(curve, false), names[curve], 0.8, 1e-7, false);
        prove(some_prism(curve, true), names[curve], 0.8, 1e-7, false);
    }
}

static void test_fields(void **context) {
    (void)context;
    prove(isosurface(true, 1.3), "isosurface", 0.8, 1e-8, true);
    prove(isosurface(true, 0.7), "isosurface cut", 0.8, 1e-8, true);
}

static void test_sets(void **context) {
    (void)context;
    prove(some_set(OBJECT_INTERSECTION), "intersection", 0.5, 1e-8, true);
    prove(some_set(OBJECT_DIFFERENCE), "difference", 0.8, 1e-8, true);
    prove(some_set(OBJECT_MERGE), "merge", 0.8, 1e-8, true);
    prove(some_set(OBJECT_UNION), "union", 0.8, 1e-8, false);
    Object turned_out = some_set(OBJECT_UNION);
    turned_out.inverse = true;
    prove(turned_out, "inverse union", 0.8, 1e-8, true);
    Object nested[2] = {some_set(OBJECT_DIFFERENCE), some_blob()};
    prove(set_of(OBJECT_DIFFERENCE, nested, 2), "difference of sets", 0.8, 1e-7, true);
}

/* ---- one body, several kinds ---- */

static void same_hits(Object a, Object b, double error, const char *name) {
    ShapeTracer *tracer = shape_tracer_create(&arena);
    for (int i = 0; i < 400; i++) {
        Vec3 from = random_point(3), to = random_point(0.9);
        const Ray ray = {from, vec3_normalize(vec3_sub(to, from))};
        TraceHit first[MOST_HITS], second[MOST_HITS];
        int n = all_hits(tracer, &a, &ray, first), m = all_hits(tracer, &b, &ray, second);
        bool grazing = false;
        for (int k = 0; k < n; k++) grazing |= fabs(vec3_dot(first[k].normal, ray.direction)) < 0.05;
        if (grazing) continue;
        if (n != m) fail_msg("%s: %d hits and %d hits", name, n, m);
        for (int k = 0; k < n; k++) {
            if (fabs(first[k].t - second[k].t) > error)
                fail_msg("%s: %.17g and %.17g", name, first[k].t, second[k].t);
            assert_true(vec3_length(vec3_sub(first[k].normal, second[k].normal)) < 1e4 * error);
        }
    }
}

static void test_spheres(void **context) {
    (void)context;
    Object ball = sphere(vec3(0, 0, 0), 1);
    const BlobPart part = {{0, 0, 0}, {0, 0, 0}, 2, 16.0 / 9, transform_identity(), NULL}; /* (1 - 1/4)²·16/9 = 1 */
    same_hits(ball, unit_quadric(), 1e-12, "quadric");
    same_hits(ball, unit_poly(), 1e-10, "poly");
    same_hits(ball, super(1, 1), 1e-10, "superellipsoid");
    same_hits(ball, blob_of(&part, 1, 1), 1e-10, "blob");
    same_hits(ball, isosurface(false, 1.5), 1e-10, "isosurface");
}

static void test_tori(void **context) {
    (void)context;
    Object ring = {.kind = OBJECT_TORUS};
    ring.as.torus.major_radius = 0.8;
    ring.as.torus.minor_radius = 0.3;
    same_hits(ring, quartic_torus(0.8, 0.3), 1e-9, "torus");
}

static void test_cylinders(void **context) {
    static const Point2 wall[] = {{0, -0.5}, {0.7, -0.5}, {0.7, 0.6}, {0, 0.6}};
    (void)context;
    Object plain = {.kind = OBJECT_CYLINDER};
    plain.as.cone.base = vec3(0, -0.5, 0);
    plain.as.cone.cap = vec3(0, 0.6, 0);
    plain.as.cone.base_radius = plain.as.cone.cap_radius = 0.7;
    same_hits(plain, turned(SOLID_LATHE, CURVE_LINEAR, wall, 4), 1e-9, "lathe");
}

/* ---- sheets ---- */

static void test_polygon_holes(void **context) {
    static const Vec3 points[] = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                                  {1, 1, 0}, {3, 1, 0}, {3, 3, 0}, {1, 3, 0}, {1, 1, 0}};
    Object o = solid_object((Solid){.kind = SOLID_POLYGON, .as.polygon = {points, 10}});
    ShapeTracer *tracer = shape_tracer_create(&arena);
    (void)context;
    for (int i = 0; i < 500; i++) {
        double x = uniform(-1, 5), y = uniform(-1, 5);
        const Ray ray = {{x, y, -2}, {0, 0, 1}};
        TraceHit hit;
        bool outer = x > 0 && x < 4 && y > 0 && y<4, hole = x> 1 && x < 3 && y > 1 && y < 3;
        assert_int_equal(shape_trace(tracer, &o, &ray, 0, &hit), outer && !hole);
    }
}

/* A patch that is the graph of a polynomial: x = 3u, y = 3v, z = 18 u(1-u) v(1-v). */
static void test_patch(void **context) {
    Solid s = {.kind = SOLID_PATCH};
    for (int i = 0; i < 16; i++) s.as.patch.points[i] = vec3(i % 4, i / 4, i % 4 % 3 && i / 4 % 3 ? 2 : 0);
    Object o = solid_object(s);
    ShapeTracer *tracer = shape_tracer_create(&arena);
    (void)context;
    for (int i = 0; i < 500; i++) {
        double x = uniform(0, 3), y = uniform(0, 3), u = x / 3, v = y / 3;
        const Ray ray = {{x, y, -2}, {0, 0, 1}};
        TraceHit hit;
        assert_true(shape_trace(tracer, &o, &ray, 0, &hit));
        assert_true(fabs(hit.point.z - 18 * u * (1 - u) * v * (1 - v)) < 1e-11);
    }
}

/* The surface is bilinear between posts along the diagonal's two triangles. */
static void test_height_field(void **context) {
    Object o = height_field();
    ShapeTracer *tracer = shape_tracer_create(&arena);
    (void)context;
    for (int i = 0; i < 500; i++) {
        const Ray down = {{uniform(0, 1), 3, uniform(0, 1)}, {0, -1, 0}};
        TraceHit hit;
        assert_true(shape_trace(tracer, &o, &down, 0, &hit));
        assert_true(shape_trace_inside(tracer, &o, vec3(hit.point.x, hit.point.y - 1e-9, hit.point.z)));
        assert_false(shape_trace_inside(tracer, &o, vec3(hit.point.x, hit.point.y + 1e-9, hit.point.z)));
    }
}

/* ---- meshes and copies ---- */

static Object ball_mesh(uint32_t rows, uint32_t columns) {
    Vec3 *vertices = arena_new_array(&arena, Vec3, (rows + 1) * columns);
    uint32_t(*triangles)[3] = arena_push_array_(&arena, 2 * rows * columns, sizeof *triangles);
    size_t count = 0;
    for (uint32_t i = 0; i <= rows; i++)
        for (uint32_t j = 0; j < columns; j++) {
            double a = VTS_PI * i / rows, b = 2 * VTS_PI * j / columns;
            vertices[i * columns + j] = vec3(sin(a) * cos(b), cos(a), sin(a) * sin(b));
            if (i == rows) continue;
            uint32_t next = (j + 1) % columns, p = i * columns + j, q = i * columns + next;
            uint32_t two[2][3] = {{p, q, p + columns}, {q, q + columns, p + columns}};
            memcpy(triangles[count], two, sizeof two);
            count += 2;
        }
    MeshData *mesh = arena_new(&arena, MeshData);
    *mesh = (MeshData){.vertices = vertices,
                       .vertex_count = (rows + 1) * columns,
                       .triangles = (const uint32_t(*)[3])triangles,
                       .triangle_count = count,
                       .inside_vector = {0.123, 0.456, 0.789}};
    mesh_rehash(mesh);
    Object o = {.kind = OBJECT_TRIANGLES};
    o.as.mesh = mesh;
    return o;
}

static void test_mesh(void **context) {
    (void)context;
    prove(ball_mesh(24, 48), "mesh", 0.6, 1e-8, false);
    Object large = ball_mesh(200, 250); /* 100,000 triangles */
    ShapeTracer *tracer = shape_tracer_create(&arena);
    for (int i = 0; i < 10000; i++) {
        Vec3 from = vec3_scale(vec3_normalize(random_point(1)), 3);
        const Ray ray = {from, vec3_negate(vec3_normalize(from))};
        TraceHit hit;
        assert_true(shape_trace(tracer, &large, &ray, 0, &hit));
        assert_true(fabs(hit.t - 2) < 1e-3);
    }
}

static void test_many_copies(void **context) {
    enum { SIDE = 60 };
    (void)context;
    Object *balls = arena_new_array(&arena, Object, SIDE * SIDE), ball = sphere(vec3(0, 0, 0), 0.4);
    for (int i = 0; i < SIDE * SIDE; i++) {
        balls[i] = ball;
        move(&balls[i], transform_translate(vec3(i % SIDE, 0, i / SIDE)));
    }
    Object all = set_of(OBJECT_UNION, balls, SIDE * SIDE);
    ShapeTracer *tracer = shape_tracer_create(&arena);
    for (int i = 0; i < 3000; i++) {
        double x = uniform(0, SIDE - 1), z = uniform(0, SIDE - 1), off = hypot(x - round(x), z - round(z));
        const Ray down = {{x, 5, z}, {0, -1, 0}};
        TraceHit hit;
        assert_int_equal(shape_trace(tracer, &all, &down, 0, &hit), off < 0.4);
        if (off < 0.4) assert_true(fabs(hit.point.y - sqrt(0.16 - off * off)) < 1e-9);
        assert_int_equal(shape_trace_inside(tracer, &all, vec3(x, 0, z)), off < 0.4);
    }
}

/* Sets of sets of copies, doubled sixty times, end in an answer, and soon. */
static void test_hostile(void **context) {
    Object o = sphere(vec3(0, 0, 0), 1);
    ShapeTracer *tracer = shape_tracer_create(&arena);
    const Ray ray = {{0, 0, -5}, {0, 0, 1}}, strange[] = {{{(double)NAN, 0, 0}, {0, 0, 1}},
                                                          {{0, 0, -5}, {0, 0, 0}},
                                                          {{0, 0, 1e308}, {0, 0, -1e-300}}};
    TraceHit hit;
    (void)context;
    for (int i = 0; i < 60; i++) {
        const Object pair[2] = {o, o};
        o = set_of(OBJECT_UNION, pair, 2);
    }
    shape_trace(tracer, &o, &ray, 0, &hit);
    shape_trace_inside(tracer, &o, vec3(3, 0, 0));
    shape_extent(tracer, &o);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(strange); i++) shape_trace(tracer, &o, &strange[i], 0, &hit);
    Object deep = sphere(vec3(0, 0, 0), 1);
    for (int i = 0; i < 5000; i++) deep = set_of(OBJECT_UNION, &deep, 1);
    shape_trace(tracer, &deep, &ray, 0, &hit);
    shape_extent(tracer, &deep);
    Object flat = sphere(vec3(0, 0, 0), 1);
    move(&flat, transform_scale(vec3(1, 0, 1)));
    assert_false(shape_trace(tracer, &flat, &ray, 0, &hit));
}

/* ---- zeros ---- */

static void test_roots(void **context) {
    (void)context;
    for (int trial = 0; trial < 2000; trial++) {
        int degree = 1 + trial % 10;
        double zeros[10], found[ROOTS_HIGHEST_DEGREE], c[12] = {1}, next[12];
        for (int i = 0; i < degree; i++) zeros[i] = -5 + (i + uniform(0.1, 0.9)) * 10 / degree;
        for (int i = 0; i < degree; i++) {
            roots_multiply(c, i, (double[]){-zeros[i], 1}, 1, next);
            memcpy(c, next, sizeof *c * (size_t)(i + 2));
        }
        int count = roots_real(c, degree, found);
        assert_int_equal(count, degree);
        /* The zeros of a polynomial of degree 10 move by as much as rounding of its coefficients moves them. */
        for (int i = 0; i < degree; i++) assert_true(fabs(found[i] - zeros[i]) < (degree < 6 ? 1e-9 : 1e-4));
    }
}

/* Two zeros 2·10⁻ᵏ apart: both are found as long as rounding leaves two. */
static void test_near_double_roots(void **context) {
    (void)context;
    for (int k = 1; k <= 6; k++) {
        double gap = pow(10, -k), found[4];
        const double quadratic[3] = {0.25 - gap * gap, -1, 1}; /* (x - 1/2)² - gap² */
        double quartic[5];
        roots_multiply(quadratic, 2, (double[]){2, 0, 1}, 2, quartic);
        assert_int_equal(roots_in(quartic, 4, -2, 2, found), 2);
        assert_true(fabs(found[0] - (0.5 - gap)) < 1e-15 / gap + 1e-14);
        assert_true(fabs(found[1] - (0.5 + gap)) < 1e-15 / gap + 1e-14);
    }
    double found[4];
    assert_int_equal(roots_in((double[]){0, 0, 0}, 2, -1, 1, found), 0);
    assert_int_equal(roots_in((double[]){(double)NAN, 1}, 1, -1, 1, found), 0);
    assert_int_equal(roots_in((double[]){1, 0, 0, 0, 0}, 4, -1, 1, found), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_algebraic),
        cmocka_unit_test(test_round),
        cmocka_unit_test(test_turned),
        cmocka_unit_test(test_prisms),
        cmocka_unit_test(test_fields),
        cmocka_unit_test(test_sets),
        cmocka_unit_test(test_spheres),
        cmocka_unit_test(test_tori),
        cmocka_unit_test(test_cylinders),
        cmocka_unit_test(test_polygon_holes),
        cmocka_unit_test(test_patch),
        cmocka_unit_test(test_height_field),
        cmocka_unit_test(test_mesh),
        cmocka_unit_test(test_many_copies),
        cmocka_unit_test(test_hostile),
        cmocka_unit_test(test_roots),
        cmocka_unit_test(test_near_double_roots),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
