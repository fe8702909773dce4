/* A picture over the time that it is exposed: the mean of pictures of moments, of as many as its error asks for. */
#include "vts_session.h"

#include "render/preview.h"

#include <math.h>
#include <string.h>

/* The mean over time by the trapezoidal rule, whose intervals are halved until the moments between tell nothing new: in each tile for itself. What the
 * moments between differ by from the mean so far is about twice the error of both together. */
enum { MOST_INTERVALS = 128, MOST_REFERENCE_INTERVALS = 64, BLOCK = 8 };
/* A block of so many pixels may be off by so many times the error that is accepted of a tile. */
static const double MOST_IN_BLOCK = 3;
/* So many moments are drawn with the same random numbers, so that what rests is told from what moves. */
enum { MOMENTS_ALIKE = 3 };

typedef struct Exposure {
    VtsSession *session;
    const char *scene_path;
    bool exact;
    RenderStats *stats;
    int region[4];        /* of the picture, in pixels */
    int tiles_x, tiles_y; /* of it */
    int channels;         /* that are light */
    int moments;          /* drawn so far */
    bool *open, *moving;  /* of tiles: not finished; of these, those that the last moments changed */
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

/* session->picture is then what is seen at that moment, one of `count` new ones. */
static VtsStatus draw_moment(Exposure *e, double moment, int count) {
    VtsSession *session = e->session;
    RenderStats stats = {.error_estimate = -1};
    MomentPlan plan = {.unseen = e->moments > 0, .tiles = e->open};
    if (e->exact || e->moments >= MOMENTS_ALIKE) plan.seed = 0x9e3779b97f4a7c15u * (uint64_t)e->moments;
    if (e->exact)
        plan.samples = int_max(1, session->options.reference_samples /
                                      intervals_of_reference(session->options.reference_samples));
    else if (e->moments >= MOMENTS_ALIKE)
        plan.noise = sqrt(count);
    VtsStatus status = go_to(e, moment);
    if (status == VTS_OK) status = session_draw(session, e->exact, &plan, &stats);
    if (status != VTS_OK) return status;
    if (e->moments++ == 0) e->stats->error_estimate = stats.error_estimate, e->stats->noise_estimate = stats.noise_estimate;
    trace_counters_add(&e->stats->counters, &stats.counters);
    e->stats->split_pixels += stats.split_pixels;
    return VTS_OK;
}

static void drop(Image *image) {
    image_free(image);
    *image = (Image){0};
}

static size_t pixels_of(const Image *image) { return (size_t)image->width * (size_t)image->height; }

/* into = a·into + b·other, in the channels of light. */
static void mix(const Exposure *e, Image *into, float a, const Image *other, float b) {
    for (size_t i = 0; i < pixels_of(into); i++) {
        float *x = into->pixels + i * (size_t)into->channels;
        const float *y = other->pixels + i * (size_t)other->channels;
        for (int c = 0; c < e->channels; c++) x[c] = a * x[c] + b * y[c];
    }
}

/* session->between becomes the mean over the middles of `count` equal intervals, in tiles that are open. */
static VtsStatus draw_between(Exposure *e, int count) {
    VtsSession *session = e->session;
    drop(&session->between);
    for (int i = 0; i < count; i++) {
        VtsStatus status = draw_moment(e, (i + 0.5) / count, count);
        if (status != VTS_OK) return status;
        if (i == 0) {
            session->between = session->picture;
            session->picture = (Image){0};
            mix(e, &session->between, 0, &session->between, 1 / (float)count);
            continue;
        }
        mix(e, &session->between, 1, &session->picture, 1 / (float)count);
        drop(&session->picture);
    }
    return VTS_OK;
}

/* ---- tiles ---- */

typedef struct Rectangle {
    int x0, y0, x1, y1; /* in the region */
} Rectangle;

static Rectangle tile_at(const Exposure *e, int tx, int ty) {
    const int *r = e->region;
    int x = (r[0] / FILM_TILE + tx) * FILM_TILE - r[0], y = (r[1] / FILM_TILE + ty) * FILM_TILE - r[1];
    return (Rectangle){int_max(x, 0), int_max(y, 0), int_min(x + FILM_TILE, r[2] - r[0]),
                       int_min(y + FILM_TILE, r[3] - r[1])};
}

/* Sum of the squares of what the two means differ by. */
static double squared_difference(const Exposure *e, Rectangle r) {
    double sum = 0;
    for (int y = r.y0; y < r.y1; y++)
        for (int x = r.x0; x < r.x1; x++) {
            const float *a = image_pixel(&e->session->blurred, x, y),
                        *b = image_pixel(&e->session->between, x, y);
            for (int c = 0; c < e->channels; c++) {
                double d = (double)float_clamp(a[c], 0, 1) - (double)float_clamp(b[c], 0, 1);
                sum += d * d;
            }
        }
    return sum;
}

/* Whether the mean of both may still be off by more than is accepted. */
static bool tile_moves(const Exposure *e, Rectangle r) {
    double accepted = e->session->compiled.max_error, sum = 0;
    for (int y = r.y0; y < r.y1; y += BLOCK)
        for (int x = r.x0; x < r.x1; x += BLOCK) {
            Rectangle block = {x, y, int_min(x + BLOCK, r.x1), int_min(y + BLOCK, r.y1)};
            double square = squared_difference(e, block) / 4;
            if (square > MOST_IN_BLOCK * MOST_IN_BLOCK * accepted * accepted * BLOCK * BLOCK * e->channels)
                return true;
            sum += square;
        }
    return sum > accepted * accepted * (r.x1 - r.x0) * (r.y1 - r.y0) * e->channels;
}

/* How far, in tiles, things may go between two moments: those that cross the part of the picture where anything moves. */
static int reach_of(const Exposure *e, int intervals) {
    Rectangle r = {e->tiles_x, e->tiles_y, -1, -1};
    for (int y = 0; y < e->tiles_y; y++)
        for (int x = 0; x < e->tiles_x; x++)
            if (e->moving[y * e->tiles_x + x])
                r = (Rectangle){int_min(r.x0, x), int_min(r.y0, y), int_max(r.x1, x), int_max(r.y1, y)};
    return r.x1 < 0 ? 0 : 1 + (int)ceil(hypot(r.x1 - r.x0, r.y1 - r.y0) / intervals);
}

static bool moves_near(const Exposure *e, int tx, int ty, int reach) {
    for (int y = int_max(ty - reach, 0); y <= int_min(ty + reach, e->tiles_y - 1); y++)
        for (int x = int_max(tx - reach, 0); x <= int_min(tx + reach, e->tiles_x - 1); x++)
            if (e->moving[y * e->tiles_x + x]) return true;
    return false;
}

/* Whether any tile stays open: one that something moves in, or may have moved through. */
static bool close_tiles(Exposure *e, int intervals) {
    int tiles = e->tiles_x * e->tiles_y, reach = reach_of(e, intervals);
    bool any = false;
    for (int i = 0; i < tiles; i++) {
        e->open[i] = e->open[i] && moves_near(e, i % e->tiles_x, i / e->tiles_x, reach);
        any |= e->open[i];
    }
    return any;
}

static void take_in(Exposure *e) {
    VtsSession *session = e->session;
    for (int i = 0; i < e->tiles_x * e->tiles_y; i++) {
        Rectangle r = tile_at(e, i % e->tiles_x, i / e->tiles_x);
        e->moving[i] = e->open[i] && tile_moves(e, r);
        for (int y = r.y0; y < r.y1 && e->open[i]; y++)
            for (int x = r.x0; x < r.x1; x++) {
                float *mean = image_pixel(&session->blurred, x, y);
                const float *between = image_pixel(&session->between, x, y);
                for (int c = 0; c < e->channels; c++) mean[c] = 0.5f * (mean[c] + between[c]);
            }
    }
}

/* ---- the whole ---- */

static VtsStatus refine(Exposure *e) {
    int most = e->exact ? intervals_of_reference(e->session->options.reference_samples) : MOST_INTERVALS;
    for (int intervals = 1; intervals < most; intervals *= 2) {
        VtsStatus status = draw_between(e, intervals);
        if (status != VTS_OK) return status;
        take_in(e);
        if (!e->exact && !close_tiles(e, 2 * intervals)) break;
    }
    return VTS_OK;
}

static VtsStatus expose_blurred(Exposure *e) {
    VtsSession *session = e->session;
    VtsStatus status = draw_moment(e, 0, 1);
    if (status != VTS_OK) return status;
    session->blurred = session->picture;
    session->picture = (Image){0};
    if ((status = draw_moment(e, 1, 1)) != VTS_OK) return status;
    mix(e, &session->blurred, 0.5f, &session->picture, 0.5f);
    drop(&session->picture);
    status = refine(e);
    drop(&session->between);
    session->picture = session->blurred;
    session->blurred = (Image){0};
    return status;
}

/* The viewer has seen the first moment. */
static void show(Exposure *e) {
    VtsSession *session = e->session;
    const Image *picture = &session->picture;
    Preview *preview = session->options.preview ? session_connect_preview(session) : NULL;
    if (!preview) return;
    preview_begin(preview, session->scene_name ? session->scene_name : "vts", picture,
                  e->tiles_x * e->tiles_y);
    for (int i = 0; i < e->tiles_x * e->tiles_y; i++) {
        Rectangle r = tile_at(e, i % e->tiles_x, i / e->tiles_x);
        preview_tile(preview, r.x0, r.y0, r.x1, r.y1);
    }
    preview_end(preview, false);
    preview_close(preview);
}

static void lay_tiles(Exposure *e) {
    const VtsOptions *o = &e->session->options;
    memcpy(e->region, o->region, sizeof e->region);
    if (e->region[2] == 0) e->region[2] = o->width, e->region[3] = o->height;
    e->tiles_x = film_tiles_x(e->region);
    e->tiles_y = film_tiles_y(e->region);
    size_t count = (size_t)e->tiles_x * (size_t)e->tiles_y;
    e->open = arena_new_array(&e->session->arena, bool, count);
    e->moving = arena_new_array(&e->session->arena, bool, count);
    memset(e->open, true, count);
}

VtsStatus session_expose(VtsSession *session, const char *scene_path, bool exact, RenderStats *stats) {
    const VtsOptions *o = &session->options;
    if (o->shutter_clock == 0 && o->shutter_time == 0)
        return session_draw(session, exact, &(MomentPlan){0}, stats);
    Exposure exposure = {.session = session,
                         .scene_path = scene_path,
                         .exact = exact,
                         .stats = stats,
                         .channels = o->alpha ? 4 : 3};
    *stats = (RenderStats){.error_estimate = -1};
    lay_tiles(&exposure);
    VtsStatus status = expose_blurred(&exposure);
    if (status == VTS_OK) show(&exposure);
    return status;
}
