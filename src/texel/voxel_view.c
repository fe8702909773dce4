#include "texel/voxel_view.h"

#include "texel/voxel_layer.h"

#include <stdlib.h>
#include <string.h>

/* Triangles that cross more lines and cover more places than this, over and over, are no texel's; nor those that lie so many grids off. */
static const int64_t MOST_WORK = 1 << 26;
static const float FAR_GRIDS = 64;

/* A vertex on the grid of places, whose middles have whole numbers, and its height. */
typedef struct ViewCorner {
    float column, row, height;
} ViewCorner;

enum { BATCH = 32, GROUP = 8 };

/* Triangles on the grid, side by side, so that the compiler computes several at once. Lines of places are the grid's rows, or its columns where a
 * triangle crosses fewer of these; they are cut by GROUPs. */
typedef struct ViewBatch {
    int count;
    float column[3][BATCH], row[3][BATCH], height[3][BATCH]; /* of corners */
    int by_columns[BATCH];
    int first[BATCH], lines[BATCH];
    float line[3][BATCH], place[3][BATCH];   /* of corners, along ascending lines */
    float per_line[3][BATCH];                /* places: of the edges from the first corner to the last, to the middle one, and from that */
    float per_column[BATCH], per_row[BATCH]; /* heights, from the first corner */
    float least[BATCH], most[BATCH];         /* heights of corners */
    int from[GROUP][BATCH], places[GROUP][BATCH]; /* of the lines of a group: the first place, and how many */
    ViewNormal normal[BATCH]; /* where they are wanted */
} ViewBatch;

/* Of lines nearly along a triangle's edge the place may be anything: it is cut off later. */
static int least_not_below(float x) {
    int whole = (int)float_min(float_max(x, -1e9f), 1e9f);
    return whole + ((float)whole < x);
}

static float least_of(float v[3][BATCH], int i) { return float_min(v[0][i], float_min(v[1][i], v[2][i])); }
static float most_of(float v[3][BATCH], int i) { return float_max(v[0][i], float_max(v[1][i], v[2][i])); }

/* ---- setting up ---- */

/* Where the vertices are seen. False if some are too far off. */
static bool project(const LayerView *v, const TexelMesh *mesh, ViewCorner *corners) {
    float per_column = VIEW_GRID / v->size[0], per_row = VIEW_GRID / v->size[1], left = v->origin[0], front = v->origin[1];
    bool known = true;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        Vec3f q = mesh->vertices[i];
        q.x -= v->turned[0], q.z -= v->turned[1]; /* first, so that rounding does not tell in which period the content was made */
        float column = (q.x - q.y * v->slope_x - left) * per_column - v->shift[0], row = (q.z - q.y * v->slope_z - front) * per_row - v->shift[1];
        corners[i] = (ViewCorner){column, row, q.y};
        known &= fabsf(column) < FAR_GRIDS * VIEW_GRID && fabsf(row) < FAR_GRIDS * VIEW_GRID;
    }
    return known;
}

/* Triangles from `from` on, as many as fit; the first again where there are no more. */
static void fill_batch(ViewBatch *b, const TexelMesh *mesh, const ViewCorner *corners, size_t from) {
    b->count = (int)size_min(BATCH, mesh->triangle_count - from);
    for (int i = 0; i < BATCH; i++) {
        const uint32_t *at = mesh->triangles[from + (size_t)(i < b->count ? i : 0)];
        for (int k = 0; k < 3; k++) {
            const ViewCorner *c = &corners[at[k]];
            b->column[k][i] = c->column;
            b->row[k][i] = c->row;
            b->height[k][i] = c->height;
        }
    }
}

static void count_lines(ViewBatch *b) {
    for (int i = 0; i < BATCH; i++) {
        int left = least_not_below(least_of(b->column, i)), right = least_not_below(most_of(b->column, i)),
            front = least_not_below(least_of(b->row, i)), back = least_not_below(most_of(b->row, i));
        int columns = right - left, rows = back - front, by_columns = columns < rows;
        b->by_columns[i] = by_columns;
        b->first[i] = by_columns ? left : front;
        b->lines[i] = by_columns ? columns : rows;
    }
}

static void find_planes(ViewBatch *b) {
    for (int i = 0; i < BATCH; i++) {
        float ac = b->column[1][i] - b->column[0][i], ar = b->row[1][i] - b->row[0][i], ah = b->height[1][i] - b->height[0][i],
              bc = b->column[2][i] - b->column[0][i], br = b->row[2][i] - b->row[0][i], bh = b->height[2][i] - b->height[0][i];
        float per = 1 / (ac * br - ar * bc);
        b->per_column[i] = (ah * br - ar * bh) * per;
        b->per_row[i] = (ac * bh - ah * bc) * per;
        b->least[i] = least_of(b->height, i);
        b->most[i] = most_of(b->height, i);
    }
}

