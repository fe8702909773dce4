#include "eval/block_setting.h"

#include "base/decimal.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ITEMS = 16, MOST_NAME = 60 };

static bool is_letter(char c) { return isalpha((unsigned char)c) || c == '_'; }
static bool is_in_name(char c) { return isalnum((unsigned char)c) || c == '_'; }

/* Past the name that `text` begins with; `text` itself where none does. */
static const char *skip_name(const char *text) {
    const char *end = text;
    if (is_letter(*text))
        while (is_in_name(*end)) end++;
    return end - text <= MOST_NAME ? end : text;
}

bool block_setting_is_name(const char *name) {
    const char *dot = skip_name(name);
    if (dot == name || *dot != '.') return false;
    const char *end = skip_name(dot + 1);
    return end > dot + 1 && *end == '\0';
}

static bool read_number(const char **text, double *out) {
    char *end;
    if (!isdigit((unsigned char)**text) && !strchr("+-.", **text)) return false; /* strtod knows names of numbers */
    errno = 0;
    *out = decimal_strtod(*text, &end);
    bool valid = end != *text && errno == 0 && isfinite(*out);
    *text = end;
    return valid;
}

static bool read_quotient(const char **text, double *out) {
    double divisor = 1;
    if (!read_number(text, out)) return false;
    if (**text != '/') return true;
    (*text)++;
    if (!read_number(text, &divisor) || divisor == 0) return false;
    *out /= divisor;
    return isfinite(*out);
}

/* 1 and 0 have names in the language. */
static bool read_switch(const char *text, size_t size, double *out) {
    static const char *const names[] = {"off", "no", "false", "on", "yes", "true"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(names); i++)
        if (strlen(names[i]) == size && memcmp(names[i], text, size) == 0) {
            *out = i >= 3;
            return true;
        }
    return false;
}

/* A number, or a name between [begin, end). */
typedef struct Piece {
    bool is_number;
    double number;
    const char *begin, *end;
} Piece;

static bool next_piece(const char **text, Piece *out) {
    const char *end = skip_name(*text);
    *out = (Piece){.begin = *text, .end = end};
    if (end > *text) {
        out->is_number = read_switch(*text, (size_t)(end - *text), &out->number);
        *text = end;
    } else {
        out->is_number = true;
        if (!read_quotient(text, &out->number)) return false;
    }
    return **text == '\0' || **text == ' ';
}

/* At most MOST_ITEMS pieces; -1 when something is none. */
static int read_pieces(const char *text, Piece *out) {
    int count = 0;
    for (text += strspn(text, " "); *text; text += strspn(text, " "))
        if (count == MOST_ITEMS || !next_piece(&text, &out[count++])) return -1;
    return count;
}

const char *block_setting_check(const char *name, const char *value) {
    Piece pieces[MOST_ITEMS];
    if (!block_setting_is_name(name)) return "a word of a block is named as in volume.rays";
    return read_pieces(value, pieces) > 0 ? NULL : "it is numbers or names, such as 20000, 1/255, auto";
}

/* A word with the numbers that stand behind it. */
static size_t add_word(Arena *arena, Name word, const Piece *pieces, size_t count, BlockItem *out) {
    size_t numbers = 0;
    while (numbers < count && pieces[numbers].is_number) numbers++;
    Argument *arguments = arena_new_array(arena, Argument, numbers);
    for (size_t i = 0; i < numbers; i++) arguments[i].value = (Value){.kind = VALUE_FLOAT, .as.number = pieces[i].number};
    *out = (BlockItem){.kind = ITEM_WORD, .word = word, .arguments = arguments, .argument_count = numbers};
    return numbers;
}

BlockSetting block_setting_make(Arena *arena, Interner *names, const char *name, const char *value) {
    Piece pieces[MOST_ITEMS];
    int found = read_pieces(value, pieces);
    size_t count = found > 0 ? (size_t)found : 0;
    const char *dot = strchr(name, '.');
    BlockItem *items = arena_new_array(arena, BlockItem, count + 1);
    BlockSetting out = {.block = arena_printf(arena, "%.*s", (int)(dot - name), name), .word = arena_printf(arena, "%s", dot + 1), .items = items};
    size_t at = add_word(arena, intern_cstr(names, out.word), pieces, count, &items[out.count++]);
    while (at < count) {
        Name word = intern(names, pieces[at].begin, (size_t)(pieces[at].end - pieces[at].begin));
        at++;
        at += add_word(arena, word, pieces + at, count - at, &items[out.count++]);
    }
    return out;
}
