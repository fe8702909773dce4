/* Functions: `function(x, y) { … }` is compiled to a tape when it is met; what it names is captured then. */
#include "eval/eval_function.h"

#include <string.h>

typedef struct Compiler {
    Eval *ev;
    TapeBuilder *tape;
    const Name *names;     /* of the parameters */
    const TapeRef *values; /* their values */
    size_t count;
    bool failed;
} Compiler;

enum { WHOLE_VALUE = -1 }; /* of a call without .x, .red … */

/* Functions of functions grow fast: each call within one is a copy. */
enum { FUNCTION_MOST_OPERATIONS = 1000000, FUNCTION_DEEPEST = 100 };
static const double FUNCTION_MOST_WORK = 1e9;

static TapeRef compile(Compiler *c, const Node *n);

static TapeRef VTS_PRINTF(3, 4) compiler_fail(Compiler *c, Span span, const char *format, ...) {
    va_list args;
    va_start(args, format);
    diag_error_va(c->ev->diags, span, format, args);
    va_end(args);
    c->failed = true;
    return tape_constant(c->tape, 0);
}

static TapeRef number(Compiler *c, double value) { return tape_constant(c->tape, value); }

static bool find_parameter(const Compiler *c, Name name, TapeRef *out) {
    for (size_t i = c->count; i > 0; i--)
        if (c->names[i - 1] == name) {
            *out = c->values[i - 1];
            return true;
        }
    return false;
}

static TapeRef captured(Compiler *c, const Value *v, Span span) {
    if (v->kind == VALUE_FLOAT) return number(c, v->as.number);
    if (v->kind == VALUE_ERROR)
        c->failed = true;
    else
        diag_error(c->ev->diags, span, "a function is made of floats, this is %s", value_kind_text(v->kind)),
            c->failed = true;
    return number(c, 0);
}

static TapeRef compile_name(Compiler *c, const Node *n) {
    TapeRef parameter;
    if (find_parameter(c, n->as.name, &parameter)) return parameter;
    Value v = eval_node(c->ev, n);
    return captured(c, &v, n->span);
}

/* x, y, z are the parameters where none are named; u and v stand for the first two. */
static TapeRef compile_constant(Compiler *c, const Node *n) {
    TapeRef parameter;
    Keyword k = (Keyword)n->op;
    if (k == KW_x || k == KW_y || k == KW_z || k == KW_u || k == KW_v || k == KW_t) {
        if (find_parameter(c, c->ev->keywords.name_of[k], &parameter)) return parameter;
        Keyword same = k == KW_u ? KW_x : k == KW_v ? KW_y : k;
        if (find_parameter(c, c->ev->keywords.name_of[same], &parameter)) return parameter;
        return compiler_fail(c, n->span, "'%s' is no parameter of this function", keyword_text(k));
    }
    Value v = eval_constant(c->ev, n);
    return captured(c, &v, n->span);
}

static TapeRef truth(Compiler *c, TapeRef a, Span span) {
    return tape_binary(c->tape, TAPE_NE, a, number(c, 0), span);
}

static TapeRef compile_binary(Compiler *c, const Node *n) {
    static const struct {
        int op;
        TapeOp tape;
    } ops[] = {{'+', TAPE_ADD},
               {'-', TAPE_SUB},
               {'*', TAPE_MUL},
               {'/', TAPE_DIV},
               {'<', TAPE_LT},
               {'>', TAPE_GT},
               {'=', TAPE_EQ},
               {TOKEN_LESS_EQUAL, TAPE_LE},
               {TOKEN_GREATER_EQUAL, TAPE_GE},
               {TOKEN_NOT_EQUAL, TAPE_NE},
               {'&', TAPE_AND},
               {'|', TAPE_OR}};
    TapeRef a = compile(c, n->as.operand.a), b = compile(c, n->as.operand.b);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(ops); i++)
        if (ops[i].op == n->op) return tape_binary(c->tape, ops[i].tape, a, b, n->span);
    return compiler_fail(c, n->span, "this cannot be part of a function");
}

static TapeRef compile_unary(Compiler *c, const Node *n) {
    TapeRef a = compile(c, n->as.operand.a);
    if (n->op == '-') return tape_unary(c->tape, TAPE_NEG, a, n->span);
    if (n->op == '!') return compiler_fail(c, n->span, "'!' is not for functions: compare with 0 instead");
    return a;
}

