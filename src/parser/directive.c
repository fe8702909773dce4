#include "parser/parser.h"

#include <string.h>

/* Where the bodies of a group lie: from the head's end to #else …, known from the tokens' matches. */
typedef struct Group {
    TokenList *list;
    uint32_t at;  /* the first token of the body that comes next */
    uint32_t end; /* the directive that ends it */
} Group;

static void group_begin(TokenList *list, uint32_t index, uint32_t body, Group *out) {
    *out = (Group){list, body, list->items[index].match};
}

static Body group_body(const Group *g) { return (Body){.tokens = g->list, .begin = g->at, .end = g->end}; }

/* The raw position after a head: the fast road's own, or what the host has not pulled yet. */
static uint32_t raw_position(Parser *p) { return p->slow ? p->host->position(p->host->context) : p->at; }

void group_report_stray(DiagList *diags, const Token *t) {
    if (t->keyword == KW_case || t->keyword == KW_range)
        diag_error(diags, t->span, "this #%s belongs to no #switch", t->as.name->text);
    else
        diag_error(diags, t->span, "this #%s belongs to no #if", t->as.name->text);
}

void group_report_endless(DiagList *diags, const TokenList *list, Span head) {
    const Token *end = &list->items[list->count - 1], *last = end - (list->count > 1);
    if (last->kind == TOKEN_BROKEN) {
        token_report_broken(diags, last); /* a string or comment that swallowed the #end */
        return;
    }
    const Token *t = list->items;
    while (t < end && (t->kind != TOKEN_DIRECTIVE || t->span.begin != head.begin)) t++;
    const char *word = t < end ? t->as.name->text : "macro"; /* whose head may have been read from elsewhere */
    Diagnostic *d = diag_error(diags, end->span, "the file ends, but #end is missing for a #%s", word);
    diag_note(diags, d, head, "this #%s has no #end", word);
}

uint32_t group_end(const TokenList *list, uint32_t index) {
    while (list->items[index].kind == TOKEN_DIRECTIVE && list->items[index].match)
        index = list->items[index].match;
    return index;
}

/* On the fast road a branch must make sense by itself. */
static bool bodies_whole(Parser *p, const Node *n, bool unbalanced) {
    if (p->slow || p->heads_only) return true;
    bool whole = !unbalanced;
    if (n->kind == NODE_IF)
        for (size_t i = 0; i < n->as.branches.count; i++)
            whole = whole && parser_body_is_whole(&n->as.branches.branches[i].body);
    else if (n->kind == NODE_SWITCH)
        for (size_t i = 0; i < n->as.switch_.count; i++)
            whole = whole && parser_body_is_whole(&n->as.switch_.cases[i].body);
    else if (n->kind == NODE_WHILE)
        whole = whole && parser_body_is_whole(&n->as.loop.body);
    else
        whole = whole && parser_body_is_whole(&n->as.for_loop.body);
    if (!whole) p->failed = true;
    return whole;
}

/* Past the whole group, whatever else stands between here and its #end. */
static void go_on_after(Parser *p, const Group *g, uint32_t *next) {
    uint32_t end = group_end(g->list, g->end);
    if (g->list->items[end].kind != TOKEN_END) end++;
    if (p->slow)
        *next = end;
    else
        p->at = end;
}

/* On the slow road what follows is not pulled for it: that would run the directives that come next before this one. */
static bool accept_semicolon(Parser *p) {
    if (p->slow && !p->has_window && p->host->after(p->host->context, 0)->kind != ';') return false;
    return parser_accept(p, ';');
}

static Node *in_parentheses(Parser *p) {
    if (!parser_expect(p, '(', "'('")) return NULL;
    p->brackets++;
    Node *e = parser_full(p);
    if (!e || !parser_expect(p, ')', "')'")) return NULL;
    p->brackets--;
    return e;
}

/* No word of the language is ever declared. */
static Node *declared_test(Parser *p) {
    p->raw = true;
    const Token *t = parser_peek(p);
    if (t->kind != TOKEN_WORD || !t->keyword) return parser_target(p);
    Node *never = parser_node(p, NODE_NUMBER, t->span);
    parser_take(p);
    return never;
}

