/* How far exact geometry is worth its time.
 *
 * Where max_error can be kept, it is, whatever it costs. Where it cannot, since voxels remain wrong as far as geometry may be drawn or geometry remains noisy with all the
 * samples that it may have, time is bounded: a few tiles of the picture are drawn both ways, what that took is told by counts, and voxels begin so near that the
 * picture takes no more than some times what voxels alone would. Counts, not clocks: the same scene is the same picture anywhere. */
#ifndef VTS_RENDER_BEAM_AFFORD_H
#define VTS_RENDER_BEAM_AFFORD_H

#include "render/beam_tile.h"

/* The distances up to which skins are exact geometry, before they were changed. In compiled->scratch. */
typedef struct ExactReach {
    const double *skins;
    double all;
} ExactReach;
/* Multiplies them; 0: none is. */
ExactReach beam_reach_set(CompiledScene *compiled, double factor);
void beam_reach_reset(CompiledScene *compiled, ExactReach before);

/* Where the pixel first sees a skin's layer, relative to the distance at which its voxels begin; < 0 where it sees none. */
double beam_distance_at(const CompiledScene *compiled, int x, int y);

/* What a pilot has found. */
typedef struct BeamOffer {
    double factor;  /* by which the distances should be multiplied */
    double error;   /* of voxels at those distances, falling with them */
    double noise;   /* of exact geometry with all the samples it may have */
    double samples; /* a pixel, that keep max_error if they are not too many */
} BeamOffer;
/* The factor that is affordable: that of the offer at most. */
double beam_afford(CompiledScene *compiled, const BeamOffer *offer);
/* Seconds, by counts, that the picture takes as it is planned with so many samples a pixel, or from voxels alone; < 0 of a picture that is too small to be probed. */
double beam_seconds(CompiledScene *compiled, bool voxels, double samples);
/* What mapping and drawing triangles took, and boxes around some of them, between the two counts: as so many of the samples in between, with what these see and ask. */
double beam_price_in_samples(const BeamWork *before, const BeamWork *after);
/* The RMSE that voxels make in the picture as it is planned, noise not counted: 0 where no pilot has told. */
double beam_voxels_error(const CompiledScene *compiled);

#endif
