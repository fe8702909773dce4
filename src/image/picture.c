#include "image/picture.h"

#include "image/palette.h"
#include "image/srgb.h"

#include <string.h>

/* ---- the pyramid ---- */

/* The share of a coarse pixel that lies in fine pixel i: coarse pixel k covers [k, k + 1) · fine / coarse. */
static double overlap(int i, double lo, double hi) { return fmax(0, fmin(hi, i + 1) - fmax(lo, i)); }

static void shrink_pixel(const PictureLevel *fine, const double x[2], const double y[2], float out[4]) {
    double sum[4] = {0, 0, 0, 0}, total = (x[1] - x[0]) * (y[1] - y[0]);
    for (int j = (int)y[0]; j < fine->height && j < y[1]; j++)
        for (int i = (int)x[0]; i < fine->width && i < x[1]; i++) {
            const float *pixel = fine->pixels[(size_t)j * (size_t)fine->width + (size_t)i];
            double share = overlap(i, x[0], x[1]) * overlap(j, y[0], y[1]) / total;
            for (int c = 0; c < 4; c++) sum[c] += share * (double)pixel[c];
        }
    for (int c = 0; c < 4; c++) out[c] = (float)sum[c];
}

static PictureLevel shrink(const PictureLevel *fine, Arena *arena) {
    PictureLevel coarse = {(fine->width + 1) / 2, (fine->height + 1) / 2, NULL};
    float(*pixels)[4] = arena_push_array_(arena, (size_t)coarse.width * (size_t)coarse.height, sizeof *pixels);
    double dx = (double)fine->width / coarse.width, dy = (double)fine->height / coarse.height;
    for (int j = 0; j < coarse.height; j++)
        for (int i = 0; i < coarse.width; i++)
            shrink_pixel(fine, (double[]){i * dx, (i + 1) * dx}, (double[]){j * dy, (j + 1) * dy},
                         pixels[(size_t)j * (size_t)coarse.width + (size_t)i]);
    coarse.pixels = (const float(*)[4])pixels;
    return coarse;
}

/* Which channels of an image are red, green, blue (all the same of a grey one) and alpha (-1: none). */
static void find_channels(const Image *image, int channel[4]) {
    static const char *const names[] = {"R", "G", "B", "A"};
    for (int c = 0; c < 4; c++) channel[c] = image_channel(image, names[c]);
    if (channel[0] >= 0 && channel[1] >= 0 && channel[2] >= 0) return;
    int grey = image_channel(image, "Y");
    for (int c = 0; c < 3; c++) channel[c] = grey >= 0 ? grey : 0;
}

void picture_make(const Image *image, Arena *arena, Picture *out) {
    int channel[4];
    size_t count = (size_t)image->width * (size_t)image->height;
    float(*pixels)[4] = arena_push_array_(arena, count, sizeof *pixels);
    find_channels(image, channel);
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 4; c++) {
            float value = channel[c] < 0 ? 1 : image->pixels[i * (size_t)image->channels + (size_t)channel[c]];
            pixels[i][c] = isfinite(value) ? value : 0;
        }
    *out = (Picture){.level_count = 1, .has_alpha = channel[3] >= 0, .hash = hash_begin(0x706963)};
    out->levels[0] = (PictureLevel){image->width, image->height, (const float(*)[4])pixels};
    hash_add_u64(&out->hash, (uint64_t)image->width);
    hash_add(&out->hash, pixels, count * sizeof *pixels);
    while (out->levels[out->level_count - 1].width > 1 || out->levels[out->level_count - 1].height > 1) {
        out->levels[out->level_count] = shrink(&out->levels[out->level_count - 1], arena);
        out->level_count++;
    }
}

/* image_load() took integers for sRGB, unless the file says otherwise. */
static void change_gamma(Image *image, double gamma) {
    int alpha = image_channel(image, "A");
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++) {
        float *pixel = image->pixels + i * (size_t)image->channels;
        double a = alpha >= 0 ? (double)pixel[alpha] : 1;
        for (int c = 0; c < image->channels; c++)
            if (c != alpha && a > 0) {
                double light = (double)pixel[c] / a;
                pixel[c] = (float)(a * pow(image->stored_linear ? light : srgb_encode(light), gamma));
            }
    }
}

static bool holds_integers(const Image *image) {
    return image->stored_as != IMAGE_SAMPLE_FLOAT && image->stored_as != IMAGE_SAMPLE_HALF && image->stored_as != IMAGE_SAMPLE_DOUBLE;
}

