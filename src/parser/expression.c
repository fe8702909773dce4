#include "parser/parser.h"

#include <string.h>

/* A call at the place of an operand: its macro's body must bind at least as tightly as the operators around it. */
static void require(Node *n, Binding need) {
    if (n->kind == NODE_CALL && n->need < need) n->need = (uint8_t)need;
}

Node *parser_fold(Parser *p, Node *n) {
    if (!n || !p->slow || p->in_function || p->unfolded || p->failed) return n;
    return p->host->fold(p->host->context, n);
}

static Node *binary(Parser *p, int op, Node *a, Node *b) {
    Node *n = parser_node(p, NODE_BINARY, span_join(a->span, b->span));
    n->op = (uint16_t)op;
    n->as.operand.a = a;
    n->as.operand.b = b;
    return n;
}

/* vector = "<" expression { [","] expression } [","] ">" */
static Node *vector(Parser *p) {
    Token open = parser_take(p);
    Node *n = parser_node(p, NODE_VECTOR, open.span);
    p->brackets++;
    while (!p->failed && parser_peek(p)->kind != '>') {
        Node *e = parser_expression(p);
        if (!e) return NULL;
        *list_push(p->arena, &n->as.list) = e;
        if (!parser_accept(p, ',') && parser_peek(p)->kind != '>' && !parser_begins_expression(p, true))
            break;
    }
    if (!parser_expect(p, '>', "',' or '>'")) return NULL;
    p->brackets--;
    n->span = span_join(open.span, p->last.span);
    /* Long ones are coefficients: of a matrix, of a quartic. */
    if (n->as.list.count < 2 || n->as.list.count > VECTOR_LONGEST)
        return parser_fail(p, n->span, "a vector has 2 to 5 components, this one %zu", n->as.list.count);
    return n;
}

/* On the slow road, whether nothing but a name or an element of an array comes next: it goes by reference and is not replaced by its
 * value. */
static bool reference_follows(Parser *p) {
    if (!p->slow || p->has_window) return false;
    const Token *t = p->host->after(p->host->context, 0);
    if (t->kind != TOKEN_WORD || t->keyword) return false;
    int depth = 0;
    for (uint32_t i = 1;; i++) {
        t = p->host->after(p->host->context, i);
        if (t->kind == '[')
            depth++;
        else if (t->kind == ']')
            depth--;
        else if (depth == 0 || t->kind == TOKEN_END)
            return depth == 0 && (t->kind == ',' || t->kind == ')');
    }
}

static bool is_relation(int kind) {
    return kind == '=' || kind == '<' || kind == '>' || kind == TOKEN_LESS_EQUAL ||
           kind == TOKEN_GREATER_EQUAL || kind == TOKEN_NOT_EQUAL;
}

static bool is_comparison(int kind) { return is_relation(kind) || kind == '&' || kind == '|' || kind == '?'; }

/* "(" [[argument] { [","] [argument] } [","]] ")", plain names going by reference. An argument before whose comma there is nothing is
 * left out: an empty node. */
static bool references(Parser *p, NodeList *out, Node *(*argument)(Parser *)) {
    if (!parser_expect(p, '(', "'('")) return false;
    p->brackets++;
    for (;;) {
        if (reference_follows(p)) {
            Node *target = parser_target(p);
            if (!target) return false;
            *list_push(p->arena, out) = target;
        } else if (parser_peek(p)->kind == ',') {
            *list_push(p->arena, out) = parser_node(p, NODE_EMPTY, parser_peek(p)->span);
        } else if (parser_peek(p)->kind == ')' && out->count == 0) {
            break;
        } else {
            Node *e = argument(p);
            if (!e) return false;
            *list_push(p->arena, out) = e;
        }
        /* POV-Ray misses no comma between arguments, and does not mind one after the last. */
        if (!parser_accept(p, ',') && !parser_begins_expression(p, false)) break;
        if (!reference_follows(p) && parser_peek(p)->kind == ')') break;
    }
    const Token *t = parser_peek(p);
    if (is_comparison(t->kind)) {
        parser_fail_hint(p, t->span, "put the comparison in parentheses", "expected ',' or ')', found %s",
                         parser_found(p, t));
        return false;
    }
    if (!parser_expect(p, ')', "',' or ')'")) return false;
    p->brackets--;
    return true;
}

