#include "eval/eval_state.h"

#include <math.h>

bool eval_is_keyword(const BuildContext *context, Name word) {
    const Eval *ev = context->eval;
    return ev && keyword_of(&ev->keywords, word) != KW_NONE;
}

void eval_undeclared(Eval *ev, Name name, Span span) {
    if (ev->build.names_missing) {
        ev->diags->failures++;
        return;
    }
    Diagnostic *d = diag_error(ev->diags, span, "'%s' is not declared", name->text);
    eval_hint_name(&ev->build, d, name->text, NULL, 0);
}

static Value eval_vector(Eval *ev, const Node *node) {
    double few[5];
    int size = (int)node->as.list.count;
    double *out = size <= 5 ? few : arena_new_array(&ev->temp, double, (size_t)size);
    bool ok = true;
    for (int i = 0; i < size; i++) ok = eval_float(ev, node->as.list.items[i], &out[i]) && ok;
    return ok ? value_vector(ev, out, size) : value_error();
}

/* Element `index` of an array, entry `index` of a dictionary. NULL after a report. */
static Slot *element_slot(Eval *ev, const Value *base, Span base_span, const Node *index, Span span) {
    if (base->kind == VALUE_DICTIONARY) {
        Name key = dictionary_key(ev, index);
        return key ? dictionary_entry(ev, base->as.array, key) : NULL;
    }
    double number;
    if (!eval_float(ev, index, &number) || base->kind == VALUE_ERROR) return NULL;
    if (base->kind == VALUE_ARRAY) return array_slot(ev, base->as.array, number, span);
    eval_fail(ev, base_span, "expected an array before '[', found %s", value_kind_text(base->kind));
    return NULL;
}

static Value element_value(Eval *ev, const Slot *slot, ValueKind of, Span span) {
    if (slot && slot->set) return slot_get(ev, slot);
    if (!slot) return value_error();
    return eval_fail(ev, span,
                     of == VALUE_ARRAY ? "this element of the array was never set"
                                       : "the dictionary has no entry of this name");
}

static Value eval_index(Eval *ev, const Node *node, bool whole) {
    const Node *base = node->as.apply.base;
    VarBinding *b = base->kind == NODE_NAME ? scope_find(ev, base->as.name) : NULL;
    Value v;
    if (b && b->slot->set && b->slot->value.kind == VALUE_ARRAY)
        v = b->slot->value;
    else
        v = base->kind == NODE_INDEX ? eval_index(ev, base, false) : eval_node(ev, base);
    Slot *slot = element_slot(ev, &v, base->span, node->as.apply.list.items[0], node->span);
    if (whole && slot && array_is_partial(ev, v.as.array, &slot->value, node->span)) return value_error();
    return element_value(ev, slot, v.kind, node->span);
}

static Value eval_dot(Eval *ev, const Node *node) {
    Value v = eval_node(ev, node->as.operand.a);
    if (v.kind == VALUE_ERROR) return v;
    if (v.kind == VALUE_DICTIONARY)
        return element_value(ev, dictionary_entry(ev, v.as.array, node->as.operand.b->as.name), v.kind,
                             node->span);
    if (node->op == DOT_OTHER)
        return eval_fail(ev, node->as.operand.b->span,
                         "expected a component after '.', found '%s': they are x y z t, u v, red green blue "
                         "filter transmit gray",
                         node->as.operand.b->as.name->text);
    if (!value_is_numeric(&v)) {
        diag_error(ev->diags, node->span, "%s has no components", value_kind_text(v.kind));
        return v = value_error();
    }
    if (node->op != DOT_GRAY && node->op != DOT_X && v.kind == VALUE_FLOAT)
        return eval_fail(ev, node->span, "%s has no components", value_kind_text(v.kind));
    if (node->op != DOT_GRAY && v.kind == VALUE_VECTOR && node->op >= v.size)
        return eval_fail(ev, node->span, "a vector of %d components has no such one", v.size);
    if (node->op == DOT_GRAY)
        return value_float(0.297 * value_component(&v, 0) + 0.589 * value_component(&v, 1) +
                           0.114 * value_component(&v, 2));
    return value_float(value_component(&v, node->op));
}

/* Both branches run, as in POV-Ray. */
static Value eval_choice(Eval *ev, const Node *node) {
    bool yes;
    bool ok = eval_condition(ev, node->as.operand.a, &yes);
    Value b = eval_node(ev, node->as.operand.b), c = eval_node(ev, node->as.operand.c);
    return !ok ? value_error() : yes ? b : c;
}

