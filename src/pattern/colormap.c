#include "pattern/colormap.h"

/* ---- POV-Ray's own maps ---- */

#define ENTRY(position, red, green, blue)                                                                    \
    { position, {red, green, blue, 0, 0}, NULL }

static const ColorMapEntry grey_map[] = {ENTRY(0, 0, 0, 0), ENTRY(1, 1, 1, 1)};
static const ColorMapEntry bozo_map[] = {ENTRY(0.4, 1, 1, 1), ENTRY(0.4, 0, 1, 0), ENTRY(0.6, 0, 1, 0),
                                         ENTRY(0.6, 0, 0, 1), ENTRY(0.8, 0, 0, 1), ENTRY(0.8, 1, 0, 0)};
static const ColorMapEntry agate_map[] = {ENTRY(0, 1, 1, 1),         ENTRY(0.5, 0.95, 0.75, 0.5),
                                          ENTRY(0.5, 0.9, 0.7, 0.5), ENTRY(0.6, 0.9, 0.7, 0.4),
                                          ENTRY(0.6, 1, 0.7, 0.4),   ENTRY(1, 0.6, 0.3, 0)};
static const ColorMapEntry marble_map[] = {ENTRY(0, 0.9, 0.8, 0.8), ENTRY(0.9, 0.9, 0.08, 0.08),
                                           ENTRY(0.9, 0, 0, 0)};
static const ColorMapEntry wood_map[] = {ENTRY(0.6, 0.666, 0.312, 0.2), ENTRY(0.6, 0.4, 0.1333, 0.066)};
static const ColorMapEntry radial_map[] = {ENTRY(0, 0, 1, 1), ENTRY(0.333, 1, 1, 0), ENTRY(0.666, 1, 0, 1),
                                           ENTRY(1, 0, 1, 1)};
static const ColorMapEntry checker_colors[] = {ENTRY(0, 0, 0, 1), ENTRY(1, 0, 1, 0)};
static const ColorMapEntry brick_colors[] = {ENTRY(0, 0.5, 0.5, 0.5), ENTRY(1, 0.6, 0.15, 0.15)};
static const ColorMapEntry hexagon_colors[] = {ENTRY(0, 0, 0, 1), ENTRY(1, 0, 1, 0), ENTRY(2, 1, 0, 0)};

#define MAP(entries) ((ColorMap){entries, VTS_ARRAY_COUNT(entries)})

static ColorMap own_map(PatternKind kind) {
    switch (kind) {
    case PATTERN_BOZO: return MAP(bozo_map);
    case PATTERN_AGATE: return MAP(agate_map);
    case PATTERN_MARBLE: return MAP(marble_map);
    case PATTERN_WOOD: return MAP(wood_map);
    case PATTERN_RADIAL: return MAP(radial_map);
    case PATTERN_CHECKER: return MAP(checker_colors);
    case PATTERN_BRICK: return MAP(brick_colors);
    case PATTERN_HEXAGON: return MAP(hexagon_colors);
    default: return MAP(grey_map);
    }
}

ColorMap colormap_of(const Pigment *pigment) {
    return pigment->entry_count ? (ColorMap){pigment->entries, pigment->entry_count} : own_map(pigment->kind);
}

/* ---- values ---- */

static void add_piece(MapPieces *pieces, double lo, double hi, double weight) {
    if (weight > 0 && pieces->count < MAX_PIECES) {
        pieces->items[pieces->count].lo = lo, pieces->items[pieces->count].hi = hi;
        pieces->items[pieces->count++].weight = weight;
    }
}

/* An interval within one period, through the wave. The weight is shared by length. */
static void add_phase(MapPieces *pieces, Wave wave, double lo, double hi, double weight) {
    if (wave == WAVE_RAMP || hi <= lo) {
        add_piece(pieces, lo, hi, weight);
        return;
    }
    double turn = double_clamp(0.5, lo, hi), per_length = weight / (hi - lo);
    add_piece(pieces, 2 * lo, 2 * turn, (turn - lo) * per_length);
    add_piece(pieces, 2 - 2 * hi, 2 - 2 * turn, (hi - turn) * per_length);
}

