/* media { … }: what glows, absorbs and scatters in the inside of objects, and between them. */
#include "eval/build_parts.h"
#include "scene/medium.h"

#include <string.h>

typedef struct MediumDraft {
    Medium medium;
    struct {
        MediumDensity *items;
        size_t count, capacity;
    } densities;
    double intervals, samples;
} MediumDraft;

/* Numbers past this would leave the range of floats. */
static const double MOST_COEFFICIENT = 1e9;

static void read_color(Reader *reader, const Word *word, Color *out) {
    Color c;
    if (word->count == 0 || !word_arguments(reader, word, 1, 1) || !word_color(reader, word, 0, &c)) return;
    if (fabs(c.red) <= MOST_COEFFICIENT && fabs(c.green) <= MOST_COEFFICIENT && fabs(c.blue) <= MOST_COEFFICIENT) *out = c;
    else reader_error(reader, word->arguments[0].span, "'%s' is greater than %g", word->text, MOST_COEFFICIENT);
}

static void read_absorption(Reader *reader, const Word *word, void *target) { read_color(reader, word, &((MediumDraft *)target)->medium.absorption); }
static void read_emission(Reader *reader, const Word *word, void *target) { read_color(reader, word, &((MediumDraft *)target)->medium.emission); }

/* ---- scattering ---- */

typedef struct ScatteringDraft {
    double eccentricity, extinction;
    Span eccentric;
} ScatteringDraft;

static void read_eccentricity(Reader *reader, const Word *word, void *target) {
    ScatteringDraft *draft = target;
    if (word_arguments(reader, word, 1, 1)) word_float(reader, word, 0, &draft->eccentricity);
    draft->eccentric = word->whole;
}

/* POV-Ray's functions are not normalised: 0.5767 (1 + 9 x⁸), 0.4957 (1 + 50 x³²) with x = (1 + µ)/2, 0.7994 (1 + µ²); isotropic light has 1. */
static void use_type(Medium *medium, int type, double eccentricity) {
    static const struct {
        PhaseKind kind;
        double power, even, gain; /* `even`: the share of light that goes everywhere alike */
    } types[] = {
        {PHASE_ISOTROPIC, 0, 0, 1},
        {PHASE_POWER, 8, 0.5, 0.576655375 / 0.5},
        {PHASE_POWER, 32, 33.0 / 83, 0.495714547 * 83 / 33},
        {PHASE_RAYLEIGH, 0, 0, 0.799372013 / 0.75},
        {PHASE_HENYEY_GREENSTEIN, 0, 0, 1},
    };
    double even = types[type - 1].even, k = type == 5 ? eccentricity : types[type - 1].power;
    medium->gain = types[type - 1].gain;
    medium->phase = (Phase){.lobes = {{types[type - 1].kind, k, 1 - even}}, .count = 1};
    if (even > 0) medium->phase.lobes[medium->phase.count++] = (PhaseLobe){PHASE_ISOTROPIC, 0, even};
}

static bool is_number(const BlockItem *item) {
    return item && item->kind == ITEM_VALUE && (item->value.kind == VALUE_FLOAT || item->value.kind == VALUE_VECTOR || item->value.kind == VALUE_COLOR);
}

static void read_scattering(Reader *reader, const Word *word, void *target) {
    static const WordRule rules[] = {
        {"eccentricity", WORD_CUSTOM, 0, read_eccentricity, false},
        {"extinction", WORD_FLOAT, offsetof(ScatteringDraft, extinction), NULL, false},
    };
    Medium *medium = &((MediumDraft *)target)->medium;
    ScatteringDraft draft = {.extinction = 1};
    double type = 1;
    Span span;
    if (!word->body) {
        reader_error(reader, word->span, "'%s' needs its block { … }", word->text);
        return;
    }
    Reader body = reader_nested(reader, word->body);
    reader_add_table(&body, rules, VTS_ARRAY_COUNT(rules), &draft);
    if (reader_float(&body, "the type of scattering", &type, &span) && !(type >= 1 && type < 6)) {
        diag_warning(body.context->diags, span, "types of scattering are 1 (isotropic), 2 and 3 (Mie), 4 (Rayleigh) and 5 (Henyey and Greenstein): %g is taken as 1", type);
        type = 1;
    }
    type = floor(type);
    const BlockItem *item = reader_peek(&body);
    if (is_number(item)) {
        const Argument color = {item->value, item->span};
        body.next++;
        read_color(&body, &(Word){.text = word->text, .span = word->span, .arguments = &color, .count = 1}, &medium->scattering);
    }
    reader_run(&body);
    if (!reader_end_nested(reader, &body)) return;
    medium->loss = double_clamp(draft.extinction, -MOST_COEFFICIENT, MOST_COEFFICIENT);
    bool possible = fabs(draft.eccentricity) < 1;
    if (type == 5 && !possible) {
        diag_warning(reader->context->diags, draft.eccentric, "an eccentricity lies between -1 and 1: light is scattered nowhere with %g", draft.eccentricity);
        medium->gain = 0;
        return;
    }
    use_type(medium, (int)type, draft.eccentricity);
}

