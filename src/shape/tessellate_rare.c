#include "shape/tessellate_rare.h"

#include "shape/soup_stitch.h"
#include "shape/weld.h"

static void snap_points(const RareShape *shape, SoupMark since, double tolerance) {
    TriangleSoup *soup = shape->walk->out;
    Arena *arena = shape->walk->arena;
    size_t count = soup->vertices.count - since.vertex;
    Vec3 *points = arena_new_array(arena, Vec3, count);
    uint32_t *place = arena_new_array(arena, uint32_t, count);
    for (size_t i = 0; i < count; i++) points[i] = soup->vertices.items[since.vertex + i].position;
    uint32_t places = weld_points(points, count, tolerance, arena, place);
    uint32_t *first = arena_new_array(arena, uint32_t, places);
    for (size_t i = count; i > 0; i--) first[place[i - 1]] = (uint32_t)(i - 1);
    for (size_t i = 0; i < count; i++) soup->vertices.items[since.vertex + i].position = points[first[place[i]]];
}

static double signed_volume(const TriangleSoup *soup, SoupMark since, Vec3 middle) {
    double sum = 0;
    for (size_t t = since.triangle; t < soup->triangles.count; t++) {
        const uint32_t *v = soup->triangles.items[t].vertex;
        Vec3 a = vec3_sub(soup->vertices.items[v[0]].position, middle), b = vec3_sub(soup->vertices.items[v[1]].position, middle),
             c = vec3_sub(soup->vertices.items[v[2]].position, middle);
        sum += vec3_dot(a, vec3_cross(b, c));
    }
    return sum;
}

static void turn_inside_out(TriangleSoup *soup, SoupMark since) {
    for (size_t t = since.triangle; t < soup->triangles.count; t++) {
        uint32_t *v = soup->triangles.items[t].vertex, second = v[1];
        v[1] = v[2];
        v[2] = second;
    }
    for (size_t i = since.vertex; i < soup->vertices.count; i++)
        soup->vertices.items[i].normal = vec3_negate(soup->vertices.items[i].normal);
}

void tessellate_close(const RareShape *shape, SoupMark since, double weld) {
    TriangleSoup *soup = shape->walk->out;
    if (soup->triangles.count == since.triangle) return;
    if (weld > 0) snap_points(shape, since, weld);
    soup_mark_closed(shape->walk->arena, soup, since);
    if (signed_volume(soup, since, soup->vertices.items[since.vertex].position) < 0) turn_inside_out(soup, since);
}

bool tessellate_rare(const RareShape *shape) {
    switch (shape->surface.object->as.solid->kind) {
    case SOLID_LATHE: tessellate_lathe(shape); return true;
    case SOLID_SOR: tessellate_sor(shape); return true;
    case SOLID_PRISM: tessellate_prism(shape); return true;
    case SOLID_POLYGON: tessellate_polygon(shape); return true;
    case SOLID_TEXT: tessellate_text(shape); return true;
    case SOLID_PATCH:
    case SOLID_PARAMETRIC: tessellate_grid(shape); return true;
    case SOLID_HEIGHT_FIELD: tessellate_height_field(shape); return true;
    case SOLID_POLYNOMIAL:
    case SOLID_QUADRIC:
    case SOLID_SUPERELLIPSOID:
    case SOLID_BLOB:
    case SOLID_SWEEP:
    case SOLID_JULIA:
    case SOLID_OVUS:
    case SOLID_ISOSURFACE: return tessellate_field(shape);
    }
    return true;
}
