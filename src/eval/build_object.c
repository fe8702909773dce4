#include "eval/build_parts.h"

#include <string.h>

Object object_begin(const EvalBlock *block, ObjectKind kind) {
    return (Object){
        .span = block->span, .kind = kind, .word = block->word->text, .transform = transform_identity()};
}

#define FIELD(name) offsetof(Object, name)
#define IGNORED(word)                                                                                        \
    { word, WORD_IGNORED, 0, NULL, false }
#define INERT(word)                                                                                          \
    { word, WORD_INERT, FIELD(inert), NULL, false }
/* Later transforms move what bounds and clips too: it is kept in the object's own space. */
static const Object *in_object_space(const BuildContext *context, const Object *part, const Object *object) {
    if (transform_is_identity(&object->transform)) return part;
    Object *moved = arena_copy(context->arena, part, sizeof *part);
    Transform back = transform_inverse(&object->transform);
    moved->transform = transform_then(&part->transform, &back);
    object_rehash(moved);
    return moved;
}

static void read_objects(Reader *reader, const Word *word, const Object *object, ObjectList *list) {
    if (word->body && word->body->count == 0) reader_error(reader, word->span, "'%s' is empty", word->text);
    const EvalBlock *body = word->body;
    if (!body || (body->count == 1 && body->items[0].kind == ITEM_WORD)) return;
    const Object **items = arena_new_array(reader->context->arena, const Object *, list->count + body->count);
    for (size_t i = 0; i < list->count; i++) items[i] = list->items[i];
    for (size_t i = 0; i < body->count; i++) {
        const Argument value = {body->items[i].value, body->items[i].span};
        const Object *part =
            body->items[i].kind == ITEM_VALUE ? object_from_value(reader->context, &value) : NULL;
        if (part) items[list->count++] = in_object_space(reader->context, part, object);
    }
    list->items = items;
}

/* `bounded_by { clipped_by }` and the other way round: the one is the other. */
static bool says(const Word *word, const char *text) {
    const EvalBlock *body = word->body;
    return body && body->count == 1 && body->items[0].kind == ITEM_WORD &&
           strcmp(body->items[0].word->text, text) == 0;
}

static void read_bounded_by(Reader *reader, const Word *word, void *target) {
    Object *object = target;
    if (says(word, "clipped_by")) object->bounded_by = object->clipped_by;
    read_objects(reader, word, object, &object->bounded_by);
}

static void read_clipped_by(Reader *reader, const Word *word, void *target) {
    Object *object = target;
    inert_add(reader->context, &object->inert, "clipped_by", word->span);
    if (says(word, "bounded_by")) object->clipped_by = object->bounded_by;
    read_objects(reader, word, object, &object->clipped_by);
}

/* Modifiers without effect here that only some objects take. */
static void read_restricted(Reader *reader, const Word *word, void *target) {
    static const struct {
        const char *word, *objects;
    } restricted[] = {
        {"sturm",
         " torus blob cubic quartic poly polynomial lathe prism sor sphere_sweep julia_fractal object "},
        {"split_union", " union object "},
        {"cutaway_textures", " intersection difference object "},
        {"inside_vector", " mesh mesh2 object "},
    };
    const char *kind = ((Object *)target)->word;
    grammar_word(reader, word);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(restricted); i++)
        if (strcmp(restricted[i].word, word->text) == 0 &&
            !strstr(restricted[i].objects, arena_printf(reader->context->arena, " %s ", kind)))
            reader_error(reader, word->span, "'%s' has no meaning for '%s'", word->text, kind);
}

static const WordRule rules[] = {
    {"no_shadow", WORD_MARK, FIELD(no_shadow), NULL, false},
    {"no_image", WORD_FLAG, FIELD(no_image), NULL, false},
    {"inverse", WORD_MARK, FIELD(inverse), NULL, false},
    {"hollow", WORD_FLAG, FIELD(hollow), NULL, false},
    {"bounded_by", WORD_CUSTOM, 0, read_bounded_by, false},
    {"clipped_by", WORD_CUSTOM, 0, read_clipped_by, false},
    IGNORED("no_reflection"),
    IGNORED("double_illuminate"),
    IGNORED("hierarchy"),
    {"sturm", WORD_CUSTOM, 0, read_restricted, false},
    {"split_union", WORD_CUSTOM, 0, read_restricted, false},
    {"cutaway_textures", WORD_CUSTOM, 0, read_restricted, false},
    {"inside_vector", WORD_CUSTOM, 0, read_restricted, false},
    IGNORED("photons"),
    IGNORED("radiosity"),
    IGNORED("no_radiosity"),
    INERT("uv_mapping"),
    INERT("interior_texture"),
};

bool object_on_value(Reader *reader, const Argument *value, void *target) {
    Object *object = target;
    if (value->value.kind == VALUE_COLOR) {
        diag_warning(reader->context->diags, value->span,
                     "a colour belongs into a pigment: it is ignored here");
        return true;
    }
    return take_looks(reader->context, value, &object->texture, &object->inert, &object->transform) ||
           take_transform(value, &object->transform);
}

bool object_finish(Reader *reader, Object *object, Value *out) {
    reader_add_table(reader, rules, VTS_ARRAY_COUNT(rules), object);
    reader_add_table(reader, transform_rules, transform_rule_count, &object->transform);
    if (!reader->on_value) {
        reader->on_value = object_on_value;
        reader->value_target = object;
    }
    if (reader->failed || !reader_run(reader)) return false;
    Object *made = arena_copy(reader->context->arena, object, sizeof *object);
    object_rehash(made);
    *out = (Value){.kind = VALUE_OBJECT, .as.object = made};
    return true;
}

