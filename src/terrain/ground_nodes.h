/* The vertices of a mesh of the ground, found by their place in the grid. */
#ifndef VTS_TERRAIN_GROUND_NODES_H
#define VTS_TERRAIN_GROUND_NODES_H

#include "terrain/ground_source.h"
#include "base/arena.h"

/* Places are counted in parts of the distance between posts. */
enum { GROUND_PART_BITS = 8, GROUND_PARTS = 1 << GROUND_PART_BITS };
/* Nodes are kept in pieces of so many: millions are never copied to make room for more. */
enum { GROUND_PIECE_BITS = 12, GROUND_PIECE = 1 << GROUND_PIECE_BITS };
#define GROUND_NO_NODE UINT32_MAX

typedef struct GroundNode {
    uint32_t x, y;     /* column and row in parts; beyond the map too */
    double height;     /* NaN: none */
    Vec3 place;        /* of that height, or of height 0; beyond the map: of its nearest border */
    uint32_t vertex;   /* of the mesh, or GROUND_NO_NODE */
    bool corner;       /* corners of triangles; else a place on the map's border where it cuts them */
} GroundNode;

typedef struct GroundNodes {
    const GroundSource *source;
    Arena *arena;
    struct { GroundNode **items; size_t count, capacity; } pieces;
    size_t count;
    uint32_t *table; /* open addressing */
    size_t table_size;
} GroundNodes;

void ground_nodes_init(GroundNodes *nodes, const GroundSource *source, Arena *arena);
static inline GroundNode *ground_node(const GroundNodes *nodes, uint32_t index) {
    return &nodes->pieces.items[index >> GROUND_PIECE_BITS][index & (GROUND_PIECE - 1)];
}
/* GROUND_NO_NODE where there is none. */
uint32_t ground_node_find(const GroundNodes *nodes, uint32_t x, uint32_t y);
/* There must be none at that place. Its height is the ground's; ground_source_beyond() beyond the map. */
uint32_t ground_node_add(GroundNodes *nodes, uint32_t x, uint32_t y);
/* The same with a given height. */
uint32_t ground_node_add_at(GroundNodes *nodes, uint32_t x, uint32_t y, double height);

#endif
