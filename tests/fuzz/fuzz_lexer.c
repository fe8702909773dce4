/* Whatever the bytes are: tokens lie in the file in order, matches point forwards, printing works. */
#include "fuzz.h"

#include "lexer/lexer.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    Arena arena;
    SourceSet sources;
    DiagList diags;
    Interner names;
    KeywordTable keywords;
    arena_init(&arena, NULL, 0);
    source_set_init(&sources, &arena);
    diag_init(&diags, &arena, &sources);
    interner_init(&names, &arena);
    keyword_table_init(&keywords, &names, &arena);
    const SourceFile *file = source_add_text(&sources, "fuzz", (const char *)data, size);
    TokenList *list = lexer_run(file, &keywords, &arena);
    for (uint32_t i = 0; i < list->count; i++)
        if (list->items[i].kind == TOKEN_BROKEN) token_report_broken(&diags, &list->items[i]);
    for (uint32_t i = 0; i + 1 < list->count; i++) {
        const Token *t = &list->items[i];
        if (t->span.end > file->size || t->span.begin >= t->span.end ||
            t->span.end > list->items[i + 1].span.end)
            abort();
        if (t->match && (t->match <= i || t->match >= list->count)) abort();
    }
    if (list->items[list->count - 1].kind != TOKEN_END) abort();
    StrBuf out = {0};
    lexer_print(list, &sources, &out);
    for (const Diagnostic *d = diags.first; d; d = d->next) diag_format(&out, &sources, d, true);
    strbuf_free(&out);
    arena_destroy(&arena);
    return 0;
}