/* A parser of the text from `at` on, as it stands: heads in the middle of a group. */
static Parser head_parser(const Parser *p, TokenList *list, uint32_t at, uint32_t end) {
    Parser inner = *p;
    inner.reports = p->slow;
    inner.slow = false;
    inner.has_window = false;
    inner.list = list;
    inner.at = at;
    inner.end = end;
    return inner;
}

/* After a head that failed: what it said itself, or (half macros and the like, which give up silently) that it cannot be read. */
static Node *head_failed(Parser *p, const Token *head, size_t failures) {
    if (p->diags->failures != failures) return parser_give_up(p);
    return parser_fail(p, head->span, "this #%s must be readable without expanding macros",
                       head->as.name->text);
}

/* if = "#if" "(" full ")" | "#ifdef" "(" target ")" | "#ifndef" "(" target ")" */
static Node *condition(Parser *p, int keyword) {
    if (keyword == KW_if || keyword == KW_elseif) return in_parentheses(p);
    if (!parser_expect(p, '(', "'('")) return NULL;
    Node *target = declared_test(p), *defined = target;
    if (!target || !parser_expect(p, ')', "')'")) return NULL;
    if (target->kind != NODE_NUMBER) {
        defined = parser_node(p, NODE_BUILTIN, target->span);
        defined->op = KW_defined;
        *list_push(p->arena, &defined->as.list) = target;
    }
    if (keyword == KW_ifdef) return defined;
    Node *not = parser_node(p, NODE_UNARY, target->span);
    not ->op = '!';
    not ->as.operand.a = defined;
    return not ;
}

typedef struct BranchList {
    Branch *items;
    size_t count, capacity;
} BranchList;

/* group = if statements { "#elseif" "(" full ")" statements } ["#else" statements] "#end"
 * On the slow road only the head is read; #elseif are read when they are reached (their condition is then a NODE_IF of its own). */
static Node *if_directive(Parser *p, TokenList *list, uint32_t index, uint32_t *next) {
    const Token *head = &list->items[index];
    Node *n = parser_node(p, NODE_IF, head->span);
    Node *test = condition(p, head->keyword);
    Group g;
    if (!test) return NULL;
    group_begin(list, index, raw_position(p), &g);
    BranchList branches = {0};
    *list_push(p->arena, &branches) = (Branch){test, group_body(&g)};
    for (bool else_seen = false; !else_seen;) {
        const Token *t = &list->items[g.end];
        if (t->keyword != KW_elseif && t->keyword != KW_else) break;
        else_seen = t->keyword == KW_else;
        g.at = g.end + 1;
        Node *other = NULL;
        if (t->keyword == KW_elseif) {
            /* On both roads the condition is read as it stands. */
            size_t failures = p->diags->failures;
            Parser inner = head_parser(p, list, g.at, t->match);
            other = in_parentheses(&inner);
            g.at = inner.at;
            if (!p->slow) p->assumptions = inner.assumptions;
            if (!other) return head_failed(p, t, failures);
        }
        g.end = t->match;
        *list_push(p->arena, &branches) = (Branch){other, group_body(&g)};
    }
    n->as.branches.branches = branches.items;
    n->as.branches.count = branches.count;
    go_on_after(p, &g, next);
    return bodies_whole(p, n, list->items[index].unbalanced) ? n : NULL;
}

/* while = "#while" "(" full ")" statements "#end" */
static Node *while_directive(Parser *p, TokenList *list, uint32_t index, uint32_t *next) {
    Node *n = parser_node(p, NODE_WHILE, list->items[index].span);
    n->as.loop.condition = in_parentheses(p);
    Group g;
    if (!n->as.loop.condition) return NULL;
    group_begin(list, index, raw_position(p), &g);
    n->as.loop.body = group_body(&g);
    go_on_after(p, &g, next);
    return bodies_whole(p, n, list->items[index].unbalanced) ? n : NULL;
}