/* macro_arguments = "(" [[layers] { [","] [layers] } [","]] ")"
 * A comparison needs parentheses of its own: in `M(a <1, 2>)` a vector follows. */
bool parser_arguments(Parser *p, NodeList *out) { return references(p, out, parser_layers); }

/* arguments = "(" [full { [","] full } [","]] ")" */
static bool plain_arguments(Parser *p, NodeList *out) {
    if (!parser_expect(p, '(', "'('")) return false;
    p->brackets++;
    while (!p->failed && parser_peek(p)->kind != ')') {
        Node *e = parser_full(p);
        if (!e) return false;
        *list_push(p->arena, out) = e;
        if (!parser_accept(p, ',') && !(parser_peek(p)->kind != ')' && parser_begins_expression(p, false)))
            break;
    }
    if (!parser_expect(p, ')', "',' or ')'")) return false;
    p->brackets--;
    return true;
}

/* builtin = "defined" "(" target ")" | ("sum" | "prod") "(" identifier "," full "," full "," full ")"
 *         | "trace" "(" full "," full "," full ["," target] ")" | function_word arguments */
static Node *builtin(Parser *p) {
    Token word = parser_take(p);
    Node *n = parser_node(p, NODE_BUILTIN, word.span);
    n->op = word.keyword;
    bool ok;
    if (word.keyword == KW_defined) {
        ok = parser_expect(p, '(', "'('");
        p->brackets++;
        Node *target = ok ? parser_target(p) : NULL;
        ok = target && parser_expect(p, ')', "')'");
        p->brackets--;
        if (ok) *list_push(p->arena, &n->as.list) = target;
    } else if (word.keyword == KW_trace || word.keyword == KW_rand || word.keyword == KW_dimensions ||
               word.keyword == KW_dimension_size) {
        ok = references(p, &n->as.list, parser_full);
    } else if ((word.keyword == KW_sum || word.keyword == KW_prod) && !p->in_function) {
        parser_fail(p, word.span, "'%s' exists only inside functions", keyword_text((Keyword)word.keyword));
        ok = false;
    } else if (word.keyword == KW_sum || word.keyword == KW_prod) {
        ok = parser_expect(p, '(', "'('");
        Token name = parser_take(p);
        if (ok && name.kind != TOKEN_WORD)
            parser_fail(p, name.span, "expected the name of the running index, found %s",
                        parser_found(p, &name));
        Node *index = parser_node(p, NODE_NAME, name.span);
        index->as.name = name.as.name;
        *list_push(p->arena, &n->as.list) = index;
        Name *parameters = p->parameters;
        if (!p->failed) {
            p->parameters = arena_new_array(p->arena, Name, p->parameter_count + 1);
            for (size_t i = 0; i < p->parameter_count; i++) p->parameters[i] = parameters[i];
            p->parameters[p->parameter_count++] = name.as.name;
            for (int i = 0; ok && i < 3; i++) {
                Node *e = parser_expect(p, ',', "','") ? parser_full(p) : NULL;
                if (e) *list_push(p->arena, &n->as.list) = e;
                ok = e != NULL;
            }
            p->parameter_count--;
            p->parameters = parameters;
        }
        ok = ok && parser_expect(p, ')', "')'");
    } else {
        ok = plain_arguments(p, &n->as.list);
    }
    n->span = span_join(word.span, p->last.span);
    return ok && !p->failed ? n : NULL;
}

static bool is_parameter(const Parser *p, Name name) {
    for (size_t i = 0; i < p->parameter_count; i++)
        if (p->parameters[i] == name) return true;
    return false;
}

