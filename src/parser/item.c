#include "parser/parser.h"

#include <string.h>

/* A word of this block that a scene also declares, `height height/2`: the second is the scene's, as what follows it shows. */
static bool is_value_of_same_name(Parser *p) {
    const Token *t = parser_peek(p);
    const void *macro;
    if (t->kind != TOKEN_WORD || t->keyword || !context_is_item(p->block, t->as.name)) return false;
    int after = parser_peek_after(p)->kind;
    bool ends = after == '+' || after == '-' || after == '*' || after == '/' || after == '.' ||
                after == '[' || after == ',' || after == '}' || after == TOKEN_END;
    return ends && parser_classify(p, t->as.name, &macro) == NAME_PLAIN;
}

/* Colours are arguments where a colour is likely meant: first, after a comma, or after another colour. So `distance 50 color rgb 1` is
 * a word with one argument, and a colour. */
static bool argument_follows(Parser *p, const NodeList *list, bool after_comma) {
    if (list->count == 0 && is_value_of_same_name(p)) return true;
    if (!parser_begins_expression(p, after_comma)) return false;
    if (after_comma || list->count == 0 || !parser_begins_color(p)) return true;
    return list->items[list->count - 1]->kind == NODE_COLOR;
}

/* After a comma: whether an argument follows it, and not the next item of the block. */
static bool argument_after_comma(Parser *p) {
    if (!p->slow) {
        uint32_t at = p->at++;
        bool follows = parser_begins_expression(p, true);
        p->at = at;
        return follows;
    }
    parser_take(p);
    return parser_begins_expression(p, true);
}

/* `red 1 green 0.5` is a colour, but in a picture's block `filter 3, 0.5` is about the palette's entry 3. */
static bool components_make_colors(const Parser *p) {
    static const char *const pictures[] = {"image_map", "bump_map", "material_map", "image_pattern",
                                           "texture"};
    for (size_t i = 0; p->block && i < VTS_ARRAY_COUNT(pictures); i++)
        if (strcmp(p->block->text, pictures[i]) == 0) return false;
    return true;
}

/* `pwr(2, 0)` of a julia_fractal and `xyz(1, 0, 2): 3` of a polynomial */
static bool takes_brackets(Parser *p, const Token *word) {
    bool term = !word->keyword && p->block && strcmp(p->block->text, "polynomial") == 0;
    return (term || word->keyword == KW_pwr) && parser_peek(p)->kind == '(';
}

static Node *bracketed_arguments(Parser *p, Node *word) {
    NodeList *list = &word->as.word.list;
    if (!parser_arguments(p, list)) return NULL;
    if (!parser_accept(p, ':')) return word;
    Node *e = parser_expression(p);
    if (e) *list_push(p->arena, list) = e;
    return e ? word : NULL;
}

/* word = keyword { [","] expression } [body] */
static Node *word_item(Parser *p) {
    Token word = parser_take(p);
    Node *n = parser_node(p, NODE_WORD, word.span);
    n->as.word.word = word.as.name;
    n->as.word.word_span = word.span;
    NodeList *list = &n->as.word.list;
    bool comma = false;
    if (takes_brackets(p, &word)) {
        n = bracketed_arguments(p, n);
        if (n) n->span = span_join(word.span, p->last.span);
        return n;
    }
    while (!p->failed && (argument_follows(p, list, comma) ||
                          (list->count == 0 && parser_begins_component(p) && components_make_colors(p)))) {
        Node *e = parser_begins_component(p) ? parser_color(p) : parser_expression(p);
        if (!e) return NULL;
        *list_push(p->arena, list) = e;
        comma = false;
        if (parser_peek(p)->kind == ',') {
            comma = argument_after_comma(p);
            if (!comma) break;
            if (!p->slow) parser_take(p);
        }
    }
    if (!p->failed && list->count && parser_peek(p)->kind == '{') {
        n->as.word.body = parser_body(p, word.as.name);
        if (!n->as.word.body) return NULL;
    }
    n->span = span_join(word.span, p->last.span);
    return p->failed ? NULL : n;
}

static Node *bracketed(Parser *p, NodeKind kind) {
    Node *n = parser_node(p, kind, parser_peek(p)->span);
    n->as.block.word = p->block;
    n->as.block.body = parser_body(p, p->block);
    if (!n->as.block.body) return NULL;
    n->span = span_join(n->span, p->last.span);
    return n;
}

static bool continues_expression(const Token *t) {
    return t->kind == '*' || t->kind == '/' || t->kind == '+' || t->kind == '-' || t->kind == '.';
}

