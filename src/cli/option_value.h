/* Values of options, read strictly: the whole text, within range, or false. */
#ifndef VTS_CLI_OPTION_VALUE_H
#define VTS_CLI_OPTION_VALUE_H

#include <stdbool.h>
#include <stddef.h>

bool option_int(const char *text, int smallest, int largest, int *out);
bool option_unsigned(const char *text, unsigned long long *out);
/* A finite number. */
bool option_double(const char *text, double *out);
/* A number or a quotient of two: "1/255". */
bool option_quotient(const char *text, double *out);
/* "640x480". */
bool option_size(const char *text, int *width, int *height);
/* "x0,y0,x1,y1" with x0 < x1 and y0 < y1, none negative. */
bool option_region(const char *text, int region[4]);
/* Bytes: "8G", "512M", "1.5g", "4096". */
bool option_bytes(const char *text, size_t *out);
/* POV-Ray's truth: on, yes, true, 1, and their opposites, in either case. */
bool option_truth(const char *text, bool *out);
/* The index of `text` among `words` (ended by NULL), or -1. */
int option_word(const char *text, const char *const *words);

#endif
