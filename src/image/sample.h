/* What the library and its OpenImageIO module (C++) both speak of: how samples are stored, and metadata. */
#ifndef VTS_IMAGE_SAMPLE_H
#define VTS_IMAGE_SAMPLE_H

#include "base/common.h"

/* How a file stores a sample. */
typedef enum ImageSample {
    IMAGE_SAMPLE_AUTO, /* when saving: half for EXR, 16 bits for TIFF, 8 for PNG, JPEG, PPM and PGM */
    IMAGE_SAMPLE_U8,
    IMAGE_SAMPLE_I8,
    IMAGE_SAMPLE_U16,
    IMAGE_SAMPLE_I16,
    IMAGE_SAMPLE_U32,
    IMAGE_SAMPLE_I32,
    IMAGE_SAMPLE_HALF,
    IMAGE_SAMPLE_FLOAT,
    IMAGE_SAMPLE_DOUBLE
} ImageSample;

/* In words: "16-bit signed"; "" for AUTO. */
static inline const char *image_sample_name(ImageSample sample) {
    static const char *const names[] = {"",
                                        "8-bit unsigned",
                                        "8-bit signed",
                                        "16-bit unsigned",
                                        "16-bit signed",
                                        "32-bit unsigned",
                                        "32-bit signed",
                                        "16-bit float",
                                        "32-bit float",
                                        "64-bit float"};
    return names[sample];
}

/* A piece of metadata: a text or a number. */
typedef struct ImageAttribute {
    const char *name;
    const char *text; /* NULL: a number */
    double number;
} ImageAttribute;

#endif
