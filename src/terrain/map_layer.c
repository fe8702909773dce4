#include "terrain/map_layer.h"

#include <stdlib.h>
#include <string.h>

#define TOLERANCE 0.02 /* posts by which files of one lattice may lie apart: their headers are rounded */

static bool same_projection(const ProjectionParameters *a, const ProjectionParameters *b) {
    return a->kind == b->kind && a->axis == b->axis && a->flattening == b->flattening && a->unit == b->unit &&
           a->prime_meridian == b->prime_meridian && a->latitude == b->latitude && a->longitude == b->longitude &&
           a->parallels[0] == b->parallels[0] && a->parallels[1] == b->parallels[1] && a->scale == b->scale &&
           a->false_east == b->false_east && a->false_north == b->false_north;
}

int map_lattice_period(const Georeference *place) {
    double turn = place->period, step = fabs(place->x[1]);
    if (turn == 0 || place->x[2] != 0 || place->y[1] != 0 || step == 0) return 0;
    double posts = round(turn / step);
    return posts >= 2 && posts < MAP_LARGEST_SIDE * 16.0 && fabs(turn / step - posts) < TOLERANCE ? (int)posts : 0;
}

bool map_lattice_offset(const Georeference *a, const Georeference *b, int columns, int rows, double *column, double *row) {
    if (!same_projection(&a->projection.parameters, &b->projection.parameters)) return false;
    double determinant = a->x[1] * a->y[2] - a->x[2] * a->y[1], turn = a->period;
    double dx = b->x[0] - a->x[0], dy = b->y[0] - a->y[0];
    if (turn > 0) dx -= turn * round(dx / turn);
    *column = (dx * a->y[2] - dy * a->x[2]) / determinant;
    *row = (dy * a->x[1] - dx * a->y[1]) / determinant;
    /* where the far corner of b lies, by b and by a */
    double ex = (b->x[1] - a->x[1]) * columns + (b->x[2] - a->x[2]) * rows, ey = (b->y[1] - a->y[1]) * columns + (b->y[2] - a->y[2]) * rows;
    double ec = (ex * a->y[2] - ey * a->x[2]) / determinant, er = (ey * a->x[1] - ex * a->y[1]) / determinant;
    double fx = (b->x[1] - a->x[1]) * columns, fy = (b->y[1] - a->y[1]) * columns;
    double fc = (fx * a->y[2] - fy * a->x[2]) / determinant, fr = (fy * a->x[1] - fx * a->y[1]) / determinant;
    return fmax(fmax(fabs(ec), fabs(er)), fmax(fabs(fc), fabs(fr))) < TOLERANCE;
}

static bool is_whole(double x) { return fabs(x - round(x)) < TOLERANCE && fabs(x) < 1 << 28; }

/* The box of all tiles and one more. */
static void box_with(const MapLayer *layer, const MapTile *more, long box[4]) {
    box[0] = more->column, box[1] = more->row, box[2] = (long)more->column + more->columns, box[3] = (long)more->row + more->rows;
    for (size_t i = 0; i < layer->tiles.count; i++) {
        const MapTile *t = &layer->tiles.items[i];
        box[0] = t->column < box[0] ? t->column : box[0];
        box[1] = t->row < box[1] ? t->row : box[1];
        box[2] = (long)t->column + t->columns > box[2] ? (long)t->column + t->columns : box[2];
        box[3] = (long)t->row + t->rows > box[3] ? (long)t->row + t->rows : box[3];
    }
}

/* Tiles far apart would need a lattice that is mostly empty. */
static bool is_dense(const MapLayer *layer, const MapTile *more) {
    long box[4];
    double sum = (double)more->columns * more->rows;
    for (size_t i = 0; i < layer->tiles.count; i++) sum += (double)layer->tiles.items[i].columns * layer->tiles.items[i].rows;
    box_with(layer, more, box);
    return (double)(box[2] - box[0]) * (double)(box[3] - box[1]) <= 16 * sum + 1e6 && box[2] - box[0] < 1 << 28 && box[3] - box[1] < 1 << 28;
}

bool map_layer_add(MapLayer *layer, const char *path, const Georeference *place, int columns, int rows, Arena *arena) {
    MapTile tile = {.path = path, .place = *place, .columns = columns, .rows = rows};
    if (layer->tiles.count == 0) {
        layer->place = *place;
    } else {
        double column, row;
        if (layer->place.heights != place->heights || !map_lattice_offset(&layer->place, place, columns, rows, &column, &row)) return false;
        if (!is_whole(column) || !is_whole(row)) return false;
        tile.column = (int)round(column);
        tile.row = (int)round(row);
        if (!is_dense(layer, &tile)) return false;
    }
    *list_push(arena, &layer->tiles) = tile;
    return true;
}

