/* A texel for the reference: triangles instead of voxels. */
#include "render/compile.h"

#include "base/stopwatch.h"

/* What is round is tessellated as the finest voxels would have it. */
static const double EXACT_TOLERANCE = 0.2 / TEXEL_LARGEST_RESOLUTION;

static void add_layer(BuiltTexel *texel, const TexelLayer *layer, const TexelMesh *mesh, CompiledScene *compiled, DiagList *diags) {
    size_t before = exact_texel_triangles(texel->exact);
    exact_texel_add_layer(texel->exact, mesh, compiled->arena);
    if (mesh->triangle_count && exact_texel_triangles(texel->exact) == before)
        diag_warning(diags, layer->span, "nothing of this layer of the texel '%s' lies within its bounds", texel->def->name);
}

bool exact_build_texel(BuiltTexel *texel, CompiledScene *compiled, DiagList *diags) {
    const TexelDef *def = texel->def;
    double start = stopwatch_wall();
    if (def->file) {
        diag_error(diags, def->span, "the texel file '%s' holds voxels alone: a reference is drawn from what they were built from", def->file);
        return false;
    }
    texel->exact = exact_texel_begin(texel->extent, def->cyclic, def->layer_count, compiled->arena);
    for (size_t i = 0; i < def->layer_count; i++) {
        TexelMesh mesh;
        ArenaMark mark = arena_mark(&compiled->scratch);
        if (!texel_mesh_layer(texel, &def->layers[i], EXACT_TOLERANCE, compiled, diags, &mesh)) return false;
        add_layer(texel, &def->layers[i], &mesh, compiled, diags);
        arena_reset_to(&compiled->scratch, mark);
    }
    exact_texel_commit(texel->exact, compiled->arena, &compiled->scratch);
    texel->build_seconds = stopwatch_wall() - start;
    return true;
}
