#include "render/beam_sight.h"

/* How far beside a place its shadow begins: what beams may round away, in tiles and distances from the eye. More would light what lies under
 * matter that is thinner than that: seen from far, pixels are wider than layers are high. */
static const double BIAS_TILES = 3e-4, BIAS_DISTANCES = 1e-6;
/* Of explicit surfaces, which may be round: also in pixels. */
static const double CLEAR_DISTANCES = 1e-5, CLEAR_PIXELS = 0.01;

/* A facet in the scene. */
typedef struct FacetPlane {
    const BeamFacet *facet;
    Vec3 corner, e1, e2, normal; /* e1 × e2 */
} FacetPlane;

static FacetPlane plane_of(const BeamFacet *f) {
    Vec3 p[3];
    for (int i = 0; i < 3; i++)
        p[i] = skin_cell_position(f->cell, f->from_a + f->size * (double)f->corner[i].x, f->from_b + f->size * (double)f->corner[i].y,
                                  (double)f->corner[i].z, NULL);
    Vec3 e1 = vec3_sub(p[1], p[0]), e2 = vec3_sub(p[2], p[0]);
    return (FacetPlane){f, p[0], e1, e2, vec3_cross(e1, e2)};
}

/* The place in the cell of a point of the plane. */
static SkinPoint in_cell(const FacetPlane *plane, Vec3 point) {
    const BeamFacet *f = plane->facet;
    Vec3 r = vec3_sub(point, plane->corner);
    double area = vec3_length_squared(plane->normal), per = area > 0 ? 1 / area : 0;
    double u = vec3_dot(vec3_cross(r, plane->e2), plane->normal) * per, v = vec3_dot(vec3_cross(plane->e1, r), plane->normal) * per;
    Vec3f c = vec3f_add(f->corner[0], vec3f_add(vec3f_scale(vec3f_sub(f->corner[1], f->corner[0]), (float)u),
                                                vec3f_scale(vec3f_sub(f->corner[2], f->corner[0]), (float)v)));
    return (SkinPoint){0, f->from_a + f->size * (double)c.x, f->from_b + f->size * (double)c.y, (double)c.z};
}

/* In the copy's box, which repeats along y where that is cyclic. */
static Vec3 place_in_box(const TexelCopy *copy, const TexturePlace *place) {
    return vec3(copy->xu * place->u + copy->xv * place->v + copy->x0, place->w * copy->inverse_scale, copy->zu * place->u + copy->zv * place->v + copy->z0);
}

/* Where the pigment of a facet is looked up: in the texel's bounds. */
static Vec3 place_in_bounds(const TexelCopy *copy, Vec3 in) {
    if (copy->texel->beam->cyclic[0]) in.x -= floor(in.x);
    if (copy->texel->beam->cyclic[1]) in.y -= floor(in.y);
    if (copy->texel->beam->cyclic[2]) in.z -= floor(in.z);
    Box3 b = copy->texel->def->bounds;
    return vec3_add(b.min, vec3_mul(in, vec3_sub(b.max, b.min)));
}

/* The unit normal of what the facet stands for, on the side of the unit vector `side`; zero where the mapping is singular. */
static Vec3f normal_on_side(const TexelCopy *copy, const TexturePlace *place, Vec3 in_texel, Vec3 side) {
    Vec3 n = vec3_normalize(texel_normal_in_scene(copy, place, in_texel));
    return vec3f_from(vec3_dot(n, side) < 0 ? vec3_negate(n) : n);
}

/* The pigment of the texel's own at a point of the plane. */
static Vec3f own_color(const FacetPlane *plane, const Look *own, Vec3 point) {
    const TexelCopy *copy = &plane->facet->copy;
    SkinPoint at = in_cell(plane, point);
    TexturePlace place = skin_texture_place(plane->facet->cell, &at);
    Vec3 in = place_in_box(copy, &place);
    return look_color(own, place_in_bounds(copy, in), beam_facet_normal(plane->facet, in), 0);
}

/* Its mean over the samples. */
static Vec3f facet_color(const BeamTracer *tr, const FacetPlane *plane, const Look *own, const Sight *sight) {
    if (sight->look->uniform) return sight->look->color;
    Vec3f sum = {0, 0, 0};
    for (int i = sight->first; i != BEAM_NOTHING; i = tr->next[i]) {
        double t;
        Vec3 point = beam_sample_point(tr, (uint32_t)i, &t);
        sum = vec3f_add(sum, sight->look == own ? own_color(plane, own, point) : look_color(sight->look, point, vec3_from_f(sight->normal), 0));
    }
    return vec3f_scale(sum, 1 / (float)sight->count);
}

