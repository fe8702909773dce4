/* volume { … }: clouds, haze and smoke. */
#include "eval/build_parts.h"
#include "scene/scene_bounds.h"
#include "scene/volumes.h"

#include <string.h>

typedef struct VolumeDraft {
    ObjectDraft common;
    Volume volume;
} VolumeDraft;

/* Numbers past this make no sense and would leave the range of floats. */
static const double MOST_COEFFICIENT = 1e9, MOST_RAYS = 1e7;

static bool is_in_range(double x, double low, double high) { return x >= low && x <= high; }

static void read_color(Reader *reader, const Word *word, Color *out) {
    if (!word_arguments(reader, word, 1, 1) || !word_color(reader, word, 0, out)) return;
    if (!is_in_range(out->red, 0, MOST_COEFFICIENT) || !is_in_range(out->green, 0, MOST_COEFFICIENT) || !is_in_range(out->blue, 0, MOST_COEFFICIENT))
        reader_error(reader, word->arguments[0].span, "'%s' must not be negative, nor greater than %g", word->text, MOST_COEFFICIENT);
}

static void read_scattering(Reader *reader, const Word *word, void *target) { read_color(reader, word, &((VolumeDraft *)target)->volume.scattering); }
static void read_absorption(Reader *reader, const Word *word, void *target) { read_color(reader, word, &((VolumeDraft *)target)->volume.absorption); }

/* A number, or a word in its place (0 then). */
static bool read_number_or(Reader *reader, const Word *word, const char *instead, double least, double most, double *out) {
    Word next;
    *out = 0;
    if (word->count == 0 && reader_take_word(reader, instead, &next)) return true;
    if (!word_arguments(reader, word, 1, 1) || !word_float(reader, word, 0, out)) return false;
    if (is_in_range(*out, least, most)) return true;
    reader_error(reader, word->arguments[0].span, "'%s' lies between %g and %g, or is '%s'", word->text, least, most, instead);
    return false;
}

static void read_orders(Reader *reader, const Word *word, void *target) {
    double orders;
    if (!read_number_or(reader, word, "all", 1, 1e6, &orders)) return;
    if (orders != floor(orders)) reader_error(reader, word->arguments[0].span, "'orders' takes a whole number or 'all'");
    ((VolumeDraft *)target)->volume.orders = (int)orders;
}

static void read_rays(Reader *reader, const Word *word, void *target) {
    read_number_or(reader, word, "auto", 1, MOST_RAYS, &((VolumeDraft *)target)->volume.rays);
}

static void read_step(Reader *reader, const Word *word, void *target) {
    read_number_or(reader, word, "auto", 1e-9, 1e9, &((VolumeDraft *)target)->volume.step);
}

/* The number of the word that follows. */
static int read_choice(Reader *reader, const Word *word, const char *const *words, int count, const char *all) {
    Word next;
    for (int i = 0; i < count && word->count == 0; i++)
        if (reader_take_word(reader, words[i], &next)) return i;
    reader_expect_word(reader, word, all);
    return 0;
}

static void read_method(Reader *reader, const Word *word, void *target) {
    static const char *const words[] = {"two_pass", "published", "path"};
    VolumeDraft *draft = target;
    draft->volume.method = (VolumeMethod)read_choice(reader, word, words, 3, "two_pass, published or path");
}

static void read_storage(Reader *reader, const Word *word, void *target) {
    static const char *const words[] = {"auto", "isotropic", "directional"};
    ((VolumeDraft *)target)->volume.storage = (VolumeStorage)read_choice(reader, word, words, 3, "isotropic, directional or auto");
}

static void read_density(Reader *reader, const Word *word, void *target) {
    VolumeDraft *draft = target;
    if (!word->body) {
        reader_error(reader, word->span, "'%s' needs its block { … }", word->text);
        return;
    }
    const DensityField *field = density_read(reader, word->body);
    if (!field) return;
    if (draft->volume.density) reader_error(reader, word->span, "a volume holds one density");
    if (field->unmodelled) inert_add(reader->context, &draft->common.rest.inert, field->unmodelled, word->span);
    const DensityGrid *grid = field->pattern->density;
    if (grid && grid->bad)
        reader_error(reader, word->span, "cell <%zu, %zu, %zu> of this density is negative or not a number", (grid->bad - 1) % (size_t)grid->size[0],
                     (grid->bad - 1) / (size_t)grid->size[0] % (size_t)grid->size[1], (grid->bad - 1) / (size_t)grid->size[0] / (size_t)grid->size[1]);
    draft->volume.density = field;
}

/* ---- phase { … } ---- */

