/* A picture over the time that it is exposed: the mean of pictures of moments, of as many as its error asks for.
 *
 * Each tile takes as many as it needs: what it shows itself tells that, and what a scout shows, a small picture of the whole, which sees what
 * may pass through it between two moments. Both are the same for a region, a picture that goes on after a stop, and the whole. */
#include "vts_session.h"

#include "render/beam_afford.h"
#include "render/preview.h"

#include <math.h>
#include <string.h>

enum { MOST_INTERVALS = 128, MOST_REFERENCE_INTERVALS = 64, BLOCK = 8 };
/* So many moments are drawn with the same random numbers, so that what rests is told from what moves. */
enum { MOMENTS_ALIKE = 3 };
/* A pixel of the scout's is at least so many of the picture's each way, as many more, up to a tile, as leave the scout no larger than that, and has so many samples; where
 * skins are, which cost little more for that. Between the moments of more intervals than these little passes through a tile unseen. */
enum { LEAST_SCOUT = 4, MOST_SCOUT_PIXELS = 512, SCOUT_SAMPLES = 1, SCOUT_SKIN_SAMPLES = 16, SCOUT_INTERVALS = 16 };
/* The mean so far may have all the noise that is accepted, and the mean between so many times its square: that of both is then no more. */
static const double NOISE_BETWEEN = 3;

typedef struct Exposure {
    VtsSession *session;
    const char *scene_path;
    bool exact;
    RenderStats *stats;
    int region[4]; /* whole tiles */
    MomentMean *mean, *scout;
    int scout_size[2];
    int scout_pixel; /* of the picture's each way */
    bool scouting; /* the scout's tiles are not all finished */
    int moments;   /* drawn so far */
} Exposure;

static int intervals_of_reference(int samples) {
    int n = 1;
    while (2 * n <= samples && n < MOST_REFERENCE_INTERVALS) n *= 2;
    return n;
}

/* ---- moments ---- */

VtsStatus session_repeat(VtsSession *session, const char *scene_path, bool exact) {
    bool silent = session->silent;
    compiled_scene_destroy(&session->compiled);
    arena_destroy(&session->compiled_arena);
    arena_destroy(&session->scene_arena);
    arena_init(&session->parse, &session->memory, 0);
    arena_init(&session->scene_arena, &session->memory, 0);
    arena_init(&session->compiled_arena, &session->memory, 0);
    session->silent = true;
    VtsStatus status = session_evaluate(session, scene_path, (EvalMode){.writes_in_memory = true});
    if (status == VTS_OK) status = session_compile(session, exact, 0);
    session->silent = silent;
    return status;
}

/* Leaves the scene as it is at this moment. */
static VtsStatus go_to(Exposure *e, double moment) {
    if (e->session->moment == moment) return VTS_OK;
    e->session->moment = moment;
    return session_repeat(e->session, e->scene_path, e->exact);
}

/* Of the moments of so many intervals each is as much noisier as their mean is less so. */
static MomentPlan plan_of(const Exposure *e, MomentPlace place) {
    MomentPlan plan = {.unseen = e->moments > 0, .tiles = e->mean->open, .region = e->region};
    if (e->exact || e->moments >= MOMENTS_ALIKE) plan.seed = 0x9e3779b97f4a7c15u * (uint64_t)e->moments;
    int samples = e->session->options.reference_samples;
    if (e->exact) plan.samples = int_max(1, samples / intervals_of_reference(samples));
    else if (e->moments >= MOMENTS_ALIKE) plan.noise = sqrt(NOISE_BETWEEN * place.intervals);
    return plan;
}

static float *new_noise(const Exposure *e, const int region[4]) {
    return arena_new_array(e->session->compiled.arena, float, (size_t)film_tiles_x(region) * (size_t)film_tiles_y(region));
}

