#include "lexer/lexer.h"

#include "base/decimal.h"
#include "base/utf8.h"
#include "lexer/match.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

typedef struct TokenBuffer {
    Token *items;
    size_t count, capacity;
} TokenBuffer;

typedef struct Lexer {
    const SourceFile *file;
    const KeywordTable *keywords;
    Arena *arena;
    const char *text;
    uint32_t at, size;
    TokenBuffer tokens;
    BrokenKind mistake; /* the first one in the string that is being read */
    Span mistake_span;
    uint32_t long_string; /* 1 + the offset of the first string that goes over several lines; 0: none */
} Lexer;

static Span span_from(const Lexer *lx, uint32_t begin) { return (Span){lx->file->id, begin, lx->at}; }

static Token *push(Lexer *lx, int kind, uint32_t begin) {
    Token *t = list_push_sole(lx->arena, &lx->tokens);
    *t = (Token){.kind = (uint8_t)kind, .span = span_from(lx, begin)};
    return t;
}

/* Text that cannot be read: said where a parser comes upon it, after all that stands before it has run. */
static Token *push_broken(Lexer *lx, BrokenKind kind, Span span) {
    Token *t = push(lx, TOKEN_BROKEN, span.begin);
    t->keyword = (uint16_t)kind;
    t->span = span;
    return t;
}

void token_report_broken(DiagList *diags, const Token *token) {
    Diagnostic *d;
    switch ((BrokenKind)token->keyword) {
    case BROKEN_COMMENT:
        diag_error(diags, token->span, "the comment that begins after this, in line %g, has no end",
                   token->as.number);
        break;
    case BROKEN_STRING:
        d = diag_error(diags, token->span, "this string has no closing quote");
        uint32_t other = (uint32_t)token->as.number;
        if (other)
            diag_note(diags, d, (Span){token->span.file, other - 1, other},
                      "perhaps this one lacks it, which goes over several lines");
        break;
    case BROKEN_UNICODE: diag_error(diags, token->span, "\\u needs hexadecimal digits"); break;
    case BROKEN_DIRECTIVE:
        diag_error(diags, token->span, "expected the word of a directive after '#'");
        break;
    case BROKEN_ESCAPE:
        d = diag_error(diags, token->span, "unknown escape in a string");
        diag_hint(diags, d, "a backslash itself is written \\\\");
        break;
    case BROKEN_NOTHING: break;
    }
}

static double line_of(const Lexer *lx, uint32_t at) {
    double line = 1;
    for (uint32_t i = 0; i < at; i++) line += lx->text[i] == '\n';
    return line;
}

/* POV-Ray blames the last thing that it could read; the message tells where the comment begins. */
static void endless_comment(Lexer *lx, uint32_t begin) {
    Span span = {lx->file->id, begin, begin + 2};
    if (lx->tokens.count) span = lx->tokens.items[lx->tokens.count - 1].span;
    push_broken(lx, BROKEN_COMMENT, span)->as.number = line_of(lx, begin);
}

/* comment = "/" "*" { comment | character } "*" "/" */
static void skip_block_comment(Lexer *lx) {
    uint32_t begin = lx->at, depth = 0;
    do {
        if (lx->at >= lx->size) {
            endless_comment(lx, begin);
            return;
        }
        const char *c = lx->text + lx->at;
        if (c[0] == '/' && c[1] == '*')
            depth++, lx->at += 2;
        else if (c[0] == '*' && c[1] == '/')
            depth--, lx->at += 2;
        else
            lx->at++;
    } while (depth);
}

static void skip_blanks_and_comments(Lexer *lx) {
    while (lx->at < lx->size) {
        unsigned char c = (unsigned char)lx->text[lx->at];
        if (c == '/' && lx->text[lx->at + 1] == '/') {
            while (lx->at < lx->size && lx->text[lx->at] != '\n') lx->at++;
        } else if (c == '/' && lx->text[lx->at + 1] == '*') {
            skip_block_comment(lx);
        } else if (c <= ' ') {
            lx->at++;
        } else {
            return;
        }
    }
}