/* name = identifier [macro_arguments | arguments] | block */
static Node *name_or_call(Parser *p) {
    const Token *t = parser_peek(p), *after = parser_peek_after(p);
    if (after->kind == '{' && context_is_block(t->as.name) && !p->in_function) return parser_block(p);
    if (parser_begins_dictionary(p)) return parser_dictionary(p);
    Token word = parser_take(p);
    Node *n = parser_node(p, NODE_NAME, word.span);
    n->as.name = word.as.name;
    if (is_parameter(p, word.as.name)) return n;
    if (parser_peek(p)->kind != '(') {
        if (!p->slow && !p->in_function) {
            const void *macro;
            if (parser_classify(p, word.as.name, &macro) == NAME_MACRO) return parser_give_up(p);
            p->assumptions.count--; /* its being a value or not makes no difference here */
        }
        return n;
    }
    const void *macro;
    NameClass class = parser_classify(p, word.as.name, &macro);
    if (class == NAME_PLAIN) return n;
    if (class == NAME_MACRO && p->in_function && !p->slow) return parser_give_up(p);
    Node *call = parser_node(p, NODE_CALL, word.span);
    call->as.apply.base = n;
    size_t at = p->assumptions.count - 1;
    if (!p->slow) p->assumptions.items[at].call = call;
    NodeList *list = &call->as.apply.list;
    if (!(class == NAME_MACRO     ? parser_arguments(p, list)
          : class == NAME_UNKNOWN ? references(p, list, parser_full)
                                  : plain_arguments(p, list)))
        return NULL;
    call->need = BIND_ANY;
    call->span = span_join(word.span, p->last.span);
    return call;
}

static Node *constant(Parser *p) {
    Token t = parser_take(p);
    Node *n;
    if (is_parameter(p, t.as.name)) {
        n = parser_node(p, NODE_NAME, t.span);
        n->as.name = t.as.name;
    } else {
        n = parser_node(p, NODE_CONSTANT, t.span);
        n->op = t.keyword;
    }
    return n;
}

static Node *value_token(Parser *p) {
    Token t = parser_take(p);
    Node *n = parser_node(p, NODE_VALUE, t.span);
    n->as.value = t.as.value;
    /* Functions and splines: the host marks their tokens with KW_function. */
    if (t.keyword != KW_function || parser_peek(p)->kind != '(') return n;
    Node *call = parser_node(p, NODE_CALL, t.span);
    call->as.apply.base = n;
    if (!plain_arguments(p, &call->as.apply.list)) return NULL;
    call->span = span_join(t.span, p->last.span);
    return call;
}

static Node *parenthesized(Parser *p) {
    Token open = parser_take(p);
    if (parser_begins_color(p))
        return parser_fail_hint(p, parser_peek(p)->span, "declare the colour first", "a colour is no operand, found %s", parser_found(p, parser_peek(p)));
    p->brackets++;
    Node *e = parser_full(p);
    if (!e || !parser_expect(p, ')', "')'")) return NULL;
    p->brackets--;
    /* The brackets themselves keep the macro's body together. */
    Node *n = parser_node(p, NODE_UNARY, span_join(open.span, p->last.span));
    n->op = '(';
    n->as.operand.a = e;
    return n;
}

/* `A == B`, `A && B`, `A ** B` */
static const char *doubled_hint(const Parser *p, const Token *t) {
    if (p->last.kind != t->kind) return NULL;
    return t->kind == '='                     ? "equality is a single ="
           : t->kind == '&' || t->kind == '|' ? "logical and is a single &, or a single |"
           : t->kind == '*'                   ? "pow(A, B) raises to a power"
                                              : NULL;
}

