#include "render/sampler.h"

#include "render/candidates.h"
#include "render/cell.h"
#include "render/guess.h"
#include "render/tile_sight.h"

#include <string.h>

/* A tile and the pixels around it, whose first samples tell what differs across its border. */
enum { EDGE = FILM_TILE + 2, CELLS = EDGE * EDGE };
/* Where so much of the light comes from explicit surfaces, their edges are worth samples; where less, skins hide them. */
static const float EDGE_WORTH = 1.0f / 64, ALL_EXPLICIT = 0.999f;
/* An edge of contrast C that crosses a pixel anywhere leaves an error of C/√12 in its middle's sample; of two pixels whose second
 * difference it makes C it crosses one. */
static const double STEP_TO_ERROR = 0.408;
/* Against random samples, of which n leave 1/n of the variance: what n of a straight edge leave (measured: 0.40 at 5, falling as 1/√n). */
static const double EDGE_GAIN = 0.4;
enum { FIRST_NET = 4 };
/* Samples of a net are so wide, against its mesh: wider ones, which blur what is at a pixel's border, are wrong by more than narrower ones are noisy. */
static const double SAMPLE_WIDTH = 0.7;
/* Whoever stops where errors seem to be small stops more often where they only seem so: what was found true of the sum of squares. */
static const double CAUTION = 2.4;
/* Samples at edges share the light of the middles around, of two at least, that see as smooth a part of the same surface and agree. */
static const double SAME_NORMAL = 0.98, NEAREST = 0.05, SHARED_RANGE = 4;
/* Middles are guessed where this is found to be no further off than so many times the error that is accepted, unless the guesses take
 * more than this part of it. */
static const double ALIKE = 1, GUESSES_MAY = 0.25;
/* What is known of a law by itself counts as much as so many pixels. */
static const double PRIOR = 4;
/* Contrasts are learned apart by their powers of four. */
enum { CONTRASTS = 8, LEVELS = 9 };

/* A ratio that is learned: of what came out to what was expected. */
typedef struct Learned {
    double expected, found;
    int count;
} Learned;

struct Sampler {
    const CompiledScene *compiled;
    SamplePlan plan;
    Middles *middles;                  /* or NULL */
    Middle own[FILM_TILE * FILM_TILE]; /* of the tile, where none are shared */
    Tracer tracer;
    Cell cells[CELLS];
    bool shares;  /* light is a matter of the surface alone: neither skins nor a lens */
    AovSum *aovs; /* of the tile without what is around it; NULL: not wanted */
    int x0, y0, columns, rows;
    Learned contrasts[CONTRASTS], levels[LEVELS];
    CandidateHeap heap;
    SamplerTally tally;
};

Sampler *sampler_create(const CompiledScene *compiled, const SamplePlan *plan, Arena *arena) {
    Sampler *sp = arena_new(arena, Sampler);
    sp->compiled = compiled;
    sp->plan = *plan;
    sp->shares = compiled->skin_count == 0 && !compiled->volumes && !compiled->scene->has_media &&
                 !view_has_lens(&compiled->view) && !plan->fixed;
    tracer_init(&sp->tracer, compiled, arena);
    return sp;
}

void sampler_share(Sampler *sp, Middles *middles) { sp->middles = middles; }

void sampler_count(const Sampler *sp, TraceCounters *counters, SamplerTally *tally) {
    trace_counters_add(counters, &sp->tracer.counters);
    tally->squared_error += sp->tally.squared_error;
    tally->pixels += sp->tally.pixels;
    tally->refined += sp->tally.refined;
}

static bool stopped(const Sampler *sp) { return sp->plan.interrupted && *sp->plan.interrupted; }

/* ---- one sample ---- */

/* `places`: also where on the surface, whatever it looks like. */
static bool find_surface(const CompiledScene *compiled, const Cone *cone, bool places, SurfaceHit *hit) {
    Ray ray = {cone->origin, cone->direction};
    return hierarchy_meet_wide(compiled->hierarchy, RAY_SEES, &ray, cone_width(cone), 1e-9, VTS_INFINITY,
                               places, hit);
}