static void lay_along_lines(ViewBatch *b, int corner) {
    for (int i = 0; i < BATCH; i++) {
        float column = b->column[corner][i], row = b->row[corner][i];
        b->line[corner][i] = b->by_columns[i] ? column : row;
        b->place[corner][i] = b->by_columns[i] ? row : column;
    }
}

/* Exchanges two corners where the first is on the higher line. */
static void order_corners(float *restrict line, float *restrict other_line, float *restrict place, float *restrict other_place) {
    float high[BATCH];
    int swap[BATCH];
    for (int i = 0; i < BATCH; i++) {
        swap[i] = line[i] > other_line[i];
        high[i] = float_max(line[i], other_line[i]);
        line[i] = float_min(line[i], other_line[i]);
        other_line[i] = high[i];
    }
    for (int i = 0; i < BATCH; i++) {
        float p = place[i], q = other_place[i];
        place[i] = swap[i] ? q : p;
        other_place[i] = swap[i] ? p : q;
    }
}

static void find_edge(ViewBatch *b, int edge, int from, int to) {
    for (int i = 0; i < BATCH; i++) {
        float run = b->line[to][i] - b->line[from][i];
        b->per_line[edge][i] = (b->place[to][i] - b->place[from][i]) / (run > 0 ? run : INFINITY);
    }
}

static void set_up(ViewBatch *b) {
    count_lines(b);
    find_planes(b);
    for (int k = 0; k < 3; k++) lay_along_lines(b, k);
    order_corners(b->line[0], b->line[1], b->place[0], b->place[1]);
    order_corners(b->line[1], b->line[2], b->place[1], b->place[2]);
    order_corners(b->line[0], b->line[1], b->place[0], b->place[1]);
    find_edge(b, 0, 0, 2);
    find_edge(b, 1, 0, 1);
    find_edge(b, 2, 1, 2);
}

static int8_t of_unit(float x) { return (int8_t)lrintf(127 * float_clamp(x, -1, 1)); }

/* Of triangles of which solid[] tells which are walls, or NULL. On the grid a triangle is height = a + b·column + c·row, and columns and rows are what the view's slopes leave of x and z. */
static void find_normals(const LayerView *v, const bool *solid, ViewBatch *b) {
    float columns = VIEW_GRID / v->size[0], rows = VIEW_GRID / v->size[1];
    for (int i = 0; i < b->count; i++) {
        float x = b->per_column[i] * columns, z = b->per_row[i] * rows;
        Vec3f n = {-x, 1 + x * v->slope_x + z * v->slope_z, -z};
        float length = vec3f_length(n);
        n = length > 0 && length < INFINITY ? vec3f_scale(n, 1 / length) : vec3f(0, 1, 0); /* seen from the edge */
        b->normal[i] = (ViewNormal){of_unit(n.x), of_unit(n.y), of_unit(n.z), solid && solid[i]};
    }
}

/* ---- marking ---- */

/* What is seen, of all places. */
typedef struct ViewSeen {
    float *top;
    ViewNormal *normal; /* or NULL */
} ViewSeen;

/* What of two edges a line meets that are joined at the middle corner. */
static void take_edge(const ViewBatch *b, int number, const float *restrict lower, const float *restrict upper, float *restrict out) {
    for (int i = 0; i < BATCH; i++) {
        float line = (float)(b->first[i] + number), below = lower[i], above = upper[i];
        out[i] = line < b->line[1][i] ? below : above;
    }
}

/* Line `number` of each triangle: the places between its edges. Loops of one kind of step each, that compilers make vectors of. */
static void cut_lines(ViewBatch *b, int number) {
    int *restrict from = b->from[number % GROUP], *restrict places = b->places[number % GROUP];
    float whole[BATCH], lower[BATCH], upper[BATCH], bent[BATCH];
    for (int i = 0; i < BATCH; i++) {
        float line = (float)(b->first[i] + number);
        whole[i] = b->place[0][i] + (line - b->line[0][i]) * b->per_line[0][i];
        lower[i] = b->place[0][i] + (line - b->line[0][i]) * b->per_line[1][i];
        upper[i] = b->place[1][i] + (line - b->line[1][i]) * b->per_line[2][i];
    }
    take_edge(b, number, lower, upper, bent);
    for (int i = 0; i < BATCH; i++) {
        from[i] = least_not_below(float_min(whole[i], bent[i]));
        places[i] = least_not_below(float_max(whole[i], bent[i]));
    }
    for (int i = 0; i < BATCH; i++) {
        int count = places[i] - from[i];
        places[i] = number < b->lines[i] ? count : 0;
    }
}

