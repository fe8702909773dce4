/* Middles of a tile's pixels where light is not found in each: between middles that agree it is interpolated, over eight pixels where only one thing
 * can be seen. What is met there is found for one of four pixels where it can be anything else that is not narrower than three, and the edges that
 * show are followed from pixel to pixel, so that none is lost; where the light may have details that a square's corners do not show, squares are small
 * and more places have to agree; and the light of a share of those pixels, which tells how wrong the others are. Where light is a multiple of a
 * pattern's colour, what is interpolated is what makes it from the colour, which is looked at, unless it changes as evenly. The light of skins' matter is interpolated where all
 * corners and the middle have some before them: between bare places there might be a blade that none of them tells of. (Adaptive
 * undersampling: Akimoto, Mase & Suenaga, Pixel-selected ray tracing, 1991; there edges are guessed, too.) */
#ifndef VTS_RENDER_GUESS_H
#define VTS_RENDER_GUESS_H

#include "render/middles.h"
#include "render/vista.h"

/* The middles at the corners of a square, which see the same, and what each counts at a place within. */
typedef struct Guess {
    const Middle *corners[4];
    float weights[4];
    bool even; /* in between there is no other colour than at the corners */
} Guess;

/* The light between the corners, of what is seen there: object, normal, texture and colour of `here` are set. False where something else
 * is met than at the corners; else its light is set, and `lit` of its tint. */
bool guess_light(const Guess *guess, Middle *here);

/* How the middle of a pixel of the tile is seen: its light is found when `guess` is NULL, or does not hold there. */
typedef struct GuessSight {
    bool (*see)(void *context, int x, int y, const Guess *guess, Middle *out); /* whether it holds */
    /* What can be seen between these pixels, which all see `object`; or NULL: anything. */
    VistaView (*view)(void *context, int x0, int y0, int x1, int y1, uint32_t object);
    /* Whether what this middle sees has its colour all over a square of so many pixels about it; NULL: nobody knows. */
    bool (*even)(void *context, int x, int y, double width, const Middle *middle);
    void *context;
    double
        tolerance; /* of light in [0, 1]: how far the middle of a square may be from what its corners tell; 0: nothing is guessed */
    double accepted; /* squared error of light that was guessed */
} GuessSight;

/* The middles of `columns` × `rows` pixels, at most FILM_TILE each way, in rows of FILM_TILE. */
void guess_tile(const GuessSight *sight, int columns, int rows, Middle *out);

#endif
