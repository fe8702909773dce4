#include "eval/eval_state.h"

#include "base/decimal.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static bool within_limit(Eval *ev, size_t length, Span span) {
    if (length <= ev->options->limits.string_bytes) return true;
    diag_error(ev->diags, span, "a string of %zu bytes is longer than the limit of %llu", length,
               (unsigned long long)ev->options->limits.string_bytes);
    return false;
}

static Value take(Eval *ev, StrBuf *text, Span span) {
    Value v = within_limit(ev, text->size, span) ? value_string(ev, text->data ? text->data : "", text->size)
                                                 : value_error();
    strbuf_free(text);
    return v;
}

static bool string_argument(Eval *ev, const Node *node, size_t i, const char **text, size_t *length) {
    return eval_string(ev, node->as.list.items[i], text, length);
}

static Value concat(Eval *ev, const Node *node) {
    if (!builtin_argument_count(ev, node, 1, SIZE_MAX)) return value_error();
    StrBuf out = {0};
    bool ok = true;
    for (size_t i = 0; i < node->as.list.count; i++) {
        const char *text;
        size_t length;
        ok = string_argument(ev, node, i, &text, &length) && ok;
        strbuf_add(&out, text, length);
    }
    if (ok) return take(ev, &out, node->span);
    strbuf_free(&out);
    return value_error();
}

/* ---- characters: UTF-8, and bytes that are none stand for themselves ---- */

static size_t char_bytes(const char *text, size_t left) {
    unsigned char first = (unsigned char)text[0];
    size_t n = first < 0xC2 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 1;
    if (n > left) return 1;
    for (size_t i = 1; i < n; i++)
        if (((unsigned char)text[i] & 0xC0) != 0x80) return 1;
    return n;
}

static size_t char_count(const char *text, size_t length) {
    size_t count = 0;
    for (size_t at = 0; at < length; count++) at += char_bytes(text + at, length - at);
    return count;
}

/* The byte at which the character with this index (from 0) begins. */
static size_t char_begin(const char *text, size_t length, size_t index) {
    size_t at = 0;
    for (; index > 0 && at < length; index--) at += char_bytes(text + at, length - at);
    return at;
}

static unsigned char_code(const char *text, size_t length) {
    static const uint8_t lead[] = {0, 0x7F, 0x1F, 0x0F, 0x07};
    if (length == 0) return 0;
    size_t n = char_bytes(text, length);
    unsigned code = n == 1 ? (unsigned char)text[0] : (unsigned char)text[0] & lead[n];
    for (size_t i = 1; i < n; i++) code = code << 6 | ((unsigned char)text[i] & 0x3F);
    return code;
}

/* POV-Ray's format: as C's %w.df; a negative width pads with zeros; negative digits ask for C's own six. */
static void add_number(StrBuf *out, double value, double width, double digits) {
    int w = double_to_int(width, -1000, 1000), d = digits < 0 ? 6 : double_to_int(digits, 0, 1000);
    if (w < 0)
        strbuf_addf(out, "%0*.*f", -w, d, value);
    else
        strbuf_addf(out, "%*.*f", w, d, value);
}

static Value str(Eval *ev, const Node *node) {
    double a[3];
    if (!builtin_argument_count(ev, node, 3, 3)) return value_error();
    for (size_t i = 0; i < 3; i++)
        if (!eval_float(ev, node->as.list.items[i], &a[i])) return value_error();
    StrBuf out = {0};
    add_number(&out, a[0], a[1], a[2]);
    return take(ev, &out, node->span);
}

/* vstr(components, vector, separator, width, digits) */
static Value vstr(Eval *ev, const Node *node) {
    double count, width, digits;
    const char *separator;
    if (!builtin_argument_count(ev, node, 5, 5) || !eval_float(ev, node->as.list.items[0], &count))
        return value_error();
    Value v = eval_node(ev, node->as.list.items[1]);
    if (!string_argument(ev, node, 2, &separator, NULL) || !eval_float(ev, node->as.list.items[3], &width) ||
        !eval_float(ev, node->as.list.items[4], &digits))
        return value_error();
    double c[5];
    if (!value_to_vector(ev, &v, node->as.list.items[1]->span, c, 5)) return value_error();
    if (v.kind == VALUE_FLOAT) c[1] = c[2] = c[3] = c[4] = 0;
    int n = int_clamp(double_to_int(count, 0, 10), 2, 5);
    StrBuf out = {0};
    for (int i = 0; i < n; i++) {
        if (i) strbuf_adds(&out, separator);
        add_number(&out, c[i], width, digits);
    }
    return take(ev, &out, node->span);
}

