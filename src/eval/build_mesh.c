#include "eval/build_parts.h"

#include <string.h>

/* ---- triangle, smooth_triangle: meshes of one triangle ---- */

typedef struct TriangleDraft {
    ObjectDraft common;
    Vec3 *uvs; /* 3; NULL: none */
    const Texture **textures; /* of the corners; or NULL */
} TriangleDraft;

static void read_uv_vectors(Reader *reader, const Word *word, void *target) {
    TriangleDraft *draft = target;
    Vec3 *uvs = arena_new_array(reader->context->arena, Vec3, 3);
    if (!word_arguments(reader, word, 3, 3)) return;
    for (size_t i = 0; i < 3; i++)
        if (!word_vector(reader, word, i, &uvs[i])) return;
    draft->uvs = uvs;
}

/* A texture for each corner. */
static void read_corner_textures(Reader *reader, const Word *word, void *target) {
    TriangleDraft *draft = target;
    size_t count = word->body ? word->body->count : 0;
    for (size_t i = 0; i < count; i++)
        if (word->body->items[i].kind != ITEM_VALUE || word->body->items[i].value.kind != VALUE_TEXTURE)
            count = 0;
    if (count != 3) {
        reader_error(reader, word->span, "'texture_list' of a triangle holds three textures");
        return;
    }
    draft->textures = arena_new_array(reader->context->arena, const Texture *, 3);
    for (size_t i = 0; i < 3; i++) draft->textures[i] = word->body->items[i].value.as.texture;
}

static bool is_degenerate(const Vec3 *v) {
    Vec3 area = vec3_cross(vec3_sub(v[1], v[0]), vec3_sub(v[2], v[0]));
    return vec3_length_squared(area) == 0;
}

static MeshData *one_triangle(Arena *arena, const Vec3 *vertices, const Vec3 *normals) {
    MeshData *mesh = arena_new(arena, MeshData);
    uint32_t(*triangles)[3] = arena_push(arena, sizeof *triangles);
    for (uint32_t i = 0; i < 3; i++) triangles[0][i] = i;
    *mesh = (MeshData){.single = true,
                       .vertices = vertices,
                       .vertex_count = 3,
                       .normals = normals,
                       .normal_count = normals ? 3 : 0,
                       .triangles = (const uint32_t(*)[3])triangles,
                       .triangle_count = 1};
    return mesh;
}

static void blend_corners(Arena *arena, MeshData *mesh, const Texture *const *textures) {
    uint32_t(*corners)[3] = arena_push(arena, sizeof *corners);
    for (uint32_t k = 0; k < 3; k++) corners[0][k] = k;
    mesh->textures = textures;
    mesh->texture_count = 3;
    mesh->triangle_textures = corners[0];
    mesh->corner_textures = (const uint32_t(*)[3])corners;
}

bool build_triangle(BuildContext *context, const EvalBlock *block, Value *out) {
    static const WordRule uv_rules[] = {{"uv_vectors", WORD_CUSTOM, 0, read_uv_vectors, false},
                                        {"texture_list", WORD_CUSTOM, 0, read_corner_textures, false}};
    if (object_is_copy(block)) return build_object(context, block, out);
    bool smooth = strcmp(block->word->text, "smooth_triangle") == 0;
    Reader reader = reader_begin(context, block);
    TriangleDraft draft = {.common = object_begin(block, OBJECT_TRIANGLES)};
    Vec3 *vertices = arena_new_array(context->arena, Vec3, 3),
         *normals = arena_new_array(context->arena, Vec3, 3);
    Span last;
    for (int i = 0; i < 3; i++)
        if (!reader_vector(&reader, "a corner", &vertices[i], &last) ||
            (smooth && !reader_vector(&reader, "a normal", &normals[i], &last)))
            return false;
    MeshData *mesh = one_triangle(context->arena, vertices, smooth ? normals : NULL);
    if (is_degenerate(vertices)) {
        diag_warning(context->diags, reader_after(&reader, last), "this triangle has no area: it is left out");
        mesh->triangle_count = 0;
    }
    draft.common.object.as.mesh = mesh;
    reader_add_table(&reader, uv_rules, VTS_ARRAY_COUNT(uv_rules), &draft);
    for (int i = 0; i < 3; i++) normals[i] = vec3_normalize(normals[i]);
    if (!object_read(&reader, &draft.common)) return false;
    mesh->uvs = draft.uvs;
    mesh->uv_count = draft.uvs ? 3 : 0;
    if (draft.textures) blend_corners(context->arena, mesh, draft.textures);
    mesh_rehash(mesh);
    return object_make(&reader, &draft.common, out);
}

/* ---- mesh: triangles one by one ---- */

typedef struct MeshDraft {
    ObjectDraft common;
    struct {
        const Object **items;
        size_t count, capacity;
    } parts;
    bool textured, blended, smooth, mapped;
    Vec3 inside_vector;
} MeshDraft;

static bool on_mesh_value(Reader *reader, const Argument *value, void *target) {
    MeshDraft *draft = target;
    if (value->value.kind == VALUE_INTERIOR || value->value.kind == VALUE_MATERIAL) take_interior(reader->context, value, &draft->common);
    if (value->value.kind != VALUE_OBJECT || value->value.as.object->kind != OBJECT_TRIANGLES)
        return take_looks(reader->context, value, &draft->common.object.texture, &draft->common.rest.inert,
                          &draft->common.transform) ||
               take_transform(value, &draft->common.transform);
    const Object *part = value->value.as.object;
    if (part->as.mesh->triangle_count == 0) return true;
    draft->textured |= part->texture || part->as.mesh->corner_textures;
    draft->blended |= part->as.mesh->corner_textures != NULL;
    draft->smooth |= part->as.mesh->normals != NULL;
    draft->mapped |= part->as.mesh->uvs != NULL;
    *list_push(reader->context->arena, &draft->parts) = part;
    return true;
}

