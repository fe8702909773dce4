/* Expressions of productions, as tapes. Operators bind as in C, ^ (a power) most tightly and to the right. */
#include "grow/lsystem_parts.h"

#include "base/decimal.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST_EXPRESSION = 100 };

typedef struct Expression {
    LSystemReader *reader;
    LSystemScope *scope;
    TapeBuilder *tape;
    TapeRef counts;  /* whether what is being read counts: the right side of & does where the left one is true, that of | where not */
    TapeRef faulty;  /* whether what counted has divided by zero */
    int depth;
} Expression;

static bool read_level(Expression *e, int level, TapeRef *out);

bool lsystem_fail(LSystemReader *reader, const char *what) {
    const LSystemText *source = reader->source;
    int shown = int_min((int)strlen(reader->at), 20);
    while (shown > 0 && ((unsigned char)reader->at[shown] & 0xc0) == 0x80) shown--; /* no character is cut */
    if (reader->at < reader->end)
        diag_error(reader->diags, source->span, "%s before '%.*s' in \"%s\"", what, shown, reader->at, source->text);
    else
        diag_error(reader->diags, source->span, "%s at the end of \"%s\"", what, source->text);
    return false;
}

void lsystem_skip_space(LSystemReader *reader) {
    while (reader->at < reader->end && isspace((unsigned char)*reader->at)) reader->at++;
}

bool lsystem_take(LSystemReader *reader, char c) {
    lsystem_skip_space(reader);
    if (reader->at == reader->end || *reader->at != c) return false;
    reader->at++;
    return true;
}

const char *lsystem_name(LSystemReader *reader) {
    lsystem_skip_space(reader);
    const char *from = reader->at;
    if (from == reader->end || !(isalpha((unsigned char)*from) || *from == '_')) return NULL;
    while (reader->at < reader->end && (isalnum((unsigned char)*reader->at) || *reader->at == '_')) reader->at++;
    return arena_printf(reader->arena, "%.*s", (int)(reader->at - from), from);
}

/* ---- operators ---- */

typedef struct Operator {
    const char *text;
    int level; /* what binds more tightly has a higher one */
    TapeOp op;
} Operator;

/* Longer ones before their beginnings. */
static const Operator operators[] = {
    {"||", 0, TAPE_OR}, {"|", 0, TAPE_OR},  {"&&", 1, TAPE_AND}, {"&", 1, TAPE_AND}, {"==", 2, TAPE_EQ}, {"!=", 2, TAPE_NE}, {"<=", 2, TAPE_LE},
    {">=", 2, TAPE_GE}, {"=", 2, TAPE_EQ},  {"<", 2, TAPE_LT},   {">", 2, TAPE_GT},  {"+", 3, TAPE_ADD}, {"-", 3, TAPE_SUB}, {"*", 4, TAPE_MUL},
    {"/", 4, TAPE_DIV}, {"%", 4, TAPE_MOD},
};
enum { UNARY_LEVEL = 5 };

static const Operator *next_operator(const LSystemReader *reader, int level) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(operators); i++) {
        size_t length = strlen(operators[i].text);
        if (length > (size_t)(reader->end - reader->at) || memcmp(reader->at, operators[i].text, length) != 0) continue;
        return operators[i].level == level ? &operators[i] : NULL;
    }
    return NULL;
}

/* ---- operands ---- */

static bool read_number(Expression *e, TapeRef *out) {
    char *end;
    double value = decimal_strtod(e->reader->at, &end); /* texts end with a zero, and so does what is a number in them */
    if (end > e->reader->end || !isfinite(value)) return lsystem_fail(e->reader, "a number is too large");
    e->reader->at = end;
    *out = tape_constant(e->tape, value);
    return true;
}

