#include "pattern/blocks.h"
#include "pattern/colormap.h"
#include "pattern/pattern.h"
#include "pattern/picture_map.h"
#include "pattern/pigment.h"

#include "tape/noise.h"

/* ---- what patterns make of their entries ---- */

/* Where the map is straight all over the values that are `width` about the mean; false where it is not. */
static bool blend_straight(const Pigment *pattern, double value, double width, double mean, double share, BlendVisit *visit, void *target) {
    MapPlace place;
    const double half = pattern_traits(pattern->kind).bounded ? fmin(width / 2, fmax(fmin(value, 1 - value), 0)) : width / 2;
    if (!colormap_is_straight(pattern, colormap_of(pattern), value - half, value + half, mean, &place)) return false;
    if (place.share < 1) visit(target, place.below, share * (1 - place.share));
    if (place.share > 0) visit(target, place.above, share * place.share);
    return true;
}

static void blend_range(const Pigment *pattern, Spread spread, double share, BlendVisit *visit, void *target) {
    MapPieces pieces = colormap_pieces(pattern, spread);
    colormap_blend(colormap_of(pattern), &pieces, share, visit, target);
}

/* A bell is two ranges, one within the other, that have its moments up to the eighth: their half widths are σ times the roots of Hermite's
 * polynomial of degree 5 (1.3556, 2.8570), here over the √12 σ / 2 of one range. */
static void blend_spread(const Pigment *pattern, Spread spread, double share, BlendVisit *visit, void *target) {
    static const struct { double width, share; } ranges[] = {{0.782671, 0.816228}, {1.649472, 0.183772}};
    const double widest = spread.bell ? ranges[1].width * spread.width : spread.width;
    if (blend_straight(pattern, spread.value, widest, spread.value, share, visit, target)) return;
    if (!spread.bell || !(spread.width > 0)) {
        blend_range(pattern, spread, share, visit, target);
        return;
    }
    for (size_t i = 0; i < VTS_ARRAY_COUNT(ranges); i++)
        blend_range(pattern, (Spread){spread.value, spread.width * ranges[i].width, false}, share * ranges[i].share, visit, target);
}

static void blend_blocks(const Pigment *pattern, const Spot *spot, BlendVisit *visit, void *target) {
    double shares[BLOCK_KINDS];
    block_shares(pattern, spot, shares);
    size_t kinds = (size_t)pattern_traits(pattern->kind).blocks;
    for (size_t k = 0; k < kinds; k++)
        if (shares[k] > 0) visit(target, k, shares[k]);
}

static double cell_value(Vec3 p) {
    return noise_pov_cell(vec3(floor(p.x + 1e-7), floor(p.y + 1e-7), floor(p.z + 1e-7)));
}

/* The share of [x - width/2, x + width/2] in the unit cell from `corner`. */
static double cell_share(double x, double width, double corner) {
    if (width < 1e-9) return floor(x + 1e-7) == corner ? 1 : 0;
    double lo = fmax(x - width / 2, corner), hi = fmin(x + width / 2, corner + 1);
    return hi > lo ? (hi - lo) / width : 0;
}

