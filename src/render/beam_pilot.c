/* A few blocks of pixels drawn both ways, before all others: how wrong voxels are in this picture tells where they may begin. */
#include "base/random.h"
#include "render/beam_afford.h"
#include "render/beam_choice.h"

/* So many blocks of so many pixels each way; no error is told from fewer blocks. As exact geometry they are drawn twice, at so many samples: the noises of both
 * know nothing of each other, so that the product of their differences from the voxels tells the error of these alone. */
enum { BLOCKS = 16, LEAST_BLOCKS = 4, BLOCK = 4, EXACT_SAMPLES = 64, VOXEL_SAMPLES = 16, TRIES = 400 };
/* Distances at which blocks are taken, relative to the one where voxels were planned to begin. */
static const double NEAREST_BLOCK = 0.3, FARTHEST_BLOCK = 1.5;
/* So far all of a block's samples are drawn as exact geometry, relative to where it first meets the layer, and on: what lies behind is mostly hidden, and far
 * fields would cost too much. */
static const double EXACT_REACH = 1.2, EXACT_BEYOND = 0.4;
/* How the noise of what is small beside a pixel falls with the samples. */
static const double NOISE_POWER = 0.6;
/* How far the plan may be put off, relative to it: farther costs too much. */
static const double LATEST = 1.4;
/* Nothing is better than this part of the error that is accepted. */
static const double LEAST_ERROR = 0.1;

typedef struct Block {
    int x, y;
    double distance; /* relative to the planned one */
    Radiance drawn[3][BLOCK * BLOCK]; /* as exact geometry, once more, and from voxels */
} Block;

static int choose_blocks(const CompiledScene *compiled, Block *blocks) {
    const View *view = &compiled->view;
    int count = 0;
    if (view->width < BLOCK || view->height < BLOCK) return 0;
    for (uint64_t i = 0; i < TRIES && count < BLOCKS; i++) {
        uint64_t bits = random_hash(i, 0, 0, 17);
        int x = (int)(random_unit(bits) * (view->width - BLOCK + 1)), y = (int)(random_unit(random_mix(bits)) * (view->height - BLOCK + 1));
        double distance = beam_distance_at(compiled, x + BLOCK / 2, y + BLOCK / 2);
        if (distance >= NEAREST_BLOCK && distance <= FARTHEST_BLOCK) blocks[count++] = (Block){.x = x, .y = y, .distance = distance};
    }
    return count;
}

/* Draws all blocks, as exact geometry or from voxels alone. */
static void draw_blocks(CompiledScene *compiled, bool exact, int samples, int way, Block *blocks, int count) {
    const BeamPlan plan = {.samples = {.first = samples, .most = samples}, .interrupted = compiled->options->interrupted};
    BeamTracer *tracer = beam_tracer_create(compiled, &plan, (uint64_t)way + 17, &compiled->scratch);
    for (int i = 0; i < count; i++) {
        Block *b = &blocks[i];
        ExactReach before = beam_reach_set(compiled, exact ? EXACT_REACH * b->distance + EXACT_BEYOND : 0);
        beam_tile(tracer, b->x, b->y, b->x + BLOCK, b->y + BLOCK, b->drawn[way], NULL);
        beam_reach_reset(compiled, before);
    }
}

static double difference(float a, float b) { return (double)float_clamp(a, 0, 1) - (double)float_clamp(b, 0, 1); }

/* The square of the voxels' error, up to chance; it may be negative. */
static double squared_error(const Block *b) {
    double sum = 0;
    for (int i = 0; i < BLOCK * BLOCK; i++) {
        Vec3f one = b->drawn[0][i].color, other = b->drawn[1][i].color, voxels = b->drawn[2][i].color;
        sum += difference(one.x, voxels.x) * difference(other.x, voxels.x) + difference(one.y, voxels.y) * difference(other.y, voxels.y) +
               difference(one.z, voxels.z) * difference(other.z, voxels.z);
    }
    return sum / (3 * BLOCK * BLOCK);
}

/* The error at the planned distance: it falls with the width of pixels. */
static double error_of_voxels(const Block *blocks, int count) {
    double sum = 0, weight = 0;
    for (int i = 0; i < count; i++) {
        double square = blocks[i].distance * blocks[i].distance;
        sum += squared_error(&blocks[i]);
        weight += 1 / square;
    }
    return sqrt(fmax(sum, 0) / weight);
}

