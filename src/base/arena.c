#include "base/arena.h"

#include "base/decimal.h"

#include <stdlib.h>
#include <string.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

enum { ALIGNMENT = 16, DEFAULT_BLOCK = 1 << 16, LARGEST_DOUBLED_BLOCK = 1 << 20 };

struct ArenaBlock {
    ArenaBlock *older;
    size_t size; /* bytes of data[] */
    uint64_t number;
    _Alignas(ALIGNMENT) unsigned char data[];
};

bool memory_budget_take(MemoryBudget *budget, size_t size) {
    if (!budget) return true;
    size_t before = atomic_fetch_add(&budget->used, size);
    if (budget->limit == 0 || (before + size >= before && before + size <= budget->limit)) return true;
    atomic_fetch_sub(&budget->used, size);
    return false;
}

void memory_budget_give_back(MemoryBudget *budget, size_t size) {
    if (budget) atomic_fetch_sub(&budget->used, size);
}

void memory_budget_fail(MemoryBudget *budget) {
    if (budget && budget->on_exhausted) budget->on_exhausted(budget->context);
    abort(); /* no owner took the failure: nothing sensible can go on */
}

void arena_init(Arena *arena, MemoryBudget *budget, size_t block_size) {
    *arena = (Arena){.budget = budget, .block_size = block_size ? block_size : DEFAULT_BLOCK};
}

static void release_block(Arena *arena, ArenaBlock *block) {
    size_t bytes = sizeof(ArenaBlock) + block->size;
    arena->total -= bytes;
    memory_budget_give_back(arena->budget, bytes);
    free(block);
}

void arena_destroy(Arena *arena) {
    arena_reset_to(arena, (ArenaMark){0, 0});
    if (arena->spare) release_block(arena, arena->spare);
    arena->spare = NULL;
}

static void put_newest(Arena *arena, ArenaBlock *block) {
    block->older = arena->block;
    block->number = arena->newest = ++arena->blocks;
    arena->block = block;
    arena->used = 0;
}

/* The one before the newest is the newest again, and full: what is left of it nobody knows any more. */
static ArenaBlock *take_newest(Arena *arena) {
    ArenaBlock *block = arena->block;
    arena->block = block->older;
    arena->newest = arena->block ? arena->block->number : 0;
    arena->used = arena->block ? arena->block->size : 0;
    return block;
}

static bool take_spare(Arena *arena, size_t at_least) {
    ArenaBlock *block = arena->spare;
    if (!block || block->size < at_least) return false;
    arena->spare = NULL;
    put_newest(arena, block);
    return true;
}

/* Whether its memory is known to be zero: what is made for one large piece comes so from the system, page by page as it is touched. */
static bool add_block(Arena *arena, size_t at_least, bool zeroes) {
    if (take_spare(arena, at_least)) return false;
    bool zeroed = zeroes && at_least > arena->block_size;
    size_t size = size_max(at_least, arena->block_size);
    if (size > SIZE_MAX - sizeof(ArenaBlock)) memory_budget_fail(arena->budget);
    size_t bytes = sizeof(ArenaBlock) + size;
    if (!memory_budget_take(arena->budget, bytes)) memory_budget_fail(arena->budget);
    ArenaBlock *block = zeroed ? calloc(1, bytes) : malloc(bytes);
    if (!block) {
        memory_budget_give_back(arena->budget, bytes);
        memory_budget_fail(arena->budget);
    }
    block->size = size;
    put_newest(arena, block);
    arena->total += bytes;
    if (arena->block_size < LARGEST_DOUBLED_BLOCK) arena->block_size *= 2;
    return zeroed;
}

/* *zeroed: whether zeroes are wanted, and then whether they are there. */
static void *push(Arena *arena, size_t size, bool *zeroed) {
    if (size > SIZE_MAX - ALIGNMENT) memory_budget_fail(arena->budget);
    size_t rounded = size == 0 ? ALIGNMENT : (size + ALIGNMENT - 1) & ~(size_t)(ALIGNMENT - 1);
    bool full = !arena->block || arena->block->size - arena->used < rounded;
    *zeroed = full && add_block(arena, rounded, *zeroed);
    void *result = arena->block->data + arena->used;
    arena->used += rounded;
    return result;
}

