/* A scene drawn both ways, with texels and as `vts reference` has it, and how far the two pictures may be apart. */
#ifndef VTS_TESTS_STABILITY_H
#define VTS_TESTS_STABILITY_H

#include "../analytic/analytic.h"

enum { STABILITY_WIDTH = 40, STABILITY_HEIGHT = 30, STABILITY_SAMPLES = 36 };

typedef struct Trial {
    const char *name;
    const char *scene;  /* what follows STAGE */
    double rms, bias;   /* most that the pictures, and their means, may be apart: 0 to 1 */
    double least;       /* the reference's own deviation from its mean, so that there is something to see; 0: a blank picture is expected */
} Trial;

/* A sun, a blue background, and texels T of different contents, as macros so that each test names its own. */
#define STAGE                                                                                                                          \
    "light_source { <300, 500, -200>, rgb 1 parallel point_at 0 }\n"                                                                   \
    "background { rgb <0.3, 0.4, 0.6> }\n"                                                                                             \
    "#default { pigment { rgb <0.6, 0.8, 0.3> } finish { ambient 0.15 diffuse 0.7 } }\n"                                               \
    "#declare S = seed(7);\n"                                                                                                          \
    "#macro Leaf(Size) #local P = <rand(S), 0.1 + 0.8*rand(S), rand(S)>; #local A = vrotate(Size*x, 360*<rand(S), rand(S), rand(S)>);" \
    " #local B = vrotate(Size*y, 360*<rand(S), rand(S), rand(S)>); triangle { P + A, P - A, P + B } #end\n"                           \
    "#macro Leaves(N, Size) texel { cyclic x + z resolution 64 layer { mesh { #for (I, 1, N) Leaf(Size) #end } } } #end\n"             \
    "#macro Look(From, At, Angle) camera { location From look_at At angle Angle right x*image_width/image_height } #end\n"

static inline double deviation(const Picture *p) {
    double mean = picture_mean(p), sum = 0;
    size_t n = 3 * (size_t)p->width * (size_t)p->height;
    for (size_t i = 0; i < n; i++) sum += ((double)p->pixels[i] - mean) * ((double)p->pixels[i] - mean);
    return sqrt(sum / (double)n);
}

static inline Picture reference_of(const Bench *b, const VtsOptions *options, const char *text) {
    bench_write(b, text);
    VtsSession *session = vts_session_create(options, NULL);
    assert_non_null(session);
    VtsStatus status = vts_reference(session, b->scene, b->output);
    if (status != VTS_OK) fputs(vts_diagnostics(session), stdout);
    assert_int_equal(status, VTS_OK);
    vts_session_destroy(session);
    return picture_read(b->output);
}

static inline void try_from(const Trial *trials, size_t count, int first) {
    static char text[20000];
    VtsOptions options = options_of_size(STABILITY_WIDTH, STABILITY_HEIGHT);
    options.reference_samples = STABILITY_SAMPLES;
    const VtsPair voxels = {"detail", "voxels"};
    int failed = 0;
    Bench b;
    bench_begin(&b);
    for (size_t i = 0; i < count; i++) {
        snprintf(text, sizeof text, "%s%s", STAGE, trials[i].scene);
        Picture exact = reference_of(&b, &options, text);
        double seen = deviation(&exact);
        for (int only = first; only < 2; only++) { /* as the program chooses, and by voxels alone */
            options.settings = only ? &voxels : NULL;
            options.setting_count = only ? 1 : 0;
            Picture drawn = bench_render(&b, &options, text);
            Difference d = picture_difference(&drawn, &exact);
            bool good = d.rms <= trials[i].rms && fabs(d.mean) <= trials[i].bias && seen >= trials[i].least;
            failed += !good;
            printf("%-46s %-6s rms %.4f (%.3f), mean %+.4f (%.3f), deviation %.3f%s\n", trials[i].name, only ? "voxels" : "", d.rms, trials[i].rms,
                   d.mean, trials[i].bias, seen, good ? "" : "  <-- beyond its bound");
            picture_free(&drawn);
        }
        options.setting_count = 0;
        picture_free(&exact);
    }
    bench_end(&b);
    assert_int_equal(failed, 0);
}

static inline void try_trials(const Trial *trials, size_t count) { try_from(trials, count, 0); }
/* By voxels alone: where exact geometry is drawn otherwise than the reference has it. */
static inline void try_voxels(const Trial *trials, size_t count) { try_from(trials, count, 1); }

#endif
