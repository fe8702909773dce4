/* For tests of builders: evaluated blocks from a text, without the language. Numbers, <vectors>, rgb …, x y z, "strings",
 * words, nested { … } blocks, [ entries ] and $names of values that the test supplies. Spans are those of the text. */
#ifndef VTS_TESTS_BLOCK_TEXT_H
#define VTS_TESTS_BLOCK_TEXT_H

#include "eval/block.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

typedef struct BlockText {
    Arena arena;
    SourceSet sources;
    DiagList diags;
    Interner names;
    BuildContext context;
    const SourceFile *file;
    const char *at;
    double index; /* of the particle */
    Name outer;   /* the word of the block that is being read */
    struct {
        const char *name;
        Value value;
    } bound[8];
    size_t bound_count;
} BlockText;

typedef struct ItemList {
    BlockItem *items;
    size_t count, capacity;
} ItemList;

typedef struct ArgumentList {
    Argument *items;
    size_t count, capacity;
} ArgumentList;

static EvalBlock *parse_items(BlockText *t, const char *word, Span word_span, char close);

static inline void block_text_begin(BlockText *t) {
    memset(t, 0, sizeof *t);
    arena_init(&t->arena, NULL, 0);
    source_set_init(&t->sources, &t->arena);
    diag_init(&t->diags, &t->arena, &t->sources);
    interner_init(&t->names, &t->arena);
    t->context =
        (BuildContext){.arena = &t->arena, .names = &t->names, .diags = &t->diags, .image_aspect = 4.0 / 3};
}

static inline void block_text_end(BlockText *t) { arena_destroy(&t->arena); }

static inline void block_text_bind(BlockText *t, const char *name, Value value) {
    t->bound[t->bound_count].name = name;
    t->bound[t->bound_count++].value = value;
}

static inline void skip_space(BlockText *t) {
    while (isspace((unsigned char)*t->at) || *t->at == ',') t->at++;
}

static inline Span span_from(const BlockText *t, const char *begin) {
    return (Span){t->file->id, (uint32_t)(begin - t->file->text), (uint32_t)(t->at - t->file->text)};
}

static inline const char *take_name(BlockText *t) {
    const char *begin = t->at;
    while (isalnum((unsigned char)*t->at) || *t->at == '_') t->at++;
    return intern(&t->names, begin, (size_t)(t->at - begin))->text;
}

static inline bool name_is(const char *at, const char *word) {
    size_t n = strlen(word);
    return strncmp(at, word, n) == 0 && !isalnum((unsigned char)at[n]) && at[n] != '_';
}

static inline Value components_value(BlockText *t, ValueKind kind, const double *c, size_t n) {
    return (Value){
        .kind = kind, .size = (uint8_t)n, .as.components = arena_copy(&t->arena, c, n * sizeof *c)};
}

static inline bool parse_expression(BlockText *t, Argument *out);

static inline Value parse_vector(BlockText *t) {
    double c[16] = {0};
    size_t n = 0;
    for (t->at++, skip_space(t); *t->at != '>'; skip_space(t)) {
        Argument a;
        if (!parse_expression(t, &a)) abort();
        c[n++] = a.value.as.number;
    }
    t->at++;
    return components_value(t, VALUE_VECTOR, c, n);
}

static inline Value parse_color(BlockText *t) {
    const char *kind = take_name(t);
    Argument a;
    double c[5] = {0}, in[5] = {0};
    skip_space(t);
    if (!parse_expression(t, &a)) abort();
    for (size_t i = 0; i < 5; i++)
        in[i] = a.value.kind == VALUE_FLOAT ? a.value.as.number
                : i < a.value.size          ? a.value.as.components[i]
                                            : 0;
    memcpy(c, in, 3 * sizeof *c);
    if (strcmp(kind, "rgbf") == 0 || strcmp(kind, "rgbft") == 0) c[3] = in[3];
    if (strcmp(kind, "rgbt") == 0) c[4] = in[3];
    if (strcmp(kind, "rgbft") == 0) c[4] = in[4];
    return components_value(t, VALUE_COLOR, c, 5);
}

static inline Value parse_axis(BlockText *t) {
    double c[3] = {*t->at == 'x', *t->at == 'y', *t->at == 'z'};
    t->at++;
    return components_value(t, VALUE_VECTOR, c, 3);
}

static inline Value parse_string(BlockText *t) {
    const char *begin = ++t->at;
    while (*t->at != '"') t->at++;
    size_t n = (size_t)(t->at++ - begin);
    return (Value){.kind = VALUE_STRING, .as.string = {arena_copy(&t->arena, begin, n), n}};
}

static inline Value bound_value(BlockText *t) {
    t->at++;
    const char *name = take_name(t);
    for (size_t i = 0; i < t->bound_count; i++)
        if (strcmp(t->bound[i].name, name) == 0) return t->bound[i].value;
    abort();
}

