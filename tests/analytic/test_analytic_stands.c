/* Stands of the standard library fit each other: `tiling wang` finds nothing that crosses a border of one and not of the others. */
#include "analytic.h"

#define VIEW                                                                                                    \
    "#include \"trees.inc\"\n"                                                                                  \
    "camera { location <0, 300, -100> look_at 0 angle 40 }\n"                                                   \
    "light_source { <-300, 500, -300>, rgb 2 parallel point_at 0 }\n"                                           \
    "#declare Field = surface { patch_grid 1, 1 function(u, v) { <200*(u - 0.5), 0, 200*(v - 0.5)> } }\n"
#define LAID(kinds) "skin { surface { Field } texel { choose " kinds " } mapping { tile 25 height 22 } tiling wang }\n"
#define OAKS                                                                                                    \
    "#declare Plants = array[2] { Oak_Plant(20, Summer, 1, 1, 1, 0.2), Birch_Plant(20, Summer, 2, 1, 1, 0.2) }\n" \
    "#macro Stand(Border, Seed) Tree_Stand(Plants, Oak_Bark, Oak_Leaves(Summer), 25, 22, 8.3, Border, Seed) #end\n"

/* Whether a scene was drawn with a warning about borders. */
static bool cut(Bench *bench, const char *scene) {
    VtsOptions o = options_of_size(16, 12);
    static const char *const folders[] = {STDLIB};
    o.max_error = 0.1, o.include_dirs = folders, o.include_dir_count = 1;
    bench_write(bench, scene);
    VtsSession *session = vts_session_create(&o, NULL);
    assert_non_null(session);
    assert_int_equal(vts_render(session, bench->scene, bench->output), VTS_OK);
    bool found = strstr(vts_diagnostics(session), "of what crosses the border") != NULL;
    vts_session_destroy(session);
    return found;
}

static void spruces_fit(void **state) { assert_false(cut(*state, VIEW LAID("Spruce_Stand_1, Spruce_Stand_2, Spruce_Stand_3"))); }

/* Crowns of oaks are wide beside the distance of the trees. */
static void oaks_of_one_border_fit(void **state) { assert_false(cut(*state, VIEW OAKS LAID("Stand(1, 1), Stand(1, 2), Stand(1, 3)"))); }

static void stands_of_other_borders_do_not(void **state) { assert_true(cut(*state, VIEW OAKS LAID("Stand(1, 1), Stand(2, 1)"))); }

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spruces_fit), cmocka_unit_test(oaks_of_one_border_fit), cmocka_unit_test(stands_of_other_borders_do_not),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
