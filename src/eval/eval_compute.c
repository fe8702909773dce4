/* Arithmetic that loops are made of, compiled. An expression of numbers, names and functions of floats has no effect but its value,
 * so it may be tried in a short way first: as postfix code over doubles. Whatever the code is not made for (a name that holds no
 * float, a division by zero, an argument outside of a function's domain) makes it give up, and the tree is evaluated from the start
 * with all its rules and messages. */
#include "eval/eval_state.h"

#include <math.h>

typedef enum ComputeOp {
    COMPUTE_PUSH,
    COMPUTE_NEGATE, /* from here to COMPUTE_SQR: of the top alone */
    COMPUTE_NOT,
    COMPUTE_ABS,
    COMPUTE_CEIL,
    COMPUTE_COS,
    COMPUTE_FLOOR,
    COMPUTE_INT,
    COMPUTE_RADIANS,
    COMPUTE_SIN,
    COMPUTE_SQRT,
    COMPUTE_SQR,
    COMPUTE_ADD, /* from here on: of the top and the step's operand */
    COMPUTE_SUBTRACT,
    COMPUTE_MULTIPLY,
    COMPUTE_DIVIDE,
    COMPUTE_LESS,
    COMPUTE_GREATER,
    COMPUTE_EQUAL,
    COMPUTE_NOT_EQUAL,
    COMPUTE_LESS_EQUAL,
    COMPUTE_GREATER_EQUAL,
    COMPUTE_AND,
    COMPUTE_OR,
    COMPUTE_MOD,
    COMPUTE_DIV,
    COMPUTE_MIN,
    COMPUTE_MAX,
} ComputeOp;

typedef enum OperandFrom { FROM_NUMBER, FROM_NAME, FROM_STACK } OperandFrom;

enum { LONGEST_COMPUTE = 64, DEEPEST_COMPUTE = 16 };

/* What stands in a node that was met once, and in one that is not arithmetic. */
static const Compute MET_ONCE = {.pending = true}, NOT_COMPUTED = {0};

typedef struct Draft {
    ComputeStep steps[LONGEST_COMPUTE];
    uint32_t count, depth;
    Eval *ev;
} Draft;

static bool emit(Draft *d, ComputeStep step) {
    if (d->count == LONGEST_COMPUTE) return false;
    d->steps[d->count++] = step;
    return true;
}

static int binary_op(int op) {
    switch (op) {
    case '+': return COMPUTE_ADD;
    case '-': return COMPUTE_SUBTRACT;
    case '*': return COMPUTE_MULTIPLY;
    case '/': return COMPUTE_DIVIDE;
    case '<': return COMPUTE_LESS;
    case '>': return COMPUTE_GREATER;
    case '=': return COMPUTE_EQUAL;
    case TOKEN_NOT_EQUAL: return COMPUTE_NOT_EQUAL;
    case TOKEN_LESS_EQUAL: return COMPUTE_LESS_EQUAL;
    case TOKEN_GREATER_EQUAL: return COMPUTE_GREATER_EQUAL;
    case '&': return COMPUTE_AND;
    case '|': return COMPUTE_OR;
    default: return -1;
    }
}

static int two_argument_op(int keyword) {
    switch (keyword) {
    case KW_mod: return COMPUTE_MOD;
    case KW_div: return COMPUTE_DIV;
    case KW_min: return COMPUTE_MIN;
    case KW_max: return COMPUTE_MAX;
    default: return -1;
    }
}

static int one_argument_op(int keyword) {
    switch (keyword) {
    case KW_abs: return COMPUTE_ABS;
    case KW_ceil: return COMPUTE_CEIL;
    case KW_cos: return COMPUTE_COS;
    case KW_floor: return COMPUTE_FLOOR;
    case KW_int: return COMPUTE_INT;
    case KW_radians: return COMPUTE_RADIANS;
    case KW_sin: return COMPUTE_SIN;
    case KW_sqrt: return COMPUTE_SQRT;
    case KW_sqr: return COMPUTE_SQR;
    default: return -1;
    }
}