static TapeRef compile_condition(Compiler *c, const Node *n) {
    TapeRef test = truth(c, compile(c, n->as.operand.a), n->span);
    TapeRef yes = compile(c, n->as.operand.b), no = compile(c, n->as.operand.c);
    return tape_ternary(c->tape, TAPE_SELECT, tape_unary(c->tape, TAPE_NEG, test, n->span), yes, no, n->span);
}

static bool takes(Compiler *c, const Node *n, size_t least, size_t most) {
    if (builtin_argument_count(c->ev, n, least, most)) return true;
    c->failed = true;
    return false;
}

static TapeRef compile_select(Compiler *c, const Node *n) {
    TapeRef a[4] = {0};
    if (!takes(c, n, 3, 4)) return number(c, 0);
    size_t count = n->as.list.count;
    for (size_t i = 0; i < count; i++) a[i] = compile(c, n->as.list.items[i]);
    if (count == 3) return tape_ternary(c->tape, TAPE_SELECT, a[0], a[1], a[2], n->span);
    TapeRef above =
        tape_ternary(c->tape, TAPE_SELECT, tape_unary(c->tape, TAPE_NEG, a[0], n->span), a[3], a[2], n->span);
    return tape_ternary(c->tape, TAPE_SELECT, a[0], a[1], above, n->span);
}

/* sum(i, from, to, body): the body is a tape of its own, with the surrounding parameters captured and i last. */
static TapeRef compile_loop(Compiler *c, const Node *n) {
    if (!takes(c, n, 4, 4)) return number(c, 0);
    Eval *ev = c->ev;
    TapeRef from = compile(c, n->as.list.items[1]), to = compile(c, n->as.list.items[2]);
    size_t inner_count = c->count + 1;
    Name *names = arena_new_array(&ev->temp, Name, inner_count);
    TapeRef *values = arena_new_array(&ev->temp, TapeRef, inner_count);
    Compiler inner = {.ev = ev,
                      .tape = tape_builder_create(ev->build.arena, (int)inner_count),
                      .names = names,
                      .values = values,
                      .count = inner_count};
    for (size_t i = 0; i < c->count; i++) names[i] = c->names[i];
    names[c->count] = n->as.list.items[0]->as.name;
    for (size_t i = 0; i < inner_count; i++) values[i] = tape_input(inner.tape, (int)i);
    TapeRef out = compile(&inner, n->as.list.items[3]);
    c->failed = c->failed || inner.failed;
    const Tape *body = tape_finish(inner.tape, &out, 1);
    return tape_loop(c->tape, n->op == KW_prod, from, to, body, c->values, (int)c->count, n->span);
}

static bool unary_op(int keyword, TapeOp *out) {
    static const struct {
        int keyword;
        TapeOp op;
    } ops[] = {{KW_abs, TAPE_ABS},         {KW_floor, TAPE_FLOOR}, {KW_ceil, TAPE_CEIL},
               {KW_int, TAPE_INT},         {KW_sqrt, TAPE_SQRT},   {KW_exp, TAPE_EXP},
               {KW_ln, TAPE_LN},           {KW_log, TAPE_LOG},     {KW_sin, TAPE_SIN},
               {KW_cos, TAPE_COS},         {KW_tan, TAPE_TAN},     {KW_asin, TAPE_ASIN},
               {KW_acos, TAPE_ACOS},       {KW_atan, TAPE_ATAN},   {KW_sinh, TAPE_SINH},
               {KW_cosh, TAPE_COSH},       {KW_tanh, TAPE_TANH},   {KW_asinh, TAPE_ASINH},
               {KW_acosh, TAPE_ACOSH},     {KW_atanh, TAPE_ATANH}, {KW_degrees, TAPE_DEGREES},
               {KW_radians, TAPE_RADIANS}, {KW_sqr, TAPE_SQR}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(ops); i++)
        if (ops[i].keyword == keyword) return *out = ops[i].op, true;
    return false;
}

static bool binary_op(int keyword, TapeOp *out) {
    static const struct {
        int keyword;
        TapeOp op;
    } ops[] = {{KW_min, TAPE_MIN},
               {KW_max, TAPE_MAX},
               {KW_pow, TAPE_POW},
               {KW_mod, TAPE_MOD},
               {KW_div, TAPE_IDIV},
               {KW_atan2, TAPE_ATAN2},
               {KW_bitwise_and, TAPE_BITWISE_AND},
               {KW_bitwise_or, TAPE_BITWISE_OR},
               {KW_bitwise_xor, TAPE_BITWISE_XOR}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(ops); i++)
        if (ops[i].keyword == keyword) return *out = ops[i].op, true;
    return false;
}

