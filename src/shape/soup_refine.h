/* Triangles cut where somebody asks for it, without gaps: each edge is decided by itself, so that both its sides agree. */
#ifndef VTS_SHAPE_SOUP_REFINE_H
#define VTS_SHAPE_SOUP_REFINE_H

#include "shape/soup.h"

#include <stdatomic.h>

typedef struct RefineRules {
    /* Whether the edge is halved: must be the same for (b, a), and for other vertices at the same places. */
    bool (*split)(void *context, const TriangleSoup *soup, uint32_t a, uint32_t b);
    /* What a new vertex, in the middle of (a, b), has to become; or NULL. */
    void (*place)(void *context, TriangleSoup *soup, uint32_t vertex, uint32_t a, uint32_t b);
    void *context;
    size_t most_triangles; /* of those after the mark */
    const atomic_bool *interrupted; /* set by others: they count as too many; or NULL */
} RefineRules;

/* Halves edges of the triangles after the mark until no rule asks for more. False when they became too many: *soup is then
 * still whole, but not fine enough. */
bool soup_refine(Arena *arena, TriangleSoup *soup, SoupMark since, const RefineRules *rules);

/* The vertex at a + (b - a)·t, everything interpolated; the same bits for (b, a, 1 - t) when t is 1/2. */
SoupVertex soup_between(const SoupVertex *a, const SoupVertex *b, double t);

#endif
