/* Grounds that are hard to draw, against the bilinear ground between their posts, and closed forms. */
#include "maps.h"
#include "stability.h"

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

/* ---- places on the globe ---- */

static double ledge(int column, int row) { return (void)column, row < 2 ? 0 : -30000; }

/* Sea level 100 km from the origin, along the equator: a circle of the earth's radius. The south falls away, so that it is seen. */
static void drop_at_100_km(void **state) {
    const Bench *b = *state;
    VtsOptions o = options_of_size(32, SIDE);
    map_write(b, MAP, 60, 3, -0.09, -0.02, 0.02, ledge);
    Picture p = bench_render(b, &o, BACK "camera { orthographic location <100000, -800, -50000> direction z right 100*x up 300*y }\n"
                                         "object { terrain { heightmap \"" MAP "\" origin geo <0, 0, 0> } " GLOWING("x") " }\n");
    const double a = 6378137, x = 100000;
    double red = 0;
    for (int y = 0; y < SIDE; y++) red += (double)pixel_at(&p, 16, y)[0] * 300 / SIDE;
    printf("sea level at 100 km: %.2f m, %.2f by the circle\n", red - 950, sqrt(a * a - x * x) - a);
    assert_true(is_sound(&p));
    assert_true(fabs(red - 950 - (sqrt(a * a - x * x) - a)) < 300.0 / SIDE / 4);
    picture_free(&p);
}

#define OBLIQUE "camera { location <-500, 900, -700> look_at <0, 0, 0> angle 50 }\n" \
                "light_source { <-3e6, 4e6, -1e6>, rgb 1.2 parallel point_at 0 }\n"
#define LAND(FILES) BACK OBLIQUE "object { terrain { heightmap " FILES " origin geo <0, LONGITUDE, 0> } pigment { rgb 1 } }\n"

static Picture around(const Bench *b, double longitude, const char *scene) {
    char value[32];
    snprintf(value, sizeof value, "%.9g", longitude);
    const VtsPair declared = {"LONGITUDE", value};
    VtsOptions o = options_of_size(SIDE, 72);
    o.declares = &declared, o.declare_count = 1;
    return bench_render(b, &o, scene);
}

static double rough_east(int column, int row) { return rough(column + (POSTS - 1) / 2, row); }
static double sea(int column, int row) { return (void)column, (void)row, 0; }

/* The same ground on the meridian of Greenwich, across the 180th in one file, and in two that meet there. */
static void antimeridian(void **state) {
    const Bench *b = *state;
    double west = -CELL * (POSTS - 1) / 2;
    Picture here = (asc(b, rough), around(b, 0, LAND("\"" MAP "\"")));
    assert_true(is_sound(&here) && picture_mean(&here) > 0.2);
    for (int k = 0; k < 3; k++) {
        Picture there;
        if (k < 2) {
            map_write(b, MAP, POSTS, POSTS, (k ? -180 : 180) + west, west, CELL, rough);
            there = around(b, k ? -180 : 180, LAND("\"" MAP "\""));
        } else {
            map_write(b, MAP, (POSTS + 1) / 2, POSTS, 180 + west, west, CELL, rough);
            map_write(b, "east.asc", (POSTS + 1) / 2, POSTS, -180, west, CELL, rough_east);
            there = around(b, 180, LAND("\"" MAP "\", \"east.asc\""));
            map_remove(b, "east.asc");
        }
        Difference d = picture_difference(&there, &here);
        printf("across 180 degrees, %s: rms %.6f, most %.4f\n", k == 2 ? "two files" : k ? "from -180" : "one file", d.rms, d.most);
        assert_true(is_sound(&there) && d.rms < 5e-4);
        picture_free(&there);
    }
    picture_free(&here);
}

/* Rows end in the pole, columns go round: from above a disc without a hole, as wide as its southern parallel. */
static void pole(void **state) {
    const Bench *b = *state;
    map_write(b, MAP, 36, 3, -175, 70, 10, sea);
    VtsOptions o = options_of_size(SIDE, SIDE);
    Picture p = bench_render(b, &o, BACK LOOK_DOWN(1e7, 5e6) "object { terrain { heightmap \"" MAP "\" origin geo <90, 0, 0> } " GLOWING("x") " }\n");
    double phi = 70 * VTS_RADIANS, e2 = 0.00669437999014, radius = 6378137 * cos(phi) / sqrt(1 - e2 * sin(phi) * sin(phi)), area = 0, dark = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            double red = (double)pixel_at(&p, x, y)[0];
            area += red * 5e6 * 5e6 / (SIDE * SIDE);
            if (hypot(x + 0.5 - SIDE / 2, y + 0.5 - SIDE / 2) < 0.9 * radius * SIDE / 5e6 && red < 1) dark++;
        }
    printf("the land around the pole: %.4f of its disc, %.0f holes\n", area / (VTS_PI * radius * radius), dark);
    assert_true(is_sound(&p));
    assert_int_equal((int)dark, 0);
    assert_true(fabs(area / (VTS_PI * radius * radius) - 1) < 0.01);
    picture_free(&p);
}

