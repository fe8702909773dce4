/* What builders say about blocks that are wrong: the message, its place, its hint. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "block_text.h"

typedef struct Case {
    const char *text;
    const char *message; /* "line:column: message" of the first diagnostic */
    const char *hint;    /* NULL: not tested */
} Case;

static const Case errors[] = {
    {"sphere { 0, 1 hollo }", "1:15: 'hollo' is neither declared nor a word of 'sphere'",
     "did you mean 'hollow'?"},
    {"sphere { 0, \"wide\" }", "1:13: the radius takes a float, found a string", NULL},
    {"sphere { 0 }", "1:12: expected the radius (a float) in 'sphere', found '}'", NULL},
    {"sphere { <0,nan,0>, 1 }", "1:10: the center has a component that is not a finite number", NULL},
    {"sphere { 0, 1 translate \"up\" }", "1:25: 'translate' takes a vector, found a string", NULL},
    {"sphere { 0, 1 translate }", "1:15: too few values for 'translate': expected 1, found 0", NULL},
    {"sphere { 0, 1 translate x y }", "1:27: too many values for 'translate': expected 1, found 2", NULL},
    {"sphere { 0, 1 matrix <1,2,0, 1,2,0, 0,0,1, 0,0,0> }",
     "1:15: this matrix is singular: it presses space flat", NULL},
    {"sphere { 0, 1 matrix <1,0,0> }",
     "1:15: 'matrix' takes 12 numbers: the images of x, y and z, and the origin's", NULL},
    {"cylinder { <1,1,1>, <1,1,1>, 0.5 }",
     "1:30: this cylinder is degenerate: its base and cap points are the same", NULL},
    {"cone { 0, 1, 0, 0.5 }", "1:17: this cone is degenerate: its base and cap points are the same", NULL},
    {"plane { 0, 1 }", "1:9: the normal of 'plane' has no length", NULL},
    {"mesh { triangle { 0, x, x } }", "1:29: 'mesh' without triangles", NULL},
    {"mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 1, <0,1,3> } }",
     "1:57: triangle 0: there is no vertex 3; they count from 0 to 2", NULL},
    {"mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 2, <0,1,2>, <-1,1,2> } }",
     "1:66: triangle 1: there is no vertex -1; they count from 0 to 2", NULL},
    {"mesh2 { vertex_vectors { 4, 0, x, y } face_indices { 1, <0,1,2> } }",
     "1:9: 'vertex_vectors' announces 4 vertices, but 3 follow", NULL},
    {"mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 1, <0,1,2>, 0 } }",
     "1:66: triangle 0: there is no texture 0; they count from 0 to 0", NULL},
    {"mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 1, <0,1,2> } height_vectors { 2, y, y } }",
     "1:67: 'height_vectors' has 2 vectors for 3 vertices", NULL},
    {"mesh2 { face_indices { 1, <0,1,2> } }", "1:1: 'mesh2' needs 'vertex_vectors' and 'face_indices'", NULL},
    {"object { rgb 1 }", "1:10: 'object' takes an object, found a colour", NULL},
    {"object { Tree translate x }", "1:10: 'Tree' is not declared", NULL},
    {"object { }", "1:1: 'object' needs an object", NULL},
    {"sphere { Ball 1 }", "1:10: 'Ball' is not declared", NULL},
    {"camera { location 0 look_at 0 }", "1:21: the camera looks at its own location", NULL},
    {"camera { angle 180 }", "1:16: the angle of this camera must be less than 180 degrees, found 180", NULL},
    {"camera { loction 0 }", "1:10: 'loction' is neither declared nor a word of 'camera'",
     "did you mean 'location'?"},
    {"light_source { 0, rgb 1 spotligth }",
     "1:25: 'spotligth' is neither declared nor a word of 'light_source'", "did you mean 'spotlight'?"},
    {"pigment { graddient y }", "1:11: 'graddient' is neither declared nor a word of 'pigment'",
     "did you mean 'gradient'?"},
    {"pigment { <1,0,0> }", "1:11: a vector has no meaning here in 'pigment'", NULL},
    {"color_map { }", "1:1: 'color_map' without entries", NULL},
    {"color_map { [0 \"red\"] }", "1:16: an entry of a colour map is [ position colour ]", NULL},
    {"finish { diffuse x }", "1:18: 'diffuse' takes a float, found a vector", NULL},
    {"finish { speculer 1 }", "1:10: 'speculer' is neither declared nor a word of 'finish'",
     "did you mean 'specular'?"},
    {"finish { roughness -1 }", "1:20: 'roughness' cannot be negative, found -1", NULL},
    {"texel { }", "1:1: this texel has no content: it needs a layer { … }", NULL},
    {"texel { layer { } }", "1:9: this layer holds no object", NULL},
    {"texel { sphere { 0, 1 } }", "1:9: objects of a texel stand in its layers",
     "write layer { … } around it"},
    {"texel { layer { plane { y, 0 } } }", "1:17: a plane has no end: a layer's contents must have bounds",
     NULL},
    {"texel { resolution 2000 layer { sphere { 0, 1 } } }",
     "1:20: 'resolution' must lie between 1 and 1024, found 2000", NULL},
    {"texel { resolution 0 layer { sphere { 0, 1 } } }",
     "1:20: 'resolution' must lie between 1 and 1024, found 0", NULL},
    {"texel { resolution 12.5 layer { sphere { 0, 1 } } }",
     "1:20: 'resolution' takes a whole number, found 12.5", NULL},
    {"texel { cyclic x cyclic z layer { sphere { 0, 1 } } }", "1:18: 'cyclic' stands twice in 'texel'", NULL},
    {"texel { bounds 0, x layer { sphere { 0, 1 } } }",
     "1:19: the texel's bounds have no volume: <1, 0, 0> in size", NULL},
    {"texel { layr { sphere { 0, 1 } } }", "1:9: 'layr' is neither declared nor a word of 'texel'",
     "did you mean 'layer'?"},
    {"particles { count 1 { position 0 } }",
     "1:13: a particle without velocity and acceleration leaves no trace", NULL},
    {"particles { count 1 { velocity y life 0 } }", "1:39: 'life' must be greater than 0, found 0", NULL},
    {"particles { count 1 { velocity y profile \"w\" } }", "1:42: there is no profile \"w\"",
     "it is one of \"v\", \"round\", \"flat\""},
    {"particles { count 1 { velosity y } }", "1:23: 'velosity' is neither declared nor a word of 'count'",
     "did you mean 'velocity'?"},
    {"surface { patch_grid 0, 4 }", "1:22: 'patch_grid' needs at least 1 patch along each side, found 0",
     NULL},
    {"surface { patch_grid 2, 4 }", "1:11: 'patch_grid' needs a function(u, v) {<…>} or points", NULL},
    {"surface { uv planr y sphere { 0, 1 } }",
     "1:14: expected mesh, planar AXIS, cylindrical or spherical after 'uv', found 'planr'", NULL},
    {"surface { }", "1:1: this surface has no shape: it needs an object or a 'patch_grid'", NULL},
    {"surface { plane { y, 0 } }", "1:11: a plane has no end: a surface needs an object with bounds", NULL},
    {"skin { }", "1:1: this skin has no surface { … } to lie on", NULL},
    {"skin { surface { sphere { 0, 1 } } }", "1:1: this skin has no texel { … } to lay on its surface", NULL},
    {"skin { sphere { 0, 1 } }", "1:8: a skin lies on a surface", "write surface { … } around the object"},
    {"skin { mapping { repeat <0, 4> } }",
     "1:25: 'repeat' must be greater than 0 in both directions, found <0, 4>", NULL},
    {"skin { mapping { repeat <4, 4> repeat 3 } }", "1:32: 'repeat' stands twice in 'mapping'", NULL},
    {"skin { mapping { height x } }", "1:25: 'height' takes a float, found a vector", NULL},
    {"skin { jitter { scale 3 } }",
     "1:17: 'scale' of a jitter follows 'coordinates', 'height' or 'direction'", NULL},
    {"skin { jitter { instance { rotaet 20 } } }",
     "1:28: 'rotaet' is neither declared nor a word of 'instance'", "did you mean 'rotate'?"},
    {"skin { tiling wave }", "1:15: expected plain or wang after 'tiling', found 'wave'", NULL},
    {"fog { distance }", "1:7: too few values for 'distance': expected 1, found 0", NULL},
    {"global_settings { max_eror 1 }", "1:19: 'max_eror' is neither declared nor a word of 'global_settings'",
     "did you mean 'max_error'?"},
    {"global_settings { detail fine }", "1:26: 'fine' is no 'detail'",
     "it is one of auto, exact, voxels, slab"},
    {"global_settings { samples 0 }", "1:27: 'samples' must lie between 1 and 256, found 0", NULL},
    {"texture { pigment { rgb 1 } }", "1:1: a texture has no meaning at top level",
     "it belongs into an object, or give it a name with #declare"},
    {"texel { layer { sphere { 0, 1 } } }", "1:1: a texel has no meaning at top level",
     "give it a name with #declare, then lay it on a surface by a skin"},
    {"mapping { repeat 3 }", "1:1: 'mapping' cannot stand at top level: it belongs into another block", NULL},
    {"skin { surface { sphere { 0, 1 } } texel { \"forest.vtx\" } }", "1:44: there is no texel file 'forest.vtx'", "looked in nowhere"},
    {"skin { surface { sphere { 0, 1 } } texel { resolution 3 \"forest.vtx\" } }",
     "1:57: a texel's file comes first, and without layers of its own", NULL},
};

