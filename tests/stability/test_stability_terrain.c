/* Grounds that are hard to draw, against the bilinear ground between their posts, and closed forms. */
#include "maps.h"

#include "base/random.h"

#define MAP "map.asc"
#define BACK "background { rgb <0, 0, 1> }\n"
#define GLOWING(COLOR) "pigment { rgb " COLOR " } finish { ambient 0 diffuse 0 emission 1 }"

/* Some metres at the equator: a degree of longitude is 2πa/360 there; one of latitude π·6,335,439 m/180. */
static const double CELL = 0.0002, EAST = 0.0002 * 111319.4908, NORTH = 0.0002 * 110574.2758;
enum { POSTS = 33, SIDE = 96 };

static void asc(const Bench *b, PostHeight *height) { map_write(b, MAP, POSTS, POSTS, -CELL * (POSTS - 1) / 2, -CELL * (POSTS - 1) / 2, CELL, height); }

static int tear_down(void **state) {
    map_remove(*state, MAP);
    return bench_tear_down(state);
}

static bool is_sound(const Picture *p) {
    for (size_t i = 0; i < 3 * (size_t)p->width * (size_t)p->height; i++)
        if (!isfinite(p->pixels[i]) || p->pixels[i] < 0) return false;
    return true;
}

/* ---- silhouettes ---- */

static double cone(int column, int row) { return 500 - 1.7 * hypot((column - 16) * EAST, (row - 16) * NORTH); }
static double cliff(int column, int row) { return (column * 3 + row > 55) * 784.0 - 400; }
static double spike(int column, int row) { return column == 11 && row == 20 ? 600 : -200; }
static double pit(int column, int row) { return (column % 5 == 2) != (row % 7 == 3) ? -600 : 300; }
static double rough(int column, int row) { return -300 + (double)(random_hash(5, (uint64_t)column, (uint64_t)row, 0) % 800); }

/* The highest (sign 1) or lowest (-1) ground on the line x: between posts every row is linear in x, and on the line the ground lies between rows. */
static double extreme(PostHeight *height, double x, int sign) {
    double column = x / EAST + (POSTS - 1) / 2.0, most = -1e9;
    if (column < 0 || column > POSTS - 1) return sign * most;
    int c = column >= POSTS - 1 ? POSTS - 2 : (int)column;
    for (int row = 0; row < POSTS; row++) most = fmax(most, sign * (height(c, row) + (column - c) * (height(c + 1, row) - height(c, row))));
    return sign * most;
}

/* The share of a pixel in which a level ray meets the ground: somewhere on its line it lies above, and somewhere below. */
static double share_of(PostHeight *height, double x0, double x1, double low, double high) {
    enum { PARTS = 32 };
    double share = 0;
    for (int k = 0; k < PARTS; k++) {
        double x = x0 + (x1 - x0) * (k + 0.5) / PARTS, top = fmin(extreme(height, x, 1), high), bottom = fmax(extreme(height, x, -1), low);
        share += fmax(0, top - bottom) / (high - low) / PARTS;
    }
    return share;
}

/* From the south, orthographic: 900 m wide, heights from -650 to 650. */
static void silhouettes(void **state) {
    static const struct { const char *name; PostHeight *height; } grounds[] = {{"cone", cone}, {"cliff", cliff}, {"spike", spike}, {"pits", pit}, {"rough", rough}};
    const double width = 900.0 / SIDE, step = 1300.0 / SIDE;
    const Bench *b = *state;
    int failed = 0;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(grounds); i++) {
        VtsOptions o = options_of_size(SIDE, SIDE);
        asc(b, grounds[i].height);
        Picture p = bench_render(b, &o, BACK "camera { orthographic location <0, 0, -5000> direction z right 900*x up 1300*y }\n"
                                             "object { terrain { heightmap \"" MAP "\" curvature off } " GLOWING("x") " }\n");
        double squares = 0, mean = 0, n = SIDE * SIDE;
        for (int x = 0; x < SIDE; x++)
            for (int y = 0; y < SIDE; y++) {
                double left = width * x - 450, low = 650 - step * (y + 1);
                double off = (double)pixel_at(&p, x, y)[0] - share_of(grounds[i].height, left, left + width, low, low + step);
                squares += off * off / n, mean += off / n;
            }
        bool good = is_sound(&p) && sqrt(squares) < 0.02 && fabs(mean) < 0.004;
        printf("%-8s rms %.4f, mean %+.5f%s\n", grounds[i].name, sqrt(squares), mean, good ? "" : "  <-- beyond its bound");
        failed += !good;
        picture_free(&p);
    }
    assert_int_equal(failed, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test_setup_teardown(silhouettes, bench_set_up, tear_down)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
