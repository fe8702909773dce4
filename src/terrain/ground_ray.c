#include "terrain/ground_ray.h"

enum { DEEPEST = 48, MOST_STEPS = 60 };
static const double LEAST_RADIUS = 6.33e6; /* of the earth's curvature */
static const double SHORTEST = 1e-4;       /* pieces, in posts */

/* A point of the ray, over the map. */
typedef struct Probe {
    double t;
    bool placed; /* it has a place on the lattice, within the map or not */
    double column, row, height;
    double above; /* the ground; NaN: there is none */
} Probe;

typedef struct Search {
    const Ground *ground;
    const Ray *ray;
    double length; /* of the ray's direction */
} Search;

static Probe probe(const Search *s, double t) {
    const Ground *g = s->ground;
    Probe p = {.t = t, .above = (double)NAN};
    GeoPlace place;
    double height;
    p.placed = scene_to_geo(&g->frame, vec3_madd(s->ray->origin, s->ray->direction, t), &place) &&
               heightmap_from_geo(g->map, place, &p.column, &p.row);
    if (!p.placed) return p;
    p.height = place.height;
    if (heightmap_at(g->map, p.column, p.row, &height)) p.above = p.height - g->exaggeration * height;
    return p;
}

/* Whether the piece may touch the ground: not where it passes over or under all of it, or beside. */
static bool may_meet(const Search *s, const Probe *a, const Probe *b) {
    const Ground *g = s->ground;
    if (!a->placed || !b->placed) return true;
    double length = (b->t - a->t) * s->length;
    double sag = length * length / (8 * LEAST_RADIUS) * 1.1 + 1e-6;
    double aside = g->source.bend * length * length / g->source.spacing + 1e-6;
    double limit_c = g->source.columns - 1, limit_r = g->source.rows - 1;
    double c0 = fmin(a->column, b->column) - aside, c1 = fmax(a->column, b->column) + aside;
    double r0 = fmin(a->row, b->row) - aside, r1 = fmax(a->row, b->row) + aside;
    if (c1 < 0 || r1 < 0 || c0 > limit_c || r0 > limit_r) return heightmap_extent(g->map)->around;
    double low, high;
    if (!heightmap_range(g->map, (int)fmax(0, floor(c0)), (int)fmax(0, floor(r0)), (int)fmin(limit_c, ceil(c1)), (int)fmin(limit_r, ceil(r1)), &low, &high, NULL))
        return false;
    double one = g->exaggeration * low, other = g->exaggeration * high;
    return fmin(a->height, b->height) - sag <= fmax(one, other) + 1e-6 && fmax(a->height, b->height) + 1e-6 >= fmin(one, other);
}

static bool changes_side(const Probe *a, const Probe *b) { return (a->above > 0) != (b->above > 0) && !isnan(a->above) && !isnan(b->above); }

/* The crossing between two probes on different sides: false position, halving where that creeps (the Illinois rule). */
static double crossing(const Search *s, Probe a, Probe b) {
    double fa = a.above, fb = b.above;
    for (int i = 0; i < MOST_STEPS && (b.t - a.t) * s->length > 1e-9; i++) {
        double t = a.t + (b.t - a.t) * fa / (fa - fb);
        Probe middle = probe(s, t);
        if (isnan(middle.above) || middle.above == 0 || t <= a.t || t >= b.t) return t;
        bool left = (middle.above > 0) == (a.above > 0);
        if (left) a = middle, fa = middle.above, fb /= 2;
        else b = middle, fb = middle.above, fa /= 2;
    }
    return fabs(a.above) < fabs(b.above) ? a.t : b.t;
}

/* Within a cell the ground along the ray is nearly a parabola. */
static bool meet_in_cell(const Search *s, const Probe *a, const Probe *b, double *t) {
    Probe middle = probe(s, 0.5 * (a->t + b->t));
    double curve = 2 * (a->above + b->above - 2 * middle.above), slope = b->above - a->above - curve;
    Probe list[4] = {*a, middle};
    int count = 2;
    double peak = curve != 0 ? -slope / (2 * curve) : -1;
    if (peak > 0 && peak < 1 && peak != 0.5) {
        Probe extreme = probe(s, a->t + (b->t - a->t) * peak);
        if (peak < 0.5) list[2] = middle, list[1] = extreme;
        else list[2] = extreme;
        count = 3;
    }
    list[count++] = *b;
    for (int i = 0; i + 1 < count; i++) {
        if (!changes_side(&list[i], &list[i + 1])) continue;
        *t = crossing(s, list[i], list[i + 1]);
        return true;
    }
    return false;
}

static bool in_one_cell(const Search *s, const Probe *a, const Probe *b) {
    if (a->placed && b->placed && floor(a->column) == floor(b->column) && floor(a->row) == floor(b->row)) return true;
    return (b->t - a->t) * s->length < SHORTEST * s->ground->source.spacing;
}

static bool search(const Search *s, const Probe *a, const Probe *b, int depth, double *t) {
    if (!may_meet(s, a, b)) return false;
    if (depth == DEEPEST || in_one_cell(s, a, b)) return meet_in_cell(s, a, b, t);
    Probe middle = probe(s, 0.5 * (a->t + b->t));
    return search(s, a, &middle, depth + 1, t) || search(s, &middle, b, depth + 1, t);
}

bool ground_meet(const Ground *ground, const Ray *ray, double t_min, double t_max, double *t) {
    const Search s = {ground, ray, vec3_length(ray->direction)};
    if (!(s.length > 0) || !isfinite(s.length) || !vec3_is_finite(ray->origin)) return false;
    if (box3_is_empty(ground->bounds) || !box3_clip_ray(ground->bounds, ray, &t_min, &t_max)) return false;
    Probe a = probe(&s, t_min), b = probe(&s, t_max);
    return search(&s, &a, &b, 0, t);
}
