#include "eval/build_parts.h"

#include <string.h>

/* A finish with what its block set, so that `texture { T finish { ambient 0 } }` changes one number of T's finish. */
typedef struct BuiltFinish {
    Finish finish; /* first: a pointer to it is a pointer to the whole */
    uint64_t set;  /* bits of rules[]; all: made from a declared finish */
} BuiltFinish;

/* POV-Ray's `diffuse albedo 0.6`: the word in between says that the amount is of all light, not of the brightest. */
static bool amount(Reader *reader, const Word *word, size_t high, Word *source, bool *albedo) {
    *source = *word;
    *albedo = word->count == 0 && reader_take_word(reader, "albedo", source);
    return word_arguments(reader, source, 1, high);
}

static void read_diffuse(Reader *reader, const Word *word, void *target) {
    Finish *finish = target;
    Word source;
    if (!amount(reader, word, 2, &source, &finish->diffuse_albedo) || !word_float(reader, &source, 0, &finish->diffuse)) return;
    finish->transmission = 0;
    if (source.count >= 2) word_float(reader, &source, 1, &finish->transmission);
}

static void read_specular(Reader *reader, const Word *word, void *target) {
    Finish *finish = target;
    Word source;
    if (amount(reader, word, 1, &source, &finish->specular_albedo)) word_float(reader, &source, 0, &finish->specular);
}

static void read_phong(Reader *reader, const Word *word, void *target) {
    Finish *finish = target;
    Word source;
    if (amount(reader, word, 1, &source, &finish->phong_albedo)) word_float(reader, &source, 0, &finish->phong);
}

/* A roughness of 0 is taken for the least one. */
static void read_roughness(Reader *reader, const Word *word, void *target) {
    double value;
    if (!word_arguments(reader, word, 1, 1) || !word_float(reader, word, 0, &value)) return;
    if (value < 0)
        reader_error(reader, word->arguments[0].span, "'roughness' cannot be negative, found %g", value);
    if (value == 0)
        diag_warning(reader->context->diags, word->arguments[0].span, "a roughness of 0 is taken as 1e-6");
    ((Finish *)target)->roughness = value > 1e-6 ? value : 1e-6;
}

/* `metallic`, `metallic 0.5`: the word alone means 1. */
static void read_reflection_metallic(Reader *reader, const Word *word, void *target) {
    Finish *finish = target;
    finish->reflection_metallic = 1;
    if (word_arguments(reader, word, 0, 1) && word->count) word_float(reader, word, 0, &finish->reflection_metallic);
}

static const WordRule reflection_rules[] = {
    {"fresnel", WORD_FLAG, offsetof(Finish, fresnel), NULL, false},
    {"falloff", WORD_FLOAT, offsetof(Finish, reflection_falloff), NULL, false},
    {"exponent", WORD_FLOAT, offsetof(Finish, reflection_exponent), NULL, false},
    {"metallic", WORD_CUSTOM, 0, read_reflection_metallic, false},
};

typedef struct ReflectionColors {
    Color colors[2];
    size_t count;
} ReflectionColors;

static bool on_reflection_value(Reader *reader, const Argument *value, void *target) {
    ReflectionColors *colors = target;
    if (colors->count == 2) return false;
    argument_color(reader, value, "'reflection'", &colors->colors[colors->count++]);
    return true;
}

/* `reflection c`, `reflection { c }`, `reflection { c_min, c_max fresnel … }` */
static void read_reflection(Reader *reader, const Word *word, void *target) {
    Finish *finish = target;
    ReflectionColors colors = {0};
    if (word->body) {
        Reader body = reader_nested(reader, word->body);
        reader_add_table(&body, reflection_rules, VTS_ARRAY_COUNT(reflection_rules), finish);
        body.on_value = on_reflection_value;
        body.value_target = &colors;
        reader_run(&body);
        reader_end_nested(reader, &body);
    } else if (word_arguments(reader, word, 0, 1) && word->count &&
               word_color(reader, word, 0, &colors.colors[0])) {
        colors.count = 1;
    }
    if (colors.count == 0) return;
    finish->reflection_max = colors.colors[colors.count - 1];
    finish->reflection_min = colors.count == 2 ? colors.colors[0] : finish->fresnel ? (Color){0} : finish->reflection_max;
}

/* POV-Ray lets the colour be missing: nothing changes then. */
static void optional_color(Reader *reader, const Word *word, Color *out) {
    if (word_arguments(reader, word, 0, 1) && word->count) word_color(reader, word, 0, out);
}

static void read_ambient(Reader *reader, const Word *word, void *target) {
    optional_color(reader, word, &((Finish *)target)->ambient);
}

static void read_emission(Reader *reader, const Word *word, void *target) {
    optional_color(reader, word, &((Finish *)target)->emission);
}

static void read_metallic(Reader *reader, const Word *word, void *target) {
    Finish *finish = target;
    finish->metallic = 1;
    if (word_arguments(reader, word, 0, 1) && word->count) word_float(reader, word, 0, &finish->metallic);
}

#define FIELD(name) offsetof(Finish, name)
/* Of a vector of turbulence only its length counts. */
static void read_irid_turbulence(Reader *reader, const Word *word, void *target) {
    Vec3 turbulence;
    if (word_arguments(reader, word, 1, 1) && word_vector(reader, word, 0, &turbulence))
        ((Finish *)target)->irid_turbulence = turbulence.x;
}