void *arena_push(Arena *arena, size_t size) {
    bool zeroed = true;
    void *result = push(arena, size, &zeroed);
    return zeroed ? result : memset(result, 0, size);
}

static size_t size_of_array(Arena *arena, size_t count, size_t size) {
    if (size != 0 && count > SIZE_MAX / size) memory_budget_fail(arena->budget);
    return count * size;
}

void *arena_push_array_(Arena *arena, size_t count, size_t size) { return arena_push(arena, size_of_array(arena, count, size)); }

void *arena_push_room_(Arena *arena, size_t count, size_t size) {
    bool zeroed = false;
    return push(arena, size_of_array(arena, count, size), &zeroed);
}

void *arena_copy(Arena *arena, const void *data, size_t size) {
    void *copy = arena_push(arena, size);
    if (size) memcpy(copy, data, size);
    return copy;
}

char *arena_strdup(Arena *arena, const char *text) { return arena_copy(arena, text, strlen(text) + 1); }

char *arena_vprintf(Arena *arena, const char *format, va_list args) {
    va_list again;
    va_copy(again, args);
    int length = decimal_vsnprintf(NULL, 0, format, args);
    size_t size = length < 0 ? 1 : (size_t)length + 1;
    char *text = arena_push(arena, size);
    if (length >= 0) decimal_vsnprintf(text, size, format, again);
    va_end(again);
    return text;
}

char *arena_printf(Arena *arena, const char *format, ...) {
    va_list args;
    va_start(args, format);
    char *text = arena_vprintf(arena, format, args);
    va_end(args);
    return text;
}

void arena_drop_blocks(Arena *arena, ArenaMark mark) {
    while (arena->newest > mark.block) {
        ArenaBlock *block = take_newest(arena);
        if (!arena->spare && block->size <= LARGEST_DOUBLED_BLOCK) arena->spare = block;
        else release_block(arena, block);
    }
    if (arena->newest == mark.block) arena->used = mark.used; /* else that block was released */
}

static size_t rounded(size_t size) { return (size + ALIGNMENT - 1) & ~(size_t)(ALIGNMENT - 1); }

/* What was pushed last grows where it is, if its block has room. */
static bool extend(Arena *arena, void *items, size_t size, size_t wanted) {
    if (!items) return false;
    char *end = (char *)items + rounded(size);
    if (end != (char *)arena->block->data + arena->used) return false;
    size_t more = rounded(wanted) - rounded(size);
    if (arena->block->size - arena->used < more) return false;
    memset(end, 0, more);
    arena->used += more;
    return true;
}

void arena_list_grow_(Arena *arena, void **items, size_t *capacity, size_t count, size_t item_size) {
    size_t grown = *capacity ? *capacity * 2 : 8;
    if (grown < *capacity || grown > SIZE_MAX / 2 / item_size) memory_budget_fail(arena->budget);
    if (arena->block && extend(arena, *items, *capacity * item_size, grown * item_size)) {
        *capacity = grown;
        return;
    }
    void *copy = arena_push_array_(arena, grown, item_size);
    if (count) memcpy(copy, *items, count * item_size);
    *items = copy;
    *capacity = grown;
}

void arena_release(Arena *arena, const void *piece, size_t size) {
    if (!piece || rounded(size) < DEFAULT_BLOCK) return; /* not worth a search */
    ArenaBlock **link = &arena->block;
    while (*link && (*link)->data != (const unsigned char *)piece) link = &(*link)->older;
    ArenaBlock *block = *link;
    if (!block || block->size != rounded(size)) return;
    if (block == arena->block) take_newest(arena);
    else *link = block->older;
    release_block(arena, block);
}

void arena_list_move_(Arena *arena, void **items, size_t *capacity, size_t count, size_t item_size) {
    const void *before = *items;
    size_t size = *capacity * item_size;
    arena_list_grow_(arena, items, capacity, count, item_size);
    if (before != *items) arena_release(arena, before, size);
}

void memory_trim(void) {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}
