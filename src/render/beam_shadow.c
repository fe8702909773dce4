#include "render/beam_shadow.h"

#include "render/beam_rigid.h"

#include <string.h>

enum { POINTS_IN_BIN = 4, LEAST_HALVED = 64 };
/* The share of a window's bins that hold points. */
static const double LEAST_FILLED = 0.4;

void shadow_scratch_init(ShadowScratch *s, uint32_t points, Arena *arena) {
    *s = (ShadowScratch){.seen = arena_new_room(arena, Vec3f, points), .order = arena_new_room(arena, uint32_t, points)};
    beam_bins_init(&s->bins, points, MOST_BINS_ACROSS * MOST_BINS_ACROSS, arena);
}

/* The rectangle around the points as the beam sees them, and the range of their keys. */
typedef struct Window {
    double x0, x1, y0, y1, key0, key1;
    uint32_t count;
} Window;

static Vec3f seen_at(const Beam *beam, Vec3f p) {
    Vec3 q = beam_vector(beam, vec3_from_f(p));
    q = vec3_add(q, beam->shift); /* of the beam from the points' origin */
    return vec3f_from(beam->perspective ? vec3(q.x / q.z, q.y / q.z, 1 / q.z) : q);
}

static Window look_through(const Vec3f *seen, const uint32_t *order, uint32_t count) {
    Vec3f lo = {INFINITY, INFINITY, INFINITY}, hi = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < count; i++) {
        Vec3f q = seen[order[i]];
        lo = vec3f(float_min(lo.x, q.x), float_min(lo.y, q.y), float_min(lo.z, q.z));
        hi = vec3f(float_max(hi.x, q.x), float_max(hi.y, q.y), float_max(hi.z, q.z));
    }
    return (Window){(double)lo.x, (double)hi.x, (double)lo.y, (double)hi.y, (double)lo.z, (double)hi.z, count};
}

/* Scales and shifts the projection so that the window is cut into bins of a few points each. Returns their side, and where the first begins. */
static double fit_bins(Beam *beam, const Window *w, double *left, double *top) {
    double width = fmax(w->x1 - w->x0, 1e-12), height = fmax(w->y1 - w->y0, 1e-12);
    double bins = fmax(1, (double)w->count / POINTS_IN_BIN), side = sqrt(width * height / bins);
    side = fmax(side, fmax(width, height) / (MOST_BINS_ACROSS - 1));
    BeamSamples *s = &beam->samples;
    s->columns = (int)double_clamp(ceil(width / side * 1.0001), 1, MOST_BINS_ACROSS);
    s->rows = (int)double_clamp(ceil(height / side * 1.0001), 1, MOST_BINS_ACROSS);
    double x0 = w->x0 - 0.5 * (s->columns * side - width), y0 = w->y0 - 0.5 * (s->rows * side - height);
    Vec3 *r = beam->rows;
    if (beam->perspective) { /* what is taken from the quotient is taken times q.z before */
        r[0] = vec3_scale(vec3_madd(r[0], r[2], -x0), 1 / side);
        r[1] = vec3_scale(vec3_madd(r[1], r[2], -y0), 1 / side);
        beam->shift.x = (beam->shift.x - x0 * beam->shift.z) / side;
        beam->shift.y = (beam->shift.y - y0 * beam->shift.z) / side;
    } else {
        r[0] = vec3_scale(r[0], 1 / side);
        r[1] = vec3_scale(r[1], 1 / side);
        beam->shift.x = (beam->shift.x - x0) / side;
        beam->shift.y = (beam->shift.y - y0) / side;
    }
    *left = x0, *top = y0;
    return side;
}

