#include "eval/build_parts.h"

#include <string.h>

ObjectDraft object_begin(const EvalBlock *block, ObjectKind kind) {
    return (ObjectDraft){
        .object = {.span = block->span, .kind = (uint8_t)kind}, .transform = transform_identity(), .word = block->word->text};
}

#define FIELD(name) offsetof(ObjectDraft, name)
#define IGNORED(word)                                                                                        \
    { word, WORD_IGNORED, 0, NULL, false }
#define INERT(word)                                                                                          \
    { word, WORD_INERT, FIELD(rest.inert), NULL, false }
/* Later transforms move what bounds and clips too: it is kept in the object's own space. */
static const Object *in_object_space(const BuildContext *context, const Object *part, const Transform *place) {
    if (transform_is_identity(place)) return part;
    Transform back = transform_inverse(place), own = object_transform(part);
    Transform moved = transform_then(&own, &back);
    return object_keep(context->arena, part, &moved);
}

static void read_objects(Reader *reader, const Word *word, const ObjectDraft *draft, ObjectList *list) {
    if (word->body && word->body->count == 0) reader_error(reader, word->span, "'%s' is empty", word->text);
    const EvalBlock *body = word->body;
    if (!body || (body->count == 1 && body->items[0].kind == ITEM_WORD)) return;
    const Object **items = arena_new_array(reader->context->arena, const Object *, list->count + body->count);
    for (size_t i = 0; i < list->count; i++) items[i] = list->items[i];
    for (size_t i = 0; i < body->count; i++) {
        const Argument value = {body->items[i].value, body->items[i].span};
        const Object *part =
            body->items[i].kind == ITEM_VALUE ? object_from_value(reader->context, &value) : NULL;
        if (part) items[list->count++] = in_object_space(reader->context, part, &draft->transform);
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
    ObjectDraft *draft = target;
    if (says(word, "clipped_by")) draft->rest.bounded_by = draft->rest.clipped_by;
    read_objects(reader, word, draft, &draft->rest.bounded_by);
}

static void read_clipped_by(Reader *reader, const Word *word, void *target) {
    ObjectDraft *draft = target;
    if (says(word, "bounded_by")) draft->rest.clipped_by = draft->rest.bounded_by;
    read_objects(reader, word, draft, &draft->rest.clipped_by);
}

static void read_inside(Reader *reader, const Word *word, void *target) {
    ObjectDraft *draft = target;
    read_interior_texture(reader, word, &draft->rest.interior_texture, &draft->transform);
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
    const char *kind = ((const ObjectDraft *)target)->word;
    grammar_word(reader, word);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(restricted); i++)
        if (strcmp(restricted[i].word, word->text) == 0 &&
            !strstr(restricted[i].objects, arena_printf(reader->context->arena, " %s ", kind)))
            reader_error(reader, word->span, "'%s' has no meaning for '%s'", word->text, kind);
}

static void read_cutaway(Reader *reader, const Word *word, void *target) {
    read_restricted(reader, word, target);
    ((ObjectDraft *)target)->cutaway = true;
}

static const WordRule rules[] = {
    {"no_shadow", WORD_MARK, FIELD(no_shadow), NULL, false},
    {"no_image", WORD_FLAG, FIELD(no_image), NULL, false},
    {"inverse", WORD_MARK, FIELD(inverse), NULL, false},
    {"hollow", WORD_FLAG, FIELD(rest.hollow), NULL, false},
    {"bounded_by", WORD_CUSTOM, 0, read_bounded_by, false},
    {"clipped_by", WORD_CUSTOM, 0, read_clipped_by, false},
    {"no_reflection", WORD_FLAG, FIELD(no_reflection), NULL, false},
    {"no_radiosity", WORD_FLAG, FIELD(no_radiosity), NULL, false},
    {"double_illuminate", WORD_FLAG, FIELD(double_illuminate), NULL, false},
    IGNORED("hierarchy"),
    {"sturm", WORD_CUSTOM, 0, read_restricted, false},
    {"split_union", WORD_CUSTOM, 0, read_restricted, false},
    {"cutaway_textures", WORD_CUSTOM, 0, read_cutaway, false},
    {"inside_vector", WORD_CUSTOM, 0, read_restricted, false},
    IGNORED("photons"),
    IGNORED("radiosity"),
    INERT("uv_mapping"),
    {"interior_texture", WORD_CUSTOM, 0, read_inside, false},
};

