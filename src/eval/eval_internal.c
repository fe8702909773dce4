/* Functions that are not written in the language: POV-Ray's internal ones, as functions.inc numbers them, and those that vts adds. */
#include "eval/eval_function.h"

#include "tape/noise.h"

#include <math.h>
#include <string.h>

/* Arguments p[0 … 2] are x, y, z; the rest are the function's own parameters. */
typedef double InternalEval(const double *p);

static double f_ph(const double *p) {
    double r = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    return r == 0 ? 0 : acos(p[1] / r);
}
static double f_r(const double *p) { return sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]); }
static double f_th(const double *p) { return atan2(p[0], p[2]); }
static double f_sphere(const double *p) { return f_r(p) - p[3]; }
static double f_ellipsoid(const double *p) {
    return sqrt(p[0] * p[0] * p[3] * p[3] + p[1] * p[1] * p[4] * p[4] + p[2] * p[2] * p[5] * p[5]);
}
static double f_torus(const double *p) {
    double ring = sqrt(p[0] * p[0] + p[2] * p[2]) - p[3];
    return sqrt(ring * ring + p[1] * p[1]) - p[4];
}
static double f_superellipsoid(const double *p) {
    double e = p[3], n = p[4];
    double side = pow(pow(fabs(p[0]), 2 / e) + pow(fabs(p[1]), 2 / e), e / n);
    return 1 - pow(side + pow(fabs(p[2]), 2 / n), n / 2);
}
static double f_rounded_box(const double *p) {
    double radius = p[3], sum = 0;
    if (p[4] < radius || p[5] < radius || p[6] < radius) return 0;
    for (int i = 0; i < 3; i++) {
        double inner = p[4 + i] - radius, over = double_max(fabs(p[i]) - inner, 0);
        sum += over * over;
    }
    return sqrt(sum) - radius - 1e-6; /* POV-Ray's, to the last digit */
}
static double f_heart(const double *p) {
    double x = p[0], y = p[1], z = p[2], x2 = x * x, y2 = y * y, z2 = z * z, a = 2 * x2 + y2 + z2 - 1;
    return -p[3] * (a * a * a - 0.1 * x2 * z2 * z - y2 * z2 * z);
}
static double f_paraboloid(const double *p) { return p[3] * (p[0] * p[0] - p[1] + p[2] * p[2]); }
/* Algebraic surfaces of POV-Ray are limited to ±10. */
static double f_quartic_cylinder(const double *p) {
    double around = p[0] * p[0] + p[2] * p[2], across = p[5] * p[5];
    return double_clamp(-p[3] * (around * p[1] * p[1] + across * around - p[4] * p[4] * across), -10, 10);
}
/* Kinds 1 and 2 are POV-Ray's own noises, 3 is Perlin's. */
static double f_noise_generator(const double *p) {
    Vec3 at = vec3(p[0], p[1], p[2]);
    return p[3] == 1   ? noise_pov_original(at)
           : p[3] == 3 ? double_clamp(0.5 * (1 + noise_perlin(at)), 0, 1)
                       : noise_pov(at);
}
static double f_noise3d(const double *p) { return noise_pov(vec3(p[0], p[1], p[2])); }

static const struct {
    int id, inputs;
    InternalEval *eval;
} internals[] = {
    {18, 6, f_ellipsoid},
    {23, 4, f_heart},
    {45, 4, f_paraboloid},
    {47, 3, f_ph},
    {57, 3, f_r},
    {60, 7, f_rounded_box},
    {61, 4, f_sphere},
    {68, 5, f_superellipsoid},
    {69, 3, f_th},
    {70, 5, f_torus},
    {56, 6, f_quartic_cylinder},
    {76, 3, f_noise3d},
    {78, 4, f_noise_generator},
};

static void eval_internal(const void *data, const double *in, double *out) {
    out[0] = (*(InternalEval *const *)data)(in);
}

static Value as_function(Eval *ev, const Node *node, int inputs, TapeBuilder *tape, TapeRef *out,
                         int outputs) {
    EvalFunction *f = arena_new(ev->build.arena, EvalFunction);
    f->base.span = node->span;
    f->base.parameter_count = inputs;
    f->base.tape = tape_finish(tape, out, outputs);
    return (Value){.kind = VALUE_FUNCTION, .as.function = &f->base};
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
    TapeRef in[8], out[8];
    for (int i = 0; i < external->input_count; i++) in[i] = tape_input(tape, i);
    tape_call(tape, external, in, out, node->span);
    return as_function(ev, node, external->input_count, tape, out, external->output_count);
}

