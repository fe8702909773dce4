/* Footprints: filtered colours against means of many point samples over the same disc. */
#include "base/random.h"
#include "pattern/colormap.h"
#include "pattern/pattern.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static Pigment make_pigment(PatternKind kind) {
    Pigment pigment = pigment_default();
    pigment.kind = kind;
    pigment.direction = vec3(1, 0, 0);
    return pigment;
}

static double grey(Color c) { return (c.red + c.green + c.blue) / 3; }

/* The mean over a square of side `size` across the normal y: what the filters approximate. */
static double brute_force(const Pigment *pigment, Vec3 p, double size, RandomStream *random) {
    enum { SIDE = 40 };
    double sum = 0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        double s = (k % SIDE + random_next_unit(random)) / SIDE - 0.5,
               t = (k / SIDE + random_next_unit(random)) / SIDE - 0.5;
        sum += grey(pigment_color(pigment, vec3(p.x + s * size, p.y, p.z + t * size), vec3(0, 1, 0), 0));
    }
    return sum / (SIDE * SIDE);
}

typedef struct Errors {
    double mean, rms; /* of filtered - brute force */
    double point_rms; /* of a point sample - brute force */
} Errors;

static Errors compare(const Pigment *pigment, double size, int count) {
    RandomStream random = {99};
    Errors e = {0, 0, 0};
    for (int n = 0; n < count; n++) {
        Vec3 p = vec3(40 * random_next_unit(&random) - 20, 40 * random_next_unit(&random) - 20,
                      40 * random_next_unit(&random) - 20);
        double truth = brute_force(pigment, p, size, &random);
        double filtered = grey(pigment_color(pigment, p, vec3(0, 1, 0), size)) - truth;
        double point = grey(pigment_color(pigment, p, vec3(0, 1, 0), 0)) - truth;
        e.mean += filtered / count;
        e.rms += filtered * filtered / count;
        e.point_rms += point * point / count;
    }
    e.rms = sqrt(e.rms), e.point_rms = sqrt(e.point_rms);
    return e;
}

static const ColorMapEntry odd_map[] = {{0.1, {0, 0, 0, 0, 0}, NULL},
                                        {0.35, {1, 0.5, 0, 0, 0}, NULL},
                                        {0.35, {0.2, 0.2, 0.9, 0, 0}, NULL},
                                        {0.9, {1, 1, 1, 0, 0}, NULL}};
static const ColorMapEntry black_white[] = {
    {0, {0, 0, 0, 0, 0}, NULL}, {1, {1, 1, 1, 0, 0}, NULL}, {2, {0.5, 0.5, 0.5, 0, 0}, NULL}};

static void boxes_are_averaged_exactly(void **state) {
    (void)state;
    static const double sizes[] = {0.05, 0.4, 1, 1.7, 6};
    static const PatternKind kinds[] = {PATTERN_CHECKER, PATTERN_BRICK, PATTERN_GRADIENT, PATTERN_MARBLE};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(kinds); k++)
        for (size_t s = 0; s < VTS_ARRAY_COUNT(sizes); s++) {
            Pigment p = make_pigment(kinds[k]);
            bool block = kinds[k] == PATTERN_CHECKER || kinds[k] == PATTERN_BRICK;
            p.entries = block ? black_white : odd_map, p.entry_count = block ? 2 : 4;
            Errors e = compare(&p, sizes[s], 100);
            /* what remains is the sampling of the brute force */
            if (e.rms > 0.012) fail_msg("kind %d size %g: rms %g", (int)kinds[k], sizes[s], e.rms);
        }
}

static void frequency_phase_and_scale_are_averaged_too(void **state) {
    (void)state;
    Pigment p = make_pigment(PATTERN_GRADIENT);
    p.entries = odd_map, p.entry_count = 4;
    p.frequency = -2.5, p.phase = 0.3;
    p.transform = transform_scale(vec3(3, 1, 1));
    assert_true(compare(&p, 0.7, 200).rms < 0.01);
    assert_true(compare(&p, 3, 200).rms < 0.01);
}

static void grow_grey_towards_the_horizon(void **state) {
    (void)state;
    RandomStream random = {5};
    for (int kind = PATTERN_CHECKER; kind <= PATTERN_HEXAGON; kind++) {
        Pigment p = make_pigment((PatternKind)kind);
        p.entries = black_white, p.entry_count = 3;
        double mean = kind == PATTERN_BRICK ? 7.5 / 8 * 4 / 4.5 : 0.5; /* within a row */
        for (int n = 0; n < 500; n++) {
            Vec3 at = vec3(1e4 * random_next_unit(&random), 0.5, 1e4 * random_next_unit(&random));
            double far = grey(pigment_color(&p, at, vec3(0, 1, 0), 300));
            assert_true(fabs(far - mean) < 0.01);
        }
    }
}