void take_interior(const BuildContext *context, const Argument *value, ObjectDraft *draft) {
    const Interior *interior = NULL;
    if (value->value.kind == VALUE_INTERIOR) interior = value->value.as.interior;
    if (value->value.kind == VALUE_MATERIAL) interior = material_interior(context, value->value.as.node);
    const Transform back = transform_inverse(&draft->transform);
    if (interior) draft->rest.interior = interior_placed(context, interior, &back);
}

/* The interior_texture of a material. */
static void take_inside(const BuildContext *context, const Argument *value, ObjectDraft *draft) {
    if (value->value.kind != VALUE_MATERIAL) return;
    const Texture *inside = material_inside(context, value->value.as.node);
    Transform back = transform_inverse(&draft->transform);
    if (inside) draft->rest.interior_texture = texture_placed(context, inside, &back);
}

bool object_on_value(Reader *reader, const Argument *value, void *target) {
    ObjectDraft *draft = target;
    if (value->value.kind == VALUE_COLOR) {
        diag_warning(reader->context->diags, value->span,
                     "a colour belongs into a pigment: it is ignored here");
        return true;
    }
    take_interior(reader->context, value, draft);
    take_inside(reader->context, value, draft);
    return take_looks(reader->context, value, &draft->object.texture, &draft->rest.inert, &draft->transform) ||
           take_transform(value, &draft->transform);
}

bool object_read(Reader *reader, ObjectDraft *draft) {
    reader_add_table(reader, rules, VTS_ARRAY_COUNT(rules), draft);
    reader_add_table(reader, transform_rules, transform_rule_count, &draft->transform);
    if (!reader->on_value) {
        reader->on_value = object_on_value;
        reader->value_target = draft;
    }
    return !reader->failed && reader_run(reader);
}

bool object_make(Reader *reader, const ObjectDraft *draft, Value *out) {
    Arena *arena = reader->context->arena;
    Object object = draft->object;
    const ObjectRest *rest = &draft->rest;
    object.no_shadow = draft->no_shadow;
    object.no_image = draft->no_image;
    object.inverse = draft->inverse;
    object.no_reflection = draft->no_reflection;
    object.no_radiosity = draft->no_radiosity;
    object.double_illuminate = draft->double_illuminate;
    object.cutaway = draft->cutaway;
    object.rest = rest->inert || rest->hollow || rest->interior || rest->interior_texture || rest->clipped_by.count || rest->bounded_by.count
                      ? arena_copy(arena, rest, sizeof *rest)
                      : NULL;
    int depth = object_depth_by_parts(&object);
    if (depth > OBJECT_DEEPEST) {
        reader_error(reader, reader->block->word_span, "objects are nested more than %d deep", OBJECT_DEEPEST);
        return false;
    }
    object.depth = (uint16_t)depth;
    *out = (Value){.kind = VALUE_OBJECT, .as.object = object_keep(arena, &object, &draft->transform)};
    return true;
}

bool object_finish(Reader *reader, ObjectDraft *draft, Value *out) {
    return object_read(reader, draft) && object_make(reader, draft, out);
}

bool object_is_copy(const EvalBlock *block) {
    return block->count && block->items[0].kind == ITEM_VALUE && block->items[0].value.kind == VALUE_OBJECT;
}

const Object *object_from_value(const BuildContext *context, const Argument *value) {
    if (value->value.kind == VALUE_OBJECT) return value->value.as.object;
    Object object = {.span = value->span};
    if (value->value.kind == VALUE_SURFACE) {
        object.kind = OBJECT_SURFACE;
        object.as.surface = value->value.as.surface;
        object.texture = object.as.surface->texture;
    } else if (value->value.kind == VALUE_TEXEL) {
        object.kind = OBJECT_TEXEL;
        object.as.texel = value->value.as.texel;
    } else {
        return NULL;
    }
    int depth = object_depth_by_parts(&object);
    if (depth > OBJECT_DEEPEST) {
        diag_error(context->diags, value->span, "objects are nested more than %d deep", OBJECT_DEEPEST);
        object = (Object){.span = value->span, .kind = OBJECT_UNMODELLED, .as.word = "object"};
        depth = 1;
    }
    object.depth = (uint16_t)depth;
    return object_keep(context->arena, &object, NULL);
}

