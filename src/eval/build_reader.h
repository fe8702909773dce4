/* How builders read their items: words are looked up in tables of rules, arguments are promoted and checked, and whatever
 * does not fit becomes a diagnostic at its own span. A builder is then little more than its table. */
#ifndef VTS_EVAL_BUILD_READER_H
#define VTS_EVAL_BUILD_READER_H

#include "eval/block.h"

typedef struct Reader Reader;

/* A word of a block with what belongs to it, however it was written: `phase 0.3`, `count 4 { … }`, `mapping { … }`. */
typedef struct Word {
    const char *text;
    Span span; /* of the word alone */
    Span whole;
    const Argument *arguments;
    size_t count;
    const EvalBlock *body; /* NULL: no { … } */
} Word;

/* Reads a word that needs more than one of the shapes below. `target` is the struct that the table fills. */
typedef void WordHandler(Reader *reader, const Word *word, void *target);

typedef enum WordShape {
    WORD_MARK,     /* bool: true; takes no argument */
    WORD_FLAG,     /* bool: true; an optional float argument decides */
    WORD_FLOAT,    /* double */
    WORD_POSITIVE, /* double, > 0 */
    WORD_INT,      /* int; fractions are an error */
    WORD_VECTOR,   /* Vec3; a float stands for all three components */
    WORD_COLOR,    /* Color; a float stands for red, green and blue */
    WORD_IGNORED,  /* accepted with any arguments: has no meaning here */
    WORD_INERT,    /* accepted with any arguments: one InertNote, at offset a `const InertNote *` */
    WORD_CUSTOM,   /* handler */
} WordShape;

typedef struct WordRule {
    const char *text;
    WordShape shape;
    size_t offset; /* of the field in the target */
    WordHandler *handler;
    bool once; /* a second one is an error */
} WordRule;

typedef struct WordTable {
    const WordRule *rules;
    size_t count;
    void *target;
} WordTable;

enum { READER_TABLES = 4 };

struct Reader {
    BuildContext *context;
    const EvalBlock *block;
    size_t next; /* item */
    bool failed; /* an error was reported */
    WordTable tables[READER_TABLES];
    size_t table_count;
    uint64_t met; /* bit i: rule i of the first table was read */
    /* Values that are not words: the handler says whether it took the value. NULL: none are expected. */
    bool (*on_value)(Reader *reader, const Argument *value, void *target);
    /* Words that no table knows: whether the handler did. */
    bool (*on_word)(Reader *reader, const Word *word, void *target);
    void *value_target; /* of both */
    struct {
        const WordRule *rule;
        Span span;
    } * seen; /* `once` rules met so far */
    size_t seen_count, seen_capacity;
};

Reader reader_begin(BuildContext *context, const EvalBlock *block);
void reader_add_table(Reader *reader, const WordRule *rules, size_t count, void *target);
/* Reads all items that are left; false when anything was wrong. */
bool reader_run(Reader *reader);
/* Reports that none of the `words` follows `word`, and takes what does. */
void reader_expect_word(Reader *reader, const Word *word, const char *words);
/* Looks one word up in the tables and reads it. */
void reader_word(Reader *reader, const Word *word);

/* The words of an item; false for plain values and entries. */
bool item_as_word(const BlockItem *item, Word *out);
const BlockItem *reader_peek(const Reader *reader);
/* Whether the next item is the word `text`; it is taken then. */
bool reader_take_word(Reader *reader, const char *text, Word *out);
/* Whether the next item is a value of this kind; it is taken then. */
bool reader_take_value(Reader *reader, ValueKind kind, Argument *out);
/* The next item must be a value: `what` names it in messages ("the radius"). */
bool reader_float(Reader *reader, const char *what, double *out, Span *span);
bool reader_vector(Reader *reader, const char *what, Vec3 *out, Span *span);
/* The body of a word (or block) as a reader of its own. Add its failure to the parent with reader_end_nested(). */
Reader reader_nested(Reader *parent, const EvalBlock *body);
bool reader_end_nested(Reader *parent, Reader *nested);

/* Arguments of a word. `index` past the end is an error, unless a default is wanted: test word->count first. */
bool word_float(Reader *reader, const Word *word, size_t index, double *out);
bool word_int(Reader *reader, const Word *word, size_t index, int *out);
bool word_vector(Reader *reader, const Word *word, size_t index, Vec3 *out);
bool word_color(Reader *reader, const Word *word, size_t index, Color *out);
bool word_string(Reader *reader, const Word *word, size_t index, const char **out);
/* At least `low` and at most `high` arguments; what is more goes to the block as values, if it takes them. */
bool word_arguments(Reader *reader, const Word *word, size_t low, size_t high);

/* Promotions; a value of the wrong kind is an error that begins with `what` ("'threshold'"). Not finite is one too. */
bool argument_float(Reader *reader, const Argument *argument, const char *what, double *out);
bool argument_vector(Reader *reader, const Argument *argument, const char *what, Vec3 *out);
bool argument_color(Reader *reader, const Argument *argument, const char *what, Color *out);
/* A function with this many parameters and components. */
bool argument_function(Reader *reader, const Argument *argument, const char *what, int parameters,
                       int components, const Tape **out);

/* Whether so many vertices are within the limit; an error at the span else. */
bool reader_mesh_fits(Reader *reader, Span span, double vertices);

/* Report an error at a span and mark the reader as failed. */
Diagnostic *reader_error(Reader *reader, Span span, const char *format, ...) VTS_PRINTF(3, 4);
/* "'mapping' takes a float, found a vector" */
void reader_mismatch(Reader *reader, Span span, const char *what, const char *wanted, ValueKind found);
/* source_blame_after() of a span of the block. */
Span reader_after(const Reader *reader, Span span);
/* The closing brace of the block: for what is found wrong when all of it is read. */
Span reader_close(const Reader *reader);
/* The same for a word that nobody knows, with the nearest of the tables' words as a hint. */
void reader_unknown_word(Reader *reader, const Word *word);
/* A name that nothing was declared as, with the nearest declared one as a hint. */
void reader_undeclared(Reader *reader, const char *name, Span span);
/* Adds a note to a list of things that stay undrawn. */
void inert_add(const BuildContext *context, const InertNote **list, const char *word, Span span);

#endif
