#include "render/beam_tile.h"

#include "base/random.h"
#include "render/beam_sky.h"

#include <string.h>

/* 1/√2: where the first of the samples goes over; the last does twice as far away. */
static const double LEAST_FADE = 0.70710678118654752;
enum { NOTHING = -1, EDGE = BEAM_TILE + 2 };
/* How far beside a place its shadow begins, in pixels and tiles. */
static const double BIAS_PIXELS = 0.02, BIAS_TILES = 3e-4;
/* How far triangles may leave what the mapping makes of them, in pixels, with so many samples: as they are fewer, their noise hides more. */
enum { MOST_IN_PASS = 32 };
/* The error of a mean from how far the means of its halves are apart: 1/2 if they were random. Measured: test_analytic_sessions. */
static const double HALVES_TO_ERROR = 0.42;
static double tolerance_for(int samples) { return double_clamp(2 / sqrt(samples), 0.125, 2); }

/* An explicit surface, as one ray has met it. */
typedef struct SeenSurface {
    bool found;
    SurfaceHit hit;
    double key_x, key_y, key_0; /* of its tangent plane in the beam */
} SeenSurface;

/* Samples of one pixel that see the same thing. */
typedef struct Sight {
    int pixel;            /* in the tile */
    int first, count;     /* its samples are linked: next[] */
    float t;              /* of the first; VTS_INFINITY of the sky */
    Vec3f up;             /* of the layer; zero of explicit objects */
    Vec3f normal, flat, bias; /* bias: to add to a place on it so that it lies on the side of the eye */
    const Look *look;     /* NULL: the sky */
    const SurfaceHit *surface;
    Vec3f view;           /* from the first sample to the eye: across a horizon the pixel's own direction is another side's */
    Vec3f color, light;   /* pigment; what it sends to the eye, so far */
    int odd;              /* how many of its samples have odd numbers, and what these alone see of the light */
    Vec3f odd_light;
    Vec3f tone;           /* of the light that is being asked for, without shadows */
    uint32_t begin;       /* of its points */
    bool asked;           /* whether it has any */
    Vec3 point;           /* of the first sample */
} Sight;

struct BeamTracer {
    const CompiledScene *compiled;
    int samples;           /* a pixel, of the pass that is being made */
    int before;            /* of the passes before */
    BeamPlan plan;
    double squared_error;  /* summed over the pixels of all tiles */
    uint64_t pixel_count;
    uint64_t seed;
    Tracer volumes;        /* empty where no voxels are seen */
    Beam beam;
    Vec3 corner, right, down; /* the line through (x, y): along corner + right·x + down·y, or from there */
    Cone cones[BEAM_TILE * BEAM_TILE]; /* of the pixels */
    uint8_t shade[BEAM_TILE * BEAM_TILE]; /* what of a pixel explicit objects shadow: some of it, none of it */
    BeamDraft draft;
    ShadowScratch shadow;
    /* of the tile's pixels and a border of one around */
    SeenSurface pixels[EDGE * EDGE];
    SeenSurface *surfaces; /* of samples that were asked for one by one */
    uint32_t surface_count;
    /* per sample */
    float *fade;           /* the factor of exact_to */
    int32_t *surface;      /* into `surfaces`; NOTHING: its pixel's */
    int32_t *next;         /* sample of the same sight, or NOTHING */
    Vec3f *points;         /* where the light is asked for */
    uint8_t *hidden;
    float *distance;
    SkyScratch sky;        /* and what goes with it: for scenes with light of the sky alone */
    Vec3f *sky_up, *sky_flat;
    uint8_t *sky_turn;
    Sight *sights;
    uint32_t sight_count;
    int x0, y0, columns, rows;
    bool bounded;
    Box3 explicit_bounds;
    TraceCounters counters;
};

