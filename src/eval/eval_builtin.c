#include "eval/eval_state.h"

#include "base/random.h"
#include "tape/noise.h"

#include <math.h>
#include <time.h>

bool eval_argument_count(Eval *ev, Span span, const char *what, size_t least, size_t most, size_t given,
                         Diagnostic **reported) {
    Diagnostic *d = NULL;
    if (given < least)
        d = diag_error(ev->diags, span, "too few arguments for %s: expected %s%zu, found %zu", what,
                       least == most ? "" : "at least ", least, given);
    else if (given > most)
        d = diag_error(ev->diags, span, "too many arguments for %s: expected %s%zu, found %zu", what,
                       least == most ? "" : "at most ", most, given);
    if (reported) *reported = d;
    return given >= least && given <= most;
}

bool builtin_argument_count(Eval *ev, const Node *node, size_t least, size_t most) {
    size_t count = node->as.list.count;
    if (count >= least && count <= most) return true;
    const char *what = arena_printf(&ev->temp, "'%s'", keyword_text((Keyword)node->op));
    return eval_argument_count(ev, node->span, what, least, most, count, NULL);
}

static double out_of_domain(Eval *ev, const Node *node, const char *name, double value, double fallback) {
    diag_warning(ev->diags, node->span, "%s(%g) is outside the function's domain; %g is taken", name, value,
                 fallback);
    return fallback;
}

static double one_argument(Eval *ev, const Node *node, double a, bool *failed) {
    switch (node->op) {
    case KW_abs: return fabs(a);
    case KW_acos:
        return a > 1    ? out_of_domain(ev, node, "acos", a, 0)
               : a < -1 ? out_of_domain(ev, node, "acos", a, VTS_PI)
                        : acos(a);
    case KW_asin:
        return a > 1    ? out_of_domain(ev, node, "asin", a, VTS_PI / 2)
               : a < -1 ? out_of_domain(ev, node, "asin", a, -VTS_PI / 2)
                        : asin(a);
    case KW_acosh: return acosh(a);
    case KW_asinh: return asinh(a);
    case KW_atan: return atan(a);
    case KW_atanh: return atanh(a);
    case KW_ceil: return ceil(a);
    case KW_cos: return cos(a);
    case KW_cosh: return cosh(a);
    case KW_cube: return a * a * a;
    case KW_degrees: return a / VTS_RADIANS;
    case KW_exp: return exp(a);
    case KW_floor: return floor(a);
    case KW_int: return value_to_int(a);
    case KW_radians: return a * VTS_RADIANS;
    case KW_sin: return sin(a);
    case KW_sinh: return sinh(a);
    case KW_sqr: return a * a;
    case KW_tan: return tan(a);
    case KW_tanh: return tanh(a);
    case KW_ln:
    case KW_log:
        if (a > 0) return node->op == KW_ln ? log(a) : log10(a);
        diag_error(ev->diags, node->span, "%s(%g): the logarithm needs a number above 0",
                   keyword_text((Keyword)node->op), a);
        break;
    case KW_sqrt:
        if (!(a < 0)) return sqrt(a);
        diag_error(ev->diags, node->span, "sqrt(%g): the square root of a negative number", a);
        break;
    default: break;
    }
    *failed = true;
    return 0;
}

static Value float_function(Eval *ev, const Node *node) {
    double a;
    bool failed = false;
    if (!builtin_argument_count(ev, node, 1, 1) || !eval_float(ev, node->as.list.items[0], &a))
        return value_error();
    double result = one_argument(ev, node, a, &failed);
    return failed ? value_error() : value_float(result);
}

static bool two_floats(Eval *ev, const Node *node, double *a, double *b) {
    if (!builtin_argument_count(ev, node, 2, 2)) return false;
    bool first = eval_float(ev, node->as.list.items[0], a);
    return eval_float(ev, node->as.list.items[1], b) && first;
}

static Value two_arguments(Eval *ev, const Node *node) {
    double a, b;
    if (!two_floats(ev, node, &a, &b)) return value_error();
    switch (node->op) {
    case KW_atan2:
        if (a == 0 && b == 0) return eval_fail(ev, node->span, "atan2(0, 0) has no value");
        return value_float(atan2(a, b));
    case KW_div:
        if (b == 0) diag_warning(ev->diags, node->span, "div() by zero");
        return value_float(value_to_int(a / b));
    case KW_mod: return value_float(fmod(a, b));
    default:
        if (a == 0 && b == 0) return eval_fail(ev, node->span, "pow(0, 0) has no value");
        if ((a < 0 && b != trunc(b)) || (a == 0 && b < 0))
            diag_warning(ev->diags, node->span, "pow(%g, %g) has no finite value", a, b);
        return value_float(pow(a, b));
    }
}

static double fold_two(int op, double a, double b) {
    switch (op) {
    case KW_min: return b < a ? b : a; /* of 0 and -0 the first, as in POV-Ray */
    case KW_max: return b > a ? b : a;
    case KW_bitwise_and: return (int32_t)a & (int32_t)b;
    case KW_bitwise_or: return (int32_t)a | (int32_t)b;
    default: return (int32_t)a ^ (int32_t)b;
    }
}

