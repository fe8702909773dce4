#include "shape/soup_stitch.h"

#include "shape/weld.h"

/* ---- places and edges ---- */

/* Places of the vertices after the mark. */
static uint32_t weld_since(const TriangleSoup *soup, SoupMark since, Arena *arena, uint32_t **place) {
    size_t count = soup->vertices.count - since.vertex;
    Vec3 *points = arena_new_array(arena, Vec3, count);
    for (size_t i = 0; i < count; i++) points[i] = soup->vertices.items[since.vertex + i].position;
    *place = arena_new_array(arena, uint32_t, count);
    return weld_points(points, count, 0, arena, *place);
}

static size_t collect_edges(const TriangleSoup *soup, SoupMark since, const uint32_t *place,
                            WeldEdge *edges) {
    size_t count = 0;
    for (size_t t = since.triangle; t < soup->triangles.count; t++) {
        const uint32_t *v = soup->triangles.items[t].vertex;
        for (uint8_t e = 0; e < 3; e++) {
            uint32_t a = place[v[e] - since.vertex], b = place[v[(e + 1) % 3] - since.vertex];
            if (a == b) continue;
            edges[count++] =
                (WeldEdge){a < b ? a : b, a < b ? b : a, (uint32_t)(t - since.triangle), e, a < b};
        }
    }
    return count;
}

static size_t run_of_edge(const WeldEdge *edges, size_t count, size_t i) {
    size_t end = i + 1;
    while (end < count && edges[end].lo == edges[i].lo && edges[end].hi == edges[i].hi) end++;
    return end;
}

/* ---- what is open ---- */

/* A side that a triangle is missing on: from one place to another. */
typedef struct OpenEdge {
    uint32_t from, to;
} OpenEdge;

typedef struct OpenEdges {
    OpenEdge *items;
    size_t count, capacity;
} OpenEdges;

typedef struct Stitcher {
    Arena *arena;
    TriangleSoup *soup;
    SoupMark since;
    uint32_t *place; /* of each vertex after the mark */
    uint32_t places;
    uint32_t *example; /* a vertex at each place */
    OpenEdges open;
    uint16_t surface; /* what gaps are filled with counts as part of */
} Stitcher;

/* Runs that pass an edge more often one way than the other leave it open; what is missing runs back. */
static void find_open(Stitcher *s) {
    WeldEdge *edges = arena_new_array(s->arena, WeldEdge, 3 * (s->soup->triangles.count - s->since.triangle));
    size_t count = collect_edges(s->soup, s->since, s->place, edges);
    weld_sort_edges(edges, count, s->places, s->arena);
    s->open.count = 0;
    for (size_t i = 0, end; i < count; i = end) {
        int balance = 0;
        end = run_of_edge(edges, count, i);
        for (size_t k = i; k < end; k++) balance += edges[k].forward ? 1 : -1;
        for (; balance > 0; balance--) *list_push(s->arena, &s->open) = (OpenEdge){edges[i].hi, edges[i].lo};
        for (; balance < 0; balance++) *list_push(s->arena, &s->open) = (OpenEdge){edges[i].lo, edges[i].hi};
    }
}

static Vec3 place_position(const Stitcher *s, uint32_t place) {
    return s->soup->vertices.items[s->example[place]].position;
}

static void weld_all(Stitcher *s) {
    s->places = weld_since(s->soup, s->since, s->arena, &s->place);
    s->example = arena_new_array(s->arena, uint32_t, s->places);
    for (size_t i = s->soup->vertices.count; i > s->since.vertex; i--)
        s->example[s->place[i - 1 - s->since.vertex]] = (uint32_t)(i - 1);
}

