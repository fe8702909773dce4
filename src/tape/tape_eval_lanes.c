/* The arithmetic of reduced affine forms over lanes. Operations that functions of places consist of have loops of their own; the
 * others go lane by lane through affine.h. */
#include "tape/tape_lanes.h"

#include "tape/affine_lanes_curves.h"
#include "tape/affine_noise.h"
#include "tape/tape_affine.h"
#include "tape/tape_program.h"

static void walk(const Tape *tape, AffineLanes *slots, struct NodeCache *cells);

/* Constants have no lanes: they are read from the tape. */
static inline bool is_constant(const Tape *tape, uint32_t slot) {
    return slot - tape->input_count < tape->constant_count;
}
static inline double constant_at(const Tape *tape, uint32_t slot) {
    return tape->constants[slot - tape->input_count];
}

static inline const AffineLanes *operand(const Tape *tape, const AffineLanes *slots, uint32_t slot,
                                         AffineLanes *filled) {
    if (!is_constant(tape, slot)) return &slots[slot];
    affine_fill_lanes(filled, constant_at(tape, slot));
    return filled;
}

static AffineForm lane_of(const Tape *tape, const AffineLanes *slots, uint32_t slot, int lane) {
    return is_constant(tape, slot) ? affine_point(constant_at(tape, slot)) : affine_lane(&slots[slot], lane);
}

static void call_forms(const Tape *tape, const TapeCall *call_, AffineLanes *slots, struct NodeCache *cells) {
    const TapeExternal *external = call_->external;
    AffineForm in[TAPE_CALL_MAX * AFFINE_LANES], out[TAPE_CALL_MAX * AFFINE_LANES];
    for (int k = 0; k < external->input_count; k++)
        AFFINE_EACH_LANE in[k * AFFINE_LANES + l] = lane_of(tape, slots, call_->arg_slots[k], l);
    external->forms(external->data, AFFINE_LANES, in, out, cells);
    for (int k = 0; k < external->output_count; k++)
        if (call_->result_slots[k] != TAPE_NO_SLOT)
            AFFINE_EACH_LANE affine_set_lane(&slots[call_->result_slots[k]], l, out[k * AFFINE_LANES + l]);
}

static void call(const Tape *tape, const TapeCall *call_, AffineLanes *slots, struct NodeCache *cells) {
    const TapeExternal *external = call_->external;
    if (external->forms) {
        call_forms(tape, call_, slots, cells);
        return;
    }
    for (int l = 0; l < AFFINE_LANES; l++) {
        Interval in[TAPE_CALL_MAX], range[TAPE_CALL_MAX];
        for (int k = 0; k < external->input_count; k++)
            in[k] = affine_range(lane_of(tape, slots, call_->arg_slots[k], l));
        if (external->bound) external->bound(external->data, in, range);
        for (int k = 0; k < external->output_count; k++)
            if (call_->result_slots[k] != TAPE_NO_SLOT)
                affine_set_lane(&slots[call_->result_slots[k]], l,
                                external->bound ? affine_of_interval(range[k]) : affine_unknown(true));
    }
}

/* As in tape_bounds.inc, between constants alone. */
enum { MOST_PASSES = 4096 };

static void loop(const Tape *tape, const TapeLoop *loop_, const TapeStep *step, bool product,
                 AffineLanes *slots, AffineLanes *scratch, struct NodeCache *cells) {
    const Tape *body = loop_->body;
    AffineLanes *out = &slots[step->dst], before, filled;
    AFFINE_EACH_LANE out->centre[l] = out->slope[l] = 0, out->error[l] = HUGE_VAL;
    if (!is_constant(tape, step->a) || !is_constant(tape, step->b)) return;
    double from = constant_at(tape, step->a), to = constant_at(tape, step->b), i = from;
    if (!(to - from < MOST_PASSES)) return;
    for (uint32_t k = 0; k < loop_->captured_count; k++)
        scratch[k] = *operand(tape, slots, loop_->captured_slots[k], &filled);
    affine_fill_lanes(out, product ? 1 : 0);
    for (double pass = 0; i <= to && pass <= to - from; pass++, i += 1) {
        affine_fill_lanes(&scratch[body->input_count - 1], i);
        walk(body, scratch, cells);
        const AffineLanes *term = operand(body, scratch, body->output_slots[0], &filled);
        before = *out;
        product ? affine_mul_lanes(out, &before, term) : affine_add_lanes(out, &before, term);
    }
}

