/* What a sample is worth: a few blocks of pixels drawn before all others tell how noisy the picture is, and so how its samples should be shared out
 * (beam_allot.h) that it comes to max_error. */
#ifndef VTS_RENDER_BEAM_WORTH_H
#define VTS_RENDER_BEAM_WORTH_H

#include "render/beam_tile.h"

/* Blocks of the picture, of so many pixels each way: what each shows, at some samples, and the noise of one sample there. */
enum { BEAM_BLOCK = 3, BEAM_MOST_BLOCKS = 100 };
typedef struct BeamBlocks {
    int count;
    double noises[BEAM_MOST_BLOCKS];
    Radiance drawn[BEAM_MOST_BLOCKS][BEAM_BLOCK * BEAM_BLOCK];
} BeamBlocks;
/* Draws them as it is planned now, of a picture that is no smaller than one; where they lie hangs on the picture's size alone. Memory comes from compiled->scratch. */
void beam_blocks_draw(CompiledScene *compiled, uint64_t seed, BeamBlocks *blocks);
/* The mean square of how far two drawings of a block are from a third, without the noise of the two; it may be negative. */
double beam_block_apart(const Radiance *one, const Radiance *other, const Radiance *from);
/* Whether beams draw anything: some skin is near enough. */
bool beam_is_drawn(const CompiledScene *compiled);

/* Sets compiled->allot, of a scene whose skins are compiled and planned. */
void beam_worth(CompiledScene *compiled);

#endif
