/* What the mapping of single boxes is measured by: places of points that are known by construction, and how far the ways of rays through
 * texture space are from the mapping's own. Boxes stand on one triangle or square; the directions of their heights are (x, 1, z) with x and
 * z drawn from a normal distribution of deviation `spread`, all of one length. */
#ifndef VTS_TESTS_MAPPING_MEASURES_H
#define VTS_TESTS_MAPPING_MEASURES_H

#include "render/skin_fold.h"
#include "skin_scenes.h"

/* ---- boxes ---- */

static inline double measure_normal_number(RandomStream *r) {
    double radius = sqrt(-2 * log(1 - random_next_unit(r)));
    return radius * cos(2 * VTS_PI * random_next_unit(r));
}

static const Vec3 measure_triangle[3] = {{0, 0, 0}, {1, 0, 0}, {.3, 0, .9}};

static inline Vec3 measure_height(RandomStream *r, double spread, double height) {
    double x = measure_normal_number(r) * spread, z = measure_normal_number(r) * spread;
    return vec3_scale(vec3_normalize(vec3(x, 1, z)), height);
}

static inline SkinCell measure_cell(RandomStream *r, bool triangle, double spread, double height) {
    SkinCell cell = {.triangle = triangle};
    Vec3 h[4], corner = triangle ? measure_triangle[2] : vec3(0, 0, 1);
    for (int k = 0; k < 4; k++) h[k] = measure_height(r, spread, height);
    cell.foot = (BilinearVec){{measure_triangle[0], measure_triangle[1], corner, {0, 0, 0}}};
    cell.height = (BilinearVec){{h[0], vec3_sub(h[1], h[0]), vec3_sub(h[2], h[0]), {0, 0, 0}}};
    if (!triangle) cell.height.c[3] = vec3_sub(vec3_add(h[0], h[3]), vec3_add(h[1], h[2]));
    cell.bounds = skin_cell_bounds(&cell);
    cell.side = (uint8_t)skin_cell_side(&cell, 1);
    return cell;
}

static inline double measure_determinant(const SkinCell *cell, const SkinPoint *p) {
    Mat3 j;
    skin_cell_position(cell, p->a, p->b, p->w, &j);
    return mat3_determinant(&j);
}

/* ---- places of points ---- */

/* Nearer than this places are one; where det J is smaller than ON_FOLD the two of a fold may be. */
static const double MEASURE_NEAR = 1e-5, MEASURE_ON_FOLD = 1e-4;

typedef struct PlaceCounts {
    uint64_t boxes, folded; /* one point in each */
    uint64_t several;       /* points with more than one place */
    uint64_t missed, missed_on_folds;
    uint64_t newton_fails, newton_wrong; /* Newton's method alone, from the middle of the box */
    uint64_t wrong_unfolded;             /* the same, of boxes that do not fold; failures too */
    uint64_t lost_unfolded;              /* boxes that do not fold in which skin_cell_holds() does not find it */
    double newton_steps;                 /* mean */
} PlaceCounts;

static inline bool measure_near(const SkinPoint *p, const SkinPoint *q) {
    return fabs(p->a - q->a) + fabs(p->b - q->b) + fabs(p->w - q->w) < MEASURE_NEAR;
}

/* Newton's method from p until the point is met to 1e-12 units; how many steps it took, `most` when it was not. */
static inline int measure_newton(const SkinCell *cell, Vec3 world, int most, SkinPoint *p) {
    for (int i = 0; i < most; i++) {
        Mat3 j;
        Vec3 rest = vec3_sub(world, skin_cell_position(cell, p->a, p->b, p->w, &j));
        if (vec3_length(rest) < 1e-12) return i;
        Mat3 rows = mat3_cofactor(&j); /* the inverse's rows are its columns, over det J */
        double inverse = 1 / mat3_determinant(&j);
        p->a += vec3_dot(rows.c[0], rest) * inverse;
        p->b += vec3_dot(rows.c[1], rest) * inverse;
        p->w += vec3_dot(rows.c[2], rest) * inverse;
    }
    return most;
}