BeamTracer *beam_tracer_create(const CompiledScene *compiled, const BeamPlan *plan, uint64_t seed, Arena *arena) {
    BeamTracer *tr = arena_new(arena, BeamTracer);
    size_t all = (size_t)int_min(plan->most, MOST_IN_PASS) * BEAM_TILE * BEAM_TILE, most_cells = beam_most_cells(compiled);
    tr->compiled = compiled;
    tr->plan = *plan;
    tr->seed = seed;
    if (!isinf(compiled->all_exact_to)) tracer_init(&tr->volumes, compiled, arena);
    BeamSamples *s = &tr->beam.samples;
    s->first = arena_new_array(arena, uint32_t, BEAM_TILE * BEAM_TILE + 1);
    s->x = arena_new_array(arena, float, all);
    s->y = arena_new_array(arena, float, all);
    s->key = arena_new_array(arena, float, all);
    s->limit = arena_new_array(arena, float, all);
    s->mark = arena_new_array(arena, uint32_t, all);
    tr->draft.facet_capacity = (uint32_t)(all + 64);
    tr->draft.facets = arena_new_array(arena, BeamFacet, tr->draft.facet_capacity);
    tr->draft.renumber = arena_new_array(arena, uint32_t, tr->draft.facet_capacity + 1);
    tr->draft.cells = arena_new_array(arena, BeamCell, most_cells);
    Cone middle = view_cone(&compiled->view, compiled->view.width / 2.0, compiled->view.height / 2.0, 1);
    tr->draft.eye = compiled->view.camera.location;
    tr->draft.width = middle.width;
    tr->draft.spread = middle.spread;
    tr->draft.tolerance = tolerance_for(plan->first < plan->most ? 4 * plan->first : plan->first);
    tr->draft.beam = &tr->beam;
    tr->bounded = hierarchy_bounds(compiled->hierarchy, &tr->explicit_bounds);
    shadow_scratch_init(&tr->shadow, (uint32_t)all, arena);
    tr->shadow.draft = tr->draft; /* which cuts triangles alike, */
    tr->shadow.draft.facets = NULL; /* and keeps nothing */
    tr->surfaces = arena_new_array(arena, SeenSurface, all);
    tr->fade = arena_new_array(arena, float, all);
    tr->surface = arena_new_array(arena, int32_t, all);
    tr->next = arena_new_array(arena, int32_t, all);
    tr->points = arena_new_array(arena, Vec3f, all);
    tr->hidden = arena_new_array(arena, uint8_t, all);
    tr->distance = arena_new_array(arena, float, all);
    tr->sights = arena_new_array(arena, Sight, all);
    if (compiled->scene->settings.sky_light) {
        sky_scratch_init(&tr->sky, (uint32_t)all, arena);
        tr->sky_up = arena_new_array(arena, Vec3f, all);
        tr->sky_flat = arena_new_array(arena, Vec3f, all);
        tr->sky_turn = arena_new_array(arena, uint8_t, all);
    }
    return tr;
}

void beam_tracer_count(const BeamTracer *tr, TraceCounters *sum) {
    trace_counters_add(sum, &tr->counters);
    trace_counters_add(sum, &tr->volumes.counters);
}

/* ---- the beam and its samples ---- */

/* The camera's lines through the tile: in the axes right, up, direction a point is at (s, t, 1) times its depth. */
static void aim(BeamTracer *tr) {
    const View *view = &tr->compiled->view;
    const Camera *c = &view->camera;
    Mat3 axes = {{c->right, c->up, c->direction}};
    double det = mat3_determinant(&axes);
    Vec3 to_s = vec3_scale(vec3_cross(axes.c[1], axes.c[2]), 1 / det), to_t = vec3_scale(vec3_cross(axes.c[2], axes.c[0]), 1 / det);
    Vec3 to_d = vec3_scale(vec3_cross(axes.c[0], axes.c[1]), 1 / det);
    double w = view->width, h = view->height, sx = 0.5 * w - tr->x0, sy = 0.5 * h - tr->y0;
    Beam *b = &tr->beam;
    b->perspective = c->kind == CAMERA_PERSPECTIVE;
    b->light = false;
    b->origin = c->location;
    b->shift = b->perspective ? vec3(0, 0, 0) : vec3(sx, sy, 0);
    b->rows[0] = vec3_scale(to_s, w);
    b->rows[1] = vec3_scale(to_t, -h);
    b->rows[2] = b->perspective ? to_d : vec3_negate(to_d);
    if (b->perspective) {
        b->rows[0] = vec3_madd(b->rows[0], to_d, sx);
        b->rows[1] = vec3_madd(b->rows[1], to_d, sy);
    }
    double s = tr->x0 / w - 0.5, t = 0.5 - tr->y0 / h;
    tr->corner = vec3_madd(vec3_madd(b->perspective ? c->direction : c->location, c->right, s), c->up, t);
    tr->right = vec3_scale(c->right, 1 / w);
    tr->down = vec3_scale(c->up, -1 / h);
    b->samples.columns = tr->columns;
    b->samples.rows = tr->rows;
    b->nearest = b->perspective ? tr->compiled->nearest : 0;
    b->farthest = b->perspective ? VTS_INFINITY : -VTS_INFINITY;
    beam_close(b);
}

/* Of the line through (x, y) of the tile: from `origin` along `direction`, whose length is that of one unit of q.z. */
typedef struct Line {
    Vec3 origin, direction;
    double length;
} Line;

static Line line_at(const BeamTracer *tr, double x, double y) {
    Vec3 to = vec3_madd(vec3_madd(tr->corner, tr->right, x), tr->down, y);
    Line line = {tr->beam.origin, to, 0};
    if (!tr->beam.perspective) line = (Line){to, tr->compiled->view.camera.direction, 0};
    line.length = vec3_length(line.direction);
    return line;
}

static double distance_of(const BeamTracer *tr, const Line *line, float key) {
    return tr->beam.perspective ? line->length / (double)key : -(double)key * line->length;
}

