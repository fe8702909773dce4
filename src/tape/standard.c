#include "tape/standard.h"

#include "tape/noise.h"
#include "tape/tape_program.h"

/* Errors below this share of a form are not worth a symbol. */
static const double WORTH = 0x1p-40;

static StandardForm standard_unknown(bool nan) { return (StandardForm){.error = HUGE_VAL, .nan = nan}; }
static StandardForm standard_point(double x) { return isfinite(x) ? (StandardForm){.centre = x} : standard_unknown(x != x); }

static StandardForm standard_of_interval(Interval a) {
    AffineForm form = affine_of_interval(a);
    return (StandardForm){.centre = form.centre, .error = form.error, .nan = form.nan};
}

/* Of the terms from `first` on, and the error, rounded up. */
static double radius_from(const StandardForm *a, int first) {
    double sum = a->error;
    for (int i = first; i < a->count; i++) sum += fabs(a->terms[i].by);
    return sum * (1 + STANDARD_TERMS * 0x1p-52);
}

static double radius_of(const StandardForm *a) { return radius_from(a, 0); }

static Interval standard_range(StandardForm a) {
    double radius = radius_of(&a);
    if (!(radius < HUGE_VAL)) return interval_all(a.nan);
    return (Interval){round_down(a.centre - radius), round_up(a.centre + radius), a.nan};
}

StandardForm standard_of_line(AffineForm form, uint32_t *next) {
    StandardForm out = {.centre = form.centre, .error = form.error, .nan = form.nan, .next = next};
    if (form.slope != 0) out.terms[out.count++] = (StandardTerm){0, form.slope};
    return out;
}

AffineForm standard_reduced(const StandardForm *a) {
    bool slopes = a->count && a->terms[0].symbol == 0;
    double error = radius_from(a, slopes);
    if (!(error < HUGE_VAL)) return affine_unknown(a->nan);
    return (AffineForm){a->centre, slopes ? a->terms[0].by : 0, error, a->nan};
}

/* ---- results of operations ---- */

/* The least of the terms but ε₀ becomes error. */
static void drop_least(StandardForm *a) {
    int least = a->terms[0].symbol == 0;
    for (int i = least + 1; i < a->count; i++)
        if (fabs(a->terms[i].by) < fabs(a->terms[least].by)) least = i;
    a->error = round_up(a->error + fabs(a->terms[least].by));
    a->count--;
    for (int i = least; i < a->count; i++) a->terms[i] = a->terms[i + 1];
}

/* `error` and the roundings of results up to `size` are added; the whole error gets a symbol of its own. What is no number is not known. */
static StandardForm finished(StandardForm a, double error, double size, uint32_t *next) {
    bool known = isfinite(a.centre);
    a.error = round_up(a.error + error + (size * (STANDARD_TERMS * 0x1p-50) + 4 * DBL_TRUE_MIN));
    for (int i = 0; i < a.count; i++) known &= isfinite(a.terms[i].by);
    if (!known || !(radius_of(&a) < HUGE_VAL)) a = standard_unknown(a.nan);
    a.next = next;
    if (!next || !(a.error < HUGE_VAL) || a.error <= WORTH * radius_of(&a) || *next == UINT32_MAX) return a;
    if (a.count == STANDARD_TERMS) drop_least(&a);
    a.terms[a.count++] = (StandardTerm){(*next)++, a.error};
    a.error = 0;
    return a;
}

static uint32_t *next_of(const StandardForm *a, const StandardForm *b) { return a->next ? a->next : b->next; }

static StandardForm of_interval(Interval range, uint32_t *next) {
    StandardForm out = standard_of_interval(range);
    return out.next = next, out;
}

/* The better of two bounds: as affine_within(). */
static StandardForm within(StandardForm a, Interval range) {
    bool slopes = a.count && a.terms[0].symbol == 0;
    if (interval_is_never(range) || range.high - range.low < 2 * radius_from(&a, slopes)) return finished(of_interval(range, a.next), 0, 0, a.next);
    a.nan = range.nan;
    return a;
}

static void push_term(StandardForm *out, StandardTerm term) {
    if (term.by == 0) return;
    if (out->count == STANDARD_TERMS) drop_least(out);
    out->terms[out->count++] = term;
}