typedef struct PhaseDraft {
    Phase *phase;
    double share; /* of the lobes that are read, of the whole */
    int depth;
} PhaseDraft;

static bool add_lobe(Reader *reader, const Word *word, const PhaseDraft *draft, PhaseKind kind, double k, double weight) {
    if (draft->phase->count == PHASE_MOST_LOBES) {
        reader_error(reader, word->span, "a phase function has at most %d parts", PHASE_MOST_LOBES);
        return false;
    }
    if (weight * draft->share > 0) draft->phase->lobes[draft->phase->count++] = (PhaseLobe){kind, k, weight * draft->share};
    return true;
}

static void read_simple(Reader *reader, const Word *word, void *target) {
    const PhaseDraft *draft = target;
    double power = word->text[0] == 'h' ? 8 : 32;
    if (!word_arguments(reader, word, 0, 0)) return;
    if (word->text[0] == 'i') add_lobe(reader, word, draft, PHASE_ISOTROPIC, 0, 1);
    else if (word->text[0] == 'r') add_lobe(reader, word, draft, PHASE_RAYLEIGH, 0, 1);
    else if (add_lobe(reader, word, draft, PHASE_ISOTROPIC, 0, 0.5)) add_lobe(reader, word, draft, PHASE_POWER, power, 0.5);
}

static bool read_eccentricity(Reader *reader, const Word *word, size_t i, double *k) {
    if (!word_float(reader, word, i, k)) return false;
    if (*k > -1 && *k < 1) return true;
    reader_error(reader, word->arguments[i].span, "the eccentricity of a phase function lies between -1 and 1, both excluded");
    return false;
}

static void read_henyey_greenstein(Reader *reader, const Word *word, void *target) {
    double g;
    if (word_arguments(reader, word, 1, 1) && read_eccentricity(reader, word, 0, &g)) add_lobe(reader, word, target, PHASE_HENYEY_GREENSTEIN, g, 1);
}

static void read_schlick(Reader *reader, const Word *word, void *target) {
    double share = 1, k, second = 0;
    if (!word_arguments(reader, word, 1, 3)) return;
    if (word->count == 2) {
        reader_error(reader, word->whole, "'schlick' takes K, or R, K, K2");
        return;
    }
    if (word->count == 1) {
        if (read_eccentricity(reader, word, 0, &k)) add_lobe(reader, word, target, PHASE_SCHLICK, k, 1);
        return;
    }
    if (!word_float(reader, word, 0, &share) || !read_eccentricity(reader, word, 1, &k) || !read_eccentricity(reader, word, 2, &second)) return;
    if (!is_in_range(share, 0, 1)) reader_error(reader, word->arguments[0].span, "the share of the first lobe lies between 0 and 1");
    else if (add_lobe(reader, word, target, PHASE_SCHLICK, k, share)) add_lobe(reader, word, target, PHASE_SCHLICK, second, 1 - share);
}

static bool read_phase_body(Reader *parent, const Word *word, const PhaseDraft *draft);

typedef struct SumDraft {
    const PhaseDraft *outer;
    double weight; /* of the phase that follows; < 0: none given */
    double total;
} SumDraft;

static bool on_weight(Reader *reader, const Argument *value, void *target) {
    SumDraft *sum = target;
    if (!argument_float(reader, value, "a weight", &sum->weight)) return true;
    if (!is_in_range(sum->weight, 0, 1e9)) reader_error(reader, value->span, "a weight must not be negative");
    return true;
}

static void read_part(Reader *reader, const Word *word, void *target) {
    SumDraft *sum = target;
    if (sum->weight < 0) {
        reader_error(reader, word->span, "a weight stands before each phase of a sum");
        return;
    }
    PhaseDraft part = *sum->outer;
    part.share *= sum->weight;
    part.depth++;
    sum->total += sum->weight;
    sum->weight = -1;
    read_phase_body(reader, word, &part);
}

enum { DEEPEST_SUM = 8 };

static void read_sum(Reader *reader, const Word *word, void *target) {
    static const WordRule rules[] = {{"phase", WORD_CUSTOM, 0, read_part, false}};
    const PhaseDraft *draft = target;
    SumDraft sum = {draft, -1, 0};
    int first = draft->phase->count;
    if (!word->body || draft->depth > DEEPEST_SUM) {
        reader_error(reader, word->span, word->body ? "sums of phase functions are too deep" : "'sum' needs { weight phase { … } … }");
        return;
    }
    Reader body = reader_nested(reader, word->body);
    reader_add_table(&body, rules, VTS_ARRAY_COUNT(rules), &sum);
    body.on_value = on_weight;
    body.value_target = &sum;
    reader_run(&body);
    if (!reader_end_nested(reader, &body)) return;
    if (!(sum.total > 0)) {
        reader_error(reader, word->span, "the weights of a sum must not all be 0");
        return;
    }
    for (int i = first; i < draft->phase->count; i++) draft->phase->lobes[i].weight /= sum.total;
}