/* Moves the ends of open edges together. */
static void join_open_ends(Stitcher *s, double reach) {
    uint32_t *joined = arena_new_array(s->arena, uint32_t, s->places), ends = 0;
    uint32_t *ends_place = arena_new_array(s->arena, uint32_t, 2 * s->open.count);
    for (size_t i = 0; i < s->open.count; i++)
        for (int k = 0; k < 2; k++) {
            uint32_t place = k ? s->open.items[i].to : s->open.items[i].from;
            if (joined[place]) continue;
            ends_place[ends++] = place;
            joined[place] = ends;
        }
    Vec3 *points = arena_new_array(s->arena, Vec3, ends);
    uint32_t *cluster = arena_new_array(s->arena, uint32_t, ends);
    for (uint32_t i = 0; i < ends; i++) points[i] = place_position(s, ends_place[i]);
    uint32_t clusters = weld_points(points, ends, reach, s->arena, cluster);
    uint32_t *first = arena_new_array(s->arena, uint32_t, clusters);
    for (uint32_t i = ends; i > 0; i--) first[cluster[i - 1]] = i - 1;
    for (size_t i = s->since.vertex; i < s->soup->vertices.count; i++) {
        uint32_t end = joined[s->place[i - s->since.vertex]];
        if (end) s->soup->vertices.items[i].position = points[first[cluster[end - 1]]];
    }
}

/* Triangles without extent are dropped: two of their corners are one place. */
static void drop_collapsed(Stitcher *s) {
    SoupTriangle *items = s->soup->triangles.items;
    size_t kept = s->since.triangle;
    for (size_t t = s->since.triangle; t < s->soup->triangles.count; t++) {
        const uint32_t *v = items[t].vertex;
        uint32_t a = s->place[v[0] - s->since.vertex], b = s->place[v[1] - s->since.vertex],
                 c = s->place[v[2] - s->since.vertex];
        if (a != b && b != c && c != a) items[kept++] = items[t];
    }
    s->soup->triangles.count = kept;
}

/* ---- filling ---- */

enum { LONGEST_LOOP = 512 };

static double width_of_ear(const Stitcher *s, const uint32_t *loop, size_t count, size_t i) {
    return vec3_length(vec3_sub(place_position(s, loop[(i + count - 1) % count]), place_position(s, loop[(i + 1) % count])));
}

/* The vertices get the normal of the new triangle: it is narrow, and belongs to no surface. */
static void fill_triangle(Stitcher *s, uint32_t a, uint32_t b, uint32_t c) {
    Vec3 p = place_position(s, a), q = place_position(s, b), r = place_position(s, c);
    Vec3 corners[3] = {p, q, r}, normal = vec3_normalize(vec3_cross(vec3_sub(q, p), vec3_sub(r, p)));
    uint32_t v[3];
    for (int k = 0; k < 3; k++) v[k] = soup_vertex(s->arena, s->soup, corners[k], normal, (double)NAN, (double)NAN);
    *list_push(s->arena, &s->soup->triangles) = (SoupTriangle){{v[0], v[1], v[2]}, false, s->surface};
}

static bool is_narrow(const Stitcher *s, const uint32_t *loop, size_t count, double width) {
    if (count > 3) return true; /* each ear is looked at on its own */
    double least = VTS_INFINITY;
    for (size_t i = 0; i < 3; i++) least = double_min(least, width_of_ear(s, loop, count, i));
    return least <= width;
}

/* Cuts off the corner with the shortest base, again and again: of two nearly equal chains, a strip of triangles between them.
 * Gaps wider than `width` stay open. */
static void fill_loop(Stitcher *s, uint32_t *loop, size_t count, double width) {
    if (count < 3 || count > LONGEST_LOOP || !is_narrow(s, loop, count, width)) return;
    while (count > 3) {
        size_t best = 0;
        double least = VTS_INFINITY;
        for (size_t i = 0; i < count; i++) {
            double here = width_of_ear(s, loop, count, i);
            if (here < least) least = here, best = i;
        }
        if (!(least <= width)) return;
        fill_triangle(s, loop[(best + count - 1) % count], loop[best], loop[(best + 1) % count]);
        for (size_t i = best; i + 1 < count; i++) loop[i] = loop[i + 1];
        count--;
    }
    fill_triangle(s, loop[0], loop[1], loop[2]);
}

typedef struct Walk {
    uint32_t *first; /* edges that start at a place: from first[place] to first[place + 1] */
    uint32_t *used;
    uint32_t *next; /* ends of these edges */
    uint32_t *at;   /* where on the path a place stands, + 1 */
} Walk;

static Walk start_walk(const Stitcher *s) {
    Walk walk = {arena_new_array(s->arena, uint32_t, (size_t)s->places + 2), arena_new_array(s->arena, uint32_t, s->places),
                 arena_new_array(s->arena, uint32_t, s->open.count), arena_new_array(s->arena, uint32_t, s->places)};
    for (size_t i = 0; i < s->open.count; i++) walk.first[s->open.items[i].from + 2]++;
    for (uint32_t i = 1; i < s->places + 2; i++) walk.first[i] += walk.first[i - 1];
    for (size_t i = 0; i < s->open.count; i++) walk.next[walk.first[s->open.items[i].from + 1]++] = s->open.items[i].to;
    return walk;
}

