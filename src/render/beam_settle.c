#include "render/beam_settle.h"

#include <math.h>

/* A pixel moves toward the mean of those up to so many pixels away, and how much pixels differ is asked of more, since few tell that badly. Measured on
 * lawns, orchards and woods of 2 to 16 samples a pixel: means of 5 x 5 make the first two crooked, differences among 3 x 3 take up to a twentieth less from the error. */
enum { NEAR = 1, FAR = 3 };
/* What the allotment takes for noise is that of well laid samples, and pixels whose few samples happened to agree got no more of them: it counts as if it were random, where
 * halves that differ by d tell of d/4, not of 0.42² d (beam_allot.c). Measured likewise: pixels of 2 to 4 samples are wrong by 1.2 to 3 times what is thought, in the square. */
static const double AS_RANDOM = 0.25 / (0.42 * 0.42);

/* Sums over pixels: of colours, of their squares over all three channels, of opacities and of the errors. */
typedef struct Around {
    double color[3], square, alpha, error, count;
} Around;

static Around of_pixel(const Radiance *pixel, double error) {
    double r = (double)pixel->color.x, g = (double)pixel->color.y, b = (double)pixel->color.z;
    return (Around){{r, g, b}, r * r + g * g + b * b, (double)pixel->alpha, error, 1};
}

static void add(Around *sum, const Around *part) {
    for (int k = 0; k < 3; k++) sum->color[k] += part->color[k];
    sum->square += part->square, sum->alpha += part->alpha, sum->error += part->error, sum->count += part->count;
}

/* Adds up what lies up to `reach` before and behind place i of `count`, `step` apart. */
static Around sum_along(const Around *in, int i, int count, int step, int reach) {
    Around sum = {.count = 0};
    for (int k = int_max(i - reach, 0); k <= int_min(i + reach, count - 1); k++) add(&sum, &in[k * step]);
    return sum;
}

/* Of the pixels of a tile, and of the parts of their rows around them. */
typedef struct TileSums {
    int columns, rows;
    Around pixel[ALLOT_PIXELS], row[ALLOT_PIXELS];
} TileSums;

static void sum_rows(TileSums *t, int reach) {
    for (int i = 0; i < t->columns * t->rows; i++) t->row[i] = sum_along(t->pixel + i / t->columns * t->columns, i % t->columns, t->columns, 1, reach);
}

/* After sum_rows() of the same reach. */
static Around sum_around(const TileSums *t, int i, int reach) {
    return sum_along(t->row + i % t->columns, i / t->columns, t->rows, t->columns, reach);
}

/* How much pixels differ beside their noise: the mean square of each channel; without end where one of them is no number, so that it stays alone. */
static double difference_of(const Around *around) {
    double n = around->count, squared = 0;
    for (int k = 0; k < 3; k++) squared += around->color[k] * around->color[k] / n;
    double all = n > 1 ? (around->square - squared) / (3 * (n - 1)) : 0;
    return isfinite(all) ? fmax(all - around->error / n, 0) : HUGE_VAL;
}

static float toward(double mean, float own, double share) { return (float)(mean + ((double)own - mean) * share); }

/* Opacity goes with the colour that it belongs to. Returns the mean square of the error that is left. */
static double settle(Radiance *pixel, const Around *around, double difference, double error) {
    double n = around->count, share = difference / (difference + error);
    if (!(share < 1)) return 0; /* no noise; or none that could be told from what is no number */
    const double *sum = around->color;
    pixel->color = vec3f(toward(sum[0] / n, pixel->color.x, share), toward(sum[1] / n, pixel->color.y, share), toward(sum[2] / n, pixel->color.z, share));
    pixel->alpha = toward(around->alpha / n, pixel->alpha, share);
    return error * (share + (1 - share * share) / n); /* the mean is not without noise, either */
}

double beam_settle(const Allotment *a, Radiance *pixels) {
    TileSums sums = {.columns = a->columns, .rows = a->rows};
    double differences[ALLOT_PIXELS], sum = 0;
    const int count = a->columns * a->rows;
    for (int i = 0; i < count; i++) sums.pixel[i] = of_pixel(&pixels[i], AS_RANDOM * allot_error_of(a, i));
    sum_rows(&sums, FAR);
    for (int i = 0; i < count; i++) {
        Around around = sum_around(&sums, i, FAR);
        differences[i] = difference_of(&around);
    }
    sum_rows(&sums, NEAR);
    for (int i = 0; i < count; i++) {
        Around around = sum_around(&sums, i, NEAR);
        sum += settle(&pixels[i], &around, differences[i], sums.pixel[i].error);
    }
    return count ? sum / count : 0;
}
