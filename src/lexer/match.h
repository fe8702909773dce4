/* Which bracket closes which, and which #end belongs to which #if: found once, right after lexing. */
#ifndef VTS_LEXER_MATCH_H
#define VTS_LEXER_MATCH_H

#include "lexer/token.h"

/* Fills in Token.match and Token.unbalanced. Brackets that a branch opens without closing (or closes without opening) have no match:
 * `#if (A) sphere { 0, #else box { -1, #end 2 }` is legal, and means that this text must be read with its directives run.
 * Returns whether everything closes within the file. */
bool token_match(Token *tokens, uint32_t count, Arena *arena);

#endif