/* The noise of exact geometry. */
static double noise_of(const Block *blocks, int count) {
    double sum = 0;
    for (int k = 0; k < count; k++)
        for (int i = 0; i < BLOCK * BLOCK; i++) {
            Vec3f a = blocks[k].drawn[0][i].color, b = blocks[k].drawn[1][i].color;
            double x = difference(a.x, b.x), y = difference(a.y, b.y), z = difference(a.z, b.z);
            sum += x * x + y * y + z * z;
        }
    return sqrt(sum / (2 * 3 * BLOCK * BLOCK * count));
}

static PilotResult draw_trials(CompiledScene *compiled) {
    PilotResult result = {.known = true, .factor = 1, .voxel_error = -1};
    Block *blocks = arena_new_array(&compiled->scratch, Block, BLOCKS);
    int count = choose_blocks(compiled, blocks);
    if (count < LEAST_BLOCKS) return result;
    compiled->trials = count;
    for (int way = 0; way < 3; way++) draw_blocks(compiled, way < 2, way < 2 ? EXACT_SAMPLES : VOXEL_SAMPLES, way, blocks, count);
    double error = fmax(error_of_voxels(blocks, count), LEAST_ERROR * compiled->max_error), noise = noise_of(blocks, count);
    double least_noise = noise * pow((double)EXACT_SAMPLES / compiled->most_samples, NOISE_POWER);
    double accepted = compiled->max_error * (least_noise > compiled->max_error ? 1 : VOXELS_SHARE);
    double samples = EXACT_SAMPLES * pow(noise / compiled->max_error, 1 / NOISE_POWER);
    double wanted = double_clamp(error / accepted, EARLIEST_VOXELS, LATEST);
    result.factor = beam_afford(compiled, &(BeamOffer){wanted, error, least_noise, samples});
    result.voxel_error = error / result.factor;
    return result;
}

/* ---- scenes that hardly differ ---- */

/* What was told holds while planned distances, light and its direction stay so near, relative to what they were. */
static const double SAME_DISTANCE = 1.25, SAME_LIGHT = 0.25;

static void describe(const CompiledScene *compiled, PilotResult *out) {
    const Scene *scene = compiled->scene;
    Vec3 middle = vec3_scale(vec3_add(compiled->exact_bounds.min, compiled->exact_bounds.max), 0.5);
    out->planned = compiled->all_exact_to;
    out->bright = 0, out->lamps = vec3(0, 0, 0);
    for (size_t i = 0; i < scene->light_count; i++) {
        const Light *light = &scene->lights[i];
        double bright = fabs(light->color.red) + fabs(light->color.green) + fabs(light->color.blue);
        Vec3 to = light->parallel ? light->to_light : vec3_sub(light->location, middle);
        double length = vec3_length(to);
        out->bright += bright;
        if (length > 0 && isfinite(length)) out->lamps = vec3_add(out->lamps, vec3_scale(to, bright / length));
    }
}

static bool are_alike(const PilotResult *a, const PilotResult *b) {
    return a->planned < SAME_DISTANCE * b->planned && b->planned < SAME_DISTANCE * a->planned &&
           fabs(a->bright - b->bright) <= SAME_LIGHT * b->bright && vec3_length(vec3_sub(a->lamps, b->lamps)) <= SAME_LIGHT * b->bright;
}

static PilotResult tell(CompiledScene *compiled) {
    ArenaMark mark = arena_mark(&compiled->scratch);
    PilotResult result = draw_trials(compiled);
    arena_reset_to(&compiled->scratch, mark);
    return result;
}

void beam_pilot(CompiledScene *compiled) {
    compiled->voxel_error = -1;
    if (!(compiled->all_exact_to > 0) || isinf(compiled->all_exact_to)) return;
    PilotResult *kept = compiled->options->pilot, here = {.known = false};
    describe(compiled, &here);
    if (kept && kept->known && are_alike(&here, kept)) compiled->told = kept;
    PilotResult result = compiled->told ? *compiled->told : tell(compiled);
    if (kept && !kept->known) {
        compiled->tells = kept;
        kept->planned = here.planned, kept->bright = here.bright, kept->lamps = here.lamps;
        kept->known = true, kept->factor = result.factor, kept->voxel_error = result.voxel_error;
    }
    beam_reach_set(compiled, result.factor);
    compiled->voxel_error = result.voxel_error;
    if (result.alone) beam_voxels_alone(compiled, result.voxel_error);
}
