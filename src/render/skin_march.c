#include "render/skin_march.h"

#include "render/skin_copies.h"
#include "render/skin_sheets.h"
#include "texel/voxel_trim.h"

/* A cone that takes more steps than this is lost in a mapping that no voxel fits; it ends there. */
enum { MOST_STEPS = 1 << 14 };
enum { MOST_ENTRIES = 1 << 10, MOST_HALVINGS = 7, SPAN_STEPS = 48 };
/* Cells without length around a vertex, and cells within one step, that are passed at once. */
enum { MOST_FAN = 64, MOST_CELLS = 64 };
/* A step crosses at most this share of the layer, so that what is homogeneous on the large is not stepped over. */
static const double LAYER_STEP = 0.3;
/* A span crosses at most this many tiles, and bends at most this many voxels from its chord: the quadratic through its
 * middle takes the bend along, what it misses is of third order. */
static const double SPAN_TILES = 1.0, SPAN_BEND_VOXELS = 1;
/* Steps are shorter by this where the cone is thinner than the finest voxels. */
static const float NEAR_STEP = 0.5f;
/* Of this mean gamma on, that of solids not counted, steps are halved. */
static const float SHEET_GAMMA = 0.85f;
static const float BETWEEN_LEVELS = 2;
/* Empty way is looked for along the tangent as far as the path stays this near to it, in voxels. */
static const double TANGENT_VOXELS = 1;

/* Of copies that may be around a tile. */
static size_t copies_around(const PlacedTexel *placed) { return (size_t)(2 * placed->reach + 1) * (size_t)(2 * placed->reach + 1); }

void skin_march_init_shared(SkinMarch *m, const SkinRoom *room, Arena *arena) {
    m->skin = NULL;
    m->tiles_kept = 1;
    m->tiles = arena_new_array(arena, TileCopies, room->texels);
    m->span.fits = arena_new_array(arena, VoxelFit, room->texels);
    for (size_t i = 0; i < room->texels; i++) m->tiles[i].copies = arena_new_array(arena, CopyOnWay, room->copies);
    m->confined = false;
    m->sheets = NULL;
}

void skin_march_ask_room(const CompiledSkin *skin, SkinRoom *room) {
    room->texels = size_max(room->texels, skin->texel_count);
    for (size_t i = 0; i < skin->texel_count; i++) room->copies = size_max(room->copies, copies_around(&skin->texels[i]));
}

void skin_march_init_confined(SkinMarch *m, const CompiledSkin *skin, Arena *arena) {
    m->skin = skin;
    m->tiles_kept = skin->cell_count == 1 ? 1 : TILES_KEPT; /* thousands of them may stand in a scene */
    m->tiles = arena_new_array(arena, TileCopies, skin->texel_count * (size_t)m->tiles_kept);
    m->span.fits = arena_new_array(arena, VoxelFit, skin->texel_count);
    for (size_t i = 0; i < skin->texel_count; i++) {
        size_t around = copies_around(&skin->texels[i]);
        for (int k = 0; k < m->tiles_kept; k++) m->tiles[i * (size_t)m->tiles_kept + (size_t)k].copies = arena_new_array(arena, CopyOnWay, around);
    }
    m->confined = true;
    m->sheets = NULL;
}

void skin_march_init(SkinMarch *m, const CompiledSkin *skin, Arena *arena) {
    skin_march_init_confined(m, skin, arena);
    m->confined = false;
    if (skin->overlaps) m->sheets = skin_sheets_new(skin, arena);
}

static void begin(SkinMarch *m, const Cone *cone, double t_min, double t_max, const MarchSettings *settings,
                  TraceCounters *counters, bool shade) {
    m->cone = cone;
    m->settings = settings;
    m->counters = counters;
    m->shade = shade;
    m->inside = false;
    m->t = t_min;
    m->t_max = t_max;
    m->entries = 0;
    m->steps_left = MOST_STEPS;
    m->number++;
    m->coarser = 0;
    m->fitted = false;
    m->span.t1 = -VTS_INFINITY;
    m->span.leaves = true;
}

