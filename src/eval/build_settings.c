/* global_settings { … }: POV-Ray's words, and the knobs of accuracy. */
#include "eval/build_parts.h"
#include "scene/knobs.h"

#include <string.h>

typedef struct SettingsDraft {
    GlobalSettings settings;
    const InertNote *inert;
} SettingsDraft;

/* A knob with named values: `detail auto` (two words) or `detail "auto"`. */
static bool knob_value(Reader *reader, const Word *word, const char **value, Span *span) {
    const BlockItem *item = reader_peek(reader);
    Word next;
    if (word->count) {
        *span = word->arguments[0].span;
        return word_string(reader, word, 0, value);
    }
    if (!item || !item_as_word(item, &next) || next.count || next.body) {
        reader_error(reader, word->span, "'%s' needs a name", word->text);
        return false;
    }
    reader->next++;
    *value = next.text;
    *span = next.span;
    return true;
}

static void read_knob(Reader *reader, const Word *word, void *target) {
    const NamedKnob *knob = named_knob_find(word->text);
    const char *value;
    Span span;
    if (!knob_value(reader, word, &value, &span)) return;
    const char *known = named_knob_value(knob, value);
    if (known) {
        named_knob_set(knob, &((SettingsDraft *)target)->settings, known);
        return;
    }
    Diagnostic *d = reader_error(reader, span, "'%s' is no '%s'", value, word->text);
    StrBuf list = {0};
    for (const char *const *v = knob->values; *v; v++) strbuf_addf(&list, "%s%s", v == knob->values ? "" : ", ", *v);
    diag_hint(reader->context->diags, d, "it is one of %s", list.data);
    strbuf_free(&list);
}

static void read_samples(Reader *reader, const Word *word, void *target) {
    int samples;
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, &samples)) return;
    if (samples >= 1 && samples <= 256)
        ((SettingsDraft *)target)->settings.samples = samples;
    else
        reader_error(reader, word->arguments[0].span, "'samples' must lie between 1 and 256, found %d",
                     samples);
}

static void read_gamma(Reader *reader, const Word *word, void *target) {
    SettingsDraft *draft = target;
    Word next;
    if (word->count == 0 && reader_take_word(reader, "srgb", &next))
        draft->settings.assumed_gamma = GAMMA_SRGB;
    else if (word_arguments(reader, word, 1, 1) && word_float(reader, word, 0, &draft->settings.assumed_gamma) && !(draft->settings.assumed_gamma > 0))
        reader_error(reader, word->whole, "'assumed_gamma' must be greater than 0");
    reader->context->assumed_gamma = draft->settings.assumed_gamma;
}

static void read_charset(Reader *reader, const Word *word, void *target) {
    (void)target;
    Word name;
    if (!reader_take_word(reader, "utf8", &name) && !reader_take_word(reader, "ascii", &name) &&
        !reader_take_word(reader, "sys", &name))
        reader_expect_word(reader, word, "ascii, utf8 or sys");
}

/* Patterns and functions that come after it in the text. */
static void read_noise_generator(Reader *reader, const Word *word, void *target) {
    (void)target;
    int generator;
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, &generator)) return;
    if (generator < 1 || generator > 3)
        reader_error(reader, word->arguments[0].span, "'noise_generator' is 1, 2 or 3");
    else
        reader->context->noise_generator = generator;
}

static void read_wave_count(Reader *reader, const Word *word, void *target) {
    (void)target;
    int count;
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, &count)) return;
    reader->context->wave_count = int_clamp(count, 1, 10000);
}

static void read_irid_wavelength(Reader *reader, const Word *word, void *target) {
    Color color;
    if (word_arguments(reader, word, 1, 1) && word_color(reader, word, 0, &color))
        ((SettingsDraft *)target)->settings.irid_wavelength = vec3(color.red, color.green, color.blue);
}

/* What only tunes POV-Ray's own search for light: checked, and without effect. */
static void read_tuning(Reader *reader, const Word *word, void *target) {
    (void)target;
    grammar_word(reader, word);
}

