#include "render/audit.h"

#include "base/gamma.h"
#include "base/random.h"
#include "render/exact_memo.h"
#include "render/exact_skin.h"
#include "render/reference.h"
#include "render/volume_set.h"

/* Places looked at, one in each of as many equal parts of the picture; so many of them are seen twice: most where skins and volumes are. */
enum { PLACES_A_SIDE = 24, PLACES = PLACES_A_SIDE * PLACES_A_SIDE, MOST_WITHIN = 96, MOST_BESIDE = 32 };
/* Of the picture's work, the part that rays may take, and how many that is of each pixel. */
static const double SHARE = 0.1;
enum { LEAST_RAYS = 8, LEAST_PATHS = 96, MOST_RAYS = 128 }; /* paths of light through volumes are noisy, and their light pass took more than rays tell */
/* Work in rays of the reference, each of which asks for light about once. */
static const double STEPS_A_RAY = 6, TRIANGLES_A_RAY = 60;
/* Triangles are as near to what is round as beams have them: a tenth of a pixel. */
static const double TOLERANCE_VOXELS = 0.2;
enum { COARSEST = 16, FLAKES = 60000, MOST_TRIANGLES = 3000000 };
/* What lies within chance counts less and less: at so many standard errors as much as what was thought before. */
static const double DOUBTFUL = 2;
/* Above so many, what was thought before was too much; but so much of its square is left. More with volumes: the few of their paths that are bright tell most, and are mostly missed. */
static const double MOST_LUCK = 1.5, LEAST_LEFT = 0.05, LEAST_LEFT_OF_PATHS = 0.25;
enum { ENOUGH = 16 };

typedef struct Place {
    int x, y; /* of the whole picture */
    double squared; /* of the error there, on the mean; may be negative */
} Place;

typedef struct Audit {
    const CompiledScene *truth;
    RenderOptions options; /* of the rays */
    const Image *picture;
    double gamma, gain;
    Place *places;
    TraceCounters *counters; /* one for each worker */
} Audit;

/* ---- the truth ---- */

static bool make_texels(CompiledScene *compiled, DiagList *unheard) {
    size_t triangles = 0;
    struct ExactMemo *memo = compiled->options->exact_memo;
    exact_memo_begin(memo);
    for (size_t i = 0; i < compiled->texel_count; i++) {
        BuiltTexel *texel = compiled->texels[i];
        if (texel->def->file || texel->triangles_known > MOST_TRIANGLES) return false;
        ExactMaking making = {.tolerance = TOLERANCE_VOXELS / int_max(texel->finest_seen, COARSEST), .flakes = FLAKES, .most = MOST_TRIANGLES - triangles};
        if (!exact_memo_build(memo, texel, &making, compiled, unheard)) return false;
        triangles += exact_texel_triangles(texel->exact);
    }
    return true;
}

static void forget_texels(CompiledScene *compiled) {
    for (size_t i = 0; i < compiled->texel_count; i++) compiled->texels[i]->exact = NULL;
}

/* The scene as the reference has it, but for what is round; all memory is the arena's, but for the skins' hierarchy. */
static bool make_truth(CompiledScene *compiled, CompiledScene *truth) {
    DiagList unheard = {0};
    diag_init(&unheard, compiled->arena, NULL);
    *truth = *compiled;
    truth->exact_paths = true;
    if (compiled->volumes) {
        truth->volumes = arena_new(compiled->arena, VolumeSet);
        *truth->volumes = *compiled->volumes;
        truth->volumes->method = VOLUME_PATH;
    }
    if (compiled->skin_count == 0) return true;
    if (!make_texels(compiled, &unheard)) return false;
    truth->exact = exact_skins_build(compiled->skins, compiled->skin_count, hierarchy_embree(compiled->hierarchy));
    return truth->exact != NULL;
}

/* ---- places ---- */

