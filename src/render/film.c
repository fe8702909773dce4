#include "render/film.h"

#include "base/gamma.h"
#include "render/preview.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

typedef struct Film {
    const RenderOptions *options;
    const char *stage;
    FilmTile *tile;
    void *context;
    Image *image;
    AovSum *aovs; /* of the tiles that the workers see */
    int tiles_x, tiles_y;
    float gain;
    double gamma; /* of what is seen */
    atomic_size_t done;
    pthread_mutex_t progress_lock;
} Film;

/* Light. */
static inline float exposed(const Film *film, float seen) {
    return (film->gamma == 1 ? seen : (float)gamma_to_light((double)seen, film->gamma)) * film->gain;
}

/* Part of the picture, [x0, x1) × [y0, y1) of the whole. */
typedef struct Place {
    int x0, y0, x1, y1;
} Place;

/* Tiles lie at multiples of their size, whatever the region. */
static Place place_of(const Film *film, size_t index) {
    const int *region = film->options->region;
    int tx = (int)(index % (size_t)film->tiles_x), ty = (int)(index / (size_t)film->tiles_x);
    int x0 = (region[0] / FILM_TILE + tx) * FILM_TILE, y0 = (region[1] / FILM_TILE + ty) * FILM_TILE;
    return (Place){int_max(x0, region[0]), int_max(y0, region[1]), int_min(x0 + FILM_TILE, region[2]), int_min(y0 + FILM_TILE, region[3])};
}

static void see(Film *film, Place p, int worker) {
    const RenderOptions *options = film->options;
    Radiance seen[FILM_TILE * FILM_TILE];
    AovSum *aovs = film->aovs ? film->aovs + (size_t)worker * FILM_TILE * FILM_TILE : NULL;
    if (aovs) memset(aovs, 0, sizeof *aovs * FILM_TILE * FILM_TILE);
    film->tile(film->context, worker, p.x0, p.y0, p.x1, p.y1, seen, aovs);
    const Radiance *r = seen;
    for (int y = p.y0; y < p.y1; y++) {
        float *sample = image_pixel(film->image, p.x0 - options->region[0], y - options->region[1]);
        for (int x = p.x0; x < p.x1; x++, r++, sample += film->image->channels) {
            sample[0] = exposed(film, r->color.x);
            sample[1] = exposed(film, r->color.y);
            sample[2] = exposed(film, r->color.z);
            if (options->alpha) sample[3] = r->alpha;
            if (aovs) aov_write(options->aovs, &aovs[r - seen], r->alpha, sample + (options->alpha ? 4 : 3));
        }
    }
}

/* Between the tile's rows in the picture and `samples`. */
static void copy_tile(const Film *film, Place p, float *samples, bool into_picture) {
    size_t row = (size_t)(p.x1 - p.x0) * (size_t)film->image->channels;
    for (int y = p.y0; y < p.y1; y++, samples += row) {
        float *pixels = image_pixel(film->image, p.x0 - film->options->region[0], y - film->options->region[1]);
        memcpy(into_picture ? pixels : samples, into_picture ? samples : pixels, row * sizeof *samples);
    }
}

/* Sees what no other run has seen. Pixels after an interruption are black, and not kept. */
static void see_or_take(Film *film, size_t index, Place p, int worker) {
    const RenderOptions *options = film->options;
    float *noise = options->tile_noise ? &options->tile_noise[index] : NULL; /* is kept behind the samples */
    size_t count = (size_t)(p.x1 - p.x0) * (size_t)(p.y1 - p.y0) * (size_t)film->image->channels + (noise != NULL);
    float *samples = options->kept ? malloc(count * sizeof *samples) : NULL;
    if (samples && tile_file_read(options->kept, (uint32_t)index, samples, count)) {
        copy_tile(film, p, samples, true);
        if (noise) *noise = samples[count - 1];
    } else {
        see(film, p, worker);
        if (samples) copy_tile(film, p, samples, false);
        if (samples && noise) samples[count - 1] = *noise;
        if (samples && !(options->interrupted && *options->interrupted)) tile_file_write(options->kept, (uint32_t)index, samples, count);
    }
    free(samples);
}

static void expose_tile(void *context, size_t index, int worker) {
    Film *film = context;
    const RenderOptions *options = film->options;
    if ((options->interrupted && *options->interrupted) || (options->tiles && !options->tiles[index])) return;
    Place p = place_of(film, index);
    see_or_take(film, index, p, worker);
    if (options->preview)
        preview_tile(options->preview, p.x0 - options->region[0], p.y0 - options->region[1], p.x1 - options->region[0], p.y1 - options->region[1]);
    size_t done = atomic_fetch_add(&film->done, 1) + 1;
    pthread_mutex_lock(&film->progress_lock);
    progress_update(options->progress, film->stage, done, (size_t)film->tiles_x * (size_t)film->tiles_y);
    pthread_mutex_unlock(&film->progress_lock);
}

int film_channels(bool alpha, const AovPlan *aovs, const char *names[FILM_MOST_CHANNELS]) {
    static const char *const light[] = {"R", "G", "B", "A"};
    int count = alpha ? 4 : 3;
    memcpy(names, light, sizeof light);
    for (int i = 0; aovs && i < aovs->channels; i++) names[count++] = aovs->names[i];
    return count;
}

static bool init_image(const RenderOptions *options, MemoryBudget *memory, Image *out, StrBuf *error) {
    const char *names[FILM_MOST_CHANNELS];
    int width = options->region[2] - options->region[0], height = options->region[3] - options->region[1];
    return image_init(out, width, height, film_channels(options->alpha, options->aovs, names), names, memory, error);
}

bool film_expose(const RenderOptions *options, double gamma, const char *stage, FilmTile *tile, void *context, MemoryBudget *memory, Image *out,
                 StrBuf *error) {
    if (!init_image(options, memory, out, error)) return false;
    Film film = {.options = options, .stage = stage, .tile = tile, .context = context, .image = out, .gain = (float)exp2(options->exposure), .gamma = gamma,
                 .tiles_x = film_tiles_x(options->region), .tiles_y = film_tiles_y(options->region)};
    if (options->aovs) film.aovs = calloc((size_t)pool_threads(options->pool) * FILM_TILE * FILM_TILE, sizeof *film.aovs);
    if (options->aovs && !film.aovs) {
        image_free(out);
        return false;
    }
    if (options->preview) preview_begin(options->preview, options->name, out, film.tiles_x * film.tiles_y);
    pthread_mutex_init(&film.progress_lock, NULL);
    bool done = pool_run(options->pool, (size_t)film.tiles_x * (size_t)film.tiles_y, expose_tile, &film);
    pthread_mutex_destroy(&film.progress_lock);
    free(film.aovs);
    if (options->preview) preview_end(options->preview, !done || (options->interrupted && *options->interrupted));
    if (!done) image_free(out);
    return done;
}
