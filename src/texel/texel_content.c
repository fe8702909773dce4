#include "texel/texel_content.h"

#include "grow/particles.h"
#include "texel/facet_normals.h"
#include "texel/texel_field.h"

/* Triangles that stand for a density where only triangles will do. */
enum { FIELD_FLAKES = 1500000 };

static double longest_side(Box3 bounds) {
    Vec3 size = vec3_sub(bounds.max, bounds.min);
    return fmax(size.x, fmax(size.y, size.z));
}

/* A side much shorter than the longest (a flat box) keeps a thickness, so that no division by zero follows. */
static const double THINNEST_SIDE = 1e-4;

Vec3f texel_extent_of(Box3 bounds) {
    Vec3 size = vec3_scale(vec3_sub(bounds.max, bounds.min), 1 / longest_side(bounds));
    return vec3f_from(vec3_max(size, vec3_splat(THINNEST_SIDE)));
}

Vec3f texel_extent(const TexelDef *def) { return texel_extent_of(def->bounds); }

Transform texel_space(const TexelDef *def) {
    Transform move = transform_translate(vec3_negate(def->bounds.min));
    Transform scale = transform_scale(vec3_splat(1 / longest_side(def->bounds)));
    return transform_then(&move, &scale);
}

/* NULL where no triangle is rounder than it looks. */
static const Vec3f *round_normals(const TriangleSoup *soup, const TexelMesh *mesh, Arena *arena) {
    ArenaMark mark = arena_mark(arena);
    Vec3f *normals = arena_new_array(arena, Vec3f, soup->vertices.count), at[3];
    for (size_t i = 0; i < soup->vertices.count; i++) normals[i] = vec3f_from(soup->vertices.items[i].normal);
    TexelMesh with = *mesh;
    with.normals = normals;
    for (size_t i = 0; i < mesh->triangle_count; i++)
        if (facet_normals_of(&with, i, at)) return normals;
    arena_reset_to(arena, mark);
    return NULL;
}

bool texel_layer_mesh(const TexelDef *def, const TexelLayer *layer, const TexelMeshOptions *how, Arena *arena, TexelMesh *out,
                      ShapeRefusal *refusal) {
    if (layer->density) {
        *refusal = (ShapeRefusal){0};
        texel_field_flakes(texel_field_make(def, layer, arena), texel_extent(def), how->flakes ? how->flakes : FIELD_FLAKES, arena, out);
        return true;
    }
    TriangleSoup soup = {0};
    Transform space = texel_space(def);
    ShapeRefusal doubt = {0};
    TessellateOptions options = {.tolerance = how->tolerance, .particles = particles_tessellate, .doubt = &doubt,
                                 .interrupted = how->interrupted, .progress = how->progress, .stage = def->name ? def->name : "texel"};
    for (size_t i = 0; i < layer->content_count; i++)
        if (!tessellate(layer->contents[i], &space, &options, arena, &soup, refusal)) return false;
    *refusal = doubt;
    Vec3f *vertices = arena_new_array(arena, Vec3f, soup.vertices.count);
    uint32_t(*triangles)[3] = arena_push_array_(arena, soup.triangles.count, sizeof *triangles);
    bool *solid = arena_new_array(arena, bool, soup.triangles.count);
    for (size_t i = 0; i < soup.vertices.count; i++) vertices[i] = vec3f_from(soup.vertices.items[i].position);
    for (size_t i = 0; i < soup.triangles.count; i++) {
        for (int k = 0; k < 3; k++) triangles[i][k] = soup.triangles.items[i].vertex[k];
        solid[i] = soup.triangles.items[i].solid;
    }
    *out = (TexelMesh){.vertices = vertices,
                       .triangles = (const uint32_t(*)[3])triangles,
                       .vertex_count = soup.vertices.count,
                       .triangle_count = soup.triangles.count,
                       .solid = solid};
    out->normals = round_normals(&soup, out, arena);
    soup_release(arena, &soup);
    return true;
}