static const Case warnings[] = {
    {"disc { 0, 0, 1 }", "1:11: the normal of 'disc' has no length: nothing will be seen", NULL},
    {"camera { right 0 } sphere { 0, 1 }", "1:1: the camera's direction, right and up span no space", NULL},
    {"light_source { 0, rgb 1 parallel point_at 0 } sphere { 0, 1 }",
     "1:1: this light has no direction, for it stands where it points at: it lights nothing", NULL},
    {"sphere { 0, 1 scale <2, 0, 3> }", "1:21: scale by 0 along y is changed to 1", NULL},
    {"sphere { 0, -1 }", "1:13: the radius of 'sphere' is negative: -1 is taken as 1", NULL},
    {"union { sphere { 0, 1 } }", "1:9: 'union' should hold at least 2 objects, found 1", NULL},
    {"triangle { 0, 0, x }", "1:18: this triangle has no area: it is left out", NULL},
    {"camera { location y look_at 0 }",
     "1:21: the camera looks along its sky vector: the picture's horizon follows 'right'", NULL},
    {"camera { right <1, 1, 0> }", "1:1: the camera's vectors are not perpendicular", NULL},
    {"sphere { 0, 1 interior { ior -1.5 } }", "1:30: an index of refraction is positive: -1.5 is taken as 1", NULL},
    {"sphere { 0, 1 uv_mapping }", "1:15: 'uv_mapping' is not modelled yet: it has no effect", NULL},
    {"sphere { 0, 1 texture { pigment { image_map { \"a.png\" } } } }",
     "1:35: 'image_map' is not modelled yet: it has no effect", NULL},
    {"lsystem { axiom \"A\" }", "1:1: this L-system draws nothing: its word has no F and no symbol with an object", NULL},
    {"fog { rgb 1 }", "1:1: this fog has no distance greater than 0: it has no effect", NULL},
    {"global_settings { photons { count 3 } }",
     "1:19: 'photons' is not modelled yet: it has no effect", NULL},
    {"global_settings { }", "0:0: the scene holds nothing to draw: the picture is its background", NULL},
};