static TapeRef compile_builtin(Compiler *c, const Node *n) {
    TapeOp op;
    if (unary_op(n->op, &op))
        return takes(c, n, 1, 1) ? tape_unary(c->tape, op, compile(c, n->as.list.items[0]), n->span)
                                 : number(c, 0);
    if (binary_op(n->op, &op)) {
        bool many = op == TAPE_MIN || op == TAPE_MAX || op == TAPE_BITWISE_AND || op == TAPE_BITWISE_OR ||
                    op == TAPE_BITWISE_XOR;
        if (!takes(c, n, 2, many ? SIZE_MAX : 2)) return number(c, 0);
        TapeRef result = compile(c, n->as.list.items[0]);
        for (size_t i = 1; i < n->as.list.count; i++)
            result = tape_binary(c->tape, op, result, compile(c, n->as.list.items[i]), n->span);
        return result;
    }
    if (n->op == KW_select) return compile_select(c, n);
    if (n->op == KW_sum || n->op == KW_prod) return compile_loop(c, n);
    if (n->op == KW_cube) {
        TapeRef a = takes(c, n, 1, 1) ? compile(c, n->as.list.items[0]) : number(c, 0);
        return tape_binary(c->tape, TAPE_MUL, tape_unary(c->tape, TAPE_SQR, a, n->span), a, n->span);
    }
    /* What does not depend on the parameters is a constant of the function: dimension_size(A, 1), strings' lengths are not. */
    if (n->op == KW_dimension_size || n->op == KW_dimensions || n->op == KW_defined) {
        Value v = eval_builtin(c->ev, n);
        return captured(c, &v, n->span);
    }
    diag_error(c->ev->diags, n->span, "%s() cannot be used inside a function", keyword_text((Keyword)n->op));
    c->failed = true;
    return number(c, 0);
}

/* POV-Ray's weights. */
static TapeRef gray_of(Compiler *c, const TapeRef *color, Span span) {
    static const double weights[3] = {0.297, 0.589, 0.114};
    TapeRef sum = number(c, 0);
    for (int k = 0; k < 3; k++)
        sum = tape_binary(c->tape, TAPE_ADD, sum,
                          tape_binary(c->tape, TAPE_MUL, number(c, weights[k]), color[k], span), span);
    return sum;
}

static TapeRef inline_function(Compiler *c, const UserFunction *f, const NodeList *list, Span span,
                               int output) {
    TapeRef inputs[FUNCTION_INPUTS], outputs[TAPE_CALL_MAX] = {0};
    if ((size_t)f->parameter_count != list->count) {
        size_t takes = (size_t)f->parameter_count;
        eval_argument_count(c->ev, span, "the function", takes, takes, list->count, NULL);
        c->failed = true;
        return number(c, 0);
    }
    for (size_t i = 0; i < list->count; i++) inputs[i] = compile(c, list->items[i]);
    if (output == WHOLE_VALUE && tape_output_count(f->tape) > 1)
        return compiler_fail(c, span, "the function gives %d numbers: one of them is wanted here, as in F(x).red",
                             tape_output_count(f->tape));
    if (output == WHOLE_VALUE) output = 0;
    bool gray = output == DOT_GRAY && tape_output_count(f->tape) >= 3;
    if (!gray && (output >= tape_output_count(f->tape) || output < 0))
        return compiler_fail(c, span, "the function's value has no such component");
    if (tape_builder_size(c->tape) + tape_instruction_count(f->tape) > FUNCTION_MOST_OPERATIONS)
        return compiler_fail(c, span, "this function has more than %d operations", FUNCTION_MOST_OPERATIONS);
    tape_inline(c->tape, f->tape, inputs, outputs);
    return gray ? gray_of(c, outputs, span) : outputs[output];
}

static TapeRef compile_known(Compiler *c, const Node *n, const KnownFunction *known) {
    TapeRef arguments[8] = {0}, result;
    const NodeList *list = &n->as.apply.list;
    if (!known_function_takes(c->ev, n, known)) {
        c->failed = true;
        return number(c, 0);
    }
    for (size_t i = known->takes_noise ? 1 : 0; i < list->count; i++)
        arguments[i] = compile(c, list->items[i]);
    if (known->compile(c->ev, c->tape, n, arguments, list->count, &result)) return result;
    c->failed = true;
    return number(c, 0);
}

