/* The grammar of POV-Ray's blocks and words that are read and not modelled: grammar.def says what may stand where, and this
 * file holds a block or a word against it. */
#include "eval/build_pattern.h"

#include "base/decimal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Grammar {
    const char *block, *lead, *values, *words;
} Grammar;

static const Grammar grammars[] = {
#define GRAMMAR(block, lead, values, words) {#block, lead, " " values " ", " " words " "},
#include "eval/grammar.def"
#undef GRAMMAR
};

static const Grammar *find_grammar(const char *block, size_t length) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(grammars); i++)
        if (strncmp(grammars[i].block, block, length) == 0 && grammars[i].block[length] == '\0')
            return &grammars[i];
    return NULL;
}

static const char *word_end(const char *p) {
    while (*p != ' ' && *p != ':' && *p != '\0') p++;
    return p;
}

/* Calls of @group in a list of words; groups do not nest in circles. */
static const Grammar *next_group(const char **at) {
    const char *p = strchr(*at, '@');
    if (!p) return NULL;
    *at = word_end(p);
    return find_grammar(p + 1, (size_t)(*at - p - 1));
}

/* What may follow the word: its operands as grammar.def spells them, NULL when the word is none of this block's. */
static const char *find_operands(const Grammar *grammar, const char *text) {
    size_t length = strlen(text);
    for (const char *p = strstr(grammar->words, text); p; p = strstr(p + 1, text))
        if (p[-1] == ' ' && (p[length] == ' ' || p[length] == ':'))
            return p[length] == ':' ? p + length + 1 : "";
    const char *at = grammar->words;
    for (const Grammar *group; (group = next_group(&at));) {
        const char *found = find_operands(group, text);
        if (found) return found;
    }
    return NULL;
}

static const char *const kind_words[] = {
    [VALUE_FLOAT] = "float",       [VALUE_VECTOR] = "vector",     [VALUE_COLOR] = "color",
    [VALUE_STRING] = "string",     [VALUE_FUNCTION] = "function", [VALUE_TRANSFORM] = "transform",
    [VALUE_OBJECT] = "object",     [VALUE_LIGHT] = "light",       [VALUE_TEXTURE] = "texture",
    [VALUE_PIGMENT] = "pigment",   [VALUE_NORMAL] = "normal",     [VALUE_FINISH] = "finish",
    [VALUE_INTERIOR] = "interior", [VALUE_MATERIAL] = "material", [VALUE_COLOR_MAP] = "map",
    [VALUE_CAMERA] = "camera",     [VALUE_FOG] = "fog",           [VALUE_SKY_SPHERE] = "sky_sphere",
    [VALUE_SPLINE] = "spline",     [VALUE_RAINBOW] = "rainbow",
};

static bool accepts_value(const Grammar *grammar, ValueKind kind) {
    const char *text = kind < VTS_ARRAY_COUNT(kind_words) ? kind_words[kind] : NULL;
    if (!text) return false;
    size_t length = strlen(text);
    for (const char *p = strstr(grammar->values, text); p; p = strstr(p + 1, text))
        if (p[-1] == ' ' && p[length] == ' ') return true;
    const char *at = grammar->words;
    for (const Grammar *group; (group = next_group(&at));)
        if (accepts_value(group, kind)) return true;
    return false;
}

/* ---- operands ---- */

static bool is_numeric(ValueKind kind) {
    return kind == VALUE_FLOAT || kind == VALUE_VECTOR || kind == VALUE_COLOR;
}

static const struct OperandKind {
    char letter;
    const char *text;
} operand_kinds[] = {{'f', "a float"},    {'v', "a vector"},  {'c', "a colour"},  {'s', "a string"},
                     {'F', "a function"}, {'o', "an object"}, {'p', "a pigment"}, {'x', "a texture"}};

static bool operand_fits(char letter, ValueKind kind) {
    switch (letter) {
    case 'f':
    case 'n': return kind == VALUE_FLOAT;
    case 'v':
    case 'c': return is_numeric(kind);
    case 's': return kind == VALUE_STRING;
    case 'F': return kind == VALUE_FUNCTION;
    case 'o': return kind == VALUE_OBJECT;
    case 'p': return kind == VALUE_PIGMENT;
    case 'x': return kind == VALUE_TEXTURE;
    default: return true;
    }
}

static const char *operand_text(char letter) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(operand_kinds); i++)
        if (operand_kinds[i].letter == letter) return operand_kinds[i].text;
    return "a value";
}

