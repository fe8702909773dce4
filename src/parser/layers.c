/* texture { … } texture { … } where one value is wanted: layers of one texture. */
#include "parser/parser.h"

/* The token so far ahead, of which the slow road must not make more than a look at the raw text. */
static const Token *ahead(Parser *p, uint32_t steps) {
    if (p->slow && !p->has_window) return p->host->after(p->host->context, steps);
    return steps ? parser_peek_after(p) : parser_peek(p);
}

static bool is_texture(const Token *t) { return t->kind == TOKEN_WORD && t->keyword == KW_texture; }

static bool texture_follows(Parser *p) { return is_texture(ahead(p, 0)) && ahead(p, 1)->kind == '{'; }

/* Made into one texture block that holds them. */
static Node *layers(Parser *p, Node *first, Token word) {
    Node *n = parser_node(p, NODE_BLOCK, first->span);
    n->as.block.word = word.as.name;
    n->as.block.word_span = word.span;
    n->op = BLOCK_OF_LAYERS;
    n->as.block.body = arena_new(p->arena, Body);
    *list_push(p->arena, &n->as.block.body->items) = first;
    while (!p->failed && texture_follows(p)) {
        Node *layer = parser_expression(p);
        if (!layer) return NULL;
        *list_push(p->arena, &n->as.block.body->items) = layer;
    }
    return n;
}

/* layers = expression { block } */
Node *parser_layers(Parser *p) {
    Token first = *ahead(p, 0);
    Node *value = parser_expression(p);
    return value && p->closed && is_texture(&first) && texture_follows(p) ? layers(p, value, first) : value;
}