static int wrapped_place(int i, bool cyclic) { return cyclic ? i & (VIEW_GRID - 1) : i >= 0 && i < VIEW_GRID ? i : -1; }

static bool within(const LayerView *v, int place, float height, int k) {
    float at = v->origin[k] + ((float)place + v->shift[k]) * (v->size[k] / VIEW_GRID) + height * (k ? v->slope_z : v->slope_x);
    return v->cyclic[k] || (at >= 0 && at <= (k ? v->extent.z : v->extent.x));
}

static void mark_place(const LayerView *v, const ViewBatch *b, int i, int line, int place, const ViewSeen *out) {
    int column = b->by_columns[i] ? line : place, row = b->by_columns[i] ? place : line, x = wrapped_place(column, v->cyclic[0]),
        z = wrapped_place(row, v->cyclic[1]);
    if (x < 0 || z < 0) return;
    float height = b->height[0][i] + ((float)column - b->column[0][i]) * b->per_column[i] + ((float)row - b->row[0][i]) * b->per_row[i];
    height = float_clamp(height, b->least[i], b->most[i]);
    if (!v->contained && !(height >= 0 && height <= v->extent.y && within(v, column, height, 0) && within(v, row, height, 1))) return;
    float *seen = &out->top[z * VIEW_GRID + x];
    height = float_max(height, 0);
    if (height > *seen && out->normal) out->normal[z * VIEW_GRID + x] = b->normal[i];
    *seen = float_max(*seen, height);
}

/* A triangle's lines of the group that begins at `number`. Most triangles have few places there: a bit for each, so that there is one loop. */
static int64_t mark_lines(const LayerView *v, const ViewBatch *b, int i, int number, const ViewSeen *out) {
    int all = 0;
    for (int l = 0; l < GROUP; l++) all |= b->places[l][i];
    if (all < GROUP) {
        uint64_t bits = 0;
        for (int l = 0; l < GROUP; l++) bits |= (uint64_t)((1u << b->places[l][i]) - 1) << (GROUP * l);
        for (; bits; bits &= bits - 1) {
            int bit = __builtin_ctzll(bits), l = bit / GROUP;
            mark_place(v, b, i, b->first[i] + number + l, b->from[l][i] + bit % GROUP, out);
        }
        return GROUP;
    }
    int64_t places = 0;
    for (int l = 0; l < GROUP; l++) {
        for (int k = 0; k < b->places[l][i]; k++) mark_place(v, b, i, b->first[i] + number + l, b->from[l][i] + k, out);
        places += b->places[l][i];
    }
    return places;
}

/* Returns how much work that was. */
static int64_t mark_batch(const LayerView *v, ViewBatch *b, const ViewSeen *out) {
    int most = 0;
    int64_t work = b->count;
    for (int i = 0; i < b->count; i++) most = int_max(most, b->lines[i]);
    for (int number = 0; number < most && work < MOST_WORK; number += GROUP) {
        for (int l = 0; l < GROUP; l++)
            if (number + l < most) cut_lines(b, number + l);
            else memset(b->places[l], 0, sizeof b->places[l]);
        for (int i = 0; i < b->count; i++)
            if (number < b->lines[i]) work += mark_lines(v, b, i, number, out);
    }
    return work;
}

double layer_view_hidden(const LayerView *view, const TexelMesh *mesh, float *top, ViewNormal *normal) {
    size_t hidden = 0;
    int64_t work = 0;
    ViewCorner *corners = malloc(mesh->vertex_count * sizeof *corners);
    ViewBatch batch;
    const ViewSeen seen = {top, normal};
    bool known = corners && project(view, mesh, corners);
    for (size_t i = 0; i < VIEW_PLACES; i++) top[i] = -1;
    for (size_t t = 0; known && t < mesh->triangle_count && work < MOST_WORK; t += BATCH) {
        fill_batch(&batch, mesh, corners, t);
        set_up(&batch);
        if (normal) find_normals(view, mesh->solid ? mesh->solid + t : NULL, &batch);
        work += mark_batch(view, &batch, &seen);
    }
    for (size_t i = 0; i < VIEW_PLACES; i++) hidden += top[i] >= 0;
    free(corners);
    return known && work < MOST_WORK ? (double)hidden / VIEW_PLACES : -1;
}