/* Whether explicit surfaces look the same all over the pixel: same part, much the same direction and depth. */
static bool alike(const SurfaceHit *a, const SurfaceHit *b) {
    return a->object == b->object && vec3_dot(a->normal, b->normal) > 0.95 &&
           fabs(a->t - b->t) < 0.05 * (a->t + b->t);
}

static bool surfaces_vary(const CompiledScene *compiled, double x, double y, bool found,
                          const SurfaceHit *hit) {
    for (int corner = 0; corner < 4; corner++) {
        Cone probe = view_cone(&compiled->view, x + (corner & 1 ? 0.499 : -0.499),
                               y + (corner & 2 ? 0.499 : -0.499), 1);
        SurfaceHit other;
        bool other_found = find_surface(compiled, &probe, false, &other);
        if (other_found != found || (found && !alike(hit, &other))) return true;
    }
    return false;
}

/* The cone of a sample; false where the picture shows nothing. */
static bool view_sample(const View *view, const Draw *draw, double x, double y, double width, Cone *cone) {
    double u = 0.5, v = 0.5;
    if (view_has_lens(view)) draw_pair(draw, DRAW_LENS, &u, &v);
    return view_ray(view, x, y, u, v, width, cone);
}

/* What a pixel beside the tile sees is not wanted. */
static AovSum *aovs_of(const Sampler *sp, int px, int py) {
    int column = px - sp->x0, row = py - sp->y0;
    bool within = column >= 0 && row >= 0 && column < sp->columns && row < sp->rows;
    return sp->aovs && within ? &sp->aovs[row * sp->columns + column] : NULL;
}

/* The middles around a sample that see the same as it. */
typedef struct Shared {
    Vec3f color, least, most;
    float alpha, weight;
    int count;
} Shared;

static void share_middle(Shared *shared, const Cell *cell, double dx, double dy) {
    float weight = (float)(1 / (dx * dx + dy * dy + NEAREST));
    Vec3f light = light_shown(cell->middle.color);
    if (shared->count++ == 0) shared->least = shared->most = light;
    shared->least = vec3f(float_min(shared->least.x, light.x), float_min(shared->least.y, light.y),
                          float_min(shared->least.z, light.z));
    shared->most = vec3f(float_max(shared->most.x, light.x), float_max(shared->most.y, light.y),
                         float_max(shared->most.z, light.z));
    shared->color = vec3f_madd(shared->color, cell->middle.color, weight);
    shared->alpha += cell->middle.alpha * weight;
    shared->weight += weight;
}

/* The light of a further sample of a cell, at (x, y) of its pixel, as the middles around have it; false where they do not tell. */
static bool shared_light(const Sampler *sp, const Cell *cell, double x, double y, const SurfaceHit *hit,
                         Radiance *out) {
    uint32_t object = hit ? hit->object + 1 : 0;
    Vec3f normal = hit ? vec3f_from(hit->normal) : vec3f(0, 0, 0);
    Shared shared = {.count = 0};
    if (!sp->shares || cell->misled) return false;
    for (int row = -1; row <= 1; row++)
        for (int column = -1; column <= 1; column++) {
            const Cell *other = cell + row * EDGE + column;
            if (other->object != object || (hit && (double)vec3f_dot(other->normal, normal) < SAME_NORMAL))
                continue;
            share_middle(&shared, other, x - 0.5 - column, y - 0.5 - row);
        }
    Vec3f range = vec3f_sub(shared.most, shared.least);
    if (shared.count < 2 || (double)float_max(range.x, float_max(range.y, range.z)) > SHARED_RANGE * sp->plan.max_error)
        return false;
    *out = (Radiance){vec3f_scale(shared.color, 1 / shared.weight), shared.alpha / shared.weight};
    return true;
}

/* A sample's place on the picture and its number in the pixel. */
typedef struct Aim {
    int px, py, number;
    double x, y, width; /* in the pixel, in pixels */
    double part;        /* of the pixel that it stands for */
} Aim;

typedef struct Sighting {
    bool found;
    bool known;     /* the light is known from others */
    SurfaceHit hit; /* where something was found */
    float reaching; /* the share that explicit surfaces have */
    Radiance seen;
} Sighting;

