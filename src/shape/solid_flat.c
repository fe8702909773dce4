/* Solids and sheets bounded by an outline in a plane: prism, polygon. */
#include "shape/outline.h"
#include "shape/solid.h"
#include "shape/solid_parts.h"

static const uint32_t PART_CAP = UINT32_MAX;

/* ---- prism: the outline in x and z, walls along y, or (conic) towards the origin ---- */

typedef struct Prism {
    Outline outline;
    double low, high;
    bool conic, open;
} Prism;

static const void *prism_prepare(const Object *object, Arena *arena) {
    const Solid *s = object->as.solid;
    Prism *prism = arena_new(arena, Prism);
    *prism = (Prism){.low = s->as.prism.low,
                     .high = s->as.prism.high,
                     .conic = s->as.prism.conic,
                     .open = s->as.prism.open};
    outline_add_closed(arena, &prism->outline, s->as.prism.curve, s->as.prism.points, s->as.prism.count);
    return prism->outline.count ? prism : NULL;
}

/* The point of the outline's plane that belongs to a point of space. */
static Point2 prism_place(const Prism *prism, Vec3 p) {
    double scale = prism->conic ? 1 / p.y : 1;
    return (Point2){p.x * scale, p.z * scale};
}

static void prism_caps(const Prism *prism, const Ray *ray, SolidSink *sink) {
    if (prism->open || ray->direction.y == 0) return;
    for (int k = 0; k < 2; k++) {
        double y = k ? prism->high : prism->low, t = (y - ray->origin.y) / ray->direction.y;
        Vec3 p = vec3_madd(ray->origin, ray->direction, t);
        p.y = y;
        if (t > sink->t_min && t < sink->t_max && (y != 0 || !prism->conic) &&
            outline_odd(&prism->outline, prism_place(prism, p)))
            solid_offer(sink, t, (SolidTag){PART_CAP, 0, 0});
    }
}

/* Where the ray meets the wall over parameter s of a piece. */
static double wall_t(const Prism *prism, const OutlinePiece *piece, double s, const Ray *ray) {
    Point2 c = outline_at(piece, s);
    Vec3 o = ray->origin, d = ray->direction;
    if (!prism->conic) return ((c.x - o.x) * d.x + (c.y - o.z) * d.z) / (d.x * d.x + d.z * d.z);
    Vec3 from_tip = {c.x, 1, c.y}, across = vec3_cross(d, from_tip);
    return -vec3_dot(vec3_cross(o, from_tip), across) / vec3_length_squared(across);
}

static void prism_cross(const void *data, const Ray *ray, SolidSink *sink) {
    const Prism *prism = data;
    Vec3 o = ray->origin, d = ray->direction;
    /* The plane that holds the ray and the direction of the walls there, cut with the outline's plane. */
    Vec3 n = prism->conic ? vec3_cross(o, d) : vec3(d.z, o.z * d.x - o.x * d.z, -d.x);
    prism_caps(prism, ray, sink);
    if (n.x == 0 && n.z == 0) return;
    for (size_t i = 0; i < prism->outline.count; i++) {
        double s[3];
        int count = outline_meet(&prism->outline.items[i], n.x, n.z, n.y, s);
        for (int k = 0; k < count; k++) {
            double t = wall_t(prism, &prism->outline.items[i], s[k], ray), y = o.y + t * d.y;
            if (y >= prism->low && y <= prism->high) solid_offer(sink, t, (SolidTag){(uint32_t)i, s[k], 0});
        }
    }
}

/* Walls face the right of the outline's direction; both caps face up, as in POV-Ray. */
static Vec3 prism_normal(const void *data, Vec3 p, const SolidTag *tag) {
    const Prism *prism = data;
    if (tag->part == PART_CAP) return vec3(0, 1, 0);
    const OutlinePiece *piece = &prism->outline.items[tag->part];
    Point2 tangent = outline_tangent(piece, tag->u), c = outline_at(piece, tag->u);
    Vec3 n = {tangent.y, prism->conic ? tangent.x * c.y - tangent.y * c.x : 0, -tangent.x};
    return vec3_normalize(prism->conic && p.y < 0 ? vec3(n.x, n.y, n.z) : n);
}

static bool prism_inside(const void *data, Vec3 p) {
    const Prism *prism = data;
    if (!(p.y >= prism->low && p.y <= prism->high) || (prism->conic && p.y == 0)) return false;
    return outline_odd(&prism->outline, prism_place(prism, p));
}

