/* First changes of sign by bounds of several pieces at once (tape_lanes.h): parts of a piece, as long as bounds are likely to exclude them
 * (tape_reach.h), are bounded together; what remains of each waits in order. */
#include "shape/line_parts.h"
#include "tape/tape_noise.h"

#include <stdlib.h>

enum { FEW_LANES = 24, MOST_PARTS = 4 };

/* Pieces up to this many line_shortest() are left to halving, whose bounds' roundings are smaller. */
static const double ALONE = 0x1p6;

/* Terms of the sum are settled on a piece where their errors are less than SETTLES of what the sum may be off its middle: parts of the
 * piece take them as they are, until their errors come to STALE of that, or to half of all. */
static const double SETTLES = 0x1p-7, STALE = 0x1p-5;

/* Shorter sums gain nothing by it. */
enum { SETTLING_TERMS = 8 };

/* A zero is guessed in pieces that are shorter by this than the way over which the sum is straight. */
static const double GUESSED = 2;

/* The sum of the settled terms at middle + s·half. */
typedef struct Settled {
    uint32_t terms; /* a bit for each */
    double middle, half, centre, slope, error, size;
} Settled;

/* Where the sum is 0 if it is straight, how it rises there, and the way over which it bends by as much as it rises; 0: nothing is known. */
typedef struct Crossing {
    double zero, rise, straight;
} Crossing;

typedef struct LanePiece {
    double a, b;
    double step, care; /* how long its parts may be, and what share of the way to 0 their bounds may reach */
    int at;            /* in TapeReach, of the last length */
    Crossing crossing;
    Settled settled;
} LanePiece;

typedef struct Lanes {
    LineSearch *search;
    AffineLanes *scratch;
    TapeNoiseWay ways[TAPE_TERMS_MOST];
    LanePiece stack[LINE_MOST_PIECES];
    int count;
    double per_length; /* of the line's parameter, for a length */
} Lanes;

/* What is divided together, lane by lane. */
typedef struct Batch {
    LinePiece pieces[AFFINE_LANES];
    int used;
    TapeSettled settled;
    AffineLanes bounds;
    TapeEach each;
} Batch;

/* Where bounds on pieces of a length usually reach this share of the way to 0, pieces are as long: some of eight are not excluded then, and
 * the fewest bounds in all are needed. The share grows and shrinks with success. */
static const double USUAL_CARE = 0.5, MORE_CARELESS = 1.05, MORE_CAREFUL = 0.9;
/* Lengths of parts change by this at most from one batch to the next, and are this share of what is left at least: what bounds usually
 * tell may be far from what they tell on this line. */
static const double MOST_SHRUNK = 4, MOST_GROWN = 8, SHORTEST_SHARE = 0x1p-11;

static double middle_of(LinePiece p) { return p.a / 2 + p.b / 2; }
static double half_of(LinePiece p) { return (p.b - p.a) / 2 * (1 + 0x1p-50); }

static void place_lanes(const Line *line, const double *restrict middles, const double *restrict halves, AffineLanes in[3]) {
    const double origin[3] = {line->origin.x, line->origin.y, line->origin.z},
                 along[3] = {line->direction.x, line->direction.y, line->direction.z};
    for (int k = 0; k < 3; k++) AFFINE_EACH_LANE {
            double middle = middles[l], half = halves[l];
            double size = fabs(origin[k]) + (fabs(middle) + half) * fabs(along[k]);
            in[k].centre[l] = origin[k] + middle * along[k], in[k].slope[l] = half * along[k],
            in[k].error[l] = affine_lane_error(0, size);
        }
}

/* What looks. */
static void widen_lanes(const Line *line, const double *restrict middles, const double *restrict halves, AffineLanes *width) {
    AFFINE_EACH_LANE {
        double middle = middles[l], half = halves[l];
        double size = line->width.start + (fabs(middle) + half) * line->width.spread;
        width->centre[l] = line->width.start + middle * line->width.spread, width->slope[l] = half * line->width.spread;
        width->error[l] = affine_lane_error(0, size);
    }
}

/* A bit for each lane that may be 0 or is unknown. */
static uint64_t open_lanes(const AffineLanes *bounds) {
    uint64_t open = 0;
    AFFINE_EACH_LANE {
        /* Infinite, or no number, where nothing is known. */
        double radius = (fabs(bounds->slope[l]) + bounds->error[l]) * (1 + 0x1p-50);
        open |= fabs(bounds->centre[l]) > radius ? 0 : (uint64_t)1 << l;
    }
    return open;
}

/* ---- terms that are settled ---- */

