#include "eval/eval_state.h"

#include <math.h>

enum {
    NESTING_LIMIT = 3000
}; /* bodies within each other, each of which takes about a kilobyte of the C stack */

/* How much of the C stack a body, a call or an expression takes differs too much for counting alone. Of the usual 8 MB, what is
 * left is for one expression of the deepest kind that the parser lets through. */
static const uintptr_t STACK_LIMIT = 5u << 20;

bool eval_has_stack(Eval *ev, Span span) {
    uintptr_t here = (uintptr_t)__builtin_frame_address(0);
    uintptr_t taken = here < ev->stack ? ev->stack - here : here - ev->stack;
    if (ev->nesting < NESTING_LIMIT && taken < STACK_LIMIT) return true;
    diag_error(ev->diags, span, "nested too deeply");
    ev->stopped = true;
    return false;
}

bool eval_deeper(Eval *ev, Span span) {
    bool fits = eval_has_stack(ev, span);
    ev->nesting += fits;
    return fits;
}

/* ---- statements and their memo ---- */

Program *eval_program_new(Eval *ev, TokenList *tokens) {
    uint32_t id = tokens->file->id;
    if (id >= ev->program_count) {
        uint32_t count = ev->program_count ? ev->program_count * 2 : 16;
        while (count <= id) count *= 2;
        Program **larger = arena_new_array(ev->parse, Program *, count);
        for (uint32_t i = 0; i < ev->program_count; i++) larger[i] = ev->programs[i];
        ev->programs = larger;
        ev->program_count = count;
    }
    if (!ev->programs[id]) {
        Program *p = arena_new(ev->parse, Program);
        p->tokens = tokens;
        ev->programs[id] = p;
    }
    return ev->programs[id];
}

/* What a call's macro must be for the fast road: the text around the call would read its body as one operand. */
static bool calls_hold(Eval *ev, const Assumption *a, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (a[i].class == NAME_MACRO && a[i].call && macro_binding(ev, a[i].macro) < a[i].call->need)
            return false;
    return true;
}

bool statement_holds(Eval *ev, Statement *s) {
    if (s->name_stamp == ev->name_stamp) return true;
    for (uint32_t i = 0; i < s->assumption_count; i++) {
        const Assumption *a = &s->assumptions[i];
        const Macro *macro;
        if (scope_classify(ev, a->name, &macro) != a->class || macro != a->macro) return false;
    }
    if (s->stamp != ev->macro_stamp) {
        s->stamp = ev->macro_stamp;
        if (s->node && !calls_hold(ev, s->assumptions, s->assumption_count)) return false;
    }
    s->name_stamp = ev->name_stamp;
    return true;
}

/* Names are looked at several times while a statement is read. */
static uint32_t drop_repetitions(Assumption *a, size_t count) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        bool seen = false;
        for (size_t k = 0; k < kept && !seen; k++)
            seen = a[k].name == a[i].name && (!a[i].call || a[k].call == a[i].call);
        if (!seen) a[kept++] = a[i];
    }
    return (uint32_t)kept;
}

static Statement parse_statement(Eval *ev, Arena *arena, const Program *program, uint32_t at, uint32_t end, Name block) {
    Parser p = {.arena = arena,
                .diags = ev->diags,
                .keywords = &ev->keywords,
                .host = &ev->fast_host,
                .list = program->tokens,
                .at = at,
                .end = end,
                .semicolons_optional = ev->version < 3.5,
                .block = block};
    Node *n = ev->options->expand_always ? NULL : parser_statement(&p);
    if (n && !calls_hold(ev, p.assumptions.items, p.assumptions.count)) n = NULL;
    return (Statement){.node = n,
                       .next = p.at,
                       .end = end,
                       .block = block,
                       .assumptions = p.assumptions.items,
                       .assumption_count = drop_repetitions(p.assumptions.items, p.assumptions.count),
                       .stamp = ev->macro_stamp,
                       .name_stamp = ev->name_stamp};
}

const Statement *statement_at(Eval *ev, Program *program, uint32_t at, uint32_t end, Name block) {
    if (!program->memo) program->memo = arena_new_array(ev->parse, Statement *, program->tokens->count);
    Statement *s = program->memo[at];
    if (s && s->end == end && s->block == block && statement_holds(ev, s)) return s;
    if (!s) s = program->memo[at] = arena_new(ev->parse, Statement);
    *s = parse_statement(ev, ev->parse, program, at, end, block);
    return s;
}

