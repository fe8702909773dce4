#include "eval/build_parts.h"

#include <string.h>

static const Texture *make_default(const BuildContext *context) {
    Texture *texture = arena_new(context->arena, Texture);
    Pigment *pigment = arena_new(context->arena, Pigment);
    Finish *finish = arena_new(context->arena, Finish);
    *pigment = pigment_default();
    *finish = finish_default();
    *texture = (Texture){.pigment = pigment, .finish = finish, .transform = transform_identity()};
    texture_rehash(texture);
    return texture;
}

const Texture *texture_default(const BuildContext *context) {
    return context->default_texture ? context->default_texture : make_default(context);
}

static Texture *copy_texture(const BuildContext *context, const Texture *texture) {
    return arena_copy(context->arena, texture, sizeof *texture);
}

const Texture *texture_placed(const BuildContext *context, const Texture *texture, const Transform *t) {
    if (!texture || transform_is_identity(t)) return texture;
    Texture *copy = copy_texture(context, texture);
    copy->transform = transform_then(&texture->transform, t);
    copy->under = texture_placed(context, texture->under, t);
    texture_rehash(copy);
    return copy;
}

const Texture *texture_over(const BuildContext *context, const Texture *top, const Texture *bottom) {
    if (!bottom) return top;
    Texture *copy = copy_texture(context, top);
    copy->under = top->under ? texture_over(context, top->under, bottom) : bottom;
    texture_rehash(copy);
    return copy;
}

static size_t layer_count(const Texture *texture) {
    size_t count = 0;
    for (; texture; texture = texture->under) count++;
    return count;
}

static const Pigment *pigment_placed(const BuildContext *context, const Pigment *pigment,
                                     const Transform *t) {
    if (transform_is_identity(t)) return pigment;
    Pigment *placed = arena_copy(context->arena, pigment, sizeof *pigment);
    placed->transform = transform_then(&pigment->transform, t);
    pigment_rehash(placed);
    return placed;
}

/* A pigment given in the space in which the texture already has its transform: that is taken back last. */
static const Texture *with_pigment(BuildContext *context, const Texture *texture, const Pigment *pigment) {
    Texture *copy = copy_texture(context, texture);
    Transform back = transform_inverse(&texture->transform);
    const Pigment *base = pigment_placed(context, texture->pigment, &texture->transform);
    copy->pigment = pigment_placed(context, pigment_over(context, base, pigment), &back);
    texture_rehash(copy);
    return copy;
}

static const Texture *with_finish(const BuildContext *context, const Texture *texture, const Finish *finish) {
    Texture *copy = copy_texture(context, texture);
    copy->finish = finish_over(context, texture->finish, finish);
    texture_rehash(copy);
    return copy;
}

/* material { … }: a texture and what is not drawn. */
typedef struct Material {
    const Texture *texture; /* in the space before `transform`; NULL: none */
    const Interior *interior; /* or NULL */
    const InertNote *inert;
    Transform transform;
} Material;

const Interior *material_interior(const void *material) { return ((const Material *)material)->interior; }

/* Normals are no more than the name and place of what is not drawn. */
static void note_inert(const BuildContext *context, const InertNote *made, const InertNote **inert) {
    for (; made; made = made->next) inert_add(context, inert, made->word, made->span);
}

/* The texture in the parent's space as of now, so that a modifier given there can be put onto it. */
static const Texture *current(const BuildContext *context, const Texture *texture, const Transform *place) {
    return texture ? texture_placed(context, texture, place) : texture_default(context);
}

