/* Pictures in memory and in files.
 *
 * In memory a picture is floats: named channels, interleaved, rows from the top. Colours are linear light and
 * multiplied by their alpha; files that store them otherwise (sRGB, unassociated alpha) are converted on the way.
 * PFM and PNM are read and written here; every other format goes through OpenImageIO, which is loaded when the first
 * such picture is opened (see oiio_module.h).
 *
 * Errors: functions that can fail return false and append one line of text, without full stop and line end, to
 * `error`, which may be NULL. */
#ifndef VTS_IMAGE_IMAGE_H
#define VTS_IMAGE_IMAGE_H

#include "base/arena.h"
#include "base/strbuf.h"
#include "image/sample.h"

enum {
    IMAGE_LARGEST_SIDE = 1 << 20, /* pixels */
    IMAGE_LARGEST_CHANNELS = 1024,
    IMAGE_LARGEST_SAMPLES = 1 << 30 /* width · height · channels: 4 GiB of floats */
};

typedef enum ImageFormat {
    IMAGE_FORMAT_NONE, /* not known */
    IMAGE_FORMAT_EXR,
    IMAGE_FORMAT_PNG,
    IMAGE_FORMAT_TIFF,
    IMAGE_FORMAT_JPEG,
    IMAGE_FORMAT_HDR,
    IMAGE_FORMAT_PFM,
    IMAGE_FORMAT_PPM,
    IMAGE_FORMAT_PGM
} ImageFormat;

typedef enum ImageReading {
    IMAGE_AS_COLOUR, /* linear light: integers scaled to [0,1] and sent through the sRGB curve, alpha multiplied in */
    IMAGE_AS_STORED /* the numbers of the file, integers as they are: heights, masks */
} ImageReading;

typedef struct Image {
    int width, height, channels;
    const char *const *names; /* of the channels: "R", "G", "B", "A", "Y", "Z", "normal.x" … */
    float *pixels;            /* [height][width][channels]; row 0 is the top */
    ImageAttribute *attributes;
    size_t attribute_count, attribute_capacity;
    ImageSample stored_as; /* what the file it was loaded from holds; IMAGE_SAMPLE_FLOAT for others */
    ImageSample colour_stored_as; /* the same of its colours alone: EXR may store further channels otherwise */
    bool stored_linear;    /* its integers are light, not sRGB codes */
    bool coded; /* the pixels are integers as the file has them: image_save() writes them so in PNG, TIFF, PPM and PGM of that format's channels */
    Arena texts;           /* names and attributes */
    MemoryBudget *budget;  /* that the pixels were taken from; may be NULL */
} Image;

/* A black picture. `names` (copied) may be NULL: Y, Y A, R G B or R G B A by the number of channels. False when the
 * size is out of range or memory is short. On failure the Image needs no image_free(), but bears it. */
bool image_init(Image *image, int width, int height, int channels, const char *const *names,
                MemoryBudget *budget, StrBuf *error);
/* Also of an Image that is all zero. */
void image_free(Image *image);

/* The channel's index, or -1. */
int image_channel(const Image *image, const char *name);
/* The first channel of the pixel in column x and row y. */
static inline float *image_pixel(const Image *image, int x, int y) {
    return image->pixels + ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
}

/* Metadata; a name that is already there gets the new value. Texts are copied. */
void image_set_text(Image *image, const char *name, const char *text);
void image_set_number(Image *image, const char *name, double number);
/* NULL when there is none of this name. A number may come back as text from formats that know only texts (PNG). */
const ImageAttribute *image_attribute(const Image *image, const char *name);

/* By the suffix of the file's name, in either case; IMAGE_FORMAT_NONE when it names no format that can be written. */
ImageFormat image_format_of(const char *path);
/* Whether image_save() to this path may succeed: the suffix is known, the folder is there and can be written. Creates
 * nothing: for telling users before hours of rendering. */
bool image_can_write(const char *path, StrBuf *error);

/* Reads a picture into an uninitialised Image. The format is told by the file's content for PFM and PNM, else by
 * OpenImageIO. The first part of a file with several. */
bool image_load(Image *image, const char *path, ImageReading reading, MemoryBudget *budget, StrBuf *error);

/* Writes a picture; the file appears whole or not at all, and equal pictures give equal bytes.
 * EXR stores all channels: R G B A Y as `sample` (half or float), others as float. The others store R G B, or Y, or
 * the first channel; PNG and TIFF with A. PNG, TIFF, PPM and PGM hold 8 or 16 bits through the sRGB curve, JPEG 8;
 * HDR and PFM are linear. A `sample` that the format lacks is taken as IMAGE_SAMPLE_AUTO.
 * Metadata: EXR and PNG (as text) store all; TIFF and JPEG as lines "name=value" of the description; the others none. */
bool image_save(const Image *image, const char *path, ImageSample sample, StrBuf *error);

#endif