/* Data files of many megabytes are made of statements that run once: their trees are not kept. */
static Flow run_once(Eval *ev, Program *program, uint32_t *at, uint32_t end, Name block, Sink *sink) {
    ArenaMark mark = arena_mark(&ev->passing);
    Statement s = parse_statement(ev, &ev->passing, program, *at, end, block);
    Flow flow;
    if (s.node) {
        *at = s.next;
        flow = run_node(ev, s.node, sink);
    } else {
        flow = run_slow(ev, program, at, end, sink);
    }
    arena_reset_to(&ev->passing, mark);
    return flow;
}

Flow run_statement(Eval *ev, Program *program, uint32_t *at, uint32_t end, Sink *sink) {
    Name block = sink->kind == SINK_ITEMS ? sink->block : NULL;
    if (!ev->repeats) return run_once(ev, program, at, end, block, sink);
    const Statement *s = program->memo ? program->memo[*at] : NULL;
    if (!s || s->name_stamp != ev->name_stamp || s->end != end || s->block != block)
        s = statement_at(ev, program, *at, end, block);
    if (!s->node) return run_slow(ev, program, at, end, sink);
    *at = s->next;
    return run_node(ev, s->node, sink);
}

static bool block_holds_objects(const Eval *ev, Name block) {
    Keyword keyword = block ? keyword_of(&ev->keywords, block) : KW_NONE;
    return keyword == KW_union || keyword == KW_merge || keyword == KW_intersection ||
           keyword == KW_difference;
}

/* Where numbers and vectors may follow each other with commas between them. */
static bool takes_lists(const Eval *ev, const Sink *sink) {
    if (ev->options->expand_always) return false;
    return sink->kind == SINK_ARRAY || (sink->kind == SINK_ITEMS && !block_holds_objects(ev, sink->block));
}

static Flow run_tokens(Eval *ev, const Body *body, Sink *sink) {
    Flow flow = FLOW_NEXT;
    Program *program = eval_program(ev, body->tokens);
    uint64_t outer = ev->body;
    bool lists = takes_lists(ev, sink);
    ev->body = ++ev->body_count;
    for (uint32_t at = body->begin; at < body->end && flow == FLOW_NEXT;) {
        if (lists && literal_begins(&body->tokens->items[at])) {
            at = run_literals(ev, body, at, sink);
            if (at >= body->end || ev->stopped) break;
        }
        ArenaMark mark = arena_mark(&ev->temp);
        uint32_t begin = at;
        flow = run_statement(ev, program, &at, body->end, sink);
        if (flow == FLOW_TEXT) {
            at = begin;
            flow = run_include_as_text(ev, program, &at, body->end, sink);
        }
        if (!(sink->kind == SINK_SINGLE && sink->filled)) arena_reset_to(&ev->temp, mark);
        if (ev->stopped) flow = FLOW_STOP;
    }
    ev->body = outer;
    return ev->stopped ? FLOW_STOP : flow;
}

/* The tree of a body that is one statement known from an earlier run, as branches and macros of programs mostly are; else NULL. */
static const Node *only_statement(const Eval *ev, const Body *body, const Sink *sink) {
    uint32_t id = body->tokens->file->id;
    if (!ev->repeats || sink->kind == SINK_ITEMS || id >= ev->program_count) return NULL;
    const Program *program = ev->programs[id];
    const Statement *s = program && program->memo ? program->memo[body->begin] : NULL;
    bool is = s && s->next == body->end && s->end == body->end && !s->block && s->name_stamp == ev->name_stamp;
    return is && s->node && s->node->kind != NODE_INCLUDE ? s->node : NULL;
}

static Flow run_one(Eval *ev, const Node *node, Sink *sink) {
    ArenaMark mark = arena_mark(&ev->temp);
    Flow flow = run_node(ev, node, sink);
    if (!(sink->kind == SINK_SINGLE && sink->filled)) arena_reset_to(&ev->temp, mark);
    return ev->stopped ? FLOW_STOP : flow;
}

