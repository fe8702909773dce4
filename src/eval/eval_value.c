#include "eval/eval_state.h"

#include <math.h>
#include <string.h>

const char *value_kind_text(ValueKind kind) {
    static const char *const texts[] = {
        [VALUE_ERROR] = "an erroneous value",
        [VALUE_FLOAT] = "a float",
        [VALUE_VECTOR] = "a vector",
        [VALUE_COLOR] = "a colour",
        [VALUE_STRING] = "a string",
        [VALUE_ARRAY] = "an array",
        [VALUE_DICTIONARY] = "a dictionary",
        [VALUE_FUNCTION] = "a function",
        [VALUE_SPLINE] = "a spline",
        [VALUE_TRANSFORM] = "a transform",
        [VALUE_FILE] = "a file handle",
        [VALUE_MACRO] = "a macro",
        [VALUE_OBJECT] = "an object",
        [VALUE_LIGHT] = "a light source",
        [VALUE_CAMERA] = "a camera",
        [VALUE_TEXTURE] = "a texture",
        [VALUE_PIGMENT] = "a pigment",
        [VALUE_NORMAL] = "a normal",
        [VALUE_FINISH] = "a finish",
        [VALUE_INTERIOR] = "an interior",
        [VALUE_MATERIAL] = "a material",
        [VALUE_COLOR_MAP] = "a colour map",
        [VALUE_FOG] = "a fog",
        [VALUE_RAINBOW] = "a rainbow",
        [VALUE_SKY_SPHERE] = "a sky sphere",
        [VALUE_TEXEL] = "a texel",
        [VALUE_SURFACE] = "a surface",
        [VALUE_SKIN] = "a skin",
        [VALUE_WIND_FIELD] = "a wind field",
        [VALUE_BLOCK] = "a block",
    };
    return (size_t)kind < VTS_ARRAY_COUNT(texts) && texts[kind] ? texts[kind] : "a value";
}

Value value_vector(Eval *ev, const double *components, int size) {
    double *own = arena_copy(&ev->temp, components, (size_t)size * sizeof *components);
    return (Value){.kind = VALUE_VECTOR, .size = (uint8_t)size, .as.components = own};
}

Value value_string(Eval *ev, const char *text, size_t length) {
    char *own = arena_push(&ev->temp, length + 1);
    memcpy(own, text, length);
    return (Value){.kind = VALUE_STRING, .as.string = {own, length}};
}

bool value_is_numeric(const Value *v) {
    return v->kind == VALUE_FLOAT || v->kind == VALUE_VECTOR || v->kind == VALUE_COLOR;
}

double value_component(const Value *v, int i) {
    if (v->kind == VALUE_FLOAT) return v->as.number;
    return i < v->size ? v->as.components[i] : 0;
}

Value eval_fail(Eval *ev, Span span, const char *format, ...) {
    va_list args;
    va_start(args, format);
    diag_error_va(ev->diags, span, format, args);
    va_end(args);
    return value_error();
}

static Value mismatch(Eval *ev, Span span, const char *wanted, const Value *found) {
    if (found->kind != VALUE_ERROR)
        diag_error(ev->diags, span, "expected %s, found %s", wanted, value_kind_text(found->kind));
    return value_error();
}

static double unary(int op, double a) {
    switch (op) {
    case '-': return -a;
    case '!': return value_is_true(a) ? 0 : 1;
    default: return a;
    }
}

/* Also where the sign begins a statement, as a string is a whole value. */
static Value no_sum_of_strings(Eval *ev, Span span) {
    Diagnostic *d = diag_error(ev->diags, span, "strings are compared with = and <, not calculated with");
    diag_hint(ev->diags, d, "concat(A, B) joins strings");
    return value_error();
}

static Value vector_unary(Eval *ev, int op, Value a, Span span) {
    if (a.kind == VALUE_STRING && op == '+') return no_sum_of_strings(ev, span);
    if (!value_is_numeric(&a)) return mismatch(ev, span, "a float or a vector", &a);
    double out[UINT8_MAX];
    for (int i = 0; i < a.size; i++) out[i] = unary(op, a.as.components[i]);
    Value v = value_vector(ev, out, a.size);
    v.kind = a.kind;
    return v;
}

Value value_unary(Eval *ev, int op, Value a, Span span) {
    if (a.kind == VALUE_FLOAT) return value_float(unary(op, a.as.number));
    return op == '(' || a.kind == VALUE_ERROR ? a : vector_unary(ev, op, a, span);
}

double value_float_binary(Eval *ev, int op, double a, double b, Span span) {
    switch (op) {
    case '+': return a + b;
    case '-': return a - b;
    case '*': return a * b;
    case '/':
        if (b != 0) return a / b;
        diag_warning(ev->diags, span, "division by zero");
        return HUGE_VAL;
    case '=': return value_are_equal(a, b);
    case TOKEN_NOT_EQUAL: return !value_are_equal(a, b);
    case '<': return a < b;
    case '>': return a > b;
    case TOKEN_LESS_EQUAL: return a <= b || value_are_equal(a, b);
    case TOKEN_GREATER_EQUAL: return a >= b || value_are_equal(a, b);
    case '&': return value_is_true(a) && value_is_true(b);
    case '|': return value_is_true(a) || value_is_true(b);
    default: return 0;
    }
}

