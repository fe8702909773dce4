#include "vts_moments.h"

#include "base/vec.h"

#include <math.h>
#include <string.h>

/* A block of pixels may be off by so many times the error that is accepted of a tile. */
static const double MOST_IN_BLOCK = 3;

MomentPlace moment_place(int number) {
    if (number < 2) return (MomentPlace){.index = number, .moment = number};
    int intervals = 1;
    while (2 * intervals <= number - 1) intervals *= 2;
    int index = number - 1 - intervals;
    return (MomentPlace){intervals, index, (index + 0.5) / intervals};
}

void moment_mean_lay(MomentMean *m, int width, int height, Arena *arena) {
    m->width = width, m->height = height;
    m->tiles_x = (m->x0 + width - 1) / m->tile - m->x0 / m->tile + 1;
    m->tiles_y = (m->y0 + height - 1) / m->tile - m->y0 / m->tile + 1;
    size_t count = (size_t)m->tiles_x * (size_t)m->tiles_y;
    m->open = arena_new_array(arena, bool, count);
    m->moving = arena_new_array(arena, bool, count);
    m->noise = arena_new_array(arena, float, count);
    m->noise_between = arena_new_array(arena, float, count);
    memset(m->open, true, count * sizeof *m->open);
}

/* ---- sums ---- */

/* Not as a mix with 0 times itself: light may be infinite. */
static void scale(const MomentMean *m, Image *image, float part) {
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++)
        for (int c = 0; c < m->channels; c++) image->pixels[i * (size_t)image->channels + (size_t)c] *= part;
}

/* into = a·into + b·other, in the channels of light. */
static void mix(const MomentMean *m, Image *into, float a, const Image *other, float b) {
    size_t pixels = (size_t)into->width * (size_t)into->height;
    for (size_t i = 0; i < pixels; i++) {
        float *x = into->pixels + i * (size_t)into->channels;
        const float *y = other->pixels + i * (size_t)other->channels;
        for (int c = 0; c < m->channels; c++) x[c] = a * x[c] + b * y[c];
    }
}

static void drop(Image *image) {
    image_free(image);
    *image = (Image){0};
}

/* As those of a mean of which each picture is `part`. */
static void add_noise(MomentMean *m, float *into, bool first, float part, const float *tile_noise, int side) {
    int columns = (m->tiles_x + side - 1) / side;
    for (int y = 0; y < m->tiles_y; y++)
        for (int x = 0; x < m->tiles_x; x++) {
            float *sum = &into[y * m->tiles_x + x];
            *sum = (first ? 0 : *sum) + part * part * tile_noise[y / side * columns + x / side];
        }
}

void moment_mean_add(MomentMean *m, MomentPlace place, Image *picture, const float *tile_noise, int side) {
    Image *into = place.intervals ? &m->between : &m->mean;
    float part = place.intervals ? 1 / (float)place.intervals : 0.5f;
    add_noise(m, place.intervals ? m->noise_between : m->noise, place.index == 0, part, tile_noise, side);
    if (place.index == 0) {
        drop(into);
        *into = *picture;
        *picture = (Image){0};
        scale(m, into, part);
        return;
    }
    mix(m, into, 1, picture, part);
    drop(picture);
}

void moment_mean_free(MomentMean *m) {
    drop(&m->mean);
    drop(&m->between);
}

/* ---- tiles ---- */

typedef struct Rectangle {
    int x0, y0, x1, y1; /* of the images */
} Rectangle;

static Rectangle tile_at(const MomentMean *m, int tx, int ty) {
    int x = (m->x0 / m->tile + tx) * m->tile - m->x0, y = (m->y0 / m->tile + ty) * m->tile - m->y0;
    return (Rectangle){int_max(x, 0), int_max(y, 0), int_min(x + m->tile, m->width), int_min(y + m->tile, m->height)};
}

/* Sum of the squares of what the two means differ by. */
static double squared_difference(const MomentMean *m, Rectangle r) {
    double sum = 0;
    for (int y = r.y0; y < r.y1; y++)
        for (int x = r.x0; x < r.x1; x++) {
            const float *a = image_pixel(&m->mean, x, y), *b = image_pixel(&m->between, x, y);
            for (int c = 0; c < m->channels; c++) {
                double d = (double)float_clamp(a[c], 0, 1) - (double)float_clamp(b[c], 0, 1);
                sum += d * d;
            }
        }
    return sum;
}

