/* Many skins along one cone: boxes against the search for pieces of cells, and what is opened from near to far against one march after the other. */
#include "skin_scenes.h"

#include "render/skin_box.h"
#include "render/skin_front.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

enum { COPIES = 150, CONES = 300 };

/* A wood of slanted boxes of leaves, so dense that many overlap; every tenth is bent, and no box. */
typedef struct Wood {
    SkinScene s;
    Surface surface[COPIES];
    Skin skin[COPIES];
    const Skin *list[COPIES];
} Wood;

static Vec3 in_cube(RandomStream *r, double size) { return vec3(between(r, -size, size), between(r, -size, size), between(r, -size, size)); }

static void make(Wood *w, double spread) {
    SkinScene *s = &w->s;
    RandomStream r = {21};
    skin_scene_begin(s);
    skin_scene_fill(s, 16, 300, .05, 0, 5);
    for (int i = 0; i < COPIES; i++) {
        Vec3 *p = arena_new_array(&s->arena, Vec3, 8), corner = in_cube(&r, spread), a = vec3(1, 0.2 * between(&r, -1, 1), 0), b = vec3(0, 0.1, -1), up = vec3(0.2, 1, 0.1);
        for (int k = 0; k < 4; k++) {
            p[k] = vec3_madd(vec3_madd(corner, a, k / 2), b, k % 2);
            p[4 + k] = vec3_madd(up, in_cube(&r, 0.2), i % 10 == 9);
        }
        w->surface[i] = (Surface){.kind = SURFACE_PATCHES, .nu = 1, .nv = 1, .points = p, .height_vectors = p + 4, .transform = transform_identity()};
        w->skin[i] = s->skin;
        w->skin[i].surface = &w->surface[i];
        w->list[i] = &w->skin[i];
    }
    s->scene.skins = w->list;
    s->scene.skin_count = COPIES;
    const CompileOptions options = {.width = 100, .height = 100};
    assert_int_equal(compile_scene(&s->scene, &options, &s->arena, &s->diags, &s->compiled), COMPILE_OK);
}

static Cone cone_through(RandomStream *r, double spread) {
    Vec3 from = vec3_scale(spread_direction(r), 3 * spread + 3), to = in_cube(r, spread);
    return (Cone){from, vec3_normalize(vec3_sub(to, from)), 0, 0.004};
}

static void boxes_are_what_their_cells_are(void **state) {
    (void)state;
    static Wood w;
    make(&w, 1);
    RandomStream r = {4};
    int boxes = 0, met = 0;
    for (int i = 0; i < COPIES; i++) {
        const CompiledSkin *skin = &w.s.compiled.skins[i];
        assert_int_equal(skin->box != NULL, i % 10 != 9);
        if (!skin->box) continue;
        boxes++;
        for (int k = 0; k < CONES; k++) {
            Cone cone = cone_through(&r, 1);
            Ray ray = {cone.origin, cone.direction};
            SkinPiece pieces[MOST_PIECES];
            SkinStretch way;
            double t_max = k % 3 ? 20 : between(&r, 2, 6);
            int count = skin_cell_pieces(&skin->cells[0], 0, &ray, 0.5, t_max, pieces);
            bool found = skin_box_stretch(skin->box, &ray, 0.5, t_max, &way);
            if (!count || !found) {
                assert_true((count ? pieces[0].t1 - pieces[0].t0 : found ? way.t1 - way.t0 : 0) < 1e-6);
                continue;
            }
            met++;
            assert_true(fabs(pieces[0].t0 - way.t0) < 1e-6 && fabs(pieces[0].t1 - way.t1) < 1e-6);
            Vec3 start = skin_cell_position(&skin->cells[0], way.start.a, way.start.b, way.start.w, NULL);
            assert_true(vec3_length(vec3_sub(start, vec3_madd(ray.origin, ray.direction, way.t0))) < 1e-9);
        }
    }
    assert_true(boxes == COPIES * 9 / 10 && met > 1000);
    skin_scene_end(&w.s);
}

static double everything(const CompiledSkin *skin, const void *context) {
    (void)skin;
    return *(const double *)context;
}

/* The optical depth of all skins, each followed alone. */
static double depth_alone(Wood *w, const Cone *cone, double from, double t_max, SkinMarch *march) {
    TraceCounters counters = {0};
    double sum = 0;
    for (int i = 0; i < COPIES; i++) {
        SkinSegment segment;
        skin_march_init(march, &w->s.compiled.skins[i], &w->s.arena);
        skin_march_begin(march, cone, from, t_max, &w->s.compiled.march, &counters, true);
        while (skin_march_next(march, &segment)) sum += (double)segment.depth;
    }
    return sum;
}

static void check_front(double spread, double t_max, double from, int cones) {
    static Wood w;
    make(&w, spread);
    RandomStream r = {9};
    TraceCounters counters = {0};
    SkinFront front;
    SkinMarch march;
    double total = 0;
    skin_front_init(&front, &w.s.compiled, &counters, &w.s.arena);
    for (int i = 0; i < cones; i++) {
        Cone cone = cone_through(&r, spread);
        const SkinSegment *segment;
        const SkinMarch *of;
        uint32_t skin;
        double sum = 0, last = -VTS_INFINITY;
        skin_front_begin(&front, &cone, t_max, everything, &from);
        while ((segment = skin_front_next(&front, &skin, &of)) != NULL) {
            assert_ptr_equal(of->skin, &w.s.compiled.skins[skin]);
            assert_true(segment->t0 >= last && segment->t0 >= from && segment->t1 <= t_max + 1e-9);
            last = segment->t0;
            sum += (double)segment->depth;
        }
        double alone = depth_alone(&w, &cone, from, t_max, &march);
        assert_true(fabs(sum - alone) <= 0.02 * alone + 1e-3); /* where a march begins anew its steps lie elsewhere */
        total += alone;
    }
    assert_true(total > cones);
    skin_scene_end(&w.s);
}

static void a_front_meets_what_each_march_meets(void **state) {
    (void)state;
    check_front(2, VTS_INFINITY, 0, 40);
    check_front(2, 9, 7, 40);
}

static void more_may_overlap_than_there_are_marches(void **state) {
    (void)state;
    check_front(0.05, VTS_INFINITY, 0, 10);
    check_front(0.001, VTS_INFINITY, 3.1, 40); /* within all of them: all begin at once */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_are_what_their_cells_are),
        cmocka_unit_test(a_front_meets_what_each_march_meets),
        cmocka_unit_test(more_may_overlap_than_there_are_marches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
