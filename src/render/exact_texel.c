#include "render/exact_texel.h"

#include "render/curve_tree.h"

#include <string.h>

typedef struct ExactTriangle {
    Vec3f corner[3];
    uint32_t layer;
} ExactTriangle;

struct ExactTexel {
    Vec3 extent;
    bool cyclic[3];
    uint32_t layer_count;
    ExactTriangle *triangles; /* as they were added; then in the order of the tree */
    FacetNormals *normals;    /* the same; NULL: all are flat */
    size_t count;
    const CurveTree *tree;
};

/* A triangle is repeated at most so often along an axis; the voxels have the same limit. */
enum { MOST_WRAPS = 64, MOST_CURVES = 1 << 13 };
/* Content in the walls of the box counts as inside, whatever rounding says; in extents. */
static const double WALL = 1e-5;

ExactTexel *exact_texel_begin(Vec3f extent, unsigned cyclic, Arena *arena) {
    ExactTexel *texel = arena_new(arena, ExactTexel);
    *texel = (ExactTexel){.extent = vec3_from_f(extent)};
    for (int k = 0; k < 3; k++) texel->cyclic[k] = cyclic >> k & 1;
    return texel;
}

/* ---- wrapping ---- */

/* Periods by which a triangle is to be moved so that some of it is in the box, along each axis. */
typedef struct Wraps {
    int from[3], to[3];
} Wraps;

static bool find_wraps(const ExactTexel *texel, const Vec3f corner[3], Wraps *out) {
    for (int k = 0; k < 3; k++) {
        double size = vec3_get(texel->extent, k), lo = VTS_INFINITY, hi = -VTS_INFINITY;
        for (int i = 0; i < 3; i++) {
            double x = vec3_get(vec3_from_f(corner[i]), k) / size;
            if (!isfinite(x)) return false;
            lo = double_min(lo, x), hi = double_max(hi, x);
        }
        out->from[k] = out->to[k] = 0;
        if (texel->cyclic[k]) {
            if (hi - lo > MOST_WRAPS || fabs(lo) > 1e6) return false;
            out->from[k] = (int)ceil(-hi - WALL);
            out->to[k] = (int)floor(1 - lo + WALL);
        } else if (hi < -WALL || lo > 1 + WALL) {
            return false;
        }
    }
    return true;
}

static size_t wrap_count(const Wraps *w) {
    size_t count = 1;
    for (int k = 0; k < 3; k++) count *= (size_t)(w->to[k] - w->from[k] + 1);
    return count;
}

/* A triangle of a mesh. */
typedef struct Source {
    Vec3f corner[3];
    FacetNormals normals;
} Source;

static void add_moved(ExactTexel *texel, const Source *source, int x, int y, int z) {
    Vec3 move = vec3_mul(vec3(x, y, z), texel->extent);
    if (texel->normals) texel->normals[texel->count] = source->normals;
    ExactTriangle *triangle = &texel->triangles[texel->count++];
    for (int i = 0; i < 3; i++) triangle->corner[i] = vec3f_from(vec3_add(vec3_from_f(source->corner[i]), move));
    triangle->layer = texel->layer_count;
}

static void add_wrapped(ExactTexel *texel, const Source *source, const Wraps *w) {
    for (int z = w->from[2]; z <= w->to[2]; z++)
        for (int y = w->from[1]; y <= w->to[1]; y++)
            for (int x = w->from[0]; x <= w->to[0]; x++) add_moved(texel, source, x, y, z);
}

/* Of a triangle that is flat, as if it had three normals of length 0. */
static FacetNormals flat_normals(void) {
    static const Vec3f none[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    return facet_normals_pack(none);
}

static FacetNormals normals_of(const TexelMesh *mesh, size_t triangle) {
    Vec3f found[3];
    return facet_normals_of(mesh, triangle, found) ? facet_normals_pack(found) : flat_normals();
}

static bool load_corners(const TexelMesh *mesh, size_t triangle, Vec3f corner[3]) {
    for (int i = 0; i < 3; i++) {
        uint32_t v = mesh->triangles[triangle][i];
        if (v >= mesh->vertex_count) return false;
        corner[i] = mesh->vertices[v];
    }
    return true;
}

/* For `count` more triangles, with normals if `round` are among them. What there was is given back where that is possible. */
static void make_room(ExactTexel *texel, size_t count, bool round, Arena *arena) {
    size_t had = texel->count, all = had + count;
    const ExactTriangle *triangles = texel->triangles;
    const FacetNormals *normals = texel->normals;
    texel->triangles = arena_new_array(arena, ExactTriangle, all);
    if (had) memcpy(texel->triangles, triangles, had * sizeof *triangles);
    arena_release(arena, triangles, had * sizeof *triangles);
    if (!normals && !round) return;
    texel->normals = arena_new_array(arena, FacetNormals, all);
    for (size_t i = 0; i < all; i++) texel->normals[i] = normals && i < had ? normals[i] : flat_normals();
    arena_release(arena, normals, had * sizeof *normals);
}

void exact_texel_add_layer(ExactTexel *texel, const TexelMesh *mesh, Arena *arena) {
    size_t count = 0;
    Source source = {.normals = flat_normals()};
    Wraps wraps;
    for (size_t i = 0; i < mesh->triangle_count; i++)
        if (load_corners(mesh, i, source.corner) && find_wraps(texel, source.corner, &wraps)) count += wrap_count(&wraps);
    make_room(texel, count, mesh->normals, arena);
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        if (!load_corners(mesh, i, source.corner) || !find_wraps(texel, source.corner, &wraps)) continue;
        if (mesh->normals) source.normals = normals_of(mesh, i);
        add_wrapped(texel, &source, &wraps);
    }
    texel->layer_count++;
}

