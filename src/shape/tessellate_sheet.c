/* Sheets over a rectangle: bicubic_patch, parametric, height_field. */
#include "shape/solid_parts.h"
#include "shape/tessellate_rare.h"

enum { FEWEST_CELLS = 8, MOST_CELLS = 512, MOST_FIELD_CELLS = 1000000 };

/* ---- of two parameters ---- */

static Vec3 place_at(const void *data, double u, double v) {
    Vec3 p, normal;
    solid_sheet_at(data, u, v, &p, &normal);
    return p;
}

/* How far the middles of sides and cells stand off the chords between the corners, at the worst. */
static double worst_bulge(const void *data, int n) {
    double worst = 0;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            double u = (i + 0.5) / n, v = (j + 0.5) / n, h = 0.5 / n;
            Vec3 a = place_at(data, u - h, v - h), b = place_at(data, u + h, v + h), middle = place_at(data, u, v);
            Vec3 side = vec3_sub(place_at(data, u, v - h), vec3_lerp(a, place_at(data, u + h, v - h), 0.5));
            Vec3 across = vec3_sub(place_at(data, u - h, v), vec3_lerp(a, place_at(data, u - h, v + h), 0.5));
            double here = double_max(vec3_length(vec3_sub(middle, vec3_lerp(a, b, 0.5))),
                                     double_max(vec3_length(side), vec3_length(across)));
            if (isfinite(here)) worst = double_max(worst, here);
        }
    return worst;
}

/* The bulge shrinks with the square of the cells' size. */
static int cells_for(const RareShape *shape) {
    int n = FEWEST_CELLS;
    if (shape->parts > 0) return int_min(4 * shape->parts, MOST_CELLS);
    while (n < MOST_CELLS) {
        double bulge = worst_bulge(shape->surface.data, n);
        if (bulge <= shape->tolerance) return n;
        n = int_max(n + 1, double_to_int(ceil(n * sqrt(bulge / shape->tolerance)), n, 4 * n));
        if (n > MOST_CELLS / 2 && n < MOST_CELLS) n = int_min(n, MOST_CELLS);
    }
    if (worst_bulge(shape->surface.data, MOST_CELLS / 4) > 16 * shape->tolerance)
        tessellate_doubt(shape->walk, shape->surface.object, "it would need too many triangles");
    return MOST_CELLS;
}

static bool all_finite(const TriangleSoup *soup, const uint32_t v[3]) {
    for (int k = 0; k < 3; k++)
        if (!vec3_is_finite(soup->vertices.items[v[k]].position)) return false;
    return true;
}

static void put_finite(const RareShape *shape, uint32_t a, uint32_t b, uint32_t c) {
    if (all_finite(shape->walk->out, (const uint32_t[]){a, b, c})) soup_triangle(shape->walk->arena, shape->walk->out, a, b, c, false);
}

static double size_of(const TriangleSoup *soup, SoupMark since) {
    Box3 box = box3_empty();
    for (size_t i = since.vertex; i < soup->vertices.count; i++)
        if (vec3_is_finite(soup->vertices.items[i].position)) box = box3_add_point(box, soup->vertices.items[i].position);
    return box3_is_empty(box) ? 0 : vec3_length(vec3_sub(box.max, box.min));
}

/* Vertices that are nowhere are no corner of anything; they lie with the others for the sake of whoever looks at all. */
static void park_unused(TriangleSoup *soup, SoupMark since) {
    for (size_t i = since.vertex; i < soup->vertices.count; i++)
        if (!vec3_is_finite(soup->vertices.items[i].position)) soup->vertices.items[i].position = vec3_splat(0);
}

