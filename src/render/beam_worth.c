#include "render/beam_worth.h"

#include "base/random.h"

/* One block for so many pixels of the picture, each in a cell of a lattice over it. */
enum { LEAST_BLOCKS = 6, PIXELS_A_BLOCK = 1200, SAMPLES = 16 };
/* Of max_error, what samples may make: the rest is what voxels are wrong by, and what else nobody has thought of. */
static const double NOISE_SHARE = 0.75;
/* So many times the samples that pixels may have on the mean those may have that are hardest. */
enum { HARDEST = 4 };

static int lattice(double cells, double part) { return int_max((int)round(sqrt(cells * part)), 1); }

void beam_blocks_draw(CompiledScene *compiled, uint64_t seed, BeamBlocks *out) {
    enum { BLOCK = BEAM_BLOCK };
    const View *view = &compiled->view;
    const BeamPlan plan = {.samples = {.first = SAMPLES, .most = SAMPLES}, .interrupted = compiled->options->interrupted};
    BeamTracer *tracer = beam_tracer_create(compiled, &plan, seed, &compiled->scratch);
    double blocks = double_clamp((double)view->width * view->height / PIXELS_A_BLOCK, LEAST_BLOCKS, 0.8 * BEAM_MOST_BLOCKS);
    int columns = lattice(blocks, (double)view->width / view->height), rows = lattice(blocks, (double)view->height / view->width);
    out->count = 0;
    for (int i = 0; i < columns * rows && out->count < BEAM_MOST_BLOCKS; i++) {
        uint64_t bits = random_hash((uint64_t)i, 0, 0, 37);
        int x = (int)((i % columns + random_unit(bits)) * (view->width - BLOCK) / columns);
        int y = (int)((i / columns + random_unit(random_mix(bits))) * (view->height - BLOCK) / rows);
        beam_tile(tracer, x, y, x + BLOCK, y + BLOCK, out->drawn[out->count], NULL);
        out->noises[out->count++] = allot_noise(beam_tile_noise(tracer), SAMPLES);
    }
}

static double difference(float a, float b) { return (double)float_clamp(a, 0, 1) - (double)float_clamp(b, 0, 1); }

double beam_block_apart(const Radiance *one, const Radiance *other, const Radiance *from) {
    double sum = 0;
    for (int i = 0; i < BEAM_BLOCK * BEAM_BLOCK; i++) {
        Vec3f a = one[i].color, b = other[i].color, c = from[i].color;
        sum += difference(a.x, c.x) * difference(b.x, c.x) + difference(a.y, c.y) * difference(b.y, c.y) + difference(a.z, c.z) * difference(b.z, c.z);
    }
    return sum / (3 * BEAM_BLOCK * BEAM_BLOCK);
}

bool beam_is_drawn(const CompiledScene *compiled) {
    for (size_t i = 0; i < compiled->skin_count; i++)
        if (compiled->skins[i].boxes) return true;
    return false;
}

void beam_worth(CompiledScene *compiled) {
    const View *view = &compiled->view;
    int most = int_min(HARDEST * compiled->most_samples, MOST_BEAM_SAMPLES);
    compiled->allot = (AllotPlan){.first = compiled->samples, .most = most};
    bool told = compiled->scene->settings.samples > 0 || compiled->options->exact;
    if (told || !beam_is_drawn(compiled) || view->width < BEAM_BLOCK || view->height < BEAM_BLOCK) return;
    if (compiled->told && compiled->told->worth > 0) {
        compiled->allot.worth = compiled->told->worth;
        return;
    }
    ArenaMark mark = arena_mark(&compiled->scratch);
    BeamBlocks *blocks = arena_new(&compiled->scratch, BeamBlocks);
    double error = NOISE_SHARE * compiled->max_error;
    beam_blocks_draw(compiled, 37, blocks);
    compiled->trials += blocks->count;
    compiled->allot.worth = allot_worth(blocks->noises, blocks->count, &compiled->allot, error * error, compiled->most_samples);
    compiled->allot_samples = allot_mean_samples(blocks->noises, blocks->count, &compiled->allot);
    compiled->allot_error = sqrt(allot_mean_square(blocks->noises, blocks->count, &compiled->allot));
    arena_reset_to(&compiled->scratch, mark);
    if (compiled->tells) compiled->tells->worth = compiled->allot.worth;
}
