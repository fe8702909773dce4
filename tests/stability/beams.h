/* Scenes drawn as exact geometry and by the reference, at so many samples that nothing but noise may be between the two. */
#ifndef VTS_TESTS_BEAMS_H
#define VTS_TESTS_BEAMS_H

#include "stability.h"

enum { BEAM_WIDTH = 40, BEAM_HEIGHT = 30, BEAM_SAMPLES = 128, REFERENCE_SAMPLES = 32 };

typedef struct BeamTrial {
    const char *name, *scene; /* what follows CONTENTS */
    double facets;            /* of contents that are round: their facets are told from the reference's by their light */
} BeamTrial;

#define SUN "light_source { <300, 500, -200>, rgb 1 parallel point_at 0 }\n"
#define VIEW "Look(<0.6, 2.4, -4.2>, <0, 0.2, 0>, 46)\n"
#define GROUND "plane { y, -0.3 pigment { rgb <0.7,0.5,0.4> } }\n"
#define CONTENTS \
    "background { rgb <0.3, 0.4, 0.6> }\n" \
    "#default { pigment { rgb <0.6, 0.8, 0.3> } finish { ambient 0.15 diffuse 0.7, 0.3 specular 0.2 } }\n" \
    "#declare S = seed(7);\n" \
    "#macro Leaf(Size) #local P = <rand(S), 0.1 + 0.8*rand(S), rand(S)>; #local A = vrotate(Size*x, 360*<rand(S), rand(S), rand(S)>); #local B = vrotate(Size*y, 360*<rand(S), rand(S), rand(S)>); triangle { P + A, P - A, P + B } #end\n" \
    "#macro Leaves(N, Size) texel { cyclic x + z layer { mesh { #for (I, 1, N) Leaf(Size) #end } } } #end\n" \
    "#macro Loose(N, Size) texel { layer { mesh { #for (I, 1, N) Leaf(Size) #end } } } #end\n" \
    "#declare Tuft = texel { layer { mesh { #for (I, 1, 14) #local P = <0.5, 0, 0.5> + 0.2*<rand(S) - 0.5, 0, rand(S) - 0.5>; triangle { P - 0.03*x, P + 0.03*x, P + <0.5*rand(S) - 0.25, 0.9, 0.5*rand(S) - 0.25> } #end } } };\n" \
    "#declare Other = texel { layer { sphere { <0.5, 0.4, 0.5>, 0.25 } texture { pigment { rgb <0.8, 0.2, 0.2> } } } };\n" \
    "#macro Look(From, At, Angle) camera { location From look_at At angle Angle right x*image_width/image_height } #end\n" \
    "#declare Flat = surface { patch_grid 4, 4 function(u, v) { <4*u - 2, 0, 4*v - 2> } };\n" \
    "#declare One = surface { patch_grid 1, 1 function(u, v) { <4*u - 2, 0, 4*v - 2> } };\n" \
    "#declare Hill = surface { patch_grid 6, 5 function(u, v) { <4*u - 2, 0.9*sin(3*u)*sin(2.6*v) + 0.2*u, 4*v - 2> } };\n" \
    "#declare Ball = surface { sphere { 0, 1 } uv spherical };\n"

/* The mean of two references and how far it is from the truth, by how far they are apart. */
static inline Picture reference_with_noise(const Bench *b, const char *text, double *noise) {
    VtsOptions options = options_of_size(BEAM_WIDTH, BEAM_HEIGHT);
    options.reference_samples = REFERENCE_SAMPLES;
    Picture mean = reference_of(b, &options, text);
    options.seed = 1;
    Picture other = reference_of(b, &options, text);
    *noise = picture_difference(&mean, &other).rms / 2;
    for (size_t i = 0; i < 3 * (size_t)mean.width * (size_t)mean.height; i++) mean.pixels[i] = (mean.pixels[i] + other.pixels[i]) / 2;
    picture_free(&other);
    return mean;
}

/* Beams have twice the samples: differences of correct pictures are √1.5 times the noise of the references. */
static const double MOST_OVER_NOISE = 1.55, MOST_ROUNDING = 0.001;

static inline void try_beams(const BeamTrial *trials, size_t count) {
    static char text[20000];
    const VtsPair exact = {"detail", "exact"};
    VtsOptions options = options_of_size(BEAM_WIDTH, BEAM_HEIGHT);
    options.settings = &exact;
    options.setting_count = 1;
    options.samples = BEAM_SAMPLES;
    int failed = 0;
    Bench b;
    bench_begin(&b);
    for (size_t i = 0; i < count; i++) {
        double noise;
        snprintf(text, sizeof text, "%s%s", CONTENTS, trials[i].scene);
        Picture truth = reference_with_noise(&b, text, &noise), drawn = bench_render(&b, &options, text);
        Difference d = picture_difference(&drawn, &truth);
        bool good = d.rms <= MOST_OVER_NOISE * noise + MOST_ROUNDING + trials[i].facets;
        failed += !good;
        printf("%-40s rms %.4f, noise %.4f, mean %+.4f, most %.3f, deviation %.3f%s\n", trials[i].name, d.rms, noise, d.mean, d.most, deviation(&truth),
               good ? "" : "  <-- beyond its bound");
        picture_free(&drawn);
        picture_free(&truth);
    }
    bench_end(&b);
    assert_int_equal(failed, 0);
}

#endif