static Value compare_strings(Eval *ev, int op, const Value *a, const Value *b, Span span) {
    int order = strcmp(a->as.string.text, b->as.string.text);
    if (op == '+' || op == '-' || op == '*' || op == '/' || op == '&' || op == '|')
        return no_sum_of_strings(ev, span);
    return value_float(value_float_binary(ev, op, order, 0, span));
}

static Value vector_binary(Eval *ev, int op, Value a, Value b, const Node *node) {
    Span span = node->span;
    if (a.kind == VALUE_ERROR || b.kind == VALUE_ERROR) return value_error();
    if (a.kind == VALUE_STRING && b.kind == VALUE_STRING) return compare_strings(ev, op, &a, &b, span);
    if (!value_is_numeric(&a)) return mismatch(ev, node->as.operand.a->span, "a float or a vector", &a);
    if (!value_is_numeric(&b)) return mismatch(ev, node->as.operand.b->span, "a float or a vector", &b);
    int size = a.kind == VALUE_FLOAT ? b.size : b.kind == VALUE_FLOAT ? a.size : int_max(a.size, b.size);
    double out[UINT8_MAX];
    for (int i = 0; i < size; i++)
        out[i] = value_float_binary(ev, op, value_component(&a, i), value_component(&b, i), span);
    Value v = value_vector(ev, out, size);
    if (a.kind == VALUE_COLOR || b.kind == VALUE_COLOR) v.kind = VALUE_COLOR;
    return v;
}

Value value_binary(Eval *ev, int op, Value a, Value b, const Node *node) {
    if (a.kind == VALUE_FLOAT && b.kind == VALUE_FLOAT)
        return value_float(value_float_binary(ev, op, a.as.number, b.as.number, node->span));
    return vector_binary(ev, op, a, b, node);
}

bool value_to_float(Eval *ev, const Value *v, Span span, double *out) {
    if (v->kind == VALUE_FLOAT) {
        *out = v->as.number;
        return true;
    }
    *out = 0;
    mismatch(ev, span, "a float", v);
    return false;
}

bool value_to_vector(Eval *ev, const Value *v, Span span, double *out, int size) {
    bool ok = value_is_numeric(v) && (size > 3 || (v->kind != VALUE_COLOR && v->size <= 3));
    if (!ok) mismatch(ev, span, value_is_numeric(v) ? "a vector of 2 or 3 numbers" : "a vector", v);
    for (int i = 0; i < size; i++) out[i] = ok ? value_component(v, i) : 0;
    return ok;
}

bool value_to_string(Eval *ev, const Value *v, Span span, const char **text, size_t *length) {
    if (v->kind == VALUE_STRING) {
        *text = v->as.string.text;
        if (length) *length = v->as.string.length;
        return true;
    }
    *text = "";
    if (length) *length = 0;
    mismatch(ev, span, "a string", v);
    return false;
}

static void *slot_buffer(Eval *ev, Slot *slot, size_t size) {
    if (slot->capacity < size) {
        slot->capacity = (uint32_t)size_max(size, 2 * (size_t)slot->capacity);
        slot->buffer = arena_push(ev->parse, slot->capacity);
    }
    return slot->buffer;
}

void slot_set(Eval *ev, Slot *slot, const Value *value) {
    NameClass before = slot_class(slot);
    Value v = *value;
    if (v.kind == VALUE_VECTOR || v.kind == VALUE_COLOR) {
        size_t bytes = v.size * sizeof(double);
        double *own =
            memcpy(slot_buffer(ev, slot, size_max(bytes, 5 * sizeof(double))), v.as.components, bytes);
        /* POV-Ray keeps colours in single precision. */
        for (int i = 0; v.kind == VALUE_COLOR && i < v.size; i++) own[i] = (double)(float)own[i];
        v.as.components = own;
    } else if (v.kind == VALUE_STRING) {
        char *text = slot_buffer(ev, slot, v.as.string.length + 1);
        memcpy(text, v.as.string.text, v.as.string.length);
        text[v.as.string.length] = '\0';
        v.as.string.text = text;
    } else if (v.kind == VALUE_ARRAY || v.kind == VALUE_DICTIONARY) {
        v.as.array = array_copy(ev, v.as.array);
        if (!v.as.array) v = value_error();
    }
    slot->value = v;
    slot->set = true;
    if (before == NAME_MACRO || slot_class(slot) != before) ev->name_stamp++;
}

void slot_clear(Eval *ev, Slot *slot) {
    ev->name_stamp += slot_class(slot) != NAME_UNKNOWN;
    slot->set = false;
    slot->value = value_error();
}

Value slot_get(Eval *ev, const Slot *slot) {
    Value v = slot->value;
    if (v.kind == VALUE_VECTOR || v.kind == VALUE_COLOR)
        v.as.components = arena_copy(&ev->temp, v.as.components, v.size * sizeof(double));
    else if (v.kind == VALUE_STRING)
        v.as.string.text = arena_copy(&ev->temp, v.as.string.text, v.as.string.length + 1);
    return v;
}
