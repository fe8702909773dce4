#include "eval/eval_state.h"

/* The first row; NULL where the elements are no arrays (any more: each element may be set to anything). */
static const Array *first_row(const Array *array) {
    if (array->count == 0 || !array->items[0].set || array->items[0].value.kind != VALUE_ARRAY) return NULL;
    return array->items[0].value.as.array;
}

int array_rank(const Array *array) {
    int rank = 0;
    for (; array; array = first_row(array)) rank++;
    return rank;
}

size_t array_extent(const Array *array, int dimension) {
    for (; array && dimension > 0; dimension--) array = first_row(array);
    return array ? array->count : 0;
}

const Value *array_element(const Array *array, const size_t *indices, int count) {
    for (int i = 0; i < count; i++) {
        if (indices[i] >= array->count || !array->items[indices[i]].set) return NULL;
        const Value *v = &array->items[indices[i]].value;
        if (i + 1 == count) return v;
        if (v->kind != VALUE_ARRAY) return NULL;
        array = v->as.array;
    }
    return NULL;
}

bool array_take(Eval *ev, uint64_t count, Span span) {
    if (ev->stopped) return false;
    uint64_t limit = ev->options->limits.array_elements;
    if (count <= limit && (ev->elements += count) <= limit) return eval_has_memory(ev, count * sizeof(Slot), span);
    diag_error(ev->diags, span, "the scene's arrays would hold more than %llu elements",
               (unsigned long long)limit);
    ev->stopped = true;
    return false;
}

/* Where POV-Ray tells floats from vectors too, here all numbers go together, as they do in expressions. */
static ValueKind element_class(const Value *v) {
    switch (v->kind) {
    case VALUE_COLOR:
    case VALUE_VECTOR: return VALUE_FLOAT;
    case VALUE_LIGHT:
    case VALUE_TEXEL:
    case VALUE_SURFACE:
    case VALUE_SKIN: return VALUE_OBJECT;
    default: return v->kind;
    }
}

bool array_accepts(Eval *ev, Array *array, const Value *v, Span span) {
    ValueKind class = element_class(v);
    if (!array->class || class == VALUE_ERROR || array->rows) return true;
    if (*array->class == VALUE_ERROR) *array->class = class;
    if (*array->class == class) return true;
    Diagnostic *d = diag_error(ev->diags, span, "the elements of this array are of another kind: %s, not %s",
                               value_kind_text(*array->class), value_kind_text(class));
    diag_hint(ev->diags, d, "'array mixed' holds anything");
    return false;
}

bool array_is_partial(Eval *ev, const Array *array, const Value *v, Span span) {
    if (!array->rows || v->kind != VALUE_ARRAY) return false;
    diag_error(ev->diags, span, "the array has more dimensions than there are indices");
    return true;
}

static void share_class(Array *array, ValueKind *class) {
    array->class = class;
    for (size_t i = 0; array->rows && i < array->count; i++)
        if (array->items[i].set && array->items[i].value.kind == VALUE_ARRAY)
            share_class(array->items[i].value.as.array, class);
}

Array *array_copy(Eval *ev, const Array *from) {
    if (!array_take(ev, from->count, ev->at)) return NULL;
    Array *to = arena_new(ev->parse, Array);
    *to = *from;
    to->capacity = from->count;
    to->items = arena_new_array(ev->parse, Slot, from->count);
    for (size_t i = 0; i < from->count && !ev->stopped; i++)
        if (from->items[i].set) slot_set(ev, &to->items[i], &from->items[i].value);
    share_class(to, from->class ? arena_copy(ev->parse, from->class, sizeof *from->class) : NULL);
    to->key_capacity = from->count;
    if (from->keys) to->keys = arena_copy(ev->parse, from->keys, from->count * sizeof *to->keys);
    return to;
}

void array_grow(Eval *ev, Array *a) {
    struct {
        Slot *items;
        size_t count, capacity;
    } list = {a->items, a->count, a->capacity};
    *list_push(ev->parse, &list) = (Slot){0};
    a->items = list.items;
    a->count = list.count;
    a->capacity = list.capacity;
}

Slot *array_slot(Eval *ev, const Array *array, double index, Span span) {
    if (index >= 0 && index < (double)array->count) return &array->items[(size_t)index];
    if (array->count)
        diag_error(ev->diags, span, "index %g is outside of the array, which goes from 0 to %zu", index,
                   array->count - 1);
    else
        diag_error(ev->diags, span, "index %g of an empty array", index);
    return NULL;
}