/* The additive recurrence of the plastic number, shifted for each pixel at random: low discrepancy for any count. */
static void lay_samples(BeamTracer *tr) {
    const double step_x = 0.7548776662466927, step_y = 0.5698402909980532;
    BeamSamples *s = &tr->beam.samples;
    uint32_t i = 0;
    for (int row = 0; row < tr->rows; row++)
        for (int column = 0; column < tr->columns; column++) {
            uint64_t bits = random_hash((uint64_t)(tr->x0 + column), (uint64_t)(tr->y0 + row), 0, tr->seed);
            double x = random_unit(bits) + tr->before * step_x, y = random_unit(random_mix(bits)) + tr->before * step_y;
            double f = random_unit(random_mix(bits + 1)) + tr->before * 0.6180339887498949;
            s->first[row * tr->columns + column] = i;
            for (int k = 0; k < tr->samples; k++, i++) {
                x += step_x, y += step_y, f += 0.6180339887498949;
                x -= floor(x), y -= floor(y), f -= floor(f);
                s->x[i] = (float)(column + x);
                s->y[i] = (float)(row + y);
                s->mark[i] = 0;
                tr->fade[i] = (float)(LEAST_FADE * (1 + f));
                tr->surface[i] = NOTHING;
            }
        }
    s->first[tr->rows * tr->columns] = i;
}

/* ---- explicit surfaces ---- */

static void see_surface(BeamTracer *tr, double x, double y, SeenSurface *out) {
    Line line = line_at(tr, x, y);
    Ray ray = {line.origin, vec3_scale(line.direction, 1 / line.length)};
    out->found = hierarchy_intersect(tr->compiled->hierarchy, &ray, 1e-9, VTS_INFINITY, &out->hit);
    tr->counters.camera_rays++;
    if (!out->found) return;
    /* q.z of the tangent plane n·(P − P0) = 0, along lines whose direction is linear in x and y. */
    Vec3 p0 = vec3_madd(ray.origin, ray.direction, out->hit.t), n = out->hit.flat;
    if (tr->beam.perspective) {
        double far = 1 / vec3_dot(n, vec3_sub(p0, line.origin));
        Line a = line_at(tr, x + 1, y), b = line_at(tr, x, y + 1);
        out->key_0 = vec3_dot(n, line.direction) * far;
        out->key_x = vec3_dot(n, vec3_sub(a.direction, line.direction)) * far;
        out->key_y = vec3_dot(n, vec3_sub(b.direction, line.direction)) * far;
    } else {
        double per = 1 / vec3_dot(n, line.direction);
        Line a = line_at(tr, x + 1, y), b = line_at(tr, x, y + 1);
        out->key_0 = -vec3_dot(n, vec3_sub(p0, line.origin)) * per;
        out->key_x = vec3_dot(n, vec3_sub(a.origin, line.origin)) * per;
        out->key_y = vec3_dot(n, vec3_sub(b.origin, line.origin)) * per;
    }
    out->key_0 -= out->key_x * x + out->key_y * y;
}

/* Whether two neighbouring pixels may be taken for parts of one smooth surface. */
static bool alike(const SeenSurface *a, const SeenSurface *b, double x, double y) {
    if (a->found != b->found) return false;
    if (!a->found) return true;
    if (a->hit.object != b->hit.object || vec3_dot(a->hit.flat, b->hit.flat) < 0.95) return false;
    double key_a = a->key_0 + a->key_x * x + a->key_y * y, key_b = b->key_0 + b->key_x * x + b->key_y * y;
    return fabs(key_a - key_b) <= 0.01 * (fabs(key_a) + fabs(key_b));
}

static const SeenSurface *surface_of(const BeamTracer *tr, int pixel, uint32_t sample) {
    if (tr->surface[sample] != NOTHING) return &tr->surfaces[tr->surface[sample]];
    int row = pixel / tr->columns, column = pixel % tr->columns;
    return &tr->pixels[(row + 1) * EDGE + column + 1];
}

static void see_surfaces(BeamTracer *tr) {
    BeamSamples *s = &tr->beam.samples;
    for (int row = -1; row <= tr->rows && tr->before == 0; row++)
        for (int column = -1; column <= tr->columns; column++)
            see_surface(tr, column + 0.5, row + 0.5, &tr->pixels[(row + 1) * EDGE + column + 1]);
    tr->surface_count = 0;
    for (int row = 0; row < tr->rows; row++)
        for (int column = 0; column < tr->columns; column++) {
            const SeenSurface *p = &tr->pixels[(row + 1) * EDGE + column + 1];
            double x = column + 0.5, y = row + 0.5;
            bool smooth = alike(p, p - 1, x - 0.5, y) && alike(p, p + 1, x + 0.5, y) && alike(p, p - EDGE, x, y - 0.5) && alike(p, p + EDGE, x, y + 0.5);
            int pixel = row * tr->columns + column;
            for (uint32_t i = s->first[pixel]; i < s->first[pixel + 1]; i++) {
                double sx = (double)s->x[i], sy = (double)s->y[i];
                const SeenSurface *at = p;
                if (!smooth) {
                    tr->surface[i] = (int32_t)tr->surface_count;
                    at = &tr->surfaces[tr->surface_count++];
                    see_surface(tr, sx, sy, &tr->surfaces[tr->surface[i]]);
                }
                s->key[i] = at->found ? (float)(at->key_0 + at->key_x * sx + at->key_y * sy) : tr->beam.perspective ? 0 : -INFINITY;
            }
        }
}