/* primary = number | string | vector | "(" full ")" | constant | builtin | name | block | function | array */
static Node *primary(Parser *p) {
    const Token *t = parser_peek(p);
    Node *n;
    switch (t->kind) {
    case TOKEN_NUMBER:
        n = parser_node(p, NODE_NUMBER, t->span);
        n->as.number = t->as.number;
        parser_take(p);
        return n;
    case TOKEN_STRING:
        n = parser_node(p, NODE_STRING, t->span);
        n->as.string = t->as.string;
        parser_take(p);
        return n;
    case TOKEN_VALUE: return value_token(p);
    case '<': return vector(p);
    case '(': return parenthesized(p);
    case TOKEN_WORD: break;
    default:
        return parser_fail_hint(p, parser_here(p), doubled_hint(p, t), "expected a value, found %s",
                                parser_found(p, t));
    }
    if (t->keyword == KW_NONE) return name_or_call(p);
    if (is_parameter(p, t->as.name)) return constant(p);
    switch (keyword_class((Keyword)t->keyword)) {
    case KEYWORD_CONSTANT: return constant(p);
    case KEYWORD_FUNCTION: return builtin(p);
    default: break;
    }
    if (t->keyword == KW_function) return parser_function(p);
    if (t->keyword == KW_array) return parser_array(p);
    if (parser_peek_after(p)->kind == '{') return parser_block(p);
    /* spline types are arguments of a spline's evaluation: S(0.5, cubic_spline); `phase` is a number in a texel's phases */
    if (t->keyword == KW_phase || t->keyword == KW_linear_spline || t->keyword == KW_quadratic_spline ||
        t->keyword == KW_cubic_spline || t->keyword == KW_natural_spline)
        return constant(p);
    return parser_fail(p, t->span, "expected a value, found %s", parser_found(p, t));
}

static int dot_component(const Token *t) {
    switch (t->keyword) {
    case KW_x:
    case KW_u:
    case KW_red: return DOT_X;
    case KW_y:
    case KW_v:
    case KW_green: return DOT_Y;
    case KW_z:
    case KW_blue: return DOT_Z;
    case KW_t:
    case KW_filter: return DOT_4;
    case KW_transmit: return DOT_5;
    case KW_gray: return DOT_GRAY;
    default: return t->kind == TOKEN_WORD ? DOT_OTHER : -1;
    }
}

static bool is_text(const Node *n) {
    if (n->kind == NODE_STRING) return true;
    if (n->kind != NODE_BUILTIN) return false;
    return n->op == KW_concat || n->op == KW_str || n->op == KW_vstr || n->op == KW_chr ||
           n->op == KW_substr || n->op == KW_strlwr || n->op == KW_strupr || n->op == KW_datetime;
}

bool parser_directive_follows(Parser *p) {
    if (!p->slow || p->brackets > 0 || p->has_window) return false;
    const Token *t = p->host->after(p->host->context, 0);
    return t->kind == TOKEN_DIRECTIVE && t->keyword != KW_end;
}

/* On the slow road, looking at the next token runs the directives before it. Outside of brackets an operand therefore ends where
 * a directive follows it, and after values that no operator can follow nothing is looked at. */
static bool operand_ends(Parser *p, const Node *n) {
    if (n->kind == NODE_BLOCK || n->kind == NODE_FUNCTION || n->kind == NODE_ARRAY ||
        n->kind == NODE_DICTIONARY || is_text(n))
        return true;
    return parser_directive_follows(p);
}

static Node *dot(Parser *p, Node *n) {
    parser_take(p);
    p->raw = true;
    Token part = parser_take(p);
    int component = part.kind != TOKEN_WORD ? -1 : dot_component(&part);
    if (component < 0)
        return parser_fail(
            p, part.span,
            "expected a component after '.', found %s: they are x y z t, u v, red green blue filter "
            "transmit gray",
            parser_found(p, &part));
    require(n, BIND_PRIMARY);
    Node *result = parser_node(p, NODE_DOT, span_join(n->span, part.span));
    result->op = (uint16_t)component;
    result->as.operand.a = n;
    result->as.operand.b = parser_node(p, NODE_NAME, part.span);
    result->as.operand.b->as.name = part.as.name;
    return result;
}

