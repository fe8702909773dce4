#include "eval/eval_state.h"

#include <string.h>

/* ---- evaluation; outside of its points a spline keeps its end values ---- */

static size_t segment_of(const Spline *s, double at) {
    size_t low = 0, high = s->count - 1;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (s->points[middle].at <= at)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* The polynomial through points [first, first + count), by Lagrange. */
static double lagrange(const SplinePoint *p, size_t count, int k, double at) {
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        double weight = p[i].value[k];
        for (size_t j = 0; j < count; j++)
            if (j != i) weight *= (at - p[j].at) / (p[i].at - p[j].at);
        sum += weight;
    }
    return sum;
}

/* A parabola through the segment's ends and the point before them (for the first segment, the one after). */
static double quadratic(const Spline *s, size_t i, int k, double at) {
    if (s->count < 3) return lagrange(s->points + i, 2, k, at);
    return lagrange(s->points + (i == 0 ? 0 : i - 1), 3, k, at);
}

static double slope(const SplinePoint *p, size_t i, int k) {
    return (p[i + 1].value[k] - p[i].value[k]) / (p[i + 1].at - p[i].at);
}

/* Catmull-Rom: no curve on the first and last segments, whose ends only give tangents. A point's tangent is the mean of the slopes
 * on both sides of it, however long they are. */
static double catmull_rom(const Spline *s, size_t i, int k, double at) {
    const SplinePoint *p = s->points;
    double h = p[i + 1].at - p[i].at, u = (at - p[i].at) / h, middle = slope(p, i, k);
    double m0 = (slope(p, i - 1, k) + middle) / 2 * h;
    double m1 = (middle + slope(p, i + 1, k)) / 2 * h;
    double u2 = u * u, u3 = u2 * u;
    return (2 * u3 - 3 * u2 + 1) * p[i].value[k] + (u3 - 2 * u2 + u) * m0 +
           (3 * u2 - 2 * u3) * p[i + 1].value[k] + (u3 - u2) * m1;
}

static double natural(const Spline *s, size_t i, int k, double at) {
    const SplinePoint *a = &s->points[i], *b = a + 1;
    double h = b->at - a->at, u = (b->at - at) / h, v = (at - a->at) / h;
    return u * a->value[k] + v * b->value[k] +
           ((u * u * u - u) * a->second[k] + (v * v * v - v) * b->second[k]) * h * h / 6;
}

void spline_evaluate(const Spline *s, int type, double at, double *out) {
    size_t low = 0, high = s->count - 1;
    if (type == SPLINE_CUBIC && s->count == 2) { /* POV-Ray's value of a curve that has only ends */
        for (int k = 0; k < s->size; k++) out[k] = (s->points[0].value[k] + s->points[1].value[k]) / 2;
        return;
    }
    if (type == SPLINE_CUBIC && s->count >= 3) {
        low = 1;
        high = s->count - 2;
    }
    const SplinePoint *end = at <= s->points[low].at                 ? &s->points[low]
                             : at >= s->points[high].at || high == 0 ? &s->points[high]
                                                                     : NULL;
    if (end) {
        memcpy(out, end->value, (size_t)s->size * sizeof *out);
        return;
    }
    size_t i = segment_of(s, at);
    for (int k = 0; k < s->size; k++)
        out[k] = type == SPLINE_QUADRATIC ? quadratic(s, i, k, at)
                 : type == SPLINE_CUBIC   ? catmull_rom(s, i, k, at)
                 : type == SPLINE_NATURAL ? natural(s, i, k, at)
                                          : lagrange(s->points + i, 2, k, at);
}

/* Second derivatives of the natural cubic spline: a tridiagonal system, solved by elimination. */
static void find_second_derivatives(Eval *ev, Spline *s) {
    size_t n = s->count;
    if (n < 3) return;
    SplinePoint *p = s->points;
    double *c = arena_new_array(&ev->temp, double, n), *d = arena_new_array(&ev->temp, double, n);
    for (int k = 0; k < s->size; k++) {
        c[0] = d[0] = 0;
        for (size_t i = 1; i + 1 < n; i++) {
            double h0 = p[i].at - p[i - 1].at, h1 = p[i + 1].at - p[i].at;
            double right =
                6 * ((p[i + 1].value[k] - p[i].value[k]) / h1 - (p[i].value[k] - p[i - 1].value[k]) / h0);
            double pivot = 2 * (h0 + h1) - h0 * c[i - 1];
            c[i] = h1 / pivot;
            d[i] = (right - h0 * d[i - 1]) / pivot;
        }
        p[n - 1].second[k] = 0;
        for (size_t i = n - 1; i-- > 1;) p[i].second[k] = d[i] - c[i] * p[i + 1].second[k];
    }
}

/* ---- spline { [type] time, value … } ---- */

