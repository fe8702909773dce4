#include "render/beam_afford.h"

#include "base/random.h"
#include "render/beam_sight.h"

/* Seconds of one of each, measured on several forests and lawns: their ratios count. */
static const double TRIANGLE = 0.11e-6, NODE = 0.12e-6, RAY = 0.45e-6, SAMPLE = 0.055e-6, SIGHT = 0.6e-6, STEP = 1.2e-6, PIXEL = 1e-5;
/* Twice the samples see so many times as much that is shaded by itself, as a power of two: measured on a lawn seen from near and from afar, 0.59 and 0.69. */
static const double SIGHTS_POWER = 0.65;
/* How many times as long as from voxels alone a picture may take that cannot keep max_error; which counts as kept a little above it. */
static const double MOST_TIMES = 3, KEPT = 1.25;
/* Voxels begin no nearer than this, whatever geometry costs, relative to the plan: none are built for less than EARLIEST_VOXELS, which is then blurred a little. */
static const double NEAREST_AFFORDED = 0.2;
/* How what is drawn grows with the distance, between that of a thin layer and that of a deep one. */
static const double COST_POWER = 2.3;
/* Tiles are drawn so often in search of the distance, at most, and only where there are more than a few. */
enum { TRIES = 3, MOST_PROBES = 4, TILES_A_PROBE = 6, PLACES = 300 };

ExactReach beam_reach_set(CompiledScene *compiled, double factor) {
    double *to = arena_new_array(&compiled->scratch, double, compiled->skin_count);
    ExactReach before = {to, compiled->all_exact_to};
    for (size_t i = 0; i < compiled->skin_count; i++) {
        to[i] = compiled->skins[i].exact_to;
        if (compiled->skins[i].boxes) compiled->skins[i].exact_to = factor > 0 ? factor * to[i] : 0;
    }
    compiled->all_exact_to = factor > 0 ? factor * compiled->all_exact_to : 0;
    return before;
}

void beam_reach_reset(CompiledScene *compiled, ExactReach before) {
    for (size_t i = 0; i < compiled->skin_count; i++) compiled->skins[i].exact_to = before.skins[i];
    compiled->all_exact_to = before.all;
}

double beam_distance_at(const CompiledScene *compiled, int x, int y) {
    Cone cone = view_cone(&compiled->view, x + 0.5, y + 0.5, 1);
    Ray ray = {cone.origin, cone.direction};
    double nearest = VTS_INFINITY, relative = -1;
    for (size_t i = 0; i < compiled->skin_count; i++) {
        const CompiledSkin *skin = &compiled->skins[i];
        SkinPoint point;
        double t;
        if (!skin->boxes || !isfinite(skin->exact_to) || !skin_enter(skin, &ray, 0, nearest, &point, &t) || t >= nearest) continue;
        nearest = t, relative = t / skin->exact_to;
    }
    return relative >= 0 && hierarchy_occluded(compiled->hierarchy, &ray, 1e-9, 0.999 * nearest) ? -1 : relative;
}

/* The error of the picture that the offer makes. */
static double picture_error(const CompiledScene *compiled, const BeamOffer *offer) {
    const View *view = &compiled->view;
    double sum = 0;
    for (uint64_t i = 0; i < PLACES; i++) {
        uint64_t bits = random_hash(i, 0, 0, 19);
        double distance = beam_distance_at(compiled, (int)(random_unit(bits) * view->width), (int)(random_unit(random_mix(bits)) * view->height));
        double wrong = distance < 0 ? 0 : distance < offer->factor ? offer->noise : offer->error / distance;
        sum += wrong * wrong;
    }
    return sqrt(sum / PLACES);
}

typedef struct Probe {
    int x0, y0, x1, y1;
} Probe;

static int choose_probes(const View *view, Probe probes[MOST_PROBES]) {
    int columns = (view->width + BEAM_TILE - 1) / BEAM_TILE, rows = (view->height + BEAM_TILE - 1) / BEAM_TILE;
    int count = int_min(columns * rows / TILES_A_PROBE, MOST_PROBES);
    for (int i = 0; i < count; i++) { /* one of each part of the tiles, by lot */
        int tile = (int)((i + random_unit(random_hash((uint64_t)i, 0, 0, 23))) * columns * rows / count);
        int x = tile % columns * BEAM_TILE, y = tile / columns * BEAM_TILE;
        probes[i] = (Probe){x, y, int_min(x + BEAM_TILE, view->width), int_min(y + BEAM_TILE, view->height)};
    }
    return count;
}

