#include "render/render.h"

#include "render/beam_tile.h"
#include "render/sampler.h"

#include <string.h>

typedef struct Frame {
    const CompiledScene *compiled;
    const RenderOptions *options;
    BeamTracer **beams; /* one for each worker; NULL: no skin is near, */
    Sampler **samplers; /* and these see the picture, */
    Middles *middles;   /* and share these; NULL: they do not */
    AovSum *aovs;       /* of the tile that each worker sees; or NULL */
} Frame;

static void see_by_beams(Frame *frame, int worker, const int tile[4], Radiance *seen, AovSum *aovs) {
    const RenderOptions *options = frame->options;
    const int *region = options->region;
    beam_tile(frame->beams[worker], tile[0], tile[1], tile[2], tile[3], seen, aovs);
    if (!options->tile_noise) return;
    int column = tile[0] / FILM_TILE - region[0] / FILM_TILE, row = tile[1] / FILM_TILE - region[1] / FILM_TILE;
    options->tile_noise[row * film_tiles_x(region) + column] = (float)beam_tile_noise(frame->beams[worker]);
}

/* The whole tile, of which a region may want a part: what is seen hangs on all of it. */
static void see_tile(void *context, int worker, int x0, int y0, int x1, int y1, Radiance *out, AovSum *aovs) {
    Frame *frame = context;
    const View *view = &frame->compiled->view;
    Radiance seen[FILM_TILE * FILM_TILE];
    AovSum *whole = frame->aovs ? frame->aovs + (size_t)worker * FILM_TILE * FILM_TILE : NULL;
    if (whole) memset(whole, 0, sizeof *whole * FILM_TILE * FILM_TILE);
    int left = x0 - x0 % FILM_TILE, top = y0 - y0 % FILM_TILE;
    int right = int_min(left + FILM_TILE, view->width), bottom = int_min(top + FILM_TILE, view->height);
    if (frame->beams) see_by_beams(frame, worker, (const int[4]){left, top, right, bottom}, seen, whole);
    else sampler_tile(frame->samplers[worker], left, top, right, bottom, seen, whole);
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            int i = (y - top) * (right - left) + x - left;
            *out++ = seen[i];
            if (aovs) *aovs++ = whole[i];
        }
}

static bool has_exact_skins(const CompiledScene *compiled) {
    for (size_t i = 0; i < compiled->skin_count; i++)
        if (compiled->skins[i].boxes) return true;
    return false;
}

static AllotPlan noisier(AllotPlan plan, double factor) {
    plan.first = int_max(2, (int)(plan.first / (factor * factor))); /* both halves of one pass tell the noise */
    plan.most = int_max(plan.first, (int)(plan.most / (factor * factor)));
    plan.worth = allot_worth_noisier(plan.worth, factor);
    return plan;
}

/* So many times the samples that pixels may have on the mean those may have that are hardest: a limit for each alone would make the others do its work. */
enum { HARDEST = 4 };

static void make_workers(Frame *frame, int workers) {
    const CompiledScene *compiled = frame->compiled;
    const RenderOptions *options = frame->options;
    Arena *arena = compiled->arena;
    if (options->aovs) frame->aovs = arena_new_array(arena, AovSum, (size_t)workers * FILM_TILE * FILM_TILE);
    if (has_exact_skins(compiled)) {
        BeamPlan plan = {.samples = compiled->allot};
        if (options->noise > 1) plan.samples = noisier(plan.samples, options->noise);
        if (options->samples > 0) plan.samples = (AllotPlan){.first = options->samples, .most = options->samples};
        plan.interrupted = options->interrupted;
        frame->beams = arena_new_array(arena, BeamTracer *, (size_t)workers);
        for (int i = 0; i < workers; i++) frame->beams[i] = beam_tracer_create(compiled, &plan, options->seed, arena);
        return;
    }
    bool told = options->samples > 0;
    SamplePlan plan = {.fixed = compiled->skin_count ? 0 : options->samples, .most = told ? options->samples : HARDEST * compiled->most_samples,
                       .most_mean = told ? options->samples : compiled->most_samples, .max_error = compiled->max_error * compiled->budget.slack[BUDGET_NOISE], .seed = options->seed, .interrupted = options->interrupted};
    frame->samplers = arena_new_array(arena, Sampler *, (size_t)workers);
    for (int i = 0; i < workers; i++) frame->samplers[i] = sampler_create(compiled, &plan, arena);
}

