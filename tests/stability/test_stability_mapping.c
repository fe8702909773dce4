/* Mappings that bend, stretch, mirror, fold or crush the layer. */
#include "stability.h"

#define GROUND "#macro Flat(N) surface { patch_grid N, N function(u, v) { <4*u - 2, 0, 4*v - 2> } } #end\n"
#define FROM_ABOVE "Look(<0.5, 4, -4>, <0, 0.2, 0>, 50)\n"

static void folded(void **state) {
    (void)state;
    static const Trial trials[] = {
        {"valley, unfolded", FROM_ABOVE "skin { surface { patch_grid 8, 8 function(u, v) { <4*u - 2, (2*u - 1)*(2*u - 1), 4*v - 2> } } texel { Leaves(30, 0.12) }\n"
                             "mapping { repeat <8, 8> height 0.8 } }", .05, .02, .04},
        {"valley, folded: curvature below the height", FROM_ABOVE "skin { surface { patch_grid 8, 8 function(u, v) { <4*u - 2, 4*(u - 0.5)*(u - 0.5), 4*v - 2> } } texel { Leaves(30, 0.12) }\n"
                             "mapping { repeat <8, 8> height 3 } }", .06, .03, .04},
        {"crossing height vectors", FROM_ABOVE "#declare P = array[3][3]; #declare H = array[3][3];\n"
                             "#for (I, 0, 2) #for (J, 0, 2) #declare P[I][J] = <2*I - 2, 0, 2*J - 2>; #declare H[I][J] = <2.5 - 2.5*I, 1, 0.3*(1 - J)>; #end #end\n"
                             "skin { surface { patch_grid 2, 2 points P height_vectors H } texel { Leaves(12, 0.15) } mapping { repeat <6, 6> } }", .06, .03, .04},
        {"folded prisms", FROM_ABOVE "skin { surface { mesh2 { vertex_vectors { 4, <-2, 0, -2>, <2, 0, -2>, <2, 0, 2>, <-2, 0, 2> } face_indices { 2, <0, 2, 1>, <0, 3, 2> }\n"
                             "height_vectors { 4, <3, 1, 0.5>, <-2.5, 1, 0>, <0, 1.5, 0>, <0.5, 1, -3> } } uv planar y } texel { Leaves(12, 0.15) } mapping { repeat <6, 6> } }", .06, .03, .04},
        {"inverted prisms: heights below the ground", FROM_ABOVE "skin { surface { mesh2 { vertex_vectors { 4, <-2, 0.5, -2>, <2, 0.5, -2>, <2, 0.5, 2>, <-2, 0.5, 2> } face_indices { 2, <0, 2, 1>, <0, 3, 2> }\n"
                             "height_vectors { 4, <0, -0.6, 0>, <0, -0.6, 0>, <0, -0.6, 0>, <0, -0.6, 0> } } uv planar y } texel { Leaves(12, 0.15) } mapping { repeat <6, 6> } }", .05, .02, .04},
    };
    try_trials(trials, VTS_ARRAY_COUNT(trials));
}

static void crushed(void **state) {
    (void)state;
    static const Trial trials[] = {
        {"height falls to nothing along an edge", GROUND FROM_ABOVE "skin { surface { Flat(4) } texel { Leaves(30, 0.12) } mapping { repeat <8, 8> height 0.8 function(x, y, z) { x/4 + 0.5 } } }", .05, .02, .04},
        {"no area: a line", FROM_ABOVE "skin { surface { patch_grid 4, 4 function(u, v) { <4*u - 2, 0, 0> } } texel { Leaves(30, 0.12) } mapping { repeat <8, 8> height 0.8 } }", .003, .001, 0},
        {"cells without area beside such with area", FROM_ABOVE "skin { surface { patch_grid 8, 4 function(u, v) { <2*max(2*u, 1) - 3, 0.1*v, 4*v - 2> } } texel { Leaves(30, 0.12) } mapping { repeat <16, 8> height 0.8 } }", .05, .02, .04},
        {"areas fall to nothing at a pole", FROM_ABOVE "skin { surface { patch_grid 8, 4 function(u, v) { <2*v*cos(2*pi*u), 0, -2*v*sin(2*pi*u)> } } texel { Leaves(30, 0.12) } mapping { repeat <16, 4> height 0.8 } }", .05, .02, .04},
        {"height vectors laid nearly flat", GROUND FROM_ABOVE "skin { surface { Flat(3) } texel { Leaves(30, 0.12) } mapping { repeat <8, 8> height 0.4 comb <3, -0.9, 1> } }", .06, .02, .02},
    };
    try_trials(trials, VTS_ARRAY_COUNT(trials));
}

#define BLADES "texel { cyclic x + z resolution 64 layer { mesh { #for (I, 1, 40) #local P = <rand(S), 0, rand(S)>; #local A = vrotate(0.05*x, 360*rand(S)*y);" \
               " triangle { P + A, P - A, P + A + 0.9*y } triangle { P - A, P - A + 0.9*y, P + A + 0.9*y } #end } } }"
#define UPRIGHT(HEIGHT, MORE) GROUND FROM_ABOVE "plane { y, -0.5 } skin { surface { Flat(4) } texel { " BLADES " } mapping { repeat <8, 8> " HEIGHT " } " MORE "}"
#define LYING(HEIGHT) GROUND FROM_ABOVE "plane { y, -0.5 } skin { surface { Flat(4) } texel { Leaves(30, 0.12) } mapping { repeat <8, 8> " HEIGHT " } }"

