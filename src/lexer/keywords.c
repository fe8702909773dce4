#include "lexer/lexer.h"

#include <string.h>

static const struct {
    const char *text;
    KeywordClass class;
} keyword_info[KW_COUNT] = {
    [KW_NONE] = {"", KEYWORD_NONE},
#define KEYWORD(class_name, word) [KW_##word] = {#word, KEYWORD_##class_name},
#include "lexer/keywords.def"
#undef KEYWORD
};

KeywordClass keyword_class(Keyword keyword) { return keyword_info[keyword].class; }
const char *keyword_text(Keyword keyword) { return keyword_info[keyword].text; }

bool keyword_is_directive(Keyword keyword) {
    return keyword_info[keyword].class == KEYWORD_DIRECTIVE || keyword == KW_version;
}

void keyword_table_init(KeywordTable *table, Interner *names, Arena *arena) {
    *table = (KeywordTable){.names = names};
    for (int k = 1; k < KW_COUNT; k++) {
        table->name_of[k] = intern_cstr(names, keyword_info[k].text);
        if (table->name_of[k]->id >= table->count) table->count = table->name_of[k]->id + 1;
    }
    table->by_id = arena_new_array(arena, uint16_t, table->count);
    for (int k = 1; k < KW_COUNT; k++) table->by_id[table->name_of[k]->id] = (uint16_t)k;
}
