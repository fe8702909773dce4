#include "cli/spelling.h"

#include <ctype.h>
#include <stdint.h>
#include <string.h>

enum { LONGEST_WORD = 40 };

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

static char lower(char c) { return (char)tolower((unsigned char)c); }

/* Edits (insert, remove, change, swap of neighbours) between two words, case apart. */
static size_t edits_between(const char *a, size_t a_size, const char *b, size_t b_size) {
    size_t rows[3][LONGEST_WORD + 1];
    size_t *before = rows[0], *above = rows[1], *row = rows[2];
    for (size_t j = 0; j <= b_size; j++) above[j] = j;
    for (size_t i = 1; i <= a_size; i++) {
        row[0] = i;
        for (size_t j = 1; j <= b_size; j++) {
            char p = lower(a[i - 1]), q = lower(b[j - 1]);
            row[j] = least(least(above[j], row[j - 1]) + 1, above[j - 1] + (p != q));
            if (i > 1 && j > 1 && p == lower(b[j - 2]) && lower(a[i - 2]) == q)
                row[j] = least(row[j], before[j - 2] + 1);
        }
        size_t *oldest = before;
        before = above;
        above = row;
        row = oldest;
    }
    return above[b_size];
}

Spelling spelling_of(const char *word) { return (Spelling){word, NULL, SIZE_MAX}; }

void spelling_try(Spelling *spelling, const char *candidate) {
    size_t typed = strlen(spelling->word), size = strlen(candidate);
    if (typed > LONGEST_WORD || size > LONGEST_WORD) return;
    size_t edits = edits_between(spelling->word, typed, candidate, size);
    /* A third of the word wrong is a slip; more is another word. */
    if (edits >= spelling->distance || edits > typed / 3 + (typed < 3)) return;
    spelling->best = candidate;
    spelling->distance = edits;
}