static int spline_type(const Eval *ev, Name word) {
    switch (keyword_of(&ev->keywords, word)) {
    case KW_linear_spline: return SPLINE_LINEAR;
    case KW_quadratic_spline: return SPLINE_QUADRATIC;
    case KW_cubic_spline: return SPLINE_CUBIC;
    case KW_natural_spline: return SPLINE_NATURAL;
    default: return -1;
    }
}

typedef struct SplineReader {
    Eval *ev;
    Spline *spline;
    size_t capacity;
    bool have_time, failed, typed;
    double time;
    double last[5]; /* the point before */
} SplineReader;

/* Points are kept in the order of their times. A time that is there already gets the new value, except the last one, whose
 * repetition POV-Ray drops. */
static SplinePoint *place_for(SplineReader *r) {
    Spline *s = r->spline;
    if (s->count > 1 && s->points[s->count - 1].at == r->time) return NULL;
    size_t at = s->count;
    while (at > 0 && s->points[at - 1].at > r->time) at--;
    if (at > 0 && s->points[at - 1].at == r->time) return &s->points[at - 1];
    struct {
        SplinePoint *items;
        size_t count, capacity;
    } list = {s->points, s->count, r->capacity};
    list_push(r->ev->build.arena, &list);
    memmove(list.items + at + 1, list.items + at, (s->count - at) * sizeof *list.items);
    s->points = list.items;
    s->count = list.count;
    r->capacity = list.capacity;
    return &s->points[at];
}

/* As in POV-Ray a float is a vector of two, and the components that a point lacks are those of the point before. */
static void add_point(SplineReader *r, const Value *v) {
    SplinePoint point = {.at = r->time};
    int size = v->kind == VALUE_FLOAT ? 2 : v->size;
    for (int k = 0; k < 5; k++) point.value[k] = k < size ? value_component(v, k) : r->last[k];
    memcpy(r->last, point.value, sizeof r->last);
    if (size > r->spline->size) r->spline->size = size;
    SplinePoint *place = place_for(r);
    if (place) *place = point;
}

static void take_value(SplineReader *r, const Value *v, Span span) {
    if (v->kind == VALUE_SPLINE && (r->typed || r->spline->count)) {
        diag_error(r->ev->diags, span, "the spline to go on from comes first");
        r->failed = true;
    } else if (v->kind == VALUE_SPLINE) {
        *r->spline = *v->as.spline;
        r->spline->points =
            arena_copy(r->ev->build.arena, v->as.spline->points, v->as.spline->count * sizeof(SplinePoint));
        r->capacity = r->spline->count;
    } else if (!r->have_time) {
        r->have_time = value_to_float(r->ev, v, span, &r->time);
        r->failed = r->failed || !r->have_time;
    } else if (value_is_numeric(v)) {
        add_point(r, v);
        r->have_time = false;
    } else {
        diag_error(r->ev->diags, span, "a spline's points are floats or vectors, this is %s",
                   value_kind_text(v->kind));
        r->failed = true;
    }
}

Value eval_spline(Eval *ev, const EvalBlock *block) {
    SplineReader r = {.ev = ev, .spline = arena_new(ev->build.arena, Spline)};
    for (size_t i = 0; i < block->count && !r.failed; i++) {
        const BlockItem *item = &block->items[i];
        if (item->kind == ITEM_VALUE) {
            take_value(&r, &item->value, item->span);
            continue;
        }
        int type = item->kind == ITEM_WORD ? spline_type(ev, item->word) : -1;
        if (type < 0) {
            diag_error(ev->diags, item->kind == ITEM_WORD ? item->word_span : item->span,
                       "this has no meaning in a spline");
            return value_error();
        }
        r.spline->type = type;
        r.typed = true;
        for (size_t k = 0; k < item->argument_count && !r.failed; k++)
            take_value(&r, &item->arguments[k].value, item->arguments[k].span);
    }
    if (r.failed) return value_error();
    if (r.spline->count == 0) {
        diag_error(ev->diags, block->span, "a spline needs at least one point");
        return value_error();
    }
    find_second_derivatives(ev, r.spline);
    return (Value){.kind = VALUE_SPLINE, .as.spline = r.spline};
}

Value call_spline(Eval *ev, const Spline *spline, const NodeList *arguments, Span span) {
    double at, out[5] = {0};
    int type = spline->type;
    if (!eval_argument_count(ev, span, "a spline's time and type", 1, 2, arguments->count, NULL))
        return value_error();
    if (!eval_float(ev, arguments->items[0], &at)) return value_error();
    if (arguments->count == 2) {
        const Node *n = arguments->items[1];
        type = n->kind == NODE_CONSTANT ? spline_type(ev, ev->keywords.name_of[n->op]) : -1;
        if (type < 0) {
            diag_error(ev->diags, n->span,
                       "expected linear_spline, quadratic_spline, cubic_spline or natural_spline");
            return value_error();
        }
    }
    spline_evaluate(spline, type, at, out);
    return value_vector(ev, out, int_max(spline->size, 3) == 3 && spline->size < 3 ? 3 : spline->size);
}