size_t exact_texel_triangles(const ExactTexel *texel) { return texel->count; }

static Box3 triangle_box(const ExactTriangle *t) {
    Box3 box = box3_empty();
    for (int i = 0; i < 3; i++) box = box3_add_point(box, vec3_from_f(t->corner[i]));
    return box;
}

void exact_texel_commit(ExactTexel *texel, Arena *arena, Arena *scratch) {
    size_t count = texel->count;
    ArenaMark mark = arena_mark(scratch);
    Box3 *boxes = arena_new_array(scratch, Box3, count);
    uint32_t *order = arena_new_array(scratch, uint32_t, count);
    for (size_t i = 0; i < count; i++) boxes[i] = triangle_box(&texel->triangles[i]);
    texel->tree = curve_tree_build(boxes, count, order, arena, scratch);
    const ExactTriangle *triangles = arena_copy(scratch, texel->triangles, count * sizeof *triangles);
    const FacetNormals *normals = texel->normals ? arena_copy(scratch, texel->normals, count * sizeof *normals) : NULL;
    for (size_t i = 0; i < count; i++) {
        texel->triangles[i] = triangles[order[i]];
        if (normals) texel->normals[i] = normals[order[i]];
    }
    arena_reset_to(scratch, mark);
}

/* ---- curves ---- */

typedef struct Shot {
    const ExactTexel *texel;
    const ExactWay *way;
    Curve curve;   /* less the period */
    double s0, s1; /* of the curve; s1 comes down with the nearest hit */
    double hair;   /* the margin, in s */
    Vec3 period;
    bool enough;
} Shot;

/* In the curve's own s. */
static double end_of_search(const ExactWay *way, const Curve *curve) { return double_min(1, (*way->nearest - curve->start) / curve->length); }

static bool within(double x, double size, double margin) { return x >= -WALL * size - margin && x <= (1 + WALL) * size + margin; }

bool exact_texel_covers(const ExactTexel *texel, const ExactTexelHit *hit, Vec3 point, double margin) {
    const double hair = 1e-9; /* neighbours share their edges */
    Vec3 e1 = hit->edge[0], e2 = hit->edge[1], n = vec3_cross(e1, e2), p = vec3_sub(point, hit->corner), in = vec3_sub(point, hit->period);
    double nn = vec3_length_squared(n), u = vec3_dot(vec3_cross(p, e2), n), v = vec3_dot(vec3_cross(e1, p), n);
    double slack = hair * nn, wide = margin * sqrt(nn); /* a side's length times the margin, in these units */
    if (u < -slack && u < -slack - wide * vec3_length(e2)) return false;
    if (v < -slack && v < -slack - wide * vec3_length(e1)) return false;
    if (!(u + v <= nn + slack || u + v <= nn + slack + wide * vec3_length(vec3_sub(e1, e2)))) return false;
    return within(in.x, texel->extent.x, margin) && within(in.y, texel->extent.y, margin) && within(in.z, texel->extent.z, margin);
}

Vec3 exact_texel_normal(const ExactTexelHit *hit, Vec3 point) {
    if (!hit->round) return hit->normal;
    Vec3 e1 = hit->edge[0], e2 = hit->edge[1], n = vec3_cross(e1, e2), p = vec3_sub(point, hit->corner);
    double nn = vec3_length_squared(n), s = vec3_dot(vec3_cross(p, e2), n) / nn, t = vec3_dot(vec3_cross(e1, p), n) / nn;
    Vec3 round = vec3_normalize(vec3_from_f(facet_normals_at(hit->round, (float)s, (float)t)));
    double side = vec3_dot(round, hit->normal);
    return side != 0 ? vec3_scale(round, side < 0 ? -1 : 1) : hit->normal;
}

static void try_triangle(Shot *shot, const ExactTriangle *triangle) {
    Vec3 a = vec3_from_f(triangle->corner[0]), e1 = vec3_sub(vec3_from_f(triangle->corner[1]), a);
    Vec3 e2 = vec3_sub(vec3_from_f(triangle->corner[2]), a), n = vec3_cross(e1, e2);
    CurvePlane plane = curve_over_plane(&shot->curve, a, n);
    if (curve_misses_plane(&plane)) return;
    double s[3];
    int count = curve_plane_roots(&plane, s);
    for (int i = 0; i < count && !shot->enough; i++) {
        if (!(s[i] >= shot->s0 - shot->hair && s[i] <= shot->s1 + shot->hair)) continue;
        ExactTexelHit hit = {shot->curve.start + shot->curve.length * s[i], triangle->layer, vec3_add(a, shot->period), {e1, e2},
                             shot->period, vec3_normalize(n), shot->texel->normals ? &shot->texel->normals[triangle - shot->texel->triangles] : NULL};
        if (!exact_texel_covers(shot->texel, &hit, vec3_add(curve_point(&shot->curve, s[i]), shot->period), shot->way->margin)) continue;
        shot->enough = shot->way->settle(shot->way->context, &hit);
        shot->s1 = double_min(shot->s1, end_of_search(shot->way, &shot->curve));
    }
}

