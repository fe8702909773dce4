#include "render/render.h"

#include "base/random.h"
#include "render/beam_tile.h"

typedef struct Frame {
    const CompiledScene *compiled;
    const RenderOptions *options;
    Tracer *tracers; /* one for each worker */
    BeamTracer **beams; /* likewise; NULL: everything is voxels */
    uint64_t *split_pixels;
} Frame;

static bool find_surface(const CompiledScene *compiled, const Cone *cone, SurfaceHit *hit) {
    Ray ray = {cone->origin, cone->direction};
    return hierarchy_intersect(compiled->hierarchy, &ray, 1e-9, VTS_INFINITY, hit);
}

/* Whether explicit surfaces look the same all over the pixel: same part, much the same direction and depth. */
static bool alike(const SurfaceHit *a, const SurfaceHit *b) {
    return a->object == b->object && vec3_dot(a->normal, b->normal) > 0.95 && fabs(a->t - b->t) < 0.05 * (a->t + b->t);
}

static bool surfaces_vary(const CompiledScene *compiled, double x, double y, bool found, const SurfaceHit *hit) {
    for (int corner = 0; corner < 4; corner++) {
        Cone probe = view_cone(&compiled->view, x + (corner & 1 ? 0.499 : -0.499), y + (corner & 2 ? 0.499 : -0.499), 1);
        SurfaceHit other;
        bool other_found = find_surface(compiled, &probe, &other);
        if (other_found != found || (found && !alike(hit, &other))) return true;
    }
    return false;
}

/* Explicit edges narrower than a pixel: an n × n grid of thinner cones, one cone for each. */
static Radiance trace_split(Tracer *tracer, double x, double y, int n, const atomic_bool *interrupted) {
    Radiance sum = {{0, 0, 0}, 0};
    uint64_t seed = tracer->seed;
    for (int j = 0; j < n && !(interrupted && *interrupted); j++)
        for (int i = 0; i < n; i++) {
            Cone cone = view_cone(&tracer->compiled->view, x + (i + 0.5) / n - 0.5, y + (j + 0.5) / n - 0.5, 1.0 / n);
            if (vec3_length_squared(cone.direction) == 0) continue;
            SurfaceHit hit;
            float reaching;
            tracer->seed = random_mix(seed + (uint64_t)(j * n + i));
            bool found = find_surface(tracer->compiled, &cone, &hit);
            Radiance part = trace_cone(tracer, &cone, found ? &hit : NULL, &reaching);
            sum.color = vec3f_add(sum.color, part.color);
            sum.alpha += part.alpha;
        }
    float share = 1 / (float)(n * n);
    return (Radiance){vec3f_scale(sum.color, share), sum.alpha * share};
}

/* What of a pixel's light an edge behind the skins may change before it is worth more cones. */
static const float EDGE_WORTH = 1.0f / 64;

static Radiance trace_pixel(void *context, int worker, int px, int py) {
    Frame *frame = context;
    Tracer *tracer = &frame->tracers[worker];
    double x = px + 0.5, y = py + 0.5;
    Cone cone = view_cone(&frame->compiled->view, x, y, 1);
    if (vec3_length_squared(cone.direction) == 0) return (Radiance){{0, 0, 0}, 0};
    SurfaceHit hit;
    float reaching;
    tracer->seed = random_hash((uint64_t)px, (uint64_t)py, frame->options->seed, 0);
    bool found = find_surface(frame->compiled, &cone, &hit);
    Radiance radiance = trace_cone(tracer, &cone, found ? &hit : NULL, &reaching);
    if (reaching < EDGE_WORTH || !surfaces_vary(frame->compiled, x, y, found, &hit)) return radiance;
    int n = frame->options->samples > 0 ? (int)ceil(sqrt(frame->options->samples)) : frame->compiled->split;
    if (n == 1) return radiance;
    frame->split_pixels[worker]++;
    return trace_split(tracer, x, y, n, frame->options->interrupted);
}

/* The whole tile, of which a region may want a part: what beams see hangs, by rounding errors, on where they begin. */
static void see_by_beams(Frame *frame, int worker, int x0, int y0, int x1, int y1, Radiance *out) {
    const View *view = &frame->compiled->view;
    Radiance seen[FILM_TILE * FILM_TILE];
    int left = x0 - x0 % FILM_TILE, top = y0 - y0 % FILM_TILE;
    int right = int_min(left + FILM_TILE, view->width), bottom = int_min(top + FILM_TILE, view->height);
    beam_tile(frame->beams[worker], left, top, right, bottom, seen);
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) *out++ = seen[(y - top) * (right - left) + x - left];
}

static void see_tile(void *context, int worker, int x0, int y0, int x1, int y1, Radiance *out) {
    Frame *frame = context;
    const atomic_bool *interrupted = frame->options->interrupted;
    if (frame->beams) {
        see_by_beams(frame, worker, x0, y0, x1, y1, out);
        return;
    }
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++, out++) *out = interrupted && *interrupted ? (Radiance){{0, 0, 0}, 0} : trace_pixel(context, worker, x, y);
}

static bool has_exact_skins(const CompiledScene *compiled) {
    for (size_t i = 0; i < compiled->skin_count; i++)
        if (compiled->skins[i].boxes) return true;
    return false;
}

static double expected_error(const Frame *frame, int workers) {
    double squares = 0;
    uint64_t pixels = 0, count;
    for (int i = 0; i < workers; i++) {
        squares += beam_tracer_error(frame->beams[i], &count);
        pixels += count;
    }
    return pixels ? sqrt(squares / (double)pixels) : 0;
}

bool render_picture(const CompiledScene *compiled, const RenderOptions *options, MemoryBudget *memory, Image *out,
                    RenderStats *stats, StrBuf *error) {
    /* Workspace from the scene's arena: should memory run out half way, its owner releases it. */
    ArenaMark mark = arena_mark(compiled->arena);
    int workers = pool_threads(options->pool);
    Frame frame = {.compiled = compiled, .options = options, .split_pixels = arena_new_array(compiled->arena, uint64_t, (size_t)workers)};
    if (has_exact_skins(compiled)) {
        BeamPlan plan = {.first = compiled->samples, .most = compiled->most_samples, .max_error = compiled->max_error};
        if (options->samples > 0) plan = (BeamPlan){.first = options->samples, .most = options->samples};
        frame.beams = arena_new_array(compiled->arena, BeamTracer *, (size_t)workers);
        for (int i = 0; i < workers; i++) frame.beams[i] = beam_tracer_create(compiled, &plan, options->seed, compiled->arena);
    } else {
        frame.tracers = arena_new_array(compiled->arena, Tracer, (size_t)workers);
        for (int i = 0; i < workers; i++) tracer_init(&frame.tracers[i], compiled, compiled->arena);
    }
    bool done = film_expose(options, "render", see_tile, &frame, memory, out, error);
    *stats = (RenderStats){.error_estimate = -1};
    if (frame.beams && isinf(compiled->all_exact_to)) stats->error_estimate = expected_error(&frame, workers);
    for (int i = 0; i < workers; i++) {
        if (frame.beams) beam_tracer_count(frame.beams[i], &stats->counters);
        else trace_counters_add(&stats->counters, &frame.tracers[i].counters);
        stats->split_pixels += frame.split_pixels[i];
    }
    arena_reset_to(compiled->arena, mark);
    return done;
}