/* (LOW) or (LOW,HIGH) behind a float; returns where it closes. */
static const char *check_range(Reader *reader, const char *name, const char *range,
                               const Argument *argument) {
    char *end;
    double low = decimal_strtod(range + 1, &end);
    double high = *end == ',' ? decimal_strtod(end + 1, &end) : HUGE_VAL;
    double found = argument && argument->value.kind == VALUE_FLOAT ? argument->value.as.number : low;
    if (!(found >= low && found <= high)) {
        if (high < HUGE_VAL)
            reader_error(reader, argument->span, "'%s' must lie between %g and %g, found %g", name, low, high,
                         found);
        else
            reader_error(reader, argument->span, "'%s' must be at least %g, found %g", name, low, found);
    }
    return end;
}

/* Matches operands with `operands`; returns how many were used, and after an error says so in *ok. A body's grammar is left
 * in *body. */
static size_t match(Reader *reader, const char *name, Span span, const char *operands,
                    const Argument *arguments, size_t count, const char **body, bool *ok) {
    size_t used = 0;
    bool optional = false;
    *body = NULL;
    for (const char *p = operands; *p && *p != ' '; p++) {
        if (*p == '?') {
            optional = true;
        } else if (*p == '(') {
            p = check_range(reader, name, p, used ? &arguments[used - 1] : NULL);
        } else if (*p == '*') {
            while (used < count && operand_fits(p[-1], arguments[used].value.kind)) used++;
        } else if (*p == '{') {
            *body = p + 1;
            return used;
        } else if (used < count && operand_fits(*p, arguments[used].value.kind)) {
            used++;
        } else if (!optional) {
            const char *what = arena_printf(reader->context->arena, "'%s'", name);
            *ok = false;
            if (used < count)
                reader_mismatch(reader, arguments[used].span, what, operand_text(*p),
                                arguments[used].value.kind);
            else
                reader_error(reader, span, "'%s' needs %s%s", name, used ? "another value: " : "",
                             operand_text(*p));
            return used;
        }
    }
    return used;
}

static void check_body(Reader *parent, const Word *word, const char *name, bool optional) {
    size_t length = (size_t)(word_end(name) - name);
    const Grammar *grammar = length ? find_grammar(name, length) : NULL;
    if (!word->body && !optional)
        reader_error(parent, word->span, "'%s' needs its block { … }", word->text);
    else if (word->body && grammar) {
        Reader reader = reader_nested(parent, word->body);
        grammar_read(&reader, grammar->block);
        reader_end_nested(parent, &reader);
    }
}

static void surplus(Reader *reader, const Grammar *grammar, const Word *word, size_t used) {
    for (size_t i = used; i < word->count; i++)
        if (!(reader->on_value && reader->on_value(reader, &word->arguments[i], reader->value_target)) &&
            !accepts_value(grammar, word->arguments[i].value.kind)) {
            reader_error(reader, word->arguments[i].span,
                         "too many values for '%s': expected %s%zu, found %zu", word->text, "", used,
                         word->count);
            return;
        }
}

static void check_word(Reader *reader, const Grammar *grammar, const Word *word, const char *operands) {
    const char *body;
    bool ok = true;
    size_t used = match(reader, word->text, word->span, operands, word->arguments, word->count, &body, &ok);
    if (!ok) return;
    surplus(reader, grammar, word, used);
    if (body)
        check_body(reader, word, body, strchr(operands, '?') && strchr(operands, '?') < body);
    else if (word->body)
        reader_error(reader, word->body->span, "'%s' takes no block { … } here", word->text);
}

static void unknown_word(Reader *reader, const Grammar *grammar, const Word *word) {
    const char *words[160];
    size_t count = 0;
    for (const char *p = grammar->words; *p && count < VTS_ARRAY_COUNT(words); p = word_end(p)) {
        while (*p == ' ') p++;
        const char *end = word_end(p);
        if (end > p && *p != '@')
            words[count++] = arena_printf(reader->context->arena, "%.*s", (int)(end - p), p);
        p = end;
        while (*p && *p != ' ') p++;
    }
    Diagnostic *d = reader_error(reader, word->span, "'%s' is neither declared nor a word of '%s'",
                                 word->text, reader->block->word->text);
    eval_hint_name(reader->context, d, word->text, words, count);
}

/* ---- blocks ---- */

