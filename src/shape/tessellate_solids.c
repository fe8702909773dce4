#include "shape/tessellate_solids.h"

#include "shape/frame.h"
#include "shape/tessellate.h"

enum { FEWEST_SIDES = 5, MOST_SIDES = 4 * TESSELLATE_MOST_PARTS - 1 };

/* ---- circles ---- */

int tessellate_sides(double radius, double tolerance) {
    /* With x = π/n and the circle's perimeter the middles of the sides stand r (1 - x cot x) ≈ r x²/3 inside; with its area
     * the corners stand r (sqrt(x / (sin x cos x)) - 1) outside, which is below r x²/2.6 for five sides and more. */
    double sides = VTS_PI / sqrt(2.6 * tolerance / radius);
    if (!(sides > FEWEST_SIDES)) return FEWEST_SIDES;
    return sides >= MOST_SIDES ? MOST_SIDES : (int)ceil(sides) | 1;
}

double tessellate_perimeter_factor(int sides) { return VTS_PI / sides / sin(VTS_PI / sides); }

static double area_factor(int sides) { return sqrt(2 * VTS_PI / (sides * sin(2 * VTS_PI / sides))); }

void tessellate_turn(int i, int n, double *cosine, double *sine) {
    /* Eighths of a turn: the argument of cos and sin stays in [0, π/4], so that mirror images agree exactly. */
    static const double axis[8][2] = {{1, 0}, {0, 1}, {0, 1}, {-1, 0}, {-1, 0}, {0, -1}, {0, -1}, {1, 0}};
    int k = (i % n + n) % n;
    int octant = (int)((int64_t)8 * k / n);
    int64_t within = (int64_t)8 * k - (int64_t)octant * n; /* of n: part of the octant */
    if (octant & 1) within = n - within;
    double angle = VTS_PI / 4 * (double)within / n, c = cos(angle), s = sin(angle);
    const double *along = axis[octant];
    double side = (octant & 1) ? -s : s; /* turning away from the nearest axis, backwards in odd octants */
    *cosine = along[0] * c - along[1] * side;
    *sine = along[1] * c + along[0] * side;
}

/* ---- sphere: an octahedron whose faces are cut and blown up ---- */

/* Place j of ring k (k of n from the pole to the equator, 4k places round it). */
static void sphere_vertex(Arena *arena, TriangleSoup *out, int n, int k, int j, double side) {
    double height, ring, c, s, turns = k ? (double)j / (4 * k) : (j + 0.5) / 4;
    tessellate_turn(k, 4 * n, &height, &ring);
    tessellate_turn(k ? j : 0, k ? 4 * k : 1, &c, &s);
    Vec3 unit = vec3(-c * ring, side * height, s * ring);
    double latitude = 0.5 + side * (0.5 - 0.5 * (double)k / n);
    soup_vertex(arena, out, unit, unit, turns, latitude);
}

static void sphere_ring(Arena *arena, TriangleSoup *out, uint32_t inner, uint32_t outer, int k, bool upper) {
    for (int quarter = 0; quarter < 4; quarter++) {
        uint32_t a = inner + (uint32_t)(quarter * (k ? k : 1)), b = outer + (uint32_t)(quarter * (k + 1));
        for (uint32_t j = 0; j <= (uint32_t)k; j++) {
            uint32_t p = a + j, q = b + j, r = b + j + 1;
            soup_triangle(arena, out, p, upper ? q : r, upper ? r : q, true);
            if (j < (uint32_t)k) soup_triangle(arena, out, p, upper ? r : p + 1, upper ? p + 1 : r, true);
        }
    }
}

static void half_sphere(Arena *arena, TriangleSoup *out, int n, bool upper) {
    uint32_t inner = (uint32_t)out->vertices.count;
    for (int j = 0; j < 4; j++) sphere_vertex(arena, out, n, 0, j, upper ? 1 : -1);
    for (int k = 1; k <= n; k++) {
        uint32_t outer = (uint32_t)out->vertices.count;
        for (int j = 0; j <= 4 * k; j++) sphere_vertex(arena, out, n, k, j, upper ? 1 : -1);
        sphere_ring(arena, out, inner, outer, k - 1, upper);
        inner = outer;
    }
}

