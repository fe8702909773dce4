#include "parser/parser.h"

#include <stdio.h>

const Token *parser_peek(Parser *p) {
    static const Token end = {.kind = TOKEN_END};
    const Token *t = &p->window;
    if (p->failed) return &end;
    if (!p->slow) {
        t = p->at < p->end ? &p->list->items[p->at] : &end;
    } else if (!p->has_window) {
        p->window = p->host->pull(p->host->context, p);
        p->has_window = true;
        p->raw = false;
        if (p->failed) return &end;
    }
    if (t->kind != TOKEN_BROKEN) return t;
    if (p->slow) token_report_broken(p->diags, t);
    p->failed = true;
    return &end;
}

/* The token after the next, as it is written. */
const Token *parser_peek_after(Parser *p) {
    static const Token end = {.kind = TOKEN_END};
    if (p->slow) {
        parser_peek(p);
        return p->failed ? &end : p->host->after(p->host->context, 0);
    }
    return p->at + 1 < p->end ? &p->list->items[p->at + 1] : &end;
}

Token parser_take(Parser *p) {
    p->last = *parser_peek(p);
    if (p->slow)
        p->has_window = false;
    else if (p->at < p->end)
        p->at++;
    return p->last;
}

bool parser_at_end(Parser *p) { return parser_peek(p)->kind == TOKEN_END; }

bool parser_accept(Parser *p, int kind) {
    if (parser_peek(p)->kind != kind) return false;
    parser_take(p);
    return true;
}

bool parser_accept_keyword(Parser *p, Keyword keyword) {
    const Token *t = parser_peek(p);
    if (t->kind != TOKEN_WORD || t->keyword != keyword) return false;
    parser_take(p);
    return true;
}

Span parser_here(Parser *p) {
    const Token *t = parser_peek(p);
    if (t->kind != TOKEN_DIRECTIVE && (t->kind != TOKEN_END || t->span.end > t->span.begin)) return t->span;
    /* Directives may have run since: then where the text ends. */
    if (t->kind == TOKEN_END && t->span.file == p->last.span.file && t->span.begin > p->last.span.end)
        return t->span;
    return (Span){p->last.span.file, p->last.span.end, p->last.span.end};
}

bool parser_expect(Parser *p, int kind, const char *what) {
    if (parser_accept(p, kind)) return true;
    const Token *t = parser_peek(p);
    parser_fail(p, parser_here(p), "expected %s, found %s", what, parser_found(p, t));
    return false;
}

static Node *fail(Parser *p, Span span, const char *hint, const char *format, va_list args) {
    bool report = (p->slow || p->reports) && !p->failed;
    p->failed = true;
    if (!report) return NULL;
    if (diag_error_before(p->diags, span)) {
        p->diags->failures++;
        return NULL;
    }
    Diagnostic *d = diag_error_va(p->diags, span, format, args);
    if (hint) diag_hint(p->diags, d, "%s", hint);
    return NULL;
}

Node *parser_fail(Parser *p, Span span, const char *format, ...) {
    va_list args;
    va_start(args, format);
    fail(p, span, NULL, format, args);
    va_end(args);
    return NULL;
}

Node *parser_fail_hint(Parser *p, Span span, const char *hint, const char *format, ...) {
    va_list args;
    va_start(args, format);
    fail(p, span, hint, format, args);
    va_end(args);
    return NULL;
}

const char *parser_found(Parser *p, const Token *token) {
    return token_describe(token, p->diags->sources, p->arena);
}

Node *parser_give_up(Parser *p) {
    p->failed = true;
    return NULL;
}

Node *parser_node(Parser *p, NodeKind kind, Span begin) {
    Node *n = arena_new(p->arena, Node);
    n->kind = (uint8_t)kind;
    n->span = begin;
    return n;
}

bool parser_enter(Parser *p) {
    if (++p->depth <= PARSER_DEPTH_LIMIT) return true;
    parser_fail(p, parser_here(p), "nested too deeply");
    return false;
}

NameClass parser_classify(Parser *p, Name name, const void **macro) {
    *macro = NULL;
    NameClass class = p->host->classify(p->host->context, name, macro);
    if (!p->slow) *list_push(p->arena, &p->assumptions) = (Assumption){name, class, *macro, BIND_NONE, NULL};
    return class;
}

static void never_closed(Parser *p, const Token *open, Span end, const char *name) {
    p->failed = true;
    Diagnostic *d = diag_error(p->diags, end, "the text ends, but '%c' is missing for '%s'",
                               open->kind == '[' ? ']' : '}', name);
    diag_note(p->diags, d, open->span, "opened here");
}

static bool is_misplaced(Parser *p, Name block) {
    const Token *t = parser_peek(p);
    return block && t->kind == TOKEN_WORD && t->keyword && parser_peek_after(p)->kind == '{' &&
           nesting_never((int)keyword_of(p->keywords, block), t->keyword);
}

static Node *missing_close(Parser *p, const Token *open, Name block) {
    const Token *t = parser_peek(p);
    Diagnostic *d = diag_error(p->diags, t->span, "'%s' has no place in '%s': is a '}' missing before it?",
                               t->as.name->text, block->text);
    diag_note(p->diags, d, open->span, "opened here");
    return parser_give_up(p);
}

/* A block among the items of one whose end is not in sight: its mistakes are met before what follows. */
static Node *fold_block(Parser *p, Node *n) {
    size_t failures = p->diags->failures;
    n = parser_fold(p, n);
    if (p->diags->failures != failures) p->failed = true;
    return n;
}
static void wrong_bracket(Parser *p, const Token *open, int close) {
    const Diagnostic *before = p->diags->last;
    parser_expect(p, close, close == ']' ? "']'" : "'}'");
    if (p->diags->last != before) diag_note(p->diags, p->diags->last, open->span, "opened here");
}

