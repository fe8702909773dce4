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

const Texture *texture_layered(const BuildContext *context, const Texture *top, const Texture *bottom, Span span) {
    if (layer_count(top) + layer_count(bottom) <= TEXTURE_MOST_LAYERS) return texture_over(context, top, bottom);
    diag_error(context->diags, span, "a texture has at most %d layers", TEXTURE_MOST_LAYERS);
    return top;
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
    copy->map = NULL;
    texture_rehash(copy);
    return copy;
}

static const Texture *with_finish(const BuildContext *context, const Texture *texture, const Finish *finish) {
    Texture *copy = copy_texture(context, texture);
    copy->finish = finish_over(context, texture->finish, finish);
    texture_rehash(copy);
    return copy;
}

static const Texture *with_normal(const BuildContext *context, const Texture *texture, const Normal *normal) {
    Texture *copy = copy_texture(context, texture);
    Transform back = transform_inverse(&texture->transform);
    copy->normal = normal_placed(context, normal, &back);
    texture_rehash(copy);
    return copy;
}

/* material { … }: a texture and what is not drawn. */
typedef struct Material {
    const Texture *texture; /* in the space before `transform`; NULL: none */
    const Interior *interior; /* in the space before `transform`; or NULL */
    const Texture *inside;    /* interior_texture, in the space before `transform`; or NULL */
    const InertNote *inert;
    Transform transform;
} Material;

const Interior *material_interior(const BuildContext *context, const void *node) {
    const Material *material = node;
    return interior_placed(context, material->interior, &material->transform);
}

const Texture *material_inside(const BuildContext *context, const void *node) {
    const Material *material = node;
    return texture_placed(context, material->inside, &material->transform);
}

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
        made = texture_layered(context, value->value.as.texture, texture_placed(context, *texture, place), value->span);
        break;
    case VALUE_PIGMENT:
        made = with_pigment(context, current(context, *texture, place), value->value.as.pigment);
        break;
    case VALUE_FINISH:
        made = with_finish(context, current(context, *texture, place), value->value.as.finish);
        break;
    case VALUE_NORMAL:
        made = with_normal(context, current(context, *texture, place), value->value.as.normal);
        break;
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

void read_interior_texture(Reader *reader, const Word *word, const Texture **texture, const Transform *place) {
    if (!word->body) {
        reader_error(reader, word->span, "'%s' needs its block { … }", word->text);
        return;
    }
    Reader body = reader_nested(reader, word->body);
    const Texture *made = texture_read(&body);
    if (!reader_end_nested(reader, &body) || !made) return;
    Transform back = transform_inverse(place);
    *texture = texture_layered(reader->context, texture_placed(reader->context, made, &back), *texture, word->span);
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
        const Transform back = transform_inverse(&material->transform);
        material->interior = interior_placed(reader->context, value->value.as.interior, &back);
        return true;
    }
    return take_looks(reader->context, value, &material->texture, &material->inert, &material->transform) ||
           take_transform(value, &material->transform);
}

static void read_inside(Reader *reader, const Word *word, void *target) {
    Material *material = target;
    read_interior_texture(reader, word, &material->inside, &material->transform);
}

bool build_material(BuildContext *context, const EvalBlock *block, Value *out) {
    static const WordRule material_rules[] = {
        {"interior_texture", WORD_CUSTOM, 0, read_inside, false},
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