bool object_is_copy(const EvalBlock *block) {
    return block->count && block->items[0].kind == ITEM_VALUE && block->items[0].value.kind == VALUE_OBJECT;
}

const Object *object_from_value(const BuildContext *context, const Argument *value) {
    if (value->value.kind == VALUE_OBJECT) return value->value.as.object;
    Object object = {.span = value->span, .transform = transform_identity()};
    if (value->value.kind == VALUE_SURFACE) {
        object.kind = OBJECT_SURFACE;
        object.word = "surface";
        object.as.surface = value->value.as.surface;
        object.texture = object.as.surface->texture;
    } else if (value->value.kind == VALUE_TEXEL) {
        object.kind = OBJECT_TEXEL;
        object.word = "texel";
        object.as.texel = value->value.as.texel;
    } else {
        return NULL;
    }
    Object *made = arena_copy(context->arena, &object, sizeof object);
    object_rehash(made);
    return made;
}

/* object { LIGHT transforms } */
static bool build_light_copy(Reader *reader, const Light *light, Value *out) {
    Object carrier =
        object_begin(reader->block, OBJECT_UNION); /* takes the modifiers; only its transform matters */
    Value ignored;
    if (!object_finish(reader, &carrier, &ignored)) return false;
    *out = (Value){.kind = VALUE_LIGHT, .as.light = light_placed(reader->context, light, &carrier.transform)};
    return true;
}

/* `object { O pigment … pigment … }` as a pattern: stays a block for the pigment, texture … around it. */
static bool is_pattern(const EvalBlock *block) {
    static const char *const holders[] = {"pigment",     "texture",     "normal",     "density",    "pattern",
                                          "pigment_map", "texture_map", "normal_map", "density_map"};
    for (size_t i = 0; block->outer && i < VTS_ARRAY_COUNT(holders); i++)
        if (strcmp(block->outer->text, holders[i]) == 0) return true;
    return false;
}

bool build_object(BuildContext *context, const EvalBlock *block, Value *out) {
    if (strcmp(block->word->text, "object") == 0 && is_pattern(block)) {
        Reader pattern = reader_begin(context, block);
        *out = (Value){.kind = VALUE_BLOCK, .as.block = block};
        return grammar_read(&pattern, "object_pattern");
    }
    Reader reader = reader_begin(context, block);
    const BlockItem *first = reader_peek(&reader);
    if (!first || first->kind != ITEM_VALUE) {
        if (first && first->kind == ITEM_WORD)
            reader_undeclared(&reader, first->word->text, first->word_span);
        else
            reader_error(&reader, block->word_span, "'%s' needs an object", block->word->text);
        return false;
    }
    reader.next++;
    Argument value = {first->value, first->span};
    if (value.value.kind == VALUE_LIGHT) return build_light_copy(&reader, value.value.as.light, out);
    const Object *source = object_from_value(context, &value);
    if (!source) {
        reader_mismatch(&reader, value.span, arena_printf(context->arena, "'%s'", block->word->text),
                        "an object", value.value.kind);
        return false;
    }
    Object object = *source;
    object.span = block->span;
    return object_finish(&reader, &object, out);
}

/* ---- union, merge, intersection, difference ---- */

typedef struct ChildList {
    const Object **items;
    size_t count, capacity;
} ChildList;

typedef struct LightList {
    const Light **items;
    size_t count, capacity;
} LightList;

typedef struct CsgDraft {
    Object object;
    ChildList children;
    LightList lights;
} CsgDraft;

static bool on_csg_value(Reader *reader, const Argument *value, void *target) {
    CsgDraft *draft = target;
    const Object *child = object_from_value(reader->context, value);
    if (child)
        *list_push(reader->context->arena, &draft->children) = child;
    else if (value->value.kind == VALUE_LIGHT)
        *list_push(reader->context->arena, &draft->lights) = value->value.as.light;
    else
        return object_on_value(reader, value, &draft->object);
    return true;
}

static ObjectKind csg_kind(const char *word) {
    if (strcmp(word, "merge") == 0) return OBJECT_MERGE;
    if (strcmp(word, "intersection") == 0) return OBJECT_INTERSECTION;
    if (strcmp(word, "difference") == 0) return OBJECT_DIFFERENCE;
    return OBJECT_UNION;
}

bool build_csg(BuildContext *context, const EvalBlock *block, Value *out) {
    CsgDraft draft = {.object = object_begin(block, csg_kind(block->word->text))};
    Reader reader = reader_begin(context, block);
    static const WordRule group_rules[] = {IGNORED("global_lights")};
    bool group = strcmp(block->word->text, "light_group") == 0;
    if (group) reader_add_table(&reader, group_rules, VTS_ARRAY_COUNT(group_rules), &draft);
    reader.on_value = on_csg_value;
    reader.value_target = &draft;
    if (!object_finish(&reader, &draft.object, out)) return false;
    if (draft.children.count + draft.lights.count < 2 && !group)
        diag_warning(context->diags, block->word_span, "'%s' should hold at least 2 objects, found %zu",
                     block->word->text, draft.children.count + draft.lights.count);
    Object *made = arena_copy(context->arena, out->as.object, sizeof *made);
    made->as.children.items = draft.children.items;
    made->as.children.count = draft.children.count;
    made->as.children.lights = draft.lights.items;
    made->as.children.light_count = draft.lights.count;
    object_rehash(made);
    out->as.object = made;
    return true;
}

bool build_unmodelled(BuildContext *context, const EvalBlock *block, Value *out) {
    Object *object = arena_new(context->arena, Object);
    *object = object_begin(block, OBJECT_UNMODELLED);
    inert_add(context, &object->inert, object->word, block->word_span);
    object_rehash(object);
    *out = (Value){.kind = VALUE_OBJECT, .as.object = object};
    return true;
}