/* k·a + l·b, symbol by symbol, without the roundings; `size` gets what those are a share of. */
static StandardForm combined(const StandardForm *a, double k, const StandardForm *b, double l, double *size) {
    StandardForm out = {.centre = k * a->centre + l * b->centre, .nan = a->nan || b->nan, .next = next_of(a, b)};
    out.error = fabs(k) * a->error + fabs(l) * b->error;
    for (int i = 0, j = 0; i < a->count || j < b->count;) {
        uint32_t one = i < a->count ? a->terms[i].symbol : UINT32_MAX, other = j < b->count ? b->terms[j].symbol : UINT32_MAX;
        uint32_t symbol = one < other ? one : other;
        double by = one == symbol ? k * a->terms[i].by : 0;
        if (other == symbol) by += l * b->terms[j].by;
        i += one == symbol, j += other == symbol;
        push_term(&out, (StandardTerm){symbol, by});
    }
    *size = fabs(k) * (fabs(a->centre) + radius_of(a)) + fabs(l) * (fabs(b->centre) + radius_of(b));
    return out;
}

static StandardForm linear(StandardForm a, double k, StandardForm b, double l) {
    double size;
    StandardForm out = combined(&a, k, &b, l, &size);
    return finished(out, 0, size, out.next);
}

/* ---- functions of one ---- */

/* An operation on reduced forms whose slope is the whole radius tells a linear function of the operand, and what that is off. */
static StandardForm lifted(StandardForm a, AffineForm (*operation)(AffineForm a, AffineForm constant), AffineForm constant) {
    double radius = radius_of(&a), unused;
    AffineForm x = radius < HUGE_VAL ? (AffineForm){a.centre, radius, 0, a.nan} : affine_unknown(a.nan), y = operation(x, constant);
    const StandardForm none = {.centre = 0};
    if (!(y.error < HUGE_VAL)) {
        StandardForm out = standard_unknown(y.nan);
        return out.next = a.next, out;
    }
    if (!(radius < HUGE_VAL)) return finished((StandardForm){.centre = y.centre, .nan = y.nan}, y.error + fabs(y.slope), 0, a.next);
    double k = radius > 0 ? y.slope / radius : 0;
    if (!isfinite(k)) return finished((StandardForm){.centre = y.centre, .nan = y.nan}, y.error + fabs(y.slope), fabs(y.slope), a.next);
    StandardForm out = combined(&a, k, &none, 0, &unused);
    out.centre = y.centre, out.nan = y.nan;
    return finished(out, y.error + (radius > 0 ? 0 : fabs(y.slope)), fabs(y.slope) + fabs(y.centre), a.next);
}

#define LIFTED(name)                                                                               \
    static AffineForm apply_##name(AffineForm a, AffineForm unused) { return (void)unused, affine_##name(a); } \
    static StandardForm standard_##name(StandardForm a) { return lifted(a, apply_##name, affine_point(0)); }
LIFTED(SQR)
LIFTED(ABS)
LIFTED(SQRT)
LIFTED(EXP)
LIFTED(LN)
LIFTED(LOG)
LIFTED(SIN)
LIFTED(COS)
LIFTED(TAN)
LIFTED(ASIN)
LIFTED(ACOS)
LIFTED(ATAN)
LIFTED(SINH)
LIFTED(COSH)
LIFTED(TANH)
LIFTED(ASINH)
LIFTED(ACOSH)
LIFTED(ATANH)
LIFTED(DEGREES)
LIFTED(RADIANS)
#undef LIFTED

/* ---- arithmetic ---- */

static StandardForm standard_ADD(StandardForm a, StandardForm b) { return linear(a, 1, b, 1); }
static StandardForm standard_SUB(StandardForm a, StandardForm b) { return linear(a, 1, b, -1); }
static StandardForm standard_NEG(StandardForm a) { return linear(a, -1, (StandardForm){.centre = 0}, 0); }

static StandardForm standard_MUL(StandardForm a, StandardForm b) {
    double ra = radius_of(&a), rb = radius_of(&b), size;
    if (!(ra < HUGE_VAL && rb < HUGE_VAL)) return finished(of_interval(interval_MUL(standard_range(a), standard_range(b)), NULL), 0, 0, next_of(&a, &b));
    StandardForm out = combined(&a, b.centre, &b, a.centre, &size);
    out.centre = a.centre * b.centre;
    return finished(out, round_up(ra * rb), 2 * ((fabs(a.centre) + ra) * (fabs(b.centre) + rb) + size), out.next);
}

