/* Near the eye, layers are drawn as their own triangles: the picture is the reference but for noise, however it is looked at and lit. */
#include "beams.h"

static void cameras(void **state) {
    (void)state;
    static const BeamTrial trials[] = {
        {"camera in the layer, hill, copies", SUN "Look(<0.13, 0.75, -0.6>, <0, 0.3, 1.5>, 70)\n"  GROUND "skin { surface { Hill } texel { Tuft } mapping { repeat <9, 9> height 0.7 } jitter { instance { displace 0.6 rotate 360 scale 0.4 mirror density 0.8 tint rgb 0.6, rgb 1.2 } } }\n", 0},
        {"orthographic", SUN "camera { orthographic location <1, 4, -6> look_at 0 right 4*x up 3*y }\n"  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"orthographic within", SUN "camera { orthographic location <0, 0.4, 0> direction z right 1.6*x up 1.2*y }\n"  GROUND "skin { surface { Flat } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"orthographic below", SUN "camera { orthographic location <0, -3, 0> direction y right 4*x up 3*z }\n" "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"very near", SUN "Look(<0.1317, 0.513, -1.2>, <0.1317, 0.512, -1.18>, 90)\n"  GROUND "skin { surface { Flat } texel { Leaves(6,0.2) } mapping { repeat <2, 2> height 1.5 }  }\n", 0},
        {"1e-3 of a tile before a leaf", SUN "Look(<0.25, 0.501, 0.25>, <0.25, 0.3, 0.26>, 60)\n" "skin { surface { One } texel { texel { layer { mesh { triangle { <0.2,0.5,0.2>, <0.8,0.5,0.2>, <0.5,0.5,0.8> } triangle { <0.2,0.1,0.2>, <0.8,0.15,0.2>, <0.5,0.2,0.9> pigment { rgb <0.8,0.2,0.1> } } } } } } mapping { repeat <2, 2> height 1 }  }\n" "sphere { <0.2,0.3,0.5>, 0.1 }\n", 0},
        {"behind", SUN "Look(<0, 0.4, 0>, <0, 0.4, -1>, 100)\n"  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"wide angle", SUN "Look(<0.3, 0.9, -0.4>, <0.2, 0, 0.2>, 150)\n"  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"mirrored camera", SUN "camera { location <0.6, 2.4, -4.2> right -1.33*x angle 46 look_at <0,0.2,0> }\n"  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"sheared camera", SUN "camera { location <0.6, 2.4, -4.2> direction <0,-0.6,1> right <0.9,0.2,0> up <0.1,0.7,0.1> }\n"  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
    };
    try_beams(trials, VTS_ARRAY_COUNT(trials));
}

static void lights(void **state) {
    (void)state;
    static const BeamTrial trials[] = {
        {"point light in the layer", "light_source { <0.1, 0.35, -0.2>, rgb 0.8 }\n"  VIEW  GROUND "skin { surface { Flat } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"point light above", "light_source { <1, 2, -0.2>, rgb 1 }\n"  VIEW  GROUND "skin { surface { Hill } texel { Tuft } mapping { repeat <9, 9> height 0.7 } jitter { instance { displace 0.6 rotate 360 scale 0.4 mirror density 0.8 tint rgb 0.6, rgb 1.2 } } }\n", 0},
        {"several lights", "light_source { <1, 3, -1>, rgb 0.5 } light_source { <-300, 400, 100>, rgb <0.2,0.3,0.6> parallel point_at 0 } light_source { <-2, 1, 2>, rgb 0.4 fade_distance 2 fade_power 2 } light_source { <0,5,-5>, rgb 0.1 shadowless }\n"  VIEW  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"no lights", VIEW  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"light below", "light_source { <100,-300,-100>, rgb 1 parallel point_at 0 }\n"  VIEW "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"spot light", "light_source { <1, 3, -1>, rgb 1.2 spotlight radius 15 falloff 25 point_at <0,0,0> }\n"  VIEW  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
    };
    try_beams(trials, VTS_ARRAY_COUNT(trials));
}

static void surroundings(void **state) {
    (void)state;
    static const BeamTrial trials[] = {
        {"objects in and over the layer", SUN  VIEW  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n" "sphere { <0.3,0.6,-0.5>, 0.4 pigment { rgb <0.9,0.2,0.1> } } cylinder { <-1,1.6,-2>, <-1,1.4,2>, 0.1 } box { <0.8,0,-1.8>, <1.4,1.0,-1.2> no_shadow }\n", 0},
        {"shadow on objects", SUN "Look(<0.6,0.8,-4.5>, <0,-0.1,-1>, 46)\n" "plane { y, -0.6 pigment { rgb 0.9 } } sphere { <0,-0.3,-2.4>, 0.5 }\n" "skin { surface { Flat } texel { Tuft } mapping { repeat <6,6> height 0.8 }  }\n", 0},
        {"fog and sky", SUN  VIEW "fog { distance 8 rgb <0.7,0.75,0.8> } sky_sphere { pigment { gradient y color_map { [0 rgb <0.9,0.6,0.4>] [0.6 rgb <0.1,0.3,0.9>] } } }\n" "skin { surface { Hill } texel { Leaves(30, 0.12) } mapping { repeat <6, 6> height 0.7 }  }\n" "sphere { <0,1,1>, 0.5 }\n", 0},
        {"pigment in the layer", SUN  VIEW  GROUND "skin { surface { Hill } texel { texel { cyclic x + z layer { mesh { #for (I, 1, 30) Leaf(0.2) #end } texture { pigment { gradient y color_map { [0 rgb <0.9,0.1,0.1>] [0.5 rgb <0.1,0.9,0.1>] [1 rgb <0.1,0.1,0.9>] } } } } } } mapping { repeat <6, 6> height 0.7 }  }\n", 0},
        {"pigment in the layer, copies", SUN  VIEW  GROUND "skin { surface { Hill } texel { texel { layer { mesh { #for (I, 1, 30) Leaf(0.2) #end } texture { pigment { gradient x color_map { [0 rgb <0.9,0.1,0.1>] [0.5 rgb <0.1,0.9,0.1>] [1 rgb <0.1,0.1,0.9>] } } } } } } mapping { repeat <6, 6> height 0.7 } jitter { instance { displace 0.6 rotate 360 scale 0.4 mirror density 0.8 tint rgb 0.6, rgb 1.2 } } }\n", 0},
        {"pigment over the skin", SUN  VIEW  GROUND "skin { surface { Hill } texel { Leaves(30, 0.12) texture { pigment { gradient x color_map { [0 rgb <0.9,0.1,0.1>] [1 rgb <0.1,0.1,0.9>] } scale 2 } } } mapping { repeat <6, 6> height 0.7 } }\n", 0},
        {"solids", SUN  VIEW  GROUND "skin { surface { Hill } texel { texel { layer { sphere { <0.5,0.4,0.5>, 0.3 } } layer { cylinder { <0.2,0,0.2>, <0.2,0.9,0.25>, 0.05 } texture { pigment { rgb <0.8,0.3,0.1> } } } layer { box { <0.6,0,0.1>, <0.9,0.5,0.3> } } } } mapping { repeat <4,4> height 0.9 }  }\n", .004},
    };
    try_beams(trials, VTS_ARRAY_COUNT(trials));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(cameras), cmocka_unit_test(lights), cmocka_unit_test(surroundings)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
