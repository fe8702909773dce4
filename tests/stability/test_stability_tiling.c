/* `tiling wang`: no period from above, nothing cut, the same by beams, voxels and the reference. */
#include "stability.h"

/* ---- from above ---- */

enum { TILE = 14, TILES = 16, SIDE = TILE * TILES };

/* Of the deviations from the mean, between a picture and itself moved by (dx, dy) pixels; 1 for (0, 0). */
static double correlation(const Picture *p, int dx, int dy) {
    double mean = picture_mean(p), sum = 0, squares = 0;
    for (int y = 0; y + dy < p->height; y++)
        for (int x = dx < 0 ? -dx : 0; x + (dx > 0 ? dx : 0) < p->width; x++) {
            double a = 0, b = 0;
            for (int k = 0; k < 3; k++) a += (double)pixel_at(p, x, y)[k] / 3, b += (double)pixel_at(p, x + dx, y + dy)[k] / 3;
            sum += (a - mean) * (b - mean);
            squares += (a - mean) * (a - mean);
        }
    return sum / squares;
}

/* Where nothing is to be expected: the root mean square. */
static double noise(const Picture *p) {
    static const int moves[][2] = {{5, 9}, {17, 6}, {-9, 20}, {23, 33}, {37, 11}, {8, 25}, {-19, 36}, {33, 19}, {20, 5}, {46, 30}, {6, 47}, {-25, 8}};
    double sum = 0;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(moves); i++) sum += pow(correlation(p, moves[i][0], moves[i][1]), 2);
    return sqrt(sum / (double)VTS_ARRAY_COUNT(moves));
}

#define FAMILY "#declare Ground = surface { patch_grid 1, 1 function(u, v) { <16*u - 8, 0, 16*v - 8> } };\n" \
               "#declare A = Leaves(90, 0.09) #declare B = Leaves(90, 0.09) #declare C = Leaves(90, 0.09)\n" \
               "camera { orthographic location 20*y direction -y right 16*x up 16*z }\n"
#define LAID(tiling) FAMILY "skin { surface { Ground } texel { texel { choose A, B, C } } mapping { repeat <16, 16> height 0.5 } tiling " tiling " }\n"

static void no_period(void **state) {
    (void)state;
    static char text[20000];
    VtsOptions options = options_of_size(SIDE, SIDE);
    options.samples = 4;
    double along[2], across[2], around[2], two[2];
    Bench b;
    bench_begin(&b);
    for (int wang = 0; wang < 2; wang++) {
        snprintf(text, sizeof text, "%s%s", STAGE, wang ? LAID("wang") : LAID("plain"));
        Picture p = bench_render(&b, &options, text);
        along[wang] = correlation(&p, TILE, 0), across[wang] = correlation(&p, 0, TILE), around[wang] = noise(&p);
        two[wang] = (correlation(&p, 2 * TILE, 0) + correlation(&p, 0, 2 * TILE) + correlation(&p, TILE, TILE) + correlation(&p, -TILE, TILE)) / 4;
        printf("%-5s moved by a tile: %.4f, %.4f; by two or aslant %.4f; elsewhere %.4f\n", wang ? "wang" : "plain", along[wang], across[wang], two[wang], around[wang]);
        picture_free(&p);
    }
    bench_end(&b);
    assert_true(along[0] > 8 * around[0] && across[0] > 8 * around[0]); /* a third of the tiles are followed by the same */
    assert_true(two[1] < 0.3 * two[0]);
    assert_true(fabs(along[1]) < 3 * around[1] && fabs(across[1]) < 3 * around[1] && around[1] < 0.03);
}

/* ---- nothing is cut ---- */

/* Tall sheets that hang over the walls of their tiles, so that light falls through where one is cut; every member has its own. */
#define OVER "#macro Over(Z) texel { cyclic x + z resolution 64 layer { mesh { triangle { <-0.2, 0, Z>, <0.2, 0, Z>, <0.2, 1, Z> } triangle { <-0.2, 0, Z>, <0.2, 1, Z>, <-0.2, 1, Z> } } } } #end\n" \
             "#declare Ground = surface { patch_grid 1, 1 function(u, v) { <8*u - 4, 0, v> } };\n" \
             "#declare A = Over(0.3) #declare B = Over(0.4) #declare C = Over(0.6)\n" \
             "camera { orthographic location <0, 0.5, -5> direction z right 6*x up 0.5*y }\n"

