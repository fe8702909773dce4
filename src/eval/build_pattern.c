#include "eval/build_pattern.h"

#include <string.h>

static const struct PatternWord {
    const char *word;
    PatternKind kind;
} pattern_words[] = {
    {"gradient", PATTERN_GRADIENT},
    {"checker", PATTERN_CHECKER},
    {"brick", PATTERN_BRICK},
    {"hexagon", PATTERN_HEXAGON},
    {"cubic", PATTERN_CUBIC},
    {"square", PATTERN_SQUARE},
    {"triangular", PATTERN_TRIANGULAR},
    {"bozo", PATTERN_BOZO},
    {"bumps", PATTERN_BOZO},
    {"dents", PATTERN_DENTS},
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
    {"quilted", PATTERN_QUILTED},
    {"ripples", PATTERN_RIPPLES},
    {"waves", PATTERN_WAVES},
    {"spiral1", PATTERN_SPIRAL1},
    {"spiral2", PATTERN_SPIRAL2},
    {"mandel", PATTERN_MANDEL},
    {"julia", PATTERN_JULIA},
    {"average", PATTERN_AVERAGE},
    {"aoi", PATTERN_AOI},
    {"tiling", PATTERN_TILING},
    {"pavement", PATTERN_PAVEMENT},
};

static PatternKind find_pattern(const char *word) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(pattern_words); i++)
        if (strcmp(pattern_words[i].word, word) == 0) return pattern_words[i].kind;
    return PATTERN_SOLID;
}

const char *pattern_word(PatternKind kind) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(pattern_words); i++)
        if (pattern_words[i].kind == kind) return pattern_words[i].word;
    return NULL;
}

/* Settings that mean something to some patterns only. */
static const struct PatternSetting {
    const char *word, *patterns;
} pattern_settings[] = {
    {"agate_turb", " agate "},
    {"altitude", " slope "},
    {"brick_size", " brick "},
    {"mortar", " brick "},
    {"form", " crackle pavement "},
    {"metric", " crackle facets "},
    {"offset", " crackle "},
    {"solid", " crackle "},
    {"coords", " facets "},
    {"size", " facets "},
    {"control0", " quilted "},
    {"control1", " quilted "},
    {"exponent", " mandel julia "},
    {"exterior", " mandel julia pavement "},
    {"interior", " mandel julia pavement "},
    {"interpolate", " density_file "},
    {"number_of_sides", " pavement "},
    {"number_of_tiles", " pavement "},
    {"pattern", " pavement "},
};

bool pattern_takes(Reader *reader, const char *pattern, const Word *setting) {
    for (size_t i = 0; pattern && i < VTS_ARRAY_COUNT(pattern_settings); i++) {
        const struct PatternSetting *s = &pattern_settings[i];
        if (strcmp(s->word, setting->text) != 0) continue;
        const char *at = strstr(s->patterns, pattern);
        size_t size = strlen(pattern);
        if (at && at[-1] == ' ' && at[size] == ' ') return true;
        reader_error(reader, setting->span, "'%s' means nothing to the pattern '%s'", setting->text, pattern);
        return false;
    }
    return true;
}

/* ---- block patterns ---- */

size_t pattern_block_count(PatternKind kind) {
    switch (kind) {
    case PATTERN_CHECKER:
    case PATTERN_BRICK:
    case PATTERN_OBJECT: return 2;
    case PATTERN_HEXAGON: return 3;
    case PATTERN_SQUARE: return 4;
    case PATTERN_CUBIC:
    case PATTERN_TRIANGULAR: return 6;
    default: return 0;
    }
}

static void add_entry(Reader *reader, PigmentDraft *draft, ColorMapEntry entry) {
    entry.position = (double)draft->count;
    *list_push(reader->context->arena, draft) = entry;
}

bool take_block_entry(Reader *reader, PigmentDraft *draft, const Argument *value) {
    ColorMapEntry entry = {0};
    if (value->value.kind == VALUE_PIGMENT)
        entry.pigment = value->value.as.pigment;
    else if (value->value.kind == VALUE_COLOR || value->value.kind == VALUE_VECTOR)
        argument_color(reader, value, "the pattern", &entry.color);
    else
        return false;
    size_t most = pattern_block_count(draft->pigment.kind);
    if (draft->count == most)
        reader_error(reader, value->span, "this pattern has only %zu colours", most);
    else
        add_entry(reader, draft, entry);
    return true;
}

