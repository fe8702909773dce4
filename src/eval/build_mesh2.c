#include "eval/build_parts.h"

typedef uint32_t Triangle[3];

typedef struct Mesh2Draft {
    MeshData mesh;
    const EvalBlock *faces, *normal_faces, *uv_faces; /* read when all vertices are known */
    size_t height_count, w_count;
    Span heights, ws;
} Mesh2Draft;

static bool stated_count(Reader *reader, const char *what, size_t *count) {
    double stated;
    Span span;
    if (!reader_float(reader, arena_printf(reader->context->arena, "the number of %s", what), &stated, &span))
        return false;
    if (stated < 0 || stated != floor(stated) || stated > 1e9) {
        reader_error(reader, span, "%g cannot be a number of %s", stated, what);
        return false;
    }
    *count = (size_t)stated;
    return true;
}

/* Reads n, <…>, <…>, …; stops at the first one that is wrong. */
static const Vec3 *read_vectors(Reader *reader, const char *what, size_t *count) {
    if (!stated_count(reader, what, count)) return NULL;
    size_t found = reader->block->count - reader->next;
    if (found != *count) {
        reader_error(reader, reader->block->word_span, "'%s' announces %zu %s, but %zu follow",
                     reader->block->word->text, *count, what, found);
        return NULL;
    }
    Vec3 *vectors = arena_new_array(reader->context->arena, Vec3, *count);
    for (size_t i = 0; i < *count; i++) {
        if (reader_vector(reader, "a vector", &vectors[i], NULL)) continue;
        return NULL;
    }
    return vectors;
}

/* Likewise, of a list in which nothing is wrong; NULL where something is, which the slower way tells. */
static const Vec3 *listed_vectors(Reader *reader, const EvalBlock *body, size_t *count) {
    const ListedNumber *n = body->numbers;
    if (!n || n->size != 1 || n->components[0] != (double)(body->number_count - 1)) return NULL;
    ArenaMark mark = arena_mark(reader->context->arena);
    *count = body->number_count - 1;
    Vec3 *vectors = arena_new_array(reader->context->arena, Vec3, *count);
    for (size_t i = 0; i < *count; i++) {
        const double *c = (++n)->components;
        vectors[i] = vec3(c[0], c[1], c[2]);
        if (vec3_is_finite(vectors[i])) continue;
        arena_reset_to(reader->context->arena, mark);
        return NULL;
    }
    return vectors;
}

const Vec3 *vectors_read(Reader *reader, const EvalBlock *body, const char *what, size_t *count) {
    const Vec3 *listed = listed_vectors(reader, body, count);
    if (listed) return listed;
    Reader inner = reader_nested(reader, body);
    const Vec3 *vectors = read_vectors(&inner, what, count);
    reader_end_nested(reader, &inner);
    return vectors;
}

static bool need_body(Reader *reader, const Word *word) {
    if (!word->body) reader_error(reader, word->span, "'%s' needs a list { count, … }", word->text);
    return word->body != NULL;
}

static void read_vertices(Reader *reader, const Word *word, void *target) {
    MeshData *mesh = &((Mesh2Draft *)target)->mesh;
    if (need_body(reader, word))
        mesh->vertices = vectors_read(reader, word->body, "vertices", &mesh->vertex_count);
}

static void read_normals(Reader *reader, const Word *word, void *target) {
    MeshData *mesh = &((Mesh2Draft *)target)->mesh;
    if (need_body(reader, word))
        mesh->normals = vectors_read(reader, word->body, "normals", &mesh->normal_count);
}

static void read_uvs(Reader *reader, const Word *word, void *target) {
    MeshData *mesh = &((Mesh2Draft *)target)->mesh;
    if (need_body(reader, word)) mesh->uvs = vectors_read(reader, word->body, "uv vectors", &mesh->uv_count);
}

static void read_heights(Reader *reader, const Word *word, void *target) {
    Mesh2Draft *draft = target;
    draft->heights = word->span;
    if (need_body(reader, word))
        draft->mesh.height_vectors = vectors_read(reader, word->body, "height vectors", &draft->height_count);
}

static void read_ws(Reader *reader, const Word *word, void *target) {
    Mesh2Draft *draft = target;
    draft->ws = word->span;
    if (need_body(reader, word))
        draft->mesh.w_vectors = vectors_read(reader, word->body, "w vectors", &draft->w_count);
}

static void read_textures(Reader *reader, const Word *word, void *target) {
    MeshData *mesh = &((Mesh2Draft *)target)->mesh;
    if (!need_body(reader, word)) return;
    Reader body = reader_nested(reader, word->body);
    size_t count;
    if (stated_count(&body, "textures", &count)) {
        const Texture **textures =
            arena_new_array(reader->context->arena, const Texture *, body.block->count);
        Argument texture;
        while (reader_take_value(&body, VALUE_TEXTURE, &texture))
            textures[mesh->texture_count++] = texture.value.as.texture;
        if (reader_peek(&body))
            reader_error(&body, reader_peek(&body)->span, "'texture_list' holds textures only");
        mesh->textures = textures;
    }
    reader_end_nested(reader, &body);
}

