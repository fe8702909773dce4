/* Functions that vts adds to POV-Ray's: noises by name, and sums of their octaves. */
#include "eval/eval_function.h"

#include "tape/noise.h"
#include "tape/noise_interval.h"
#include "tape/noise_nodes_forms.h"

#include <string.h>

/* ---- noises that are no operations of tapes ---- */

/* Rounded towards zero and bounded; what is no number counts as 0. */
static int whole(double a, int most) { return a >= most ? most : a > 0 ? (int)a : 0; }

/* The distances to the nearest nodes at once, as many as the data says: what is made of several asks once. */
static const int worley_last[] = {0, 1, 3, WORLEY_NODES - 1};

static void eval_worley(const void *data, const double *in, double *out) {
    noise_worley_nearest(vec3(in[0], in[1], in[2]), *(const int *)data, out);
}

static void bound_worley(const void *data, const Interval *in, Interval *out) {
    interval_worley_nearest(in, *(const int *)data, out);
}

static void forms_worley(const void *data, int count, const AffineForm *in, AffineForm *out, struct NodeCache *cells) {
    affine_worley(count, in, *(const int *)data, out, cells);
}

static void gradient_worley(const void *data, const double *in, double *slopes) {
    Vec3 by[WORLEY_NODES];
    noise_worley_gradients(vec3(in[0], in[1], in[2]), *(const int *)data, by);
    for (int k = 0; k <= *(const int *)data; k++) slopes[3 * k] = by[k].x, slopes[3 * k + 1] = by[k].y, slopes[3 * k + 2] = by[k].z;
}

#define WORLEY_OF(k, last)                                                                                                               \
    {.name = "worley", .input_count = 3, .output_count = (last) + 1, .eval = eval_worley, .bound = bound_worley, .forms = forms_worley, .gradient = gradient_worley, \
     .data = &worley_last[k], .hash = {0x776F726C6579, 2 + (k)}, .work = 60}
static const TapeExternal worley_nearest[] = {WORLEY_OF(0, 0), WORLEY_OF(1, 1), WORLEY_OF(2, 3), WORLEY_OF(3, WORLEY_NODES - 1)};

/* Where the number of the node is not known before. */
static void eval_worley_any(const void *data, const double *in, double *out) {
    (void)data;
    out[0] = noise_worley(vec3(in[0], in[1], in[2]), whole(in[3], WORLEY_NODES));
}

static void bound_worley_any(const void *data, const Interval *in, Interval *out) {
    (void)data;
    *out = interval_is_point(in[3]) ? interval_worley(in, whole(in[3].low, WORLEY_NODES)) : interval_all(true);
}

static const TapeExternal worley_any = {
    .name = "worley", .input_count = 4, .output_count = 1, .eval = eval_worley_any, .bound = bound_worley_any, .hash = {0x776F726C6579, 1}, .work = 60};

static void eval_sparse(const void *data, const double *in, double *out) {
    (void)data;
    out[0] = noise_sparse_convolution(vec3(in[0], in[1], in[2]), whole(in[3], SPARSE_IMPULSES));
}

/* How many impulses must be known. */
static void bound_sparse(const void *data, const Interval *in, Interval *out) {
    (void)data;
    *out = interval_is_point(in[3]) ? interval_sparse_convolution(in, whole(in[3].low, SPARSE_IMPULSES)) : interval_all(true);
}

static void forms_sparse(const void *data, int count, const AffineForm *in, AffineForm *out, struct NodeCache *cells) {
    const AffineForm *impulses = &in[3 * count];
    (void)data;
    if (impulses->slope != 0 || impulses->error != 0 || impulses->nan)
        for (int i = 0; i < count; i++) out[i] = affine_unknown(true);
    else
        affine_sparse_convolution(count, in, int_clamp(whole(impulses->centre, SPARSE_IMPULSES), 1, SPARSE_IMPULSES), out, cells);
}

static void gradient_sparse(const void *data, const double *in, double *slopes) {
    (void)data;
    Vec3 by = noise_sparse_gradient(vec3(in[0], in[1], in[2]), whole(in[3], SPARSE_IMPULSES));
    slopes[0] = by.x, slopes[1] = by.y, slopes[2] = by.z;
}

static const TapeExternal sparse_convolution = {.name = "sparse_convolution",
                                                .input_count = 4,
                                                .output_count = 1,
                                                .eval = eval_sparse,
                                                .bound = bound_sparse,
                                                .forms = forms_sparse,
                                                .gradient = gradient_sparse,
                                                .hash = {0x737061727365, 1},
                                                .work = 60};

/* ---- one octave ---- */

typedef TapeRef CompileNoise(TapeBuilder *tape, const TapeRef place[3], Span span);

static TapeRef perlin_octave(TapeBuilder *tape, const TapeRef place[3], Span span) {
    return tape_ternary(tape, TAPE_PERLIN, place[0], place[1], place[2], span);
}


/* In fbm() the distance to the nearest node, and three impulses a cell. */
static TapeRef worley_octave(TapeBuilder *tape, const TapeRef place[3], Span span) {
    TapeRef out;
    tape_call(tape, &worley_nearest[0], place, &out, span);
    return out;
}

static TapeRef sparse_octave(TapeBuilder *tape, const TapeRef place[3], Span span) {
    const TapeRef in[4] = {place[0], place[1], place[2], tape_constant(tape, 3)};
    TapeRef out;
    tape_call(tape, &sparse_convolution, in, &out, span);
    return out;
}

static const struct {
    const char *name;
    CompileNoise *octave;
} noises[] = {{"perlin", perlin_octave}, {"worley", worley_octave}, {"sparse_convolution", sparse_octave}};