static void general(const Tape *tape, const TapeStep *step, AffineLanes *slots) {
    int arity = tape_op_arity((TapeOp)step->op);
    for (int l = 0; l < AFFINE_LANES; l++) {
        AffineForm a = lane_of(tape, slots, step->a, l), b = a, c = a;
        if (arity > 1) b = lane_of(tape, slots, step->b, l);
        if (arity > 2) c = lane_of(tape, slots, step->c, l);
        affine_set_lane(&slots[step->dst], l, tape_apply_affine((TapeOp)step->op, a, b, c));
    }
}

static void add(const Tape *tape, const TapeStep *step, AffineLanes *slots) {
    if (is_constant(tape, step->a))
        affine_shift_lanes(&slots[step->dst], &slots[step->b], constant_at(tape, step->a));
    else if (is_constant(tape, step->b))
        affine_shift_lanes(&slots[step->dst], &slots[step->a], constant_at(tape, step->b));
    else
        affine_add_lanes(&slots[step->dst], &slots[step->a], &slots[step->b]);
}

static void sub(const Tape *tape, const TapeStep *step, AffineLanes *slots) {
    AffineLanes filled;
    if (is_constant(tape, step->b))
        affine_shift_lanes(&slots[step->dst], &slots[step->a], -constant_at(tape, step->b));
    else
        affine_sub_lanes(&slots[step->dst], operand(tape, slots, step->a, &filled), &slots[step->b]);
}

static void mul(const Tape *tape, const TapeStep *step, AffineLanes *slots) {
    if (is_constant(tape, step->a))
        affine_scale_lanes(&slots[step->dst], &slots[step->b], constant_at(tape, step->a));
    else if (is_constant(tape, step->b))
        affine_scale_lanes(&slots[step->dst], &slots[step->a], constant_at(tape, step->b));
    else
        affine_mul_lanes(&slots[step->dst], &slots[step->a], &slots[step->b]);
}

/* x/k is x·(1/k) but for half a unit of 1/k, which affine_scale_lanes() allows for. */
static void divide(const Tape *tape, const TapeStep *step, AffineLanes *slots) {
    double by = is_constant(tape, step->b) ? constant_at(tape, step->b) : 0;
    if (fabs(by) > 0x1p-500 && fabs(by) < 0x1p500)
        affine_scale_lanes(&slots[step->dst], &slots[step->a], 1 / by);
    else
        general(tape, step, slots);
}

static void noise(const Tape *tape, const TapeStep *step, AffineLanes *slots, NoiseKind kind) {
    AffineLanes filled[3];
    const AffineLanes *p[3] = {operand(tape, slots, step->a, &filled[0]),
                               operand(tape, slots, step->b, &filled[1]),
                               operand(tape, slots, step->c, &filled[2])};
    affine_noise_lanes(&slots[step->dst], p, kind);
}

static void wave(const Tape *tape, const TapeStep *step, AffineLanes *slots) {
    if (affine_small_angles(&slots[step->a]))
        affine_wave_lanes(&slots[step->dst], &slots[step->a], step->op == TAPE_COS);
    else
        general(tape, step, slots);
}

static void angle(const Tape *tape, const TapeStep *step, AffineLanes *slots) {
    AffineLanes filled[2];
    const AffineLanes *y = operand(tape, slots, step->a, &filled[0]), *x = operand(tape, slots, step->b, &filled[1]);
    if (affine_plain_angles(y, x))
        affine_angle_lanes(&slots[step->dst], y, x);
    else
        general(tape, step, slots);
}

