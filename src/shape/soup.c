#include "shape/soup.h"

#include <string.h>

SoupMark soup_mark(const TriangleSoup *soup) {
    return (SoupMark){soup->vertices.count, soup->triangles.count};
}

/* Room that is asked for again and again grows by half at least. */
static size_t reserved(size_t capacity, size_t wanted) { return size_max(wanted, capacity + capacity / 2); }

static void reserve_vertices(Arena *arena, SoupVertexList *v, size_t wanted) {
    size_t capacity = reserved(v->capacity, wanted);
    SoupVertex *items = arena_new_array(arena, SoupVertex, capacity);
    if (v->count) memcpy(items, v->items, v->count * sizeof *items);
    arena_release(arena, v->items, v->capacity * sizeof *items);
    *v = (SoupVertexList){items, v->count, capacity};
}

static void reserve_triangles(Arena *arena, SoupTriangleList *t, size_t wanted) {
    size_t capacity = reserved(t->capacity, wanted);
    SoupTriangle *items = arena_new_array(arena, SoupTriangle, capacity);
    if (t->count) memcpy(items, t->items, t->count * sizeof *items);
    arena_release(arena, t->items, t->capacity * sizeof *items);
    *t = (SoupTriangleList){items, t->count, capacity};
}

void soup_reserve(Arena *arena, TriangleSoup *soup, size_t vertices, size_t triangles) {
    vertices += soup->vertices.count, triangles += soup->triangles.count;
    if (vertices > soup->vertices.capacity) reserve_vertices(arena, &soup->vertices, vertices);
    if (triangles > soup->triangles.capacity) reserve_triangles(arena, &soup->triangles, triangles);
}

void soup_release(Arena *arena, TriangleSoup *soup) {
    arena_release(arena, soup->vertices.items, soup->vertices.capacity * sizeof *soup->vertices.items);
    arena_release(arena, soup->triangles.items, soup->triangles.capacity * sizeof *soup->triangles.items);
    *soup = (TriangleSoup){0};
}

uint32_t soup_vertex(Arena *arena, TriangleSoup *soup, Vec3 position, Vec3 normal, double u, double v) {
    *list_push_sole(arena, &soup->vertices) = (SoupVertex){position, normal, {u, v}, NULL, NULL};
    return (uint32_t)(soup->vertices.count - 1);
}

void soup_triangle(Arena *arena, TriangleSoup *soup, uint32_t a, uint32_t b, uint32_t c, bool solid) {
    if (a == b || b == c || c == a) return;
    *list_push_sole(arena, &soup->triangles) = (SoupTriangle){{a, b, c}, solid, 0};
}

static void grid_cell(Arena *arena, TriangleSoup *soup, const SoupGrid *grid, uint32_t corner, int row) {
    uint32_t across = (uint32_t)grid->columns + 1;
    uint32_t a = corner, b = corner + 1, c = corner + across + 1, d = corner + across;
    if (!(grid->first_pinched && row == 0)) soup_triangle(arena, soup, a, b, c, grid->solid);
    if (!(grid->last_pinched && row == grid->rows - 1)) soup_triangle(arena, soup, a, c, d, grid->solid);
}

void soup_grid(Arena *arena, TriangleSoup *soup, const SoupGrid *grid, SoupGridPoint point,
               const void *context) {
    uint32_t first = (uint32_t)soup->vertices.count;
    for (int i = 0; i <= grid->rows; i++) {
        for (int j = 0; j <= grid->columns; j++) *list_push_sole(arena, &soup->vertices) = point(context, i, j);
    }
    for (int i = 0; i < grid->rows; i++) {
        for (int j = 0; j < grid->columns; j++) {
            grid_cell(arena, soup, grid, first + (uint32_t)(i * (grid->columns + 1) + j), i);
        }
    }
}

static const Vec3 *moved_vector(Arena *arena, const Vec3 *vector, const Transform *transform) {
    if (!vector) return NULL;
    Vec3 moved = transform_vector(transform, *vector);
    return arena_copy(arena, &moved, sizeof moved);
}

static void turn_round(SoupTriangle *triangle) {
    uint32_t first = triangle->vertex[1];
    triangle->vertex[1] = triangle->vertex[2];
    triangle->vertex[2] = first;
}

