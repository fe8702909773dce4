/* Functions that are not written in the language: POV-Ray's internal ones, as functions.inc numbers them, splines, transforms,
 * objects. */
#include "eval/eval_function.h"

#include "eval/build_pattern.h"
#include "tape/internal.h"
#include "tape/noise.h"

#include <string.h>

static void eval_internal(const void *data, const double *in, double *out) {
    out[0] = ((const InternalFunction *)data)->eval(in);
}

static bool expand_internal(const void *data, TapeBuilder *tape, const TapeRef *in, TapeRef *out, Span span) {
    return internal_append(tape, data, in, span, out);
}

static Value as_function(Eval *ev, const Node *node, int inputs, TapeBuilder *tape, TapeRef *out,
                         int outputs) {
    UserFunction *f = function_new(ev, node, inputs);
    f->tape = tape_finish(tape, out, outputs);
    return (Value){.kind = VALUE_FUNCTION, .as.function = f};
}

static const TapeExternal *external_new(Eval *ev, const char *name, int inputs, int outputs, const void *data,
                                        size_t size, void (*eval)(const void *, const double *, double *)) {
    TapeExternal *e = arena_new(ev->build.arena, TapeExternal);
    *e = (TapeExternal){.name = name, .input_count = inputs, .output_count = outputs, .eval = eval};
    e->data = arena_copy(ev->build.arena, data, size);
    e->hash = hash_begin(0x66756E63);
    hash_add(&e->hash, name, strlen(name));
    return e;
}

Value external_function(Eval *ev, const Node *node, const TapeExternal *external) {
    TapeBuilder *tape = tape_builder_create(ev->build.arena, external->input_count);
    TapeRef in[TAPE_CALL_MAX], out[TAPE_CALL_MAX];
    for (int i = 0; i < external->input_count; i++) in[i] = tape_input(tape, i);
    tape_call(tape, external, in, out, node->span);
    return as_function(ev, node, external->input_count, tape, out, external->output_count);
}

static TapeExternal *internal_external(Eval *ev, const InternalFunction *f) {
    TapeExternal *e = arena_new(ev->build.arena, TapeExternal);
    *e = (TapeExternal){.name = f->name,
                        .input_count = f->inputs,
                        .output_count = 1,
                        .eval = eval_internal,
                        .expand = expand_internal,
                        .data = f,
                        .hash = hash_begin(0x696E7465)};
    hash_add_u64(&e->hash, (uint64_t)f->number);
    return e;
}

/* f_noise_generator with the generator filled in. */
static Value other_noise_function(Eval *ev, const Node *node, int generator) {
    enum { NOISE_GENERATOR = 78 };
    const TapeExternal *e = internal_external(ev, internal_find(NOISE_GENERATOR));
    TapeBuilder *tape = tape_builder_create(ev->build.arena, 3);
    TapeRef in[4], out;
    for (int i = 0; i < 3; i++) in[i] = tape_input(tape, i);
    in[3] = tape_constant(tape, generator);
    tape_call(tape, e, in, &out, node->span);
    return as_function(ev, node, 3, tape, &out, 1);
}

Value internal_function(Eval *ev, const Node *node, int id) {
    enum { NOISE_3D = 76 };
    const InternalFunction *f = internal_find(id);
    if (!f) {
        diag_error(ev->diags, node->span, "there is no internal function %d", id);
        return value_error();
    }
    int generator = build_noise_generator(&ev->build);
    if (id == NOISE_3D && generator != NOISE_CORRECTED) return other_noise_function(ev, node, generator);
    if (!f->formula) return external_function(ev, node, internal_external(ev, f));
    TapeBuilder *tape = tape_builder_create(ev->build.arena, f->inputs);
    TapeRef in[INTERNAL_INPUTS], out;
    for (int i = 0; i < f->inputs; i++) in[i] = tape_input(tape, i);
    internal_append(tape, f, in, node->span, &out);
    return as_function(ev, node, f->inputs, tape, &out, 1);
}

/* ---- objects as functions: inside or not ---- */

typedef struct InsideQuery {
    EvalGeometry geometry; /* a copy: the renderer asks after the evaluator is gone */
    const Object *object;
} InsideQuery;

static void eval_inside(const void *data, const double *in, double *out) {
    const InsideQuery *q = data;
    out[0] = q->geometry.inside(q->geometry.context, q->object, vec3(in[0], in[1], in[2])) ? 1 : 0;
}

const Tape *object_inside_tape(const BuildContext *context, const Object *object, Span span) {
    const EvalGeometry *geometry = ((const Eval *)context->eval)->options->geometry;
    if (!geometry || !geometry->inside) return NULL;
    InsideQuery *query = arena_new(context->arena, InsideQuery);
    *query = (InsideQuery){*geometry, object};
    /* Whatever is made of the object is made by the first question; later ones may come from many threads. */
    geometry->inside(geometry->context, object, vec3_splat(0));
    TapeExternal *e = arena_new(context->arena, TapeExternal);
    *e = (TapeExternal){
        .name = "inside", .input_count = 3, .output_count = 1, .eval = eval_inside, .data = query};
    e->hash = hash_begin(0x696E7369);
    hash_add_hash(&e->hash, object_hash(object));
    TapeBuilder *tape = tape_builder_create(context->arena, 3);
    TapeRef in[3], out;
    for (int i = 0; i < 3; i++) in[i] = tape_input(tape, i);
    tape_call(tape, e, in, &out, span);
    return tape_finish(tape, &out, 1);
}

/* ---- splines and transforms as functions ---- */

static void eval_spline_external(const void *data, const double *in, double *out) {
    const Spline *spline = *(const Spline *const *)data;
    spline_evaluate(spline, spline->type, in[0], out);
}

Value spline_function(Eval *ev, const Node *node, const Spline *spline) {
    TapeExternal *e = (TapeExternal *)(uintptr_t)external_new(ev, "spline", 1, spline->size, &spline,
                                                              sizeof(const Spline *), eval_spline_external);
    hash_add(&e->hash, spline->points, spline->count * sizeof *spline->points);
    hash_add_u64(&e->hash, (uint64_t)spline->type);
    return external_function(ev, node, e);
}

/* A linear map, in tape operations: its bounds are then as good as the tape's. */
Value transform_function(Eval *ev, const Node *node, const Transform *t) {
    TapeBuilder *tape = tape_builder_create(ev->build.arena, 3);
    TapeRef out[3];
    for (int row = 0; row < 3; row++) {
        TapeRef sum = tape_constant(tape, vec3_get(t->offset, row));
        for (int column = 0; column < 3; column++) {
            TapeRef m = tape_constant(tape, vec3_get(t->linear.c[column], row));
            sum =
                tape_binary(tape, TAPE_ADD, sum,
                            tape_binary(tape, TAPE_MUL, m, tape_input(tape, column), node->span), node->span);
        }
        out[row] = sum;
    }
    return as_function(ev, node, 3, tape, out, 3);
}
