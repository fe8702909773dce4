#include "terrain/heightmap_parts.h"

#include <string.h>

enum { MOST_FILES = 4096 };

typedef struct Opening {
    Heightmap *map;
    const HeightmapOptions *options;
    Arena *arena;
    DiagList *diags;
    Span span;
} Opening;

/* Takes the text. */
static bool fail_file(const Opening *o, const char *path, StrBuf *why) {
    diag_error(o->diags, o->span, "cannot use the map '%s': %s", path, why->data ? why->data : "it cannot be read");
    strbuf_free(why);
    return false;
}

static const char *copy_text(Arena *arena, StrBuf *text) {
    const char *copy = text->size ? arena_strdup(arena, text->data) : NULL;
    strbuf_free(text);
    return copy;
}

static bool place_by_scene(const HeightmapPlace *wish, Georeference *place, int columns, int rows, StrBuf *error) {
    return georeference_from_corners(place, &wish->projection, wish->west_south, wish->east_north, columns, rows, wish->area) ||
           map_fail(error, "its georeference has no extent");
}

/* Size and place of a file. */
static bool read_facts(const Opening *o, const char *path, HeightmapFile *facts) {
    MapFile file;
    StrBuf why = {0}, system = {0};
    if (!map_file_open(&file, path, &why)) return fail_file(o, path, &why);
    *facts = (HeightmapFile){.path = arena_strdup(o->arena, path), .format = file.format, .samples = file.samples,
                             .columns = file.columns, .rows = file.rows, .place = file.place};
    bool placed = o->options->place ? place_by_scene(o->options->place, &facts->place, file.columns, file.rows, &why) : file.place.placed;
    if (!placed && !why.size) strbuf_adds(&why, file.misplaced.data ? file.misplaced.data : "nothing says where it lies");
    if (placed && file.misplaced.size && !o->options->place) {
        facts->remark = arena_strdup(o->arena, file.misplaced.data);
        diag_warning(o->diags, o->span, "the map '%s': %s", path, facts->remark);
    }
    map_file_close(&file);
    if (!placed) return fail_file(o, path, &why);
    strbuf_free(&why);
    projection_describe(&facts->place.projection, &system);
    facts->system = copy_text(o->arena, &system);
    return true;
}

/* Into the first layer whose lattice it shares, or one of its own. */
static void add_to_layers(const Opening *o, const HeightmapFile *file) {
    Heightmap *map = o->map;
    for (int i = 0; i <= map->layer_count; i++)
        if (map_layer_add(&map->layers[i], file->path, &file->place, file->columns, file->rows, o->arena)) {
            if (i == map->layer_count) map->layer_count++;
            return;
        }
}

static void hash_place(Hash128 *hash, const Georeference *p) {
    const ProjectionParameters *q = &p->projection.parameters;
    const double numbers[] = {p->x[0], p->x[1], p->x[2], p->y[0], p->y[1], p->y[2], (double)q->kind, q->axis, q->flattening, q->unit,
                              q->prime_meridian, q->latitude, q->longitude, q->parallels[0], q->parallels[1], q->scale, q->false_east, q->false_north,
                              (double)p->heights};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(numbers); i++) hash_add_double(hash, numbers[i]);
}

static bool read_layer(const Opening *o, MapLayer *layer) {
    StrBuf why = {0};
    hash_place(&o->map->hash, &layer->place);
    for (size_t i = 0; i < layer->tiles.count; i++) {
        const MapTile *tile = &layer->tiles.items[i];
        const double *nodata = o->options->has_nodata ? &o->options->nodata : NULL;
        hash_add_u64(&o->map->hash, (uint64_t)(uint32_t)tile->column << 32 | (uint32_t)tile->row);
        hash_add_u64(&o->map->hash, (uint64_t)(uint32_t)tile->columns << 32 | (uint32_t)tile->rows);
        if (!map_layer_read(layer, tile, nodata, o->arena, &o->map->hash, &why)) return fail_file(o, tile->path, &why);
    }
    return true;
}

/* What the layers below have at a place. */
static bool height_below(const Heightmap *map, int layer, GeoPlace place, double *height) {
    for (int i = layer + 1; i < map->layer_count; i++) {
        double column, row;
        if (map_layer_from_geo(&map->layers[i], place, &column, &row) && map_layer_height(&map->layers[i], column, row, height)) return true;
    }
    return false;
}

/* Voids of an upper map take the heights of the maps below, before anything is invented. */
static void patch_block(Heightmap *map, int k, int x, int y, Arena *arena) {
    static const PostScale metres = {1, 0, 1};
    MapLayer *layer = &map->layers[k];
    float block[POST_BLOCK_COUNT];
    bool any = false;
    posts_load_block(&layer->posts, x, y, block);
    for (int i = 0; i < POST_BLOCK_COUNT; i++) {
        int column = x * POST_BLOCK + i % POST_BLOCK, row = y * POST_BLOCK + i / POST_BLOCK;
        GeoPlace place;
        double height;
        if (!isnan(block[i]) || !post_is_within(layer->rects.items, layer->rects.count, column, row)) continue;
        if (!georeference_to_geo(&layer->place, column, row, &place) || !height_below(map, k, place, &height)) continue;
        block[i] = (float)height;
        any = true;
    }
    if (any) posts_store_block(&layer->posts, arena, x, y, block, &metres);
}