/* Of the edges left at a place the one that leads back to where the walk came from: a gap between two chains is narrow. */
static uint32_t take_edge(const Stitcher *s, Walk *walk, uint32_t here, const uint32_t *before) {
    uint32_t *edges = walk->next + walk->first[here] + walk->used[here]++;
    size_t count = walk->first[here + 1] - (size_t)(edges - walk->next), best = 0;
    double least = VTS_INFINITY;
    for (size_t i = 0; before && i < count; i++) {
        double far = vec3_length(vec3_sub(place_position(s, edges[i]), place_position(s, *before)));
        if (far < least) least = far, best = i;
    }
    uint32_t taken = edges[best];
    edges[best] = edges[0];
    edges[0] = taken;
    return taken;
}

/* Each walk along open edges that comes back to where it was has found a gap. */
static void fill_gaps(Stitcher *s, double width) {
    Walk walk = start_walk(s);
    uint32_t *path = arena_new_array(s->arena, uint32_t, s->open.count + 1);
    for (uint32_t start = 0; start < s->places; start++) {
        size_t length = 0;
        path[length++] = start;
        walk.at[start] = 1;
        while (length) {
            uint32_t here = path[length - 1];
            if (walk.first[here] + walk.used[here] == walk.first[here + 1]) { /* a chain that ends, or all is used */
                walk.at[here] = 0;
                length--;
                continue;
            }
            uint32_t next = take_edge(s, &walk, here, length > 1 ? &path[length - 2] : NULL);
            if (!walk.at[next]) {
                path[length++] = next;
                walk.at[next] = (uint32_t)length;
                continue;
            }
            size_t from = walk.at[next] - 1;
            for (size_t i = from + 1; i < length; i++) walk.at[path[i]] = 0;
            uint32_t *loop = arena_copy(s->arena, path + from, (length - from) * sizeof *path);
            fill_loop(s, loop, length - from, width);
            length = from + 1;
        }
    }
}

void soup_stitch(Arena *arena, TriangleSoup *soup, SoupMark since, double reach) {
    Stitcher s = {.arena = arena, .soup = soup, .since = since};
    static const double WIDEST = 8; /* of `reach` */
    weld_all(&s);
    find_open(&s);
    if (s.open.count == 0) return;
    s.surface = soup->triangles.items[since.triangle].surface;
    join_open_ends(&s, reach);
    weld_all(&s);
    drop_collapsed(&s);
    find_open(&s);
    fill_gaps(&s, WIDEST * reach);
}

/* ---- closed parts ---- */

static uint32_t find_root(uint32_t *parent, uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

/* Triangles joined by edges are one part; a part with an odd edge is open. */
void soup_mark_closed(Arena *arena, TriangleSoup *soup, SoupMark since) {
    size_t count = soup->triangles.count - since.triangle;
    ArenaMark mark = arena_mark(arena);
    uint32_t *place, *parent = arena_new_array(arena, uint32_t, count);
    uint32_t places = weld_since(soup, since, arena, &place);
    WeldEdge *edges = arena_new_array(arena, WeldEdge, 3 * count);
    size_t edge_count = collect_edges(soup, since, place, edges);
    bool *open = arena_new_array(arena, bool, count);
    weld_sort_edges(edges, edge_count, places, arena);
    for (uint32_t t = 0; t < count; t++) parent[t] = t;
    for (size_t i = 0, end; i < edge_count; i = end) {
        end = run_of_edge(edges, edge_count, i);
        for (size_t j = i + 1; j < end; j++)
            parent[find_root(parent, edges[j].cell)] = find_root(parent, edges[i].cell);
    }
    for (size_t i = 0, end; i < edge_count; i = end) {
        end = run_of_edge(edges, edge_count, i);
        if ((end - i) % 2) open[find_root(parent, edges[i].cell)] = true;
    }
    for (uint32_t t = 0; t < count; t++)
        soup->triangles.items[since.triangle + t].solid = !open[find_root(parent, t)];
    arena_reset_to(arena, mark);
}