/* object { LIGHT transforms } */
static bool build_light_copy(Reader *reader, const Light *light, Value *out) {
    ObjectDraft carrier = object_begin(reader->block, OBJECT_UNION); /* takes the modifiers; only its transform matters */
    if (!object_read(reader, &carrier)) return false;
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
    ObjectDraft draft = {.object = object_copy(source), .transform = object_transform(source), .word = block->word->text};
    draft.object.span = block->span;
    draft.no_shadow = source->no_shadow;
    draft.no_image = source->no_image;
    draft.inverse = source->inverse;
    draft.no_reflection = source->no_reflection;
    draft.no_radiosity = source->no_radiosity;
    draft.double_illuminate = source->double_illuminate;
    draft.cutaway = source->cutaway;
    if (source->rest) draft.rest = *source->rest;
    return object_finish(&reader, &draft, out);
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
    ObjectDraft common;
    ChildList children;
    LightList lights;
    bool global_lights;
} CsgDraft;

static bool on_csg_value(Reader *reader, const Argument *value, void *target) {
    CsgDraft *draft = target;
    const Object *child = object_from_value(reader->context, value);
    if (child)
        *list_push(reader->context->arena, &draft->children) = child;
    else if (value->value.kind == VALUE_LIGHT)
        *list_push(reader->context->arena, &draft->lights) = value->value.as.light;
    else
        return object_on_value(reader, value, &draft->common);
    return true;
}

static ObjectKind csg_kind(const char *word) {
    if (strcmp(word, "merge") == 0) return OBJECT_MERGE;
    if (strcmp(word, "intersection") == 0) return OBJECT_INTERSECTION;
    if (strcmp(word, "difference") == 0) return OBJECT_DIFFERENCE;
    return OBJECT_UNION;
}

static size_t objects_in(const EvalBlock *block) {
    size_t count = 0;
    for (size_t i = 0; i < block->count; i++)
        count += block->items[i].kind == ITEM_OBJECTS ? block->items[i].objects.count : block->items[i].kind == ITEM_VALUE;
    return count;
}

/* Behind the last object of the block, or its closing brace where it holds none. */
static Span after_objects(const Reader *reader) {
    const EvalBlock *block = reader->block;
    for (size_t i = block->count; i-- > 0;) {
        const BlockItem *item = &block->items[i];
        if (item->kind == ITEM_VALUE && (item->value.kind == VALUE_OBJECT || item->value.kind == VALUE_LIGHT))
            return reader_after(reader, item->span);
    }
    return reader_close(reader);
}

bool build_csg(BuildContext *context, const EvalBlock *block, Value *out) {
    CsgDraft draft = {.common = object_begin(block, csg_kind(block->word->text))};
    Reader reader = reader_begin(context, block);
    static const WordRule group_rules[] = {
        {"global_lights", WORD_FLAG, offsetof(CsgDraft, global_lights), NULL, false}};
    bool group = strcmp(block->word->text, "light_group") == 0;
    if (group) reader_add_table(&reader, group_rules, VTS_ARRAY_COUNT(group_rules), &draft);
    reader.on_value = on_csg_value;
    reader.value_target = &draft;
    draft.children.capacity = objects_in(block);
    draft.children.items = arena_new_array(context->arena, const Object *, draft.children.capacity);
    if (!object_read(&reader, &draft.common)) return false;
    if (draft.children.count + draft.lights.count < 2 && !group)
        diag_warning(context->diags, after_objects(&reader), "'%s' should hold at least 2 objects, found %zu",
                     block->word->text, draft.children.count + draft.lights.count);
    ObjectGroup *made = arena_new(context->arena, ObjectGroup);
    *made = (ObjectGroup){.items = draft.children.items,
                          .count = draft.children.count,
                          .lights = draft.lights.items,
                          .light_count = draft.lights.count,
                          .light_group = group,
                          .global_lights = draft.global_lights};
    object_group_settle(made);
    draft.common.object.as.group = made;
    return object_make(&reader, &draft.common, out);
}

bool build_unmodelled(BuildContext *context, const EvalBlock *block, Value *out) {
    ObjectDraft draft = object_begin(block, OBJECT_UNMODELLED);
    draft.object.as.word = draft.word;
    inert_add(context, &draft.rest.inert, draft.word, block->word_span);
    Reader reader = reader_begin(context, block);
    return object_make(&reader, &draft, out);
}
