/* Parts of pictures: where each belongs, and parts joined into the whole. */
#ifndef VTS_IMAGE_IMAGE_PART_H
#define VTS_IMAGE_IMAGE_PART_H

#include "image/image.h"

/* Where a picture lies in a larger one, in pixels. */
typedef struct ImagePart {
    int x, y, width, height;        /* of the part */
    int whole_width, whole_height;
    uint64_t key; /* the same for all parts of one whole, another for those of other wholes */
} ImagePart;

/* The metadata that says so; image_save() keeps it in EXR, PNG, TIFF, JPEG, PFM, PPM and PGM. */
#define IMAGE_PART_NAME "vts:part"

/* Makes a picture a part. */
void image_part_set(Image *image, const ImagePart *part);
/* Where a picture belongs, as its file says; false when it says nothing, or what cannot be. */
bool image_part_of(const Image *image, ImagePart *out);

/* As the text of the metadata, and back; false when it is not that. */
void image_part_print(const ImagePart *part, StrBuf *out);
bool image_part_parse(const char *text, ImagePart *out);

typedef enum StitchStatus { STITCH_OK, STITCH_FILE /* could not be read or written */, STITCH_MISFIT /* parts are missing, or of other pictures */ } StitchStatus;

/* Joins parts, which may overlap where they agree, into the picture that would have been drawn at once: the same samples in the same
 * format, the same metadata, and so the same file, if `output` has their format. A line of text in `error` tells why not. */
StitchStatus image_stitch(const char *const *paths, size_t count, const char *output, StrBuf *error);

#endif
