/* Middles of tiles that samplers share. */
#include "render/middles.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

/* The tiles that are asked for: those that are drawn, and those around them in a picture that ends at the right. */
enum { COLUMNS = 5, ROWS = 4, X0 = 2, Y0 = 7, WORKERS = 4 };
enum { DRAWN_COLUMNS = COLUMNS - 1, DRAWN_ROWS = ROWS - 2 };

typedef struct Counts {
    atomic_int seen[ROWS][COLUMNS];
    atomic_size_t next;
    atomic_int wrong;
    Middles *middles;
} Counts;

static void see(void *context, int x, int y, Middle *rows) {
    Counts *c = context;
    atomic_fetch_add(&c->seen[y - Y0][x - X0], 1);
    for (int i = 0; i < FILM_TILE * FILM_TILE; i++) rows[i] = (Middle){.object = (uint32_t)(100 * y + x)};
}

/* Asks for all around, as a sampler does, reads them all, and leaves. */
static void finish_tile(Counts *c, int x, int y) {
    const Middle *around[9];
    for (int wait = 0; wait < 2; wait++)
        for (int k = 0; k < 9; k++)
            around[k] = middles_ask(c->middles, x + k % 3 - 1, y + k / 3 - 1, wait, see, c);
    for (int k = 0; k < 9; k++) {
        int nx = x + k % 3 - 1, ny = y + k / 3 - 1;
        bool within = nx >= X0 && ny >= Y0 && nx < X0 + COLUMNS && ny < Y0 + ROWS;
        if ((around[k] != NULL) != within) atomic_fetch_add(&c->wrong, 1);
        if (around[k] && around[k][FILM_TILE * FILM_TILE - 1].object != (uint32_t)(100 * ny + nx))
            atomic_fetch_add(&c->wrong, 1);
    }
    middles_leave(c->middles, x, y);
}

static void *work(void *context) {
    Counts *c = context;
    for (size_t i; (i = atomic_fetch_add(&c->next, 1)) < DRAWN_COLUMNS * DRAWN_ROWS;)
        finish_tile(c, X0 + 1 + (int)(i % DRAWN_COLUMNS), Y0 + 1 + (int)(i / DRAWN_COLUMNS));
    return NULL;
}

static void test_each_tile_is_seen_once(void **state) {
    (void)state;
    for (int workers = 1; workers <= WORKERS; workers += WORKERS - 1) {
        Counts c = {.middles = middles_create((TileRange){X0 + 1, Y0 + 1, X0 + COLUMNS, Y0 + ROWS - 1}, (TileRange){X0, Y0, X0 + COLUMNS, Y0 + ROWS})};
        pthread_t threads[WORKERS];
        assert_non_null(c.middles);
        for (int i = 0; i < workers; i++) assert_int_equal(pthread_create(&threads[i], NULL, work, &c), 0);
        for (int i = 0; i < workers; i++) pthread_join(threads[i], NULL);
        assert_int_equal(c.wrong, 0);
        for (int y = 0; y < ROWS; y++)
            for (int x = 0; x < COLUMNS; x++) assert_int_equal(c.seen[y][x], 1);
        middles_destroy(c.middles);
    }
}

static void test_nothing_is_shared_without_them(void **state) {
    (void)state;
    Counts c = {.middles = NULL};
    assert_null(middles_ask(NULL, X0, Y0, true, see, &c));
    middles_leave(NULL, X0, Y0);
    middles_destroy(NULL);
    assert_int_equal(c.seen[0][0], 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_each_tile_is_seen_once),
                                       cmocka_unit_test(test_nothing_is_shared_without_them)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