/* ---- spans ---- */

/* Between two levels both are read, which costs twice as much as one: only in the middle half of the way from one to the next. */
static float level_between(float lod) {
    float whole = floorf(lod);
    return whole + float_clamp(BETWEEN_LEVELS * (lod - whole - 0.5f) + 0.5f, 0, 1);
}

static VoxelFit fit_voxels(const TexturePlace *place, Vec3f extent, float finest_voxel, Vec3 d, double width, float *speed) {
    Vec3 row[3] = {vec3_scale(place->grad_u, (double)extent.x), vec3_scale(place->grad_w, (double)extent.y),
                   vec3_scale(place->grad_v, (double)extent.z)};
    *speed = (float)vec3_length(vec3(vec3_dot(row[0], d), vec3_dot(row[1], d), vec3_dot(row[2], d)));
    /* An area across the cone is magnified by |cof(T) d|; its root is the mean scale of the footprint. */
    Vec3 area = vec3(vec3_dot(vec3_cross(row[1], row[2]), d), vec3_dot(vec3_cross(row[2], row[0]), d),
                     vec3_dot(vec3_cross(row[0], row[1]), d));
    float side = (float)(width * sqrt(vec3_length(area)));
    return (VoxelFit){.lod = side > finest_voxel ? level_between(log2f(side / finest_voxel)) : 0, .voxel = float_max(side, finest_voxel), .width = side};
}

/* One voxel for the whole texel: the layer as a homogeneous slab. */
static VoxelFit coarsest_voxels(const PlacedTexel *placed) {
    float lod = (float)(placed->levels - 1);
    float voxel = placed->finest_voxel * exp2f(lod);
    return (VoxelFit){.lod = lod, .voxel = voxel, .width = voxel};
}

/* Chooses voxels and the length of steps for all texels at `place`. */
static void fit_span(const SkinMarch *m, const TexturePlace *place, double t, MarchSpan *span) {
    Vec3 d = m->cone->direction;
    double width = ldexp(cone_diameter(m->cone, t) * (double)m->settings->voxel_width, m->coarser);
    float side = INFINITY, finest = INFINITY, stride = INFINITY;
    span->coarsest = true;
    for (size_t i = 0; i < m->skin->texel_count; i++) {
        const PlacedTexel *placed = &m->skin->texels[i];
        float speed;
        span->fits[i] = fit_voxels(place, placed->finest_extent, placed->finest_voxel, d, width, &speed);
        if (m->settings->slab) span->fits[i] = coarsest_voxels(placed);
        span->coarsest &= span->fits[i].lod >= (float)(placed->levels - 1);
        span->fits[i].width *= 1 / m->settings->voxel_width;
        span->fits[i].coarsening = exp2f(float_min(span->fits[i].lod, (float)(placed->levels - 1)));
        if (!(speed > 0)) continue;
        side = float_min(side, float_min(span->fits[i].voxel, coarsest_voxels(placed).voxel) / speed);
        finest = float_min(finest, placed->finest_voxel / speed);
        /* Nearer than the finest voxels single walls are looked at: long steps would let their light through in rings. */
        stride = float_min(stride, span->fits[i].voxel / speed * (span->fits[i].lod > 0 ? 1 : NEAR_STEP));
    }
    double layer_rate = fabs(vec3_dot(place->grad_layer, d));
    span->voxel_world = side;
    span->finest_world = finest;
    span->step = double_min((double)(stride * m->settings->step), layer_rate > 0 ? LAYER_STEP / layer_rate : VTS_INFINITY);
    if (!isfinite(span->step)) span->step = double_max(1e-6, width); /* no extent along the cone: a degenerate box */
    span->step = double_max(span->step, 1e-12 * (1 + fabs(t)));      /* t + step must be more than t */
}

static Vec3 coordinates(const TexturePlace *p) { return vec3(p->u, p->v, p->w); }

static SkinPoint guess(const SkinPoint *from, const TexturePlace *place, Vec3 d, double dt) {
    return (SkinPoint){from->cell, from->a + vec3_dot(place->grad_a, d) * dt, from->b + vec3_dot(place->grad_b, d) * dt,
                       from->w + vec3_dot(place->grad_layer, d) * dt};
}