/* ---- what is not there ---- */

/* The area that is seen from above, in cells. */
static double cells_seen(const Bench *b, const char *how) {
    char text[1000];
    snprintf(text, sizeof text, "%s%s object { terrain { heightmap \"" MAP "\" curvature off %s } " GLOWING("x") " }\n", BACK,
             "camera { orthographic location <0, 5000, 0> direction -y right 800*x up 800*z }\n", how);
    VtsOptions o = options_of_size(SIDE, SIDE);
    o.samples = 64; /* a cell is less than three pixels wide */
    Picture p = bench_render(b, &o, text);
    double sum = 0;
    assert_true(is_sound(&p));
    for (int i = 0; i < SIDE * SIDE; i++) sum += (double)p.pixels[3 * i];
    picture_free(&p);
    return sum * 800 * 800 / (SIDE * SIDE) / (EAST * NORTH);
}

static void single_rows(void **state) {
    static const int sizes[][3] = {{1, 1, 1}, {1, 5, 4}, {5, 1, 4}, {2, 1, 1}, {2, 2, 1}}; /* from the first post to the last, and as wide as a pixel */
    const Bench *b = *state;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(sizes); i++) {
        map_write(b, MAP, sizes[i][0], sizes[i][1], 10, 0, CELL, sea);
        double seen = cells_seen(b, "");
        printf("%d x %d posts: %.3f cells\n", sizes[i][0], sizes[i][1], seen);
        assert_true(fabs(seen - sizes[i][2]) < 0.02 * sizes[i][2]);
    }
}

static bool is_void(int column, int row) {
    return (column > 5 && column < 12 && row > 8 && row < 20) || (column == 20 && row == 20) || (column > 24 && row == 0) || (column + row) % 17 == 0;
}
static double slope(int column, int row) { return 6.0 * column - 4.0 * row; }
static double holed(int column, int row) {
    static const double none[] = {-9999, 1e30, (double)NAN, (double)INFINITY, -(double)INFINITY};
    return is_void(column, row) ? none[(column + 3 * row) % 5] : slope(column, row);
}

static void voids(void **state) {
    const Bench *b = *state;
    int whole = 0;
    for (int c = 0; c + 1 < POSTS; c++)
        for (int r = 0; r + 1 < POSTS; r++) whole += !is_void(c, r) && !is_void(c + 1, r) && !is_void(c, r + 1) && !is_void(c + 1, r + 1);
    asc(b, holed);
    double open = cells_seen(b, "nodata hole detail full"), closed = cells_seen(b, "nodata fill"), cells = (POSTS - 1) * (POSTS - 1);
    printf("holes left open: %.2f cells of %d whole ones; filled: %.2f of %.0f\n", open, whole, closed, cells);
    assert_true(fabs(open - whole) < 0.01 * cells);
    assert_true(fabs(closed - cells) < 0.01 * cells);

    Picture filled = around(b, 0, LAND("\"" MAP "\""));
    Picture plain = (asc(b, slope), around(b, 0, LAND("\"" MAP "\"")));
    Difference d = picture_difference(&filled, &plain);
    printf("a filled slope: rms %.4f\n", d.rms);
    assert_true(d.rms < 0.03);
    picture_free(&filled);
    picture_free(&plain);
}

/* ---- what is seen ---- */

static double hills(int column, int row) { return 120 * sin(0.5 * column) * cos(0.37 * row) + 0.05 * rough(column, row); }

