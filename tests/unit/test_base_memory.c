/* Arenas, budgets, names, hashes, texts. */
#include "base/hash.h"
#include "base/intern.h"
#include "base/random.h"
#include "base/strbuf.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* ---- arenas ---- */

static void pushes_are_zero_aligned_and_apart(void **state) {
    (void)state;
    RandomStream r = {1};
    Arena arena;
    arena_init(&arena, NULL, 128);
    unsigned char *pieces[500];
    size_t sizes[500];
    for (int i = 0; i < 500; i++) {
        sizes[i] = (size_t)(random_next_unit(&r) * (i % 50 ? 100 : 5000));
        pieces[i] = arena_push(&arena, sizes[i]);
        assert_non_null(pieces[i]);
        assert_int_equal((uintptr_t)pieces[i] % 16, 0);
        for (size_t k = 0; k < sizes[i]; k++) assert_int_equal(pieces[i][k], 0);
        memset(pieces[i], i & 255, sizes[i]);
    }
    for (int i = 0; i < 500; i++) {
        for (size_t k = 0; k < sizes[i]; k++) assert_int_equal(pieces[i][k], i & 255);
        for (int j = 0; j < i; j++) assert_ptr_not_equal(pieces[i], pieces[j]);
    }
    arena_destroy(&arena);
    assert_int_equal(arena.total, 0);
}

static void marks_give_back(void **state) {
    (void)state;
    MemoryBudget budget = {.limit = 0};
    Arena arena;
    arena_init(&arena, &budget, 256);
    char *kept = arena_strdup(&arena, "kept");
    ArenaMark mark = arena_mark(&arena);
    size_t used = atomic_load(&budget.used), settled = 0;
    for (int round = 0; round < 10; round++) {
        for (int i = 0; i < 100; i++) memset(arena_push(&arena, 300), 0xFF, 300);
        assert_true(atomic_load(&budget.used) > used);
        arena_reset_to(&arena, mark);
        if (round == 1) settled = atomic_load(&budget.used); /* one spare block may be kept */
        if (round > 1) assert_int_equal(atomic_load(&budget.used), settled);
        unsigned char *again = arena_push(&arena, 64); /* memory used before is zero again */
        for (int i = 0; i < 64; i++) assert_int_equal(again[i], 0);
        arena_reset_to(&arena, mark);
    }
    assert_string_equal(kept, "kept");
    assert_string_equal(arena_printf(&arena, "%d-%s-%s", 7, "x", "long enough to need a block of its own, surely, when blocks are small"),
                        "7-x-long enough to need a block of its own, surely, when blocks are small");
    arena_destroy(&arena);
    assert_int_equal(atomic_load(&budget.used), 0);
}

/* What is released may be what a mark stands in, what is newest, or neither. */
static void large_pieces_are_given_back(void **state) {
    (void)state;
    enum { LARGE = 4 << 20 };
    MemoryBudget budget = {0};
    Arena arena;
    arena_init(&arena, &budget, 0);
    char *small = arena_strdup(&arena, "small");
    ArenaMark first = arena_mark(&arena);
    char *a = arena_push(&arena, LARGE), *b = arena_push(&arena, LARGE);
    ArenaMark within = arena_mark(&arena);
    char *c = arena_push(&arena, LARGE);
    size_t all = budget.used;
    arena_release(&arena, a, LARGE);
    assert_true(budget.used < all - LARGE);
    arena_release(&arena, b, LARGE); /* the mark's */
    arena_release(&arena, c, LARGE); /* the newest */
    assert_true(budget.used < all - 3 * (size_t)LARGE);
    char *d = arena_push(&arena, 100);
    memset(d, 1, 100);
    arena_reset_to(&arena, within);
    char *e = arena_push(&arena, LARGE);
    memset(e, 2, LARGE);
    arena_release(&arena, small, 6); /* shares its block: stays */
    assert_string_equal(small, "small");
    arena_reset_to(&arena, first);
    assert_true(strcmp(arena_strdup(&arena, "next"), "next") == 0 && strcmp(small, "small") == 0);
    arena_destroy(&arena);
    assert_int_equal(budget.used, 0);
}

static void sole_lists_leave_nothing_behind(void **state) {
    (void)state;
    enum { COUNT = 3000000 };
    MemoryBudget budget = {0};
    Arena arena;
    struct {
        int *items;
        size_t count, capacity;
    } list = {0}, other = {0};
    arena_init(&arena, &budget, 0);
    for (int i = 0; i < COUNT; i++) *list_push_sole(&arena, &list) = *list_push_sole(&arena, &other) = i;
    for (int i = 0; i < COUNT; i++) assert_true(list.items[i] == i && other.items[i] == i);
    assert_true(budget.used < (list.capacity + other.capacity) * sizeof(int) * 5 / 4); /* small beginnings share blocks */
    arena_destroy(&arena);
    assert_int_equal(budget.used, 0);
}