Value eval_compound(Eval *ev, const Node *node) {
    switch (node->kind) {
    case NODE_STRING:
        return (Value){.kind = VALUE_STRING, .as.string = {node->as.string->text, node->as.string->length}};
    case NODE_CONSTANT: return eval_constant(ev, node);
    case NODE_VECTOR: return eval_vector(ev, node);
    case NODE_INDEX: return eval_index(ev, node, true);
    case NODE_DOT: return eval_dot(ev, node);
    case NODE_CONDITION: return eval_choice(ev, node);
    case NODE_CALL: return eval_call(ev, node);
    case NODE_BUILTIN: return eval_builtin(ev, node);
    case NODE_COLOR: return eval_color(ev, node);
    case NODE_ARRAY: return eval_array(ev, node);
    case NODE_DICTIONARY: return eval_dictionary(ev, node);
    case NODE_FUNCTION: return eval_function(ev, node);
    case NODE_BLOCK: return eval_block(ev, node, NULL);
    case NODE_EMPTY: return eval_fail(ev, node->span, "expected a value, found ','");
    default: return value_error();
    }
}

bool eval_string(Eval *ev, const Node *node, const char **text, size_t *length) {
    Value v = eval_node(ev, node);
    return value_to_string(ev, &v, node->span, text, length);
}

Slot *eval_target(Eval *ev, const Node *target, bool *failed) {
    Array *array;
    return eval_element(ev, target, &array, failed);
}

Slot *eval_element(Eval *ev, const Node *target, Array **array, bool *failed) {
    if (target->kind == NODE_NAME) {
        VarBinding *b = scope_find(ev, target->as.name);
        return b ? b->slot : NULL;
    }
    bool dot = target->kind == NODE_DOT;
    if (!dot && target->kind != NODE_INDEX) return NULL;
    const Node *base_node = dot ? target->as.operand.a : target->as.apply.base;
    Slot *base = eval_element(ev, base_node, array, failed), *slot = NULL;
    if (*failed || !base || !base->set) return NULL;
    if (!dot)
        slot = element_slot(ev, &base->value, base_node->span, target->as.apply.list.items[0], target->span);
    else if (base->value.kind == VALUE_DICTIONARY)
        slot = dictionary_entry(ev, base->value.as.array, target->as.operand.b->as.name);
    else
        eval_fail(ev, base_node->span, "expected a dictionary before '.', found %s",
                  value_kind_text(base->value.kind));
    *array = base->value.as.array;
    *failed = slot == NULL;
    return slot;
}

static int component_index(int keyword) {
    switch (keyword) {
    case KW_red: return 0;
    case KW_green: return 1;
    case KW_blue: return 2;
    case KW_filter:
    case KW_alpha: return 3;
    default: return 4;
    }
}

/* `rgb C` of a whole colour, `rgb <r, g, b, f>`: more than the keyword names. */
static void check_color_size(Eval *ev, const ColorPart *part, const Value *v) {
    int keyword = part->component;
    int size = keyword == KW_rgb || keyword == KW_srgb                                                  ? 3
               : keyword == KW_rgbf || keyword == KW_srgbf || keyword == KW_rgbt || keyword == KW_srgbt ? 4
                                                                                                        : 5;
    if (value_is_numeric(v) && v->kind != VALUE_FLOAT && v->size > size)
        diag_warning(ev->diags, part->value->span, "'%s' is of %d components, these are %d",
                     keyword_text((Keyword)keyword), size, v->size);
}

/* `gamma`: what the scene's numbers mean. */
static void color_from(int keyword, const Value *v, double gamma, double out[5]) {
    for (int i = 0; i < 5; i++) out[i] = value_component(v, i);
    if (keyword == KW_rgb || keyword == KW_srgb) {
        if (v->kind == VALUE_FLOAT)
            out[3] = out[4] = 0;
        else if (v->size <= 3)
            out[3] = out[4] = 0;
    } else if (keyword == KW_rgbf || keyword == KW_srgbf) {
        if (v->size <= 4) out[4] = 0;
    } else if (keyword == KW_rgbt || keyword == KW_srgbt) {
        out[4] = out[3];
        out[3] = 0;
    }
    if (keyword == KW_srgb || keyword == KW_srgbf || keyword == KW_srgbt || keyword == KW_srgbft)
        for (int i = 0; i < 3; i++) out[i] = gamma_from_light(gamma_to_light(out[i], GAMMA_SRGB), gamma);
}

Value eval_color(Eval *ev, const Node *node) {
    double c[5] = {0};
    bool ok = true;
    for (size_t i = 0; i < node->as.color.count; i++) {
        const ColorPart *part = &node->as.color.parts[i];
        Value v = eval_node(ev, part->value);
        if (keyword_class((Keyword)part->component) == KEYWORD_COLOR) {
            if (!value_is_numeric(&v))
                ok = value_to_vector(ev, &v, part->value->span, c, 5);
            else
                color_from(part->component, &v, build_assumed_gamma(&ev->build), c);
            check_color_size(ev, part, &v);
        } else {
            ok = value_to_float(ev, &v, part->value->span, &c[component_index(part->component)]) && ok;
        }
    }
    Value v = value_vector(ev, c, 5);
    v.kind = VALUE_COLOR;
    return ok ? v : value_error();
}