static const struct {
    const char *name;
    int arity;
    TapeOp op;
} functions[] = {
    {"abs", 1, TAPE_ABS},   {"acos", 1, TAPE_ACOS}, {"asin", 1, TAPE_ASIN}, {"atan", 1, TAPE_ATAN}, {"atan2", 2, TAPE_ATAN2},
    {"ceil", 1, TAPE_CEIL}, {"cos", 1, TAPE_COS},   {"exp", 1, TAPE_EXP},   {"floor", 1, TAPE_FLOOR}, {"int", 1, TAPE_INT},
    {"ln", 1, TAPE_LN},     {"log", 1, TAPE_LOG},   {"max", 2, TAPE_MAX},   {"min", 2, TAPE_MIN},   {"mod", 2, TAPE_MOD},
    {"pow", 2, TAPE_POW},   {"sin", 1, TAPE_SIN},   {"sqrt", 1, TAPE_SQRT}, {"tan", 1, TAPE_TAN},
    {"degrees", 1, TAPE_DEGREES}, {"radians", 1, TAPE_RADIANS},
};

static TapeRef is_zero(Expression *e, TapeRef value) {
    return tape_binary(e->tape, TAPE_EQ, value, tape_constant(e->tape, 0), e->reader->source->span);
}

/* A divisor of zero is a fault where it counts. */
static void check_divisor(Expression *e, TapeRef divisor) {
    Span span = e->reader->source->span;
    TapeRef fault = tape_binary(e->tape, TAPE_AND, e->counts, is_zero(e, divisor), span);
    e->faulty = tape_binary(e->tape, TAPE_OR, e->faulty, fault, span);
}

static bool read_arguments(Expression *e, TapeRef *out, int count) {
    for (int i = 0; i < count; i++) {
        if (i > 0 && !lsystem_take(e->reader, ',')) return lsystem_fail(e->reader, "a comma is missing");
        if (!read_level(e, 0, &out[i])) return false;
    }
    return lsystem_take(e->reader, ')') || lsystem_fail(e->reader, "a ')' is missing");
}

/* rand(a, b): uniform between a and b, another number each time that the production is used. */
static bool read_random(Expression *e, TapeRef *out) {
    TapeRef ends[2];
    Span span = e->reader->source->span;
    if (!read_arguments(e, ends, 2)) return false;
    if (e->scope->random_count == LSYSTEM_MOST_RANDOM) return lsystem_fail(e->reader, "there are more than 16 'rand'");
    TapeRef random = tape_input(e->tape, e->scope->formal_count + e->scope->random_count++);
    TapeRef range = tape_binary(e->tape, TAPE_SUB, ends[1], ends[0], span);
    *out = tape_binary(e->tape, TAPE_ADD, ends[0], tape_binary(e->tape, TAPE_MUL, range, random, span), span);
    return true;
}

static bool read_function(Expression *e, const char *name, TapeRef *out) {
    TapeRef arguments[2];
    if (strcmp(name, "rand") == 0) return read_random(e, out);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(functions); i++) {
        if (strcmp(functions[i].name, name) != 0) continue;
        if (!read_arguments(e, arguments, functions[i].arity)) return false;
        Span span = e->reader->source->span;
        if (functions[i].op == TAPE_MOD) check_divisor(e, arguments[1]);
        *out = functions[i].arity == 1 ? tape_unary(e->tape, functions[i].op, arguments[0], span)
                                       : tape_binary(e->tape, functions[i].op, arguments[0], arguments[1], span);
        return true;
    }
    diag_error(e->reader->diags, e->reader->source->span, "productions have no function '%s'", name);
    return false;
}

static bool read_named(Expression *e, TapeRef *out) {
    const char *name = lsystem_name(e->reader);
    if (lsystem_take(e->reader, '(')) return read_function(e, name, out);
    /* The innermost name counts: of two formals alike the last. */
    for (int i = e->scope->formal_count - 1; i >= 0; i--)
        if (strcmp(e->scope->formals[i], name) == 0) {
            *out = tape_input(e->tape, i);
            return true;
        }
    for (size_t i = 0; i < e->scope->constant_count; i++)
        if (strcmp(e->scope->constants[i].name, name) == 0) {
            *out = tape_constant(e->tape, e->scope->constants[i].value);
            return true;
        }
    Diagnostic *d = diag_error(e->reader->diags, e->reader->source->span, "'%s' is neither a parameter nor a constant of this L-system", name);
    diag_hint(e->reader->diags, d, "define \"%s\" 1", name);
    return false;
}

