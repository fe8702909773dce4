/* The view pass: steps along a line of sight through all volumes, in each of which light is scattered that comes straight from lamps, and light that was kept. */
#include "render/volume_light.h"
#include "render/volume_shoot.h"

enum { MOST_STEPS = 1024 };
/* Steps of this optical depth at most, the shorter the finer the light is known, as long as a cell of the density, and of what lamps are known in. */
static const double MOST_STEP_DEPTH = 0.25;
/* What is behind so much is not seen. */
static const double OPAQUE_BELOW = 1e-4;

typedef struct Step {
    double t0, t1, length; /* length: integral of density */
    double before;         /* of it since the volume was entered */
    int volume;
} Step;

typedef struct Gathering {
    SurfaceTracer *tracer;
    const VolumeSet *set;
    Ray ray;
    Step steps[MOST_STEPS];
    int count;
} Gathering;

static double densest(const CompiledVolume *v) { return double_max(v->thinned[0], double_max(v->thinned[1], v->thinned[2])); }

/* How far a step may go. */
static double stride_of(const CompiledVolume *v, const Ray *cells) {
    const VolumeLight *light = v->light;
    double density = vec3_length(cells->direction), lamps = 0;
    for (int k = 0; k < 3; k++) {
        double d = vec3_get(cells->direction, k) * light->cells[k] / v->lattice.size[k];
        lamps += d * d;
    }
    return 1 / double_max(density, sqrt(lamps));
}

static void add_step(Gathering *g, int volume, double t0, double t1, double length, double *before) {
    if (g->count == MOST_STEPS) { /* coarser at the end */
        Step *last = &g->steps[MOST_STEPS - 1];
        if (last->volume == volume) last->t1 = t1, last->length += length;
    } else {
        g->steps[g->count++] = (Step){t0, t1, length, *before, volume};
    }
    *before += length;
}

static void add_volume(Gathering *g, int number, double t_max) {
    const CompiledVolume *v = &g->set->items[number];
    VolumeSpan spans[VOLUME_MOST_SPANS];
    int count = volume_spans(v, &g->ray, 0, t_max, spans);
    Ray cells = volume_ray_in_cells(v, &g->ray);
    double stride = stride_of(v, &cells), most = densest(v), before = 0, step_depth = MOST_STEP_DEPTH / g->set->fineness;
    for (int i = 0; i < count && most * before < -log(OPAQUE_BELOW); i++) {
        LatticeWalk walk;
        LatticePiece piece;
        Step open = {.length = 0};
        lattice_walk_begin(&walk, &v->lattice, &cells, spans[i].t0, spans[i].t1);
        while (lattice_walk_next(&walk, &piece) && most * before < -log(OPAQUE_BELOW)) {
            bool joins = open.length > 0 && open.t1 >= piece.t0 - 1e-9 * piece.t1 && piece.t1 - open.t0 <= stride && most * (open.length + piece.length) <= step_depth;
            if (joins) {
                open.t1 = piece.t1, open.length += piece.length;
                continue;
            }
            if (open.length > 0) add_step(g, number, open.t0, open.t1, open.length, &before);
            open.length = 0;
            int parts = (int)double_clamp(ceil(double_max(most * piece.length / step_depth, (piece.t1 - piece.t0) / stride)), 1, MOST_STEPS);
            if (parts == 1) {
                open = (Step){.t0 = piece.t0, .t1 = piece.t1, .length = piece.length};
                continue;
            }
            double t0 = piece.t0;
            for (int k = 1; k <= parts && most * before < -log(OPAQUE_BELOW); k++) {
                double t1 = k < parts ? lattice_piece_invert(&walk, &piece, piece.length * k / parts) : piece.t1;
                add_step(g, number, t0, t1, piece.length / parts, &before);
                t0 = t1;
            }
        }
        if (open.length > 0) add_step(g, number, open.t0, open.t1, open.length, &before);
    }
}

/* The integral of density of the steps [begin, end) of one volume up to t. */
static double length_until(const Gathering *g, int begin, int end, double t) {
    int lo = begin, hi = end;
    while (lo < hi) {
        int middle = (lo + hi) / 2;
        if (g->steps[middle].t1 <= t) lo = middle + 1;
        else hi = middle;
    }
    if (lo == end) return end > begin ? g->steps[end - 1].before + g->steps[end - 1].length : 0;
    const Step *s = &g->steps[lo];
    return s->before + (t > s->t0 ? s->length * (t - s->t0) / (s->t1 - s->t0) : 0);
}

/* Of which so much is left. */
static double depth_of(Vec3f through) { return -log(double_max((double)(through.x + through.y + through.z) / 3, 1e-30)); }