static Vec3 mean_point(const BeamTracer *tr, const Sight *sight) {
    Vec3 sum = {0, 0, 0};
    for (int i = sight->first; i != BEAM_NOTHING; i = tr->next[i]) {
        double t;
        sum = vec3_add(sum, beam_sample_point(tr, (uint32_t)i, &t));
    }
    return vec3_scale(sum, 1.0 / sight->count);
}

/* Copies of what is known of one place in each period, or at the rim of what stands alone. */
static float sky_at(const TexelCopy *copy, const TexturePlace *place, Vec3 in, Vec3f to_eye) {
    if (!copy->texel->sky) return -1;
    double *axes[] = {&in.x, &in.y, &in.z};
    for (int i = 0; i < 3; i++) *axes[i] = copy->texel->beam->cyclic[i] ? *axes[i] - floor(*axes[i]) : double_clamp(*axes[i], 0, 1);
    return skin_sky_seen(copy, place, vec3f_mul(vec3f_from(in), copy->texel->extent), vec3_from_f(to_eye));
}

/* What it stands for is as flat as the facet, in the scene as in texel space. */
static bool is_as_flat(const BeamFacet *f) { return f->skin->rigid && !f->round; }

/* When all samples of the sight are known: it is what they see on average. */
static void see_facet(const BeamTracer *tr, Sight *sight) {
    const BeamFacet *f = &tr->draft.facets[tr->beam.samples.mark[sight->first] - 1];
    const TexelCopy *copy = &f->copy;
    const Look *own = &copy->texel->matter[f->layer].look;
    FacetPlane plane = plane_of(f);
    Vec3 flat = vec3_normalize(plane.normal);
    if (vec3f_dot(vec3f_from(flat), sight->view) < 0) flat = vec3_negate(flat);
    if (sight->count > 1) sight->point = mean_point(tr, sight);
    SkinPoint at = in_cell(&plane, sight->point);
    TexturePlace place = skin_texture_place(f->cell, &at);
    sight->look = f->placed->look ? f->placed->look : own;
    sight->up = vec3f_from(vec3_normalize(place.grad_layer));
    sight->sky = sky_at(copy, &place, place_in_box(copy, &place), sight->view);
    sight->flat = vec3f_from(flat);
    Vec3f round = is_as_flat(f) ? sight->flat : normal_on_side(copy, &place, beam_facet_normal(f, place_in_box(copy, &place)), flat);
    sight->normal = sheet_normal(round, sight->flat, sight->view);
    sight->bias = vec3f_from(vec3_scale(flat, BIAS_TILES * f->skin->tile_size + BIAS_DISTANCES * (double)sight->t));
    sight->clear = vec3f_length(sight->bias);
    sight->color = vec3f_mul(facet_color(tr, &plane, own, sight), copy->tint);
}

/* Whether what a surface looks like may change within a pixel. */
static bool look_varies(const SurfaceHit *hit) { return hit->share_count || !hit->look->uniform || hit->look->texture->normal; }

static void see_explicit(const SeenSurface *seen, Vec3 point, double width, int samples, double t, Sight *sight) {
    const SurfaceHit *hit = seen->hit;
    Vec3 normal = hit->normal, direction = vec3_negate(vec3_from_f(sight->view));
    double part = look_varies(hit) ? sample_width(samples) : 1;
    const Cone cone = {vec3_madd(point, direction, -hit->t), direction, part * width, 0};
    sight->color = hit->look->color;
    if (look_varies(hit) || !hit->look->opaque) surface_glance(&cone, hit, &sight->color, &normal);
    sight->look = hit->look;
    sight->surface = hit;
    sight->normal = vec3f_from(normal);
    sight->flat = vec3f_from(hit->flat);
    sight->bias = vec3f_from(vec3_scale(hit->flat, BIAS_DISTANCES * t));
    sight->clear = (float)(CLEAR_DISTANCES * t + CLEAR_PIXELS * width) + seen->bend;
}

/* Two explicit hits of one pixel that may share their shading. */
static bool same_surface(const SeenSurface *a, const SeenSurface *b) {
    if (!a->hit || !b->hit) return a->hit == b->hit;
    return a == b || (a->hit->object == b->hit->object && vec3_dot(a->hit->normal, b->hit->normal) > 0.999);
}

/* Whether a sample sees voxels of any skin before what it sees. */
static bool is_beyond(const BeamTracer *tr, uint32_t i) {
    if (isinf(tr->compiled->all_exact_to)) return false;
    float key = tr->beam.samples.key[i];
    if (tr->beam.perspective && !(key > 0)) return true;
    BeamLine line = beam_sample_line(tr, i);
    return beam_faded_distance(tr, i, beam_line_distance(tr, &line, key)) > tr->compiled->all_exact_to;
}

