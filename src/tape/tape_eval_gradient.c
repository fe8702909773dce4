/* The arithmetic of dual numbers: value + Σ by[k]·εₖ with εᵢ·εₖ = 0. */
#include "tape/derivative.h"
#include "tape/tape_gradient.h"
#include "tape/tape_program.h"
#include "tape/tape_scalar.h"

static Dual dual_point(double x) { return (Dual){x, {0, 0, 0}}; }
static bool is_constant(Dual a) { return a.by[0] == 0 && a.by[1] == 0 && a.by[2] == 0; }

/* a·x' + b·y'; a derivative of 0 counts even where its factor is infinite. */
static double weighed(double a, double x, double b, double y) { return (x == 0 ? 0 : a * x) + (y == 0 ? 0 : b * y); }

static Dual chain2(double value, double first, Dual a, double second, Dual b) {
    Dual out = {value, {0, 0, 0}};
    for (int k = 0; k < 3; k++) out.by[k] = weighed(first, a.by[k], second, b.by[k]);
    return out;
}
static Dual chain(double value, double slope, Dual a) { return chain2(value, slope, a, 0, dual_point(0)); }

static Dual dual_ADD(Dual a, Dual b) { return chain2(a.value + b.value, 1, a, 1, b); }
static Dual dual_SUB(Dual a, Dual b) { return chain2(a.value - b.value, 1, a, -1, b); }
static Dual dual_MUL(Dual a, Dual b) { return chain2(a.value * b.value, b.value, a, a.value, b); }
static Dual dual_DIV(Dual a, Dual b) { return chain2(a.value / b.value, 1 / b.value, a, -(a.value / b.value) / b.value, b); }
static Dual dual_NEG(Dual a) { return chain(-a.value, -1, a); }
static Dual dual_SQR(Dual a) { return chain(a.value * a.value, 2 * a.value, a); }
static Dual dual_ABS(Dual a) { return a.value < 0 ? dual_NEG(a) : a; }
static Dual dual_MIN(Dual a, Dual b) { return a.value < b.value ? a : b; }
static Dual dual_MAX(Dual a, Dual b) { return a.value > b.value ? a : b; }
static Dual dual_SELECT(Dual a, Dual b, Dual c) { return a.value < 0 ? b : c; }
static Dual dual_MOD(Dual a, Dual b) { return chain2(fmod(a.value, b.value), 1, a, -trunc(a.value / b.value), b); }
static Dual dual_FOLD(Dual a, Dual b) {
    double period = fabs(b.value), rest = a.value - period * (floor(a.value / period) + 0.5), side = rest < 0 ? -1 : 1;
    return chain2(scalar_FOLD(a.value, b.value), side, a, b.value < 0 ? (a.value - rest) / period * side : -((a.value - rest) / period) * side, b);
}
static Dual dual_DEGREES(Dual a) { return chain(scalar_DEGREES(a.value), 180.0 / VTS_PI, a); }
static Dual dual_RADIANS(Dual a) { return chain(scalar_RADIANS(a.value), VTS_RADIANS, a); }

static Dual dual_POW(Dual a, Dual b) {
    double value = scalar_POW(a.value, b.value);
    return chain2(value, b.value * pow(a.value, b.value - 1), a, is_constant(b) ? 0 : value * log(a.value), b);
}

static Dual dual_ATAN2(Dual a, Dual b) {
    double square = a.value * a.value + b.value * b.value;
    return chain2(scalar_ATAN2(a.value, b.value), b.value / square, a, -a.value / square, b);
}

#define DUAL_CONSTANT(x) (x)
#define DUAL_SMOOTH(name)                                                                  \
    static Dual dual_##name(Dual a) {                                                      \
        double y = scalar_##name(a.value);                                                 \
        return chain(y, DERIVATIVE_##name(scalar, DUAL_CONSTANT, a.value, y), a);          \
    }
DUAL_SMOOTH(SQRT)
DUAL_SMOOTH(EXP)
DUAL_SMOOTH(LN)
DUAL_SMOOTH(LOG)
DUAL_SMOOTH(SIN)
DUAL_SMOOTH(COS)
DUAL_SMOOTH(TAN)
DUAL_SMOOTH(ASIN)
DUAL_SMOOTH(ACOS)
DUAL_SMOOTH(ATAN)
DUAL_SMOOTH(SINH)
DUAL_SMOOTH(COSH)
DUAL_SMOOTH(TANH)
DUAL_SMOOTH(ASINH)
DUAL_SMOOTH(ACOSH)
DUAL_SMOOTH(ATANH)

/* Operations that are constant between jumps. */
#define DUAL_STEP_1(name) static Dual dual_##name(Dual a) { return dual_point(scalar_##name(a.value)); }
#define DUAL_STEP_2(name) static Dual dual_##name(Dual a, Dual b) { return dual_point(scalar_##name(a.value, b.value)); }
DUAL_STEP_1(FLOOR)
DUAL_STEP_1(CEIL)
DUAL_STEP_1(INT)
DUAL_STEP_2(IDIV)
DUAL_STEP_2(BITWISE_AND)
DUAL_STEP_2(BITWISE_OR)
DUAL_STEP_2(BITWISE_XOR)
DUAL_STEP_2(LT)
DUAL_STEP_2(LE)
DUAL_STEP_2(GT)
DUAL_STEP_2(GE)
DUAL_STEP_2(EQ)
DUAL_STEP_2(NE)
DUAL_STEP_2(AND)
DUAL_STEP_2(OR)