static void lay_quadratic(MarchSpan *span, Vec3 x0, Vec3 xm, Vec3 x1, double length) {
    Vec3 bend = vec3_sub(vec3_add(x0, x1), vec3_scale(xm, 2));
    span->c0 = x0;
    span->c1 = vec3_scale(vec3_sub(vec3_sub(x1, x0), bend), 1 / length);
    span->c1 = vec3_madd(span->c1, bend, -1 / length);
    span->c2 = vec3_scale(bend, 2 / (length * length));
}

/* A span that is being tried, from the march's place to t1 in the stretch `last`. */
typedef struct SpanTrial {
    SkinStretch last;
    bool one_cell; /* `last` is the stretch in which the march is */
    double t1;
    bool shortest;
} SpanTrial;

static bool goes_on(const SkinMarch *m, const SkinStretch *s) { return !m->confined && skin_stretch_goes_on(m->skin, s); }

static Ray ray_of(const SkinMarch *m) { return (Ray){m->cone->origin, m->cone->direction}; }

/* Newton's method in the cell of the guess. */
static bool find(const SkinMarch *m, double t, double tolerance, SkinPoint *point) {
    return skin_cell_invert(&m->skin->cells[point->cell], cone_point(m->cone, t), tolerance, point);
}

static bool find_end(const SkinMarch *m, const SpanTrial *trial, double tolerance, SkinPoint *end) {
    if (trial->t1 >= trial->last.t1) {
        *end = trial->last.end;
        return true;
    }
    if (trial->one_cell) {
        *end = guess(&m->point, &m->place, m->cone->direction, trial->t1 - m->at);
    } else {
        TexturePlace place = skin_texture_place(&m->skin->cells[trial->last.start.cell], &trial->last.start);
        *end = guess(&trial->last.start, &place, m->cone->direction, trial->t1 - trial->last.t0);
    }
    return find(m, trial->t1, tolerance, end);
}

/* Through several cells the span is straight: no quadratic follows the kinks at their walls. */
static bool find_middle(const SkinMarch *m, const SpanTrial *trial, double tolerance, SkinPoint *middle) {
    double t = (m->at + trial->t1) / 2;
    *middle = guess(&m->point, &m->place, m->cone->direction, t - m->at);
    return trial->one_cell && find(m, t, tolerance, middle);
}

/* The chord of the whole stretch, from t0 on. */
static void lay_chord(SkinMarch *m, double t0) {
    const SkinStretch *s = &m->stretch;
    const SkinCell *cell = &m->skin->cells[s->start.cell];
    TexturePlace start = skin_texture_place(cell, &s->start), end = skin_texture_place(cell, &s->end);
    Vec3 x0 = coordinates(&start), rate = vec3_scale(vec3_sub(coordinates(&end), x0), 1 / (s->t1 - s->t0));
    m->span.c0 = vec3_madd(x0, rate, t0 - s->t0);
    m->span.c1 = rate;
    m->span.c2 = vec3(0, 0, 0);
}