/* What a unit of density at the place sends towards the eye. */
static Vec3f source(const Gathering *g, const CompiledVolume *v, Vec3 point, double seen_depth, const double shape[VOLUME_HARMONICS]) {
    const Scene *scene = g->tracer->compiled->scene;
    Vec3 unit = volume_unit(v, point);
    Vec3f sum = volume_kept(v, unit, shape), scattering = {(float)v->scattering[0], (float)v->scattering[1], (float)v->scattering[2]};
    for (size_t l = 0; l < scene->light_count; l++) {
        const Light *light = &scene->lights[l];
        if (!light_shines_on(light, NULL)) continue;
        LightRay way = light_ray(light, point);
        if (way.color.x == 0 && way.color.y == 0 && way.color.z == 0) continue;
        Vec3f through = volume_lamp(v, g->tracer, l, &way, unit, point);
        double mu = vec3_dot(way.direction, g->ray.direction), shine = VOLUME_IRRADIANCE * phase_value(&v->phase, mu);
        shine *= phase_spread(v->spread, mu, v->peak_share * depth_of(through), v->peak_share * seen_depth);
        sum = vec3f_madd(sum, vec3f_mul(vec3f_mul(through, way.color), scattering), (float)shine);
    }
    return vec3f(float_max(sum.x, 0), float_max(sum.y, 0), float_max(sum.z, 0));
}

/* The mean of exp(-x) over [0, depth]. */
static double mean_passing(double depth) { return depth > 1e-4 ? -expm1(-depth) / depth : 1 - depth / 2; }

/* Where a volume is denser than light within goes by, nothing behind is seen through it, and it is as bright as what hides all that. */
static Vec3f part_hidden(Vec3f whole, Vec3f seen) {
    return vec3f(seen.x < 1 ? (1 - whole.x) / (1 - seen.x) : 1, seen.y < 1 ? (1 - whole.y) / (1 - seen.y) : 1, seen.z < 1 ? (1 - whole.z) / (1 - seen.z) : 1);
}

static Vec3f passing(const double depth[3]) { return vec3f((float)exp(-depth[0]), (float)exp(-depth[1]), (float)exp(-depth[2])); }

Air volumes_gather(SurfaceTracer *tracer, const Cone *cone, double t_max, double *mean_t) {
    const VolumeSet *set = tracer->compiled->volumes;
    Gathering g;
    g.tracer = tracer, g.set = set, g.ray = (Ray){cone->origin, cone->direction}, g.count = 0;
    int bounds[MOST_STEPS + 1]; /* where the steps of each volume begin that has any */
    int met = 0;
    for (size_t i = 0; i < set->count; i++) {
        int before = g.count;
        if (!set->items[i].seen) continue;
        add_volume(&g, (int)i, t_max);
        if (g.count > before) bounds[met++] = before;
    }
    bounds[met] = g.count;
    double shape[VOLUME_HARMONICS], weights = 0, depth_sum[3] = {0, 0, 0}, whole_sum[3] = {0, 0, 0}, thinned_sum[3] = {0, 0, 0};
    bool capped = false;
    Air air = air_clear();
    volume_harmonics(vec3_negate(cone->direction), VOLUME_HARMONICS, shape);
    *mean_t = 0;
    for (int m = 0; m < met; m++) {
        const CompiledVolume *v = &set->items[g.steps[bounds[m]].volume];
        for (int i = bounds[m]; i < bounds[m + 1]; i++) {
            const Step *s = &g.steps[i];
            double depth = densest(v) * s->length, at = depth > 1e-3 ? 1 / depth - 1 / expm1(depth) : 0.5, t = s->t0 + (s->t1 - s->t0) * at;
            double others[3] = {0, 0, 0};
            for (int o = 0; o < met; o++) {
                if (o == m) continue;
                const CompiledVolume *other = &set->items[g.steps[bounds[o]].volume];
                double length = length_until(&g, bounds[o], bounds[o + 1], t);
                for (int c = 0; c < 3; c++) others[c] += other->thinned[c] * length;
            }
            float share[3];
            for (int c = 0; c < 3; c++)
                share[c] = (float)(s->length * exp(-others[c] - v->thinned[c] * s->before) * mean_passing(v->thinned[c] * s->length));
            if (!(share[0] > 0 || share[1] > 0 || share[2] > 0)) continue;
            double seen = (v->thinned[0] + v->thinned[1] + v->thinned[2]) / 3 * (s->before + at * s->length);
            Vec3f light = source(&g, v, cone_point(cone, t), seen, shape);
            air.add = vec3f_add(air.add, vec3f_mul(light, vec3f(share[0], share[1], share[2])));
            *mean_t += (double)share[1] * t, weights += (double)share[1];
        }
        const Step *last = &g.steps[bounds[m + 1] - 1];
        const double length = last->before + last->length, whole = v->dense ? volume_whole_length(v, &g.ray, 0, t_max) : length;
        capped |= v->dense != NULL;
        for (int c = 0; c < 3; c++) {
            depth_sum[c] += v->extinction[c] * length, whole_sum[c] += v->extinction[c] * whole;
            thinned_sum[c] += v->thinned[c] * length;
        }
    }
    if (weights > 0) *mean_t /= weights;
    air.keep = passing(whole_sum);
    if (capped) air.add = vec3f_mul(air.add, part_hidden(air.keep, passing(depth_sum)));
    if (set->sky && t_max >= VTS_INFINITY) { /* what peaks alone turn here comes from about there */
        Vec3f turned = vec3f_sub(passing(thinned_sum), air.keep);
        air.add = vec3f_add(air.add, vec3f_mul(turned, sky_radiance(tracer->compiled->scene, cone->direction, 0)));
    }
    return air;
}