static VtsStatus draw_picture(Exposure *e, MomentPlace place) {
    VtsSession *session = e->session;
    RenderStats stats = {.error_estimate = -1};
    MomentPlan plan = plan_of(e, place);
    plan.tile_noise = new_noise(e, e->region);
    session_keep_moment(session, e->moments, e->region);
    VtsStatus status = session_draw(session, e->exact, &plan, &stats);
    if (status != VTS_OK) return status;
    if (e->moments == 0) e->stats->error_estimate = stats.error_estimate, e->stats->noise_estimate = stats.noise_estimate;
    trace_counters_add(&e->stats->counters, &stats.counters);
    e->stats->split_pixels += stats.split_pixels;
    moment_mean_add(e->mean, place, &session->picture, plan.tile_noise, 1);
    return VTS_OK;
}

/* ---- the scout ---- */

/* Tiles of the small picture that hold some of the scout's that are open. */
static const bool *open_tiles(const Exposure *e) {
    const MomentMean *m = e->scout;
    const int side = FILM_TILE / m->tile, columns = (m->tiles_x + side - 1) / side, rows = (m->tiles_y + side - 1) / side;
    bool *open = arena_new_array(e->session->compiled.arena, bool, (size_t)columns * (size_t)rows);
    for (int y = 0; y < m->tiles_y; y++)
        for (int x = 0; x < m->tiles_x; x++) open[y / side * columns + x / side] |= m->open[y * m->tiles_x + x];
    return open;
}

/* As the picture is seen, and what in it is exact geometry. Random numbers are those of the first moment: what rests stays the same. */
static VtsStatus draw_scout(Exposure *e, MomentPlace place) {
    VtsSession *session = e->session;
    CompiledScene *compiled = &session->compiled;
    const View view = compiled->view;
    const int region[4] = {0, 0, e->scout_size[0], e->scout_size[1]};
    MomentPlan plan = {.unseen = true, .apart = true, .region = region, .tiles = open_tiles(e), .tile_noise = new_noise(e, region)};
    plan.samples = compiled->skin_count ? SCOUT_SKIN_SAMPLES : SCOUT_SAMPLES;
    RenderStats stats;
    compiled->view.width = region[2], compiled->view.height = region[3];
    view_prepare(&compiled->view, compiled->arena);
    ExactReach reach = beam_reach_set(compiled, 1.0 / e->scout_pixel);
    VtsStatus status = session_draw(session, false, &plan, &stats);
    beam_reach_reset(compiled, reach);
    compiled->view = view;
    if (status != VTS_OK) return status;
    trace_counters_add(&e->stats->counters, &stats.counters);
    moment_mean_add(e->scout, place, &session->picture, plan.tile_noise, FILM_TILE / e->scout->tile);
    return VTS_OK;
}

/* ---- the whole ---- */

static VtsStatus draw_moment(Exposure *e, MomentPlace place) {
    VtsStatus status = go_to(e, place.moment);
    if (status == VTS_OK && e->scouting) status = draw_scout(e, place);
    return status == VTS_OK ? draw_picture(e, place) : status;
}

/* Whether there is more to be drawn. */
static bool close_tiles(Exposure *e, int intervals) {
    double accepted = e->session->compiled.max_error;
    if (e->scouting) moment_mean_finish(e->scout, accepted);
    moment_mean_finish(e->mean, accepted);
    if (e->exact) return true;
    bool open = moment_mean_close(e->mean, e->scouting ? e->scout : NULL, e->region[0] / FILM_TILE, e->region[1] / FILM_TILE, 2 * intervals);
    e->scouting = e->scouting && intervals < SCOUT_INTERVALS && moment_mean_close(e->scout, e->scout, 0, 0, 2 * intervals);
    return open;
}

static VtsStatus expose(Exposure *e) {
    int most = e->exact ? intervals_of_reference(e->session->options.reference_samples) : MOST_INTERVALS;
    for (bool more = true; more;) {
        MomentPlace place = moment_place(e->moments);
        VtsStatus status = draw_moment(e, place);
        if (status != VTS_OK) return status;
        e->stats->moments = (uint64_t)++e->moments;
        if (place.moment == 1) more = most > 1;
        if (moment_is_last(place)) more = close_tiles(e, place.intervals) && 2 * place.intervals < most;
        const ExposureState state = {&e->moments, &e->scouting, e->stats, e->mean, e->scout};
        if (more) session_save_moments(e->session, &state, e->region);
    }
    return VTS_OK;
}