/* for = "#for" "(" identifier "," expression "," expression ["," expression] ")" statements "#end" */
static Node *for_directive(Parser *p, TokenList *list, uint32_t index, uint32_t *next) {
    Node *n = parser_node(p, NODE_FOR, list->items[index].span);
    if (!parser_expect(p, '(', "'('")) return NULL;
    Node *name = parser_target(p);
    if (!name) return NULL;
    if (name->kind != NODE_NAME) return parser_fail(p, name->span, "the variable of #for is a plain name");
    p->brackets++;
    n->as.for_loop.name = name->as.name;
    if (!parser_expect(p, ',', "','") || !(n->as.for_loop.from = parser_full(p))) return NULL;
    if (!parser_expect(p, ',', "','") || !(n->as.for_loop.to = parser_full(p))) return NULL;
    if (parser_accept(p, ',') && !(n->as.for_loop.step = parser_full(p))) return NULL;
    if (!parser_expect(p, ')', "',' or ')'")) return NULL;
    p->brackets--;
    Group g;
    group_begin(list, index, raw_position(p), &g);
    n->as.for_loop.body = group_body(&g);
    go_on_after(p, &g, next);
    return bodies_whole(p, n, list->items[index].unbalanced) ? n : NULL;
}

static bool case_head(Parser *p, const Token *t, SwitchCase *out) {
    if (t->keyword == KW_else) return true;
    if (!parser_expect(p, '(', "'('") || !(out->low = parser_full(p))) return false;
    if (t->keyword == KW_range && (!parser_expect(p, ',', "','") || !(out->high = parser_full(p))))
        return false;
    return parser_expect(p, ')', "')'");
}

/* switch = "#switch" "(" full ")" { "#case" "(" full ")" statements | "#range" "(" full "," full ")" statements } ["#else" statements] "#end" */
static Node *switch_directive(Parser *p, TokenList *list, uint32_t index, uint32_t *next) {
    Node *n = parser_node(p, NODE_SWITCH, list->items[index].span);
    n->as.switch_.subject = in_parentheses(p);
    Group g;
    if (!n->as.switch_.subject) return NULL;
    group_begin(list, index, raw_position(p), &g);
    n->as.switch_.prelude = group_body(&g);
    struct {
        SwitchCase *items;
        size_t count, capacity;
    } cases = {0};
    for (;;) {
        const Token *t = &list->items[g.end];
        bool is_else = t->keyword == KW_else && cases.count > 0;
        if (t->keyword == KW_end && cases.count == 0)
            return parser_fail(p, t->span, "this #end belongs to a #switch without #case and #range");
        if (t->keyword != KW_case && t->keyword != KW_range && !is_else) break;
        SwitchCase one = {0};
        size_t failures = p->diags->failures;
        Parser inner = head_parser(p, list, g.end + 1, t->match);
        bool ok = case_head(&inner, t, &one);
        if (!p->slow) p->assumptions = inner.assumptions;
        if (!ok) return head_failed(p, t, failures);
        g.at = inner.at;
        g.end = t->match;
        one.body = group_body(&g);
        *list_push(p->arena, &cases) = one;
    }
    n->as.switch_.cases = cases.items;
    n->as.switch_.count = cases.count;
    go_on_after(p, &g, next);
    return bodies_whole(p, n, list->items[index].unbalanced) ? n : NULL;
}

/* `optional` before a parameter, unless it is the name of one. */
static bool is_optional(Parser *p, const Token *t) {
    if (t->keyword || strcmp(t->as.name->text, "optional") != 0) return false;
    p->raw = true;
    return parser_peek(p)->kind == TOKEN_WORD;
}