/* Lays the span. False: take a shorter one. */
static bool try_span(SkinMarch *m, const SpanTrial *trial) {
    MarchSpan *span = &m->span;
    double t0 = m->at, length = trial->t1 - t0;
    /* Of the residual before the last Newton step, which squares it: what is left is far below the footprint. */
    double tolerance = 0.2 * double_max(cone_diameter(m->cone, t0), 1e-4 * length) + 1e-9 * length;
    SkinPoint middle, end;
    bool ends = find_end(m, trial, tolerance, &end), found = ends && find_middle(m, trial, tolerance, &middle);
    if (!found && !trial->shortest) return false;
    if (!found) middle = m->point;
    if (!ends) end = guess(&m->point, &m->place, m->cone->direction, length); /* a singular place: on as at its start */
    TexturePlace place_m = found ? skin_texture_place(&m->skin->cells[middle.cell], &middle) : m->place;
    TexturePlace place_e = skin_texture_place(&m->skin->cells[end.cell], &end);
    Vec3 x0 = coordinates(&m->place), x1 = coordinates(&place_e), xm = found ? coordinates(&place_m) : vec3_lerp(x0, x1, 0.5);
    double bend = vec3_length(vec3_scale(vec3_sub(vec3_add(x0, x1), vec3_scale(xm, 2)), 0.25));
    bool straight = m->settings->path == RAY_PATH_STRAIGHT && trial->one_cell;
    if (!trial->shortest && !straight && bend > SPAN_BEND_VOXELS * (double)span->voxel_world * vec3_length(vec3_sub(x1, x0)) / length) return false;
    if (straight) lay_chord(m, t0);
    else lay_quadratic(span, x0, xm, x1, length);
    span->t0 = t0;
    span->t1 = trial->t1;
    span->place = place_m;
    span->middle = middle;
    span->leaves = trial->t1 >= trial->last.t1 && !goes_on(m, &trial->last);
    fit_span(m, &place_m, (t0 + trial->t1) / 2, span);
    /* The path leaves its tangent by |c2|·s². */
    double bending = vec3_length(span->c2), voxel = (double)span->voxel_world * vec3_length(span->c1);
    span->straight = bending > 0 ? sqrt(TANGENT_VOXELS * voxel / bending) : VTS_INFINITY;
    m->at = trial->t1;
    m->point = end;
    m->place = place_e;
    m->stretch = trial->last;
    m->inside = !span->leaves;
    return true;
}

static bool crosses_seam(const SkinMarch *m, const SkinStretch *s) {
    return m->skin->cells[s->end.cell].neighbour[s->exit].seam;
}

/* From the end of the stretch into the next that has a length. False where the layer ends. */
static bool next_stretch(SkinMarch *m) {
    Ray ray = ray_of(m);
    for (int i = 0; i < MOST_FAN && goes_on(m, &m->stretch); i++) {
        m->stretch = skin_stretch_next(m->skin, &ray, &m->stretch, m->t_max);
        if (m->stretch.t1 - m->stretch.t0 <= skin_hair(&m->skin->cells[m->stretch.start.cell], &ray, m->stretch.t0)) continue;
        m->at = m->stretch.t0;
        m->point = m->stretch.start;
        m->place = skin_texture_place(&m->skin->cells[m->point.cell], &m->point);
        return true;
    }
    return false;
}

/* Through cells smaller than a step until the way is as long as one; texture coordinates go on across walls, but not across seams. Larger
 * cells end the way: the mapping has a kink at their walls. */
static void reach_through_cells(const SkinMarch *m, double least, SpanTrial *trial) {
    Ray ray = ray_of(m);
    trial->last = m->stretch;
    trial->one_cell = true;
    for (int i = 0; i < MOST_CELLS && trial->last.t1 - m->at < least; i++) {
        if (!goes_on(m, &trial->last) || crosses_seam(m, &trial->last)) return;
        SkinStretch next = skin_stretch_next(m->skin, &ray, &trial->last, m->t_max);
        if (next.t1 - next.t0 >= least) return;
        trial->last = next;
        trial->one_cell = false;
    }
}

/* The next span from the current place. False where the layer ends: the march then looks for another entry. */
/* A box maps straight lines to straight lines. */
static void lay_line(SkinMarch *m, double t1) {
    MarchSpan *span = &m->span;
    Vec3 d = m->cone->direction, x = coordinates(&m->place);
    double length = t1 - m->at;
    span->t0 = m->at;
    span->t1 = t1;
    span->c0 = x;
    span->c1 = vec3(vec3_dot(m->place.grad_u, d), vec3_dot(m->place.grad_v, d), vec3_dot(m->place.grad_w, d));
    span->c2 = vec3(0, 0, 0);
    span->middle = guess(&m->point, &m->place, d, length / 2);
    m->point = guess(&m->point, &m->place, d, length);
    x = vec3_madd(x, span->c1, length);
    m->place.u = x.x, m->place.v = x.y, m->place.w = x.z;
    span->place = m->place;
    span->straight = VTS_INFINITY;
    span->leaves = t1 >= m->stretch.t1;
    fit_span(m, &m->place, (m->at + t1) / 2, span);
    m->at = t1;
    m->inside = !span->leaves;
}