static void fold(const Tape *tape, const TapeStep *step, AffineLanes *slots) {
    double period = is_constant(tape, step->b) ? fabs(constant_at(tape, step->b)) : 0;
    if (period > 0x1p-500 && period < 0x1p500)
        affine_fold_lanes(&slots[step->dst], &slots[step->a], period);
    else
        general(tape, step, slots);
}

/* Whole powers of negative numbers have values. */
static void power(const Tape *tape, const TapeStep *step, AffineLanes *slots) {
    double by = is_constant(tape, step->b) ? constant_at(tape, step->b) : 0;
    if (by != floor(by) && !is_constant(tape, step->a))
        affine_pow_lanes(&slots[step->dst], &slots[step->a], by);
    else
        general(tape, step, slots);
}

static void lesser(const Tape *tape, const TapeStep *step, AffineLanes *slots) {
    AffineLanes filled[2];
    affine_lesser_lanes(&slots[step->dst], operand(tape, slots, step->a, &filled[0]), operand(tape, slots, step->b, &filled[1]), step->op == TAPE_MAX);
}

static void select_lanes(const Tape *tape, const TapeStep *step, AffineLanes *slots) {
    AffineLanes filled[2];
    affine_select_lanes(&slots[step->dst], &slots[step->a], operand(tape, slots, step->b, &filled[0]), operand(tape, slots, step->c, &filled[1]));
}

static void walk(const Tape *tape, AffineLanes *slots, struct NodeCache *cells) {
    for (const TapeStep *step = tape->steps, *end = step + tape->step_count; step < end; step++) {
        switch ((TapeOp)step->op) {
        case TAPE_ADD: add(tape, step, slots); break;
        case TAPE_SUB: sub(tape, step, slots); break;
        case TAPE_MUL: mul(tape, step, slots); break;
        case TAPE_DIV: divide(tape, step, slots); break;
        case TAPE_NEG: affine_neg_lanes(&slots[step->dst], &slots[step->a]); break;
        case TAPE_SQR: affine_sqr_lanes(&slots[step->dst], &slots[step->a]); break;
        case TAPE_SQRT: affine_sqrt_lanes(&slots[step->dst], &slots[step->a]); break;
        case TAPE_SIN:
        case TAPE_COS: wave(tape, step, slots); break;
        case TAPE_EXP: affine_exp_lanes(&slots[step->dst], &slots[step->a]); break;
        case TAPE_ATAN2: angle(tape, step, slots); break;
        case TAPE_POW: power(tape, step, slots); break;
        case TAPE_FOLD: fold(tape, step, slots); break;
        case TAPE_ABS: affine_abs_lanes(&slots[step->dst], &slots[step->a]); break;
        case TAPE_MIN:
        case TAPE_MAX: lesser(tape, step, slots); break;
        case TAPE_SELECT: select_lanes(tape, step, slots); break;
        case TAPE_PERLIN: noise(tape, step, slots, NOISE_IS_PERLIN); break;
        case TAPE_POV_NOISE: noise(tape, step, slots, NOISE_IS_POV); break;
        case TAPE_CALL: call(tape, &tape->calls[step->c], slots, cells); break;
        case TAPE_SUM:
        case TAPE_PROD:
            loop(tape, &tape->loops[step->c], step, step->op == TAPE_PROD, slots, slots + tape->slot_count, cells);
            break;
        default: general(tape, step, slots); break;
        }
    }
}

void tape_eval_lanes(const Tape *tape, const AffineLanes *in, AffineLanes *out, AffineLanes *scratch) {
    AffineLanes filled;
    for (uint32_t k = 0; k < tape->input_count; k++) scratch[k] = in[k];
    *out = *tape_eval_lanes_again(tape, scratch, &filled, NULL);
}

const AffineLanes *tape_eval_lanes_again(const Tape *tape, AffineLanes *scratch, AffineLanes *filled, struct NodeCache *cells) {
    walk(tape, scratch, cells);
    return operand(tape, scratch, tape->output_slots[0], filled);
}