/* macro = "#macro" identifier "(" [["optional"] identifier { "," ["optional"] identifier }] ")" statements "#end" */
static Node *macro_directive(Parser *p, TokenList *list, uint32_t index, uint32_t *next) {
    Node *n = parser_node(p, NODE_MACRO, list->items[index].span);
    p->raw = true;
    const Token *word = parser_peek(p);
    if (word->kind != TOKEN_WORD)
        return parser_fail(p, word->span, "expected the macro's name, found %s", parser_found(p, word));
    if (word->keyword)
        return parser_fail(p, word->span, "'%s' is a word of the language: it cannot be a name",
                           word->as.name->text);
    n->as.macro.name_span = word->span;
    n->as.macro.name = parser_take(p).as.name;
    struct {
        Name *items;
        size_t count, capacity;
    } names = {0};
    if (!parser_expect(p, '(', "'('")) return NULL;
    bool optional = false;
    for (;;) {
        p->raw = true;
        if (parser_peek(p)->kind != TOKEN_WORD) break;
        Token name = parser_take(p);
        if (is_optional(p, &name)) {
            optional = true;
            name = parser_take(p);
        }
        if (name.keyword)
            return parser_fail(p, name.span, "'%s' is a word of the language: it cannot be a name",
                               name.as.name->text);
        *list_push(p->arena, &names) = name.as.name;
        if (!optional) n->as.macro.required = names.count;
        parser_accept(p, ','); /* POV-Ray does not miss it, and its own includes leave it out */
    }
    if (!parser_expect(p, ')', "',' or ')'")) return NULL;
    Group g;
    group_begin(list, index, raw_position(p), &g);
    if (list->items[g.end].kind != TOKEN_DIRECTIVE) { /* the text ends, or nothing matches */
        if (p->slow) group_report_endless(p->diags, list, n->span);
        return parser_give_up(p);
    }
    if (list->items[g.end].keyword != KW_end)
        return parser_fail(p, list->items[g.end].span, "this #%s stands in a macro, outside of its #if",
                           list->items[g.end].as.name->text);
    n->as.macro.parameters = names.items;
    n->as.macro.count = names.count;
    n->as.macro.body = group_body(&g);
    n->as.macro.unbalanced = list->items[index].unbalanced;
    go_on_after(p, &g, next);
    return n;
}

/* Values that must be followed by a semicolon, as far as their form tells. */
static bool needs_semicolon(const Node *n) {
    switch (n->kind) {
    case NODE_NUMBER:
    case NODE_CONSTANT:
    case NODE_VECTOR:
    case NODE_COLOR:
    case NODE_DOT:
    case NODE_CONDITION:
    case NODE_BINARY: return true;
    case NODE_VALUE:
        return n->op == NODE_NUMBER || n->op == NODE_VECTOR || n->op == NODE_COLOR || n->op == NODE_DOT;
    case NODE_UNARY: return n->op != '(' || needs_semicolon(n->as.operand.a);
    default: return false;
    }
}

/* Values of which only their evaluation will tell. A macro's text may bring the semicolon along. */
static bool may_need_semicolon(const Node *n) {
    int kind = n->kind == NODE_VALUE && n->op ? n->op : n->kind;
    return kind == NODE_NAME || kind == NODE_INDEX || kind == NODE_BUILTIN || kind == NODE_VALUE;
}

/* Where a semicolon is missing: what stands there instead, or the end of what it should follow. */
static Span missing_place(Parser *p) {
    const Token *t = p->slow && !p->has_window ? p->host->after(p->host->context, 0) : parser_peek(p);
    bool nothing = t->kind == TOKEN_END || t->kind == TOKEN_DIRECTIVE;
    return nothing ? (Span){p->last.span.file, p->last.span.end, p->last.span.end} : t->span;
}

/* "deprecated" ["once"] [string]: a note for users of the name, which is not checked here */
static void skip_deprecation(Parser *p) {
    p->raw = true;
    if (!parser_accept_keyword(p, KW_deprecated)) return;
    p->raw = true;
    if (parser_accept_keyword(p, KW_once)) p->raw = true;
    parser_accept(p, TOKEN_STRING);
}

/* What an operator that cannot stand here was meant to say. */
static const char *operator_hint(const Token *t) {
    switch (t->kind) {
    case '=':
    case '<':
    case '>':
    case '&':
    case '|':
    case '?':
    case TOKEN_LESS_EQUAL:
    case TOKEN_GREATER_EQUAL:
    case TOKEN_NOT_EQUAL: return "comparisons, & | and ? : stand in parentheses";
    case '^': return "pow(A, B) raises to a power";
    case ',': return "a vector stands in < >";
    default: return NULL;
    }
}

