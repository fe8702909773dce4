#include "render/sampler.h"

#include "render/candidates.h"
#include "render/cell.h"
#include "render/error_laws.h"
#include "render/guess.h"
#include "render/pixel_corners.h"
#include "render/pixel_edge.h"
#include "render/shared_light.h"
#include "render/tile_sight.h"

#include <string.h>

enum { EDGE = CONTRAST_EDGE, CELLS = CONTRAST_CELLS };
/* From a cell to the eight around it. */
static const int AROUND[] = {-EDGE - 1, -EDGE, -EDGE + 1, -1, 1, EDGE - 1, EDGE, EDGE + 1};
/* Where so much of the light comes from explicit surfaces, their edges are worth samples; where less, skins hide them. */
static const float EDGE_WORTH = 1.0f / 64, ALL_EXPLICIT = 0.999f;
enum { FIRST_NET = 4 };
/* Of an edge so many samples are taken at most, until its error is this part of what is accepted; where that is not enough a net of so many tells more. */
enum { EDGE_SAMPLES = 4, NET_AFTER_EDGE = 32 };
static const double EDGE_ENOUGH = 0.25;
/* Middles are guessed where this is found to be no further off than so many times the error that is accepted, unless the guesses take
 * more than this part of it. */
static const double ALIKE = 1, GUESSES_MAY = 0.25;
/* However much error is accepted: of more the edges of shadows would be guessed away. */
static const double ALIKE_AT_MOST = 8.0 / 255;
/* The same of skins' matter, whose light takes far longer than that of surfaces. */
static const double GUESSES_OF_MATTER_MAY = 0.5;
/* Pixels that seem to need nothing are quiet: of a tile's, one of a square of so many each way is looked at all the same, for all of these, and of those that have had samples one of so many, if there are
 * enough of them. Where things are narrower than pixels it is one of a smaller square. */
enum { PROBE_SIDE = 8, PROBE_SIDE_THIN = 2, PROBE_AGAIN = 16, ENOUGH_QUIET = 32 };
/* Pixels of less than this part of the mean error that is accepted are looked at when nothing else is left. */
static const double NO_WORTH = 0.125;

struct Sampler {
    const CompiledScene *compiled;
    SamplePlan plan;
    Middles *middles;                  /* or NULL */
    Middle own[FILM_TILE * FILM_TILE]; /* of the tile, where none are shared */
    Tracer tracer;
    Cell cells[CELLS];
    LightPlanes light; /* their means */
    bool shares;  /* light is a matter of the surface alone: neither skins nor a lens */
    bool guesses; /* middles may tell the light of others: it may be a matter of skins, too */
    AovSum *aovs; /* of the tile without what is around it; NULL: not wanted */
    int x0, y0, columns, rows;
    ErrorLaws laws;
    int probes; /* that are waiting */
    CandidateHeap heap;
    SamplerTally tally;
};

Sampler *sampler_create(const CompiledScene *compiled, const SamplePlan *plan, Arena *arena) {
    Sampler *sp = arena_new(arena, Sampler);
    sp->compiled = compiled;
    sp->plan = *plan;
    sp->guesses = !compiled->volumes && !compiled->scene->has_media && !view_has_lens(&compiled->view) && !plan->fixed;
    sp->shares = sp->guesses && compiled->skin_count == 0;
    tracer_init(&sp->tracer, compiled, arena);
    return sp;
}

bool sampler_guesses(const Sampler *sp) { return sp->guesses && sp->plan.max_error > 0; }
void sampler_share(Sampler *sp, Middles *middles) { sp->middles = middles; }

void sampler_count(const Sampler *sp, TraceCounters *counters, SamplerTally *tally) {
    trace_counters_add(counters, &sp->tracer.counters);
    tally->squared_error += sp->tally.squared_error;
    tally->pixels += sp->tally.pixels;
    tally->refined += sp->tally.refined;
}

