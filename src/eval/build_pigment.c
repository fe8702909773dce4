#include "eval/build_pattern.h"

#include <string.h>

static void read_unmodelled(Reader *reader, const Word *word, void *target) {
    PigmentDraft *draft = target;
    draft->pigment.kind = PATTERN_SOLID;
    draft->pigment.color = (Color){0.5, 0.5, 0.5, 0, 0};
    inert_add(reader->context, &draft->pigment.inert, word->text, word->span);
}

void read_image(Reader *reader, const Word *word, void *target) {
    Pigment *pigment = &((PigmentDraft *)target)->pigment;
    const ImageMap *image = image_read(reader, word);
    if (!image || !image->picture) read_unmodelled(reader, word, target);
    else pigment->kind = strcmp(word->text, "image_map") == 0 ? PATTERN_IMAGE_MAP : PATTERN_IMAGE;
    pigment->image = image;
}

static void read_undrawn(Reader *reader, const Word *word, void *target) {
    read_unmodelled(reader, word, target);
    grammar_word(reader, word);
}

#define FIELD(name) offsetof(PigmentDraft, pigment.name)
#define UNMODELLED(word)                                                                                     \
    { word, WORD_CUSTOM, 0, read_undrawn, false }
#define INERT(word)                                                                                          \
    { word, WORD_INERT, FIELD(inert), NULL, false }
static const WordRule rules[] = {
    {"quick_color", WORD_COLOR, FIELD(quick_color), NULL, false},
    {"quick_colour", WORD_COLOR, FIELD(quick_color), NULL, false},
    INERT("map_type"),
    INERT("once"),
    UNMODELLED("facets"),
    {"image_map", WORD_CUSTOM, 0, read_image, false},
    UNMODELLED("potential"),
    UNMODELLED("proximity"),
    {"uv_mapping", WORD_FLAG, offsetof(PigmentDraft, uv), NULL, false},
};

/* The pigment as the one entry of a map that is seen in u and v. */
static const Pigment *seen_in_uv(const BuildContext *context, const Pigment *inner) {
    Pigment *outer = arena_new(context->arena, Pigment);
    ColorMapEntry *entry = arena_new(context->arena, ColorMapEntry);
    entry->pigment = inner;
    *outer = pigment_default();
    outer->span = inner->span;
    outer->kind = PATTERN_UV;
    outer->entries = entry;
    outer->entry_count = 1;
    pigment_measure(outer);
    pigment_rehash(outer);
    return outer;
}

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

static bool is_uv_mapping(const BlockItem *item) {
    Word word;
    return item_as_word(item, &word) && strcmp(word.text, "uv_mapping") == 0;
}

static bool on_value(Reader *reader, const Argument *value, void *target) {
    PigmentDraft *draft = target;
    bool block_pattern = pattern_block_count(draft->pigment.kind) > 0 && !draft->pigment.entries;
    if (block_pattern && take_block_entry(reader, draft, value)) return true;
    switch (value->value.kind) {
    case VALUE_COLOR:
        draft->pigment.kind = PATTERN_SOLID;
        return argument_color(reader, value, "'pigment'", &draft->pigment.color);
    case VALUE_PIGMENT:
        if (reader->block->items[0].kind == ITEM_WORD && !(reader->next <= 2 && is_uv_mapping(&reader->block->items[0])))
            reader_error(reader, value->span, "the pattern or colour of a pigment comes first, and only once");
        draft->pigment = *value->value.as.pigment;
        return true;
    case VALUE_OBJECT: return take_object_pattern(reader, draft, value->value.as.object);
    case VALUE_COLOR_MAP: take_map(draft, value->value.as.color_map); return true;
    case VALUE_FUNCTION:
        if (argument_function(reader, value, "'pigment'", 3, 1, &draft->pigment.function))
            draft->pigment.kind = PATTERN_FUNCTION;
        return true;
    default: return take_transform(value, &draft->pigment.transform);
    }
}

/* ---- density { … } of media: a pigment that may begin with a declared density, and have maps of densities ---- */

static const Pigment *read_from(Reader *reader, const Pigment *start);

const Pigment *density_colors_read(Reader *reader) {
    Pigment start = pigment_default();
    start.color = (Color){1, 1, 1, 0, 0};
    return read_from(reader, &start);
}

static void read_density_map(Reader *reader, const Word *word, PigmentDraft *draft) {
    const ColorMap *map = density_map_read(reader, word->body);
    if (map) take_map(draft, map);
}

static bool read_density_word(Reader *reader, const Word *word, PigmentDraft *draft) {
    if (word->body && strcmp(word->text, "density_map") == 0) {
        read_density_map(reader, word, draft);
        return true;
    }
    if (!word->body || strcmp(word->text, "density") != 0) return false;
    Reader body = reader_nested(reader, word->body);
    const Pigment *declared = density_colors_read(&body);
    if (reader_end_nested(reader, &body) && declared) draft->pigment = *declared;
    return true;
}

/* Options of patterns that are not drawn. */
static bool on_word(Reader *reader, const Word *word, void *target) {
    return read_density_word(reader, word, target) || grammar_word(reader, word);
}

/* Whether the item says what kind of pigment this is: a pattern, a picture, a function, a colour. */
static bool gives_kind(const BlockItem *item, Word *word) {
    if (item_as_word(item, word))
        return strcmp(word->text, "image_map") == 0 || grammar_has("pattern_types", word->text);
    return item->kind == ITEM_VALUE &&
           (item->value.kind == VALUE_FUNCTION || item->value.kind == VALUE_COLOR);
}

