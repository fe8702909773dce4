/* PNG files, written by ourselves: loading OpenImageIO takes longer than drawing a small picture does. */
#ifndef VTS_IMAGE_PNG_H
#define VTS_IMAGE_PNG_H

#include "image/image.h"

/* Codes that went through the sRGB curve, alpha not multiplied in: rows of pixels of grey, grey and alpha, red, green and blue, or these and
 * alpha. */
typedef struct PngPicture {
    int width, height, channels;
    bool wide; /* codes of 16 bits, else of 8 */
    const uint16_t *codes;
    const ImageAttribute *attributes;
    size_t attribute_count;
} PngPicture;

/* The file's bytes, added to `out`; equal pictures give equal bytes. False when memory is short. */
bool png_encode(const PngPicture *picture, StrBuf *out);

#endif