static void lists_grow(void **state) {
    (void)state;
    struct { int *items; size_t count, capacity; } list = {0};
    Arena arena;
    arena_init(&arena, NULL, 0);
    for (int i = 0; i < 10000; i++) *list_push(&arena, &list) = i * i;
    assert_int_equal(list.count, 10000);
    for (int i = 0; i < 10000; i++) assert_int_equal(list.items[i], i * i);
    arena_destroy(&arena);
}

typedef struct Guard {
    jmp_buf back;
    int calls;
} Guard;

static void fall_back(void *context) {
    Guard *guard = context;
    guard->calls++;
    longjmp(guard->back, 1);
}

static void budgets_hold(void **state) {
    (void)state;
    Guard guard = {.calls = 0};
    MemoryBudget budget = {.limit = 100000, .on_exhausted = fall_back, .context = &guard};
    assert_true(memory_budget_take(&budget, 60000));
    assert_false(memory_budget_take(&budget, 40001));
    assert_false(memory_budget_take(&budget, SIZE_MAX - 10)); /* the sum overflows */
    assert_int_equal(atomic_load(&budget.used), 60000);
    assert_true(memory_budget_take(&budget, 40000));
    memory_budget_give_back(&budget, 100000);
    assert_true(memory_budget_take(NULL, SIZE_MAX));
    static Arena arena; /* outlives longjmp */
    arena_init(&arena, &budget, 0);
    if (setjmp(guard.back) == 0) {
        for (;;) arena_push(&arena, 1000);
    }
    assert_int_equal(guard.calls, 1);
    assert_true(atomic_load(&budget.used) <= budget.limit && arena.total <= budget.limit);
    if (setjmp(guard.back) == 0) arena_push_array_(&arena, SIZE_MAX / 4, 8);
    assert_int_equal(guard.calls, 2);
    if (setjmp(guard.back) == 0) arena_push(&arena, SIZE_MAX);
    assert_int_equal(guard.calls, 3);
    arena_destroy(&arena);
    assert_int_equal(atomic_load(&budget.used), 0);
}

/* ---- names ---- */

static void equal_texts_are_one_name(void **state) {
    (void)state;
    Arena arena;
    Interner names;
    arena_init(&arena, NULL, 0);
    interner_init(&names, &arena);
    enum { COUNT = 5000 };
    static Name made[COUNT];
    char text[32];
    for (int i = 0; i < COUNT; i++) {
        snprintf(text, sizeof text, "name%d", i);
        assert_null(intern_find(&names, text, strlen(text)));
        made[i] = intern_cstr(&names, text);
        assert_int_equal(made[i]->id, i);
    }
    for (int i = 0; i < COUNT; i++) {
        snprintf(text, sizeof text, "name%d", i);
        assert_ptr_equal(intern(&names, text, strlen(text)), made[i]);
        assert_ptr_equal(intern_find(&names, text, strlen(text)), made[i]);
        assert_string_equal(made[i]->text, text);
        assert_int_equal(made[i]->size, strlen(text));
    }
    assert_ptr_not_equal(intern(&names, "a\0b", 3), intern(&names, "a\0c", 3)); /* by size, not by terminator */
    assert_ptr_equal(intern(&names, "name1234", 5), intern_cstr(&names, "name1"));
    assert_int_equal(intern_cstr(&names, "")->size, 0);
    arena_destroy(&arena);
}

static void close_words_are_proposed(void **state) {
    (void)state;
    static const char *const words[] = {"pigment", "finish", "texture", "translate", "rotate", "scale", "sphere", "x", "rgb"};
    static const char *const tried[][2] = {
        {"pigmnet", "pigment"}, /* two letters swapped: one edit */
        {"pigmet", "pigment"},     {"piigment", "pigment"}, {"translat", "translate"}, {"shpere", "sphere"}, {"finnish", "finish"},
        {"rotat", "rotate"},       {"pigment", "pigment"},  {"zzzzzz", NULL},          {"light", NULL},      {"", NULL},
        {"y", NULL}, /* one letter is never a typing error of another */
        {"a_word_that_is_longer_than_anything_that_anyone_would_ever_call_a_variable_of_theirs", NULL}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(tried); i++) {
        const char *got = closest_word(tried[i][0], words, VTS_ARRAY_COUNT(words));
        if (tried[i][1]) {
            assert_non_null(got);
            assert_string_equal(got, tried[i][1]);
        } else {
            assert_null(got);
        }
    }
}

/* ---- hashes ---- */