/* ---- skins ---- */

static void draw_skins(BeamTracer *tr, uint32_t cells) {
    BeamSamples *s = &tr->beam.samples;
    uint32_t count = s->first[tr->columns * tr->rows];
    tr->draft.facet_count = 0;
    if (!tr->beam.perspective) { /* everything is as wide: a skin is exact as a whole, or voxels */
        for (uint32_t i = 0; i < count; i++) s->limit[i] = -INFINITY;
    } else if (isfinite(tr->compiled->all_exact_to)) {
        for (uint32_t i = 0; i < count; i++) s->limit[i] = (float)line_at(tr, (double)s->x[i], (double)s->y[i]).length / tr->fade[i];
    } else {
        memset(s->limit, 0, count * sizeof *s->limit);
    }
    beam_draw_cells(&tr->draft, tr->compiled, cells);
}

/* The sky's pixels, where there is nothing else. */
static bool see_sky(const BeamTracer *tr, Radiance *out) {
    const Scene *scene = tr->compiled->scene;
    if (!tr->bounded || beam_meets_box(&tr->beam, &tr->explicit_bounds) || !isinf(tr->compiled->all_exact_to)) return false;
    for (int i = 0; i < tr->columns * tr->rows; i++) {
        Vec3f color = sky_radiance(scene, tr->cones[i].direction, tr->cones[i].spread);
        out[i] = (Radiance){fog_over(scene, color, 1, VTS_INFINITY), 0};
    }
    return true;
}

/* ---- what each sample sees ---- */

static Vec3 facet_corner(const BeamFacet *f, int i) {
    return skin_cell_position(f->cell, (double)f->corner[i].x, (double)f->corner[i].y, (double)f->corner[i].z, NULL);
}

/* Where the pigment of a facet is looked up: in the texel's bounds. */
static Vec3 facet_place(const BeamFacet *f, Vec3 point, const Vec3 p[3], Vec3 normal) {
    Vec3 e1 = vec3_sub(p[1], p[0]), e2 = vec3_sub(p[2], p[0]), r = vec3_sub(point, p[0]);
    double area = vec3_length_squared(normal);
    double u = area > 0 ? vec3_dot(vec3_cross(r, e2), normal) / area : 0, v = area > 0 ? vec3_dot(vec3_cross(e1, r), normal) / area : 0;
    Vec3f c = vec3f_add(f->corner[0], vec3f_add(vec3f_scale(vec3f_sub(f->corner[1], f->corner[0]), (float)u),
                                                vec3f_scale(vec3f_sub(f->corner[2], f->corner[0]), (float)v)));
    SkinPoint at = {0, (double)c.x, (double)c.y, (double)c.z};
    TexturePlace place = skin_texture_place(f->cell, &at);
    const TexelCopy *copy = &f->copy;
    Vec3 in = vec3(copy->xu * place.u + copy->xv * place.v + copy->x0, place.w * copy->inverse_scale,
                   copy->zu * place.u + copy->zv * place.v + copy->z0);
    if (copy->texel->beam->cyclic[0]) in.x -= floor(in.x);
    if (copy->texel->beam->cyclic[1]) in.y -= floor(in.y);
    if (copy->texel->beam->cyclic[2]) in.z -= floor(in.z);
    Box3 b = copy->texel->def->bounds;
    return vec3_add(b.min, vec3_mul(in, vec3_sub(b.max, b.min)));
}

/* Across the layer, away from the surface. */
static Vec3f layer_up(const BeamFacet *f) {
    Vec3f middle = vec3f_scale(vec3f_add(f->corner[0], vec3f_add(f->corner[1], f->corner[2])), 1.0f / 3);
    SkinPoint at = {0, (double)middle.x, (double)middle.y, (double)middle.z};
    TexturePlace place = skin_texture_place(f->cell, &at);
    return vec3f_from(vec3_normalize(place.grad_layer));
}

