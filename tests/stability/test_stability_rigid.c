/* Copies that nothing bends, met by rays: wherever they stand and however they are turned, they are what the reference has. */
#include "stability.h"

#define TREE "#declare Tree = texel { bounds -0.5, <0.5, 1, 0.5> resolution 64 layer { cylinder { -0.5*y, 0.4*y, 0.06 } texture { pigment { rgb <0.5, 0.3, 0.2> } } }" \
             " layer { mesh { #for (I, 1, 60) #local P = <0.7*rand(S) - 0.35, 0.2 + 0.7*rand(S), 0.7*rand(S) - 0.35>; #local A = vrotate(0.08*x, 360*<rand(S), rand(S), rand(S)>);" \
             " #local B = vrotate(0.08*y, 360*<rand(S), rand(S), rand(S)>); triangle { P + A, P - A, P + B } #end } } };\n"
#define FLOOR "plane { y, -0.5 pigment { rgb 0.7 } }\n"
#define FIELD(x, y, z) "#declare Ground = surface { patch_grid 1, 1 function(u, v) { <6*u - 3 + " x ", " y ", 6*v - 3 + " z "> } };\n"

static void placed(void **state) {
    (void)state;
    static const Trial trials[] = {
        {"one, as an object", TREE FLOOR "Look(<1, 1, -3>, <0, 0.2, 0>, 40) object { Tree }", .03, .006, .04},
        {"some, turned, stretched, mirrored, leaning", TREE FLOOR "Look(<1, 2, -6>, <0, 0, 0>, 45) object { Tree rotate 40*y translate -2*x } object { Tree scale <-1, 1.5, 0.7> translate 2*x }"
         " object { Tree rotate <30, 10, 50> } object { Tree matrix <1, 0.2, 0, 0, 1, 0.4, 0.3, 0, 1, 0, 0, 2> }", .03, .006, .04},
        {"beside a skin that is bent", TREE "Look(<1, 2, -6>, <0, 0, 0>, 45) object { Tree scale 2 } skin { surface { sphere { -3*y, 2.5 } } texel { Leaves(20, 0.12) } mapping { repeat <16, 8> height 0.4 } }", .04, .01, .04},
        {"a light at a place", TREE FLOOR "Look(<1, 2, -6>, <0, 0, 0>, 45) light_source { <0, 2, -1>, rgb 1 } object { Tree rotate 40*y translate -x } object { Tree translate x }", .03, .006, .04},
    };
    try_from(trials, VTS_ARRAY_COUNT(trials), 0);
}

static void fields(void **state) {
    (void)state;
    static const Trial trials[] = {
        {"a flat field of jittered copies", TREE FIELD("0", "-0.5", "0") FLOOR "Look(<1, 2, -6>, <0, 0, 0>, 45) skin { surface { Ground } texel { Tree } mapping { repeat <5, 5> height 1.5 }"
         " jitter { instance { rotate 360 scale 0.4 displace 0.3 mirror tint rgb 0.7, rgb 1.3 } } }", .04, .01, .04},
        {"orthographic", TREE FIELD("0", "0", "0") "camera { orthographic location <2, 4, -6> look_at 0 right 6*x up 4.5*y } skin { surface { Ground } texel { Tree } mapping { repeat <5, 5> height 1 } }", .04, .01, .04},
        {"far from the origin", TREE FIELD("1e5", "3e4", "-2e5") "Look(<1e5 + 1, 3e4 + 2, -2e5 - 6>, <1e5, 3e4, -2e5>, 45) skin { surface { Ground } texel { Tree } mapping { repeat <5, 5> height 1 } }", .04, .01, .04},
        {"cyclic, a field of patches", FIELD("0", "0", "0") "Look(<1, 2, -6>, <0, 0, 0>, 45) skin { surface { Ground } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.8 } }", .05, .02, .04},
        {"of half tiles: cut at the border", TREE FIELD("0", "0", "0") "Look(<1, 2, -6>, <0, 0, 0>, 45) skin { surface { Ground } texel { Tree } mapping { repeat <4.5, 3.3> height 1 } }", .04, .01, .04},
        {"cyclic, of half tiles, in half light", FIELD("0", "0", "0") "Look(<1, 2, -6>, <0, 0, 0>, 45) skin { surface { Ground } texel { Leaves(30, 0.12) } mapping { repeat <4.6, 5.3> height 0.8 } }", .05, .02, .04},
        {"wang, seen along its border", FIELD("0", "0", "0") "Look(<-3, 2, -6>, <-2.5, 0, 0>, 45) skin { surface { Ground } texel { choose Leaves(30, 0.12), Leaves(20, 0.12) } tiling wang mapping { repeat <5, 5> height 0.8 } }", .05, .02, .04},
        {"the upper half of them alone", TREE FIELD("0", "0", "0") "Look(<1, 2, -6>, <0, 0, 0>, 45) skin { surface { Ground } texel { Tree } mapping { repeat <4, 4> height 1 w 0.5, 1 } }", .04, .01, .04},
    };
    try_from(trials, VTS_ARRAY_COUNT(trials), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(placed), cmocka_unit_test(fields)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
