/* A tape under construction: shared by the files that build and finish tapes. */
#ifndef VTS_TAPE_TAPE_BUILDER_H
#define VTS_TAPE_TAPE_BUILDER_H

#include "tape/tape_program.h"

struct TapeBuilder {
    Arena *arena;
    uint32_t input_count;
    struct {
        TapeNode *items;
        size_t count, capacity;
    } nodes;
    struct {
        Span *items;
        size_t count, capacity;
    } spans; /* of nodes */
    struct {
        TapeCall *items;
        size_t count, capacity;
    } calls;
    struct {
        TapeLoop *items;
        size_t count, capacity;
    } loops;
    uint32_t *share; /* open hash table: 1 + index of a node, 0 = empty */
    size_t share_size;
};

/* tape_inline() of all values: map[i] gets the value of the callee's node i. */
void tape_inline_nodes(TapeBuilder *builder, const Tape *callee, const TapeRef *inputs, TapeRef *map);

#endif
