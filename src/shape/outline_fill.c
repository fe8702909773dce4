#include "shape/outline_fill.h"

#include "shape/weld.h"

#include <stdlib.h>

/* The plane is cut into slabs at all heights where a chord begins, ends or crosses another. Within a slab chords run side by
 * side from its lower to its upper line, and what lies between two of them is filled or not as a whole. All that meet a line
 * share its points, so that slabs fit each other. */

typedef struct Chord {
    Point2 lo, hi;
    int direction; /* 1 upwards, -1 downwards */
} Chord;

typedef struct ChordList {
    Chord *items;
    size_t count, capacity;
} ChordList;

typedef struct HeightList {
    double *items;
    size_t count, capacity;
} HeightList;

enum { MOST_CHORDS = 256, MOST_CROSSED = 6000, MOST_SIDES = 4000000 };

int outline_chords(const OutlinePiece *piece, double tolerance) {
    /* An eighth of the second derivative is how far a chord over all of it stands off, n² less for n chords. */
    double x = double_max(fabs(2 * piece->x[2]), fabs(2 * piece->x[2] + 6 * piece->x[3]));
    double y = double_max(fabs(2 * piece->y[2]), fabs(2 * piece->y[2] + 6 * piece->y[3]));
    return 1 + double_to_int(sqrt(hypot(x, y) / 8 / tolerance), 0, MOST_CHORDS - 1);
}

static void add_chord(Arena *arena, ChordList *list, Point2 a, Point2 b) {
    if (!isfinite(a.x + a.y + b.x + b.y)) return;
    bool up = a.y <= b.y;
    *list_push(arena, list) = (Chord){up ? a : b, up ? b : a, up ? 1 : -1};
}

static ChordList chords_of(const Outline *outline, double tolerance, Arena *arena) {
    ChordList list = {0};
    for (size_t i = 0; i < outline->count; i++) {
        const OutlinePiece *piece = &outline->items[i];
        int n = outline_chords(piece, tolerance);
        Point2 from = outline_at(piece, 0);
        for (int k = 1; k <= n; k++) {
            Point2 to = outline_at(piece, (double)k / n);
            add_chord(arena, &list, from, to);
            from = to;
        }
    }
    return list;
}

/* ---- heights ---- */

