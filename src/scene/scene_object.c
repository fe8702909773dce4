#include "scene/scene.h"

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
        [OBJECT_PARTICLES] = "particles", [OBJECT_SURFACE] = "surface",
        [OBJECT_TEXEL] = "texel",
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
    case OBJECT_TRIANGLES:
    case OBJECT_UNION:
    case OBJECT_INTERSECTION:
    case OBJECT_DIFFERENCE:
    case OBJECT_MERGE:
    case OBJECT_SURFACE:
    case OBJECT_TEXEL:
    case OBJECT_SOLID:
    case OBJECT_UNMODELLED: member = sizeof(void *); break;
    }
    return offsetof(Object, as) + member;
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