/* Whether the line through the pixel's middle meets a layer before anything else; volumes may be anywhere. */
static bool meets_skins(const CompiledScene *compiled, int x, int y) {
    Cone cone;
    if (!view_ray(&compiled->view, x + 0.5, y + 0.5, 0.5, 0.5, 1, &cone)) return false;
    Ray ray = {cone.origin, cone.direction};
    double nearest = VTS_INFINITY;
    for (size_t i = 0; i < compiled->skin_count; i++) {
        double near = 0, far = nearest, t;
        SkinPoint point;
        if (!box3_clip_ray(compiled->skins[i].bounds, &ray, &near, &far)) continue;
        if (!compiled->skins[i].tree && !compiled->skins[i].box) nearest = fmin(nearest, fmax(near, 0));
        else if (skin_enter(&compiled->skins[i], &ray, 0, nearest, &point, &t)) nearest = fmin(nearest, t);
    }
    return nearest < VTS_INFINITY && !hierarchy_occluded(compiled->hierarchy, &ray, 1e-9, 0.999 * nearest);
}

static Place place_in(const int region[4], int number) {
    uint64_t bits = random_hash((uint64_t)number, 0, 0, 29);
    double u = (number % PLACES_A_SIDE + random_unit(bits)) / PLACES_A_SIDE, v = ((double)(number / PLACES_A_SIDE) + random_unit(random_mix(bits))) / PLACES_A_SIDE;
    int width = region[2] - region[0], height = region[3] - region[1];
    return (Place){region[0] + int_min((int)(u * width), width - 1), region[1] + int_min((int)(v * height), height - 1), 0};
}

/* Those of one kind, evenly thinned out to `most`. */
static int choose(Audit *audit, const Place *all, const bool *within, bool wanted, int kind, int most) {
    int chosen = int_min(kind, most), seen = 0, count = 0;
    for (int i = 0; i < PLACES && count < chosen; i++) {
        if (within[i] != wanted) continue;
        if ((int64_t)seen++ * chosen / kind == count) audit->places[count++] = all[i];
    }
    return count;
}

/* ---- errors ---- */

static double clamped(float value) { return (double)float_clamp(value, 0, 1); }

static Vec3f exposed(const Audit *audit, Vec3f seen) {
    if (audit->gamma != 1)
        seen = vec3f((float)gamma_to_light((double)seen.x, audit->gamma), (float)gamma_to_light((double)seen.y, audit->gamma),
                     (float)gamma_to_light((double)seen.z, audit->gamma));
    return vec3f_scale(seen, (float)audit->gain);
}

static void see_place(void *context, size_t index, int worker) {
    Audit *audit = context;
    Place *place = &audit->places[index];
    const float *drawn = image_pixel(audit->picture, place->x - audit->options.region[0], place->y - audit->options.region[1]);
    Vec3f seen[2];
    for (uint64_t k = 0; k < 2; k++) {
        RenderOptions options = audit->options;
        options.seed = random_mix(audit->options.seed + 41 * (k + 1));
        seen[k] = exposed(audit, reference_pixel(audit->truth, &options, place->x, place->y, &audit->counters[worker]).color);
    }
    float one[3] = {seen[0].x, seen[0].y, seen[0].z}, other[3] = {seen[1].x, seen[1].y, seen[1].z};
    for (int c = 0; c < 3; c++)
        place->squared += (clamped(drawn[c]) - clamped(one[c])) * (clamped(drawn[c]) - clamped(other[c])) / 3;
}

/* What to take for the mean square of the error: what places tell, as far as they can, and what was thought before (negative: nothing). */
static double settle(const Place *places, int count, double before, double least_left) {
    double sum = 0, squares = 0;
    for (int i = 0; i < count; i++) sum += places[i].squared, squares += places[i].squared * places[i].squared;
    if (count < 2) return fmax(before, 0);
    double mean = sum / count, variance = fmax(squares / count - mean * mean, 0) / (count - 1), chance = DOUBTFUL * DOUBTFUL * variance;
    if (before < 0) return fmax(mean, 0.5 * sqrt(variance));
    double square = mean > 0 ? mean * mean : 0, weight = square * square / (square * square + chance * chance);
    double settled = weight > 0 ? weight * mean + (1 - weight) * before : before;
    return count < ENOUGH ? settled : fmin(settled, fmax(mean + MOST_LUCK * sqrt(variance), least_left * before));
}