/* A single value goes through POV-Ray's formula to the letter; its period of 1.00001 keeps a value of 1 from being 0. */
static MapPieces point_piece(const Pigment *pigment, PatternTraits traits, double value) {
    double phase = fmod(value * (double)(float)pigment->frequency + (double)(float)pigment->phase, 1.00001);
    if (phase < 0) phase -= floor(phase);
    if (traits.wave == WAVE_TRIANGLE) {
        phase -= floor(phase);
        phase = phase >= 0.5 ? 2 * (1 - phase) : 2 * phase;
    }
    MapPieces pieces = {.count = 0};
    add_piece(&pieces, phase, phase, 1);
    return pieces;
}

static MapPieces interval_pieces(const Pigment *pigment, PatternTraits traits, double lo, double hi) {
    MapPieces pieces = {.count = 0};
    double a = lo * pigment->frequency + pigment->phase, b = hi * pigment->frequency + pigment->phase;
    double length = fabs(b - a), start = fmin(a, b), whole = floor(length), rest = length - whole;
    if (whole > 0) add_phase(&pieces, traits.wave, 0, 1, whole / length);
    if (traits.bounded && start >= 0 &&
        start + length <= 1) { /* a value of 1 is no beginning of another period */
        if (rest > 0) add_phase(&pieces, traits.wave, start, start + rest, rest / length);
        return pieces;
    }
    start -= floor(start);
    double first = fmin(rest, 1 - start);
    if (first > 0) add_phase(&pieces, traits.wave, start, start + first, first / length);
    if (rest > first) add_phase(&pieces, traits.wave, 0, rest - first, (rest - first) / length);
    return pieces;
}

MapPieces colormap_pieces(const Pigment *pigment, Spread spread) {
    PatternTraits traits = pattern_traits(pigment->kind);
    double lo = spread.value - spread.width / 2, hi = spread.value + spread.width / 2;
    if (traits.bounded) lo = double_clamp(lo, 0, 1), hi = double_clamp(hi, 0, 1);
    if (!(hi - lo > 1e-9) || fabs((hi - lo) * pigment->frequency) < 1e-9)
        return point_piece(pigment, traits, spread.value);
    return interval_pieces(pigment, traits, lo, hi);
}

/* ---- weights ---- */

/* The mean over [lo, hi], clipped to the segment [a, b], of the function falling from 1 at a to 0 at b, times the share of
 * [lo, hi] in the segment. */
static double falling_weight(double a, double b, double lo, double hi) {
    double l = fmax(a, lo), h = fmin(b, hi);
    return h > l ? (h - l) / (hi - lo) * (1 - ((l + h) / 2 - a) / (b - a)) : 0;
}

static double interval_weight(ColorMap map, size_t k, double lo, double hi) {
    double x = map.entries[k].position, weight = 0;
    if (k == 0) weight += double_clamp((x - lo) / (hi - lo), 0, 1);
    if (k + 1 == map.count) weight += double_clamp((hi - x) / (hi - lo), 0, 1);
    if (k + 1 < map.count) weight += falling_weight(x, map.entries[k + 1].position, lo, hi);
    if (k > 0) weight += falling_weight(-x, -map.entries[k - 1].position, -hi, -lo);
    return weight;
}

/* Of entries at one position the first counts. */
static double point_weight(ColorMap map, size_t k, double value) {
    double x = map.entries[k].position;
    if (x >= value) {
        if (k == 0) return 1;
        double before = map.entries[k - 1].position;
        return before < value ? (value - before) / (x - before) : 0;
    }
    if (k + 1 == map.count) return 1;
    double next = map.entries[k + 1].position;
    return next >= value ? (next - value) / (next - x) : 0;
}

double colormap_weight(ColorMap map, size_t k, const MapPieces *pieces) {
    double weight = 0;
    for (int i = 0; i < pieces->count; i++) {
        double lo = pieces->items[i].lo, hi = pieces->items[i].hi;
        double part = hi > lo ? interval_weight(map, k, lo, hi) : point_weight(map, k, lo);
        weight += pieces->items[i].weight * part;
    }
    return weight;
}
