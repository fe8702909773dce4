/* What is turned about y: lathe, sor. */
#include "shape/outline_fill.h"
#include "shape/solid_parts.h"
#include "shape/tessellate_rare.h"
#include "shape/tessellate_solids.h"

/* A place of the profile, and which way the surface looks there. */
typedef struct ProfilePoint {
    double r, y, normal_r, normal_y;
} ProfilePoint;

typedef struct Strip {
    const ProfilePoint *points;
    int rows, columns;
    double factor; /* on radii, so that circles keep their length */
} Strip;

static SoupVertex strip_point(const void *context, int i, int j) {
    const Strip *strip = context;
    const ProfilePoint *at = &strip->points[i];
    double c, s, r = at->r * strip->factor;
    tessellate_turn(j, strip->columns, &c, &s);
    Vec3 normal = vec3_normalize(vec3(at->normal_r * c, at->normal_y, at->normal_r * s));
    return (SoupVertex){vec3(r * c, at->y, r * s), normal, {(double)j / strip->columns, (double)i / strip->rows}, NULL, NULL};
}

static void push_strip(const RareShape *shape, const ProfilePoint *points, int rows, int columns) {
    const Strip strip = {points, rows, columns, tessellate_perimeter_factor(columns)};
    const SoupGrid grid = {rows, columns, points[0].r == 0, points[rows].r == 0, false};
    soup_grid(shape->walk->arena, shape->walk->out, &grid, strip_point, &strip);
}

static int columns_for(const RareShape *shape, double radius) {
    return shape->parts > 0 ? 4 * shape->parts : tessellate_sides(radius, shape->tolerance);
}

/* ---- lathe ---- */

/* Ends that the next piece begins at, and those on the axis, are met exactly. */
static Point2 lathe_point(const Outline *outline, size_t piece, double s) {
    double near = 1e-9 * (outline->max.y - outline->min.y + fabs(outline->max.x) + fabs(outline->min.x));
    Point2 p = outline_at(&outline->items[piece], s);
    if (s == 1 && piece + 1 < outline->count) {
        Point2 next = outline_at(&outline->items[piece + 1], 0);
        if (hypot(next.x - p.x, next.y - p.y) < near) p = next;
    }
    if (s == 1 && piece + 1 == outline->count) {
        Point2 first = outline_at(&outline->items[0], 0);
        if (hypot(first.x - p.x, first.y - p.y) < near) p = first;
    }
    if (fabs(p.x) < near) p.x = 0;
    return p;
}

static void push_lathe_piece(const RareShape *shape, const Outline *outline, size_t piece, int columns) {
    int rows = shape->parts > 0 ? shape->parts : outline_chords(&outline->items[piece], shape->tolerance);
    ProfilePoint *points = arena_new_array(shape->walk->arena, ProfilePoint, (size_t)rows + 1);
    for (int i = 0; i <= rows; i++) {
        double s = (double)i / rows;
        Point2 p = lathe_point(outline, piece, s), t = outline_tangent(&outline->items[piece], s);
        points[i] = (ProfilePoint){p.x, p.y, t.y, -t.x};
    }
    push_strip(shape, points, rows, columns);
}

void tessellate_lathe(const RareShape *shape) {
    const Solid *s = shape->surface.object->as.solid;
    SoupMark since = soup_mark(shape->walk->out);
    Outline outline = {0};
    outline_add_curve(shape->walk->arena, &outline, s->as.turned.curve, s->as.turned.points, s->as.turned.count);
    int columns = columns_for(shape, double_max(fabs(outline.min.x), fabs(outline.max.x)));
    for (size_t i = 0; i < outline.count; i++) push_lathe_piece(shape, &outline, i, columns);
    tessellate_close(shape, since, 0);
}

/* ---- sor ---- */

/* Denser at the ends, where the radius may rise like a root. */
static double share_of(int i, int n) { return i == 0 ? 0 : i == n ? 1 : (1 - cos(VTS_PI * i / n)) / 2; }

static ProfilePoint sor_point(const void *data, size_t piece, double share) {
    SorPlace at = {0};
    solid_sor_at(data, piece, share, &at);
    double r = sqrt(at.square);
    return (ProfilePoint){r, at.y, 2 * r, -at.slope};
}

static bool is_within(const RareShape *shape, size_t piece, int n) {
    for (int i = 0; i < n; i++) {
        ProfilePoint a = sor_point(shape->surface.data, piece, share_of(i, n)),
                     b = sor_point(shape->surface.data, piece, share_of(i + 1, n)),
                     m = sor_point(shape->surface.data, piece, (share_of(i, n) + share_of(i + 1, n)) / 2);
        double r = b.r - a.r, y = b.y - a.y, length = hypot(r, y);
        if (length > 0 && fabs((m.r - a.r) * y - (m.y - a.y) * r) > shape->tolerance * length / 2) return false;
    }
    return true;
}

static void push_sor_piece(const RareShape *shape, size_t piece, int columns) {
    enum { MOST_ROWS = 256 };
    int rows = shape->parts > 0 ? shape->parts : 1;
    while (shape->parts == 0 && rows < MOST_ROWS && !is_within(shape, piece, rows)) rows *= 2;
    ProfilePoint *points = arena_new_array(shape->walk->arena, ProfilePoint, (size_t)rows + 1);
    for (int i = 0; i <= rows; i++) points[i] = sor_point(shape->surface.data, piece, share_of(i, rows));
    SorPlace next;
    if (solid_sor_at(shape->surface.data, piece + 1, 0, &next)) points[rows].r = sqrt(next.square), points[rows].y = next.y;
    push_strip(shape, points, rows, columns);
}

static void push_sor_cap(const RareShape *shape, double r, double y, bool upper, int columns) {
    ProfilePoint points[2] = {{0, y, 0, upper ? 1 : -1}, {r, y, 0, upper ? 1 : -1}};
    if (r == 0) return;
    if (upper) {
        ProfilePoint first = points[0];
        points[0] = points[1];
        points[1] = first;
    }
    push_strip(shape, points, 1, columns);
}

void tessellate_sor(const RareShape *shape) {
    const void *data = shape->surface.data;
    SoupMark since = soup_mark(shape->walk->out);
    int columns = columns_for(shape, shape->surface.ops->bounds(data).max.x);
    SorPlace low, high = {0};
    size_t pieces = 0;
    for (; solid_sor_at(data, pieces, 1, &high); pieces++) push_sor_piece(shape, pieces, columns);
    if (pieces && !shape->surface.object->as.solid->as.turned.open && solid_sor_at(data, 0, 0, &low)) {
        push_sor_cap(shape, sqrt(low.square), low.y, false, columns);
        push_sor_cap(shape, sqrt(high.square), high.y, true, columns);
    }
    tessellate_close(shape, since, 0);
}