Flow run_body(Eval *ev, const Body *body, Sink *sink) {
    Flow flow = FLOW_NEXT;
    if (body->tokens) {
        if (body->begin >= body->end) return FLOW_NEXT;
        if (!eval_deeper(ev, body->tokens->items[body->begin].span)) return FLOW_STOP;
        const Node *only = only_statement(ev, body, sink);
        flow = only ? run_one(ev, only, sink) : run_tokens(ev, body, sink);
        ev->nesting--;
        return flow;
    }
    for (size_t i = 0; i < body->items.count && flow == FLOW_NEXT; i++)
        flow = run_node(ev, body->items.items[i], sink);
    return flow;
}

/* ---- directives ---- */

Flow run_group_end(Eval *ev, const Node *group, const Body *last, bool reached) {
    const TokenList *list = last->tokens;
    if (!list) return FLOW_NEXT;
    const Token *t = &list->items[last->end], *end = &list->items[group_end(list, last->end)];
    if (end->kind != TOKEN_END && (t->keyword == KW_end || !reached)) return FLOW_NEXT;
    if (t->kind == TOKEN_DIRECTIVE && reached)
        group_report_stray(ev->diags, t);
    else
        group_report_endless(ev->diags, list, group->span);
    ev->stopped = true;
    return FLOW_STOP;
}

bool run_branch_goes_on(const Branch *b) {
    int next = b->body.tokens ? b->body.tokens->items[b->body.end].keyword : KW_end;
    return b->condition && next != KW_case && next != KW_range;
}

void run_break_leaves(Eval *ev, const Body *body) {
    if (body->tokens) ev->break_end = body->tokens->items[group_end(body->tokens, body->end)].span;
}

static Flow run_if(Eval *ev, const Node *node, Sink *sink) {
    size_t count = node->as.branches.count;
    for (size_t i = 0; i < count; i++) {
        const Branch *b = &node->as.branches.branches[i];
        bool taken = true;
        if (b->condition && !eval_condition(ev, b->condition, &taken)) return FLOW_NEXT;
        if (!taken) continue;
        Flow flow = run_body(ev, &b->body, sink);
        if (flow == FLOW_BREAK) run_break_leaves(ev, &b->body);
        return flow == FLOW_NEXT ? run_group_end(ev, node, &b->body, !run_branch_goes_on(b)) : flow;
    }
    return run_group_end(ev, node, &node->as.branches.branches[count - 1].body, true);
}

bool eval_has_memory(Eval *ev, size_t more, Span span) {
    size_t taken = ev->parse->total + ev->build.arena->total + ev->temp.total + ev->passing.total + ev->blocks.total;
    if (taken + more <= ev->options->limits.memory_bytes) return !ev->stopped;
    Diagnostic *d = diag_error(ev->diags, span, "reading the scene takes more than %llu bytes of memory",
                               (unsigned long long)ev->options->limits.memory_bytes);
    diag_hint(ev->diags, d, "--limit memory=N allows more");
    ev->stopped = true;
    return false;
}

bool eval_step(Eval *ev, Span span) {
    if (++ev->steps > ev->options->limits.steps) {
        diag_error(ev->diags, span,
                   "the scene has made %llu passes of loops and calls of macros without ending",
                   (unsigned long long)ev->options->limits.steps);
        ev->stopped = true;
    } else if (ev->options->interrupted && *ev->options->interrupted) {
        ev->interrupted = ev->stopped = true;
    }
    return eval_has_memory(ev, 0, span);
}

/* Called before each pass. A loop whose pass met an error ends: its condition may depend on what failed. */
Flow run_loop_guard(Eval *ev, uint64_t *passes, size_t errors, Span span) {
    if (ev->diags->failures != errors) return FLOW_BREAK;
    if (++*passes > ev->options->limits.loops) {
        diag_error(ev->diags, span, "the loop has made %llu passes without ending",
                   (unsigned long long)ev->options->limits.loops);
        return FLOW_BREAK;
    }
    return eval_step(ev, span) ? FLOW_NEXT : FLOW_STOP;
}

/* One pass of a loop; a loop that is left must have an #end too. */
static Flow run_pass(Eval *ev, const Node *node, const Body *body, Sink *sink) {
    bool repeats = ev->repeats;
    ev->repeats = true;
    Flow flow = run_body(ev, body, sink);
    ev->repeats = repeats;
    if (flow == FLOW_STOP || run_group_end(ev, node, body, flow == FLOW_NEXT) == FLOW_STOP) return FLOW_STOP;
    return flow;
}

