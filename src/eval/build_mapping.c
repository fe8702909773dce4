/* mapping { … } and jitter { … } of a skin. */
#include "eval/build_parts.h"

#include <string.h>

/* ---- mapping ---- */

/* Tiles along a side of a surface: beyond, coordinates have no digits left within a tile. */
static const double MOST_TILES = 1e9;

static void read_repeat(Reader *reader, const Word *word, void *target) {
    SkinMapping *mapping = target;
    Vec3 repeat;
    bool two = word->count == 2; /* repeat 40, 40 */
    if (two) {
        if (!word_float(reader, word, 0, &repeat.x) || !word_float(reader, word, 1, &repeat.y)) return;
    } else if (!word_arguments(reader, word, 1, 1) || !word_vector(reader, word, 0, &repeat)) {
        return;
    }
    if (!(repeat.x > 0 && repeat.y > 0 && repeat.x <= MOST_TILES && repeat.y <= MOST_TILES)) {
        reader_error(reader, word->arguments[0].span,
                     repeat.x > 0 && repeat.y > 0 ? "'repeat' must be at most 1e9 in both directions, found <%g, %g>"
                                                  : "'repeat' must be greater than 0 in both directions, found <%g, %g>",
                     repeat.x, repeat.y);
        return;
    }
    mapping->repeat_u = repeat.x;
    mapping->repeat_v = repeat.y;
    mapping->by_tile_size = false;
}

static void read_tile(Reader *reader, const Word *word, void *target) {
    SkinMapping *mapping = target;
    if (!word_arguments(reader, word, 1, 1) || !word_float(reader, word, 0, &mapping->tile_size)) return;
    mapping->by_tile_size = true;
    if (!(mapping->tile_size > 0))
        reader_error(reader, word->arguments[0].span, "'tile' must be greater than 0, found %g",
                     mapping->tile_size);
}

/* A function or pigment that multiplies: behind the number, as argument or as an item of its own. */
static bool height_factor(Reader *reader, SkinMapping *mapping, const Argument *value) {
    if (value->value.kind == VALUE_PIGMENT) {
        mapping->height_pigment = value->value.as.pigment;
        return true;
    }
    return argument_function(reader, value, "'height'", 3, 1, &mapping->height_function);
}

static void read_height(Reader *reader, const Word *word, void *target) {
    SkinMapping *mapping = target;
    Argument next;
    if (!word_arguments(reader, word, 1, 2) || !word_float(reader, word, 0, &mapping->height)) return;
    if (mapping->height < 0)
        reader_error(reader, word->arguments[0].span,
                     "'height' cannot be negative: the texel would hang inside");
    if (word->count == 2)
        height_factor(reader, mapping, &word->arguments[1]);
    else if (reader_take_value(reader, VALUE_FUNCTION, &next) ||
             reader_take_value(reader, VALUE_PIGMENT, &next))
        height_factor(reader, mapping, &next);
}

static void read_comb(Reader *reader, const Word *word, void *target) {
    SkinMapping *mapping = target;
    Argument function;
    if (word->count == 0 && reader_take_value(reader, VALUE_FUNCTION, &function))
        argument_function(reader, &function, "'comb'", 3, 3, &mapping->comb_function);
    else if (word_arguments(reader, word, 1, 1) && word->arguments[0].value.kind == VALUE_FUNCTION)
        argument_function(reader, &word->arguments[0], "'comb'", 3, 3, &mapping->comb_function);
    else if (word->count == 1)
        word_vector(reader, word, 0, &mapping->comb);
}

static void read_w(Reader *reader, const Word *word, void *target) {
    SkinMapping *mapping = target;
    Argument function;
    if (!word_arguments(reader, word, 2, 3) || !word_float(reader, word, 0, &mapping->w_foot) ||
        !word_float(reader, word, 1, &mapping->w_tip))
        return;
    if (mapping->w_foot == mapping->w_tip)
        reader_error(reader, word->arguments[1].span, "w at foot and tip must differ, found %g for both",
                     mapping->w_foot);
    if (word->count == 3)
        argument_function(reader, &word->arguments[2], "'w'", 3, 3, &mapping->w_function);
    else if (reader_take_value(reader, VALUE_FUNCTION, &function))
        argument_function(reader, &function, "'w'", 3, 3, &mapping->w_function);
}

static const WordRule mapping_rules[] = {
    {"repeat", WORD_CUSTOM, 0, read_repeat, true}, {"tile", WORD_CUSTOM, 0, read_tile, true},
    {"height", WORD_CUSTOM, 0, read_height, true}, {"comb", WORD_CUSTOM, 0, read_comb, true},
    {"w", WORD_CUSTOM, 0, read_w, true},
};

bool mapping_read(Reader *parent, const Word *word, SkinMapping *mapping) {
    if (!word->body) {
        reader_error(parent, word->span, "'mapping' needs its words { … }");
        return false;
    }
    Reader reader = reader_nested(parent, word->body);
    reader_add_table(&reader, mapping_rules, VTS_ARRAY_COUNT(mapping_rules), mapping);
    reader_run(&reader);
    return reader_end_nested(parent, &reader);
}

