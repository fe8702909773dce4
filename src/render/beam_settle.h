/* What neighbours tell of a pixel.
 *
 * The mean of a few samples is wrong by what is random in them, and the allotment knows by how much: its mean square e. How much neighbouring pixels really differ
 * is what they differ by, less that noise: s. The best linear estimate of a pixel is then their mean m and the share s/(s + e) of what the pixel differs from it, whose
 * mean square error is e·s/(s + e) (Lee 1980, Digital image enhancement and noise filtering by use of local statistics). At edges, in the sky, and with many samples s is far
 * larger than e, and pixels stay as they are; woods of which a pixel holds many trees have half the error, or less. */
#ifndef VTS_RENDER_BEAM_SETTLE_H
#define VTS_RENDER_BEAM_SETTLE_H

#include "render/beam_allot.h"

/* Replaces the pixels of a tile, as its last pass has left them, by such estimates; neighbours are those of the tile, up to three pixels away.
 * Returns the mean square of the error that is to be expected of them. */
double beam_settle(const Allotment *allotment, Radiance *pixels);

#endif
