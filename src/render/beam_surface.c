#include "render/beam_sight.h"
#include "render/tile_sight.h"

#include <string.h>

static const SurfaceHit *keep_hit(HitPool *pool, const SurfaceHit *hit) {
    void *kept = memcpy(pool->bytes + pool->used, hit, offsetof(SurfaceHit, shares) + (size_t)hit->share_count * sizeof *hit->shares);
    pool->used += beam_hit_room(hit->share_count);
    return kept;
}

static void see_surface(BeamTracer *tr, double x, double y, HitPool *pool, SeenSurface *out) {
    BeamLine line = beam_line_at(tr, x, y);
    Ray ray = {line.origin, vec3_scale(line.direction, 1 / line.length)};
    SurfaceHit hit;
    bool found = hierarchy_meet_wide(tr->compiled->hierarchy, RAY_SEES, &ray, (RayWidth){0, 0}, 1e-9, VTS_INFINITY, tr->aovs != NULL, &hit);
    tr->counters.camera_rays++;
    out->hit = found ? keep_hit(pool, &hit) : NULL;
    out->bend = 0;
    if (!found) return;
    /* q.z of the tangent plane n·(P − P0) = 0, along lines whose direction is linear in x and y. */
    Vec3 p0 = vec3_madd(ray.origin, ray.direction, hit.t), n = hit.flat;
    if (tr->beam.perspective) {
        double far = 1 / vec3_dot(n, vec3_sub(p0, line.origin));
        BeamLine a = beam_line_at(tr, x + 1, y), b = beam_line_at(tr, x, y + 1);
        out->key_0 = vec3_dot(n, line.direction) * far;
        out->key_x = vec3_dot(n, vec3_sub(a.direction, line.direction)) * far;
        out->key_y = vec3_dot(n, vec3_sub(b.direction, line.direction)) * far;
    } else {
        double per = 1 / vec3_dot(n, line.direction);
        BeamLine a = beam_line_at(tr, x + 1, y), b = beam_line_at(tr, x, y + 1);
        out->key_0 = -vec3_dot(n, vec3_sub(p0, line.origin)) * per;
        out->key_x = vec3_dot(n, vec3_sub(a.origin, line.origin)) * per;
        out->key_y = vec3_dot(n, vec3_sub(b.origin, line.origin)) * per;
    }
    out->key_0 -= out->key_x * x + out->key_y * y;
}

/* How much farther or nearer one of two pixels may be than the other, where both meet. */
static const double ALIKE = 0.01;

/* Whether two neighbouring pixels may be taken for parts of one smooth surface. */
static bool alike(const SeenSurface *a, const SeenSurface *b, double x, double y) {
    if (!a->hit || !b->hit) return a->hit == b->hit;
    if (a->hit->object != b->hit->object || vec3_dot(a->hit->flat, b->hit->flat) < 0.95) return false;
    double key_a = a->key_0 + a->key_x * x + a->key_y * y, key_b = b->key_0 + b->key_x * x + b->key_y * y;
    return fabs(key_a - key_b) <= ALIKE * (fabs(key_a) + fabs(key_b));
}

const SeenSurface *beam_surface_of(const BeamTracer *tr, int pixel, uint32_t sample) {
    if (tr->surface[sample] != BEAM_NOTHING) return &tr->surfaces[tr->surface[sample]];
    int row = pixel / tr->columns, column = pixel % tr->columns;
    return &tr->pixels[(row + 1) * BEAM_EDGE + column + 1];
}

/* What the surface leaves the tangent plane by within the pixel, of what it does at the middles of the next: a quarter where it is bent evenly. */
static const double BENDS_WITHIN = 0.5;

/* How far the tangent planes of two neighbouring pixels are apart at a place of the picture, along the normal of the first. */
static double gap_between(const BeamTracer *tr, const SeenSurface *a, const SeenSurface *b, double x, double y) {
    BeamLine line = beam_line_at(tr, x, y);
    double key_a = a->key_0 + a->key_x * x + a->key_y * y, key_b = b->key_0 + b->key_x * x + b->key_y * y;
    double apart = beam_line_distance(tr, &line, (float)key_a) - beam_line_distance(tr, &line, (float)key_b);
    return fabs(apart * vec3_dot(line.direction, a->hit->flat)) / line.length;
}

/* Whether the pixel, whose middle is (x, y), and all around it show parts of one smooth surface: then its tangent plane stands for it, and `bend` gets how
 * far that may lie beside it. */
static bool is_smooth(const BeamTracer *tr, SeenSurface *p, double x, double y) {
    p->bend = 0;
    for (int down = -1; down <= 1; down++)
        for (int right = -1; right <= 1; right++) {
            const SeenSurface *other = p + down * BEAM_EDGE + right;
            if (other == p) continue;
            if (!alike(p, other, x + 0.5 * right, y + 0.5 * down)) return false;
            if (!p->hit) continue;
            double bend = fmin(BENDS_WITHIN * gap_between(tr, p, other, x + right, y + down), ALIKE * p->hit->t); /* however steep a plane is at a horizon */
            p->bend = float_max(p->bend, (float)bend);
        }
    return true;
}

void beam_see_surfaces(BeamTracer *tr) {
    BeamSamples *s = &tr->beam.samples;
    /* What is thinner than a pixel may lie between the middles of them all. */
    const bool thin = tile_sight_thin(tr->compiled, tr->x0, tr->y0, tr->columns, tr->rows);
    if (tr->first_pass) tr->pixel_hits.used = 0;
    tr->sample_hits.used = 0;
    for (int row = -1; row <= tr->rows && tr->first_pass; row++)
        for (int column = -1; column <= tr->columns; column++)
            see_surface(tr, column + 0.5, row + 0.5, &tr->pixel_hits, &tr->pixels[(row + 1) * BEAM_EDGE + column + 1]);
    tr->surface_count = 0;
    int32_t nothing = BEAM_NOTHING; /* one for all samples that meet none */
    for (int row = 0; row < tr->rows; row++)
        for (int column = 0; column < tr->columns; column++) {
            SeenSurface *p = &tr->pixels[(row + 1) * BEAM_EDGE + column + 1];
            double x = column + 0.5, y = row + 0.5;
            if (!tr->allotment.asked[row * tr->columns + column]) continue;
            bool smooth = !thin && is_smooth(tr, p, x, y);
            int pixel = row * tr->columns + column;
            for (uint32_t i = s->first[pixel]; i < s->first[pixel + 1]; i++) {
                double sx = (double)s->x[i], sy = (double)s->y[i];
                const SeenSurface *at = p;
                if (!smooth) {
                    int32_t next = (int32_t)tr->surface_count;
                    see_surface(tr, sx, sy, &tr->sample_hits, &tr->surfaces[next]);
                    if (!tr->surfaces[next].hit && nothing != BEAM_NOTHING) next = nothing;
                    else tr->surface_count++;
                    if (!tr->surfaces[next].hit) nothing = next;
                    tr->surface[i] = next;
                    at = &tr->surfaces[next];
                }
                s->key[i] = at->hit ? (float)(at->key_0 + at->key_x * sx + at->key_y * sy) : tr->beam.perspective ? 0 : -INFINITY;
            }
        }
}
