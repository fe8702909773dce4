/* Rays and cameras in awkward places: along walls and through vertices, edge-on, within the layer, within a voxel; copies moved far. */
#include "stability.h"

#define GROUND "#declare Ground = surface { patch_grid 4, 4 function(u, v) { <4*u - 2, 0, 4*v - 2> } };\n"
#define SKIN "skin { surface { Ground } texel { Leaves(30, 0.12) } mapping { repeat <8, 8> height 0.8 } }\n"

static void rays(void **state) {
    (void)state;
    static const Trial trials[] = {
        {"edge-on: the camera at the ground's height", GROUND "Look(<0, 0, -6>, <0, 0, 0>, 40)\n" SKIN, .05, .02, .04},
        {"edge-on: at the height of the top", GROUND "Look(<0, 0.8, -6>, <0, 0.8, 0>, 40)\n" SKIN, .05, .02, .04},
        {"nearly along walls: orthographic", GROUND "camera { orthographic location <0, 0.4, -6> direction z right 4*x up 3*y rotate 7*y }\n" SKIN, .06, .02, .04},
        {"along walls, through one row of tiles", "#declare Ground = surface { patch_grid 8, 1 function(u, v) { <4*u - 2, 0, 0.5*v> } };\n"
         "camera { orthographic location <0, 0.4, -6> direction z right 4*x up 3*y }\n skin { surface { Ground } texel { Leaves(30, 0.12) } mapping { repeat <8, 1> height 0.8 } }", .05, .02, .02},
        {"along walls and through vertices from above", GROUND "camera { orthographic location <0, 6, 0> direction -y right 4*x up 3*z }\n" SKIN, .05, .02, .04},
        {"down onto a vertex", GROUND "Look(<0, 3, -0.0001>, <0, 0, 0>, 50)\n" SKIN, .06, .02, .04},
        /* Middles of pixels of 0.1 are moved onto multiples of it, and so onto the walls. */
        {"in walls, from the side, one row of tiles", "#declare Ground = surface { patch_grid 8, 1 function(u, v) { <4*u - 2, 0, 0.5*v> } };\n"
         "camera { orthographic location <0.05, 0.45, -6> direction z right 4*x up 3*y }\n skin { surface { Ground } texel { Leaves(30, 0.12) } mapping { repeat <8, 1> height 0.8 } }", .05, .02, .02},
        {"in walls and vertices, from above", GROUND "camera { orthographic location <0.05, 6, 0.05> direction -y right 4*x up 3*z }\n" SKIN, .05, .02, .04},
        {"in walls, down an edge between four boxes", GROUND "camera { location <0, 3, 0> direction <0.0125, -1, 0.0125> right x up 0.75*z }\n" SKIN, .06, .02, .04},
        {"in walls of prisms", "camera { orthographic location <0.05, 6, 0.05> direction -y right 4*x up 3*z }\n"
         "skin { surface { mesh2 { vertex_vectors { 4, <-2, 0, -2>, <2, 0, -2>, <2, 0, 2>, <-2, 0, 2> } face_indices { 2, <0, 2, 1>, <0, 3, 2> } } uv planar y } texel { Leaves(30, 0.12) } mapping { repeat <8, 8> height 0.8 } }\n", .05, .02, .04},
        {"poles and seam of a ball", "Look(<0, 2.5, -1.5>, <0, 0.3, 0>, 50) skin { surface { sphere { 0, 1 } uv spherical } texel { Leaves(20, 0.12) } mapping { repeat <16, 8> height 0.3 } }", .05, .02, .04},
    };
    try_trials(trials, VTS_ARRAY_COUNT(trials));
}

/* Level, along rows of copies: the same gaps come again in each, and voxels take those of the next for others. */
static void level_rows(void **state) {
    (void)state;
    static const Trial trials[] = {{"level along eight rows of tiles", GROUND "camera { orthographic location <0, 0.45, -6> direction z right 4*x up 3*y }\n" SKIN, .08, .03, .04}};
    try_trials(trials, VTS_ARRAY_COUNT(trials));
}