/* Rows are made at once, so that elements can be set in any order. */
static Array *make(Eval *ev, const size_t *sizes, size_t rank, ValueKind *class) {
    Array *a = arena_new(ev->parse, Array);
    a->count = sizes[0];
    a->rows = rank > 1;
    a->class = class;
    a->items = arena_new_array(ev->parse, Slot, a->count);
    for (size_t i = 0; rank > 1 && i < a->count; i++)
        a->items[i] = (Slot){.value = {.kind = VALUE_ARRAY, .as.array = make(ev, sizes + 1, rank - 1, class)},
                             .set = true};
    return a;
}

enum { LARGEST_RANK = 16 };

static bool read_sizes(Eval *ev, const Node *node, size_t *sizes) {
    uint64_t total = 1, all = 0 /* rows are elements too */, limit = ev->options->limits.array_elements;
    for (size_t i = 0; i < node->as.array.dimensions.count; i++) {
        const Node *d = node->as.array.dimensions.items[i];
        double size;
        if (!eval_float(ev, d, &size)) return false;
        if (!(size >= 1)) {
            diag_error(ev->diags, d->span, "an array needs at least one element, %g asked for", size);
            return false;
        }
        if ((double)total * size > (double)limit) {
            diag_error(ev->diags, d->span, "the scene's arrays would hold more than %llu elements",
                       (unsigned long long)limit);
            return false;
        }
        sizes[i] = (size_t)size;
        total *= (uint64_t)size;
        all += total;
    }
    return array_take(ev, all, node->span);
}

static void check_filled(Eval *ev, const Array *a, size_t given, Span span) {
    if (given < a->count)
        diag_error(ev->diags, span, "an array of %zu elements gets only %zu", a->count, given);
}

Value eval_array(Eval *ev, const Node *node) {
    size_t sizes[LARGEST_RANK] = {0}, rank = node->as.array.dimensions.count;
    if (rank > LARGEST_RANK) {
        diag_error(ev->diags, node->span, "an array has at most %d dimensions", LARGEST_RANK);
        return value_error();
    }
    if (!read_sizes(ev, node, sizes)) return value_error();
    if (rank == 0 && !node->as.array.body) {
        diag_error(ev->diags, node->span, "array needs its size: array[N]");
        return value_error();
    }
    Array *a = make(ev, sizes, rank ? rank : 1, node->op ? NULL : arena_new(ev->parse, ValueKind));
    a->growing = rank == 0;
    if (node->as.array.body) {
        Sink sink = {.kind = SINK_ARRAY, .array = a};
        size_t errors = ev->diags->failures;
        run_body(ev, node->as.array.body, &sink);
        if (errors == ev->diags->failures && rank) check_filled(ev, a, sink.next, node->span);
    }
    return (Value){.kind = VALUE_ARRAY, .as.array = a};
}

/* ---- dictionaries ---- */

Slot *dictionary_find(const Array *d, Name key) {
    for (size_t i = 0; i < d->count; i++)
        if (d->keys[i] == key) return &d->items[i];
    return NULL;
}

Slot *dictionary_entry(Eval *ev, Array *d, Name key) {
    Slot *known = dictionary_find(d, key);
    if (known) return known;
    if (!array_take(ev, 1, ev->at)) return NULL;
    struct {
        Name *items;
        size_t count, capacity;
    } keys = {d->keys, d->count, d->key_capacity};
    *list_push(ev->parse, &keys) = key;
    d->keys = keys.items;
    d->key_capacity = keys.capacity;
    array_grow(ev, d);
    return &d->items[d->count - 1];
}

Name dictionary_key(Eval *ev, const Node *index) {
    const char *text;
    size_t length;
    return eval_string(ev, index, &text, &length) ? intern(ev->names, text, length) : NULL;
}

Value eval_dictionary(Eval *ev, const Node *node) {
    Array *d = arena_new(ev->parse, Array);
    for (size_t i = 0; i + 1 < node->as.list.count; i += 2) {
        const Node *key = node->as.list.items[i];
        Name name = key->kind == NODE_NAME ? key->as.name : dictionary_key(ev, key);
        Value v = eval_node(ev, node->as.list.items[i + 1]);
        Slot *slot = name ? dictionary_entry(ev, d, name) : NULL;
        if (slot) slot_set(ev, slot, &v);
    }
    return (Value){.kind = VALUE_DICTIONARY, .as.array = d};
}
