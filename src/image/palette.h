/* The tables of colours of pictures whose pixels are numbers. OpenImageIO tells the colours alone; the tables lie plain in the files. */
#ifndef VTS_IMAGE_PALETTE_H
#define VTS_IMAGE_PALETTE_H

#include "image/image.h"

enum { PALETTE_MOST = 256 };

typedef struct Palette {
    int count;
    unsigned char colors[PALETTE_MOST][3]; /* red, green, blue */
} Palette;

/* The table of a PNG, GIF or BMP file. False when it has none, or cannot be read. */
bool palette_read(const char *path, Palette *out);
/* All channels of an image that was loaded IMAGE_AS_STORED become the numbers of the pixels' colours in the table: of equal colours the
 * first, of others the nearest. An image of wider integers, or of floats, stays. */
void palette_index(const Palette *palette, Image *image);

#endif