static Flow run_while(Eval *ev, const Node *node, Sink *sink) {
    uint64_t passes = 0;
    size_t errors = ev->diags->failures;
    for (;;) {
        bool go_on;
        ArenaMark mark = arena_mark(&ev->temp);
        if (!eval_condition(ev, node->as.loop.condition, &go_on)) return FLOW_NEXT;
        if (!go_on) return run_group_end(ev, node, &node->as.loop.body, false);
        arena_reset_to(&ev->temp, mark);
        Flow flow = run_loop_guard(ev, &passes, errors, node->span);
        if (flow == FLOW_NEXT) flow = run_pass(ev, node, &node->as.loop.body, sink);
        if (flow != FLOW_NEXT) return flow == FLOW_BREAK ? FLOW_NEXT : flow;
    }
}

static Flow run_for(Eval *ev, const Node *node, Sink *sink) {
    double from, to, step = 1;
    bool ok = eval_float(ev, node->as.for_loop.from, &from);
    if (!eval_float(ev, node->as.for_loop.to, &to) || !ok) return FLOW_NEXT;
    if (node->as.for_loop.step && !eval_float(ev, node->as.for_loop.step, &step)) return FLOW_NEXT;
    if (fabs(step) <= VALUE_TOLERANCE) {
        diag_error(ev->diags, node->as.for_loop.step->span, "the step of #for is 0");
        return FLOW_NEXT;
    }
    Name name = node->as.for_loop.name;
    Value v = value_float(from);
    if (!scope_may_declare(ev, name, VALUE_FLOAT, node->span)) return FLOW_NEXT;
    Slot *slot = scope_declare(ev, name, true);
    slot_set(ev, slot, &v);
    uint64_t passes = 0;
    size_t errors = ev->diags->failures;
    for (;;) {
        VarBinding *b = scope_find(ev, name);
        if (!b || b->slot->value.kind != VALUE_FLOAT) {
            const Body *body = &node->as.for_loop.body;
            Diagnostic *d = diag_error(ev->diags, body->tokens->items[body->end].span,
                                       "the variable of this #for no longer holds a float");
            diag_note(ev->diags, d, node->span, "this #for");
            return FLOW_NEXT;
        }
        /* A limit missed by rounding still counts: 0 to 1 by 0.1 makes 11 passes. */
        double now = b->slot->value.as.number;
        if (!(step > 0 ? now <= to + 1e-10 : now >= to - 1e-10))
            return run_group_end(ev, node, &node->as.for_loop.body, false);
        Flow flow = run_loop_guard(ev, &passes, errors, node->span);
        if (flow == FLOW_NEXT) flow = run_pass(ev, node, &node->as.for_loop.body, sink);
        if (flow != FLOW_NEXT) return flow == FLOW_BREAK ? FLOW_NEXT : flow;
        b = scope_find(ev, name);
        if (b && b->slot->value.kind == VALUE_FLOAT) b->slot->value.as.number += step;
    }
}

bool run_case_matches(Eval *ev, const SwitchCase *c, double subject) {
    double low, high;
    if (!c->low) return true;
    if (!eval_float(ev, c->low, &low)) return false;
    if (!c->high) return fabs(subject - low) <= VALUE_TOLERANCE;
    return eval_float(ev, c->high, &high) && subject >= low && subject <= high;
}

/* From the first case that matches on, through the following ones, to a #break. */
static Flow run_switch(Eval *ev, const Node *node, Sink *sink) {
    double subject;
    if (!eval_float(ev, node->as.switch_.subject, &subject)) return FLOW_NEXT;
    const Body *last = &node->as.switch_.prelude;
    Flow flow = run_body(ev, last, sink);
    bool found = false;
    for (size_t i = 0; flow == FLOW_NEXT && i < node->as.switch_.count; i++) {
        const SwitchCase *c = &node->as.switch_.cases[i];
        found = found || run_case_matches(ev, c, subject);
        last = &c->body;
        if (found) flow = run_body(ev, last, sink);
    }
    if (flow == FLOW_STOP || run_group_end(ev, node, last, flow == FLOW_NEXT) == FLOW_STOP) return FLOW_STOP;
    return FLOW_NEXT;
}

