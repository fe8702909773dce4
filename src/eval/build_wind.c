/* wind_field { … }, and wind_at(), which tells its force. */
#include "eval/build_parts.h"
#include "eval/eval_function.h"
#include "grow/wind.h"
#include "scene/scene_hash.h"

#include <math.h>

/* An octave halves the wave: more have nothing left of it. */
enum { MOST_OCTAVES = 32 };

static void read_octaves(Reader *reader, const Word *word, void *target) {
    WindField *wind = target;
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, &wind->turbulence_octaves)) return;
    if (wind->turbulence_octaves < 1 || wind->turbulence_octaves > MOST_OCTAVES)
        reader_error(reader, word->arguments[0].span, "'octaves' must be from 1 to %d, found %d", MOST_OCTAVES, wind->turbulence_octaves);
}

static void read_seed(Reader *reader, const Word *word, void *target) {
    int seed;
    if (word_arguments(reader, word, 1, 1) && word_int(reader, word, 0, &seed)) ((WindField *)target)->turbulence_seed = (uint32_t)seed;
}

static const WordRule gust_rules[] = {
    {"wavelength", WORD_POSITIVE, offsetof(WindField, gust_wavelength), NULL, true},
    {"amplitude", WORD_FLOAT, offsetof(WindField, gust_amplitude), NULL, true},
    {"sharpness", WORD_POSITIVE, offsetof(WindField, gust_sharpness), NULL, true},
};

static const WordRule turbulence_rules[] = {
    {"amplitude", WORD_FLOAT, offsetof(WindField, turbulence_amplitude), NULL, true},
    {"scale", WORD_POSITIVE, offsetof(WindField, turbulence_scale), NULL, true},
    {"octaves", WORD_CUSTOM, 0, read_octaves, true},
    {"seed", WORD_CUSTOM, 0, read_seed, true},
};

static void read_part(Reader *reader, const Word *word, WindField *wind, const WordRule *rules, size_t count) {
    if (!word->body) {
        reader_error(reader, word->span, "'%s' needs its block { … }", word->text);
        return;
    }
    Reader body = reader_nested(reader, word->body);
    reader_add_table(&body, rules, count, wind);
    reader_run(&body);
    reader_end_nested(reader, &body);
}

static void read_gust(Reader *reader, const Word *word, void *target) {
    read_part(reader, word, target, gust_rules, VTS_ARRAY_COUNT(gust_rules));
}

static void read_turbulence(Reader *reader, const Word *word, void *target) {
    read_part(reader, word, target, turbulence_rules, VTS_ARRAY_COUNT(turbulence_rules));
}

static void read_direction(Reader *reader, const Word *word, void *target) {
    WindField *wind = target;
    Vec3 direction;
    if (!word_arguments(reader, word, 1, 1) || !word_vector(reader, word, 0, &direction)) return;
    wind->direction = vec3_normalize(direction);
    if (!(vec3_length(direction) > 0)) reader_error(reader, word->arguments[0].span, "'direction' has no length");
}

static const WordRule rules[] = {
    {"direction", WORD_CUSTOM, 0, read_direction, true},
    {"speed", WORD_FLOAT, offsetof(WindField, speed), NULL, true},
    {"strength", WORD_FLOAT, offsetof(WindField, strength), NULL, true},
    {"gust", WORD_CUSTOM, 0, read_gust, true},
    {"turbulence", WORD_CUSTOM, 0, read_turbulence, true},
    {"stiffness", WORD_POSITIVE, offsetof(WindField, stiffness), NULL, true},
};

static bool on_value(Reader *reader, const Argument *value, void *target) {
    WindField *wind = target;
    if (value->value.kind == VALUE_WIND_FIELD && reader->next == 1) { /* wind_field { Breeze speed 3 } */
        *wind = *value->value.as.wind_field;
        return true;
    }
    if (value->value.kind != VALUE_FUNCTION) return false;
    if (wind->function) reader_error(reader, value->span, "'function' stands twice in 'wind_field'");
    return argument_function(reader, value, "'wind_field'", 4, 3, &wind->function);
}

/* In a film that goes round. A wind that was declared before has been told of then. */
static void make_cyclic(BuildContext *context, WindField *wind) {
    if (!(context->cycle > 0)) return;
    double speed = wind->speed, waves = wind_make_cyclic(wind, context->cycle);
    if (waves > 0 && fabs(wind->speed - speed) > 1e-9 * fabs(speed))
        diag_warning(context->diags, wind->span, "the film goes round in %g seconds: the wind's speed of %g is taken as %g, so that whole waves pass (%g of them)",
                     context->cycle, speed, wind->speed, waves);
}

bool build_wind_field(BuildContext *context, const EvalBlock *block, Value *out) {
    WindField *wind = arena_new(context->arena, WindField);
    *wind = (WindField){.direction = {1, 0, 0}, .strength = 1, .gust_wavelength = 1, .gust_sharpness = 1, .turbulence_scale = 1,
                        .turbulence_octaves = 1, .stiffness = 1};
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), wind);
    reader.on_value = on_value;
    reader.value_target = wind;
    if (!reader_run(&reader)) return false;
    wind->span = block->span;
    make_cyclic(context, wind);
    wind_rehash(wind);
    *out = (Value){.kind = VALUE_WIND_FIELD, .as.wind_field = wind};
    return true;
}

Value eval_wind_at(Eval *ev, const Node *call) {
    const NodeList *list = &call->as.apply.list;
    Value field = eval_node(ev, list->items[0]), place = eval_node(ev, list->items[1]);
    double p[3], time;
    if (field.kind == VALUE_ERROR || place.kind == VALUE_ERROR) return value_error();
    if (field.kind != VALUE_WIND_FIELD) {
        diag_error(ev->diags, list->items[0]->span, "expected a wind_field, found %s", value_kind_text(field.kind));
        return value_error();
    }
    if (!value_to_vector(ev, &place, list->items[1]->span, p, 3) || !eval_float(ev, list->items[2], &time)) return value_error();
    Vec3 force = wind_force(field.as.wind_field, vec3(p[0], p[1], p[2]), time);
    return value_vector(ev, (double[]){force.x, force.y, force.z}, 3);
}
