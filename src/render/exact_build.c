/* A texel for the reference: triangles instead of voxels. */
#include "render/compile.h"

static void add_layer(BuiltTexel *texel, const TexelLayer *layer, const TexelMesh *mesh, Arena *arena, DiagList *diags) {
    size_t before = exact_texel_triangles(texel->exact);
    exact_texel_add_layer(texel->exact, mesh, arena);
    if (mesh->triangle_count && exact_texel_triangles(texel->exact) == before)
        diag_warning(diags, layer->span, "nothing of this layer of the texel '%s' lies within its bounds", texel->def->name);
}

bool exact_build_texel(BuiltTexel *texel, const ExactMaking *how, CompiledScene *compiled, DiagList *diags) {
    const TexelDef *def = texel->def;
    if (def->file) {
        diag_error(diags, def->span, "the texel file '%s' holds voxels alone: a reference is drawn from what they were built from", def->file);
        return false;
    }
    Arena *arena = how->arena ? how->arena : compiled->arena;
    size_t left = how->most ? how->most : SIZE_MAX;
    texel->exact = exact_texel_begin(texel->extent, def->cyclic, arena);
    for (size_t i = 0; i < def->layer_count; i++) {
        TexelMesh mesh;
        ArenaMark mark = arena_mark(&compiled->scratch);
        if (!texel_mesh_layer(texel, &def->layers[i], &(TexelFineness){how->tolerance, how->flakes}, compiled, diags, &mesh)) return false;
        if (mesh.triangle_count > left) return false;
        left -= mesh.triangle_count;
        add_layer(texel, &def->layers[i], &mesh, arena, diags);
        arena_reset_to(&compiled->scratch, mark);
    }
    exact_texel_commit(texel->exact, arena, &compiled->scratch);
    return true;
}
