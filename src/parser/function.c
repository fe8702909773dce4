/* function (…) { … } and array […] { … }. */
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

/* array = "array" ["mixed"] { "[" expression "]" } [body] */
Node *parser_array(Parser *p) {
    Token word = parser_take(p);
    Node *n = parser_node(p, NODE_ARRAY, word.span);
    const Token *t = parser_peek(p);
    if (t->kind == TOKEN_WORD && strcmp(t->as.name->text, "mixed") == 0) {
        n->op = 1;
        parser_take(p);
    }
    p->brackets++;
    while (parser_accept(p, '[')) {
        Node *e = parser_expression(p);
        if (!e || !parser_expect(p, ']', "']'")) return NULL;
        *list_push(p->arena, &n->as.array.dimensions) = e;
    }
    p->brackets--;
    if (parser_peek(p)->kind == '{') {
        n->as.array.body = parser_body(p, NULL);
        if (!n->as.array.body) return NULL;
    }
    n->span = span_join(word.span, p->last.span);
    return n;
}