/* A number or a name as the operand of a step, without a push of its own. */
static bool direct_operand(Draft *d, const Node *node, ComputeStep *step) {
    if (node->kind == NODE_NUMBER) {
        step->from = FROM_NUMBER;
        step->number = node->as.number;
        return true;
    }
    if (node->kind == NODE_NAME) {
        step->from = FROM_NAME;
        step->name_id = node->as.name->id;
        return node->as.name->id < d->ev->binding_count;
    }
    return false;
}

static bool compile(Draft *d, const Node *node);

static bool compile_binary(Draft *d, int op, const Node *a, const Node *b) {
    ComputeStep step = {.op = (uint8_t)op, .from = FROM_STACK};
    if (op < 0 || !compile(d, a)) return false;
    if (!direct_operand(d, b, &step)) {
        if (!compile(d, b)) return false;
        d->depth--;
    }
    return emit(d, step);
}

static bool compile_unary(Draft *d, int op, const Node *a) {
    return op >= 0 && compile(d, a) && emit(d, (ComputeStep){.op = (uint8_t)op});
}

static bool compile_constant(Draft *d, const Node *node) {
    if (node->op == KW_now || node->op == KW_version || node->op == KW_phase) return false;
    if (node->op == KW_x || node->op == KW_y || node->op == KW_z || node->op == KW_t || node->op == KW_u ||
        node->op == KW_v)
        return false;
    Value v = eval_constant(d->ev, node);
    return v.kind == VALUE_FLOAT && ++d->depth <= DEEPEST_COMPUTE &&
           emit(d, (ComputeStep){.op = COMPUTE_PUSH, .from = FROM_NUMBER, .number = v.as.number});
}

static bool compile(Draft *d, const Node *node) {
    ComputeStep push = {.op = COMPUTE_PUSH};
    if (direct_operand(d, node, &push)) return ++d->depth <= DEEPEST_COMPUTE && emit(d, push);
    switch (node->kind) {
    case NODE_UNARY:
        if (node->op == '(' || node->op == '+') return compile(d, node->as.operand.a);
        return compile_unary(d, node->op == '-' ? COMPUTE_NEGATE : node->op == '!' ? COMPUTE_NOT : -1,
                             node->as.operand.a);
    case NODE_BINARY: return compile_binary(d, binary_op(node->op), node->as.operand.a, node->as.operand.b);
    case NODE_CONSTANT: return compile_constant(d, node);
    case NODE_BUILTIN:
        if (node->as.list.count == 1) return compile_unary(d, one_argument_op(node->op), node->as.list.items[0]);
        return node->as.list.count == 2 && compile_binary(d, two_argument_op(node->op), node->as.list.items[0],
                                                          node->as.list.items[1]);
    default: return false;
    }
}

void compute_prepare(Eval *ev, const Node *node) {
    Node *n = (Node *)(uintptr_t)node; /* the code is kept in the tree */
    if (!n->as.operand.compute) {
        n->as.operand.compute = &MET_ONCE; /* text that runs only once is not worth compiling */
        return;
    }
    Draft d = {.ev = ev};
    n->as.operand.compute = &NOT_COMPUTED;
    if (!compile(&d, node)) return;
    Compute *c = arena_push(ev->parse, sizeof *c + d.count * sizeof(ComputeStep));
    c->count = d.count;
    c->pair = d.count == 2 && d.steps[0].from == FROM_NAME && d.steps[1].from == FROM_NUMBER &&
              (d.steps[1].op == COMPUTE_ADD || d.steps[1].op == COMPUTE_SUBTRACT || d.steps[1].op == COMPUTE_MULTIPLY ||
               d.steps[1].op == COMPUTE_LESS || d.steps[1].op == COMPUTE_GREATER);
    for (uint32_t i = 0; i < d.count; i++) c->steps[i] = d.steps[i];
    n->as.operand.compute = c;
}

