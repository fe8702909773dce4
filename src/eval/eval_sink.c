#include "eval/build_parts.h"
#include "eval/eval_state.h"

#include <math.h>
#include <string.h>

/* What goes into a block outlives the statement that made it. */
static Value keep(Eval *ev, Value v) {
    if (v.kind == VALUE_VECTOR || v.kind == VALUE_COLOR)
        v.as.components = arena_copy(&ev->blocks, v.as.components, v.size * sizeof(double));
    else if (v.kind == VALUE_STRING)
        v.as.string.text =
            arena_copy(ev->build.arena, v.as.string.text, v.as.string.length + 1); /* builders keep texts */
    return v;
}

/* A number, colour or text that directives brought in right after a word continues that word's arguments, as it would if it stood
 * there. */
static bool continues_word(const Eval *ev, const Sink *sink, const Value *v) {
    const ItemList *items = sink->items;
    if (sink->word_body == ev->body || items->count == 0 ||
        items->items[items->count - 1].kind != ITEM_WORD || items->items[items->count - 1].body)
        return false;
    return value_is_numeric(v) || v->kind == VALUE_STRING;
}

static void add_argument(Eval *ev, BlockItem *item, Value v, Span span) {
    Argument *all = arena_new_array(&ev->blocks, Argument, item->argument_count + 1);
    if (item->argument_count) memcpy(all, item->arguments, item->argument_count * sizeof *all);
    all[item->argument_count++] = (Argument){v, span};
    item->arguments = all;
}

enum { LARGEST_RUN = 4096 }; /* longer lists would be copied again and again as they grow */

/* Objects of a large union take a pointer each, not a whole item. */
static bool joins_objects(Eval *ev, const Sink *sink, const Value *v) {
    if (!sink->gathers || v->kind != VALUE_OBJECT || sink->items->count == 0) return false;
    BlockItem *last = &sink->items->items[sink->items->count - 1];
    if (last->kind == ITEM_VALUE && last->value.kind == VALUE_OBJECT) {
        *last = (BlockItem){.kind = ITEM_OBJECTS, .span = last->span, .value = last->value};
        *list_push(&ev->blocks, &last->objects) = last->value.as.object;
    }
    if (last->kind != ITEM_OBJECTS || last->objects.count == LARGEST_RUN) return false;
    *list_push(&ev->blocks, &last->objects) = v->as.object;
    return true;
}

/* A list keeps its numbers without an item each. */
static bool joins_list(Eval *ev, Sink *sink, const Value *v, Span span) {
    if (!sink->lists || (v->kind != VALUE_FLOAT && v->kind != VALUE_VECTOR) || v->size > 3) return false;
    ListedNumber *n = list_push(&ev->blocks, &sink->numbers);
    *n = (ListedNumber){.span = span, .size = v->kind == VALUE_FLOAT ? 1 : v->size};
    for (int i = 0; i < 3; i++) n->components[i] = value_component(v, i);
    return true;
}

/* Something else stands in it: from here on it is a block like others. */
static void unlist(Eval *ev, Sink *sink) {
    sink->lists = false;
    if (sink->numbers.count == 0) return;
    const EvalBlock list = {.numbers = sink->numbers.items, .number_count = sink->numbers.count};
    const EvalBlock *block = block_with_items(&ev->blocks, &list);
    *sink->items = (ItemList){(BlockItem *)(uintptr_t)block->items, block->count, block->count};
    sink->numbers = (ListedNumbers){0};
}

static void add_item(Eval *ev, Sink *sink, Value v, Span span) {
    if (joins_list(ev, sink, &v, span)) return;
    unlist(ev, sink);
    v = keep(ev, v);
    if (joins_objects(ev, sink, &v)) return;
    if (continues_word(ev, sink, &v))
        add_argument(ev, &sink->items->items[sink->items->count - 1], v, span);
    else
        *list_push(&ev->blocks, sink->items) = (BlockItem){.kind = ITEM_VALUE, .span = span, .value = v};
}

static void add_element(Eval *ev, Sink *sink, Value v, Span span) {
    bool layers = sink->layers && v.kind == VALUE_TEXTURE && sink->next > 0 && sink->array->items[sink->next - 1].value.kind == VALUE_TEXTURE;
    sink->layers = v.kind == VALUE_TEXTURE;
    if (layers) {
        v.as.texture = texture_layered(&ev->build, v.as.texture, sink->array->items[--sink->next].value.as.texture, span);
        slot_set(ev, &sink->array->items[sink->next++], &v);
        return;
    }
    if (sink->array->growing && sink->next == sink->array->count) {
        if (!array_take(ev, 1, span)) return;
        array_grow(ev, sink->array);
    }
    if (sink->next >= sink->array->count && !sink->filled) {
        diag_error(ev->diags, span, "one element too many for an array of %zu", sink->array->count);
        sink->filled = true;
    }
    if (sink->next < sink->array->count && array_accepts(ev, sink->array, &v, span))
        slot_set(ev, &sink->array->items[sink->next++], &v);
}

