#include "render/skin_march.h"

enum { MOST_ENTRIES = 64 };
/* A step crosses at most this share of the layer, so that what is homogeneous on the large is not stepped over. */
static const double LAYER_STEP = 0.3;

static void init(SkinMarch *m, const CompiledSkin *skin, const Cone *cone, double t_min, double t_max,
                 const MarchSettings *settings, TraceCounters *counters, bool shade) {
    m->skin = skin;
    m->cone = cone;
    m->settings = settings;
    m->counters = counters;
    m->shade = shade;
    m->inside = false;
    m->t = t_min;
    m->t_max = t_max;
    m->entries = 0;
    for (size_t i = 0; i < skin->texel_count; i++) m->caches[i].count = -1;
}

void skin_march_begin(SkinMarch *m, const CompiledSkin *skin, const Cone *cone, double t_min, double t_max,
                      const MarchSettings *settings, TraceCounters *counters, bool shade) {
    init(m, skin, cone, t_min, t_max, settings, counters, shade);
}

void skin_march_begin_at(SkinMarch *m, const CompiledSkin *skin, const Cone *cone, const SkinPoint *point, double t_min,
                         double t_max, const MarchSettings *settings, TraceCounters *counters, bool shade) {
    init(m, skin, cone, t_min, t_max, settings, counters, shade);
    m->point = *point;
    m->place = skin_texture_place(&skin->cells[point->cell], point);
    m->inside = true;
}

static bool enter(SkinMarch *m) {
    if (m->t >= m->t_max || m->entries++ >= MOST_ENTRIES) return false;
    Ray ray = {m->cone->origin, m->cone->direction};
    double t;
    if (!skin_enter(m->skin, &ray, m->t, m->t_max, &m->point, &t)) return false;
    /* The query leaves the point somewhere in the piece it found: bring it to the entry. */
    SkinPoint at = m->point;
    if (skin_cell_invert(&m->skin->cells[at.cell], cone_point(m->cone, t), 1e-7 * (1 + fabs(t)), &at)) m->point = at;
    m->point.w = double_clamp(m->point.w, 0, 1);
    m->t = t;
    m->place = skin_texture_place(&m->skin->cells[m->point.cell], &m->point);
    m->inside = true;
    return true;
}

/* The voxels that fit the cone's footprint in the space of one texel. */
typedef struct Fit {
    Vec3 row[3];      /* ∂(texel space)/∂world */
    Vec3f velocity;   /* texel space per unit of t */
    float speed;
    float lod;        /* unclamped above */
    float voxel;      /* side of the voxels of that lod, texel space */
} Fit;

static Fit fit_voxels(const TexturePlace *place, Vec3f extent, float finest_voxel, int levels, Vec3 d, double width) {
    Fit fit;
    fit.row[0] = vec3_scale(place->grad_u, (double)extent.x);
    fit.row[1] = vec3_scale(place->grad_w, (double)extent.y);
    fit.row[2] = vec3_scale(place->grad_v, (double)extent.z);
    fit.velocity = vec3f((float)vec3_dot(fit.row[0], d), (float)vec3_dot(fit.row[1], d), (float)vec3_dot(fit.row[2], d));
    fit.speed = vec3f_length(fit.velocity);
    /* An area across the cone is magnified by |cof(T) d|; its root is the mean scale of the footprint. */
    Vec3 area = vec3(vec3_dot(vec3_cross(fit.row[1], fit.row[2]), d), vec3_dot(vec3_cross(fit.row[2], fit.row[0]), d),
                     vec3_dot(vec3_cross(fit.row[0], fit.row[1]), d));
    float side = (float)(width * sqrt(vec3_length(area)));
    fit.lod = side > finest_voxel ? log2f(side / finest_voxel) : 0;
    (void)levels;
    fit.voxel = float_max(side, finest_voxel);
    return fit;
}

/* A copy seen from the march: position and velocity in its own texel space. */
typedef struct Local {
    Vec3f position, velocity;
} Local;