Cone beam_sight_cone(const BeamTracer *tr, const Sight *sight, double *t) {
    const BeamSamples *s = &tr->beam.samples;
    double x = 0, y = 0, sum = 0;
    for (int i = sight->first; i != BEAM_NOTHING; i = tr->next[i]) {
        BeamLine line = beam_sample_line(tr, (uint32_t)i);
        x += (double)s->x[i], y += (double)s->y[i];
        if (sight->look) sum += beam_line_distance(tr, &line, s->key[i]);
    }
    BeamLine line = beam_line_at(tr, x / sight->count, y / sight->count);
    Cone cone = tr->cones[sight->pixel];
    if (sight->narrow) {
        const double part = sample_width((double)tr->allotment.asked[sight->pixel] / sight->count);
        cone.width *= part, cone.spread *= part;
    }
    cone.origin = line.origin;
    cone.direction = vec3_scale(line.direction, 1 / line.length);
    *t = sight->look ? sum / sight->count : VTS_INFINITY;
    return cone;
}

/* Where the surface that carries a layer of voxels ends, parts of the pixel look at them by themselves: far layers are lower than a pixel,
 * and one line would meet them, or pass over them, for all. */
static bool is_narrow(const BeamTracer *tr, uint32_t sample, bool beyond) {
    return beyond && !tr->beam.samples.mark[sample] && tr->surface[sample] != BEAM_NOTHING;
}
/* Two across and four down, since most of what ends is a horizon. */
static int part_of_pixel(const BeamSamples *s, uint32_t sample) {
    float x = s->x[sample], y = s->y[sample];
    return 4 * (int)(2 * (x - floorf(x))) + (int)(4 * (y - floorf(y)));
}

/* What changes within a pixel is looked at for each sample: what one look misses would stay with any number of samples, and their noise
 * would know nothing of it. */
static bool may_join(const BeamSamples *s, const Sight *sight, uint32_t sample) {
    if (sight->surface && look_varies(sight->surface)) return false;
    return !sight->narrow || part_of_pixel(s, sample) == part_of_pixel(s, (uint32_t)sight->first);
}

/* The sight of the pixel, whose sights begin at `begin`, that the sample belongs to; sight_count if none does yet. */
static uint32_t sight_of(const BeamTracer *tr, int pixel, uint32_t begin, uint32_t sample, bool beyond) {
    const uint32_t *mark = tr->beam.samples.mark;
    uint32_t k = begin;
    for (; k < tr->sight_count; k++) {
        uint32_t other = (uint32_t)tr->sights[k].first;
        if (mark[sample] != mark[other] || beyond != tr->sights[k].beyond || !may_join(&tr->beam.samples, &tr->sights[k], sample)) continue;
        if (mark[sample] || same_surface(beam_surface_of(tr, pixel, sample), beam_surface_of(tr, pixel, other))) break;
    }
    return k;
}

static Sight new_sight(const BeamTracer *tr, int pixel, uint32_t sample, bool beyond) {
    Sight sight = {.pixel = pixel, .first = BEAM_NOTHING, .t = INFINITY, .sky = -1, .beyond = beyond, .narrow = is_narrow(tr, sample, beyond)};
    uint32_t mark = tr->beam.samples.mark[sample];
    if (!mark && !beam_surface_of(tr, pixel, sample)->hit) return sight;
    double t;
    sight.point = beam_sample_point(tr, sample, &t);
    sight.t = (float)t;
    sight.view = vec3f_from(vec3_normalize(vec3_negate(beam_sample_line(tr, sample).direction)));
    if (!mark) see_explicit(beam_surface_of(tr, pixel, sample), sight.point, cone_diameter(&tr->cones[pixel], t), tr->allotment.asked[pixel], t, &sight);
    return sight;
}

void beam_gather_sights(BeamTracer *tr) {
    const BeamSamples *s = &tr->beam.samples;
    tr->sight_count = 0;
    for (int pixel = 0; pixel < tr->columns * tr->rows; pixel++) {
        uint32_t begin = tr->sight_count;
        for (uint32_t i = s->first[pixel]; i < s->first[pixel + 1]; i++) {
            bool beyond = is_beyond(tr, i);
            uint32_t k = sight_of(tr, pixel, begin, i, beyond);
            Sight *sight = &tr->sights[k];
            if (k == tr->sight_count) {
                *sight = new_sight(tr, pixel, i, beyond);
                tr->sight_count++;
            }
            tr->next[i] = sight->first;
            sight->first = (int)i;
            sight->count++;
            sight->odd += (int)((i - s->first[pixel]) & 1);
        }
        for (uint32_t k = begin; k < tr->sight_count; k++)
            if (s->mark[tr->sights[k].first]) see_facet(tr, &tr->sights[k]);
    }
}