bool take_object_pattern(Reader *reader, PigmentDraft *draft, const Object *object) {
    const Tape *inside = object_inside_tape(reader->context, object, object->span);
    draft->pigment.kind = inside ? PATTERN_OBJECT : PATTERN_SOLID;
    draft->pigment.function = inside;
    if (!inside) inert_add(reader->context, &draft->pigment.inert, "object", object->span);
    return true;
}

/* `object { O color A color B }`, which stays a block because of its colours. */
static void read_object(Reader *reader, const Word *word, void *target) {
    PigmentDraft *draft = target;
    if (!word->body || word->body->count == 0 || word->body->items[0].kind != ITEM_VALUE) {
        reader_error(reader, word->span, "'object' as a pattern begins with an object");
        return;
    }
    const Argument first = {word->body->items[0].value, word->body->items[0].span};
    const Object *object = object_from_value(reader->context, &first);
    if (!object) {
        reader_mismatch(reader, first.span, "'object'", "an object", first.value.kind);
        return;
    }
    take_object_pattern(reader, draft, object);
    for (size_t i = 1; i < word->body->count && draft->pigment.kind == PATTERN_OBJECT; i++) {
        const Argument value = {word->body->items[i].value, word->body->items[i].span};
        if (draft->is_normal || draft->is_texture) {
            if (word->body->items[i].kind == ITEM_VALUE) reader->on_value(reader, &value, reader->value_target);
            continue;
        }
        if (word->body->items[i].kind != ITEM_VALUE || !take_block_entry(reader, draft, &value))
            reader_error(reader, value.span, "the pattern 'object' lists two colours or pigments");
    }
}

/* ---- patterns with operands ---- */

/* slope DIRECTION [, low, high]; the same of the altitude. */
static void read_slope(Reader *reader, const Word *word, Vec3 *direction, double *low, double *high) {
    if (!word_arguments(reader, word, 1, 3) || !word_vector(reader, word, 0, direction)) return;
    if (word->count > 1) word_float(reader, word, 1, low);
    if (word->count > 2) word_float(reader, word, 2, high);
}

static void read_altitude(Reader *reader, const Word *word, void *target) {
    Pigment *pigment = &((PigmentDraft *)target)->pigment;
    if (pigment->points_at) reader_error(reader, word->span, "'%s' means nothing to the pattern '%s'", word->text, "slope point_at");
    read_slope(reader, word, &pigment->altitude, &pigment->altitude_low, &pigment->altitude_high);
}

/* slope { DIRECTION, low, high altitude DIRECTION, low, high } */
static void read_slope_body(Reader *reader, const Word *word, PigmentDraft *draft) {
    static const WordRule altitude[] = {{"altitude", WORD_CUSTOM, 0, read_altitude, false}};
    Reader body = reader_nested(reader, word->body);
    Pigment *pigment = &draft->pigment;
    Word at;
    pigment->points_at = reader_take_word(&body, "point_at", &at);
    if (!pigment->points_at) reader_vector(&body, "the direction", &pigment->direction, NULL);
    else if (word_arguments(&body, &at, 1, 3)) read_slope(&body, &at, &pigment->direction, &pigment->slope_low, &pigment->slope_high);
    Argument argument;
    if (reader_take_value(&body, VALUE_FLOAT, &argument))
        argument_float(&body, &argument, "'slope'", &pigment->slope_low);
    if (reader_take_value(&body, VALUE_FLOAT, &argument))
        argument_float(&body, &argument, "'slope'", &pigment->slope_high);
    reader_add_table(&body, altitude, 1, draft);
    reader_run(&body);
    reader_end_nested(reader, &body);
}

static void read_fractal(Reader *reader, const Word *word, PigmentDraft *draft) {
    FractalSettings *f = &draft->pigment.fractal;
    bool julia = draft->pigment.kind == PATTERN_JULIA;
    Vec3 constant = {0, 0, 0};
    if (draft->magnet) draft->pigment.kind = julia ? PATTERN_MAGNET_JULIA : PATTERN_MAGNET_MANDEL;
    f->magnet = draft->magnet;
    draft->magnet = 0;
    size_t wanted = julia ? 2 : 1;
    if (!word_arguments(reader, word, wanted, wanted)) return;
    if (julia && !word_vector(reader, word, 0, &constant)) return;
    double iterations;
    if (!word_float(reader, word, wanted - 1, &iterations)) return;
    f->re = constant.x, f->im = constant.y;
    f->iterations = (int)double_clamp(iterations, 1, 10000000);
}

