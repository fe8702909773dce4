/* The slow road: a statement whose text only makes sense once its directives have run and its macros are expanded. Tokens are
 * pulled one by one; directives met on the way are run, calls of macros replaced by their bodies, names by their values. */
#include "eval/eval_state.h"

#include <string.h>

typedef enum FrameKind {
    FRAME_BASE,
    FRAME_BRANCH,
    FRAME_WHILE,
    FRAME_FOR,
    FRAME_SWITCH,
    FRAME_MACRO,
    FRAME_INCLUDE
} FrameKind;

/* A piece of text that is being read; tokens come from the innermost. */
typedef struct Frame Frame;
struct Frame {
    Frame *outer;
    FrameKind kind;
    TokenList *list;
    uint32_t at, end;
    const Node *node; /* BRANCH, WHILE, FOR, SWITCH */
    Body last;        /* the branch, pass or case that is being read */
    bool to_end;      /* the group must end with it */
    size_t next_case; /* SWITCH */
    double to, step;  /* FOR */
    uint64_t passes;
    size_t errors;
    uint32_t head; /* WHILE: the token of #while; its condition may itself need the slow road */
    Scope scope;   /* MACRO, INCLUDE */
    CallRecord record;
};

typedef struct Source {
    Eval *ev;
    Frame base;
    Frame *top;
    Parser *parser;
    bool at_start;       /* the statement's own directive is not for the source to run */
    bool in_head;        /* conditions may not hold directives, except in the macros that they call */
    Frame *window_frame; /* where the last token came from */
    uint32_t window_at;
    size_t groups_ended;
    Flow flow;
} Source;

static Frame *push(Source *s, FrameKind kind, TokenList *list, uint32_t at, uint32_t end) {
    Frame *f = arena_new(&s->ev->temp, Frame);
    f->outer = s->top;
    f->kind = kind;
    f->list = list;
    f->at = at;
    f->end = end;
    f->errors = s->ev->diags->failures;
    s->top = f;
    return f;
}

static void pop(Source *s) {
    Frame *f = s->top;
    if (f->kind == FRAME_MACRO) {
        macro_leave(s->ev, &f->scope);
    } else if (f->kind == FRAME_INCLUDE) {
        macro_leave(s->ev, &f->scope);
        s->ev->include_depth--;
    } else {
        s->groups_ended++;
    }
    s->top = f->outer;
}

static void fail(Source *s) { s->parser->failed = true; }

static void to_body(Frame *f, const Body *body) {
    f->last = *body;
    f->to_end = true;
    f->list = body->tokens;
    f->at = body->begin;
    f->end = body->end;
}

static bool next_pass(Source *s, Frame *f) {
    Flow flow = run_loop_guard(s->ev, &f->passes, f->errors, f->node->span);
    if (flow == FLOW_STOP) fail(s);
    return flow == FLOW_NEXT;
}

static const Node *head_at(Source *s, Frame *f, uint32_t at, uint32_t *next);

static void check_end(Source *s, const Frame *f, bool reached) {
    if (f->node && run_group_end(s->ev, f->node, &f->last, reached) == FLOW_STOP) fail(s);
}

/* At the end of a loop's body: on to the next pass, or false. */
static bool repeat_while(Source *s, Frame *f) {
    uint32_t next;
    bool go_on = false;
    const Node *head = head_at(s, f->outer, f->head, &next);
    if (!head || !eval_condition(s->ev, head->as.loop.condition, &go_on) || !go_on || !next_pass(s, f))
        return false;
    to_body(f, &head->as.loop.body);
    return true;
}

static bool repeat_for(Source *s, Frame *f, bool first) {
    VarBinding *b = scope_find(s->ev, f->node->as.for_loop.name);
    if (!b || b->slot->value.kind != VALUE_FLOAT) return false;
    double *now = &b->slot->value.as.number;
    if (!first) *now += f->step;
    if (!(f->step > 0 ? *now <= f->to + 1e-10 : *now >= f->to - 1e-10)) return false;
    if (!next_pass(s, f)) return false;
    to_body(f, &f->node->as.for_loop.body);
    return true;
}

