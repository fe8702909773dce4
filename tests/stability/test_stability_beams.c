/* Near the eye, layers are drawn as their own triangles: the picture is the reference but for noise, however the layer lies. */
#include "beams.h"

static void mappings(void **state) {
    (void)state;
    static const BeamTrial trials[] = {
        {"flat cyclic", SUN  VIEW  GROUND "skin { surface { Flat } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"hill patches", SUN  VIEW  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"ball of triangles", SUN "Look(<0,2.5,-2.5>,<0,0.2,0>,44)\n"  GROUND "skin { surface { Ball } texel { Leaves(30, 0.12) } mapping { repeat <10, 6> height 0.4 }  }\n", 0},
        {"mesh triangles", SUN  VIEW  GROUND "#declare Mesh = surface { mesh2 { vertex_vectors { 5, <-2,0,-2>, <2,0,-2>, <2,0.5,2>, <-2,0,2>, <0.2,0.8,0.1> } uv_vectors { 5, <0,0>, <1,0>, <1,1>, <0,1>, <0.5,0.55> } face_indices { 4, <0,1,4>, <1,2,4>, <2,3,4>, <3,0,4> } } };\n" "skin { surface { Mesh } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"height vectors", SUN  VIEW  GROUND "#declare HV = array[2][2] { { <0.5,1,0>, <0,0.7,0.5> }, { <-0.5,0.9,0>, <0.3,0.5,-0.4> } }\n" "#declare PV = array[2][2] { { <-2,0,-2>, <-2,0.4,2> }, { <2,0.3,-2>, <2,0,2> } }\n" "skin { surface { surface { patch_grid 1, 1 points PV height_vectors HV } } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"comb", SUN  VIEW  GROUND "skin { surface { Hill } texel { Tuft } mapping { repeat <8, 8> height 0.7 comb <1,0,0.4> }  }\n", 0},
        {"folded", SUN  VIEW  GROUND "skin { surface { surface { patch_grid 3, 3 function(u, v) { <4*u - 2, -1.6*(u*(1-u)+v*(1-v)) + 0.5, 4*v - 2> } } } texel { Leaves(30, 0.12) } mapping { repeat <5, 5> height 3 }  }\n", 0},
        {"w shifted", SUN  VIEW  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.9 w -0.4, 1.7 }  }\n", 0},
        {"w reversed", SUN  VIEW  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.9 w 1.2, -0.3 }  }\n", 0},
        {"w varying", SUN  VIEW  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.9 w 0, 1 function(x,y,z) { <0.2*sin(2*x), 1 + 0.3*z, 0> } }  }\n", 0},
        {"cyclic in y", SUN  VIEW  GROUND "skin { surface { Hill } texel { texel { cyclic x + y + z layer { mesh { #for (I, 1, 20) Leaf(0.15) #end } } } } mapping { repeat <6, 6> height 0.9 w -0.7, 2.6 }  }\n", 0},
        {"no height", SUN  VIEW  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6,6> height 0 }  }\n", 0},
        {"height zero here and there", SUN  VIEW  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6,6> height 1 function(x,y,z) { max(0, x) } }  }\n", 0},
        {"cells without area", SUN  VIEW  GROUND "skin { surface { surface { patch_grid 4, 4 function(u, v) { <2*min(2*u, 1) - 1, 0.1*v, 4*v - 2> } } } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
    };
    try_beams(trials, VTS_ARRAY_COUNT(trials));
}