static bool read_primary(Expression *e, TapeRef *out) {
    LSystemReader *r = e->reader;
    lsystem_skip_space(r);
    if (r->at == r->end) return lsystem_fail(r, "a number is missing");
    if (isdigit((unsigned char)*r->at) || *r->at == '.') {
        if (*r->at == '.' && !isdigit((unsigned char)r->at[1])) return lsystem_fail(r, "a number is missing");
        return read_number(e, out);
    }
    if (lsystem_take(r, '(')) return read_level(e, 0, out) && (lsystem_take(r, ')') || lsystem_fail(r, "a ')' is missing"));
    if (isalpha((unsigned char)*r->at) || *r->at == '_') return read_named(e, out);
    return lsystem_fail(r, "a number is missing");
}

static bool read_unary(Expression *e, TapeRef *out) {
    Span span = e->reader->source->span;
    if (++e->depth > DEEPEST_EXPRESSION) return lsystem_fail(e->reader, "an expression is nested too deeply");
    bool done;
    if (lsystem_take(e->reader, '-')) {
        if ((done = read_unary(e, out))) *out = tape_unary(e->tape, TAPE_NEG, *out, span);
    } else if (lsystem_take(e->reader, '+')) {
        done = read_unary(e, out);
    } else if (lsystem_take(e->reader, '!')) {
        if ((done = read_unary(e, out))) *out = tape_binary(e->tape, TAPE_EQ, *out, tape_constant(e->tape, 0), span);
    } else if ((done = read_primary(e, out)) && lsystem_take(e->reader, '^')) {
        TapeRef power;
        if ((done = read_unary(e, &power))) *out = tape_binary(e->tape, TAPE_POW, *out, power, span);
    }
    e->depth--;
    return done;
}

static bool read_right(Expression *e, const Operator *op, TapeRef left, TapeRef *out) {
    TapeRef counted = e->counts;
    bool decides = op->op == TAPE_AND || op->op == TAPE_OR;
    if (decides) e->counts = tape_binary(e->tape, TAPE_AND, counted, op->op == TAPE_AND ? left : is_zero(e, left), e->reader->source->span);
    bool done = read_level(e, op->level + 1, out);
    e->counts = counted;
    if (done && (op->op == TAPE_DIV || op->op == TAPE_MOD)) check_divisor(e, *out);
    return done;
}

static bool read_level(Expression *e, int level, TapeRef *out) {
    if (level == UNARY_LEVEL) return read_unary(e, out);
    if (!read_level(e, level + 1, out)) return false;
    for (;;) {
        lsystem_skip_space(e->reader);
        const Operator *op = next_operator(e->reader, level);
        if (!op) return true;
        TapeRef right;
        e->reader->at += strlen(op->text);
        if (!read_right(e, op, *out, &right)) return false;
        *out = tape_binary(e->tape, op->op, *out, right, e->reader->source->span);
    }
}

/* Comparisons and min() would hide the infinity that a division by zero makes: 0/0 is added there. */
bool lsystem_expression(LSystemReader *reader, LSystemScope *scope, TapeBuilder *tape, TapeRef *out) {
    Expression e = {reader, scope, tape, tape_constant(tape, 1), tape_constant(tape, 0), 0};
    double known;
    if (!read_level(&e, 0, out)) return false;
    if (tape_is_constant(tape, e.faulty, &known) && known == 0) return true;
    Span span = reader->source->span;
    TapeRef sound = tape_binary(tape, TAPE_EQ, e.faulty, tape_constant(tape, 0), span);
    *out = tape_binary(tape, TAPE_ADD, *out, tape_binary(tape, TAPE_DIV, tape_constant(tape, 0), sound, span), span);
    return true;
}