/* Sorts the points into the beam's bins; returns how many of those are not empty. */
static int sort_points(ShadowScratch *scratch, Beam *beam, const ShadowPoints *in, const uint32_t *order, const Window *w) {
    double left, top, side = fit_bins(beam, w, &left, &top);
    float per_bin = (float)(1 / side), x0 = (float)left, y0 = (float)top;
    const int columns = beam->samples.columns, rows = beam->samples.rows;
    const BeamBins *bins = &scratch->bins;
    for (uint32_t i = 0; i < w->count; i++) {
        Vec3f q = scratch->seen[order[i]];
        int column = int_clamp((int)((q.x - x0) * per_bin), 0, columns - 1), row = int_clamp((int)((q.y - y0) * per_bin), 0, rows - 1);
        bins->bin[i] = (uint32_t)(row * columns + column);
    }
    int filled = beam_bins_sort(&scratch->bins, columns, rows, w->count);
    for (uint32_t i = 0; i < w->count; i++) {
        uint32_t point = order[bins->order[i]];
        Vec3f q = scratch->seen[point];
        bins->x[i] = (q.x - x0) * per_bin, bins->y[i] = (q.y - y0) * per_bin, bins->key[i] = q.z;
        bins->mark[i] = 0;
        bins->limit[i] = in->distance[point];
    }
    beam->samples = beam_bins_samples(bins, columns, rows);
    return filled;
}

/* Moves the points of the window's first half, across its longer side, to the front; returns how many. */
static uint32_t halve(const Vec3f *seen, const Window *w, uint32_t *order) {
    bool across = w->x1 - w->x0 >= w->y1 - w->y0;
    float middle = (float)(across ? (w->x0 + w->x1) / 2 : (w->y0 + w->y1) / 2);
    uint32_t low = 0, high = w->count;
    while (low < high) {
        uint32_t other = order[low];
        if ((across ? seen[other].x : seen[other].y) < middle) {
            low++;
        } else {
            order[low] = order[--high];
            order[high] = other;
        }
    }
    return low;
}

/* Draws the skins between the points and the light. Points that lie in few places of their window are taken by halves: much would
 * be drawn into the empty part of it. */
static void cast(ShadowScratch *scratch, const CompiledScene *compiled, const Beam *aim, const ShadowPoints *in, uint32_t *order, uint32_t count) {
    if (count == 0) return;
    Beam beam = *aim;
    Window w = look_through(scratch->seen, order, count);
    int filled = sort_points(scratch, &beam, in, order, &w);
    if (count >= LEAST_HALVED && filled < LEAST_FILLED * beam.samples.columns * beam.samples.rows) {
        uint32_t low = halve(scratch->seen, &w, order);
        if (low > 0 && low < count) {
            cast(scratch, compiled, aim, in, order, low);
            cast(scratch, compiled, aim, in, order + low, count - low);
            return;
        }
    }
    if (beam.perspective) {
        beam.farthest = 1 / w.key0;
        beam.nearest = 1e-4 * beam.farthest;
    } else {
        beam.farthest = w.key0;
        beam.nearest = VTS_INFINITY;
    }
    beam_close(&beam);
    scratch->draft.beam = &beam;
    beam_draw_cells(&scratch->draft, compiled, beam_gather(&scratch->draft, compiled));
    for (uint32_t i = 0; i < count; i++) in->hidden[order[scratch->bins.order[i]]] |= (uint8_t)beam.samples.mark[i];
}

/* The greatest distance from the eye of points that any skin's triangles shadow: behind it voxels do. */
static double exact_reach(const CompiledScene *compiled) {
    double reach = 0;
    for (size_t i = 0; i < compiled->skin_count; i++)
        if (compiled->skins[i].boxes && !compiled->skins[i].rigid) reach = fmax(reach, compiled->skins[i].exact_to);
    return reach;
}