/* The arena may not return once it runs out, and nothing else frees the image. */
static bool make_and_free(Image *image, Arena *arena, Picture *out, StrBuf *error) {
    size_t need = (size_t)image->width * (size_t)image->height * 4 * sizeof(float) * 3 / 2;
    bool room = memory_budget_take(arena->budget, need);
    if (room) {
        memory_budget_give_back(arena->budget, need);
        picture_make(image, arena, out);
    } else if (error) {
        strbuf_adds(error, "it does not fit into the memory limit");
    }
    image_free(image);
    return room;
}

bool picture_load(const char *path, PictureGamma curve, double gamma, Arena *arena, Picture *out, StrBuf *error) {
    Image image;
    if (!image_load(&image, path, IMAGE_AS_COLOUR, arena->budget, error)) return false;
    if (curve == PICTURE_GAMMA_POWER && holds_integers(&image)) change_gamma(&image, gamma);
    return make_and_free(&image, arena, out, error);
}

bool picture_load_entries(const char *path, const float (*entries)[4], Arena *arena, Picture *out, StrBuf *error) {
    Palette palette;
    Image numbers, image;
    if (!palette_read(path, &palette) || !image_load(&numbers, path, IMAGE_AS_STORED, arena->budget, error)) return false;
    palette_index(&palette, &numbers);
    bool room = image_init(&image, numbers.width, numbers.height, 4, NULL, arena->budget, error);
    size_t count = (size_t)numbers.width * (size_t)numbers.height;
    for (size_t i = 0; room && i < count; i++) {
        size_t entry = (size_t)double_clamp((double)numbers.pixels[i * (size_t)numbers.channels], 0, PALETTE_MOST - 1);
        memcpy(image.pixels + 4 * i, entries[entry], sizeof *entries);
    }
    image_free(&numbers);
    return room && make_and_free(&image, arena, out, error);
}

/* ---- looking up ---- */

static int wrapped(long i, int size, bool once) {
    if (once) return i < 0 ? 0 : i >= size ? size - 1 : (int)i;
    long r = i % size;
    return (int)(r < 0 ? r + size : r);
}

static const float *pixel_at(const PictureLevel *level, long x, long y, bool once) {
    return level->pixels[(size_t)wrapped(y, level->height, once) * (size_t)level->width + (size_t)wrapped(x, level->width, once)];
}

/* Columns and rows with their weights, whose products add up to 1. */
typedef struct Taps {
    long first;
    int count;
    double weight[4];
} Taps;

static Taps linear_taps(double at, double t) { return (Taps){(long)floor(at), 2, {1 - t, t}}; }

/* Catmull & Rom's cubic. */
static Taps cubic_taps(double at) {
    double t = at - floor(at), u = 1 - t;
    return (Taps){(long)floor(at) - 1,
                  4,
                  {-t * u * u / 2, (2 - t * t * (5 - 3 * t)) / 2, (2 - u * u * (5 - 3 * u)) / 2, -u * t * t / 2}};
}

/* A row of pixels averaged over a box at most one pixel wide: the nearest one, but for a seam as wide as the box. */
static Taps nearest_taps(double at, double width) {
    double t = at - floor(at);
    if (width <= 0) return (Taps){(long)floor(at + 0.5), 1, {1}};
    return linear_taps(at, double_clamp((t - 0.5) / width + 0.5, 0, 1));
}

/* Colours before they were multiplied by alpha, if `plain`: what POV-Ray mixes at a place without extent. */
static void add_pixel(const float *pixel, bool plain, double weight, double sum[4]) {
    double divisor = plain && pixel[3] > 0 ? (double)pixel[3] : 1;
    for (int c = 0; c < 3; c++) sum[c] += weight * (double)pixel[c] / divisor;
    sum[3] += weight * (double)pixel[3];
}

static void weigh(const PictureLevel *level, const Taps *x, const Taps *y, bool once, bool plain, double sum[4], double scale) {
    for (int j = 0; j < y->count; j++)
        for (int i = 0; i < x->count; i++)
            add_pixel(pixel_at(level, x->first + i, y->first + j, once), plain, scale * x->weight[i] * y->weight[j], sum);
}

