/* normal { … }. Its grammar is held against the text first; what is read here makes sense. */
#include "eval/build_pattern.h"

#include <string.h>

typedef struct NormalDraft {
    PigmentDraft pattern; /* first: the pattern's words are read into it */
    Normal normal;
    struct {
        const Normal **items;
        size_t count, capacity;
    } normals;
    struct {
        double *items;
        size_t count, capacity;
    } positions;
    struct {
        SlopeEntry *items;
        size_t count, capacity;
    } slopes;
    bool uv;
} NormalDraft;

static const Normal *normal_read(Reader *reader);

static void add_normal(Reader *reader, NormalDraft *draft, const Normal *normal, double position) {
    if (!normal) return;
    *list_push(reader->context->arena, &draft->normals) = normal;
    *list_push(reader->context->arena, &draft->positions) = position;
}

/* ---- maps ---- */

typedef void EntryReader(Reader *entry, NormalDraft *draft);

static void read_normal_entry(Reader *entry, NormalDraft *draft) {
    double position = 1; /* of `average`, a weight that may be left out */
    Argument first;
    if (reader_take_value(entry, VALUE_FLOAT, &first)) argument_float(entry, &first, "the position", &position);
    add_normal(entry, draft, normal_read(entry), position);
}

static void read_slope_entry(Reader *entry, NormalDraft *draft) {
    SlopeEntry slope;
    Vec3 value;
    if (!reader_float(entry, "the position", &slope.position, NULL) || !reader_vector(entry, "height and slope", &value, NULL)) return;
    slope.height = value.x, slope.slope = value.y;
    *list_push(entry->context->arena, &draft->slopes) = slope;
}

/* The entries of a map, or of the declared map that it holds. */
static void read_entries(Reader *reader, const EvalBlock *map, NormalDraft *draft, EntryReader *read) {
    for (size_t i = 0; map && i < map->count && !reader->failed; i++) {
        const BlockItem *item = &map->items[i];
        if (item->kind == ITEM_VALUE && item->value.kind == VALUE_BLOCK) read_entries(reader, item->value.as.block, draft, read);
        if (item->kind != ITEM_ENTRY) continue;
        Reader entry = reader_nested(reader, item->entry);
        read(&entry, draft);
        reader_end_nested(reader, &entry);
    }
}

static void read_normal_map(Reader *reader, const Word *word, void *target) {
    NormalDraft *draft = target;
    draft->normals.count = draft->positions.count = 0;
    read_entries(reader, word->body, draft, read_normal_entry);
    draft->normal.form = NORMAL_MAP;
}

static void read_slope_map(Reader *reader, const Word *word, void *target) {
    NormalDraft *draft = target;
    draft->slopes.count = 0;
    read_entries(reader, word->body, draft, read_slope_entry);
}

static void read_bump_map(Reader *reader, const Word *word, void *target) {
    NormalDraft *draft = target;
    draft->pattern.pigment.image = image_read(reader, word);
    draft->pattern.pigment.kind = PATTERN_IMAGE;
    draft->normal.form = NORMAL_PICTURE;
    if (draft->pattern.pigment.image && draft->pattern.pigment.image->bump_size != 0)
        draft->normal.amount = draft->pattern.pigment.image->bump_size;
}

/* Its kind is left to find_form(). */
static void read_facets(Reader *reader, const Word *word, void *target) {
    (void)target;
    word_arguments(reader, word, 0, 0);
}

/* ---- the block ---- */

static NormalForm form_of(const char *word) {
    static const struct {
        const char *word;
        NormalForm form;
    } forms[] = {{"bumps", NORMAL_BUMPS},       {"dents", NORMAL_DENTS},     {"ripples", NORMAL_RIPPLES}, {"waves", NORMAL_WAVES},
                 {"wrinkles", NORMAL_WRINKLES}, {"quilted", NORMAL_QUILTED}, {"facets", NORMAL_FACETS}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(forms); i++)
        if (strcmp(forms[i].word, word) == 0) return forms[i].form;
    return NORMAL_GRADIENT;
}

/* The form follows from the pattern's word, wherever it stands. */
static void find_form(Reader *reader, NormalDraft *draft) {
    Word word;
    for (size_t i = reader->next; i < reader->block->count; i++)
        if (item_as_word(&reader->block->items[i], &word) && grammar_has("pattern_types", word.text))
            draft->normal.form = form_of(word.text);
}