/* What drawing the probes takes once, with few samples. */
static BeamWork probe(CompiledScene *compiled, double factor, const Probe *probes, int count) {
    const BeamPlan plan = {.samples = {.first = compiled->samples, .most = compiled->samples}, .interrupted = compiled->options->interrupted};
    ArenaMark mark = arena_mark(&compiled->scratch);
    ExactReach before = beam_reach_set(compiled, factor);
    BeamTracer *tracer = beam_tracer_create(compiled, &plan, 31, &compiled->scratch);
    Radiance *drawn = arena_new_array(&compiled->scratch, Radiance, BEAM_TILE * BEAM_TILE);
    for (int i = 0; i < count; i++) beam_tile(tracer, probes[i].x0, probes[i].y0, probes[i].x1, probes[i].y1, drawn, NULL);
    BeamWork work = beam_tracer_work(tracer);
    beam_reach_reset(compiled, before);
    arena_reset_to(&compiled->scratch, mark);
    return work;
}

/* Of as many samples: triangles and voxels are met once in each pass. */
static double seconds_of(const CompiledScene *compiled, const BeamWork *w, double samples) {
    double times = fmax(samples / compiled->samples, 1), passes = 1 + ceil(fmax(samples - compiled->samples, 0) / beam_most_in_pass(compiled));
    return passes * (TRIANGLE * (double)w->triangles + NODE * (double)w->nodes + STEP * (double)w->steps) +
           times * (RAY * (double)w->rays + SAMPLE * (double)w->samples) + pow(times, SIGHTS_POWER) * SIGHT * (double)w->sights;
}

double beam_price_in_samples(const BeamWork *before, const BeamWork *after) {
    const double fixed = TRIANGLE * (double)(after->triangles - before->triangles) + NODE * (double)(after->nodes - before->nodes);
    const double samples = (double)(after->samples - before->samples);
    const double all = SAMPLE * samples + SIGHT * (double)(after->sights - before->sights) + RAY * (double)(after->rays - before->rays);
    return samples > 0 ? fixed * samples / all : 0;
}

static double pixels_of(const Probe *probes, int count) {
    double pixels = 0;
    for (int i = 0; i < count; i++) pixels += (double)(probes[i].x1 - probes[i].x0) * (probes[i].y1 - probes[i].y0);
    return pixels;
}

/* Of voxels alone. */
static double seconds_of_voxels(const BeamWork *w, double pixels) { return STEP * (double)w->steps + PIXEL * pixels; }

double beam_voxels_error(const CompiledScene *compiled) {
    const BeamOffer drawn = {.factor = 1, .error = compiled->voxel_error};
    return compiled->voxel_error > 0 ? picture_error(compiled, &drawn) : 0;
}

double beam_seconds(CompiledScene *compiled, bool voxels, double samples) {
    Probe probes[MOST_PROBES];
    int count = choose_probes(&compiled->view, probes);
    if (count == 0) return -1;
    BeamWork work = probe(compiled, voxels ? 0 : 1, probes, count);
    double pixels = pixels_of(probes, count), all = (double)compiled->view.width * compiled->view.height;
    return all / pixels * (voxels ? seconds_of_voxels(&work, pixels) : seconds_of(compiled, &work, samples));
}

double beam_afford(CompiledScene *compiled, const BeamOffer *offer) {
    Probe probes[MOST_PROBES];
    int count = choose_probes(&compiled->view, probes);
    if (count == 0 || picture_error(compiled, offer) <= KEPT * compiled->max_error) return offer->factor;
    BeamWork alone = probe(compiled, 0, probes, count);
    double samples = double_clamp(offer->samples, compiled->samples, compiled->most_samples), factor = offer->factor;
    double most = MOST_TIMES * seconds_of_voxels(&alone, pixels_of(probes, count));
    for (int i = 0; i < TRIES && factor > NEAREST_AFFORDED; i++) {
        BeamWork work = probe(compiled, factor, probes, count);
        double seconds = seconds_of(compiled, &work, samples);
        if (!(seconds > most)) break;
        factor = fmax(NEAREST_AFFORDED, factor * fmin(pow(most / seconds, 1 / COST_POWER), 0.9));
    }
    return factor;
}
