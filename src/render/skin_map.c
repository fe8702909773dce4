/* World ↔ skin space: evaluating and inverting the mapping of a cell, going from cell to cell, entering the layer. */
#include "render/skin.h"

#include "render/embree_module.h"
#include "render/embree_ray.h"
#include "render/skin_box.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

enum { NEWTON_STEPS = 12, MOST_HOPS = 64 };

static Vec3 bilinear_vec(const BilinearVec *f, double a, double b) {
    return vec3_madd(vec3_madd(f->c[0], f->c[1], a), vec3_madd(f->c[2], f->c[3], a), b);
}
static Vec3 bilinear_vec_da(const BilinearVec *f, double b) { return vec3_madd(f->c[1], f->c[3], b); }
static Vec3 bilinear_vec_db(const BilinearVec *f, double a) { return vec3_madd(f->c[2], f->c[3], a); }

Vec3 skin_cell_position(const SkinCell *cell, double a, double b, double w, Mat3 *jacobian) {
    Vec3 height = bilinear_vec(&cell->height, a, b);
    if (jacobian) {
        jacobian->c[0] = vec3_madd(bilinear_vec_da(&cell->foot, b), bilinear_vec_da(&cell->height, b), w);
        jacobian->c[1] = vec3_madd(bilinear_vec_db(&cell->foot, a), bilinear_vec_db(&cell->height, a), w);
        jacobian->c[2] = height;
    }
    return vec3_madd(bilinear_vec(&cell->foot, a, b), height, w);
}

