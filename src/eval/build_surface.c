#include "eval/build_parts.h"

#include <string.h>

typedef struct SurfaceDraft {
    Surface surface;
    Argument function;     /* of patch_grid; kind VALUE_ERROR: none */
    Argument points;       /* an array; likewise */
    Argument height_array; /* likewise */
    const EvalBlock *height_list;
    Span grid_span, height_span, deform_span;
    bool has_grid, has_uv;
    Transform transform;
} SurfaceDraft;


/* ---- patch_grid NU, NV function(u, v) { … } ---- */

static bool grid_size(Reader *reader, const Word *word, size_t index, int *out) {
    if (!word_int(reader, word, index, out)) return false;
    if (*out >= 1) return true;
    reader_error(reader, word->arguments[index].span,
                 "'patch_grid' needs at least 1 patch along each side, found %d", *out);
    return false;
}

static void read_patch_grid(Reader *reader, const Word *word, void *target) {
    SurfaceDraft *draft = target;
    Surface *surface = &draft->surface;
    if (!word_arguments(reader, word, 2, 3) || !grid_size(reader, word, 0, &surface->nu) ||
        !grid_size(reader, word, 1, &surface->nv))
        return;
    if (!reader_mesh_fits(reader, word->whole, (surface->nu + 1.0) * (surface->nv + 1.0))) return;
    surface->kind = SURFACE_PATCHES;
    draft->has_grid = true;
    draft->grid_span = word->span;
    if (word->count == 3) draft->function = word->arguments[2];
}

static size_t vertex_count(const Surface *s) { return ((size_t)s->nu + 1) * ((size_t)s->nv + 1); }

static const Vec3 *points_of_function(Reader *reader, const SurfaceDraft *draft) {
    const Surface *s = &draft->surface;
    const Tape *tape;
    if (!argument_function(reader, &draft->function, "'patch_grid'", 2, 3, &tape)) return NULL;
    Vec3 *points = arena_new_array(reader->context->arena, Vec3, vertex_count(s)), *next = points;
    ArenaMark mark = arena_mark(reader->context->arena);
    double *scratch = arena_new_array(reader->context->arena, double, tape_scratch_size(tape));
    for (int i = 0; i <= s->nu; i++)
        for (int j = 0; j <= s->nv; j++, next++) {
            double uv[2] = {(double)i / s->nu, (double)j / s->nv}, p[3];
            tape_eval(tape, uv, p, scratch);
            *next = vec3(p[0], p[1], p[2]);
            if (!vec3_is_finite(*next)) {
                reader_error(reader, draft->function.span,
                             "the surface has no finite point at u = %g, v = %g", uv[0], uv[1]);
                return NULL;
            }
        }
    arena_reset_to(reader->context->arena, mark);
    return points;
}

/* An array [NU+1][NV+1] of vectors. */
static const Vec3 *points_of_array(Reader *reader, const Surface *s, const Argument *argument,
                                   const char *what) {
    if (argument->value.kind != VALUE_ARRAY) {
        reader_mismatch(reader, argument->span, arena_printf(reader->context->arena, "'%s'", what),
                        "an array", argument->value.kind);
        return NULL;
    }
    const Array *array = argument->value.as.array;
    size_t rows = array_extent(array, 0), columns = array_rank(array) > 1 ? array_extent(array, 1) : 0;
    if (array_rank(array) != 2 || rows != (size_t)s->nu + 1 || columns != (size_t)s->nv + 1) {
        reader_error(reader, argument->span, "'%s' needs an array [%d][%d] of vertices for %d x %d patches",
                     what, s->nu + 1, s->nv + 1, s->nu, s->nv);
        return NULL;
    }
    Vec3 *points = arena_new_array(reader->context->arena, Vec3, vertex_count(s));
    for (size_t i = 0; i < rows; i++)
        for (size_t j = 0; j < columns; j++) {
            const Value *element = array_element(array, (size_t[]){i, j}, 2);
            Argument vector = {element ? *element : (Value){.kind = VALUE_FLOAT}, argument->span};
            if (!element)
                reader_error(reader, argument->span, "element [%zu][%zu] of the array was never set", i, j);
            else if (!argument_vector(reader, &vector, arena_printf(reader->context->arena, "'%s'", what),
                                      &points[i * columns + j]))
                return NULL;
        }
    return points;
}

