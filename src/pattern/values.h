/* The patterns that give a number. */
#ifndef VTS_PATTERN_VALUES_H
#define VTS_PATTERN_VALUES_H

#include "pattern/warp.h"

/* Where a pattern's value starts again from 0, before its frequency multiplies it. */
typedef enum Restart { RESTART_NEVER, RESTART_AT_ONE, RESTART_PAST_ONE } Restart;

typedef struct PatternTraits {
    WaveKind wave;     /* unless the pigment names one */
    Restart restart;   /* left to the reader of pattern_value(), for whom the value runs on */
    bool bounded;      /* values stay in [0, 1] and do not wrap of themselves */
    bool warps_itself; /* turbulence is part of the pattern's own formula */
    bool sampled;      /* nothing is known of its means: places of the footprint are asked one by one */
    int blocks;        /* kinds of block; 0: the pattern has a value */
} PatternTraits;

PatternTraits pattern_traits(PatternKind kind);
WaveKind pigment_wave(const Pigment *pigment);
/* The pattern's value at a spot of pattern space (already warped), before its restart, frequency, phase and wave. */
Spread pattern_value(const Pigment *pigment, const Spot *spot);
/* Only the value, at places of one footprint: what iterates does so side by side. */
enum { PATTERN_PLACES = 4 };
void pattern_values(const Pigment *pigment, const Spot places[PATTERN_PLACES], double values[PATTERN_PLACES]);

#endif
