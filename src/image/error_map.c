#include "image/error_map.h"

#include "image/srgb.h"

#include <math.h>
#include <string.h>

/* In sRGB codes, at equal steps of the value; luminance grows from each to the next. */
static const double STOPS[][3] = {
    {0.00, 0.00, 0.02}, {0.16, 0.07, 0.37}, {0.45, 0.12, 0.51}, {0.76, 0.20, 0.43}, {0.96, 0.42, 0.31}, {0.99, 0.72, 0.42}, {1.00, 0.98, 0.78},
};
enum { LAST_STOP = VTS_ARRAY_COUNT(STOPS) - 1 };

void error_color(double value, float rgb[3]) {
    double at = value >= 0 && value < 1 ? value * LAST_STOP : value < 0 ? 0 : LAST_STOP;
    int below = int_min((int)at, LAST_STOP - 1);
    double share = at - below;
    for (int c = 0; c < 3; c++) rgb[c] = (float)srgb_decode(STOPS[below][c] * (1 - share) + STOPS[below + 1][c] * share);
}

bool error_map_save(const float *map, int width, int height, const char *path, MemoryBudget *budget, StrBuf *error) {
    ImageFormat format = image_format_of(path);
    bool plain = format == IMAGE_FORMAT_EXR || format == IMAGE_FORMAT_PFM;
    Image picture;
    if (!image_init(&picture, width, height, plain ? 1 : 3, NULL, budget, error)) return false;
    size_t count = (size_t)width * (size_t)height;
    if (plain) memcpy(picture.pixels, map, count * sizeof *map);
    for (size_t i = 0; !plain && i < count; i++) error_color((double)map[i], picture.pixels + 3 * i);
    bool saved = image_save(&picture, path, plain ? IMAGE_SAMPLE_FLOAT : IMAGE_SAMPLE_AUTO, error);
    image_free(&picture);
    return saved;
}
