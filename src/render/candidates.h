/* Pixels that may be refined, those that gain most first. */
#ifndef VTS_RENDER_CANDIDATES_H
#define VTS_RENDER_CANDIDATES_H

#include "render/film.h"

typedef struct Candidate {
    double gain;
    int cell;
} Candidate;

enum { MOST_CANDIDATES = 4 * (FILM_TILE + 2) * (FILM_TILE + 2) };

/* A heap, the largest gain on top. */
typedef struct CandidateHeap {
    Candidate items[MOST_CANDIDATES];
    int count;
} CandidateHeap;

/* Nothing, when the heap is full. */
void candidates_push(CandidateHeap *heap, int cell, double gain);
/* Of a heap that is not empty. */
Candidate candidates_pop(CandidateHeap *heap);

#endif
