/* PFM (Debevec's portable float map) and PNM (P2, P3, P5, P6) in memory: formats so plain that tests and pipes need no
 * library for them. */
#ifndef VTS_IMAGE_PNM_H
#define VTS_IMAGE_PNM_H

#include "image/image.h"

/* Whether a file that begins so is one of ours. */
bool pnm_recognizes(const unsigned char *data, size_t size);

/* Decodes a whole file as image_load() does; nothing in the data is trusted. `path` is for the errors. */
bool pnm_decode(Image *image, const unsigned char *data, size_t size, const char *path, ImageReading reading,
                MemoryBudget *budget, StrBuf *error);

/* The header of a file of `channels` (1 or 3): PFM with little-endian floats, or PGM/PPM with that largest value. Where the image belongs
 * if it is a part (image_part.h) stands there as well, in a comment. PFM has none, and most readers take its lines as they come: there it
 * is in the scale's decimals, behind so many zeros that no reader's number has room for them. */
void pnm_add_pfm_header(StrBuf *out, const Image *image, int channels);
void pnm_add_header(StrBuf *out, const Image *image, int channels, int largest);
/* Whether this machine has floats as a PFM wants them. */
bool pnm_floats_are_own(void);
/* Turns samples into what a PFM holds of them, in their place. */
void pnm_floats_to_file(float *samples, size_t count);
/* A row of `count` codes of one byte, or of two with the high byte first. */
void pnm_add_codes(StrBuf *out, const uint16_t *codes, size_t count, bool wide);

#endif
