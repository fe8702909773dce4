/* interior { … }: what light meets inside of an object. */
#include "eval/build_parts.h"
#include "scene/medium.h"

#define FIELD(name) offsetof(Interior, name)

/* A ray cannot be bent by a negative index, nor by none. */
static void read_ior(Reader *reader, const Word *word, void *target) {
    double ior;
    if (!word_arguments(reader, word, 1, 1) || !word_float(reader, word, 0, &ior)) return;
    if (!(ior > 0)) {
        diag_warning(reader->context->diags, word->arguments[0].span, "an index of refraction is positive: %g is taken as 1", ior);
        ior = 1;
    }
    ((Interior *)target)->ior = ior;
}

/* Kept, and light is not yet parted into its colours. */
static void read_dispersion(Reader *reader, const Word *word, void *target) {
    Interior *interior = target;
    if (!word_arguments(reader, word, 1, 1) || !word_float(reader, word, 0, &interior->dispersion)) return;
    if (!(interior->dispersion > 0)) reader_error(reader, word->arguments[0].span, "'%s' must be greater than 0, found %g", word->text, interior->dispersion);
    else if (interior->dispersion != 1) inert_add(reader->context, &interior->inert, word->text, word->span);
}

static void read_samples(Reader *reader, const Word *word, void *target) {
    enum { MOST_DISPERSION_SAMPLES = 1000 };
    int samples;
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, &samples)) return;
    ((Interior *)target)->dispersion_samples = int_clamp(samples, 2, MOST_DISPERSION_SAMPLES);
}

static void read_media(Reader *reader, const Word *word, void *target) {
    Interior *interior = target;
    Medium medium;
    if (!word->body) reader_error(reader, word->span, "'%s' needs its block { … }", word->text);
    else if (medium_read(reader, word->body, &medium)) interior->media = media_joined(reader->context->arena, interior->media, &medium);
}

static const WordRule rules[] = {
    {"ior", WORD_CUSTOM, 0, read_ior, false},
    {"caustics", WORD_FLOAT, FIELD(caustics), NULL, false},
    {"dispersion", WORD_CUSTOM, 0, read_dispersion, false},
    {"dispersion_samples", WORD_CUSTOM, 0, read_samples, false},
    {"fade_distance", WORD_FLOAT, FIELD(fade_distance), NULL, false},
    {"fade_power", WORD_FLOAT, FIELD(fade_power), NULL, false},
    {"fade_color", WORD_COLOR, FIELD(fade_color), NULL, false},
    {"fade_colour", WORD_COLOR, FIELD(fade_color), NULL, false},
    {"refraction", WORD_IGNORED, 0, NULL, false},
    {"media", WORD_CUSTOM, 0, read_media, false},
};

/* A declared interior comes first, and the block changes it. */
static bool on_value(Reader *reader, const Argument *value, void *target) {
    if (value->value.kind != VALUE_INTERIOR || reader->next > 1) return false;
    *(Interior *)target = *value->value.as.interior;
    return true;
}

bool build_interior(BuildContext *context, const EvalBlock *block, Value *out) {
    Interior *interior = arena_new(context->arena, Interior);
    *interior = interior_default();
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), interior);
    reader.on_value = on_value;
    reader.value_target = interior;
    if (!grammar_read(&reader, "interior")) return false;
    reader.next = 0;
    if (!reader_run(&reader)) return false;
    interior->span = block->span;
    interior_rehash(interior);
    *out = (Value){.kind = VALUE_INTERIOR, .as.interior = interior};
    return true;
}