static void add_rect(PostRectList *rects, Arena *arena, int left, int top, int right, int bottom) {
    if (left < right && top < bottom) *list_push(arena, rects) = (PostRect){left, top, right - left, bottom - top};
}

/* Adds what of a rectangle lies in none of the others from `from` on: what one of them leaves of it is up to four rectangles. */
static void add_disjoint(PostRectList *rects, size_t from, size_t known, PostRect r, Arena *arena) {
    for (size_t i = from; i < known; i++) {
        PostRect e = rects->items[i];
        int left = int_max(r.column, e.column), right = int_min(r.column + r.columns, e.column + e.columns);
        int top = int_max(r.row, e.row), bottom = int_min(r.row + r.rows, e.row + e.rows);
        if (left >= right || top >= bottom) continue;
        PostRect parts[4] = {{r.column, r.row, r.columns, top - r.row},
                             {r.column, bottom, r.columns, r.row + r.rows - bottom},
                             {r.column, top, left - r.column, bottom - top},
                             {right, top, r.column + r.columns - right, bottom - top}};
        for (int k = 0; k < 4; k++)
            if (parts[k].columns > 0 && parts[k].rows > 0) add_disjoint(rects, i + 1, known, parts[k], arena);
        return;
    }
    add_rect(rects, arena, r.column, r.row, r.column + r.columns, r.row + r.rows);
}

/* Around the globe a tile is itself and its copies a turn away; those parts that lie in the lattice count. */
static void add_tile_rects(MapLayer *layer, const MapTile *tile, Arena *arena) {
    int period = layer->around ? layer->columns - 1 : 0;
    for (int turn = layer->around ? -1 : 0; turn <= (layer->around ? 1 : 0); turn++) {
        int left = int_max(tile->column + turn * period, 0), right = int_min(tile->column + turn * period + tile->columns, layer->columns);
        PostRect rect = {left, tile->row, right - left, tile->rows};
        if (rect.columns > 0) add_disjoint(&layer->rects, 0, layer->rects.count, rect, arena);
    }
}

/* Of a single column or row of pixels both edges. */
static void widen(MapLayer *layer, Arena *arena) {
    Georeference *p = &layer->place;
    bool across = layer->columns < 2, along = layer->rows < 2;
    double column = across ? -0.5 : 0, row = along ? -0.5 : 0;
    p->x[0] += p->x[1] * column + p->x[2] * row;
    p->y[0] += p->y[1] * column + p->y[2] * row;
    if (!across && !along) return;
    layer->columns = int_max(layer->columns, 2);
    layer->rows = int_max(layer->rows, 2);
    layer->rects.count = 0;
    add_rect(&layer->rects, arena, 0, 0, layer->columns, layer->rows);
}

static double spacing_of(const MapLayer *layer) {
    double middle[2] = {(layer->columns - 1) / 2.0, (layer->rows - 1) / 2.0}, most = 0;
    GeoPlace a, b;
    GeodesicLine line;
    for (int k = 0; k < 2; k++)
        if (georeference_to_geo(&layer->place, middle[0], middle[1], &a) &&
            georeference_to_geo(&layer->place, middle[0] + (k == 0 ? 0.5 : 0), middle[1] + (k == 1 ? 0.5 : 0), &b) && geodesic_inverse(a, b, &line))
            most = fmax(most, 2 * line.distance);
    return most;
}

void map_layer_close(MapLayer *layer, Arena *arena) {
    long box[4];
    Georeference *p = &layer->place;
    int period = map_lattice_period(p);
    box_with(layer, &layer->tiles.items[0], box);
    for (size_t i = 0; i < layer->tiles.count; i++) {
        layer->tiles.items[i].column -= (int)box[0];
        layer->tiles.items[i].row -= (int)box[1];
    }
    p->x[0] += p->x[1] * (double)box[0] + p->x[2] * (double)box[1];
    p->y[0] += p->y[1] * (double)box[0] + p->y[2] * (double)box[1];
    layer->around = period > 0 && box[2] - box[0] >= period;
    layer->columns = layer->around ? period + 1 : (int)(box[2] - box[0]);
    layer->rows = (int)(box[3] - box[1]);
    for (size_t i = 0; i < layer->tiles.count; i++) add_tile_rects(layer, &layer->tiles.items[i], arena);
    widen(layer, arena);
    georeference_from_affine(p, &p->projection, (double[3]){p->x[0], p->x[1], p->x[2]}, (double[3]){p->y[0], p->y[1], p->y[2]}, layer->columns,
                             layer->rows, p->area);
    layer->spacing = spacing_of(layer);
    posts_init(&layer->posts, arena, layer->columns, layer->rows);
}