static TapeRef compile_call(Compiler *c, const Node *n, int output) {
    const Node *base = n->as.apply.base;
    Value callee = value_error();
    if (base->kind == NODE_NAME) {
        VarBinding *b = scope_find(c->ev, base->as.name);
        if (!b || !b->slot->set) {
            const KnownFunction *known = known_function_find(base->as.name);
            if (known && known->compile) return compile_known(c, n, known);
            Diagnostic *d =
                diag_error(c->ev->diags, base->span, "function '%s' is not declared", base->as.name->text);
            eval_hint_name(&c->ev->build, d, base->as.name->text, NULL, 0);
            c->failed = true;
            return number(c, 0);
        }
        callee = b->slot->value;
    } else {
        callee = eval_node(c->ev, base);
    }
    if (callee.kind == VALUE_FUNCTION)
        return inline_function(c, callee.as.function, &n->as.apply.list, n->span, output);
    if (callee.kind == VALUE_MACRO) {
        Value v = eval_node(c->ev, n);
        return captured(c, &v, n->span);
    }
    if (callee.kind != VALUE_ERROR) return compiler_fail(c, base->span, "this is no function");
    c->failed = true;
    return number(c, 0);
}

/* A component of a captured vector, an element of a captured array. */
static TapeRef compile_value(Compiler *c, const Node *n) {
    Value v = eval_node(c->ev, n);
    return captured(c, &v, n->span);
}

static TapeRef compile(Compiler *c, const Node *n) {
    switch (n->kind) {
    case NODE_NUMBER: return number(c, n->as.number);
    case NODE_NAME: return compile_name(c, n);
    case NODE_CONSTANT: return compile_constant(c, n);
    case NODE_VALUE: return captured(c, n->as.value, n->span);
    case NODE_UNARY: return compile_unary(c, n);
    case NODE_BINARY: return compile_binary(c, n);
    case NODE_CONDITION: return compile_condition(c, n);
    case NODE_BUILTIN: return compile_builtin(c, n);
    case NODE_CALL: return compile_call(c, n, WHOLE_VALUE);
    case NODE_DOT:
        return n->as.operand.a->kind == NODE_CALL ? compile_call(c, n->as.operand.a, n->op)
                                                  : compile_value(c, n);
    case NODE_INDEX: return compile_value(c, n);
    case NODE_STRING: return compiler_fail(c, n->span, "functions know no strings");
    case NODE_VECTOR: return compiler_fail(c, n->span, "a vector can only be a function's whole body");
    default: return compiler_fail(c, n->span, "this cannot be part of a function");
    }
}

UserFunction *function_new(Eval *ev, const Node *node, int count) {
    UserFunction *f = arena_new(ev->build.arena, UserFunction);
    f->span = node->span;
    f->parameter_count = count;
    if (!node->as.function.columns) return f;
    double columns, rows;
    if (eval_float(ev, node->as.function.columns, &columns) && eval_float(ev, node->as.function.rows, &rows)) {
        f->columns = double_to_int(columns, 0, 1e6);
        f->rows = double_to_int(rows, 0, 1e6);
    }
    return f;
}

static Value pigment_function(Eval *ev, const Node *node, const Pigment *pigment, bool pattern) {
    const EvalGeometry *g = ev->options->geometry;
    bool (*make)(void *, Arena *, const Pigment *, TapeExternal *) = !g        ? NULL
                                                                     : pattern ? g->pattern_function
                                                                               : g->pigment_function;
    TapeExternal *external = arena_new(ev->build.arena, TapeExternal);
    for (const InertNote *note = pigment->inert; note; note = note->next)
        diag_warning(ev->diags, note->span, "'%s' is not modelled yet: it has no effect", note->word);
    if (make && make(g->context, ev->build.arena, pigment, external))
        return external_function(ev, node, external);
    diag_error(ev->diags, node->span, "this pigment cannot be a function here");
    return value_error();
}

/* function { pigment { … } } and the like. */
static Value block_function(Eval *ev, const Node *node, const Node *body) {
    if (body->kind == NODE_BUILTIN) {
        double id;
        if (!builtin_argument_count(ev, body, 1, 1) || !eval_float(ev, body->as.list.items[0], &id))
            return value_error();
        return internal_function(ev, node, double_to_int(id, -1, 1000));
    }
    Value v = eval_node(ev, body);
    if (v.kind == VALUE_ERROR) return v;
    if (v.kind == VALUE_SPLINE) return spline_function(ev, node, v.as.spline);
    if (v.kind == VALUE_TRANSFORM) return transform_function(ev, node, v.as.transform);
    if (v.kind == VALUE_PIGMENT) {
        Keyword word = keyword_of(&ev->keywords, body->as.block.word);
        return pigment_function(ev, node, v.as.pigment, word == KW_pattern);
    }
    diag_error(ev->diags, body->as.block.word_span,
               "a function is an expression or one of pigment, pattern, spline and transform");
    return value_error();
}

