/* L-systems: productions in the notation of Prusinkiewicz & Lindenmayer, The Algorithmic Beauty of Plants (1990, "ABOP"),
 * parametric (sec. 1.10), stochastic (1.7), context-sensitive with brackets and ignored letters (1.8), and the words they
 * derive. turtle.h draws the words. */
#ifndef VTS_GROW_LSYSTEM_H
#define VTS_GROW_LSYSTEM_H

#include "base/diag.h"
#include "tape/tape.h"

#include <stdatomic.h>

/* A piece of the scene's text. */
typedef struct LSystemText {
    const char *text;
    Span span;
} LSystemText;

typedef struct LSystemConstant {
    const char *name;
    double value;
} LSystemConstant;

/* What the text of a scene says. */
typedef struct LSystemSource {
    LSystemText axiom;
    const LSystemText *rules; /* "left < A(l, w) > right : condition -> (weight) successor"; all but letter and arrow may be missing */
    size_t rule_count;
    const LSystemConstant *constants;
    size_t constant_count;
    const char *ignored;      /* letters that are no neighbours */
    int iterations;           /* >= 0 */
    uint64_t seed;
    uint64_t most_segments;   /* letters F and G of a word; letters in all: LSYSTEM_LETTERS times as many */
} LSystemSource;

enum { LSYSTEM_LETTERS = 16, LSYSTEM_MOST_PARAMETERS = 16, LSYSTEM_MOST_ITERATIONS = 100000 };

/* A word: letters, each with parameters first[i] to first[i + 1]. */
typedef struct LSystemWord {
    char *letters;
    uint32_t *first;
    double *parameters;
    size_t count;
} LSystemWord;

typedef struct LSystem LSystem;

/* Reads axiom and productions (65,000 at most). NULL after diagnostics at the texts' spans. All lives in `arena`. */
LSystem *lsystem_read(const LSystemSource *source, Arena *arena, DiagList *diags);

/* The word after all iterations, or sooner if nothing changes any more; in `arena`. What is random hangs on the seed, the
 * iteration and the letter's place in the word alone. Productions that grow past the limits, or make parameters that are no
 * numbers, end in a diagnostic that names production and iteration; `interrupted` (may be NULL) in silence. False then. */
bool lsystem_derive(const LSystem *system, Arena *arena, DiagList *diags, const atomic_bool *interrupted, LSystemWord *word);

/* As it is written: "F(1.5)[+(30)F]"; numbers with 12 digits. */
void lsystem_print(const LSystemWord *word, StrBuf *out);
/* How often a letter stands in it. */
size_t lsystem_count(const LSystemWord *word, char letter);

#endif
