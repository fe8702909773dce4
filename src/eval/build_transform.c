#include "eval/build_parts.h"

#include <string.h>

static void compose(Transform *onto, Transform next) { *onto = transform_then(onto, &next); }

bool take_transform(const Argument *value, Transform *onto) {
    if (value->value.kind != VALUE_TRANSFORM) return false;
    compose(onto, *value->value.as.transform);
    return true;
}

static void read_translate(Reader *reader, const Word *word, void *target) {
    Vec3 by;
    if (word_arguments(reader, word, 1, 1) && word_vector(reader, word, 0, &by))
        compose(target, transform_translate(by));
}

static void read_rotate(Reader *reader, const Word *word, void *target) {
    Vec3 by;
    if (word_arguments(reader, word, 1, 1) && word_vector(reader, word, 0, &by))
        compose(target, transform_rotate(by));
}

/* POV-Ray's rule: a factor of zero means "leave this axis alone". */
static double nonzero_factor(Reader *reader, const Word *word, char axis, double factor) {
    if (factor != 0) return factor;
    diag_warning(reader->context->diags, reader_after(reader, word->arguments[0].span), "scale by 0 along %c is changed to 1",
                 axis);
    return 1;
}

static void read_scale(Reader *reader, const Word *word, void *target) {
    Vec3 by;
    if (!word_arguments(reader, word, 1, 1) || !word_vector(reader, word, 0, &by)) return;
    by.x = nonzero_factor(reader, word, 'x', by.x);
    by.y = nonzero_factor(reader, word, 'y', by.y);
    by.z = nonzero_factor(reader, word, 'z', by.z);
    compose(target, transform_scale(by));
}

/* `matrix <12 numbers>`: one long vector, or twelve floats. */
static bool matrix_numbers(Reader *reader, const Word *word, double m[12]) {
    if (word->count == 1 && word->arguments[0].value.kind == VALUE_VECTOR &&
        word->arguments[0].value.size == 12) {
        memcpy(m, word->arguments[0].value.as.components, 12 * sizeof *m);
    } else {
        if (word->count != 12) {
            reader_error(reader, word->whole,
                         "'matrix' takes 12 numbers: the images of x, y and z, and the origin's");
            return false;
        }
        for (size_t i = 0; i < 12; i++)
            if (!word_float(reader, word, i, &m[i])) return false;
    }
    for (int i = 0; i < 12; i++)
        if (!isfinite(m[i])) {
            reader_error(reader, word->whole, "number %d of 'matrix' is not finite", i + 1);
            return false;
        }
    return true;
}

/* POV-Ray's rule: where all three axes have lost a coordinate, its own axis gets it back. */
static void fill_zero_columns(Reader *reader, const Word *word, double m[12]) {
    for (int axis = 0; axis < 3; axis++) {
        if (m[axis] != 0 || m[3 + axis] != 0 || m[6 + axis] != 0) continue;
        m[4 * axis] = 1;
        Span last = {word->whole.file, word->whole.end - 1, word->whole.end}; /* as POV-Ray: with the last number */
        diag_warning(reader->context->diags, last,
                     "this matrix presses space flat along %c: 1 is taken there", "xyz"[axis]);
    }
}

static void read_matrix(Reader *reader, const Word *word, void *target) {
    double m[12];
    if (!matrix_numbers(reader, word, m)) return;
    fill_zero_columns(reader, word, m);
    Transform t = transform_matrix(m);
    if (transform_is_singular(&t))
        reader_error(reader, word->whole, "this matrix is singular: it presses space flat");
    else
        compose(target, t);
}

/* `transform T`; `transform { … }` arrives as a finished value. */
static void read_transform(Reader *reader, const Word *word, void *target) {
    if (!word_arguments(reader, word, 1, 1)) return;
    if (!take_transform(&word->arguments[0], target))
        reader_mismatch(reader, word->arguments[0].span, "'transform'", "a transform",
                        word->arguments[0].value.kind);
}

const WordRule transform_rules[] = {
    {"translate", WORD_CUSTOM, 0, read_translate, false}, {"rotate", WORD_CUSTOM, 0, read_rotate, false},
    {"scale", WORD_CUSTOM, 0, read_scale, false},         {"matrix", WORD_CUSTOM, 0, read_matrix, false},
    {"transform", WORD_CUSTOM, 0, read_transform, false},
};
const size_t transform_rule_count = VTS_ARRAY_COUNT(transform_rules);

static bool on_value(Reader *reader, const Argument *value, void *target) {
    (void)reader;
    return take_transform(value, target);
}

typedef struct Inverting {
    Transform *transform;
    bool inverse;
} Inverting;

/* Wherever it stands, and however often, it inverts the whole. A transform after it is an item of its own. */
static void read_inverse(Reader *reader, const Word *word, void *target) {
    Inverting *to = target;
    to->inverse = true;
    for (size_t i = 0; i < word->count; i++)
        if (!take_transform(&word->arguments[i], to->transform))
            reader_mismatch(reader, word->arguments[i].span, "'inverse'", "nothing or a transform",
                            word->arguments[i].value.kind);
}

static const WordRule own_rules[] = {{"inverse", WORD_CUSTOM, 0, read_inverse, false}};

bool build_transform(BuildContext *context, const EvalBlock *block, Value *out) {
    Transform *t = arena_new(context->arena, Transform);
    *t = transform_identity();
    Inverting own = {.transform = t};
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, transform_rules, transform_rule_count, t);
    reader_add_table(&reader, own_rules, VTS_ARRAY_COUNT(own_rules), &own);
    reader.on_value = on_value;
    reader.value_target = t;
    if (!reader_run(&reader)) return false;
    if (own.inverse) *t = transform_inverse(t);
    *out = (Value){.kind = VALUE_TRANSFORM, .as.transform = t};
    return true;
}
