/* One worker pool: jobs are numbered, taken from a counter, and must not depend on who runs them. */
#ifndef VTS_BASE_POOL_H
#define VTS_BASE_POOL_H

#include "base/common.h"

typedef struct Pool Pool;

/* `threads` workers in all, the caller of pool_run() being one of them; 0 = one for each processor. NULL when threads
 * cannot be made. */
Pool *pool_create(int threads);
void pool_destroy(Pool *pool);
int pool_threads(const Pool *pool);

/* Runs job(context, index, worker) for every index in [0, count); worker in [0, pool_threads). Returns when all are done,
 * false if pool_cancel() stopped it early. Not reentrant: jobs must not call pool_run(). A NULL pool runs in the caller. */
bool pool_run(Pool *pool, size_t count, void (*job)(void *context, size_t index, int worker), void *context);
/* From any thread or a signal handler: no further job starts, until the next pool_run(). */
void pool_cancel(Pool *pool);

#endif