static inline bool parse_expression(BlockText *t, Argument *out) {
    const char *begin = t->at;
    if (isdigit((unsigned char)*t->at) || *t->at == '-' || *t->at == '.') {
        char *end;
        out->value = (Value){.kind = VALUE_FLOAT, .as.number = strtod(t->at, &end)};
        t->at = end;
    } else if (*t->at == '<')
        out->value = parse_vector(t);
    else if (*t->at == '"')
        out->value = parse_string(t);
    else if (*t->at == '$')
        out->value = bound_value(t);
    else if (name_is(t->at, "x") || name_is(t->at, "y") || name_is(t->at, "z"))
        out->value = parse_axis(t);
    else if (name_is(t->at, "rgb") || name_is(t->at, "rgbf") || name_is(t->at, "rgbt") ||
             name_is(t->at, "rgbft"))
        out->value = parse_color(t);
    else if (name_is(t->at, "index")) {
        t->at += 5;
        out->value = (Value){.kind = VALUE_FLOAT, .as.number = t->index};
    } else if (name_is(t->at, "nan")) {
        t->at += 3;
        out->value = (Value){.kind = VALUE_FLOAT, .as.number = (double)NAN};
    } else
        return false;
    out->span = span_from(t, begin);
    return true;
}

static inline Value build_value(BlockText *t, const EvalBlock *block) {
    bool known;
    Value value = {.kind = VALUE_BLOCK, .as.block = block};
    BlockBuilder *builder = block_builder_find(&t->context, block->word, &known);
    if (builder && !builder(&t->context, block, &value)) value = (Value){.kind = VALUE_ERROR};
    return value;
}

/* count N { … }: the body once for each particle */
static inline void parse_count(BlockText *t, ItemList *list, BlockItem *item, const char *begin) {
    const char *body = t->at;
    double count = item->arguments[0].value.as.number;
    for (t->index = 0; t->index < count; t->index++) {
        t->at = body;
        Argument *arguments = arena_new_array(&t->arena, Argument, 2);
        arguments[0].value = (Value){.kind = VALUE_FLOAT, .as.number = t->index};
        arguments[1] = item->arguments[0];
        item->arguments = arguments;
        item->argument_count = 2;
        item->body = parse_items(t, "count", item->word_span, '}');
        item->span = span_from(t, begin);
        *list_push(&t->arena, list) = *item;
    }
}

static inline void parse_word(BlockText *t, ItemList *list) {
    const char *begin = t->at;
    BlockItem item = {.kind = ITEM_WORD};
    item.word = intern_cstr(&t->names, take_name(t));
    item.word_span = span_from(t, begin);
    item.span = item.word_span;
    ArgumentList arguments = {0};
    Argument argument;
    for (skip_space(t); parse_expression(t, &argument); skip_space(t)) {
        item.span = span_from(t, begin);
        *list_push(&t->arena, &arguments) = argument;
    }
    item.arguments = arguments.items;
    item.argument_count = arguments.count;
    if (*t->at == '{') {
        t->at++;
        if (strcmp(item.word->text, "count") == 0) {
            parse_count(t, list, &item, begin);
            return;
        }
        item.body = parse_items(t, item.word->text, item.word_span, '}');
        item.span = span_from(t, begin);
        if (arguments.count == 0) {
            item.kind = ITEM_VALUE;
            item.value = build_value(t, item.body);
        }
    }
    *list_push(&t->arena, list) = item;
}

static EvalBlock *parse_items(BlockText *t, const char *word, Span word_span, char close) {
    ItemList list = {0};
    EvalBlock *block = arena_new(&t->arena, EvalBlock);
    Name outer = t->outer;
    t->outer = intern_cstr(&t->names, word);
    for (skip_space(t); *t->at && *t->at != close; skip_space(t)) {
        const char *begin = t->at;
        Argument argument;
        if (*t->at == '[') {
            t->at++;
            const EvalBlock *entry = parse_items(t, word, word_span, ']');
            *list_push(&t->arena, &list) =
                (BlockItem){.kind = ITEM_ENTRY, .span = span_from(t, begin), .entry = entry};
        } else if (parse_expression(t, &argument))
            *list_push(&t->arena, &list) =
                (BlockItem){.kind = ITEM_VALUE, .span = argument.span, .value = argument.value};
        else if (isalpha((unsigned char)*t->at))
            parse_word(t, &list);
        else
            abort();
    }
    if (*t->at) t->at++;
    t->outer = outer;
    *block = (EvalBlock){.word = intern_cstr(&t->names, word),
                         .outer = outer,
                         .word_span = word_span,
                         .items = list.items,
                         .count = list.count};
    block->span = span_from(t, t->file->text + word_span.begin);
    return block;
}

/* All items of the text as if they stood in one block. */
static inline const EvalBlock *block_text_parse(BlockText *t, const char *text) {
    t->file = source_add_text(&t->sources, "test.vts", text, strlen(text));
    t->at = t->file->text;
    return parse_items(t, "scene", (Span){t->file->id, 0, 0}, '\0');
}

/* The value of the first item. */
static inline Value block_text_value(BlockText *t, const char *text) {
    const EvalBlock *all = block_text_parse(t, text);
    return all->items[0].value;
}

/* A scene of all items, or NULL after errors. */
static inline const Scene *block_text_scene(BlockText *t, const char *text) {
    SceneDraft *draft = scene_draft_create(&t->context, "test");
    const EvalBlock *all = block_text_parse(t, text);
    for (size_t i = 0; i < all->count; i++)
        scene_draft_add(draft, &t->context, &all->items[i].value, all->items[i].span);
    return t->diags.error_count ? NULL : scene_draft_finish(draft, &t->context);
}

#endif