static inline void measure_place(const SkinCell *cell, const SkinPoint *known, PlaceCounts *counts) {
    enum { MOST_STEPS = 20 };
    SkinPoint found[MOST_PREIMAGES], newton = {0, cell->triangle ? 1.0 / 3 : .5, cell->triangle ? 1.0 / 3 : .5, .5};
    Vec3 world = skin_cell_position(cell, known->a, known->b, known->w, NULL);
    int count = skin_cell_preimages(cell, world, 1e-12, found), steps = measure_newton(cell, world, MOST_STEPS, &newton);
    bool hit = false, fails = steps == MOST_STEPS, wrong = !fails && !measure_near(&newton, known);
    for (int i = 0; i < count; i++) hit |= measure_near(&found[i], known);
    bool on_fold = fabs(measure_determinant(cell, known)) < MEASURE_ON_FOLD;
    counts->boxes++;
    counts->folded += cell->side == CELL_FOLDED;
    counts->several += count > 1;
    counts->missed += !hit && !on_fold;
    counts->missed_on_folds += !hit && on_fold;
    counts->newton_fails += fails;
    counts->newton_wrong += wrong;
    counts->wrong_unfolded += cell->side != CELL_FOLDED && (fails || wrong);
    SkinPoint held;
    if (cell->side != CELL_FOLDED && !on_fold)
        counts->lost_unfolded += !skin_cell_holds(cell, world, 1e-12, &held) || !measure_near(&held, known);
    counts->newton_steps += steps;
}

static inline PlaceCounts measure_places(bool triangle, double spread, double height, uint64_t boxes, uint64_t seed) {
    RandomStream r = {seed};
    PlaceCounts counts = {0};
    for (uint64_t i = 0; i < boxes; i++) {
        SkinCell cell = measure_cell(&r, triangle, spread, height);
        SkinPoint p = {0, random_next_unit(&r), random_next_unit(&r), random_next_unit(&r)};
        if (triangle && p.a + p.b > 1) p.a = 1 - p.a, p.b = 1 - p.b;
        measure_place(&cell, &p, &counts);
    }
    counts.newton_steps /= (double)boxes;
    return counts;
}

/* ---- ways of rays ---- */

enum { MEASURE_RESOLUTION = 128, MEASURE_WAYS = 5 };
/* The whole way's chord; one quadratic through its middle; then as they are marched. */
static const char *const measure_way_names[MEASURE_WAYS] = {"chord", "one quadratic", "`straight`", "`box`", "`exact`"};

/* Worst deviation of each way, in voxels of MEASURE_RESOLUTION: median and 95th percentile over the ways. */
typedef struct WayErrors {
    double median[MEASURE_WAYS], percentile_95[MEASURE_WAYS];
    size_t ways;
} WayErrors;

typedef struct WayScene {
    SkinScene scene;
    size_t prisms;
} WayScene;

/* `prisms` boxes apart from each other, none of them folded, each with a tile of its own. */
static inline bool way_scene_begin(WayScene *w, size_t prisms, double spread, double height, RandomStream *r) {
    SkinScene *s = &w->scene;
    w->prisms = prisms;
    skin_scene_begin(s);
    skin_scene_fill(s, MEASURE_RESOLUTION, 500, .15, TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z, 3);
    Vec3 *v = arena_new_array(&s->arena, Vec3, 3 * prisms), *h = arena_new_array(&s->arena, Vec3, 3 * prisms),
         *uv = arena_new_array(&s->arena, Vec3, 3 * prisms);
    uint32_t(*t)[3] = arena_push(&s->arena, prisms * sizeof *t);
    for (size_t i = 0; i < prisms;) {
        SkinCell cell = measure_cell(r, true, spread, height);
        if (cell.side == CELL_FOLDED) continue;
        for (size_t k = 0; k < 3; k++) {
            size_t n = 3 * i + k;
            v[n] = vec3_add(measure_triangle[k], vec3(10 * (double)i, 0, 0));
            h[n] = k ? vec3_add(cell.height.c[0], cell.height.c[k]) : cell.height.c[0];
            uv[n] = vec3(k == 1, k == 2, 0);
            t[i][k] = (uint32_t)n;
        }
        i++;
    }
    s->mesh = (MeshData){.vertices = v, .vertex_count = 3 * prisms, .triangles = (const uint32_t(*)[3])t, .triangle_count = prisms,
                         .uvs = uv, .uv_count = 3 * prisms, .height_vectors = h};
    s->object = (Object){.kind = OBJECT_TRIANGLES, .as.mesh = &s->mesh};
    s->surface = (Surface){.kind = SURFACE_OBJECT, .object = &s->object, .object_height_vectors = h, .subdivide = 1,
                           .transform = transform_identity()};
    return skin_scene_compile(s) == COMPILE_OK;
}

static inline Vec3 measure_coordinates(const SkinCell *cell, const SkinPoint *p) {
    TexturePlace place = skin_texture_place(cell, p);
    return vec3(place.u, place.v, place.w);
}

static inline double measure_deviation(Vec3 a, Vec3 b) {
    Vec3 d = vec3_sub(a, b);
    return MEASURE_RESOLUTION * fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z)));
}