/* The first diagnostic of this severity. */
static const Diagnostic *first_of(const BlockText *t, Severity severity) {
    const Diagnostic *d = t->diags.first;
    while (d && d->severity != severity) d = d->next;
    return d;
}

static bool matches(BlockText *t, const Case *c, Severity severity) {
    const Diagnostic *d = first_of(t, severity);
    StrBuf text = {0};
    if (d) {
        SourcePlace place = source_locate(&t->sources, d->span);
        strbuf_addf(&text, "%u:%u: %s", place.file ? place.line : 0, place.file ? place.column : 0,
                    d->message);
    }
    bool same = d && strcmp(text.data, c->message) == 0 &&
                (!c->hint || (d->hint && strcmp(d->hint, c->hint) == 0)) &&
                (severity == SEVERITY_ERROR || t->diags.error_count == 0);
    if (!same)
        print_error("for: %s\n  wanted: %s\n  found:  %s\n  hint:   %s\n", c->text, c->message,
                    d ? text.data : "nothing", d && d->hint ? d->hint : "none");
    strbuf_free(&text);
    return same;
}

static void check_all(const Case *cases, size_t count, Severity severity) {
    size_t wrong = 0;
    for (size_t i = 0; i < count; i++) {
        BlockText t;
        block_text_begin(&t);
        block_text_scene(&t, cases[i].text);
        wrong += !matches(&t, &cases[i], severity);
        block_text_end(&t);
    }
    assert_int_equal(wrong, 0);
}

static void test_errors(void **state) {
    (void)state;
    check_all(errors, VTS_ARRAY_COUNT(errors), SEVERITY_ERROR);
}

static void test_warnings(void **state) {
    (void)state;
    check_all(warnings, VTS_ARRAY_COUNT(warnings), SEVERITY_WARNING);
}

static void test_inert_is_named_once(void **state) {
    (void)state;
    BlockText t;
    block_text_begin(&t);
    assert_non_null(block_text_scene(&t, "sphere { 0, 1 uv_mapping } sphere { 0, 2 uv_mapping }"));
    assert_int_equal(t.diags.warning_count, 1);
    block_text_end(&t);
}

static void test_declared_but_unused_is_silent(void **state) {
    (void)state;
    BlockText t;
    block_text_begin(&t);
    assert_int_equal(
        block_text_value(&t, "texture { pigment { image_map { \"a.png\" } } normal { bumps 1 } }").kind,
        VALUE_TEXTURE);
    assert_null(t.diags.first);
    block_text_end(&t);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_errors),
        cmocka_unit_test(test_warnings),
        cmocka_unit_test(test_inert_is_named_once),
        cmocka_unit_test(test_declared_but_unused_is_silent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
