/* What pixels of a tile have told about others like them: how far what is expected of an error comes true. */
#ifndef VTS_RENDER_LEARNED_H
#define VTS_RENDER_LEARNED_H

/* A ratio that is learned: of what came out to what was expected. */
typedef struct Learned {
    double expected, found;
    int count;
} Learned;

/* Nets are learned apart by the doublings of their size. */
enum { LEARNED_LEVELS = 9 };
/* Of so many samples; 0: of one or two. */
int learned_level(int samples);

void learn(Learned *learned, double expected, double found);
/* `before` where nothing has been learned; it counts as much as `weight` pixels. */
double learned_ratio(const Learned *learned, double before, double weight);
/* Of what was found; `before` where nothing was. */
double learned_mean(const Learned *learned, double before);

#endif