static void see_facet(const BeamFacet *f, Vec3 point, double width, Sight *sight) {
    Vec3 p[3] = {facet_corner(f, 0), facet_corner(f, 1), facet_corner(f, 2)};
    Vec3 normal = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0])), unit = vec3_normalize(normal);
    if (vec3f_dot(vec3f_from(unit), sight->view) < 0) unit = vec3_negate(unit);
    sight->up = layer_up(f);
    const Look *own = &f->copy.texel->matter[f->layer].look;
    sight->look = f->placed->look ? f->placed->look : own;
    sight->normal = sight->flat = vec3f_from(unit);
    sight->bias = vec3f_from(vec3_scale(unit, BIAS_TILES * f->skin->tile_size + BIAS_PIXELS * width));
    Vec3f color = sight->look->color;
    if (!sight->look->uniform) {
        Vec3 place = sight->look == own ? facet_place(f, point, p, normal) : point;
        color = look_color(sight->look, place, unit, 0);
    }
    sight->color = vec3f_mul(color, f->copy.tint);
}

static void see_explicit(const SeenSurface *seen, Vec3 point, double width, double t, Sight *sight) {
    const SurfaceHit *hit = &seen->hit;
    Vec3 local = transform_point_back(&hit->space, point), local_normal = vec3_normalize(mat3_apply_transposed(&hit->space.linear, hit->normal));
    double shrink = cbrt(fabs(mat3_determinant(&hit->space.inverse_linear))), facing = fmax(0.05, vec3_dot(hit->normal, vec3_from_f(sight->view)));
    sight->look = hit->look;
    sight->surface = hit;
    sight->normal = vec3f_from(hit->normal);
    sight->flat = vec3f_from(hit->flat);
    sight->bias = vec3f_from(vec3_scale(hit->flat, 1e-5 * t + 0.01 * width));
    sight->color = hit->look->uniform ? hit->look->color : look_color(hit->look, local, local_normal, width / facing * shrink);
}

static Line sample_line(const BeamTracer *tr, uint32_t i) {
    return line_at(tr, (double)tr->beam.samples.x[i], (double)tr->beam.samples.y[i]);
}

static Vec3 sample_point(const BeamTracer *tr, uint32_t i, double *t) {
    const BeamSamples *s = &tr->beam.samples;
    Line line = sample_line(tr, i);
    *t = distance_of(tr, &line, s->key[i]);
    return vec3_madd(line.origin, line.direction, *t / line.length);
}

static Cone pixel_cone(const BeamTracer *tr, int pixel) { return tr->cones[pixel]; }

/* Two explicit hits of one pixel that may share their shading. */
static bool same_surface(const SeenSurface *a, const SeenSurface *b) {
    return a == b || (a->found == b->found && (!a->found || (a->hit.object == b->hit.object && vec3_dot(a->hit.normal, b->hit.normal) > 0.999)));
}

static void gather_sights(BeamTracer *tr) {
    const BeamSamples *s = &tr->beam.samples;
    tr->sight_count = 0;
    for (int pixel = 0; pixel < tr->columns * tr->rows; pixel++) {
        uint32_t begin = tr->sight_count;
        for (uint32_t i = s->first[pixel]; i < s->first[pixel + 1]; i++) {
            const SeenSurface *surface = s->mark[i] ? NULL : surface_of(tr, pixel, i);
            uint32_t k = begin;
            for (; k < tr->sight_count; k++) {
                uint32_t other = (uint32_t)tr->sights[k].first;
                if (s->mark[i] != s->mark[other]) continue;
                if (s->mark[i] || same_surface(surface, surface_of(tr, pixel, other))) break;
            }
            Sight *sight = &tr->sights[k];
            if (k < tr->sight_count) {
                tr->next[i] = sight->first;
                sight->first = (int)i;
                sight->count++;
                sight->odd += (int)((i - s->first[pixel]) & 1);
                continue;
            }
            tr->sight_count++;
            *sight = (Sight){.pixel = pixel, .first = (int)i, .count = 1, .odd = (int)((i - s->first[pixel]) & 1), .t = INFINITY};
            tr->next[i] = NOTHING;
            if (!s->mark[i] && !surface->found) continue;
            double t;
            Vec3 point = sample_point(tr, i, &t);
            sight->t = (float)t;
            sight->point = point;
            sight->view = vec3f_from(vec3_normalize(vec3_negate(sample_line(tr, i).direction)));
            Cone cone = pixel_cone(tr, pixel);
            double width = cone_diameter(&cone, t);
            if (s->mark[i]) see_facet(&tr->draft.facets[s->mark[i] - 1], point, width, sight);
            else see_explicit(surface, point, width, t, sight);
        }
    }
}

/* ---- light ---- */