static bool stopped(const Sampler *sp) { return sp->plan.interrupted && *sp->plan.interrupted; }

/* ---- one sample ---- */

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
    SurfaceTint tint;
    float reaching; /* the share that explicit surfaces have */
    Radiance seen;
} Sighting;

static bool agree(const Sampler *sp, Vec3f a, Vec3f b) {
    Vec3f apart = vec3f_sub(light_shown(a), light_shown(b));
    return (double)float_max(fabsf(apart.x), float_max(fabsf(apart.y), fabsf(apart.z))) <= sp->plan.max_error;
}

static bool guessed_light(const Guess *guess, const Cone *cone, Sighting *s, Radiance *out) {
    Middle here = {.object = s->found ? s->hit.object + 1 : 0, .tint.texture = NULL};
    if (s->found) here.normal = vec3f_from(s->hit.normal);
    if (guess->even) here.tint = guess->corners[0]->tint;
    else if (s->found && guess->corners[0]->tint.texture) surface_tint(cone, &s->hit, &here.tint);
    if (!guess_light(guess, &here)) return false;
    *out = here.seen;
    s->tint = here.tint;
    return true;
}

/* The light as it is known from others: of a further sample of a `cell`, of a first one by a `guess`; either may be NULL. What middles say
 * may be wrong of what is thin: the first of each round of samples that could go by it is looked at all the same. */
static void see_light(Sampler *sp, const Aim *aim, Cell *cell, const Guess *guess, const Cone *cone,
                      Sighting *out) {
    const SurfaceHit *hit = out->found ? &out->hit : NULL;
    Radiance known;
    bool shared = cell && sp->shares && !cell->misled && shared_light(cell, &(SharedPlace){aim->x, aim->y, cone, hit}, sp->plan.max_error, &known);
    out->known = (guess && guessed_light(guess, cone, out, &known)) || (shared && cell->checked);
    if (out->known) {
        sp->tracer.counters.camera_rays++;
        out->seen = known;
        return;
    }
    out->tint.texture = NULL;
    sp->tracer.tint = sp->shares && hit ? &out->tint : NULL;
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
    out->found = ray && pixel_surface(sp->compiled, &cone, aovs, &out->hit);
    out->reaching = 1;
    out->known = false;
    out->tint.texture = NULL;
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
    out->tint = s.tint;
    out->object = s.found ? s.hit.object + 1 : 0;
    out->normal = s.found ? vec3f_from(s.hit.normal) : vec3f(0, 0, 0);
    if (s.known && !sp->shares) { /* it is what the corners are */
        out->calm = true;
        out->refinable = false;
        for (int k = 0; k < 4; k++) out->refinable |= guess->corners[k]->refinable;
        out->hidden = guess->corners[0]->hidden;
        return true;
    }
    const double x = aim->px + aim->x, y = aim->py + aim->y;
    const SurfaceHit *hit = s.found ? &s.hit : NULL;
    out->refinable = view_has_lens(&sp->compiled->view) || s.reaching >= ALL_EXPLICIT || pixel_is_wide(sp->compiled, x, y, hit) ||
                     (s.reaching >= EDGE_WORTH && pixel_surfaces_vary(sp->compiled, x, y, hit));
    const bool matter = s.reaching < ALL_EXPLICIT;
    out->calm = s.found ? s.hit.look->even && s.hit.look->plain && s.hit.share_count == 0 : sp->compiled->scene->sky_layer_count == 0;
    out->calm |= matter;
    out->single = !sp->shares && !matter;
    out->hidden = 1 - s.reaching;
    return s.known;
}

/* The first sample of each pixel lies in its middle: of light that changes evenly it is the mean. */
static bool see_middle(Sampler *sp, int px, int py, const Guess *guess, Middle *out) {
    out->doubt = 0;
    out->single = false;
    return see_first(sp, &(Aim){px, py, 0, 0.5, 0.5, 1, 1}, guess, out);
}

