#include "pattern/blocks.h"
#include "pattern/colormap.h"
#include "pattern/pattern.h"
#include "pattern/picture_map.h"
#include "pattern/pigment.h"

#include "tape/noise.h"

static void add_color(Color *sum, Color color, double weight) {
    sum->red += weight * color.red;
    sum->green += weight * color.green;
    sum->blue += weight * color.blue;
    sum->filter += weight * color.filter;
    sum->transmit += weight * color.transmit;
}

/* Pigments of a map stand in the space of the pattern, its turbulence included, as in POV-Ray. */
static Color entry_color(const ColorMapEntry *entry, const Spot *spot) {
    return entry->pigment ? pigment_color_at(entry->pigment, spot) : entry->color;
}

static Color mapped(ColorMap map, const MapPieces *pieces, const Spot *spot) {
    Color sum = {0, 0, 0, 0, 0};
    for (size_t k = 0; k < map.count; k++) {
        double weight = colormap_weight(map, k, pieces);
        if (weight > 0) add_color(&sum, entry_color(&map.entries[k], spot), weight);
    }
    return sum;
}

static Color mapped_spread(const Pigment *pigment, Spread spread, const Spot *spot) {
    MapPieces pieces = colormap_pieces(pigment, spread);
    return mapped(colormap_of(pigment), &pieces, spot);
}

/* ---- blocks ---- */

static Color block_color(const Pigment *pigment, const Spot *spot) {
    double shares[BLOCK_KINDS];
    Color sum = {0, 0, 0, 0, 0};
    Pigment plain = {.kind = pigment->kind};
    ColorMap map = colormap_of(pigment), own = colormap_of(&plain);
    block_shares(pigment, spot, shares);
    size_t kinds = (size_t)pattern_traits(pigment->kind).blocks;
    for (size_t k = 0; k < kinds; k++) /* colours that were not given are the pattern's own */
        if (shares[k] > 0)
            add_color(&sum, entry_color(&(k < map.count ? map : own).entries[k], spot), shares[k]);
    return sum;
}

/* ---- cells ---- */

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
static Color cells_covered(const Pigment *pigment, const Spot *spot, const double width[3]) {
    Vec3 p = spot->p, corner = vec3(floor(p.x + 1e-7), floor(p.y + 1e-7), floor(p.z + 1e-7));
    Color sum = {0, 0, 0, 0, 0};
    for (int k = 0; k < 27; k++) {
        Vec3 at = vec3_add(corner, vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
        double share = cell_share(p.x, width[0], at.x) * cell_share(p.y, width[1], at.y) *
                       cell_share(p.z, width[2], at.z);
        if (share > 0) add_color(&sum, mapped_spread(pigment, (Spread){noise_pov_cell(at), 0}, spot), share);
    }
    return sum;
}

static Color cells_color(const Pigment *pigment, const Spot *spot) {
    double width[3], widest = 0;
    for (int k = 0; k < 3; k++) {
        width[k] = spot_width(spot, vec3(k == 0, k == 1, k == 2));
        widest = fmax(widest, width[k]);
    }
    double far = double_clamp(widest - 1, 0, 1);
    Color sum = {0, 0, 0, 0, 0};
    if (far < 1) add_color(&sum, cells_covered(pigment, spot, width), 1 - far);
    if (far > 0) add_color(&sum, mapped_spread(pigment, (Spread){0.5, 1}, spot), far); /* all values alike */
    return sum;
}

/* ---- patterns of which only values are known ---- */

/* The mean of four places, each with the range of all of them. */
static Color sampled_color(const Pigment *pigment, const Spot *spot) {
    static const double places[4][2] = {{-0.125, -0.375}, {0.375, -0.125}, {0.125, 0.375}, {-0.375, 0.125}};
    if (spot_is_point(spot)) return mapped_spread(pigment, pattern_value(pigment, spot), spot);
    Vec3 u = spot->axes[0], v = spot->axes[1];
    if (spot->blur > 0) u = vec3(spot_size(spot), 0, 0), v = vec3(0, 0, spot_size(spot));
    double values[4], lo = (double)INFINITY, hi = -(double)INFINITY;
    for (int k = 0; k < 4; k++) {
        Spot place = *spot;
        place.p = vec3_madd(vec3_madd(spot->p, u, places[k][0]), v, places[k][1]);
        values[k] = pattern_value(pigment, &place).value;
        lo = fmin(lo, values[k]), hi = fmax(hi, values[k]);
    }
    Color sum = {0, 0, 0, 0, 0};
    for (int k = 0; k < 4; k++)
        add_color(&sum, mapped_spread(pigment, (Spread){values[k], (hi - lo) / 2}, spot), 0.25);
    return sum;
}

/* ---- pigments ---- */

static Color average_color(const Pigment *pigment, const Spot *spot) {
    Color sum = {0, 0, 0, 0, 0};
    double total = 0;
    for (size_t k = 0; k < pigment->entry_count; k++) total += pigment->entries[k].position;
    if (!(fabs(total) > 0)) return sum;
    for (size_t k = 0; k < pigment->entry_count; k++)
        add_color(&sum, entry_color(&pigment->entries[k], spot), pigment->entries[k].position / total);
    return sum;
}

Color pigment_color_at(const Pigment *pigment, const Spot *outer) {
    if (pigment->kind == PATTERN_SOLID) return pigment->color;
    PatternTraits traits = pattern_traits(pigment->kind);
    Spot spot = spot_in_pattern(pigment, outer, traits.warps_itself);
    if (pigment->kind == PATTERN_IMAGE_MAP)
        return pigment->image ? picture_map_color(pigment->image, &spot) : pigment->color;
    if (traits.blocks) return block_color(pigment, &spot);
    if (pigment->kind == PATTERN_CELLS) return cells_color(pigment, &spot);
    if (pigment->kind == PATTERN_AVERAGE) return average_color(pigment, &spot);
    if (traits.sampled) return sampled_color(pigment, &spot);
    return mapped_spread(pigment, pattern_value(pigment, &spot), &spot);
}

Color pigment_color(const Pigment *pigment, Vec3 point, Vec3 normal, double footprint) {
    Spot spot = spot_make(point, normal, footprint);
    return pigment_color_at(pigment, &spot);
}

double pigment_value(const Pigment *pigment, Vec3 point, Vec3 normal) {
    if (pigment->kind == PATTERN_SOLID || pigment->kind == PATTERN_IMAGE_MAP) return 0;
    Spot outer = spot_make(point, normal, 0);
    PatternTraits traits = pattern_traits(pigment->kind);
    Spot spot = spot_in_pattern(pigment, &outer, traits.warps_itself);
    if (traits.blocks && pigment->kind != PATTERN_CHECKER && pigment->kind != PATTERN_BRICK)
        return block_index(pigment, spot.p);
    double value = traits.blocks                     ? block_index(pigment, spot.p)
                   : pigment->kind == PATTERN_CELLS ? cell_value(spot.p)
                                                    : pattern_value(pigment, &spot).value;
    return colormap_pieces(pigment, (Spread){value, 0}).items[0].lo;
}

static bool same_color(Color a, Color b) {
    return a.red == b.red && a.green == b.green && a.blue == b.blue && a.filter == b.filter &&
           a.transmit == b.transmit;
}

bool pigment_is_uniform(const Pigment *pigment, Color *color) {
    if (pigment->kind == PATTERN_IMAGE_MAP) return false;
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