static void read_magnet(Reader *reader, const Word *word, void *target) {
    PigmentDraft *draft = target;
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, &draft->magnet)) return;
    if (draft->magnet != 1 && draft->magnet != 2)
        reader_error(reader, word->arguments[0].span, "'magnet' is of type 1 or 2");
}

static void read_exponent(Reader *reader, const Word *word, void *target) {
    FractalSettings *f = &((PigmentDraft *)target)->pigment.fractal;
    double exponent;
    if (!word_arguments(reader, word, 1, 1) || !word_float(reader, word, 0, &exponent)) return;
    bool known = exponent >= 2 && exponent < 34;
    if (!known)
        diag_warning(reader->context->diags, word->arguments[0].span,
                     "'exponent' of a fractal lies between 2 and 33: 2 is taken for %g", exponent);
    f->exponent = known ? (int)exponent : 2;
}

static void read_colouring(Reader *reader, const Word *word, int most, int *type, double *factor) {
    if (!word_arguments(reader, word, 1, 2) || !word_int(reader, word, 0, type)) return;
    if (word->count > 1) word_float(reader, word, 1, factor);
    if (*type < 0 || *type > most)
        reader_error(reader, word->arguments[0].span, "'%s' has types 0 to %d", word->text, most);
}

/* One of a pavement's looks, which have types 0 to `most`. */
static void read_pavement_look(Reader *reader, const Word *word, int most, int *look) {
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, look)) return;
    if (*look < 0 || *look > most) reader_error(reader, word->arguments[0].span, "'%s' has types 0 to %d", word->text, most);
}

static void read_form(Reader *reader, const Word *word, void *target) {
    Pigment *pigment = &((PigmentDraft *)target)->pigment;
    if (pigment->kind == PATTERN_PAVEMENT) read_pavement_look(reader, word, 3, &pigment->pavement.form);
    else if (word_arguments(reader, word, 1, 1)) word_vector(reader, word, 0, &pigment->crackle.form);
}

static void read_exterior(Reader *reader, const Word *word, void *target) {
    Pigment *pigment = &((PigmentDraft *)target)->pigment;
    if (pigment->kind == PATTERN_PAVEMENT) {
        read_pavement_look(reader, word, 2, &pigment->pavement.exterior);
        return;
    }
    FractalSettings *f = &((PigmentDraft *)target)->pigment.fractal;
    read_colouring(reader, word, 8, &f->exterior, &f->exterior_factor);
}

static void read_interior(Reader *reader, const Word *word, void *target) {
    Pigment *pigment = &((PigmentDraft *)target)->pigment;
    if (pigment->kind == PATTERN_PAVEMENT) {
        read_pavement_look(reader, word, 2, &pigment->pavement.interior);
        return;
    }
    FractalSettings *f = &((PigmentDraft *)target)->pigment.fractal;
    read_colouring(reader, word, 6, &f->interior, &f->interior_factor);
}

static void read_list(Reader *reader, const Word *word, PigmentDraft *draft) {
    bool blocks = pattern_block_count(draft->pigment.kind) > 0;
    if (draft->is_normal) {
        word_arguments(reader, word, 0, 0);
        return;
    }
    for (size_t i = 0; i < word->count; i++)
        if (!blocks || !take_block_entry(reader, draft, &word->arguments[i]))
            reader_error(reader, word->arguments[i].span, "'%s' takes no %s here", word->text,
                         blocks ? "such value" : "value");
}

static void read_arms(Reader *reader, const Word *word, int *out) {
    double arms;
    if (word_arguments(reader, word, 1, 1) && word_float(reader, word, 0, &arms))
        *out = (int)double_clamp(arms, -1e9, 1e9);
}