static void widening_is_continuous(void **state) {
    (void)state;
    RandomStream random = {6};
    for (int kind = PATTERN_GRADIENT; kind <= PATTERN_PLANAR; kind++) {
        Pigment p = make_pigment((PatternKind)kind);
        p.entries = black_white, p.entry_count = 2;
        if (kind == PATTERN_HEXAGON) continue; /* counted at sixteen places */
        p.turbulence = vec3_splat(kind > PATTERN_HEXAGON ? 0.4 : 0);
        for (int n = 0; n < 50; n++) {
            Vec3 at = vec3(9 * random_next_unit(&random), 9 * random_next_unit(&random),
                           9 * random_next_unit(&random));
            double before = grey(pigment_color(&p, at, vec3(0, 1, 0), 0.05));
            for (double size = 0.0505; size < 20; size *= 1.01) {
                double now = grey(pigment_color(&p, at, vec3(0, 1, 0), size));
                if (!(fabs(now - before) < 0.03))
                    fail_msg("kind %d size %g: %g then %g", kind, size, before, now);
                before = now;
            }
        }
    }
}

static void filtering_beats_a_point_sample(void **state) {
    (void)state;
    static const PatternKind kinds[] = {PATTERN_BOZO,   PATTERN_GRANITE, PATTERN_WRINKLES, PATTERN_AGATE,
                                        PATTERN_MARBLE, PATTERN_WOOD,    PATTERN_CRACKLE,  PATTERN_LEOPARD,
                                        PATTERN_ONION,  PATTERN_CELLS,   PATTERN_HEXAGON};
    static const double sizes[] = {0.3, 1.5, 5};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(kinds); k++)
        for (int turbulent = 0; turbulent < 2; turbulent++)
            for (size_t s = 0; s < VTS_ARRAY_COUNT(sizes); s++) {
                Pigment p = make_pigment(kinds[k]);
                p.turbulence = vec3_splat(turbulent ? 0.5 : 0);
                p.entries = black_white, p.entry_count = kinds[k] == PATTERN_HEXAGON ? 3 : 2;
                Errors e = compare(&p, sizes[s], 60);
                if (e.rms > 0.9 * e.point_rms + 0.01 || fabs(e.mean) > 0.05 || (sizes[s] > 4 && e.rms > 0.08))
                    fail_msg("kind %d turbulent %d size %g: rms %g, point %g, mean error %g", (int)kinds[k],
                             turbulent, sizes[s], e.rms, e.point_rms, e.mean);
            }
}

/* A sharp map of a noise: the mean of its colours is not the colour of the mean. */
static void maps_are_averaged_not_their_values(void **state) {
    (void)state;
    const ColorMapEntry step[] = {{0.6, {0, 0, 0, 0, 0}, NULL}, {0.6, {1, 1, 1, 0, 0}, NULL}};
    Pigment p = make_pigment(PATTERN_BOZO);
    p.entries = step, p.entry_count = 2;
    Errors e = compare(&p, 8, 100);
    assert_true(fabs(e.mean) < 0.06);
    assert_true(e.rms < 0.1);
}

/* A straight map over all greys has the colour of the source's mean, which is exact for checkers. */
static void straight_maps_of_pigments_are_averaged_exactly(void **state) {
    (void)state;
    static const ColorMapEntry dark_and_light[] = {{0, {0.2, 0.2, 0.2, 0, 0}, NULL}, {1, {0.9, 0.9, 0.9, 0, 0}, NULL}},
                               straight[] = {{0, {0.8, 0.4, 0, 0, 0}, NULL}, {1, {0, 0.1, 1.5, 0, 0}, NULL}};
    Pigment source = make_pigment(PATTERN_CHECKER), pattern = make_pigment(PATTERN_PIGMENT);
    source.entries = dark_and_light, source.entry_count = 2;
    pattern.source = &source;
    pattern.entries = straight, pattern.entry_count = 2;
    for (int k = 1; k < 5; k++) {
        Errors e = compare(&pattern, 0.4 * k, 100);
        assert_true(e.rms < 0.002 && fabs(e.mean) < 0.0005);
    }
}