static bool next_span(SkinMarch *m) {
    if (m->at >= m->stretch.t1 && !next_stretch(m)) return false;
    if (!m->fitted) fit_span(m, &m->place, m->at, &m->span); /* else the span before tells how long steps are here */
    m->fitted = true;
    Vec3 d = m->cone->direction;
    double rate = fmax(fabs(vec3_dot(m->place.grad_u, d)), fabs(vec3_dot(m->place.grad_v, d)));
    double step = m->span.step, length = (m->settings->path == RAY_PATH_EXACT ? 1 : SPAN_STEPS) * step;
    if (rate > 0) length = double_min(length, SPAN_TILES / rate);
    if (m->skin->box) {
        lay_line(m, m->stretch.t1 - m->at - length < 0.25 * double_min(step, length) ? m->stretch.t1 : m->at + length);
        return true;
    }
    SpanTrial trial;
    reach_through_cells(m, double_min(step, length), &trial);
    double most = trial.last.t1 - m->at;
    if (!(most > 0)) return false;
    length = double_min(trial.one_cell ? length : double_min(step, length), most);
    for (int i = 0; i <= MOST_HALVINGS; i++, length /= 2) {
        trial.t1 = most - length < 0.25 * double_min(step, length) ? trial.last.t1 : m->at + length;
        trial.shortest = !trial.one_cell || i == MOST_HALVINGS || length <= step;
        if (try_span(m, &trial)) return true;
    }
    return false;
}

/* ---- entering ---- */

static void begin_stretch(SkinMarch *m, const SkinStretch *stretch) {
    m->entries++;
    m->stretch = *stretch;
    m->at = stretch->t0;
    m->point = stretch->start;
    m->place = skin_texture_place(&m->skin->cells[m->point.cell], &m->point);
    m->inside = true;
}

static bool enter(SkinMarch *m) {
    Ray ray = ray_of(m);
    SkinStretch stretch;
    if (m->confined || m->t >= m->t_max || m->entries > MOST_ENTRIES) return false;
    bool again = m->entries > 0 && m->stretch.t1 >= m->t;
    if (!(again ? skin_stretch_again(m->skin, &ray, &m->stretch, m->t_max, &stretch)
                : skin_stretch_first(m->skin, &ray, m->t, m->t_max, &stretch)))
        return false;
    begin_stretch(m, &stretch);
    m->t = m->at;
    return true;
}

void skin_march_begin(SkinMarch *m, const Cone *cone, double t_min, double t_max, const MarchSettings *settings,
                      TraceCounters *counters, bool shade) {
    begin(m, cone, t_min, t_max, settings, counters, shade);
    if (m->sheets) skin_sheets_begin(m->sheets, m);
}

void skin_march_begin_stretch(SkinMarch *m, const SkinMarch *like, const SkinStretch *stretch) {
    begin(m, like->cone, stretch->t0, stretch->t1, like->settings, like->counters, like->shade);
    begin_stretch(m, stretch);
}

/* The point `back` before `point` along the cone, or where the layer begins when that is nearer: *back is then shortened. */
static SkinPoint step_back(const SkinMarch *m, const SkinPoint *point, double tolerance, double *back) {
    for (int i = 0; i < 2 && *back > 0; i++) {
        SkinPoint p = guess(point, &m->place, m->cone->direction, -*back);
        bool seam = false;
        SkinSide side = skin_locate(m->skin, cone_point(m->cone, -*back), tolerance, &p, &seam);
        if (side == SKIN_INSIDE && !seam) return p;
        if (side == SKIN_LOST || side == SKIN_BORDER || seam || i > 0) break;
        double limit = side == SKIN_ABOVE ? 1 : 0;
        *back *= double_clamp(0.999 * (point->w - limit) / (point->w - p.w), 0, 1);
    }
    *back = 0;
    return *point;
}

