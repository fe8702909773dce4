#include "eval/eval_state.h"

void run_define_macro(Eval *ev, const Node *node) {
    VarBinding *b = scope_find(ev, node->as.macro.name);
    ValueKind old = b && b->slot->set ? b->slot->value.kind : VALUE_ERROR;
    if (old != VALUE_ERROR && old != VALUE_MACRO) {
        diag_error(ev->diags, node->as.macro.name_span, "'%s' is %s already: #undef it first",
                   node->as.macro.name->text, value_kind_text(old));
        return;
    }
    Macro *m = arena_new(ev->parse, Macro);
    m->name = node->as.macro.name;
    m->name_span = node->as.macro.name_span;
    m->parameter_count = node->as.macro.count;
    m->required = node->as.macro.required;
    m->parameters = arena_copy(ev->parse, node->as.macro.parameters,
                               m->parameter_count * sizeof(Name)); /* the tree may be a passing one */
    m->body = node->as.macro.body;
    m->half = node->as.macro.unbalanced;
    ev->half_macros = ev->half_macros || m->half;
    m->whole = !m->half && parser_body_is_whole(&m->body);
    m->next = ev->macros;
    ev->macros = m;
    Value v = {.kind = VALUE_MACRO, .as.macro = m};
    slot_set(ev, scope_declare(ev, m->name, false), &v);
    ev->macro_stamp++;
}

bool macro_half_called(const Eval *ev, const TokenList *tokens, uint32_t begin, uint32_t end) {
    if (!ev->half_macros) return false;
    for (uint32_t i = begin; i < end; i++) {
        const Token *t = &tokens->items[i];
        const Macro *macro;
        if (t->kind == TOKEN_WORD && !t->keyword && scope_classify(ev, t->as.name, &macro) == NAME_MACRO &&
            macro->half)
            return true;
    }
    return false;
}

/* ---- does a call stand for an expression? ---- */

/* What a body leaves behind, found without running it: how many values, and how tightly the loosest binds. */
typedef struct Shape {
    int values;      /* 0, 1, or 2 for more or unknown */
    Binding binding; /* of the value */
    bool block;      /* the value is a block */
} Shape;

static Shape body_shape(Eval *ev, const Body *body);

static Binding node_binding(Eval *ev, const Node *n) {
    const Macro *macro;
    switch (n->kind) {
    case NODE_BINARY:
        if (n->op == '+' || n->op == '-') return BIND_SUM;
        return n->op == '*' || n->op == '/' ? BIND_PRODUCT : BIND_NONE;
    case NODE_UNARY: return n->op == '(' ? BIND_PRIMARY : BIND_PRODUCT;
    case NODE_CONDITION: return BIND_NONE;
    case NODE_COLOR: return BIND_ANY;
    case NODE_CALL:
        if (n->as.apply.base->kind != NODE_NAME ||
            scope_classify(ev, n->as.apply.base->as.name, &macro) != NAME_MACRO)
            return BIND_PRIMARY;
        return macro_binding(ev, macro);
    default: return BIND_PRIMARY;
    }
}

static Shape both(Shape a, Shape b) {
    if (a.values + b.values >= 2) return (Shape){2, BIND_NONE, false};
    return a.values ? a : b;
}

static Shape either(Shape a, Shape b) {
    if (a.values != b.values) return (Shape){2, BIND_NONE, false};
    return (Shape){a.values, a.binding < b.binding ? a.binding : b.binding, a.block || b.block};
}

static Shape branches_shape(Eval *ev, const Node *n) {
    Shape shape = {0, BIND_PRIMARY, false};
    bool has_else = false;
    for (size_t i = 0; i < n->as.branches.count; i++) {
        Shape one = body_shape(ev, &n->as.branches.branches[i].body);
        shape = i == 0 ? one : either(shape, one);
        has_else = has_else || !n->as.branches.branches[i].condition;
    }
    return has_else ? shape : either(shape, (Shape){0, BIND_PRIMARY, false});
}

static Shape cases_shape(Eval *ev, const Node *n) {
    if (n->as.switch_.prelude.begin < n->as.switch_.prelude.end) return (Shape){2, BIND_NONE, false};
    Shape shape = {0, BIND_PRIMARY, false};
    for (size_t i = 0; i < n->as.switch_.count; i++) {
        Shape one = body_shape(ev, &n->as.switch_.cases[i].body);
        shape = i == 0 ? one : either(shape, one);
    }
    return shape;
}