static void set_mean(Sampler *sp, int index, Vec3f mean) {
    sp->cells[index].mean = mean;
    for (int c = 0; c < 3; c++) sp->light.channels[c][index] = c == 0 ? mean.x : c == 1 ? mean.y : mean.z;
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
    double width = sample_width(count);
    place_of(sp, index, &px, &py);
    cell->checked = cell->net == 0;
    cell->edged = cell->traced = false;
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
    if (counted) set_mean(sp, index, vec3f_scale(cell_shown_sum(cell), 1 / (float)counted));
}

/* ---- errors ---- */

static void set_contrast(const Sampler *sp, Cell *cell, float contrast) {
    cell->contrast = contrast;
    cell->class = contrast_class(contrast);
    if (error_counts(&sp->laws, contrast) && sp->shares && shared_but_pattern(cell, sp->plan.max_error)) cell->class += ERROR_OF_PATTERNS;
}

/* ---- edges ---- */

static void set_edge(Cell *cell, const PixelEdge *edge) {
    cell->edge = pixel_edge_light(edge);
    cell->edge_error = pixel_edge_error(edge);
    cell->mean = light_shown(cell->edge.color);
    cell->edged = isfinite(cell->edge.color.x) && isfinite(cell->edge.color.y) && isfinite(cell->edge.color.z);
}

/* Where the middles show one, and it makes a difference. */
static void find_edge(const Sampler *sp, Cell *cell) {
    PixelEdge edge;
    if (!sp->shares || sp->aovs || !cell->refinable || cell->class >= ERROR_OF_PATTERNS || !error_counts(&sp->laws, cell->contrast)) return;
    if (pixel_edge_begin(cell, &edge)) set_edge(cell, &edge);
    if (!cell->edged) cell->mean = cell->first;
}

/* Samples along the pixel's edge; returns how many. It is none after all if they say so. */
static int trace_edge(Sampler *sp, int index) {
    Cell *cell = &sp->cells[index];
    PixelEdge edge;
    int px, py, taken = 0;
    bool holds = pixel_edge_begin(cell, &edge);
    place_of(sp, index, &px, &py);
    cell->checked = true;
    while (holds && taken < EDGE_SAMPLES && !stopped(sp) &&
           (taken == 0 || (double)pixel_edge_error(&edge) > EDGE_ENOUGH * sp->laws.accepted)) {
        float x, y;
        Sighting s;
        edge_place(&edge.fit, taken++, &x, &y);
        see(sp, &(Aim){px, py, taken, 0.5 + (double)x, 0.5 + (double)y, sample_width(FIRST_NET), 1.0 / FIRST_NET}, cell, NULL, &s);
        holds = pixel_edge_add(&edge, x, y, &s.seen);
    }
    cell->edged = false;
    if (holds) set_edge(cell, &edge);
    cell->traced = cell->edged;
    if (cell->edged) set_mean(sp, index, cell->mean);
    return taken;
}

/* ---- a tile ---- */

static int next_net(const Cell *cell) { return cell->traced ? NET_AFTER_EDGE : cell->net ? 2 * cell->net : FIRST_NET; }

static double gain_of(const Cell *cell) { return cell->probe ? VTS_INFINITY : cell->error / (next_net(cell) - cell->net); }

static bool can_refine(const Sampler *sp, const Cell *cell) {
    return cell->refinable && next_net(cell) <= sp->plan.most;
}

/* Samples that the tile may have beside those in the middle. */
static int64_t most_of_tile(const Sampler *sp) {
    return (int64_t)sp->plan.most_mean * sp->columns * sp->rows;
}

static void ask_probe(Sampler *sp, Cell *cell) {
    if (cell->probe || !can_refine(sp, cell)) return;
    cell->probe = true;
    sp->probes++;
}

