/* Cells of noises made of scattered points that were worked out before, for those who look at many places near each other. What is asked of a cache
 * never depends on what it has seen: a cell's points follow from the cell. */
#ifndef VTS_TAPE_NODE_CACHE_H
#define VTS_TAPE_NODE_CACHE_H

#include "tape/noise_nodes.h"

enum { NODE_CACHE_CELLS = 1024, NODE_CACHE_POINTS = 10 };

typedef struct NodePoint {
    Vec3 at;
    double weight;
} NodePoint;

/* Of a cell: its points, and what they weigh. */
typedef struct NodePoints {
    NodeCell cell;
    uint32_t kind; /* 0: nothing yet */
    int32_t count;
    NodePoint points[NODE_CACHE_POINTS];
} NodePoints;

typedef struct NodeCache {
    NodePoints cells[NODE_CACHE_CELLS];
} NodeCache;

/* Before its first use. */
static inline void node_cache_begin(NodeCache *cache) {
    for (size_t k = 0; k < NODE_CACHE_CELLS; k++) cache->cells[k].kind = 0;
}

/* Neighbours of one kind have places of their own. *known: what is there are the cell's points; else the caller puts them there. `kind` is not 0. */
static inline NodePoints *node_cache_at(NodeCache *cache, NodeCell cell, uint32_t kind, bool *known) {
    NodePoints *here = &cache->cells[((uint64_t)cell.x + 5 * (uint64_t)cell.y + 29 * (uint64_t)cell.z) % NODE_CACHE_CELLS];
    *known = here->kind == kind && here->cell.x == cell.x && here->cell.y == cell.y && here->cell.z == cell.z;
    here->cell = cell, here->kind = kind;
    return here;
}

#endif
