#include "terrain/heightmap_parts.h"

const HeightmapExtent *heightmap_extent(const Heightmap *map) { return &map->extent; }
Hash128 heightmap_hash(const Heightmap *map) { return map->hash; }

bool heightmap_to_geo(const Heightmap *map, double column, double row, GeoPlace *out) {
    return georeference_to_geo(&map->lattice, column, row, out);
}

bool heightmap_from_geo(const Heightmap *map, GeoPlace place, double *column, double *row) {
    if (!georeference_from_geo(&map->lattice, place, column, row)) return false;
    if (map->period) *column -= map->period * floor(*column / map->period);
    return true;
}

double undulation_at(const Undulation *u, double column, double row) {
    if (!u->nodes) return 0;
    double x = double_clamp(column / u->step, 0, u->columns - 1), y = double_clamp(row / u->step, 0, u->rows - 1);
    int c = int_clamp((int)x, 0, u->columns - 2), r = int_clamp((int)y, 0, u->rows - 2);
    const float *node = u->nodes + (size_t)r * (size_t)u->columns + (size_t)c;
    double v = y - r, w = x - c;
    double low = (double)node[0] * (1 - w) + (double)node[1] * w;
    double high = (double)node[u->columns] * (1 - w) + (double)node[u->columns + 1] * w;
    return low * (1 - v) + high * v;
}

/* Each layer over those below it, as much as it counts. A point between two layers' borders belongs to both; elsewhere a layer ends with
 * its posts. */
static bool blend(const Heightmap *map, GeoPlace place, double undulation, double *out) {
    double sum = 0, total = 0, left = 1, own = 0;
    int reached = 0;
    bool inside = false;
    for (int i = 0; i < map->layer_count && left > 0; i++) {
        const MapLayer *layer = &map->layers[i];
        double column, row, height, weight, core, add = layer_gets_geoid(layer) ? undulation : 0;
        if (!map_layer_from_geo(layer, place, &column, &row)) continue;
        if (map_layer_height(layer, column, row, &core)) {
            own = inside ? own : core + add;
            inside = true;
        }
        if (!map_layer_blended(layer, column, row, &height, &weight)) continue;
        sum += left * weight * (height + add);
        total += left * weight;
        left *= 1 - weight;
        reached++;
    }
    *out = total > 0 ? sum / total : own;
    return inside || reached > 1;
}

static bool height_at(const Heightmap *map, const GeoPlace *place, double column, double row, double *height) {
    double undulation = undulation_at(&map->undulation, column, row);
    if (map->layer_count > 1) return blend(map, *place, undulation, height);
    if (!map_layer_height(&map->layers[0], column, row, height)) return false;
    if (layer_gets_geoid(&map->layers[0])) *height += undulation;
    return !isnan(*height);
}

bool heightmap_height(const Heightmap *map, GeoPlace place, double *height) {
    double column, row;
    return heightmap_from_geo(map, place, &column, &row) && height_at(map, &place, column, row, height);
}

bool heightmap_at(const Heightmap *map, double column, double row, double *height) {
    GeoPlace place = {0};
    if (!(fabs(column) < 1e9 && fabs(row) < 1e9)) return false;
    return (map->layer_count == 1 || heightmap_to_geo(map, column, row, &place)) && height_at(map, &place, column, row, height);
}

float heightmap_post(const Heightmap *map, int column, int row) {
    double height;
    if (map->layer_count > 1) return heightmap_at(map, column, row, &height) ? (float)height : NAN;
    float post = posts_get(&map->layers[0].posts, column, row);
    if (!map->undulation.nodes || !layer_gets_geoid(&map->layers[0])) return post;
    return (float)((double)post + undulation_at(&map->undulation, column, row));
}

/* Of one layer without a geoid, whole rows are copied. */
bool heightmap_block(const Heightmap *map, int column, int row, int step, int columns, int rows, float *heights) {
    bool plain = map->layer_count == 1 && (!map->undulation.nodes || !layer_gets_geoid(&map->layers[0]));
    bool whole = true;
    if (plain) posts_read(&map->layers[0].posts, column, row, step, columns, rows, heights, (size_t)columns);
    for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++, heights++) {
            if (!plain) *heights = heightmap_post(map, column + c * step, row + r * step);
            whole &= !isnan(*heights);
        }
    return whole;
}

