/* What OpenImageIO does for us, as C functions: the interface of the module vts_oiio, which is loaded on use
 * (oiio_module.h). No exception leaves them; each returns false with a text in `error` instead. */
#ifndef VTS_IMAGE_OIIO_SHIM_H
#define VTS_IMAGE_OIIO_SHIM_H

#include "image/sample.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Changes with every change of this file; a module with another number is not used. */
enum { OIIO_SHIM_VERSION = 4, OIIO_ERROR_SIZE = 512 };

typedef struct OiioReader OiioReader;
typedef struct OiioFilm OiioFilm;

/* The first part of an opened file. Texts belong to the reader. */
typedef struct OiioHeader {
    int width, height, channels;
    const char *const *names;         /* of the channels */
    ImageSample sample;               /* the widest among the channels */
    ImageSample colour_sample;        /* that of the first channel called R, G, B, A or Y; the same where there is none */
    int alpha;                        /* index of the alpha channel, or -1 */
    bool alpha_unassociated;          /* colours are not multiplied by alpha */
    bool linear;                      /* integers that hold linear light, says the file */
    int row_step;                     /* rows that are stored together: strips, tiles */
    const ImageAttribute *attributes; /* texts and numbers; nothing structured */
    size_t attribute_count;
} OiioHeader;

/* A picture to encode. Names and texts are borrowed. */
typedef struct OiioPicture {
    const char *format; /* OpenImageIO's name: "openexr", "png", "tiff", "jpeg", "hdr" */
    int width, height, channels;
    int x, y, whole_width, whole_height; /* of what it is a part of; 0 wide: it is whole */
    const char *const *names;
    ImageSample sample;         /* of `data`: U8, U16 or FLOAT */
    const void *data;           /* [height][width][channels] */
    const ImageSample *samples; /* for EXR, one per channel, HALF or FLOAT; NULL: as `sample` */
    int alpha;                  /* index of an alpha channel, or -1 */
    bool srgb;                  /* data went through the sRGB curve, and alpha is unassociated */
    const ImageAttribute *attributes;
    size_t attribute_count;
} OiioPicture;

typedef struct OiioShim {
    int version; /* OIIO_SHIM_VERSION */
    bool (*open)(const char *path, OiioReader **reader, OiioHeader *header, char error[OIIO_ERROR_SIZE]);
    /* All samples, integers not scaled, into width · height · channels floats. */
    bool (*read)(OiioReader *reader, float *pixels, char error[OIIO_ERROR_SIZE]);
    /* The samples of one channel, as read() has them, of the rows from `row` on: a multiple of row_step, up to the next multiple or the
     * last row. */
    bool (*read_rows)(OiioReader *reader, int row, int channel, float *samples, char error[OIIO_ERROR_SIZE]);
    void (*close)(OiioReader *reader);
    /* The bytes of a file, allocated with malloc(). */
    bool (*encode)(const OiioPicture *picture, void **bytes, size_t *size, char error[OIIO_ERROR_SIZE]);
    /* A file of several pictures shown one after the other ("gif"): opened with the first, which is not added yet; a picture is three bytes a
     * pixel. film_close() of an opened one always, also to break off; false when the file is not whole. */
    bool (*film_open)(const char *path, const char *format, int width, int height, double fps, OiioFilm **film, char error[OIIO_ERROR_SIZE]);
    bool (*film_add)(OiioFilm *film, const unsigned char *pixels, char error[OIIO_ERROR_SIZE]);
    bool (*film_close)(OiioFilm *film, char error[OIIO_ERROR_SIZE]);
} OiioShim;

/* The one symbol of the module. */
VTS_EXPORT const OiioShim *vts_oiio_shim(void);

#ifdef __cplusplus
}
#endif
#endif