/* min, max and the bitwise functions: any number of arguments. */
static Value many_arguments(Eval *ev, const Node *node) {
    if (!builtin_argument_count(ev, node, 1, SIZE_MAX)) return value_error();
    bool bits = node->op != KW_min && node->op != KW_max;
    double result = 0;
    for (size_t i = 0; i < node->as.list.count; i++) {
        double a;
        if (!eval_float(ev, node->as.list.items[i], &a)) return value_error();
        if (bits) a = value_to_int(a);
        result = i == 0 ? a : fold_two(node->op, result, a);
    }
    return value_float(result);
}

static Value select_value(Eval *ev, const Node *node) {
    if (!builtin_argument_count(ev, node, 3, 4)) return value_error();
    double test;
    Value v[3] = {{0}};
    size_t count = node->as.list.count - 1;
    bool ok = eval_float(ev, node->as.list.items[0], &test);
    for (size_t i = 0; i < count; i++) v[i] = eval_node(ev, node->as.list.items[i + 1]);
    if (!ok) return value_error();
    if (test < 0) return v[0];
    return count == 3 && test != 0 ? v[2] : v[1];
}

static bool vector_argument(Eval *ev, const Node *node, size_t i, double out[3]) {
    Value v = eval_node(ev, node->as.list.items[i]);
    return value_to_vector(ev, &v, node->as.list.items[i]->span, out, 3);
}

static Value vec3_value(Eval *ev, Vec3 v) { return value_vector(ev, (double[]){v.x, v.y, v.z}, 3); }

static Value vector_function(Eval *ev, const Node *node) {
    bool single = node->op == KW_vlength || node->op == KW_vnormalize;
    double c[2][3] = {{0}};
    if (!builtin_argument_count(ev, node, single ? 1 : 2, single ? 1 : 2) ||
        !vector_argument(ev, node, 0, c[0]) || (!single && !vector_argument(ev, node, 1, c[1])))
        return value_error();
    Vec3 a = vec3(c[0][0], c[0][1], c[0][2]), b = vec3(c[1][0], c[1][1], c[1][2]);
    switch (node->op) {
    case KW_vlength: return value_float(vec3_length(a));
    case KW_vnormalize:
        if (vec3_length(a) == 0)
            diag_warning(ev->diags, node->span, "a vector without length has no direction");
        return vec3_value(ev, vec3_normalize(a));
    case KW_vdot: return value_float(vec3_dot(a, b));
    case KW_vcross: return vec3_value(ev, vec3_cross(a, b));
    default: {
        Transform t = transform_rotate(b);
        return vec3_value(ev, transform_point(&t, a));
    }
    }
}

static Value vaxis_rotate(Eval *ev, const Node *node) {
    double a[3], axis[3], degrees;
    if (!builtin_argument_count(ev, node, 3, 3) || !vector_argument(ev, node, 0, a) ||
        !vector_argument(ev, node, 1, axis) || !eval_float(ev, node->as.list.items[2], &degrees))
        return value_error();
    Transform t = transform_axis_rotate(vec3(axis[0], axis[1], axis[2]), degrees);
    return vec3_value(ev, transform_point(&t, vec3(a[0], a[1], a[2])));
}

/* vturbulence(lambda, omega, octaves, point) = Σ omegaᵏ · noise(lambdaᵏ · point) */
static Value vturbulence(Eval *ev, const Node *node) {
    double a[3], p[3];
    if (!builtin_argument_count(ev, node, 4, 4)) return value_error();
    for (size_t i = 0; i < 3; i++)
        if (!eval_float(ev, node->as.list.items[i], &a[i])) return value_error();
    if (!vector_argument(ev, node, 3, p)) return value_error();
    Vec3 at = vec3(p[0], p[1], p[2]), sum = vec3_splat(0);
    int octaves = int_clamp(double_to_int(a[2], 0, 100), 1, 10);
    double scale = 1, weight = 1;
    for (int k = 0; k < octaves; k++, scale *= a[0], weight *= a[1])
        sum = vec3_madd(sum, noise_pov_vector(vec3_scale(at, scale)), weight);
    return vec3_value(ev, sum);
}

static Value seed_stream(Eval *ev, const Node *node) {
    double s;
    if (!builtin_argument_count(ev, node, 1, 1) || !eval_float(ev, node->as.list.items[0], &s))
        return value_error();
    struct {
        uint32_t *items;
        size_t count, capacity;
    } list = {ev->streams, ev->stream_count, ev->stream_capacity};
    *list_push(ev->parse, &list) = (uint32_t)(int32_t)value_to_int(s);
    ev->streams = list.items;
    ev->stream_count = list.count;
    ev->stream_capacity = list.capacity;
    return value_float((double)(list.count - 1));
}

static Value rand_next(Eval *ev, const Node *node) {
    double s;
    if (!builtin_argument_count(ev, node, 1, 1) || !eval_float(ev, node->as.list.items[0], &s))
        return value_error();
    if (!(s >= 0 && s < (double)ev->stream_count))
        return eval_fail(ev, node->span, "rand() needs a stream made by seed()");
    return value_float(random_pov_next(&ev->streams[(size_t)s]));
}

