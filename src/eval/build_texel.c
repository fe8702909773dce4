#include "eval/build_parts.h"
#include "scene/scene_bounds.h"

#include <math.h>
#include <string.h>

typedef struct LayerList {
    TexelLayer *items;
    size_t count, capacity;
} LayerList;

typedef struct TexelDraft {
    TexelDef texel;
    LayerList layers;
    LayerList *phases; /* texel.phase_count of them, */
    int phases_read;   /* so many of which are read */
    double period;     /* in seconds; 0: not given */
    Span period_span;
    struct {
        const TexelDef **items;
        size_t count, capacity;
    } choices;
} TexelDraft;

enum { MAX_RESOLUTION = 1024 };

static bool is_bounded(Box3 box) {
    return !box3_is_empty(box) && vec3_is_finite(box.min) && vec3_is_finite(box.max);
}

static void set_bounds(Reader *reader, TexelDraft *draft, Box3 box, Span span) {
    Vec3 size = vec3_sub(box.max, box.min);
    if (!is_bounded(box))
        reader_error(reader, span,
                     "the texel's bounds come from an object without bounds (or without anything in it)");
    else if (size.x == 0 || size.y == 0 || size.z == 0)
        reader_error(reader, span, "the texel's bounds have no volume: <%g, %g, %g> in size", size.x, size.y,
                     size.z);
    else
        draft->texel.bounds = box;
}

static void note_unmodelled(Reader *reader, TexelDraft *draft, const Object *object) {
    for (const InertNote *note = object_inert(object); note; note = note->next)
        inert_add(reader->context, &draft->texel.inert, note->word, note->span);
}

/* `bounds A, B`, `bounds OBJECT`, or `bounds { OBJECT }` read as `bounds` and an object behind it. */
static void read_bounds(Reader *reader, const Word *word, void *target) {
    Vec3 a, b;
    if (word->count == 2) {
        if (word_vector(reader, word, 0, &a) && word_vector(reader, word, 1, &b))
            set_bounds(reader, target, (Box3){vec3_min(a, b), vec3_max(a, b)}, word->arguments[1].span);
        return;
    }
    Argument value;
    if (word->count == 1)
        value = word->arguments[0];
    else if (word->count || !reader_take_value(reader, VALUE_OBJECT, &value)) {
        reader_error(reader, word->span, "'bounds' takes two corners or an object");
        return;
    }
    const Object *object = object_from_value(reader->context, &value);
    if (object && (object->kind == OBJECT_UNMODELLED || object->kind == OBJECT_SOLID))
        note_unmodelled(reader, target, object); /* the unit cube stays */
    else if (object)
        set_bounds(reader, target, object_bounds(object), value.span);
    else
        reader_mismatch(reader, value.span, "'bounds'", "two corners or an object", value.value.kind);
}

static void read_resolution(Reader *reader, const Word *word, void *target) {
    TexelDraft *draft = target;
    Word next;
    int resolution;
    if (word->count == 0 && reader_take_word(reader, "auto", &next)) {
        draft->texel.resolution = 0;
        return;
    }
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, &resolution)) return;
    if (resolution < 1 || resolution > MAX_RESOLUTION) {
        Diagnostic *d =
            reader_error(reader, word->arguments[0].span, "'resolution' must lie between 1 and %d, found %d",
                         MAX_RESOLUTION, resolution);
        diag_hint(reader->context->diags, d,
                  "leave it out, or write 'resolution auto', to get what the frame needs");
    } else {
        draft->texel.resolution = resolution;
    }
}

static void read_cyclic(Reader *reader, const Word *word, void *target) {
    TexelDraft *draft = target;
    Vec3 axes;
    if (!word_arguments(reader, word, 1, 1) || !word_vector(reader, word, 0, &axes)) return;
    draft->texel.cyclic = (axes.x != 0 ? 1u : 0u) | (axes.y != 0 ? 2u : 0u) | (axes.z != 0 ? 4u : 0u);
}

/* ---- layers ---- */