/* For a part of the piece, in lane l. The part's middle is rounded. */
static void take_settled(const Settled *whole, LinePiece part, TapeSettled *out, int l) {
    double middle = middle_of(part), way = (middle - whole->middle) / whole->half, share = half_of(part) / whole->half;
    double off = fabs(whole->slope) * (0x1p-50 * (fabs(middle) + fabs(whole->middle)) / whole->half);
    out->centre[l] = whole->centre + whole->slope * way, out->slope[l] = whole->slope * share;
    out->error[l] = affine_lane_error(whole->error + off, 4 * (fabs(whole->centre) + fabs(whole->slope)));
    out->size[l] = whole->size;
}

/* Whether this error is below a share of what the sum may be, in all lanes of `open`. */
static bool errors_below(const double *errors, const AffineLanes *bounds, uint64_t open, double share, double of_error) {
    for (int l = 0; l < AFFINE_LANES; l++) {
        if (!(open >> l & 1)) continue;
        double most = bound_max(share * (fabs(bounds->slope[l]) + bounds->error[l]), of_error * bounds->error[l]);
        if (!(errors[l] <= most && bounds->error[l] < HUGE_VAL)) return false;
    }
    return true;
}

/* What the parts of each lane's piece need not evaluate again. */
static void settle(const TapeSum *sum, const Batch *batch, uint64_t open, Settled *out) {
    bool stays = errors_below(batch->settled.error, &batch->bounds, open, STALE, 0.2);
    for (int l = 0; l < batch->used; l++) {
        const TapeSettled *old = &batch->settled;
        out[l] = (Settled){.middle = middle_of(batch->pieces[l]), .half = half_of(batch->pieces[l])};
        if (stays && old->terms)
            out[l].terms = old->terms, out[l].centre = old->centre[l], out[l].slope = old->slope[l], out[l].error = old->error[l], out[l].size = old->size[l];
    }
    for (size_t k = 0; k < size_min(sum->count, TAPE_SETTLED_MOST); k++) {
        const AffineLanes *own = &batch->each.of[k];
        if (!(batch->each.terms >> k & 1) || !errors_below(own->error, &batch->bounds, open, SETTLES, 0)) continue;
        for (int l = 0; l < batch->used; l++) {
            out[l].terms |= (uint32_t)1 << k;
            out[l].centre += own->centre[l], out[l].slope += own->slope[l], out[l].error += own->error[l];
            out[l].size += fabs(own->centre[l]) + fabs(own->slope[l]) + own->error[l] + sum->terms[k].rounding;
        }
    }
    for (int l = 0; l < batch->used; l++) out[l].error = affine_lane_error(out[l].error, TAPE_SETTLED_MOST * out[l].size);
}

/* ---- pieces ---- */

/* Of a piece of which cutting has left a part. */
static Crossing crossing_of(const AffineForm *f, LinePiece whole, LinePiece rest) {
    double half = half_of(whole);
    if (f->nan || !(rest.a > whole.a && rest.b < whole.b)) return (Crossing){0, 0, 0};
    return (Crossing){middle_of(whole) - half * (f->centre / f->slope), f->slope / half, half * fabs(f->slope) / f->error};
}

/* Of the line's parameter: on pieces of this length bounds usually reach so far. */
static double length_for(const Lanes *lanes, double radius, int *at) {
    return lanes->per_length * tape_reach_length(&lanes->search->line->sum->reach, radius, at);
}

/* How many parts a piece is divided into that its form does not exclude: the more, the farther it reaches beyond 0. */
static double parts_for(const AffineForm *f) {
    double parts = 1.5 * affine_radius(*f) / fabs(f->centre);
    return parts < MOST_PARTS ? bound_max(parts, 2) : MOST_PARTS;
}

/* What may hold a zero of the pieces, cut, goes onto the stack, the first on top. */
static void push_rest(Lanes *lanes, const Batch *batch) {
    uint64_t open = open_lanes(&batch->bounds);
    Settled settled[AFFINE_LANES];
    bool settles = open && lanes->search->line->sum->count >= SETTLING_TERMS;
    if (settles) settle(lanes->search->line->sum, batch, open, settled);
    for (int l = batch->used; l-- > 0;) {
        if (!(open >> l & 1)) continue;
        LinePiece piece = batch->pieces[l];
        AffineForm f = affine_lane(&batch->bounds, l);
        if (!(f.error < HUGE_VAL)) {
            f = line_bounds(lanes->search, piece.a, piece.b);
            Interval range = affine_range(f);
            if (range.low > 0 || (range.high <= 0 && !f.nan)) continue;
        }
        if (!f.nan) line_cut(&f, &piece.a, &piece.b);
        if (!(piece.b >= piece.a) || lanes->count >= LINE_MOST_PIECES) continue;
        LanePiece *rest = &lanes->stack[lanes->count++];
        rest->a = piece.a, rest->b = piece.b, rest->settled.terms = 0;
        rest->crossing = crossing_of(&f, batch->pieces[l], piece);
        rest->step = (piece.b - piece.a) / parts_for(&f);
        rest->care = USUAL_CARE, rest->at = 0;
        /* Where cutting soon ends at a zero, only what settled terms are off would stand in its way. */
        if (settles && fabs(f.slope) <= f.error) rest->settled = settled[l];
    }
}