static AffineForm reciprocal(AffineForm a, AffineForm one) { return affine_DIV(one, a); }

static StandardForm standard_DIV(StandardForm a, StandardForm b) {
    Interval range = interval_DIV(standard_range(a), standard_range(b));
    if (interval_has_zero(standard_range(b))) return finished(of_interval(range, NULL), 0, 0, next_of(&a, &b));
    return within(standard_MUL(a, lifted(b, reciprocal, affine_point(1))), range);
}

static bool is_constant(const StandardForm *a) { return a->count == 0 && a->error == 0; }

static StandardForm standard_POW(StandardForm a, StandardForm b) {
    Interval x = standard_range(a), range = interval_POW(x, standard_range(b));
    if (is_constant(&b) && !b.nan) return lifted(a, affine_POW, affine_point(b.centre));
    if (x.low > 0) return within(standard_EXP(standard_MUL(b, standard_LN(a))), range);
    return finished(of_interval(range, NULL), 0, 0, next_of(&a, &b));
}

static StandardForm standard_FOLD(StandardForm a, StandardForm b) {
    if (is_constant(&b) && !b.nan) return lifted(a, affine_FOLD, affine_point(b.centre));
    return finished(of_interval(interval_FOLD(standard_range(a), standard_range(b)), NULL), 0, 0, next_of(&a, &b));
}

static StandardForm standard_MOD(StandardForm a, StandardForm b) {
    if (is_constant(&b) && !b.nan) return lifted(a, affine_MOD, affine_point(b.centre));
    return finished(of_interval(interval_MOD(standard_range(a), standard_range(b)), NULL), 0, 0, next_of(&a, &b));
}

/* ---- choices ---- */

static StandardForm halved(StandardForm a, StandardForm b, double sign) {
    return linear(linear(a, 0.5, b, 0.5), 1, standard_ABS(linear(a, 0.5, b, -0.5)), sign);
}

static StandardForm standard_MIN(StandardForm a, StandardForm b) {
    Interval x = standard_range(a), y = standard_range(b), range = interval_MIN(x, y);
    if (a.nan || b.nan) return finished(of_interval(range, NULL), 0, 0, next_of(&a, &b));
    if (x.high < y.low) return a;
    if (x.low >= y.high) return b;
    return within(halved(a, b, -1), range);
}

static StandardForm standard_MAX(StandardForm a, StandardForm b) {
    Interval x = standard_range(a), y = standard_range(b), range = interval_MAX(x, y);
    if (a.nan || b.nan) return finished(of_interval(range, NULL), 0, 0, next_of(&a, &b));
    if (x.low > y.high) return a;
    if (x.high <= y.low) return b;
    return within(halved(a, b, 1), range);
}

static StandardForm standard_SELECT(StandardForm a, StandardForm b, StandardForm c) {
    Interval x = standard_range(a);
    if (x.high < 0 && !x.nan) return b;
    if (x.low >= 0) return c;
    return finished(of_interval(interval_hull(standard_range(b), standard_range(c)), NULL), 0, 0, next_of(&b, &c));
}

/* Operations with jumps, and what has two operands that both bend: only their range is known. */
#define BY_INTERVAL_1(name) \
    static StandardForm standard_##name(StandardForm a) { return finished(of_interval(interval_##name(standard_range(a)), NULL), 0, 0, a.next); }
