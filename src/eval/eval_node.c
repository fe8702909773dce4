/* The evaluation of expressions begins here. What loops are made of (numbers, names, arithmetic of floats) is done in this
 * file, away from the functions that need room on the stack. */
#include "eval/eval_state.h"

static Value eval_name(Eval *ev, const Node *node) {
    VarBinding *b = scope_find(ev, node->as.name);
    if (!b || !b->slot->set) {
        eval_undeclared(ev, node->as.name, node->span);
        return value_error();
    }
    if (b->slot->value.kind == VALUE_FLOAT) return b->slot->value;
    if (b->slot->value.kind == VALUE_MACRO) {
        diag_error(ev->diags, node->span, "'%s' is a macro: it is called with ( )", node->as.name->text);
        return value_error();
    }
    return slot_get(ev, b->slot);
}

static Value binary(Eval *ev, const Node *node) {
    Value a = eval_node(ev, node->as.operand.a), b = eval_node(ev, node->as.operand.b);
    if (a.kind == VALUE_FLOAT && b.kind == VALUE_FLOAT) switch (node->op) {
        case '+': a.as.number += b.as.number; return a;
        case '-': a.as.number -= b.as.number; return a;
        case '*': a.as.number *= b.as.number; return a;
        case '<': a.as.number = a.as.number < b.as.number; return a;
        case '>': a.as.number = a.as.number > b.as.number; return a;
        default: break;
        }
    return value_binary(ev, node->op, a, b, node->span);
}

Value eval_node(Eval *ev, const Node *node) {
    switch (node->kind) {
    case NODE_NUMBER: return value_float(node->as.number);
    case NODE_NAME: return eval_name(ev, node);
    case NODE_VALUE: return *node->as.value;
    case NODE_BINARY: return binary(ev, node);
    case NODE_UNARY: return value_unary(ev, node->op, eval_node(ev, node->as.operand.a), node->span);
    default: return eval_compound(ev, node);
    }
}

bool eval_float(Eval *ev, const Node *node, double *out) {
    if (node->kind == NODE_NUMBER) {
        *out = node->as.number;
        return true;
    }
    Value v = eval_node(ev, node);
    if (v.kind == VALUE_FLOAT) {
        *out = v.as.number;
        return true;
    }
    return value_to_float(ev, &v, node->span, out);
}
