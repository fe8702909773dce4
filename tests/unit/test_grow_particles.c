/* Swept particles against integrals of their trajectories. */
#include "object_parts.h"
#include "base/random.h"
#include "grow/particles.h"
#include "shape/tessellate.h"
#include "shape/weld.h"

#include <setjmp.h>
#include <stdarg.h>

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

static double soup_volume(const TriangleSoup *soup) {
    double sum = 0;
    for (size_t t = 0; t < soup->triangles.count; t++)
        sum += vec3_dot(corner(soup, t, 0), twice_area(soup, t)) / 6;
    return sum;
}

static Vec3 place(const Particle *p, double t) {
    return vec3_madd(vec3_madd(p->position, p->velocity, t), p->acceleration, t * t / 2);
}

/* ∫ width^power ds by Simpson's rule. */
static double width_integral(const Particle *p, int power) {
    double sum = 0;
    const int n = 20000;
    for (int i = 0; i <= n; i++) {
        double share = (double)i / n, t = share * p->life,
               width = p->width_foot + (p->width_tip - p->width_foot) * share;
        double speed = vec3_length(vec3_madd(p->velocity, p->acceleration, t));
        sum += (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * speed * (power == 2 ? width * width : width);
    }
    return sum * p->life / (3.0 * n);
}

static double centered(RandomStream *random) { return random_next_unit(random) - 0.5; }

static Particle random_blade(RandomStream *random, BladeProfile profile) {
    return (Particle){
        .position = vec3(random_next_unit(random), 0, random_next_unit(random)),
        .velocity =
            vec3(0.7 * centered(random), 0.8 + 0.2 * random_next_unit(random), 0.7 * centered(random)),
        .acceleration = vec3(centered(random), -random_next_unit(random), centered(random)),
        .life = 0.5 + random_next_unit(random),
        .width_foot = 0.06,
        .width_tip = random_next_unit(random) < 0.5 ? 0 : 0.01,
        .profile = profile,
    };
}

static void areas_are_width_times_way(void **state) {
    RandomStream random = {3};
    for (int i = 0; i < 150; i++) {
        Particle blade = random_blade(&random, (BladeProfile)(i % 3));
        blade.twist = blade.profile != BLADE_ROUND && i % 2 ? 60 : 0;
        TriangleSoup soup = {0};
        particles_tessellate(&blade, 1, 1e-4, *state, &soup);
        double expected = width_integral(&blade, 1),
               ends = blade.width_foot * blade.width_foot + blade.width_tip * blade.width_tip;
        if (blade.profile == BLADE_ROUND) expected = VTS_PI * (expected + ends / 4);
        assert_true(fabs(soup_area(&soup) / expected - 1) < (blade.twist > 0 ? 0.02 : 0.003));
    }
}

static void round_ones_are_closed_and_have_their_volume(void **state) {
    Arena *arena = *state;
    RandomStream random = {4};
    for (int i = 0; i < 60; i++) {
        Particle hair = random_blade(&random, BLADE_ROUND);
        TriangleSoup soup = {0};
        hair.width_foot = i % 5 ? 0.06 : 0;
        hair.width_tip = i % 5 ? hair.width_tip : 0.03;
        particles_tessellate(&hair, 1, 2e-5, arena, &soup);
        assert_true(fabs(soup_volume(&soup) / (VTS_PI / 4 * width_integral(&hair, 2)) - 1) < 0.01);
        size_t count = soup.vertices.count, edge_count = 0;
        Vec3 *points = arena_new_array(arena, Vec3, count);
        uint32_t *at = arena_new_array(arena, uint32_t, count);
        WeldEdge *edges = arena_new_array(arena, WeldEdge, 3 * soup.triangles.count);
        for (size_t k = 0; k < count; k++) points[k] = soup.vertices.items[k].position;
        uint32_t places = weld_points(points, count, 0, arena, at);
        for (uint32_t t = 0; t < soup.triangles.count; t++) {
            const uint32_t *v = soup.triangles.items[t].vertex;
            assert_true(soup.triangles.items[t].solid);
            for (uint8_t e = 0; e < 3; e++) {
                uint32_t a = at[v[e]], b = at[v[(e + 1) % 3]];
                edges[edge_count++] = (WeldEdge){a < b ? a : b, a < b ? b : a, t, e, a < b};
            }
        }
        weld_sort_edges(edges, edge_count, places, arena);
        assert_int_equal(edge_count % 2, 0);
        for (size_t k = 0; k < edge_count; k += 2) {
            assert_int_equal(edges[k].lo, edges[k + 1].lo);
            assert_int_equal(edges[k].hi, edges[k + 1].hi);
            assert_int_not_equal(edges[k].forward, edges[k + 1].forward);
        }
    }
}

/* Dense points of the trajectory are within tolerance of the middle line of a strip. */
static void tolerance_is_kept_along_the_way(void **state) {
    RandomStream random = {5};
    for (int i = 0; i < 60; i++) {
        Particle blade = random_blade(&random, BLADE_FLAT);
        double tolerance = i % 2 ? 1e-3 : 1e-5, largest = 0;
        TriangleSoup soup = {0};
        particles_tessellate(&blade, 1, tolerance, *state, &soup);
        for (int k = 0; k <= 500; k++) {
            double share = k / 500.0, best = HUGE_VAL;
            Vec3 p = place(&blade, share * blade.life), previous = blade.position;
            for (size_t v = 0; v < soup.vertices.count; v += 2) {
                Vec3 q = vec3_lerp(soup.vertices.items[v].position, soup.vertices.items[v + 1].position, 0.5);
                Vec3 line = vec3_sub(q, previous), to = vec3_sub(p, previous);
                double square = vec3_length_squared(line);
                double s = square > 0 ? double_clamp(vec3_dot(to, line) / square, 0, 1) : 0;
                best = double_min(best, vec3_length(vec3_madd(to, line, -s)));
                previous = q;
            }
            largest = double_max(largest, best);
        }
        assert_true(largest <= tolerance);
        assert_true(soup.triangles.count < (i % 2 ? 60 : 513));
    }
}

static void folded_blades_have_their_angle_and_open_to_the_front(void **state) {
    Particle blade = {.velocity = {0.3, 1, 0},
                      .acceleration = {0.1, -0.4, 0},
                      .life = 1,
                      .width_foot = 0.1,
                      .width_tip = 0.1};
    TriangleSoup soup = {0};
    particles_tessellate(&blade, 1, 1e-3, *state, &soup);
    Vec3 left = soup.vertices.items[0].normal, right = soup.vertices.items[soup.vertices.count - 1].normal;
    for (size_t v = 0; v < soup.vertices.count; v++) {
        const SoupVertex *vertex = &soup.vertices.items[v];
        if (vertex->uv.v == 0 && vertex->uv.u == 1) right = vertex->normal;
        assert_true(vertex->normal.y > 0); /* leaning over, the front is above */
    }
    assert_true(fabs(vec3_dot(left, right) - cos(70 * VTS_RADIANS)) < 1e-9);
    Vec3 edge = soup.vertices.items[0].position, rib = soup.vertices.items[1].position;
    assert_true(vec3_dot(vec3_sub(edge, rib), vec3_add(left, right)) > 0);
    assert_true(fabs(vec3_length(vec3_sub(edge, rib)) - 0.05) < 1e-12);
}

/* Neighbouring frames never turn by much: no flip where the tangent passes the vertical or turns back sharply. */
static void frames_do_not_flip(void **state) {
    RandomStream random = {6};
    for (int i = 0; i < 300; i++) {
        Particle blade = {.velocity = vec3(0.2 * centered(&random), 1, 0.2 * centered(&random)),
                          .acceleration = vec3(0.4 * centered(&random), -2.0, 0.4 * centered(&random)),
                          .life = 1,
                          .width_foot = 0.02,
                          .width_tip = 0.02,
                          .profile = BLADE_FLAT};
        TriangleSoup soup = {0};
        Vec3 top = vec3_madd(blade.velocity, blade.acceleration, 0.5);
        if (hypot(top.x, top.z) < 0.03) continue; /* turns back within a segment */
        particles_tessellate(&blade, 1, 1e-5, *state, &soup);
        Vec3 last = vec3_sub(soup.vertices.items[1].position, soup.vertices.items[0].position);
        for (size_t v = 2; v + 1 < soup.vertices.count; v += 2) {
            Vec3 across = vec3_sub(soup.vertices.items[v + 1].position, soup.vertices.items[v].position);
            assert_true(vec3_dot(across, last) > 0.6 * 0.02 * 0.02);
            last = across;
        }
    }
}

static void upright_blades_look_everywhere(void **state) {
    int quadrants[4] = {0};
    for (int i = 0; i < 400; i++) {
        Particle blade = {.position = {i * 0.1, 0, 3},
                          .velocity = {0, 1, 0},
                          .life = 1,
                          .width_foot = 1,
                          .width_tip = 1,
                          .profile = BLADE_FLAT};
        TriangleSoup soup = {0}, again = {0};
        particles_tessellate(&blade, 1, 0.1, *state, &soup);
        particles_tessellate(&blade, 1, 0.1, *state, &again);
        Vec3 front = soup.vertices.items[0].normal;
        assert_true(fabs(front.y) < 1e-12 && vec3_dot(front, again.vertices.items[0].normal) > 1 - 1e-12);
        quadrants[(front.x > 0) + 2 * (front.z > 0)]++;
    }
    for (int i = 0; i < 4; i++) assert_true(quadrants[i] > 60);
}

static void odd_particles_leave_finite_triangles_or_none(void **state) {
    const double nan_value = (double)NAN;
    const Particle odd[] = {
        {.life = 1, .width_foot = 1},             /* no way */
        {.velocity = {0, 1, 0}, .width_foot = 1}, /* no life */
        {.velocity = {0, 1, 0}, .life = -1, .width_foot = 1},
        {.velocity = {0, 1, 0}, .life = 1}, /* no width */
        {.velocity = {0, nan_value, 0}, .life = 1, .width_foot = 1},
        {.acceleration = {0, -1, 0}, .life = 1, .width_foot = 1}, /* starts at rest */
        {.acceleration = {1, 0, 0}, .life = 1, .width_foot = 1},
        {.velocity = {0, 1, 0}, .acceleration = {0, -2, 0}, .life = 1, .width_foot = 1}, /* up and back */
        {.velocity = {1, 1, 0}, .acceleration = {-2, -2, 1e-14}, .life = 1, .width_foot = 1},
        {.velocity = {1e-9, 1, 0}, .acceleration = {-2e-9, -2, 1e-9}, .life = 1, .width_foot = 1},
        {.velocity = {0, 1e-200, 0}, .life = 1, .width_foot = 1e-200},
        {.velocity = {0, 1e100, 0}, .acceleration = {1e100, 0, 0}, .life = 1, .width_foot = 1e99},
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(odd); i++) {
        for (int profile = 0; profile < 3; profile++) {
            Particle particle = odd[i];
            TriangleSoup soup = {0};
            particle.profile = (BladeProfile)profile;
            particles_tessellate(&particle, 1, 1e-3, *state, &soup);
            if (i < 5) assert_int_equal(soup.triangles.count, 0);
            for (size_t v = 0; v < soup.vertices.count; v++) {
                assert_true(vec3_is_finite(soup.vertices.items[v].position) &&
                            vec3_is_finite(soup.vertices.items[v].normal));
            }
        }
    }
}

static void a_tree_takes_particles_through_its_hook(void **state) {
    const Particle blade = {
        .velocity = {0, 1, 0}, .life = 1, .width_foot = 0.1, .width_tip = 0.1, .profile = BLADE_FLAT};
    const Transform triple = transform_scale(vec3_splat(3));
    Object object = {.kind = OBJECT_PARTICLES, .place = PLACE(triple)};
    const TessellateOptions options = {.tolerance = 0.01, .particles = particles_tessellate};
    TriangleSoup soup = {0};
    ShapeRefusal refusal;
    object.as.particles.items = &blade;
    object.as.particles.count = 1;
    assert_true(tessellate(&object, NULL, &options, *state, &soup, &refusal));
    assert_true(fabs(soup_area(&soup) - 0.9) < 1e-12);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(areas_are_width_times_way),
        TEST(round_ones_are_closed_and_have_their_volume),
        TEST(tolerance_is_kept_along_the_way),
        TEST(folded_blades_have_their_angle_and_open_to_the_front),
        TEST(frames_do_not_flip),
        TEST(upright_blades_look_everywhere),
        TEST(odd_particles_leave_finite_triangles_or_none),
        TEST(a_tree_takes_particles_through_its_hook),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