/* One pixel of each square, whatever it seems to need. */
static void probe_middles(Sampler *sp) {
    const bool thin = tile_sight_thin(sp->compiled, sp->x0, sp->y0, sp->columns, sp->rows);
    const int side = thin ? PROBE_SIDE_THIN : PROBE_SIDE;
    for (int y = 0; y < sp->rows; y += side)
        for (int x = 0; x < sp->columns; x += side) {
            uint64_t bits = random_hash((uint64_t)(sp->x0 + x), (uint64_t)(sp->y0 + y), sp->plan.seed, 53);
            int row = y + (int)(random_unit(bits) * side), column = x + (int)(random_unit(random_mix(bits)) * side);
            if (row < sp->rows && column < sp->columns) ask_probe(sp, &sp->cells[(row + 1) * EDGE + column + 1]);
        }
}

/* Of enough quiet pixels that have had as many samples, some by lot. */
static void probe_net(Sampler *sp, int index) {
    const Cell *cell = &sp->cells[index];
    uint64_t lot = random_hash((uint64_t)(sp->x0 + index % EDGE), (uint64_t)(sp->y0 + index / EDGE), (uint64_t)cell->net, 59);
    if (lot % PROBE_AGAIN == 0) ask_probe(sp, &sp->cells[index]);
}

static void probe_nets(Sampler *sp) {
    int nets[FILM_TILE * FILM_TILE], count = 0, quiet[QUIET_CLASSES] = {0};
    for (int row = 1; row <= sp->rows; row++)
        for (int column = 1; column <= sp->columns; column++) {
            const Cell *cell = &sp->cells[row * EDGE + column];
            if (cell->net == 0 || !error_net_is_quiet(&sp->laws, cell)) continue;
            nets[count++] = row * EDGE + column;
            quiet[error_quiet_class(cell)]++;
        }
    for (int i = 0; i < count; i++)
        if (quiet[error_quiet_class(&sp->cells[nets[i]])] >= ENOUGH_QUIET) probe_net(sp, nets[i]);
}

/* Values every pixel of the tile anew, by what has been learned; those that gain less than `least` are no candidates. Returns the sum of
 * the errors. */
static double value_all(Sampler *sp, double least) {
    double sum = 0;
    sp->heap.count = 0;
    probe_nets(sp);
    for (int row = 1; row <= sp->rows; row++)
        for (int column = 1; column <= sp->columns; column++) {
            Cell *cell = &sp->cells[row * EDGE + column];
            cell->error = error_expected(&sp->laws, cell);
            sum += cell->error;
            if ((cell->error > 0 || cell->probe) && gain_of(cell) >= least && can_refine(sp, cell)) candidates_push(&sp->heap, row * EDGE + column, gain_of(cell));
        }
    return sum;
}

/* One pixel's next samples, and what they tell of others like it. Returns how many. */
static int refine(Sampler *sp, int index) {
    Cell *cell = &sp->cells[index];
    const Cell before = *cell;
    int taken = cell->edged && !cell->traced && !cell->probe ? trace_edge(sp, index) : 0;
    if (!cell->traced || before.traced) see_more(sp, index, next_net(cell));
    sp->probes -= cell->probe;
    cell->probe = false;
    error_learn(&sp->laws, &before, cell);
    return taken + cell->net - before.net;
}

/* Whether what pixels beside it see is another contrast by now, one that counts (contrasts are squares: half as much again takes 0.22 of
 * a difference, and one that counts is 2.2 times the error that is accepted). */
static bool turned_out(const Sampler *sp, const Cell *cell, Vec3f before) {
    Vec3f off = vec3f_sub(cell->mean, before);
    return (double)vec3f_dot(off, off) > 0.16 * sp->plan.max_error * sp->plan.max_error;
}