double skin_march_begin_around(SkinMarch *m, const Cone *cone, const SkinPoint *point, double reach, double tolerance, double t_max,
                               const MarchSettings *settings, TraceCounters *counters) {
    begin(m, cone, 0, t_max, settings, counters, false);
    m->place = skin_texture_place(&m->skin->cells[point->cell], point);
    fit_span(m, &m->place, 0, &m->span);
    double back = reach * (double)m->span.voxel_world, wanted = back;
    m->point = step_back(m, point, tolerance, &back);
    m->t = -back;
    m->fitted = true;
    if (m->sheets) {
        skin_sheets_begin(m->sheets, m);
        return wanted;
    }
    Ray ray = ray_of(m);
    SkinStretch stretch = skin_stretch_from(m->skin, &ray, m->point, m->t, t_max);
    if (stretch.t1 > m->t) begin_stretch(m, &stretch);
    return wanted;
}

SkinPoint skin_march_guess(const SkinMarch *m, double t) {
    if (m->sheets) return skin_sheets_guess(m->sheets, t);
    const MarchSpan *span = &m->span;
    return guess(&span->middle, &span->place, m->cone->direction, t - (span->t0 + span->t1) / 2);
}

/* ---- sampling ---- */

/* S of the texel in world space: normals transform by the transposed map world → texel. */
static Sym3f to_world(const Sym3f *s, const TexelCopy *copy, const TexturePlace *place) {
    Vec3f e = copy->texel->extent;
    Vec3 x = vec3_scale(vec3_madd(vec3_scale(place->grad_u, copy->xu), place->grad_v, copy->xv), (double)e.x);
    Vec3 y = vec3_scale(place->grad_w, copy->inverse_scale * (double)e.y);
    Vec3 z = vec3_scale(vec3_madd(vec3_scale(place->grad_u, copy->zu), place->grad_v, copy->zv), (double)e.z);
    Mat3 gradients = {{x, y, z}};
    return sym3f_congruence(s, &gradients);
}

typedef struct StepSample {
    double t0, t1;
    Vec3 middle, difference; /* texture coordinates */
    float depth, area, gamma_area, sheet_area;
} StepSample;

static void sample_copy(SkinMarch *m, size_t i, const CopyOnWay *on_way, StepSample *step, SkinSegment *out) {
    const PlacedTexel *placed = &m->skin->texels[i];
    const TexelCopy *copy = &on_way->copy;
    const BuiltTexel *texel = copy->texel;
    bool known = on_way->cone == m->number, any = !known;
    for (size_t k = 0; k < texel->matter_count && !any; k++) any = on_way->clear_until[size_min(k, LAYERS_APART - 1)] < step->t1;
    if (!any) return;
    Vec3f at = skin_copy_place(copy, step->middle), along = texel_copy_rate(copy, step->difference);
    const VoxelFit *fit = &m->span.fits[i];
    float lod = float_min(fit->lod, (float)(texel->levels - 1)), coarsening = fit->coarsening;
    if (texel->voxel != placed->finest_voxel) { /* members of a family may be built to different resolutions */
        lod = float_clamp(fit->lod - log2f(texel->voxel / placed->finest_voxel), 0, (float)(texel->levels - 1));
        coarsening = exp2f(lod);
    }
    float finest = 1 / (float)texel->built, h = finest * coarsening; /* along the longest side, as opacity.h wants it */
    for (size_t k = 0; k < texel->matter_count; k++) {
        VoxelSample v;
        if (known && on_way->clear_until[size_min(k, LAYERS_APART - 1)] >= step->t1) continue;
        m->counters->voxels_visited++;
        if (!voxel_layer_sample_lod(texel->matter[k].voxels, lod, at, &v)) continue;
        float tau = m->settings->opacity == OPACITY_MEAN ? opacity_depth_mean(&v, finest, h, along)
                                                         : opacity_depth(m->settings->opacity, &v, h, along);
        if (!(tau > 0)) continue;
        if (m->settings->opacity == OPACITY_CORRELATED) tau *= voxel_layer_trim_at(texel->matter[k].voxels, lod, along);
        step->depth += tau;
        float area = opacity_area(&v, along);
        step->area += area;
        step->gamma_area += area * (v.gamma + v.solid * (1 - v.gamma)); /* walls of solids are sheets */
        step->sheet_area += area * v.gamma * (1 - v.solid);
        if (!m->shade || out->hit_count == MOST_MATTER_HITS) continue;
        MatterHit *hit = &out->hits[out->hit_count++];
        *hit = (MatterHit){.matter = &texel->matter[k], .look = placed->look ? placed->look : &texel->matter[k].look,
                           .tint = copy->tint, .share = tau, .texel = texel,
                           .width = fit->width, .lod = lod, .place = at};
        hit->s = to_world(&v.s, copy, &m->span.place);
        hit->sky = texel->sky ? skin_sky_seen(copy, &m->span.place, at, vec3_negate(m->cone->direction)) : 1;
    }
}

