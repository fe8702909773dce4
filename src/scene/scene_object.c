#include "scene/volumes.h"

#include <stddef.h>
#include <string.h>

bool object_has_group(const Object *o) {
    return o->kind == OBJECT_UNION || o->kind == OBJECT_INTERSECTION || o->kind == OBJECT_DIFFERENCE || o->kind == OBJECT_MERGE;
}

Transform object_transform(const Object *o) { return o->place ? transform_of(o->place) : transform_identity(); }

const char *object_word(const Object *o) {
    static const char *const words[] = {
        [OBJECT_SPHERE] = "sphere",       [OBJECT_BOX] = "box",
        [OBJECT_CYLINDER] = "cylinder",   [OBJECT_CONE] = "cone",
        [OBJECT_PLANE] = "plane",         [OBJECT_DISC] = "disc",
        [OBJECT_TORUS] = "torus",         [OBJECT_TRIANGLES] = "mesh",
        [OBJECT_UNION] = "union",         [OBJECT_INTERSECTION] = "intersection",
        [OBJECT_DIFFERENCE] = "difference", [OBJECT_MERGE] = "merge",
        [OBJECT_PARTICLES] = "particles", [OBJECT_BRANCHES] = "lsystem", [OBJECT_SURFACE] = "surface",
        [OBJECT_TEXEL] = "texel", [OBJECT_VOLUME] = "volume",
    };
    if (o->kind == OBJECT_UNMODELLED) return o->as.word;
    if (o->kind == OBJECT_SOLID) return o->as.solid->word;
    return words[o->kind];
}

ObjectList object_clipped_by(const Object *o) { return o->rest ? o->rest->clipped_by : (ObjectList){0}; }
ObjectList object_bounded_by(const Object *o) { return o->rest ? o->rest->bounded_by : (ObjectList){0}; }
const InertNote *object_inert(const Object *o) { return o->rest ? o->rest->inert : NULL; }

/* Bytes of an object of this kind. */
static size_t object_size(ObjectKind kind) {
    static const Object *const o = NULL;
    size_t member = 0;
    switch (kind) {
    case OBJECT_SPHERE: member = sizeof o->as.sphere; break;
    case OBJECT_BOX: member = sizeof o->as.box; break;
    case OBJECT_CYLINDER:
    case OBJECT_CONE: member = sizeof o->as.cone; break;
    case OBJECT_PLANE: member = sizeof o->as.plane; break;
    case OBJECT_DISC: member = sizeof o->as.disc; break;
    case OBJECT_TORUS: member = sizeof o->as.torus; break;
    case OBJECT_PARTICLES: member = sizeof o->as.particles; break;
    case OBJECT_BRANCHES: member = sizeof o->as.branches; break;
    case OBJECT_TRIANGLES:
    case OBJECT_UNION:
    case OBJECT_INTERSECTION:
    case OBJECT_DIFFERENCE:
    case OBJECT_MERGE:
    case OBJECT_SURFACE:
    case OBJECT_TEXEL:
    case OBJECT_VOLUME:
    case OBJECT_SOLID:
    case OBJECT_UNMODELLED: member = sizeof(void *); break;
    }
    return offsetof(Object, as) + member;
}

static int deepest(const Object *const *items, size_t count) {
    int depth = 0;
    for (size_t i = 0; i < count; i++) depth = int_max(depth, items[i]->depth);
    return depth;
}

static int depth_of_texel(const TexelDef *texel) {
    int depth = 0;
    for (size_t i = 0; i < texel->layer_count; i++)
        depth = int_max(depth, deepest(texel->layers[i].contents, texel->layers[i].content_count));
    for (size_t i = 0; i < texel->choice_count; i++) depth = int_max(depth, depth_of_texel(texel->choices[i]));
    return depth;
}

static int depth_of_solid(const Solid *solid) {
    return solid->kind == SOLID_ISOSURFACE && solid->as.isosurface.container ? solid->as.isosurface.container->depth : 0;
}

int object_depth_by_parts(const Object *o) {
    ObjectList clips = object_clipped_by(o), guards = object_bounded_by(o);
    int depth = int_max(deepest(clips.items, clips.count), deepest(guards.items, guards.count));
    if (object_has_group(o) && o->as.group) depth = int_max(depth, deepest(o->as.group->items, o->as.group->count));
    if (o->kind == OBJECT_SURFACE && o->as.surface->object) depth = int_max(depth, o->as.surface->object->depth);
    if (o->kind == OBJECT_TEXEL) depth = int_max(depth, depth_of_texel(o->as.texel));
    if (o->kind == OBJECT_VOLUME && o->as.volume->container) depth = int_max(depth, o->as.volume->container->depth);
    if (o->kind == OBJECT_SOLID) depth = int_max(depth, depth_of_solid(o->as.solid));
    return depth + 1;
}

Object object_copy(const Object *object) {
    Object copy;
    memset(&copy, 0, sizeof copy);
    memcpy(&copy, object, object_size((ObjectKind)object->kind));
    return copy;
}

const Object *object_keep(Arena *arena, const Object *object, const Transform *transform) {
    Object *kept = arena_copy(arena, object, object_size((ObjectKind)object->kind));
    if (!transform) return kept;
    if (transform_is_identity(transform)) {
        kept->place = NULL;
    } else {
        Affine *place = arena_new(arena, Affine);
        *place = (Affine){transform->linear, transform->offset};
        kept->place = place;
    }
    return kept;
}

const BlobPart *object_textured_parts(const Object *object, size_t *count) {
    *count = 0;
    if (object->kind != OBJECT_SOLID || object->as.solid->kind != SOLID_BLOB || !object->as.solid->as.blob.textured) return NULL;
    *count = object->as.solid->as.blob.count;
    return object->as.solid->as.blob.parts;
}
