/* What the samples of one pixel have told: a net of them laid by lot, and one in the middle. */
#ifndef VTS_RENDER_CELL_H
#define VTS_RENDER_CELL_H

#include "render/middles.h"

/* What is known of a pixel. Errors and contrasts are those of light that the picture can show. */
typedef struct Cell {
    Radiance sum;      /* over the samples of its net */
    Vec3f shown, late; /* sums of clamped light: of all of these, of the last half */
    float squares;     /* of its channels */
    Vec3f mean;        /* of what counts */
    int class;         /* of the contrast: contrast_class() */
    float contrast;    /* of the first sample with those around: squared error to be expected of it */
    int net, late_count;
    bool centred;          /* there is a sample in the middle, beside the net */
    bool refinable;
    bool checked, misled; /* whether what is shared was looked at in this round, and was wrong */
    float doubt;     /* squared error to be expected of the first sample by itself */
    uint32_t object; /* that the middle sees, from 1; 0: none */
    Vec3f normal;    /* of it */
    Radiance middle; /* the first sample, */
    Vec3f first;     /* clamped */
    double error;    /* expected squared error now */
} Cell;

/* Light that the picture can show: clamped to [0, 1]. */
Vec3f light_shown(Vec3f color);
/* Of its channels. */
float light_mean_square(Vec3f light);

/* A cell that has but its middle. */
void cell_begin(Cell *cell, const Middle *middle);
/* The next sample of the net. */
void cell_add(Cell *cell, const Radiance *seen);
/* Of the samples that count: the net's, and the middle while the net is small. */
int cell_count(const Cell *cell);
/* Their clamped light, and the squares of its channels, summed. */
Vec3f cell_shown_sum(const Cell *cell);
float cell_squares_sum(const Cell *cell);
/* Their mean; nothing of none. */
Radiance cell_light(const Cell *cell);
/* The squared error of their mean, by how far those of the last half are from the others; 0 where there are none of either. */
double cell_halves_error(const Cell *cell);

#endif