static void read_pattern(Reader *reader, const Word *word, void *target) {
    PigmentDraft *draft = target;
    Pigment *pigment = &draft->pigment;
    bool had_list = pattern_block_count(pigment->kind) > 0;
    pigment->kind = find_pattern(word->text);
    draft->count = 0;
    if (had_list || pattern_block_count(pigment->kind) > 0) { /* a map stays, under another pattern */
        pigment->entries = NULL;
        pigment->entry_count = 0;
    }
    switch (pigment->kind) {
    case PATTERN_GRADIENT:
        if (word_arguments(reader, word, 1, 1)) word_vector(reader, word, 0, &pigment->direction);
        break;
    case PATTERN_SLOPE:
        pigment->slope_low = pigment->slope_high = 0;
        pigment->points_at = false;
        if (word->body)
            read_slope_body(reader, word, draft);
        else
            read_slope(reader, word, &pigment->direction, &pigment->slope_low, &pigment->slope_high);
        break;
    case PATTERN_SPIRAL1:
    case PATTERN_SPIRAL2:
        read_arms(reader, word, &pigment->number);
        break;
    case PATTERN_TILING: break;
    case PATTERN_MANDEL:
    case PATTERN_JULIA: read_fractal(reader, word, draft); break;
    default: read_list(reader, word, draft);
    }
}

/* Those of one lattice are drawn. */
static void read_tiling(Reader *reader, const Word *word, void *target) {
    PigmentDraft *draft = target;
    read_pattern(reader, word, target);
    if (!word_arguments(reader, word, 1, draft->is_normal ? 2 : 1) || !word_int(reader, word, 0, &draft->pigment.number)) return;
    if (draft->pigment.number < 1 || draft->pigment.number > TILING_MOST) grammar_word(reader, word); /* knows how many there are */
    if (draft->pigment.number > TILING_MOST)
        inert_add(reader->context, &draft->pigment.inert, "tiling", word->span);
}

bool pattern_check(Reader *reader, const Pigment *pigment) {
    const PavementSettings *p = &pigment->pavement;
    int count = pavement_count(p->sides, p->tiles);
    if (pigment->kind != PATTERN_PAVEMENT || (p->pattern >= 1 && p->pattern <= count)) return true;
    if (count == 0)
        reader_error(reader, reader->block->word_span, "a 'pavement' has number_of_sides 3 or 4 and up to 6 tiles, or 6 and up to 5: found %d and %d", p->sides, p->tiles);
    else
        reader_error(reader, reader->block->word_span, "a 'pavement' of these sides and tiles has patterns 1 to %d, found %d", count, p->pattern);
    return false;
}

static void read_pigment_pattern(Reader *reader, const Word *word, void *target) {
    Pigment *pigment = &((PigmentDraft *)target)->pigment;
    if (!word->body) {
        reader_error(reader, word->span, "'pigment_pattern' takes a pigment in braces");
        return;
    }
    Reader body = reader_nested(reader, word->body);
    pigment->source = pigment_read(&body);
    pigment->kind = PATTERN_PIGMENT;
    reader_end_nested(reader, &body);
}

/* density_file df3 "name" */
static void read_density_file(Reader *reader, const Word *word, void *target) {
    Pigment *pigment = &((PigmentDraft *)target)->pigment;
    Word file;
    const char *name;
    if (!reader_take_word(reader, "df3", &file)) {
        reader_error(reader, word->span, "'density_file' is followed by df3 and the file's name");
        return;
    }
    if (!word_arguments(reader, &file, 1, 1) || !word_string(reader, &file, 0, &name)) return;
    pigment->density = density_load(reader->context, name, file.arguments[0].span);
    pigment->kind = PATTERN_DENSITY;
    reader->failed |= !pigment->density;
}

/* ---- settings ---- */

static void read_octaves(Reader *reader, const Word *word, void *target) {
    int octaves;
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, &octaves)) return;
    ((PigmentDraft *)target)->pigment.octaves = int_clamp(octaves, 1, 10); /* POV-Ray's range */
}

static void read_noise_generator(Reader *reader, const Word *word, void *target) {
    Pigment *pigment = &((PigmentDraft *)target)->pigment;
    int generator;
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, &generator)) return;
    if (generator < 1 || generator > 3)
        reader_error(reader, word->arguments[0].span, "'noise_generator' is 1, 2 or 3");
    else
        pigment->noise_generator = generator;
}