static Value defined_value(Eval *ev, const Node *node) {
    bool failed = false;
    Slot *slot = eval_target(ev, node->as.list.items[0], &failed);
    bool is = slot && slot->set && !(slot->value.kind == VALUE_FILE && !file_is_open(slot->value.as.file));
    return failed ? value_error() : value_float(is);
}

/* Rows of an array have sizes too. */
static Value array_argument(Eval *ev, const Node *node) {
    if (node->kind != NODE_INDEX) return eval_node(ev, node);
    bool failed = false;
    const Slot *slot = eval_target(ev, node, &failed);
    return slot && slot->set ? slot->value : failed ? value_error() : eval_node(ev, node);
}

static Value dimensions(Eval *ev, const Node *node) {
    bool sized = node->op == KW_dimension_size;
    if (!builtin_argument_count(ev, node, sized ? 2 : 1, sized ? 2 : 1)) return value_error();
    Value v = array_argument(ev, node->as.list.items[0]);
    double which = 1;
    if (sized && !eval_float(ev, node->as.list.items[1], &which)) return value_error();
    if (v.kind == VALUE_ERROR) return v;
    if (v.kind != VALUE_ARRAY)
        return eval_fail(ev, node->as.list.items[0]->span, "expected an array, found %s",
                         value_kind_text(v.kind));
    if (!sized) return value_float(array_rank(v.as.array));
    return value_float(!(which >= 1 && which <= 64) ? 0 : (double)array_extent(v.as.array, (int)which - 1));
}

/* Days since 2000-01-01 00:00 UTC. */
static double days_now(void) { return ((double)time(NULL) - 946684800.0) / 86400; }

Value eval_constant(Eval *ev, const Node *node) {
    const EvalOptions *o = ev->options;
    switch (node->op) {
    case KW_x: return value_vector(ev, (double[]){1, 0, 0}, 3);
    case KW_y: return value_vector(ev, (double[]){0, 1, 0}, 3);
    case KW_z: return value_vector(ev, (double[]){0, 0, 1}, 3);
    case KW_t: return value_vector(ev, (double[]){0, 0, 0, 1}, 4);
    case KW_u: return value_vector(ev, (double[]){1, 0}, 2);
    case KW_v: return value_vector(ev, (double[]){0, 1}, 2);
    case KW_pi: return value_float(VTS_PI);
    case KW_on:
    case KW_yes:
    case KW_true: return value_float(1);
    case KW_off:
    case KW_no:
    case KW_false: return value_float(0);
    case KW_clock: return value_float(o->clock);
    case KW_clock_on: return value_float(o->clock_on);
    case KW_clock_delta: return value_float(o->clock_delta);
    case KW_frame_number: return value_float(o->frame_number);
    case KW_initial_frame: return value_float(o->initial_frame);
    case KW_final_frame: return value_float(o->final_frame);
    case KW_initial_clock: return value_float(o->initial_clock);
    case KW_final_clock: return value_float(o->final_clock);
    case KW_image_width: return value_float(o->image_width);
    case KW_image_height: return value_float(o->image_height);
    case KW_now: return value_float(days_now());
    case KW_version: return value_float(ev->version);
    case KW_phase:
        if (ev->has_phase) return value_float(ev->phase);
        return eval_fail(ev, node->span, "'phase' is a number only within a texel's phases");
    default: return value_error();
    }
}

Value eval_builtin(Eval *ev, const Node *node) {
    switch (node->op) {
    case KW_atan2:
    case KW_div:
    case KW_mod:
    case KW_pow: return two_arguments(ev, node);
    case KW_min:
    case KW_max:
    case KW_bitwise_and:
    case KW_bitwise_or:
    case KW_bitwise_xor: return many_arguments(ev, node);
    case KW_select: return select_value(ev, node);
    case KW_vlength:
    case KW_vnormalize:
    case KW_vdot:
    case KW_vcross:
    case KW_vrotate: return vector_function(ev, node);
    case KW_vaxis_rotate: return vaxis_rotate(ev, node);
    case KW_seed: return seed_stream(ev, node);
    case KW_rand: return rand_next(ev, node);
    case KW_defined: return defined_value(ev, node);
    case KW_dimensions:
    case KW_dimension_size: return dimensions(ev, node);
    case KW_asc:
    case KW_chr:
    case KW_concat:
    case KW_datetime:
    case KW_file_exists:
    case KW_str:
    case KW_strcmp:
    case KW_strlen:
    case KW_strlwr:
    case KW_strupr:
    case KW_substr:
    case KW_val:
    case KW_vstr: return eval_builtin_string(ev, node);
    case KW_min_extent:
    case KW_max_extent: return eval_extent(ev, node);
    case KW_inside:
    case KW_trace: return eval_geometry(ev, node);
    case KW_vturbulence: return vturbulence(ev, node);
    case KW_internal:
    case KW_sum:
    case KW_prod:
        diag_error(ev->diags, node->span, "%s() is not available here", keyword_text((Keyword)node->op));
        return value_error();
    default: return float_function(ev, node);
    }
}