/* Most often there are none. */
static inline void skip_blanks(Lexer *lx) {
    const unsigned char c = (unsigned char)lx->text[lx->at];
    if (c <= ' ' || c == '/') skip_blanks_and_comments(lx);
}

static bool is_word_start(char c) { return isalpha((unsigned char)c) || c == '_'; }
static bool is_word_part(char c) { return isalnum((unsigned char)c) || c == '_'; }
/* number = (digits ["." [digits]] | "." digits) [("e" | "E") ["+" | "-"] [digits]]; those that are not short are left to strtod(). */
static double read_number(Lexer *lx) {
    Decimal d;
    double value;
    const char *begin = lx->text + lx->at, *at = decimal_read(begin, &d);
    bool simple = decimal_value(&d, &value);
    if (*at == 'e' || *at == 'E') {
        const char *exponent = at + 1;
        simple = false;
        if (*exponent == '+' || *exponent == '-') exponent++;
        if (!is_word_part(*exponent) || is_digit(*exponent)) at = exponent;
        while (is_digit(*at)) at++;
    }
    lx->at = (uint32_t)(at - lx->text);
    return simple ? value : decimal_strtod(begin, NULL);
}

static void lex_number(Lexer *lx) {
    uint32_t begin = lx->at;
    double value = read_number(lx);
    push(lx, TOKEN_NUMBER, begin)->as.number = value;
}

static void add_utf8(StrBuf *out, unsigned code) {
    if (code < 0x80) {
        strbuf_addc(out, (char)code);
    } else if (code < 0x800) {
        strbuf_addc(out, (char)(0xC0 | code >> 6));
        strbuf_addc(out, (char)(0x80 | (code & 0x3F)));
    } else {
        strbuf_addc(out, (char)(0xE0 | code >> 12));
        strbuf_addc(out, (char)(0x80 | (code >> 6 & 0x3F)));
        strbuf_addc(out, (char)(0x80 | (code & 0x3F)));
    }
}

