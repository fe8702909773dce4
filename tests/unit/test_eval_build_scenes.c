/* Whole files through the evaluator to the printed scene: the shipped examples, and arrays as points. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "eval/eval.h"

typedef struct Evaluated {
    Arena parse, arena;
    SourceSet sources;
    DiagList diags;
    Interner names;
    const Scene *scene;
    EvalStatus status;
} Evaluated;

static void on_text(void *context, EvalStream stream, const char *text) {
    (void)context;
    (void)stream;
    (void)text;
}

static void evaluate(Evaluated *e, const char *path) {
    memset(e, 0, sizeof *e);
    arena_init(&e->parse, NULL, 0);
    arena_init(&e->arena, NULL, 0);
    source_set_init(&e->sources, &e->parse);
    diag_init(&e->diags, &e->parse, &e->sources);
    interner_init(&e->names, &e->arena);
    EvalOptions options = {.stdlib_dir = VTS_SOURCE_DIR "/stdlib",
                           .image_width = 400,
                           .image_height = 300,
                           .limits = eval_limits_default(),
                           .on_text = on_text};
    e->status = eval_file(path, &options, &e->sources, &e->diags, &e->names, &e->parse, &e->arena, &e->scene);
    for (const Diagnostic *d = e->diags.first; d; d = d->next) print_message("%s: %s\n", path, d->message);
}

static void release(Evaluated *e) {
    arena_destroy(&e->arena);
    arena_destroy(&e->parse);
}

/* Writes the text to a file of its own and evaluates it. */
static void evaluate_text(Evaluated *e, const char *text) {
    char path[] = "/tmp/vts_scene_XXXXXX";
    int file = mkstemp(path);
    FILE *stream = file < 0 ? NULL : fdopen(file, "w");
    assert_non_null(stream);
    fputs(text, stream);
    fclose(stream);
    evaluate(e, path);
    remove(path);
}

static size_t count_particles(const Skin *skin) {
    size_t count = 0;
    const TexelDef *texel = skin->texels[0].texel;
    for (size_t i = 0; i < texel->layer_count; i++)
        for (size_t k = 0; k < texel->layers[i].content_count; k++)
            if (texel->layers[i].contents[k]->kind == OBJECT_PARTICLES)
                count += texel->layers[i].contents[k]->as.particles.count;
    return count;
}

static void test_lawn_has_its_blades_and_flowers(void **state) {
    (void)state;
    Evaluated e;
    evaluate(&e, VTS_SOURCE_DIR "/examples/tufts.vts");
    assert_int_equal(e.status, EVAL_OK);
    assert_null(e.diags.first);
    assert_int_equal(e.scene->skin_count, 1);
    const Skin *skin = e.scene->skins[0];
    double tiles = skin->mapping.repeat_u * skin->mapping.repeat_v;
    assert_int_equal((int)(tiles * (double)count_particles(skin)), 21904);
    assert_in_range((int)(tiles * skin->texels[1].density), 650, 750);
    assert_int_equal(skin->surface->nu, 38);
    release(&e);
}

static void test_other_examples(void **state) {
    (void)state;
    static const char *const names[] = {"solids", "meadow_ball"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(names); i++) {
        char path[200];
        snprintf(path, sizeof path, VTS_SOURCE_DIR "/examples/%s.vts", names[i]);
        Evaluated e;
        evaluate(&e, path);
        assert_int_equal(e.status, EVAL_OK);
        assert_null(e.diags.first);
        assert_true(e.scene->object_count > 0);
        release(&e);
    }
}

/* Two evaluations of one file give equal hashes: what was built for one frame serves the next. */
static void test_hashes_are_the_same_next_time(void **state) {
    (void)state;
    Evaluated a, b;
    evaluate(&a, VTS_SOURCE_DIR "/examples/tufts.vts");
    evaluate(&b, VTS_SOURCE_DIR "/examples/tufts.vts");
    assert_true(hash_equal(a.scene->skins[0]->hash, b.scene->skins[0]->hash));
    assert_true(
        hash_equal(a.scene->skins[0]->texels[0].texel->hash, b.scene->skins[0]->texels[0].texel->hash));
    release(&a);
    release(&b);
}

static void test_points_of_arrays(void **state) {
    (void)state;
    Evaluated e;
    evaluate_text(&e, "#declare P = array[2][3] { {0, x, 2*x}, {z, x + z, 2*x + z} }\n"
                      "#declare H = array[2][3] { {y, y, y}, {2*y, 2*y, 3*y} }\n"
                      "object { surface { patch_grid 1, 2 points P height_vectors H } }\n");
    assert_int_equal(e.status, EVAL_OK);
    const Surface *s = e.scene->objects[0]->as.surface;
    assert_true(s->points[5].x == 2 && s->points[5].z == 1);
    assert_true(s->points[1].x == 1 && s->points[1].z == 0);
    assert_true(s->height_vectors[5].y == 3);
    release(&e);
    evaluate_text(
        &e,
        "#declare P = array[2][2] { {0, x}, {z, x + z} }\nobject { surface { patch_grid 1, 2 points P } }\n");
    assert_int_equal(e.status, EVAL_FAILED);
    assert_string_equal(e.diags.first->message,
                        "'points' needs an array [2][3] of vertices for 1 x 2 patches");
    release(&e);
}