static void take_declared(Reader *reader, NormalDraft *draft, const Normal *normal) {
    draft->normal = *normal;
    draft->pattern.pigment = *normal->pattern;
    draft->pattern.count = draft->normals.count = draft->positions.count = draft->slopes.count = 0;
    for (size_t i = 0; i < normal->normal_count; i++)
        add_normal(reader, draft, normal->normals[i], normal->pattern->entries[i].position);
    for (size_t i = 0; i < normal->slope_count; i++) *list_push(reader->context->arena, &draft->slopes) = normal->slopes[i];
}

static bool on_value(Reader *reader, const Argument *value, void *target) {
    NormalDraft *draft = target;
    switch (value->value.kind) {
    case VALUE_FLOAT: return argument_float(reader, value, "'normal'", &draft->normal.amount);
    case VALUE_OBJECT: return take_object_pattern(reader, &draft->pattern, value->value.as.object);
    case VALUE_FUNCTION:
        if (argument_function(reader, value, "'normal'", 3, 1, &draft->pattern.pigment.function))
            draft->pattern.pigment.kind = PATTERN_FUNCTION;
        return true;
    case VALUE_NORMAL:
        if (pattern_block_count(draft->pattern.pigment.kind) > 0) {
            add_normal(reader, draft, value->value.as.normal, (double)draft->normals.count);
            draft->normal.form = NORMAL_MAP;
        } else {
            take_declared(reader, draft, value->value.as.normal);
        }
        return true;
    default: return take_transform(value, &draft->pattern.pigment.transform);
    }
}

/* ---- the finished node ---- */

static void sort_slopes(SlopeEntry *slopes, size_t count) {
    for (size_t i = 1; i < count; i++)
        for (size_t k = i; k > 0 && slopes[k].position < slopes[k - 1].position; k--) {
            SlopeEntry slope = slopes[k];
            slopes[k] = slopes[k - 1], slopes[k - 1] = slope;
        }
}

/* Entries in the order of their positions, as searching a map wants them; what `list` holds moves along. */
void map_entries_sort(ColorMapEntry *entries, const void **list, size_t count) {
    for (size_t i = 1; i < count; i++)
        for (size_t k = i; k > 0 && entries[k].position < entries[k - 1].position; k--) {
            ColorMapEntry entry = entries[k];
            const void *item = list[k];
            entries[k] = entries[k - 1], list[k] = list[k - 1];
            entries[k - 1] = entry, list[k - 1] = item;
        }
}

/* Positions without colours: how a footprint's mean height is gathered where the heights are no straight line. */
static void set_ramp(Arena *arena, Pigment *pattern, size_t count) {
    ColorMapEntry *ramp = arena_new_array(arena, ColorMapEntry, count);
    for (size_t i = 0; i < count; i++) ramp[i].position = (double)i / (double)(count - 1);
    pattern->entries = ramp;
    pattern->entry_count = count;
}

static void set_entries(Arena *arena, NormalDraft *draft) {
    Pigment *pattern = &draft->pattern.pigment;
    Normal *normal = &draft->normal;
    if (normal->form != NORMAL_MAP) {
        set_ramp(arena, pattern, draft->slopes.count ? 17 : 2);
        return;
    }
    ColorMapEntry *entries = arena_new_array(arena, ColorMapEntry, draft->normals.count);
    for (size_t i = 0; i < draft->normals.count; i++) entries[i].position = draft->positions.items[i];
    if (pattern_block_count(pattern->kind) == 0 && pattern->kind != PATTERN_AVERAGE)
        map_entries_sort(entries, (const void **)draft->normals.items, draft->normals.count);
    pattern->entries = entries;
    pattern->entry_count = draft->normals.count;
    normal->normals = draft->normals.items;
    normal->normal_count = draft->normals.count;
}

static bool measure(Reader *reader, Normal *normal) {
    normal->depth = normal->pattern->depth;
    normal->work = (normal->form == NORMAL_GRADIENT ? 4 : 1) * normal->pattern->work + 1;
    for (size_t i = 0; i < normal->normal_count; i++) {
        normal->depth = int_max(normal->depth, normal->normals[i]->depth + 1);
        normal->work += normal->normals[i]->work;
    }
    if (normal->depth > PIGMENT_DEEPEST)
        reader_error(reader, reader->block->word_span, "normals are nested more than %d deep", PIGMENT_DEEPEST);
    else if (normal->work > PIGMENT_MOST_WORK)
        reader_error(reader, reader->block->word_span, "this normal takes more than %g steps", PIGMENT_MOST_WORK);
    return !reader->failed;
}

static const Normal *finished(Reader *reader, const NormalDraft *draft) {
    Normal *normal = arena_copy(reader->context->arena, &draft->normal, sizeof *normal);
    Pigment *pattern = arena_copy(reader->context->arena, &draft->pattern.pigment, sizeof *pattern);
    normal->pattern = pattern;
    pigment_measure(pattern);
    if (!measure(reader, normal)) return NULL;
    pigment_rehash(pattern);
    normal_rehash(normal);
    return normal;
}

