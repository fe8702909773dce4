#include "terrain/heightmap_parts.h"

enum { MOST_POSTS = 1 << 30, PROBES = 33 };
/* A mosaic of small maps far apart would else be a lattice of mostly nothing: that of a coarser map is taken, or none. */
static const double MOST_POSTS_IN_ALL = 0x1p33;

/* A box in columns and rows. */
typedef struct Box {
    double left, top, right, bottom;
} Box;

/* The place of a probe, `a` and `b` in [0, PROBES), spread over a layer from border to border. */
static bool probe(const MapLayer *layer, int a, int b, GeoPlace *place) {
    return georeference_to_geo(&layer->place, (layer->columns - 1) * (a / (PROBES - 1.0)), (layer->rows - 1) * (b / (PROBES - 1.0)), place);
}

/* The layer's own columns and rows as those of a lattice. False where it does not lie in the lattice's plane. */
static bool layer_box(const MapLayer *layer, const Georeference *lattice, Box *box) {
    double shift_column, shift_row;
    if (map_lattice_offset(lattice, &layer->place, layer->columns, layer->rows, &shift_column, &shift_row)) {
        *box = (Box){shift_column, shift_row, shift_column + layer->columns - 1, shift_row + layer->rows - 1};
        return true;
    }
    *box = (Box){VTS_INFINITY, VTS_INFINITY, -VTS_INFINITY, -VTS_INFINITY};
    for (int b = 0; b < PROBES; b++)
        for (int a = 0; a < PROBES; a++) {
            GeoPlace place;
            double column, row;
            if (!probe(layer, a, b, &place) || !georeference_from_geo(lattice, place, &column, &row)) return false;
            *box = (Box){fmin(box->left, column), fmin(box->top, row), fmax(box->right, column), fmax(box->bottom, row)};
        }
    return true;
}

static bool all_boxes(const Heightmap *map, const Georeference *lattice, Box *all) {
    Box box;
    *all = (Box){VTS_INFINITY, VTS_INFINITY, -VTS_INFINITY, -VTS_INFINITY};
    for (int i = 0; i < map->layer_count; i++) {
        if (!layer_box(&map->layers[i], lattice, &box)) return false;
        *all = (Box){fmin(all->left, box.left), fmin(all->top, box.top), fmax(all->right, box.right), fmax(all->bottom, box.bottom)};
    }
    double columns = all->right - all->left, rows = all->bottom - all->top;
    return columns < MOST_POSTS && rows < MOST_POSTS && columns * rows < MOST_POSTS_IN_ALL;
}

/* Continues the lattice of one layer over all. */
static bool try_lattice(Heightmap *map, const MapLayer *finest) {
    Box all;
    Georeference *p = &map->lattice;
    if (!all_boxes(map, &finest->place, &all)) return false;
    int period = map_lattice_period(&finest->place);
    double left = floor(all.left + 1e-6), top = floor(all.top + 1e-6);
    *p = finest->place;
    p->x[0] += p->x[1] * left + p->x[2] * top;
    p->y[0] += p->y[1] * left + p->y[2] * top;
    map->extent.columns = int_max((int)(ceil(all.right - 1e-6) - left) + 1, 2);
    map->extent.rows = int_max((int)(ceil(all.bottom - 1e-6) - top) + 1, 2);
    map->extent.around = period > 0 && map->extent.columns > period;
    if (map->extent.around) map->extent.columns = period + 1;
    map->period = map->extent.around ? period : 0;
    return georeference_from_affine(p, &p->projection, (double[3]){p->x[0], p->x[1], p->x[2]}, (double[3]){p->y[0], p->y[1], p->y[2]},
                                    map->extent.columns, map->extent.rows, p->area);
}

/* The finest lattice that all layers can be seen through. */
static bool choose_lattice(Heightmap *map) {
    double above = 0;
    for (int tries = 0; tries < map->layer_count; tries++) {
        const MapLayer *next = NULL;
        for (int i = 0; i < map->layer_count; i++)
            if (map->layers[i].spacing > above && (!next || map->layers[i].spacing < next->spacing)) next = &map->layers[i];
        if (!next) return false;
        if (try_lattice(map, next)) return true;
        above = next->spacing;
    }
    return false;
}

/* Whether a pole lies among a layer's posts, or on their border. */
static bool holds_pole(const MapLayer *layer, double latitude) {
    double column, row;
    if (layer->place.projection.parameters.kind == PROJECTION_LONLAT) return false;
    return georeference_from_geo(&layer->place, (GeoPlace){latitude, 0, 0}, &column, &row) && column >= 0 && row >= 0 &&
           column <= layer->columns - 1 && row <= layer->rows - 1;
}