void tessellate_grid(const RareShape *shape) {
    TriangleSoup *out = shape->walk->out;
    SoupMark since = soup_mark(out);
    int n = cells_for(shape);
    uint32_t first = (uint32_t)out->vertices.count, row = (uint32_t)n + 1;
    for (int j = 0; j <= n; j++)
        for (int i = 0; i <= n; i++) {
            Vec3 p, normal;
            solid_sheet_at(shape->surface.data, (double)i / n, (double)j / n, &p, &normal);
            soup_vertex(shape->walk->arena, out, p, normal, (double)i / n, (double)j / n);
        }
    for (uint32_t j = 0; j < (uint32_t)n; j++)
        for (uint32_t i = 0; i < (uint32_t)n; i++) {
            uint32_t a = first + j * row + i;
            put_finite(shape, a, a + 1, a + row + 1);
            put_finite(shape, a, a + row + 1, a + row);
        }
    double size = size_of(out, since);
    park_unused(out, since);
    tessellate_close(shape, since, 1e-9 * size);
}

/* ---- height_field ---- */

typedef struct FieldMesher {
    const RareShape *shape;
    HeightGrid grid;
} FieldMesher;

static SoupVertex field_vertex(const FieldMesher *f, uint32_t i, uint32_t j) {
    double x = (double)i / (f->grid.columns - 1), z = (double)j / (f->grid.rows - 1);
    Vec3 normal = f->grid.smooth ? solid_height_normal(f->shape->surface.data, i, j) : vec3_splat(0);
    return (SoupVertex){{x, (double)f->grid.heights[(size_t)j * f->grid.columns + i], z}, normal, {x, z}, NULL, NULL};
}

static SoupVertex at_water(const SoupVertex *a, const SoupVertex *b, double level) {
    bool order = a->position.y < b->position.y; /* the same from both sides */
    const SoupVertex *lo = order ? a : b, *hi = order ? b : a;
    double t = (level - lo->position.y) / (hi->position.y - lo->position.y);
    Vec3 p = vec3_lerp(lo->position, hi->position, t);
    p.y = level;
    return (SoupVertex){p, vec3_normalize(vec3_lerp(lo->normal, hi->normal, t)), {p.x, p.z}, NULL, NULL};
}

/* What stands above the water. */
static void push_dry(const FieldMesher *f, const SoupVertex corner[3]) {
    uint32_t v[4];
    int count = 0;
    Arena *arena = f->shape->walk->arena;
    TriangleSoup *out = f->shape->walk->out;
    double level = f->grid.water_level;
    for (int k = 0; k < 3; k++) {
        const SoupVertex *a = &corner[k], *b = &corner[(k + 1) % 3];
        bool dry = a->position.y >= level, next = b->position.y >= level;
        if (dry) {
            *list_push(arena, &out->vertices) = *a;
            v[count++] = (uint32_t)(out->vertices.count - 1);
        }
        if (dry != next) {
            *list_push(arena, &out->vertices) = at_water(a, b, level);
            v[count++] = (uint32_t)(out->vertices.count - 1);
        }
    }
    for (int k = 2; k < count; k++) soup_triangle(arena, out, v[0], v[k - 1], v[k], false);
}

void tessellate_height_field(const RareShape *shape) {
    const FieldMesher f = {shape, solid_height_grid(shape->surface.data)};
    uint64_t cells = (uint64_t)(f.grid.columns - 1) * (f.grid.rows - 1);
    uint32_t stride = 1;
    while (cells / stride / stride > MOST_FIELD_CELLS) stride++;
    if (stride > 1) tessellate_doubt(shape->walk, shape->surface.object, "a height field of more than a million cells is thinned out");
    for (uint32_t j = 0; j + 1 < f.grid.rows; j += stride)
        for (uint32_t i = 0; i + 1 < f.grid.columns; i += stride) {
            uint32_t ni = i + stride < f.grid.columns ? i + stride : f.grid.columns - 1,
                     nj = j + stride < f.grid.rows ? j + stride : f.grid.rows - 1;
            SoupVertex a = field_vertex(&f, i, j), b = field_vertex(&f, ni, j), c = field_vertex(&f, i, nj), d = field_vertex(&f, ni, nj);
            push_dry(&f, (const SoupVertex[]){a, c, b});
            push_dry(&f, (const SoupVertex[]){d, b, c});
        }
}