/* The viewer has seen the first moment. */
static void show(Exposure *e) {
    VtsSession *session = e->session;
    const Image *picture = &session->picture;
    Preview *preview = session->options.preview ? session_connect_preview(session) : NULL;
    if (!preview) return;
    preview_begin(preview, session->scene_name ? session->scene_name : "vts", picture, e->mean->tiles_x * e->mean->tiles_y);
    for (int y = 0; y < picture->height; y += FILM_TILE)
        for (int x = 0; x < picture->width; x += FILM_TILE)
            preview_tile(preview, x, y, int_min(x + FILM_TILE, picture->width), int_min(y + FILM_TILE, picture->height));
    preview_end(preview, false);
    preview_close(preview);
}

/* session->picture becomes what is wanted of the tiles. */
static void crop(const Exposure *e) {
    VtsSession *session = e->session;
    Image *whole = &session->blurred.mean, *out = &session->picture;
    int wanted[4];
    session_region(session, wanted);
    int width = wanted[2] - wanted[0], height = wanted[3] - wanted[1], left = wanted[0] - e->region[0], top = wanted[1] - e->region[1];
    if (!image_init(out, width, height, whole->channels, whole->names, &session->memory, NULL)) memory_budget_fail(&session->memory);
    for (int y = 0; y < height; y++)
        memcpy(image_pixel(out, 0, y), image_pixel(whole, left, top + y), (size_t)width * (size_t)whole->channels * sizeof *out->pixels);
    moment_mean_free(&session->blurred);
    moment_mean_free(&session->scout);
}

/* Whole ones lie in a tile. */
static int scout_pixel(int width, int height) {
    int pixel = LEAST_SCOUT;
    while (pixel < FILM_TILE && int_max(width, height) > MOST_SCOUT_PIXELS * pixel) pixel *= 2;
    return pixel;
}

static void lay_tiles(Exposure *e) {
    const VtsOptions *o = &e->session->options;
    Arena *arena = &e->session->arena;
    int *r = e->region;
    session_region(e->session, r);
    r[0] -= r[0] % FILM_TILE, r[1] -= r[1] % FILM_TILE;
    r[2] = int_min((r[2] + FILM_TILE - 1) / FILM_TILE * FILM_TILE, o->width);
    r[3] = int_min((r[3] + FILM_TILE - 1) / FILM_TILE * FILM_TILE, o->height);
    int channels = o->alpha ? 4 : 3;
    *e->mean = (MomentMean){.x0 = r[0], .y0 = r[1], .tile = FILM_TILE, .block = BLOCK, .channels = channels};
    moment_mean_lay(e->mean, r[2] - r[0], r[3] - r[1], arena);
    const int pixel = e->scout_pixel = scout_pixel(o->width, o->height);
    e->scout_size[0] = (o->width + pixel - 1) / pixel, e->scout_size[1] = (o->height + pixel - 1) / pixel;
    *e->scout = (MomentMean){.tile = FILM_TILE / pixel, .block = int_max(1, BLOCK / pixel), .channels = channels};
    moment_mean_lay(e->scout, e->scout_size[0], e->scout_size[1], arena);
}

VtsStatus session_expose(VtsSession *session, const char *scene_path, bool exact, RenderStats *stats) {
    if (!session_is_blurred(session)) return session_draw(session, exact, &(MomentPlan){0}, stats);
    Exposure e = {.session = session, .scene_path = scene_path, .exact = exact, .stats = stats, .mean = &session->blurred, .scout = &session->scout, .scouting = !exact};
    *stats = (RenderStats){.error_estimate = -1};
    lay_tiles(&e);
    const ExposureState state = {&e.moments, &e.scouting, stats, e.mean, e.scout};
    session_restore_moments(session, &state, e.region);
    VtsStatus status = expose(&e);
    if (status != VTS_OK) return status;
    crop(&e);
    show(&e);
    return VTS_OK;
}