static void keep_faces(Reader *reader, const Word *word, void *target) {
    if (need_body(reader, word)) ((Mesh2Draft *)target)->faces = word->body;
}
static void keep_normal_faces(Reader *reader, const Word *word, void *target) {
    if (need_body(reader, word)) ((Mesh2Draft *)target)->normal_faces = word->body;
}
static void keep_uv_faces(Reader *reader, const Word *word, void *target) {
    if (need_body(reader, word)) ((Mesh2Draft *)target)->uv_faces = word->body;
}

static const WordRule rules[] = {
    {"vertex_vectors", WORD_CUSTOM, 0, read_vertices, true},
    {"normal_vectors", WORD_CUSTOM, 0, read_normals, true},
    {"uv_vectors", WORD_CUSTOM, 0, read_uvs, true},
    {"texture_list", WORD_CUSTOM, 0, read_textures, true},
    {"face_indices", WORD_CUSTOM, 0, keep_faces, true},
    {"normal_indices", WORD_CUSTOM, 0, keep_normal_faces, true},
    {"uv_indices", WORD_CUSTOM, 0, keep_uv_faces, true},
    {"height_vectors", WORD_CUSTOM, 0, read_heights, true},
    {"w_vectors", WORD_CUSTOM, 0, read_ws, true},
    {"inside_vector", WORD_VECTOR, offsetof(Mesh2Draft, mesh.inside_vector), NULL, false},
};

/* ---- indices ---- */

static bool read_triangle(Reader *reader, size_t number, const char *what, size_t limit, Triangle out) {
    Vec3 v;
    Span span;
    if (!reader_vector(reader, "a triangle <i, j, k>", &v, &span)) return false;
    for (int i = 0; i < 3; i++) {
        double index = vec3_get(v, i);
        if (index < 0 || index >= (double)limit || index != floor(index)) {
            reader_error(reader, span, "triangle %zu: there is no %s %g; they count from 0 to %zu", number,
                         what, index, limit ? limit - 1 : 0);
            return false;
        }
        out[i] = (uint32_t)index;
    }
    return true;
}

typedef struct FaceList {
    Triangle *triangles, *corner_textures; /* NULL: all corners of each triangle have the same */
    uint32_t *textures;                    /* NULL: none are named */
    size_t count;
} FaceList;

/* The texture of a triangle, and from the second corner on of this corner. */
static void put_texture(Arena *arena, FaceList *list, size_t triangle, int corner, uint32_t texture) {
    if (!list->textures) list->textures = arena_new_array(arena, uint32_t, list->count);
    if (corner == 0) list->textures[triangle] = texture;
    if (corner > 0 && corner < 3 && !list->corner_textures) {
        list->corner_textures = arena_push_array_(arena, list->count, sizeof(Triangle));
        for (size_t i = 0; i < list->count; i++)
            for (int k = 0; k < 3; k++) list->corner_textures[i][k] = list->textures[i];
    }
    if (list->corner_textures)
        for (int k = corner; k < 3; k++) list->corner_textures[triangle][k] = texture;
}

/* `, t` or `, t0, t1, t2` behind a triangle. */
static bool read_texture_index(Reader *reader, size_t number, size_t limit, FaceList *list) {
    Argument argument;
    for (int i = 0; reader_take_value(reader, VALUE_FLOAT, &argument); i++) {
        double index = argument.value.as.number;
        if (!(index >= 0 && index < (double)limit)) {
            reader_error(reader, argument.span,
                         "triangle %zu: there is no texture %g; they count from 0 to %zu", number, index,
                         limit ? limit - 1 : 0);
            return false;
        }
        put_texture(reader->context->arena, list, number, i, (uint32_t)index);
    }
    return true;
}

/* A vector of indices, or false. */
static bool listed_triangle(const ListedNumber *n, double limit, Triangle out) {
    for (int i = 0; i < 3; i++) {
        double index = n->components[i];
        if (!(index >= 0 && index < limit && index == floor(index))) return false;
        out[i] = (uint32_t)index;
    }
    return n->size > 1;
}

/* read_faces() of a list in which nothing is wrong; false where something is, which the slower way tells. */
static bool listed_faces(Reader *reader, const EvalBlock *body, size_t limit, size_t texture_limit, FaceList *out) {
    const ListedNumber *n = body->numbers, *end = n + body->number_count;
    if (!n || n->size != 1 || !(n->components[0] >= 0 && n->components[0] < (double)body->number_count)) return false;
    size_t count = (size_t)n->components[0], found = 0;
    if ((double)count != n->components[0]) return false;
    Triangle *triangles = arena_push_array_(reader->context->arena, count, sizeof(Triangle));
    FaceList list = {.triangles = triangles, .count = count};
    for (n++; n < end && found < count; found++) {
        if (!listed_triangle(n++, (double)limit, triangles[found])) return false;
        for (int i = 0; n < end && n->size == 1; i++, n++) {
            double index = n->components[0];
            if (!(index >= 0 && index < (double)texture_limit)) return false;
            put_texture(reader->context->arena, &list, found, i, (uint32_t)index);
        }
    }
    if (n < end || found < count) return false;
    *out = list;
    return true;
}