Value internal_function(Eval *ev, const Node *node, int id) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(internals); i++) {
        if (internals[i].id != id) continue;
        TapeExternal *e = (TapeExternal *)(uintptr_t)external_new(ev, "internal", internals[i].inputs, 1,
                                                                  &internals[i].eval,
                                                                  sizeof internals[i].eval, eval_internal);
        hash_add_u64(&e->hash, (uint64_t)id);
        return external_function(ev, node, e);
    }
    TapeBuilder *tape = tape_builder_create(ev->build.arena, 3);
    TapeRef zero = tape_constant(tape, 0);
    Value v = as_function(ev, node, 3, tape, &zero, 1);
    ((EvalFunction *)(uintptr_t)v.as.function)->missing =
        "this internal function is";
    return v;
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

/* ---- functions that vts adds ---- */

static bool compile_perlin(Eval *ev, TapeBuilder *tape, const Node *call, const TapeRef *a, size_t count,
                           TapeRef *out) {
    (void)ev;
    (void)count;
    *out = tape_ternary(tape, TAPE_PERLIN, a[0], a[1], a[2], call->span);
    return true;
}

static bool constant_argument(Eval *ev, const Node *call, size_t i, double *out) {
    return eval_float(ev, call->as.apply.list.items[i], out);
}

/* fbm(noise, x, y, z, octaves, lacunarity, gain) = Σ gainᵏ · noise(lacunarityᵏ · p) */
static bool compile_fbm(Eval *ev, TapeBuilder *tape, const Node *call, const TapeRef *a, size_t count,
                        TapeRef *out) {
    (void)count;
    const Node *noise = call->as.apply.list.items[0];
    double octaves, lacunarity, gain;
    if (noise->kind != NODE_NAME || strcmp(noise->as.name->text, "perlin") != 0) {
        diag_error(ev->diags, noise->span, "fbm() takes the name of a noise first: perlin");
        return false;
    }
    if (!constant_argument(ev, call, 4, &octaves) || !constant_argument(ev, call, 5, &lacunarity) ||
        !constant_argument(ev, call, 6, &gain))
        return false;
    if (!(octaves >= 1 && octaves <= 64)) {
        diag_error(ev->diags, call->as.apply.list.items[4]->span, "fbm() takes 1 to 64 octaves");
        return false;
    }
    Span s = call->span;
    TapeRef sum = tape_constant(tape, 0);
    double frequency = 1, weight = 1;
    for (int k = 0; k < (int)octaves; k++, frequency *= lacunarity, weight *= gain) {
        TapeRef f = tape_constant(tape, frequency);
        TapeRef value =
            tape_ternary(tape, TAPE_PERLIN, tape_binary(tape, TAPE_MUL, a[1], f, s),
                         tape_binary(tape, TAPE_MUL, a[2], f, s), tape_binary(tape, TAPE_MUL, a[3], f, s), s);
        sum = tape_binary(tape, TAPE_ADD, sum,
                          tape_binary(tape, TAPE_MUL, tape_constant(tape, weight), value, s), s);
    }
    *out = sum;
    return true;
}

static const KnownFunction known_functions[] = {
    {"perlin", 3, false, compile_perlin},
    {"fbm", 7, true, compile_fbm},
};

const KnownFunction *known_function_find(Name name) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(known_functions); i++)
        if (strcmp(known_functions[i].name, name->text) == 0) return &known_functions[i];
    return NULL;
}

bool known_function_takes(Eval *ev, const Node *call, const KnownFunction *f) {
    size_t count = call->as.apply.list.count;
    if (count == f->arguments) return true;
    diag_error(ev->diags, call->span, "%s() takes %zu arguments, %zu given", f->name, f->arguments, count);
    return false;
}

/* Called outside of functions: as a tape of constants. */
Value call_known_function(Eval *ev, const Node *node, bool *known) {
    const KnownFunction *f = known_function_find(node->as.apply.base->as.name);
    *known = f != NULL;
    if (!f) return value_error();
    const NodeList *list = &node->as.apply.list;
    if (!known_function_takes(ev, node, f)) return value_error();
    TapeBuilder *tape = tape_builder_create(&ev->temp, 0);
    TapeRef arguments[8] = {0}, out;
    for (size_t i = f->takes_noise ? 1 : 0; i < list->count; i++) {
        double a;
        if (!eval_float(ev, list->items[i], &a)) return value_error();
        arguments[i] = tape_constant(tape, a);
    }
    if (!f->compile(ev, tape, node, arguments, list->count, &out)) return value_error();
    double result;
    tape_eval_once(tape_finish(tape, &out, 1), NULL, &result);
    return value_float(result);
}
