#include "image/metrics.h"

#include "image/srgb.h"

#include <math.h>

typedef struct Channels {
    int index[3];
} Channels;

static Channels colour_channels(const Image *image) {
    int r = image_channel(image, "R"), g = image_channel(image, "G"), b = image_channel(image, "B");
    if (r >= 0 && g >= 0 && b >= 0) return (Channels){{r, g, b}};
    int grey = int_max(image_channel(image, "Y"), 0);
    return (Channels){{grey, grey, grey}};
}

static double clamped(float value) { return value > 0 ? double_min((double)value, 1) : 0; }

static double square(double x) { return x * x; }

bool image_compare(const Image *a, const Image *b, ImageDifference *out, StrBuf *error) {
    *out = (ImageDifference){0};
    if (a->width != b->width || a->height != b->height) {
        if (error)
            strbuf_addf(error, "pictures of different size: %d x %d and %d x %d", a->width, a->height,
                        b->width, b->height);
        return false;
    }
    Channels from_a = colour_channels(a), from_b = colour_channels(b);
    double linear = 0, coded = 0;
    for (int y = 0; y < a->height; y++) {
        /* Summed by row: sums of millions of small terms keep their digits. */
        double row_linear = 0, row_coded = 0;
        for (int x = 0; x < a->width; x++)
            for (int c = 0; c < 3; c++) {
                float raw_p = image_pixel(a, x, y)[from_a.index[c]],
                      raw_q = image_pixel(b, x, y)[from_b.index[c]];
                out->not_finite += !isfinite(raw_p) || !isfinite(raw_q);
                double p = clamped(raw_p), q = clamped(raw_q);
                if (p == q) continue;
                row_linear += square(p - q);
                row_coded += square(srgb_encode(p) - srgb_encode(q));
                if (fabs(p - q) > out->largest) {
                    out->largest = fabs(p - q);
                    out->x = x;
                    out->y = y;
                }
            }
        linear += row_linear;
        coded += row_coded;
    }
    double samples = 3.0 * a->width * a->height;
    out->rmse = sqrt(linear / samples);
    out->psnr = coded > 0 ? 10 * log10(samples / coded) : (double)INFINITY;
    return true;
}

void image_subtract(const Image *reference, const Image *test, float *out) {
    Channels from_reference = colour_channels(reference), from_test = colour_channels(test);
    for (int y = 0; y < test->height; y++)
        for (int x = 0; x < test->width; x++)
            for (int c = 0; c < 3; c++)
                *out++ = (float)(clamped(image_pixel(test, x, y)[from_test.index[c]]) - clamped(image_pixel(reference, x, y)[from_reference.index[c]]));
}
