#include "render/exact_skin.h"

#include "render/skin_fold.h"

#include <embree3/rtcore.h>
#include <stdlib.h>

struct ExactSkin {
    RTCScene scene;
};

/* Largest distance of a chord from its curve, in tiles and heights of the texel. */
static const double CHORD_ERROR = 1e-4;
/* Chords overlap by this share of their length, so that rounding leaves no gap between two. */
static const double OVERLAP = 1e-4;
/* From a hit, matter within this distance is the same triangle seen again: in texel space, several chord errors. */
static const double CLEARANCE = 3e-4;
/* A ray that needs more is lost in absurd coordinates; it ends there. */
enum { MOST_CHORDS = 1 << 16, MOST_TILES = 1 << 18, DEEPEST_CHORD = 14, DEEPEST_REACH = 10, POLISHINGS = 3 };
static const double LARGEST_COORDINATE = 1e9;

/* A place on the ray within a cell. */
typedef struct Node {
    double t;
    SkinPoint point;
    TexturePlace place;
} Node;

typedef struct Walk {
    struct RTCIntersectContext context; /* first: Embree hands back its address */
    const CompiledSkin *skin;
    const Ray *ray;
    double t_min, t; /* nearest hit so far, or the end */
    bool shadow, found;
    int chords_left, tiles_left;
    TraceCounters *counters;
    /* of the nearest hit */
    Node at;
    TexelCopy copy;
    ExactTexelHit hit;
    const PlacedTexel *placed;
} Walk;

/* ---- the curve ---- */

static bool find_node(const Walk *w, const SkinCell *cell, double t, SkinPoint guess, Node *out) {
    Vec3 world = vec3_madd(w->ray->origin, w->ray->direction, t);
    double size = vec3_length(vec3_sub(cell->bounds.max, cell->bounds.min));
    if (!skin_cell_invert(cell, world, 1e-6 * size, &guess)) return false; /* whose last step squares the residual */
    const double slack = 0.5 + 1e-3;
    if (!(fabs(guess.a - 0.5) < slack && fabs(guess.b - 0.5) < slack && fabs(guess.w - 0.5) < slack)) return false;
    *out = (Node){t, guess, skin_texture_place(cell, &guess)};
    return true;
}

static SkinPoint guess_from(const Walk *w, const Node *from, double t) {
    Vec3 way = vec3_scale(w->ray->direction, t - from->t);
    return (SkinPoint){from->point.cell, from->point.a + vec3_dot(from->place.grad_a, way), from->point.b + vec3_dot(from->place.grad_b, way),
                       from->point.w + vec3_dot(from->place.grad_layer, way)};
}

static double turning(const Node *n) { return vec3_dot(n->place.grad_a, vec3_cross(n->place.grad_b, n->place.grad_layer)); }

/* Where a fold lies between two nodes they are on sheets that are turned opposite ways. */
static bool same_sheet(const Node *a, const Node *b) { return turning(a) * turning(b) > 0; }

/* The node at t, going there from a known one by as many steps as Newton's method needs. */
static bool reach(const Walk *w, const SkinCell *cell, const Node *from, double t, int depth, Node *out) {
    if (find_node(w, cell, t, guess_from(w, from, t), out) && (cell->side != CELL_FOLDED || same_sheet(from, out))) return true;
    Node half;
    return depth > 0 && reach(w, cell, from, (from->t + t) / 2, depth - 1, &half) && reach(w, cell, &half, t, depth - 1, out);
}

static Vec3 coordinates(const Node *n) { return vec3(n->place.u, n->place.v, n->place.w); }

static Vec3 coordinate_rate(const Walk *w, const Node *n) {
    Vec3 d = w->ray->direction;
    return vec3(vec3_dot(n->place.grad_u, d), vec3_dot(n->place.grad_v, d), vec3_dot(n->place.grad_w, d));
}

static double largest_part(Vec3 v) { return fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z))); }

/* A curve leaves its chord by a quarter of what its tangents at the ends miss the other end by (a parabola just so). */
static double bend(const Walk *w, const Node *a, const Node *b) {
    Vec3 chord = vec3_sub(coordinates(b), coordinates(a));
    double length = b->t - a->t;
    Vec3 miss_a = vec3_sub(vec3_scale(coordinate_rate(w, a), length), chord);
    Vec3 miss_b = vec3_sub(vec3_scale(coordinate_rate(w, b), length), chord);
    return fmax(largest_part(miss_a), largest_part(miss_b)) / 4;
}

