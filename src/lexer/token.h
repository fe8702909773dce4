/* Tokens: what the parser sees of a source file. A file is lexed once; bodies of loops, branches and macros are ranges of
 * its tokens. */
#ifndef VTS_LEXER_TOKEN_H
#define VTS_LEXER_TOKEN_H

#include "base/diag.h"
#include "base/intern.h"

/* KW_NONE, then one KW_word for each line of keywords.def. */
typedef enum Keyword {
    KW_NONE,
#define KEYWORD(class, word) KW_##word,
#include "lexer/keywords.def"
#undef KEYWORD
    KW_COUNT
} Keyword;

typedef enum KeywordClass {
    KEYWORD_NONE,
    KEYWORD_CONSTANT,
    KEYWORD_FUNCTION,
    KEYWORD_COLOR,
    KEYWORD_DIRECTIVE,
    KEYWORD_WORD
} KeywordClass;

typedef enum TokenKind {
    TOKEN_END, /* of the file, or of the range that is being read */
    TOKEN_NUMBER,
    TOKEN_STRING,
    TOKEN_WORD,      /* keyword or identifier */
    TOKEN_DIRECTIVE, /* # and its word in one; keyword is KW_NONE for a word that is no directive */
    TOKEN_VALUE,     /* made while macros are expanded: a name replaced by its value */
    TOKEN_BROKEN,    /* cannot be read; keyword holds a BrokenKind */
    TOKEN_LIST,      /* all that stands in a '{ }', where that is many numbers and vectors */
    /* The single characters stand for themselves; these have two. */
    TOKEN_LESS_EQUAL = 128,
    TOKEN_GREATER_EQUAL,
    TOKEN_NOT_EQUAL,
} TokenKind;

typedef enum BrokenKind {
    BROKEN_NOTHING,
    BROKEN_COMMENT, /* has no end; as.number is the line where it begins, the span that of the token before it */
    BROKEN_STRING, /* has no end */
    BROKEN_ESCAPE,
    BROKEN_UNICODE,
    BROKEN_DIRECTIVE, /* # without a word */
} BrokenKind;

struct Value;

/* A float or a vector of a long list. */
typedef struct ListedNumber {
    Span span;
    uint32_t size; /* 1 to 3 */
    double components[3]; /* of a float three times the same; of what a vector has not 0 */
} ListedNumber;

typedef struct ListedNumbers {
    ListedNumber *items;
    size_t count, capacity;
} ListedNumbers;

typedef struct Token {
    uint8_t kind; /* TokenKind or a character */
    bool
        unbalanced; /* directive that opens a group: a branch has brackets that it does not close, or closes others */
    uint16_t keyword; /* Keyword of a word or directive */
    Span span;
    /* Of an opening bracket: the index of its closing one. Of a directive that opens a group or continues it (if, else, case …):
     * the index of the next one of its group, up to #end or, if that is missing, to TOKEN_END. 0: none, or brackets interleave. */
    uint32_t match;
    union {
        double number;
        Name name; /* word; directive: the word after # */
        struct TokenString *string;
        const struct Value *value;
        const ListedNumbers *list;
    } as;
} Token;

typedef struct TokenString {
    const char *text; /* escapes decoded */
    size_t length;
} TokenString;

typedef struct TokenList {
    const SourceFile *file;
    const Token *items; /* count tokens, the last being TOKEN_END */
    uint32_t count;
    bool balanced; /* all brackets and groups of the file close within it */
} TokenList;

#endif