static bool read_phase_body(Reader *parent, const Word *word, const PhaseDraft *draft) {
    static const WordRule rules[] = {
        {"isotropic", WORD_CUSTOM, 0, read_simple, false},
        {"rayleigh", WORD_CUSTOM, 0, read_simple, false},
        {"hazy", WORD_CUSTOM, 0, read_simple, false},
        {"murky", WORD_CUSTOM, 0, read_simple, false},
        {"henyey_greenstein", WORD_CUSTOM, 0, read_henyey_greenstein, false},
        {"schlick", WORD_CUSTOM, 0, read_schlick, false},
        {"sum", WORD_CUSTOM, 0, read_sum, false},
    };
    PhaseDraft own = *draft;
    if (!word->body) {
        reader_error(parent, word->span, "'%s' needs its block { … }", word->text);
        return false;
    }
    Reader body = reader_nested(parent, word->body);
    reader_add_table(&body, rules, VTS_ARRAY_COUNT(rules), &own);
    size_t items = word->body->count;
    if (reader_run(&body) && items != 1) reader_error(&body, word->span, "a phase is one function: several are added by 'sum'");
    return reader_end_nested(parent, &body);
}

static void read_phase(Reader *reader, const Word *word, void *target) {
    VolumeDraft *draft = target;
    draft->volume.phase.count = 0;
    read_phase_body(reader, word, &(PhaseDraft){&draft->volume.phase, 1, 0});
}

/* ---- the block ---- */

static const WordRule rules[] = {
    {"density", WORD_CUSTOM, 0, read_density, false},
    {"scattering", WORD_CUSTOM, 0, read_scattering, true},
    {"absorption", WORD_CUSTOM, 0, read_absorption, true},
    {"phase", WORD_CUSTOM, 0, read_phase, true},
    {"orders", WORD_CUSTOM, 0, read_orders, true},
    {"rays", WORD_CUSTOM, 0, read_rays, true},
    {"step", WORD_CUSTOM, 0, read_step, true},
    {"method", WORD_CUSTOM, 0, read_method, true},
    {"storage", WORD_CUSTOM, 0, read_storage, true},
};

static bool on_value(Reader *reader, const Argument *value, void *target) {
    VolumeDraft *draft = target;
    if (value->value.kind != VALUE_OBJECT) return object_on_value(reader, value, &draft->common);
    const Object *object = value->value.as.object;
    Box3 bounds = object_bounds(object);
    if (draft->volume.container) {
        reader_error(reader, value->span, "a volume fills one box or object");
    } else if (object->kind == OBJECT_UNMODELLED || object->kind == OBJECT_TEXEL || object->kind == OBJECT_VOLUME || object->kind == OBJECT_SURFACE) {
        reader_error(reader, value->span, "a volume fills a solid, not %s", object_word(object));
    } else if (object->kind != OBJECT_SOLID && !(vec3_is_finite(bounds.min) && vec3_is_finite(bounds.max))) {
        reader_error(reader, value->span, "what a volume fills must have bounds");
    }
    draft->volume.container = object;
    return true;
}

static bool is_copy(const EvalBlock *block) { return object_is_copy(block) && block->items[0].value.as.object->kind == OBJECT_VOLUME; }

static bool is_black(Color c) { return c.red == 0 && c.green == 0 && c.blue == 0; }

bool build_volume(BuildContext *context, const EvalBlock *block, Value *out) {
    if (is_copy(block)) return build_object(context, block, out);
    VolumeDraft draft = {.common = object_begin(block, OBJECT_VOLUME), .volume = {.span = block->span}};
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), &draft);
    reader.on_value = on_value;
    reader.value_target = &draft;
    if (!object_read(&reader, &draft.common)) return false;
    if (!draft.volume.container) {
        reader_error(&reader, block->word_span, "'volume' needs a box { … } or an object that it fills");
        return false;
    }
    if (is_black(draft.volume.scattering) && is_black(draft.volume.absorption))
        diag_warning(context->diags, block->word_span, "this volume neither scatters nor absorbs: it is not seen");
    Volume *volume = arena_copy(context->arena, &draft.volume, sizeof draft.volume);
    if (volume->phase.count == 0) volume->phase = (Phase){.lobes = {{PHASE_ISOTROPIC, 0, 1}}, .count = 1};
    volume_rehash(volume);
    draft.common.object.as.volume = volume;
    return object_make(&reader, &draft.common, out);
}