/* ---- chords against copies ---- */

typedef struct Chord {
    const SkinCell *cell;
    const Node *a, *b;
    Vec3 x, d;     /* texture coordinates x + s·d */
    double s0, s1; /* s1 comes down to the nearest hit */
    bool found;
    TexelCopy copy;
    ExactTexelHit hit;
    const PlacedTexel *placed;
} Chord;

static Vec3 point_in_copy(const TexelCopy *copy, Vec3 x) {
    Vec3f e = copy->texel->extent;
    return vec3((copy->xu * x.x + copy->xv * x.y + copy->x0) * (double)e.x, x.z * copy->inverse_scale * (double)e.y,
                (copy->zu * x.x + copy->zv * x.y + copy->z0) * (double)e.z);
}

static Vec3 way_in_copy(const TexelCopy *copy, Vec3 d) {
    Vec3f e = copy->texel->extent;
    return vec3((copy->xu * d.x + copy->xv * d.y) * (double)e.x, d.z * copy->inverse_scale * (double)e.y,
                (copy->zu * d.x + copy->zv * d.y) * (double)e.z);
}

/* Tries one copy between s0 and s1. */
static void shoot_copy(Chord *c, const PlacedTexel *placed, const TexelCopy *copy, double s0, double s1, bool any) {
    ExactTexelHit hit;
    Vec3 from = point_in_copy(copy, c->x), along = way_in_copy(copy, c->d);
    if (!exact_texel_shoot(copy->texel->exact, from, along, s0, s1, any ? NULL : &hit)) return;
    c->found = true;
    if (any || hit.s >= c->s1) return;
    c->s1 = hit.s;
    c->hit = hit;
    c->copy = *copy;
    c->placed = placed;
}

/* The number of the tile along one axis that the path enters or is in at s; *end gets the s at which it leaves it. */
static int64_t tile_at(double x, double d, double s, double *end) {
    double tile = floor(x + s * d);
    *end = d > 0 ? (tile + 1 - x) / d : d < 0 ? (tile - x) / d : VTS_INFINITY;
    if (*end <= s) { /* on the border, on the way out */
        tile += d > 0 ? 1 : -1;
        *end += 1 / fabs(d);
    }
    return (int64_t)tile;
}

static void shoot_tile(Chord *c, const PlacedTexel *placed, int64_t iu, int64_t iv, double s0, double s1, bool any) {
    int side = 2 * placed->reach + 1;
    TexelCopy copy;
    for (int k = 0; k < side * side && !(any && c->found); k++)
        if (texel_copy_near(placed, iu, iv, k, &copy)) shoot_copy(c, placed, &copy, s0, s1, any);
}

static void shoot_texel(Walk *w, Chord *c, const PlacedTexel *placed) {
    if (placed->alike) { /* one endless copy */
        TexelCopy copy;
        if (texel_copy_near(placed, (int64_t)floor(c->x.x), (int64_t)floor(c->x.y), 0, &copy)) shoot_copy(c, placed, &copy, c->s0, c->s1, w->shadow);
        return;
    }
    for (double s = c->s0; s < c->s1 && !(w->shadow && c->found) && w->tiles_left-- > 0;) {
        double end_u, end_v;
        int64_t iu = tile_at(c->x.x, c->d.x, s, &end_u), iv = tile_at(c->x.y, c->d.y, s, &end_v);
        double end = double_min(double_min(end_u, end_v), c->s1);
        shoot_tile(c, placed, iu, iv, s, end, w->shadow);
        if (!(end > s)) return;
        s = end;
    }
}

/* Moves the chord's hit along the ray until it lies in the plane of its triangle, as the curved mapping has it. */
static void polish(const Walk *w, const Chord *c, Node *at) {
    double length = c->b->t - c->a->t, t = c->a->t + c->s1 * length, most = 0.05 * length;
    *at = *(c->s1 < 0.5 ? c->a : c->b);
    for (int i = 0; i < POLISHINGS; i++) {
        Node next;
        if (!find_node(w, c->cell, t, guess_from(w, at, t), &next)) return;
        *at = next;
        double miss = vec3_dot(c->hit.normal, vec3_sub(point_in_copy(&c->copy, coordinates(at)), c->hit.corner));
        double rate = vec3_dot(c->hit.normal, way_in_copy(&c->copy, coordinate_rate(w, at)));
        double step = -miss / rate;
        if (!(fabs(step) <= most)) return; /* the triangle is seen edge-on */
        t += step;
        most = fabs(step) / 2;
    }
}