static void add_weight(void *target, size_t entry, double share) { ((double *)target)[entry] += share; }

/* The mean of x, held within [first, last], over [lo, hi]. */
static double mean_held(double lo, double hi, double first, double last) {
    double sum = 0;
    if (!(hi > lo)) return fmin(fmax(lo, first), last);
    for (int i = 0; i < 4000; i++) sum += fmin(fmax(lo + (hi - lo) * (i + 0.5) / 4000, first), last);
    return sum / 4000;
}

/* Entries that have their own position for a colour make a map that is the value itself. */
static void maps_of_their_own_positions_are_the_value(void **state) {
    (void)state;
    RandomStream random = {23};
    for (int n = 0; n < 2000; n++) {
        ColorMapEntry entries[12] = {{0}};
        const size_t count = 1 + (size_t)(random_next_unit(&random) * 11.99);
        double position = 0.3 * random_next_unit(&random), mean = 0, whole = 0, weights[12] = {0};
        for (size_t k = 0; k < count; k++) {
            entries[k].position = position;
            if (random_next_unit(&random) < 0.7) position += 0.12 * random_next_unit(&random); /* else two at one position */
        }
        const double lo = 1.6 * random_next_unit(&random) - 0.3, hi = n % 4 ? lo + random_next_unit(&random) : lo;
        const MapPieces pieces = {.items = {{lo, hi, 1}}, .count = 1};
        colormap_blend((ColorMap){entries, count}, &pieces, 1, add_weight, weights);
        for (size_t k = 0; k < count; k++) mean += weights[k] * entries[k].position, whole += weights[k];
        assert_float_equal(whole, 1, 1e-9);
        assert_float_equal(mean, mean_held(lo, hi, entries[0].position, entries[count - 1].position), 1e-4);
    }
}

/* Where a map is said to be straight over a range its pieces say the same. */
static void straight_ranges_are_as_their_pieces(void **state) {
    (void)state;
    const ColorMapEntry entries[] = {{0.1, {0, 0, 0, 0, 0}, NULL}, {0.4, {1, 1, 1, 0, 0}, NULL}, {0.4, {0, 1, 1, 0, 0}, NULL}, {0.9, {1, 0, 1, 0, 0}, NULL}};
    const PatternKind kinds[] = {PATTERN_BOZO, PATTERN_GRADIENT, PATTERN_ONION, PATTERN_MARBLE, PATTERN_SPIRAL1, PATTERN_RADIAL};
    const double frequencies[] = {1, 3.5, -2, 0};
    RandomStream random = {11};
    int straight = 0;
    for (int n = 0; n < 20000; n++) {
        Pigment p = make_pigment(kinds[n % 6]);
        p.entries = entries, p.entry_count = 4;
        p.frequency = (float)frequencies[n / 6 % 4], p.phase = n % 5 ? 0 : 0.3f;
        if (n % 7 == 0) p.wave = WAVE_SINE;
        const double middle = n % 6 == 0 ? random_next_unit(&random) : 4 * random_next_unit(&random) - 1, half = 0.2 * random_next_unit(&random);
        const bool bounded = n % 6 == 0 && (middle < half || middle > 1 - half);
        const ColorMap map = colormap_of(&p);
        MapPlace place;
        if (bounded || !colormap_is_straight(&p, map, middle - half, middle + half, middle, &place)) continue;
        straight++;
        const MapPieces pieces = colormap_pieces(&p, (Spread){middle, 2 * half, false});
        double weights[4] = {0};
        colormap_blend(map, &pieces, 1, add_weight, weights);
        for (size_t k = 0; k < 4; k++) {
            const double weight = (k == place.below ? 1 - place.share : 0) + (k == place.above ? place.share : 0);
            assert_float_equal(weights[k], weight, 1e-6);
        }
    }
    assert_in_range(straight, 2000, 17000);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_are_averaged_exactly),
        cmocka_unit_test(frequency_phase_and_scale_are_averaged_too),
        cmocka_unit_test(grow_grey_towards_the_horizon),
        cmocka_unit_test(widening_is_continuous),
        cmocka_unit_test(filtering_beats_a_point_sample),
        cmocka_unit_test(maps_are_averaged_not_their_values),
        cmocka_unit_test(straight_maps_of_pigments_are_averaged_exactly),
        cmocka_unit_test(maps_of_their_own_positions_are_the_value),
        cmocka_unit_test(straight_ranges_are_as_their_pieces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