static bool next_case(Source *s, Frame *f) {
    (void)s;
    if (f->next_case >= f->node->as.switch_.count) return false;
    to_body(f, &f->node->as.switch_.cases[f->next_case++].body);
    return true;
}

static bool is_loop(const Frame *f) { return f->kind == FRAME_WHILE || f->kind == FRAME_FOR; }

static void end_frame(Source *s) {
    Frame *f = s->top;
    if (is_loop(f) || f->kind == FRAME_BRANCH) check_end(s, f, f->to_end);
    if (s->parser->failed) return;
    bool again = f->kind == FRAME_WHILE    ? repeat_while(s, f)
                 : f->kind == FRAME_FOR    ? repeat_for(s, f, false)
                 : f->kind == FRAME_SWITCH ? next_case(s, f)
                                           : false;
    if (again) return;
    if (f->kind == FRAME_SWITCH) check_end(s, f, true);
    pop(s);
}

static void break_out(Source *s) {
    while (s->top != &s->base) {
        Frame *f = s->top;
        pop(s);
        if (f->kind == FRAME_BRANCH) run_break_leaves(s->ev, &f->last);
        if (!is_loop(f) && f->kind != FRAME_SWITCH) continue;
        check_end(s, f, false);
        return;
    }
    s->flow = FLOW_BREAK;
    s->base.at = s->base.end;
}

/* ---- what is met while pulling ---- */

static void begin_branch(Source *s, const Node *n, const Body *body, bool to_end) {
    Frame *f = push(s, FRAME_BRANCH, body->tokens, body->begin, body->end);
    to_body(f, body);
    f->node = n;
    f->to_end = to_end;
}

static void begin_if(Source *s, const Node *n) {
    size_t count = n->as.branches.count;
    for (size_t i = 0; i < count; i++) {
        const Branch *b = &n->as.branches.branches[i];
        bool taken = true;
        if (b->condition && !eval_condition(s->ev, b->condition, &taken)) return;
        if (!taken) continue;
        begin_branch(s, n, &b->body, !run_branch_goes_on(b));
        return;
    }
    if (run_group_end(s->ev, n, &n->as.branches.branches[count - 1].body, true) == FLOW_STOP) fail(s);
}

static void begin_for(Source *s, const Node *n) {
    Eval *ev = s->ev;
    double from, to, step = 1;
    if (!eval_float(ev, n->as.for_loop.from, &from) || !eval_float(ev, n->as.for_loop.to, &to)) return;
    if (n->as.for_loop.step && !eval_float(ev, n->as.for_loop.step, &step)) return;
    if (fabs(step) <= VALUE_TOLERANCE) {
        diag_error(ev->diags, n->as.for_loop.step->span, "the step of #for is 0");
        return;
    }
    Value v = value_float(from);
    if (!scope_may_declare(ev, n->as.for_loop.name, VALUE_FLOAT, n->span)) return;
    slot_set(ev, scope_declare(ev, n->as.for_loop.name, true), &v);
    Frame *f = push(s, FRAME_FOR, n->as.for_loop.body.tokens, 0, 0);
    f->node = n;
    f->to = to;
    f->step = step;
    if (repeat_for(s, f, true)) return;
    f->last = n->as.for_loop.body;
    check_end(s, f, false);
    pop(s);
}

static void begin_while(Source *s, const Node *n, uint32_t head) {
    Frame *f = push(s, FRAME_WHILE, n->as.loop.body.tokens, 0, 0);
    f->node = n;
    f->head = head;
    bool go_on;
    if (!eval_condition(s->ev, n->as.loop.condition, &go_on) || !go_on || !next_pass(s, f)) {
        f->last = n->as.loop.body;
        check_end(s, f, false);
        pop(s);
        return;
    }
    to_body(f, &n->as.loop.body);
}

