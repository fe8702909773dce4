/* Which word makes what: all blocks of the language. */
#include "eval/build_parts.h"

#include <string.h>

static const struct BlockWord {
    const char *word;
    BlockBuilder *builder; /* NULL: stays a block, for the block around it or the scene */
} block_words[] = {
    /* solids */
    {"sphere", build_sphere},
    {"box", build_box},
    {"cylinder", build_cone},
    {"cone", build_cone},
    {"plane", build_plane},
    {"disc", build_disc},
    {"torus", build_torus},
    {"triangle", build_triangle},
    {"smooth_triangle", build_triangle},
    {"mesh", build_mesh},
    {"mesh2", build_mesh2},
    {"union", build_csg},
    {"merge", build_csg},
    {"intersection", build_csg},
    {"difference", build_csg},
    {"light_group", build_csg},
    {"object", build_object},
    {"particles", build_particles},
    /* objects of the language that are not drawn yet */
    {"bicubic_patch", build_patch},
    {"blob", build_blob},
    {"cubic", build_polynomial},
    {"height_field", build_height_field},
    {"isosurface", build_isosurface},
    {"julia_fractal", build_julia},
    {"lathe", build_lathe},
    {"lemon", build_unmodelled},
    {"ovus", build_ovus},
    {"parametric", build_parametric},
    {"poly", build_polynomial},
    {"polygon", build_polygon},
    {"polynomial", build_polynomial},
    {"prism", build_prism},
    {"quadric", build_quadric},
    {"quartic", build_polynomial},
    {"sor", build_sor},
    {"sphere_sweep", build_sweep},
    {"superellipsoid", build_superellipsoid},
    {"text", build_text},
    {"lsystem", build_lsystem},
    {"volume", build_volume},
    {"terrain", build_terrain},
    {"cloth", build_cloth},
    /* looks */
    {"texture", build_texture},
    {"pigment", build_pigment},
    {"pattern", build_pattern},
    {"finish", build_finish},
    {"normal", build_normal},
    {"interior", build_interior},
    {"material", build_material},
    {"color_map", build_color_map},
    {"colour_map", build_color_map},
    {"pigment_map", build_color_map},
    {"transform", build_transform},
    /* scene */
    {"camera", build_camera},
    {"light_source", build_light},
    {"sky_sphere", build_sky_sphere},
    {"fog", build_fog},
    {"background", NULL},
    {"global_settings", NULL},
    {"animation", NULL},
    {"rainbow", build_rainbow},
    {"radiosity", NULL},
    {"photons", NULL},
    {"subsurface", NULL},
    /* volumetric textures */
    {"texel", build_texel},
    {"surface", build_surface},
    {"skin", build_skin},
    {"wind_field", build_wind_field},
    {"layer", NULL},
    {"phases", NULL},
    {"count", NULL},
    {"mapping", NULL},
    {"jitter", NULL},
    {"instance", NULL},
    {"springs", NULL},
    {"gust", NULL},
    {"turbulence", NULL},
    {"density", build_checked},
    {"fractal", NULL},
    {"height_vectors", NULL},
    {"w_vectors", NULL},
    {"phase", NULL},
    {"georeference", NULL},
    {"symbol", NULL},
    {"sum", NULL},
    {"goniometric", NULL},
    /* parts of others */
    {"vertex_vectors", NULL},
    {"normal_vectors", NULL},
    {"uv_vectors", NULL},
    {"texture_list", NULL},
    {"face_indices", NULL},
    {"normal_indices", NULL},
    {"uv_indices", NULL},
    {"reflection", NULL},
    {"media", build_checked},
    {"bounded_by", NULL},
    {"clipped_by", NULL},
    {"contained_by", NULL},
    {"looks_like", NULL},
    {"projected_through", NULL},
    {"interior_texture", NULL},
    {"texture_map", build_checked},
    {"material_map", NULL},
    {"normal_map", build_checked},
    {"slope_map", build_checked},
    {"density_map", build_checked},
    {"bump_map", NULL},
    {"image_map", NULL},
    {"image_pattern", NULL},
    {"pigment_pattern", NULL},
    {"warp", NULL},
    {"slope", NULL},
    {"aoi", NULL},
    {"fade_color", NULL},
    {"bokeh", NULL},
    {"mesh_camera", NULL},
    {"user_defined", NULL},
    {"bounds", NULL},
    {"scattering", NULL},
    {"choose", NULL},
    {"potential", NULL},
    {"tiling", NULL},
    {"tiles", NULL},
    {"irid", NULL},
};

static const struct BlockWord *find(const char *word) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(block_words); i++)
        if (strcmp(block_words[i].word, word) == 0) return &block_words[i];
    return NULL;
}

BlockBuilder *block_builder_find(const BuildContext *context, Name word, bool *known) {
    (void)context;
    const struct BlockWord *found = find(word->text);
    *known = found != NULL;
    return found ? found->builder : NULL;
}

bool block_may_be_declared(Name word) {
    static const char *const words[] = {
        "radiosity",         "photons",         "background",
        "global_settings",   "bounded_by",      "clipped_by",
        "contained_by",      "looks_like",      "warp",
        "image_map",         "bump_map",        "image_pattern",
        "reflection",        "subsurface",      "irid",
        "projected_through", "pigment_pattern", "interior_texture",
        "material_map",      "tiles",
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(words); i++)
        if (strcmp(words[i], word->text) == 0) return false;
    return true;
}

const char *block_word_suggest(const char *word) {
    const char *words[VTS_ARRAY_COUNT(block_words)];
    for (size_t i = 0; i < VTS_ARRAY_COUNT(block_words); i++) words[i] = block_words[i].word;
    return closest_word(word, words, VTS_ARRAY_COUNT(words));
}
