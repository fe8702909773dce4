#include "render/exact_skin.h"

#include "render/embree_module.h"
#include "render/embree_ray.h"
#include "render/skin_cross.h"
#include "render/skin_fold.h"

#include <stdlib.h>

/* A cell as the hierarchy knows it. */
typedef struct ExactCell {
    const CompiledSkin *skin;
    const SkinCell *cell;
    double size;         /* diagonal of its box */
    TexturePlace middle; /* of an affine cell */
    Vec3 middle_world;
    bool affine; /* rays are straight in its texture space */
} ExactCell;

struct ExactSkins {
    const EmbreeShim *rtc;
    RTCScene scene;
    ExactCell *cells;
    size_t cell_count;
    Box3 bounds;
    Vec3 origin; /* Embree's floats count from here */
};

/* Cubics are cut until they are as near to the ray's way as CURVE_ERROR, as far as their ends tell, in tiles and heights of the texel;
 * what comes within MARGIN of one is looked at on the way itself. MOST_BOW: the farther a cubic may leave its chord, the fewer of them,
 * but the more triangles to look at. */
static const double CURVE_ERROR = 3e-4, MARGIN = 3e-3, MOST_BOW = 0.05;
/* How near, in texel space, a hit lies to the plane of its triangle; and from where on other matter is told from it. */
static const double HIT_ERROR = 1e-9, CLEARANCE = 1e-5;
/* A ray that needs more is lost in absurd coordinates; it ends there. */
enum { MOST_CUBICS = 1 << 16, MOST_TILES = 1 << 18, DEEPEST_CUT = 14, DEEPEST_REACH = 10, MOST_SETTLING = 6 };
static const double LARGEST_COORDINATE = 1e9;

/* A place on the ray within a cell. */
typedef struct Node {
    double t;
    SkinPoint point;
    TexturePlace place;
} Node;

typedef struct Walk {
    struct RTCIntersectContext context; /* first: Embree hands back its address */
    const ExactSkins *exact;
    const Ray *ray;
    double t_min, t; /* nearest hit so far, or the end */
    double embree_start; /* Embree's t counts from here */
    bool shadow, found;
    int cubics_left, tiles_left;
    TraceCounters *counters;
    /* of the nearest hit */
    Node at;
    TexelCopy copy;
    ExactTexelHit hit;
    const PlacedTexel *placed;
} Walk;

/* ---- the curve ---- */