/* The same of pictures whose samples tell their noise: few places hit upon the edges that make most of it, so that they count only for what is wrong nearly everywhere. */
static double settle_bias(const Place *places, int count, double before) {
    double sum = 0, squares = 0;
    for (int i = 0; i < count; i++) sum += places[i].squared, squares += places[i].squared * places[i].squared;
    if (count < ENOUGH) return before;
    double mean = sum / count, variance = fmax(squares / count - mean * mean, 0) / (count - 1);
    return fmax(before, mean - DOUBTFUL * sqrt(variance));
}

static bool samples_tell(const CompiledScene *compiled) { return compiled->skin_count == 0 && !compiled->volumes && !compiled->scene->has_media; }

static double settled_of(const CompiledScene *compiled, const Place *places, int count, double before) {
    if (samples_tell(compiled)) return settle_bias(places, count, before);
    return settle(places, count, before, compiled->volumes ? LEAST_LEFT_OF_PATHS : LEAST_LEFT);
}

static int rays_a_pixel(const TraceCounters *c, bool paths, int pixels) {
    double work = (double)c->camera_rays + (double)c->shadow_rays + (double)c->steps / STEPS_A_RAY + (double)c->triangles / TRIANGLES_A_RAY;
    return (int)double_clamp(SHARE * work / (4 * int_max(pixels, 1)), paths ? LEAST_PATHS : LEAST_RAYS, MOST_RAYS);
}

/* ---- the whole ---- */

/* Where the picture's pixels see skins or volumes, and where they do not: two kinds, since what is thought of their errors beforehand is not worth the same. */
static void look(Audit *audit, const CompiledScene *compiled, Pool *pool, RenderStats *stats) {
    Place *all = arena_new_array(compiled->arena, Place, PLACES);
    bool *within = arena_new_array(compiled->arena, bool, PLACES);
    int inside = 0;
    for (int i = 0; i < PLACES; i++) {
        all[i] = place_in(audit->options.region, i);
        inside += within[i] = compiled->skin_count == 0 || meets_skins(compiled, all[i].x, all[i].y);
    }
    audit->options.samples = rays_a_pixel(&stats->counters, compiled->volumes, int_min(inside, MOST_WITHIN) + int_min(PLACES - inside, MOST_BESIDE));
    double noise = stats->noise_estimate * stats->noise_estimate, known = stats->error_estimate, total = 0;
    if (compiled->volumes && compiled->volume_rays > 0 && known >= 0) known = hypot(known, compiled->volume_error); /* samples of a pixel share what bins have */
    for (int kind = 0; kind < 2; kind++) {
        int of_kind = kind ? PLACES - inside : inside, count = choose(audit, all, within, !kind, of_kind, kind ? MOST_BESIDE : MOST_WITHIN);
        double before = kind ? noise : known < 0 ? -1 : known * known;
        if (!pool_run(pool, (size_t)count, see_place, audit)) return;
        total += settled_of(compiled, audit->places, count, before) * of_kind / PLACES;
    }
    stats->error_estimate = sqrt(total);
}

static bool is_interrupted(const RenderOptions *options) { return options->interrupted && *options->interrupted; }

void audit_picture(CompiledScene *compiled, const CompileOptions *how, const RenderOptions *options, const Image *picture, RenderStats *stats) {
    const MemoryBudget *memory = how->memory;
    if (memory && memory->limit && memory->used > memory->limit / 2) return;
    ArenaMark mark = arena_mark(compiled->arena);
    CompiledScene truth = {0};
    compiled->options = how;
    Audit audit = {.truth = &truth, .options = *options, .picture = picture, .gamma = compiled->scene->settings.assumed_gamma, .gain = exp2(options->exposure)};
    audit.places = arena_new_array(compiled->arena, Place, MOST_WITHIN + MOST_BESIDE);
    audit.counters = arena_new_array(compiled->arena, TraceCounters, (size_t)pool_threads(how->pool));
    RenderStats told = *stats;
    if (make_truth(compiled, &truth)) look(&audit, compiled, how->pool, &told);
    if (!is_interrupted(options)) *stats = told;
    exact_skins_destroy(truth.exact);
    forget_texels(compiled);
    compiled->options = NULL;
    arena_reset_to(compiled->arena, mark);
}