static bool agree(const Sampler *sp, Vec3f a, Vec3f b) {
    Vec3f apart = vec3f_sub(light_shown(a), light_shown(b));
    return (double)float_max(fabsf(apart.x), float_max(fabsf(apart.y), fabsf(apart.z))) <= sp->plan.max_error;
}

/* The light as it is known from others: of a further sample of a `cell`, of a first one by a `guess`; either may be NULL. What middles say
 * may be wrong of what is thin: the first of each round of samples that could go by it is looked at all the same. */
static void see_light(Sampler *sp, const Aim *aim, Cell *cell, const Guess *guess, const Cone *cone,
                      Sighting *out) {
    const SurfaceHit *hit = out->found ? &out->hit : NULL;
    Vec3f normal = hit ? vec3f_from(hit->normal) : vec3f(0, 0, 0);
    Radiance known;
    bool shared = cell && shared_light(sp, cell, aim->x, aim->y, hit, &known);
    bool guessed = guess && guess_light(guess, hit ? hit->object + 1 : 0, normal, &known);
    out->known = guessed || (shared && cell->checked);
    if (out->known) {
        sp->tracer.counters.camera_rays++;
        out->seen = known;
        return;
    }
    out->seen = trace_cone(&sp->tracer, cone, hit, &out->reaching);
    if (!shared) return;
    cell->checked = true;
    cell->misled = !agree(sp, out->seen.color, known.color);
}

static void see(Sampler *sp, const Aim *aim, Cell *cell, const Guess *guess, Sighting *out) {
    Tracer *tracer = &sp->tracer;
    Cone cone;
    uint64_t pixel = random_hash((uint64_t)aim->px, (uint64_t)aim->py, sp->plan.seed, 0);
    tracer->draw = (Draw){pixel, (uint32_t)aim->number};
    tracer->seed = cell || aim->number ? random_mix(pixel + (uint64_t)aim->number + 1) : pixel;
    tracer->part = aim->part;
    bool ray = view_sample(&sp->compiled->view, &tracer->draw, aim->px + aim->x, aim->py + aim->y, aim->width,
                           &cone);
    AovSum *aovs = aovs_of(sp, aim->px, aim->py);
    MatterAov matter = {.share = 0};
    tracer->matter = aovs ? &matter : NULL;
    out->found = ray && find_surface(sp->compiled, &cone, aovs, &out->hit);
    out->reaching = 1;
    out->known = false;
    out->seen = (Radiance){{0, 0, 0}, 0};
    const SurfaceHit *hit = out->found ? &out->hit : NULL;
    if (ray) see_light(sp, aim, cell, guess, &cone, out);
    if (!aovs) return;
    AovSample surface = hit ? aov_of_surface(&cone, hit, out->reaching) : (AovSample){.share = 0};
    AovSample voxels = matter_sum_end(&matter, &cone);
    aov_add(aovs, &voxels, 1);
    aov_add(aovs, &surface, 1);
    aovs->samples++;
}

/* The first sample, by which it is found whether the pixel's error can be that of edges. */
static bool see_first(Sampler *sp, const Aim *aim, const Guess *guess, Middle *out) {
    Sighting s;
    see(sp, aim, NULL, guess, &s);
    out->seen = s.seen;
    out->object = s.found ? s.hit.object + 1 : 0;
    out->normal = s.found ? vec3f_from(s.hit.normal) : vec3f(0, 0, 0);
    out->refinable = view_has_lens(&sp->compiled->view) || s.reaching >= ALL_EXPLICIT ||
                     (s.reaching >= EDGE_WORTH &&
                      surfaces_vary(sp->compiled, aim->px + aim->x, aim->py + aim->y, s.found, &s.hit));
    out->calm = s.found ? s.hit.look->even && s.hit.look->plain && s.hit.share_count == 0 : sp->compiled->scene->sky_layer_count == 0;
    return s.known;
}

/* The first sample of each pixel lies in its middle: of light that changes evenly it is the mean. */
static bool see_middle(Sampler *sp, int px, int py, const Guess *guess, Middle *out) {
    out->doubt = 0;
    return see_first(sp, &(Aim){px, py, 0, 0.5, 0.5, 1, 1}, guess, out);
}