static bool find_node(const Walk *w, const ExactCell *c, double t, SkinPoint guess, Node *out) {
    Vec3 world = vec3_madd(w->ray->origin, w->ray->direction, t);
    if (!skin_cell_invert(c->cell, world, 1e-6 * c->size, &guess)) return false; /* whose last step squares the residual */
    const double slack = 0.5 + 1e-3;
    if (!(fabs(guess.a - 0.5) < slack && fabs(guess.b - 0.5) < slack && fabs(guess.w - 0.5) < slack)) return false;
    *out = (Node){t, guess, skin_texture_place(c->cell, &guess)};
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
static bool reach(const Walk *w, const ExactCell *c, const Node *from, double t, int depth, Node *out) {
    if (find_node(w, c, t, guess_from(w, from, t), out) && (c->cell->side != CELL_FOLDED || same_sheet(from, out))) return true;
    Node half;
    return depth > 0 && reach(w, c, from, (from->t + t) / 2, depth - 1, &half) && reach(w, c, &half, t, depth - 1, out);
}

static Vec3 coordinates(const Node *n) { return vec3(n->place.u, n->place.v, n->place.w); }

static Vec3 coordinate_rate(const Walk *w, const Node *n) {
    Vec3 d = w->ray->direction;
    return vec3(vec3_dot(n->place.grad_u, d), vec3_dot(n->place.grad_v, d), vec3_dot(n->place.grad_w, d));
}

static double largest_part(Vec3 v) { return double_max(fabs(v.x), double_max(fabs(v.y), fabs(v.z))); }

static Curve straight(const Node *a, const Node *b) {
    return (Curve){.from = coordinates(a), .chord = vec3_sub(coordinates(b), coordinates(a)), .length = 1};
}

static Curve cubic_between(const Walk *w, const Node *a, const Node *b) {
    Curve c = straight(a, b);
    double length = b->t - a->t;
    c.bow_from = vec3_sub(vec3_scale(coordinate_rate(w, a), length), c.chord);
    c.bow_to = vec3_sub(vec3_scale(coordinate_rate(w, b), length), c.chord);
    return c;
}

/* Whether the cubic is good enough. Its error comes from the way's fourth derivative. For a parabola the bows are opposite, their sum tells
 * the third, and each derivative is taken to be smaller than the one before as the third is than the second: (6·sum)·(3·sum/bow)/384, and as
 * much again for safety. Where the sum happens to be small, the ratio of the second to the first says as much: bow³/chord². */
static bool good_enough(const Curve *c) {
    double bow = double_max(largest_part(c->bow_from), largest_part(c->bow_to)), sum = largest_part(vec3_add(c->bow_from, c->bow_to));
    double chord = largest_part(c->chord);
    return bow <= 4 * MOST_BOW && sum * sum <= 10 * CURVE_ERROR * bow && bow * bow * bow <= CURVE_ERROR * chord * chord;
}

/* ---- cubics against copies ---- */

/* A cubic from a to b, and the copy that it is shot against. */
typedef struct Shot {
    Walk *walk;
    const ExactCell *cell;
    const Node *a, *b;
    const PlacedTexel *placed;
    const TexelCopy *copy;
    double nearest; /* s of the nearest hit so far, or the end */
    bool found, enough;
} Shot;

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

static Curve curve_in_copy(const TexelCopy *copy, const Curve *c) {
    return (Curve){point_in_copy(copy, c->from), way_in_copy(copy, c->chord), way_in_copy(copy, c->bow_from), way_in_copy(copy, c->bow_to),
                   c->start, c->length};
}

/* A node of an affine cell, without inverting. */
static Node affine_node(const Walk *w, const ExactCell *c, double t) {
    Node n = {t, {0, 0, 0, 0}, c->middle};
    Vec3 way = vec3_sub(vec3_madd(w->ray->origin, w->ray->direction, t), c->middle_world);
    n.place.u += vec3_dot(c->middle.grad_u, way);
    n.place.v += vec3_dot(c->middle.grad_v, way);
    n.place.w += vec3_dot(c->middle.grad_w, way);
    double share = c->cell->triangle ? 1.0 / 3 : 0.5;
    n.point.a = share + vec3_dot(c->middle.grad_a, way);
    n.point.b = share + vec3_dot(c->middle.grad_b, way);
    n.point.w = 0.5 + vec3_dot(c->middle.grad_layer, way);
    return n;
}

/* The node at t, from one that is known nearby. */
static bool node_near(const Shot *shot, const Node *known, double t, Node *out) {
    if (!shot->cell->affine) return find_node(shot->walk, shot->cell, t, guess_from(shot->walk, known, t), out);
    *out = affine_node(shot->walk, shot->cell, t);
    return true;
}

/* Moves along the ray to the plane of the hit's triangle, as the curved mapping has it. False when it is not to be found there. */
static bool settle_in_plane(const Shot *shot, const ExactTexelHit *hit, Node *at) {
    double length = shot->b->t - shot->a->t, t = shot->a->t + hit->s * length, most = 0.1 * length;
    *at = *(hit->s < 0.5 ? shot->a : shot->b);
    for (int i = 0; i < MOST_SETTLING; i++) {
        Node next;
        if (!node_near(shot, at, t, &next)) return false;
        *at = next;
        double miss = vec3_dot(hit->normal, vec3_sub(point_in_copy(shot->copy, coordinates(at)), hit->corner));
        if (fabs(miss) <= HIT_ERROR) return true;
        double step = -miss / vec3_dot(hit->normal, way_in_copy(shot->copy, coordinate_rate(shot->walk, at)));
        if (!(fabs(step) <= most)) return false; /* the triangle is seen edge-on */
        t += step;
        most = fabs(step) / 2;
    }
    return true;
}

static bool settle(void *context, ExactTexelHit *hit) {
    Shot *shot = context;
    Walk *w = shot->walk;
    Node at;
    if (!settle_in_plane(shot, hit, &at) || !(at.t > w->t_min && at.t < w->t)) return false;
    Vec3 point = point_in_copy(shot->copy, coordinates(&at));
    if (!exact_texel_covers(shot->copy->texel->exact, hit, point, 0)) return false;
    shot->found = true;
    if (w->shadow) return shot->enough = true;
    shot->nearest = (at.t - shot->a->t) / (shot->b->t - shot->a->t);
    w->t = at.t;
    w->at = at;
    w->copy = *shot->copy;
    w->hit = *hit;
    w->placed = shot->placed;
    return false;
}

/* Tries one copy from s0 on. */
static void shoot_copy(Shot *shot, const TexelCopy *copy, const Curve *curve, double s0, unsigned repeat) {
    ExactWay way = {shot->cell->affine ? 0 : MARGIN, &shot->nearest, settle, shot};
    Curve inside = curve_in_copy(copy, curve);
    shot->copy = copy;
    exact_texel_shoot(copy->texel->exact, &inside, s0, repeat, &way);
}

/* Tries all copies around the tiles that the curve may be in. */
static void shoot_tiles(Shot *shot, const Curve *curve, double s0) {
    const double hair = 1e-7;
    const PlacedTexel *placed = shot->placed;
    unsigned repeat = placed->cyclic || placed->turns ? TEXEL_CYCLIC_Y : 0;
    Box3 hull = curve_hull(curve);
    int64_t u0 = (int64_t)floor(hull.min.x + hair), u1 = (int64_t)floor(hull.max.x - hair);
    int64_t v0 = (int64_t)floor(hull.min.y + hair), v1 = (int64_t)floor(hull.max.y - hair);
    int side = 2 * placed->reach + 1;
    for (int64_t iu = u0; iu <= u1 || iu == u0; iu++)
        for (int64_t iv = v0; iv <= v1 || iv == v0; iv++)
            for (int k = 0; k < side * side && !shot->enough; k++) {
                TexelCopy copy;
                if (skin_copy_near(shot->cell->skin, shot->cell->cell, placed, iu, iv, k, &copy)) shoot_copy(shot, &copy, curve, s0, copy.texel->def->cyclic & repeat);
            }
}

/* The same of a curve of any length: in halves, until they are no longer than a tile. */
static void shoot_along(Shot *shot, const Curve *curve, double s0) {
    if (s0 > 1 || curve->start > shot->nearest || shot->enough || shot->walk->tiles_left-- <= 0) return;
    if (fabs(curve->chord.x) <= 1.01 && fabs(curve->chord.y) <= 1.01) {
        shoot_tiles(shot, curve, s0);
        return;
    }
    Curve half = curve_part(curve, 0, 0.5);
    shoot_along(shot, &half, 2 * s0);
    half = curve_part(curve, 0.5, 1);
    shoot_along(shot, &half, double_max(0, 2 * s0 - 1));
}

static void shoot_texel(Shot *shot, const Curve *curve, double s0) {
    if (!shot->placed->alike) {
        shoot_along(shot, curve, s0);
        return;
    }
    TexelCopy copy; /* one, endless */
    if (texel_copy_near(shot->placed, (int64_t)floor(curve->from.x), (int64_t)floor(curve->from.y), 0, &copy))
        shoot_copy(shot, &copy, curve, s0, copy.texel->def->cyclic);
}

static bool shoot_curve(Walk *w, const ExactCell *c, const Node *a, const Node *b, const Curve *curve) {
    double length = b->t - a->t, s0 = double_max(0, (w->t_min - a->t) / length);
    Shot shot = {.walk = w, .cell = c, .a = a, .b = b, .nearest = double_min(1, (w->t - a->t) / length)};
    if (!(largest_part(curve->from) < LARGEST_COORDINATE && largest_part(curve->chord) < LARGEST_COORDINATE)) return false;
    w->counters->steps++;
    w->cubics_left--;
    for (size_t i = 0; i < c->skin->texel_count && !shot.enough; i++) {
        shot.placed = &c->skin->texels[i];
        if (skin_cell_bears(c->cell, shot.placed)) shoot_texel(&shot, curve, s0);
    }
    return shot.found;
}

static bool walk_curve(Walk *w, const ExactCell *c, const Node *a, const Node *b, int depth) {
    if (w->cubics_left <= 0 || !(b->t > a->t)) return false;
    Node middle;
    Curve curve = cubic_between(w, a, b);
    if (good_enough(&curve)) return shoot_curve(w, c, a, b, &curve);
    if (depth == 0 || !reach(w, c, a, (a->t + b->t) / 2, DEEPEST_REACH, &middle)) { /* singular: its rates tell nothing */
        curve = straight(a, b);
        return shoot_curve(w, c, a, b, &curve);
    }
    return walk_curve(w, c, a, &middle, depth - 1) || walk_curve(w, c, &middle, b, depth - 1);
}

/* ---- cells ---- */

/* The piece of the ray from t0 to t1 that lies in the cell, `middle` half way. */
static bool walk_piece(Walk *w, const ExactCell *c, const Node *middle, double t0, double t1) {
    Node a, b;
    bool has_a = reach(w, c, middle, t0, DEEPEST_REACH, &a), has_b = reach(w, c, middle, t1, DEEPEST_REACH, &b);
    return (has_a && walk_curve(w, c, &a, middle, DEEPEST_CUT)) || (has_b && walk_curve(w, c, middle, &b, DEEPEST_CUT));
}

/* A folded cell, or a ray along an edge: each piece for itself, and all of them, since sheets overlap. */
static bool walk_pieces(Walk *w, const ExactCell *c) {
    SkinPiece pieces[MOST_PIECES];
    int count = skin_cell_pieces(c->cell, 0, w->ray, w->t_min, w->t, pieces);
    bool found = false;
    for (int i = 0; i < count && !(found && w->shadow); i++) {
        const SkinPiece *p = &pieces[i];
        if (p->t0 >= w->t) continue;
        Node middle = {(p->t0 + p->t1) / 2, p->middle, skin_texture_place(c->cell, &p->middle)};
        found |= walk_piece(w, c, &middle, p->t0, double_min(p->t1, w->t));
    }
    return found;
}

static Node node_at(const ExactCell *c, const SkinCrossing *x) {
    SkinPoint point = {0, x->a, x->b, x->w};
    return (Node){x->t, point, skin_texture_place(c->cell, &point)};
}

/* A line that passes the walls twice is inside in between. */
static bool walk_between(Walk *w, const ExactCell *c, const SkinCrossing *in, const SkinCrossing *out) {
    if (!(out->t > w->t_min && in->t < w->t)) return false;
    Node a = node_at(c, in), b = node_at(c, out), end;
    if (a.t < w->t_min && reach(w, c, &a, w->t_min, DEEPEST_REACH, &end)) a = end;
    if (b.t > w->t && reach(w, c, &a, w->t, DEEPEST_REACH, &end)) b = end;
    return walk_curve(w, c, &a, &b, DEEPEST_CUT);
}

/* Narrows [*t0, *t1] to where x + t·d >= 0. */
static void keep_positive(double x, double d, double *t0, double *t1) {
    if (d > 0) *t0 = double_max(*t0, -x / d);
    else if (d < 0) *t1 = double_min(*t1, -x / d);
    else if (x < 0) *t1 = -VTS_INFINITY;
}

static bool walk_straight(Walk *w, const ExactCell *c) {
    Node zero = affine_node(w, c, 0);
    Vec3 d = w->ray->direction;
    double a = zero.point.a, b = zero.point.b, h = zero.point.w, t0 = w->t_min, t1 = w->t;
    double da = vec3_dot(c->middle.grad_a, d), db = vec3_dot(c->middle.grad_b, d), dh = vec3_dot(c->middle.grad_layer, d);
    keep_positive(a, da, &t0, &t1);
    keep_positive(b, db, &t0, &t1);
    keep_positive(h, dh, &t0, &t1);
    keep_positive(1 - h, -dh, &t0, &t1);
    if (c->cell->triangle) {
        keep_positive(1 - a - b, -da - db, &t0, &t1);
    } else {
        keep_positive(1 - a, -da, &t0, &t1);
        keep_positive(1 - b, -db, &t0, &t1);
    }
    if (!(t0 < t1)) return false;
    Node from = affine_node(w, c, t0), to = affine_node(w, c, t1);
    Curve line = straight(&from, &to);
    return shoot_curve(w, c, &from, &to, &line);
}

static bool walk_cell(Walk *w, const ExactCell *c) {
    SkinCrossing crossings[MOST_CROSSINGS];
    if (c->affine) return walk_straight(w, c);
    if (c->cell->side == CELL_FLAT) return false;
    if (c->cell->side == CELL_FOLDED) return walk_pieces(w, c);
    int count = skin_cell_cross(c->cell, w->ray, -VTS_INFINITY, VTS_INFINITY, crossings);
    if (count == 0) return false;
    return count == 2 ? walk_between(w, c, &crossings[0], &crossings[1]) : walk_pieces(w, c);
}

/* ---- Embree over the cells ---- */

static void intersect_exactly(const struct RTCIntersectFunctionNArguments *args) {
    if (!args->valid[0]) return;
    Walk *w = (Walk *)(void *)args->context;
    struct RTCRayHit *rayhit = (struct RTCRayHit *)(void *)args->rayhit;
    if (!walk_cell(w, &w->exact->cells[args->primID])) return;
    w->found = true;
    rayhit->ray.tfar = (float)(w->t - w->embree_start);
    rayhit->hit.geomID = args->geomID;
    rayhit->hit.primID = args->primID;
}

static void occlude_exactly(const struct RTCOccludedFunctionNArguments *args) {
    Walk *w = (Walk *)(void *)args->context;
    if (!args->valid[0] || !walk_cell(w, &w->exact->cells[args->primID])) return;
    w->found = true;
    ((struct RTCRay *)(void *)args->ray)->tfar = -INFINITY;
}

static void bound_exactly(const struct RTCBoundsFunctionArguments *args) {
    const ExactSkins *exact = args->geometryUserPtr;
    Box3 all = exact->bounds, box = exact->cells[args->primID].cell->bounds;
    /* Floats are coarser than doubles: grow by more than they lose on the way across the scene. */
    Vec3 size = vec3_sub(all.max, all.min), o = exact->origin;
    double margin = 1e-6 * (size.x + size.y + size.z) + 1e-30;
    struct RTCBounds *b = args->bounds_o;
    b->lower_x = (float)(box.min.x - o.x - margin), b->upper_x = (float)(box.max.x - o.x + margin);
    b->lower_y = (float)(box.min.y - o.y - margin), b->upper_y = (float)(box.max.y - o.y + margin);
    b->lower_z = (float)(box.min.z - o.z - margin), b->upper_z = (float)(box.max.z - o.z + margin);
}

static bool vec_is_zero(Vec3 v) { return v.x == 0 && v.y == 0 && v.z == 0; }

/* Whether texture coordinates are an affine function of the scene's in the whole box. */
static bool cell_is_affine(const SkinCell *c) {
    const BilinearVec *h = &c->height;
    const Bilinear *f = &c->w_foot, *t = &c->w_tip;
    for (int i = 1; i < 4; i++)
        if (!vec_is_zero(h->c[i]) || f->c[i] != t->c[i]) return false;
    return vec_is_zero(c->foot.c[3]) && c->u.c[3] == 0 && c->v.c[3] == 0 && f->c[3] == 0;
}

static ExactCell make_cell(const CompiledSkin *skin, const SkinCell *cell) {
    double share = cell->triangle ? 1.0 / 3 : 0.5;
    SkinPoint middle = {0, share, share, 0.5};
    ExactCell c = {.skin = skin, .cell = cell, .size = vec3_length(vec3_sub(cell->bounds.max, cell->bounds.min))};
    c.middle = skin_texture_place(cell, &middle);
    c.middle_world = skin_cell_position(cell, share, share, 0.5, NULL);
    c.affine = cell_is_affine(cell) && !vec_is_zero(c.middle.grad_layer); /* which is zero where the box has no volume */
    return c;
}

static bool collect_cells(ExactSkins *exact, const CompiledSkin *skins, size_t count) {
    for (size_t i = 0; i < count; i++) exact->cell_count += skins[i].cell_count;
    exact->cells = malloc((exact->cell_count + 1) * sizeof *exact->cells);
    if (!exact->cells) return false;
    size_t n = 0;
    exact->bounds = box3_empty();
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < skins[i].cell_count; k++) {
            exact->cells[n] = make_cell(&skins[i], &skins[i].cells[k]);
            exact->bounds = box3_union(exact->bounds, exact->cells[n++].cell->bounds);
        }
    exact->origin = vec3_lerp(exact->bounds.min, exact->bounds.max, 0.5);
    if (!vec3_is_finite(exact->origin)) exact->origin = vec3(0, 0, 0);
    return true;
}

