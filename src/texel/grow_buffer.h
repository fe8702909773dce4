/* A growing array on the heap, charged to a budget; running out is a flag, since workers cannot unwind. */
#ifndef VTS_TEXEL_GROW_BUFFER_H
#define VTS_TEXEL_GROW_BUFFER_H

#include "base/arena.h"

typedef struct GrowBuffer {
    void *data;
    size_t count;    /* items */
    size_t capacity; /* bytes */
    MemoryBudget *memory;
    bool failed;
} GrowBuffer;

/* Room for `count` more items of `size` bytes, not cleared; NULL, and `failed`, when memory ran out. All items of a buffer
 * have the same size. The address holds until the next call. */
void *grow_buffer_add(GrowBuffer *buffer, size_t count, size_t size);
void grow_buffer_free(GrowBuffer *buffer);

#endif
