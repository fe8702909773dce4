/* The pool: every index once, whoever runs it; cancelling. */
#include "base/pool.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { JOBS = 20000 };

typedef struct Work {
    Pool *pool;
    atomic_int runs[JOBS];
    atomic_int by_worker[16], in_worker[16], overlaps;
    size_t cancel_at;
    atomic_size_t done;
} Work;

static void do_job(void *context, size_t index, int worker) {
    Work *w = context;
    if (atomic_fetch_add(&w->in_worker[worker], 1) != 0) atomic_fetch_add(&w->overlaps, 1); /* one job at a time each */
    atomic_fetch_add(&w->runs[index], 1);
    atomic_fetch_add(&w->by_worker[worker], 1);
    atomic_fetch_add(&w->done, 1);
    if (index == w->cancel_at) pool_cancel(w->pool);
    atomic_fetch_sub(&w->in_worker[worker], 1);
}

static Work *new_work(Pool *pool) {
    Work *w = calloc(1, sizeof *w);
    w->pool = pool;
    w->cancel_at = SIZE_MAX;
    return w;
}

static void every_index_runs_once(void **state) {
    (void)state;
    static const int threads[] = {1, 2, 3, 8};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(threads); k++) {
        Pool *pool = pool_create(threads[k]);
        assert_non_null(pool);
        assert_int_equal(pool_threads(pool), threads[k]);
        static const size_t counts[] = {0, 1, 2, 7, 1000, JOBS};
        for (size_t c = 0; c < VTS_ARRAY_COUNT(counts); c++) { /* again and again: rounds must not mix */
            Work *w = new_work(pool);
            assert_true(pool_run(pool, counts[c], do_job, w));
            for (size_t i = 0; i < JOBS; i++) assert_int_equal(atomic_load(&w->runs[i]), i < counts[c]);
            int total = 0;
            for (int i = 0; i < threads[k]; i++) total += atomic_load(&w->by_worker[i]);
            assert_int_equal(total, counts[c]);
            assert_int_equal(atomic_load(&w->overlaps), 0);
            free(w);
        }
        pool_destroy(pool);
    }
}

static void short_rounds_follow_each_other(void **state) {
    (void)state;
    Pool *pool = pool_create(4);
    Work *w = new_work(pool);
    for (int round = 0; round < 3000; round++) assert_true(pool_run(pool, 3, do_job, w));
    for (size_t i = 0; i < 3; i++) assert_int_equal(atomic_load(&w->runs[i]), 3000);
    free(w);
    pool_destroy(pool);
}

static void cancelling_stops_and_is_forgotten(void **state) {
    (void)state;
    static const int threads[] = {1, 4};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(threads); k++) {
        Pool *pool = pool_create(threads[k]);
        Work *w = new_work(pool);
        w->cancel_at = 100;
        assert_false(pool_run(pool, JOBS, do_job, w));
        for (size_t i = 0; i < JOBS; i++) assert_true(atomic_load(&w->runs[i]) <= 1);
        if (threads[k] == 1) assert_int_equal(atomic_load(&w->done), 101);
        free(w);
        w = new_work(pool);
        pool_cancel(pool); /* between rounds: the next one runs */
        assert_true(pool_run(pool, 50, do_job, w));
        assert_int_equal(atomic_load(&w->done), 50);
        free(w);
        pool_destroy(pool);
    }
}

static void no_pool_runs_in_the_caller(void **state) {
    (void)state;
    Work *w = new_work(NULL);
    assert_true(pool_run(NULL, 10, do_job, w));
    assert_int_equal(atomic_load(&w->by_worker[0]), 10);
    assert_int_equal(pool_threads(NULL), 1);
    pool_cancel(NULL);
    pool_destroy(NULL);
    Pool *all = pool_create(0);
    assert_true(pool_threads(all) >= 1);
    pool_destroy(all);
    free(w);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_index_runs_once),
        cmocka_unit_test(short_rounds_follow_each_other),
        cmocka_unit_test(cancelling_stops_and_is_forgotten),
        cmocka_unit_test(no_pool_runs_in_the_caller),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
