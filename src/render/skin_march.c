#include "render/skin_march.h"

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
/* Empty way is looked for along the tangent as far as the path stays this near to it, in voxels. */
static const double TANGENT_VOXELS = 1;

void skin_march_init_confined(SkinMarch *m, const CompiledSkin *skin, Arena *arena) {
    m->skin = skin;
    m->tiles_kept = skin->cell_count == 1 ? 1 : TILES_KEPT; /* thousands of them may stand in a scene */
    m->tiles = arena_new_array(arena, TileCopies, skin->texel_count * (size_t)m->tiles_kept);
    m->span.fits = arena_new_array(arena, VoxelFit, skin->texel_count);
    for (size_t i = 0; i < skin->texel_count; i++) {
        size_t around = (size_t)(2 * skin->texels[i].reach + 1) * (size_t)(2 * skin->texels[i].reach + 1);
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

static VoxelFit fit_voxels(const TexturePlace *place, Vec3f extent, float finest_voxel, Vec3 d, double width, float *speed) {
    Vec3 row[3] = {vec3_scale(place->grad_u, (double)extent.x), vec3_scale(place->grad_w, (double)extent.y),
                   vec3_scale(place->grad_v, (double)extent.z)};
    *speed = (float)vec3_length(vec3(vec3_dot(row[0], d), vec3_dot(row[1], d), vec3_dot(row[2], d)));
    /* An area across the cone is magnified by |cof(T) d|; its root is the mean scale of the footprint. */
    Vec3 area = vec3(vec3_dot(vec3_cross(row[1], row[2]), d), vec3_dot(vec3_cross(row[2], row[0]), d),
                     vec3_dot(vec3_cross(row[0], row[1]), d));
    float side = (float)(width * sqrt(vec3_length(area)));
    return (VoxelFit){.lod = side > finest_voxel ? log2f(side / finest_voxel) : 0, .voxel = float_max(side, finest_voxel), .width = side};
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
    for (size_t i = 0; i < m->skin->texel_count; i++) {
        const PlacedTexel *placed = &m->skin->texels[i];
        float speed;
        span->fits[i] = fit_voxels(place, placed->finest_extent, placed->finest_voxel, d, width, &speed);
        if (m->settings->slab) span->fits[i] = coarsest_voxels(placed);
        span->fits[i].width *= 1 / m->settings->voxel_width;
        span->fits[i].coarsening = exp2f(float_min(span->fits[i].lod, (float)(placed->levels - 1)));
        if (!(speed > 0)) continue;
        side = float_min(side, span->fits[i].voxel / speed);
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
static bool next_span(SkinMarch *m) {
    if (m->at >= m->stretch.t1 && !next_stretch(m)) return false;
    if (!m->fitted) fit_span(m, &m->place, m->at, &m->span); /* else the span before tells how long steps are here */
    m->fitted = true;
    Vec3 d = m->cone->direction;
    double rate = fmax(fabs(vec3_dot(m->place.grad_u, d)), fabs(vec3_dot(m->place.grad_v, d)));
    double step = m->span.step, length = (m->settings->path == RAY_PATH_EXACT ? 1 : SPAN_STEPS) * step;
    if (rate > 0) length = double_min(length, SPAN_TILES / rate);
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

/* ---- copies ---- */

static Vec3f to_copy(const TexelCopy *copy, Vec3 x) {
    Vec3f e = copy->texel->extent;
    return vec3f((float)(copy->xu * x.x + copy->xv * x.y + copy->x0) * e.x, (float)(x.z * copy->inverse_scale) * e.y,
                 (float)(copy->zu * x.x + copy->zv * x.y + copy->z0) * e.z);
}

static float wrapped(float x, float size) {
    float turns = x / size;
    if (!(fabsf(turns) < 1e9f)) return 0; /* past all precision, or not a number */
    float whole = (float)(int64_t)turns;
    float part = turns - whole + (turns < whole ? 1.0f : 0.0f);
    return part < 1 ? part * size : 0; /* a hair below 0 is rounded to 1 */
}

/* A path along the foot or the top of the layer may pass them by a hair, by rounding and by what the quadratic misses. */
static const float HAIR = 0.02f;

/* Wrapped on cyclic axes. */
static Vec3f wrap(const BuiltTexel *texel, Vec3f p) {
    unsigned cyclic = texel->def->cyclic;
    float hair = HAIR * texel->extent.y;
    if (p.y < 0 && p.y > -hair) p.y = 0;
    if (p.y > texel->extent.y && p.y < texel->extent.y + hair) p.y = texel->extent.y;
    if (cyclic & TEXEL_CYCLIC_X) p.x = wrapped(p.x, texel->extent.x);
    if (cyclic & TEXEL_CYCLIC_Y) p.y = wrapped(p.y, texel->extent.y);
    if (cyclic & TEXEL_CYCLIC_Z) p.z = wrapped(p.z, texel->extent.z);
    return p;
}

/* The number of a tile; where texture coordinates are absurd some number that casts. */
static int64_t tile_number(double x) { return isfinite(x) ? (int64_t)double_clamp(floor(x), -9e15, 9e15) : 0; }

static TileCopies *copies_at(SkinMarch *m, size_t i, int64_t iu, int64_t iv) {
    const PlacedTexel *placed = &m->skin->texels[i];
    const SkinCell *cell = &m->skin->cells[m->span.middle.cell];
    if (placed->alike) iu = iv = 0;
    TileCopies *tile = &m->tiles[i * (size_t)m->tiles_kept + ((size_t)((iu & 3) | (iv & 3) << 2) & (size_t)(m->tiles_kept - 1))];
    if (tile->placed == placed && tile->iu == iu && tile->iv == iv && tile->part == cell->part && tile->rim == cell->rim) return tile;
    tile->placed = placed;
    tile->iu = iu;
    tile->iv = iv;
    tile->part = cell->part;
    tile->rim = cell->rim;
    tile->count = 0;
    int candidates = skin_cell_bears(cell, placed) ? (2 * placed->reach + 1) * (2 * placed->reach + 1) : 0;
    for (int k = 0; k < candidates; k++)
        if (skin_copy_near(m->skin, cell, placed, iu, iv, k, &tile->copies[tile->count].copy)) tile->copies[tile->count++].cone = 0;
    return tile;
}

/* When the path p + t·v is within [0, size] along an axis. */
static void clip_slab(float p, float v, float size, float *t0, float *t1) {
    if (v == 0) {
        if (p < 0 || p > size) *t1 = -1;
        return;
    }
    float a = -p / v, b = (size - p) / v;
    *t0 = float_max(*t0, float_min(a, b));
    *t1 = float_min(*t1, float_max(a, b));
}

/* How far in t the copy's box is away, at most `limit`; 0 inside. */
static float box_gap(const TexelCopy *copy, Vec3f p, Vec3f velocity, float limit) {
    Vec3f e = copy->texel->extent;
    unsigned cyclic = copy->texel->def->cyclic; /* along these axes the box has no end */
    float t0 = 0, t1 = limit, hair = HAIR * e.y;
    if (!(cyclic & TEXEL_CYCLIC_X)) clip_slab(p.x, velocity.x, e.x, &t0, &t1);
    if (!(cyclic & TEXEL_CYCLIC_Y)) clip_slab(p.y + hair, velocity.y, e.y + 2 * hair, &t0, &t1);
    if (!(cyclic & TEXEL_CYCLIC_Z)) clip_slab(p.z, velocity.z, e.z, &t0, &t1);
    return t0 > t1 ? limit : t0;
}

/* Brings clear_until of all layers of a copy up to date at t; returns the smallest. `x` and `rate` are texture coordinates
 * and their rate there, `rest` the length of way that is nearly straight. */
static double clear_copy(CopyOnWay *on_way, const VoxelFit *fit, uint32_t cone, double t, Vec3 x, Vec3 rate, float rest) {
    const TexelCopy *copy = &on_way->copy;
    const BuiltTexel *texel = copy->texel;
    bool fresh = on_way->cone != cone, placed = false;
    double clear = VTS_INFINITY;
    Vec3f p = {0, 0, 0}, direction = {0, 0, 0};
    float speed = 0, box = 0;
    on_way->cone = cone;
    for (size_t k = 0; k < texel->matter_count; k++) {
        double *until = &on_way->clear_until[size_min(k, LAYERS_APART - 1)];
        if (fresh || *until <= t || k >= LAYERS_APART) {
            if (!placed) { /* only now: most copies are known to be clear */
                Vec3f velocity = texel_copy_rate(copy, rate);
                p = to_copy(copy, x);
                speed = vec3f_length(velocity);
                direction = speed > 0 ? vec3f_scale(velocity, 1 / speed) : velocity;
                box = box_gap(copy, p, velocity, rest);
                p = wrap(texel, p);
                placed = true;
            }
            float gap = box > 0 ? box : speed > 0 ? voxel_layer_skip(texel->matter[k].voxels, fit->lod, p, direction, rest * speed) / speed : 0;
            double found = t + (double)gap;
            *until = k >= LAYERS_APART ? double_min(*until, found) : found;
        }
        clear = double_min(clear, *until);
    }
    return clear;
}

/* t until the path leaves the tile of x. */
static double tile_exit(Vec3 x, Vec3 rate) {
    double exit = VTS_INFINITY;
    if (rate.x != 0) exit = double_min(exit, (floor(x.x) + (rate.x > 0) - x.x) / rate.x);
    if (rate.y != 0) exit = double_min(exit, (floor(x.y) + (rate.y > 0) - x.y) / rate.y);
    return double_max(exit, 0);
}

static Vec3 span_at(const MarchSpan *span, double t) {
    double s = t - span->t0;
    return vec3_madd(vec3_madd(span->c0, span->c1, s), span->c2, s * s);
}

static Vec3 span_rate(const MarchSpan *span, double t) { return vec3_madd(span->c1, span->c2, 2 * (t - span->t0)); }

/* The length of empty way from t in all copies of all texels, within the span. */
static double empty_way(SkinMarch *m, double t) {
    const MarchSpan *span = &m->span;
    Vec3 x = span_at(span, t), rate = span_rate(span, t);
    int64_t iu = tile_number(x.x), iv = tile_number(x.y);
    double rest = double_min(span->t1 - t, span->straight), gap = rest;
    for (size_t i = 0; i < m->skin->texel_count; i++) {
        const PlacedTexel *placed = &m->skin->texels[i];
        if (!placed->alike) gap = double_min(gap, double_max(tile_exit(x, rate), 1e-3 * span->step));
        TileCopies *tile = copies_at(m, i, iu, iv);
        /* All copies are brought up to date even when one is near: sampling passes by those that are known to be clear. */
        for (int c = 0; c < tile->count; c++)
            gap = double_min(gap, clear_copy(&tile->copies[c], &span->fits[i], m->number, t, x, rate, (float)rest) - t);
    }
    return gap;
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
    Vec3f at = wrap(texel, to_copy(copy, step->middle)), along = texel_copy_rate(copy, step->difference);
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
                           .width = fit->width,
                           .place = {at.x / texel->extent.x, at.y / texel->extent.y, at.z / texel->extent.z}};
        hit->s = to_world(&v.s, copy, &m->span.place);
        hit->sky = texel->sky ? skin_sky_seen(copy, &m->span.place, at, vec3_negate(m->cone->direction)) : 1;
    }
}

/* Samples all matter at the middle of a step; fills the segment. */
static void sample(SkinMarch *m, double t0, double t1, SkinSegment *out) {
    const MarchSpan *span = &m->span;
    double tm = (t0 + t1) / 2;
    StepSample step = {.t0 = t0, .t1 = t1, .middle = span_at(span, tm)};
    step.difference = vec3_sub(span_at(span, t1), span_at(span, t0));
    int64_t iu = tile_number(step.middle.x), iv = tile_number(step.middle.y);
    out->hit_count = 0;
    for (size_t i = 0; i < m->skin->texel_count; i++) {
        TileCopies *tile = copies_at(m, i, iu, iv);
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
        double gap = empty_way(m, m->t), sliver = 1e-3 * m->span.step;
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