/* call = identifier macro_arguments: as an item, whatever its macro's body holds are items here too. */
static Node *call_item(Parser *p, const void *macro) {
    if (!p->slow && !p->host->macro_is_whole(p->host->context, macro)) return parser_give_up(p);
    Parser before = *p;
    Token name = parser_take(p);
    Node *call = parser_node(p, NODE_CALL, name.span);
    Node *base = parser_node(p, NODE_NAME, name.span);
    base->as.name = name.as.name;
    call->as.apply.base = base;
    if (!parser_arguments(p, &call->as.apply.list)) return NULL;
    call->span = span_join(name.span, p->last.span);
    if (!continues_expression(parser_peek(p))) return call;
    if (p->host->macro_binding(p->host->context, macro) == BIND_NONE) return parser_give_up(p);
    *p = before;
    return parser_expression(p);
}

/* A declared colour with other components: `White filter 0.7`. */
static Node *value_item(Parser *p) {
    bool name = parser_peek(p)->kind == TOKEN_WORD || parser_peek(p)->kind == TOKEN_VALUE;
    Node *n = parser_expression(p);
    if (!n || !name || p->closed || !parser_begins_component(p) || !components_make_colors(p)) return n;
    return parser_color_from(p, n);
}

/* POV-Ray looks for the arguments in what comes next. */
static Node *call_without_arguments(Parser *p) {
    if (!p->slow) return parser_give_up(p);
    Token name = parser_take(p);
    Span span = parser_here(p);
    Diagnostic *d = diag_error(p->diags, span, "'%s' is a macro: it is called with ( )", name.as.name->text);
    if (span.begin != name.span.end) diag_note(p->diags, d, name.span, "called here");
    return parser_give_up(p);
}

static bool follows_comma(const Parser *p) {
    if (p->slow) return p->last.kind == ',';
    return p->at > 0 && p->list->items[p->at - 1].kind == ',';
}

static Node *named_item(Parser *p) {
    const Token *t = parser_peek(p), *after = parser_peek_after(p);
    bool brace = after->kind == '{';
    if (context_is_item(p->block, t->as.name)) return brace ? parser_block(p) : word_item(p);
    if (brace && context_is_block(t->as.name)) return parser_block(p);
    const void *macro;
    switch (parser_classify(p, t->as.name, &macro)) {
    case NAME_UNKNOWN:
        if (parser_begins_dictionary(p)) return parser_expression(p);
        if (brace) return parser_block(p);
        return after->kind == '(' || p->guessing || follows_comma(p) ? parser_expression(p) : word_item(p);
    case NAME_MACRO:
        if (after->kind != '(') return call_without_arguments(p);
        return call_item(p, macro);
    default: return value_item(p);
    }
}

static Node *keyword_item(Parser *p) {
    const Token *t = parser_peek(p);
    int after = parser_peek_after(p)->kind;
    bool brace = after == '{';
    switch (keyword_class((Keyword)t->keyword)) {
    case KEYWORD_CONSTANT:
        if (parser_is_film_clock(p, t)) return word_item(p);
        return brace ? parser_block(p) : parser_expression(p);
    case KEYWORD_COLOR:
        if (!brace && parser_begins_color(p)) return parser_expression(p);
        break;
    case KEYWORD_FUNCTION: /* `seed 5` of a jitter is a word, seed(5) a function */
        if (after == '(') return parser_expression(p);
        break;
    default: break;
    }
    if (t->keyword == KW_function || t->keyword == KW_array) return parser_expression(p);
    if (parser_begins_component(p) && components_make_colors(p)) return parser_color(p);
    bool bare = (t->keyword == KW_default && brace) || (t->keyword == KW_declare && !p->block) ||
                (t->keyword == KW_include && after == TOKEN_STRING);
    if (bare) { /* old scenes leave the # out */
        uint32_t next;
        parser_take(p);
        return parser_directive(p, p->list, 0, &next);
    }
    return brace ? parser_block(p) : word_item(p);
}

/* statement = directive | word | block | call | body | expression | "," | ";" */
Node *parser_statement(Parser *p) {
    const Token *t = parser_peek(p);
    switch (t->kind) {
    case TOKEN_DIRECTIVE: {
        Token directive = parser_take(p);
        (void)directive;
        uint32_t next;
        return parser_directive(p, p->list, p->slow ? 0 : p->at - 1, &next);
    }
    case '[': return bracketed(p, NODE_ENTRY);
    case '{': return bracketed(p, NODE_LIST);
    case ',':
    case ';': {
        Node *n = parser_node(p, NODE_EMPTY, t->span);
        n->op = t->kind;
        parser_take(p);
        return n;
    }
    case TOKEN_LIST: {
        Node *n = parser_node(p, NODE_NUMBERS, t->span);
        n->as.numbers = t->as.list;
        parser_take(p);
        return n;
    }
    case TOKEN_WORD: return t->keyword ? keyword_item(p) : named_item(p);
    case '}':
    case ')':
    case ']':
    case '>': return parser_fail(p, t->span, "'%c' closes nothing that is open here", t->kind);
    default: return value_item(p);
    }
}