void sink_value(Eval *ev, Sink *sink, Value v, Span span) {
    if (v.kind == VALUE_ERROR) {
        sink->filled = sink->kind == SINK_SINGLE || sink->filled;
        ev->silent_errors++;
        if (sink->kind == SINK_ARRAY && sink->next < sink->array->count)
            slot_set(ev, &sink->array->items[sink->next++], &v); /* so that its uses stay silent */
        return;
    }
    switch (sink->kind) {
    case SINK_SCENE: {
        Value kept = keep(ev, v);
        scene_draft_add(ev->draft, &ev->build, &kept, span);
        if (ev->options->ends_at_film && scene_draft_has_film(ev->draft)) ev->stopped = true;
        return;
    }
    case SINK_ITEMS: add_item(ev, sink, v, span); return;
    case SINK_SINGLE:
        if (sink->filled) diag_error(ev->diags, span, "a second value where one is expected");
        sink->value = v;
        sink->filled = true;
        return;
    case SINK_ARRAY: add_element(ev, sink, v, span); return;
    default: diag_error(ev->diags, span, "%s has no meaning here", value_kind_text(v.kind)); return;
    }
}

void sink_numbers(Eval *ev, Sink *sink, const ListedNumbers *numbers) {
    if (sink->lists && sink->numbers.count == 0) {
        sink->numbers = (ListedNumbers){numbers->items, numbers->count, numbers->count}; /* what is added comes into a copy */
        return;
    }
    for (size_t i = 0; i < numbers->count && !ev->stopped; i++) {
        const ListedNumber *n = &numbers->items[i];
        Value v = {.kind = VALUE_VECTOR, .size = (uint8_t)n->size, .as.components = (double *)(uintptr_t)n->components};
        sink_value(ev, sink, n->size == 1 ? value_float(n->components[0]) : v, n->span);
        if (ev->diags->error_count && diag_full(ev->diags)) ev->stopped = true;
    }
}

static const Argument *eval_arguments(Eval *ev, const NodeList *list, bool *ok) {
    Argument *out = arena_new_array(&ev->blocks, Argument, list->count);
    for (size_t i = 0; i < list->count; i++) {
        Value v = eval_node(ev, list->items[i]);
        if (v.kind == VALUE_ERROR) *ok = false;
        out[i] = (Argument){keep(ev, v), list->items[i]->span};
    }
    return out;
}

enum {
    MOST_PARTICLES = 4000000
}; /* the items of each stay in memory, about half a kilobyte, until all are read */

/* particles { count N { … } }: one item for each particle, with `index` counting. */
static void add_particles(Eval *ev, Sink *sink, const Node *node, BlockItem item) {
    uint64_t loops = ev->options->limits.loops, most = loops < MOST_PARTICLES ? loops : MOST_PARTICLES;
    double count = item.argument_count == 1 && item.arguments[0].value.kind == VALUE_FLOAT
                       ? item.arguments[0].value.as.number
                       : -1;
    if (!(count >= 0 && count <= (double)most) || count != (double)(uint64_t)count) {
        diag_error(ev->diags, item.argument_count ? item.arguments[0].span : node->span,
                   "'count' takes a whole number of particles, up to %llu", (unsigned long long)most);
        return;
    }
    Scope scope;
    scope_enter(ev, &scope);
    Value v = value_float(0), n = value_float(count);
    Slot *index = scope_bind(ev, ev->index_name, NULL, &v);
    size_t errors = ev->diags->failures;
    bool repeats = ev->repeats;
    ev->repeats = true;
    for (double i = 0; i < count && !ev->stopped && errors == ev->diags->failures; i++) {
        v = value_float(i);
        slot_set(ev, index, &v);
        Argument *arguments = arena_new_array(&ev->blocks, Argument, 2);
        arguments[0] = (Argument){v, item.word_span};
        arguments[1] = (Argument){n, item.arguments[0].span};
        BlockItem one = item;
        one.arguments = arguments;
        one.argument_count = 2;
        ArenaMark mark = arena_mark(&ev->temp);
        one.body = eval_block_items(ev, item.word, item.word_span, item.span, node->as.word.body);
        arena_reset_to(&ev->temp, mark);
        *list_push(&ev->blocks, sink->items) = one;
    }
    ev->repeats = repeats;
    scope_leave(ev, &scope);
}

