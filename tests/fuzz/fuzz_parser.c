/* The fast road over every statement of the text, with names of all classes: no crash, and progress with each statement. */
#include "fuzz.h"

#include "parser/parser.h"

#include <stdlib.h>

static NameClass classify(void *context, Name name, const void **macro) {
    (void)context;
    *macro = name;
    return (NameClass)(name->hash % 4);
}

static Binding binding(void *context, const void *macro) {
    (void)context;
    return (Binding)(((Name)macro)->size % 5);
}

static bool is_block(void *context, const void *macro) {
    (void)context;
    return ((Name)macro)->size % 2;
}

/* As the evaluator goes on after a mistake: trying at each token would take the square of the text's length. */
static uint32_t next_statement(const TokenList *list, uint32_t at) {
    for (at++; at + 1 < list->count; at++) {
        if (list->items[at].kind == TOKEN_DIRECTIVE) return at;
        if (list->items[at].kind == ';' || list->items[at].kind == '{') return at + 1;
    }
    return at;
}

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
    TokenList *list =
        lexer_run(source_add_text(&sources, "fuzz", (const char *)data, size), &keywords, &arena);
    ParserHost host = {.classify = classify, .macro_binding = binding, .macro_is_whole = is_block, .macro_is_block = is_block};
    StrBuf out = {0};
    for (uint32_t at = 0; at + 1 < list->count;) {
        Parser p = {.arena = &arena,
                    .diags = &diags,
                    .keywords = &keywords,
                    .host = &host,
                    .list = list,
                    .at = at,
                    .end = list->count - 1};
        size_t errors = diags.error_count;
        Node *n = parser_statement(&p);
        if (diags.error_count != errors) abort(); /* the fast road is silent */
        if (n && p.at <= at) abort();
        if (n && out.size < 100000) ast_print(n, &out, 0);
        at = n ? p.at : next_statement(list, at);
    }
    strbuf_free(&out);
    arena_destroy(&arena);
    return 0;
}