static bool shoot_chord(Walk *w, const SkinCell *cell, const Node *a, const Node *b) {
    Chord c = {.cell = cell, .a = a, .b = b, .x = coordinates(a), .d = vec3_sub(coordinates(b), coordinates(a)),
               .s0 = a->t > w->t_min ? -OVERLAP : 0, .s1 = 1 + OVERLAP};
    if (!(largest_part(c.x) < LARGEST_COORDINATE && largest_part(c.d) < LARGEST_COORDINATE)) return false;
    w->counters->steps++;
    w->chords_left--;
    for (size_t i = 0; i < w->skin->texel_count && !(w->shadow && c.found); i++)
        if (w->skin->texels[i].family_size) shoot_texel(w, &c, &w->skin->texels[i]);
    if (!c.found || w->shadow) return c.found;
    Node at;
    polish(w, &c, &at);
    if (at.t >= w->t || at.t <= w->t_min) return false;
    w->t = at.t;
    w->at = at;
    w->copy = c.copy;
    w->hit = c.hit;
    w->placed = c.placed;
    return true;
}

static bool walk_curve(Walk *w, const SkinCell *cell, const Node *a, const Node *b, int depth) {
    Node middle;
    double t = (a->t + b->t) / 2;
    if (w->chords_left <= 0) return false;
    if (depth == 0 || bend(w, a, b) <= CHORD_ERROR || !reach(w, cell, a, t, DEEPEST_REACH, &middle)) return shoot_chord(w, cell, a, b);
    return walk_curve(w, cell, a, &middle, depth - 1) || walk_curve(w, cell, &middle, b, depth - 1);
}

/* The piece of the ray from t0 to t1 that lies in the cell, `middle` half way. */
static bool walk_piece(Walk *w, const SkinCell *cell, const Node *middle, double t0, double t1) {
    Node a, b;
    bool has_a = reach(w, cell, middle, t0, DEEPEST_REACH, &a), has_b = reach(w, cell, middle, t1, DEEPEST_REACH, &b);
    return (has_a && walk_curve(w, cell, &a, middle, DEEPEST_CHORD)) || (has_b && walk_curve(w, cell, middle, &b, DEEPEST_CHORD));
}

static bool walk_cell(Walk *w, int32_t number) {
    const SkinCell *cell = &w->skin->cells[number];
    SkinPiece pieces[MOST_PIECES];
    int count = skin_cell_pieces(cell, number, w->ray, w->t_min, w->t, pieces);
    bool found = false;
    for (int i = 0; i < count && !(found && w->shadow); i++) {
        const SkinPiece *p = &pieces[i];
        if (p->t0 >= w->t) continue;
        Node middle = {(p->t0 + p->t1) / 2, p->middle, skin_texture_place(cell, &p->middle)};
        found |= walk_piece(w, cell, &middle, p->t0, double_min(p->t1, w->t));
    }
    w->found |= found;
    return found;
}

/* ---- Embree over the cells ---- */

static void intersect_exactly(const struct RTCIntersectFunctionNArguments *args) {
    if (!args->valid[0]) return;
    Walk *w = (Walk *)(void *)args->context;
    struct RTCRayHit *rayhit = (struct RTCRayHit *)(void *)args->rayhit;
    if (!walk_cell(w, (int32_t)args->primID)) return;
    rayhit->ray.tfar = (float)w->t;
    rayhit->hit.geomID = args->geomID;
    rayhit->hit.primID = args->primID;
}

static void occlude_exactly(const struct RTCOccludedFunctionNArguments *args) {
    if (!args->valid[0]) return;
    if (walk_cell((Walk *)(void *)args->context, (int32_t)args->primID)) ((struct RTCRay *)(void *)args->ray)->tfar = -INFINITY;
}