static TileRange tiles_of(int x0, int y0, int x1, int y1) {
    return (TileRange){x0 / FILM_TILE, y0 / FILM_TILE, (x1 - 1) / FILM_TILE + 1, (y1 - 1) / FILM_TILE + 1};
}

/* After all that takes memory from arenas, which may not return. Where middles are guessed those of a tile hang together: to draw a part of
 * a picture as in the whole the tiles around it are looked at, too, all of them. */
static void share_middles(Frame *frame, int workers) {
    const int *region = frame->options->region;
    if (!frame->samplers || frame->options->aovs) return;
    const View *view = &frame->compiled->view;
    const TileRange drawn = tiles_of(region[0], region[1], region[2], region[3]), all = tiles_of(0, 0, view->width, view->height);
    TileRange asked = drawn;
    if (sampler_guesses(frame->samplers[0]))
        asked = (TileRange){int_max(drawn.x0 - 1, 0), int_max(drawn.y0 - 1, 0), int_min(drawn.x1 + 1, all.x1), int_min(drawn.y1 + 1, all.y1)};
    frame->middles = middles_create(drawn, asked);
    for (int i = 0; i < workers; i++) sampler_share(frame->samplers[i], frame->middles);
}

static void count_workers(const Frame *frame, int workers, RenderStats *stats) {
    double squares = 0, noise = 0;
    uint64_t pixels = 0;
    SamplerTally tally = {.pixels = 0};
    for (int i = 0; i < workers; i++) {
        uint64_t count;
        if (frame->samplers) {
            sampler_count(frame->samplers[i], &stats->counters, &tally);
            continue;
        }
        beam_tracer_count(frame->beams[i], &stats->counters);
        squares += beam_tracer_error(frame->beams[i], &count);
        noise += beam_tracer_noise(frame->beams[i]);
        pixels += count;
    }
    squares += tally.squared_error, noise += tally.squared_error, pixels += tally.pixels;
    stats->split_pixels = tally.refined;
    double wrong = frame->compiled->voxel_error;
    bool known = wrong >= 0 || (frame->beams ? isinf(frame->compiled->all_exact_to) : frame->compiled->skin_count == 0);
    if (!frame->beams && wrong >= 0) squares += wrong * wrong * (double)pixels;
    stats->noise_estimate = pixels ? sqrt(noise / (double)pixels) : 0;
    stats->voxels_estimate = !known ? -1 : pixels ? sqrt(fmax(squares - noise, 0) / (double)pixels) : 0;
    stats->pixels = pixels;
    stats->error_estimate = !known ? -1 : pixels ? sqrt(squares / (double)pixels) : 0;
}

SolidWork render_functions_since(const CompiledScene *compiled, const SolidWork *before) {
    SolidWork now = {0};
    hierarchy_work(compiled->hierarchy, &now);
    return (SolidWork){now.lines - before->lines, now.evaluations - before->evaluations, now.unsettled - before->unsettled, now.sampled};
}

bool render_picture(const CompiledScene *compiled, const RenderOptions *options, MemoryBudget *memory, Image *out,
                    RenderStats *stats, StrBuf *error) {
    /* Workspace from the scene's arena: should memory run out half way, its owner releases it. */
    ArenaMark mark = arena_mark(compiled->arena);
    int workers = pool_threads(options->pool);
    Frame frame = {.compiled = compiled, .options = options};
    SolidWork before = {0};
    hierarchy_work(compiled->hierarchy, &before);
    make_workers(&frame, workers);
    share_middles(&frame, workers);
    bool done = film_expose(options, compiled->scene->settings.assumed_gamma, "render", see_tile, &frame, memory, out, error);
    *stats = (RenderStats){.error_estimate = -1};
    count_workers(&frame, workers, stats);
    stats->counters.functions = render_functions_since(compiled, &before);
    middles_destroy(frame.middles);
    arena_reset_to(compiled->arena, mark);
    return done;
}
