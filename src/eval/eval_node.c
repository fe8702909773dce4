/* The evaluation of expressions begins here. What loops are made of (numbers, names, arithmetic of floats) is done in this
 * file, away from the functions that need room on the stack. */
#include "eval/eval_state.h"

static bool name_operand(Eval *ev, const Node *node, double *number, Value *other) {
    const VarBinding *b = scope_find(ev, node->as.name);
    if (!b || !b->slot->set) {
        eval_undeclared(ev, node->as.name, node->span);
        *other = value_error();
        return false;
    }
    if (b->slot->value.kind == VALUE_FLOAT) {
        *number = b->slot->value.as.number;
        return true;
    }
    if (b->slot->value.kind == VALUE_MACRO) {
        diag_error(ev->diags, node->span, "'%s' is a macro: it is called with ( )", node->as.name->text);
        *other = value_error();
    } else {
        *other = slot_get(ev, b->slot);
    }
    return false;
}

/* Where an operand is no float: apart, so that the fast road has no Values on its stack. */
static VTS_NOINLINE bool mixed_left(Eval *ev, const Node *node, double *number, Value *other) {
    Value b = eval_node(ev, node->as.operand.b);
    *other = value_binary(ev, node->op, *other, b, node);
    *number = other->as.number;
    return other->kind == VALUE_FLOAT;
}

static VTS_NOINLINE bool mixed_right(Eval *ev, const Node *node, double *number, Value *other) {
    *other = value_binary(ev, node->op, value_float(*number), *other, node);
    *number = other->as.number;
    return other->kind == VALUE_FLOAT;
}

static bool binary(Eval *ev, const Node *node, double *number, Value *other) {
    double b;
    if (!eval_operand(ev, node->as.operand.a, number, other)) return mixed_left(ev, node, number, other);
    if (!eval_operand(ev, node->as.operand.b, &b, other)) return mixed_right(ev, node, number, other);
    switch (node->op) {
    case '+': *number += b; return true;
    case '-': *number -= b; return true;
    case '*': *number *= b; return true;
    case '<': *number = *number < b; return true;
    case '>': *number = *number > b; return true;
    default: *number = value_float_binary(ev, node->op, *number, b, node->span); return true;
    }
}

static VTS_NOINLINE bool any_operand(Eval *ev, const Node *node, double *number, Value *other) {
    switch (node->kind) {
    case NODE_VALUE: *other = *node->as.value; break;
    case NODE_UNARY:
        *other = value_unary(ev, node->op, eval_node(ev, node->as.operand.a), node->span);
        break;
    case NODE_CALL: *other = eval_call(ev, node); break;
    default: *other = eval_compound(ev, node); break;
    }
    *number = other->as.number;
    return other->kind == VALUE_FLOAT;
}

bool eval_operand(Eval *ev, const Node *node, double *number, Value *other) {
    switch (node->kind) {
    case NODE_NUMBER: *number = node->as.number; return true;
    case NODE_NAME: return name_operand(ev, node, number, other);
    case NODE_BINARY: return compute_try(ev, node, number) || binary(ev, node, number, other);
    case NODE_UNARY:
        if (node->op == '(') return eval_operand(ev, node->as.operand.a, number, other);
        return any_operand(ev, node, number, other);
    default: return any_operand(ev, node, number, other);
    }
}

Value eval_node(Eval *ev, const Node *node) {
    double number;
    Value other;
    return eval_operand(ev, node, &number, &other) ? value_float(number) : other;
}

bool eval_float(Eval *ev, const Node *node, double *out) {
    Value other;
    return eval_operand(ev, node, out, &other) || value_to_float(ev, &other, node->span, out);
}

bool eval_condition(Eval *ev, const Node *node, bool *out) {
    Value other;
    double number;
    *out = false;
    if (!eval_operand(ev, node, &number, &other) && !value_to_float(ev, &other, node->span, &number)) return false;
    *out = value_is_true(number);
    return true;
}