bool take_looks(BuildContext *context, const Argument *value, const Texture **texture,
                const InertNote **inert, const Transform *place) {
    const Texture *made = NULL;
    switch (value->value.kind) {
    case VALUE_TEXTURE:
        made = value->value.as.texture;
        if (layer_count(made) + layer_count(*texture) > TEXTURE_MOST_LAYERS)
            diag_error(context->diags, value->span, "a texture has at most %d layers", TEXTURE_MOST_LAYERS);
        else if (*texture)
            made = texture_over(context, made, texture_placed(context, *texture, place));
        break;
    case VALUE_PIGMENT:
        made = with_pigment(context, current(context, *texture, place), value->value.as.pigment);
        break;
    case VALUE_FINISH:
        made = with_finish(context, current(context, *texture, place), value->value.as.finish);
        break;
    case VALUE_NORMAL: note_inert(context, value->value.as.node, inert); return true;
    case VALUE_INTERIOR: return true; /* of what has no inside */
    case VALUE_MATERIAL: {
        const Material *material = value->value.as.node;
        note_inert(context, material->inert, inert);
        if (!material->texture) return true;
        made = texture_placed(context, material->texture, &material->transform);
        break;
    }
    default: return false;
    }
    Transform back = transform_inverse(place);
    *texture = transform_is_identity(place) ? made : texture_placed(context, made, &back);
    return true;
}

/* ---- texture { … } ---- */

typedef struct TextureDraft {
    const Texture *texture; /* in the space before `transform`; NULL: nothing said yet */
    const InertNote *inert;
    Transform transform;
    bool begun;  /* something was read */
    bool mapped; /* a texture_map was read */
    bool
        patterned; /* a pattern chooses among textures: which is not modelled, the first one is seen everywhere */
} TextureDraft;

static const Texture *texture_read(Reader *reader);

static bool on_value(Reader *reader, const Argument *value, void *target) {
    TextureDraft *draft = target;
    bool begun = draft->begun;
    draft->begun = true;
    switch (value->value.kind) {
    case VALUE_FUNCTION:
        if (draft->patterned) return false;
        draft->patterned = true;
        inert_add(reader->context, &draft->inert, "function", value->span);
        return true;
    case VALUE_TEXTURE: /* a declared one comes first, those of a pattern's list after it */
        if (draft->patterned && !draft->texture) draft->texture = value->value.as.texture;
        if (draft->patterned) return true;
        if (begun && !reader->block->declared_as) return false; /* #declare L = texture … texture … */
        break;
    case VALUE_PIGMENT:
    case VALUE_NORMAL:
    case VALUE_FINISH:
        if (draft->patterned) return false;
        break;
    case VALUE_TRANSFORM: break;
    default: return false;
    }
    return take_looks(reader->context, value, &draft->texture, &draft->inert, &draft->transform) ||
           take_transform(value, &draft->transform);
}

/* The texture of the first entry of texture_map { … }, or of the declared map that it holds. */
static const Texture *first_of_map(Reader *reader, const EvalBlock *map) {
    for (size_t i = 0; i < map->count; i++) {
        const BlockItem *item = &map->items[i];
        if (item->kind == ITEM_VALUE && item->value.kind == VALUE_BLOCK)
            return first_of_map(reader, item->value.as.block);
        if (item->kind != ITEM_ENTRY) continue;
        Reader entry = reader_nested(reader, item->entry);
        Argument position;
        reader_take_value(&entry, VALUE_FLOAT, &position);
        const Texture *texture = texture_read(&entry);
        reader_end_nested(reader, &entry);
        return texture;
    }
    return NULL;
}

/* tiles { texture … tile2 texture … }, object { O texture … }, material_map { … texture … } */
static const Texture *first_in(const EvalBlock *block) {
    for (size_t i = 0; i < block->count; i++)
        if (block->items[i].kind == ITEM_VALUE && block->items[i].value.kind == VALUE_TEXTURE)
            return block->items[i].value.as.texture;
    return NULL;
}

/* Patterns whose textures stand in a list, not in a map. */
static bool has_list(const char *pattern) {
    static const char *const words[] = {"checker", "brick",  "hexagon", "square",       "triangular",
                                        "cubic",   "object", "tiles",   "material_map", "texture_map"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(words); i++)
        if (strcmp(words[i], pattern) == 0) return true;
    return false;
}

static bool read_map(Reader *reader, const Word *word, TextureDraft *draft) {
    if (!draft->patterned) reader_error(reader, word->span, "'texture_map' needs a pattern before it");
    draft->mapped = true;
    if (word->body && !draft->texture && !reader->failed) draft->texture = first_of_map(reader, word->body);
    return true;
}