/* declare = ("#declare" | "#local") ["deprecated" ["once"] [string]] target "=" expression { block } [";"] */
static Node *declare_directive(Parser *p, Token head) {
    Node *n = parser_node(p, NODE_DECLARE, head.span);
    n->as.declare.local = head.keyword == KW_local;
    p->brackets = 0;
    p->crossed = false;
    skip_deprecation(p);
    n->as.declare.target = parser_target(p);
    if (!n->as.declare.target || !parser_expect(p, '=', "'='")) return NULL;
    Node *value = parser_begins_component(p) ? parser_color(p) : parser_layers(p);
    n->as.declare.value = value;
    if (!value) return NULL;
    n->span = span_join(head.span, p->last.span);
    if (p->crossed && needs_semicolon(value)) {
        Diagnostic *d = diag_error(p->diags, value->span, "a directive ends in the middle of this value");
        diag_hint(p->diags, d, "put the value into parentheses");
        p->failed = true;
        return NULL;
    }
    if (accept_semicolon(p)) return n;
    n->as.declare.after = missing_place(p);
    n->as.declare.unended = may_need_semicolon(value) || needs_semicolon(value);
    if (!needs_semicolon(value) || p->semicolons_optional) return n;
    const Token *t = p->slow && !p->has_window ? p->host->after(p->host->context, 0) : parser_peek(p);
    return parser_fail_hint(
        p, n->as.declare.after, operator_hint(t), "expected ';' after the value of '%s', found %s",
        n->as.declare.target->kind == NODE_NAME ? n->as.declare.target->as.name->text : "an array's element",
        parser_found(p, t));
}

static Node *undef_directive(Parser *p, Token head) {
    Node *n = parser_node(p, NODE_UNDEF, head.span);
    Node *target = parser_target(p);
    if (!target) return NULL;
    *list_push(p->arena, &n->as.list) = target;
    return n;
}

static Node *operand_directive(Parser *p, NodeKind kind, Token head) {
    Node *n = parser_node(p, kind, head.span);
    n->op = head.keyword;
    const Token *t = kind == NODE_INCLUDE ? parser_peek(p) : NULL;
    if (t && (t->kind == '<' || (t->kind == TOKEN_WORD && parser_peek_after(p)->kind == '.')))
        return parser_fail(p, t->span, "expected the name of a file in double quotes, found %s",
                           parser_found(p, t));
    n->as.operand.a = parser_expression(p);
    if (!n->as.operand.a) return NULL;
    n->span = span_join(head.span, p->last.span);
    if (kind == NODE_VERSION && !accept_semicolon(p)) {
        n->op = 0;
        n->span = missing_place(p);
    }
    return n;
}

/* fopen = "#fopen" target expression ("read" | "write" | "append") */
static Node *fopen_directive(Parser *p, Token head) {
    Node *n = parser_node(p, NODE_FOPEN, head.span);
    Node *handle = parser_target(p);
    Node *path = handle ? parser_expression(p) : NULL;
    if (!path) return NULL;
    *list_push(p->arena, &n->as.list) = handle;
    *list_push(p->arena, &n->as.list) = path;
    Token mode = parser_take(p);
    if (mode.kind != TOKEN_WORD ||
        (mode.keyword != KW_read && mode.keyword != KW_write && mode.keyword != KW_append))
        return parser_fail(p, mode.span, "expected read, write or append, found %s", parser_found(p, &mode));
    n->op = mode.keyword;
    n->span = span_join(head.span, mode.span);
    return n;
}

static Node *fclose_directive(Parser *p, Token head) {
    Node *n = parser_node(p, NODE_FCLOSE, head.span);
    Node *handle = parser_target(p);
    if (!handle) return NULL;
    *list_push(p->arena, &n->as.list) = handle;
    return n;
}

/* read = "#read" "(" target { "," target } ")" */
static Node *read_directive(Parser *p, Token head) {
    Node *n = parser_node(p, NODE_READ, head.span);
    if (!parser_expect(p, '(', "'('")) return NULL;
    do {
        Node *target = parser_target(p);
        if (!target) return NULL;
        *list_push(p->arena, &n->as.list) = target;
    } while (parser_accept(p, ','));
    return parser_expect(p, ')', "',' or ')'") ? n : NULL;
}

