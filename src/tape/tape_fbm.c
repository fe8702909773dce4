/* Fractal sums as operations of the tape, so that every arithmetic has them. */
#include "tape/tape_builder.h"

#include <math.h>

enum { MAX_OCTAVES = 64 };

static TapeRef octave(TapeBuilder *b, const TapeRef place[3], TapeRef frequency, TapeRef amplitude,
                      Span span) {
    TapeRef p[3];
    for (int k = 0; k < 3; k++) p[k] = tape_binary(b, TAPE_MUL, place[k], frequency, span);
    return tape_binary(b, TAPE_MUL, amplitude, tape_ternary(b, TAPE_PERLIN, p[0], p[1], p[2], span), span);
}

static TapeRef unrolled(TapeBuilder *b, const TapeRef place[3], int octaves, TapeRef lacunarity, TapeRef gain,
                        Span span) {
    TapeRef sum = tape_constant(b, 0), frequency = tape_constant(b, 1), amplitude = frequency;
    for (int k = 0; k < octaves; k++) {
        TapeRef term = octave(b, place, frequency, amplitude, span);
        sum = k ? tape_binary(b, TAPE_ADD, sum, term, span) : term;
        frequency = tape_binary(b, TAPE_MUL, frequency, lacunarity, span);
        amplitude = tape_binary(b, TAPE_MUL, amplitude, gain, span);
    }
    return sum;
}

/* sum(k, 0, octaves - 1, gainᵏ·perlin(lacunarityᵏ·p)) */
static TapeRef looped(TapeBuilder *b, const TapeRef place[3], TapeRef octaves, TapeRef lacunarity,
                      TapeRef gain, Span span) {
    TapeBuilder *body = tape_builder_create(b->arena, 6);
    TapeRef inner[6], captured[5] = {place[0], place[1], place[2], lacunarity, gain};
    for (int k = 0; k < 6; k++) inner[k] = tape_input(body, k);
    TapeRef frequency = tape_binary(body, TAPE_POW, inner[3], inner[5], span);
    TapeRef amplitude = tape_binary(body, TAPE_POW, inner[4], inner[5], span);
    TapeRef term = octave(body, inner, frequency, amplitude, span);
    TapeRef last = tape_binary(b, TAPE_SUB, octaves, tape_constant(b, 1), span);
    return tape_loop(b, false, tape_constant(b, 0), last, tape_finish(body, &term, 1), captured, 5, span);
}

TapeRef tape_fbm(TapeBuilder *b, const TapeRef place[3], TapeRef octaves, TapeRef lacunarity, TapeRef gain,
                 Span span) {
    double count;
    if (!tape_is_constant(b, octaves, &count)) return looped(b, place, octaves, lacunarity, gain, span);
    return unrolled(b, place, double_to_int(count, 0, MAX_OCTAVES), lacunarity, gain, span);
}