typedef struct LayerDraft {
    TexelDraft *texel;
    TexelLayer layer;
    bool unmodelled; /* holds something that is not drawn */
    struct {
        const Object **items;
        size_t count, capacity;
    } contents;
    Transform place;
} LayerDraft;

static bool on_layer_value(Reader *reader, const Argument *value, void *target) {
    LayerDraft *draft = target;
    const InertNote *ignored = NULL;
    const Object *object = value->value.kind == VALUE_SURFACE || value->value.kind == VALUE_TEXEL
                               ? NULL
                               : object_from_value(reader->context, value);
    if (!object) return take_looks(reader->context, value, &draft->layer.texture, &ignored, &draft->place);
    if (object->kind == OBJECT_UNMODELLED) {
        note_unmodelled(reader, draft->texel, object);
        draft->unmodelled = true;
        return true;
    }
    if (object->kind == OBJECT_PLANE)
        reader_error(reader, value->span, "a plane has no end: a layer's contents must have bounds");
    *list_push(reader->context->arena, &draft->contents) = object;
    return true;
}

static void read_density(Reader *reader, const Word *word, void *target) {
    LayerDraft *draft = target;
    if (!word->body) {
        reader_error(reader, word->span, "'%s' needs its block { … }", word->text);
        return;
    }
    const DensityField *field = density_read(reader, word->body);
    if (field && field->unmodelled) {
        inert_add(reader->context, &draft->texel->texel.inert, field->unmodelled, word->span);
        draft->unmodelled = true;
        return;
    }
    if (draft->layer.density) reader_error(reader, word->span, "a layer holds one density");
    draft->layer.density = field;
}

/* Of a layer that names none: that of its objects, which must be one. NULL: they have none. */
static const Texture *texture_of_contents(Reader *reader, const LayerDraft *layer) {
    const Object *textured = NULL;
    for (size_t i = 0; i < layer->contents.count; i++) {
        const Object *object = layer->contents.items[i];
        if (!object->texture) continue;
        if (!textured) textured = object;
        if (hash_equal(object->texture->hash, textured->texture->hash)) continue;
        Diagnostic *d = diag_warning(reader->context->diags, object->span, "a layer has one texture: this object gets that of the first");
        diag_hint(reader->context->diags, d, "give it a layer of its own");
        break;
    }
    if (!textured) return NULL;
    Transform place = object_transform(textured);
    return texture_placed(reader->context, textured->texture, &place);
}

/* A layer of nothing but what is not drawn is left out; one without anything is an error. */
static void read_layer(Reader *reader, const Word *word, void *target) {
    static const WordRule layer_rules[] = {{"density", WORD_CUSTOM, 0, read_density, false}};
    TexelDraft *draft = target;
    if (!word->body) {
        reader_error(reader, word->span, "'layer' needs its contents { … }");
        return;
    }
    LayerDraft layer = {.texel = draft, .layer.span = word->whole, .place = transform_identity()};
    Reader body = reader_nested(reader, word->body);
    reader_add_table(&body, layer_rules, VTS_ARRAY_COUNT(layer_rules), &layer);
    body.on_value = on_layer_value;
    body.value_target = &layer;
    reader_run(&body);
    if (!reader_end_nested(reader, &body)) return;
    if (layer.contents.count && layer.layer.density)
        reader_error(reader, layer.layer.density->span, "a layer holds a density or objects: superimpose two layers");
    if (layer.contents.count == 0 && !layer.layer.density) {
        if (!layer.unmodelled) reader_error(reader, word->span, "this layer holds no object");
        return;
    }
    if (!layer.layer.texture) layer.layer.texture = texture_of_contents(reader, &layer);
    if (!layer.layer.texture) layer.layer.texture = texture_default(reader->context); /* of now, as for objects */
    layer.layer.contents = layer.contents.items;
    layer.layer.content_count = layer.contents.count;
    layer_rehash(&layer.layer);
    *list_push(reader->context->arena, &draft->layers) = layer.layer;
}

/* ---- texel { choose A, B } and the rest ---- */