/* ---- densities ---- */

static void read_density(Reader *reader, const Word *word, void *target) {
    MediumDraft *draft = target;
    if (!word->body) {
        reader_error(reader, word->span, "'%s' needs its block { … }", word->text);
        return;
    }
    Reader body = reader_nested(reader, word->body);
    const Pigment *pattern = density_colors_read(&body);
    if (!reader_end_nested(reader, &body) || !pattern) return;
    *list_push(reader->context->arena, &draft->densities) = (MediumDensity){pattern, transform_identity()};
}

/* Of the densities that were read before. */
static void place_densities(MediumDraft *draft, const Transform *t) {
    for (size_t i = 0; i < draft->densities.count; i++) draft->densities.items[i].place = transform_then(&draft->densities.items[i].place, t);
}

static void read_transform(Reader *reader, const Word *word, void *target) {
    Transform step = transform_identity();
    Reader one = *reader;
    one.table_count = 0;
    reader_add_table(&one, transform_rules, transform_rule_count, &step);
    reader_word(&one, word);
    reader->failed |= one.failed;
    place_densities(target, &step);
}

static bool on_value(Reader *reader, const Argument *value, void *target) {
    Transform step = transform_identity();
    (void)reader;
    if (!take_transform(value, &step)) return false;
    place_densities(target, &step);
    return true;
}

/* ---- the block ---- */

static void read_base(Reader *reader, const Word *word, void *target);

static void read_samples(Reader *reader, const Word *word, void *target) {
    MediumDraft *draft = target;
    double *number = word->text[0] == 'i' ? &draft->intervals : &draft->samples;
    if (word_arguments(reader, word, 1, 2)) word_float(reader, word, 0, number);
}

/* How POV-Ray takes its samples: here errors decide. */
#define IGNORED(word) {word, WORD_IGNORED, 0, NULL, false}
static const WordRule rules[] = {
    {"media", WORD_CUSTOM, 0, read_base, false},
    {"absorption", WORD_CUSTOM, 0, read_absorption, false},
    {"emission", WORD_CUSTOM, 0, read_emission, false},
    {"scattering", WORD_CUSTOM, 0, read_scattering, false},
    {"density", WORD_CUSTOM, 0, read_density, false},
    {"intervals", WORD_CUSTOM, 0, read_samples, false},
    {"samples", WORD_CUSTOM, 0, read_samples, false},
    {"translate", WORD_CUSTOM, 0, read_transform, false},
    {"rotate", WORD_CUSTOM, 0, read_transform, false},
    {"scale", WORD_CUSTOM, 0, read_transform, false},
    {"matrix", WORD_CUSTOM, 0, read_transform, false},
    {"transform", WORD_CUSTOM, 0, read_transform, false},
    IGNORED("method"), IGNORED("confidence"), IGNORED("variance"), IGNORED("ratio"),
    IGNORED("aa_threshold"), IGNORED("aa_level"), IGNORED("jitter"), IGNORED("collect"),
};

static bool read_into(Reader *parent, const EvalBlock *block, MediumDraft *draft) {
    Reader reader = reader_nested(parent, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), draft);
    reader.on_value = on_value;
    reader.value_target = draft;
    reader_run(&reader);
    return reader_end_nested(parent, &reader);
}

/* A declared medium comes first, and the block changes it. */
static void read_base(Reader *reader, const Word *word, void *target) {
    if (word->body) read_into(reader, word->body, target);
}

bool medium_read(Reader *parent, const EvalBlock *block, Medium *out) {
    MediumDraft draft = {.medium = {.span = block->span, .loss = 1, .gain = 1}};
    use_type(&draft.medium, 1, 0);
    if (!read_into(parent, block, &draft)) return false;
    draft.medium.densities = draft.densities.items;
    draft.medium.density_count = draft.densities.count;
    draft.medium.samples = double_clamp(double_max(draft.intervals, 1) * draft.samples, 0, 1e6);
    *out = draft.medium;
    return true;
}

MediaList media_joined(Arena *arena, MediaList list, const Medium *medium) {
    Medium *items = arena_new_array(arena, Medium, list.count + 1);
    for (size_t i = 0; i < list.count; i++) items[i] = list.items[i];
    items[list.count] = *medium;
    return (MediaList){items, list.count + 1};
}

const Interior *interior_placed(const BuildContext *context, const Interior *interior, const Transform *t) {
    if (!interior || !interior->media.count || transform_is_identity(t)) return interior;
    Interior *placed = arena_copy(context->arena, interior, sizeof *interior);
    Medium *media = arena_copy(context->arena, interior->media.items, interior->media.count * sizeof *media);
    for (size_t i = 0; i < interior->media.count; i++) {
        MediumDensity *densities = arena_new_array(context->arena, MediumDensity, media[i].density_count);
        for (size_t k = 0; k < media[i].density_count; k++)
            densities[k] = (MediumDensity){media[i].densities[k].pattern, transform_then(&media[i].densities[k].place, t)};
        media[i].densities = densities;
    }
    placed->media.items = media;
    interior_rehash(placed);
    return placed;
}