static bool finish_grid(Reader *reader, SurfaceDraft *draft) {
    Surface *s = &draft->surface;
    if (s->object || s->deform)
        reader_error(reader, draft->grid_span, "a surface is a 'patch_grid' or an object, not both");
    else if (draft->points.value.kind != VALUE_ERROR)
        s->points = points_of_array(reader, s, &draft->points, "points");
    else if (draft->function.value.kind != VALUE_ERROR)
        s->points = points_of_function(reader, draft);
    else
        reader_error(reader, draft->grid_span, "'patch_grid' needs a function(u, v) {<…>} or points");
    if (draft->height_list) {
        size_t count;
        s->height_vectors = vectors_read(reader, draft->height_list, "height vectors", &count);
        if (s->height_vectors && count != vertex_count(s))
            reader_error(reader, draft->height_span, "'height_vectors' has %zu vectors for %zu vertices",
                         count, vertex_count(s));
    } else if (draft->height_array.value.kind != VALUE_ERROR) {
        s->height_vectors = points_of_array(reader, s, &draft->height_array, "height_vectors");
    }
    return !reader->failed;
}

/* ---- surface { OBJECT … } ---- */

static void read_function_word(Reader *reader, const Word *word, void *target) {
    SurfaceDraft *draft = target;
    if (word_arguments(reader, word, 1, 1)) draft->function = word->arguments[0];
}

static void read_points(Reader *reader, const Word *word, void *target) {
    if (word_arguments(reader, word, 1, 1)) ((SurfaceDraft *)target)->points = word->arguments[0];
}

static void read_heights(Reader *reader, const Word *word, void *target) {
    SurfaceDraft *draft = target;
    draft->height_span = word->span;
    draft->height_list = word->body;
    if (!word->body && word_arguments(reader, word, 1, 1)) draft->height_array = word->arguments[0];
}

static void read_deform(Reader *reader, const Word *word, void *target) {
    SurfaceDraft *draft = target;
    Argument function;
    draft->deform_span = word->span;
    if (word->count == 0 && reader_take_value(reader, VALUE_FUNCTION, &function))
        argument_function(reader, &function, "'deform'", 3, 3, &draft->surface.deform);
    else if (word_arguments(reader, word, 1, 1))
        argument_function(reader, &word->arguments[0], "'deform'", 3, 3, &draft->surface.deform);
}

static void read_uv(Reader *reader, const Word *word, void *target) {
    static const struct {
        const char *word;
        SurfaceUv uv;
    } modes[] = {{"mesh", SURFACE_UV_MESH},
                 {"planar", SURFACE_UV_PLANAR},
                 {"cylindrical", SURFACE_UV_CYLINDRICAL},
                 {"spherical", SURFACE_UV_SPHERICAL}};
    SurfaceDraft *draft = target;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(modes); i++) {
        Word mode;
        if (word->count || !reader_take_word(reader, modes[i].word, &mode)) continue;
        draft->surface.uv = modes[i].uv;
        draft->has_uv = true;
        if (mode.count == 0 || !word_vector(reader, &mode, 0, &draft->surface.uv_axis)) return;
        if (vec3_length_squared(draft->surface.uv_axis) == 0)
            reader_error(reader, mode.arguments[0].span, "the axis of 'uv %s' has no length", mode.text);
        draft->surface.uv_axis = vec3_normalize(draft->surface.uv_axis);
        return;
    }
    reader_expect_word(reader, word, "mesh, planar AXIS, cylindrical or spherical");
}

static void read_subdivide(Reader *reader, const Word *word, void *target) {
    SurfaceDraft *draft = target;
    Word next;
    int count;
    if (word->count == 0 && reader_take_word(reader, "auto", &next)) {
        draft->surface.subdivide = 0;
        return;
    }
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, &count)) return;
    if (count >= 1 && count <= 4096)
        draft->surface.subdivide = count;
    else
        reader_error(reader, word->arguments[0].span, "'subdivide' must lie between 1 and 4096, found %d",
                     count);
}

static const WordRule rules[] = {
    {"patch_grid", WORD_CUSTOM, 0, read_patch_grid, true},
    {"function", WORD_CUSTOM, 0, read_function_word, true},
    {"points", WORD_CUSTOM, 0, read_points, true},
    {"height_vectors", WORD_CUSTOM, 0, read_heights, true},
    {"deform", WORD_CUSTOM, 0, read_deform, true},
    {"uv", WORD_CUSTOM, 0, read_uv, true},
    {"subdivide", WORD_CUSTOM, 0, read_subdivide, true},
};

/* Whether all of it is meshes that bring their own; no deeper than objects are nested. */
static bool has_mesh_uv(const Object *object) {
    if (object->kind == OBJECT_TRIANGLES) return object->as.mesh->uvs != NULL;
    if (object->kind != OBJECT_UNION || !object->as.group->count) return false;
    for (size_t i = 0; i < object->as.group->count; i++)
        if (!has_mesh_uv(object->as.group->items[i])) return false;
    return true;
}

/* What a surface is wrapped in by default: meshes by their own uvs, a ball by angles, a tube around its axis, others from above. */
static SurfaceUv natural_uv(const Object *object) {
    switch (object->kind) {
    case OBJECT_SPHERE: return SURFACE_UV_SPHERICAL;
    case OBJECT_CYLINDER:
    case OBJECT_CONE: return SURFACE_UV_CYLINDRICAL;
    default: return has_mesh_uv(object) ? SURFACE_UV_MESH : SURFACE_UV_PLANAR;
    }
}