/* POV-Ray's `interpolate 4`: the four pixels around by the inverse square of their distance. */
static void weigh_normalized(const PictureLevel *level, double x, double y, bool once, bool plain, double sum[4], double scale) {
    double weights[4], total = 0, fx = x - floor(x), fy = y - floor(y);
    for (int k = 0; k < 4; k++) {
        double dx = fx - (k & 1), dy = fy - (k >> 1);
        weights[k] = 1 / fmax(dx * dx + dy * dy, 1e-20);
        total += weights[k];
    }
    for (int k = 0; k < 4; k++) {
        const float *pixel = pixel_at(level, (long)floor(x) + (k & 1), (long)floor(y) + (k >> 1), once);
        add_pixel(pixel, plain, scale * weights[k] / total, sum);
    }
}

/* In units of the level's pixels, whose centres are at whole numbers. */
static void sample_level(const PictureLevel *level, double u, double v, PictureFilter filter, double width, bool once, double sum[4],
                         double scale) {
    double x = u * level->width - 0.5, y = (1 - v) * level->height - 0.5;
    if (!(fabs(x) < 1e15 && fabs(y) < 1e15)) return;
    if (filter == PICTURE_NORMALIZED) {
        weigh_normalized(level, x, y, once, width == 0, sum, scale);
        return;
    }
    Taps columns, rows;
    switch (filter) {
    case PICTURE_NEAREST: columns = nearest_taps(x, width), rows = nearest_taps(y, width); break;
    case PICTURE_BICUBIC: columns = cubic_taps(x), rows = cubic_taps(y); break;
    default: columns = linear_taps(x, x - floor(x)), rows = linear_taps(y, y - floor(y)); break;
    }
    weigh(level, &columns, &rows, once, width == 0, sum, scale);
}

/* Averaged over about `size` pixels of the finest level. */
static void sample(const Picture *p, double u, double v, double size, PictureFilter filter, bool once, double sum[4], double scale) {
    if (size <= 1) {
        sample_level(&p->levels[0], u, v, filter, size, once, sum, scale);
        return;
    }
    double lod = fmin(log2(size), p->level_count - 1);
    int level = int_min((int)lod, p->level_count - 1);
    double t = lod - level;
    if (t < 1) sample_level(&p->levels[level], u, v, PICTURE_BILINEAR, 1, once, sum, scale * (1 - t));
    if (t > 0) sample_level(&p->levels[level + 1], u, v, PICTURE_BILINEAR, 1, once, sum, scale * t);
}

/* The axes of the ellipse that `axes` span, as those of their covariance: lengths in pixels, and the longer one's direction. */
static double ellipse(const Picture *p, const PictureSpot *spot, double *shorter, double longer[2]) {
    double xx = 0, xy = 0, yy = 0;
    for (int k = 0; k < 2; k++) {
        double x = spot->axes[k][0] * p->levels[0].width, y = spot->axes[k][1] * p->levels[0].height;
        xx += x * x, xy += x * y, yy += y * y;
    }
    double mean = (xx + yy) / 2, spread = hypot((xx - yy) / 2, xy), angle = atan2(2 * xy, xx - yy) / 2;
    double length = sqrt(mean + spread);
    *shorter = sqrt(fmax(mean - spread, 0));
    longer[0] = length * cos(angle) / p->levels[0].width;
    longer[1] = length * sin(angle) / p->levels[0].height;
    return length;
}

enum { MOST_PROBES = 8 };

PictureColor picture_color(const Picture *picture, const PictureSpot *spot, PictureFilter filter, bool once) {
    double sum[4] = {0, 0, 0, 0}, shorter, along[2];
    double length = ellipse(picture, spot, &shorter, along);
    if (!isfinite(length)) length = shorter = picture->levels[0].width, along[0] = along[1] = 0;
    /* Probes along the longer axis, each as wide as the shorter one, or as what is left between them. */
    double most = double_min(MOST_PROBES, length / double_max(shorter, 1));
    int probes = length > 1 ? int_max(1, (int)ceil(most)) : 1;
    double size = probes > 1 ? double_max(shorter, length / probes) : length;
    for (int k = 0; k < probes; k++) {
        double t = (k + 0.5) / probes - 0.5;
        sample(picture, spot->u + t * along[0], spot->v - t * along[1], size, filter, once, sum, 1.0 / probes);
    }
    PictureColor color = {sum[0], sum[1], sum[2], double_clamp(sum[3], 0, 1)};
    if (picture->has_alpha && color.alpha > 0 && length > 0) /* else they were not multiplied */
        color.red /= color.alpha, color.green /= color.alpha, color.blue /= color.alpha;
    return color;
}
