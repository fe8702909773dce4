/* Pictures as colours of surfaces: looked up between pixels, and averaged over footprints by a pyramid of box-filtered levels. */
#ifndef VTS_IMAGE_PICTURE_H
#define VTS_IMAGE_PICTURE_H

#include "base/hash.h"
#include "image/image.h"

enum { PICTURE_LEVELS = 21 };

/* Linear light that is multiplied by alpha, and alpha. Row 0 is the top. Each level has half of the columns and rows of the one
 * before, rounded up, and the same mean. */
typedef struct PictureLevel {
    int width, height;
    const float (*pixels)[4];
} PictureLevel;

typedef struct Picture {
    PictureLevel levels[PICTURE_LEVELS];
    int level_count;
    bool has_alpha;
    Hash128 hash; /* of the pixels */
} Picture;

typedef enum PictureGamma { PICTURE_GAMMA_FILE /* what the format says, as image_load() */, PICTURE_GAMMA_SRGB, PICTURE_GAMMA_POWER } PictureGamma;

/* Loads a picture with its pyramid into `arena`. PICTURE_GAMMA_POWER: code values of integer formats are light to the power of 1/gamma.
 * False with a line in `error`. */
bool picture_load(const char *path, PictureGamma curve, double gamma, Arena *arena, Picture *out, StrBuf *error);
/* The same of a file with a table of colours (image/palette.h), each pixel being what `entries` has for its number, instead of a colour: 256
 * times red, green, blue, multiplied by alpha, and alpha. False, also without a line, where the file has no table. */
bool picture_load_entries(const char *path, const float (*entries)[4], Arena *arena, Picture *out, StrBuf *error);
/* The pyramid of an image that is there. */
void picture_make(const Image *image, Arena *arena, Picture *out);

/* POV-Ray's `interpolate`. */
typedef enum PictureFilter { PICTURE_NEAREST = 0, PICTURE_BILINEAR = 2, PICTURE_BICUBIC = 3, PICTURE_NORMALIZED = 4 } PictureFilter;

/* A place in the picture, in turns: u from left to right, v from bottom to top, [0, 1) being the picture once. The footprint is
 * spanned by the two axes <du, dv>, full widths; 0: the place alone. */
typedef struct PictureSpot {
    double u, v;
    double axes[2][2];
} PictureSpot;

typedef struct PictureColor {
    double red, green, blue, alpha; /* not multiplied */
} PictureColor;

/* `once`: the picture is not continued beyond its borders; what the footprint sees there is its rim. */
PictureColor picture_color(const Picture *picture, const PictureSpot *spot, PictureFilter filter, bool once);

#endif