static Value change_case(Eval *ev, const Node *node) {
    const char *text;
    size_t length;
    if (!builtin_argument_count(ev, node, 1, 1) || !string_argument(ev, node, 0, &text, &length))
        return value_error();
    Value v = value_string(ev, text, length);
    char *own = (char *)(uintptr_t)v.as.string.text;
    for (size_t i = 0; i < length; i++)
        own[i] =
            (char)(node->op == KW_strupr ? toupper((unsigned char)own[i]) : tolower((unsigned char)own[i]));
    return v;
}

static Value chr(Eval *ev, const Node *node) {
    double code;
    if (!builtin_argument_count(ev, node, 1, 1) || !eval_float(ev, node->as.list.items[0], &code))
        return value_error();
    if (!(code >= 0 && code < 65536)) {
        diag_error(ev->diags, node->span, "chr(%g): characters are numbered 0 to 65535", code);
        return value_error();
    }
    unsigned c = (unsigned)code;
    char text[4];
    size_t n = 0;
    if (c < 0x80) {
        text[n++] = (char)c;
    } else if (c < 0x800) {
        text[n++] = (char)(0xC0 | c >> 6);
        text[n++] = (char)(0x80 | (c & 0x3F));
    } else {
        text[n++] = (char)(0xE0 | c >> 12);
        text[n++] = (char)(0x80 | (c >> 6 & 0x3F));
        text[n++] = (char)(0x80 | (c & 0x3F));
    }
    return value_string(ev, text, c == 0 ? 0 : n);
}

/* substr(text, first character from 1, length) */
static Value substr(Eval *ev, const Node *node) {
    const char *text;
    size_t length;
    double first, count;
    if (!builtin_argument_count(ev, node, 3, 3) || !string_argument(ev, node, 0, &text, &length) ||
        !eval_float(ev, node->as.list.items[1], &first) || !eval_float(ev, node->as.list.items[2], &count))
        return value_error();
    size_t characters = char_count(text, length);
    first = trunc(first);
    count = trunc(count);
    if (first == 0 && count >= 0 && count - 1 <= (double)characters) { /* POV-Ray's answer to who counts from 0 */
        diag_warning(ev->diags, node->span, "substr() counts characters from 1: from 0 on it gives none");
        return value_string(ev, "", 0);
    }
    if (!(first >= 1 && count >= 0 && first - 1 + count <= (double)characters))
        return eval_fail(ev, node->span, "substr(): characters %g to %g of a string of %zu", first,
                         first + count - 1, characters);
    size_t begin = char_begin(text, length, (size_t)first - 1);
    return value_string(ev, text + begin, char_begin(text + begin, length - begin, (size_t)count));
}

/* datetime(days since 2000-01-01 [, strftime format]) */
static Value datetime(Eval *ev, const Node *node) {
    double days;
    const char *format = "%Y-%m-%d %H:%M:%SZ";
    if (!builtin_argument_count(ev, node, 1, 2) || !eval_float(ev, node->as.list.items[0], &days))
        return value_error();
    if (node->as.list.count == 2 && !string_argument(ev, node, 1, &format, NULL)) return value_error();
    if (*format == '\0') return eval_fail(ev, node->span, "datetime() needs a format that is not empty");
    if (!(days > -700000 && days < 3000000)) {
        diag_error(ev->diags, node->span, "datetime(%g) is no date", days);
        return value_error();
    }
    time_t when = (time_t)(days * 86400 + 946684800.0 + 0.5);
    struct tm parts;
    char text[512];
    gmtime_r(&when, &parts);
    size_t length = strftime(text, sizeof text, format, &parts);
    return value_string(ev, text, length);
}

static Value text_measure(Eval *ev, const Node *node) {
    const char *a, *b;
    size_t length;
    bool two = node->op == KW_strcmp;
    if (!builtin_argument_count(ev, node, two ? 2 : 1, two ? 2 : 1) ||
        !string_argument(ev, node, 0, &a, &length))
        return value_error();
    switch (node->op) {
    case KW_asc: return value_float(char_code(a, length));
    case KW_strlen: return value_float((double)char_count(a, length));
    case KW_val: return value_float(decimal_strtod(a, NULL));
    case KW_file_exists: return value_float(file_exists_for(ev, a, node->span));
    default: return string_argument(ev, node, 1, &b, NULL) ? value_float(strcmp(a, b)) : value_error();
    }
}

Value eval_builtin_string(Eval *ev, const Node *node) {
    switch (node->op) {
    case KW_concat: return concat(ev, node);
    case KW_str: return str(ev, node);
    case KW_vstr: return vstr(ev, node);
    case KW_strlwr:
    case KW_strupr: return change_case(ev, node);
    case KW_chr: return chr(ev, node);
    case KW_substr: return substr(ev, node);
    case KW_datetime: return datetime(ev, node);
    default: return text_measure(ev, node);
    }
}