static Shape call_shape(Eval *ev, const Node *n) {
    const Macro *macro;
    if (n->as.apply.base->kind != NODE_NAME ||
        scope_classify(ev, n->as.apply.base->as.name, &macro) != NAME_MACRO)
        return (Shape){1, BIND_PRIMARY, false};
    Macro *m = (Macro *)(uintptr_t)macro;
    if (m->measuring) return (Shape){1, BIND_PRIMARY, false};
    if (!m->whole) return (Shape){2, BIND_NONE, false};
    m->measuring = true;
    Shape shape = body_shape(ev, &m->body);
    m->measuring = false;
    return shape;
}

static Shape node_shape(Eval *ev, const Node *n) {
    switch (n->kind) {
    case NODE_DECLARE:
    case NODE_UNDEF:
    case NODE_BREAK:
    case NODE_MACRO:
    case NODE_VERSION:
    case NODE_DEFAULT:
    case NODE_MESSAGE:
    case NODE_FOPEN:
    case NODE_FCLOSE:
    case NODE_READ:
    case NODE_WRITE: return (Shape){0, BIND_PRIMARY, false};
    case NODE_IF: return branches_shape(ev, n);
    case NODE_SWITCH: return cases_shape(ev, n);
    case NODE_WHILE:
        return body_shape(ev, &n->as.loop.body).values ? (Shape){2, BIND_NONE, false}
                                                       : (Shape){0, BIND_PRIMARY, false};
    case NODE_FOR:
        return body_shape(ev, &n->as.for_loop.body).values ? (Shape){2, BIND_NONE, false}
                                                           : (Shape){0, BIND_PRIMARY, false};
    case NODE_INCLUDE:
    case NODE_WORD:
    case NODE_ENTRY:
    case NODE_LIST:
    case NODE_EMPTY:
    case NODE_NUMBERS:
    case NODE_ERROR: return (Shape){2, BIND_NONE, false};
    case NODE_CALL: return call_shape(ev, n);
    default: return (Shape){1, node_binding(ev, n), n->kind == NODE_BLOCK};
    }
}

/* Bodies are parsed here before they run, when names that they declare themselves mean nothing yet: those trees are not kept. */
static Shape body_shape(Eval *ev, const Body *body) {
    Shape shape = {0, BIND_PRIMARY, false};
    if (!body->tokens) return (Shape){2, BIND_NONE, false};
    Parser p = {.arena = &ev->temp,
                .diags = ev->diags,
                .keywords = &ev->keywords,
                .host = &ev->fast_host,
                .list = body->tokens,
                .at = body->begin,
                .end = body->end,
                .guessing = true};
    while (p.at < p.end && shape.values < 2) {
        Node *n = parser_statement(&p);
        if (!n) return (Shape){2, BIND_NONE, false};
        shape = both(shape, node_shape(ev, n));
    }
    return shape;
}

Binding macro_binding(Eval *ev, const Macro *macro) {
    Macro *m = (Macro *)(uintptr_t)macro; /* the answer is cached in the macro */
    if (m->measuring) return BIND_PRIMARY;
    if (m->stamp == ev->macro_stamp && m->stamp) return m->binding;
    m->binding = BIND_NONE;
    if (m->whole) {
        ArenaMark mark = arena_mark(&ev->temp);
        m->measuring = true;
        Shape shape = body_shape(ev, &m->body);
        m->measuring = false;
        arena_reset_to(&ev->temp, mark);
        if (shape.values == 1) m->binding = shape.binding;
        m->is_block = shape.block;
    }
    m->stamp = ev->macro_stamp;
    return m->binding;
}

/* ---- calls ---- */

/* Names and elements of arrays go by reference, everything else by value, evaluated once and before the scope is entered; what is left
 * out is neither. */
typedef struct Passed {
    Slot *reference;
    Value value;
} Passed;

static bool pass(Eval *ev, const Macro *m, size_t index, const Node *argument, Passed *out) {
    *out = (Passed){0};
    if (argument->kind == NODE_EMPTY) {
        if (index >= m->required) return true;
        Diagnostic *d = diag_error(ev->diags, argument->span, "expected a value for '%s', found ','", m->parameters[index]->text);
        diag_note(ev->diags, d, m->name_span, "'%s' is defined here", m->name->text);
        return false;
    }
    if (argument->kind == NODE_NAME || argument->kind == NODE_INDEX) {
        bool failed = false;
        Array *array = NULL;
        out->reference = eval_element(ev, argument, &array, &failed);
        if (failed) return false;
        if (array && out->reference && array_is_partial(ev, array, &out->reference->value, argument->span))
            return false;
        if (argument->kind == NODE_NAME && (!out->reference || !out->reference->set)) {
            eval_undeclared(ev, argument->as.name, argument->span);
            return false;
        }
        if (out->reference && !out->reference->set) {
            diag_error(ev->diags, argument->span, "this element of the array was never set");
            return false;
        }
        if (out->reference) return true;
    }
    double number;
    if (eval_operand(ev, argument, &number, &out->value)) {
        out->value = value_float(number);
        return true;
    }
    return out->value.kind != VALUE_ERROR;
}