static bool is_closing(const Token *t) { return t->kind == '}' || t->kind == ']' || t->kind == ')'; }

/* body = "{" statements "}" | "[" statements "]": a range of tokens where its end is known, else its statements now. */
Body *parser_body(Parser *p, Name block) {
    Token open = parser_take(p);
    Body *body = arena_new(p->arena, Body);
    if (!p->slow) {
        if (open.match == 0 || open.match >= p->end) return parser_give_up(p), NULL;
        if (p->host->holds_half_macro &&
            p->host->holds_half_macro(p->host->context, p->list, p->at, open.match))
            return parser_give_up(p), NULL;
        *body = (Body){.tokens = p->list, .begin = p->at, .end = open.match};
        p->at = open.match;
        parser_take(p);
        return body;
    }
    /* Within a block that is read as it is expanded, a body kept for later would see what its text's loops and macros
     * have left behind. */
    if (!p->expanding && p->host->take_body(p->host->context, body)) {
        if (body->tokens) p->last = body->tokens->items[body->end];
        return body;
    }
    Name outer = p->block;
    int brackets = p->brackets;
    bool expanding = p->expanding;
    p->block = block;
    p->brackets = 1;
    p->expanding = true;
    int close = open.kind == '[' ? ']' : '}';
    if (!parser_enter(p)) return NULL;
    while (!p->failed && !is_closing(parser_peek(p)) && !parser_at_end(p)) {
        Node *n = is_misplaced(p, block) ? missing_close(p, &open, block) : parser_statement(p);
        if (n && n->kind == NODE_BLOCK) n = fold_block(p, n);
        if (n) *list_push(p->arena, &body->items) = n;
    }
    parser_leave(p);
    p->block = outer;
    p->brackets = brackets;
    p->expanding = expanding;
    if (!p->failed && !parser_accept(p, close)) {
        const char *name = block ? block->text : "array";
        const Token *t = parser_peek(p);
        if (t->kind == TOKEN_END)
            never_closed(p, &open, t->span, name);
        else
            wrong_bracket(p, &open, close);
    }
    return p->failed ? NULL : body;
}

/* The "." of a target: an entry of a dictionary. */
static Node *target_entry(Parser *p, Node *base) {
    parser_take(p);
    p->raw = true;
    Token word = parser_take(p);
    if (word.kind != TOKEN_WORD) return parser_fail(p, word.span, "expected a name after '.'");
    Node *n = parser_node(p, NODE_DOT, span_join(base->span, word.span));
    n->as.operand.a = base;
    n->as.operand.b = parser_node(p, NODE_NAME, word.span);
    n->as.operand.b->as.name = word.as.name;
    return n;
}

/* Nothing is pulled on the slow road to find out: that would run the directives that come next. */
static bool target_continues(Parser *p, int kind) {
    if (p->slow && !p->has_window && p->host->after(p->host->context, 0)->kind != kind) return false;
    return parser_peek(p)->kind == kind;
}

/* target = identifier { "[" expression "]" | "." word } */
Node *parser_target(Parser *p) {
    p->raw = true;
    const Token *t = parser_peek(p);
    if (t->kind != TOKEN_WORD)
        return parser_fail(p, parser_here(p), "expected a name, found %s", parser_found(p, t));
    if (t->keyword)
        return parser_fail(p, t->span, "'%s' is a word of the language: it cannot be a name",
                           t->as.name->text);
    Token name = parser_take(p);
    Node *n = parser_node(p, NODE_NAME, name.span);
    n->as.name = name.as.name;
    p->brackets++;
    while (!p->failed) {
        if (target_continues(p, '.')) {
            n = target_entry(p, n);
            if (!n) return NULL;
            continue;
        }
        if (!target_continues(p, '[')) break;
        parser_take(p);
        Node *index = parser_node(p, NODE_INDEX, n->span);
        index->as.apply.base = n;
        Node *e = parser_expression(p);
        if (!e || !parser_expect(p, ']', "']'")) return NULL;
        *list_push(p->arena, &index->as.apply.list) = e;
        index->span = span_join(n->span, p->last.span);
        n = index;
    }
    p->brackets--;
    return n;
}

static bool is_dangling_end(const Token *t) {
    return t->kind == '+' || t->kind == '-' || t->kind == '*' || t->kind == '/' || t->kind == '?' ||
           t->kind == ':' || t->kind == '&' || t->kind == '|' || t->kind == '=' || t->kind == '<' ||
           t->kind == '!' || t->kind == '.' || t->kind == TOKEN_LESS_EQUAL ||
           t->kind == TOKEN_GREATER_EQUAL || t->kind == TOKEN_NOT_EQUAL;
}

static bool is_dangling_begin(const Token *t) {
    return t->kind == '*' || t->kind == '/' || t->kind == '?' || t->kind == ':' || t->kind == '&' ||
           t->kind == '|' || t->kind == '=' || t->kind == '>' || t->kind == '.' || t->kind == '^' ||
           t->kind == TOKEN_LESS_EQUAL || t->kind == TOKEN_GREATER_EQUAL || t->kind == TOKEN_NOT_EQUAL;
}

bool parser_body_is_whole(const Body *body) {
    if (!body->tokens || body->begin >= body->end) return true;
    const Token *items = body->tokens->items;
    return !is_dangling_begin(&items[body->begin]) && !is_dangling_end(&items[body->end - 1]);
}
