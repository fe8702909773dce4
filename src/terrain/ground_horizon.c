#include "terrain/ground_horizon.h"

/* Directions all around, and rings about the eye, each so much wider than the one before. */
enum { DIRECTIONS = 512, MOST_RINGS = 1200, WIDEST = 64 /* directions that a question may span */ };
static const double GROWTH = 1.01, FIRST_RING = 0.25 /* posts */;

/* Where a direction meets a ring. */
typedef struct Crossing {
    double column, row;
    double height, y; /* of the ground: as the map counts it, and in the frame */
} Crossing;

typedef struct Spoke {
    Crossing *crossings; /* NULL: not asked yet */
    int count;           /* up to the last one on the map */
} Spoke;

/* Between two spokes: the tangents of the steepest lines to what lies within each ring. */
typedef struct Sector {
    float *tangents; /* NULL: not asked yet */
    int count;
} Sector;

struct GroundHorizon {
    const Ground *ground;
    Vec3 eye;
    Arena *arena;
    double first; /* radius of the first ring */
    int rings;
    Spoke spokes[DIRECTIONS];
    Sector sectors[DIRECTIONS]; /* from spoke i to the next */
};

static double radius_of(const GroundHorizon *h, int ring) { return h->first * pow(GROWTH, ring); }

GroundHorizon *ground_horizon_create(const Ground *ground, Vec3 eye, Arena *arena) {
    double y;
    const double first = FIRST_RING * ground->source.spacing;
    const Vec3 size = vec3_sub(ground->bounds.max, ground->bounds.min);
    if (!vec3_is_finite(eye) || !ground_ops.height(ground, eye, &y) || !(eye.y > y)) return NULL;
    GroundHorizon *h = arena_new(arena, GroundHorizon);
    *h = (GroundHorizon){.ground = ground, .eye = eye, .arena = arena, .first = first};
    h->rings = (int)double_clamp(1 + log(fmax(1, hypot(size.x, size.z) / first)) / log(GROWTH), 1, MOST_RINGS);
    return h;
}

/* `y` is known nearly, from the ring before: along the curved earth's verticals, nearly y, that tells the place well enough. */
static bool cross(const GroundHorizon *h, double angle, double radius, double y, Crossing *out) {
    const Ground *g = h->ground;
    GeoPlace place;
    double height;
    const Vec3 p = vec3(h->eye.x + radius * sin(angle), y, h->eye.z + radius * cos(angle));
    if (!scene_to_geo(&g->frame, p, &place) || !heightmap_from_geo(g->map, place, &out->column, &out->row)) return false;
    if (!heightmap_at(g->map, out->column, out->row, &height)) return false;
    out->height = g->exaggeration * height;
    out->y = y + out->height - place.height;
    return true;
}

static const Spoke *spoke_of(GroundHorizon *h, int direction) {
    Spoke *spoke = &h->spokes[direction];
    if (spoke->crossings) return spoke;
    const double angle = 2 * VTS_PI * direction / DIRECTIONS;
    double y = h->eye.y;
    ground_ops.height(h->ground, h->eye, &y);
    spoke->crossings = arena_new_array(h->arena, Crossing, (size_t)h->rings);
    while (spoke->count < h->rings && cross(h, angle, radius_of(h, spoke->count), y, &spoke->crossings[spoke->count])) y = spoke->crossings[spoke->count++].y;
    return spoke;
}

/* The lowest y of the ground between two spokes and two rings; false where some of it is missing. Verticals lean away from y: what lies lower by
 * so many metres lies lower by less in y. */
static bool lowest_between(const GroundHorizon *h, const Crossing *const corner[4], double *y) {
    double column[2] = {HUGE_VAL, -HUGE_VAL}, row[2] = {HUGE_VAL, -HUGE_VAL}, low, high;
    bool whole;
    for (int k = 0; k < 4; k++) {
        column[0] = fmin(column[0], corner[k]->column), column[1] = fmax(column[1], corner[k]->column);
        row[0] = fmin(row[0], corner[k]->row), row[1] = fmax(row[1], corner[k]->row);
    }
    const GroundSource *s = &h->ground->source;
    if (!heightmap_range(h->ground->map, int_max(0, (int)column[0] - 1), int_max(0, (int)row[0] - 1), int_min(s->columns - 1, (int)column[1] + 2),
                         int_min(s->rows - 1, (int)row[1] + 2), &low, &high, &whole) || !whole) return false;
    const double bottom = fmin(h->ground->exaggeration * low, h->ground->exaggeration * high);
    *y = HUGE_VAL;
    for (int k = 0; k < 4; k++) *y = fmin(*y, corner[k]->y - (corner[k]->height - bottom));
    return true;
}

static const Sector *sector_of(GroundHorizon *h, int direction) {
    Sector *sector = &h->sectors[direction];
    if (sector->tangents) return sector;
    const Spoke *a = spoke_of(h, direction), *b = spoke_of(h, (direction + 1) % DIRECTIONS);
    const int count = int_max(1, int_min(a->count, b->count));
    float steepest = -HUGE_VALF;
    sector->tangents = arena_new_array(h->arena, float, (size_t)count);
    sector->tangents[sector->count++] = steepest;
    for (int ring = 0; ring + 1 < count; ring++) {
        const Crossing *const corner[4] = {&a->crossings[ring], &a->crossings[ring + 1], &b->crossings[ring], &b->crossings[ring + 1]};
        double y;
        if (!lowest_between(h, corner, &y)) break;
        double rise = y - h->eye.y;
        steepest = fmaxf(steepest, (float)(rise / radius_of(h, ring + (rise > 0))));
        sector->tangents[sector->count++] = steepest;
    }
    return sector;
}

bool ground_horizon_hides(GroundHorizon *h, Vec3 centre, double reach, double top, double slack) {
    const double x = centre.x - h->eye.x, z = centre.z - h->eye.z, distance = hypot(x, z), near = distance - reach, rise = top - h->eye.y;
    if (!(near > h->first) || !isfinite(rise)) return false;
    const double tangent = rise / (rise > 0 ? near : distance + reach) + slack;
    const int ring = (int)(log(near / h->first) / log(GROWTH));
    const double turn = DIRECTIONS / (2 * VTS_PI), angle = atan2(x, z) * turn, span = asin(fmin(1, reach / distance)) * turn;
    const int first = (int)floor(angle - span), last = (int)floor(angle + span);
    if (last - first >= WIDEST) return false;
    for (int i = first; i <= last; i++) {
        const Sector *sector = sector_of(h, (i + DIRECTIONS) % DIRECTIONS);
        if (!((double)sector->tangents[int_min(ring, sector->count - 1)] > tangent)) return false;
    }
    return true;
}
