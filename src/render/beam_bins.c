#include "render/beam_bins.h"

#include <string.h>

void beam_bins_init(BeamBins *b, uint32_t samples, uint32_t most_bins, Arena *arena) {
    const uint32_t padded = samples + BEAM_LANES - 1;
    *b = (BeamBins){.first = arena_new_room(arena, uint32_t, most_bins + 1),
                    .bin = arena_new_room(arena, uint32_t, samples),
                    .order = arena_new_room(arena, uint32_t, samples),
                    .x = arena_new_room(arena, float, padded),
                    .y = arena_new_room(arena, float, padded),
                    .key = arena_new_room(arena, float, padded),
                    .limit = arena_new_room(arena, float, padded),
                    .mark = arena_new_room(arena, uint32_t, padded)};
}

int beam_bins_sort(BeamBins *b, int columns, int rows, uint32_t samples) {
    int bins = columns * rows, filled = 0;
    uint32_t *first = b->first;
    memset(first, 0, ((size_t)bins + 1) * sizeof *first);
    for (uint32_t i = 0; i < samples; i++) first[b->bin[i]]++;
    for (int k = 0; k < bins; k++) {
        filled += first[k] > 0;
        first[k + 1] += first[k];
    }
    /* Fills each bin from its end: first[k] comes to its beginning. The last entry counts none, and is where all end. */
    for (uint32_t i = samples; i-- > 0;) b->order[--first[b->bin[i]]] = i;
    return filled;
}

BeamSamples beam_bins_samples(const BeamBins *b, int columns, int rows) {
    for (uint32_t i = 0, count = b->first[columns * rows]; i < BEAM_LANES - 1; i++) {
        b->key[count + i] = INFINITY;
        b->x[count + i] = b->y[count + i] = b->limit[count + i] = 0;
    }
    return (BeamSamples){columns, rows, b->first, b->x, b->y, b->key, b->limit, b->mark};
}

static int bin_at(float x, int bins) { return int_clamp((int)x, 0, bins - 1); }

void beam_part(Beam *beam, int parts, BeamBins *b) {
    const BeamSamples in = beam->samples;
    const int columns = parts * in.columns, rows = parts * in.rows;
    const uint32_t count = in.first[in.columns * in.rows];
    const float scale = (float)parts;
    for (uint32_t i = 0; i < count; i++) b->bin[i] = (uint32_t)(bin_at(scale * in.y[i], rows) * columns + bin_at(scale * in.x[i], columns));
    beam_bins_sort(b, columns, rows, count);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t from = b->order[i];
        b->x[i] = scale * in.x[from], b->y[i] = scale * in.y[from];
        b->key[i] = in.key[from], b->limit[i] = in.limit[from], b->mark[i] = in.mark[from];
    }
    for (int k = 0; k < 2; k++) beam->rows[k] = vec3_scale(beam->rows[k], parts);
    beam->shift.x *= parts, beam->shift.y *= parts;
    beam->samples = beam_bins_samples(b, columns, rows);
    beam_close(beam);
}

void beam_join(const Beam *parted, const BeamBins *b, Beam *beam) {
    const BeamSamples *from = &parted->samples, *to = &beam->samples;
    const uint32_t count = to->first[to->columns * to->rows];
    for (uint32_t i = 0; i < count; i++) to->key[b->order[i]] = from->key[i], to->mark[b->order[i]] = from->mark[i];
}