/* The text before the first case is read as a branch within the switch. */
static void begin_switch(Source *s, const Node *n) {
    double subject;
    if (!eval_float(s->ev, n->as.switch_.subject, &subject)) return;
    const Body *prelude = &n->as.switch_.prelude;
    Frame *f = push(s, FRAME_SWITCH, prelude->tokens, 0, 0);
    f->node = n;
    f->last = *prelude;
    size_t i = 0, count = n->as.switch_.count;
    while (i < count && !run_case_matches(s->ev, &n->as.switch_.cases[i], subject)) i++;
    f->next_case = i;
    if (i == count && count) f->last = n->as.switch_.cases[count - 1].body;
    if (prelude->begin < prelude->end) begin_branch(s, NULL, prelude, false);
}

static void begin_include(Source *s, const Node *n) {
    Span span;
    TokenList *list = eval_load_include(s->ev, n, &span);
    if (!list) {
        fail(s);
        return;
    }
    Frame *f = push(s, FRAME_INCLUDE, list, 0, list->count - 1);
    scope_enter(s->ev, &f->scope);
    f->record = (CallRecord){.outer = s->ev->calls, .span = span};
    s->ev->calls = &f->record;
    s->ev->call_depth++;
    s->ev->include_depth++;
}

static void begin_call(Source *s, Frame *from, const Macro *macro, Span name_span);

static void source_init(Source *s, Eval *ev, Parser *p, const ParserHost *host, Frame *frame, uint32_t at);
static void make_host(ParserHost *host, Source *s);

/* Reads a directive's head on a slow road of its own. */
static const Node *slow_head(Source *outer, Frame *f, uint32_t at, uint32_t *next) {
    Source inner;
    Parser p;
    ParserHost host = {0};
    source_init(&inner, outer->ev, &p, &host, f, at);
    p.block = outer->parser->block;
    p.depth = outer->parser->depth;
    inner.in_head = f->list->items[at].match != 0;
    parser_take(&p);
    Node *n = parser_directive(&p, f->list, at, next);
    while (inner.top != &inner.base) pop(&inner);
    if (!n) {
        outer->parser->failed = true;
        return NULL;
    }
    if (*next == 0)
        *next = p.has_window && inner.window_frame == &inner.base ? inner.window_at : inner.base.at;
    return n;
}

/* The directive at `at`: its head parsed, *next the token after all of it. Heads are kept, since loops and macros come back to them. */
static const Node *head_at(Source *s, Frame *f, uint32_t at, uint32_t *next) {
    Eval *ev = s->ev;
    Program *program = eval_program(ev, f->list);
    if (!program->heads) program->heads = arena_new_array(ev->parse, Statement *, f->list->count);
    Statement *head = program->heads[at];
    if (!head || head->end != f->end || !statement_holds(ev, head)) {
        if (!head) head = program->heads[at] = arena_new(ev->parse, Statement);
        Parser p = {.arena = ev->parse,
                    .diags = ev->diags,
                    .keywords = &ev->keywords,
                    .host = &ev->fast_host,
                    .list = f->list,
                    .at = at,
                    .end = f->end,
                    .heads_only = true};
        parser_take(&p);
        Node *n = parser_directive(&p, f->list, at, next);
        bool holds = n != NULL;
        for (size_t i = 0; holds && i < p.assumptions.count; i++) {
            const Assumption *a = &p.assumptions.items[i];
            holds = a->class != NAME_MACRO || !a->call || macro_binding(ev, a->macro) >= a->call->need;
        }
        *head = (Statement){.node = holds ? n : NULL,
                            .next = p.at,
                            .end = f->end,
                            .assumptions = p.assumptions.items,
                            .assumption_count = (uint32_t)p.assumptions.count,
                            .stamp = ev->macro_stamp,
                            .name_stamp = ev->name_stamp};
    }
    if (!head->node) return slow_head(s, f, at, next);
    *next = head->next;
    return head->node;
}