static bool count_matches(Eval *ev, const Macro *m, size_t given, Span span) {
    if (given >= m->required && given <= m->parameter_count) return true;
    const char *what = arena_printf(&ev->temp, "macro '%s'", m->name->text);
    Diagnostic *d;
    eval_argument_count(ev, span, what, m->parameter_count, m->parameter_count, given, &d);
    diag_note(ev->diags, d, m->name_span, "'%s' is defined here", m->name->text);
    return false;
}

enum { FEW_ARGUMENTS = 16 };

bool macro_enter(Eval *ev, const Macro *m, const NodeList *arguments, Span span, Scope *scope,
                 CallRecord *record) {
    if (!count_matches(ev, m, arguments->count, span)) return false;
    if (ev->call_depth >= ev->options->limits.recursion) {
        diag_error(ev->diags, span, "macro calls are nested more than %u deep",
                   ev->options->limits.recursion);
        ev->stopped = true; /* what called itself this often would go on to do so on every level */
        return false;
    }
    if (!eval_has_stack(ev, span) || !eval_step(ev, span)) return false;
    ev->at = span;
    Passed few[FEW_ARGUMENTS];
    Passed *passed =
        arguments->count <= FEW_ARGUMENTS ? few : arena_new_array(&ev->temp, Passed, arguments->count);
    for (size_t i = 0; i < arguments->count; i++)
        if (!pass(ev, m, i, arguments->items[i], &passed[i])) return false;
    scope_enter(ev, scope);
    for (size_t i = 0; i < arguments->count; i++)
        scope_bind(ev, m->parameters[i], passed[i].reference, arguments->items[i]->kind == NODE_EMPTY ? NULL : &passed[i].value);
    for (size_t i = arguments->count; i < m->parameter_count; i++) scope_bind(ev, m->parameters[i], NULL, NULL);
    ((Macro *)(uintptr_t)m)->last_call = span;
    *record = (CallRecord){.outer = ev->calls, .macro = m->name, .span = span};
    ev->calls = record;
    ev->call_depth++;
    return true;
}

void macro_leave(Eval *ev, Scope *scope) {
    scope_leave(ev, scope);
    ev->calls = ev->calls->outer;
    ev->call_depth--;
}

Flow run_call(Eval *ev, const Node *node, Sink *sink) {
    VarBinding *b = scope_find(ev, node->as.apply.base->as.name);
    Scope scope;
    CallRecord record;
    if (!macro_enter(ev, b->slot->value.as.macro, &node->as.apply.list, node->span, &scope, &record)) {
        ev->silent_errors++; /* what the call would have left is missing */
        sink->filled = sink->filled || sink->kind == SINK_SINGLE;
        return FLOW_NEXT;
    }
    const Macro *macro = b->slot->set && b->slot->value.kind == VALUE_MACRO ? b->slot->value.as.macro : NULL;
    bool repeats = ev->repeats;
    ev->repeats = true;
    Flow flow = macro ? run_body(ev, &macro->body, sink) : FLOW_NEXT;
    ev->repeats = repeats;
    macro_leave(ev, &scope);
    return flow == FLOW_STOP ? FLOW_STOP : FLOW_NEXT;
}

static Value call_macro(Eval *ev, const Node *node) {
    Sink sink = {.kind = SINK_SINGLE};
    sink.value = value_error();
    size_t errors = ev->diags->failures;
    run_call(ev, node, &sink);
    if (!sink.filled && errors == ev->diags->failures && !ev->stopped)
        diag_error(ev->diags, node->span, "macro '%s' leaves no value", node->as.apply.base->as.name->text);
    return sink.value;
}

Value eval_call(Eval *ev, const Node *node) {
    const Node *base = node->as.apply.base;
    Value callee;
    if (base->kind == NODE_NAME) {
        VarBinding *b = scope_find(ev, base->as.name);
        if (!b || !b->slot->set) {
            bool known = false;
            Value v = call_known_function(ev, node, &known);
            if (known) return v;
            eval_undeclared(ev, base->as.name, base->span);
            return value_error();
        }
        if (b->slot->value.kind == VALUE_MACRO) return call_macro(ev, node);
        callee = b->slot->value;
    } else {
        callee = eval_node(ev, base);
    }
    switch (callee.kind) {
    case VALUE_FUNCTION: return call_function(ev, callee.as.function, &node->as.apply.list, node->span);
    case VALUE_SPLINE: return call_spline(ev, callee.as.spline, &node->as.apply.list, node->span);
    case VALUE_ERROR: return callee;
    default:
        diag_error(ev->diags, base->span, "%s cannot be called", value_kind_text(callee.kind));
        return value_error();
    }
}