static void add_choice(Reader *reader, TexelDraft *draft, const Argument *value) {
    if (value->value.kind != VALUE_TEXEL)
        reader_mismatch(reader, value->span, "'choose'", "texels", value->value.kind);
    else
        *list_push(reader->context->arena, &draft->choices) = value->value.as.texel;
}

static void read_choose(Reader *reader, const Word *word, void *target) {
    Argument value;
    for (size_t i = 0; i < word->count; i++) add_choice(reader, target, &word->arguments[i]);
    while (reader_take_value(reader, VALUE_TEXEL, &value)) add_choice(reader, target, &value);
    if (((TexelDraft *)target)->choices.count == 0 && !reader->failed)
        reader_error(reader, word->span, "'choose' needs texels to choose from");
}

static bool on_value(Reader *reader, const Argument *value, void *target) {
    (void)target;
    if (value->value.kind == VALUE_STRING) {
        reader_error(reader, value->span, "a texel's file comes first, and without layers of its own");
        return true;
    }
    if (value->value.kind != VALUE_OBJECT) return false;
    Diagnostic *d = reader_error(reader, value->span, "objects of a texel stand in its layers");
    diag_hint(reader->context->diags, d, "write layer { … } around it");
    return true;
}

/* ---- phases N { layer {…} … } ---- */

/* One of them, as the evaluator has them: N, and its number from 0. Its layers take the place of the texel's. */
static void read_phases(Reader *reader, const Word *word, void *target) {
    static const WordRule phase_rules[] = {{"layer", WORD_CUSTOM, 0, read_layer, false}};
    TexelDraft *draft = target;
    double count, number;
    if (!word->body) {
        reader_error(reader, word->span, "'%s' needs its block { … }", word->text);
        return;
    }
    if (!word_arguments(reader, word, 2, 2) || !word_float(reader, word, 0, &count) || !word_float(reader, word, 1, &number)) return;
    if (number == 0 && draft->phases) {
        reader_error(reader, word->span, "'%s' stands twice in '%s'", word->text, "texel");
        return;
    }
    if (!draft->phases) {
        draft->texel.phase_count = (int)count;
        draft->phases = arena_new_array(reader->context->arena, LayerList, (size_t)count);
    }
    LayerList outside = draft->layers;
    draft->layers = (LayerList){0};
    Reader body = reader_nested(reader, word->body);
    reader_add_table(&body, phase_rules, VTS_ARRAY_COUNT(phase_rules), draft);
    body.on_value = on_value;
    body.value_target = draft;
    reader_run(&body);
    if (reader_end_nested(reader, &body) && draft->phases_read < draft->texel.phase_count) draft->phases[draft->phases_read++] = draft->layers;
    draft->layers = outside;
}

static void read_period(Reader *reader, const Word *word, void *target) {
    TexelDraft *draft = target;
    if (!word_arguments(reader, word, 1, 1) || !word_float(reader, word, 0, &draft->period)) return;
    draft->period_span = word->arguments[0].span;
    if (!(draft->period > 0 && isfinite(draft->period))) reader_error(reader, draft->period_span, "'period' must be above 0, found %g", draft->period);
}

/* A film that goes round wants whole periods. */
static double period_of(Reader *reader, const TexelDraft *draft) {
    double cycle = reader->context->cycle, period = draft->period;
    if (period == 0) return cycle > 0 ? cycle : 1;
    if (!(cycle > 0)) return period;
    double periods = fmax(floor(cycle / period + 0.5), 1);
    if (fabs(cycle / periods - period) > 1e-9 * period)
        diag_warning(reader->context->diags, draft->period_span, "the film goes round in %g seconds, which are no whole periods of %g: 'period' is taken as %g", cycle,
                       period, cycle / periods);
    return cycle / periods;
}

/* The layers of the phase that is played at the frame's time. A frame that should begin a phase does so, whatever rounding says. */
static void choose_phase(Reader *reader, TexelDraft *draft) {
    TexelDef *texel = &draft->texel;
    double turns = reader->context->time / period_of(reader, draft), share = turns - floor(turns);
    if (!(share >= 0 && share < 1)) share = 0; /* times that are no numbers, or too large to have a share */
    texel->phase = (int)floor(share * texel->phase_count + 1e-6) % texel->phase_count;
    draft->layers = draft->phases[texel->phase];
}