static void test_functions_of_skins(void **state) {
    (void)state;
    Evaluated e;
    evaluate_text(
        &e,
        "#declare T = texel { layer { sphere { 0.5, 0.4 } } }\n"
        "#declare U = texel { layer { box { 0.1, 0.9 } } }\n"
        "skin { surface { sphere { 0, 1 } deform function(x, y, z) { <x, y*(1 + 0.1*x), z> } }\n"
        "  texel { choose T, U } texel { T density 0.25 texture { pigment { rgb <1, 0, 0> } } }\n"
        "  mapping { tile 0.25 height 0.4 function(x, y, z) { 1 + y } comb function(x, y, z) { <0, x, 0> }\n"
        "            w 0.2, 0.8 function(x, y, z) { <0, 1 - 0.5*y, 0> } } }\n");
    assert_int_equal(e.status, EVAL_OK);
    const Skin *skin = e.scene->skins[0];
    assert_int_equal(tape_input_count(skin->mapping.height_function), 3);
    assert_int_equal(tape_output_count(skin->mapping.comb_function), 3);
    assert_non_null(skin->surface->deform);
    assert_int_equal(skin->surface->uv, SURFACE_UV_SPHERICAL);
    assert_int_equal(skin->texels[0].texel->choice_count, 2);
    assert_string_equal(skin->texels[0].texel->choices[1]->name, "U");
    assert_true(skin->texels[1].density == 0.25 && skin->texels[1].texture != NULL);
    double in[3] = {0, 2, 0}, out[3];
    tape_eval_once(skin->mapping.w_function, in, out);
    assert_true(out[1] == 0);
    release(&e);
}

/* Meshes that bring coordinates keep them in a union, unless something else is in it. */
static void test_what_a_surface_is_wrapped_in(void **state) {
    (void)state;
    static const struct {
        const char *object;
        SurfaceUv uv;
    } cases[] = {{"M", SURFACE_UV_MESH},
                 {"union { object { M } union { object { M translate x } } }", SURFACE_UV_MESH},
                 {"union { object { M } object { Bare translate x } }", SURFACE_UV_PLANAR},
                 {"union { object { M } sphere { 0, 1 } }", SURFACE_UV_PLANAR}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        char text[1024];
        snprintf(text, sizeof text,
                 "#declare M = mesh { triangle { 0, x, z uv_vectors <0, 0>, <1, 0>, <0, 1> } }\n"
                 "#declare Bare = mesh { triangle { 0, x, z } }\n"
                 "skin { surface { %s } texel { layer { sphere { 0.5, 0.4 } } } mapping { tile 0.25 height 0.4 } }\n",
                 cases[i].object);
        Evaluated e;
        evaluate_text(&e, text);
        assert_int_equal(e.status, EVAL_OK);
        assert_int_equal(e.scene->skins[0]->surface->uv, cases[i].uv);
        release(&e);
    }
}

static void test_a_function_of_the_wrong_shape(void **state) {
    (void)state;
    Evaluated e;
    evaluate_text(&e, "object { surface { patch_grid 1, 2 function(x, y, z) { <x, y, z> } } }\n");
    assert_string_equal(e.diags.first->message,
                        "the function of 'patch_grid' takes 2 parameters here, this one has 3");
    release(&e);
    evaluate_text(&e, "object { surface { patch_grid 1, 2 function(u, v) { u + v } } }\n");
    assert_string_equal(e.diags.first->message, "the function of 'patch_grid' gives a vector <…, …, …> here");
    release(&e);
    evaluate_text(&e, "object { surface { patch_grid 1, 2 function(u, v) { <u, 1/(v - 0.5), 0> } } }\n");
    assert_string_equal(e.diags.first->message, "the surface has no finite point at u = 0, v = 0.5");
    release(&e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lawn_has_its_blades_and_flowers),
        cmocka_unit_test(test_other_examples),
        cmocka_unit_test(test_hashes_are_the_same_next_time),
        cmocka_unit_test(test_points_of_arrays),
        cmocka_unit_test(test_functions_of_skins),
        cmocka_unit_test(test_what_a_surface_is_wrapped_in),
        cmocka_unit_test(test_a_function_of_the_wrong_shape),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
