/* Lists of numbers and vectors as programs write them, by the hundred thousand: taken from the tokens as they stand, without a tree of
 * their own. Whatever is more than that is left to the parser. */
#include "eval/eval_state.h"

typedef struct Literal {
    double numbers[5];
    int count;
    uint32_t next; /* token behind it */
} Literal;

/* ["-" | "+"] number; returns the token behind it, or 0. */
static uint32_t signed_number(const Token *tokens, uint32_t at, double *out) {
    uint8_t sign = tokens[at].kind;
    at += sign == '-' || sign == '+';
    if (tokens[at].kind != TOKEN_NUMBER) return 0;
    *out = sign == '-' ? -tokens[at].as.number : tokens[at].as.number;
    return at + 1;
}

/* "<" signed_number { "," signed_number } ">" */
static bool vector(const Token *tokens, uint32_t at, Literal *out) {
    do {
        if (out->count == (int)VTS_ARRAY_COUNT(out->numbers)) return false;
        at = signed_number(tokens, at + 1, &out->numbers[out->count++]);
    } while (at && tokens[at].kind == ',');
    out->next = at + 1;
    return at && out->count > 1 && tokens[at].kind == '>';
}

/* A number or vector with a comma or the end of the body behind it. The list's last token, TOKEN_END, ends every search. */
static bool literal(const Token *tokens, uint32_t at, uint32_t end, Literal *out) {
    out->count = 0;
    if (tokens[at].kind == '<') {
        if (!vector(tokens, at, out)) return false;
    } else {
        out->count = 1;
        out->next = signed_number(tokens, at, &out->numbers[0]);
        if (!out->next) return false;
    }
    return out->next == end || (out->next < end && tokens[out->next].kind == ',');
}

uint32_t run_literals(Eval *ev, const Body *body, uint32_t at, Sink *sink) {
    const Token *tokens = body->tokens->items;
    Literal l;
    while (at < body->end && literal_begins(&tokens[at]) && literal(tokens, at, body->end, &l)) {
        Value v = {.kind = VALUE_VECTOR, .size = (uint8_t)l.count, .as.components = l.numbers};
        if (l.count == 1) v = value_float(l.numbers[0]);
        sink_value(ev, sink, v, span_join(tokens[at].span, tokens[l.next - 1].span));
        at = l.next + (l.next < body->end);
        ev->after_declare = false;
        if (ev->diags->error_count && diag_full(ev->diags)) ev->stopped = true;
        if (ev->stopped) break;
    }
    return at;
}
