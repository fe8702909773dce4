#include "render/film.h"

#include <math.h>
#include <pthread.h>

enum { TILE = 16 };

typedef struct Film {
    const RenderOptions *options;
    const char *stage;
    FilmPixel *pixel;
    void *context;
    Image *image;
    int tiles_x, tiles_y;
    float gain;
    atomic_size_t done;
    pthread_mutex_t progress_lock;
} Film;

static void expose_tile(void *context, size_t index, int worker) {
    Film *film = context;
    const RenderOptions *options = film->options;
    if (options->interrupted && *options->interrupted) return;
    int tx = (int)(index % (size_t)film->tiles_x), ty = (int)(index / (size_t)film->tiles_x);
    int x0 = options->region[0] + tx * TILE, y0 = options->region[1] + ty * TILE;
    int x1 = int_min(x0 + TILE, options->region[2]), y1 = int_min(y0 + TILE, options->region[3]);
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1 && !(options->interrupted && *options->interrupted); x++) {
            Radiance r = film->pixel(film->context, worker, x, y);
            float *sample = image_pixel(film->image, x - options->region[0], y - options->region[1]);
            sample[0] = r.color.x * film->gain;
            sample[1] = r.color.y * film->gain;
            sample[2] = r.color.z * film->gain;
            if (options->alpha) sample[3] = r.alpha;
        }
    size_t done = atomic_fetch_add(&film->done, 1) + 1;
    pthread_mutex_lock(&film->progress_lock);
    progress_update(options->progress, film->stage, done, (size_t)film->tiles_x * (size_t)film->tiles_y);
    pthread_mutex_unlock(&film->progress_lock);
}

bool film_expose(const RenderOptions *options, const char *stage, FilmPixel *pixel, void *context, MemoryBudget *memory, Image *out,
                 StrBuf *error) {
    int width = options->region[2] - options->region[0], height = options->region[3] - options->region[1];
    if (!image_init(out, width, height, options->alpha ? 4 : 3, NULL, memory, error)) return false;
    Film film = {.options = options, .stage = stage, .pixel = pixel, .context = context, .image = out, .gain = (float)exp2(options->exposure),
                 .tiles_x = (width + TILE - 1) / TILE, .tiles_y = (height + TILE - 1) / TILE};
    pthread_mutex_init(&film.progress_lock, NULL);
    bool done = pool_run(options->pool, (size_t)film.tiles_x * (size_t)film.tiles_y, expose_tile, &film);
    pthread_mutex_destroy(&film.progress_lock);
    if (!done) image_free(out);
    return done;
}