ExactSkins *exact_skins_build(const CompiledSkin *skins, size_t count, const Embree *embree) {
    ExactSkins *exact = calloc(1, sizeof *exact);
    if (!exact || !collect_cells(exact, skins, count)) {
        free(exact);
        return NULL;
    }
    const EmbreeShim *rtc = exact->rtc = embree->rtc;
    RTCGeometry geometry = rtc->NewGeometry(embree->device, RTC_GEOMETRY_TYPE_USER);
    rtc->SetGeometryUserPrimitiveCount(geometry, (unsigned)exact->cell_count);
    rtc->SetGeometryUserData(geometry, exact);
    rtc->SetGeometryBoundsFunction(geometry, bound_exactly, NULL);
    rtc->SetGeometryIntersectFunction(geometry, intersect_exactly);
    rtc->SetGeometryOccludedFunction(geometry, occlude_exactly);
    rtc->CommitGeometry(geometry);
    exact->scene = rtc->NewScene(embree->device);
    rtc->SetSceneFlags(exact->scene, RTC_SCENE_FLAG_ROBUST);
    rtc->AttachGeometry(exact->scene, geometry);
    rtc->ReleaseGeometry(geometry);
    rtc->CommitScene(exact->scene);
    return exact;
}

void exact_skins_destroy(ExactSkins *exact) {
    if (!exact) return;
    exact->rtc->ReleaseScene(exact->scene);
    free(exact->cells);
    free(exact);
}