/* Samples all matter at the middle of a step; fills the segment. */
static void sample(SkinMarch *m, double t0, double t1, SkinSegment *out) {
    const MarchSpan *span = &m->span;
    double tm = (t0 + t1) / 2;
    StepSample step = {.t0 = t0, .t1 = t1, .middle = skin_span_at(span, tm)};
    step.difference = vec3_sub(skin_span_at(span, t1), skin_span_at(span, t0));
    out->hit_count = 0;
    for (size_t i = 0; i < m->skin->texel_count; i++) {
        TileCopies *tile = skin_copies_at(m, i, step.middle);
        for (int c = 0; c < tile->count; c++) sample_copy(m, i, &tile->copies[c], &step, out);
    }
    for (int i = 0; i < out->hit_count; i++) out->hits[i].share /= step.depth;
    out->t0 = t0;
    out->t1 = t1;
    out->depth = step.depth;
    out->area = step.area;
    out->gamma_area = step.gamma_area;
    out->sheet_area = step.sheet_area;
    out->transmittance = step.depth > 0 ? expf(-step.depth) : 1;
    out->voxel_world = span->voxel_world;
}

void skin_march_coarsen(SkinMarch *m, int levels) {
    if (levels == m->coarser) return;
    m->coarser = levels;
    m->number++; /* what was known to be empty need not be with wider voxels */
    if (m->inside || m->t < m->span.t1) fit_span(m, &m->span.place, (m->span.t0 + m->span.t1) / 2, &m->span);
}

/* A sheet is blurred over two voxels, and most of its opacity over one: samples a step apart may both miss that. */
static bool misses_sheets(const SkinSegment *segment) {
    return segment->transmittance < 1 && segment->sheet_area > SHEET_GAMMA * segment->area;
}

bool skin_march_next(SkinMarch *m, SkinSegment *segment) {
    if (m->sheets) return skin_sheets_next(m->sheets, segment);
    while (m->steps_left-- > 0) {
        if (m->t >= m->span.t1) {
            if (!m->inside && !enter(m)) return false;
            if (m->at >= m->t_max) return false;
            m->counters->steps++;
            if (!next_span(m)) {
                m->inside = false;
                continue;
            }
            m->t = double_max(m->t, m->span.t0);
            if (m->t >= m->span.t1) continue;
        }
        /* Over what is empty, and ask again: other tiles may begin there. Slivers are not worth the question. */
        double gap = skin_copies_empty_way(m, m->t), sliver = 1e-3 * m->span.step;
        if (m->span.t1 - m->t - gap < sliver) {
            m->t = m->span.t1;
            continue;
        }
        if (gap > sliver) {
            m->t += gap;
            continue;
        }
        double t0 = m->t, t1 = double_min(t0 + m->span.step, m->span.t1);
        m->t = t1;
        m->counters->steps++;
        sample(m, t0, t1, segment);
        if (misses_sheets(segment) && t1 - t0 > 0.75 * m->span.step) {
            m->t = (t0 + t1) / 2;
            sample(m, t0, m->t, segment);
        }
        if (segment->transmittance >= 1) continue;
        return true;
    }
    return false;
}
