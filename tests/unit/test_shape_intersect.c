/* Exact hits against brute force in long double: every solid as one function that is negative inside, marched along the ray. */
#include "object_parts.h"
#include "base/random.h"
#include "shape/intersect.h"
#include "shape/tessellate.h"

#include <float.h>
#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

typedef long double Long;

/* ---- solids as functions: negative inside ---- */

typedef struct LongVec {
    Long x, y, z;
} LongVec;

static Long long_dot(LongVec a, LongVec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static LongVec long_from(Vec3 a) { return (LongVec){(Long)a.x, (Long)a.y, (Long)a.z}; }
static LongVec long_madd(LongVec a, LongVec b, Long s) {
    return (LongVec){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}

static Long box_function(const Object *object, LongVec p) {
    Vec3 a = object->as.box.corner1, b = object->as.box.corner2;
    Long x = fmaxl((Long)fmin(a.x, b.x) - p.x, p.x - (Long)fmax(a.x, b.x));
    Long y = fmaxl((Long)fmin(a.y, b.y) - p.y, p.y - (Long)fmax(a.y, b.y));
    return fmaxl(x, fmaxl(y, fmaxl((Long)fmin(a.z, b.z) - p.z, p.z - (Long)fmax(a.z, b.z))));
}

static Long cone_function(const Object *object, LongVec p) {
    LongVec base = long_from(object->as.cone.base),
            axis = long_madd(long_from(object->as.cone.cap), base, -1);
    Long length = sqrtl(long_dot(axis, axis)), r0 = (Long)object->as.cone.base_radius,
         r1 = (Long)object->as.cone.cap_radius;
    LongVec from = long_madd(p, base, -1);
    Long z = long_dot(from, axis) / length;
    LongVec q = long_madd(from, axis, -z / length);
    return fmaxl(fmaxl(-z, z - length), sqrtl(long_dot(q, q)) - (r0 + (r1 - r0) * z / length));
}

static Long solid_function(const Object *object, LongVec p) {
    LongVec from = long_madd(p, long_from(object->as.sphere.center), -1);
    switch (object->kind) {
    case OBJECT_SPHERE: return sqrtl(long_dot(from, from)) - (Long)object->as.sphere.radius;
    case OBJECT_BOX: return box_function(object, p);
    case OBJECT_CONE: return cone_function(object, p);
    default:
        return hypotl(hypotl(p.x, p.z) - (Long)object->as.torus.major_radius, p.y) -
               (Long)object->as.torus.minor_radius;
    }
}

/* Crossings for t in [0, 1], which must start and end outside. */
static int march(const Object *object, const Ray *ray, int steps, double out[8]) {
    LongVec o = long_from(ray->origin), d = long_from(ray->direction);
    int count = 0;
    bool inside = false;
    for (int i = 1; i <= steps && count < 8; i++) {
        Long hi = (Long)i / steps, lo = (Long)(i - 1) / steps;
        bool next = solid_function(object, long_madd(o, d, hi)) < 0;
        if (next == inside) continue;
        while (hi - lo > 1e-18L) {
            Long middle = (lo + hi) / 2;
            if (middle == lo || middle == hi) break;
            if ((solid_function(object, long_madd(o, d, middle)) < 0) == inside)
                lo = middle;
            else
                hi = middle;
        }
        inside = next;
        out[count++] = (double)lo;
    }
    return count;
}

/* ---- random solids and rays ---- */

static double centered(RandomStream *random) { return 2 * random_next_unit(random) - 1; }
static Vec3 random_vec(RandomStream *random) {
    return vec3(centered(random), centered(random), centered(random));
}

static Object random_solid(RandomStream *random, int i) {
    Object object = {.kind = (uint8_t[]){OBJECT_SPHERE, OBJECT_BOX, OBJECT_CONE, OBJECT_TORUS}[i % 4]};
    switch (object.kind) {
    case OBJECT_SPHERE:
        object.as.sphere.center = random_vec(random);
        object.as.sphere.radius = 0.01 + random_next_unit(random);
        break;
    case OBJECT_BOX:
        object.as.box.corner1 = random_vec(random);
        object.as.box.corner2 = random_vec(random);
        break;
    case OBJECT_CONE:
        object.as.cone.base = random_vec(random);
        object.as.cone.cap = random_vec(random);
        object.as.cone.base_radius = i % 3 ? random_next_unit(random) : 0;
        object.as.cone.cap_radius = i % 3 == 1 ? object.as.cone.base_radius : random_next_unit(random);
        break;
    default:
        object.as.torus.major_radius = random_next_unit(random);
        object.as.torus.minor_radius = i % 8 < 4 ? random_next_unit(random) : 0.03;
        break;
    }
    return object;
}

static double solid_size(const Object *object) {
    Box3 box = shape_bounds(object);
    return vec3_length(vec3_sub(box.max, box.min));
}

/* From outside to outside through the neighbourhood of the solid; t in [0, 1]. */
static Ray random_ray(RandomStream *random, const Object *object) {
    Box3 box = shape_bounds(object);
    Vec3 size = vec3_sub(box.max, box.min), middle = vec3_lerp(box.min, box.max, 0.5);
    Vec3 through = vec3_add(middle, vec3_mul(random_vec(random), vec3_scale(size, 0.5))),
         way = random_vec(random);
    if (random_next_unit(random) < 0.2) way = random_next_unit(random) < 0.5 ? vec3(1, 0, 0) : vec3(0, -1, 0);
    way = vec3_scale(vec3_normalize(way), 1.1 * vec3_length(size));
    return (Ray){vec3_sub(through, way), vec3_scale(way, 2)};
}

static void assert_on_surface(const Object *object, const ShapeHit *hit, double scale) {
    Long off = solid_function(object, long_from(hit->point));
    if (!(fabsl(off) <= 1e-12L * (Long)scale))
        print_error("kind %d: %Lg off at size %g\n", object->kind, off, scale);
    assert_true(fabsl(off) <= 1e-12L * (Long)scale);
    assert_true(fabs(vec3_length(hit->normal) - 1) < 1e-12);
}

/* ---- tests ---- */

static void crossings_are_those_of_brute_force(void **state) {
    (void)state;
    RandomStream random = {1};
    const int steps = 1000;
    int crossings = 0, grazes = 0;
    for (int i = 0; i < 6000; i++) {
        Object object = random_solid(&random, i);
        Ray ray = random_ray(&random, &object);
        ShapeCrossing found[SHAPE_MOST_CROSSINGS];
        double expected[8];
        int count = shape_crossings(&object, &ray, found), brute = march(&object, &ray, steps, expected),
            k = 0;
        assert_int_equal(count % 2, 0);
        for (int j = 0; j < count; j++) {
            assert_true(found[j].leaving == (j % 2 == 1) && (j == 0 || found[j].t >= found[j - 1].t));
            /* A pair closer than a step (inside or outside) may hide from the march. */
            bool hidden = (j + 1 < count && found[j + 1].t - found[j].t < 1.0 / steps) &&
                          !(k < brute && fabs(expected[k] - found[j].t) < 1e-10);
            if (hidden) {
                grazes++;
                j++;
                continue;
            }
            assert_true(k < brute);
            if (!(fabs(expected[k] - found[j].t) < 1e-10))
                print_error("solid %d: %.15g, expected %.15g\n", i, found[j].t, expected[k]);
            assert_true(fabs(expected[k++] - found[j].t) < 1e-10);
            crossings++;
        }
        assert_int_equal(k, brute);
    }
    assert_true(crossings > 5000 && grazes < 100);
}

static void hits_are_nearest_and_on_the_surface(void **state) {
    (void)state;
    RandomStream random = {2};
    for (int i = 0; i < 20000; i++) {
        Object object = random_solid(&random, i);
        Ray ray = random_ray(&random, &object);
        ShapeCrossing all[SHAPE_MOST_CROSSINGS];
        ShapeHit hit;
        int count = shape_crossings(&object, &ray, all);
        double t_min = random_next_unit(&random), nearest = 2;
        for (int k = count - 1; k >= 0; k--) nearest = all[k].t > t_min ? all[k].t : nearest;
        assert_int_equal(shape_intersect(&object, &ray, t_min, 1, &hit), nearest < 1);
        if (!(nearest < 1)) continue;
        double size = solid_size(&object);
        assert_true(hit.t == nearest);
        assert_on_surface(&object, &hit, size);
        Vec3 along = vec3_madd(ray.origin, ray.direction, hit.t);
        /* Grazing hits slide along the ray, never off it: the distance between both is what rounding of t gives. */
        assert_true(vec3_length(vec3_sub(along, hit.point)) < 1e-11 * size);
        assert_true(hit.leaving ? vec3_dot(hit.normal, ray.direction) > -1e-5 * size
                                : vec3_dot(hit.normal, ray.direction) < 1e-5 * size);
        assert_true(hit.uv.u >= 0 && hit.uv.u <= 1 && hit.uv.v >= 0 && hit.uv.v <= 1);
    }
}

/* The normal is the gradient of the function, by differences in long double. */
static void normals_are_gradients(void **state) {
    (void)state;
    RandomStream random = {3};
    for (int i = 0; i < 4000; i++) {
        Object object = random_solid(&random, i);
        Ray ray = random_ray(&random, &object);
        ShapeHit hit;
        if (!shape_intersect(&object, &ray, 0, 1, &hit)) continue;
        LongVec p = long_from(hit.point);
        const Long h = 1e-7L;
        Vec3 gradient = vec3((double)((solid_function(&object, (LongVec){p.x + h, p.y, p.z}) -
                                       solid_function(&object, (LongVec){p.x - h, p.y, p.z})) /
                                      h),
                             (double)((solid_function(&object, (LongVec){p.x, p.y + h, p.z}) -
                                       solid_function(&object, (LongVec){p.x, p.y - h, p.z})) /
                                      h),
                             (double)((solid_function(&object, (LongVec){p.x, p.y, p.z + h}) -
                                       solid_function(&object, (LongVec){p.x, p.y, p.z - h})) /
                                      h));
        if (vec3_dot(vec3_normalize(gradient), hit.normal) < 1 - 1e-6) {
            /* Only at edges, where the function is not smooth: there the values on both sides differ by a kink. */
            Long kink = solid_function(&object, long_madd(p, long_from(hit.normal), h)) +
                        solid_function(&object, long_madd(p, long_from(hit.normal), -h));
            Vec3 side, other;
            vec3_frame(hit.normal, &side, &other);
            kink += solid_function(&object, long_madd(p, long_from(side), h)) +
                    solid_function(&object, long_madd(p, long_from(side), -h));
            kink += solid_function(&object, long_madd(p, long_from(other), h)) +
                    solid_function(&object, long_madd(p, long_from(other), -h));
            assert_true(kink > h / 1000);
        }
    }
}

static void inside_is_the_parity_of_crossings(void **state) {
    (void)state;
    RandomStream random = {4};
    for (int i = 0; i < 20000; i++) {
        Object object = random_solid(&random, i);
        Ray ray = random_ray(&random, &object);
        ShapeCrossing all[SHAPE_MOST_CROSSINGS];
        int count = shape_crossings(&object, &ray, all), ahead = 0;
        double t = random_next_unit(&random);
        Vec3 p = vec3_madd(ray.origin, ray.direction, t);
        if (fabsl(solid_function(&object, long_from(p))) < 1e-12L) continue;
        for (int k = 0; k < count; k++) ahead += all[k].t > t;
        assert_int_equal(shape_inside(&object, p), ahead % 2);
        Box3 box = shape_bounds(&object);
        if (shape_inside(&object, p)) {
            assert_true(p.x >= box.min.x && p.y >= box.min.y && p.z >= box.min.z);
            assert_true(p.x <= box.max.x && p.y <= box.max.y && p.z <= box.max.z);
        }
    }
}

static Object scaled(Object object, double scale, Vec3 shift) {
    switch (object.kind) {
    case OBJECT_SPHERE:
        object.as.sphere.center = vec3_scale(vec3_add(object.as.sphere.center, shift), scale);
        object.as.sphere.radius *= scale;
        break;
    case OBJECT_BOX:
        object.as.box.corner1 = vec3_scale(vec3_add(object.as.box.corner1, shift), scale);
        object.as.box.corner2 = vec3_scale(vec3_add(object.as.box.corner2, shift), scale);
        break;
    case OBJECT_CONE:
        object.as.cone.base = vec3_scale(vec3_add(object.as.cone.base, shift), scale);
        object.as.cone.cap = vec3_scale(vec3_add(object.as.cone.cap, shift), scale);
        object.as.cone.base_radius *= scale;
        object.as.cone.cap_radius *= scale;
        break;
    default:
        object.as.torus.major_radius *= scale;
        object.as.torus.minor_radius *= scale;
        break;
    }
    return object;
}

static void scale_and_length_of_the_direction_do_not_matter(void **state) {
    (void)state;
    RandomStream random = {5};
    static const double scales[] = {1e-100, 1e-12, 1e12, 1e100};
    for (int i = 0; i < 4000; i++) {
        Object object = random_solid(&random, i);
        Ray ray = random_ray(&random, &object);
        double scale = scales[i % 4], stretch = i % 3 == 0 ? 1e-80 : i % 3 == 1 ? 1e80 : 1;
        Object other = scaled(object, scale, vec3_splat(0));
        Ray moved = {vec3_scale(ray.origin, scale), vec3_scale(vec3_scale(ray.direction, scale), stretch)};
        ShapeHit hit, copy;
        bool found = shape_intersect(&object, &ray, 0, 1, &hit);
        assert_int_equal(shape_intersect(&other, &moved, 0, 1 / stretch, &copy), found);
        if (!found) continue;
        /* Near-tangent rays double their rounding errors' square roots. */
        double steep = fabs(vec3_dot(hit.normal, vec3_normalize(ray.direction)));
        assert_true(fabs(copy.t * stretch - hit.t) < 1e-13 / double_max(steep, 1e-5) * 10);
        if (object.kind != OBJECT_CONE) assert_on_surface(&other, &copy, scale * 2);
    }
}

static void far_origins_lose_only_their_own_rounding(void **state) {
    (void)state;
    RandomStream random = {6};
    for (int i = 0; i < 4000; i++) {
        Object object = random_solid(&random, i);
        Ray near_ray = random_ray(&random, &object);
        ShapeHit hit, again;
        if (!shape_intersect(&object, &near_ray, 0, 1, &hit)) continue;
        double steep = fabs(vec3_dot(hit.normal, vec3_normalize(near_ray.direction)));
        if (steep < 0.05 || hit.leaving) continue;
        double away = 1e6;
        Ray far_ray = {vec3_madd(hit.point, near_ray.direction, -away), near_ray.direction};
        if (!shape_intersect(&object, &far_ray, 0, HUGE_VAL, &again)) {
            assert_true(object.kind == OBJECT_BOX || object.kind == OBJECT_CONE); /* through an edge */
            continue;
        }
        assert_on_surface(&object, &again, solid_size(&object));
    }
}

static void rays_that_start_on_a_convex_solid_leave_it(void **state) {
    (void)state;
    RandomStream random = {7};
    for (int i = 0; i < 20000; i++) {
        Object object = random_solid(&random, i);
        Ray ray = random_ray(&random, &object);
        ShapeHit hit, next;
        if (object.kind == OBJECT_TORUS || !shape_intersect(&object, &ray, 0, 1, &hit)) continue;
        double epsilon = 1e-9 * solid_size(&object);
        Vec3 way = vec3_normalize(random_vec(&random));
        double steep = vec3_dot(way, hit.normal);
        if (fabs(steep) < 1e-3) continue;
        ray = (Ray){hit.point, way};
        bool found = shape_intersect(&object, &ray, epsilon, HUGE_VAL, &next);
        if (steep > 0) assert_false(found);
        if (found) assert_true(next.leaving);
    }
}

static void spheres_are_met_to_the_last_digits_of_their_rim(void **state) {
    (void)state;
    const Object object = {.kind = OBJECT_SPHERE, .as.sphere = {{0, 0, 0}, 1, 0}};
    for (int i = 1; i < 15; i++) {
        double gap = pow(10, -i);
        Ray within = {{-5, 1 - gap, 0}, {1, 0, 0}}, beyond = {{-5, 1 + gap, 0}, {1, 0, 0}};
        ShapeHit hit;
        assert_true(shape_intersect(&object, &within, 0, 10, &hit));
        assert_true(fabs(hit.t - (5 - sqrt(gap * (2 - gap)))) < 1e-8 / pow(10, 7 - 0.5 * i) + 1e-14);
        assert_on_surface(&object, &hit, 1);
        assert_false(shape_intersect(&object, &beyond, 0, 10, &hit));
    }
}

static void no_ray_slips_through_rims_and_edges(void **state) {
    (void)state;
    RandomStream random = {8};
    for (int i = 0; i < 20000; i++) {
        Object object = random_solid(&random, i % 2 ? 4 * i + 2 : 4 * i + 1);
        Box3 box = shape_bounds(&object);
        /* Aim from the rim, exactly or nearly, through the solid's middle. */
        Vec3 middle = object.kind == OBJECT_BOX ? vec3_lerp(box.min, box.max, 0.5)
                                                : vec3_lerp(object.as.cone.base, object.as.cone.cap, 0.5),
             rim;
        if (object.kind == OBJECT_BOX) {
            rim = vec3(i & 2 ? box.min.x : box.max.x, i & 4 ? box.min.y : box.max.y,
                       i & 8 ? box.min.z : middle.z);
        } else {
            Vec3 side, other, axis = vec3_normalize(vec3_sub(object.as.cone.cap, object.as.cone.base));
            double turn = random_next_unit(&random) * 7;
            vec3_frame(axis, &side, &other);
            rim = vec3_madd(object.as.cone.cap, side, cos(turn) * object.as.cone.cap_radius);
            rim = vec3_madd(rim, other, sin(turn) * object.as.cone.cap_radius);
        }
        Vec3 way = vec3_sub(middle, rim);
        Ray ray = {vec3_madd(rim, way, -1), way};
        ShapeHit hit;
        assert_true(shape_intersect(&object, &ray, 0, 3, &hit));
        assert_true(fabs(hit.t - 1) < 1e-9);
    }
}

static void rays_nearly_along_a_generator_keep_their_digits(void **state) {
    (void)state;
    Object object = {.kind = OBJECT_CONE, .as.cone = {{0, 0, 0}, {0, 1, 0}, 1, 0, false, 0}};
    for (int i = 1; i < 18; i++) {
        /* Down beside the generator x = 1 - y: in by the side, out by the base. */
        double tilt = (i & 1 ? 1 : -1) * pow(10, -i);
        Ray ray = {{-1, 1.5, 0.1}, {2 + tilt, -2, 0}};
        ShapeCrossing found[SHAPE_MOST_CROSSINGS];
        double expected[8];
        assert_int_equal(shape_crossings(&object, &ray, found), 2);
        assert_int_equal(march(&object, &ray, 1000, expected), 2);
        assert_true(fabs(found[0].t - expected[0]) < 1e-14 && fabs(found[1].t - expected[1]) < 1e-14);
    }
}

static void thin_rings_and_spindles_are_met(void **state) {
    (void)state;
    for (double minor = 1e-1; minor > 1e-10; minor /= 10) {
        const Object object = {.kind = OBJECT_TORUS, .as.torus = {1, minor}};
        for (int i = 0; i < 50; i++) {
            double turn = 0.1 * i, aim = minor * (0.9 * (i % 7) / 3.5 - 0.9);
            Vec3 on = vec3((1 + aim) * cos(turn), 0, (1 + aim) * sin(turn));
            Ray ray = {vec3(on.x + 0.2, 3, on.z), {-0.2, -3, 0}};
            ShapeHit hit;
            assert_true(shape_intersect(&object, &ray, 0, 2, &hit));
            assert_on_surface(&object, &hit, 1);
            assert_true(fabs(hit.t - 1) < 2 * minor);
        }
    }
    const Object spindle = {.kind = OBJECT_TORUS, .as.torus = {0.5, 1}};
    const Ray axis = {{0, 5, 0}, {0, -1, 0}}, across = {{-5, 0, 0}, {1, 0, 0}};
    ShapeCrossing out[SHAPE_MOST_CROSSINGS];
    assert_int_equal(shape_crossings(&spindle, &axis, out), 2);
    assert_true(fabs(out[0].t - (5 - sqrt(0.75))) < 1e-12);
    assert_int_equal(shape_crossings(&spindle, &across, out), 2);
    assert_true(fabs(out[0].t - 3.5) < 1e-12 && fabs(out[1].t - 6.5) < 1e-12);
}

static void sheets_and_planes(void **state) {
    (void)state;
    const Object plane = {.kind = OBJECT_PLANE, .as.plane = {{0, 1, 0}, 2}};
    const Object disc = {.kind = OBJECT_DISC, .as.disc = {{1, 0, 0}, {0, 0, -3}, 2, 0.5}};
    const Object tube = {.kind = OBJECT_CYLINDER, .as.cone = {{0, 0, 0}, {0, 2, 0}, 1, 1, true, 0}};
    Ray down = {{7, 5, -3}, {1, -2, 0}}, level = {{0, 2, 0}, {1, 0, 0}}, through = {{2.5, 0, 4}, {0, 0, -2}};
    ShapeHit hit;
    assert_true(shape_intersect(&plane, &down, 0, 10, &hit));
    assert_true(hit.t == 1.5 && hit.normal.y == 1 && hit.point.y == 2 && !hit.leaving);
    assert_false(shape_intersect(&plane, &level, -10, 10, &hit));
    assert_true(shape_inside(&plane, vec3(9, 1, 9)) && !shape_inside(&plane, vec3(9, 3, 9)));
    assert_true(shape_intersect(&disc, &through, 0, 10, &hit) && hit.t == 2 && hit.normal.z == -1);
    through.origin.x = 1.2;
    assert_false(shape_intersect(&disc, &through, 0, 10, &hit));
    Ray along = {{0.5, -1, 0}, {0, 1, 0}}, slant = {{-2, -1, 0}, {1, 1, 0}},
        inside_out = {{0, 1, 0}, {1, 0, 0}};
    assert_false(shape_intersect(&tube, &along, -10, 10, &hit)); /* in by one end, out by the other */
    assert_true(shape_intersect(&tube, &inside_out, 0, 10, &hit) && hit.t == 1 && hit.normal.x == 1);
    slant.origin.x = -0.5;
    assert_true(shape_intersect(&tube, &slant, 0, 10, &hit) && fabs(hit.t - 1.5) < 1e-15);
}

static void what_is_degenerate_is_missed_without_harm(void **state) {
    (void)state;
    const double nan_value = (double)NAN;
    const Object objects[] = {
        {.kind = OBJECT_SPHERE},
        {.kind = OBJECT_CONE, .as.cone = {{0, 0, 0}, {0, 0, 0}, 1, 1, false, 0}},
        {.kind = OBJECT_CONE, .as.cone = {{0, 0, 0}, {0, 1, 0}, 0, 0, false, 0}},
        {.kind = OBJECT_TORUS, .as.torus = {1, 0}},
        {.kind = OBJECT_TORUS, .as.torus = {0, 0}},
        {.kind = OBJECT_DISC, .as.disc = {{0, 0, 0}, {0, 0, 0}, 1, 0}},
        {.kind = OBJECT_SPHERE, .as.sphere = {{0, 0, 0}, 1, 0}},
        {.kind = OBJECT_CONE, .as.cone = {{0, 0, 0}, {0, 1, 0}, 1, 1, false, 0}},
        {.kind = OBJECT_TORUS, .as.torus = {1, 0.5}},
        {.kind = OBJECT_BOX, .as.box = {{0, 0, 0}, {1, 1, 1}}},
    };
    const Ray rays[] = {{{-3, 0, 0}, {0, 0, 0}},
                        {{nan_value, 0, 0}, {1, 0, 0}},
                        {{0, -9, 0}, {0, nan_value, 0}},
                        {{-3, 0, 0}, {1, 0, 0}},
                        {{0, -9, 0}, {0, 1, 0}}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(objects); i++) {
        for (size_t k = 0; k < VTS_ARRAY_COUNT(rays); k++) {
            ShapeHit hit;
            bool found = shape_intersect(&objects[i], &rays[k], 0, 100, &hit);
            if (i < 6 || k < 3) assert_false(found);
        }
    }
    /* A torus whose ring is a point is a sphere; a flat box is a sheet with two walls. */
    const Object point_ring = {.kind = OBJECT_TORUS, .as.torus = {0, 1}},
                 flat = {.kind = OBJECT_BOX, .as.box = {{0, 0, 0}, {1, 0, 1}}};
    const Ray ray = {{0.5, 3, 0.5}, {0, -1, 0}};
    ShapeHit hit;
    assert_true(shape_intersect(&point_ring, &ray, 0, 9, &hit) && fabs(hit.t - (3 - sqrt(0.5))) < 1e-12);
    assert_true(shape_intersect(&flat, &ray, 0, 9, &hit) && hit.t == 3);
}

/* Texture coordinates of hits are those of the tessellation's vertices. */
static void hits_and_tessellations_agree_on_coordinates(void **state) {
    (void)state;
    RandomStream random = {9};
    Arena arena;
    arena_init(&arena, NULL, 0);
    for (int i = 0; i < 40; i++) {
        Object object = random_solid(&random, i);
        const TessellateOptions options = {.tolerance = 1e-7 * solid_size(&object), .parts = 40};
        TriangleSoup soup = {0};
        ShapeRefusal refusal;
        assert_true(tessellate(&object, NULL, &options, &arena, &soup, &refusal));
        for (size_t v = 0; v < soup.vertices.count; v += 97) {
            const SoupVertex *vertex = &soup.vertices.items[v];
            double reach = 0.01 * solid_size(&object);
            Ray ray = {vec3_madd(vertex->position, vertex->normal, reach), vec3_negate(vertex->normal)};
            ShapeHit hit;
            if (!shape_intersect(&object, &ray, 0, 2 * reach, &hit) ||
                vec3_dot(hit.normal, vertex->normal) < 0.999)
                continue;
            double across = fabs(hit.uv.u - vertex->uv.u), pole = fabs(vertex->uv.v - 0.5);
            if (object.kind == OBJECT_SPHERE && pole > 0.49) continue;
            assert_true(fabs(hit.uv.v - vertex->uv.v) < 0.01 ||
                        (object.kind == OBJECT_TORUS && fabs(hit.uv.v - vertex->uv.v) > 0.99));
            assert_true(across < 0.02 || across > 0.98);
        }
    }
    arena_destroy(&arena);
}

static void bounds_are_tight_and_hold_trees(void **state) {
    (void)state;
    RandomStream random = {10};
    Arena arena;
    arena_init(&arena, NULL, 0);
    for (int i = 0; i < 200; i++) {
        Object object = random_solid(&random, i), child = object, tree = {.kind = OBJECT_UNION};
        const Object *items[1] = {&child};
        const TessellateOptions options = {.tolerance = 1e-4 * solid_size(&object)};
        TriangleSoup soup = {0};
        ShapeRefusal refusal;
        Box3 box = shape_bounds(&object), held = box3_empty();
        assert_true(tessellate(&object, NULL, &options, &arena, &soup, &refusal));
        for (size_t v = 0; v < soup.vertices.count; v++)
            held = box3_add_point(held, soup.vertices.items[v].position);
        double slack = 0.03 * solid_size(&object);
        assert_true(vec3_length(vec3_sub(held.min, box.min)) < slack &&
                    vec3_length(vec3_sub(held.max, box.max)) < slack);
        const Transform turn = transform_rotate(vec3_scale(random_vec(&random), 180));
        child.place = PLACE(turn);
        tree.as.group = GROUP(items, 1);
        box = shape_bounds(&tree);
        for (size_t v = 0; v < soup.vertices.count; v++) {
            Vec3 p = transform_point(&turn, soup.vertices.items[v].position);
            Vec3 below = vec3_sub(p, box.min), above = vec3_sub(box.max, p);
            assert_true(fmin(fmin(below.x, below.y), below.z) > -options.tolerance &&
                        fmin(fmin(above.x, above.y), above.z) > -options.tolerance);
        }
    }
    arena_destroy(&arena);
    const Object plane = {
        .kind = OBJECT_PLANE, .as.plane = {{0, 1, 0}, 2}};
    const Object *items[1] = {&plane};
    Object tree = {.kind = OBJECT_UNION};
    tree.as.group = GROUP(items, 1);
    assert_true(isinf(shape_bounds(&tree).max.x) && isinf(shape_bounds(&tree).min.y));
}

static void csg_insides(void **state) {
    (void)state;
    const Transform right = transform_translate(vec3(1, 0, 0));
    Object ball = {.kind = OBJECT_SPHERE, .place = PLACE(right), .as.sphere = {{0, 0, 0}, 1, 0}};
    Object cube = {
        .kind = OBJECT_BOX, .as.box = {{-1, -1, -1}, {1, 1, 1}}};
    const Object *items[2] = {&cube, &ball};
    const Vec3 points[4] = {{0.5, 0, 0}, {-0.5, 0, 0}, {1.5, 0, 0}, {5, 0, 0}}; /* both, cube, ball, none */
    static const struct {
        ObjectKind kind;
        bool expected[4];
    } cases[4] = {{OBJECT_UNION, {true, true, true, false}},
                  {OBJECT_INTERSECTION, {true, false, false, false}},
                  {OBJECT_DIFFERENCE, {false, true, false, false}},
                  {OBJECT_MERGE, {true, true, true, false}}};
    for (int k = 0; k < 8; k++) {
        Object tree = {.kind = (uint8_t)cases[k / 2].kind, .inverse = k & 1};
        tree.as.group = GROUP(items, 2);
        for (int i = 0; i < 4; i++)
            assert_int_equal(shape_inside(&tree, points[i]), cases[k / 2].expected[i] != tree.inverse);
    }
    Object both = {.kind = OBJECT_INTERSECTION};
    both.as.group = GROUP(items, 2);
    assert_true(shape_bounds(&both).min.x == 0 && shape_bounds(&both).max.x == 1);
    ball.inverse = true;
    assert_true(shape_bounds(&both).min.x == -1 && shape_inside(&both, points[1]) &&
                !shape_inside(&both, points[0]));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crossings_are_those_of_brute_force),
        cmocka_unit_test(hits_are_nearest_and_on_the_surface),
        cmocka_unit_test(normals_are_gradients),
        cmocka_unit_test(inside_is_the_parity_of_crossings),
        cmocka_unit_test(scale_and_length_of_the_direction_do_not_matter),
        cmocka_unit_test(far_origins_lose_only_their_own_rounding),
        cmocka_unit_test(rays_that_start_on_a_convex_solid_leave_it),
        cmocka_unit_test(spheres_are_met_to_the_last_digits_of_their_rim),
        cmocka_unit_test(no_ray_slips_through_rims_and_edges),
        cmocka_unit_test(rays_nearly_along_a_generator_keep_their_digits),
        cmocka_unit_test(thin_rings_and_spindles_are_met),
        cmocka_unit_test(sheets_and_planes),
        cmocka_unit_test(what_is_degenerate_is_missed_without_harm),
        cmocka_unit_test(hits_and_tessellations_agree_on_coordinates),
        cmocka_unit_test(bounds_are_tight_and_hold_trees),
        cmocka_unit_test(csg_insides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
