#include "render/skin_copies.h"

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

Vec3f skin_copy_place(const TexelCopy *copy, Vec3 x) { return wrap(copy->texel, to_copy(copy, x)); }

/* The number of a tile; where texture coordinates are absurd some number that casts. */
static int64_t tile_number(double x) { return isfinite(x) ? (int64_t)double_clamp(floor(x), -9e15, 9e15) : 0; }

TileCopies *skin_copies_at(SkinMarch *m, size_t i, Vec3 x) {
    int64_t iu = tile_number(x.x), iv = tile_number(x.y);
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

Vec3 skin_span_at(const MarchSpan *span, double t) {
    double s = t - span->t0;
    return vec3_madd(vec3_madd(span->c0, span->c1, s), span->c2, s * s);
}

static Vec3 span_rate(const MarchSpan *span, double t) { return vec3_madd(span->c1, span->c2, 2 * (t - span->t0)); }

double skin_copies_empty_way(SkinMarch *m, double t) {
    const MarchSpan *span = &m->span;
    if (span->coarsest && m->skin->texel_count) return 0; /* steps as long as copies would hardly find a gap */
    Vec3 x = skin_span_at(span, t), rate = span_rate(span, t);
    double rest = double_min(span->t1 - t, span->straight), gap = rest;
    for (size_t i = 0; i < m->skin->texel_count; i++) {
        const PlacedTexel *placed = &m->skin->texels[i];
        if (!placed->alike) gap = double_min(gap, double_max(tile_exit(x, rate), 1e-3 * span->step));
        TileCopies *tile = skin_copies_at(m, i, x);
        /* All copies are brought up to date even when one is near: sampling passes by those that are known to be clear. */
        for (int c = 0; c < tile->count; c++)
            gap = double_min(gap, clear_copy(&tile->copies[c], &span->fits[i], m->number, t, x, rate, (float)rest) - t);
    }
    return gap;
}