/* A skin that is full of matter stands on the ground: no ray passes between the two. */
static void feet_stand_on_the_ground(void **state) {
    const Bench *b = *state;
    static const char *const details[] = {"exact", "voxels"};
    static const char scene[] = BACK OBLIQUE
        "#declare Land = terrain { heightmap \"" MAP "\" curvature off }\n"
        "#declare Slab = texel { cyclic x + z resolution 16 layer { box { <-1, 0, -1>, <2, 1, 2> } texture { " GLOWING("y") " } } }\n"
        "object { Land " GLOWING("x") " }\n"
        "skin { surface { terrain { Land } } texel { Slab } mapping { tile 30 height 12 } }\n";
    asc(b, hills);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(details); i++) {
        const VtsPair detail = {"detail", details[i]};
        VtsOptions o = options_of_size(SIDE, SIDE);
        o.settings = &detail, o.setting_count = 1;
        Picture p = bench_render(b, &o, scene);
        double through = 0, green = 0;
        for (int x = 0; x < SIDE; x++) {
            int top = 0, bottom = SIDE - 1; /* of the green */
            while (top < SIDE && pixel_at(&p, x, top)[1] < 0.99f) top++;
            while (bottom > top && pixel_at(&p, x, bottom)[1] < 0.99f) bottom--;
            for (int y = top; y <= bottom; y++) through += 1 - (double)pixel_at(&p, x, y)[1], green++;
        }
        printf("%s: %.0f green pixels, seen through them %.2f\n", details[i], green, through);
        assert_true(is_sound(&p) && green > 0.3 * SIDE * SIDE);
        assert_true(through < 0.003 * green);
        picture_free(&p);
    }
}

static double gentle(int column, int row) { return 14 * sin(0.45 * column) * cos(0.37 * row) + 0.3 * column; }

/* Blue marks over the ground, from terrain_height() + `foot` to `tip`, seen from a place of a flight: with a skin, or bare. */
static Picture marks(const Bench *b, int frame, const char *skin, double foot, double tip) {
    char scene[2500];
    snprintf(scene, sizeof scene,
             "background { rgb 0 }\n#declare Land = terrain { heightmap \"" MAP "\" curvature off }\n"
             "camera { location <%d, %d, %d> look_at <20, 0, 10> angle 50 }\n"
             "#declare Slab = texel { cyclic x + z resolution 16 layer { box { <-1, 0, -1>, <2, 1, 2> } texture { " GLOWING("y") " } } }\n"
             "object { Land " GLOWING("x") " }\n"
             "#for (I, -4, 4) #for (J, -4, 4) #declare P = <I*53, 0, J*47>; #declare P = <P.x, terrain_height(Land, P), P.z>;\n"
             "cylinder { P + %g*y, P + %g*y, 4.5 " GLOWING("z") " }\n#end #end\n%s",
             -280 + 60 * frame, 330 + 20 * (frame % 3), -260 - 10 * frame, foot, tip, skin);
    const VtsPair detail = {"detail", frame % 2 ? "voxels" : "exact"};
    VtsOptions o = options_of_size(SIDE, SIDE);
    o.settings = &detail, o.setting_count = 1;
    Picture p = bench_render(b, &o, scene);
    assert_true(is_sound(&p));
    return p;
}

/* Of the pixels that are all mark without the skin, the share of blue that is left with it; *count of them. */
static double marks_left(const Bench *b, int frame, double foot, double tip, int *count) {
    static const char skin[] = "skin { surface { terrain { Land } } texel { Slab } mapping { tile 30 height 12 } }\n";
    Picture bare = marks(b, frame, "", foot, tip), grown = marks(b, frame, skin, foot, tip);
    double left = 0;
    *count = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        if (bare.pixels[3 * i + 2] > 0.99f) left += (double)grown.pixels[3 * i + 2], ++*count;
    picture_free(&bare);
    picture_free(&grown);
    return left / *count;
}

/* What stands on the ground is as high above terrain_height() as it should be, however coarse the drawn ground is from there: discs a little under the top of a slab of 12
 * metres are hidden, those above what slopes make of it are seen. */
static void trees_neither_float_nor_sink(void **state) {
    const Bench *b = *state;
    asc(b, gentle);
    for (int frame = 0; frame < 6; frame++) {
        int below, above;
        double sunk = marks_left(b, frame, 8.5, 9, &below), flying = 1 - marks_left(b, frame, 15, 15.5, &above);
        printf("frame %d: of %d pixels of discs below the top %.3f are seen, of %d above it %.3f are hidden\n", frame, below, sunk, above, flying);
        assert_true(below > 15 && above > 15);
        assert_true(sunk < 0.02 && flying < 0.02);
    }
}

#define FLIGHT "#declare Land = terrain { heightmap \"" MAP "\" curvature off }\n" \
                    "camera { location <-300 + 2*clock, 420, -340> look_at <0, 0, 0> angle 60 }\nbackground { rgb <0, 0, 1> }\n" \
                    "light_source { <-3e6, 4e6, -1e6>, rgb 1.2 parallel point_at 0 }\nobject { Land pigment { rgb <1, 0.8, 0.6> } }\n"