/* index = "[" expression "]" [arguments]: an element, possibly a function that is called */
static Node *index(Parser *p, Node *n) {
    parser_take(p);
    p->brackets++;
    Node *e = parser_expression(p);
    if (!e || !parser_expect(p, ']', "']'")) return NULL;
    p->brackets--;
    Node *result = parser_node(p, NODE_INDEX, span_join(n->span, p->last.span));
    result->as.apply.base = n;
    *list_push(p->arena, &result->as.apply.list) = e;
    if (operand_ends(p, result) || parser_peek(p)->kind != '(') return result;
    Node *call = parser_node(p, NODE_CALL, result->span);
    call->as.apply.base = result;
    return plain_arguments(p, &call->as.apply.list) ? call : NULL;
}

/* postfix = primary { "." component | index } */
static Node *postfix(Parser *p) {
    Node *n = primary(p);
    size_t groups = p->slow ? p->host->groups_ended(p->host->context) : 0;
    for (;;) {
        if (!n || p->failed) return NULL;
        p->closed = operand_ends(p, n);
        int next = p->closed ? TOKEN_END : parser_peek(p)->kind;
        if (p->slow && p->brackets == 0 && p->host->groups_ended(p->host->context) != groups)
            p->crossed = true;
        if (next == '.')
            n = dot(p, n);
        else if (next == '[' && (n->kind == NODE_NAME || n->kind == NODE_INDEX || n->kind == NODE_DOT || n->kind == NODE_VALUE))
            n = index(p, n);
        else
            return parser_fold(p, n);
    }
}

/* factor = ("-" | "+" | "!") factor | postfix */
static Node *factor(Parser *p) {
    const Token *t = parser_peek(p);
    if (t->kind != '-' && t->kind != '+' && t->kind != '!') return postfix(p);
    Token op = parser_take(p);
    if (!parser_enter(p)) return NULL;
    Node *a = factor(p);
    parser_leave(p);
    if (!a) return NULL;
    require(a, BIND_PRIMARY);
    Node *n = parser_node(p, NODE_UNARY, span_join(op.span, a->span));
    n->op = op.kind;
    n->as.operand.a = a;
    return n;
}

/* term = factor { ("*" | "/") factor } */
static Node *term(Parser *p) {
    Node *a = factor(p);
    for (int count = 0; a && !p->failed; count++) {
        int op = p->closed ? TOKEN_END : parser_peek(p)->kind;
        if (op != '*' && op != '/') return a;
        if (count > PARSER_CHAIN_LIMIT)
            return parser_fail(p, a->span, "too many operators in one expression");
        parser_take(p);
        Node *b = factor(p);
        if (!b) return NULL;
        p->closed = false;
        require(a, BIND_PRODUCT);
        require(b, BIND_PRIMARY);
        a = binary(p, op, a, b);
    }
    return a;
}

/* expression = color | term { ("+" | "-") term } */
Node *parser_expression(Parser *p) {
    if (parser_begins_color(p)) return parser_color(p);
    if (!parser_enter(p)) return NULL;
    Node *a = term(p);
    for (int count = 0; a && !p->failed; count++) {
        int op = p->closed ? TOKEN_END : parser_peek(p)->kind;
        if (op != '+' && op != '-') break;
        if (count > PARSER_CHAIN_LIMIT)
            return parser_fail(p, a->span, "too many operators in one expression");
        parser_take(p);
        Node *b = term(p);
        if (!b) return NULL;
        require(a, BIND_SUM);
        require(b, BIND_PRIMARY);
        a = binary(p, op, a, b);
    }
    parser_leave(p);
    return p->failed ? NULL : a;
}