/* A pixel that turned out to be other than its middle may be part of something thin, which goes on beside it. */
static double look_around(Sampler *sp, int index) {
    double change = 0;
    for (int k = 0; k < 8; k++) {
        int other = index + AROUND[k], row = other / EDGE, column = other % EDGE;
        Cell *cell = &sp->cells[other];
        if (row < 1 || row > sp->rows || column < 1 || column > sp->columns || cell->net || cell->traced ||
            !cell->refinable)
            continue;
        float contrast = contrast_at(&sp->light, other);
        if (contrast <= 1.5f * cell->contrast) continue;
        set_contrast(sp, cell, contrast);
        cell->edged = false;
        cell->mean = cell->first;
        change -= cell->error;
        cell->error = error_expected(&sp->laws, cell);
        change += cell->error;
        candidates_push(&sp->heap, other, gain_of(cell));
    }
    return change;
}

/* The next to be refined; false when none is left. Those of small gain are looked for when there are no others. */
static bool next_candidate(Sampler *sp, double *least, double *sum, Candidate *out) {
    if (sp->heap.count == 0 && *least > 0) {
        *least = 0;
        *sum = value_all(sp, 0);
    }
    if (sp->heap.count == 0) return false;
    *out = candidates_pop(&sp->heap);
    return true;
}