/* Bounds of the sum on the batch's pieces. */
static void bound_batch(Lanes *lanes, Batch *batch) {
    const Line *line = lanes->search->line;
    double middles[AFFINE_LANES], halves[AFFINE_LANES];
    AffineLanes width;
    bool wide = line_is_wide(line), settles = line->sum->count >= SETTLING_TERMS;
    AFFINE_EACH_LANE {
        LinePiece piece = batch->pieces[l < batch->used ? l : 0];
        middles[l] = middle_of(piece), halves[l] = half_of(piece);
    }
    place_lanes(line, middles, halves, lanes->scratch);
    if (wide) widen_lanes(line, middles, halves, &width);
    const TapePieces pieces = {middles, halves, lanes->ways};
    tape_sum_rest(line->sum, line->level, wide ? &width : NULL, &batch->settled, &pieces, &batch->bounds, settles ? &batch->each : NULL, lanes->scratch, line->cells);
    lanes->search->work.bounds += (uint64_t)batch->used;
}

/* Parts of a piece that are bounded next, in as many lanes as there are at most; the piece keeps what they leave. */
static void take(LanePiece *piece, int lanes, Batch *batch) {
    double a = piece->a, b = piece->b, parts = (b - a) / piece->step, step = piece->step;
    int count = lanes;
    bool all = !(parts >= lanes + 0.5);
    if (all) count = parts > 1 ? (int)(parts + 0.5) : 1, step = (b - a) / count;
    for (int l = 0; l < count; l++) {
        LinePiece part = {l ? a + step * l : a, all && l == count - 1 ? b : a + step * (l + 1)};
        if (batch->settled.terms) take_settled(&piece->settled, part, &batch->settled, batch->used);
        batch->pieces[batch->used++] = part;
    }
    piece->a = batch->pieces[batch->used - 1].b;
}

/* ---- zeros that are guessed first, and then proved to be the first ---- */

enum { MOST_STEPS = 12 };

/* Secants from where a straight line would have it, until they stand. False: they leave [a, b]. */
static bool guess_zero(LineSearch *s, double a, double b, const Crossing *crossing, double *zero) {
    double x = crossing->zero, at = line_value(s, x), step = -at / crossing->rise;
    for (int i = 0; i < MOST_STEPS && at != 0 && fabs(step) > 0x1p-52 * fabs(x); i++) {
        double next = x + step, there;
        if (!(next >= a && next <= b)) return false;
        there = line_value(s, next);
        step = there == at ? 0 : -there * (step / (there - at));
        x = next, at = there;
    }
    *zero = x;
    return x >= a && x <= b;
}

static void push_plain(Lanes *lanes, double a, double b) {
    if (b > a) lanes->stack[lanes->count++] = (LanePiece){.a = a, .b = b, .step = (b - a) / AFFINE_LANES};
}

/* Pieces of [a, zero - near], the shorter the nearer they are: over each the sum is straight enough not to reach 0 at its end. The last
 * may be missing: returns where they end. */
static double approach(double a, double zero, double near, double straight, Batch *batch) {
    double way = zero - a;
    batch->used = 0, batch->settled.terms = 0;
    while (way > near && batch->used < AFFINE_LANES) {
        double next = bound_max(way / double_clamp(straight / (2 * way), 2, 0x1p16), near);
        batch->pieces[batch->used] = (LinePiece){batch->used ? zero - way : a, zero - next};
        batch->used++, way = next;
    }
    return zero - way;
}

/* Whether there is a zero on [a, b], and all there are one as far as places go. */
static bool is_one_zero(LineSearch *s, double a, double b) {
    AffineForm f = line_bounds(s, a, b);
    double low = a, high = b;
    if (f.nan) return false;
    line_cut(&f, &low, &high);
    return low > a && high < b && high - low <= line_shortest(s->line, b);
}

