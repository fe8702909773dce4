/* density { … } in a layer of a texel or in a volume: numbers of place, from a grid, a function or any pattern. */
#include "eval/build_pattern.h"

#include <string.h>

typedef struct DensityDraft {
    PigmentDraft pattern;
    DensityField field;
    Span source; /* the word that says where the numbers come from; begin = end: none yet */
    EvalDensityRequest raw;
    const char *name; /* of a file that is read at the end of the block */
    Span name_span;
    Span grid_span;
} DensityDraft;

static bool begin_source(Reader *reader, DensityDraft *draft, Span span) {
    if (draft->source.end > draft->source.begin) {
        reader_error(reader, span, "where the numbers of a density come from is said once");
        return false;
    }
    draft->source = span;
    return true;
}

/* NULL: it was refused. What says where it lies is not laid into the block's bounds. */
static void use_grid(DensityDraft *draft, const DensityGrid *grid) {
    draft->pattern.pigment.kind = PATTERN_DENSITY;
    draft->pattern.pigment.density = grid;
    draft->field.in_bounds = !(grid && grid->placed);
    if (draft->field.in_bounds) return;
    Transform place = transform_of(&grid->place);
    draft->pattern.pigment.transform = transform_then(&place, &draft->pattern.pigment.transform);
}

static void read_df3(Reader *reader, const Word *word, void *target) {
    DensityDraft *draft = target;
    const char *name;
    if (!begin_source(reader, draft, word->span) || !word_arguments(reader, word, 1, 1) || !word_string(reader, word, 0, &name)) return;
    const DensityGrid *grid = density_load(reader->context, name, word->arguments[0].span);
    use_grid(draft, grid);
    reader->failed |= !grid;
}

/* The kind of number and the order of bytes may follow: the file is read at the end of the block. */
static void read_raw(Reader *reader, const Word *word, void *target) {
    DensityDraft *draft = target;
    Vec3 size;
    if (!begin_source(reader, draft, word->span) || !word_arguments(reader, word, 2, 2) || !word_string(reader, word, 0, &draft->name) ||
        !word_vector(reader, word, 1, &size))
        return;
    draft->name_span = word->arguments[0].span;
    draft->raw.raw = true;
    for (int k = 0; k < 3; k++) {
        double side = vec3_get(size, k);
        if (!(side >= 1 && side <= 65536 && side == floor(side))) {
            reader_error(reader, word->arguments[1].span, "a grid of <%g, %g, %g> cells makes no sense", size.x, size.y, size.z);
            return;
        }
        draft->raw.size[k] = (int)side;
    }
}

static void read_kind(Reader *reader, const Word *word, void *target) {
    DensityDraft *draft = target;
    if (!word_arguments(reader, word, 0, 0)) return;
    switch (word->text[0]) {
    case 'u': draft->raw.bytes = strcmp(word->text, "uint8") == 0 ? 1 : 2; break;
    case 'f': draft->raw.bytes = 4; break;
    default: draft->raw.big = word->text[0] == 'b';
    }
}

static void read_nanovdb(Reader *reader, const Word *word, void *target) {
    DensityDraft *draft = target;
    if (!begin_source(reader, draft, word->span) || !word_arguments(reader, word, 1, 1) || !word_string(reader, word, 0, &draft->name)) return;
    draft->name_span = word->arguments[0].span;
    draft->raw.nanovdb = true;
}

static void read_grid_name(Reader *reader, const Word *word, void *target) {
    DensityDraft *draft = target;
    if (word_arguments(reader, word, 1, 1) && word_string(reader, word, 0, &draft->raw.grid)) draft->grid_span = word->span;
}

/* ---- fractal { … } ---- */

typedef struct FractalDraft {
    Vec3 size;
    double dimension, threshold;
    int seed;
} FractalDraft;

#define FIELD(name) offsetof(FractalDraft, name)
static const WordRule fractal_rules[] = {
    {"size", WORD_VECTOR, FIELD(size), NULL, true},
    {"dimension", WORD_FLOAT, FIELD(dimension), NULL, true},
    {"threshold", WORD_FLOAT, FIELD(threshold), NULL, true},
    {"seed", WORD_INT, FIELD(seed), NULL, true},
};

static void read_fractal(Reader *reader, const Word *word, void *target) {
    DensityDraft *draft = target;
    FractalDraft fractal = {{64, 64, 64}, 2.4, 0.45, 0};
    if (!begin_source(reader, draft, word->span)) return;
    if (!word->body) {
        reader_error(reader, word->span, "'%s' needs its block { … }", word->text);
        return;
    }
    Reader body = reader_nested(reader, word->body);
    reader_add_table(&body, fractal_rules, VTS_ARRAY_COUNT(fractal_rules), &fractal);
    reader_run(&body);
    EvalDensityRequest request = {.fractal = true, .dimension = fractal.dimension, .threshold = fractal.threshold, .seed = (uint32_t)fractal.seed};
    double cells = 1;
    for (int k = 0; k < 3; k++) {
        double side = vec3_get(fractal.size, k);
        cells *= side;
        if (!(side >= 1 && side <= 4096 && side == floor(side)))
            reader_error(&body, word->span, "a grid of <%g, %g, %g> cells makes no sense", fractal.size.x, fractal.size.y, fractal.size.z);
        request.size[k] = (int)double_clamp(side, 1, 4096);
    }
    if (!(fractal.dimension >= 2 && fractal.dimension <= 3) || !(fractal.threshold >= 0 && fractal.threshold < 1))
        reader_error(&body, word->span, "the dimension of a fractal lies between 2 and 3, its threshold between 0 and 1");
    if (!reader_end_nested(reader, &body) || !reader_mesh_fits(reader, word->span, cells)) return;
    const DensityGrid *grid = density_grid_load(reader->context, NULL, word->span, &request);
    reader->failed |= !grid;
    if (grid) use_grid(draft, grid);
}

