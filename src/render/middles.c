#include "render/middles.h"

#include <pthread.h>
#include <stdlib.h>

enum { NOT_SEEN, BEING_SEEN, SEEN };

typedef struct SharedTile {
    Middle *rows; /* NULL once SEEN: memory was short */
    int state;
    int users; /* tiles that are not finished and may ask */
} SharedTile;

struct Middles {
    int x0, y0, columns, rows;
    pthread_mutex_t lock; /* of all states */
    pthread_cond_t seen;
    SharedTile tiles[];
};

static bool holds(const Middles *m, int x, int y) {
    return x >= m->x0 && y >= m->y0 && x < m->x0 + m->columns && y < m->y0 + m->rows;
}

static SharedTile *tile_at(Middles *m, int x, int y) {
    return holds(m, x, y) ? &m->tiles[(size_t)(y - m->y0) * (size_t)m->columns + (size_t)(x - m->x0)] : NULL;
}

/* Of the numbers [from, to) those that are at most 1 from `at`. */
static int count_near(int at, int from, int to) { return int_min(at + 1, to - 1) - int_max(at - 1, from) + 1; }

Middles *middles_create(TileRange drawn, TileRange asked) {
    size_t count = (size_t)(asked.x1 - asked.x0) * (size_t)(asked.y1 - asked.y0);
    Middles *m = calloc(1, sizeof *m + count * sizeof *m->tiles);
    if (!m) return NULL;
    m->x0 = asked.x0, m->y0 = asked.y0, m->columns = asked.x1 - asked.x0, m->rows = asked.y1 - asked.y0;
    pthread_mutex_init(&m->lock, NULL);
    pthread_cond_init(&m->seen, NULL);
    for (int y = asked.y0; y < asked.y1; y++)
        for (int x = asked.x0; x < asked.x1; x++) tile_at(m, x, y)->users = count_near(x, drawn.x0, drawn.x1) * count_near(y, drawn.y0, drawn.y1);
    return m;
}

void middles_destroy(Middles *m) {
    if (!m) return;
    for (size_t i = 0; i < (size_t)m->columns * (size_t)m->rows; i++) free(m->tiles[i].rows);
    pthread_mutex_destroy(&m->lock);
    pthread_cond_destroy(&m->seen);
    free(m);
}

/* Under the lock, which is given up meanwhile. */
static void see_tile(Middles *m, SharedTile *tile, int x, int y,
                     void (*see)(void *context, int x, int y, Middle *rows), void *context) {
    tile->state = BEING_SEEN;
    pthread_mutex_unlock(&m->lock);
    tile->rows = malloc(sizeof *tile->rows * FILM_TILE * FILM_TILE);
    if (tile->rows) see(context, x, y, tile->rows);
    pthread_mutex_lock(&m->lock);
    tile->state = SEEN;
    pthread_cond_broadcast(&m->seen);
}

const Middle *middles_ask(Middles *m, int x, int y, bool wait,
                          void (*see)(void *context, int x, int y, Middle *rows), void *context) {
    SharedTile *tile = m ? tile_at(m, x, y) : NULL;
    if (!tile) return NULL;
    pthread_mutex_lock(&m->lock);
    if (tile->state == NOT_SEEN) see_tile(m, tile, x, y, see, context);
    while (wait && tile->state != SEEN) pthread_cond_wait(&m->seen, &m->lock);
    const Middle *rows = tile->state == SEEN ? tile->rows : NULL;
    pthread_mutex_unlock(&m->lock);
    return rows;
}

void middles_leave(Middles *m, int x, int y) {
    if (!m) return;
    pthread_mutex_lock(&m->lock);
    for (int k = 0; k < 9; k++) {
        SharedTile *tile = tile_at(m, x + k % 3 - 1, y + k / 3 - 1);
        if (!tile || --tile->users > 0) continue;
        free(tile->rows);
        tile->rows = NULL;
    }
    pthread_mutex_unlock(&m->lock);
}
