/* Functions as sums: fractal surfaces are, and most of their terms matter only near the surface. */
#include "tape/tape_builder.h"
#include "tape/tape_detail.h"
#include "tape/tape_interval.h"
#include "tape/tape_lanes.h"
#include "tape/tape_noise.h"

#include <stdlib.h>

typedef struct Part {
    TapeRef node;
    double scale;
} Part;

typedef struct Split {
    const Tape *tape;
    Part parts[TAPE_TERMS_MOST];
    size_t count;
    double constant;
    bool failed;
} Split;

static bool constant_of(const Tape *tape, TapeRef node, double *value) {
    if (tape->nodes[node].op != TAPE_CONSTANT) return false;
    *value = tape_node_constant(&tape->nodes[node]);
    return true;
}

/* Adds scale·node. */
static void split(Split *s, TapeRef ref, double scale, int depth) {
    const TapeNode *node = &s->tape->nodes[ref];
    double k;
    s->failed |= depth > 1000;
    if (s->failed) return;
    if (node->op == TAPE_ADD || node->op == TAPE_SUB) {
        split(s, node->a, scale, depth + 1);
        split(s, node->b, node->op == TAPE_SUB ? -scale : scale, depth + 1);
    } else if (node->op == TAPE_NEG) {
        split(s, node->a, -scale, depth + 1);
    } else if (node->op == TAPE_MUL && constant_of(s->tape, node->a, &k)) {
        split(s, node->b, scale * k, depth + 1);
    } else if (node->op == TAPE_MUL && constant_of(s->tape, node->b, &k)) {
        split(s, node->a, scale * k, depth + 1);
    } else if (node->op == TAPE_DIV && constant_of(s->tape, node->b, &k) && k != 0) {
        split(s, node->a, scale / k, depth + 1);
    } else if (constant_of(s->tape, ref, &k)) {
        s->constant += scale * k;
    } else if (s->count < TAPE_TERMS_MOST) {
        s->parts[s->count++] = (Part){ref, scale};
    } else {
        s->failed = true;
    }
}

/* ---- parts that ask the same external stay together: it is asked once, and what their values have in common is not lost ---- */

/* Calls below a node, as bits; the number of bits is what is told apart. */
static uint64_t *find_calls(const Tape *tape, Arena *arena) {
    uint64_t *calls = arena_new_array(arena, uint64_t, tape->node_count);
    for (size_t i = 0; i < tape->node_count; i++) {
        const TapeNode *node = &tape->nodes[i];
        int arity = tape_op_arity((TapeOp)node->op);
        if (node->op == TAPE_CALL) {
            const TapeCall *call = &tape->calls[node->c];
            calls[i] = (uint64_t)1 << node->c % 64;
            for (int k = 0; k < call->external->input_count; k++) calls[i] |= calls[call->args[k]];
        } else if (node->op == TAPE_SUM || node->op == TAPE_PROD) {
            const TapeLoop *loop = &tape->loops[node->c];
            for (uint32_t k = 0; k < loop->captured_count; k++) calls[i] |= calls[loop->captured[k]];
        } else if (node->op == TAPE_RESULT) {
            calls[i] = calls[node->a];
        }
        if (arity > 0) calls[i] |= calls[node->a];
        if (arity > 1) calls[i] |= calls[node->b];
        if (arity > 2) calls[i] |= calls[node->c];
    }
    return calls;
}

/* group[k]: the first part that part k shares a call with, directly or by others. */
static void find_groups(const Split *s, size_t *group, Arena *arena) {
    ArenaMark mark = arena_mark(arena);
    const uint64_t *calls = find_calls(s->tape, arena);
    for (size_t k = 0; k < s->count; k++) {
        group[k] = k;
        for (size_t j = 0; j < k; j++) {
            if (!(calls[s->parts[k].node] & calls[s->parts[j].node])) continue;
            size_t from = size_max(group[j], group[k]), to = size_min(group[j], group[k]);
            for (size_t i = 0; i <= k; i++)
                if (group[i] == from) group[i] = to;
        }
    }
    arena_reset_to(arena, mark);
}

