/* PNG in memory, by libpng: the format of most pictures that are written, which need not wait for OpenImageIO's many libraries. */
#ifndef VTS_IMAGE_PNG_FILE_H
#define VTS_IMAGE_PNG_FILE_H

#include "image/image.h"
#include "image/oiio_shim.h"

/* Whether a file that begins so is a PNG. */
bool png_file_recognizes(const unsigned char *data, size_t size);

/* Decodes a whole file into an uninitialised Image: numbers as they are stored, palettes and few bits widened to 8, texts as attributes. What
 * the numbers mean is put into *header, of which sample, alpha, alpha_unassociated and linear are set. Nothing in the data is trusted;
 * `path` is for the errors. */
bool png_file_decode(Image *image, const unsigned char *data, size_t size, const char *path,
                     MemoryBudget *budget, OiioHeader *header, StrBuf *error);

/* Appends the file's bytes; of the picture 1 to 4 channels, samples U8 or U16, srgb and attributes count. */
bool png_file_encode(const OiioPicture *picture, StrBuf *out, char error[OIIO_ERROR_SIZE]);

#endif