/* Boxes without height beside such with height, and the way there: what stands upright has less and less area, what lies keeps it. */
static void low(void **state) {
    (void)state;
    static const Trial trials[] = {
        {"blades, no height where x < 0", UPRIGHT("height 0.8 function(x, y, z) { max(0, x)/2 }", ""), .05, .02, .04},
        {"leaves, no height where x < 0", LYING("height 0.8 function(x, y, z) { max(0, x)/2 }"), .05, .02, .04},
        {"blades, no height at all", UPRIGHT("height 0", ""), .003, .001, 0},
        {"blades, a millionth", UPRIGHT("height 1e-6", ""), .003, .001, 0},
        {"leaves, a hundredth", LYING("height 0.01"), .05, .02, .02},
        {"leaves, a millionth", LYING("height 1e-6"), .05, .02, .02},
        {"leaves, a ten-millionth", LYING("height 1e-7"), .05, .02, .02},
    };
    try_trials(trials, VTS_ARRAY_COUNT(trials));
}

/* Matter pressed into a sheet: boxes without volume hold none. */
static void flat(void **state) {
    (void)state;
    static const Trial trials[] = {
        {"no height", GROUND FROM_ABOVE "plane { y, -0.5 } skin { surface { Flat(2) } texel { Leaves(30, 0.12) } mapping { repeat <8, 8> height 0 } }", .003, .001, 0},
        {"height vectors laid flat", GROUND FROM_ABOVE "plane { y, -0.5 } skin { surface { Flat(3) } texel { Leaves(30, 0.12) } mapping { repeat <8, 8> height 0.4 comb <1, -1, 0> } }", .003, .001, 0},
    };
    try_trials(trials, VTS_ARRAY_COUNT(trials));
}

#define IN_WIND(WIND) GROUND FROM_ABOVE "skin { surface { Flat(4) } texel { Leaves(30, 0.12) } mapping { repeat <8, 8> height 0.5 } wind_field { direction <1, 0, 0.3> speed 4 " WIND " } }"

/* Forces of all sizes, and such as are no number: height vectors keep their length. */
static void winds(void **state) {
    (void)state;
    static const Trial trials[] = {
        {"a gale", IN_WIND("strength 20 gust { wavelength 1.3 amplitude 0.6 sharpness 2 }"), .06, .02, .04},
        {"a wind that lays everything flat", IN_WIND("strength 1e6"), .06, .02, .005},
        {"a wind beyond all measure", IN_WIND("strength 1e300 turbulence { amplitude 1e300 scale 1e-3 octaves 5 }"), .06, .02, 0},
        {"gusts shorter than a pixel", IN_WIND("strength 1 gust { wavelength 0.01 amplitude 1 sharpness 30 }"), .06, .02, .04},
        {"no number here and there", IN_WIND("strength 0.5 function(x, y, z, t) { <sqrt(x), 1/(z - 0.5), ln(x)> }"), .06, .02, .04},
        {"straight down", IN_WIND("strength 0 function(x, y, z, t) { <0, -3, 0> }"), .06, .02, 0},
    };
    try_trials(trials, VTS_ARRAY_COUNT(trials));
}

static void stretched(void **state) {
    (void)state;
    static const Trial trials[] = {
        {"mirrored", GROUND FROM_ABOVE "skin { surface { Flat(4) scale <-1, 1, 1> } texel { Leaves(30, 0.12) } mapping { repeat <8, 8> height 0.8 } }", .05, .02, .04},
        {"sheared by combing", GROUND FROM_ABOVE "skin { surface { Flat(4) } texel { Leaves(30, 0.12) } mapping { repeat <8, 8> height 0.6 comb <1.5, 0, 0.5> } }", .05, .02, .04},
        {"1:30 along u", GROUND FROM_ABOVE "skin { surface { Flat(4) } texel { Leaves(30, 0.12) } mapping { repeat <0.5, 15> height 0.8 } }", .08, .02, .04},
        {"1:1000 along u", GROUND FROM_ABOVE "skin { surface { Flat(4) } texel { Leaves(30, 0.12) } mapping { repeat <0.02, 20> height 0.8 } }", .10, .04, .02},
        {"1:1000 in height", GROUND "Look(<0, 400, -4>, <0, 0.2, 0>, 90) skin { surface { Flat(4) } texel { Leaves(8, 0.12) } mapping { repeat <4, 4> height 1000 } }", .06, .02, .02},
        {"a million tiles", GROUND FROM_ABOVE "skin { surface { Flat(4) } texel { Leaves(30, 0.12) } mapping { repeat 1000000 height 0.000003 } }", .05, .03, .02},
        {"coordinates of a million tiles", "Look(<0.5, 4, -4>, <0, 0.2, 0>, 50)\n"
                             "skin { surface { mesh2 { vertex_vectors { 4, <-2, 0, -2>, <2, 0, -2>, <2, 0, 2>, <-2, 0, 2> } uv_vectors { 4, <1000000, 1000000>, <1000008, 1000000>, <1000008, 1000008>, <1000000, 1000008> }\n"
                             "face_indices { 2, <0, 2, 1>, <0, 3, 2> } } uv mesh } texel { Leaves(30, 0.12) } mapping { height 0.8 } }", .05, .02, .04},
    };
    try_trials(trials, VTS_ARRAY_COUNT(trials));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(folded), cmocka_unit_test(crushed), cmocka_unit_test(flat), cmocka_unit_test(low), cmocka_unit_test(winds),
                                       cmocka_unit_test(stretched)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