/* Of a node alone, or of a group's sum, of which *scale is meant. */
static const Tape *tape_of(const Split *s, const size_t *group, size_t which, double *scale, Arena *arena) {
    TapeBuilder *builder = tape_builder_create(arena, tape_input_count(s->tape));
    TapeRef inputs[TAPE_CALL_MAX], *map = arena_new_array(arena, TapeRef, s->tape->node_count), sum = 0;
    for (int k = 0; k < tape_input_count(s->tape); k++) inputs[k] = tape_input(builder, k);
    tape_inline_nodes(builder, s->tape, inputs, map);
    size_t count = 0;
    *scale = s->parts[which].scale != 0 ? s->parts[which].scale : 1;
    for (size_t k = which; k < s->count; k++) {
        if (group[k] != which) continue;
        TapeRef part = map[s->parts[k].node];
        double by = s->parts[k].scale / *scale;
        if (by == -1 && count) {
            sum = tape_binary(builder, TAPE_SUB, sum, part, (Span){0});
            continue;
        }
        if (by != 1) part = tape_binary(builder, TAPE_MUL, part, tape_constant(builder, by), (Span){0});
        sum = count++ ? tape_binary(builder, TAPE_ADD, sum, part, (Span){0}) : part;
    }
    return tape_finish(builder, &sum, 1);
}

static double most_of(const Tape *tape, const Interval *box, Arena *arena) {
    Interval out, *scratch = arena_new_array(arena, Interval, tape_scratch_size(tape));
    tape_eval_interval(tape, box, &out, scratch);
    return out.nan || !(out.low <= out.high) ? HUGE_VAL : bound_max(fabs(out.low), fabs(out.high));
}

/* The terms' sum may be far smaller than they are: their roundings count. */
static double rounding_of(const Split *s, const size_t *group, size_t which, const Interval *box, Arena *arena) {
    ArenaMark mark = arena_mark(arena);
    double size = 0, scale;
    size_t count = 0, alone[TAPE_TERMS_MOST];
    for (size_t k = 0; k < s->count; k++) count += group[k] == which, alone[k] = k;
    for (size_t k = which; k < s->count && count > 1; k++)
        if (group[k] == which) size += fabs(s->parts[k].scale) * most_of(tape_of(s, alone, k, &scale, arena), box, arena);
    arena_reset_to(arena, mark);
    return size;
}

static int wider_first(const void *a, const void *b) {
    const TapeTerm *x = a, *y = b;
    double wx = x->high - x->low, wy = y->high - y->low;
    return wx > wy ? -1 : wx < wy ? 1 : 0;
}

static void find_range(TapeTerm *term, const Interval *box, Arena *arena) {
    ArenaMark mark = arena_mark(arena);
    Interval out, scaled, *scratch = arena_new_array(arena, Interval, tape_scratch_size(term->tape));
    tape_eval_interval(term->tape, box, &out, scratch);
    scaled = interval_MUL(out, interval_point(term->scale));
    bool known = !scaled.nan && scaled.low <= scaled.high;
    term->low = known ? scaled.low : -HUGE_VAL;
    term->high = known ? scaled.high : HUGE_VAL;
    arena_reset_to(arena, mark);
}

/* No number here is subnormal, as the ends of ranges are: those are slow. */
static void add_up(TapeSum *sum, Arena *arena) {
    double *middle = arena_new_array(arena, double, sum->count + 1),
           *half = arena_new_array(arena, double, sum->count + 1),
           *size = arena_new_array(arena, double, sum->count + 1), low = 0, high = 0;
    middle[sum->count] = half[sum->count] = size[sum->count] = 0;
    for (size_t k = sum->count; k-- > 0;) {
        TapeTerm *term = &sum->terms[k];
        bool ends = isfinite(term->low) && isfinite(term->high);
        term->middle = ends ? term->low / 2 + term->high / 2 : 0;
        term->half = ends ? bound_max(term->high - term->middle, term->middle - term->low) * (1 + 0x1p-50) + 0x1p-1000 : HUGE_VAL;
        low = round_down(low + term->low), high = round_up(high + term->high);
        bool known = isfinite(low) && isfinite(high);
        middle[k] = known ? low / 2 + high / 2 : 0;
        half[k] = known ? bound_max(high - middle[k], middle[k] - low) * (1 + 0x1p-50) + 0x1p-1000 : HUGE_VAL;
        size[k] = size[k + 1] * (1 + 0x1p-50) + bound_max(fabs(term->low), fabs(term->high)) + 0x1p-1000;
    }
    sum->rest_middle = middle, sum->rest_half = half, sum->rest_size = size;
}