/* ---- rays ---- */

/* False when the ray passes by all skins. Embree's ray begins where it comes near them, so that its floats tell cells apart from afar too. */
static bool begin_walk(Walk *w, const ExactSkins *exact, const Ray *ray, double t_min, double t_max, bool shadow, TraceCounters *counters,
                       struct RTCRay *embree) {
    double near = t_min, far = t_max;
    if (!exact || !box3_clip_ray(exact->bounds, ray, &near, &far)) return false;
    *w = (Walk){.exact = exact, .ray = ray, .t_min = t_min, .t = t_max, .embree_start = near, .shadow = shadow, .cubics_left = MOST_CUBICS,
                .tiles_left = MOST_TILES, .counters = counters};
    rtcInitIntersectContext(&w->context);
    Vec3 o = vec3_sub(vec3_madd(ray->origin, ray->direction, near), exact->origin), d = ray->direction;
    *embree = (struct RTCRay){.org_x = (float)o.x, .org_y = (float)o.y, .org_z = (float)o.z, .dir_x = (float)d.x, .dir_y = (float)d.y,
                              .dir_z = (float)d.z, .tfar = t_max - near < 1e30 ? (float)(t_max - near) : INFINITY, .mask = 0xFFFFFFFFu};
    return embree_takes(embree);
}

