/* Arenas: memory by lifetime. What is pushed lives until the arena is reset to an earlier mark or destroyed;
 * single objects are never freed. An arena is used by one thread at a time.
 *
 * Running out of memory: the arena asks its MemoryBudget. When the budget's limit would be passed, or malloc
 * fails, the budget's `on_exhausted` is called; it must not return (vts.c sets one that longjmps to the entry
 * point, which destroys all arenas). So no caller of arena_push() tests for NULL. */
#ifndef VTS_BASE_ARENA_H
#define VTS_BASE_ARENA_H

#include "base/common.h"

#include <stdarg.h>
#include <stdatomic.h>

typedef struct MemoryBudget {
    atomic_size_t used;                     /* bytes handed out through this budget */
    size_t limit;                           /* bytes; 0 = no limit */
    void (*on_exhausted)(void *context);    /* must not return; NULL: abort() */
    void *context;
} MemoryBudget;

/* Takes `size` bytes out of the budget; false when that would pass the limit. A NULL budget is unlimited. */
bool memory_budget_take(MemoryBudget *budget, size_t size);
void memory_budget_give_back(MemoryBudget *budget, size_t size);
/* Calls on_exhausted. */
VTS_NORETURN void memory_budget_fail(MemoryBudget *budget);

typedef struct ArenaBlock ArenaBlock;

typedef struct Arena {
    ArenaBlock *block;    /* newest block, linked to older ones */
    ArenaBlock *spare;    /* kept from the last reset, so that one that crosses a block's edge again and again costs nothing; or NULL */
    uint64_t newest;      /* the number of the newest block, 0 of none: later ones have larger numbers */
    uint64_t blocks;      /* how many there have ever been */
    size_t used;          /* bytes used in the newest block */
    size_t total;         /* bytes held by all blocks */
    size_t block_size;    /* size of the next ordinary block */
    MemoryBudget *budget; /* may be NULL */
} Arena;

typedef struct ArenaMark {
    uint64_t block; /* its number */
    size_t used;
} ArenaMark;

/* An empty arena; allocates nothing yet. block_size 0 = 64 KiB, doubled up to 1 MiB as it grows. */
void arena_init(Arena *arena, MemoryBudget *budget, size_t block_size);
void arena_destroy(Arena *arena);

/* `size` zeroed bytes, aligned for any type (16). size 0 gives a unique non-NULL address. */
void *arena_push(Arena *arena, size_t size);
/* count * size, checked for overflow. */
void *arena_push_array_(Arena *arena, size_t count, size_t size);
#define arena_new(arena, Type)          ((Type *)arena_push((arena), sizeof(Type)))
#define arena_new_array(arena, Type, n) ((Type *)arena_push_array_((arena), (n), sizeof(Type)))
/* Room for an array of which nothing is read before it is written: the bytes may be anything. What of a large one is never written takes no memory. */
void *arena_push_room_(Arena *arena, size_t count, size_t size);
#define arena_new_room(arena, Type, n)  ((Type *)arena_push_room_((arena), (n), sizeof(Type)))

/* A copy of `size` bytes; of a string with its terminator. */
void *arena_copy(Arena *arena, const void *data, size_t size);
char *arena_strdup(Arena *arena, const char *text);
/* Text with decimal points, whatever locale a host program has set. */
char *arena_vprintf(Arena *arena, const char *format, va_list args);
char *arena_printf(Arena *arena, const char *format, ...) VTS_PRINTF(2, 3);

static inline ArenaMark arena_mark(const Arena *arena) { return (ArenaMark){arena->newest, arena->used}; }
/* Gives back what was pushed since the mark, which is in a block that is not the newest any more. */
void arena_drop_blocks(Arena *arena, ArenaMark mark);
static inline void arena_reset_to(Arena *arena, ArenaMark mark) {
    if (arena->newest != mark.block) arena_drop_blocks(arena, mark);
    else arena->used = mark.used;
}

/* Gives back what was pushed as one large piece of `size` bytes, if it has a block to itself: nobody may use it any more. Else nothing happens. */
void arena_release(Arena *arena, const void *piece, size_t size);
/* Hands back to the system what malloc keeps of blocks that were given back: after much more than what will be needed again. */
void memory_trim(void);

/* Growing arrays in an arena: `items`, `count`, `capacity` fields of any struct.
 *   typedef struct { Foo *items; size_t count, capacity; } FooList;
 *   *list_push(arena, &list) = foo;                                                     */
void arena_list_grow_(Arena *arena, void **items, size_t *capacity, size_t count, size_t item_size);
#define list_push(arena, list)                                                                              \
    ((list)->count < (list)->capacity                                                                       \
         ? (void)0                                                                                          \
         : arena_list_grow_((arena), (void **)&(list)->items, &(list)->capacity, (list)->count,             \
                            sizeof(*(list)->items)),                                                        \
     &(list)->items[(list)->count++])

/* The same for a list that nobody else points into: what it grows out of is given back where that is possible. */
void arena_list_move_(Arena *arena, void **items, size_t *capacity, size_t count, size_t item_size);
#define list_push_sole(arena, list)                                                                         \
    ((list)->count < (list)->capacity                                                                       \
         ? (void)0                                                                                          \
         : arena_list_move_((arena), (void **)&(list)->items, &(list)->capacity, (list)->count,             \
                            sizeof(*(list)->items)),                                                        \
     &(list)->items[(list)->count++])

#endif