TapeSum tape_sum_of(const Tape *tape, const Interval *box, Arena *arena) {
    Split s = {.tape = tape};
    split(&s, tape->outputs[0], 1, 0);
    TapeTerm *terms = arena_new_array(arena, TapeTerm, s.count + 1);
    double work = 0;
    size_t group[TAPE_TERMS_MOST], count = 0;
    if (!s.failed) find_groups(&s, group, arena);
    for (size_t k = 0; k < s.count && !s.failed; k++) {
        if (group[k] != k) continue;
        TapeTerm *term = &terms[count++];
        *term = (TapeTerm){.rounding = rounding_of(&s, group, k, box, arena), .full = HUGE_VAL, .gone = HUGE_VAL};
        term->tape = tape_of(&s, group, k, &term->scale, arena);
        work += tape_work(term->tape);
    }
    /* Terms that have much in common are quicker together. */
    if (s.failed || !isfinite(s.constant) || work > 1.5 * tape_work(tape) + 8 * (double)count) {
        terms[0] = (TapeTerm){.tape = tape, .scale = 1, .full = HUGE_VAL, .gone = HUGE_VAL};
        count = 1, s.constant = 0;
    }
    s.count = count;
    TapeSum sum = {.terms = terms, .count = s.count, .constant = s.constant, .scratch_size = (size_t)tape_input_count(tape)};
    for (size_t k = 0; k < s.count; k++) {
        find_range(&terms[k], box, arena);
        terms[k].noise = tape_noise_of(terms[k].tape, arena);
        sum.scratch_size = size_max(sum.scratch_size, tape_scratch_size(terms[k].tape));
    }
    qsort(terms, s.count, sizeof *terms, wider_first);
    add_up(&sum, arena);
    sum.reach = tape_reach_of(&sum, box, arena);
    return sum;
}

/* Sums so far, lane by lane: roundings are counted at the end. */
typedef struct Total {
    double centre[AFFINE_LANES], slope[AFFINE_LANES], error[AFFINE_LANES], size[AFFINE_LANES];
} Total;

static void begin(Total *restrict total, const TapeSettled *settled, double constant, double size) {
    /* An error of 0 would make compilers fill it with the slopes, by an instruction that takes its time. */
    AFFINE_EACH_LANE total->centre[l] = constant, total->slope[l] = 0, total->error[l] = 0x1p-1000, total->size[l] = size;
    if (!settled || settled->terms == 0) return;
    AFFINE_EACH_LANE {
        total->centre[l] += settled->centre[l], total->slope[l] = settled->slope[l], total->error[l] = settled->error[l];
        total->size[l] += settled->size[l];
    }
}

static void add_scaled(Total *restrict total, const AffineLanes *restrict term, double scale, double rounding, AffineLanes *restrict own) {
    double absolute = fabs(scale);
    AFFINE_EACH_LANE {
        double c = term->centre[l] * scale, s = term->slope[l] * scale, e = term->error[l] * absolute;
        own->centre[l] = c, own->slope[l] = s, own->error[l] = e;
        total->centre[l] += c, total->slope[l] += s, total->error[l] += e;
        total->size[l] += ((fabs(c) + fabs(s)) + e) + rounding;
    }
}

/* Whether no lane may be 0 with terms to come within `half` of `middle`. */
static bool all_decided(const Total *restrict total, double middle, double half) {
    uint64_t open = 0;
    AFFINE_EACH_LANE {
        double reach = ((fabs(total->slope[l]) + total->error[l]) + half) * (1 + 0x1p-40) +
                       0x1p-40 * (fabs(total->centre[l]) + fabs(middle));
        open |= fabs(total->centre[l] + middle) > reach ? 0 : 1;
    }
    return open == 0;
}

/* What looks, and the narrowest and the widest of it in all lanes. */
typedef struct Look {
    const AffineLanes *width;
    double narrowest, widest;
} Look;

static Look look_of(const AffineLanes *width) {
    Look look = {width, 0, 0};
    for (int l = 0; l < AFFINE_LANES && width; l++) {
        Interval range = affine_range(affine_lane(width, l));
        look.narrowest = l ? bound_min(look.narrowest, range.low) : range.low;
        look.widest = l ? bound_max(look.widest, range.high) : range.high;
    }
    return look;
}

void tape_sum_begin(const TapeSum *sum, Vec3 origin, Vec3 direction, TapeNoiseWay *ways) {
    for (size_t k = 0; k < sum->count; k++)
        if (sum->terms[k].noise) ways[k] = tape_noise_along(sum->terms[k].noise, origin, direction);
}