/* The operands that a block begins with. */
static void read_lead(Reader *reader, const Grammar *grammar) {
    enum { MOST_LEAD = 16 };
    Argument lead[MOST_LEAD];
    size_t count = 0;
    for (const BlockItem *item; count < MOST_LEAD && (item = reader_peek(reader)) &&
                                item->kind == ITEM_VALUE && item->value.kind != VALUE_BLOCK;
         reader->next++)
        lead[count++] = (Argument){item->value, item->span};
    const char *body;
    bool ok = true;
    size_t used = match(reader, reader->block->word->text, reader->block->word_span, grammar->lead, lead,
                        count, &body, &ok);
    reader->next -= count - used;
}

static void read_entry(Reader *reader, const Grammar *grammar, const BlockItem *item) {
    const char *operands = find_operands(grammar, "[");
    if (operands && *operands == '{') {
        Reader entry = reader_nested(reader, item->entry);
        grammar_read(&entry, arena_printf(reader->context->arena, "%.*s",
                                          (int)(word_end(operands + 1) - operands - 1), operands + 1));
        reader_end_nested(reader, &entry);
    } else {
        reader_error(reader, item->span, "an entry [ … ] has no meaning in '%s'", reader->block->word->text);
    }
}

static bool has_value(const EvalBlock *block, ValueKind kind) {
    for (size_t i = 0; i < block->count; i++)
        if (block->items[i].kind == ITEM_VALUE && block->items[i].value.kind == kind) return true;
    return false;
}

static bool has_map(const EvalBlock *block) {
    for (size_t i = 0; i < block->count; i++) {
        Word word;
        if (item_as_word(&block->items[i], &word) && strstr(word.text, "_map")) return true;
    }
    return has_value(block, VALUE_COLOR_MAP);
}

/* What a block that was read whole must have held. */
static void check_complete(Reader *reader, const Grammar *grammar, const char *pattern) {
    const EvalBlock *block = reader->block;
    const char *name = grammar->block;
    bool normal = strcmp(name, "normal") == 0;
    if (block->count == 0 && find_operands(grammar, "["))
        reader_error(reader, block->word_span, "'%s' without entries", block->word->text);
    if (pattern && strcmp(pattern, "average") == 0 && (normal || strcmp(name, "density") == 0) &&
        !has_map(block))
        reader_error(reader, block->word_span, "the pattern 'average' needs a map of what it averages");
}

bool grammar_read(Reader *reader, const char *block) {
    const Grammar *grammar = find_grammar(block, strlen(block));
    if (!grammar) return true;
    read_lead(reader, grammar);
    const BlockItem *item;
    const char *found = NULL; /* the pattern's word */
    while (!reader->failed && (item = reader_peek(reader))) {
        reader->next++;
        Word word;
        if (item->kind == ITEM_ENTRY) {
            read_entry(reader, grammar, item);
        } else if (item_as_word(item, &word)) {
            const char *operands = find_operands(grammar, word.text);
            bool prefix =
                strcmp(word.text, "magnet") == 0; /* of `magnet 1 mandel`: the pattern's first word of two */
            bool pattern = operands && !prefix && grammar_has("pattern_types", word.text);
            if (pattern && found)
                reader_error(reader, word.span, "'%s' is a second pattern", word.text);
            else if (!operands)
                unknown_word(reader, grammar, &word);
            else if (pattern_takes(reader, found, &word))
                check_word(reader, grammar, &word, operands);
            if (pattern) found = word.text;
        } else if (item->value.kind == VALUE_ERROR) {
            reader->failed = true;
        } else if (!accepts_value(grammar, item->value.kind)) {
            reader_error(reader, item->span, "%s has no meaning here in '%s'",
                         value_kind_text(item->value.kind), reader->block->word->text);
        }
    }
    if (!reader->failed) check_complete(reader, grammar, found);
    return !reader->failed;
}

bool grammar_word(Reader *reader, const Word *word) {
    const char *block = reader->block->word->text;
    const Grammar *own = find_grammar(block, strlen(block));
    const Grammar *shared = find_grammar("modifiers", strlen("modifiers"));
    const char *operands = own ? find_operands(own, word->text) : NULL;
    if (!operands && (operands = find_operands(shared, word->text))) own = shared;
    if (operands) check_word(reader, own, word, operands);
    return operands != NULL;
}

bool grammar_has(const char *block, const char *word) {
    const Grammar *grammar = find_grammar(block, strlen(block));
    return grammar && find_operands(grammar, word);
}

bool build_checked(BuildContext *context, const EvalBlock *block, Value *out) {
    Reader reader = reader_begin(context, block);
    if (!grammar_read(&reader, block->word->text)) return false;
    *out = (Value){.kind = VALUE_BLOCK, .as.block = block};
    return true;
}