static void begin_directive(Source *s) {
    Frame *f = s->top;
    uint32_t at = f->at, next = 0;
    const Node *n = head_at(s, f, at, &next);
    if (!n) return;
    f->at = next;
    switch (n->kind) {
    case NODE_IF: begin_if(s, n); break;
    case NODE_WHILE: begin_while(s, n, at); break;
    case NODE_FOR: begin_for(s, n); break;
    case NODE_SWITCH: begin_switch(s, n); break;
    case NODE_BREAK:
        s->ev->last_break = s->ev->break_end = n->span;
        break_out(s);
        break;
    case NODE_INCLUDE: begin_include(s, n); break;
    default: {
        Sink none = {.kind = SINK_NONE};
        run_node(s->ev, n, &none);
    }
    }
    if (s->ev->stopped) fail(s);
}

static void begin_call(Source *s, Frame *from, const Macro *macro, Span name_span) {
    Eval *ev = s->ev;
    Source inner;
    Parser p;
    ParserHost host = {0};
    NodeList arguments = {0};
    source_init(&inner, ev, &p, &host, from, from->at);
    inner.at_start = false;
    p.depth = s->parser->depth;
    bool ok = parser_enter(&p) && parser_arguments(&p, &arguments);
    Span span = span_join(name_span, p.last.span);
    while (inner.top != &inner.base) pop(&inner);
    from->at = inner.base.at;
    Frame *f = ok ? push(s, FRAME_MACRO, macro->body.tokens, macro->body.begin, macro->body.end) : NULL;
    if (f && macro_enter(ev, macro, &arguments, span, &f->scope, &f->record)) return;
    if (f) s->top = f->outer;
    fail(s);
}

/* ---- ParserHost ---- */

static bool is_parameter(const Parser *p, Name name) {
    for (size_t i = 0; i < p->parameter_count; i++)
        if (p->parameters[i] == name) return true;
    return false;
}

static Token value_token(Eval *ev, const Token *word, const Slot *slot) {
    Token t = {.kind = TOKEN_VALUE, .span = word->span};
    Value *v = arena_new(&ev->temp, Value);
    *v = slot_get(ev, slot);
    t.as.value = v;
    if (v->kind == VALUE_FUNCTION || v->kind == VALUE_SPLINE) t.keyword = KW_function;
    return t;
}

/* Whether a name stays a name: an index's running name, a word of this block, something not declared. */
static bool stays_name(const Source *s, const Parser *p, const Token *t) {
    const Macro *macro;
    const Frame *f = s->top;
    if (t->keyword || is_parameter(p, t->as.name) || context_is_item(p->block, t->as.name)) return true;
    if (f->at < f->end && f->list->items[f->at].kind == '{' && context_is_block(t->as.name)) return true;
    return scope_classify(s->ev, t->as.name, &macro) == NAME_UNKNOWN;
}

static Token pull(void *context, Parser *p) {
    Source *s = context;
    for (;;) {
        Frame *f = s->top;
        if (p->failed || s->ev->stopped) break;
        if (f->at >= f->end) {
            if (f == &s->base) break;
            end_frame(s);
            continue;
        }
        const Token *t = &f->list->items[f->at];
        bool start = s->at_start;
        s->at_start = false;
        s->window_frame = f;
        s->window_at = f->at;
        if (t->kind == TOKEN_DIRECTIVE && !start && !(s->in_head && f == &s->base)) {
            begin_directive(s);
            continue;
        }
        f->at++;
        if (t->kind != TOKEN_WORD || p->raw || stays_name(s, p, t)) return *t;
        const Macro *macro;
        if (scope_classify(s->ev, t->as.name, &macro) != NAME_MACRO)
            return value_token(s->ev, t, scope_find(s->ev, t->as.name)->slot);
        if (f->at >= f->end || f->list->items[f->at].kind != '(') return *t;
        begin_call(s, f, macro, t->span);
    }
    if (s->ev->stopped) p->failed = true;
    Frame *f = s->top;
    Span last = f->at > 0 ? f->list->items[f->at - 1].span : f->list->items[0].span;
    Token end = {.kind = TOKEN_END, .span = {last.file, last.end, last.end}};
    if (f->at < f->list->count) token_set_ending(&end, &f->list->items[f->at]);
    return end;
}