/* ---- jitter: `coordinates 0.2 scale 3 height 0.3 scale 2 …`; `scale` belongs to the word before it ---- */

typedef struct JitterDraft {
    SkinJitter *jitter;
    NoiseJitter *last; /* NULL: `scale` would stand alone */
} JitterDraft;

static void read_noise(Reader *reader, const Word *word, void *target) {
    JitterDraft *draft = target;
    NoiseJitter *noise = word->text[0] == 'c'   ? &draft->jitter->coordinates
                         : word->text[0] == 'h' ? &draft->jitter->height
                                                : &draft->jitter->direction;
    draft->last = NULL;
    if (!word_arguments(reader, word, 1, 1) || !word_float(reader, word, 0, &noise->amplitude)) return;
    if (noise->amplitude < 0)
        reader_error(reader, word->arguments[0].span, "'%s' cannot be negative, found %g", word->text,
                     noise->amplitude);
    draft->last = noise;
}

static void read_scale(Reader *reader, const Word *word, void *target) {
    JitterDraft *draft = target;
    double scale;
    if (!draft->last) {
        reader_error(reader, word->span,
                     "'scale' of a jitter follows 'coordinates', 'height' or 'direction'");
    } else if (word_arguments(reader, word, 1, 1) && word_float(reader, word, 0, &scale)) {
        draft->last->scale = scale;
        if (!(scale > 0))
            reader_error(reader, word->arguments[0].span, "'scale' must be greater than 0, found %g", scale);
    }
    draft->last = NULL;
}

static void read_share(Reader *reader, const Word *word, void *target) {
    InstanceJitter *instance = target;
    if (!word_arguments(reader, word, 1, 1) || !word_float(reader, word, 0, &instance->density)) return;
    if (instance->density < 0 || instance->density > 1)
        reader_error(reader, word->arguments[0].span, "'density' is a share from 0 to 1, found %g",
                     instance->density);
}

static void read_rotate(Reader *reader, const Word *word, void *target) {
    InstanceJitter *instance = target;
    instance->turned = word_arguments(reader, word, 1, 1) && word_float(reader, word, 0, &instance->rotate);
}

static void read_tint(Reader *reader, const Word *word, void *target) {
    InstanceJitter *instance = target;
    instance->tinted = word_arguments(reader, word, 2, 2) && word_color(reader, word, 0, &instance->tint_a) &&
                       word_color(reader, word, 1, &instance->tint_b);
}

static const WordRule instance_rules[] = {
    {"displace", WORD_FLOAT, offsetof(InstanceJitter, displace), NULL, true},
    {"rotate", WORD_CUSTOM, 0, read_rotate, true},
    {"scale", WORD_FLOAT, offsetof(InstanceJitter, scale), NULL, true},
    {"mirror", WORD_FLAG, offsetof(InstanceJitter, mirror), NULL, true},
    {"density", WORD_CUSTOM, 0, read_share, true},
    {"tint", WORD_CUSTOM, 0, read_tint, true},
};

static void read_instance(Reader *reader, const Word *word, void *target) {
    JitterDraft *draft = target;
    draft->last = NULL;
    if (!word->body) {
        reader_error(reader, word->span, "'instance' needs its words { … }");
        return;
    }
    Reader body = reader_nested(reader, word->body);
    draft->jitter->instance.present = true;
    reader_add_table(&body, instance_rules, VTS_ARRAY_COUNT(instance_rules), &draft->jitter->instance);
    reader_run(&body);
    reader_end_nested(reader, &body);
}

static void read_seed(Reader *reader, const Word *word, void *target) {
    JitterDraft *draft = target;
    int seed;
    draft->last = NULL;
    if (word_arguments(reader, word, 1, 1) && word_int(reader, word, 0, &seed))
        draft->jitter->seed = (uint32_t)seed;
}

static const WordRule jitter_rules[] = {
    {"coordinates", WORD_CUSTOM, 0, read_noise, true}, {"height", WORD_CUSTOM, 0, read_noise, true},
    {"direction", WORD_CUSTOM, 0, read_noise, true},   {"scale", WORD_CUSTOM, 0, read_scale, false},
    {"instance", WORD_CUSTOM, 0, read_instance, true}, {"seed", WORD_CUSTOM, 0, read_seed, true},
};

bool jitter_read(Reader *parent, const Word *word, SkinJitter *jitter) {
    if (!word->body) {
        reader_error(parent, word->span, "'jitter' needs its words { … }");
        return false;
    }
    JitterDraft draft = {.jitter = jitter};
    Reader reader = reader_nested(parent, word->body);
    reader_add_table(&reader, jitter_rules, VTS_ARRAY_COUNT(jitter_rules), &draft);
    reader_run(&reader);
    return reader_end_nested(parent, &reader);
}