static int hex_digit(char c) {
    return is_digit(c)            ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* "\u" with up to four hexadecimal digits; false when there is none. */
static bool unicode_escape(Lexer *lx, StrBuf *out) {
    unsigned code = 0;
    int digits = 0;
    for (; digits < 4 && hex_digit(lx->text[lx->at]) >= 0; digits++, lx->at++)
        code = code * 16 + (unsigned)hex_digit(lx->text[lx->at]);
    if (digits == 0) return false;
    if (code) add_utf8(out, code);
    return true;
}

static void string_mistake(Lexer *lx, BrokenKind kind, Span span) {
    if (lx->mistake) return;
    lx->mistake = kind;
    lx->mistake_span = span;
}

static void lex_escape(Lexer *lx, StrBuf *out) {
    static const char letters[] = "abfnrtv0\\'\"", meant[] = "\a\b\f\n\r\t\v\0\\'\"";
    uint32_t begin = lx->at++;
    char c = lx->text[lx->at];
    const char *found = c ? strchr(letters, c) : NULL;
    if (found && c != '0') {
        strbuf_addc(out, meant[found - letters]);
        lx->at++;
    } else if (c == 'u') {
        lx->at++;
        if (!unicode_escape(lx, out)) string_mistake(lx, BROKEN_UNICODE, span_from(lx, begin));
    } else {
        if (lx->at < lx->size) lx->at++;
        string_mistake(lx, BROKEN_ESCAPE, span_from(lx, begin));
    }
}

/* A string over several lines may be what is left of two with a forgotten quote. */
static void note_long_string(Lexer *lx, uint32_t begin) {
    if (memchr(lx->text + begin, '\n', lx->at - begin)) lx->long_string = begin + 1;
}

/* string = '"' { character | escape } '"': may go over several lines, but one that never ends is blamed on its start. */
static void lex_string(Lexer *lx) {
    uint32_t begin = lx->at++;
    StrBuf decoded = {0};
    lx->mistake = BROKEN_NOTHING;
    while (lx->at < lx->size && lx->text[lx->at] != '"') {
        if (lx->text[lx->at] == '\\')
            lex_escape(lx, &decoded);
        else
            strbuf_addc(&decoded, lx->text[lx->at++]);
    }
    if (lx->at >= lx->size) {
        const char *eol = memchr(lx->text + begin, '\n', lx->size - begin);
        uint32_t end = eol ? (uint32_t)(eol - lx->text) : lx->size;
        lx->mistake = BROKEN_NOTHING;
        string_mistake(lx, BROKEN_STRING, (Span){lx->file->id, begin, end});
    } else {
        lx->at++;
        if (lx->long_string == 0) note_long_string(lx, begin);
    }
    if (lx->mistake) {
        strbuf_free(&decoded);
        Token *t = push_broken(lx, lx->mistake, lx->mistake_span);
        if (lx->mistake == BROKEN_STRING) t->as.number = lx->long_string;
        return;
    }
    TokenString *string = arena_new(lx->arena, TokenString);
    string->length = decoded.size;
    string->text = decoded.size ? arena_copy(lx->arena, decoded.data, decoded.size + 1) : "";
    strbuf_free(&decoded);
    push(lx, TOKEN_STRING, begin)->as.string = string;
}

static Name take_word(Lexer *lx) {
    uint32_t begin = lx->at;
    while (is_word_part(lx->text[lx->at])) lx->at++;
    return intern(lx->keywords->names, lx->text + begin, lx->at - begin);
}

static void lex_word(Lexer *lx) {
    uint32_t begin = lx->at;
    Name name = take_word(lx);
    Token *t = push(lx, TOKEN_WORD, begin);
    t->as.name = name;
    t->keyword = (uint16_t)keyword_of(lx->keywords, name);
}

/* POV-Ray passes over a '#' before a brace or another '#', or before a keyword that is no directive. */
static bool is_idle(Lexer *lx) {
    uint32_t begin = lx->at;
    if (lx->text[begin] == '}' || lx->text[begin] == '#') return true;
    if (!is_word_start(lx->text[begin])) return false;
    Keyword keyword = keyword_of(lx->keywords, take_word(lx));
    lx->at = begin;
    return keyword && !keyword_is_directive(keyword);
}

/* directive = "#" word: blanks and line ends may stand between. */
static void lex_directive(Lexer *lx) {
    uint32_t begin = lx->at++;
    size_t tokens = lx->tokens.count;
    skip_blanks(lx);
    if (lx->tokens.count > tokens) return; /* a comment without end: nothing follows */
    if (is_idle(lx)) {
        lx->at = begin + 1;
        return;
    }
    if (!is_word_start(lx->text[lx->at])) {
        push_broken(lx, BROKEN_DIRECTIVE, (Span){lx->file->id, begin, begin + 1});
        return;
    }
    Name name = take_word(lx);
    Keyword keyword = keyword_of(lx->keywords, name);
    Token *t = push(lx, TOKEN_DIRECTIVE, begin);
    t->as.name = name;
    t->keyword = keyword_is_directive(keyword) ? (uint16_t)keyword : KW_NONE;
}

/* ---- long lists ---- */

/* Programs hold numbers and vectors by the hundred thousand: what stands in braces and is nothing else becomes one token. */

/* A comment that ends makes no token; of one that does not the caller sees that it made one. */
static char next_char(Lexer *lx) {
    skip_blanks(lx);
    return lx->text[lx->at];
}

static bool begins_number(const Lexer *lx) { return is_digit(lx->text[lx->at]) || (lx->text[lx->at] == '.' && is_digit(lx->text[lx->at + 1])); }

/* ["-" | "+"] number */
static bool listed_float(Lexer *lx, double *out) {
    char sign = next_char(lx);
    if (sign == '-' || sign == '+') {
        lx->at++;
        skip_blanks(lx);
    }
    if (!begins_number(lx)) return false;
    double value = read_number(lx);
    *out = sign == '-' ? -value : value;
    return true;
}

/* "<" float { "," float } ">", two or three of them; or a float */
static bool listed_number(Lexer *lx, ListedNumber *out) {
    uint32_t begin = lx->at;
    double *c = out->components;
    if (lx->text[begin] != '<') {
        out->size = 1;
        if (!listed_float(lx, c)) return false;
        c[1] = c[2] = c[0];
    } else {
        do {
            lx->at++;
            if (out->size == 3 || !listed_float(lx, &c[out->size++])) return false;
        } while (next_char(lx) == ',');
        if (out->size < 2 || lx->text[lx->at++] != '>') return false;
    }
    out->span = span_from(lx, begin);
    return true;
}

/* How many there will be, from what those so far take. */
static size_t expected_in_list(const Lexer *lx, uint32_t begin, size_t so_far) {
    const char *from = lx->text + lx->at, *close = memchr(from, '}', lx->size - lx->at);
    size_t each = (lx->at - begin) / so_far;
    return close ? (size_t)(close - from) / size_max(each, 1) * 9 / 8 + so_far : 0;
}

enum { LONG_LIST = 64 };

/* Up to the closing brace; false where there is anything else, or not much. */
static bool read_list(Lexer *lx, ListedNumbers *list) {
    uint32_t begin = lx->at;
    ListedNumber few[LONG_LIST];
    list->items = few, list->capacity = LONG_LIST;
    for (char c = next_char(lx); c != '}'; c = next_char(lx)) {
        if (list->count == LONG_LIST && list->items == few) {
            list->capacity = size_max(expected_in_list(lx, begin, LONG_LIST), 2 * LONG_LIST);
            list->items = arena_new_array(lx->arena, ListedNumber, list->capacity);
            memcpy(list->items, few, sizeof few);
        }
        ListedNumber *n = list_push_sole(lx->arena, list);
        *n = (ListedNumber){0};
        if (!listed_number(lx, n)) return false;
        c = next_char(lx);
        if (c == ',') lx->at++;
        else if (c != '}') return false;
    }
    return list->count > LONG_LIST;
}

/* After an opening brace. */
static void lex_list(Lexer *lx) {
    const uint32_t begin = lx->at;
    const size_t tokens = lx->tokens.count;
    const ArenaMark mark = arena_mark(lx->arena);
    ListedNumbers list = {0};
    if (read_list(lx, &list) && lx->tokens.count == tokens) {
        const Span from = list.items[0].span, to = list.items[list.count - 1].span;
        Token *t = push(lx, TOKEN_LIST, begin);
        t->span = span_join(from, to);
        t->as.list = arena_copy(lx->arena, &list, sizeof list);
        return;
    }
    if (lx->tokens.count == tokens) arena_reset_to(lx->arena, mark);
    lx->tokens.count = tokens;
    lx->at = begin;
}

static void lex_symbol(Lexer *lx) {
    uint32_t begin = lx->at;
    char c = lx->text[lx->at++], next = lx->text[lx->at];
    int kind = c;
    if (c == '<' && next == '=')
        kind = TOKEN_LESS_EQUAL;
    else if (c == '>' && next == '=')
        kind = TOKEN_GREATER_EQUAL;
    else if (c == '!' && next == '=')
        kind = TOKEN_NOT_EQUAL;
    if (kind != c) lx->at++;
    push(lx, kind, begin);
    if (c == '{') lex_list(lx);
}

/* A run of bytes that no token begins with: kept as one token '$', so that text which a branch skips may hold anything and what is
 * not skipped is an error where it is read. */
static void lex_unknown(Lexer *lx) {
    uint32_t begin = lx->at++;
    while (lx->at < lx->size && (unsigned char)lx->text[lx->at] >= 0x80) lx->at++;
    push(lx, '$', begin);
}

static bool is_symbol(char c) {
    switch (c) {
    case ',': case '<': case '>': case '-': case '+': case '*': case '/': case '^': case '!': case '=': case '&': case '|': case '?':
    case ':': case '.': case ';': case '(': case ')': case '[': case ']': case '{': case '}': return true;
    default: return false;
    }
}

static void lex_one(Lexer *lx) {
    char c = lx->text[lx->at];
    if (is_digit(c) || (c == '.' && is_digit(lx->text[lx->at + 1])))
        lex_number(lx);
    else if (is_word_start(c))
        lex_word(lx);
    else if (c == '"')
        lex_string(lx);
    else if (c == '#')
        lex_directive(lx);
    else if (is_symbol(c))
        lex_symbol(lx);
    else
        lex_unknown(lx);
}

TokenList *lexer_run(const SourceFile *file, const KeywordTable *keywords, Arena *arena) {
    Lexer lx = {.file = file, .keywords = keywords, .arena = arena, .text = file->text, .size = file->size};
    if (lx.size >= 3 && memcmp(lx.text, "\xEF\xBB\xBF", 3) == 0) lx.at = 3;
    for (skip_blanks(&lx); lx.at < lx.size; skip_blanks(&lx)) lex_one(&lx);
    /* The end is blamed for what is missing: it lies right after the last token, not behind blank lines. */
    if (lx.tokens.count) lx.at = lx.tokens.items[lx.tokens.count - 1].span.end;
    push(&lx, TOKEN_END, lx.at);
    TokenList *list = arena_new(arena, TokenList);
    *list = (TokenList){.file = file, .items = lx.tokens.items, .count = (uint32_t)lx.tokens.count};
    list->balanced = token_match(lx.tokens.items, (uint32_t)lx.tokens.count, arena);
    return list;
}

void token_set_ending(Token *end, const Token *by) {
    if (by->kind == TOKEN_DIRECTIVE)
        end->as.name = by->as.name;
    else if (by->kind == '}' || by->kind == ']' || by->kind == ')')
        end->match = by->kind;
}

/* The text of a token as the file has it; what cannot be shown by its number. */
static const char *token_text(const Token *token, SourceSet *sources, Arena *arena) {
    SourcePlace place = source_locate(sources, token->span);
    if (!place.file || token->span.end > place.file->size) return "a value";
    const char *text = place.file->text + token->span.begin;
    size_t size = token->span.end - token->span.begin;
    if (token->kind == TOKEN_VALUE) return arena_printf(arena, "'%.*s'", (int)size_min(size, 100), text);
    size = utf8_size(text, size);
    if (size == 0 || (unsigned char)*text < 0x20 || *text == 0x7F)
        return arena_printf(arena, "the byte 0x%02X", (unsigned)(unsigned char)*text);
    return arena_printf(arena, "the character '%.*s'", (int)size, text);
}

const char *token_describe(const Token *token, SourceSet *sources, Arena *arena) {
    switch (token->kind) {
    case TOKEN_END:
        if (token->match) return arena_printf(arena, "'%c'", (int)token->match);
        return token->as.name ? arena_printf(arena, "'#%s'", token->as.name->text) : "the end";
    case TOKEN_NUMBER: return arena_printf(arena, "the number %g", token->as.number);
    case TOKEN_STRING: return "a string";
    case TOKEN_WORD: return arena_printf(arena, "'%s'", token->as.name->text);
    case TOKEN_DIRECTIVE: return arena_printf(arena, "'#%s'", token->as.name->text);
    case TOKEN_BROKEN: return "text that cannot be read";
    case TOKEN_LIST: return "a list of numbers";
    case '$':
    case TOKEN_VALUE: return token_text(token, sources, arena);
    case TOKEN_LESS_EQUAL: return "'<='";
    case TOKEN_GREATER_EQUAL: return "'>='";
    case TOKEN_NOT_EQUAL: return "'!='";
    default: return arena_printf(arena, "'%c'", token->kind);
    }
}

void lexer_print(const TokenList *tokens, SourceSet *sources, StrBuf *out) {
    static const char *const kinds[] = {"end", "number", "string", "word", "directive", "value", "broken", "list"};
    for (uint32_t i = 0; i < tokens->count; i++) {
        const Token *t = &tokens->items[i];
        SourcePlace place = source_locate(sources, t->span);
        const char *kind = t->kind < VTS_ARRAY_COUNT(kinds) ? kinds[t->kind] : "symbol";
        if (t->kind == TOKEN_WORD && t->keyword) kind = "keyword";
        strbuf_addf(out, "%u:%u %s ", place.line, place.column, kind);
        if (t->kind == TOKEN_NUMBER)
            strbuf_addf(out, "%.17g", t->as.number);
        else if (t->kind == TOKEN_STRING)
            strbuf_add_json(out, t->as.string->text);
        else
            strbuf_add(out, tokens->file->text + t->span.begin, t->span.end - t->span.begin);
        strbuf_addc(out, '\n');
    }
}