/* Past the end of a macro's or a branch's text, the text that it stood in goes on. */
static const Token *after(void *context, uint32_t skip) {
    static const Token end = {.kind = TOKEN_END};
    const Source *s = context;
    const Frame *f = s->top;
    while (f->at >= f->end && (f->kind == FRAME_BRANCH || f->kind == FRAME_MACRO || f->kind == FRAME_INCLUDE))
        f = f->outer;
    return f->at + skip < f->end ? &f->list->items[f->at + skip] : &end;
}

static uint32_t position(void *context) { return ((const Source *)context)->top->at; }

static bool take_body(void *context, Body *body) {
    Source *s = context;
    Frame *f = s->window_frame;
    if (f != s->top || f->at == 0) return false;
    uint32_t close = f->list->items[s->window_at].match;
    if (close == 0 || close >= f->end || macro_half_called(s->ev, f->list, s->window_at, close)) return false;
    *body = (Body){.tokens = f->list, .begin = s->window_at + 1, .end = close};
    f->at = close + 1;
    return true;
}

static Node *fold(void *context, Node *node) {
    Source *s = context;
    if (node->kind == NODE_CONSTANT && keyword_class((Keyword)node->op) == KEYWORD_WORD)
        return node; /* a type of spline */
    Value *v = arena_new(&s->ev->temp, Value);
    *v = eval_node(s->ev, node);
    Node *n = arena_new(&s->ev->temp, Node);
    n->kind = NODE_VALUE;
    n->op = node->kind;
    n->span = node->span;
    n->as.value = v;
    return n;
}

static size_t groups_ended(void *context) { return ((Source *)context)->groups_ended; }

static NameClass classify(void *context, Name name, const void **macro) {
    const Macro *m;
    NameClass class = scope_classify(((Source *)context)->ev, name, &m);
    *macro = m;
    return class;
}

static Binding binding(void *context, const void *macro) {
    return macro_binding(((Source *)context)->ev, macro);
}

static bool is_whole(void *context, const void *macro) {
    (void)context;
    return ((const Macro *)macro)->whole;
}

static bool is_block(void *context, const void *macro) {
    (void)context;
    return ((const Macro *)macro)->is_block;
}

static void make_host(ParserHost *host, Source *s) {
    *host = (ParserHost){.context = s,
                         .classify = classify,
                         .macro_binding = binding,
                         .macro_is_whole = is_whole, .macro_is_block = is_block,
                         .pull = pull,
                         .after = after,
                         .position = position,
                         .take_body = take_body,
                         .fold = fold,
                         .groups_ended = groups_ended};
}

static void source_init(Source *s, Eval *ev, Parser *p, const ParserHost *host, Frame *frame, uint32_t at) {
    *s = (Source){.ev = ev, .parser = p, .at_start = true};
    s->base = (Frame){.kind = FRAME_BASE, .list = frame->list, .at = at, .end = frame->end};
    s->top = &s->base;
    make_host((ParserHost *)(uintptr_t)host, s);
    *p = (Parser){.arena = &ev->temp,
                  .diags = ev->diags,
                  .keywords = &ev->keywords,
                  .host = host,
                  .slow = true,
                  .semicolons_optional = ev->version < 3.5,
                  .list = frame->list};
}

/* ---- statements ---- */

/* After a mistake: past the group, or the next ';' or bracket that closes more than was opened, or up to a directive. */
static uint32_t recover(const TokenList *list, uint32_t begin, uint32_t at, uint32_t end) {
    int depth = 0;
    if (list->items[begin].kind == TOKEN_DIRECTIVE && list->items[begin].match) {
        at = group_end(list, begin) + 1;
        return at < end ? at : end;
    }
    for (; at < end; at++) {
        const Token *t = &list->items[at];
        if (t->kind == '{' || t->kind == '(' || t->kind == '[') {
            if (t->match && t->match < end)
                at = t->match;
            else
                depth += t->kind == '{';
        } else if (t->kind == ';' || (t->kind == '}' && depth-- <= 0)) {
            return t->kind == '}' && at + 1 < end && list->items[at + 1].kind == ';' ? at + 2 : at + 1;
        } else if (t->kind == TOKEN_DIRECTIVE && depth <= 0 && t->keyword != KW_end &&
                   t->keyword != KW_else) {
            return at;
        }
    }
    return end;
}