static bool may_set_element(Eval *ev, Array *array, const Slot *slot, const Value *v, Span span) {
    if (slot->set && slot->value.kind == VALUE_FUNCTION && v->kind != VALUE_ERROR) {
        diag_error(ev->diags, span, "this element is a function already: #undef it first");
        return false;
    }
    return array_accepts(ev, array, v, span);
}

static void check_semicolon(Eval *ev, const Node *node, bool is_number) {
    if (!is_number || !node->as.declare.unended) return;
    if (ev->version < 3.5)
        diag_warning(ev->diags, node->as.declare.after, "the value wants a ';' after it");
    else
        diag_error(ev->diags, node->as.declare.after, "expected ';' after the value");
}

void run_assign(Eval *ev, const Node *node) {
    const Node *target = node->as.declare.target, *source = node->as.declare.value;
    ev->at = node->span;
    Value v;
    double number;
    bool is_float = false;
    if (source->kind == NODE_BLOCK && target->kind == NODE_NAME)
        v = eval_block(ev, source, target->as.name);
    else
        is_float = eval_operand(ev, source, &number, &v);
    if (!is_float && v.kind == VALUE_VECTOR && v.size > 5)
        v = eval_fail(ev, source->span, "a vector has 2 to 5 components, this one %d", v.size);
    check_semicolon(ev, node, is_float || value_is_numeric(&v));
    if (target->kind == NODE_NAME) {
        if (!scope_may_declare(ev, target->as.name, is_float ? VALUE_FLOAT : v.kind, target->span)) return;
        Slot *slot = scope_declare(ev, target->as.name, node->as.declare.local);
        if (is_float)
            slot_set_float(ev, slot, number);
        else
            slot_set(ev, slot, &v);
        return;
    }
    if (is_float) v = value_float(number);
    bool failed = false;
    Array *array = NULL;
    Slot *slot = eval_element(ev, target, &array, &failed);
    if (!slot && !failed) {
        const Node *base = target;
        while (base->kind != NODE_NAME)
            base = base->kind == NODE_INDEX ? base->as.apply.base : base->as.operand.a;
        eval_undeclared(ev, base->as.name, base->span);
    }
    if (slot && may_set_element(ev, array, slot, &v, source->span)) slot_set(ev, slot, &v);
}

static void run_undef(Eval *ev, const Node *node) {
    const Node *target = node->as.list.items[0];
    bool failed = false;
    if (target->kind == NODE_NAME) {
        VarBinding *b = scope_find(ev, target->as.name);
        if (!b || !b->slot->set)
            diag_warning(ev->diags, target->span, "'%s' is not declared", target->as.name->text);
        scope_undef(ev, target->as.name);
        return;
    }
    Slot *slot = eval_target(ev, target, &failed);
    if (slot) slot_clear(ev, slot);
}

/* #warning tells where it stands, as every warning does. */
static const char *located_warning(Eval *ev, Span span, const char *text, size_t length) {
    SourcePlace place = source_locate(ev->sources, span);
    bool ended = length > 0 && text[length - 1] == '\n';
    return arena_printf(&ev->temp, "%s:%u:%u: warning: %s%s", place.file ? place.file->name : "?", place.line,
                        place.column, text, ended ? "" : "\n");
}

static void run_message(Eval *ev, const Node *node) {
    const char *text;
    size_t length;
    if (!eval_string(ev, node->as.operand.a, &text, &length)) return;
    EvalStream stream = EVAL_STREAM_DEBUG;
    switch (node->op) {
    case KW_error:
        while (length && (unsigned char)text[length - 1] <= ' ') length--;
        diag_error(ev->diags, node->span, "#error: %.*s", (int)size_min(length, 10000), text);
        ev->stopped = true;
        return;
    case KW_warning: stream = EVAL_STREAM_WARNING; break;
    case KW_render: stream = EVAL_STREAM_RENDER; break;
    case KW_statistics: stream = EVAL_STREAM_STATISTICS; break;
    default: break;
    }
    /* After an error the program goes on only to find more errors. */
    if (!ev->options->on_text || ev->diags->error_count) return;
    if (node->op == KW_warning) text = located_warning(ev, node->span, text, length);
    ev->options->on_text(ev->options->context, stream, text);
}