#define BY_INTERVAL_2(name)                                                                                              \
    static StandardForm standard_##name(StandardForm a, StandardForm b) {                                                \
        return finished(of_interval(interval_##name(standard_range(a), standard_range(b)), NULL), 0, 0, next_of(&a, &b)); \
    }
BY_INTERVAL_1(FLOOR)
BY_INTERVAL_1(CEIL)
BY_INTERVAL_1(INT)
BY_INTERVAL_2(IDIV)
BY_INTERVAL_2(ATAN2)
BY_INTERVAL_2(BITWISE_AND)
BY_INTERVAL_2(BITWISE_OR)
BY_INTERVAL_2(BITWISE_XOR)
BY_INTERVAL_2(LT)
BY_INTERVAL_2(LE)
BY_INTERVAL_2(GT)
BY_INTERVAL_2(GE)
BY_INTERVAL_2(EQ)
BY_INTERVAL_2(NE)
BY_INTERVAL_2(AND)
BY_INTERVAL_2(OR)
#undef BY_INTERVAL_2
#undef BY_INTERVAL_1

/* ---- noises: as affine.c has them, the gradient on the forms of the coordinates ---- */

typedef double NoiseGradient(Vec3 p, double gradient[3]);

static StandardForm noise_of(NoiseGradient *noise, double curvature, Interval whole, const StandardForm p[3]) {
    double gradient[3], way = 0, steepest = 0, size;
    uint32_t *next = p[0].next ? p[0].next : next_of(&p[1], &p[2]);
    for (int k = 0; k < 3; k++) way += radius_of(&p[k]) * radius_of(&p[k]), whole.nan |= p[k].nan || !(radius_of(&p[k]) < HUGE_VAL);
    if (!(curvature / 2 * way < whole.high)) return finished(of_interval(whole, NULL), 0, 0, next);
    double centre = noise(vec3(p[0].centre, p[1].centre, p[2].centre), gradient);
    for (int k = 0; k < 3; k++) steepest += fabs(gradient[k]) * (fabs(p[k].centre) + radius_of(&p[k]));
    const StandardForm two = combined(&p[0], gradient[0], &p[1], gradient[1], &size);
    StandardForm out = combined(&two, 1, &p[2], gradient[2], &size);
    out.centre = centre, out.nan = whole.nan;
    /* Numbers in a cell are below 8, and its places and curves are right to a few units of 2⁻⁵². */
    return finished(out, curvature / 2 * way * (1 + 0x1p-48), 32 + 4 * steepest, next);
}

static StandardForm standard_PERLIN(StandardForm a, StandardForm b, StandardForm c) {
    const Interval whole = interval(-NOISE_PERLIN_MOST, NOISE_PERLIN_MOST);
    return within(noise_of(noise_perlin_gradient, NOISE_PERLIN_CURVATURE, whole, (const StandardForm[]){a, b, c}),
                  interval_PERLIN(standard_range(a), standard_range(b), standard_range(c)));
}

static StandardForm standard_POV_NOISE(StandardForm a, StandardForm b, StandardForm c) {
    StandardForm out = noise_of(noise_pov_gradient3, NOISE_POV_CURVATURE, interval(0, 1), (const StandardForm[]){a, b, c});
    Interval range = standard_range(out), whole = interval_POV_NOISE(standard_range(a), standard_range(b), standard_range(c));
    if (range.low < 0) out = standard_MAX(standard_point(0), out);
    if (range.high > 1) out = standard_MIN(standard_point(1), out);
    return within(out, whole);
}

/* ---- tapes ---- */

static bool standard_call(const TapeCall *call_, const StandardForm *slots, StandardForm *out) {
    const TapeExternal *external = call_->external;
    AffineForm in[TAPE_CALL_MAX], values[TAPE_CALL_MAX];
    uint32_t *next = NULL;
    if (!external->forms) return false;
    for (int k = 0; k < external->input_count; k++) {
        const StandardForm *slot = &slots[call_->arg_slots[k]];
        in[k] = standard_reduced(slot), next = slot->next ? slot->next : next;
    }
    external->forms(external->data, 1, in, values, NULL);
    for (int k = 0; k < external->output_count; k++) {
        out[k] = standard_of_line(values[k], next);
        if (values[k].error < HUGE_VAL) out[k] = finished(out[k], 0, 0, next);
    }
    return true;
}

#define BOUND             StandardForm
#define BOUND_(name)      standard_##name
#define BOUND_NAMED(name) standard_##name
#include "tape/tape_bounds.inc"

StandardForm tape_apply_standard(TapeOp op, StandardForm a, StandardForm b, StandardForm c) { return apply(op, a, b, c); }

void tape_eval_standard(const Tape *tape, const StandardForm *in, StandardForm *out, StandardForm *scratch) { evaluate(tape, in, out, scratch); }
