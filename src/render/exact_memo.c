#include "render/exact_memo.h"

#include "base/hash.h"
#include "render/exact_texel.h"

#include <stdlib.h>

enum { MOST_KEPT = 32 };
static const size_t MOST_TRIANGLES_KEPT = 6000000;

struct ExactMemo {
    Arena arena;
    MemoryBudget *memory;
    struct Kept {
        Hash128 key;
        struct ExactTexel *exact;
    } kept[MOST_KEPT];
    size_t count, triangles;
};

ExactMemo *exact_memo_create(MemoryBudget *memory) {
    ExactMemo *memo = calloc(1, sizeof *memo);
    if (!memo) return NULL;
    memo->memory = memory;
    arena_init(&memo->arena, memory, 0);
    return memo;
}

void exact_memo_clear(ExactMemo *memo) {
    if (!memo) return;
    arena_destroy(&memo->arena);
    arena_init(&memo->arena, memo->memory, 0);
    memo->count = memo->triangles = 0;
}

void exact_memo_destroy(ExactMemo *memo) {
    if (memo) arena_destroy(&memo->arena);
    free(memo);
}

void exact_memo_begin(ExactMemo *memo) {
    if (memo && (memo->count == MOST_KEPT || memo->triangles > MOST_TRIANGLES_KEPT / 2)) exact_memo_clear(memo);
}

static Hash128 key_of(const BuiltTexel *texel, const ExactMaking *how) {
    Hash128 key = hash_begin(71);
    hash_add_hash(&key, texel->def->hash);
    hash_add_double(&key, how->tolerance);
    hash_add_u64(&key, how->flakes);
    return key;
}

bool exact_memo_build(ExactMemo *memo, BuiltTexel *texel, const ExactMaking *how, CompiledScene *compiled, DiagList *diags) {
    if (!memo || memo->count == MOST_KEPT) return exact_build_texel(texel, how, compiled, diags);
    const Hash128 key = key_of(texel, how);
    for (size_t i = 0; i < memo->count; i++)
        if (hash_equal(memo->kept[i].key, key)) {
            texel->exact = memo->kept[i].exact;
            return texel->exact && exact_texel_triangles(texel->exact) <= how->most;
        }
    ExactMaking own = *how;
    own.arena = &memo->arena;
    ArenaMark mark = arena_mark(&memo->arena);
    bool made = exact_build_texel(texel, &own, compiled, diags);
    if (made) memo->triangles += exact_texel_triangles(texel->exact);
    else arena_reset_to(&memo->arena, mark), texel->exact = NULL;
    memo->kept[memo->count++] = (struct Kept){key, texel->exact}; /* what has too many is not tried again */
    return made;
}
