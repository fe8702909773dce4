#include "render/beam_worth.h"

#include "base/random.h"
#include "render/beam_tile.h"

/* Blocks of so many pixels each way, one for so many pixels of the picture, each in a cell of a lattice over it. */
enum { BLOCK = 3, LEAST_BLOCKS = 6, MOST_BLOCKS = 100, PIXELS_A_BLOCK = 1200, SAMPLES = 16 };
/* Of max_error, what samples may make: the rest is what voxels are wrong by, and what else nobody has thought of. */
static const double NOISE_SHARE = 0.75;
/* So many times the samples that pixels may have on the mean those may have that are hardest. */
enum { HARDEST = 4 };

static int lattice(double cells, double part) { return int_max((int)round(sqrt(cells * part)), 1); }

/* The noise of each block; returns how many there are. */
static int draw_blocks(CompiledScene *compiled, double noises[MOST_BLOCKS]) {
    const View *view = &compiled->view;
    const BeamPlan plan = {.samples = {.first = SAMPLES, .most = SAMPLES}, .interrupted = compiled->options->interrupted};
    BeamTracer *tracer = beam_tracer_create(compiled, &plan, 37, &compiled->scratch);
    Radiance drawn[BLOCK * BLOCK];
    double blocks = double_clamp((double)view->width * view->height / PIXELS_A_BLOCK, LEAST_BLOCKS, 0.8 * MOST_BLOCKS);
    int columns = lattice(blocks, (double)view->width / view->height), rows = lattice(blocks, (double)view->height / view->width), count = 0;
    for (int i = 0; i < columns * rows && count < MOST_BLOCKS; i++) {
        uint64_t bits = random_hash((uint64_t)i, 0, 0, 37);
        int x = (int)((i % columns + random_unit(bits)) * (view->width - BLOCK) / columns);
        int y = (int)((i / columns + random_unit(random_mix(bits))) * (view->height - BLOCK) / rows);
        beam_tile(tracer, x, y, x + BLOCK, y + BLOCK, drawn, NULL);
        noises[count++] = allot_noise(beam_tile_noise(tracer), SAMPLES);
    }
    return count;
}

static bool is_drawn_by_beams(const CompiledScene *compiled) {
    for (size_t i = 0; i < compiled->skin_count; i++)
        if (compiled->skins[i].boxes) return true;
    return false;
}

void beam_worth(CompiledScene *compiled) {
    const View *view = &compiled->view;
    int most = int_min(HARDEST * compiled->most_samples, MOST_BEAM_SAMPLES);
    compiled->allot = (AllotPlan){.first = compiled->samples, .most = most};
    bool told = compiled->scene->settings.samples > 0 || compiled->options->exact;
    if (told || !is_drawn_by_beams(compiled) || view->width < BLOCK || view->height < BLOCK) return;
    if (compiled->told && compiled->told->worth > 0) {
        compiled->allot.worth = compiled->told->worth;
        return;
    }
    ArenaMark mark = arena_mark(&compiled->scratch);
    double noises[MOST_BLOCKS], error = NOISE_SHARE * compiled->max_error;
    int count = draw_blocks(compiled, noises);
    arena_reset_to(&compiled->scratch, mark);
    compiled->trials += count;
    compiled->allot.worth = allot_worth(noises, count, &compiled->allot, error * error, compiled->most_samples);
    if (compiled->tells) compiled->tells->worth = compiled->allot.worth;
}