static float luminance(Vec3f c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

/* What the light would send to the eye if nothing were in its way. */
static Vec3f tone_of(const Sight *sight, const Light *light, LightRay *ray) {
    *ray = light_ray(light, sight->point);
    NdfShade shade = sheet_shade(sight->normal, sight->view, vec3f_from(ray->direction), &sight->look->sheet);
    if (shade.diffuse <= 0 && shade.highlight <= 0) return vec3f(0, 0, 0);
    return vec3f_mul(shade_tone(&shade, sight->look, sight->color), ray->color);
}

/* Puts the samples of a sight on the list of points whose shadows are wanted. */
static uint32_t add_points(BeamTracer *tr, const Sight *sight, const LightRay *ray, uint32_t count) {
    bool front = vec3f_dot(sight->flat, vec3f_from(ray->direction)) > 0;
    for (int i = sight->first; i != NOTHING; i = tr->next[i]) {
        double t;
        Vec3f p = vec3f_from(vec3_sub(sample_point(tr, (uint32_t)i, &t), tr->beam.origin));
        tr->points[count] = front ? vec3f_add(p, sight->bias) : vec3f_sub(p, sight->bias);
        tr->hidden[count] = 0;
        tr->distance[count] = (float)t;
        count++;
    }
    return count;
}

static bool hidden_by_surfaces(BeamTracer *tr, const Sight *sight, Vec3 to_light, double distance, uint32_t point) {
    Ray shadow = {vec3_add(tr->beam.origin, vec3_from_f(tr->points[point])), to_light};
    tr->counters.shadow_rays++;
    return hierarchy_occluded(tr->compiled->hierarchy, &shadow, (double)vec3f_length(sight->bias), distance);
}

enum { SOME_HIDDEN = 1, SOME_LIT = 2 };

/* One ray for each sight; all of its samples where that and the pixels around do not agree: there an edge of a shadow passes. */
static void hide_by_surfaces(BeamTracer *tr, const Light *light) {
    memset(tr->shade, 0, sizeof tr->shade);
    for (uint32_t k = 0; k < tr->sight_count; k++) {
        const Sight *sight = &tr->sights[k];
        if (!sight->asked) continue;
        LightRay ray = light_ray(light, sight->point);
        bool hidden = hidden_by_surfaces(tr, sight, ray.direction, ray.distance, sight->begin);
        memset(tr->hidden + sight->begin, hidden, (size_t)sight->count);
        tr->shade[sight->pixel] |= hidden ? SOME_HIDDEN : SOME_LIT;
    }
    for (uint32_t k = 0; k < tr->sight_count; k++) {
        const Sight *sight = &tr->sights[k];
        if (!sight->asked || sight->count == 1) continue;
        int column = sight->pixel % tr->columns, row = sight->pixel / tr->columns;
        unsigned around = tr->shade[sight->pixel];
        if (column > 0) around |= tr->shade[sight->pixel - 1];
        if (column + 1 < tr->columns) around |= tr->shade[sight->pixel + 1];
        if (row > 0) around |= tr->shade[sight->pixel - tr->columns];
        if (row + 1 < tr->rows) around |= tr->shade[sight->pixel + tr->columns];
        if (around != (SOME_HIDDEN | SOME_LIT)) continue;
        LightRay ray = light_ray(light, sight->point);
        for (uint32_t i = 1; i < (uint32_t)sight->count; i++)
            tr->hidden[sight->begin + i] = hidden_by_surfaces(tr, sight, ray.direction, ray.distance, sight->begin + i);
    }
}

/* The share of light that voxels let through to a sight: of skins that have no exact geometry there. */
static float through_voxels(BeamTracer *tr, const Sight *sight, const Cone *cone, const LightRay *ray) {
    if ((double)sight->t <= tr->compiled->all_exact_to) return 1;
    double aperture = tr->compiled->shadow_aperture, side = vec3f_dot(sight->flat, vec3f_from(ray->direction)) > 0 ? 1 : -1;
    Vec3 from = vec3_madd(cone_point(cone, (double)sight->t), vec3_from_f(sight->bias), side);
    Cone shadow = {from, ray->direction, cone_diameter(cone, (double)sight->t) * aperture, cone->spread * aperture};
    return skin_light_through_voxels(&tr->volumes.light, &shadow, ray->distance, (double)sight->t);
}

/* The share of a sight's points that are not hidden, of all and of those with odd numbers. */
static void shares_seen(const BeamTracer *tr, const Sight *sight, float *all, float *odd) {
    int hidden = 0, odd_hidden = 0;
    uint32_t at = sight->begin, first = tr->beam.samples.first[sight->pixel];
    for (int i = sight->first; i != NOTHING; i = tr->next[i], at++) {
        hidden += tr->hidden[at];
        odd_hidden += (((uint32_t)i - first) & 1) ? tr->hidden[at] : 0;
    }
    *all = 1 - (float)hidden / (float)sight->count;
    *odd = sight->odd ? 1 - (float)odd_hidden / (float)sight->odd : *all;
}

static void add_light(BeamTracer *tr, const Light *light) {
    uint32_t count = 0;
    for (uint32_t k = 0; k < tr->sight_count; k++) {
        Sight *sight = &tr->sights[k];
        sight->tone = vec3f(0, 0, 0);
        sight->begin = count;
        sight->asked = false;
        if (!sight->look) continue;
        Cone cone = pixel_cone(tr, sight->pixel);
        LightRay ray;
        sight->tone = tone_of(sight, light, &ray);
        if (light->shadowless || !(luminance(sight->tone) > 0)) continue;
        count = add_points(tr, sight, &ray, count);
        sight->asked = true;
        float through = through_voxels(tr, sight, &cone, &ray);
        sight->tone = vec3f_scale(sight->tone, through);
    }
    hide_by_surfaces(tr, light);
    ShadowPoints points = {.origin = tr->beam.origin, .points = tr->points, .distance = tr->distance, .hidden = tr->hidden, .count = count};
    beam_shadow(&tr->shadow, tr->compiled, light, &points);
    for (uint32_t k = 0; k < tr->sight_count; k++) {
        Sight *sight = &tr->sights[k];
        if (!(luminance(sight->tone) > 0)) continue;
        float seen = 1, odd_seen = 1;
        if (sight->asked) shares_seen(tr, sight, &seen, &odd_seen);
        sight->light = vec3f_madd(sight->light, sight->tone, seen);
        sight->odd_light = vec3f_madd(sight->odd_light, sight->tone, odd_seen);
    }
}

/* Ambient and emitted light. Of the former, where the scene asks for it, the sky's share that is seen. */
static void add_ambient(BeamTracer *tr) {
    bool sky = tr->compiled->scene->settings.sky_light;
    uint32_t count = 0;
    for (uint32_t k = 0; k < tr->sight_count && sky; k++) {
        Sight *sight = &tr->sights[k];
        sight->begin = count;
        if (!sight->look || vec3f_length(sight->up) == 0) continue;
        uint32_t first = tr->beam.samples.first[sight->pixel];
        uint32_t turn = (uint32_t)random_hash((uint64_t)(tr->x0 + sight->pixel % tr->columns), (uint64_t)(tr->y0 + sight->pixel / tr->columns), 2, tr->seed);
        for (int i = sight->first; i != NOTHING; i = tr->next[i], count++) {
            double t;
            tr->points[count] = vec3f_from(vec3_sub(sample_point(tr, (uint32_t)i, &t), tr->beam.origin));
            tr->distance[count] = (float)t;
            tr->sky_up[count] = sight->up;
            tr->sky_flat[count] = sight->bias;
            tr->sky_turn[count] = (uint8_t)((turn + (uint32_t)tr->before + (uint32_t)i - first) % SKY_PAIRS);
        }
    }
    SkySamples samples = {tr->beam.origin, tr->points, tr->sky_up, tr->sky_flat, tr->distance, tr->sky_turn, tr->hidden, count};
    if (count) beam_sky(&tr->sky, &tr->shadow, tr->compiled, &samples);
    for (uint32_t k = 0; k < tr->sight_count; k++) {
        Sight *s = &tr->sights[k];
        if (!s->look) continue;
        float seen = 1, odd_seen = 1;
        if (sky && vec3f_length(s->up) > 0) shares_seen(tr, s, &seen, &odd_seen);
        s->light = vec3f_mul(vec3f_madd(s->look->emission, s->look->ambient, seen), s->color);
        s->odd_light = vec3f_mul(vec3f_madd(s->look->emission, s->look->ambient, odd_seen), s->color);
    }
}

/* ---- pixels ---- */

/* Where skins' voxels begin for the samples of a sight; false when it sees none. */
static bool starts_of(const BeamTracer *tr, const Sight *sight, ConeStart *start) {
    float first = INFINITY;
    start->count = 0;
    if (isinf(tr->compiled->all_exact_to)) return false;
    for (int i = sight->first; i != NOTHING; i = tr->next[i]) {
        start->factors[start->count++] = tr->fade[i];
        first = float_min(first, tr->fade[i]);
    }
    return tr->compiled->all_exact_to * (double)first < (double)sight->t;
}

/* What a sight sends through fog and voxels, to all of its samples and to the odd ones. */
static void see_sight(BeamTracer *tr, const Sight *sight, Radiance *all, Vec3f *odd) {
    const Scene *scene = tr->compiled->scene;
    Cone cone = pixel_cone(tr, sight->pixel);
    double t = sight->look ? (double)sight->t : VTS_INFINITY;
    Vec3f sky = {0, 0, 0};
    if (!sight->look) sky = sky_radiance(scene, cone.direction, cone.spread);
    *all = (Radiance){fog_over(scene, sight->look ? sight->light : sky, 1, t), sight->look ? 1 : 0};
    *odd = fog_over(scene, sight->look ? sight->odd_light : sky, 1, t);
    ConeStart start;
    if (!starts_of(tr, sight, &start)) return;
    float transmittance;
    tr->volumes.seed = random_hash((uint64_t)(tr->x0 + sight->pixel % tr->columns), (uint64_t)(tr->y0 + sight->pixel / tr->columns), 1, tr->seed);
    Vec3f matter = trace_skins(&tr->volumes, &cone, &start, t, &transmittance);
    all->color = vec3f_madd(matter, all->color, transmittance);
    all->alpha = 1 - transmittance * (1 - all->alpha);
    *odd = vec3f_madd(matter, *odd, transmittance);
}

static float clamped_difference(Vec3f a, Vec3f b) {
    float x = float_clamp(a.x, 0, 1) - float_clamp(b.x, 0, 1), y = float_clamp(a.y, 0, 1) - float_clamp(b.y, 0, 1);
    float z = float_clamp(a.z, 0, 1) - float_clamp(b.z, 0, 1);
    return (x * x + y * y + z * z) / 3;
}

/* One pass of tr->samples a pixel: adds to the means so far. Returns the RMSE to be expected of this pass alone. */
static double see_pass(BeamTracer *tr, Radiance *out) {
    int pixels = tr->columns * tr->rows;
    uint32_t cells = beam_gather(&tr->draft, tr->compiled);
    lay_samples(tr);
    see_surfaces(tr);
    draw_skins(tr, cells);
    gather_sights(tr);
    add_ambient(tr);
    for (size_t l = 0; l < tr->compiled->scene->light_count; l++) add_light(tr, &tr->compiled->scene->lights[l]);
    /* Sights come pixel by pixel. */
    double squares = 0;
    float weight = (float)tr->samples / (float)(tr->before + tr->samples), odds = (float)(tr->samples / 2), evens = (float)tr->samples - odds;
    uint32_t k = 0;
    for (int pixel = 0; pixel < pixels; pixel++) {
        Vec3f sum = {0, 0, 0}, odd_sum = {0, 0, 0};
        float alpha = 0;
        for (; k < tr->sight_count && tr->sights[k].pixel == pixel; k++) {
            const Sight *s = &tr->sights[k];
            Radiance seen;
            Vec3f odd;
            see_sight(tr, s, &seen, &odd);
            sum = vec3f_madd(sum, seen.color, (float)s->count);
            odd_sum = vec3f_madd(odd_sum, odd, (float)s->odd);
            alpha += seen.alpha * (float)s->count;
        }
        Radiance *mean = &out[pixel];
        mean->color = vec3f_madd(vec3f_scale(mean->color, 1 - weight), sum, weight / (float)tr->samples);
        mean->alpha = mean->alpha * (1 - weight) + alpha * weight / (float)tr->samples;
        if (odds > 0) squares += (double)clamped_difference(vec3f_scale(odd_sum, 1 / odds), vec3f_scale(vec3f_sub(sum, odd_sum), 1 / evens));
    }
    return HALVES_TO_ERROR * sqrt(squares / pixels);
}

/* How the error of a tile falls with the samples: error·(samples/n)^power for n of them. */
typedef struct ErrorLaw {
    double error, samples, power;
} ErrorLaw;

static int samples_for(const ErrorLaw *law, double error, int most) {
    if (!(error > 0) || law->error <= error) return 0;
    return (int)fmin(ceil(law->samples * pow(law->error / error, 1 / law->power)), most);
}

/* A larger pass tells more: of edges the error falls with the power 3/4, of what is random on the scale of a pixel with 1/2. */
static void learn(ErrorLaw *law, double error, int samples) {
    double more = samples / law->samples;
    if (more >= 2 && error > 0 && law->error > 0) law->power = double_clamp(log(law->error / error) / log(more), 0.5, 0.8);
    if (more > 1) law->error = error, law->samples = samples;
}

/* Passes until the error should be small enough. */
void beam_tile(BeamTracer *tr, int x0, int y0, int x1, int y1, Radiance *out) {
    int pixels = (x1 - x0) * (y1 - y0), wanted = tr->plan.first;
    tr->x0 = x0, tr->y0 = y0, tr->columns = x1 - x0, tr->rows = y1 - y0;
    aim(tr);
    for (int i = 0; i < pixels; i++) tr->cones[i] = view_cone(&tr->compiled->view, x0 + i % tr->columns + 0.5, y0 + i / tr->columns + 0.5, 1);
    memset(out, 0, (size_t)pixels * sizeof *out);
    tr->pixel_count += (uint64_t)pixels;
    if (beam_gather(&tr->draft, tr->compiled) == 0 && see_sky(tr, out)) return;
    ErrorLaw law = {.samples = 0, .power = 0.75};
    for (tr->before = 0; tr->before < wanted; tr->before += tr->samples) {
        tr->samples = int_min(wanted - tr->before, MOST_IN_PASS);
        if (tr->before) aim(tr); /* drawing has narrowed the beam */
        double error = see_pass(tr, out);
        if (tr->before) learn(&law, error, tr->samples);
        else law.error = error, law.samples = tr->samples;
        wanted = int_max(tr->before + tr->samples, samples_for(&law, tr->plan.max_error, tr->plan.most));
        if (tr->plan.first == tr->plan.most) wanted = tr->plan.most;
    }
    double error = law.error * pow(law.samples / tr->before, law.power);
    tr->squared_error += error * error * pixels;
}

double beam_tracer_error(const BeamTracer *tr, uint64_t *pixels) {
    *pixels = tr->pixel_count;
    return tr->squared_error;
}
