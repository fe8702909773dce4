/* How far bounds of a sum reach on pieces of lines of some length: whoever divides lines learns from it how long pieces may be for bounds
 * to tell anything. A matter of speed alone. */
#ifndef VTS_TAPE_TAPE_REACH_H
#define VTS_TAPE_TAPE_REACH_H

#include "base/arena.h"

struct Interval;
struct TapeSum;

enum { TAPE_REACH_LENGTHS = 32 };

/* length[k] is 2⁻ᵏ of the box's diagonal, the last is 0; radius[k] what the forms of the sum are off their middles on pieces of that length, on
 * average; it falls with k. */
typedef struct TapeReach {
    double length[TAPE_REACH_LENGTHS + 1], radius[TAPE_REACH_LENGTHS + 1];
    double per_radius[TAPE_REACH_LENGTHS]; /* lengths between k + 1 and k */
} TapeReach;

/* Measured on pieces of random lines in the box, the same ones each time. Of a length that no bound tells anything of the radius is that of half of it. */
TapeReach tape_reach_of(const struct TapeSum *sum, const struct Interval *box, Arena *arena);

/* The longest pieces, up to the diagonal, whose radius is on average no more than `radius`, which is not negative. *at, in
 * [0, TAPE_REACH_LENGTHS): where to look first; set to where it was found. */
double tape_reach_length(const TapeReach *reach, double radius, int *at);

#endif