/* Refines where it helps most until the tile is good enough, or has had its share of samples. Returns the sum of its errors. */
static double refine_all(Sampler *sp) {
    enum { REVALUE = 64 };
    const double mean = sp->plan.max_error * sp->plan.max_error, accepted = mean * sp->columns * sp->rows;
    probe_middles(sp);
    double least = NO_WORTH * mean / FIRST_NET, sum = value_all(sp, least);
    int64_t left = most_of_tile(sp);
    Candidate best;
    bool valued = true; /* since the last samples */
    for (int done = 1; (sum > accepted || sp->probes) && left > 0 && !stopped(sp) && next_candidate(sp, &least, &sum, &best); done++) {
        Cell *cell = &sp->cells[best.cell];
        if (best.gain != gain_of(cell) || !can_refine(sp, cell)) continue;
        const Vec3f mean_before = cell->mean;
        left -= refine(sp, best.cell);
        valued = false;
        double before = cell->error;
        cell->error = error_expected(&sp->laws, cell);
        sum += cell->error - before;
        if (turned_out(sp, cell, mean_before)) sum += look_around(sp, best.cell);
        if (can_refine(sp, cell)) candidates_push(&sp->heap, best.cell, gain_of(cell));
        if (done % REVALUE && (sum > accepted || sp->probes)) continue;
        sum = value_all(sp, least);
        valued = true;
    }
    if (!valued) sum = value_all(sp, least);
    return left > 0 ? sum : error_of_stopped(sum);
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

static bool even_in_tile(void *context, int x, int y, double width, const Middle *middle) {
    const SharedSight *sight = context;
    const CompiledScene *compiled = sight->sampler->compiled;
    Cone cone = view_cone(&compiled->view, sight->tile.x0 + x + 0.5, sight->tile.y0 + y + 0.5, width);
    SurfaceHit hit;
    SurfaceTint tint;
    if (!pixel_surface(compiled, &cone, false, &hit)) return false;
    surface_tint(&cone, &hit, &tint);
    const Vec3f a = tint.color, b = middle->tint.color;
    return tint.texture == middle->tint.texture && a.x == b.x && a.y == b.y && a.z == b.z;
}

/* All of a tile, for whoever needs them. Whoever wants more than light looks at everything. */
static void see_shared(void *context, int tile_x, int tile_y, Middle *rows) {
    Sampler *sp = context;
    const View *view = &sp->compiled->view;
    const int x0 = tile_x * FILM_TILE, y0 = tile_y * FILM_TILE;
    const int columns = int_min(FILM_TILE, view->width - x0), row_count = int_min(FILM_TILE, view->height - y0);
    const double error = sp->shares || (sp->guesses && !sp->aovs) ? sp->plan.max_error : 0, may = sp->shares ? GUESSES_MAY : GUESSES_OF_MATTER_MAY;
    SharedSight shared = {.sampler = sp};
    if (sp->shares) shared.tile = tile_sight(sp->compiled, x0, y0, columns, row_count);
    else shared.tile = (TileSight){.x0 = x0, .y0 = y0};
    const GuessSight sight = {.see = see_of_tile, .view = sp->shares && !sp->aovs ? view_in_tile : NULL, .even = even_in_tile, .context = &shared, .tolerance = fmin(ALIKE * error, ALIKE_AT_MOST), .accepted = may * error * error};
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

/* Whether the explicit surface of a pixel ends between its middle and those around. */
static bool ends_near(const Sampler *sp, int index) {
    const Cell *cell = &sp->cells[index];
    for (int k = 0; k < 8; k++)
        if (sp->cells[index + AROUND[k]].object != cell->object) return true;
    return false;
}

/* A skin ends where its surface does: its cone, which is opaque where it meets the surface, tells nothing of what is beside the border. */
static void find_ends_of_skins(Sampler *sp) {
    for (int row = 1; row <= sp->rows; row++)
        for (int column = 1; column <= sp->columns; column++) {
            Cell *cell = &sp->cells[row * EDGE + column];
            cell->refinable = cell->refinable || ends_near(sp, row * EDGE + column);
        }
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
            set_mean(sp, row * EDGE + column, sp->cells[row * EDGE + column].first);
        }
    middles_leave(sp->middles, sp->x0 / FILM_TILE, sp->y0 / FILM_TILE);
    bool at_border = sp->x0 == 0 || sp->y0 == 0 || sp->x0 + sp->columns == view->width ||
                     sp->y0 + sp->rows == view->height;
    /* Beyond the picture's border lies what lies along it. */
    for (int row = 0; at_border && row <= sp->rows + 1; row++)
        for (int column = 0; column <= sp->columns + 1; column++) {
            int x = int_clamp(sp->x0 + column - 1, 0, view->width - 1) - sp->x0 + 1,
                y = int_clamp(sp->y0 + row - 1, 0, view->height - 1) - sp->y0 + 1;
            if (x == column && y == row) continue;
            sp->cells[row * EDGE + column] = sp->cells[y * EDGE + x];
            set_mean(sp, row * EDGE + column, sp->cells[y * EDGE + x].first);
        }
    if (sp->compiled->skin_count) find_ends_of_skins(sp);
    for (int row = 1; row <= sp->rows; row++) {
        float contrasts[FILM_TILE];
        contrast_row(&sp->light, row * EDGE + 1, sp->columns, contrasts);
        for (int i = 0; i < sp->columns; i++) {
            set_contrast(sp, &sp->cells[row * EDGE + 1 + i], contrasts[i]);
            find_edge(sp, &sp->cells[row * EDGE + 1 + i]);
        }
    }
}

static double see_fixed(Sampler *sp) {
    double sum = 0;
    for (int row = 1; row <= sp->rows; row++)
        for (int column = 1; column <= sp->columns && !stopped(sp); column++) {
            Cell *cell = &sp->cells[row * EDGE + column];
            *cell = (Cell){.net = 0};
            see_more(sp, row * EDGE + column, sp->plan.fixed);
            if (cell->net > 1) error_learn(&sp->laws, &(Cell){.net = 0}, cell);
        }
    for (int row = 1; row <= sp->rows; row++)
        for (int column = 1; column <= sp->columns; column++) {
            const Cell *cell = &sp->cells[row * EDGE + column];
            if (cell->net > 1) sum += error_expected(&sp->laws, cell);
        }
    return error_of_all(sum);
}

void sampler_tile(Sampler *sp, int x0, int y0, int x1, int y1, Radiance *out, AovSum *aovs) {
    sp->aovs = aovs;
    sp->x0 = x0, sp->y0 = y0, sp->columns = x1 - x0, sp->rows = y1 - y0;
    error_laws_begin(&sp->laws, sp->plan.max_error * sp->plan.max_error);
    sp->probes = 0;
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
            sp->tally.refined += cell->traced || cell_count(cell) > 1;
        }
}