/* relation = expression { ("=" | "!=" | "<" | "<=" | ">" | ">=") expression } */
static Node *relation(Parser *p) {
    Node *a = parser_expression(p);
    while (a && !p->failed && is_relation(parser_peek(p)->kind)) {
        int op = parser_take(p).kind;
        Node *b = parser_expression(p);
        if (!b) return NULL;
        require(a, BIND_SUM);
        require(b, BIND_SUM);
        a = binary(p, op, a, b);
    }
    return a;
}

/* logical = relation { ("&" | "|") relation } */
static Node *logical(Parser *p) {
    Node *a = relation(p);
    while (a && !p->failed && (parser_peek(p)->kind == '&' || parser_peek(p)->kind == '|')) {
        int op = parser_take(p).kind;
        Node *b = relation(p);
        if (!b) return NULL;
        require(a, BIND_SUM);
        require(b, BIND_SUM);
        a = binary(p, op, a, b);
    }
    return a;
}

/* full = logical ["?" full ":" full] */
Node *parser_full(Parser *p) {
    if (!parser_enter(p)) return NULL;
    Node *a = logical(p);
    if (a && !p->failed && parser_accept(p, '?')) {
        require(a, BIND_SUM);
        Node *b = parser_full(p);
        Node *c = b && parser_expect(p, ':', "':'") ? parser_full(p) : NULL;
        if (!c) return NULL;
        require(b, BIND_SUM);
        require(c, BIND_SUM);
        Node *n = parser_node(p, NODE_CONDITION, span_join(a->span, c->span));
        n->as.operand.a = a;
        n->as.operand.b = b;
        n->as.operand.c = c;
        a = n;
    }
    parser_leave(p);
    return p->failed ? NULL : a;
}

/* `rotate phase*360*y`, but not the pattern's `wood phase 0.5` */
static bool is_phase_value(const Token *t, int after) {
    return t->keyword == KW_phase && (after == '*' || after == '/' || after == '}' || after == ',' || after == ')');
}

bool parser_is_film_clock(const Parser *p, const Token *t) {
    return t->keyword == KW_clock && p->block && strcmp(p->block->text, "animation") == 0;
}

/* What can stand for an operand. Names count after a comma; elsewhere when they are known to be values. */
bool parser_begins_expression(Parser *p, bool after_comma) {
    const Token *t = parser_peek(p);
    switch (t->kind) {
    case TOKEN_NUMBER:
    case TOKEN_STRING:
    case TOKEN_VALUE:
    case '(':
    case '<':
    case '-':
    case '+':
    case '!': return true;
    case TOKEN_WORD: break;
    default: return false;
    }
    int after = parser_peek_after(p)->kind;
    bool brace = after == '{';
    if (t->keyword) {
        if (is_parameter(p, t->as.name)) return true;
        switch (keyword_class((Keyword)t->keyword)) {
        case KEYWORD_CONSTANT: return !brace && (after_comma || !parser_is_film_clock(p, t));
        case KEYWORD_COLOR: return parser_begins_color(p);
        case KEYWORD_FUNCTION: return after == '(';
        default: return t->keyword == KW_function || t->keyword == KW_array || is_phase_value(t, after);
        }
    }
    if (brace && context_is_block(t->as.name)) return false;
    if (!after_comma && context_is_item(p->block, t->as.name)) return false;
    const void *macro;
    switch (parser_classify(p, t->as.name, &macro)) {
    case NAME_UNKNOWN: return after_comma ? !brace : after == '(';
    case NAME_MACRO:
        if (after != '(' || p->host->macro_binding(p->host->context, macro) == BIND_NONE) return false;
        return after_comma || !p->host->macro_is_block(p->host->context, macro);
    default: return true;
    }
}

/* block = (keyword | identifier) body */
Node *parser_block(Parser *p) {
    Token word = parser_take(p);
    Node *n = parser_node(p, NODE_BLOCK, word.span);
    n->as.block.word = word.as.name;
    n->as.block.word_span = word.span;
    n->as.block.body = parser_body(p, word.as.name);
    if (!n->as.block.body) return NULL;
    n->span = span_join(word.span, p->last.span);
    return n;
}
