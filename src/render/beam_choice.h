/* Whether a picture is better drawn from voxels alone.
 *
 * beam_pilot.c tells how far geometry is worth drawing at each distance; it does not look at skins that are drawn whole, nor at what all of it takes together. Where
 * geometry takes long, some blocks of the picture are drawn as it is planned, twice, and from voxels: the mean of (planned₁ − voxels)·(planned₂ − voxels) is the square
 * of how far the two are apart, without the noise of either. Voxels are chosen where they take less time and keep max_error, or are no worse than what is planned; and where
 * nobody named a max_error, if geometry is dearer than samples would be that brought the voxels' error down as far (it falls with the power 0.6 of their number). By counts, not by
 * clocks: the same scene is the same picture anywhere. */
#ifndef VTS_RENDER_BEAM_CHOICE_H
#define VTS_RENDER_BEAM_CHOICE_H

#include "render/compile.h"

/* The picture as it is planned: seconds, by counts; RMSE, of noise and of what voxels there are. */
typedef struct BeamPrice {
    double seconds, error;
} BeamPrice;

/* After beam_worth(). False: whatever voxels would take, it is not worth asking; else the price. */
bool beam_choice_open(CompiledScene *compiled, BeamPrice *planned);
/* Makes the choice, of a scene whose voxels are built. True: voxels are drawn alone. */
bool beam_choose_voxels(CompiledScene *compiled, const BeamPrice *planned);
/* From now on all skins are voxels alone, whose RMSE in the picture is `error`. */
void beam_voxels_alone(CompiledScene *compiled, double error);

#endif