static void sizes(void **state) {
    (void)state;
    static const BeamTrial trials[] = {
        {"tile of three cells", SUN  VIEW  GROUND "skin { surface { surface { patch_grid 15, 15 function(u, v) { <4*u - 2, 0.3*sin(3*u), 4*v - 2> } } } texel { Leaves(30, 0.12) } mapping { repeat <5, 5> height 0.7 }  }\n", 0},
        {"tile of 8 cells, not cyclic", SUN  VIEW  GROUND "skin { surface { surface { patch_grid 16, 16 function(u, v) { <4*u - 2, 0.3*sin(3*u), 4*v - 2> } } } texel { Loose(60, 0.12) } mapping { repeat <2, 2> height 1 }  }\n", 0},
        {"one cell of 200x200 tiles", SUN "Look(<0.1, 0.35, -1.95>, <0.1, 0, -1.2>, 46)\n"  GROUND "skin { surface { One } texel { Leaves(12,0.3) } mapping { repeat <200, 200> height 0.05 }  }\n", 0},
        {"across the walls", SUN  VIEW  GROUND "skin { surface { Hill } texel { texel { cyclic x + z layer { mesh { triangle { <-0.7,0.3,0.2>, <1.6,0.35,0.5>, <0.5,0.6,0.9> } triangle { <0.5,-0.3,-1.3>, <0.6,1.4,0.4>, <0.3,0.4,1.9> } } } } } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"beyond the bounds", SUN  VIEW  GROUND "skin { surface { Hill } texel { texel { layer { mesh { triangle { <-0.7,0.3,0.2>, <1.6,0.35,0.5>, <0.5,0.6,0.9> } triangle { <0.5,-0.3,-1.3>, <0.6,1.4,0.4>, <0.3,0.4,1.9> } } } } } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"triangles far beyond", SUN  VIEW  GROUND "skin { surface { Hill } texel { texel { layer { mesh { triangle { <-1e4,0.3,0.2>, <1e4,0.35,0.5>, <0.5,0.6,1e4> } triangle { <0.5,-1e6,-1.3>, <0.6,1e6,0.4>, <0.3,0.4,1.9> } } } } } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"offset 1e6", SUN "Look(<1e+06*1e0+0.6, 2.4, 1e+06+-4.2>, <1e+06, 0.2, 1e+06>, 46)\n" "plane { y, -0.3 pigment { rgb 0.6 } }\n" "skin { surface { surface { patch_grid 4, 4 function(u, v) { <1*(4*u - 2) + 1e+06, 1*0.2*sin(5*u), 1*(4*v - 2) + 1e+06> } } } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"scale 1:1000", SUN "Look(<0*1e0+0.0006, 0.0024, 0+-0.0042>, <0, 0.0002, 0>, 46)\n" "plane { y, -0.0003 pigment { rgb 0.6 } }\n" "skin { surface { surface { patch_grid 4, 4 function(u, v) { <0.001*(4*u - 2) + 0, 0.001*0.2*sin(5*u), 0.001*(4*v - 2) + 0> } } } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.0007 }  }\n", 0},
    };
    try_beams(trials, VTS_ARRAY_COUNT(trials));
}

static void copies(void **state) {
    (void)state;
    static const BeamTrial trials[] = {
        {"copies", SUN  VIEW  GROUND "skin { surface { Hill } texel { Tuft } mapping { repeat <9, 9> height 0.7 } jitter { instance { displace 0.6 rotate 360 scale 0.4 mirror density 0.8 tint rgb 0.6, rgb 1.2 } } }\n", 0},
        {"copies far", SUN  VIEW  GROUND "skin { surface { Flat } texel { Tuft } mapping { repeat <9, 9> height 0.7 } jitter { instance { displace 2.5 rotate 360 scale 0.8 mirror } } }\n", 0},
        {"over the border of a disc", SUN "Look(<0.6,3.4,-5>,<0,0.2,0>,46)\n" GROUND "skin { surface { disc { 0, y, 1.6, 0.7 } } texel { Tuft } mapping { repeat <12, 2> height 0.6 } jitter { instance { displace 0.8 rotate 360 scale 0.4 } } }\n", 0},
        {"over the border of a pipe", SUN "Look(<0.6,3.4,-5>,<0,0.2,0>,46)\n" GROUND "skin { surface { cylinder { 0.3*y, 1.6*y, 1.2 open } } texel { Tuft } mapping { repeat <8, 2> height 0.5 } jitter { instance { displace 0.8 rotate 360 scale 0.4 } } }\n", 0},
        {"over the borders of triangles", SUN "Look(<0.6,3.4,-5>,<0,0.2,0>,46)\n" GROUND "skin { surface { mesh2 { vertex_vectors { 6, <-2,0,-2>, <0,0.3,-1>, <-1.6,0.4,1>, <2,0.1,-1.5>, <1,0,1.8>, <0,0.9,0> } uv_vectors { 6, <0,0>, <.5,.2>, <.1,.8>, <1,0>, <.8,.9>, <.5,.5> } face_indices { 4, <0,1,2>, <1,3,4>, <1,0,5>, <1,5,3> } } } texel { Tuft } mapping { repeat <6, 6> height 0.5 } jitter { instance { displace 0.8 rotate 360 scale 0.4 } } }\n", 0},
        {"choose", SUN  VIEW  GROUND "skin { surface { Hill } texel { texel { choose Tuft, Other } } mapping { repeat <8, 8> height 0.6 } jitter { instance { rotate 360 } } }\n", 0},
        {"choose cyclic", SUN  VIEW  GROUND "skin { surface { Hill } texel { texel { choose Leaves(30,0.12), Leaves(8,0.2) } } mapping { repeat <8, 8> height 0.6 }  }\n", 0},
        {"two texels", SUN  VIEW  GROUND "skin { surface { Hill } texel { Tuft density 0.5 } texel { Leaves(15, 0.1) density 0.6 texture { pigment { rgb <0.9, 0.4, 0.2> } } } mapping { repeat <8, 8> height 0.6 } }\n", 0},
        {"three skins through each other", SUN "Look(<0,2.5,-3.5>,<0,0.2,0>,44)\n"  GROUND "skin { surface { Ball } texel { Leaves(30, 0.12) } mapping { repeat <10, 6> height 0.4 }  }\n" "skin { surface { Flat } texel { Tuft } mapping { repeat <6, 6> height 0.7 }  }\n" "skin { surface { Hill } texel { Other } mapping { repeat <8, 8> height 0.5 }  }\n", 0},
        {"texel as object", SUN "Look(<1.6,1.4,-2.2>,<0.4,0.4,0.4>,46)\n"  GROUND "object { Leaves(40,0.12) rotate 20*y } object { Tuft scale <1,0.6,1> translate <-0.9,0,0.4> } object { Tuft scale <-1,1,1> translate <0.3,0,-0.9> pigment { rgb <0.9,0.3,0.2> } }\n", 0},
    };
    try_beams(trials, VTS_ARRAY_COUNT(trials));
}

static void coordinates(void **state) {
    (void)state;
    static const BeamTrial trials[] = {
        {"jittered coordinates", SUN  VIEW  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 } jitter { coordinates 0.5 scale 1.2 } }\n", 0},
        {"jittered all", SUN  VIEW  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 } jitter { coordinates 0.4 scale 1.2 height 0.5 scale 0.7 direction 0.4 scale 0.7 } }\n", 0},
        {"copies, jittered coordinates", SUN  VIEW  GROUND "skin { surface { Hill } texel { Tuft } mapping { repeat <9, 9> height 0.7 } jitter { coordinates 0.4 scale 1 instance { displace 0.6 rotate 360 scale 0.4 mirror density 0.8 tint rgb 0.6, rgb 1.2 } } }\n", 0},
        {"coordinates by more than a tile", SUN  VIEW  GROUND "skin { surface { surface { patch_grid 16, 16 function(u, v) { <4*u - 2, 0, 4*v - 2> } } } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 } jitter { coordinates 1.5 scale 0.8 height 0.5 scale 0.5 direction 0.5 scale 0.7 } }\n", 0},
    };
    try_beams(trials, VTS_ARRAY_COUNT(trials));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(mappings), cmocka_unit_test(sizes), cmocka_unit_test(copies), cmocka_unit_test(coordinates)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
