#include "texel/grow_buffer.h"

#include <stdlib.h>

static bool grow(GrowBuffer *b, size_t needed) {
    size_t capacity = size_max(needed + needed / 2, 4096);
    if (!memory_budget_take(b->memory, capacity - b->capacity)) return false;
    void *data = realloc(b->data, capacity);
    if (!data) {
        memory_budget_give_back(b->memory, capacity - b->capacity);
        return false;
    }
    b->data = data;
    b->capacity = capacity;
    return true;
}

void *grow_buffer_add(GrowBuffer *b, size_t count, size_t size) {
    size_t needed = (b->count + count) * size;
    if (b->failed || (needed > b->capacity && !grow(b, needed))) {
        b->failed = true;
        return NULL;
    }
    void *place = (unsigned char *)b->data + b->count * size;
    b->count += count;
    return place;
}

void grow_buffer_free(GrowBuffer *b) {
    free(b->data);
    memory_budget_give_back(b->memory, b->capacity);
    *b = (GrowBuffer){0};
}