static void place_of(const Sampler *sp, int cell, int *px, int *py) {
    *px = sp->x0 + cell % EDGE - 1;
    *py = sp->y0 + cell / EDGE - 1;
}

static void add_sample(Sampler *sp, Cell *cell, const Aim *aim) {
    if (!cell->centred && cell->net == 0) {
        Middle first;
        see_first(sp, aim, NULL, &first);
        cell->refinable = first.refinable;
        cell_add(cell, &first.seen);
        return;
    }
    Sighting s;
    see(sp, aim, cell->centred ? cell : NULL, NULL, &s);
    cell_add(cell, &s.seen);
}

/* Samples of the pixel's net up to `count` of them, laid by lot. */
static void see_more(Sampler *sp, int index, int count) {
    Cell *cell = &sp->cells[index];
    int px, py, half = cell->net ? cell->net : (count + 1) / 2;
    double width = count > 1 ? SAMPLE_WIDTH / sqrt(count) : 1;
    place_of(sp, index, &px, &py);
    cell->checked = cell->net == 0;
    Draw draw = {random_hash((uint64_t)px, (uint64_t)py, sp->plan.seed, 0), 0};
    for (int k = cell->net; k < count && !stopped(sp); k++) {
        double x, y;
        draw.index = (uint32_t)k;
        draw_pair(&draw, DRAW_PIXEL, &x, &y);
        if (sp->plan.fixed == 1) x = y = 0.5;
        if (k == half) cell->late = vec3f(0, 0, 0), cell->late_count = 0;
        add_sample(sp, cell, &(Aim){px, py, k, x, y, width, 1.0 / count});
    }
    int counted = cell_count(cell);
    if (counted) cell->mean = vec3f_scale(cell_shown_sum(cell), 1 / (float)counted);
}

/* ---- errors ---- */

static int level_of(int count) {
    int level = 0;
    while (count > 2 && level < LEVELS - 1) count /= 2, level++;
    return level;
}

/* -log4, rounded down; from the number's own exponent. */
static int contrast_class(double contrast) {
    int exponent;
    if (!(contrast > 0)) return CONTRASTS - 1;
    bool power = frexp(contrast, &exponent) == 0.5;
    return exponent > 0 ? 0 : int_min((power - exponent) / 2, CONTRASTS - 1);
}

static void learn(Learned *learned, double expected, double found) {
    learned->expected += expected;
    learned->found += found;
    learned->count++;
}

static double learned_ratio(const Learned *learned, double before) {
    if (learned->count == 0 || !(learned->expected > 0)) return before;
    return (PRIOR * before + learned->count * learned->found / learned->expected) / (PRIOR + learned->count);
}

/* Of what is expected of a first sample, the part that was found where the contrast was as large, or next larger. */
static void contrast_ratios(const Sampler *sp, int classes, double ratios[CONTRASTS]) {
    for (int class = 0; class < classes; class ++)
        ratios[class] = learned_ratio(&sp->contrasts[class], class ? ratios[class - 1] : 1);
}

static void set_contrast(Cell *cell, float contrast) {
    cell->contrast = contrast;
    cell->class = contrast_class((double)contrast);
}

static double variance(const Cell *cell) {
    double n = cell_count(cell), squares = (double)cell_squares_sum(cell) / n,
           mean = (double)vec3f_dot(cell->mean, cell->mean);
    double found = fmax(squares - mean, 0) * n / (n - 1) / 3;
    /* Few samples may have missed what the neighbours show. */
    return found + (double)cell->contrast / (n * n);
}

/* By so many: of pixels with one sample, of those with more. */
static double error_of_first(const Cell *cell, double ratio) {
    return CAUTION * (double)cell->contrast * ratio + (double)cell->doubt;
}
static double error_of_many(const Sampler *sp, const Cell *cell) {
    int count = cell_count(cell);
    double ratio = learned_ratio(&sp->levels[level_of(count)], EDGE_GAIN * sqrt(5.0 / count));
    return CAUTION * variance(cell) * ratio / count;
}

