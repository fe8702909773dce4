#include "parser/parser.h"

#include <string.h>

typedef struct ContextBlock {
    const char *word, *items;
} ContextBlock;

static const ContextBlock context_blocks[] = {
#define CONTEXT_BLOCK(word, items) {#word, " " items " "},
#include "parser/context.def"
#undef CONTEXT_BLOCK
};

static const ContextBlock *find_block(Name word) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(context_blocks); i++)
        if (strcmp(context_blocks[i].word, word->text) == 0) return &context_blocks[i];
    return NULL;
}

bool context_is_block(Name word) { return find_block(word) != NULL; }

bool context_is_item(Name block, Name word) {
    const ContextBlock *found = block ? find_block(block) : NULL;
    if (!found) return false;
    for (const char *p = strstr(found->items, word->text); p; p = strstr(p + 1, word->text))
        if (p[-1] == ' ' && p[word->size] == ' ') return true;
    return false;
}
