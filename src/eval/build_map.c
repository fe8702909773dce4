#include "eval/build_parts.h"

#include <string.h>

typedef struct EntryList {
    ColorMapEntry *items;
    size_t count, capacity;
} EntryList;

static bool is_color(const BlockItem *item) {
    return item && item->kind == ITEM_VALUE &&
           (item->value.kind == VALUE_COLOR || item->value.kind == VALUE_VECTOR);
}

static void read_color_entry(Reader *reader, EntryList *list, double position) {
    const BlockItem *item = reader_peek(reader);
    ColorMapEntry entry = {.position = position};
    if (!is_color(item)) {
        reader_error(reader, item ? item->span : reader->block->span,
                     "an entry of a colour map is [ position colour ]");
        return;
    }
    Argument argument = {item->value, item->span};
    reader->next++;
    if (argument_color(reader, &argument, "an entry of a colour map", &entry.color))
        *list_push(reader->context->arena, list) = entry;
}

/* [p colour], or the old form [p, q colour colour]. */
static void read_color_entries(Reader *reader, EntryList *list, double position) {
    Argument second;
    double end = position;
    bool two = reader_take_value(reader, VALUE_FLOAT, &second) &&
               argument_float(reader, &second, "the position", &end);
    read_color_entry(reader, list, position);
    if (two && !reader->failed) read_color_entry(reader, list, end);
    const BlockItem *extra = reader_peek(reader);
    if (extra && !reader->failed)
        reader_error(reader, extra->span, "this entry of the colour map has too many values");
}

typedef const Pigment *ReadPigment(Reader *reader);

static void read_pigment_entry(Reader *reader, ReadPigment *read, EntryList *list, double position) {
    const Pigment *pigment = read(reader);
    if (pigment)
        *list_push(reader->context->arena, list) = (ColorMapEntry){.position = position, .pigment = pigment};
}

/* Stable: two entries at one place are a step, in the order of the text. */
static void sort_entries(EntryList *list) {
    for (size_t i = 1; i < list->count; i++)
        for (size_t k = i; k > 0 && list->items[k].position < list->items[k - 1].position; k--) {
            ColorMapEntry swap = list->items[k];
            list->items[k] = list->items[k - 1];
            list->items[k - 1] = swap;
        }
}

/* `pigments`: reads them; NULL: entries are colours. */
static void read_entry(Reader *map, const EvalBlock *block, ReadPigment *pigments, EntryList *list) {
    Reader reader = reader_nested(map, block);
    double position = 1; /* of pigments that are averaged: a weight, which may be left out */
    const BlockItem *first = reader_peek(&reader);
    bool weightless = pigments && first && !(first->kind == ITEM_VALUE && first->value.kind == VALUE_FLOAT);
    if (weightless || reader_float(&reader, "the position of a map's entry", &position, NULL)) {
        if (pigments)
            read_pigment_entry(&reader, pigments, list, position);
        else
            read_color_entries(&reader, list, position);
    }
    reader_end_nested(map, &reader);
}

/* The rest of the reader's block as a map; NULL after a report. */
static const ColorMap *read_map(Reader *reader, ReadPigment *pigments) {
    const EvalBlock *block = reader->block;
    Arena *arena = reader->context->arena;
    EntryList list = {0};
    for (const BlockItem *item; (item = reader_peek(reader)); reader->next++)
        if (item->kind == ITEM_ENTRY)
            read_entry(reader, item->entry, pigments, &list);
        else if (!reader->failed)
            reader_error(reader, item->span, "'%s' holds entries [ … ] only", block->word->text);
    if (!reader->failed && list.count == 0)
        reader_error(reader, block->word_span, "'%s' without entries", block->word->text);
    if (reader->failed) return NULL;
    sort_entries(&list);
    ColorMap *map = arena_new(arena, ColorMap);
    *map = (ColorMap){block->span, list.items, list.count};
    return map;
}

bool build_color_map(BuildContext *context, const EvalBlock *block, Value *out) {
    Reader reader = reader_begin(context, block);
    bool pigments = strcmp(block->word->text, "pigment_map") == 0;
    Argument declared;
    if (reader_take_value(&reader, VALUE_COLOR_MAP, &declared)) {
        *out = declared.value;
        return true;
    }
    const ColorMap *map = read_map(&reader, pigments ? pigment_read : NULL);
    if (map) *out = (Value){.kind = VALUE_COLOR_MAP, .as.color_map = map};
    return map != NULL;
}

const ColorMap *density_map_read(Reader *parent, const EvalBlock *block) {
    Reader reader = reader_nested(parent, block);
    const BlockItem *first = reader_peek(&reader);
    Word declared;
    if (first && item_as_word(first, &declared) && declared.body && strcmp(declared.text, "density_map") == 0)
        return density_map_read(parent, declared.body);
    const ColorMap *map = read_map(&reader, density_colors_read);
    return reader_end_nested(parent, &reader) ? map : NULL;
}