static bool read_faces(Reader *parent, const EvalBlock *body, const char *what, size_t limit,
                       size_t texture_limit, FaceList *out) {
    if (listed_faces(parent, body, limit, texture_limit, out)) return true;
    Reader reader = reader_nested(parent, body);
    if (stated_count(&reader, "triangles", &out->count)) {
        if (out->count > reader.block->count) /* before memory is taken for a slip of the keyboard */
            reader_error(&reader, body->word_span, "'%s' announces %zu triangles, but at most %zu follow",
                         body->word->text, out->count, reader.block->count - 1);
        out->triangles =
            arena_push_array_(parent->context->arena, reader.failed ? 0 : out->count, sizeof(Triangle));
        for (size_t i = 0; i < out->count && !reader.failed; i++)
            if (read_triangle(&reader, i, what, limit, out->triangles[i]))
                read_texture_index(&reader, i, texture_limit, out);
        if (!reader.failed && reader_peek(&reader))
            reader_error(&reader, reader_peek(&reader)->span, "'%s' announces %zu triangles, but more follow",
                         body->word->text, out->count);
    }
    return reader_end_nested(parent, &reader);
}

static bool read_other_faces(Reader *reader, const EvalBlock *body, const char *what, size_t limit,
                             size_t expected, const Triangle **out) {
    FaceList list = {0};
    if (!body) return true;
    if (!read_faces(reader, body, what, limit, 0, &list)) return false;
    if (list.count != expected) {
        reader_error(reader, body->word_span, "'%s' has %zu triangles, 'face_indices' %zu", body->word->text,
                     list.count, expected);
        return false;
    }
    *out = (const Triangle *)list.triangles;
    return true;
}

static void warn_flat(MeshData *mesh, Span span, DiagList *diags) {
    size_t flat = 0;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangles[i];
        flat += t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    }
    if (flat && flat == mesh->triangle_count)
        diag_warning(diags, span, "no triangle of this mesh has an area");
}

static void check_per_vertex(Reader *reader, const void *list, const char *word, Span span, size_t count,
                             size_t vertices) {
    if (list && count != vertices)
        reader_error(reader, span, "'%s' has %zu vectors for %zu vertices", word, count, vertices);
}

/* Normals and uvs without indices of their own go with the vertices. */
static void check_shared(Reader *reader, const void *list, const void *indices, const char *word,
                         size_t count, size_t vertices) {
    if (list && !indices && count < vertices)
        reader_error(reader, reader->block->word_span,
                     "'%s' has %zu vectors for %zu vertices and no indices of its own", word, count,
                     vertices);
}

static bool assemble(Reader *reader, Mesh2Draft *draft) {
    MeshData *mesh = &draft->mesh;
    FaceList faces = {0};
    if (!mesh->vertices || !draft->faces) {
        reader_error(reader, reader->block->word_span, "'mesh2' needs 'vertex_vectors' and 'face_indices'");
        return false;
    }
    if (!read_faces(reader, draft->faces, "vertex", mesh->vertex_count, mesh->texture_count, &faces))
        return false;
    mesh->triangles = (const Triangle *)faces.triangles;
    mesh->triangle_count = faces.count;
    mesh->triangle_textures = faces.textures;
    mesh->corner_textures = (const Triangle *)faces.corner_textures;
    if (mesh->triangle_count == 0) reader_error(reader, draft->faces->word_span, "'mesh2' without triangles");
    read_other_faces(reader, draft->normal_faces, "normal", mesh->normal_count, faces.count,
                     &mesh->normal_triangles);
    read_other_faces(reader, draft->uv_faces, "uv vector", mesh->uv_count, faces.count, &mesh->uv_triangles);
    check_shared(reader, mesh->normals, draft->normal_faces, "normal_vectors", mesh->normal_count,
                 mesh->vertex_count);
    check_shared(reader, mesh->uvs, draft->uv_faces, "uv_vectors", mesh->uv_count, mesh->vertex_count);
    check_per_vertex(reader, mesh->height_vectors, "height_vectors", draft->heights, draft->height_count,
                     mesh->vertex_count);
    check_per_vertex(reader, mesh->w_vectors, "w_vectors", draft->ws, draft->w_count, mesh->vertex_count);
    warn_flat(mesh, reader->block->word_span, reader->context->diags);
    return !reader->failed;
}

bool build_mesh2(BuildContext *context, const EvalBlock *block, Value *out) {
    if (object_is_copy(block)) return build_object(context, block, out);
    if (block_begins_with_string(block)) return build_mesh_file(context, block, out);
    Mesh2Draft *draft = arena_new(context->arena, Mesh2Draft);
    ObjectDraft common = object_begin(block, OBJECT_TRIANGLES);
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), draft);
    if (!object_read(&reader, &common) || !assemble(&reader, draft)) return false;
    mesh_rehash(&draft->mesh);
    common.object.as.mesh = &draft->mesh;
    return object_make(&reader, &common, out);
}
