#include "render/beam_choice.h"

#include "render/beam_afford.h"
#include "render/beam_worth.h"

/* Voxels are asked about where geometry takes so many times as long as they are likely to: for each pixel, and for building them, in seconds; for building, besides, by the square
 * of their resolution. */
static const double DEAR = 1.5, VOXELS_A_PIXEL = 3e-5, BUILDING = 0.5, BUILDING_FINE = 7e-6;
/* Voxels that are built to be asked, and may then not be wanted, take no more of the time than this part of what geometry takes. */
static const double ASKED_SHARE = 1.0 / 8;
/* How the noise of what is small beside a pixel falls with the samples. */
static const double NOISE_POWER = 0.6;
/* The blocks of both drawings as planned. */
enum { ONE = 41, OTHER = 43 };

static bool is_open(const CompiledScene *compiled) {
    if (!(compiled->allot.worth > 0) || compiled->told || !beam_is_drawn(compiled)) return false;
    return !compiled->options->film || compiled->tells; /* frames are drawn alike */
}

/* What building voxels is likely to take. */
static double building_seconds(const CompiledScene *compiled) {
    double finest = 0;
    for (size_t i = 0; i < compiled->texel_count; i++) finest = fmax(finest, int_min(compiled->texels[i]->finest_seen, TEXEL_LARGEST_RESOLUTION));
    return compiled->voxels ? 0 : BUILDING + BUILDING_FINE * finest * finest;
}

bool beam_choice_open(CompiledScene *compiled, BeamPrice *planned) {
    if (!is_open(compiled)) return false;
    double pixels = (double)compiled->view.width * compiled->view.height, building = building_seconds(compiled);
    *planned = (BeamPrice){beam_seconds(compiled, false, compiled->allot_samples), hypot(compiled->allot_error, beam_voxels_error(compiled))};
    return planned->seconds > DEAR * (VOXELS_A_PIXEL * pixels + building) && building <= ASKED_SHARE * planned->seconds;
}

/* How far voxels alone are from what is planned: up to chance, which may make it less than nothing. */
static double square_apart(CompiledScene *compiled) {
    BeamBlocks *one = arena_new(&compiled->scratch, BeamBlocks), *other = arena_new(&compiled->scratch, BeamBlocks), *voxels = arena_new(&compiled->scratch, BeamBlocks);
    beam_blocks_draw(compiled, ONE, one);
    beam_blocks_draw(compiled, OTHER, other);
    ExactReach before = beam_reach_set(compiled, 0);
    beam_blocks_draw(compiled, ONE, voxels);
    beam_reach_reset(compiled, before);
    compiled->trials += one->count;
    double sum = 0;
    for (int i = 0; i < one->count; i++) sum += beam_block_apart(one->drawn[i], other->drawn[i], voxels->drawn[i]);
    return one->count ? sum / one->count : 0;
}

void beam_voxels_alone(CompiledScene *compiled, double error) {
    for (size_t i = 0; i < compiled->skin_count; i++) compiled->skins[i].boxes = NULL, compiled->skins[i].exact_to = 0;
    compiled->all_exact_to = VTS_INFINITY;
    compiled->voxel_error = error;
}

/* What it would take to bring the error down to max_error by samples. */
static double whole_price(const CompiledScene *compiled, BeamPrice drawn) { return drawn.seconds * pow(fmax(drawn.error / compiled->max_error, 1), 1 / NOISE_POWER); }

bool beam_choose_voxels(CompiledScene *compiled, const BeamPrice *planned) {
    ArenaMark mark = arena_mark(&compiled->scratch);
    double apart = square_apart(compiled), own = beam_voxels_error(compiled);
    arena_reset_to(&compiled->scratch, mark);
    BeamPrice alone = {beam_seconds(compiled, true, 0), sqrt(fmax(apart, 0) + own * own)};
    bool named = compiled->scene->settings.max_error > 0, as_good = alone.error <= fmax(compiled->max_error, planned->error);
    bool better = alone.seconds < planned->seconds && (as_good || (!named && whole_price(compiled, alone) < whole_price(compiled, *planned)));
    if (better) beam_voxels_alone(compiled, alone.error);
    if (compiled->tells) compiled->tells->alone = better, compiled->tells->voxel_error = compiled->voxel_error;
    return better;
}
