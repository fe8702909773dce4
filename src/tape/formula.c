#include "tape/formula.h"

#include "base/decimal.h"

#include <ctype.h>
#include <string.h>

enum { MOST_NAMES = 64, MOST_NESTED = 64 };

typedef struct Name {
    const char *text;
    size_t length;
    TapeRef value;
} Name;

typedef struct Reader {
    TapeBuilder *builder;
    Span span;
    const char *at;
    Name names[MOST_NAMES];
    size_t count;
    int nested;
    bool failed;
} Reader;

static TapeRef fail(Reader *r) { return r->failed = true, tape_constant(r->builder, 0); }

static TapeRef one(Reader *r, TapeOp op, TapeRef a) { return tape_unary(r->builder, op, a, r->span); }
static TapeRef two(Reader *r, TapeOp op, TapeRef a, TapeRef b) { return tape_binary(r->builder, op, a, b, r->span); }

static void skip_spaces(Reader *r) { r->at += strspn(r->at, " \n"); }

static bool take(Reader *r, char c) {
    skip_spaces(r);
    if (*r->at != c) return false;
    r->at++;
    return true;
}

static size_t name_length(const char *text) {
    size_t n = 0;
    while (isalnum((unsigned char)text[n]) || text[n] == '_') n++;
    return isalpha((unsigned char)text[0]) ? n : 0;
}

static void define(Reader *r, const char *text, size_t length, TapeRef value) {
    if (r->count == MOST_NAMES)
        r->failed = true;
    else
        r->names[r->count++] = (Name){text, length, value};
}

static bool same(const char *text, size_t length, const char *other) { return strlen(other) == length && memcmp(text, other, length) == 0; }

/* The last definition counts. */
static TapeRef value_of(Reader *r, const char *text, size_t length) {
    for (size_t k = r->count; k-- > 0;)
        if (r->names[k].length == length && memcmp(r->names[k].text, text, length) == 0) return r->names[k].value;
    return same(text, length, "pi") ? tape_constant(r->builder, VTS_PI) : fail(r);
}

static TapeRef sum(Reader *r);

static TapeRef operation(Reader *r, const char *text, size_t length) {
    TapeRef in[3];
    int count = 0, op = 0;
    do in[count++] = sum(r);
    while (count < 3 && take(r, ','));
    while (op < TAPE_OP_COUNT && !(tape_op_arity((TapeOp)op) == count && same(text, length, tape_op_text((TapeOp)op)))) op++;
    if (!take(r, ')') || op == TAPE_OP_COUNT) return fail(r);
    if (count == 1) return one(r, (TapeOp)op, in[0]);
    if (count == 2) return two(r, (TapeOp)op, in[0], in[1]);
    return tape_ternary(r->builder, (TapeOp)op, in[0], in[1], in[2], r->span);
}

static TapeRef operand(Reader *r) {
    skip_spaces(r);
    const char *text = r->at;
    size_t length = name_length(text);
    if (length) {
        r->at += length;
        return take(r, '(') ? operation(r, text, length) : value_of(r, text, length);
    }
    if (take(r, '(')) {
        TapeRef inner = sum(r);
        return take(r, ')') ? inner : fail(r);
    }
    Decimal digits;
    double number;
    r->at = decimal_read(text, &digits);
    if (!is_digit(*text) || !decimal_value(&digits, &number)) return fail(r);
    return tape_constant(r->builder, number);
}

static TapeRef power(Reader *r) {
    TapeRef a = operand(r);
    if (!take(r, '^')) return a;
    TapeRef square = one(r, TAPE_SQR, a);
    if (take(r, '2')) return square;
    if (take(r, '3')) return two(r, TAPE_MUL, square, a);
    return take(r, '4') ? one(r, TAPE_SQR, square) : fail(r);
}

static TapeRef signed_power(Reader *r) { return take(r, '-') ? one(r, TAPE_NEG, power(r)) : power(r); }

static TapeRef product(Reader *r) {
    TapeRef value = signed_power(r);
    for (;;) {
        if (take(r, '*'))
            value = two(r, TAPE_MUL, value, signed_power(r));
        else if (take(r, '/'))
            value = two(r, TAPE_DIV, value, signed_power(r));
        else
            return value;
    }
}

static TapeRef sum(Reader *r) {
    if (r->failed || r->nested == MOST_NESTED) return fail(r);
    r->nested++;
    TapeRef value = product(r);
    for (;;) {
        if (take(r, '+'))
            value = two(r, TAPE_ADD, value, product(r));
        else if (take(r, '-'))
            value = two(r, TAPE_SUB, value, product(r));
        else
            return r->nested--, value;
    }
}

static bool at_definition(Reader *r) {
    skip_spaces(r);
    const char *end = r->at + name_length(r->at);
    return end > r->at && *(end + strspn(end, " \n")) == '=';
}

bool formula_append(TapeBuilder *builder, const char *text, const TapeRef *in, int count, Span span, TapeRef *out) {
    static const char *const inputs[] = {"x", "y", "z", "p3", "p4", "p5", "p6", "p7", "p8", "p9", "p10", "p11", "p12"};
    Reader r = {.builder = builder, .span = span, .at = text, .failed = count > (int)VTS_ARRAY_COUNT(inputs)};
    for (int k = 0; k < count && !r.failed; k++) define(&r, inputs[k], strlen(inputs[k]), in[k]);
    while (!r.failed && at_definition(&r)) {
        const char *name = r.at;
        size_t length = name_length(name);
        r.at += length;
        take(&r, '=');
        TapeRef value = sum(&r);
        define(&r, name, length, value);
        if (!take(&r, ';')) fail(&r);
    }
    *out = sum(&r);
    skip_spaces(&r);
    return !r.failed && *r.at == '\0';
}