/* ---- the block ---- */

static void read_threshold(Reader *reader, const Word *word, void *target) {
    DensityField *field = &((DensityDraft *)target)->field;
    if (!word_arguments(reader, word, 2, 2) || !word_float(reader, word, 0, &field->low) || !word_float(reader, word, 1, &field->high)) return;
    field->has_threshold = true;
    if (!(field->low < field->high))
        reader_error(reader, word->arguments[1].span, "the upper threshold must be above the lower, found %g and %g", field->low, field->high);
}

#undef FIELD
static const WordRule rules[] = {
    {"df3", WORD_CUSTOM, 0, read_df3, false},
    {"raw", WORD_CUSTOM, 0, read_raw, false},
    {"uint8", WORD_CUSTOM, 0, read_kind, false},
    {"uint16", WORD_CUSTOM, 0, read_kind, false},
    {"float", WORD_CUSTOM, 0, read_kind, false},
    {"little", WORD_CUSTOM, 0, read_kind, false},
    {"big", WORD_CUSTOM, 0, read_kind, false},
    {"nanovdb", WORD_CUSTOM, 0, read_nanovdb, false},
    {"grid", WORD_CUSTOM, 0, read_grid_name, true},
    {"fractal", WORD_CUSTOM, 0, read_fractal, false},
    {"threshold", WORD_CUSTOM, 0, read_threshold, true},
    {"extinction", WORD_POSITIVE, offsetof(DensityDraft, field.extinction), NULL, true},
};

static bool on_value(Reader *reader, const Argument *value, void *target) {
    DensityDraft *draft = target;
    if (value->value.kind != VALUE_FUNCTION) return take_transform(value, &draft->pattern.pigment.transform);
    if (begin_source(reader, draft, value->span) &&
        argument_function(reader, value, "'density'", 3, 1, &draft->pattern.pigment.function))
        draft->pattern.pigment.kind = PATTERN_FUNCTION;
    return true;
}

/* Any pattern of pigments will do, too. */
static bool has_source(const DensityDraft *draft) {
    return draft->source.end > draft->source.begin || draft->pattern.pigment.kind != PATTERN_SOLID;
}

static void rehash(DensityField *field) {
    const double numbers[] = {field->low, field->high, field->extinction, field->in_bounds, field->has_threshold};
    field->hash = hash_begin(0x64656e73);
    hash_add_hash(&field->hash, field->pattern->hash);
    hash_add(&field->hash, numbers, sizeof numbers);
}

const DensityField *density_read(Reader *parent, const EvalBlock *block) {
    BuildContext *context = parent->context;
    DensityDraft *draft = arena_new(context->arena, DensityDraft);
    Pigment *pigment = &draft->pattern.pigment;
    *pigment = pigment_default();
    pigment->span = draft->field.span = block->span;
    draft->field.low = 0, draft->field.high = 1, draft->field.extinction = 64;
    draft->raw.bytes = 1;
    Reader reader = reader_nested(parent, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), draft);
    reader_add_table(&reader, pattern_rules, pattern_rule_count, &draft->pattern);
    reader_add_table(&reader, pattern_setting_rules, pattern_setting_rule_count, &draft->pattern);
    reader_add_table(&reader, transform_rules, transform_rule_count, &pigment->transform);
    reader.on_value = on_value;
    reader.value_target = draft;
    reader_run(&reader);
    if (!reader.failed && !has_source(draft)) reader_error(&reader, block->word_span, "this density has no numbers: it needs a file, a function or a pattern");
    if (!reader.failed && draft->raw.grid && !draft->raw.nanovdb) reader_error(&reader, draft->grid_span, "'grid' names a grid of a 'nanovdb' file");
    if (!reader.failed && draft->name) {
        const DensityGrid *grid = density_grid_load(context, draft->name, draft->name_span, &draft->raw);
        reader.failed |= !grid;
        if (grid) use_grid(draft, grid);
    }
    if (!reader.failed) pattern_check(&reader, pigment);
    if (!reader_end_nested(parent, &reader)) return NULL;
    if (!pigment->noise_generator) pigment->noise_generator = build_noise_generator(context);
    pigment_measure(pigment);
    pigment_rehash(pigment);
    draft->field.pattern = pigment;
    rehash(&draft->field);
    return &draft->field;
}