static const AffineLanes *whole_term(const TapeSum *sum, size_t k, const TapePieces *pieces, AffineLanes *scratch, AffineLanes *filled, struct NodeCache *cells) {
    const TapeTerm *term = &sum->terms[k];
    if (!pieces || !term->noise) return tape_eval_lanes_again(term->tape, scratch, filled, cells);
    tape_noise_lanes(term->noise, &pieces->ways[k], pieces->middle, pieces->half, filled);
    return filled;
}

/* What remains of a term, before its scale: mean + share·(term − mean). */
static const AffineLanes *seen_term(const TapeSum *sum, size_t k, const Look *look, const TapePieces *pieces, AffineLanes *scratch,
                                    AffineLanes *filled, struct NodeCache *cells) {
    const TapeTerm *term = &sum->terms[k];
    if (!(look->widest > term->full)) return whole_term(sum, k, pieces, scratch, filled, cells);
    AffineForm mean = affine_point(term->mean / term->scale);
    affine_fill_lanes(filled, mean.centre);
    if (look->narrowest >= term->gone) return filled;
    AffineLanes constant;
    const AffineLanes *whole = whole_term(sum, k, pieces, scratch, &constant, cells);
    AFFINE_EACH_LANE {
        AffineForm part = affine_MUL(tape_term_share(term, affine_lane(look->width, l)), affine_SUB(affine_lane(whole, l), mean));
        affine_set_lane(filled, l, affine_ADD(mean, part));
    }
    return filled;
}

/* What terms from k on may add, those that are settled left out. */
typedef struct Rest {
    double middle[TAPE_TERMS_MOST + 1], half[TAPE_TERMS_MOST + 1];
} Rest;

static bool is_settled(const TapeSettled *settled, size_t k) { return settled && k < TAPE_SETTLED_MOST && (settled->terms >> k & 1); }

static void find_rest(const TapeSum *sum, const TapeSettled *settled, Rest *rest) {
    rest->middle[sum->count] = rest->half[sum->count] = 0;
    for (size_t k = sum->count; k-- > 0;) {
        bool counts = !is_settled(settled, k);
        rest->middle[k] = rest->middle[k + 1] + (counts ? sum->terms[k].middle : 0);
        rest->half[k] = (rest->half[k + 1] + (counts ? sum->terms[k].half : 0)) * (1 + 0x1p-50);
    }
}

size_t tape_sum_rest(const TapeSum *sum, double level, const AffineLanes *width, const TapeSettled *settled, const TapePieces *pieces,
                     AffineLanes *restrict out, TapeEach *restrict each, AffineLanes *restrict scratch, struct NodeCache *cells) {
    const Look look = look_of(width);
    Total total;
    Rest own;
    const double *middles = sum->rest_middle, *halves = sum->rest_half;
    double n = (double)sum->count + 2;
    AffineLanes filled, spare;
    size_t k = 0;
    if (settled && settled->terms) find_rest(sum, settled, &own), middles = own.middle, halves = own.half;
    if (each) each->terms = 0;
    begin(&total, settled, sum->constant - level, fabs(sum->constant) + fabs(level));
    for (bool first = middles == sum->rest_middle; k < sum->count && (first || !all_decided(&total, middles[k], halves[k])); k++) {
        const TapeTerm *term = &sum->terms[k];
        if (is_settled(settled, k)) continue;
        bool kept = each && k < TAPE_SETTLED_MOST;
        add_scaled(&total, seen_term(sum, k, &look, pieces, scratch, &filled, cells), term->scale, term->rounding, kept ? &each->of[k] : &spare);
        if (kept) each->terms |= (uint32_t)1 << k;
        first = false;
    }
    double middle = middles[k], half = halves[k], rest = sum->rest_size[k];
    /* The tape adds in another order, with coefficients multiplied in another: a rounding of each partial sum and of each product,
     * there and here. */
    AFFINE_EACH_LANE {
        out->centre[l] = total.centre[l] + middle, out->slope[l] = total.slope[l];
        out->error[l] = affine_lane_error(total.error[l] + half, 2 * n * (total.size[l] + rest));
    }
    return k;
}

size_t tape_sum_lanes(const TapeSum *sum, double level, const AffineLanes *width, AffineLanes *restrict out, AffineLanes *restrict scratch) {
    return tape_sum_rest(sum, level, width, NULL, NULL, out, NULL, scratch, NULL);
}
