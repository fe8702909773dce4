/* A tile's rows into the blocks of its layer. */
#include "terrain/map_layer.h"

#include <stdlib.h>

/* Rows of a tile as heights. */
typedef struct Band {
    const float *heights;
    int columns;
    int row, rows; /* the first, counted in the layer; how many */
    PostScale scale;
} Band;

/* Where a tile's first column stands in the layer: several times for what is seen twice, the closing column of a globe and the two edges of
 * a single pixel. */
static int shifts_of(const MapLayer *layer, const MapTile *tile, int shifts[3]) {
    int count = 0, period = layer->columns - 1;
    bool single = tile->columns == 1 && layer->columns == 2 && !layer->around && layer->tiles.count == 1;
    for (int turn = layer->around ? -1 : 0; turn <= (layer->around || single ? 1 : 0); turn++) {
        int shift = tile->column + turn * (layer->around ? period : 1);
        if (shift < layer->columns && shift + tile->columns > 0) shifts[count++] = shift;
    }
    return count;
}

/* Heights of the band where the block has none. Returns whether there were any. */
static bool overlay(const Band *band, int shift, const Posts *posts, int block_column, int block_row, float block[POST_BLOCK_COUNT]) {
    int left = int_max(block_column * POST_BLOCK, shift), right = int_min(int_min((block_column + 1) * POST_BLOCK, shift + band->columns), posts->columns);
    int top = int_max(block_row * POST_BLOCK, band->row), bottom = int_min(int_min((block_row + 1) * POST_BLOCK, band->row + band->rows), posts->rows);
    bool any = false;
    for (int r = top; r < bottom; r++)
        for (int c = left; c < right; c++) {
            float *at = &block[(r - block_row * POST_BLOCK) * POST_BLOCK + (c - block_column * POST_BLOCK)];
            float height = band->heights[(size_t)(r - band->row) * (size_t)band->columns + (size_t)(c - shift)];
            if (!isnan(*at) || isnan(height)) continue;
            *at = height;
            any = true;
        }
    return any;
}

static void store_band(MapLayer *layer, const Band *band, const int *shifts, int shift_count, Arena *arena) {
    float block[POST_BLOCK_COUNT];
    int block_row = band->row / POST_BLOCK;
    for (int x = 0; x < layer->posts.block_columns; x++) {
        bool reached = false, any = false;
        for (int k = 0; k < shift_count; k++) reached |= shifts[k] < (x + 1) * POST_BLOCK && shifts[k] + band->columns > x * POST_BLOCK;
        if (!reached) continue;
        posts_load_block(&layer->posts, x, block_row, block);
        for (int k = 0; k < shift_count; k++) any |= overlay(band, shifts[k], &layer->posts, x, block_row, block);
        if (any) posts_store_block(&layer->posts, arena, x, block_row, block, &band->scale);
    }
}

static void to_heights(float *samples, size_t count, const PostScale *scale, MapLayer *layer) {
    layer->post_count += count;
    for (size_t i = 0; i < count; i++) {
        float height = post_scale_apply(scale, (double)samples[i]);
        samples[i] = isfinite(height) ? height : NAN;
        layer->void_count += isfinite(height) ? 0 : 1;
    }
}

/* `samples` has room for POST_BLOCK rows. */
static bool read_bands(MapLayer *layer, const MapTile *tile, MapFile *file, const double *nodata, float *samples, Arena *arena, Hash128 *hash, StrBuf *error) {
    int shifts[3], shift_count = shifts_of(layer, tile, shifts);
    bool single = tile->rows == 1 && layer->rows == 2 && layer->tiles.count == 1;
    PostScale scale = {tile->place.scale, tile->place.offset, tile->place.unit};
    for (int row = tile->row, end = tile->row + tile->rows; row < end;) {
        int rows = int_min((row / POST_BLOCK + 1) * POST_BLOCK, end) - row;
        size_t count = (size_t)rows * (size_t)tile->columns;
        if (!map_file_read(file, rows, nodata, samples, error)) return false;
        to_heights(samples, count, &scale, layer);
        hash_add(hash, samples, count * sizeof *samples);
        if (!posts_have_room(arena, (size_t)layer->posts.block_columns * POST_BLOCK_COUNT * sizeof *samples)) {
            map_file_close(file);
            free(samples);
            memory_budget_fail(arena->budget);
        }
        Band band = {samples, tile->columns, row, rows, scale};
        store_band(layer, &band, shifts, shift_count, arena);
        if (single) {
            band.row++;
            store_band(layer, &band, shifts, shift_count, arena);
        }
        row += rows;
    }
    return true;
}

bool map_layer_read(MapLayer *layer, const MapTile *tile, const double *nodata, Arena *arena, Hash128 *hash, StrBuf *error) {
    MapFile file;
    if (!map_file_open(&file, tile->path, error)) return false;
    float *samples = malloc((size_t)POST_BLOCK * (size_t)file.columns * sizeof *samples);
    bool same = file.columns == tile->columns && file.rows == tile->rows;
    bool good = samples && same && read_bands(layer, tile, &file, nodata, samples, arena, hash, error);
    if (!samples || !same) map_fail(error, samples ? "it changed while it was read" : "not enough memory");
    free(samples);
    map_file_close(&file);
    return good;
}
