#include "render/learned.h"

/* What is known of a law by itself counts as much as so many pixels. */
static const double PRIOR = 4;

int learned_level(int samples) {
    int level = 0;
    while (samples > 2 && level < LEARNED_LEVELS - 1) samples /= 2, level++;
    return level;
}

void learn(Learned *learned, double expected, double found) {
    learned->expected += expected;
    learned->found += found;
    learned->count++;
}

double learned_ratio(const Learned *learned, double before, double weight) {
    if (learned->count == 0 || !(learned->expected > 0)) return before;
    return (weight * before + learned->count * learned->found / learned->expected) / (weight + learned->count);
}

double learned_mean(const Learned *learned, double before) {
    return (PRIOR * before + learned->found) / (PRIOR + learned->count);
}
