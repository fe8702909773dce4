/* Samples sorted into square bins, so that a triangle is held against few of those that it misses. */
#ifndef VTS_RENDER_BEAM_BINS_H
#define VTS_RENDER_BEAM_BINS_H

#include "render/beam.h"

typedef struct BeamBins {
    uint32_t *first; /* [bins + 1] */
    uint32_t *bin;   /* of each sample before it is sorted */
    uint32_t *order; /* which one has become sample i */
    float *x, *y, *key, *limit;
    uint32_t *mark;
} BeamBins;

/* Room for so many samples in so many bins. */
void beam_bins_init(BeamBins *bins, uint32_t samples, uint32_t most_bins, Arena *arena);
/* Sorts samples of which `bin` is set: sets `order` and `first`. Returns how many bins are not empty. */
int beam_bins_sort(BeamBins *bins, int columns, int rows, uint32_t samples);
/* The arrays of sorted samples; they hold nothing yet. */
BeamSamples beam_bins_samples(const BeamBins *bins, int columns, int rows);

/* Bins of a beam are cut in `parts` each way and its samples sorted into them: `beam` becomes one that sees them in these, and whoever draws into it has to call beam_join()
 * when it is done. `beam` is closed. */
void beam_part(Beam *beam, int parts, BeamBins *bins);
/* What has been drawn since comes back to the samples of the beam as it was. */
void beam_join(const Beam *parted, const BeamBins *bins, Beam *beam);

#endif