static Dual along(double value, const double gradient[3], Dual a, Dual b, Dual c) {
    Dual out = chain2(value, gradient[0], a, gradient[1], b);
    for (int k = 0; k < 3; k++) out.by[k] += weighed(gradient[2], c.by[k], 0, 0);
    return out;
}

static Dual dual_PERLIN(Dual a, Dual b, Dual c) {
    double gradient[3];
    Vec3 p = vec3(a.value, b.value, c.value);
    noise_perlin_gradient(p, gradient);
    return along(noise_perlin(p), gradient, a, b, c);
}

static Dual dual_POV_NOISE(Dual a, Dual b, Dual c) {
    double gradient[3], raw;
    Vec3 p = vec3(a.value, b.value, c.value);
    raw = noise_pov_gradient3(p, gradient);
    return raw < 0 || raw > 1 ? dual_point(noise_pov(p)) : along(noise_pov(p), gradient, a, b, c);
}

/* ---- externals and loops ---- */

static const double STEP = 1e-6; /* of a coordinate, or of 1 */

/* slopes[k·inputs + j]: of output k by input j, where that input changes at all. */
static void compare(const TapeExternal *external, const Dual *in, const double *at, double *slopes) {
    double moved[TAPE_CALL_MAX], before[TAPE_CALL_MAX], behind[TAPE_CALL_MAX];
    for (int j = 0; j < external->input_count; j++) moved[j] = at[j];
    for (int j = 0; j < external->input_count; j++) {
        if (is_constant(in[j])) continue;
        double step = STEP * fmax(1, fabs(at[j])), high = at[j] + step, low = at[j] - step;
        moved[j] = low, external->eval(external->data, moved, before);
        moved[j] = high, external->eval(external->data, moved, behind);
        moved[j] = at[j];
        for (int k = 0; k < external->output_count; k++) slopes[k * external->input_count + j] = (behind[k] - before[k]) / (high - low);
    }
}

static void call(const TapeCall *call_, Dual *slots) {
    const TapeExternal *external = call_->external;
    int inputs = external->input_count;
    Dual in[TAPE_CALL_MAX];
    double at[TAPE_CALL_MAX], value[TAPE_CALL_MAX], slopes[TAPE_CALL_MAX * TAPE_CALL_MAX] = {0};
    for (int j = 0; j < inputs; j++) in[j] = slots[call_->arg_slots[j]], at[j] = in[j].value;
    external->eval(external->data, at, value);
    (external->gradient ? external->gradient(external->data, at, slopes) : compare(external, in, at, slopes));
    for (int k = 0; k < external->output_count; k++) {
        if (call_->result_slots[k] == TAPE_NO_SLOT) continue;
        Dual out = dual_point(value[k]);
        for (int j = 0; j < inputs; j++)
            for (int axis = 0; axis < 3; axis++) out.by[axis] += weighed(slopes[k * inputs + j], in[j].by[axis], 0, 0);
        slots[call_->result_slots[k]] = out;
    }
}

static void walk(const Tape *tape, Dual *slots);

static void load_constants(const Tape *tape, Dual *slots) {
    for (uint32_t k = 0; k < tape->constant_count; k++) slots[tape->input_count + k] = dual_point(tape->constants[k]);
}

static Dual loop(const TapeLoop *loop_, bool product, Dual from, Dual to, const Dual *slots, Dual *scratch) {
    const Tape *body = loop_->body;
    double passes = to.value - from.value, i = from.value;
    Dual total = dual_point(product ? 1 : 0);
    if (!(passes < TAPE_LOOP_LIMIT)) return dual_point((double)NAN);
    for (uint32_t k = 0; k < loop_->captured_count; k++) scratch[k] = slots[loop_->captured_slots[k]];
    load_constants(body, scratch);
    for (double pass = 0; i <= to.value && pass <= passes; pass++, i += 1) {
        scratch[body->input_count - 1] = dual_point(i);
        walk(body, scratch);
        Dual term = scratch[body->output_slots[0]];
        total = product ? dual_MUL(total, term) : dual_ADD(total, term);
    }
    return total;
}

#define WALK_STEP_1(name) slots[step->dst] = dual_##name(slots[step->a])
#define WALK_STEP_2(name) slots[step->dst] = dual_##name(slots[step->a], slots[step->b])
#define WALK_STEP_3(name) slots[step->dst] = dual_##name(slots[step->a], slots[step->b], slots[step->c])
#define WALK_CALL         call(&tape->calls[step->c], slots)
#define WALK_LOOP(product) \
    slots[step->dst] = loop(&tape->loops[step->c], product, slots[step->a], slots[step->b], slots, slots + tape->slot_count)

static void walk(const Tape *tape, Dual *slots) {
#include "tape/tape_walk.inc"
}

Dual tape_eval_gradient(const Tape *tape, Vec3 p, Dual *scratch) {
    const double at[3] = {p.x, p.y, p.z};
    for (uint32_t k = 0; k < tape->input_count && k < 3; k++) {
        scratch[k] = dual_point(at[k]);
        scratch[k].by[k] = 1;
    }
    load_constants(tape, scratch);
    walk(tape, scratch);
    return scratch[tape->output_slots[0]];
}