/* Longitudes are collected as they lie about that of the first layer's middle. */
static void find_box(const Heightmap *map, HeightmapExtent *e) {
    GeoPlace middle = {0}, place;
    const MapLayer *first = &map->layers[0];
    double west = VTS_INFINITY, east = -VTS_INFINITY;
    georeference_to_geo(&first->place, (first->columns - 1) / 2.0, (first->rows - 1) / 2.0, &middle);
    e->south = VTS_INFINITY;
    e->north = -VTS_INFINITY;
    bool whole_turn = e->around;
    for (int i = 0; i < map->layer_count; i++) {
        bool poles[2] = {holds_pole(&map->layers[i], -90), holds_pole(&map->layers[i], 90)};
        whole_turn |= poles[0] || poles[1] || map->layers[i].around;
        if (poles[0]) e->south = -90;
        if (poles[1]) e->north = 90;
        for (int k = 0; k < PROBES * PROBES; k++) {
            if (!probe(&map->layers[i], k % PROBES, k / PROBES, &place)) continue;
            double along = place.longitude - middle.longitude;
            along -= 360 * floor((along + 180) / 360);
            if (map->layers[i].place.projection.parameters.kind == PROJECTION_LONLAT && fabs(place.longitude - middle.longitude) <= 180)
                along = place.longitude - middle.longitude; /* 180 itself belongs to the side that the map says */
            west = fmin(west, along);
            east = fmax(east, along);
            e->south = fmin(e->south, place.latitude);
            e->north = fmax(e->north, place.latitude);
        }
    }
    e->west = whole_turn ? -180 : middle.longitude + west;
    e->east = whole_turn ? 180 : middle.longitude + east;
    double turns = 360 * floor((e->west + 180) / 360);
    e->west -= turns;
    e->east -= turns;
}

static double spacing_at(const Georeference *lattice, double column, double row, double dc, double dr) {
    GeoPlace a, b;
    GeodesicLine line;
    bool good = georeference_to_geo(lattice, column - dc / 4, row - dr / 4, &a) && georeference_to_geo(lattice, column + dc / 4, row + dr / 4, &b) &&
                geodesic_inverse(a, b, &line);
    return good ? 2 * line.distance : 0;
}

bool heightmap_make_lattice(Heightmap *map, Arena *arena, StrBuf *error) {
    HeightmapExtent *e = &map->extent;
    StrBuf system = {0};
    if (!choose_lattice(map)) return map_fail(error, "the maps lie too far from each other, or too oddly, to be one");
    e->column_spacing = spacing_at(&map->lattice, (e->columns - 1) / 2.0, (e->rows - 1) / 2.0, 1, 0);
    e->row_spacing = spacing_at(&map->lattice, (e->columns - 1) / 2.0, (e->rows - 1) / 2.0, 0, 1);
    find_box(map, e);
    projection_describe(&map->lattice.projection, &system);
    e->system = arena_strdup(arena, system.data ? system.data : "");
    strbuf_free(&system);
    return true;
}

/* So that a kilometre, and not many nodes, lies between two of them: a geoid bends over tens of kilometres. */
static int node_step(const HeightmapExtent *e) {
    enum { MOST_NODES = 1 << 21 };
    double spacing = fmax(fmax(e->column_spacing, e->row_spacing), 1e-3);
    int step = int_clamp((int)fmin(1000 / spacing, 1 << 20), 1, 1 << 20);
    while (((double)e->columns / step + 2) * ((double)e->rows / step + 2) > MOST_NODES) step += step / 8 + 1;
    return step;
}

bool heightmap_add_geoid(Heightmap *map, const HeightmapOptions *options, Arena *arena, StrBuf *error) {
    Geoid geoid;
    Undulation *u = &map->undulation;
    if (!options->geoid) return true;
    if (!geoid_load(&geoid, options->geoid, options->folders, options->folder_count, arena, error)) return false;
    u->step = node_step(&map->extent);
    u->columns = (map->extent.columns - 1) / u->step + 2;
    u->rows = (map->extent.rows - 1) / u->step + 2;
    float *nodes = arena_new_array(arena, float, (size_t)u->columns * (size_t)u->rows);
    u->low = INFINITY;
    u->high = -INFINITY;
    for (int r = 0; r < u->rows; r++)
        for (int c = 0; c < u->columns; c++) {
            GeoPlace place;
            double n = (double)NAN;
            if (georeference_to_geo(&map->lattice, (double)c * u->step, (double)r * u->step, &place))
                geoid_undulation(&geoid, double_clamp(place.latitude, -90, 90), place.longitude, &n);
            nodes[(size_t)r * (size_t)u->columns + (size_t)c] = (float)n;
            u->low = isnan(n) ? u->low : float_min(u->low, (float)n);
            u->high = isnan(n) ? u->high : float_max(u->high, (float)n);
        }
    u->nodes = nodes;
    map->extent.geoid = geoid.path;
    hash_add_hash(&map->hash, geoid.hash);
    return u->low <= u->high || map_fail(error, "the geoid '%s' does not reach to where the map lies", geoid.path);
}