static Local to_copy(const TexelCopy *copy, const TexturePlace *place, Vec3 rate) {
    Vec3f e = copy->texel->extent;
    Local out;
    out.position = vec3f((float)(copy->xu * place->u + copy->xv * place->v + copy->x0) * e.x,
                         (float)(place->w * copy->inverse_scale) * e.y,
                         (float)(copy->zu * place->u + copy->zv * place->v + copy->z0) * e.z);
    out.velocity = vec3f((float)(copy->xu * rate.x + copy->xv * rate.y) * e.x, (float)(rate.z * copy->inverse_scale) * e.y,
                         (float)(copy->zu * rate.x + copy->zv * rate.y) * e.z);
    return out;
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

/* How far in t a copy is certainly empty from here, at most `limit`. */
static float copy_gap(const TexelCopy *copy, const Local *local, float lod, float voxel, bool cyclic, float limit) {
    const BuiltTexel *texel = copy->texel;
    float speed = vec3f_length(local->velocity);
    if (speed <= 0) return 0;
    Vec3f p = local->position;
    if (!cyclic) {
        float t0 = 0, t1 = limit, margin = voxel; /* interpolation reaches half a voxel out */
        Vec3f grown = {p.x + margin, p.y + margin, p.z + margin};
        clip_slab(grown.x, local->velocity.x, texel->extent.x + 2 * margin, &t0, &t1);
        clip_slab(grown.y, local->velocity.y, texel->extent.y + 2 * margin, &t0, &t1);
        clip_slab(grown.z, local->velocity.z, texel->extent.z + 2 * margin, &t0, &t1);
        if (t0 > t1) return limit;
        if (t0 > 0) return float_min(t0, limit);
    }
    float gap = limit * speed;
    Vec3f direction = vec3f_scale(local->velocity, 1 / speed);
    for (size_t i = 0; i < texel->matter_count && gap > 0; i++)
        gap = float_min(gap, voxel_layer_skip(texel->matter[i].voxels, lod, p, direction, gap));
    return gap / speed;
}

static CopyCache *copies_here(SkinMarch *m, size_t i, int64_t iu, int64_t iv) {
    CopyCache *cache = &m->caches[i];
    if (cache->count < 0 || cache->iu != iu || cache->iv != iv) {
        cache->iu = iu;
        cache->iv = iv;
        cache->count = texel_copies(&m->skin->texels[i], iu, iv, cache->copies);
    }
    return cache;
}

/* t until the path leaves the tile of (u, v). */
static double tile_exit(const TexturePlace *place, Vec3 rate, int64_t iu, int64_t iv) {
    double exit = VTS_INFINITY;
    if (rate.x != 0) exit = double_min(exit, ((double)(iu + (rate.x > 0)) - place->u) / rate.x);
    if (rate.y != 0) exit = double_min(exit, ((double)(iv + (rate.y > 0)) - place->v) / rate.y);
    return double_max(exit, 0);
}

typedef struct Step {
    Fit fits[MOST_PLACED_TEXELS];
    Vec3 rate;      /* of (u, v, w') per unit of t */
    double length;  /* of the step in t */
    double gap;     /* of certainly empty skin from here, in t */
    float voxel_world;
} Step;

/* Chooses voxels and the length of the next step for all texels of the skin, and how far nothing is. */
static Step plan(SkinMarch *m) {
    const TexturePlace *place = &m->place;
    Vec3 d = m->cone->direction;
    Step step = {.rate = vec3(vec3_dot(place->grad_u, d), vec3_dot(place->grad_v, d), vec3_dot(place->grad_w, d)),
                 .length = VTS_INFINITY, .voxel_world = INFINITY};
    double width = cone_diameter(m->cone, m->t) * (double)m->settings->voxel_width;
    int64_t iu = (int64_t)floor(place->u), iv = (int64_t)floor(place->v);
    double layer_rate = fabs(vec3_dot(place->grad_layer, d));
    double longest = layer_rate > 0 ? LAYER_STEP / layer_rate : VTS_INFINITY;
    double leave = tile_exit(place, step.rate, iu, iv);
    step.gap = VTS_INFINITY;
    for (size_t i = 0; i < m->skin->texel_count; i++) {
        const PlacedTexel *placed = &m->skin->texels[i];
        Fit *fit = &step.fits[i];
        *fit = fit_voxels(place, placed->finest_extent, placed->finest_voxel, placed->levels, d, width);
        if (fit->speed > 0) {
            float side = fit->voxel / fit->speed;
            step.length = double_min(step.length, (double)(side * m->settings->step));
            step.voxel_world = float_min(step.voxel_world, side);
        }
        const CopyCache *cache = copies_here(m, i, iu, iv);
        double limit = double_min(longest, fit->speed > 0 ? 0.25 / (double)fit->speed : longest);
        if (!placed->cyclic) limit = double_min(limit, leave);
        double gap = cache->count == 0 ? (placed->density > 0 ? leave : VTS_INFINITY) : limit;
        for (int c = 0; c < cache->count && gap > 0; c++) {
            Local local = to_copy(&cache->copies[c], place, step.rate);
            gap = double_min(gap, (double)copy_gap(&cache->copies[c], &local, fit->lod, fit->voxel, placed->cyclic, (float)gap));
        }
        step.gap = double_min(step.gap, gap);
    }
    step.length = double_min(step.length, longest);
    if (!isfinite(step.length)) step.length = m->t_max - m->t;
    return step;
}

/* Moves to t1; *exit is set when the layer ends on the way, and m->t is then where. False when the way is lost. */
static bool advance(SkinMarch *m, double t1, double tolerance, bool *exit) {
    double dt = t1 - m->t;
    Vec3 d = m->cone->direction;
    SkinPoint next = {m->point.cell, m->point.a + vec3_dot(m->place.grad_a, d) * dt,
                      m->point.b + vec3_dot(m->place.grad_b, d) * dt, m->point.w + vec3_dot(m->place.grad_layer, d) * dt};
    bool seam = false;
    SkinSide side = skin_locate(m->skin, cone_point(m->cone, t1), tolerance, &next, &seam);
    *exit = side != SKIN_INSIDE;
    if (side == SKIN_LOST) {
        m->t = t1;
        m->inside = false;
        return false;
    }
    if (*exit) {
        /* Where w passes the limit, by the chord; one inversion there takes the curve into account. */
        double limit = side == SKIN_ABOVE ? 1 : 0;
        double f = side == SKIN_BORDER || next.w == m->point.w ? 1 : double_clamp((limit - m->point.w) / (next.w - m->point.w), 0, 1);
        m->t += f * dt;
        m->inside = false;
        return true;
    }
    m->point = next;
    m->t = t1;
    m->place = skin_texture_place(&m->skin->cells[next.cell], &next);
    return true;
}

/* S of the texel in world space: normals transform by the transposed map world → texel. */
static Sym3f to_world(const Sym3f *s, const Fit *fit, const TexelCopy *copy, const TexturePlace *place) {
    Vec3f e = copy->texel->extent;
    Vec3 x = vec3_scale(vec3_madd(vec3_scale(place->grad_u, copy->xu), place->grad_v, copy->xv), (double)e.x);
    Vec3 y = vec3_scale(place->grad_w, copy->inverse_scale * (double)e.y);
    Vec3 z = vec3_scale(vec3_madd(vec3_scale(place->grad_u, copy->zu), place->grad_v, copy->zv), (double)e.z);
    (void)fit;
    Mat3 transposed = {{x, y, z}}; /* columns: gradients */
    return sym3f_congruence(s, &transposed);
}

static float fraction(float x) { return x - floorf(x); }

/* Position to sample at: wrapped on cyclic axes. */
static Vec3f wrap(const BuiltTexel *texel, Vec3f p) {
    unsigned cyclic = texel->def->cyclic;
    if (cyclic & TEXEL_CYCLIC_X) p.x = fraction(p.x / texel->extent.x) * texel->extent.x;
    if (cyclic & TEXEL_CYCLIC_Y) p.y = fraction(p.y / texel->extent.y) * texel->extent.y;
    if (cyclic & TEXEL_CYCLIC_Z) p.z = fraction(p.z / texel->extent.z) * texel->extent.z;
    return p;
}

/* Samples all matter at the middle of the step from `before`; fills the segment. */
static void sample(SkinMarch *m, const Step *step, const TexturePlace *before, double dt, SkinSegment *out) {
    Vec3 middle_rate = step->rate;
    TexturePlace middle = *before;
    middle.u += middle_rate.x * dt / 2;
    middle.v += middle_rate.y * dt / 2;
    middle.w += middle_rate.z * dt / 2;
    int64_t iu = (int64_t)floor(middle.u), iv = (int64_t)floor(middle.v);
    float depth = 0;
    for (size_t i = 0; i < m->skin->texel_count; i++) {
        const PlacedTexel *placed = &m->skin->texels[i];
        const Fit *fit = &step->fits[i];
        const CopyCache *cache = copies_here(m, i, iu, iv);
        for (int c = 0; c < cache->count; c++) {
            const TexelCopy *copy = &cache->copies[c];
            const BuiltTexel *texel = copy->texel;
            Local local = to_copy(copy, &middle, middle_rate);
            Vec3f at = wrap(texel, local.position), along = vec3f_scale(local.velocity, (float)dt);
            float lod = float_min(fit->lod, (float)(texel->levels - 1));
            float h = texel->voxel * exp2f(lod);
            for (size_t k = 0; k < texel->matter_count; k++) {
                VoxelSample v;
                m->counters->voxels_visited++;
                if (!voxel_layer_sample_lod(texel->matter[k].voxels, lod, at, &v)) continue;
                float transmittance = opacity_transmittance(m->settings->opacity, &v, h, along);
                if (transmittance >= 1) continue;
                float tau = -logf(float_max(transmittance, 1e-12f));
                depth += tau;
                if (!m->shade || out->hit_count == MOST_MATTER_HITS) continue;
                MatterHit *hit = &out->hits[out->hit_count++];
                *hit = (MatterHit){.matter = &texel->matter[k], .look = placed->look ? placed->look : &texel->matter[k].look,
                                   .tint = copy->tint, .share = tau, .texel = texel,
                                   .place = {at.x / texel->extent.x, at.y / texel->extent.y, at.z / texel->extent.z}};
                hit->s = to_world(&v.s, fit, copy, before);
            }
        }
    }
    for (int i = 0; i < out->hit_count; i++) out->hits[i].share /= depth;
    out->transmittance = expf(-depth);
}

void skin_march_skip(SkinMarch *m, double dt) {
    bool exit;
    if (dt > 0) advance(m, m->t + dt, 0.01 * dt, &exit);
}

bool skin_march_next(SkinMarch *m, SkinSegment *segment) {
    for (;;) {
        if (!m->inside && !enter(m)) return false;
        if (m->t >= m->t_max) return false;
        Step step = plan(m);
        double world = cone_diameter(m->cone, m->t) + 1e-6 * step.length;
        double tolerance = 0.05 * double_max(world, 1e-3 * step.length);
        bool exit;
        if (step.gap > step.length) { /* nothing here: go to where something may be */
            double t1 = double_min(m->t + step.gap, m->t_max);
            double before = m->t;
            m->counters->steps++;
            advance(m, t1, tolerance, &exit);
            if (!m->inside) m->t = double_max(m->t, before) + 1e-6 * (step.length + 1e-9);
            continue;
        }
        TexturePlace before = m->place;
        double t0 = m->t, t1 = double_min(t0 + step.length, m->t_max);
        segment->point = m->point;
        segment->hit_count = 0;
        m->counters->steps++;
        if (advance(m, t1, tolerance, &exit) && !exit) {
            /* The mean of the rates at both ends: the segment's own difference of texture coordinates. */
            Vec3 d = m->cone->direction, end = vec3(vec3_dot(m->place.grad_u, d), vec3_dot(m->place.grad_v, d), vec3_dot(m->place.grad_w, d));
            step.rate = vec3_scale(vec3_add(step.rate, end), 0.5);
            segment->point = m->point;
        }
        double dt = m->t - t0;
        if (!m->inside) m->t += 1e-6 * (step.length + 1e-9);
        if (dt <= 0) continue;
        sample(m, &step, &before, dt, segment);
        if (segment->transmittance >= 1) continue;
        segment->t0 = t0;
        segment->t1 = t0 + dt;
        segment->voxel_world = step.voxel_world;
        return true;
    }
}
