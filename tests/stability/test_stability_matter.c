/* Matter that a voxel's few numbers describe badly, at scales from single leaves to tiles below a pixel. */
#include "stability.h"

/* Near, in the middle and far: tiles of some twenty pixels, of some five, and below one. */
#define LAID(T, N) "Look(<0.5, 4, -4>, <0, 0.2, 0>, 45)\nskin { surface { patch_grid 2, 2 function(u, v) { <4*u - 2, 0, 4*v - 2> } } texel { " T " } mapping { repeat <" #N ", " #N "> height 2/" #N " } }"
#define SCALES(NAME, T, NEAR, MIDDLE, FAR, LEAST) \
    {NAME ", near", LAID(T, 4), NEAR, .03, LEAST}, {NAME ", middle", LAID(T, 16), MIDDLE, .03, LEAST}, {NAME ", far", LAID(T, 120), FAR, .03, LEAST}

#define DISCS "texel { cyclic x + z resolution 64 layer { mesh { #for (I, 1, 40) #local P = <rand(S), 0.1 + 0.8*rand(S), rand(S)>;" \
              " triangle { P - 0.1*x, P + 0.1*x, P + 0.15*z } #end } } }"
#define NEEDLES "texel { cyclic x + z resolution 64 layer { #for (I, 1, 25) #local P = <rand(S), 0, rand(S)>; cylinder { P, P + <0, 0.9, 0>, 0.012 } #end } }"
#define FACETS "texel { cyclic x + z resolution 64 layer { mesh { #for (I, 1, 12) #local P = <rand(S), 0.1 + 0.7*rand(S), rand(S)>;" \
               " triangle { P, P + 0.12*x, P + 0.12*y } triangle { P, P + 0.12*z, P + 0.12*y } #end } } }"
/* Light of its own: what is asked is whether anything shines through. */
#define BRIGHT "texture { pigment { rgb <0.9, 0.3, 0.1> } finish { ambient 1 diffuse 0 } }"
#define WHOLE "texel { cyclic x + z resolution 32 layer { box { <-0.5, -0.1, -0.5>, <1.5, 0.5, 1.5> } " BRIGHT " } }"
#define SHEET "texel { cyclic x + z resolution 32 layer { mesh { triangle { <-1, 0.5, -1>, <3, 0.5, -1>, <-1, 0.5, 3> } } " BRIGHT " } }"
/* The same in the sun, as single sheets, and as some that lie upon their own copies; a floor whose copies touch. */
#define LIT_WHOLE "texel { cyclic x + z resolution 32 layer { box { <-0.5, -0.1, -0.5>, <1.5, 0.5, 1.5> } } }"
#define LIT_FLOOR "texel { cyclic x + z resolution 32 layer { box { <0, -0.1, 0>, <1, 0.51, 1> } } }"
#define LIT_SHEETS "texel { cyclic x + z resolution 32 layer { mesh { triangle { <-1, 0.5, -1>, <3, 0.5, -1>, <-1, 0.5, 3> } } } }"
#define LIT_SHEET "texel { cyclic x + z resolution 32 layer { mesh { triangle { <0, 0.51, 0>, <1, 0.51, 0>, <0, 0.51, 1> }" \
                  " triangle { <1, 0.51, 1>, <1, 0.51, 0>, <0, 0.51, 1> } } } }"
#define NEXT_TO_NOTHING "texel { cyclic x + z resolution 32 layer { mesh { triangle { <0.5, 0.5, 0.5>, <0.5001, 0.5, 0.5>, <0.5, 0.5001, 0.5> } } } }"
/* Triangles without area, points and lines, by themselves and among some that have one: matrices of nothing. */
#define EMPTY_ONES "#for (I, 1, 60) #local P = <rand(S), 0.1 + 0.8*rand(S), rand(S)>; #local E = <0.2*rand(S), 0.2*rand(S), 0>;" \
                   " triangle { P, P, P } triangle { P, P + E, P + 2*E } triangle { P, P + E, P + E } #end"
#define ONLY_EMPTY "texel { cyclic x + z resolution 64 layer { mesh { " EMPTY_ONES " } } }"
#define EMPTY_AMONG "texel { cyclic x + z resolution 64 layer { mesh { " EMPTY_ONES " #for (I, 1, 12) Leaf(0.12) #end } } }"
#define NOTHING "texel { cyclic x + z resolution 32 layer { mesh { triangle { <5, 5, 5>, <6, 5, 5>, <5, 6, 5> } } } }"

static void distributions(void **state) {
    (void)state;
    static const Trial trials[] = {SCALES("discs", DISCS, .07, .05, .06, .02), SCALES("needles", NEEDLES, .09, .05, .04, .02),
                                   SCALES("perpendicular facets", FACETS, .07, .05, .04, .02)};
    try_trials(trials, VTS_ARRAY_COUNT(trials));
}

static void opacities(void **state) {
    (void)state;
    static const Trial trials[] = {SCALES("solid", WHOLE, .08, .08, .06, .02), SCALES("sheet", SHEET, .08, .08, .05, .02),
                                   SCALES("next to nothing", NEXT_TO_NOTHING, .004, .004, .004, 0), SCALES("nothing", NOTHING, 1e-6, 1e-6, 1e-6, 0)};
    try_trials(trials, VTS_ARRAY_COUNT(trials));
}

static void no_matter(void **state) {
    (void)state;
    static const Trial trials[] = {SCALES("no area", ONLY_EMPTY, 1e-4, 1e-4, 1e-4, 0), SCALES("no area, among leaves", EMPTY_AMONG, .05, .04, .03, .02)};
    try_trials(trials, VTS_ARRAY_COUNT(trials));
}

static void lit_matter(void **state) {
    (void)state;
    static const Trial trials[] = {SCALES("lit solid", LIT_WHOLE, .07, .04, .04, .02), SCALES("lit floor", LIT_FLOOR, .07, .04, .04, .02),
                                   SCALES("lit sheets", LIT_SHEETS, .045, .04, .04, .02), SCALES("lit sheet", LIT_SHEET, .045, .04, .04, .02)};
    try_trials(trials, VTS_ARRAY_COUNT(trials));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(distributions), cmocka_unit_test(opacities), cmocka_unit_test(no_matter), cmocka_unit_test(lit_matter)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