static int by_value(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int by_foot(const void *a, const void *b) {
    double x = ((const Chord *)a)->lo.y, y = ((const Chord *)b)->lo.y;
    return (x > y) - (x < y);
}

/* Sorted, and those nearer than eps to the one before dropped. */
static void sort_out(HeightList *list, double eps) {
    if (!list->count) return;
    qsort(list->items, list->count, sizeof(double), by_value);
    size_t kept = 1;
    for (size_t i = 1; i < list->count; i++)
        if (list->items[i] - list->items[kept - 1] > eps) list->items[kept++] = list->items[i];
    list->count = kept;
}

static double cross2(Point2 a, Point2 b, Point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

static void add_crossing(Arena *arena, HeightList *heights, const Chord *a, const Chord *b) {
    double p = cross2(a->lo, a->hi, b->lo), q = cross2(a->lo, a->hi, b->hi);
    double r = cross2(b->lo, b->hi, a->lo), s = cross2(b->lo, b->hi, a->hi);
    if ((p > 0) == (q > 0) || (r > 0) == (s > 0)) return;
    double t = p / (p - q);
    *list_push(arena, heights) = b->lo.y + (b->hi.y - b->lo.y) * t;
}

/* Chords are sorted by their feet. */
static void add_crossings(Arena *arena, HeightList *heights, const ChordList *chords) {
    for (size_t i = 0; i < chords->count; i++)
        for (size_t k = i + 1; k < chords->count && chords->items[k].lo.y <= chords->items[i].hi.y; k++) {
            const Chord *a = &chords->items[i], *b = &chords->items[k];
            if (double_max(a->lo.x, a->hi.x) >= double_min(b->lo.x, b->hi.x) &&
                double_max(b->lo.x, b->hi.x) >= double_min(a->lo.x, a->hi.x))
                add_crossing(arena, heights, a, b);
        }
}

/* ---- slabs ---- */

typedef struct Side {
    double low, high; /* x at the lower and the upper line */
    int direction;
} Side;

typedef struct SideList {
    Side *items;
    size_t count, capacity;
} SideList;

typedef struct Line {
    HeightList x; /* of the points on it, ascending */
    size_t first; /* number of the first */
} Line;

typedef struct Filler {
    Arena *arena;
    ChordList chords;
    HeightList heights;
    Line *lines;     /* per height */
    SideList *slabs; /* per height but the last */
    double eps;
    bool odd;
    struct {
        uint32_t (*items)[3];
        size_t count, capacity;
    } triangles;
} Filler;

static double x_at(const Chord *chord, double y) {
    if (y <= chord->lo.y) return chord->lo.x;
    if (y >= chord->hi.y) return chord->hi.x;
    return chord->lo.x + (chord->hi.x - chord->lo.x) * ((y - chord->lo.y) / (chord->hi.y - chord->lo.y));
}

static size_t height_index(const Filler *f, double y) {
    size_t lo = 0, hi = f->heights.count;
    while (lo + 1 < hi) {
        size_t middle = (lo + hi) / 2;
        if (f->heights.items[middle] <= y + f->eps / 2)
            lo = middle;
        else
            hi = middle;
    }
    return lo;
}

static bool is_too_intricate(const Filler *f) {
    size_t sides = 0;
    for (size_t i = 0; i < f->chords.count && sides <= MOST_SIDES; i++)
        sides += height_index(f, f->chords.items[i].hi.y) - height_index(f, f->chords.items[i].lo.y);
    return sides > MOST_SIDES;
}

static void enter_chord(Filler *f, const Chord *chord) {
    size_t from = height_index(f, chord->lo.y), to = height_index(f, chord->hi.y);
    for (size_t i = from; i < to; i++) {
        Side side = {x_at(chord, f->heights.items[i]), x_at(chord, f->heights.items[i + 1]), chord->direction};
        if (i == from) side.low = chord->lo.x;
        if (i + 1 == to) side.high = chord->hi.x;
        *list_push(f->arena, &f->slabs[i]) = side;
        *list_push(f->arena, &f->lines[i].x) = side.low;
        *list_push(f->arena, &f->lines[i + 1].x) = side.high;
    }
}

static int by_middle(const void *a, const void *b) {
    const Side *p = a, *q = b;
    double x = p->low + p->high, y = q->low + q->high;
    if (x != y) return (x > y) - (x < y);
    return (p->direction > q->direction) - (p->direction < q->direction);
}

static size_t point_on(const Line *line, double x) {
    size_t lo = 0, hi = line->x.count;
    while (lo + 1 < hi) {
        size_t middle = (lo + hi) / 2;
        if (line->x.items[middle] <= x)
            lo = middle;
        else
            hi = middle;
    }
    if (lo + 1 < line->x.count && line->x.items[lo + 1] - x < x - line->x.items[lo]) lo++;
    return lo;
}

static void put(Filler *f, size_t a, size_t b, size_t c) {
    uint32_t *out = *list_push(f->arena, &f->triangles);
    out[0] = (uint32_t)a, out[1] = (uint32_t)b, out[2] = (uint32_t)c;
}

/* Between two sides: a strip between the points of the lower line and those of the upper. */
static void fill_between(Filler *f, const Line *below, const Line *above, const Side *left, const Side *right) {
    size_t i = point_on(below, left->low), last_i = point_on(below, right->low);
    size_t k = point_on(above, left->high), last_k = point_on(above, right->high);
    while (i < last_i || k < last_k) {
        bool lower = k >= last_k || (i < last_i && below->x.items[i + 1] <= above->x.items[k + 1]);
        if (lower)
            put(f, below->first + i, below->first + i + 1, above->first + k), i++;
        else
            put(f, below->first + i, above->first + k + 1, above->first + k), k++;
    }
}

static void fill_slab(Filler *f, size_t index) {
    SideList *sides = &f->slabs[index];
    int winding = 0;
    if (sides->count) qsort(sides->items, sides->count, sizeof *sides->items, by_middle);
    for (size_t i = 0, left = 0; i < sides->count; i++) {
        bool before = f->odd ? winding & 1 : winding != 0;
        winding += f->odd ? 1 : sides->items[i].direction;
        bool after = f->odd ? winding & 1 : winding != 0;
        if (!before && after) left = i;
        if (before && !after)
            fill_between(f, &f->lines[index], &f->lines[index + 1], &sides->items[left], &sides->items[i]);
    }
}

static size_t number_points(Filler *f) {
    size_t count = 0;
    for (size_t i = 0; i < f->heights.count; i++) {
        sort_out(&f->lines[i].x, f->eps);
        f->lines[i].first = count;
        count += f->lines[i].x.count;
    }
    return count;
}

/* ---- border ---- */

static void find_border(Filler *f, OutlineFill *out) {
    size_t count = f->triangles.count, edges = 0, border = 0;
    WeldEdge *edge = arena_new_array(f->arena, WeldEdge, 3 * count);
    for (uint32_t t = 0; t < count; t++)
        for (uint8_t e = 0; e < 3; e++) {
            uint32_t a = f->triangles.items[t][e], b = f->triangles.items[t][(e + 1) % 3];
            edge[edges++] = (WeldEdge){a < b ? a : b, a < b ? b : a, t, e, a < b};
        }
    weld_sort_edges(edge, edges, out->point_count, f->arena);
    uint32_t(*list)[2] = arena_push_array_(f->arena, edges, sizeof *list);
    for (size_t i = 0; i < edges; i++) {
        bool paired = i + 1 < edges && edge[i + 1].lo == edge[i].lo && edge[i + 1].hi == edge[i].hi;
        if (paired) {
            i++;
            continue;
        }
        list[border][0] = edge[i].forward ? edge[i].lo : edge[i].hi;
        list[border++][1] = edge[i].forward ? edge[i].hi : edge[i].lo;
    }
    out->border = (const uint32_t(*)[2])list;
    out->border_count = border;
}

void outline_fill(const Outline *outline, bool odd, double tolerance, Arena *arena, OutlineFill *out) {
    double size = double_max(outline->max.x - outline->min.x, outline->max.y - outline->min.y);
    Filler f = {.arena = arena, .chords = chords_of(outline, tolerance, arena), .eps = 1e-9 * size, .odd = odd};
    *out = (OutlineFill){0};
    if (f.chords.count < 2 || !isfinite(size) || !(size > 0)) return;
    qsort(f.chords.items, f.chords.count, sizeof *f.chords.items, by_foot);
    for (size_t i = 0; i < f.chords.count; i++) {
        *list_push(arena, &f.heights) = f.chords.items[i].lo.y;
        *list_push(arena, &f.heights) = f.chords.items[i].hi.y;
    }
    if (f.chords.count <= MOST_CROSSED) add_crossings(arena, &f.heights, &f.chords);
    sort_out(&f.heights, f.eps);
    out->too_intricate = is_too_intricate(&f);
    if (out->too_intricate) return;
    f.lines = arena_new_array(arena, Line, f.heights.count);
    f.slabs = arena_new_array(arena, SideList, f.heights.count);
    for (size_t i = 0; i < f.chords.count; i++) enter_chord(&f, &f.chords.items[i]);
    out->point_count = number_points(&f);
    Point2 *points = arena_new_array(arena, Point2, out->point_count);
    for (size_t i = 0, n = 0; i < f.heights.count; i++)
        for (size_t k = 0; k < f.lines[i].x.count; k++) points[n++] = (Point2){f.lines[i].x.items[k], f.heights.items[i]};
    for (size_t i = 0; i + 1 < f.heights.count; i++) fill_slab(&f, i);
    out->points = points;
    out->triangles = (const uint32_t(*)[3])f.triangles.items;
    out->triangle_count = f.triangles.count;
    find_border(&f, out);
}