static double expected_error(const Sampler *sp, const Cell *cell) {
    if (!cell->refinable) return 0;
    if (cell_count(cell) > 1) return error_of_many(sp, cell);
    double ratios[CONTRASTS];
    contrast_ratios(sp, cell->class + 1, ratios);
    return error_of_first(cell, ratios[cell->class]);
}

/* How much of a second difference, squared, counts: where light changes alike on both sides it is that of something smooth, of which the
 * middle has but a small error. */
static float step_like(Vec3f before, Vec3f after) {
    static const float SMOOTH = 0.05f;
    float most = float_max(vec3f_dot(before, before), vec3f_dot(after, after));
    return most > 0 ? float_clamp(1.4f - 2 * vec3f_dot(before, after) / most, SMOOTH, 1) : 0;
}

/* Whether all around looks exactly the same. */
static bool is_even(const Sampler *sp, int index) {
    static const int around[] = {-EDGE - 1, -EDGE, -EDGE + 1, -1, 1, EDGE - 1, EDGE, EDGE + 1};
    Vec3f here = sp->cells[index].first;
    for (int k = 0; k < 8; k++) {
        Vec3f other = sp->cells[index + around[k]].mean;
        if (other.x != here.x || other.y != here.y || other.z != here.z) return false;
    }
    return true;
}

/* The largest second difference of the middle's light with those on both sides, as a squared error. */
static float contrast_of(const Sampler *sp, int index) {
    static const int across[] = {1, EDGE, EDGE + 1, EDGE - 1};
    Vec3f here = sp->cells[index].first;
    float most = 0;
    if (is_even(sp, index)) return 0;
    for (int k = 0; k < 4; k++) {
        Vec3f after = vec3f_sub(sp->cells[index + across[k]].mean, here),
              before = vec3f_sub(here, sp->cells[index - across[k]].mean);
        float second = light_mean_square(vec3f_sub(after, before));
        if (second > most) most = float_max(most, second * step_like(before, after));
    }
    return most * (float)(STEP_TO_ERROR * STEP_TO_ERROR / 4);
}

/* ---- a tile ---- */

static int next_net(const Cell *cell) { return cell->net ? 2 * cell->net : FIRST_NET; }

static double gain_of(const Cell *cell) { return cell->error / (next_net(cell) - cell->net); }

static bool can_refine(const Sampler *sp, const Cell *cell) {
    return cell->refinable && next_net(cell) <= sp->plan.most;
}

/* Samples that the tile may have beside those in the middle. */
static int64_t most_of_tile(const Sampler *sp) {
    return (int64_t)sp->plan.most_mean * sp->columns * sp->rows;
}

/* Values every pixel of the tile anew, by what has been learned. Returns the sum of its errors. */
static double value_all(Sampler *sp) {
    double sum = 0, ratios[CONTRASTS];
    sp->heap.count = 0;
    contrast_ratios(sp, CONTRASTS, ratios);
    for (int row = 1; row <= sp->rows; row++)
        for (int column = 1; column <= sp->columns; column++) {
            Cell *cell = &sp->cells[row * EDGE + column];
            if (!cell->refinable || (cell->net == 0 && cell->contrast == 0 && cell->doubt == 0))
                cell->error = 0;
            else
                cell->error =
                    cell->net ? error_of_many(sp, cell) : error_of_first(cell, ratios[cell->class]);
            sum += cell->error;
            if (cell->error > 0 && can_refine(sp, cell))
                candidates_push(&sp->heap, row * EDGE + column, gain_of(cell));
        }
    return sum;
}

/* One pixel's next samples, and what they tell of others like it. Returns how many. */
static int refine(Sampler *sp, int index) {
    Cell *cell = &sp->cells[index];
    int before = cell->net;
    see_more(sp, index, next_net(cell));
    if (before == 0)
        learn(&sp->contrasts[cell->class], (double)cell->contrast,
              (double)light_mean_square(vec3f_sub(cell->first, cell->mean)));
    learn(&sp->levels[level_of(cell_count(cell))], variance(cell) / cell_count(cell), cell_halves_error(cell));
    return cell->net - before;
}

