/* Solids that are known by their inside: the surface on a grid, moved onto the exact one and halved until it stays there. */
#include "shape/inside_grid.h"
#include "shape/set_bounds.h"
#include "shape/soup_refine.h"
#include "shape/soup_stitch.h"
#include "shape/tessellate_rare.h"

enum { FEWEST_CELLS = 32, MOST_CELLS = 64, MOST_CELLS_OF_JULIA = 96, MOST_CELLS_IF_THIN = 256, MOST_TRIANGLES = 300000 };
static const double MOST_WORK = 2e8; /* steps of an isosurface's function on one grid */

/* One part in so many of the tolerance for the middles of edges: what lies between them is further off. */
static const double EDGE_SHARE = 0.5;

typedef struct Field {
    const RareShape *shape;
    double cell;     /* of the grid */
    double shortest; /* edges that stay whole: a fractal has no end of detail */
} Field;

/* ---- onto the surface ---- */

static void add_face_normals(TriangleSoup *soup, SoupMark since) {
    for (size_t t = since.triangle; t < soup->triangles.count; t++) {
        const uint32_t *v = soup->triangles.items[t].vertex;
        Vec3 a = soup->vertices.items[v[0]].position;
        Vec3 n = vec3_cross(vec3_sub(soup->vertices.items[v[1]].position, a), vec3_sub(soup->vertices.items[v[2]].position, a));
        for (int k = 0; k < 3; k++) soup->vertices.items[v[k]].normal = vec3_add(soup->vertices.items[v[k]].normal, n);
    }
    for (size_t i = since.vertex; i < soup->vertices.count; i++)
        soup->vertices.items[i].normal = vec3_normalize(soup->vertices.items[i].normal);
}

static void move_vertex(const Field *f, SoupVertex *vertex, double reach) {
    double t;
    Vec3 normal;
    if (!solid_project(&f->shape->surface, vertex->position, vertex->normal, reach, &t, &normal)) return;
    vertex->position = vec3_madd(vertex->position, vertex->normal, t);
    if (vec3_length_squared(normal) > 0) vertex->normal = normal;
}

/* How far the middle of an edge may have to move: a bow over the whole edge. */
static double edge_reach(const Field *f, double length) { return double_min(0.5 * length, f->cell) + f->shape->tolerance; }

static bool split_edge(void *context, const TriangleSoup *soup, uint32_t a, uint32_t b) {
    const Field *f = context;
    const SoupVertex *p = &soup->vertices.items[a], *q = &soup->vertices.items[b];
    double length = vec3_length(vec3_sub(p->position, q->position)), tolerance = f->shape->tolerance, t;
    if (!(length > f->shortest)) return false;
    SoupVertex middle = soup_between(p, q, 0.5);
    if (!solid_project(&f->shape->surface, middle.position, middle.normal, edge_reach(f, length), &t, NULL))
        return length > 4 * tolerance && vec3_length_squared(middle.normal) > 0;
    return fabs(t) > EDGE_SHARE * tolerance;
}

static void place_middle(void *context, TriangleSoup *soup, uint32_t vertex, uint32_t a, uint32_t b) {
    const Field *f = context;
    double length = vec3_length(vec3_sub(soup->vertices.items[a].position, soup->vertices.items[b].position));
    move_vertex(f, &soup->vertices.items[vertex], edge_reach(f, length));
}

/* ---- the grid ---- */

static uint32_t cells_for(const RareShape *shape, Box3 box) {
    bool julia = shape->surface.object->as.solid->kind == SOLID_JULIA; /* all folds, which nothing warns of */
    Vec3 size = vec3_sub(box.max, box.min);
    double longest = double_max(size.x, double_max(size.y, size.z)), wanted = longest / ((julia ? 5 : 10) * shape->tolerance);
    return (uint32_t)double_clamp(wanted, FEWEST_CELLS, julia ? MOST_CELLS_OF_JULIA : MOST_CELLS);
}

static bool may_be_finer(const RareShape *shape, uint32_t cells) {
    const Solid *s = shape->surface.object->as.solid;
    double n = 2.0 * cells;
    if (n > (s->kind == SOLID_ISOSURFACE ? MOST_CELLS : MOST_CELLS_IF_THIN)) return false;
    return s->kind != SOLID_ISOSURFACE || n * n * n * tape_work(s->as.isosurface.function) < MOST_WORK;
}

/* Wide enough that all corners at the border are outside. */
static Box3 widened(Box3 box, uint32_t cells) {
    Vec3 size = vec3_sub(box.max, box.min);
    Vec3 margin = vec3_splat(1.01 * double_max(size.x, double_max(size.y, size.z)) / cells);
    return (Box3){vec3_sub(box.min, margin), vec3_add(box.max, margin)};
}

static bool fill_grid(const RareShape *shape, Box3 box, InsideGrid *grid) {
    Arena *arena = shape->walk->arena;
    uint32_t cells = cells_for(shape, box);
    if (!inside_grid_fill(&shape->surface, widened(box, cells), cells, shape->walk->options->interrupted, arena, grid)) return false;
    while (grid->missed && may_be_finer(shape, cells)) {
        cells *= 2;
        if (!inside_grid_fill(&shape->surface, widened(box, cells), cells, shape->walk->options->interrupted, arena, grid)) return false;
    }
    if (grid->missed) tessellate_doubt(shape->walk, shape->surface.object, "it has parts too thin for the grid that looks for them");
    return true;
}

bool tessellate_field(const RareShape *shape) {
    TessellateWalk *walk = shape->walk;
    Box3 box = shape->surface.ops->bounds(shape->surface.data);
    if (shape->region) box = set_box_common(box, *shape->region);
    if (box3_is_empty(box)) return true;
    if (!set_box_is_finite(box)) return tessellate_refuse(walk, shape->surface.object, "no end of it is known");
    InsideGrid grid;
    SoupMark since = soup_mark(walk->out);
    if (!fill_grid(shape, box, &grid)) return !tessellate_interrupted(walk) || tessellate_give_up(walk); /* or without extent */
    inside_grid_surface(&grid, walk->arena, walk->out);
    Field field = {shape, double_max(grid.step.x, double_max(grid.step.y, grid.step.z)), 0};
    bool julia = shape->surface.object->as.solid->kind == SOLID_JULIA;
    field.shortest = julia ? field.cell : shape->tolerance;
    add_face_normals(walk->out, since);
    for (size_t i = since.vertex; i < walk->out->vertices.count && !tessellate_interrupted(walk); i++)
        move_vertex(&field, &walk->out->vertices.items[i], 2 * field.cell);
    const RefineRules rules = {split_edge, place_middle, &field, MOST_TRIANGLES, walk->options->interrupted};
    if (!soup_refine(walk->arena, walk->out, since, &rules))
        tessellate_doubt(walk, shape->surface.object, "its surface would need too many triangles");
    if (tessellate_interrupted(walk)) return tessellate_give_up(walk);
    soup_mark_closed(walk->arena, walk->out, since);
    return true;
}