static bool on_word(Reader *reader, const Word *word, void *target) {
    TextureDraft *draft = target;
    if (!grammar_word(reader, word)) return false;
    if (strcmp(word->text, "texture_map") == 0) return read_map(reader, word, draft);
    bool own = strcmp(word->text, "tiles") == 0 || strcmp(word->text, "material_map") == 0;
    if (!own && !grammar_has("pattern_types", word->text)) return true;
    if (draft->patterned) reader_error(reader, word->span, "'%s' is a second pattern", word->text);
    inert_add(reader->context, &draft->inert, word->text, word->span);
    draft->patterned = true;
    draft->mapped = has_list(word->text);
    if (word->body && !draft->texture && !reader->failed) draft->texture = first_in(word->body);
    return true;
}

static const Texture *texture_read(Reader *reader) {
    TextureDraft draft = {.transform = transform_identity()};
    reader_add_table(reader, transform_rules, transform_rule_count, &draft.transform);
    reader->on_value = on_value;
    reader->on_word = on_word;
    reader->value_target = &draft;
    if (!reader_run(reader)) return NULL;
    if (draft.patterned && !draft.mapped) {
        reader_error(reader, draft.inert->span, "a pattern of textures needs a 'texture_map'");
        return NULL;
    }
    const Texture *base = draft.texture ? draft.texture : texture_default(reader->context);
    Texture *texture = copy_texture(reader->context, texture_placed(reader->context, base, &draft.transform));
    texture->span = reader->block->span;
    note_inert(reader->context, draft.inert, &texture->inert);
    return texture;
}

bool build_texture(BuildContext *context, const EvalBlock *block, Value *out) {
    Reader reader = reader_begin(context, block);
    const Texture *texture = texture_read(&reader);
    *out = (Value){.kind = VALUE_TEXTURE, .as.texture = texture};
    return texture != NULL;
}

/* ---- normal, wind_field: a note of what is not drawn ---- */

bool build_inert_value(BuildContext *context, const EvalBlock *block, Value *out) {
    static const struct {
        const char *word;
        ValueKind kind;
    } kinds[] = {{"normal", VALUE_NORMAL}, {"wind_field", VALUE_WIND_FIELD}};
    const InertNote *note = NULL;
    Reader reader = reader_begin(context, block);
    if (!grammar_read(&reader, block->word->text)) return false;
    if (block->count) inert_add(context, &note, block->word->text, block->word_span);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(kinds); i++)
        if (strcmp(kinds[i].word, block->word->text) == 0)
            *out = (Value){.kind = kinds[i].kind, .as.node = note};
    return true;
}

/* ---- material ---- */

static bool on_material_value(Reader *reader, const Argument *value, void *target) {
    Material *material = target;
    if (value->value.kind == VALUE_PIGMENT || value->value.kind == VALUE_NORMAL ||
        value->value.kind == VALUE_FINISH)
        return false;
    if (value->value.kind == VALUE_MATERIAL) {
        *material = *(const Material *)value->value.as.node;
        return true;
    }
    if (value->value.kind == VALUE_INTERIOR) {
        material->interior = value->value.as.interior;
        return true;
    }
    return take_looks(reader->context, value, &material->texture, &material->inert, &material->transform) ||
           take_transform(value, &material->transform);
}

bool build_material(BuildContext *context, const EvalBlock *block, Value *out) {
    static const WordRule material_rules[] = {
        {"interior_texture", WORD_INERT, offsetof(Material, inert), NULL, false},
        {"uv_mapping", WORD_INERT, offsetof(Material, inert), NULL, false}};
    Material *material = arena_new(context->arena, Material);
    material->transform = transform_identity();
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, material_rules, VTS_ARRAY_COUNT(material_rules), material);
    reader_add_table(&reader, transform_rules, transform_rule_count, &material->transform);
    reader.on_value = on_material_value;
    reader.value_target = material;
    if (!reader_run(&reader)) return false;
    *out = (Value){.kind = VALUE_MATERIAL, .as.node = material};
    return true;
}