/* A pixel that turned out to be other than its middle may be part of something thin, which goes on beside it. */
static double look_around(Sampler *sp, int index) {
    static const int around[] = {-EDGE - 1, -EDGE, -EDGE + 1, -1, 1, EDGE - 1, EDGE, EDGE + 1};
    double change = 0;
    for (int k = 0; k < 8; k++) {
        int other = index + around[k], row = other / EDGE, column = other % EDGE;
        Cell *cell = &sp->cells[other];
        if (row < 1 || row > sp->rows || column < 1 || column > sp->columns || cell->net ||
            !cell->refinable)
            continue;
        float contrast = contrast_of(sp, other);
        if (contrast <= 1.5f * cell->contrast) continue;
        set_contrast(cell, contrast);
        change -= cell->error;
        cell->error = expected_error(sp, cell);
        change += cell->error;
        candidates_push(&sp->heap, other, gain_of(cell));
    }
    return change;
}

/* Refines where it helps most until the tile is good enough, or has had its share of samples. Returns the sum of its errors. */
static double refine_all(Sampler *sp) {
    enum { REVALUE = 64 };
    double accepted = sp->plan.max_error * sp->plan.max_error * sp->columns * sp->rows, sum = value_all(sp);
    int64_t left = most_of_tile(sp);
    for (int done = 1; sum > accepted && left > 0 && sp->heap.count && !stopped(sp); done++) {
        Candidate best = candidates_pop(&sp->heap);
        Cell *cell = &sp->cells[best.cell];
        if (best.gain != gain_of(cell) || !can_refine(sp, cell)) continue;
        left -= refine(sp, best.cell);
        double before = cell->error;
        cell->error = expected_error(sp, cell);
        sum += cell->error - before;
        sum += look_around(sp, best.cell);
        if (can_refine(sp, cell)) candidates_push(&sp->heap, best.cell, gain_of(cell));
        if (done % REVALUE == 0 || sum <= accepted) sum = value_all(sp);
    }
    return value_all(sp);
}

/* A tile whose middles are wanted. */
typedef struct SharedSight {
    Sampler *sampler;
    TileSight tile;
} SharedSight;

static VistaView view_in_tile(void *context, int x0, int y0, int x1, int y1, uint32_t object) {
    return tile_sight_view(&((const SharedSight *)context)->tile, x0, y0, x1, y1, object);
}

static bool see_of_tile(void *context, int x, int y, const Guess *guess, Middle *out) {
    const SharedSight *sight = context;
    if (!stopped(sight->sampler)) return see_middle(sight->sampler, sight->tile.x0 + x, sight->tile.y0 + y, guess, out);
    *out = (Middle){.object = 0};
    return false;
}

/* All of a tile, for whoever needs them. Whoever wants more than light looks at everything. */
static void see_shared(void *context, int tile_x, int tile_y, Middle *rows) {
    Sampler *sp = context;
    const View *view = &sp->compiled->view;
    const int x0 = tile_x * FILM_TILE, y0 = tile_y * FILM_TILE;
    const int columns = int_min(FILM_TILE, view->width - x0), row_count = int_min(FILM_TILE, view->height - y0);
    const double error = sp->shares ? sp->plan.max_error : 0;
    SharedSight shared = {.sampler = sp};
    if (sp->shares) shared.tile = tile_sight(sp->compiled, x0, y0, columns, row_count);
    else shared.tile = (TileSight){.x0 = x0, .y0 = y0};
    const GuessSight sight = {.see = see_of_tile, .view = sp->shares && !sp->aovs ? view_in_tile : NULL, .context = &shared, .tolerance = ALIKE * error, .accepted = GUESSES_MAY * error * error};
    guess_tile(&sight, columns, row_count, rows);
}

/* Those of the tile and of the tiles around; NULL where each looks for itself. First what nobody sees yet, then what others do. */
static void ask_around(Sampler *sp, const Middle *shared[9]) {
    int x = sp->x0 / FILM_TILE, y = sp->y0 / FILM_TILE;
    for (int wait = 0; wait < 2; wait++)
        for (int k = 0; k < 9; k++)
            shared[k] = middles_ask(sp->middles, x + k % 3 - 1, y + k / 3 - 1, wait, see_shared, sp);
}

