/* Pictures of 8 bits, from files, as one file that shows them one after the other. */
#ifndef VTS_IMAGE_FILM_FILE_H
#define VTS_IMAGE_FILM_FILE_H

#include "base/strbuf.h"

/* Writes the pictures as an animated GIF that goes round, each shown for 1/fps seconds as near as hundredths of a second come to it. The
 * first one's size is that of all. On failure no file is left but one that was there before, and `error` gets a line of text. */
bool film_file_save_gif(const char *const *paths, size_t count, double fps, const char *output_path, StrBuf *error);

#endif