static double pixels_in(Rectangle r) { return (double)(r.x1 - r.x0) * (r.y1 - r.y0); }

/* Whether the mean of both may still be off by more than is accepted: of what they differ by, noise is taken off, which lies as the difference does. */
static bool tile_moves(const MomentMean *m, int tile, Rectangle r, double accepted) {
    double all = squared_difference(m, r), noise = ((double)m->noise[tile] + (double)m->noise_between[tile]) * pixels_in(r) * m->channels;
    if (!(all > noise)) return false;
    double share = (1 - noise / all) / 4, most = MOST_IN_BLOCK * accepted;
    if (share * all > accepted * accepted * pixels_in(r) * m->channels) return true;
    for (int y = r.y0; y < r.y1; y += m->block)
        for (int x = r.x0; x < r.x1; x += m->block) {
            Rectangle block = {x, y, int_min(x + m->block, r.x1), int_min(y + m->block, r.y1)};
            if (share * squared_difference(m, block) > most * most * m->block * m->block * m->channels) return true;
        }
    return false;
}

static void take_in(MomentMean *m, Rectangle r) {
    for (int y = r.y0; y < r.y1; y++)
        for (int x = r.x0; x < r.x1; x++) {
            float *mean = image_pixel(&m->mean, x, y);
            const float *between = image_pixel(&m->between, x, y);
            for (int c = 0; c < m->channels; c++) mean[c] = 0.5f * (mean[c] + between[c]);
        }
}

void moment_mean_finish(MomentMean *m, double accepted) {
    for (int i = 0; i < m->tiles_x * m->tiles_y; i++) {
        Rectangle r = tile_at(m, i % m->tiles_x, i / m->tiles_x);
        m->moving[i] = m->open[i] && tile_moves(m, i, r, accepted);
        if (!m->open[i]) continue;
        take_in(m, r);
        m->noise[i] = (m->noise[i] + m->noise_between[i]) / 4;
    }
    drop(&m->between);
}

/* Where something may be between two moments: within the part of the picture where anything moves, which what goes straight does not leave, and no
 * farther from what moves, in tiles, than crossing all of it takes. */
typedef struct Reach {
    Rectangle tiles; /* x1, y1 exclusive */
    int far;
} Reach;

static Reach reach_of(const MomentMean *m, int intervals) {
    Rectangle r = {m->tiles_x, m->tiles_y, 0, 0};
    for (int y = 0; y < m->tiles_y; y++)
        for (int x = 0; x < m->tiles_x; x++)
            if (m->moving[y * m->tiles_x + x]) r = (Rectangle){int_min(r.x0, x), int_min(r.y0, y), int_max(r.x1, x + 1), int_max(r.y1, y + 1)};
    return (Reach){r, r.x1 == 0 ? 0 : (int)ceil(hypot(r.x1 - 1 - r.x0, r.y1 - 1 - r.y0) / intervals)};
}

static bool moves_near(const MomentMean *m, int tx, int ty, Reach reach) {
    Rectangle r = reach.tiles;
    if (tx < r.x0 || tx >= r.x1 || ty < r.y0 || ty >= r.y1) return false;
    for (int y = int_max(ty - reach.far, r.y0); y <= int_min(ty + reach.far, r.y1 - 1); y++)
        for (int x = int_max(tx - reach.far, r.x0); x <= int_min(tx + reach.far, r.x1 - 1); x++)
            if (m->moving[y * m->tiles_x + x]) return true;
    return false;
}

bool moment_mean_close(MomentMean *m, const MomentMean *scout, int first_x, int first_y, int intervals) {
    Reach reach = {.far = 0};
    if (scout) reach = reach_of(scout, intervals);
    bool any = false;
    for (int y = 0; y < m->tiles_y; y++)
        for (int x = 0; x < m->tiles_x; x++) {
            int i = y * m->tiles_x + x;
            m->open[i] = m->open[i] && (m->moving[i] || (scout && moves_near(scout, first_x + x, first_y + y, reach)));
            any |= m->open[i];
        }
    return any;
}