/* For a piece that is off the stack, which has room. False: its parts that may hold a zero are on the stack. */
static bool guess(Lanes *lanes, double a, double b, Crossing crossing, double *t, bool *falling) {
    LineSearch *s = lanes->search;
    double zero, near = ALONE * line_shortest(s->line, b) / 4;
    if (!guess_zero(s, a, b, &crossing, &zero)) {
        push_plain(lanes, a, b);
        return false;
    }
    double from = bound_max(zero - near, a), to = bound_min(zero + near, b);
    Batch batch;
    double reached = approach(a, zero, near, crossing.straight, &batch);
    if (batch.used) bound_batch(lanes, &batch);
    bool proved = (!batch.used || !open_lanes(&batch.bounds)) && reached >= from;
    if (proved && is_one_zero(s, from, to)) {
        *t = zero, *falling = crossing.rise < 0;
        return true;
    }
    push_plain(lanes, to, b);
    push_plain(lanes, bound_min(reached, from), to);
    if (batch.used) push_rest(lanes, &batch);
    return false;
}

/* For the rest of a piece whose parts before it are the last `count` of the batch: its parts may be as long as the sum's bounds usually are
 * of use where it is as far from 0 as in the last of them; or longer where bounds told more than is usual. */
static void pace(const Lanes *lanes, const Batch *batch, int count, LanePiece *rest) {
    const AffineLanes *bounds = &batch->bounds;
    int last = batch->used - 1;
    double value = fabs(bounds->centre[last]), radius = fabs(bounds->slope[last]) + bounds->error[last], next = rest->step;
    bool all_excluded = open_lanes(bounds) >> (batch->used - count) == 0;
    if (radius < HUGE_VAL) next = length_for(lanes, value * rest->care, &rest->at);
    if (all_excluded) next = bound_max(next, rest->step * (value / (2 * radius)));
    rest->care *= all_excluded ? MORE_CARELESS : MORE_CAREFUL;
    next = double_clamp(next, rest->step / MOST_SHRUNK, rest->step * MOST_GROWN);
    rest->step = bound_max(next, SHORTEST_SHARE * (rest->b - rest->a));
}

static bool search(Lanes *lanes, double *t, bool *falling) {
    LineSearch *s = lanes->search;
    Batch batch;
    while (lanes->count > 0) {
        LanePiece *rest = NULL; /* of the last piece that is divided */
        int before = 0;
        batch.used = 0;
        while (batch.used < AFFINE_LANES && !rest && lanes->count > 0) {
            LanePiece *piece = &lanes->stack[lanes->count - 1];
            double a = piece->a, b = piece->b;
            bool full = lanes->count + AFFINE_LANES + 2 > LINE_MOST_PIECES || s->work.bounds > LINE_MOST_BOUNDS;
            bool other = batch.used > 0 && piece->settled.terms != batch.settled.terms;
            bool alone = piece->crossing.straight >= GUESSED * (b - a) || b - a < 0x1p-20 * (fabs(a) + fabs(b));
            if (batch.used > 0 && (full || other || alone)) break;
            lanes->count--;
            if (full) {
                if (line_give_up(s, (LinePiece){a, b}, t, falling)) return true;
            } else if (b - a <= ALONE * line_shortest(s->line, b)) {
                if (line_search_halves(s, a, b, t, falling)) return true;
            } else if (batch.used == 0 && piece->crossing.straight >= GUESSED * (b - a)) {
                if (guess(lanes, a, b, piece->crossing, t, falling)) return true;
            } else {
                if (batch.used == 0) batch.settled.terms = piece->settled.terms;
                before = batch.used;
                take(piece, AFFINE_LANES - before, &batch);
                if (piece->a < b) rest = piece, rest->crossing.straight = 0, lanes->count++;
            }
        }
        if (!batch.used) continue;
        bound_batch(lanes, &batch);
        if (rest) pace(lanes, &batch, batch.used - before, rest);
        push_rest(lanes, &batch);
    }
    return false;
}

bool line_search_lanes(LineSearch *s, double from, double to, double *t, bool *falling) {
    AffineLanes few[FEW_LANES];
    size_t slots = s->line->sum->scratch_size;
    Lanes lanes; /* its stack is large: nothing is written to it in vain */
    lanes.search = s, lanes.scratch = slots > FEW_LANES ? malloc(slots * sizeof *few) : few;
    if (!lanes.scratch) return false;
    tape_sum_begin(s->line->sum, s->line->origin, s->line->direction, lanes.ways);
    lanes.count = 1, lanes.per_length = 1 / vec3_length(s->line->direction);
    LanePiece *whole = &lanes.stack[0];
    whole->a = from, whole->b = to, whole->crossing.straight = 0, whole->settled.terms = 0, whole->care = USUAL_CARE, whole->at = 0;
    double start = fabs(s->line->start != 0 ? s->line->start : line_value(s, from));
    whole->step = double_clamp(length_for(&lanes, start * USUAL_CARE, &whole->at), (to - from) * SHORTEST_SHARE, to - from);
    bool found = search(&lanes, t, falling);
    if (lanes.scratch != few) free(lanes.scratch);
    return found;
}