static bool try_triangles(void *context, uint32_t first, uint32_t count) {
    Shot *shot = context;
    for (uint32_t i = 0; i < count && !shot->enough; i++) try_triangle(shot, &shot->texel->triangles[first + i]);
    return shot->enough;
}

/* Narrows [*s0, *s1] to where the curve may be in the box, but for the axes `free`. */
static bool clip_to_box(const ExactTexel *texel, const Curve *curve, double margin, unsigned free, double *s0, double *s1) {
    Vec3 spread = curve_spread(curve);
    for (int k = 0; k < 3; k++) {
        if (free >> k & 1) continue;
        double p = vec3_get(curve->from, k), d = vec3_get(curve->chord, k), size = vec3_get(texel->extent, k);
        double grow = WALL * size + vec3_get(spread, k) + margin;
        if (d == 0) {
            if (p < -grow || p > size + grow) return false;
            continue;
        }
        double a = (-grow - p) / d, b = (size + grow - p) / d;
        *s0 = double_max(*s0, double_min(a, b));
        *s1 = double_min(*s1, double_max(a, b));
    }
    return *s0 <= *s1;
}

static void shoot_period(Shot *shot, const Curve *curve, Vec3 period) {
    double from = shot->s0, to = shot->s1;
    shot->curve = *curve;
    shot->curve.from = vec3_sub(curve->from, period);
    shot->period = period;
    if (clip_to_box(shot->texel, &shot->curve, shot->way->margin, 0, &from, &to))
        curve_tree_walk(shot->texel->tree, &shot->curve, shot->way->margin, from, &shot->s1, try_triangles, shot);
}

/* The periods along one axis that the hull reaches into. */
static void periods_along(double lo, double hi, double size, bool repeated, int64_t *first, int64_t *last) {
    *first = *last = 0;
    if (!repeated) return;
    *first = (int64_t)floor(lo / size + WALL);
    *last = (int64_t)floor(hi / size - WALL);
    if (*last < *first) *last = *first;
}

/* The periods of a curve no longer than one of them. */
static void shoot_periods(Shot *shot, const Curve *curve, unsigned repeat) {
    Box3 hull = curve_hull(curve);
    int64_t first[3], last[3];
    for (int k = 0; k < 3; k++)
        periods_along(vec3_get(hull.min, k), vec3_get(hull.max, k), vec3_get(shot->texel->extent, k), repeat >> k & 1, &first[k], &last[k]);
    for (int64_t z = first[2]; z <= last[2]; z++)
        for (int64_t y = first[1]; y <= last[1]; y++)
            for (int64_t x = first[0]; x <= last[0] && !shot->enough; x++)
                shoot_period(shot, curve, vec3_mul(vec3((double)x, (double)y, (double)z), shot->texel->extent));
}

static bool longer_than_a_period(const ExactTexel *texel, const Curve *curve, unsigned repeat) {
    for (int k = 0; k < 3; k++)
        if (repeat >> k & 1 && fabs(vec3_get(curve->chord, k)) > 1.01 * vec3_get(texel->extent, k)) return true;
    return false;
}

/* In halves, until they are no longer than a period; the first before the second. */
static bool shoot_piece(const ExactTexel *texel, const Curve *curve, double s0, unsigned repeat, const ExactWay *way, int *curves_left) {
    double from = s0, to = end_of_search(way, curve);
    if ((*curves_left)-- <= 0 || !clip_to_box(texel, curve, way->margin, repeat, &from, &to)) return false;
    if (!longer_than_a_period(texel, curve, repeat)) {
        double chord = double_max(fabs(curve->chord.x), double_max(fabs(curve->chord.y), fabs(curve->chord.z)));
        Shot shot = {.texel = texel, .way = way, .s0 = from, .s1 = to, .hair = chord > 0 ? double_min(1, way->margin / chord) : 0};
        shoot_periods(&shot, curve, repeat);
        return shot.enough;
    }
    Curve half = curve_part(curve, 0, 0.5);
    if (from < 0.5 && shoot_piece(texel, &half, 2 * from, repeat, way, curves_left)) return true;
    half = curve_part(curve, 0.5, 1);
    return to > 0.5 && shoot_piece(texel, &half, double_max(0, 2 * from - 1), repeat, way, curves_left);
}

bool exact_texel_shoot(const ExactTexel *texel, const Curve *curve, double s0, unsigned repeat, const ExactWay *way) {
    int curves_left = MOST_CURVES;
    return shoot_piece(texel, curve, s0, repeat, way, &curves_left);
}
