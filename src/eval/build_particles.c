/* particles { count N { … } }: the evaluator gives one word `count` for each particle (eval/block.h). */
#include "eval/build_parts.h"

#include <string.h>

typedef struct ParticleList {
    Particle *items;
    size_t count, capacity;
} ParticleList;

static void read_width(Reader *reader, const Word *word, void *target) {
    Particle *particle = target;
    if (!word_arguments(reader, word, 1, 2) || !word_float(reader, word, 0, &particle->width_foot)) return;
    particle->width_tip = particle->width_foot;
    if (word->count == 2 && !word_float(reader, word, 1, &particle->width_tip)) return;
    if (particle->width_foot < 0 || particle->width_tip < 0)
        reader_error(reader, word->arguments[particle->width_foot < 0 ? 0 : 1].span,
                     "a width cannot be negative");
}

static void read_profile(Reader *reader, const Word *word, void *target) {
    static const char *const names[] = {"v", "round", "flat"};
    const char *text;
    if (!word_arguments(reader, word, 1, 1) || !word_string(reader, word, 0, &text)) return;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(names); i++)
        if (strcmp(names[i], text) == 0) {
            ((Particle *)target)->profile = (BladeProfile)i;
            return;
        }
    Diagnostic *d = reader_error(reader, word->arguments[0].span, "there is no profile \"%s\"", text);
    diag_hint(reader->context->diags, d, "it is one of \"v\", \"round\", \"flat\"");
}

#define FIELD(name) offsetof(Particle, name)
static const WordRule body_rules[] = {
    {"position", WORD_VECTOR, FIELD(position), NULL, true},
    {"velocity", WORD_VECTOR, FIELD(velocity), NULL, true},
    {"acceleration", WORD_VECTOR, FIELD(acceleration), NULL, true},
    {"life", WORD_POSITIVE, FIELD(life), NULL, true},
    {"width", WORD_CUSTOM, 0, read_width, true},
    {"profile", WORD_CUSTOM, 0, read_profile, true},
    {"twist", WORD_FLOAT, FIELD(twist), NULL, true},
};

static void read_count(Reader *reader, const Word *word, void *target) {
    if (!word->body) {
        reader_error(reader, word->span, "'count' needs the words of one particle { … }");
        return;
    }
    Particle particle = {.life = 1, .width_foot = 0.01, .profile = BLADE_V};
    Reader body = reader_nested(reader, word->body);
    reader_add_table(&body, body_rules, VTS_ARRAY_COUNT(body_rules), &particle);
    reader_run(&body);
    if (!reader_end_nested(reader, &body)) return;
    if (vec3_length_squared(particle.velocity) + vec3_length_squared(particle.acceleration) == 0)
        reader_error(reader, word->body->word_span,
                     "a particle without velocity and acceleration leaves no trace");
    else
        *list_push(reader->context->arena, (ParticleList *)target) = particle;
}

bool build_particles(BuildContext *context, const EvalBlock *block, Value *out) {
    static const WordRule rules[] = {{"count", WORD_CUSTOM, 0, read_count, false}};
    if (object_is_copy(block)) return build_object(context, block, out);
    ParticleList list = {0};
    ObjectDraft draft = object_begin(block, OBJECT_PARTICLES);
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), &list);
    if (!object_read(&reader, &draft)) return false;
    if (list.count == 0)
        diag_warning(context->diags, block->word_span, "'particles' without particles draws nothing");
    draft.object.as.particles.items = list.items;
    draft.object.as.particles.count = list.count;
    return object_make(&reader, &draft, out);
}