static void cameras(void **state) {
    (void)state;
    static const Trial trials[] = {
        {"camera in the layer", GROUND "Look(<0.13, 0.5, -1.2>, <0, 0.3, 0.5>, 60)\n" SKIN, .10, .04, .04},
        {"camera on a wall between boxes", GROUND "Look(<0, 0.7, 0>, <1, 0.4, 1>, 60)\n" SKIN, .10, .04, .04},
        {"camera in a voxel", GROUND "Look(<0.1317, 0.513, -1.2>, <0.1317, 0.512, -1.18>, 90)\n skin { surface { Ground } texel { Leaves(6, 0.2) } mapping { repeat <2, 2> height 1.5 } }\n", .12, .05, .02},
    };
    try_trials(trials, VTS_ARRAY_COUNT(trials));
}

#define COPIES "#declare Tuft = texel { resolution 64 layer { mesh { #for (I, 1, 14) #local P = <0.5, 0, 0.5> + 0.2*<rand(S) - 0.5, 0, rand(S) - 0.5>;" \
               " triangle { P - 0.03*x, P + 0.03*x, P + <0.5*rand(S) - 0.25, 0.9, 0.5*rand(S) - 0.25> } #end } } };\n"
#define FROM_ABOVE "Look(<0.5, 4, -4>, <0, 0.2, 0>, 42)\n"

static void jitters(void **state) {
    (void)state;
    static const Trial trials[] = {
        {"copies jittered", GROUND COPIES FROM_ABOVE "skin { surface { Ground } texel { Tuft } mapping { repeat <10, 10> height 0.6 } jitter { instance { displace 0.6 rotate 360 scale 0.4 mirror } } }", .06, .02, .04},
        {"copies jittered by more than a tile", GROUND COPIES FROM_ABOVE "skin { surface { Ground } texel { Tuft } mapping { repeat <10, 10> height 0.6 } jitter { instance { displace 2.5 rotate 360 scale 0.8 mirror } } }", .06, .02, .04},
        {"superimposed, with shares of the tiles", GROUND COPIES FROM_ABOVE "skin { surface { Ground } texel { Tuft density 0.5 } texel { Leaves(15, 0.1) density 0.6 texture { pigment { rgb <0.9, 0.4, 0.2> } } } mapping { repeat <10, 10> height 0.6 } }", .06, .02, .04},
        {"a family", GROUND COPIES FROM_ABOVE "#declare Other = texel { resolution 64 layer { sphere { <0.5, 0.4, 0.5>, 0.25 } texture { pigment { rgb <0.8, 0.2, 0.2> } } } }\n"
         "skin { surface { Ground } texel { texel { choose Tuft, Other } } mapping { repeat <8, 8> height 0.6 } jitter { instance { rotate 360 } } }", .07, .03, .04},
    };
    try_trials(trials, VTS_ARRAY_COUNT(trials));
}

static void coordinates(void **state) {
    (void)state;
    static const Trial trials[] = {
        {"coordinates jittered by more than a tile", "#declare Ground = surface { patch_grid 16, 16 function(u, v) { <4*u - 2, 0, 4*v - 2> } };\n" FROM_ABOVE
         "skin { surface { Ground } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.6 } jitter { coordinates 1.5 scale 0.8 height 0.5 scale 0.5 direction 0.5 scale 0.7 } }", .06, .02, .04},
    };
    try_voxels(trials, VTS_ARRAY_COUNT(trials));
}

/* What a line of sight through the middle of such a pixel meets is not what the pixel sees. */
static void far_hills(void **state) {
    (void)state;
    static const Trial trials[] = {
        {"pixels wider than tiles, and crests thinner than pixels",
         "#declare Hill = surface { patch_grid 24, 24 function(u, v) { <60*(u - 0.5), 5*sin(7*u)*cos(9*v), 60*(v - 0.5)> } };\n"
         "object { Hill pigment { rgb <0.5, 0.2, 0.1> } } Look(<0, 4, -70>, <0, 0, 0>, 30)\n"
         "skin { surface { Hill } texel { Leaves(200, 0.2) } mapping { repeat <120, 120> height 0.5 } }", .019, .01, .04},
    };
    try_voxels(trials, VTS_ARRAY_COUNT(trials));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(rays), cmocka_unit_test(level_rows), cmocka_unit_test(cameras), cmocka_unit_test(jitters), cmocka_unit_test(coordinates),
                                       cmocka_unit_test(far_hills)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
