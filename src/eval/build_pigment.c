#include "eval/build_pattern.h"

#include <string.h>

static void read_unmodelled(Reader *reader, const Word *word, void *target) {
    PigmentDraft *draft = target;
    draft->pigment.kind = PATTERN_SOLID;
    draft->pigment.color = (Color){0.5, 0.5, 0.5, 0, 0};
    inert_add(reader->context, &draft->pigment.inert, word->text, word->span);
}

#define FIELD(name) offsetof(PigmentDraft, pigment.name)
#define UNMODELLED(word)                                                                                     \
    { word, WORD_CUSTOM, 0, read_unmodelled, false }
#define INERT(word)                                                                                          \
    { word, WORD_INERT, FIELD(inert), NULL, false }
static const WordRule rules[] = {
    {"quick_color", WORD_COLOR, FIELD(quick_color), NULL, false},
    {"quick_colour", WORD_COLOR, FIELD(quick_color), NULL, false},
    INERT("map_type"),
    INERT("once"),
    UNMODELLED("aoi"),
    UNMODELLED("facets"),
    UNMODELLED("image_map"),
    UNMODELLED("image_pattern"),
    UNMODELLED("pavement"),
    UNMODELLED("potential"),
    UNMODELLED("proximity"),
    UNMODELLED("tiling"),
    UNMODELLED("uv_mapping"),
};

/* What stands in a map's place when its pattern cannot be drawn: the mean of its colours. */
static Color map_mean(const ColorMapEntry *entries, size_t count) {
    Color sum = {0};
    for (size_t i = 0; i < count; i++) {
        Color c = entries[i].pigment ? entries[i].pigment->color : entries[i].color;
        sum = (Color){sum.red + c.red, sum.green + c.green, sum.blue + c.blue, sum.filter + c.filter,
                      sum.transmit + c.transmit};
    }
    double n = (double)count;
    return (Color){sum.red / n, sum.green / n, sum.blue / n, sum.filter / n, sum.transmit / n};
}

static void take_map(PigmentDraft *draft, const ColorMap *map) {
    if (draft->pigment.kind == PATTERN_SOLID) {
        draft->pigment.color = map_mean(map->entries, map->count);
        return;
    }
    draft->pigment.entries = map->entries;
    draft->pigment.entry_count = map->count;
}

static bool on_value(Reader *reader, const Argument *value, void *target) {
    PigmentDraft *draft = target;
    bool block_pattern = pattern_block_count(draft->pigment.kind) > 0 && !draft->pigment.entries;
    if (block_pattern && take_block_entry(reader, draft, value)) return true;
    switch (value->value.kind) {
    case VALUE_COLOR:
        draft->pigment.kind = PATTERN_SOLID;
        return argument_color(reader, value, "'pigment'", &draft->pigment.color);
    case VALUE_PIGMENT: draft->pigment = *value->value.as.pigment; return true;
    case VALUE_OBJECT: return take_object_pattern(reader, draft, value->value.as.object);
    case VALUE_COLOR_MAP: take_map(draft, value->value.as.color_map); return true;
    case VALUE_FUNCTION:
        if (argument_function(reader, value, "'pigment'", 3, 1, &draft->pigment.function))
            draft->pigment.kind = PATTERN_FUNCTION;
        return true;
    default: return take_transform(value, &draft->pigment.transform);
    }
}

static const Pigment *read_from(Reader *reader, const Pigment *start) {
    PigmentDraft *draft = arena_new(reader->context->arena, PigmentDraft);
    draft->pigment = *start;
    draft->pigment.span = reader->block->span;
    reader_add_table(reader, rules, VTS_ARRAY_COUNT(rules), draft);
    reader_add_table(reader, pattern_rules, pattern_rule_count, draft);
    reader_add_table(reader, pattern_setting_rules, pattern_setting_rule_count, draft);
    reader_add_table(reader, transform_rules, transform_rule_count, &draft->pigment.transform);
    reader->on_value = on_value;
    reader->value_target = draft;
    if (!reader_run(reader)) return NULL;
    if (draft->count) {
        draft->pigment.entries = draft->items;
        draft->pigment.entry_count = draft->count;
    }
    pigment_rehash(&draft->pigment);
    return &draft->pigment;
}

const Pigment *pigment_read(Reader *reader) {
    return read_from(reader, texture_default(reader->context)->pigment);
}

/* Of function { pattern { … } }: a pigment whose colours nobody asks for. */
bool build_pattern(BuildContext *context, const EvalBlock *block, Value *out) {
    Reader reader = reader_begin(context, block);
    Pigment start = pigment_default();
    const Pigment *pigment = read_from(&reader, &start);
    if (pigment) *out = (Value){.kind = VALUE_PIGMENT, .as.pigment = pigment};
    return pigment != NULL;
}

bool build_pigment(BuildContext *context, const EvalBlock *block, Value *out) {
    Reader reader = reader_begin(context, block);
    const Pigment *pigment = pigment_read(&reader);
    if (pigment) *out = (Value){.kind = VALUE_PIGMENT, .as.pigment = pigment};
    return pigment != NULL;
}