/* Points that are not hidden yet, are within `reach` and whose way to the light meets the box of all skins. */
static bool may_be_hidden(const CompiledScene *compiled, double reach, const Light *light, const ShadowPoints *in, uint32_t i) {
    if (in->hidden[i] || in->distance[i] > (float)reach) return false;
    Vec3 from = vec3_add(in->origin, vec3_from_f(in->points[i]));
    bool parallel = light_is_parallel(light);
    Ray ray = {from, parallel ? light->to_light : vec3_sub(light->location, from)};
    double near = 0, far = parallel ? VTS_INFINITY : 1;
    return box_tree_clip(&compiled->exact_bounds, &ray, &near, &far);
}

/* The direction across the light along which the points lie apart most: beams are narrow across it. */
static Vec3 longest_across(const ShadowPoints *in, const uint32_t *order, uint32_t count, Vec3 to_light) {
    Vec3f first = in->points[order[0]], last = in->points[order[count - 1]];
    Vec3 along = vec3_sub(vec3_from_f(last), vec3_from_f(first));
    along = vec3_madd(along, to_light, -vec3_dot(along, to_light));
    if (vec3_length_squared(along) > 1e-20) return vec3_normalize(along);
    Vec3 s, t;
    vec3_frame(to_light, &s, &t);
    return s;
}

static void cast_parallel(ShadowScratch *scratch, const CompiledScene *compiled, const Light *light, const ShadowPoints *in) {
    uint32_t count = 0;
    double reach = exact_reach(compiled);
    for (uint32_t i = 0; i < in->count; i++)
        if (may_be_hidden(compiled, reach, light, in, i)) scratch->order[count++] = i;
    if (count == 0) return;
    Vec3 s = longest_across(in, scratch->order, count, light->to_light);
    Beam beam = {.origin = in->origin, .rows = {s, vec3_cross(light->to_light, s), light->to_light}, .light = true};
    for (uint32_t i = 0; i < count; i++) scratch->seen[scratch->order[i]] = seen_at(&beam, in->points[scratch->order[i]]);
    cast(scratch, compiled, &beam, in, scratch->order, count);
}

/* Towards a light at a place: six beams, one for each side of a cube around it. */
static void cast_central(ShadowScratch *scratch, const CompiledScene *compiled, const Light *light, const ShadowPoints *in) {
    Vec3 from = vec3_sub(in->origin, light->location);
    double reach = exact_reach(compiled);
    for (int face = 0; face < 6; face++) {
        double sign = face & 1 ? -1 : 1;
        Vec3 axis = face / 2 == 0 ? vec3(sign, 0, 0) : face / 2 == 1 ? vec3(0, sign, 0) : vec3(0, 0, sign), s, t;
        uint32_t count = 0;
        for (uint32_t i = 0; i < in->count; i++) {
            Vec3 p = vec3_add(from, vec3_from_f(in->points[i]));
            double size[3] = {fabs(p.x), fabs(p.y), fabs(p.z)};
            int most = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
            if (may_be_hidden(compiled, reach, light, in, i) && most == face / 2 && vec3_dot(p, axis) > 0) scratch->order[count++] = i;
        }
        vec3_frame(axis, &s, &t);
        Vec3 rows[3] = {s, t, axis};
        Beam beam = {.origin = in->origin, .rows = {s, t, axis}, .perspective = true, .light = true,
                     .shift = {vec3_dot(rows[0], from), vec3_dot(rows[1], from), vec3_dot(rows[2], from)}};
        for (uint32_t i = 0; i < count; i++) scratch->seen[scratch->order[i]] = seen_at(&beam, in->points[scratch->order[i]]);
        cast(scratch, compiled, &beam, in, scratch->order, count);
    }
}

void beam_shadow(ShadowScratch *scratch, const CompiledScene *compiled, const Light *light, const ShadowPoints *in) {
    if (compiled->rigid) scratch->rays += rigid_hide(compiled->rigid, light, in);
    if (box3_is_empty(compiled->exact_bounds)) return;
    if (light_is_parallel(light)) cast_parallel(scratch, compiled, light, in);
    else cast_central(scratch, compiled, light, in);
}