/* The columns and rows of a layer that a box of the lattice may touch: by places along and across the box, and some more around them, since
 * lines of one system are bent in another. */
static bool box_in_layer(const Heightmap *map, const MapLayer *layer, const int box[4], int out[4]) {
    enum { PROBES = 5 };
    double low[2] = {VTS_INFINITY, VTS_INFINITY}, high[2] = {-VTS_INFINITY, -VTS_INFINITY};
    for (int k = 0; k < PROBES * PROBES; k++) {
        GeoPlace place;
        double at[2];
        double column = box[0] + (box[2] - box[0]) * (k % PROBES / (PROBES - 1.0)), row = box[1] + (box[3] - box[1]) * (k / PROBES / (PROBES - 1.0));
        if (!heightmap_to_geo(map, column, row, &place) || !map_layer_from_geo(layer, place, &at[0], &at[1])) return false;
        for (int a = 0; a < 2; a++) low[a] = fmin(low[a], at[a]), high[a] = fmax(high[a], at[a]);
    }
    for (int a = 0; a < 2; a++) {
        double margin = 2 + 0.05 * (high[a] - low[a]);
        out[a] = double_to_int(floor(low[a] - margin), -2, 1 << 29);
        out[a + 2] = double_to_int(ceil(high[a] + margin), -2, 1 << 29);
    }
    return true;
}

/* Where a box cannot be told in a layer's terms, or goes around the globe in it, all of the layer counts. A layer is continued by a post
 * beyond its border, by no more than its posts differ. */
static PostRange range_in_layer(const Heightmap *map, const MapLayer *layer, const int box[4]) {
    int own[4];
    bool told = !layer->around && box_in_layer(map, layer, box, own);
    PostRange range = told ? post_ranges_over(&layer->ranges, &layer->posts, own[0], own[1], own[2], own[3])
                           : post_ranges_over(&layer->ranges, &layer->posts, 0, 0, layer->columns - 1, layer->rows - 1);
    float rise = range.high - range.low;
    if ((!told || !range.whole) && rise > 0) range.low -= rise, range.high += rise;
    return range;
}

/* Of the geoid over a box: its nodes if they are few, else all that was ever added. */
static void undulation_range(const Undulation *u, const int box[4], double *low, double *high) {
    enum { FEW = 16 };
    *low = *high = 0;
    if (!u->nodes) return;
    int x0 = int_clamp(box[0] / u->step, 0, u->columns - 1), x1 = int_clamp(box[2] / u->step + 1, 0, u->columns - 1);
    int y0 = int_clamp(box[1] / u->step, 0, u->rows - 1), y1 = int_clamp(box[3] / u->step + 1, 0, u->rows - 1);
    *low = (double)u->low;
    *high = (double)u->high;
    if (x1 - x0 > FEW || y1 - y0 > FEW) return;
    double least = VTS_INFINITY, most = -VTS_INFINITY;
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            double n = (double)u->nodes[(size_t)y * (size_t)u->columns + (size_t)x];
            least = fmin(least, n);
            most = fmax(most, n);
        }
    if (least <= most) *low = least, *high = most;
}

bool heightmap_range(const Heightmap *map, int column0, int row0, int column1, int row1, double *low, double *high, bool *whole) {
    const int box[4] = {int_min(column0, column1), int_min(row0, row1), int_max(column0, column1), int_max(row0, row1)};
    double add_low, add_high;
    bool covered = false;
    *low = VTS_INFINITY;
    *high = -VTS_INFINITY;
    undulation_range(&map->undulation, box, &add_low, &add_high);
    for (int i = 0; i < map->layer_count; i++) {
        const MapLayer *layer = &map->layers[i];
        bool adds = layer_gets_geoid(layer);
        PostRange range = map->layer_count == 1 ? post_ranges_over(&layer->ranges, &layer->posts, box[0], box[1], box[2], box[3])
                                                : range_in_layer(map, layer, box);
        if (range.low > range.high) continue;
        *low = fmin(*low, (double)range.low + (adds ? add_low : 0));
        *high = fmax(*high, (double)range.high + (adds ? add_high : 0));
        covered |= range.whole;
    }
    if (whole) *whole = covered;
    return *low <= *high;
}