/* From a place in texel space to the box of scene space that the texel was cut out of. */
static Vec3 place_in_bounds(const BuiltTexel *texel, Vec3 p) {
    Box3 b = texel->def->bounds;
    Vec3 e = vec3_from_f(texel->extent), size = vec3_sub(b.max, b.min);
    return vec3_add(b.min, vec3(p.x / e.x * size.x, p.y / e.y * size.y, p.z / e.z * size.z));
}

static SkinHit describe(const Walk *w) {
    const BuiltTexel *texel = w->copy.texel;
    Vec3 at = point_in_copy(&w->copy, coordinates(&w->at)), round = exact_texel_normal(&w->hit, at);
    Vec3 flat = texel_normal_in_scene(&w->copy, &w->at.place, w->hit.normal), normal = texel_normal_in_scene(&w->copy, &w->at.place, round);
    double stretch = vec3_length(flat); /* of texel space against the scene, along the normal */
    SkinHit out = {.t = w->t, .normal = vec3_normalize(normal), .flat = vec3_normalize(flat), .clearance = stretch > 0 ? CLEARANCE / stretch : 0, .tint = w->copy.tint,
                   .up = vec3_normalize(w->at.place.grad_layer)};
    out.look = w->placed->look;
    if (out.look) { /* laid over the texel: it lives in the scene */
        out.place = vec3_madd(w->ray->origin, w->ray->direction, w->t);
        out.place_normal = out.normal;
        return out;
    }
    out.look = &texel->matter[w->hit.layer].look;
    out.place = place_in_bounds(texel, vec3_sub(at, w->hit.period));
    out.place_normal = round;
    return out;
}

bool exact_skins_intersect(const ExactSkins *exact, const Ray *ray, double t_min, double t_max, TraceCounters *counters, SkinHit *hit) {
    Walk w;
    struct RTCRayHit rayhit = {.hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    if (!begin_walk(&w, exact, ray, t_min, t_max, false, counters, &rayhit.ray)) return false;
    exact->rtc->Intersect1(exact->scene, &w.context, &rayhit);
    if (!w.found) return false;
    *hit = describe(&w);
    return true;
}

bool exact_skins_occluded(const ExactSkins *exact, const Ray *ray, double t_min, double t_max, TraceCounters *counters) {
    Walk w;
    struct RTCRay shadow;
    if (!begin_walk(&w, exact, ray, t_min, t_max, true, counters, &shadow)) return false;
    exact->rtc->Occluded1(exact->scene, &w.context, &shadow);
    return w.found;
}