/* phases N { … } of a texel: one item for each phase, its number behind N, with `phase` = 0, 1/N … */
static void add_phases(Eval *ev, Sink *sink, const Node *node, BlockItem item) {
    enum { MOST_PHASES = 1024 };
    double count = item.argument_count == 1 && item.arguments[0].value.kind == VALUE_FLOAT
                       ? item.arguments[0].value.as.number
                       : 0;
    if (!(count >= 1 && count <= MOST_PHASES) || count != floor(count)) {
        diag_error(ev->diags, item.argument_count ? item.arguments[0].span : node->span,
                   "'phases' takes a whole number, 1 to %d", MOST_PHASES);
        return;
    }
    double outer = ev->phase;
    bool had = ev->has_phase, repeats = ev->repeats;
    size_t errors = ev->diags->failures;
    ev->repeats = ev->has_phase = true;
    for (double i = 0; i < count && !ev->stopped && errors == ev->diags->failures; i++) {
        ArenaMark mark = arena_mark(&ev->temp);
        ev->phase = i / count;
        Argument *arguments = arena_new_array(&ev->blocks, Argument, 2);
        arguments[0] = item.arguments[0];
        arguments[1] = (Argument){value_float(i), item.word_span};
        BlockItem one = item;
        one.arguments = arguments;
        one.argument_count = 2;
        one.body = eval_block_items(ev, item.word, item.word_span, item.span, node->as.word.body);
        arena_reset_to(&ev->temp, mark);
        *list_push(&ev->blocks, sink->items) = one;
    }
    ev->phase = outer;
    ev->has_phase = had;
    ev->repeats = repeats;
    sink->word_body = ev->body;
}

/* A word among statements or elements: half of a block, part of another one, or a name that nobody declared. */
static void misplaced_word(Eval *ev, const Sink *sink, const Node *node) {
    Name word = node->as.word.word;
    Span span = node->as.word.word_span;
    bool block;
    block_builder_find(&ev->build, word, &block);
    if (block)
        diag_error(ev->diags, (Span){span.file, span.end, span.end}, "expected '{' after '%s'", word->text);
    else if (!keyword_of(&ev->keywords, word))
        eval_undeclared(ev, word, span);
    else if (sink->kind == SINK_SCENE)
        diag_error(ev->diags, span, "'%s' cannot stand at top level: it belongs into another block",
                   word->text);
    else
        diag_error(ev->diags, span, "'%s' has no meaning here", word->text);
}

void sink_word(Eval *ev, Sink *sink, const Node *node) {
    if (sink->kind != SINK_ITEMS) {
        misplaced_word(ev, sink, node);
        sink->filled = sink->filled || sink->kind == SINK_SINGLE;
        return;
    }
    unlist(ev, sink);
    bool ok = true;
    BlockItem item = {.kind = ITEM_WORD,
                      .span = node->span,
                      .word_span = node->as.word.word_span,
                      .word = node->as.word.word};
    item.argument_count = node->as.word.list.count;
    item.arguments = eval_arguments(ev, &node->as.word.list, &ok);
    if (!ok) {
        ev->silent_errors++;
        return;
    }
    if (node->as.word.body && item.word == ev->count_name && sink->block == ev->particles_name) {
        add_particles(ev, sink, node, item);
        return;
    }
    if (node->as.word.body && strcmp(item.word->text, "phases") == 0 && sink->block &&
        strcmp(sink->block->text, "texel") == 0) {
        add_phases(ev, sink, node, item);
        return;
    }
    if (node->as.word.body)
        item.body = eval_block_items(ev, item.word, item.word_span, item.span, node->as.word.body);
    *list_push(&ev->blocks, sink->items) = item;
    sink->word_body = ev->body;
}

void sink_entry(Eval *ev, Sink *sink, const Node *node) {
    if (sink->kind != SINK_ITEMS) {
        diag_error(ev->diags, node->span, "[ … ] has no meaning here");
        return;
    }
    unlist(ev, sink);
    BlockItem item = {.kind = ITEM_ENTRY, .span = node->span};
    item.entry = eval_block_items(ev, sink->block, node->span, node->span, node->as.block.body);
    *list_push(&ev->blocks, sink->items) = item;
}

/* { … } among the elements of an array is one row of it. */
void sink_list(Eval *ev, Sink *sink, const Node *node) {
    if (sink->kind != SINK_ARRAY) {
        Diagnostic *d = diag_error(ev->diags, (Span){node->span.file, node->span.begin, node->span.begin + 1},
                                   "unexpected '{'");
        if (sink->kind == SINK_SCENE)
            diag_hint(ev->diags, d, "a declared object is used as object { Name … }");
        return;
    }
    Array *a = sink->array;
    if (sink->next >= a->count) {
        diag_error(ev->diags, node->span, "one row too many for an array of %zu", a->count);
        return;
    }
    Slot *row = &a->items[sink->next++];
    if (!row->set || row->value.kind != VALUE_ARRAY) {
        diag_error(ev->diags, node->span, "this array has fewer dimensions");
        return;
    }
    Sink inner = {.kind = SINK_ARRAY, .array = row->value.as.array};
    size_t errors = ev->diags->failures;
    run_body(ev, node->as.block.body, &inner);
    if (errors == ev->diags->failures && inner.next < inner.array->count)
        diag_error(ev->diags, node->span, "a row of %zu elements gets only %zu", inner.array->count,
                   inner.next);
}