static Box3 prism_bounds(const void *data) {
    const Prism *prism = data;
    Point2 lo = prism->outline.min, hi = prism->outline.max;
    if (!prism->conic) return (Box3){{lo.x, prism->low, lo.y}, {hi.x, prism->high, hi.y}};
    Box3 box = box3_empty();
    for (int k = 0; k < 2; k++) {
        double y = k ? prism->high : prism->low;
        box = box3_add_point(box, vec3(lo.x * y, y, lo.y * y));
        box = box3_add_point(box, vec3(hi.x * y, y, hi.y * y));
    }
    return box;
}

const SolidOps solid_prism_ops = {.prepare = prism_prepare,
                                  .cross = prism_cross,
                                  .normal = prism_normal,
                                  .inside = prism_inside,
                                  .bounds = prism_bounds};

/* ---- polygon: the outline in the plane of its points ---- */

typedef struct PolygonSheet {
    Outline outline;
    Vec3 origin, a, b, normal; /* orthonormal */
    Box3 bounds;
} PolygonSheet;

static bool same_point(Vec3 a, Vec3 b) { return vec3_length_squared(vec3_sub(a, b)) < 1e-20; }

/* The corner furthest from the first, and the one that stands furthest off the line through both. */
static bool polygon_plane(PolygonSheet *sheet, const Vec3 *points, size_t count) {
    double best = 0;
    Vec3 other = points[0];
    sheet->origin = points[0];
    for (size_t i = 1; i + 1 < count && same_point(other, points[0]); i++) other = points[i];
    sheet->a = vec3_normalize(vec3_sub(other, points[0]));
    for (size_t i = 1; i < count; i++) {
        Vec3 n = vec3_cross(sheet->a, vec3_sub(points[i], points[0]));
        if (vec3_length_squared(n) <= best) continue;
        best = vec3_length_squared(n);
        sheet->normal = vec3_normalize(n);
        if (best > 1e-12) break;
    }
    sheet->b = vec3_cross(sheet->normal, sheet->a);
    return best > 0;
}

static const void *polygon_prepare(const Object *object, Arena *arena) {
    const Solid *s = object->as.solid;
    PolygonSheet *sheet = arena_new(arena, PolygonSheet);
    const Vec3 *points = s->as.polygon.points;
    size_t count = s->as.polygon.count;
    sheet->bounds = box3_empty();
    if (!polygon_plane(sheet, points, count)) return NULL;
    Point2 *flat = arena_new_array(arena, Point2, count);
    for (size_t i = 0; i < count; i++) {
        Vec3 p = vec3_sub(points[i], sheet->origin);
        flat[i] = (Point2){vec3_dot(p, sheet->a), vec3_dot(p, sheet->b)};
        sheet->bounds = box3_add_point(sheet->bounds, points[i]);
    }
    outline_add_closed(arena, &sheet->outline, CURVE_LINEAR, flat, count);
    return sheet;
}

static void polygon_cross(const void *data, const Ray *ray, SolidSink *sink) {
    const PolygonSheet *sheet = data;
    double approach = vec3_dot(ray->direction, sheet->normal);
    if (approach == 0) return;
    Vec3 from = vec3_sub(ray->origin, sheet->origin);
    double t = -vec3_dot(from, sheet->normal) / approach;
    if (!(t > sink->t_min && t < sink->t_max)) return;
    Vec3 p = vec3_madd(from, ray->direction, t);
    if (outline_odd(&sheet->outline, (Point2){vec3_dot(p, sheet->a), vec3_dot(p, sheet->b)}))
        solid_offer(sink, t, (SolidTag){0, 0, 0});
}

static Vec3 polygon_normal(const void *data, Vec3 p, const SolidTag *tag) {
    (void)p, (void)tag;
    return ((const PolygonSheet *)data)->normal;
}

PlanarOutline solid_polygon_outline(const void *data) {
    const PolygonSheet *sheet = data;
    return (PlanarOutline){&sheet->outline, sheet->origin, sheet->a, sheet->b};
}

static Box3 polygon_bounds(const void *data) { return ((const PolygonSheet *)data)->bounds; }

const SolidOps solid_polygon_ops = {.prepare = polygon_prepare,
                                    .cross = polygon_cross,
                                    .normal = polygon_normal,
                                    .bounds = polygon_bounds,
                                    .keeps_normal = true};