/* ---- calls ---- */

static bool compile_perlin(Eval *ev, TapeBuilder *tape, const Node *call, const TapeRef *a, size_t count,
                           TapeRef *out) {
    (void)ev;
    (void)count;
    *out = perlin_octave(tape, a, call->span);
    return true;
}

static bool compile_worley(Eval *ev, TapeBuilder *tape, const Node *call, const TapeRef *a, size_t count,
                           TapeRef *out) {
    double number;
    (void)ev;
    (void)count;
    if (!tape_is_constant(tape, a[3], &number)) {
        tape_call(tape, &worley_any, a, out, call->span);
        return true;
    }
    TapeRef all[WORLEY_NODES];
    int index = int_min(whole(number, WORLEY_NODES), WORLEY_NODES - 1), set = 1;
    while (worley_last[set] < index) set++;
    tape_call(tape, &worley_nearest[set], a, all, call->span);
    *out = all[index];
    return true;
}

static bool compile_sparse(Eval *ev, TapeBuilder *tape, const Node *call, const TapeRef *a, size_t count,
                           TapeRef *out) {
    (void)ev;
    (void)count;
    tape_call(tape, &sparse_convolution, a, out, call->span);
    return true;
}

static CompileNoise *find_noise(Eval *ev, const Node *name) {
    for (size_t i = 0; name->kind == NODE_NAME && i < VTS_ARRAY_COUNT(noises); i++)
        if (strcmp(noises[i].name, name->as.name->text) == 0) return noises[i].octave;
    diag_error(ev->diags, name->span,
               "fbm() takes the name of a noise first: perlin, sparse_convolution or worley");
    return NULL;
}

/* Σ gainᵏ · noise(lacunarityᵏ · p), k = 0 … octaves - 1, one after the other. a: place, octaves, lacunarity, gain. */
static TapeRef sum_octaves(TapeBuilder *tape, CompileNoise *noise, const TapeRef *a, int octaves, Span span) {
    TapeRef sum = tape_constant(tape, 0), frequency = tape_constant(tape, 1), weight = frequency;
    for (int k = 0; k < octaves; k++) {
        TapeRef place[3];
        for (int i = 0; i < 3; i++) place[i] = tape_binary(tape, TAPE_MUL, a[i], frequency, span);
        TapeRef term = tape_binary(tape, TAPE_MUL, weight, noise(tape, place, span), span);
        sum = k ? tape_binary(tape, TAPE_ADD, sum, term, span) : term;
        frequency = tape_binary(tape, TAPE_MUL, frequency, a[4], span);
        weight = tape_binary(tape, TAPE_MUL, weight, a[5], span);
    }
    return sum;
}

/* fbm(noise, x, y, z, octaves, lacunarity, gain); the octaves are counted when the function is defined. */
static bool compile_fbm(Eval *ev, TapeBuilder *tape, const Node *call, const TapeRef *a, size_t count,
                        TapeRef *out) {
    enum { OCTAVES = 4, MOST = 64 };
    (void)count;
    double octaves = 0;
    CompileNoise *noise = find_noise(ev, call->as.apply.list.items[0]);
    if (!noise) return false;
    Span span = call->as.apply.list.items[OCTAVES]->span;
    if (!tape_is_constant(tape, a[OCTAVES], &octaves)) {
        diag_error(ev->diags, span,
                   "the octaves of fbm() are counted when the function is defined: a number");
        return false;
    }
    if (!(octaves >= 1 && octaves <= MOST)) {
        diag_error(ev->diags, span, "fbm() takes 1 to %d octaves, found %g", MOST, octaves);
        return false;
    }
    *out = sum_octaves(tape, noise, a + 1, (int)octaves, call->span);
    return true;
}

static const KnownFunction known_functions[] = {
    {"perlin", 3, false, compile_perlin, NULL},
    {"worley", 4, false, compile_worley, NULL},
    {"sparse_convolution", 4, false, compile_sparse, NULL},
    {"fbm", 7, true, compile_fbm, NULL},
    {"lsystem_string", 1, false, NULL, eval_lsystem_string},
    {"lsystem_count", 2, false, NULL, eval_lsystem_count},
    {"wind_at", 3, false, NULL, eval_wind_at},
    {"geo", 1, false, NULL, eval_geo},
    {"geo_inverse", 1, false, NULL, eval_geo_inverse},
    {"geodesic", 2, false, NULL, eval_geodesic},
    {"utm", 1, false, NULL, eval_utm},
    {"sun_direction", 2, false, NULL, eval_sun_direction},
    {"terrain_height", 2, false, NULL, eval_terrain_height},
};

const KnownFunction *known_function_find(Name name) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(known_functions); i++)
        if (strcmp(known_functions[i].name, name->text) == 0) return &known_functions[i];
    return NULL;
}

bool known_function_takes(Eval *ev, const Node *call, const KnownFunction *f) {
    const char *what = arena_printf(&ev->temp, "'%s'", f->name);
    size_t takes = f->arguments;
    return eval_argument_count(ev, call->span, what, takes, takes, call->as.apply.list.count, NULL);
}

/* Called outside of functions: as a tape of constants. */
Value call_known_function(Eval *ev, const Node *node, bool *known) {
    const KnownFunction *f = known_function_find(node->as.apply.base->as.name);
    *known = f != NULL;
    if (!f) return value_error();
    const NodeList *list = &node->as.apply.list;
    if (!known_function_takes(ev, node, f)) return value_error();
    if (f->value) return f->value(ev, node);
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
