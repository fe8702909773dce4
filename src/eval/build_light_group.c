/* The lights in sets of objects, and what light_group { … } keeps apart: its objects get textures that know their group. */
#include "eval/build_parts.h"

/* What the walk knows of the sets around an object. */
typedef struct Around {
    Transform place;
    const LightGroup *group; /* the innermost, or NULL */
    const Texture *texture;  /* that an object without one has; NULL: the default */
} Around;

static const Texture *grouped_texture(const LightFinder *f, const Texture *texture, const LightGroup *group) {
    Texture *copy = arena_copy(f->context->arena, texture, sizeof *texture);
    copy->group = group;
    texture_rehash(copy);
    return copy;
}

static const MeshData *grouped_mesh(const LightFinder *f, const MeshData *mesh, const LightGroup *group) {
    if (!mesh->texture_count) return mesh;
    Arena *arena = f->context->arena;
    MeshData *copy = arena_copy(arena, mesh, sizeof *mesh);
    const Texture **textures = arena_new_array(arena, const Texture *, mesh->texture_count);
    for (size_t i = 0; i < mesh->texture_count; i++) textures[i] = grouped_texture(f, mesh->textures[i], group);
    copy->textures = textures;
    return copy;
}

static const Object *walk(LightFinder *f, const Object *object, const Around *around);

/* The children; NULL where none has changed. */
static const Object *const *walk_children(LightFinder *f, const ObjectGroup *set, const Around *within) {
    const Object **items = NULL;
    for (size_t i = 0; i < set->count; i++) {
        const Object *child = walk(f, set->items[i], within);
        if (child == set->items[i]) continue;
        if (!items) {
            items = arena_new_array(f->context->arena, const Object *, set->count);
            for (size_t k = 0; k < set->count; k++) items[k] = set->items[k];
        }
        items[i] = child;
    }
    return items;
}

static const LightGroup *open_group(LightFinder *f, const ObjectGroup *set, const LightGroup *outer) {
    if (!set->light_group) return outer;
    LightGroup *group = arena_new(f->context->arena, LightGroup);
    *group = (LightGroup){.outer = outer, .number = ++f->group_count, .global_lights = set->global_lights};
    return group;
}

static const Object *regrouped(LightFinder *f, const Object *object, const Around *within, const Object *const *items) {
    Object copy = object_copy(object);
    if (within->group && (object->texture || (object_has_group(object) && object->as.group->light_group)))
        copy.texture = grouped_texture(f, within->texture ? within->texture : texture_default(f->context), within->group);
    if (within->group && object->kind == OBJECT_TRIANGLES) copy.as.mesh = grouped_mesh(f, object->as.mesh, within->group);
    if (items) {
        ObjectGroup *set = arena_new(f->context->arena, ObjectGroup);
        *set = (ObjectGroup){.items = items, .count = object->as.group->count, .lights = object->as.group->lights,
                             .light_count = object->as.group->light_count};
        object_group_settle(set);
        copy.as.group = set;
    }
    return object_keep(f->context->arena, &copy, NULL);
}

static const Object *walk(LightFinder *f, const Object *object, const Around *around) {
    const Object *const *items = NULL;
    Around within = *around;
    if (object_has_group(object) && object->as.group->plain && !around->group) return object;
    if (object->texture) within.texture = object->texture;
    if (object_has_group(object)) {
        const ObjectGroup *set = object->as.group;
        Transform own = object_transform(object);
        within.place = transform_then(&own, &around->place);
        within.group = open_group(f, set, around->group);
        for (size_t i = 0; i < set->light_count; i++) {
            Light light = *light_placed(f->context, set->lights[i], &within.place);
            light.group = within.group;
            f->take(f->target, f->context, &light);
        }
        items = walk_children(f, set, &within);
    }
    return items || within.group ? regrouped(f, object, &within, items) : object;
}

const Object *lights_find(LightFinder *finder, const Object *object) {
    const Around nothing = {transform_identity(), NULL, NULL};
    return object_has_group(object) ? walk(finder, object, &nothing) : object;
}