/* object { SURFACE … } in a surface is that surface, placed and coloured. */
static bool take_placed_surface(Surface *s, const Object *object) {
    *s = *object->as.surface;
    Transform place = object_transform(object);
    s->transform = transform_then(&s->transform, &place);
    if (object->texture) s->texture = object->texture;
    return true;
}

static bool take_object(Reader *reader, SurfaceDraft *draft, const Argument *value) {
    Surface *s = &draft->surface;
    if (!s->object && !draft->has_grid && value->value.as.object->kind == OBJECT_SURFACE)
        return take_placed_surface(s, value->value.as.object);
    if (s->object) {
        Diagnostic *d = reader_error(reader, value->span, "a surface is made of one object");
        diag_hint(reader->context->diags, d, "write a surface and a skin for each, or one mesh");
        return true;
    }
    s->kind = SURFACE_OBJECT;
    s->object = value->value.as.object;
    if (!draft->has_uv) s->uv = natural_uv(s->object);
    if (s->object->kind == OBJECT_PLANE)
        reader_error(reader, value->span, "a plane has no end: a surface needs an object with bounds");
    return true;
}

static bool on_value(Reader *reader, const Argument *value, void *target) {
    SurfaceDraft *draft = target;
    switch (value->value.kind) {
    case VALUE_FUNCTION: draft->function = *value; return true;
    case VALUE_OBJECT: return take_object(reader, draft, value);
    case VALUE_SURFACE: draft->surface = *value->value.as.surface; return true;
    default:
        return take_looks(reader->context, value, &draft->surface.texture, &draft->surface.inert,
                          &draft->transform) ||
               take_transform(value, &draft->transform);
    }
}

static bool finish_object(Reader *reader, SurfaceDraft *draft) {
    Surface *s = &draft->surface;
    bool mesh = s->object->kind == OBJECT_TRIANGLES;
    if (!s->texture) s->texture = s->object->texture;
    if (!draft->height_list) return !reader->failed;
    size_t count, expected = mesh ? s->object->as.mesh->vertex_count : 0;
    s->object_height_vectors = vectors_read(reader, draft->height_list, "height vectors", &count);
    if (s->object_height_vectors && count != expected)
        reader_error(reader, draft->height_span, "'height_vectors' has %zu vectors, the object %zu vertices",
                     count, expected);
    return !reader->failed;
}

static bool finish_terrain(Reader *reader, const SurfaceDraft *draft) {
    if (draft->has_uv) reader_error(reader, reader->block->word_span, "'uv' has no meaning for a terrain: its u and v are metres to the east and north");
    if (draft->height_list) reader_error(reader, draft->height_span, "'height_vectors' have no meaning for a terrain");
    return !reader->failed;
}

static bool finish(Reader *reader, SurfaceDraft *draft) {
    Surface *s = &draft->surface;
    if (draft->has_grid) return finish_grid(reader, draft);
    if (draft->points.value.kind != VALUE_ERROR || draft->function.value.kind != VALUE_ERROR) {
        reader_error(reader, reader->block->word_span,
                     "points of a surface need 'patch_grid NU, NV' before them");
        return false;
    }
    if (s->kind == SURFACE_OBJECT && s->object) return finish_object(reader, draft);
    if (s->kind == SURFACE_TERRAIN) return finish_terrain(reader, draft);
    if (s->kind == SURFACE_PATCHES && s->points) return true; /* a copy of a declared one */
    reader_error(reader, reader->block->word_span,
                 "this surface has no shape: it needs an object or a 'patch_grid'");
    return false;
}

bool build_surface(BuildContext *context, const EvalBlock *block, Value *out) {
    SurfaceDraft draft = {
        .surface = {.kind = SURFACE_OBJECT, .uv_axis = {0, 1, 0}, .transform = transform_identity()},
        .transform = transform_identity()};
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), &draft);
    reader_add_table(&reader, transform_rules, transform_rule_count, &draft.transform);
    reader.on_value = on_value;
    reader.value_target = &draft;
    bool copy = block->count == 1 && block->items[0].kind == ITEM_VALUE &&
                block->items[0].value.kind == VALUE_SURFACE;
    if (copy) {
        *out = block->items[0].value;
        return true;
    }
    if (!reader_run(&reader)) return false;
    if (!finish(&reader, &draft)) return false;
    Surface *surface = arena_copy(context->arena, &draft.surface, sizeof draft.surface);
    surface->span = block->span;
    surface->transform = transform_then(&surface->transform, &draft.transform);
    surface_rehash(surface);
    *out = (Value){.kind = VALUE_SURFACE, .as.surface = surface};
    return true;
}