static double soup_area_since(const TriangleSoup *soup, SoupMark since) {
    double twice = 0;
    for (size_t i = since.triangle; i < soup->triangles.count; i++) {
        const uint32_t *v = soup->triangles.items[i].vertex;
        Vec3 a = soup->vertices.items[v[0]].position, b = soup->vertices.items[v[1]].position;
        Vec3 c = soup->vertices.items[v[2]].position;
        twice += vec3_length(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
    }
    return twice / 2;
}

static int sphere_parts(double radius, double tolerance) {
    /* The largest distance of a polyhedron of unit sphere's area with n parts is below 0.62/n² (measured, n >= 2). */
    double parts = sqrt(0.62 * radius / tolerance);
    return parts > 3 ? (int)double_min(ceil(parts), TESSELLATE_MOST_PARTS) : 3;
}

void tessellate_sphere(const Object *object, double tolerance, int parts, Arena *arena, TriangleSoup *out) {
    double radius = fabs(object->as.sphere.radius);
    int n = parts > 0 ? parts : sphere_parts(radius, tolerance);
    SoupMark since = soup_mark(out);
    half_sphere(arena, out, n, true);
    half_sphere(arena, out, n, false);
    double size = radius * sqrt(4 * VTS_PI / soup_area_since(out, since));
    for (size_t i = since.vertex; i < out->vertices.count; i++) {
        SoupVertex *vertex = &out->vertices.items[i];
        vertex->position = vec3_madd(object->as.sphere.center, vertex->normal, size);
    }
}

/* ---- box ---- */

typedef struct BoxFace {
    Vec3 min, max;
    int axis, n; /* the face across `axis`, cut into n × n */
    bool high;
} BoxFace;

static double step(double a, double b, int i, int n) { return i == 0 ? a : i == n ? b : a + (b - a) * i / n; }

static SoupVertex box_point(const void *context, int i, int j) {
    const BoxFace *face = context;
    double lo[3] = {face->min.x, face->min.y, face->min.z}, hi[3] = {face->max.x, face->max.y, face->max.z};
    double p[3], normal[3] = {0, 0, 0};
    /* The two axes across, in the order whose grid looks outwards. */
    int first = (face->axis + 1) % 3, second = (face->axis + 2) % 3;
    int columns = face->high ? first : second, rows = face->high ? second : first;
    p[face->axis] = face->high ? hi[face->axis] : lo[face->axis];
    p[columns] = step(lo[columns], hi[columns], j, face->n);
    p[rows] = step(lo[rows], hi[rows], i, face->n);
    normal[face->axis] = face->high ? 1 : -1;
    return (SoupVertex){vec3(p[0], p[1], p[2]),
                        vec3(normal[0], normal[1], normal[2]),
                        {(double)j / face->n, (double)i / face->n},
                        NULL,
                        NULL};
}

void tessellate_box(const Object *object, int parts, Arena *arena, TriangleSoup *out) {
    int n = parts > 0 ? parts : 1;
    const SoupGrid grid = {n, n, false, false, true};
    for (int side = 0; side < 6; side++) {
        BoxFace face = {vec3_min(object->as.box.corner1, object->as.box.corner2),
                        vec3_max(object->as.box.corner1, object->as.box.corner2), side / 2, n, side & 1};
        soup_grid(arena, out, &grid, box_point, &face);
    }
}

/* ---- cylinder, cone, disc: grids between two circles ---- */

/* Row i runs round the circle of radius r0 + (r1 - r0)·i/rows about the point base + axis·i/rows. */
typedef struct CircleGrid {
    Vec3 base, axis, side, other;
    double r0, r1;
    int rows, columns;
    Vec3 normal_axis, normal_side; /* normal = normal_axis + (unit radial)·normal_side.x */
    double uv_radius; /* > 0: texture coordinates from the square around; 0: turns and way along */
} CircleGrid;

static SoupVertex circle_point(const void *context, int i, int j) {
    const CircleGrid *grid = context;
    double c, s;
    tessellate_turn(j, grid->columns, &c, &s);
    Vec3 radial = vec3_madd(vec3_scale(grid->side, c), grid->other, s);
    double radius = step(grid->r0, grid->r1, i, grid->rows), along = step(0, 1, i, grid->rows);
    SoupVertex vertex = {
        .position = vec3_madd(vec3_madd(grid->base, grid->axis, along), radial, radius),
        .normal = vec3_normalize(vec3_madd(grid->normal_axis, radial, grid->normal_side.x)),
        .uv = {(double)j / grid->columns, along},
    };
    if (grid->uv_radius > 0) {
        vertex.uv =
            (TexCoord){0.5 + 0.5 * c * radius / grid->uv_radius, 0.5 + 0.5 * s * radius / grid->uv_radius};
    }
    return vertex;
}

static void circle_grid(Arena *arena, TriangleSoup *out, const CircleGrid *circles, bool solid) {
    const SoupGrid grid = {circles->rows, circles->columns, circles->r0 == 0, circles->r1 == 0, solid};
    soup_grid(arena, out, &grid, circle_point, circles);
}

/* The round end of a cylinder at `center`, looking along `sign`·axis. */
static void cone_end(Arena *arena, TriangleSoup *out, CircleGrid wall, Vec3 center, double radius,
                     double sign) {
    if (radius == 0) return;
    Vec3 normal = vec3_scale(vec3_normalize(wall.axis), sign);
    CircleGrid end = wall;
    end.base = center;
    end.axis = vec3_splat(0);
    end.normal_axis = normal;
    end.normal_side = vec3_splat(0);
    end.uv_radius = radius;
    /* Outwards or inwards, so that the grid looks the right way: ∂/∂turn × ∂/∂row = -axis for growing radii. */
    end.r0 = sign > 0 ? radius : 0;
    end.r1 = sign > 0 ? 0 : radius;
    circle_grid(arena, out, &end, true);
}

/* Of the wall, and the ends of a closed one, when the circles are polygons of n sides with `factor` times the radii. */
static double cone_area(const Object *object, double length, int n, double factor) {
    double r0 = fabs(object->as.cone.base_radius) * factor, r1 = fabs(object->as.cone.cap_radius) * factor;
    double x = VTS_PI / n, chords = 2 * n * sin(x) * (r0 + r1) / 2,
           ends = n * sin(2 * x) / 2 * (r0 * r0 + r1 * r1);
    return chords * hypot(length, (r0 - r1) * cos(x)) + (object->as.cone.open ? 0 : ends);
}

static double round_cone_area(const Object *object, double length) {
    double r0 = fabs(object->as.cone.base_radius), r1 = fabs(object->as.cone.cap_radius);
    return VTS_PI * ((r0 + r1) * hypot(length, r0 - r1) + (object->as.cone.open ? 0 : r0 * r0 + r1 * r1));
}

/* Circumradius over radius for the true area. Area goes as a power of it between 1 (a long wall) and 2 (flat ends); taking
 * it for 3/2 leaves at most a third of the error each time. */
static double cone_factor(const Object *object, double length, int sides) {
    double factor = tessellate_perimeter_factor(sides), wanted = round_cone_area(object, length);
    for (int i = 0; i < 30 && wanted > 0; i++) {
        double ratio = wanted / cone_area(object, length, sides, factor);
        if (fabs(ratio - 1) < 1e-14) break;
        factor *= pow(ratio, 2.0 / 3);
    }
    return factor;
}

void tessellate_cone(const Object *object, double tolerance, int parts, Arena *arena, TriangleSoup *out) {
    double base_radius = fabs(object->as.cone.base_radius), cap_radius = fabs(object->as.cone.cap_radius);
    Vec3 axis = vec3_sub(object->as.cone.cap, object->as.cone.base);
    double length = vec3_length(axis);
    if (length == 0) return; /* no inside, and no direction for a wall */
    int sides = parts > 0 ? 4 * parts : tessellate_sides(double_max(base_radius, cap_radius), tolerance);
    double factor = cone_factor(object, length, sides);
    CircleGrid wall = {.base = object->as.cone.base,
                       .axis = axis,
                       .r0 = base_radius * factor,
                       .r1 = cap_radius * factor,
                       .rows = parts > 0 ? parts : 1,
                       .columns = sides};
    shape_axis_frame(vec3_scale(axis, 1 / length), &wall.side, &wall.other);
    wall.normal_axis = vec3_scale(axis, (base_radius - cap_radius) / length);
    wall.normal_side = vec3_splat(length);
    bool closed = !object->as.cone.open;
    /* Rows go up and turns go round: ∂/∂turn × ∂/∂row looks outwards. */
    if (wall.r0 > 0 || wall.r1 > 0) circle_grid(arena, out, &wall, closed);
    if (!closed) return;
    cone_end(arena, out, wall, wall.base, wall.r0, -1);
    cone_end(arena, out, wall, vec3_add(wall.base, axis), wall.r1, 1);
}

void tessellate_disc(const Object *object, double tolerance, int parts, Arena *arena, TriangleSoup *out) {
    double radius = fabs(object->as.disc.radius),
           hole = double_min(fabs(object->as.disc.hole_radius), radius);
    Vec3 normal = vec3_normalize(object->as.disc.normal);
    int sides = parts > 0 ? 4 * parts : tessellate_sides(radius, tolerance);
    double factor = area_factor(sides);
    if (radius == hole) return;
    CircleGrid circles = {.base = object->as.disc.center,
                          .r0 = radius * factor,
                          .r1 = hole * factor,
                          .columns = sides,
                          .rows = parts > 0 ? parts : 1,
                          .normal_axis = normal,
                          .uv_radius = radius * factor};
    shape_axis_frame(normal, &circles.side, &circles.other);
    circle_grid(arena, out, &circles, false);
}

/* ---- torus ---- */

/* Rows run round the tube backwards, columns round the axis. Of a spindle (minor > major) only the outside is there: a
 * profile from pole to pole. */
typedef struct TorusGrid {
    double major, minor, factor; /* factor: of the polygon about the axis */
    int turns, around;
    bool spindle;
} TorusGrid;

static SoupVertex torus_point(const void *context, int i, int j) {
    const TorusGrid *torus = context;
    int back = torus->around - i;
    double c, s, ct, st, share = (double)back / torus->around;
    tessellate_turn(j, torus->turns, &c, &s);
    tessellate_turn(back, torus->around, &ct, &st);
    if (torus->spindle) {
        double pole = acos(double_min(torus->major / torus->minor, 1)),
               angle = pole + 2 * (VTS_PI - pole) * share;
        ct = cos(angle), st = sin(angle);
        share = angle / (2 * VTS_PI);
    }
    bool on_axis = torus->spindle && (i == 0 || back == 0);
    double from_axis = on_axis ? 0 : (torus->major - torus->minor * ct) * torus->factor;
    return (SoupVertex){vec3(-c * from_axis, torus->minor * st, s * from_axis),
                        vec3(c * ct, st, -s * ct),
                        {(double)j / torus->turns, share},
                        NULL,
                        NULL};
}

/* Of all turns: they are alike. */
static double torus_grid_area(const TorusGrid *torus) {
    double twice = 0;
    for (int i = 0; i < torus->around; i++) {
        Vec3 a = torus_point(torus, i, 0).position, b = torus_point(torus, i, 1).position;
        Vec3 c = torus_point(torus, i + 1, 1).position, d = torus_point(torus, i + 1, 0).position;
        twice += vec3_length(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
        twice += vec3_length(vec3_cross(vec3_sub(c, a), vec3_sub(d, a)));
    }
    return torus->turns * twice / 2;
}

static double torus_area(double major, double minor) {
    if (minor <= major) return 4 * VTS_PI * VTS_PI * major * minor;
    double pole = acos(major / minor);
    return 4 * VTS_PI * minor * (major * (VTS_PI - pole) + minor * sin(pole));
}

void tessellate_torus(const Object *object, double tolerance, int parts, Arena *arena, TriangleSoup *out) {
    double major = fabs(object->as.torus.major_radius), minor = fabs(object->as.torus.minor_radius);
    TorusGrid torus = {.major = major,
                       .minor = minor,
                       .spindle = minor > major,
                       .turns = parts > 0 ? 4 * parts : tessellate_sides(major + minor, tolerance / 2),
                       .around = parts > 0 ? 4 * parts : tessellate_sides(minor, tolerance / 2)};
    if (minor == 0) return; /* a thread */
    /* The axis keeps its length; the tube makes up for the rest of the area, nearly in proportion to its radius. */
    torus.factor = tessellate_perimeter_factor(torus.turns);
    for (int i = 0; i < 6; i++) {
        double ratio = torus_area(major, minor) / torus_grid_area(&torus);
        torus.minor *= torus.spindle ? sqrt(ratio) : ratio;
    }
    const SoupGrid grid = {torus.around, torus.turns, torus.spindle, torus.spindle, true};
    soup_grid(arena, out, &grid, torus_point, &torus);
}

/* ---- plane ---- */

void tessellate_plane(const Object *object, const Box3 *region, Arena *arena, TriangleSoup *out) {
    Vec3 n = object->as.plane.normal, a, b, centre = vec3_lerp(region->min, region->max, 0.5);
    double half = vec3_length(vec3_sub(region->max, region->min)) / 2;
    uint32_t v[4];
    shape_axis_frame(n, &a, &b);
    centre = vec3_madd(centre, n, object->as.plane.distance - vec3_dot(n, centre));
    for (int k = 0; k < 4; k++) {
        Vec3 p = vec3_madd(vec3_madd(centre, a, k == 1 || k == 2 ? half : -half), b, k >= 2 ? half : -half);
        v[k] = soup_vertex(arena, out, p, n, vec3_dot(p, a), vec3_dot(p, b));
    }
    soup_triangle(arena, out, v[0], v[1], v[2], false);
    soup_triangle(arena, out, v[0], v[2], v[3], false);
}
