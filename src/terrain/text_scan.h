/* Words and numbers of large texts, from a file of any length through a small buffer. */
#ifndef VTS_TERRAIN_TEXT_SCAN_H
#define VTS_TERRAIN_TEXT_SCAN_H

#include "base/common.h"

#include <stdio.h>

enum { SCAN_BUFFER = 1 << 16, SCAN_LONGEST_WORD = 256 };

typedef struct TextScan {
    FILE *file;
    size_t at, size;
    char buffer[SCAN_BUFFER];
} TextScan;

/* The next word that is not blank, which stays where it is until the next call; NULL at the end. Longer ones come in pieces. */
const char *text_scan_peek(TextScan *scan, size_t *size);
/* Goes past a word that was peeked. */
static inline void text_scan_skip(TextScan *scan, size_t size) { scan->at += size; }

/* A number that takes all of a word, in the C locale; a decimal comma is understood. "nan" and what compilers' libraries print for it are
 * NaN. False when the word is none. */
bool text_number(const char *word, size_t size, double *out);

#endif