static void read_radiosity(Reader *reader, const Word *word, void *target) {
#define TUNING(word)                                                                                         \
    { word, WORD_CUSTOM, 0, read_tuning, false }
    static const WordRule rules[] = {
        {"brightness", WORD_FLOAT, offsetof(Radiosity, brightness), NULL, false},
        {"gray_threshold", WORD_FLOAT, offsetof(Radiosity, gray_threshold), NULL, false},
        {"max_sample", WORD_FLOAT, offsetof(Radiosity, max_sample), NULL, false},
        {"recursion_limit", WORD_INT, offsetof(Radiosity, bounces), NULL, false},
        {"normal", WORD_FLAG, offsetof(Radiosity, bumps), NULL, false},
        {"media", WORD_FLAG, offsetof(Radiosity, media), NULL, false},
        TUNING("adc_bailout"), TUNING("always_sample"), TUNING("count"), TUNING("error_bound"), TUNING("low_error_factor"),
        TUNING("maximum_reuse"), TUNING("minimum_reuse"), TUNING("nearest_count"), TUNING("pretrace_end"),
        TUNING("pretrace_start"), TUNING("subsurface"), TUNING("load_file"), TUNING("save_file"),
    };
    Radiosity *radiosity = &((SettingsDraft *)target)->settings.radiosity;
    if (!word->body) {
        reader_error(reader, word->span, "'%s' needs its block { … }", word->text);
        return;
    }
    Reader body = reader_nested(reader, word->body);
    reader_add_table(&body, rules, VTS_ARRAY_COUNT(rules), radiosity);
    reader_run(&body);
    reader_end_nested(reader, &body);
    radiosity->on = true;
    radiosity->with_ambient = reader->context->old_gamma;
    radiosity->gray_threshold = double_clamp(radiosity->gray_threshold, 0, 1);
    radiosity->max_sample = fmax(radiosity->max_sample, 0);
    radiosity->bounces = int_clamp(radiosity->bounces, 1, 20);
}

#define FIELD(name) offsetof(SettingsDraft, settings.name)
#define KNOB(word)                                                                                           \
    { word, WORD_CUSTOM, 0, read_knob, true }
#define IGNORED(word)                                                                                        \
    { word, WORD_IGNORED, 0, NULL, false }
#define INERT(word)                                                                                          \
    { word, WORD_INERT, offsetof(SettingsDraft, inert), NULL, false }
static const WordRule rules[] = {
    {"max_error", WORD_POSITIVE, FIELD(max_error), NULL, true},
    {"ambient_light", WORD_COLOR, FIELD(ambient_light), NULL, false},
    {"assumed_gamma", WORD_CUSTOM, 0, read_gamma, false},
    {"max_trace_level", WORD_INT, FIELD(max_trace_level), NULL, false},
    {"samples", WORD_CUSTOM, 0, read_samples, true},
    {"shadow_aperture", WORD_POSITIVE, FIELD(shadow_aperture), NULL, true},
    KNOB("opacity_model"),
    KNOB("ray_path"),
    KNOB("quadrature"),
    KNOB("filtering"),
    KNOB("detail"),
    {"sky_light", WORD_FLAG, FIELD(sky_light), NULL, false},
    {"geo_origin", WORD_CUSTOM, 0, settings_read_origin, true},
    {"radiosity", WORD_CUSTOM, 0, read_radiosity, false},
    INERT("photons"),
    INERT("subsurface"),
    INERT("mm_per_unit"),
    {"adc_bailout", WORD_FLOAT, FIELD(adc_bailout), NULL, false},
    IGNORED("hf_gray_16"),
    {"irid_wavelength", WORD_CUSTOM, 0, read_irid_wavelength, false},
    {"charset", WORD_CUSTOM, 0, read_charset, false},
    IGNORED("max_intersections"),
    {"noise_generator", WORD_CUSTOM, 0, read_noise_generator, false},
    {"number_of_waves", WORD_CUSTOM, 0, read_wave_count, false},
};

bool settings_read(BuildContext *context, const EvalBlock *block, GlobalSettings *settings) {
    SettingsDraft draft = {.settings = *settings};
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), &draft);
    if (!reader_run(&reader)) return false;
    for (const InertNote *note = draft.inert; note; note = note->next)
        diag_warning(context->diags, note->span, "'%s' is not modelled yet: it has no effect", note->word);
    *settings = draft.settings;
    return true;
}
