/* Interned strings: equal text gives the same Name, so that names compare and index by identity. */
#ifndef VTS_BASE_INTERN_H
#define VTS_BASE_INTERN_H

#include "base/arena.h"

typedef struct NameEntry {
    uint32_t id;   /* 0, 1, 2 … in order of first interning: an index for tables */
    uint32_t size; /* bytes of text without the terminator */
    uint32_t hash;
    char text[];   /* NUL-terminated */
} NameEntry;
typedef const NameEntry *Name;

typedef struct Interner {
    Arena *arena; /* owns the entries */
    NameEntry **slots;
    uint32_t slot_count; /* a power of two */
    uint32_t count;
} Interner;

/* `arena` must outlive all names. */
void interner_init(Interner *interner, Arena *arena);
Name intern(Interner *interner, const char *text, size_t size);
Name intern_cstr(Interner *interner, const char *text);
/* The name if `text` was interned before, else NULL. */
Name intern_find(const Interner *interner, const char *text, size_t size);

/* The candidate nearest to `text` in edit distance (Damerau-Levenshtein), if near enough to be a likely typing
 * error (at most a third of its length, or other capitals), else NULL: for "did you mean" hints. */
const char *closest_word(const char *text, const char *const *candidates, size_t count);

#endif