static void patch_layer(Heightmap *map, int k, Arena *arena) {
    const Posts *posts = &map->layers[k].posts;
    if (map->layers[k].void_count == 0) return;
    for (int y = 0; y < posts->block_rows; y++)
        for (int x = 0; x < posts->block_columns; x++)
            if (posts_voids_in(posts, x, y) > 0) patch_block(map, k, x, y, arena);
}

/* Some posts of the coarsest map, for a gentle step to it; not so many that nothing is left of this one. */
static void set_blend(Heightmap *map, MapLayer *layer) {
    double coarsest = 0;
    for (int i = 0; i < map->layer_count; i++) coarsest = fmax(coarsest, map->layers[i].spacing);
    int side = MAP_LARGEST_SIDE;
    for (size_t i = 0; i < layer->tiles.count; i++) side = int_min(side, int_min(layer->tiles.items[i].columns, layer->tiles.items[i].rows));
    double wish = layer->spacing > 0 ? 2 * coarsest / layer->spacing : 2;
    layer->blend = fmax(fmin(fmax(wish, 2), side / 4.0), 1);
}

static void finish_layers(const Opening *o) {
    Heightmap *map = o->map;
    for (int i = 0; i + 1 < map->layer_count; i++) patch_layer(map, i, o->arena);
    for (int i = 0; i < map->layer_count; i++) {
        MapLayer *layer = &map->layers[i];
        if (o->options->voids == HEIGHTMAP_FILL && layer->void_count > 0)
            post_fill(&layer->posts, layer->rects.items, layer->rects.count, o->arena);
        post_ranges_make(&layer->ranges, &layer->posts, o->arena);
        set_blend(map, layer);
    }
}

static void find_facts(Heightmap *map) {
    HeightmapExtent *e = &map->extent;
    size_t posts = 0, voids = 0;
    e->lowest = VTS_INFINITY;
    e->highest = -VTS_INFINITY;
    for (int i = 0; i < map->layer_count; i++) {
        const PostRanges *ranges = &map->layers[i].ranges;
        PostRange all = ranges->cells[ranges->level_count - 1][0];
        e->lowest = fmin(e->lowest, (double)all.low);
        e->highest = fmax(e->highest, (double)all.high);
        posts += map->layers[i].post_count;
        voids += map->layers[i].void_count;
    }
    e->nodata_share = posts ? (double)voids / (double)posts : 0;
}

static bool open_all(const Opening *o, const char *const *paths, size_t count) {
    Heightmap *map = o->map;
    StrBuf why = {0};
    HeightmapFile *files = arena_new_array(o->arena, HeightmapFile, count);
    map->layers = arena_new_array(o->arena, MapLayer, count + 1);
    for (size_t i = 0; i < count; i++) {
        if (!read_facts(o, paths[i], &files[i])) return false;
        add_to_layers(o, &files[i]);
    }
    map->extent.files = files;
    map->extent.file_count = count;
    for (int i = 0; i < map->layer_count; i++) map_layer_close(&map->layers[i], o->arena);
    if (!heightmap_make_lattice(map, o->arena, &why)) return fail_file(o, paths[0], &why);
    for (int i = 0; i < map->layer_count; i++)
        if (!read_layer(o, &map->layers[i])) return false;
    finish_layers(o);
    find_facts(map);
    if (map->extent.lowest > map->extent.highest) {
        strbuf_adds(&why, "none of its posts has a height");
        return fail_file(o, paths[0], &why);
    }
    if (!heightmap_add_geoid(map, o->options, o->arena, &why)) return fail_file(o, paths[0], &why);
    if (map->undulation.nodes) {
        map->extent.lowest += (double)map->undulation.low;
        map->extent.highest += (double)map->undulation.high;
    }
    return true;
}

const Heightmap *heightmap_open(const char *const *paths, size_t count, const HeightmapOptions *options, Arena *arena, DiagList *diags, Span span) {
    Opening o = {arena_new(arena, Heightmap), options, arena, diags, span};
    o.map->hash = hash_begin(0x6D6170);
    hash_add_u64(&o.map->hash, (uint64_t)options->voids << 1 | (options->has_nodata ? 1 : 0));
    if (options->has_nodata) hash_add_double(&o.map->hash, options->nodata);
    if (count < 1 || count > MOST_FILES) {
        diag_error(diags, span, "a heightmap is made of 1 to %d files", MOST_FILES);
        return NULL;
    }
    if (options->place && count > 1) {
        diag_error(diags, span, "'georeference' places one map: of %zu files each must say its own place", count);
        return NULL;
    }
    return open_all(&o, paths, count) ? o.map : NULL;
}