void soup_transform(Arena *arena, TriangleSoup *soup, SoupMark since, const Transform *transform) {
    /* The cofactor is finite where the inverse is not: a flattened solid keeps its normals. */
    Mat3 cofactor = mat3_cofactor(&transform->linear);
    bool mirrored = mat3_determinant(&transform->linear) < 0;
    for (size_t i = since.vertex; i < soup->vertices.count; i++) {
        SoupVertex *vertex = &soup->vertices.items[i];
        Vec3 normal = vec3_normalize(mat3_apply(&cofactor, vertex->normal));
        vertex->position = transform_point(transform, vertex->position);
        vertex->normal = mirrored ? vec3_negate(normal) : normal;
        vertex->height = moved_vector(arena, vertex->height, transform);
    }
    for (size_t i = since.triangle; mirrored && i < soup->triangles.count; i++)
        turn_round(&soup->triangles.items[i]);
}

/* ---- splitting ---- */

/* (a·i + b·j + c·k)/n. On an edge one weight is zero, and the sum does not depend on the order of the other two: the
 * triangles on both sides compute the same point. */
static Vec3 mixed(Vec3 a, Vec3 b, Vec3 c, double i, double j, double k) {
    double n = i + j + k;
    Vec3 sum = vec3_add(vec3_add(vec3_scale(a, i), vec3_scale(b, j)), vec3_scale(c, k));
    return vec3(sum.x / n, sum.y / n, sum.z / n);
}

static const Vec3 *mixed_given(Arena *arena, const Vec3 *a, const Vec3 *b, const Vec3 *c, const double w[3]) {
    if (!a || !b || !c) return NULL;
    Vec3 vector = mixed(*a, *b, *c, w[0], w[1], w[2]);
    return arena_copy(arena, &vector, sizeof vector);
}

static SoupVertex mixed_vertex(Arena *arena, const SoupVertex *a, const SoupVertex *b, const SoupVertex *c,
                               const double w[3]) {
    Vec3 uv = mixed(vec3(a->uv.u, a->uv.v, 0), vec3(b->uv.u, b->uv.v, 0), vec3(c->uv.u, c->uv.v, 0), w[0],
                    w[1], w[2]);
    return (SoupVertex){
        .position = mixed(a->position, b->position, c->position, w[0], w[1], w[2]),
        .normal = vec3_normalize(mixed(a->normal, b->normal, c->normal, w[0], w[1], w[2])),
        .uv = {uv.x, uv.y},
        .height = mixed_given(arena, a->height, b->height, c->height, w),
        .w = mixed_given(arena, a->w, b->w, c->w, w),
    };
}

/* Row r of the new vertices has n + 1 - r of them. */
static uint32_t split_index(uint32_t first, int n, int row, int column) {
    return first + (uint32_t)(row * (n + 1) - row * (row - 1) / 2 + column);
}

static void split_triangle(Arena *arena, TriangleSoup *soup, SoupTriangle triangle, int n) {
    uint32_t first = (uint32_t)soup->vertices.count;
    SoupVertex corner[3];
    for (int i = 0; i < 3; i++) corner[i] = soup->vertices.items[triangle.vertex[i]];
    for (int row = 0; row <= n; row++) {
        for (int column = 0; column <= n - row; column++) {
            const double weights[3] = {n - row - column, column, row};
            *list_push(arena, &soup->vertices) =
                mixed_vertex(arena, &corner[0], &corner[1], &corner[2], weights);
        }
    }
    for (int row = 0; row < n; row++) {
        for (int column = 0; column < n - row; column++) {
            uint32_t a = split_index(first, n, row, column), b = a + 1,
                     c = split_index(first, n, row + 1, column);
            soup_triangle(arena, soup, a, b, c, triangle.solid);
            if (column < n - row - 1) soup_triangle(arena, soup, b, c + 1, c, triangle.solid);
        }
    }
}

void soup_split(Arena *arena, TriangleSoup *soup, SoupMark since, int n) {
    if (n <= 1) return;
    size_t count = soup->triangles.count - since.triangle;
    SoupTriangle *whole = arena_new_array(arena, SoupTriangle, count);
    for (size_t i = 0; i < count; i++) whole[i] = soup->triangles.items[since.triangle + i];
    soup->triangles.count = since.triangle;
    for (size_t i = 0; i < count; i++) split_triangle(arena, soup, whole[i], n);
}