/* What calls functions is apart from the loop below, whose values then stay in registers. */
static VTS_NOINLINE double compute_rare(ComputeOp op, double a, double b, bool *gives_up) {
    switch (op) {
    case COMPUTE_ABS: return fabs(a);
    case COMPUTE_CEIL: return ceil(a);
    case COMPUTE_COS: return cos(a);
    case COMPUTE_FLOOR: return floor(a);
    case COMPUTE_INT: return value_to_int(a);
    case COMPUTE_RADIANS: return a * VTS_RADIANS;
    case COMPUTE_SIN: return sin(a);
    case COMPUTE_SQRT: *gives_up = !(a >= 0); return sqrt(a);
    case COMPUTE_DIV: *gives_up = b == 0; return value_to_int(a / b);
    default: *gives_up = b == 0; return fmod(a, b);
    }
}

bool compute_run(const Eval *ev, const Compute *compute, double *out) {
    double stack[DEEPEST_COMPUTE + 1], *below = stack, a = 0; /* a: the top */
    VarBinding *const *bindings = ev->bindings;
    bool gives_up = false;
    for (const ComputeStep *s = compute->steps, *end = s + compute->count; s < end; s++) {
        double b = s->number;
        if (s->from == FROM_NAME) {
            const VarBinding *binding = bindings[s->name_id];
            if (!binding || binding->slot->value.kind != VALUE_FLOAT) return false;
            b = binding->slot->value.as.number;
        } else if (s->from == FROM_STACK) {
            b = a;
            a = *--below;
        }
        switch ((ComputeOp)s->op) {
        case COMPUTE_PUSH:
            *below++ = a;
            a = b;
            break;
        case COMPUTE_NEGATE: a = -a; break;
        case COMPUTE_NOT: a = !value_is_true(a); break;
        case COMPUTE_SQR: a *= a; break;
        case COMPUTE_ADD: a += b; break;
        case COMPUTE_SUBTRACT: a -= b; break;
        case COMPUTE_MULTIPLY: a *= b; break;
        case COMPUTE_DIVIDE:
            if (b == 0) return false;
            a /= b;
            break;
        case COMPUTE_LESS: a = a < b; break;
        case COMPUTE_GREATER: a = a > b; break;
        case COMPUTE_EQUAL: a = value_are_equal(a, b); break;
        case COMPUTE_NOT_EQUAL: a = !value_are_equal(a, b); break;
        case COMPUTE_LESS_EQUAL: a = a <= b || value_are_equal(a, b); break;
        case COMPUTE_GREATER_EQUAL: a = a >= b || value_are_equal(a, b); break;
        case COMPUTE_AND: a = value_is_true(a) && value_is_true(b); break;
        case COMPUTE_OR: a = value_is_true(a) || value_is_true(b); break;
        case COMPUTE_MIN: a = b < a ? b : a; break;
        case COMPUTE_MAX: a = b > a ? b : a; break;
        default:
            a = compute_rare((ComputeOp)s->op, a, b, &gives_up);
            if (gives_up) return false;
            break;
        }
    }
    *out = a;
    return true;
}

bool compute_run_pair(const Eval *ev, const Compute *compute, double *out) {
    const VarBinding *binding = ev->bindings[compute->steps[0].name_id];
    if (!binding || binding->slot->value.kind != VALUE_FLOAT) return false;
    double a = binding->slot->value.as.number, b = compute->steps[1].number;
    switch ((ComputeOp)compute->steps[1].op) {
    case COMPUTE_ADD: *out = a + b; break;
    case COMPUTE_SUBTRACT: *out = a - b; break;
    case COMPUTE_MULTIPLY: *out = a * b; break;
    case COMPUTE_LESS: *out = a < b; break;
    default: *out = a > b; break;
    }
    return true;
}
