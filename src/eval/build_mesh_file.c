/* mesh { "file.obj" … }: a mesh from a file. Parts that the file colours differently are objects of their own in a union, unless the
 * block has a texture for all. */
#include "eval/build_parts.h"

typedef struct FileDraft {
    ObjectDraft common;
    bool smooth;
    Vec3 inside_vector;
} FileDraft;

static const WordRule rules[] = {
    {"inside_vector", WORD_VECTOR, offsetof(FileDraft, inside_vector), NULL, false},
    {"smooth", WORD_MARK, offsetof(FileDraft, smooth), NULL, false},
};

static const Texture *texture_of_color(const BuildContext *context, Color color, Span span) {
    Texture *texture = arena_copy(context->arena, texture_default(context), sizeof *texture);
    Pigment *pigment = arena_new(context->arena, Pigment);
    *pigment = pigment_default();
    pigment->span = texture->span = span;
    pigment->color = color;
    pigment_measure(pigment);
    pigment_rehash(pigment);
    texture->pigment = pigment;
    texture_rehash(texture);
    return texture;
}

static const MeshData *with_inside(Arena *arena, const MeshData *mesh, Vec3 inside_vector) {
    if (vec3_length_squared(inside_vector) == 0) return mesh;
    MeshData *copy = arena_copy(arena, mesh, sizeof *mesh);
    copy->inside_vector = inside_vector;
    mesh_rehash(copy);
    return copy;
}

/* What is common to a mesh alone and to one of several. */
static void take_part(const BuildContext *context, const FileDraft *draft, const EvalMeshPart *part, Object *object) {
    object->kind = OBJECT_TRIANGLES;
    object->as.mesh = with_inside(context->arena, part->mesh, draft->inside_vector);
    if (!object->texture && part->colored) object->texture = texture_of_color(context, part->color, object->span);
}

static const ObjectGroup *group_of(const BuildContext *context, const FileDraft *draft, const EvalMeshFile *file) {
    ObjectGroup *group = arena_new(context->arena, ObjectGroup);
    const Object **items = arena_new_array(context->arena, const Object *, file->count);
    for (size_t i = 0; i < file->count; i++) {
        Object object = {.span = draft->common.object.span, .depth = 1};
        take_part(context, draft, &file->parts[i], &object);
        items[i] = object_keep(context->arena, &object, NULL);
    }
    *group = (ObjectGroup){.items = items, .count = file->count};
    object_group_settle(group);
    return group;
}

bool build_mesh_file(BuildContext *context, const EvalBlock *block, Value *out) {
    FileDraft draft = {.common = object_begin(block, OBJECT_TRIANGLES)};
    Reader reader = reader_begin(context, block);
    const BlockItem *name = reader_peek(&reader);
    const char *text = arena_printf(context->arena, "%.*s", (int)name->value.as.string.length, name->value.as.string.text);
    reader.next++;
    reader.on_value = object_on_value;
    reader.value_target = &draft.common;
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), &draft);
    if (!object_read(&reader, &draft.common)) return false;
    EvalMeshFile file;
    const EvalMeshRequest request = {context->most_vertices, !draft.common.object.texture, draft.smooth};
    if (!mesh_file_load(context, text, name->span, &request, &file)) return false;
    if (file.count == 1) {
        take_part(context, &draft, &file.parts[0], &draft.common.object);
    } else {
        draft.common.object.kind = OBJECT_UNION;
        draft.common.object.as.group = group_of(context, &draft, &file);
    }
    return object_make(&reader, &draft.common, out);
}