static Hash128 hash_of(const void *data, size_t size) {
    Hash128 h = hash_begin(1);
    hash_add(&h, data, size);
    return h;
}

static void hashes_tell_contents_apart(void **state) {
    (void)state;
    static Hash128 seen[3000];
    unsigned char data[40] = {0};
    size_t n = 0;
    for (size_t size = 0; size <= 40; size++) seen[n++] = hash_of(data, size); /* zeros of all lengths */
    for (int bit = 0; bit < 320; bit++) {                                      /* each bit counts */
        data[bit / 8] = (unsigned char)(1 << bit % 8);
        seen[n++] = hash_of(data, 40);
        data[bit / 8] = 0;
    }
    for (uint64_t i = 1; i < 2000; i++) {
        Hash128 h = hash_begin(2);
        hash_add_u64(&h, i);
        seen[n++] = h;
    }
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++) assert_false(hash_equal(seen[i], seen[j]));
    Hash128 ab = hash_begin(3), ba = hash_begin(3), plus = hash_begin(3), minus = hash_begin(3);
    hash_add(&ab, "ab", 2), hash_add(&ab, "c", 1);
    hash_add(&ba, "a", 1), hash_add(&ba, "bc", 2);
    assert_false(hash_equal(ab, ba));
    hash_add_double(&plus, 0.0), hash_add_double(&minus, -0.0);
    assert_true(hash_equal(plus, minus));
    assert_true(hash_equal(hash_of("same", 4), hash_of("same", 4)));
}

/* A change of one bit turns about half of the bits, in both halves. */
static void hashes_avalanche(void **state) {
    (void)state;
    RandomStream r = {5};
    int turned[128] = {0};
    enum { TRIALS = 2000 };
    for (int i = 0; i < TRIALS; i++) {
        uint64_t word = random_next(&r);
        Hash128 a = hash_of(&word, 8);
        word ^= (uint64_t)1 << i % 64;
        Hash128 b = hash_of(&word, 8);
        for (int k = 0; k < 64; k++) turned[k] += (int)((a.lo ^ b.lo) >> k & 1), turned[64 + k] += (int)((a.hi ^ b.hi) >> k & 1);
    }
    for (int k = 0; k < 128; k++) assert_true(abs(turned[k] - TRIALS / 2) < 6 * 23);
}

/* ---- random numbers ---- */

static void pov_streams_follow_the_recurrence(void **state) {
    (void)state;
    uint32_t s = 0;
    assert_true(fabs(random_pov_next(&s) - 12345.0 / 4294967295.0) < 1e-15);
    uint32_t expected = (uint32_t)(12345ull * 1812433253ull + 12345ull);
    random_pov_next(&s);
    assert_int_equal(s, expected);
    RandomStream r = {1};
    double sum = 0, square = 0;
    for (int i = 0; i < 100000; i++) {
        double x = random_next_unit(&r);
        assert_true(x >= 0 && x < 1);
        sum += x, square += x * x;
    }
    assert_true(fabs(sum / 1e5 - .5) < .004 && fabs(square / 1e5 - 1.0 / 3) < .004);
    assert_true(random_unit(UINT64_MAX) < 1 && random_unitf(UINT64_MAX) < 1);
}

/* ---- texts ---- */

static void texts_grow_and_quote(void **state) {
    (void)state;
    StrBuf b = {0};
    strbuf_addf(&b, "%s=%d", "a", 3);
    strbuf_repeat(&b, '.', 5);
    strbuf_addc(&b, '!');
    assert_string_equal(b.data, "a=3.....!");
    assert_int_equal(b.size, 9);
    for (int i = 0; i < 1000; i++) strbuf_adds(&b, "0123456789");
    assert_int_equal(b.size, 10009);
    assert_int_equal(strlen(b.data), b.size);
    strbuf_clear(&b);
    assert_string_equal(b.data, "");
    strbuf_add_json(&b, "a\"b\\c\n\t\001/é");
    assert_string_equal(b.data, "\"a\\\"b\\\\c\\u000a\\u0009\\u0001/é\"");
    strbuf_free(&b);
    assert_null(b.data);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pushes_are_zero_aligned_and_apart), cmocka_unit_test(marks_give_back),
        cmocka_unit_test(large_pieces_are_given_back),       cmocka_unit_test(sole_lists_leave_nothing_behind),
        cmocka_unit_test(lists_grow),                        cmocka_unit_test(budgets_hold),
        cmocka_unit_test(equal_texts_are_one_name),          cmocka_unit_test(close_words_are_proposed),
        cmocka_unit_test(hashes_tell_contents_apart),        cmocka_unit_test(hashes_avalanche),
        cmocka_unit_test(pov_streams_follow_the_recurrence), cmocka_unit_test(texts_grow_and_quote),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
