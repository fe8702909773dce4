#include "eval/eval_state.h"

#include <string.h>

/* Blocks whose builders know ITEM_OBJECTS. */
static bool gathers(Keyword word) {
    switch (word) {
    case KW_union:
    case KW_merge:
    case KW_intersection:
    case KW_difference:
    case KW_light_group:
    case KW_mesh: return true;
    default: return false;
    }
}

/* Blocks of which mesh2 and surfaces read the numbers as they are. */
static bool lists(Keyword keyword, Name word) {
    switch (keyword) {
    case KW_vertex_vectors:
    case KW_normal_vectors:
    case KW_uv_vectors:
    case KW_face_indices:
    case KW_normal_indices:
    case KW_uv_indices: return true;
    case KW_NONE: return strcmp(word->text, "height_vectors") == 0 || strcmp(word->text, "w_vectors") == 0;
    default: return false;
    }
}

const EvalBlock *eval_block_items(Eval *ev, Name word, Span word_span, Span span, const Body *body) {
    ItemList items = {0};
    Keyword keyword = keyword_of(&ev->keywords, word);
    Sink sink = {.kind = SINK_ITEMS,
                 .block = word,
                 .gathers = gathers(keyword),
                 .lists = lists(keyword, word),
                 .items = &items};
    run_body(ev, body, &sink);
    EvalBlock *block = arena_new(&ev->blocks, EvalBlock);
    *block = (EvalBlock){
        .word = word, .word_span = word_span, .span = span, .items = items.items, .count = items.count};
    block->numbers = sink.numbers.items;
    block->number_count = sink.numbers.count;
    return block;
}

const EvalBlock *block_with_items(Arena *arena, const EvalBlock *from) {
    EvalBlock *to = arena_copy(arena, from, sizeof *from);
    BlockItem *items = arena_new_array(arena, BlockItem, from->number_count);
    for (size_t i = 0; i < from->number_count; i++) {
        const ListedNumber *n = &from->numbers[i];
        Value v = {.kind = VALUE_VECTOR, .size = (uint8_t)n->size, .as.components = n->components};
        if (n->size == 1) v = value_float(n->components[0]);
        items[i] = (BlockItem){.kind = ITEM_VALUE, .span = n->span, .value = v};
    }
    to->items = items;
    to->count = from->number_count;
    to->numbers = NULL;
    return to;
}

static Value keep_value(Arena *arena, Value v) {
    if (v.kind == VALUE_VECTOR || v.kind == VALUE_COLOR)
        v.as.components = arena_copy(arena, v.as.components, v.size * sizeof(double));
    return v;
}

const EvalBlock *block_keep(Arena *arena, const EvalBlock *from) {
    if (!from) return NULL;
    EvalBlock *to = arena_copy(arena, from, sizeof *from);
    if (from->numbers) to->numbers = arena_copy(arena, from->numbers, from->number_count * sizeof *from->numbers);
    BlockItem *items = arena_new_array(arena, BlockItem, from->count);
    for (size_t i = 0; i < from->count; i++) {
        items[i] = from->items[i];
        items[i].value = keep_value(arena, items[i].value);
        items[i].body = block_keep(arena, items[i].body);
        items[i].entry = block_keep(arena, items[i].entry);
        items[i].objects.items =
            arena_copy(arena, items[i].objects.items, items[i].objects.count * sizeof(const Object *));
        if (items[i].argument_count == 0) continue;
        Argument *arguments =
            arena_copy(arena, items[i].arguments, items[i].argument_count * sizeof(Argument));
        for (size_t k = 0; k < items[i].argument_count; k++)
            arguments[k].value = keep_value(arena, arguments[k].value);
        items[i].arguments = arguments;
    }
    to->items = items;
    return to;
}

static Value unknown_block(Eval *ev, const EvalBlock *block) {
    Diagnostic *d = diag_error(ev->diags, block->word_span, "unknown word '%s'", block->word->text);
    const char *suggestion = block_word_suggest(block->word->text);
    if (suggestion) diag_hint(ev->diags, d, "did you mean '%s'?", suggestion);
    return value_error();
}

Value eval_block(Eval *ev, const Node *node, Name declared_as) {
    ArenaMark mark = arena_mark(&ev->blocks);
    size_t errors = ev->diags->failures + ev->silent_errors;
    bool known = true;
    BlockBuilder *builder = block_builder_find(&ev->build, node->as.block.word, &known);
    Name outer = ev->block_word;
    ev->block_word = node->as.block.word;
    EvalBlock *block = (EvalBlock *)(uintptr_t)eval_block_items(
        ev, node->as.block.word, node->as.block.word_span, node->span, node->as.block.body);
    ev->block_word = outer;
    block->outer = declared_as ? NULL : outer;
    block->declared_as = declared_as;
    block->of_layers = node->op == BLOCK_OF_LAYERS;
    Value v = value_error();
    if (keyword_of(&ev->keywords, block->word) == KW_spline) {
        v = eval_spline(ev, block);
    } else if (!known) {
        v = unknown_block(ev, block);
    } else if (ev->diags->failures + ev->silent_errors != errors) {
        v = value_error(); /* what is missing inside was said already */
    } else if (declared_as && !block_may_be_declared(block->word)) {
        diag_error(ev->diags, block->word_span, "'%s' cannot be declared", block->word->text);
    } else if (builder) {
        if (!builder(&ev->build, block, &v)) v = value_error();
        if (v.kind == VALUE_BLOCK) v.as.block = block_keep(ev->build.arena, v.as.block);
    } else {
        v = (Value){.kind = VALUE_BLOCK, .as.block = block_keep(ev->build.arena, block)};
    }
    arena_reset_to(&ev->blocks, mark);
    return v;
}