/* write = "#write" "(" target { [","] full } ")" */
static Node *write_directive(Parser *p, Token head) {
    Node *n = parser_node(p, NODE_WRITE, head.span);
    if (!parser_expect(p, '(', "'('")) return NULL;
    Node *handle = parser_target(p);
    if (!handle) return NULL;
    *list_push(p->arena, &n->as.list) = handle;
    p->brackets++;
    while (parser_accept(p, ',') ||
           (!p->failed && parser_peek(p)->kind != ')' && parser_begins_expression(p, true))) {
        if (parser_peek(p)->kind == ')' || parser_peek(p)->kind == ',') continue;
        Node *e = parser_full(p);
        if (!e) return NULL;
        *list_push(p->arena, &n->as.list) = e;
    }
    p->brackets--;
    return parser_expect(p, ')', "',' or ')'") ? n : NULL;
}

static Node *default_directive(Parser *p, Token head) {
    Node *n = parser_node(p, NODE_DEFAULT, head.span);
    n->as.block.word = head.as.name;
    n->as.block.word_span = head.span;
    if (parser_peek(p)->kind != '{') return parser_expect(p, '{', "'{'"), NULL;
    n->as.block.body = parser_body(p, head.as.name);
    return n->as.block.body ? n : NULL;
}

/* What other languages have taught. */
static const char *habit(const char *word) {
    static const char *const words[][2] = {{"define", "declare"}, {"set", "declare"},    {"endif", "end"},
                                           {"endwhile", "end"},   {"next", "end"},       {"endfor", "end"},
                                           {"elif", "elseif"},    {"elsif", "elseif"},   {"foreach", "for"},
                                           {"import", "include"}, {"function", "macro"}, {"def", "macro"},
                                           {"print", "debug"},    {"echo", "debug"},     {"unset", "undef"}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(words); i++)
        if (strcmp(words[i][0], word) == 0) return words[i][1];
    return NULL;
}

static Node *unknown_directive(Parser *p, Token head) {
    if (!p->slow) return parser_give_up(p);
    const char *candidates[64];
    size_t count = 0;
    for (int k = 1; k < KW_COUNT; k++)
        if (keyword_is_directive((Keyword)k)) candidates[count++] = keyword_text((Keyword)k);
    Diagnostic *d = diag_error(p->diags, head.span, "unknown directive '#%s'", head.as.name->text);
    const char *closest = habit(head.as.name->text);
    if (!closest) closest = closest_word(head.as.name->text, candidates, count);
    if (closest) diag_hint(p->diags, d, "did you mean '#%s'?", closest);
    return parser_give_up(p);
}

/* directive = group | while | for | switch | macro | declare | "#undef" target | "#include" expression
 *           | "#version" expression [";"] | ("#debug" | "#warning" | "#error" | "#render" | "#statistics") expression
 *           | "#break" | "#default" body | fopen | "#fclose" target | read | write */
Node *parser_directive(Parser *p, TokenList *list, uint32_t index, uint32_t *next) {
    Token head = p->last;
    *next = 0;
    switch (head.keyword) {
    case KW_if:
    case KW_ifdef:
    case KW_ifndef: return if_directive(p, list, index, next);
    case KW_while: return while_directive(p, list, index, next);
    case KW_for: return for_directive(p, list, index, next);
    case KW_switch: return switch_directive(p, list, index, next);
    case KW_macro: return macro_directive(p, list, index, next);
    case KW_declare:
    case KW_local: return declare_directive(p, head);
    case KW_undef: return undef_directive(p, head);
    case KW_include: return operand_directive(p, NODE_INCLUDE, head);
    case KW_version: return operand_directive(p, NODE_VERSION, head);
    case KW_debug:
    case KW_warning:
    case KW_error:
    case KW_render:
    case KW_statistics: return operand_directive(p, NODE_MESSAGE, head);
    case KW_break: return parser_node(p, NODE_BREAK, head.span);
    case KW_default: return default_directive(p, head);
    case KW_fopen: return fopen_directive(p, head);
    case KW_fclose: return fclose_directive(p, head);
    case KW_read: return read_directive(p, head);
    case KW_write: return write_directive(p, head);
    case KW_else:
    case KW_elseif:
    case KW_end:
    case KW_case:
    case KW_range:
        if (p->slow) group_report_stray(p->diags, &head);
        return parser_give_up(p);
    default: return unknown_directive(p, head);
    }
}