/* Frames two metres apart: how the error, against ground that is eight times finer, changes from one to the next. */
static void flights_do_not_flicker(void **state) {
    enum { FRAMES = 5, VALUES = 3 * SIDE * SIDE };
    const Bench *b = *state;
    static float errors[2][VALUES];
    double flicker = 0, error = 0;
    asc(b, hills);
    for (int f = 0; f < FRAMES; f++) {
        VtsOptions o = options_of_size(SIDE, SIDE);
        o.clock = f, o.clock_set = true;
        Picture coarse = bench_render(b, &o, FLIGHT);
        o.max_error = 1.0 / (8 * 255);
        Picture full = bench_render(b, &o, FLIGHT);
        float *now = errors[f % 2], *before = errors[1 - f % 2];
        for (int i = 0; i < VALUES; i++) {
            now[i] = coarse.pixels[i] - full.pixels[i];
            double change = f ? (double)now[i] - (double)before[i] : 0;
            error += (double)now[i] * (double)now[i] / (VALUES * FRAMES), flicker += change * change / (VALUES * (FRAMES - 1));
        }
        assert_true(is_sound(&coarse) && is_sound(&full));
        picture_free(&coarse);
        picture_free(&full);
    }
    printf("flight: error %.4f, flicker %.4f\n", sqrt(error), sqrt(flicker));
    assert_true(sqrt(error) < 2.0 / 255);
    assert_true(sqrt(flicker) < 2.0 / 255);
}

/* ---- clearings ---- */

static double rolling(int column, int row) { return 30 * sin(0.23 * column + 0.4) * cos(0.19 * row); }

/* Woods that end where it is flat: a little error of the slope moves their border far. */
static void clearings_end_where_slopes_say(void **state) {
    const Bench *b = *state;
    static const char scene[] = BACK "camera { location <-600, 500, -800> look_at <0, 0, -40> angle 36 }\n"
        "#declare Land = terrain { heightmap \"" MAP "\" curvature off }\n"
        "#declare Slab = texel { cyclic x + z resolution 16 layer { box { <-1, 0, -1>, <2, 1, 2> } texture { " GLOWING("y") " } } }\n"
        "object { Land " GLOWING("x") " }\n"
        "skin { surface { terrain { Land } } texel { Slab } mapping { tile 30 height 12 pigment { slope y pigment_map { [0.95 rgb 1] [0.96 rgb 0] } } } }\n";
    asc(b, rolling);
    const VtsPair voxels = {"detail", "voxels"};
    VtsOptions o = options_of_size(SIDE, 72);
    o.reference_samples = STABILITY_SAMPLES;
    Picture exact = reference_of(b, &o, scene);
    o.settings = &voxels, o.setting_count = 1;
    Picture drawn = bench_render(b, &o, scene);
    Difference d = picture_difference(&drawn, &exact);
    printf("clearings: rms %.4f, mean %+.4f, deviation %.3f\n", d.rms, d.mean, deviation(&exact));
    assert_true(is_sound(&drawn) && deviation(&exact) > 0.3);
    assert_true(d.rms < 0.08);
    picture_free(&exact);
    picture_free(&drawn);
}

/* ---- pictures of all around ---- */

static double triangles_for(const Bench *b, const char *camera) {
    char text[600];
    VtsOptions o = options_of_size(96, 48);
    snprintf(text, sizeof text, "%scamera { %s }\nobject { terrain { heightmap \"" MAP "\" curvature off } " GLOWING("x") " }\n", BACK, camera);
    bench_write(b, text);
    VtsSession *session = vts_session_create(&o, NULL);
    assert_non_null(session);
    assert_int_equal(vts_render(session, b->scene, b->output), VTS_OK);
    const char *found = strstr(vts_report(session), "\"terrains\":[");
    assert_non_null(found);
    assert_non_null(found = strstr(found, "\"needed\":"));
    double needed = strtod(found + strlen("\"needed\":"), NULL);
    vts_session_destroy(session);
    return needed;
}

/* At the poles of a panorama a place is as wide as the picture: pixels there are narrow, and ask for nothing finer than others do. */
static void panoramas_need_no_more(void **state) {
    const Bench *b = *state;
    asc(b, rough);
    double around = triangles_for(b, "spherical location <0, 600, 0> look_at x angle 360 180"), ahead = triangles_for(b, "location <0, 600, 0> look_at 600*y + x angle 90");
    printf("triangles: panorama %g, ahead %g\n", around, ahead);
    assert_true(around > 0 && around < 4 * ahead);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, bench_set_up, tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {TEST(silhouettes), TEST(drop_at_100_km), TEST(antimeridian), TEST(pole), TEST(single_rows), TEST(voids), TEST(feet_stand_on_the_ground), TEST(trees_neither_float_nor_sink), TEST(flights_do_not_flicker), TEST(clearings_end_where_slopes_say), TEST(panoramas_need_no_more)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
