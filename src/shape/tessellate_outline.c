/* What outlines bound: prism, polygon, text. */
#include "shape/outline_fill.h"
#include "shape/solid_parts.h"
#include "shape/tessellate_rare.h"

/* The plane of an outline at one end of its walls. */
typedef struct OutlinePlane {
    Vec3 origin, a, b, normal;
} OutlinePlane;

static Vec3 on_plane(const OutlinePlane *plane, Point2 p) {
    return vec3_madd(vec3_madd(plane->origin, plane->a, p.x), plane->b, p.y);
}

static uint32_t put_point(const RareShape *shape, Vec3 p, Vec3 normal, Point2 uv) {
    return soup_vertex(shape->walk->arena, shape->walk->out, p, normal, uv.x, uv.y);
}

static void push_fill(const RareShape *shape, const OutlineFill *fill, const OutlinePlane *plane, bool turned) {
    uint32_t first = (uint32_t)shape->walk->out->vertices.count;
    for (size_t i = 0; i < fill->point_count; i++)
        put_point(shape, on_plane(plane, fill->points[i]), plane->normal, fill->points[i]);
    for (size_t t = 0; t < fill->triangle_count; t++) {
        const uint32_t *v = fill->triangles[t];
        soup_triangle(shape->walk->arena, shape->walk->out, first + v[0], first + v[turned ? 2 : 1], first + v[turned ? 1 : 2], true);
    }
}

/* A wall over each edge of the border, from one plane to the other. */
static void push_walls(const RareShape *shape, const OutlineFill *fill, const OutlinePlane *low, const OutlinePlane *high) {
    Arena *arena = shape->walk->arena;
    TriangleSoup *out = shape->walk->out;
    for (size_t i = 0; i < fill->border_count; i++) {
        Point2 p = fill->points[fill->border[i][0]], q = fill->points[fill->border[i][1]];
        Vec3 a = on_plane(low, p), b = on_plane(low, q), c = on_plane(high, q), d = on_plane(high, p);
        Vec3 normal = vec3_normalize(vec3_cross(vec3_sub(c, a), vec3_sub(d, b)));
        uint32_t v[4] = {put_point(shape, a, normal, p), put_point(shape, b, normal, q), put_point(shape, c, normal, q),
                         put_point(shape, d, normal, p)};
        soup_triangle(arena, out, v[0], v[1], v[2], true);
        soup_triangle(arena, out, v[0], v[2], v[3], true);
    }
}

static void fill(const RareShape *shape, const Outline *outline, bool odd, double tolerance, OutlineFill *out) {
    outline_fill(outline, odd, tolerance, shape->walk->arena, out);
    if (out->too_intricate) tessellate_doubt(shape->walk, shape->surface.object, "its outline is too intricate to be filled");
}

/* ---- prism ---- */

/* Between two heights; the outline's plane is x and z, so that what turns from x to z looks down. */
static void push_prism_part(const RareShape *shape, const OutlineFill *area, double low, double high) {
    const Solid *s = shape->surface.object->as.solid;
    double height[2] = {low, high};
    OutlinePlane plane[2];
    for (int k = 0; k < 2; k++) {
        double scale = s->as.prism.conic ? height[k] : 1;
        plane[k] = (OutlinePlane){{0, height[k], 0}, {scale, 0, 0}, {0, 0, scale}, {0, k ? 1 : -1, 0}};
        if (!s->as.prism.open && scale != 0) push_fill(shape, area, &plane[k], k == 1);
    }
    push_walls(shape, area, &plane[1], &plane[0]);
}

void tessellate_prism(const RareShape *shape) {
    const Solid *s = shape->surface.object->as.solid;
    SoupMark since = soup_mark(shape->walk->out);
    double low = s->as.prism.low, high = s->as.prism.high;
    double widest = s->as.prism.conic ? double_max(fabs(low), fabs(high)) : 1;
    Outline outline = {0};
    OutlineFill area;
    outline_add_closed(shape->walk->arena, &outline, s->as.prism.curve, s->as.prism.points, s->as.prism.count);
    fill(shape, &outline, true, shape->tolerance / double_max(widest, 1e-300), &area);
    if (s->as.prism.conic && low < 0 && high > 0) {
        SoupMark middle;
        push_prism_part(shape, &area, low, 0);
        tessellate_close(shape, since, 0);
        middle = soup_mark(shape->walk->out);
        push_prism_part(shape, &area, 0, high);
        tessellate_close(shape, middle, 0);
        return;
    }
    push_prism_part(shape, &area, low, high);
    tessellate_close(shape, since, 0);
}

/* ---- polygon ---- */

void tessellate_polygon(const RareShape *shape) {
    PlanarOutline planar = solid_polygon_outline(shape->surface.data);
    OutlineFill area;
    SoupMark since = soup_mark(shape->walk->out);
    const OutlinePlane plane = {planar.origin, planar.a, planar.b, vec3_cross(planar.a, planar.b)};
    fill(shape, planar.outline, true, shape->tolerance, &area);
    push_fill(shape, &area, &plane, false);
    for (size_t t = since.triangle; t < shape->walk->out->triangles.count; t++) shape->walk->out->triangles.items[t].solid = false;
}

/* ---- text ---- */

void tessellate_text(const RareShape *shape) {
    PlanarOutline letter;
    double thickness;
    for (size_t i = 0; solid_text_letter(shape->surface.data, i, &letter, &thickness); i++) {
        OutlineFill area;
        SoupMark since = soup_mark(shape->walk->out);
        OutlinePlane plane[2];
        if (letter.outline->count == 0) continue;
        fill(shape, letter.outline, false, shape->tolerance, &area);
        for (int k = 0; k < 2; k++) {
            plane[k] = (OutlinePlane){letter.origin, letter.a, letter.b, {0, 0, k ? 1 : -1}};
            plane[k].origin.z += k ? thickness : 0;
            push_fill(shape, &area, &plane[k], k == 0);
        }
        push_walls(shape, &area, &plane[0], &plane[1]);
        tessellate_close(shape, since, 0);
    }
}