/* The normal as the one entry of a map that is seen in u and v. */
static const Normal *wrapped(Reader *reader, const Normal *inner) {
    NormalDraft outer = {.pattern.pigment = pigment_default(), .normal = {.span = inner->span, .form = NORMAL_MAP, .amount = 1}};
    outer.pattern.pigment.kind = PATTERN_UV;
    add_normal(reader, &outer, inner, 0);
    set_entries(reader->context->arena, &outer);
    return finished(reader, &outer);
}

#define FIELD(name) offsetof(NormalDraft, normal.name)
static const WordRule rules[] = {
    {"bump_size", WORD_FLOAT, FIELD(amount), NULL, false},
    {"accuracy", WORD_FLOAT, FIELD(accuracy), NULL, false},
    {"no_bump_scale", WORD_FLAG, FIELD(unscaled), NULL, false},
    {"facets", WORD_CUSTOM, 0, read_facets, false},
    {"coords", WORD_FLOAT, FIELD(facet_coords), NULL, false},
    {"size", WORD_FLOAT, FIELD(facet_size), NULL, false},
    {"bump_map", WORD_CUSTOM, 0, read_bump_map, false},
    {"normal_map", WORD_CUSTOM, 0, read_normal_map, false},
    {"slope_map", WORD_CUSTOM, 0, read_slope_map, false},
    {"uv_mapping", WORD_FLAG, offsetof(NormalDraft, uv), NULL, false},
};

static NormalDraft *begin(Reader *reader) {
    NormalDraft *draft = arena_new(reader->context->arena, NormalDraft);
    draft->pattern.pigment = pigment_default();
    draft->pattern.is_normal = true;
    if (reader->context->wave_count) draft->pattern.pigment.wave_count = reader->context->wave_count;
    draft->normal = (Normal){.span = reader->block->span, .amount = 0.5, .accuracy = 0.02, .facet_size = 0.1};
    return draft;
}

/* A block that says nothing, or nothing that bends, is no normal. */
static bool is_flat(const NormalDraft *draft) {
    if (draft->normal.form == NORMAL_MAP) return draft->normals.count == 0;
    if (draft->normal.form == NORMAL_PICTURE) return !draft->pattern.pigment.image;
    return draft->normal.form == NORMAL_GRADIENT && draft->pattern.pigment.kind == PATTERN_SOLID;
}

static const Normal *normal_read(Reader *reader) {
    NormalDraft *draft = begin(reader);
    find_form(reader, draft);
    reader_add_table(reader, rules, VTS_ARRAY_COUNT(rules), draft);
    reader_add_table(reader, pattern_rules, pattern_rule_count, &draft->pattern);
    reader_add_table(reader, pattern_setting_rules, pattern_setting_rule_count, &draft->pattern);
    reader_add_table(reader, transform_rules, transform_rule_count, &draft->pattern.pigment.transform);
    reader->on_value = on_value;
    reader->value_target = draft;
    if (!reader_run(reader)) return NULL;
    Pigment *pattern = &draft->pattern.pigment;
    if (!pattern_check(reader, pattern)) return NULL;
    if (!pattern->noise_generator) pattern->noise_generator = build_noise_generator(reader->context);
    if (is_flat(draft)) draft->normal.form = NORMAL_BUMPS, draft->normal.amount = 0;
    if (draft->slopes.count) {
        sort_slopes(draft->slopes.items, draft->slopes.count);
        draft->normal.slopes = draft->slopes.items;
        draft->normal.slope_count = draft->slopes.count;
    }
    set_entries(reader->context->arena, draft);
    const Normal *normal = finished(reader, draft);
    return normal && draft->uv ? wrapped(reader, normal) : normal;
}

bool build_normal(BuildContext *context, const EvalBlock *block, Value *out) {
    Reader grammar = reader_begin(context, block), reader = reader_begin(context, block);
    if (!grammar_read(&grammar, "normal")) return false;
    const Normal *normal = normal_read(&reader);
    *out = (Value){.kind = VALUE_NORMAL, .as.normal = normal};
    return normal != NULL;
}

const Normal *normal_placed(const BuildContext *context, const Normal *normal, const Transform *t) {
    if (transform_is_identity(t)) return normal;
    Normal *placed = arena_copy(context->arena, normal, sizeof *normal);
    Pigment *pattern = arena_copy(context->arena, normal->pattern, sizeof *pattern);
    pattern->transform = transform_then(&pattern->transform, t);
    placed->pattern = pattern;
    pigment_rehash(pattern);
    normal_rehash(placed);
    return placed;
}