/* The worst of a march's texture coordinates on the way from x0 to x1; negative when it met nothing. */
static inline double measure_march(SkinScene *s, RayPath path, Vec3 x0, Vec3 x1, const SkinPoint *start) {
    const SkinCell *cell = &s->compiled.skins[0].cells[start->cell];
    double length = vec3_length(vec3_sub(x1, x0)), worst = -1;
    Cone cone = {x0, vec3_normalize(vec3_sub(x1, x0)), 1e-4, 0};
    MarchSettings settings = s->compiled.march;
    TraceCounters counters = {0};
    SkinSegment segment;
    SkinMarch *m = &s->march;
    SkinPoint at = *start;
    settings.path = path;
    skin_march_begin(m, &cone, 0, length, &settings, &counters, false);
    while (skin_march_next(m, &segment)) {
        double t = (segment.t0 + segment.t1) / 2, from = t - m->span.t0;
        Vec3 got = vec3_madd(vec3_madd(m->span.c0, m->span.c1, from), m->span.c2, from * from);
        if (skin_cell_invert(cell, cone_point(&cone, t), 1e-12, &at)) worst = fmax(worst, measure_deviation(got, measure_coordinates(cell, &at)));
    }
    return worst;
}

/* The worst of the chord and of the quadratic through the middle of the way. */
static inline void measure_curves(const SkinCell *cell, const SkinPoint *p0, const SkinPoint *p1, double *chord, double *quadratic) {
    enum { SAMPLES = 16 };
    Vec3 x0 = skin_cell_position(cell, p0->a, p0->b, p0->w, NULL), x1 = skin_cell_position(cell, p1->a, p1->b, p1->w, NULL);
    Vec3 c0 = measure_coordinates(cell, p0), c1 = measure_coordinates(cell, p1);
    SkinPoint at = *p0, middle = *p0;
    *chord = *quadratic = 0;
    skin_cell_invert(cell, vec3_lerp(x0, x1, .5), 1e-12, &middle);
    Vec3 cm = measure_coordinates(cell, &middle);
    for (int i = 1; i < SAMPLES; i++) {
        double t = (double)i / SAMPLES;
        if (!skin_cell_invert(cell, vec3_lerp(x0, x1, t), 1e-12, &at)) continue;
        Vec3 truth = measure_coordinates(cell, &at), q = vec3_scale(c0, (1 - t) * (1 - 2 * t));
        q = vec3_madd(vec3_madd(q, cm, 4 * t * (1 - t)), c1, t * (2 * t - 1));
        *chord = fmax(*chord, measure_deviation(vec3_lerp(c0, c1, t), truth));
        *quadratic = fmax(*quadratic, measure_deviation(q, truth));
    }
}

static inline int measure_compare(const void *a, const void *b) {
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* One way through each of so many prisms. */
static inline WayErrors measure_ways(size_t prisms, double spread, double height, uint64_t seed) {
    static const RayPath paths[MEASURE_WAYS] = {0, 0, RAY_PATH_STRAIGHT, RAY_PATH_BOX, RAY_PATH_EXACT};
    static WayScene w;
    RandomStream r = {seed};
    WayErrors out = {0};
    double *errors = malloc(MEASURE_WAYS * prisms * sizeof *errors);
    bool ready = way_scene_begin(&w, prisms, spread, height, &r);
    for (size_t i = 0; ready && errors && i < prisms; i++) {
        const SkinCell *cell = &w.scene.compiled.skins[0].cells[i];
        SkinPoint p0 = {(int32_t)i, between(&r, .1, .3), between(&r, .1, .3), random_next_unit(&r)};
        SkinPoint p1 = {(int32_t)i, between(&r, .2, .7), between(&r, 0, .3), random_next_unit(&r)};
        Vec3 x0 = skin_cell_position(cell, p0.a, p0.b, p0.w, NULL), x1 = skin_cell_position(cell, p1.a, p1.b, p1.w, NULL);
        double e[MEASURE_WAYS];
        bool met = true;
        measure_curves(cell, &p0, &p1, &e[0], &e[1]);
        for (int k = 2; k < MEASURE_WAYS; k++) met &= (e[k] = measure_march(&w.scene, paths[k], x0, x1, &p0)) >= 0;
        if (!met) continue;
        for (int k = 0; k < MEASURE_WAYS; k++) errors[(size_t)k * prisms + out.ways] = e[k];
        out.ways++;
    }
    for (size_t k = 0; k < MEASURE_WAYS && out.ways; k++) {
        double *list = errors + k * prisms;
        qsort(list, out.ways, sizeof *list, measure_compare);
        out.median[k] = list[out.ways / 2], out.percentile_95[k] = list[out.ways * 95 / 100];
    }
    free(errors);
    skin_scene_end(&w.scene);
    return out;
}

#endif
