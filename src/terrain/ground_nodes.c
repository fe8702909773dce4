#include "terrain/ground_nodes.h"

#include <string.h>

enum { FIRST_TABLE = 1 << 12 };

/* Neighbours of one level of the grid share lines of the cache. */
static size_t slot_of(const GroundNodes *nodes, uint32_t x, uint32_t y) {
    enum { NEAR_BITS = 2, NEAR = 1 << NEAR_BITS };
    const int level = x | y ? __builtin_ctz(x | y) : 0;
    x >>= level, y >>= level;
    uint64_t key = ((uint64_t)(y >> NEAR_BITS) << 32 | x >> NEAR_BITS) + ((uint64_t)level << 58);
    key = (key ^ key >> 31) * 0x9E3779B97F4A7C15u;
    const size_t within = (y % NEAR) * NEAR + x % NEAR;
    return (size_t)((key ^ key >> 29) << (2 * NEAR_BITS) | within) & (nodes->table_size - 1);
}

static void clear_table(GroundNodes *nodes, size_t size) {
    nodes->table_size = size;
    nodes->table = arena_new_array(nodes->arena, uint32_t, size);
    memset(nodes->table, 0xFF, size * sizeof *nodes->table);
}

static void insert(GroundNodes *nodes, uint32_t index) {
    const GroundNode *node = ground_node(nodes, index);
    size_t slot = slot_of(nodes, node->x, node->y);
    while (nodes->table[slot] != GROUND_NO_NODE) slot = (slot + 1) & (nodes->table_size - 1);
    nodes->table[slot] = index;
}

void ground_nodes_init(GroundNodes *nodes, const GroundSource *source, Arena *arena) {
    *nodes = (GroundNodes){.source = source, .arena = arena};
    clear_table(nodes, FIRST_TABLE);
}

uint32_t ground_node_find(const GroundNodes *nodes, uint32_t x, uint32_t y) {
    for (size_t slot = slot_of(nodes, x, y);; slot = (slot + 1) & (nodes->table_size - 1)) {
        uint32_t index = nodes->table[slot];
        if (index == GROUND_NO_NODE) return index;
        const GroundNode *node = ground_node(nodes, index);
        if (node->x == x && node->y == y) return index;
    }
}

uint32_t ground_node_add_at(GroundNodes *nodes, uint32_t x, uint32_t y, double height) {
    const GroundSource *s = nodes->source;
    double column = fmin((double)x / GROUND_PARTS, s->columns - 1), row = fmin((double)y / GROUND_PARTS, s->rows - 1);
    Vec3 place = s->place(s->map, column, row, isfinite(height) ? height : 0);
    uint32_t index = (uint32_t)nodes->count;
    if (nodes->count % GROUND_PIECE == 0) *list_push(nodes->arena, &nodes->pieces) = arena_new_array(nodes->arena, GroundNode, GROUND_PIECE);
    *ground_node(nodes, (uint32_t)nodes->count++) = (GroundNode){.x = x, .y = y, .height = height, .place = place, .vertex = GROUND_NO_NODE};
    if (2 * nodes->count > nodes->table_size) {
        clear_table(nodes, 2 * nodes->table_size);
        for (uint32_t i = 0; i < nodes->count; i++) insert(nodes, i);
    } else {
        insert(nodes, index);
    }
    return index;
}

uint32_t ground_node_add(GroundNodes *nodes, uint32_t x, uint32_t y) {
    return ground_node_add_at(nodes, x, y, ground_source_beyond(nodes->source, (double)x / GROUND_PARTS, (double)y / GROUND_PARTS));
}