bool map_layer_from_geo(const MapLayer *layer, GeoPlace place, double *column, double *row) {
    if (!georeference_from_geo(&layer->place, place, column, row)) return false;
    int period = layer->around ? layer->columns - 1 : 0;
    if (period) *column -= period * floor(*column / period);
    return true;
}

bool map_layer_height(const MapLayer *layer, double column, double row, double *height) {
    const double slack = 1e-6; /* posts: places on the border come back from their projection with errors of rounding */
    if (!(column >= -slack && row >= -slack && column <= layer->columns - 1 + slack && row <= layer->rows - 1 + slack)) return false;
    int c = int_clamp((int)column, 0, layer->columns - 2), r = int_clamp((int)row, 0, layer->rows - 2);
    double u = double_clamp(column - c, 0, 1), v = double_clamp(row - r, 0, 1), sum = 0;
    for (int k = 0; k < 4; k++) {
        double weight = (k & 1 ? u : 1 - u) * (k & 2 ? v : 1 - v);
        if (weight != 0) sum += weight * (double)posts_get(&layer->posts, c + (k & 1), r + (k >> 1));
    }
    *height = sum;
    return !isnan(sum);
}

static bool is_in_tiles(const MapLayer *layer, int column, int row) {
    return post_is_within(layer->rects.items, layer->rects.count, column, row);
}

/* A post where no tile has one, by going on straight from the two behind it, or level from one; means over the directions along the axes
 * that have any, else over the diagonals. */
static double continued(const MapLayer *layer, int column, int row) {
    static const int steps[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    double sum = 0;
    int count = 0;
    for (int k = 0; k < 8 && !(k == 4 && count > 0); k++) {
        int c = column + steps[k][0], r = row + steps[k][1], c2 = c + steps[k][0], r2 = r + steps[k][1];
        if (!is_in_tiles(layer, c, r)) continue;
        double near = (double)posts_get(&layer->posts, c, r), far = (double)posts_get(&layer->posts, c2, r2);
        sum += isnan(far) ? near : 2 * near - far;
        count++;
    }
    return count ? sum / count : (double)NAN;
}

static double post_or_continued(const MapLayer *layer, int column, int row) {
    return is_in_tiles(layer, column, row) ? (double)posts_get(&layer->posts, column, row) : continued(layer, column, row);
}

/* How much of the square with the half side `reach` about a point is tiles, whose pixels end half a post beyond their posts. */
static double covered_share(const MapLayer *layer, double column, double row, double reach) {
    double sum = 0;
    for (size_t i = 0; i < layer->rects.count; i++) {
        const PostRect *t = &layer->rects.items[i];
        bool whole_turn = layer->around && t->columns >= layer->columns - 1;
        double left = whole_turn ? column - reach : fmax(column - reach, t->column - 0.5);
        double right = whole_turn ? column + reach : fmin(column + reach, t->column + t->columns - 0.5);
        double top = fmax(row - reach, t->row - 0.5), bottom = fmin(row + reach, t->row + t->rows - 0.5);
        if (left < right && top < bottom) sum += (right - left) * (bottom - top);
    }
    return sum / (4 * reach * reach);
}

bool map_layer_blended(const MapLayer *layer, double column, double row, double *height, double *weight) {
    double reach = layer->blend, none = (reach - 0.5) / (2 * reach); /* the share one post beyond a straight border of posts */
    *weight = double_clamp((covered_share(layer, column, row, reach) - none) / (1 - none), 0, 1);
    if (*weight == 0) return false;
    int c = (int)floor(column), r = (int)floor(row);
    double u = column - c, v = row - r, sum = 0;
    for (int k = 0; k < 4; k++) {
        double part = (k & 1 ? u : 1 - u) * (k & 2 ? v : 1 - v);
        if (part != 0) sum += part * post_or_continued(layer, c + (k & 1), r + (k >> 1));
    }
    *height = sum;
    return !isnan(sum);
}
