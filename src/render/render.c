#include "render/render.h"

#include "base/random.h"

#include <pthread.h>
#include <stdatomic.h>

enum { TILE = 16 };

typedef struct Frame {
    const CompiledScene *compiled;
    const RenderOptions *options;
    Image *image;
    Tracer *tracers; /* one for each worker */
    uint64_t *split_pixels;
    int tiles_x, tiles_y;
    float gain;
    atomic_size_t done;
    pthread_mutex_t progress_lock;
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

static Radiance trace_pixel(Frame *frame, Tracer *tracer, int worker, int px, int py) {
    double x = px + 0.5, y = py + 0.5;
    Cone cone = view_cone(&frame->compiled->view, x, y, 1);
    SurfaceHit hit;
    float reaching;
    tracer->seed = random_hash((uint64_t)px, (uint64_t)py, frame->options->seed, 0);
    bool found = find_surface(frame->compiled, &cone, &hit);
    Radiance radiance = trace_cone(tracer, &cone, found ? &hit : NULL, &reaching);
    if (reaching < EDGE_WORTH || !surfaces_vary(frame->compiled, x, y, found, &hit)) return radiance;
    int n = frame->options->samples > 0 ? frame->options->samples : frame->compiled->split;
    if (n == 1) return radiance;
    frame->split_pixels[worker]++;
    return trace_split(tracer, x, y, n, frame->options->interrupted);
}

static void render_tile(void *context, size_t index, int worker) {
    Frame *frame = context;
    const RenderOptions *options = frame->options;
    if (options->interrupted && *options->interrupted) return;
    int tx = (int)(index % (size_t)frame->tiles_x), ty = (int)(index / (size_t)frame->tiles_x);
    int x0 = options->region[0] + tx * TILE, y0 = options->region[1] + ty * TILE;
    int x1 = int_min(x0 + TILE, options->region[2]), y1 = int_min(y0 + TILE, options->region[3]);
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1 && !(options->interrupted && *options->interrupted); x++) {
            Radiance r = trace_pixel(frame, &frame->tracers[worker], worker, x, y);
            float *pixel = image_pixel(frame->image, x - options->region[0], y - options->region[1]);
            pixel[0] = r.color.x * frame->gain;
            pixel[1] = r.color.y * frame->gain;
            pixel[2] = r.color.z * frame->gain;
            if (options->alpha) pixel[3] = r.alpha;
        }
    size_t done = atomic_fetch_add(&frame->done, 1) + 1;
    pthread_mutex_lock(&frame->progress_lock);
    progress_update(options->progress, "render", done, (size_t)frame->tiles_x * (size_t)frame->tiles_y);
    pthread_mutex_unlock(&frame->progress_lock);
}

static void add_counters(RenderStats *stats, const TraceCounters *c) {
    stats->counters.camera_rays += c->camera_rays;
    stats->counters.shadow_rays += c->shadow_rays;
    stats->counters.steps += c->steps;
    stats->counters.voxels_visited += c->voxels_visited;
}

bool render_picture(const CompiledScene *compiled, const RenderOptions *options, MemoryBudget *memory, Image *out,
                    RenderStats *stats, StrBuf *error) {
    int width = options->region[2] - options->region[0], height = options->region[3] - options->region[1];
    if (!image_init(out, width, height, options->alpha ? 4 : 3, NULL, memory, error)) return false;
    /* Workspace from the scene's arena: should memory run out half way, its owner releases it. */
    ArenaMark mark = arena_mark(compiled->arena);
    int workers = pool_threads(options->pool);
    Frame frame = {.compiled = compiled, .options = options, .image = out, .gain = (float)exp2(options->exposure),
                   .tiles_x = (width + TILE - 1) / TILE, .tiles_y = (height + TILE - 1) / TILE,
                   .tracers = arena_new_array(compiled->arena, Tracer, (size_t)workers),
                   .split_pixels = arena_new_array(compiled->arena, uint64_t, (size_t)workers)};
    pthread_mutex_init(&frame.progress_lock, NULL);
    for (int i = 0; i < workers; i++) tracer_init(&frame.tracers[i], compiled, compiled->arena);
    bool done = pool_run(options->pool, (size_t)frame.tiles_x * (size_t)frame.tiles_y, render_tile, &frame);
    *stats = (RenderStats){0};
    for (int i = 0; i < workers; i++) {
        add_counters(stats, &frame.tracers[i].counters);
        stats->split_pixels += frame.split_pixels[i];
    }
    pthread_mutex_destroy(&frame.progress_lock);
    arena_reset_to(compiled->arena, mark);
    if (!done) image_free(out);
    return done;
}
