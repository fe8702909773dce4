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
static const ColorMapEntry six_colors[] = {ENTRY(0, 1, 0, 0), ENTRY(1, 0, 1, 0), ENTRY(2, 0, 0, 1),
                                           ENTRY(3, 1, 1, 0), ENTRY(4, 0, 1, 1), ENTRY(5, 1, 0, 1)};
static const ColorMapEntry mandel_map[] = {ENTRY(0.001, 0, 0, 0), ENTRY(0.001, 0, 1, 1),
                                           ENTRY(0.012, 1, 1, 0), ENTRY(0.015, 1, 0, 1), ENTRY(0.1, 0, 1, 1)};
static const ColorMapEntry hexagon_colors[] = {ENTRY(0, 0, 0, 1), ENTRY(1, 0, 1, 0), ENTRY(2, 1, 0, 0)};

#define MAP(entries) ((ColorMap){entries, VTS_ARRAY_COUNT(entries)})

ColorMap colormap_own(PatternKind kind) {
    switch (kind) {
    case PATTERN_BOZO: return MAP(bozo_map);
    case PATTERN_AGATE: return MAP(agate_map);
    case PATTERN_MARBLE: return MAP(marble_map);
    case PATTERN_WOOD: return MAP(wood_map);
    case PATTERN_RADIAL: return MAP(radial_map);
    case PATTERN_OBJECT:
    case PATTERN_CHECKER: return MAP(checker_colors);
    case PATTERN_BRICK: return MAP(brick_colors);
    case PATTERN_HEXAGON: return MAP(hexagon_colors);
    case PATTERN_CUBIC:
    case PATTERN_TRIANGULAR: return MAP(six_colors);
    case PATTERN_SQUARE: return (ColorMap){six_colors, 4};
    case PATTERN_MANDEL: return MAP(mandel_map);
    default: return MAP(grey_map);
    }
}

ColorMap colormap_of(const Pigment *pigment) {
    return pigment->entry_count ? (ColorMap){pigment->entries, pigment->entry_count} : colormap_own(pigment->kind);
}

/* ---- values ---- */

static void add_piece(MapPieces *pieces, double lo, double hi, double weight) {
    if (weight > 0 && pieces->count < MAX_PIECES) {
        pieces->items[pieces->count].lo = lo, pieces->items[pieces->count].hi = hi;
        pieces->items[pieces->count++].weight = weight;
    }
}

static double cycloid(double x) { return sin(2 * VTS_PI * (x - floor(x))); }

static double triangle(double x) {
    x -= floor(x);
    return x >= 0.5 ? 2 * (1 - x) : 2 * x;
}

static double through_wave(const Pigment *pigment, double phase) {
    switch (pigment_wave(pigment)) {
    case WAVE_TRIANGLE: return triangle(phase);
    case WAVE_SINE: return (1 + cycloid(phase)) / 2;
    case WAVE_SCALLOP: return fabs(cycloid(phase / 2));
    case WAVE_CUBIC: return phase * phase * (3 - 2 * phase);
    case WAVE_POLY: return pow(phase, (double)(float)pigment->wave_exponent);
    default: return phase;
    }
}

/* An interval within one period, through the wave: in quarters of the period, where waves only rise or only fall. The weight
 * is shared by length. */
static void add_phase(MapPieces *pieces, const Pigment *pigment, double lo, double hi, double weight) {
    if (!(weight > 0)) return;
    const WaveKind wave = pigment_wave(pigment);
    if (wave == WAVE_RAMP || hi <= lo) {
        add_piece(pieces, lo, hi, weight);
        return;
    }
    int quarters = wave == WAVE_TRIANGLE ? 2 : 4;
    for (int k = 0; k < quarters; k++) {
        double a = double_clamp((double)k / quarters, lo, hi), b = double_clamp((k + 1.0) / quarters, lo, hi);
        if (!(b > a)) continue;
        double from = through_wave(pigment, a), to = through_wave(pigment, b - (b == 1 ? 1e-12 : 0));
        add_piece(pieces, fmin(from, to), fmax(from, to), weight * (b - a) / (hi - lo));
    }
}

static double restarted(Restart restart, double value) {
    return restart == RESTART_AT_ONE || (restart == RESTART_PAST_ONE && value > 1) ? fmod(value, 1) : value;
}

/* A single value goes through POV-Ray's formula to the letter; its period of 1.00001 keeps a value of 1 from being 0. */
static double point_phase(const Pigment *pigment, PatternTraits traits, double value) {
    value = restarted(traits.restart, value);
    double phase = value;
    if (pigment->frequency != 0)
        phase = fmod(value * (double)(float)pigment->frequency + (double)(float)pigment->phase, 1.00001);
    if (phase < 0) phase -= floor(phase);
    return through_wave(pigment, phase);
}