/* Corners of the unit square and the unit triangle. */
static const double SQUARE[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, TRIANGLE[3][2] = {{0, 0}, {1, 0}, {0, 1}};

static double bilinear_at(const Bilinear *f, double a, double b) { return f->c[0] + f->c[1] * a + (f->c[2] + f->c[3] * a) * b; }

SkinCorner skin_cell_corner(const SkinCell *cell, int corner) {
    const double *at = cell->triangle ? TRIANGLE[corner] : SQUARE[corner];
    double a = at[0], b = at[1];
    return (SkinCorner){bilinear_vec(&cell->foot, a, b),   bilinear_vec(&cell->height, a, b), bilinear_at(&cell->u, a, b), bilinear_at(&cell->v, a, b),
                        bilinear_at(&cell->w_foot, a, b), bilinear_at(&cell->w_tip, a, b), a, b};
}

static BilinearVec fit_vec(Vec3 p0, Vec3 p1, Vec3 p2, Vec3 p3, bool triangle) {
    BilinearVec f = {{p0, vec3_sub(p1, p0), vec3_sub(triangle ? p2 : p3, p0), {0, 0, 0}}};
    if (!triangle) f.c[3] = vec3_sub(vec3_add(p0, p2), vec3_add(p1, p3));
    return f;
}

static Bilinear fit_scalar(double x0, double x1, double x2, double x3, bool triangle) {
    return (Bilinear){{x0, x1 - x0, (triangle ? x2 : x3) - x0, triangle ? 0 : x0 + x2 - x1 - x3}};
}

void skin_cell_fit(SkinCell *cell, const SkinCorner c[4], bool triangle) {
    cell->triangle = triangle;
    cell->foot = fit_vec(c[0].foot, c[1].foot, c[2].foot, c[3].foot, triangle);
    cell->height = fit_vec(c[0].height, c[1].height, c[2].height, c[3].height, triangle);
    cell->u = fit_scalar(c[0].u, c[1].u, c[2].u, c[3].u, triangle);
    cell->v = fit_scalar(c[0].v, c[1].v, c[2].v, c[3].v, triangle);
    cell->w_foot = fit_scalar(c[0].w_foot, c[1].w_foot, c[2].w_foot, c[3].w_foot, triangle);
    cell->w_tip = fit_scalar(c[0].w_tip, c[1].w_tip, c[2].w_tip, c[3].w_tip, triangle);
    cell->bounds = skin_cell_bounds(cell);
    cell->side = (uint8_t)skin_cell_side(cell, 1);
}

/* One Newton step towards `world`; *error gets the distance before the step. False where the Jacobian is singular. */
static bool newton_step(const SkinCell *cell, Vec3 world, SkinPoint *p, double *error) {
    Mat3 j;
    Vec3 rest = vec3_sub(world, skin_cell_position(cell, p->a, p->b, p->w, &j));
    *error = vec3_length(rest);
    Vec3 bc = vec3_cross(j.c[1], j.c[2]);
    double det = vec3_dot(j.c[0], bc);
    double inverse = 1 / det;
    if (!isfinite(inverse)) return false;
    p->a += vec3_dot(bc, rest) * inverse;
    p->b += vec3_dot(vec3_cross(j.c[2], j.c[0]), rest) * inverse;
    p->w += vec3_dot(vec3_cross(j.c[0], j.c[1]), rest) * inverse;
    return true;
}

bool skin_cell_invert(const SkinCell *cell, Vec3 world, double tolerance, SkinPoint *point) {
    for (int i = 0; i < NEWTON_STEPS; i++) {
        double error;
        if (!newton_step(cell, world, point, &error)) return false;
        if (error <= tolerance) return true; /* the step just made has squared it */
        if (!(fabs(point->a) < 1e3 && fabs(point->b) < 1e3 && fabs(point->w) < 1e3)) return false;
    }
    return false;
}

/* ---- from cell to cell ---- */

/* How far the point is beyond each edge of its cell, in cell units; edges numbered as in surface_mesh.h. */
static int worst_edge(const SkinCell *cell, const SkinPoint *p, double *beyond) {
    double out[4] = {-p->b, 0, 0, -p->a};
    int count = 4;
    if (cell->triangle) {
        out[1] = p->a + p->b - 1;
        out[2] = -p->a;
        count = 3;
    } else {
        out[1] = p->a - 1;
        out[2] = p->b - 1;
    }
    int worst = 0;
    for (int e = 1; e < count; e++)
        if (out[e] > out[worst]) worst = e;
    *beyond = out[worst];
    return worst;
}

/* The place along edge e, 0 at its first corner. */
static double along_edge(const SkinCell *cell, int e, const SkinPoint *p) {
    if (cell->triangle) return e == 0 ? p->a : e == 1 ? (p->b - p->a + 1) / 2 : 1 - p->b;
    return e == 0 ? p->a : e == 1 ? p->b : e == 2 ? 1 - p->a : 1 - p->b;
}

/* The point at `s` along edge e, `in` inside of it. */
static void point_at_edge(const SkinCell *cell, int e, double s, double in, SkinPoint *p) {
    if (cell->triangle) {
        static const double corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
        const double *from = corner[e], *to = corner[(e + 1) % 3], *opposite = corner[(e + 2) % 3];
        double a = from[0] + s * (to[0] - from[0]), b = from[1] + s * (to[1] - from[1]);
        double middle_a = (from[0] + to[0]) / 2, middle_b = (from[1] + to[1]) / 2;
        p->a = a + in * (opposite[0] - middle_a);
        p->b = b + in * (opposite[1] - middle_b);
        return;
    }
    switch (e) {
    case 0: p->a = s, p->b = in; break;
    case 1: p->a = 1 - in, p->b = s; break;
    case 2: p->a = 1 - s, p->b = 1 - in; break;
    default: p->a = in, p->b = 1 - s; break;
    }
}

int skin_cross_edge(const CompiledSkin *skin, int edge, SkinPoint *point) {
    const SkinCell *cell = &skin->cells[point->cell];
    SurfaceNeighbour next = cell->neighbour[edge];
    double s = 1 - along_edge(cell, edge, point);
    point->cell = next.cell;
    point_at_edge(&skin->cells[next.cell], next.edge, s, 0, point);
    return next.edge;
}

SkinSide skin_locate(const CompiledSkin *skin, Vec3 world, double tolerance, SkinPoint *point, bool *crossed_seam) {
    int32_t before = -1;
    for (int hop = 0; hop < MOST_HOPS; hop++) {
        const SkinCell *cell = &skin->cells[point->cell];
        if (!skin_cell_invert(cell, world, tolerance, point)) return SKIN_LOST;
        double beyond;
        int edge = worst_edge(cell, point, &beyond);
        if (beyond <= 0) return point->w > 1 ? SKIN_ABOVE : point->w < 0 ? SKIN_BELOW : SKIN_INSIDE;
        SurfaceNeighbour next = cell->neighbour[edge];
        /* A point on a wall may lie outside of both cells by rounding: the first one keeps it. */
        if (next.cell == before && beyond < 1e-9) return point->w > 1 ? SKIN_ABOVE : point->w < 0 ? SKIN_BELOW : SKIN_INSIDE;
        if (next.cell < 0) return point->w > 1 ? SKIN_ABOVE : point->w < 0 ? SKIN_BELOW : SKIN_BORDER;
        *crossed_seam |= next.seam;
        double s = 1 - along_edge(cell, edge, point);
        before = point->cell;
        point->cell = next.cell;
        point_at_edge(&skin->cells[next.cell], next.edge, double_clamp(s, -2, 3), double_min(beyond, 2), point);
    }
    return SKIN_LOST;
}

/* ---- entering the layer ---- */

Box3 skin_cell_bounds(const SkinCell *cell) {
    Box3 box = box3_empty();
    for (int i = 0; i < 4; i++) {
        double a = i & 1, b = (i >> 1) & 1;
        if (cell->triangle && i == 3) break;
        box = box3_add_point(box, skin_cell_position(cell, a, b, 0, NULL));
        box = box3_add_point(box, skin_cell_position(cell, a, b, 1, NULL));
    }
    return box;
}

/* Newton's method may end on a fold of the mapping beyond the cell: det J has the other sign there. */
static bool is_beyond_fold(const SkinCell *cell, const SkinPoint *p) {
    Mat3 j;
    skin_cell_position(cell, p->a, p->b, p->w, &j);
    double det = mat3_determinant(&j);
    return cell->side == CELL_UPRIGHT ? det < 0 : cell->side == CELL_MIRRORED && det > 0;
}

bool skin_cell_holds(const SkinCell *cell, Vec3 world, double tolerance, SkinPoint *p) {
    double beyond;
    p->a = p->b = cell->triangle ? 1.0 / 3 : 0.5;
    p->w = 0.5;
    bool found = skin_cell_invert(cell, world, tolerance, p);
    if (found) {
        worst_edge(cell, p, &beyond);
        if (beyond <= 1e-7 && p->w >= -1e-7 && p->w <= 1 + 1e-7) return true;
    }
    if (cell->side == CELL_FOLDED || cell->side == CELL_FLAT || (found && !is_beyond_fold(cell, p))) return false;
    SkinPoint place[MOST_PREIMAGES];
    if (!skin_cell_preimages(cell, world, tolerance, place)) return false;
    p->a = place[0].a, p->b = place[0].b, p->w = place[0].w;
    return true;
}

/* Embree's hierarchy over the cells, each a user primitive: built when it is first asked, as a skin that is drawn as geometry alone never is. */
struct CellTree {
    const Embree *embree;
    pthread_mutex_t building;
    _Atomic(RTCScene) scene; /* NULL: not yet */
};

typedef struct EnterQuery {
    struct RTCIntersectContext context; /* first: Embree hands back its address */
    const CompiledSkin *skin;
    const Ray *ray;
    double t_min, t_max;
    SkinPiece *list; /* in the order of t0 */
    int count, most;
} EnterQuery;

static void list_piece(EnterQuery *query, const SkinPiece *piece) {
    int i = query->count;
    if (i == query->most && piece->t0 >= query->list[i - 1].t0) return;
    if (i < query->most) query->count++;
    else i--;
    for (; i > 0 && query->list[i - 1].t0 > piece->t0; i--) query->list[i] = query->list[i - 1];
    query->list[i] = *piece;
}

void skin_bound_cell(const struct RTCBoundsFunctionArguments *args) {
    const CompiledSkin *skin = args->geometryUserPtr;
    Box3 box = skin->cells[args->primID].bounds;
    /* Floats are coarser than doubles: grow by more than their rounding. */
    Vec3 size = vec3_max(vec3_max(vec3_negate(box.min), box.max), vec3_max(box.min, vec3_negate(box.max)));
    double margin = 1e-6 * (size.x + size.y + size.z) + 1e-30;
    struct RTCBounds *b = args->bounds_o;
    b->lower_x = (float)(box.min.x - margin), b->upper_x = (float)(box.max.x + margin);
    b->lower_y = (float)(box.min.y - margin), b->upper_y = (float)(box.max.y + margin);
    b->lower_z = (float)(box.min.z - margin), b->upper_z = (float)(box.max.z + margin);
}

/* Floats at most and at least as large as t. */
static float float_below(double t) { return (float)(t - 1e-7 * fabs(t)); }
static float float_above(double t) { return t < 1e30 ? (float)(t + 1e-7 * fabs(t)) : INFINITY; }

static void intersect_cell(const struct RTCIntersectFunctionNArguments *args) {
    if (!args->valid[0]) return;
    EnterQuery *query = (EnterQuery *)(void *)args->context;
    struct RTCRayHit *rayhit = (struct RTCRayHit *)(void *)args->rayhit;
    SkinPiece pieces[MOST_PIECES];
    int count = skin_cell_pieces(&query->skin->cells[args->primID], (int32_t)args->primID, query->ray, query->t_min, query->t_max, pieces);
    for (int i = 0; i < count; i++) list_piece(query, &pieces[i]);
    if (!count || query->count < query->most) return;
    rayhit->ray.tfar = float_above(query->list[query->count - 1].t0); /* what begins later is not asked for */
    rayhit->hit.geomID = args->geomID;
    rayhit->hit.primID = args->primID;
}

CellTree *cell_tree_create(const Embree *embree) {
    CellTree *tree = calloc(1, sizeof *tree);
    if (!tree) return NULL;
    if (pthread_mutex_init(&tree->building, NULL)) {
        free(tree);
        return NULL;
    }
    tree->embree = embree;
    return tree;
}

void cell_tree_destroy(CellTree *tree) {
    if (!tree) return;
    RTCScene scene = atomic_load(&tree->scene);
    if (scene) tree->embree->rtc->ReleaseScene(scene);
    pthread_mutex_destroy(&tree->building);
    free(tree);
}

static RTCScene build_scene(const CompiledSkin *skin, const Embree *embree) {
    const EmbreeShim *rtc = embree->rtc;
    RTCGeometry geometry = rtc->NewGeometry(embree->device, RTC_GEOMETRY_TYPE_USER);
    rtc->SetGeometryUserPrimitiveCount(geometry, (unsigned)skin->cell_count);
    rtc->SetGeometryUserData(geometry, (void *)(uintptr_t)skin);
    rtc->SetGeometryBoundsFunction(geometry, skin_bound_cell, NULL);
    rtc->SetGeometryIntersectFunction(geometry, intersect_cell);
    rtc->CommitGeometry(geometry);
    RTCScene scene = rtc->NewScene(embree->device);
    rtc->AttachGeometry(scene, geometry);
    rtc->ReleaseGeometry(geometry);
    rtc->CommitScene(scene);
    return scene;
}

static RTCScene scene_of_cells(const CompiledSkin *skin) {
    CellTree *tree = skin->tree;
    RTCScene scene = atomic_load_explicit(&tree->scene, memory_order_acquire);
    if (scene) return scene;
    pthread_mutex_lock(&tree->building);
    scene = atomic_load(&tree->scene);
    if (!scene) atomic_store(&tree->scene, scene = build_scene(skin, tree->embree));
    pthread_mutex_unlock(&tree->building);
    return scene;
}

int skin_first_pieces(const CompiledSkin *skin, const Ray *ray, double t_min, double t_max, SkinPiece *out, int most) {
    SkinStretch within;
    if (skin->box) {
        if (most < 1 || !skin_box_stretch(skin->box, ray, t_min, t_max, &within)) return 0;
        SkinPoint a = within.start, b = within.end;
        out[0] = (SkinPiece){within.t0, within.t1, {0, (a.a + b.a) / 2, (a.b + b.b) / 2, (a.w + b.w) / 2}};
        return 1;
    }
    EnterQuery query = {.skin = skin, .ray = ray, .t_min = t_min, .t_max = t_max, .list = out, .most = most};
    rtcInitIntersectContext(&query.context);
    struct RTCRayHit rayhit = {
        .ray = {.org_x = (float)ray->origin.x, .org_y = (float)ray->origin.y, .org_z = (float)ray->origin.z,
                .dir_x = (float)ray->direction.x, .dir_y = (float)ray->direction.y, .dir_z = (float)ray->direction.z,
                .tnear = float_below(double_max(t_min, 0)), .tfar = float_above(t_max), .mask = 0xFFFFFFFFu},
        .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    if (embree_takes(&rayhit.ray)) skin->tree->embree->rtc->Intersect1(scene_of_cells(skin), &query.context, &rayhit);
    return query.count;
}

bool skin_enter(const CompiledSkin *skin, const Ray *ray, double t_min, double t_max, SkinPoint *point, double *t) {
    SkinPiece piece;
    if (!skin_first_pieces(skin, ray, t_min, t_max, &piece, 1)) return false;
    *point = piece.middle;
    *t = piece.t0;
    return true;
}