/* The macros whose text has been read to its end are left: what the statement declares is not theirs. */
static void leave_finished(Source *s) {
    while (!s->parser->has_window && s->top != &s->base && s->top->at >= s->top->end &&
           (s->top->kind == FRAME_MACRO || s->top->kind == FRAME_BRANCH || s->top->kind == FRAME_INCLUDE))
        pop(s);
}

/* After a #declare that cannot be read, uses of its name stay silent. */
static void declare_error(Eval *ev, const TokenList *list, uint32_t at) {
    const Token *head = &list->items[at], *name = &list->items[at + 1];
    if (head->kind != TOKEN_DIRECTIVE ||
        (head->keyword != KW_declare && head->keyword != KW_local && head->keyword != KW_macro))
        return;
    if (name->kind != TOKEN_WORD || name->keyword || scope_find(ev, name->as.name)) return;
    Value v = value_error();
    slot_set(ev, scope_declare(ev, name->as.name, head->keyword == KW_local), &v);
}

static Flow expand(Eval *ev, Program *program, uint32_t *at, uint32_t end, Sink *sink, bool as_text) {
    Source s;
    Parser p;
    ParserHost host;
    Frame frame = {.list = program->tokens, .end = end};
    uint32_t begin = *at;
    const Token *first = &program->tokens->items[begin];
    if (!eval_deeper(ev, first->span)) return FLOW_STOP;
    bool repeats = ev->repeats;
    ev->repeats = true; /* for all that macros and loops in the text hold */
    source_init(&s, ev, &p, &host, &frame, begin);
    s.in_head = first->kind == TOKEN_DIRECTIVE && first->keyword == KW_macro;
    p.block = sink->kind == SINK_ITEMS ? sink->block : NULL;
    Flow flow = FLOW_NEXT;
    if (as_text) {
        /* A group: its branches are text like any other. */
        s.at_start = false;
        if (parser_at_end(&p) && !p.failed) goto done;
    }
    for (;;) {
        bool directive = s.at_start && first->kind == TOKEN_DIRECTIVE;
        uint32_t next = 0;
        if (directive)
            parser_take(&p);
        else if (parser_at_end(&p))
            break;
        Node *n = directive ? parser_directive(&p, program->tokens, begin, &next) : parser_statement(&p);
        if (p.failed) break;
        if (next) s.base.at = next;
        if (n->kind == NODE_DECLARE || n->kind == NODE_UNDEF || n->kind == NODE_FOPEN || n->kind == NODE_READ)
            leave_finished(&s);
        flow = run_node(ev, n, sink);
        /* What is left of the macros that were expanded belongs here too. */
        if (flow != FLOW_NEXT || (s.top == &s.base && !(p.has_window && s.window_frame != &s.base))) break;
        if (parser_at_end(&p) || s.window_frame == &s.base) break;
    }
done:
    while (s.top != &s.base) pop(&s);
    if (p.failed) declare_error(ev, program->tokens, begin);
    if (p.failed)
        *at = recover(program->tokens, begin, s.base.at > begin ? s.base.at : begin + 1, end);
    else
        *at =
            p.has_window && s.window_frame == &s.base && p.window.kind != TOKEN_END ? s.window_at : s.base.at;
    if (p.failed && sink->kind == SINK_SINGLE) sink->filled = true;
    if (*at <= begin) *at = begin + 1;
    ev->nesting--;
    ev->repeats = repeats;
    if (ev->stopped) return FLOW_STOP;
    return flow == FLOW_NEXT ? s.flow : flow;
}

Flow run_slow(Eval *ev, Program *program, uint32_t *at, uint32_t end, Sink *sink) {
    const Token *first = &program->tokens->items[*at];
    bool is_group = first->kind == TOKEN_DIRECTIVE && first->match && first->keyword != KW_macro;
    return expand(ev, program, at, end, sink, is_group);
}

Flow run_include_as_text(Eval *ev, Program *program, uint32_t *at, uint32_t end, Sink *sink) {
    return expand(ev, program, at, end, sink, true);
}