static void run_version(Eval *ev, const Node *node) {
    double version;
    if (!eval_float(ev, node->as.operand.a, &version)) return;
    if (version > 3.85) {
        diag_error(ev->diags, node->as.operand.a->span,
                   "the scene asks for version %g of the language, this is 3.8 at most", version);
    } else {
        ev->version = version;
        ev->build.old_noise = version < 3.5;
        ev->build.old_gamma = version < 3.7;
    }
    if (node->op == 0) diag_warning(ev->diags, node->span, "#version wants a ';' after its number");
}

static void run_default(Eval *ev, const Node *node) {
    ArenaMark mark = arena_mark(&ev->blocks);
    size_t errors = ev->diags->failures;
    const EvalBlock *block =
        eval_block_items(ev, node->as.block.word, node->as.block.word_span, node->span, node->as.block.body);
    if (errors == ev->diags->failures) scene_draft_default(ev->draft, &ev->build, block);
    arena_reset_to(&ev->blocks, mark);
}

static bool is_macro_call(const Eval *ev, const Node *node) {
    const Macro *macro;
    return node->as.apply.base->kind == NODE_NAME &&
           scope_classify(ev, node->as.apply.base->as.name, &macro) == NAME_MACRO;
}

static void run_value(Eval *ev, const Node *node, Sink *sink) {
    Value v;
    double number;
    if (eval_operand(ev, node, &number, &v)) {
        v = value_float(number);
        if (sink->kind == SINK_SINGLE && !sink->filled) {
            sink->value = v;
            sink->filled = true;
            return;
        }
    }
    sink_value(ev, sink, v, node->span);
}

/* Commas separate values; a semicolon ends a directive, which takes it along, and a second one after #declare is let pass. */
static void check_stray(Eval *ev, const Node *node, const Sink *sink) {
    if (ev->diags->failures) return; /* likely left over from what failed */
    bool comma = node->op == ',';
    bool in_set = sink->kind == SINK_ITEMS && block_holds_objects(ev, sink->block);
    if (sink->kind != SINK_SCENE && !in_set && (comma || sink->kind != SINK_ITEMS)) return;
    diag_error(ev->diags, node->span, "unexpected '%c'", node->op);
}

Flow run_node(Eval *ev, const Node *node, Sink *sink) {
    Flow flow = FLOW_NEXT;
    bool after_declare = ev->after_declare;
    ev->after_declare = node->kind == NODE_DECLARE;
    switch (node->kind) {
    case NODE_DECLARE: run_assign(ev, node); break;
    case NODE_UNDEF: run_undef(ev, node); break;
    case NODE_IF: flow = run_if(ev, node, sink); break;
    case NODE_WHILE: flow = run_while(ev, node, sink); break;
    case NODE_FOR: flow = run_for(ev, node, sink); break;
    case NODE_SWITCH: flow = run_switch(ev, node, sink); break;
    case NODE_BREAK:
        ev->last_break = ev->break_end = node->span;
        flow = FLOW_BREAK;
        break;
    case NODE_MACRO: run_define_macro(ev, node); break;
    case NODE_INCLUDE: flow = run_include(ev, node, sink); break;
    case NODE_VERSION: run_version(ev, node); break;
    case NODE_DEFAULT: run_default(ev, node); break;
    case NODE_MESSAGE: run_message(ev, node); break;
    case NODE_FOPEN: run_fopen(ev, node); break;
    case NODE_FCLOSE: run_fclose(ev, node); break;
    case NODE_READ: run_read(ev, node); break;
    case NODE_WRITE: run_write(ev, node); break;
    case NODE_WORD: sink_word(ev, sink, node); break;
    case NODE_ENTRY: sink_entry(ev, sink, node); break;
    case NODE_LIST: sink_list(ev, sink, node); break;
    case NODE_NUMBERS: sink_numbers(ev, sink, node->as.numbers); break;
    case NODE_EMPTY:
        if (node->op == ',' || !after_declare) check_stray(ev, node, sink);
        sink->layers = false;
        break;
    case NODE_ERROR: break;
    case NODE_CALL:
        if (is_macro_call(ev, node)) return run_call(ev, node, sink);
        sink_value(ev, sink, eval_node(ev, node), node->span);
        break;
    default: run_value(ev, node, sink); break;
    }
    if (ev->diags->error_count && diag_full(ev->diags)) ev->stopped = true;
    return ev->stopped ? FLOW_STOP : flow;
}
