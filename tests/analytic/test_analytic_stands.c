/* Stands of the standard library: they fit each other, and `tiling wang` finds nothing that crosses a border of one and not of the others; from voxels
 * they have the light that their triangles have. */
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

/* Mean of a wood that fills the view, from `up` degrees above the horizon; the sun behind the viewer at `sun` degrees from the zenith, or before him, below 0. */
static double light_of_wood(Bench *bench, bool exact, bool wang, const char *distance, const char *up, const char *sun) {
#define ONE_STAND  "Spruce_Stand_1"
#define TWO_STANDS "choose Spruce_Stand_1, Spruce_Stand_2"
    char scene[2000];
    snprintf(scene, sizeof scene,
             "#include \"trees.inc\"\n"
             "camera { location vrotate(-%s*z, <%s, 0, 0>) look_at 0 right x*image_width/image_height angle 10 }\n"
             "light_source { 1e7*vrotate(y, <-(%s), 0, 0>), rgb 1 parallel point_at 0 }\n"
             "#declare Field = surface { patch_grid 1, 1 function(u, v) { <8000*(u - 0.5), 0, 8000*(v - 0.5)> } texture { pigment { rgb 0.2 } } }\n"
             "object { Field }\n"
             "skin { surface { Field } texel { %s }%s mapping { tile 25 height 22 } }\n", distance, up, sun, wang ? TWO_STANDS : ONE_STAND, wang ? " tiling wang" : "");
    static const char *const folders[] = {STDLIB};
    const VtsPair voxels = {"detail", "voxels"};
    VtsOptions o = options_of_size(20, 15);
    o.include_dirs = folders, o.include_dir_count = 1;
    if (exact) o.reference_samples = 24;
    else o.settings = &voxels, o.setting_count = 1;
    return bench_mean(bench, &o, scene, exact);
}

/* A tile in 10, 5 and 1 pixels. It was a quarter to a half of the light where eye and sun are nearly one, by voxels that take what is seen for any of their matter. */
static void voxels_have_the_light_of_woods(void **state) {
    static const struct {
        const char *distance, *up, *sun;
    } views[] = {{"290", "60", "20"}, {"580", "60", "20"}, {"2900", "60", "20"}, {"580", "60", "50"}, {"580", "60", "-50"}};
    int failed = 0;
    for (size_t k = 0; k < VTS_ARRAY_COUNT(views); k++) {
        double truth = light_of_wood(*state, true, false, views[k].distance, views[k].up, views[k].sun);
        for (size_t i = 0; i < 2; i++) {
            double ratio = light_of_wood(*state, false, i > 0, views[k].distance, views[k].up, views[k].sun) / truth;
            bool good = ratio > 0.8 && ratio < 1.1;
            failed += !good;
            printf("%s, from %s at %s degrees, sun %s: %.4f, voxels %.3f of it%s\n", i ? "wang" : "plain", views[k].distance, views[k].up, views[k].sun, truth, ratio, good ? "" : "  <--");
        }
    }
    assert_int_equal(failed, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spruces_fit), cmocka_unit_test(oaks_of_one_border_fit), cmocka_unit_test(stands_of_other_borders_do_not),
        cmocka_unit_test(voxels_have_the_light_of_woods),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
