/* Inside of L-systems: what the reader of productions leaves to the derivation. */
#ifndef VTS_GROW_LSYSTEM_PARTS_H
#define VTS_GROW_LSYSTEM_PARTS_H

#include "grow/lsystem.h"

/* Numbers in (0, 1) that a production's expressions may ask for: one input of the tape for each rand(a, b). */
enum { LSYSTEM_MOST_RANDOM = 16, LSYSTEM_MOST_FORMALS = 64 };

/* Names that an expression may use. */
typedef struct LSystemScope {
    const char *formals[LSYSTEM_MOST_FORMALS]; /* inputs of the tape, in order */
    int formal_count;
    const LSystemConstant *constants;
    size_t constant_count;
    int random_count; /* inputs after the formals, so far */
} LSystemScope;

/* Where the text is being read. */
typedef struct LSystemReader {
    const LSystemText *source;
    const char *at, *end;
    Arena *arena;
    DiagList *diags;
} LSystemReader;

bool lsystem_fail(LSystemReader *reader, const char *what);
void lsystem_skip_space(LSystemReader *reader);
/* Takes the character if it comes next, after spaces. */
bool lsystem_take(LSystemReader *reader, char c);
/* A name of letters, digits and underscores; NULL if none comes. */
const char *lsystem_name(LSystemReader *reader);

/* An expression up to the first character that does not belong to it: + - * / % ^, comparisons (= and == are the same), & | ! and
 * the functions of lsystem_expression.c. False after a diagnostic. */
bool lsystem_expression(LSystemReader *reader, LSystemScope *scope, TapeBuilder *tape, TapeRef *out);

/* Letters with the counts of their parameters. */
typedef struct LSystemLetters {
    const char *letters;
    const uint8_t *parameter_counts;
    size_t count;
} LSystemLetters;

typedef struct Production {
    const LSystemText *source;
    LSystemLetters left, right;  /* context; the left one from left to right */
    char letter;
    int parameter_count;         /* of the letter itself */
    int formal_count;            /* of all three together, in the order of the text */
    const Tape *guard;           /* formals and random numbers → condition, weight; NULL: neither */
    bool weighted;
    int random_count;            /* that its tapes use */
    LSystemLetters successor;
    size_t segments;             /* among it: F and G */
    const Tape *parameters;      /* formals and random numbers → the successor's parameters; NULL: it has none */
    size_t parameter_total;
} Production;

struct LSystem {
    const LSystemSource *source;
    LSystemWord axiom;
    Production *productions;     /* those of one letter on end: first those with both contexts, then with one, then with none */
    size_t production_count;
    uint32_t first[257];         /* of each letter */
    bool ignored[256];
    bool has_context;            /* any of them */
    size_t scratch;              /* doubles that the largest tape needs */
};

static inline bool lsystem_is_segment(char letter) { return letter == 'F' || letter == 'G'; }

#endif
