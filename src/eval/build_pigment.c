#include "eval/build_parts.h"

#include <string.h>

/* A pigment under construction. Block patterns (checker, brick, hexagon) collect their colours in `entries`. */
typedef struct PigmentDraft {
    Pigment pigment;
    ColorMapEntry *items;
    size_t count, capacity;
} PigmentDraft;

static const struct PatternWord {
    const char *word;
    PatternKind kind;
} pattern_words[] = {
    {"gradient", PATTERN_GRADIENT},
    {"checker", PATTERN_CHECKER},
    {"brick", PATTERN_BRICK},
    {"hexagon", PATTERN_HEXAGON},
    {"bozo", PATTERN_BOZO},
    {"bumps", PATTERN_BOZO},
    {"granite", PATTERN_GRANITE},
    {"wrinkles", PATTERN_WRINKLES},
    {"agate", PATTERN_AGATE},
    {"marble", PATTERN_MARBLE},
    {"wood", PATTERN_WOOD},
    {"crackle", PATTERN_CRACKLE},
    {"leopard", PATTERN_LEOPARD},
    {"onion", PATTERN_ONION},
    {"radial", PATTERN_RADIAL},
    {"spotted", PATTERN_SPOTTED},
    {"cells", PATTERN_CELLS},
    {"boxed", PATTERN_BOXED},
    {"cylindrical", PATTERN_CYLINDRICAL},
    {"spherical", PATTERN_SPHERICAL},
    {"planar", PATTERN_PLANAR},
    {"slope", PATTERN_SLOPE},
};

static const struct PatternWord *find_pattern(const char *word) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(pattern_words); i++)
        if (strcmp(pattern_words[i].word, word) == 0) return &pattern_words[i];
    return NULL;
}

static bool is_block_pattern(PatternKind kind) {
    return kind == PATTERN_CHECKER || kind == PATTERN_BRICK || kind == PATTERN_HEXAGON;
}

static void add_entry(Reader *reader, PigmentDraft *draft, ColorMapEntry entry) {
    entry.position = (double)draft->count;
    *list_push(reader->context->arena, draft) = entry;
}

static bool take_block_entry(Reader *reader, PigmentDraft *draft, const Argument *value) {
    ColorMapEntry entry = {0};
    if (value->value.kind == VALUE_PIGMENT)
        entry.pigment = value->value.as.pigment;
    else if (value->value.kind == VALUE_COLOR || value->value.kind == VALUE_VECTOR)
        argument_color(reader, value, "the pattern", &entry.color);
    else
        return false;
    size_t most = draft->pigment.kind == PATTERN_HEXAGON ? 3 : 2;
    if (draft->count == most)
        reader_error(reader, value->span, "this pattern has only %zu colours", most);
    else
        add_entry(reader, draft, entry);
    return true;
}

static void read_direction(Reader *reader, const Word *word, Pigment *pigment) {
    if (word->body) { /* slope { y, low, high }: the direction counts */
        Reader body = reader_nested(reader, word->body);
        reader_vector(&body, "the direction", &pigment->direction, NULL);
        reader_end_nested(reader, &body);
    } else if (word_arguments(reader, word, 1, 3)) {
        word_vector(reader, word, 0, &pigment->direction);
    }
}

static void read_pattern(Reader *reader, const Word *word, void *target) {
    PigmentDraft *draft = target;
    Pigment *pigment = &draft->pigment;
    pigment->kind = find_pattern(word->text)->kind;
    pigment->entries = NULL;
    pigment->entry_count = draft->count = 0;
    if (pigment->kind == PATTERN_GRADIENT || pigment->kind == PATTERN_SLOPE) {
        read_direction(reader, word, pigment);
        return;
    }
    for (size_t i = 0; i < word->count; i++)
        if (!is_block_pattern(pigment->kind) || !take_block_entry(reader, draft, &word->arguments[i]))
            reader_error(reader, word->arguments[i].span, "'%s' takes no %s here", word->text,
                         is_block_pattern(pigment->kind) ? "such value" : "value");
}

static void read_unmodelled(Reader *reader, const Word *word, void *target) {
    PigmentDraft *draft = target;
    draft->pigment.kind = PATTERN_SOLID;
    draft->pigment.color = (Color){0.5, 0.5, 0.5, 0, 0};
    inert_add(reader->context, &draft->pigment.inert, word->text, word->span);
}

static void read_octaves(Reader *reader, const Word *word, void *target) {
    PigmentDraft *draft = target;
    int octaves;
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, &octaves)) return;
    draft->pigment.octaves = int_clamp(octaves, 1, 10); /* POV-Ray's range */
}

