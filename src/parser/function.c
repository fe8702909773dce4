/* function (…) { … }, array […] { … } and dictionary { … }. */
#include "parser/parser.h"

#include <string.h>

/* function = "function" ["(" identifier { "," identifier } ")"] "{" (full { "," full } | vector | block) "}" */
Node *parser_function(Parser *p) {
    Token word = parser_take(p);
    Node *n = parser_node(p, NODE_FUNCTION, word.span);
    struct {
        Name *items;
        size_t count, capacity;
    } names = {0};
    p->raw = true;
    if (parser_accept(p, '(')) {
        for (;;) {
            p->raw = true;
            if (parser_peek(p)->kind == ')' && names.count) break;
            Token name = parser_take(p);
            if (name.kind != TOKEN_WORD)
                return parser_fail(p, name.span, "expected the name of a parameter, found %s",
                                   parser_found(p, &name));
            *list_push(p->arena, &names) = name.as.name;
            if (!parser_accept(p, ',')) break;
        }
        if (!parser_expect(p, ')', "',' or ')'")) return NULL;
    }
    n->as.function.parameters = names.items;
    n->as.function.count = names.count;
    /* function 300, 300 { … }: a resolution, for pictures made of it */
    if (parser_peek(p)->kind != '{' && names.count == 0)
        if (!(n->as.function.columns = parser_expression(p)) || !parser_expect(p, ',', "'{'") ||
            !(n->as.function.rows = parser_expression(p)))
            return NULL;
    Parser outer = *p;
    p->parameters = names.items;
    p->parameter_count = names.count;
    bool ok = parser_expect(p, '{', "'{'");
    p->brackets = 1;
    if (ok && parser_peek_after(p)->kind == '{') {
        p->in_function =
            false; /* pigment, pattern, spline, transform: a block like any other, but the function evaluates it */
        p->unfolded = true;
        p->parameter_count = 0;
    } else {
        p->in_function = true;
    }
    while (ok && !p->failed && parser_peek(p)->kind != '}') {
        Node *e = parser_full(p);
        if (!e)
            ok = false;
        else
            *list_push(p->arena, &n->as.function.body) = e;
        if (!parser_accept(p, ',')) break;
    }
    p->in_function = outer.in_function;
    p->unfolded = outer.unfolded;
    p->parameters = outer.parameters;
    p->parameter_count = outer.parameter_count;
    if (!ok || !parser_expect(p, '}', "an operator or '}'")) return NULL;
    p->brackets = outer.brackets;
    n->span = span_join(word.span, p->last.span);
    return n;
}

static bool is_word(const Token *t, const char *text) {
    return t->kind == TOKEN_WORD && !t->keyword && strcmp(t->as.name->text, text) == 0;
}

static bool accept_mixed(Parser *p) {
    p->raw = true;
    if (!is_word(parser_peek(p), "mixed")) return false;
    parser_take(p);
    return true;
}

/* array = "array" ["mixed"] { "[" expression "]" } [body] */
Node *parser_array(Parser *p) {
    Token word = parser_take(p);
    Node *n = parser_node(p, NODE_ARRAY, word.span);
    n->op = accept_mixed(p);
    p->brackets++;
    while (parser_accept(p, '[')) {
        Node *e = parser_expression(p);
        if (!e || !parser_expect(p, ']', "']'")) return NULL;
        *list_push(p->arena, &n->as.array.dimensions) = e;
    }
    p->brackets--;
    if (!n->op) n->op = accept_mixed(p);
    if (parser_peek(p)->kind == '{') {
        n->as.array.body = parser_body(p, NULL);
        if (!n->as.array.body) return NULL;
    }
    n->span = span_join(word.span, p->last.span);
    return n;
}

bool parser_begins_dictionary(Parser *p) {
    const void *macro;
    return !p->in_function && is_word(parser_peek(p), "dictionary") && parser_peek_after(p)->kind != '(' &&
           parser_classify(p, parser_peek(p)->as.name, &macro) == NAME_UNKNOWN;
}

/* dictionary_key = "." word | "[" full "]" | string | word */
static Node *dictionary_key(Parser *p) {
    bool dotted = parser_accept(p, '.');
    if (!dotted && parser_accept(p, '[')) {
        Node *e = parser_full(p);
        return e && parser_expect(p, ']', "']'") ? e : NULL;
    }
    p->raw = true;
    const Token *t = parser_peek(p);
    if (t->kind != TOKEN_WORD && (dotted || t->kind != TOKEN_STRING))
        return parser_fail(p, t->span, "expected a key of the dictionary");
    Node *n = parser_node(p, t->kind == TOKEN_WORD ? NODE_NAME : NODE_STRING, t->span);
    if (t->kind == TOKEN_WORD)
        n->as.name = t->as.name;
    else
        n->as.string = t->as.string;
    parser_take(p);
    return n;
}

/* dictionary = "dictionary" ["{" { dictionary_key (":" | "=") full [","] } "}"] */
Node *parser_dictionary(Parser *p) {
    Token word = parser_take(p);
    Node *n = parser_node(p, NODE_DICTIONARY, word.span);
    if (p->slow && p->host->after(p->host->context, 0)->kind != '{') return n;
    if (!parser_accept(p, '{')) return n;
    p->brackets++;
    /* Keys are words as they stand, whatever they mean elsewhere. */
    for (p->raw = true; !p->failed && parser_peek(p)->kind != '}'; p->raw = true) {
        Node *key = dictionary_key(p);
        if (!key) return NULL;
        if (!parser_accept(p, '=') && !parser_expect(p, ':', "':'")) return NULL;
        Node *value = parser_full(p);
        if (!value) return NULL;
        *list_push(p->arena, &n->as.list) = key;
        *list_push(p->arena, &n->as.list) = value;
        parser_accept(p, ',');
    }
    p->brackets--;
    if (!parser_expect(p, '}', "'}'")) return NULL;
    n->span = span_join(word.span, p->last.span);
    return n;
}
