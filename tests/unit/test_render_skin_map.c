/* The mapping of skins: inversion, going from cell to cell, entering the layer, against exact bodies and brute force. */
#include "skin_scenes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

/* ---- single cells ---- */

static BilinearVec bilinear_through(const Vec3 c[4], bool triangle) {
    BilinearVec f = {{c[0], vec3_sub(c[1], c[0]), vec3_sub(c[triangle ? 2 : 3], c[0]), {0, 0, 0}}};
    if (!triangle) f.c[3] = vec3_sub(vec3_add(c[0], c[2]), vec3_add(c[1], c[3]));
    return f;
}

/* A box or prism with corners moved by up to `spread` of its side, stretched by `scale`. */
static SkinCell random_cell(RandomStream *r, bool triangle, double spread, Vec3 scale) {
    static const double square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, half[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    Vec3 foot[4], height[4];
    for (int k = 0; k < (triangle ? 3 : 4); k++) {
        const double *at = triangle ? half[k] : square[k];
        foot[k] = vec3(at[0] + between(r, -spread, spread), between(r, -spread, spread), at[1] + between(r, -spread, spread));
        height[k] = vec3(between(r, -spread, spread), 1 + between(r, -spread, spread), between(r, -spread, spread));
        foot[k] = vec3_mul(foot[k], scale), height[k] = vec3_mul(height[k], scale);
    }
    SkinCell cell = {.triangle = triangle, .foot = bilinear_through(foot, triangle), .height = bilinear_through(height, triangle)};
    for (int e = 0; e < 4; e++) cell.neighbour[e].cell = -1;
    return cell;
}

/* Sign of det J all over the cell: 0 where it changes. */
static int orientation(const SkinCell *cell) {
    int sign = 0;
    for (int i = 0; i <= 4; i++)
        for (int j = 0; j <= 4; j++)
            for (int k = 0; k <= 4; k++) {
                Mat3 m;
                if (cell->triangle && i + j > 4) continue;
                skin_cell_position(cell, i / 4.0, j / 4.0, k / 4.0, &m);
                int here = mat3_determinant(&m) > 0 ? 1 : -1;
                if (sign && here != sign) return 0;
                sign = here;
            }
    return sign;
}

static SkinPoint random_place(RandomStream *r, const SkinCell *cell) {
    SkinPoint p = {0, random_next_unit(r), random_next_unit(r), random_next_unit(r)};
    if (cell->triangle && p.a + p.b > 1) p.a = 1 - p.a, p.b = 1 - p.b;
    return p;
}

static void inversion_undoes_the_mapping(void **state) {
    (void)state;
    RandomStream r = {1};
    static const Vec3 scales[] = {{1, 1, 1}, {1e-3, 1e-3, 1e-3}, {1000, 1, 1}, {1, 1e-3, 1}, {1e4, 1e4, 1e4}, {-1, 1, 1}};
    size_t tried = 0, lost = 0;
    for (int i = 0; i < 20000; i++) {
        Vec3 scale = scales[i % 6];
        SkinCell cell = random_cell(&r, i & 1, 0.25, scale);
        int sign = orientation(&cell);
        if (!sign) continue;
        SkinPoint at = random_place(&r, &cell), found = {0, cell.triangle ? 1.0 / 3 : 0.5, cell.triangle ? 1.0 / 3 : 0.5, 0.5};
        Vec3 world = skin_cell_position(&cell, at.a, at.b, at.w, NULL);
        double size = fmin(fabs(scale.x), fmin(fabs(scale.y), fabs(scale.z)));
        tried++;
        if (!skin_cell_invert(&cell, world, 1e-7 * size, &found)) {
            lost++;
            continue;
        }
        Vec3 back = skin_cell_position(&cell, found.a, found.b, found.w, NULL);
        assert_true(vec3_length(vec3_sub(back, world)) < 1e-7 * size);
        assert_true(fabs(found.a - at.a) + fabs(found.b - at.b) + fabs(found.w - at.w) < 1e-5);
    }
    printf("%zu unfolded cells, %zu inversions lost\n", tried, lost);
    assert_true(tried > 10000);
    assert_int_equal(lost, 0);
}

static void jacobian_is_the_derivative(void **state) {
    (void)state;
    RandomStream r = {2};
    for (int i = 0; i < 200; i++) {
        SkinCell cell = random_cell(&r, i & 1, 0.4, vec3(2, 3, 0.5));
        SkinPoint p = random_place(&r, &cell);
        Mat3 j;
        const double d = 1e-5;
        skin_cell_position(&cell, p.a, p.b, p.w, &j);
        for (int k = 0; k < 3; k++) {
            double da = k == 0 ? d : 0, db = k == 1 ? d : 0, dw = k == 2 ? d : 0;
            Vec3 hi = skin_cell_position(&cell, p.a + da, p.b + db, p.w + dw, NULL);
            Vec3 lo = skin_cell_position(&cell, p.a - da, p.b - db, p.w - dw, NULL);
            assert_true(vec3_length(vec3_sub(vec3_scale(vec3_sub(hi, lo), 0.5 / d), j.c[k])) < 1e-8);
        }
    }
}

static void boxes_without_height_or_area_are_refused_quietly(void **state) {
    (void)state;
    RandomStream r = {3};
    for (int i = 0; i < 300; i++) {
        SkinCell cell = random_cell(&r, i & 1, 0.2, i % 3 == 0 ? vec3(1, 0, 1) : i % 3 == 1 ? vec3(0, 1, 0) : vec3(0, 0, 0));
        if (i % 3 == 0) cell.height = (BilinearVec){0};
        SkinPoint p = {0, .3, .3, .5};
        skin_cell_invert(&cell, vec3(between(&r, 0, 1), 0, between(&r, 0, 1)), 1e-9, &p);
        TexturePlace place = skin_texture_place(&cell, &(SkinPoint){0, .3, .3, .5});
        assert_true(vec3_is_finite(place.grad_u) && vec3_is_finite(place.grad_layer));
    }
}

/* ---- a hill ---- */

static Vec3 hill_foot(double u, double v) { return vec3(16 * (u - .5), 2.2 * exp(-((u - .5) * (u - .5) + (v - .4) * (v - .4)) * 8) + .1 * sin(9 * u), 16 * (v - .5)); }
static Vec3 hill_height(double u, double v) { return vec3(.25 * sin(7 * u + v), .9 + .2 * cos(11 * v), .2 * cos(5 * u * v)); }
static Vec3 hill_turned_over(double u, double v) { return hill_foot(v, u); }

static void check_inside(const CompiledSkin *skin, const SkinPoint *p) {
    const SkinCell *cell = &skin->cells[p->cell];
    assert_true(p->a >= -1e-7 && p->b >= -1e-7);
    if (cell->triangle) assert_true(p->a + p->b <= 1 + 1e-7);
    else assert_true(p->a <= 1 + 1e-7 && p->b <= 1 + 1e-7);
}

static void points_are_found_from_far_cells(void **state) {
    (void)state;
    RandomStream r = {4};
    for (int turned = 0; turned < 2; turned++) {
        SkinScene s;
        skin_scene_begin(&s);
        enum { N = 38 };
        skin_scene_grid(&s, N, N, turned ? hill_turned_over : hill_foot, hill_height);
        assert_int_equal(skin_scene_compile(&s), COMPILE_OK);
        const CompiledSkin *skin = &s.compiled.skins[0];
        int lost = 0;
        enum { TRIALS = 20000 };
        for (int i = 0; i < TRIALS; i++) {
            int from_i = (int)between(&r, 0, N), from_j = (int)between(&r, 0, N), hops = 1 + i % 8;
            int to_i = int_clamp(from_i + (int)between(&r, -hops, hops + 1), 0, N - 1);
            int to_j = int_clamp(from_j + (int)between(&r, -hops, hops + 1), 0, N - 1);
            int32_t from = from_i * N + from_j, to = to_i * N + to_j;
            SkinPoint target = random_place(&r, &skin->cells[to]), p = {from, .5, .5, .5};
            Vec3 world = skin_cell_position(&skin->cells[to], target.a, target.b, target.w, NULL);
            bool seam = false;
            SkinSide side = skin_locate(skin, world, 1e-9, &p, &seam);
            if (side != SKIN_INSIDE) {
                lost++;
                continue;
            }
            assert_false(seam);
            check_inside(skin, &p);
            Vec3 back = skin_cell_position(&skin->cells[p.cell], p.a, p.b, p.w, NULL);
            assert_true(vec3_length(vec3_sub(back, world)) < 1e-9);
            if (target.a > 1e-6 && target.a < 1 - 1e-6 && target.b > 1e-6 && target.b < 1 - 1e-6) assert_int_equal(p.cell, to);
        }
        printf("%d of %d points lost up to 8 cells away\n", lost, TRIALS);
        assert_true(lost < TRIALS / 1000);
        /* Above, below, beyond the border. */
        for (int i = 0; i < 2000; i++) {
            SkinPoint target = {(int32_t)between(&r, 0, N * N), random_next_unit(&r), random_next_unit(&r), 0};
            target.w = i & 1 ? between(&r, 1.01, 1.3) : between(&r, -.3, -.01);
            Vec3 world = skin_cell_position(&skin->cells[target.cell], target.a, target.b, target.w, NULL);
            SkinPoint p = {target.cell, .5, .5, .5};
            bool seam = false;
            assert_int_equal(skin_locate(skin, world, 1e-9, &p, &seam), i & 1 ? SKIN_ABOVE : SKIN_BELOW);
            int32_t cell = (int32_t)between(&r, 1, N - 1); /* of the first row */
            int edge = 0;
            while (edge < 4 && skin->cells[cell].neighbour[edge].cell >= 0) edge++;
            assert_true(edge < 4);
            static const double beyond[4][2] = {{.5, -.2}, {1.2, .5}, {.5, 1.2}, {-.2, .5}};
            world = skin_cell_position(&skin->cells[cell], beyond[edge][0], beyond[edge][1], .5, NULL);
            p = (SkinPoint){cell, .5, .5, .5};
            assert_int_equal(skin_locate(skin, world, 1e-9, &p, &seam), SKIN_BORDER);
        }
        skin_scene_end(&s);
    }
}

/* ---- entering ---- */

/* Whether the point is in the cell, by Newton's method in long double from the nearest of 27 points. */
static bool holds(const SkinCell *cell, Vec3 world, double *a_out, double *b_out) {
    double best = VTS_INFINITY;
    SkinPoint p = {0};
    for (int i = 0; i < 27; i++) {
        SkinPoint q = {0, (i % 3) / 2.0, (i / 3 % 3) / 2.0, i / 9 / 2.0};
        double d = vec3_length_squared(vec3_sub(world, skin_cell_position(cell, q.a, q.b, q.w, NULL)));
        if (d < best) best = d, p = q;
    }
    for (int i = 0; i < 30; i++) {
        Mat3 j, inverse;
        Vec3 rest = vec3_sub(world, skin_cell_position(cell, p.a, p.b, p.w, &j));
        if (!mat3_invert(&j, &inverse)) return false;
        Vec3 step = mat3_apply(&inverse, rest);
        double length = vec3_length(step), f = length > .5 ? .5 / length : 1;
        p.a += step.x * f, p.b += step.y * f, p.w += step.z * f;
        if (length < 1e-12) break;
    }
    *a_out = p.a, *b_out = p.b;
    return p.a >= 0 && p.b >= 0 && p.a <= 1 && p.b <= 1 && p.w >= 0 && p.w <= 1;
}

static bool skin_holds(const CompiledSkin *skin, Vec3 world) {
    for (size_t i = 0; i < skin->cell_count; i++) {
        Box3 box = box3_empty();
        for (int k = 0; k < 4; k++)
            box = box3_add_point(box3_add_point(box, cell_corner(&skin->cells[i], k, 0)), cell_corner(&skin->cells[i], k, 1));
        if (world.x < box.min.x || world.y < box.min.y || world.z < box.min.z || world.x > box.max.x || world.y > box.max.y ||
            world.z > box.max.z)
            continue;
        double a, b;
        if (holds(&skin->cells[i], world, &a, &b)) return true;
    }
    return false;
}

static Vec3 bumpy_foot(double u, double v) { return vec3(4 * u - 2, .5 * sin(5 * u) * cos(4 * v), 4 * v - 2); }
static Vec3 bumpy_height(double u, double v) { return vec3(.2 * sin(9 * v), .7, .2 * cos(8 * u)); }

/* Against points along the ray, a thousandth of the scene apart. */
static void rays_enter_patches_where_brute_force_says(void **state) {
    (void)state;
    RandomStream r = {5};
    SkinScene s;
    skin_scene_begin(&s);
    skin_scene_grid(&s, 4, 4, bumpy_foot, bumpy_height);
    assert_int_equal(skin_scene_compile(&s), COMPILE_OK);
    const CompiledSkin *skin = &s.compiled.skins[0];
    enum { STEPS = 1500 };
    const double length = 9;
    int inside_starts = 0, hits = 0;
    for (int i = 0; i < 600; i++) {
        SkinPoint target = {(int32_t)between(&r, 0, 16), random_next_unit(&r), random_next_unit(&r), between(&r, -.1, 1.1)};
        if (i % 4 == 1) target.a = 0, target.b = 0;
        if (i % 4 == 2) target.a = 1;
        Vec3 at = skin_cell_position(&skin->cells[target.cell], target.a, target.b, target.w, NULL);
        Vec3 d = spread_direction(&r);
        if (i % 4 == 3) d = vec3_normalize(vec3(d.x, .05 * d.y, d.z)); /* grazing */
        Ray ray = {i % 5 == 4 ? at : vec3_madd(at, d, -4.5), d};       /* camera in the layer */
        double first = -1;
        for (int k = 0; k < STEPS && first < 0; k++) {
            double t = length * (k + .5) / STEPS;
            if (skin_holds(skin, vec3_madd(ray.origin, d, t))) first = t;
        }
        SkinPoint p;
        double t;
        bool got = skin_enter(skin, &ray, 0, length, &p, &t);
        if (first >= 0) {
            hits++;
            assert_true(got);
            assert_true(t <= first);
            inside_starts += t == 0;
        }
        if (!got) continue;
        /* What the samples step over may be found, nothing else: just behind the entry lies the layer. */
        check_inside(skin, &p);
        if (first < 0 || t < first - length / STEPS) {
            bool within = false;
            for (int k = 1; k < 4000 && !within; k++) within = skin_holds(skin, vec3_madd(ray.origin, d, t + k * length / STEPS / 2000));
            bool on_wall = fmin(fmin(p.a, 1 - p.a), fmin(p.b, 1 - p.b)) < 1e-6; /* rays that start on the border */
            assert_true(within || on_wall);
        }
    }
    printf("%d rays enter, %d of them start in the layer\n", hits, inside_starts);
    assert_true(hits > 350 && inside_starts > 30);
    skin_scene_end(&s);
}

/* The ball's layer is known exactly: rays through faces, edges and vertices, along walls, from outside and inside. */
static void rays_enter_a_ball_exactly(void **state) {
    (void)state;
    RandomStream r = {6};
    static BallMesh ball;
    ball_make(&ball, 3);
    static const struct { Vec3 center; double radius, height; } cases[] = {
        {{0, 0, 0}, 1, .2}, {{3, -2, 1}, 1e-3, .5}, {{100, 50, -70}, 40, .01}, {{1e5, 2e5, -1e5}, 10, .1}};
    for (size_t c = 0; c < VTS_ARRAY_COUNT(cases); c++) {
        double radius = cases[c].radius, height = cases[c].height, worst = 0;
        Vec3 center = cases[c].center;
        SkinScene s;
        skin_scene_begin(&s);
        skin_scene_ball(&s, &ball, center, radius, height);
        assert_int_equal(skin_scene_compile(&s), COMPILE_OK);
        const CompiledSkin *skin = &s.compiled.skins[0];
        assert_int_equal(skin->cell_count, ball.triangle_count);
        int missed = 0, rays = 0;
        for (int i = 0; i < 4000; i++) {
            const uint32_t *f = ball.triangles[(size_t)between(&r, 0, (double)ball.triangle_count)];
            double e = random_next_unit(&r), w = random_next_unit(&r);
            Vec3 on = ball.vertices[f[0]]; /* a vertex, a point of an edge, any direction */
            if (i % 4 == 1) on = vec3_lerp(ball.vertices[f[0]], ball.vertices[f[1]], e);
            if (i % 4 >= 2) on = spread_direction(&r);
            Vec3 target = vec3_madd(center, on, radius * (1 + height * w));
            Vec3 d = spread_direction(&r);
            if (i % 8 == 1) { /* within the wall over the edge */
                Vec3 along = vec3_sub(ball.vertices[f[1]], ball.vertices[f[0]]);
                d = vec3_normalize(vec3_madd(vec3_scale(along, between(&r, -1, 1)), on, between(&r, -.3, .3)));
            }
            Ray ray = {vec3_madd(target, d, i % 6 == 5 ? 0 : -3 * radius), d};
            LayerParts parts = ball_layer_parts(&ball, center, radius, height, &ray, 0);
            SkinPoint p;
            double t, slack = 1e-6 * radius + 1e-12 * vec3_length(center);
            bool got = skin_enter(skin, &ray, 0, VTS_INFINITY, &p, &t);
            if (layer_length(&parts) < 1e-4 * radius) continue; /* touches */
            rays++;
            if (!got) {
                missed++;
                continue;
            }
            assert_true(t >= parts.from[0] - slack);
            if (parts.to[0] - parts.from[0] < 1e-4 * radius) continue;
            worst = fmax(worst, fabs(t - parts.from[0]) / radius);
            if (fabs(t - parts.from[0]) > slack) missed++;
        }
        printf("ball %zu: %d of %d entries missed, worst error of the others %.1e radii\n", c, missed, rays, worst);
        assert_int_equal(missed, 0);
        skin_scene_end(&s);
    }
}

/* ---- compiling ---- */

static Vec3 flat_foot(double u, double v) { return vec3(u, 0, v); }
static Vec3 valley_foot(double u, double v) { return vec3(u, 4 * (u - .5) * (u - .5), v); }
static Vec3 no_height(double u, double v) {
    (void)u, (void)v;
    return vec3(0, 0, 0);
}
static Vec3 no_area(double u, double v) {
    (void)v;
    return vec3(u, 0, 0);
}
static Vec3 leaning(double u, double v) {
    (void)u, (void)v;
    return vec3(40, .02, 0); /* wind that lays the height vectors nearly flat */
}

static bool warns_of_folds(Vec3 (*foot)(double, double), double height) {
    SkinScene s;
    skin_scene_begin(&s);
    skin_scene_grid(&s, 8, 8, foot, NULL);
    s.skin.mapping.height = height;
    assert_int_equal(skin_scene_compile(&s), COMPILE_OK);
    bool found = s.diags.first && strstr(s.diags.first->message, "folds") != NULL;
    skin_scene_end(&s);
    return found;
}

static void folds_are_named(void **state) {
    (void)state;
    assert_false(warns_of_folds(flat_foot, 100));
    assert_false(warns_of_folds(valley_foot, .05)); /* radius of curvature at the bottom: 1/8 */
    assert_true(warns_of_folds(valley_foot, .5));
}

static void degenerate_skins_do_no_harm(void **state) {
    (void)state;
    RandomStream r = {7};
    Vec3 (*feet[])(double, double) = {flat_foot, no_area, flat_foot};
    Vec3 (*heights[])(double, double) = {no_height, leaning, leaning};
    for (int k = 0; k < 3; k++) {
        SkinScene s;
        skin_scene_begin(&s);
        skin_scene_fill(&s, 8, 500, .1, TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z, 1);
        skin_scene_grid(&s, 3, 3, feet[k], heights[k]);
        assert_int_equal(skin_scene_compile(&s), COMPILE_OK);
        for (int i = 0; i < 3000; i++) {
            Vec3 target = vec3(random_next_unit(&r), i % 3 ? 0 : random_next_unit(&r), random_next_unit(&r));
            Cone cone = {vec3_madd(target, spread_direction(&r), -3), {0, 0, 0}, .001, .001};
            cone.direction = vec3_normalize(vec3_sub(target, cone.origin));
            if (i % 4 == 0) cone.direction = vec3(1, 0, 0), cone.origin = vec3(-2, 0, target.z);
            TraceCounters counters = {0};
            SkinSegment segment;
            double sum = 0;
            skin_march_begin(&s.march, &cone, 0, VTS_INFINITY, &s.compiled.march, &counters, true);
            for (int n = 0; n < 100000 && skin_march_next(&s.march, &segment); n++) {
                assert_true(segment.t1 >= segment.t0 && isfinite(segment.t1));
                assert_true(segment.transmittance >= 0 && segment.transmittance < 1);
                sum += segment.t1 - segment.t0;
            }
            assert_true(counters.steps < 100000);
            assert_true(sum < 50);
        }
        skin_scene_end(&s);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inversion_undoes_the_mapping),
        cmocka_unit_test(jacobian_is_the_derivative),
        cmocka_unit_test(boxes_without_height_or_area_are_refused_quietly),
        cmocka_unit_test(points_are_found_from_far_cells),
        cmocka_unit_test(rays_enter_patches_where_brute_force_says),
        cmocka_unit_test(rays_enter_a_ball_exactly),
        cmocka_unit_test(folds_are_named),
        cmocka_unit_test(degenerate_skins_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
