/* "Did you mean …": the nearest of some words. */
#ifndef VTS_CLI_SPELLING_H
#define VTS_CLI_SPELLING_H

#include <stddef.h>

/* Keeps the best of the words it was shown. */
typedef struct Spelling {
    const char *word; /* what was typed */
    const char *best; /* NULL: nothing near enough yet */
    size_t distance;
} Spelling;

Spelling spelling_of(const char *word);
void spelling_try(Spelling *spelling, const char *candidate);

#endif