/* x, y, z; those of a parametric surface say u, v for the first two. */
static const Name *default_parameters(Eval *ev) {
    Name *names = arena_new_array(ev->build.arena, Name, 5);
    names[0] = ev->keywords.name_of[KW_x];
    names[1] = ev->keywords.name_of[KW_y];
    names[2] = ev->keywords.name_of[KW_z];
    names[3] = ev->keywords.name_of[KW_u];
    names[4] = ev->keywords.name_of[KW_v];
    return names;
}

static bool check_size(Eval *ev, const UserFunction *f) {
    if (tape_depth(f->tape) > FUNCTION_DEEPEST)
        diag_error(ev->diags, f->span, "functions are nested more than %d deep", FUNCTION_DEEPEST);
    else if (tape_work(f->tape) > FUNCTION_MOST_WORK)
        diag_error(ev->diags, f->span, "one call of this function takes more than %g steps", FUNCTION_MOST_WORK);
    else
        return true;
    return false;
}

Value eval_function(Eval *ev, const Node *node) {
    const NodeList *body = &node->as.function.body;
    if (body->count == 0) {
        diag_error(ev->diags, node->span, "this function has no body");
        return value_error();
    }
    const Node *first = body->items[0];
    if (first->kind == NODE_BLOCK || (first->kind == NODE_BUILTIN && first->op == KW_internal))
        return block_function(ev, node, first);
    bool vector = body->count == 1 && first->kind == NODE_VECTOR;
    const NodeList *outputs = vector ? &first->as.list : body;
    size_t count = node->as.function.count ? node->as.function.count : 3;
    if (count > FUNCTION_INPUTS || outputs->count > 5) {
        diag_error(ev->diags, node->span, "a function has at most %d parameters and 5 components",
                   FUNCTION_INPUTS);
        return value_error();
    }
    UserFunction *f = function_new(ev, node, (int)count);
    f->parameters = node->as.function.count
                        ? arena_copy(ev->build.arena, node->as.function.parameters, count * sizeof(Name))
                        : default_parameters(ev);
    if (!eval_has_memory(ev, 0, node->span)) return value_error();
    TapeRef inputs[FUNCTION_INPUTS], results[5];
    Compiler c = {.ev = ev,
                  .tape = tape_builder_create(ev->build.arena, (int)count),
                  .names = f->parameters,
                  .values = inputs,
                  .count = node->as.function.count ? count : 5};
    for (size_t i = 0; i < count; i++) inputs[i] = tape_input(c.tape, (int)i);
    if (!node->as.function.count) inputs[3] = inputs[0], inputs[4] = inputs[1];
    for (size_t i = 0; i < outputs->count; i++) results[i] = compile(&c, outputs->items[i]);
    if (c.failed) return value_error();
    f->tape = tape_finish(c.tape, results, (int)outputs->count);
    return check_size(ev, f) ? (Value){.kind = VALUE_FUNCTION, .as.function = f} : value_error();
}

Value call_function(Eval *ev, const UserFunction *function, const NodeList *arguments, Span span) {
    double in[FUNCTION_INPUTS], out[TAPE_CALL_MAX];
    bool vector = false, ok = true;
    for (size_t i = 0; i < arguments->count && i < FUNCTION_INPUTS; i++) {
        Value v = eval_node(ev, arguments->items[i]);
        /* F(<x, y, z>) is F(x, y, z) */
        if (arguments->count == 1 && function->parameter_count > 1 && v.kind == VALUE_VECTOR &&
            v.size == function->parameter_count) {
            vector = true;
            for (int k = 0; k < v.size; k++) in[k] = v.as.components[k];
        } else {
            ok = value_to_float(ev, &v, arguments->items[i]->span, &in[i]) && ok;
        }
    }
    if (!ok) return value_error();
    if (!vector && arguments->count != (size_t)function->parameter_count) {
        size_t takes = (size_t)function->parameter_count;
        eval_argument_count(ev, span, "the function", takes, takes, arguments->count, NULL);
        return value_error();
    }
    tape_eval_once(function->tape, in, out);
    int count = tape_output_count(function->tape);
    return count == 1 ? value_float(out[0]) : value_vector(ev, out, count);
}