/* Values from lo to hi, all before a restart. */
static void add_values(MapPieces *pieces, const Pigment *pigment, PatternTraits traits, double lo, double hi,
                       double weight) {
    double a = lo * pigment->frequency + pigment->phase, b = hi * pigment->frequency + pigment->phase;
    double length = fabs(b - a), start = fmin(a, b), whole = floor(length), rest = length - whole;
    if (!(length > 1e-12)) {
        double phase = point_phase(pigment, traits, lo);
        add_piece(pieces, phase, phase, weight);
        return;
    }
    weight /= length;
    if (start < 0 || start + length > 1) start -= floor(start); /* a value of 1 begins no other period */
    double first = fmin(rest, 1 - start);
    add_phase(pieces, pigment, 0, 1, whole * weight);
    add_phase(pieces, pigment, start, start + first, first * weight);
    add_phase(pieces, pigment, 0, rest - first, (rest - first) * weight);
}

/* The same for values that start again at each whole number, from 0 on. */
static void add_restarting(MapPieces *pieces, const Pigment *pigment, PatternTraits traits, double lo,
                           double hi) {
    double length = hi - lo, below = double_clamp(-lo, 0, length);
    if (below > 0) add_values(pieces, pigment, traits, lo, lo + below, below / length);
    double start = fmax(lo, 0), left = length - below, whole = floor(left), rest = left - whole;
    start -= floor(start);
    double first = fmin(rest, 1 - start);
    if (whole > 0) add_values(pieces, pigment, traits, 0, 1, whole / length);
    if (first > 0) add_values(pieces, pigment, traits, start, start + first, first / length);
    if (rest > first) add_values(pieces, pigment, traits, 0, rest - first, (rest - first) / length);
}

/* The phases of values without a wave that bends; false where they go beyond one period. */
static bool straight_phases(const Pigment *pigment, Restart restart, double values[3]) {
    const double begin = restart == RESTART_NEVER ? 0 : floor(values[0]);
    if (begin < 0 || (restart != RESTART_NEVER && values[1] - begin > 1)) return false;
    for (int i = 0; i < 3; i++) values[i] = (values[i] - begin) * pigment->frequency + pigment->phase;
    const double least = fmin(values[0], values[1]), most = fmax(values[0], values[1]), whole = least < 0 || most > 1 ? floor(least) : 0;
    for (int i = 0; i < 3; i++) values[i] -= whole;
    return most - whole <= 1 && most > least;
}

bool colormap_is_straight(const Pigment *pigment, ColorMap map, double lo, double hi, double mean, MapPlace *place) {
    const WaveKind wave = pigment_wave(pigment);
    double v[3] = {lo, hi, mean};
    if ((wave != WAVE_RAMP && wave != WAVE_TRIANGLE) || !straight_phases(pigment, pattern_traits(pigment->kind).restart, v)) return false;
    if (wave == WAVE_TRIANGLE) {
        if (fmin(v[0], v[1]) < 0.5 && fmax(v[0], v[1]) > 0.5) return false;
        for (int i = 0; i < 3; i++) v[i] = v[i] < 0.5 ? 2 * v[i] : 2 * (1 - v[i]);
    }
    const double least = fmin(v[0], v[1]), most = fmax(v[0], v[1]);
    size_t k = 0;
    while (k < map.count && map.entries[k].position < most) k++;
    if (k > 0 && map.entries[k - 1].position > least) return false;
    *place = (MapPlace){k > 0 ? k - 1 : 0, k < map.count ? k : map.count - 1, 0};
    if (place->above > place->below)
        place->share = (v[2] - map.entries[k - 1].position) / (map.entries[k].position - map.entries[k - 1].position);
    return map.count > 0;
}

MapPieces colormap_pieces(const Pigment *pigment, Spread spread) {
    MapPieces pieces = {.count = 0};
    PatternTraits traits = pattern_traits(pigment->kind);
    double half = spread.width / 2;
    /* A range that would leave [0, 1] is narrowed, which keeps its mean. */
    if (traits.bounded) half = fmin(half, fmax(fmin(spread.value, 1 - spread.value), 0));
    double lo = spread.value - half, hi = spread.value + half;
    if (!(hi - lo > 1e-9 * fmax(1, fabs(lo)))) {
        double phase = point_phase(pigment, traits, spread.value);
        add_piece(&pieces, phase, phase, 1);
    } else if (traits.restart == RESTART_NEVER)
        add_values(&pieces, pigment, traits, lo, hi, 1);
    else
        add_restarting(&pieces, pigment, traits, lo, hi);
    return pieces;
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

/* Of the entries before the last the first that is not before x. */
static size_t entry_from(ColorMap map, double x) {
    size_t k = 0;
    while (k + 1 < map.count && map.entries[k].position < x) k++;
    return k;
}

/* Only entries between which a piece lies have a part in it: one before it, one behind it, and all within. */
void colormap_blend(ColorMap map, const MapPieces *pieces, double share, BlendVisit *visit, void *target) {
    for (int i = 0; i < pieces->count && map.count > 0; i++) {
        const double lo = pieces->items[i].lo, hi = pieces->items[i].hi, whole = share * pieces->items[i].weight;
        const size_t from = entry_from(map, lo), to = entry_from(map, hi);
        for (size_t k = from > 0 ? from - 1 : 0; k <= to; k++) {
            const double weight = hi > lo ? interval_weight(map, k, lo, hi) : point_weight(map, k, lo);
            if (weight > 0) visit(target, k, whole * weight);
        }
    }
}
