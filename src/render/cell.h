/* What the samples of one pixel have told: a net of them laid by lot, and one in the middle. */
#ifndef VTS_RENDER_CELL_H
#define VTS_RENDER_CELL_H

#include "render/middles.h"

/* What is known of a pixel. Errors and contrasts are those of light that the picture can show. */
typedef struct Cell {
    /* What is asked of all cells of a tile again and again stands together. */
    double error;   /* expected squared error now */
    float contrast; /* of the first sample with those around: squared error to be expected of it */
    float doubt;    /* squared error to be expected of the first sample by itself */
    int class;      /* of the contrast: contrast_class() */
    int net, late_count;
    bool centred; /* there is a sample in the middle, beside the net */
    bool refinable;
    bool probe;           /* its next samples are for others like it */
    bool checked, misled; /* whether what is shared was looked at in this round, and was wrong */
    bool edged, traced;   /* one edge goes through the pixel (pixel_edge.h), as the middles around have it; and as its samples have it */
    float edge_error;     /* squared error to be expected of */
    Radiance edge;        /* the light that it makes */
    Vec3f mean;           /* of what counts */
    float squares;        /* of the channels of its net's samples */
    Radiance sum;         /* over these, */
    Vec3f shown, late;    /* and sums of clamped light: of all of these, of the last half */
    uint32_t object;      /* that the middle sees, from 1; 0: none */
    Vec3f normal;         /* of it */
    SurfaceTint tint;     /* as Middle has it */
    Radiance middle;      /* the first sample, */
    Vec3f first;          /* clamped */
} Cell;

/* Light that the picture can show: clamped to [0, 1]. */
static inline Vec3f light_shown(Vec3f color) {
    return vec3f(float_clamp(color.x, 0, 1), float_clamp(color.y, 0, 1), float_clamp(color.z, 0, 1));
}
/* Of its channels. */
static inline float light_mean_square(Vec3f light) { return vec3f_dot(light, light) / 3; }

/* A cell that has but its middle. */
void cell_begin(Cell *cell, const Middle *middle);
/* The next sample of the net. */
void cell_add(Cell *cell, const Radiance *seen);
/* A net of so many samples or more says more without the middle: its error falls with their power 3/2, and what another would add does not. */
enum { CELL_NET_ALONE = 8 };
static inline bool cell_counts_middle(const Cell *cell) { return cell->centred && cell->net < CELL_NET_ALONE; }
/* Of the samples that count: the net's, and the middle while the net is small. */
static inline int cell_count(const Cell *cell) { return cell->net + cell_counts_middle(cell); }
/* Their clamped light, and the squares of its channels, summed. */
Vec3f cell_shown_sum(const Cell *cell);
float cell_squares_sum(const Cell *cell);
/* Their mean; nothing of none. */
Radiance cell_light(const Cell *cell);
/* The squared error of their mean, by how far those of the last half are from the others; 0 where there are none of either. */
double cell_halves_error(const Cell *cell);
/* The variance of one sample, by those that count, two at least: the mean over its channels. */
double cell_variance(const Cell *cell);

#endif