static bool on_irid_value(Reader *reader, const Argument *value, void *target) {
    Color color;
    if (!argument_color(reader, value, "'irid'", &color)) return true;
    ((Finish *)target)->irid = (color.red + color.green + color.blue) / 3;
    return true;
}

/* `irid { amount thickness F turbulence F }` */
static void read_irid(Reader *reader, const Word *word, void *target) {
    static const WordRule irid_rules[] = {
        {"thickness", WORD_FLOAT, FIELD(irid_thickness), NULL, false},
        {"turbulence", WORD_CUSTOM, 0, read_irid_turbulence, false},
    };
    if (!word->body) return;
    if (word->body->count == 0) reader_error(reader, word->span, "'%s' is empty", word->text);
    Reader body = reader_nested(reader, word->body);
    reader_add_table(&body, irid_rules, VTS_ARRAY_COUNT(irid_rules), target);
    body.on_value = on_irid_value;
    body.value_target = target;
    reader_run(&body);
    reader_end_nested(reader, &body);
}

static const WordRule rules[] = {
    {"ambient", WORD_CUSTOM, FIELD(ambient), read_ambient, false},
    {"emission", WORD_CUSTOM, FIELD(emission), read_emission, false},
    {"diffuse", WORD_CUSTOM, FIELD(diffuse), read_diffuse, false},
    {"brilliance", WORD_FLOAT, FIELD(brilliance), NULL, false},
    {"specular", WORD_CUSTOM, FIELD(specular), read_specular, false},
    {"roughness", WORD_CUSTOM, FIELD(roughness), read_roughness, false},
    {"phong", WORD_CUSTOM, FIELD(phong), read_phong, false},
    {"phong_size", WORD_FLOAT, FIELD(phong_size), NULL, false},
    {"metallic", WORD_CUSTOM, FIELD(metallic), read_metallic, false},
    {"reflection", WORD_CUSTOM, FIELD(reflection_min), read_reflection, false},
    {"fresnel", WORD_FLAG, FIELD(fresnel), NULL, false},
    {"conserve_energy", WORD_MARK, FIELD(conserve_energy), NULL, false},
    {"reflection_exponent", WORD_FLOAT, FIELD(reflection_exponent), NULL, false},
    {"crand", WORD_FLOAT, FIELD(crand), NULL, false},
    {"irid", WORD_CUSTOM, FIELD(irid), read_irid, false},
    {"ior", WORD_IGNORED, 0, NULL, false},
    {"refraction", WORD_IGNORED, 0, NULL, false},
    {"subsurface", WORD_IGNORED, 0, NULL, false},
    {"use_alpha", WORD_IGNORED, 0, NULL, false},
};

/* Which fields each rule sets, up to the last that sets one. */
typedef struct FieldRange {
    size_t begin, end;
} FieldRange;
#define RANGE(first, last) {FIELD(first), FIELD(last) + sizeof(((const Finish *)0)->last)}
static const FieldRange rule_fields[][2] = {
    {RANGE(ambient, ambient)},
    {RANGE(emission, emission)},
    {RANGE(diffuse, transmission), RANGE(diffuse_albedo, diffuse_albedo)},
    {RANGE(brilliance, brilliance)},
    {RANGE(specular, specular), RANGE(specular_albedo, specular_albedo)},
    {RANGE(roughness, roughness)},
    {RANGE(phong, phong), RANGE(phong_albedo, phong_albedo)},
    {RANGE(phong_size, phong_size)},
    {RANGE(metallic, metallic)},
    {RANGE(reflection_min, reflection_metallic)},
    {RANGE(fresnel, fresnel)},
    {RANGE(conserve_energy, conserve_energy)},
    {RANGE(reflection_exponent, reflection_exponent)},
    {RANGE(crand, crand)},
    {RANGE(irid, irid_turbulence)},
};

static bool on_value(Reader *reader, const Argument *value, void *target) {
    BuiltFinish *built = target;
    if (value->value.kind != VALUE_FINISH) return false;
    if (reader->next > 1 || reader->block->items[0].kind == ITEM_WORD) /* or taken for an operand of it */
        reader_error(reader, value->span, "a declared finish comes first in 'finish'");
    built->finish = *value->value.as.finish;
    built->set = ~(uint64_t)0;
    return true;
}

const Finish *finish_over(const BuildContext *context, const Finish *base, const Finish *block) {
    const BuiltFinish *change = (const BuiltFinish *)(const void *)block;
    BuiltFinish *built = arena_new(context->arena, BuiltFinish);
    built->set = ~(uint64_t)0;
    if (change->set == built->set) return block;
    built->finish = *base;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(rule_fields); i++)
        for (int k = 0; k < 2 && change->set >> i & 1; k++) {
            FieldRange range = rule_fields[i][k];
            memcpy((char *)&built->finish + range.begin, (const char *)block + range.begin, range.end - range.begin);
        }
    finish_rehash(&built->finish);
    return &built->finish;
}

bool build_finish(BuildContext *context, const EvalBlock *block, Value *out) {
    BuiltFinish *built = arena_new(context->arena, BuiltFinish);
    built->finish = *texture_default(context)->finish;
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), &built->finish);
    reader.on_value = on_value;
    reader.value_target = built;
    if (!reader_run(&reader)) return false;
    built->set |= reader.met;
    finish_rehash(&built->finish);
    *out = (Value){.kind = VALUE_FINISH, .as.finish = &built->finish};
    return true;
}
