#include "base/intern.h"

#include <string.h>
#include <strings.h>

static uint32_t text_hash(const char *text, size_t size) {
    uint32_t h = 2166136261u; /* FNV-1a */
    for (size_t i = 0; i < size; i++) h = (h ^ (unsigned char)text[i]) * 16777619u;
    return h;
}

void interner_init(Interner *interner, Arena *arena) {
    *interner = (Interner){.arena = arena, .slot_count = 1024};
    interner->slots = arena_new_array(arena, NameEntry *, interner->slot_count);
}

static NameEntry **find_slot(const Interner *interner, const char *text, size_t size, uint32_t hash) {
    uint32_t mask = interner->slot_count - 1;
    for (uint32_t i = hash & mask;; i = (i + 1) & mask) {
        NameEntry *e = interner->slots[i];
        if (!e || (e->hash == hash && e->size == size && memcmp(e->text, text, size) == 0))
            return &interner->slots[i];
    }
}

static void grow(Interner *interner) {
    NameEntry **old = interner->slots;
    uint32_t old_count = interner->slot_count;
    interner->slot_count *= 2;
    interner->slots = arena_new_array(interner->arena, NameEntry *, interner->slot_count);
    for (uint32_t i = 0; i < old_count; i++)
        if (old[i]) *find_slot(interner, old[i]->text, old[i]->size, old[i]->hash) = old[i];
}

Name intern(Interner *interner, const char *text, size_t size) {
    uint32_t hash = text_hash(text, size);
    NameEntry **slot = find_slot(interner, text, size, hash);
    if (*slot) return *slot;
    NameEntry *entry = arena_push(interner->arena, sizeof(NameEntry) + size + 1);
    entry->id = interner->count++;
    entry->size = (uint32_t)size;
    entry->hash = hash;
    memcpy(entry->text, text, size);
    *slot = entry;
    if (interner->count * 2 > interner->slot_count) grow(interner);
    return entry;
}

Name intern_cstr(Interner *interner, const char *text) { return intern(interner, text, strlen(text)); }

Name intern_find(const Interner *interner, const char *text, size_t size) {
    return *find_slot(interner, text, size, text_hash(text, size));
}

enum { LONGEST_COMPARED = 63 };

static size_t edit_distance(const char *a, size_t m, const char *b, size_t n) {
    size_t row[3][LONGEST_COMPARED + 1];
    for (size_t j = 0; j <= n; j++) row[0][j] = j;
    for (size_t i = 1; i <= m; i++) {
        size_t *now = row[i % 3], *above = row[(i + 2) % 3], *above2 = row[(i + 1) % 3];
        now[0] = i;
        for (size_t j = 1; j <= n; j++) {
            size_t replaced = above[j - 1] + (a[i - 1] != b[j - 1]);
            now[j] = size_min(replaced, size_min(above[j], now[j - 1]) + 1);
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                now[j] = size_min(now[j], above2[j - 2] + 1);
        }
    }
    return row[m % 3][n];
}

const char *closest_word(const char *text, const char *const *candidates, size_t count) {
    size_t size = strlen(text);
    if (size == 0 || size > LONGEST_COMPARED) return NULL;
    size_t best = size / 3 + 1;
    if (size < 3) best = 1;
    const char *closest = NULL;
    for (size_t i = 0; i < count; i++)
        if (strcasecmp(text, candidates[i]) == 0) return candidates[i];
    for (size_t i = 0; i < count; i++) {
        size_t n = strlen(candidates[i]);
        if (n > LONGEST_COMPARED || (n > size ? n - size : size - n) >= best) continue;
        size_t distance = edit_distance(text, size, candidates[i], n);
        if (distance < best) {
            best = distance;
            closest = candidates[i];
        }
    }
    return closest;
}