/* The colours that a pattern lists follow its kind. */
static bool lists_colors(const Word *kind) {
    static const char *const words[] = {"checker", "brick", "hexagon", "square", "triangular", "cubic"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(words); i++)
        if (strcmp(words[i], kind->text) == 0) return true;
    return false;
}

static bool is_value(const BlockItem *item, ValueKind kind) {
    return item->kind == ITEM_VALUE && item->value.kind == kind;
}

/* What kind of pigment it is comes first, after a declared pigment and `uv_mapping`, and is said once; the settings after it are its
 * own. */
static bool check_order(Reader *reader) {
    bool begun = false, listing = false;
    const char *pattern = NULL;
    size_t first = reader->next;
    for (size_t i = first; i < reader->block->count; i++) {
        const BlockItem *item = &reader->block->items[i];
        Word word = {.text = ""};
        bool kind = gives_kind(item, &word);
        if ((kind && begun && !(listing && is_value(item, VALUE_COLOR))) ||
            (is_value(item, VALUE_PIGMENT) && i > first + is_uv_mapping(&reader->block->items[first]) && !listing)) {
            reader_error(reader, item->span, "the pattern or colour of a pigment comes first, and only once");
            return false;
        }
        if (is_value(item, VALUE_PIGMENT) && i == first) pattern = pattern_word(item->value.as.pigment->kind);
        if (kind) pattern = word.text[0] ? word.text : NULL;
        if (word.text[0] && !pattern_takes(reader, pattern, &word)) return false;
        listing = kind ? listing || lists_colors(&word) : listing;
        if (begun && strcmp(word.text, "uv_mapping") == 0) {
            reader_error(reader, word.span, "'uv_mapping' stands before the pattern of a pigment");
            return false;
        }
        begun |= kind || is_value(item, VALUE_COLOR_MAP) ||
                 (word.text[0] && strcmp(word.text, "uv_mapping") != 0 && strcmp(word.text, "magnet") != 0);
    }
    return true;
}

/* `average` is the mean of pigments; a pattern that lists its colours has no use for a map. */
static bool check_map(Reader *reader, const PigmentDraft *draft) {
    const Pigment *p = &draft->pigment;
    bool average = p->kind == PATTERN_AVERAGE;
    bool pigments = p->entry_count && p->entries[0].pigment;
    if (average && !pigments)
        reader_error(reader, reader->block->word_span, "the pattern 'average' needs a map of what it averages");
    return !average || pigments;
}

/* Loops can make a pigment out of itself for ever. */
static bool check_size(Reader *reader, const Pigment *pigment) {
    if (pigment->depth > PIGMENT_DEEPEST)
        reader_error(reader, reader->block->word_span, "pigments are nested more than %d deep", PIGMENT_DEEPEST);
    else if (pigment->work > PIGMENT_MOST_WORK)
        reader_error(reader, reader->block->word_span, "one colour of this pigment takes more than %g steps",
                     PIGMENT_MOST_WORK);
    else
        return true;
    return false;
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
    reader->on_word = on_word;
    if (!check_order(reader) || !reader_run(reader)) return NULL;
    if (!draft->pigment.noise_generator)
        draft->pigment.noise_generator = build_noise_generator(reader->context);
    if (draft->count) {
        draft->pigment.entries = draft->items;
        draft->pigment.entry_count = draft->count;
    }
    if (!check_map(reader, draft) || !pattern_check(reader, &draft->pigment)) return NULL;
    pigment_measure(&draft->pigment);
    if (!check_size(reader, &draft->pigment)) return NULL;
    pigment_rehash(&draft->pigment);
    return draft->uv ? seen_in_uv(reader->context, &draft->pigment) : &draft->pigment;
}

const Pigment *pigment_read(Reader *reader) {
    Pigment start = *texture_default(reader->context)->pigment;
    if (reader->context->wave_count) start.wave_count = reader->context->wave_count;
    return read_from(reader, &start);
}

/* Of function { pattern { … } }: a pigment whose colours nobody asks for. */
bool build_pattern(BuildContext *context, const EvalBlock *block, Value *out) {
    Reader reader = reader_begin(context, block);
    Pigment start = pigment_default();
    const Pigment *pigment = read_from(&reader, &start);
    if (pigment) *out = (Value){.kind = VALUE_PIGMENT, .as.pigment = pigment};
    return pigment != NULL;
}

const Pigment *pigment_over(BuildContext *context, const Pigment *base, const Pigment *block) {
    if (!block->text || base == texture_default(context)->pigment) return block;
    Reader reader = reader_begin(context, block->text);
    const Pigment *made = read_from(&reader, base);
    return made ? made : block;
}

static bool begins_declared(const EvalBlock *block) {
    return block->count && block->items[0].kind == ITEM_VALUE && block->items[0].value.kind == VALUE_PIGMENT;
}

bool build_pigment(BuildContext *context, const EvalBlock *block, Value *out) {
    Reader reader = reader_begin(context, block);
    const Pigment *pigment = pigment_read(&reader);
    if (!pigment) return false;
    Pigment *kept = arena_copy(context->arena, pigment, sizeof *pigment);
    kept->text = begins_declared(block) ? NULL : block_keep(context->arena, block);
    *out = (Value){.kind = VALUE_PIGMENT, .as.pigment = kept};
    return true;
}
