#include "render/volume_bins.h"

#include "render/volume_shoot.h"

bool bin_walk_begin(BinWalk *w, const CompiledVolume *v, const Ray *ray, double t0, double t1) {
    const int *n = v->light->bins, *cells = v->lattice.size;
    const Vec3 scale = vec3((double)n[0] / cells[0], (double)n[1] / cells[1], (double)n[2] / cells[2]);
    Ray own = volume_ray_in_cells(v, ray);
    own = (Ray){vec3_mul(vec3_sub(own.origin, vec3_splat(0.5)), scale), vec3_mul(own.direction, scale)};
    if (!box3_clip_ray((Box3){vec3_splat(0), vec3(n[0], n[1], n[2])}, &own, &t0, &t1) || !(t0 < t1))
        return false;
    w->volume = v, w->t = t0, w->t_end = t1, w->bin = 0;
    for (int k = 2; k >= 0; k--) {
        double o = vec3_get(own.origin, k), d = vec3_get(own.direction, k);
        w->at[k] = double_to_int(o + t0 * d, 0, n[k] - 1);
        w->step[k] = d > 0 ? 1 : -1;
        w->width[k] = d != 0 ? 1 / fabs(d) : VTS_INFINITY;
        w->next[k] = d != 0 ? double_max((w->at[k] + (d > 0) - o) / d, t0) : VTS_INFINITY;
        w->bin = w->bin * (size_t)n[k] + (size_t)w->at[k];
    }
    return true;
}

static int nearest_axis(const double next[3]) {
    return next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
}

double bin_walk_wall(const BinWalk *w) { return double_min(w->next[nearest_axis(w->next)], w->t_end); }

bool bin_walk_step(BinWalk *w) {
    const int *n = w->volume->light->bins;
    int axis = nearest_axis(w->next);
    w->t = w->next[axis];
    w->at[axis] += w->step[axis];
    if (!(w->t < w->t_end) || w->at[axis] < 0 || w->at[axis] >= n[axis]) return false;
    w->next[axis] += w->width[axis];
    w->bin = ((size_t)w->at[2] * (size_t)n[1] + (size_t)w->at[1]) * (size_t)n[0] + (size_t)w->at[0];
    return true;
}

void bin_sweep_begin(BinSweep *s, BinWalk *walks, const VolumeSet *set, const Ray *ray, double t0,
                     double t1) {
    *s = (BinSweep){.walks = walks, .t0 = t0, .t1 = t0};
    for (size_t i = 0; i < set->count; i++)
        s->count += bin_walk_begin(&walks[s->count], &set->items[i], ray, t0, t1);
}

bool bin_sweep_next(BinSweep *s) {
    for (int i = 0; i < s->count; i++)
        while (s->walks[i].t <= s->t0 && bin_walk_wall(&s->walks[i]) <= s->t1)
            if (!bin_walk_step(&s->walks[i])) {
                s->walks[i--] = s->walks[--s->count];
                break;
            }
    if (s->count == 0) return false;
    double end = VTS_INFINITY;
    s->t0 = s->t1;
    for (int i = 0; i < s->count; i++) {
        const BinWalk *w = &s->walks[i];
        end = double_min(end, w->t > s->t0 ? w->t : bin_walk_wall(w));
    }
    s->t1 = end;
    return true;
}