static void read_function_body(Reader *reader, const Word *word, void *target) {
    PigmentDraft *draft = target;
    if (!word_arguments(reader, word, 1, 1)) return;
    if (argument_function(reader, &word->arguments[0], "'function'", 3, 1, &draft->pigment.function))
        draft->pigment.kind = PATTERN_FUNCTION;
}

#define FIELD(name) offsetof(PigmentDraft, pigment.name)
#define PATTERN(word)                                                                                        \
    { word, WORD_CUSTOM, 0, read_pattern, false }
#define UNMODELLED(word)                                                                                     \
    { word, WORD_CUSTOM, 0, read_unmodelled, false }
#define INERT(word)                                                                                          \
    { word, WORD_INERT, FIELD(inert), NULL, false }
static const WordRule rules[] = {
    {"quick_color", WORD_COLOR, FIELD(quick_color), NULL, false},
    {"quick_colour", WORD_COLOR, FIELD(quick_color), NULL, false},
    {"frequency", WORD_FLOAT, FIELD(frequency), NULL, false},
    {"phase", WORD_FLOAT, FIELD(phase), NULL, false},
    {"turbulence", WORD_VECTOR, FIELD(turbulence), NULL, false},
    {"octaves", WORD_CUSTOM, 0, read_octaves, false},
    {"lambda", WORD_FLOAT, FIELD(lambda), NULL, false},
    {"omega", WORD_FLOAT, FIELD(omega), NULL, false},
    {"brick_size", WORD_VECTOR, FIELD(brick_size), NULL, false},
    {"mortar", WORD_FLOAT, FIELD(mortar), NULL, false},
    {"function", WORD_CUSTOM, 0, read_function_body, false},
    {"ramp_wave", WORD_IGNORED, 0, NULL, false},
    INERT("triangle_wave"),
    INERT("sine_wave"),
    INERT("scallop_wave"),
    INERT("cubic_wave"),
    INERT("poly_wave"),
    INERT("warp"),
    INERT("agate_turb"),
    INERT("form"),
    INERT("metric"),
    INERT("offset"),
    INERT("solid"),
    INERT("noise_generator"),
    INERT("interpolate"),
    INERT("map_type"),
    INERT("once"),
    INERT("altitude"),
    INERT("exponent"),
    INERT("exterior"),
    PATTERN("gradient"),
    PATTERN("checker"),
    PATTERN("brick"),
    PATTERN("hexagon"),
    PATTERN("bozo"),
    PATTERN("bumps"),
    PATTERN("granite"),
    PATTERN("wrinkles"),
    PATTERN("agate"),
    PATTERN("marble"),
    PATTERN("wood"),
    PATTERN("crackle"),
    PATTERN("leopard"),
    PATTERN("onion"),
    PATTERN("radial"),
    PATTERN("spotted"),
    PATTERN("cells"),
    PATTERN("boxed"),
    PATTERN("cylindrical"),
    PATTERN("spherical"),
    PATTERN("planar"),
    PATTERN("slope"),
};
static const WordRule unmodelled_rules[] = {
    UNMODELLED("aoi"),
    UNMODELLED("average"),
    UNMODELLED("dents"),
    UNMODELLED("density_file"),
    UNMODELLED("facets"),
    UNMODELLED("image_map"),
    UNMODELLED("image_pattern"),
    UNMODELLED("julia"),
    UNMODELLED("magnet"),
    UNMODELLED("mandel"),
    UNMODELLED("object"),
    UNMODELLED("pavement"),
    UNMODELLED("pigment_pattern"),
    UNMODELLED("potential"),
    UNMODELLED("proximity"),
    UNMODELLED("quilted"),
    UNMODELLED("ripples"),
    UNMODELLED("spiral1"),
    UNMODELLED("spiral2"),
    UNMODELLED("square"),
    UNMODELLED("tiling"),
    UNMODELLED("triangular"),
    UNMODELLED("waves"),
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
    bool block_pattern = is_block_pattern(draft->pigment.kind) && !draft->pigment.entries;
    if (block_pattern && take_block_entry(reader, draft, value)) return true;
    switch (value->value.kind) {
    case VALUE_COLOR:
        draft->pigment.kind = PATTERN_SOLID;
        return argument_color(reader, value, "'pigment'", &draft->pigment.color);
    case VALUE_PIGMENT: draft->pigment = *value->value.as.pigment; return true;
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
    reader_add_table(reader, unmodelled_rules, VTS_ARRAY_COUNT(unmodelled_rules), draft);
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