/* The mean over the cells that the footprint's box covers: at most three along each axis. */
static void blend_covered(const Pigment *pattern, const Spot *spot, const double width[3], double whole, BlendVisit *visit, void *target) {
    Vec3 p = spot->p, corner = vec3(floor(p.x + 1e-7), floor(p.y + 1e-7), floor(p.z + 1e-7));
    for (int k = 0; k < 27; k++) {
        Vec3 at = vec3_add(corner, vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
        double share = cell_share(p.x, width[0], at.x) * cell_share(p.y, width[1], at.y) * cell_share(p.z, width[2], at.z);
        if (share > 0) blend_spread(pattern, (Spread){noise_pov_cell(at), 0, false}, share * whole, visit, target);
    }
}

static void blend_cells(const Pigment *pattern, const Spot *spot, BlendVisit *visit, void *target) {
    double width[3], widest = 0;
    for (int k = 0; k < 3; k++) {
        width[k] = spot_width_along(spot, k);
        widest = fmax(widest, width[k]);
    }
    double far = double_clamp(widest - 1, 0, 1);
    if (far < 1) blend_covered(pattern, spot, width, 1 - far, visit, target);
    if (far > 0) blend_spread(pattern, (Spread){0.5, 1, false}, far, visit, target); /* all values alike */
}

static bool is_unit_color(Color c) { return fmin(fmin(c.red, c.green), c.blue) >= 0 && fmax(fmax(c.red, c.green), c.blue) <= 1; }

/* Whether all colours are from 0 to 1, as their grey then is. */
static bool has_unit_colors(const Pigment *pigment) {
    if (pigment->kind == PATTERN_IMAGE_MAP) return false;
    if (pigment->kind == PATTERN_SOLID) return is_unit_color(pigment->color);
    const ColorMap map = colormap_of(pigment);
    for (size_t k = 0; k < map.count; k++) {
        const ColorMapEntry *e = &map.entries[k];
        if (e->pigment ? !has_unit_colors(e->pigment) : !is_unit_color(e->color)) return false;
    }
    return true;
}

/* Where the map is straight over all greys, colours are that of the mean, and a pigment's colour is one already. */
static bool blend_gray(const Pigment *pattern, const Spot *spot, BlendVisit *visit, void *target) {
    MapPlace place;
    if (pattern->kind != PATTERN_PIGMENT || !pattern->source || !has_unit_colors(pattern->source)) return false;
    if (!colormap_is_straight(pattern, colormap_of(pattern), 0, 1, 0.5, &place)) return false;
    return blend_straight(pattern, 0.5, 1, pattern_value(pattern, spot).value, 1, visit, target);
}

/* Of patterns of which only values are known: the mean of four places, each with the range of all of them. */
static void blend_sampled(const Pigment *pattern, const Spot *spot, BlendVisit *visit, void *target) {
    static const double within[PATTERN_PLACES][2] = {{-0.125, -0.375}, {0.375, -0.125}, {0.125, 0.375}, {-0.375, 0.125}};
    Vec3 u = spot->axes[0], v = spot->axes[1];
    if (spot->blur > 0) u = vec3(spot_size(spot), 0, 0), v = vec3(0, 0, spot_size(spot));
    Spot places[PATTERN_PLACES];
    double values[PATTERN_PLACES], lo = (double)INFINITY, hi = -(double)INFINITY, sum = 0;
    for (int k = 0; k < PATTERN_PLACES; k++) {
        places[k] = *spot;
        places[k].p = vec3_madd(vec3_madd(spot->p, u, within[k][0]), v, within[k][1]);
    }
    pattern_values(pattern, places, values);
    for (int k = 0; k < PATTERN_PLACES; k++) {
        lo = fmin(lo, values[k]), hi = fmax(hi, values[k]), sum += values[k];
    }
    if (blend_straight(pattern, (lo + hi) / 2, 1.5 * (hi - lo), sum / PATTERN_PLACES, 1, visit, target)) return;
    for (int k = 0; k < PATTERN_PLACES; k++) blend_spread(pattern, (Spread){values[k], (hi - lo) / 2, false}, 1.0 / PATTERN_PLACES, visit, target);
}

static void blend_average(const Pigment *pattern, BlendVisit *visit, void *target) {
    double total = 0;
    for (size_t k = 0; k < pattern->entry_count; k++) total += pattern->entries[k].position;
    if (!(fabs(total) > 0)) return;
    for (size_t k = 0; k < pattern->entry_count; k++) visit(target, k, pattern->entries[k].position / total);
}

/* Numbers beyond the textures begin anew, but that which is one too many: it has the last (measured). */
static size_t material_number(const Pigment *pattern, const Spot *spot) {
    size_t count = pattern->entry_count, number = pattern->image && count ? picture_map_index(pattern->image, spot) : 0;
    return number > count ? number % count : number == count && count ? count - 1 : number;
}

/* Shares of the first entries, added up: an entry may be a pigment or a texture that takes long to look at, and the ranges and places of a
 * footprint mostly fall on the same few entries. */
enum { MERGED_ENTRIES = 32 };
typedef struct MergedShares {
    double shares[MERGED_ENTRIES];
    BlendVisit *visit;
    void *target;
} MergedShares;

static void merge_share(void *target, size_t entry, double share) {
    MergedShares *m = target;
    if (entry < MERGED_ENTRIES)
        m->shares[entry] += share;
    else
        m->visit(m->target, entry, share);
}

static void blend_values(const Pigment *pattern, const Spot *spot, BlendVisit *visit, void *target) {
    if (pattern->kind == PATTERN_CELLS)
        blend_cells(pattern, spot, visit, target);
    else if (spot_is_point(spot) || !pattern_traits(pattern->kind).sampled)
        blend_spread(pattern, pattern_value(pattern, spot), 1, visit, target);
    else if (!blend_gray(pattern, spot, visit, target))
        blend_sampled(pattern, spot, visit, target);
}

static void blend_merged(const Pigment *pattern, const Spot *spot, BlendVisit *visit, void *target) {
    MergedShares merged;
    const size_t count = size_min(colormap_of(pattern).count, MERGED_ENTRIES);
    merged.visit = visit, merged.target = target;
    for (size_t k = 0; k < count; k++) merged.shares[k] = 0;
    blend_values(pattern, spot, merge_share, &merged);
    for (size_t k = 0; k < count; k++)
        if (merged.shares[k] > 0) visit(target, k, merged.shares[k]);
}

void pattern_blend(const Pigment *pattern, const Spot *spot, BlendVisit *visit, void *target) {
    if (pattern_traits(pattern->kind).blocks)
        blend_blocks(pattern, spot, visit, target);
    else if (pattern->kind == PATTERN_AVERAGE)
        blend_average(pattern, visit, target);
    else if (pattern->kind == PATTERN_MATERIAL)
        visit(target, material_number(pattern, spot), 1);
    else
        blend_merged(pattern, spot, visit, target);
}

/* ---- colours ---- */

typedef struct ColorSum {
    ColorMap map, own; /* `own`: the pattern's, where entries were not given */
    const Spot *spot;
    Color sum;
} ColorSum;

/* Pigments of a map stand in the space of the pattern, its turbulence included, as in POV-Ray. */
static void add_entry(void *target, size_t k, double share) {
    ColorSum *s = target;
    const ColorMapEntry *entry = &(k < s->map.count ? s->map : s->own).entries[k];
    Color c = entry->pigment ? pigment_color_at(entry->pigment, s->spot) : entry->color;
    s->sum.red += share * c.red;
    s->sum.green += share * c.green;
    s->sum.blue += share * c.blue;
    s->sum.filter += share * c.filter;
    s->sum.transmit += share * c.transmit;
}

/* ---- pigments ---- */

Color pigment_color_at(const Pigment *pigment, const Spot *outer) {
    if (pigment->kind == PATTERN_SOLID) return pigment->color;
    PatternTraits traits = pattern_traits(pigment->kind);
    Spot spot = spot_in_pattern(pigment, outer, traits.warps_itself);
    if (pigment->kind == PATTERN_IMAGE_MAP)
        return pigment->image ? picture_map_color(pigment->image, &spot) : pigment->color;
    ColorSum sum = {.map = colormap_of(pigment), .own = colormap_own(pigment->kind), .spot = &spot};
    pattern_blend(pigment, &spot, add_entry, &sum);
    return sum.sum;
}

Color pigment_color(const Pigment *pigment, Vec3 point, Vec3 normal, double footprint) {
    Spot spot = spot_make(point, normal, footprint);
    return pigment_color_at(pigment, &spot);
}

double pattern_number(const Pigment *pattern, const Spot *spot) {
    PatternTraits traits = pattern_traits(pattern->kind);
    if (traits.blocks && pattern->kind != PATTERN_CHECKER && pattern->kind != PATTERN_BRICK)
        return block_index(pattern, spot->p);
    double value = traits.blocks                    ? block_index(pattern, spot->p)
                   : pattern->kind == PATTERN_CELLS ? cell_value(spot->p)
                                                    : pattern_value(pattern, spot).value;
    return colormap_pieces(pattern, (Spread){value, 0, false}).items[0].lo;
}

double pigment_value(const Pigment *pigment, Vec3 point, Vec3 normal) {
    if (pigment->kind == PATTERN_SOLID || pigment->kind == PATTERN_IMAGE_MAP) return 0;
    Spot outer = spot_make(point, normal, 0);
    Spot spot = spot_in_pattern(pigment, &outer, pattern_traits(pigment->kind).warps_itself);
    return pattern_number(pigment, &spot);
}

static bool same_color(Color a, Color b) {
    return a.red == b.red && a.green == b.green && a.blue == b.blue && a.filter == b.filter &&
           a.transmit == b.transmit;
}

bool pigment_is_uniform(const Pigment *pigment, Color *color) {
    if (pigment->kind == PATTERN_IMAGE_MAP || pigment->kind == PATTERN_MATERIAL) return false;
    if (pigment->kind == PATTERN_SOLID) return *color = pigment->color, true;
    ColorMap map = colormap_of(pigment);
    if (map.count < (size_t)pattern_traits(pigment->kind).blocks) return false;
    for (size_t k = 0; k < map.count; k++) {
        Color entry = map.entries[k].color;
        if (map.entries[k].pigment && !pigment_is_uniform(map.entries[k].pigment, &entry)) return false;
        if (k > 0 && !same_color(entry, *color)) return false;
        *color = entry;
    }
    return true;
}