static const WordRule rules[] = {
    {"bounds", WORD_CUSTOM, 0, read_bounds, true}, {"resolution", WORD_CUSTOM, 0, read_resolution, true},
    {"cyclic", WORD_CUSTOM, 0, read_cyclic, true}, {"layer", WORD_CUSTOM, 0, read_layer, false},
    {"choose", WORD_CUSTOM, 0, read_choose, true}, {"phases", WORD_CUSTOM, 0, read_phases, false},
    {"period", WORD_CUSTOM, 0, read_period, true},
};

/* `texel { Flower density 0.05 texture { Red } }` belongs to the skin around it: it stays a block. */
static bool is_reference(const EvalBlock *block) {
    return block->count && block->items[0].kind == ITEM_VALUE && block->items[0].value.kind == VALUE_TEXEL;
}

static bool check_content(Reader *reader, const TexelDraft *draft) {
    if ((draft->choices.count > 0) + (draft->layers.count > 0) + (draft->phases != NULL) > 1)
        reader_error(reader, reader->block->word_span, "a texel has layers, phases or choices: one of them");
    else if (draft->period > 0 && !draft->phases)
        reader_error(reader, draft->period_span, "'period' is that of phases, which this texel has none of");
    else if (!draft->layers.count && !draft->choices.count && !draft->phases && !draft->texel.inert)
        reader_error(reader, reader->block->word_span, "this texel has no content: it needs a layer { … }");
    return !reader->failed;
}

/* ---- texel { "forest.vtx" } ---- */

/* The file's texel in the place of its name; what follows belongs to the skin around it, as with a declared texel. */
static bool texel_from_file(BuildContext *context, const EvalBlock *block, Value *out) {
    const BlockItem *name = &block->items[0];
    TexelDef *texel = arena_new(context->arena, TexelDef);
    const char *path = arena_printf(context->arena, "%.*s", (int)name->value.as.string.length, name->value.as.string.text);
    if (!texel_file_read(context, path, name->span, texel)) return false;
    if (block->declared_as) texel->name = block->declared_as->text;
    Value value = {.kind = VALUE_TEXEL, .as.texel = texel};
    if (block->count > 1) {
        EvalBlock *reference = arena_copy(context->arena, block, sizeof *block);
        BlockItem *items = arena_copy(context->arena, block->items, block->count * sizeof *items);
        items[0].value = value;
        reference->items = items;
        value = (Value){.kind = VALUE_BLOCK, .as.block = reference};
    }
    *out = value;
    return true;
}

bool build_texel(BuildContext *context, const EvalBlock *block, Value *out) {
    if (is_reference(block)) {
        *out = block->count == 1 ? block->items[0].value : (Value){.kind = VALUE_BLOCK, .as.block = block};
        return true;
    }
    if (block_begins_with_string(block)) return texel_from_file(context, block, out);
    TexelDraft *draft = arena_new(context->arena, TexelDraft);
    TexelDef *texel = &draft->texel;
    *texel = (TexelDef){.span = block->span,
                        .name = block->declared_as ? block->declared_as->text : "texel",
                        .bounds = {{0, 0, 0}, {1, 1, 1}}};
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), draft);
    reader.on_value = on_value;
    reader.value_target = draft;
    if (!reader_run(&reader) || !check_content(&reader, draft)) return false;
    if (draft->phases) choose_phase(&reader, draft);
    if (draft->phases && !draft->layers.count && !texel->inert) {
        reader_error(&reader, block->word_span, "phase %d of this texel has no content: it needs a layer { … }", texel->phase);
        return false;
    }
    texel->layers = draft->layers.items;
    texel->layer_count = draft->layers.count;
    texel->choices = draft->choices.items;
    texel->choice_count = draft->choices.count;
    texel_rehash(texel);
    *out = (Value){.kind = VALUE_TEXEL, .as.texel = texel};
    return true;
}