static void read_wave(Reader *reader, const Word *word, void *target) {
    static const struct {
        const char *word;
        WaveKind wave;
    } waves[] = {{"ramp_wave", WAVE_RAMP},       {"triangle_wave", WAVE_TRIANGLE}, {"sine_wave", WAVE_SINE},
                 {"scallop_wave", WAVE_SCALLOP}, {"cubic_wave", WAVE_CUBIC},       {"poly_wave", WAVE_POLY}};
    Pigment *pigment = &((PigmentDraft *)target)->pigment;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(waves); i++)
        if (strcmp(waves[i].word, word->text) == 0) pigment->wave = waves[i].wave;
    pigment->wave_exponent = 1;
    bool poly = pigment->wave == WAVE_POLY;
    if (word_arguments(reader, word, 0, poly ? 1 : 0) && word->count)
        word_float(reader, word, 0, &pigment->wave_exponent);
}

static void read_metric(Reader *reader, const Word *word, void *target) {
    double *metric = &((PigmentDraft *)target)->pigment.crackle.metric;
    if (!word_arguments(reader, word, 1, 1) || !word_float(reader, word, 0, metric)) return;
    if (*metric < 1)
        diag_warning(reader->context->diags, word->arguments[0].span,
                     "a 'metric' of crackle below 1 measures no distances");
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
#define CUSTOM(word, handler)                                                                                \
    { word, WORD_CUSTOM, 0, handler, false }

const WordRule pattern_rules[] = {
    PATTERN("gradient"),
    PATTERN("checker"),
    PATTERN("brick"),
    PATTERN("hexagon"),
    PATTERN("cubic"),
    PATTERN("square"),
    PATTERN("triangular"),
    PATTERN("bozo"),
    PATTERN("bumps"),
    PATTERN("dents"),
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
    PATTERN("quilted"),
    PATTERN("ripples"),
    PATTERN("waves"),
    PATTERN("spiral1"),
    PATTERN("spiral2"),
    PATTERN("mandel"),
    PATTERN("julia"),
    PATTERN("average"),
    PATTERN("aoi"),
    CUSTOM("tiling", read_tiling),
    PATTERN("pavement"),
    CUSTOM("magnet", read_magnet),
    CUSTOM("function", read_function_body),
    CUSTOM("pigment_pattern", read_pigment_pattern),
    CUSTOM("density_file", read_density_file),
    CUSTOM("object", read_object),
    CUSTOM("image_pattern", read_image),
};
const size_t pattern_rule_count = VTS_ARRAY_COUNT(pattern_rules);

const WordRule pattern_setting_rules[] = {
    {"frequency", WORD_FLOAT, FIELD(frequency), NULL, false},
    {"phase", WORD_FLOAT, FIELD(phase), NULL, false},
    {"turbulence", WORD_VECTOR, FIELD(turbulence), NULL, false},
    {"lambda", WORD_FLOAT, FIELD(lambda), NULL, false},
    {"omega", WORD_FLOAT, FIELD(omega), NULL, false},
    {"brick_size", WORD_VECTOR, FIELD(brick_size), NULL, false},
    {"mortar", WORD_FLOAT, FIELD(mortar), NULL, false},
    {"agate_turb", WORD_FLOAT, FIELD(agate_turbulence), NULL, false},
    {"offset", WORD_FLOAT, FIELD(crackle.offset), NULL, false},
    {"solid", WORD_FLAG, FIELD(crackle.solid), NULL, false},
    {"control0", WORD_FLOAT, FIELD(control0), NULL, false},
    {"control1", WORD_FLOAT, FIELD(control1), NULL, false},
    {"interpolate", WORD_INT, FIELD(interpolation), NULL, false},
    {"number_of_sides", WORD_INT, FIELD(pavement.sides), NULL, false},
    {"number_of_tiles", WORD_INT, FIELD(pavement.tiles), NULL, false},
    {"pattern", WORD_INT, FIELD(pavement.pattern), NULL, false},
    CUSTOM("metric", read_metric),
    CUSTOM("octaves", read_octaves),
    CUSTOM("noise_generator", read_noise_generator),
    CUSTOM("altitude", read_altitude),
    CUSTOM("exponent", read_exponent),
    CUSTOM("form", read_form),
    CUSTOM("exterior", read_exterior),
    CUSTOM("interior", read_interior),
    CUSTOM("ramp_wave", read_wave),
    CUSTOM("triangle_wave", read_wave),
    CUSTOM("sine_wave", read_wave),
    CUSTOM("scallop_wave", read_wave),
    CUSTOM("cubic_wave", read_wave),
    CUSTOM("poly_wave", read_wave),
    CUSTOM("warp", read_warp),
};
const size_t pattern_setting_rule_count = VTS_ARRAY_COUNT(pattern_setting_rules);
