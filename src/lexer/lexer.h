/* From text to tokens. */
#ifndef VTS_LEXER_LEXER_H
#define VTS_LEXER_LEXER_H

#include "lexer/token.h"

/* The reserved words as names of one interner. */
typedef struct KeywordTable {
    Interner *names;
    uint16_t *by_id; /* Keyword of the name with this id, KW_NONE for ids that are none */
    uint32_t count;
    Name name_of[KW_COUNT];
} KeywordTable;

/* Interns the reserved words, so that from here on a keyword is known by its name's id. The table lives in `arena`. */
void keyword_table_init(KeywordTable *table, Interner *names, Arena *arena);
static inline Keyword keyword_of(const KeywordTable *table, Name name) {
    return name->id < table->count ? (Keyword)table->by_id[name->id] : KW_NONE;
}
KeywordClass keyword_class(Keyword keyword);
/* The word's text; "" for KW_NONE. */
const char *keyword_text(Keyword keyword);
/* Whether the word means something after #. */
bool keyword_is_directive(Keyword keyword);

/* All tokens of a file, in `arena`. What cannot be read (strings and comments that do not end, unknown escapes) becomes a TOKEN_BROKEN,
 * which is reported where it is met: scenes say much before they come to it, and a branch that is skipped may hold it. */
TokenList *lexer_run(const SourceFile *file, const KeywordTable *keywords, Arena *arena);
/* Says what is wrong with a TOKEN_BROKEN. */
void token_report_broken(DiagList *diags, const Token *token);

/* One token a line: place, kind, text. */
void lexer_print(const TokenList *tokens, SourceSet *sources, StrBuf *out);
/* What a token is called in messages: "'+'", "the number 3", "'sphere'", "the end of the file". */
/* For token_describe(): the text that `end` ends is part of a larger one, where `by` comes next. */
void token_set_ending(Token *end, const Token *by);
const char *token_describe(const Token *token, SourceSet *sources, Arena *arena);

#endif