static void fill_normals(const MeshData *part, Vec3 *normals) {
    Vec3 flat = vec3_normalize(vec3_cross(vec3_sub(part->vertices[1], part->vertices[0]),
                                          vec3_sub(part->vertices[2], part->vertices[0])));
    for (int k = 0; k < 3; k++) normals[k] = part->normals ? part->normals[k] : flat;
}

static const Texture **gather_textures(Arena *arena, const MeshDraft *draft, MeshData *mesh,
                                       uint32_t *indices, uint32_t (*corners)[3]) {
    const Texture **textures = arena_new_array(arena, const Texture *, (draft->blended ? 3 : 1) * draft->parts.count + 1);
    for (size_t i = 0; i < draft->parts.count; i++) {
        const MeshData *part = draft->parts.items[i]->as.mesh;
        if (part->corner_textures) {
            indices[i] = (uint32_t)mesh->texture_count;
            for (uint32_t k = 0; k < 3; k++) corners[i][k] = indices[i] + k;
            for (uint32_t k = 0; k < 3; k++) textures[mesh->texture_count++] = part->textures[k];
            continue;
        }
        const Texture *texture = draft->parts.items[i]->texture;
        if (!texture) texture = draft->common.object.texture;
        if (mesh->texture_count == 0 || textures[mesh->texture_count - 1] != texture)
            textures[mesh->texture_count++] = texture;
        indices[i] = (uint32_t)(mesh->texture_count - 1);
        for (uint32_t k = 0; corners && k < 3; k++) corners[i][k] = indices[i];
    }
    return textures;
}

/* Three vertices of its own for each triangle. */
static const MeshData *join_triangles(const BuildContext *context, const MeshDraft *draft) {
    size_t count = draft->parts.count;
    MeshData *mesh = arena_new(context->arena, MeshData);
    Vec3 *vertices = arena_new_array(context->arena, Vec3, 3 * count);
    Vec3 *normals = draft->smooth ? arena_new_array(context->arena, Vec3, 3 * count) : NULL;
    Vec3 *uvs = draft->mapped ? arena_new_array(context->arena, Vec3, 3 * count) : NULL;
    uint32_t(*triangles)[3] = arena_push_array_(context->arena, count, sizeof *triangles);
    for (size_t i = 0; i < count; i++) {
        const MeshData *part = draft->parts.items[i]->as.mesh;
        memcpy(&vertices[3 * i], part->vertices, 3 * sizeof *vertices);
        if (normals) fill_normals(part, &normals[3 * i]);
        if (uvs && part->uvs) memcpy(&uvs[3 * i], part->uvs, 3 * sizeof *uvs);
        for (uint32_t k = 0; k < 3; k++) triangles[i][k] = (uint32_t)(3 * i) + k;
    }
    *mesh = (MeshData){.vertices = vertices,
                       .vertex_count = 3 * count,
                       .normals = normals,
                       .uvs = uvs,
                       .normal_count = normals ? 3 * count : 0,
                       .uv_count = uvs ? 3 * count : 0,
                       .triangles = (const uint32_t(*)[3])triangles,
                       .triangle_count = count,
                       .inside_vector = draft->inside_vector};
    if (draft->textured) {
        uint32_t *indices = arena_new_array(context->arena, uint32_t, count);
        uint32_t(*corners)[3] = draft->blended ? arena_push_array_(context->arena, count, sizeof *corners) : NULL;
        mesh->textures = gather_textures(context->arena, draft, mesh, indices, corners);
        mesh->triangle_textures = indices;
        mesh->corner_textures = (const uint32_t(*)[3])corners;
    }
    mesh_rehash(mesh);
    return mesh;
}

static const WordRule mesh_rules[] = {
    {"inside_vector", WORD_VECTOR, offsetof(MeshDraft, inside_vector), NULL, false}};

bool build_mesh(BuildContext *context, const EvalBlock *block, Value *out) {
    if (block_begins_with_string(block)) return build_mesh_file(context, block, out);
    MeshDraft draft = {.common = object_begin(block, OBJECT_TRIANGLES)};
    Reader reader = reader_begin(context, block);
    if (block->count == 0) {
        reader_error(&reader, reader_close(&reader), "'mesh' without triangles");
        return false;
    }
    const BlockItem *first = reader_peek(&reader);
    bool copy = object_is_copy(block) && first->value.as.object->kind == OBJECT_TRIANGLES &&
                !first->value.as.object->as.mesh->single;
    if (copy) return build_object(context, block, out);
    reader_add_table(&reader, mesh_rules, VTS_ARRAY_COUNT(mesh_rules), &draft);
    reader.on_value = on_mesh_value;
    reader.value_target = &draft;
    if (!object_read(&reader, &draft.common)) return false;
    if (draft.parts.count == 0) {
        reader_error(&reader, reader_close(&reader), "'mesh' without triangles");
        return false;
    }
    if (!reader_mesh_fits(&reader, block->word_span, 3 * (double)draft.parts.count)) return false;
    draft.common.object.as.mesh = join_triangles(context, &draft);
    return object_make(&reader, &draft.common, out);
}
