#include "shape/soup_refine.h"

#include "base/random.h"

#include <string.h>

static const uint32_t UNSPLIT = UINT32_MAX;

/* ---- the edges of one round ---- */

typedef struct EdgeSlot {
    uint64_t key; /* lower vertex << 32 | higher one; 0: free (no edge runs from 0 to 0) */
    uint32_t middle;
} EdgeSlot;

typedef struct EdgeTable {
    EdgeSlot *slots;
    uint64_t mask;
} EdgeTable;

static EdgeTable edge_table(Arena *arena, size_t edges) {
    size_t count = 16;
    while (count < 2 * edges) count *= 2;
    return (EdgeTable){arena_new_array(arena, EdgeSlot, count), count - 1};
}

static EdgeSlot *edge_slot(const EdgeTable *table, uint32_t a, uint32_t b) {
    uint64_t key = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
    uint64_t i = random_mix(key) & table->mask;
    while (table->slots[i].key && table->slots[i].key != key) i = (i + 1) & table->mask;
    if (!table->slots[i].key) table->slots[i] = (EdgeSlot){key, 0};
    return &table->slots[i];
}

SoupVertex soup_between(const SoupVertex *a, const SoupVertex *b, double t) {
    Vec3 mixed = vec3_add(vec3_scale(a->normal, 1 - t), vec3_scale(b->normal, t));
    return (SoupVertex){
        .position = vec3_add(vec3_scale(a->position, 1 - t), vec3_scale(b->position, t)),
        .normal = vec3_normalize(mixed),
        .uv = {a->uv.u * (1 - t) + b->uv.u * t, a->uv.v * (1 - t) + b->uv.v * t},
    };
}

typedef struct Round {
    Arena *arena;
    TriangleSoup *soup;
    const RefineRules *rules;
    EdgeTable edges;
} Round;

static uint32_t middle_of(Round *round, uint32_t a, uint32_t b) {
    EdgeSlot *slot = edge_slot(&round->edges, a, b);
    if (slot->middle) return slot->middle;
    slot->middle = UNSPLIT;
    if (!round->rules->split(round->rules->context, round->soup, a, b)) return UNSPLIT;
    SoupVertex vertex = soup_between(&round->soup->vertices.items[a], &round->soup->vertices.items[b], 0.5);
    slot->middle = (uint32_t)round->soup->vertices.count;
    *list_push(round->arena, &round->soup->vertices) = vertex;
    if (round->rules->place) round->rules->place(round->rules->context, round->soup, slot->middle, a, b);
    return slot->middle;
}

/* ---- triangles ---- */

static double squared_distance(const TriangleSoup *soup, uint32_t a, uint32_t b) {
    return vec3_length_squared(vec3_sub(soup->vertices.items[a].position, soup->vertices.items[b].position));
}

/* The parts of a triangle whose edge k has the middle m[k]; returns their number, 0 for a whole one. */
static int cut_triangle(const TriangleSoup *soup, const uint32_t v[3], const uint32_t m[3], uint32_t out[4][3]) {
    int split = 0, first = 0;
    for (int k = 0; k < 3; k++) split += m[k] != UNSPLIT;
    if (split == 0) return 0;
    /* Turned so that edge 0 is the only one split, or edge 2 the only one that is not. */
    while (split < 3 && !(m[first] != UNSPLIT && (split == 1 || m[(first + 2) % 3] == UNSPLIT))) first++;
    const uint32_t a = v[first], b = v[(first + 1) % 3], c = v[(first + 2) % 3];
    const uint32_t ab = m[first], bc = m[(first + 1) % 3], ca = m[(first + 2) % 3];
    if (split == 1) {
        memcpy(out, (const uint32_t[2][3]){{a, ab, c}, {ab, b, c}}, sizeof(uint32_t[2][3]));
        return 2;
    }
    if (split == 3) {
        memcpy(out, (const uint32_t[4][3]){{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}, sizeof(uint32_t[4][3]));
        return 4;
    }
    bool from_a = squared_distance(soup, a, bc) <= squared_distance(soup, ab, c);
    if (from_a)
        memcpy(out, (const uint32_t[3][3]){{ab, b, bc}, {a, ab, bc}, {a, bc, c}}, sizeof(uint32_t[3][3]));
    else
        memcpy(out, (const uint32_t[3][3]){{ab, b, bc}, {a, ab, c}, {ab, bc, c}}, sizeof(uint32_t[3][3]));
    return 3;
}

typedef struct ActiveList {
    uint32_t *items;
    size_t count, capacity;
} ActiveList;

static void refine_one(Round *round, uint32_t index, ActiveList *next) {
    TriangleSoup *soup = round->soup;
    const SoupTriangle triangle = soup->triangles.items[index];
    uint32_t middle[3], parts[4][3];
    for (int k = 0; k < 3; k++) middle[k] = middle_of(round, triangle.vertex[k], triangle.vertex[(k + 1) % 3]);
    int count = cut_triangle(soup, triangle.vertex, middle, parts);
    for (int k = 0; k < count; k++) {
        SoupTriangle part = {{parts[k][0], parts[k][1], parts[k][2]}, triangle.solid, triangle.surface};
        uint32_t at = k ? (uint32_t)soup->triangles.count : index;
        if (k)
            *list_push(round->arena, &soup->triangles) = part;
        else
            soup->triangles.items[index] = part;
        *list_push(round->arena, next) = at;
    }
}

bool soup_refine(Arena *arena, TriangleSoup *soup, SoupMark since, const RefineRules *rules) {
    enum { MOST_ROUNDS = 64 };
    ActiveList active = {0}, next = {0};
    for (size_t i = since.triangle; i < soup->triangles.count; i++) *list_push(arena, &active) = (uint32_t)i;
    for (int i = 0; i < MOST_ROUNDS && active.count; i++) {
        Round round = {arena, soup, rules, edge_table(arena, 3 * active.count)};
        next.count = 0;
        for (size_t k = 0; k < active.count; k++) {
            if (rules->interrupted && *rules->interrupted) return false;
            refine_one(&round, active.items[k], &next);
        }
        if (soup->triangles.count - since.triangle > rules->most_triangles) return false;
        ActiveList done = active;
        active = next;
        next = done;
    }
    return true;
}