ExactSkin *exact_skin_build(CompiledSkin *skin, void *embree_device) {
    ExactSkin *exact = calloc(1, sizeof *exact);
    if (!exact) return NULL;
    RTCDevice device = embree_device;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, (unsigned)skin->cell_count);
    rtcSetGeometryUserData(geometry, skin);
    rtcSetGeometryBoundsFunction(geometry, skin_bound_cell, NULL);
    rtcSetGeometryIntersectFunction(geometry, intersect_exactly);
    rtcSetGeometryOccludedFunction(geometry, occlude_exactly);
    rtcCommitGeometry(geometry);
    exact->scene = rtcNewScene(device);
    rtcSetSceneFlags(exact->scene, RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(exact->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(exact->scene);
    return exact;
}

void exact_skin_destroy(ExactSkin *exact) {
    if (!exact) return;
    rtcReleaseScene(exact->scene);
    free(exact);
}

/* ---- rays ---- */

static Walk begin_walk(const CompiledSkin *skin, const Ray *ray, double t_min, double t_max, bool shadow, TraceCounters *counters) {
    Walk w = {.skin = skin, .ray = ray, .t_min = t_min, .t = t_max, .shadow = shadow, .chords_left = MOST_CHORDS, .tiles_left = MOST_TILES,
              .counters = counters};
    rtcInitIntersectContext(&w.context);
    return w;
}

static struct RTCRay embree_ray(const Ray *ray, double t_min, double t_max) {
    return (struct RTCRay){.org_x = (float)ray->origin.x, .org_y = (float)ray->origin.y, .org_z = (float)ray->origin.z,
                           .dir_x = (float)ray->direction.x, .dir_y = (float)ray->direction.y, .dir_z = (float)ray->direction.z,
                           .tnear = (float)t_min, .tfar = t_max < 1e30 ? (float)t_max : INFINITY, .mask = 0xFFFFFFFFu};
}

/* Normals transform by the transposed map world → texel. */
static Vec3 normal_in_scene(const TexelCopy *copy, const TexturePlace *place, Vec3 n) {
    Vec3f e = copy->texel->extent;
    Vec3 x = vec3_madd(vec3_scale(place->grad_u, copy->xu), place->grad_v, copy->xv);
    Vec3 z = vec3_madd(vec3_scale(place->grad_u, copy->zu), place->grad_v, copy->zv);
    Vec3 out = vec3_scale(x, (double)e.x * n.x);
    out = vec3_madd(out, place->grad_w, copy->inverse_scale * (double)e.y * n.y);
    return vec3_madd(out, z, (double)e.z * n.z);
}

/* From a place in texel space to the box of scene space that the texel was cut out of. */
static Vec3 place_in_bounds(const BuiltTexel *texel, Vec3 p) {
    Box3 b = texel->def->bounds;
    Vec3 e = vec3_from_f(texel->extent), size = vec3_sub(b.max, b.min);
    return vec3_add(b.min, vec3(p.x / e.x * size.x, p.y / e.y * size.y, p.z / e.z * size.z));
}

static SkinHit describe(const Walk *w) {
    const BuiltTexel *texel = w->copy.texel;
    Vec3 normal = normal_in_scene(&w->copy, &w->at.place, w->hit.normal);
    double stretch = vec3_length(normal); /* of texel space against the scene, along the normal */
    SkinHit out = {.t = w->t, .normal = vec3_normalize(normal), .clearance = stretch > 0 ? CLEARANCE / stretch : 0, .tint = w->copy.tint};
    out.look = w->placed->look;
    if (out.look) { /* laid over the texel: it lives in the scene */
        out.place = vec3_madd(w->ray->origin, w->ray->direction, w->t);
        out.place_normal = out.normal;
        return out;
    }
    out.look = &texel->matter[w->hit.layer].look;
    out.place = place_in_bounds(texel, vec3_sub(point_in_copy(&w->copy, coordinates(&w->at)), w->hit.period));
    out.place_normal = w->hit.normal;
    return out;
}

bool exact_skin_intersect(const CompiledSkin *skin, const Ray *ray, double t_min, double t_max, TraceCounters *counters, SkinHit *hit) {
    Walk w = begin_walk(skin, ray, t_min, t_max, false, counters);
    struct RTCRayHit rayhit = {.ray = embree_ray(ray, t_min, t_max), .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    rtcIntersect1(skin->exact->scene, &w.context, &rayhit);
    if (!w.found) return false;
    *hit = describe(&w);
    return true;
}

bool exact_skin_occluded(const CompiledSkin *skin, const Ray *ray, double t_min, double t_max, TraceCounters *counters) {
    Walk w = begin_walk(skin, ray, t_min, t_max, true, counters);
    struct RTCRay shadow = embree_ray(ray, t_min, t_max);
    rtcOccluded1(skin->exact->scene, &w.context, &shadow);
    return w.found;
}