/* The widths of the sheets, as a row of the picture sees them: each must be 0.4 of a tile, whichever its neighbours are. */
static void whole_sheets(void **state) {
    (void)state;
    enum { WIDTH = 240 };
    static char text[20000];
    VtsOptions options = options_of_size(WIDTH, 20);
    Bench b;
    bench_begin(&b);
    snprintf(text, sizeof text, "%s%sskin { surface { Ground } texel { texel { choose A, B, C } } mapping { repeat <8, 1> height 1 } tiling wang }\n", STAGE, OVER);
    Picture p = bench_render(&b, &options, text);
    int found = 0, run = 0, odd = 0;
    for (int x = 0; x < WIDTH; x++) {
        const float *pixel = pixel_at(&p, x, 10);
        bool sky = fabsf(pixel[2] - 0.6f) < 0.05f && fabsf(pixel[0] - 0.3f) < 0.05f;
        if (!sky) {
            run++;
            continue;
        }
        if (run && run < x) odd += abs(run - 16) > 1, found++; /* the first one the picture cuts */
        run = 0;
    }
    picture_free(&p);
    bench_end(&b);
    printf("%d sheets, %d of another width\n", found, odd);
    assert_true(found >= 5);
    assert_int_equal(odd, 0);
}

/* ---- the same on all ways ---- */

static void ways(void **state) {
    (void)state;
#define CHOSEN "#declare A = Leaves(30, 0.12) #declare B = Leaves(30, 0.12)\n"
#define FIELD "#declare Ground = surface { patch_grid 4, 4 function(u, v) { <4*u - 2, 0, 4*v - 2> } };\n"
#define SKIN(words) "skin { surface { Ground } texel { texel { choose A, B } } mapping { repeat <8, 8> height 0.8 } tiling wang " words " }\n"
#define ABOVE "Look(<0.5, 4, -4>, <0, 0.2, 0>, 42)\n"
    static const Trial trials[] = {
        {"a family", FIELD CHOSEN ABOVE SKIN(""), .06, .02, .04},
        {"tinted, with gaps", FIELD CHOSEN ABOVE "skin { surface { Ground } texel { texel { choose A, B } density 0.7 } mapping { repeat <8, 8> height 0.8 } tiling wang jitter { instance { tint rgb 0.5, rgb 1.5 } } }", .06, .02, .04},
        {"one alone, over a ball of triangles", CHOSEN "Look(<0, 2.5, -1.5>, <0, 0.3, 0>, 50) skin { surface { sphere { 0, 1 } } texel { A } mapping { repeat <16, 8> height 0.3 } tiling wang }", .06, .02, .04},
        {"cyclic along x alone", FIELD ABOVE "#declare A = texel { cyclic x resolution 64 layer { mesh { #for (I, 1, 30) Leaf(0.12) #end } } }\n skin { surface { Ground } texel { A } mapping { repeat <8, 8> height 0.8 } tiling wang }", .06, .02, .04},
        {"what is not cyclic", FIELD ABOVE "#declare A = texel { resolution 64 layer { mesh { #for (I, 1, 30) Leaf(0.12) #end } } }\n skin { surface { Ground } texel { A } mapping { repeat <8, 8> height 0.8 } tiling wang }", .06, .02, .04},
        {"a camera in the layer", FIELD CHOSEN "Look(<0.13, 0.5, -1.2>, <0, 0.3, 0.5>, 60)\n" SKIN(""), .10, .04, .04},
        {"turned as little as asked, combed, thick and thin", FIELD CHOSEN ABOVE "skin { surface { Ground } texel { texel { choose A, B } } mapping { repeat <8, 8> height 0.8 comb <0.5, 0, 0.2> w 0.1, 0.8 } tiling wang jitter { direction 0.4 height 0.5 coordinates 0.2 instance { rotate 180 } } }", .07, .02, .04},
    };
    try_trials(trials, VTS_ARRAY_COUNT(trials));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_period), cmocka_unit_test(whole_sheets), cmocka_unit_test(ways)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
