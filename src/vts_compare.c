/* vts_compare(): how far two pictures are apart. */
#include "vts_session.h"

#include "image/error_map.h"
#include "image/flip.h"
#include "image/metrics.h"

#include <stdio.h>
#include <stdlib.h>

float *difference_map(const Image *reference, const Image *test, VtsDifference *out, StrBuf *why) {
    ImageDifference d;
    if (!image_compare(reference, test, &d, why)) return NULL;
    *out = (VtsDifference){.width = test->width, .height = test->height, .rmse = d.rmse, .psnr = d.psnr, .largest = d.largest,
                           .x = d.x, .y = d.y, .not_finite = d.not_finite};
    return flip_map(reference, test, FLIP_PIXELS_PER_DEGREE, &out->flip, why);
}

static VtsStatus compare_loaded(const Image *reference, const Image *test, const char *map_path, VtsDifference *out, StrBuf *why) {
    float *map = difference_map(reference, test, out, why);
    if (!map) return out->width ? VTS_ERROR_MEMORY : VTS_ERROR_USAGE; /* it has a size once the pictures could be compared */
    bool saved = !map_path || error_map_save(map, test->width, test->height, map_path, NULL, why);
    free(map);
    return saved ? VTS_OK : VTS_ERROR_FILE;
}

VtsStatus vts_compare(const char *reference_path, const char *test_path, const char *map_path, VtsDifference *out, char *error,
                      size_t error_size) {
    StrBuf why = {0};
    Image reference = {0}, test = {0};
    VtsStatus status = VTS_ERROR_FILE;
    *out = (VtsDifference){0};
    if ((!map_path || image_can_write(map_path, &why)) && image_load(&reference, reference_path, IMAGE_AS_COLOUR, NULL, &why) &&
        image_load(&test, test_path, IMAGE_AS_COLOUR, NULL, &why))
        status = compare_loaded(&reference, &test, map_path, out, &why);
    if (error && error_size) snprintf(error, error_size, "%s", status == VTS_OK || !why.data ? "" : why.data);
    strbuf_free(&why);
    image_free(&reference);
    image_free(&test);
    return status;
}