/* Number of the pixel's tile among those around, of which the tile in question is the fourth; and of the pixel in it. */
static const Middle *shared_middle(const Sampler *sp, const Middle *const shared[9], int px, int py) {
    int x = px / FILM_TILE - sp->x0 / FILM_TILE + 1, y = py / FILM_TILE - sp->y0 / FILM_TILE + 1;
    const Middle *rows = shared[3 * y + x];
    return rows ? &rows[py % FILM_TILE * FILM_TILE + px % FILM_TILE] : NULL;
}

static void see_middles(Sampler *sp) {
    const View *view = &sp->compiled->view;
    const Middle *shared[9];
    ask_around(sp, shared);
    if (!shared[4]) {
        see_shared(sp, sp->x0 / FILM_TILE, sp->y0 / FILM_TILE, sp->own);
        shared[4] = sp->own;
    }
    for (int row = 0; row <= sp->rows + 1; row++)
        for (int column = 0; column <= sp->columns + 1 && !stopped(sp); column++) {
            int px = sp->x0 + column - 1, py = sp->y0 + row - 1;
            if (px < 0 || py < 0 || px >= view->width || py >= view->height) continue;
            Middle own;
            const Middle *m = shared_middle(sp, shared, px, py);
            if (!m) see_middle(sp, px, py, NULL, &own);
            cell_begin(&sp->cells[row * EDGE + column], m ? m : &own);
        }
    middles_leave(sp->middles, sp->x0 / FILM_TILE, sp->y0 / FILM_TILE);
    bool at_border = sp->x0 == 0 || sp->y0 == 0 || sp->x0 + sp->columns == view->width ||
                     sp->y0 + sp->rows == view->height;
    /* Beyond the picture's border lies what lies along it. */
    for (int row = 0; at_border && row <= sp->rows + 1; row++)
        for (int column = 0; column <= sp->columns + 1; column++) {
            int x = int_clamp(sp->x0 + column - 1, 0, view->width - 1) - sp->x0 + 1,
                y = int_clamp(sp->y0 + row - 1, 0, view->height - 1) - sp->y0 + 1;
            if (x != column || y != row) sp->cells[row * EDGE + column] = sp->cells[y * EDGE + x];
        }
    for (int row = 1; row <= sp->rows; row++)
        for (int column = 1; column <= sp->columns; column++)
            set_contrast(&sp->cells[row * EDGE + column], contrast_of(sp, row * EDGE + column));
}

static double see_fixed(Sampler *sp) {
    double sum = 0;
    for (int row = 1; row <= sp->rows; row++)
        for (int column = 1; column <= sp->columns && !stopped(sp); column++) {
            Cell *cell = &sp->cells[row * EDGE + column];
            *cell = (Cell){.net = 0};
            see_more(sp, row * EDGE + column, sp->plan.fixed);
            if (cell->net > 1)
                learn(&sp->levels[level_of(cell->net)], variance(cell) / cell->net, cell_halves_error(cell));
        }
    for (int row = 1; row <= sp->rows; row++)
        for (int column = 1; column <= sp->columns; column++) {
            const Cell *cell = &sp->cells[row * EDGE + column];
            if (cell->net > 1) sum += expected_error(sp, cell);
        }
    return sum / CAUTION; /* all have as many, whatever they seem to need */
}

void sampler_tile(Sampler *sp, int x0, int y0, int x1, int y1, Radiance *out, AovSum *aovs) {
    sp->aovs = aovs;
    sp->x0 = x0, sp->y0 = y0, sp->columns = x1 - x0, sp->rows = y1 - y0;
    memset(sp->contrasts, 0, sizeof sp->contrasts);
    memset(sp->levels, 0, sizeof sp->levels);
    if (sp->plan.fixed) {
        sp->tally.squared_error += see_fixed(sp);
    } else {
        see_middles(sp);
        sp->tally.squared_error += refine_all(sp);
    }
    sp->tally.pixels += (uint64_t)(sp->columns * sp->rows);
    for (int row = 1; row <= sp->rows; row++)
        for (int column = 1; column <= sp->columns; column++) {
            const Cell *cell = &sp->cells[row * EDGE + column];
            *out++ = cell_light(cell);
            sp->tally.refined += cell_count(cell) > 1;
        }
}
