#include "render/skin_joint.h"

#include "texel/voxel_pairs.h"

/* What is not matter counts as ground up to this height, less and less up to twice as high. */
static const double GROUND_HEIGHT = 0.1;
/* Voxels of so many levels below the coarsest tell by themselves where light falls, at least: where they are about as small as triangles, of
 * which there are N in a tile, log4(N) levels down. */
static const float LEVELS_BLURRED = 3, MOST_LEVELS_BLURRED = 8, LEVELS_OF_TRIANGLES = 1.3f;

/* A direction of the scene at the march's place, in a copy of a texel. */
static Vec3f in_texel(const SkinMarch *march, const TexelCopy *copy, Vec3 d) {
    const TexturePlace *place = &march->span.place;
    return texel_copy_rate(copy, vec3(vec3_dot(place->grad_u, d), vec3_dot(place->grad_v, d), vec3_dot(place->grad_w, d)));
}

static bool knows(const SkinMarch *march) { return !march->sheets && march->settings->opacity == OPACITY_CORRELATED && march->skin->texel_count == 1; }

/* 1 where the coarsest voxel is used, 0 where they tell by themselves. */
static float blurred(const SkinMarch *march, const BuiltTexel *texel) {
    float structure = 0.5f * log2f((float)texel->triangles_known + 1) - LEVELS_OF_TRIANGLES;
    float levels = float_clamp(structure, LEVELS_BLURRED, MOST_LEVELS_BLURRED);
    return float_clamp(1 - ((float)(texel->levels - 1) - march->span.fits[0].lod) / levels, 0, 1);
}

/* Any copy will do: steep views of one that is turned, or of another of the family, are much the same. */
static bool any_copy(const SkinMarch *march, TexelCopy *copy) {
    const PlacedTexel *placed = march->skin->texels;
    for (int64_t i = 0; i < 4; i++)
        if (texel_copy_of(placed, i & 1, i >> 1, copy)) return copy->texel->matter_count > 0;
    return false;
}

/* The layer that most of it is in stands for all: of a wood its leaves. */
static const VoxelLayer *main_layer(const BuiltTexel *texel) {
    const VoxelLayer *most = texel->matter[0].voxels;
    for (size_t i = 1; i < texel->matter_count; i++)
        if (texel->matter[i].voxels->level[0].code_count > most->level[0].code_count) most = texel->matter[i].voxels;
    return most;
}

/* Every tile holds a whole period. */
static bool is_closed(const PlacedTexel *placed) { return placed->cyclic && placed->blanks == 0 && placed->density >= 1; }

float skin_joint_ground(const SkinMarch *march, Vec3 to_eye, float through) {
    double height = march->stretch.start.w / GROUND_HEIGHT - 1;
    TexelCopy copy;
    if (!knows(march) || march->entries != 1 || march->stretch.t0 > 1e-6 * (double)march->span.voxel_world || height >= 1 || !any_copy(march, &copy)) return through;
    float spot = voxel_layer_spot(main_layer(copy.texel), in_texel(march, &copy, to_eye), in_texel(march, &copy, march->cone->direction));
    return through + (1 - through) * spot * blurred(march, copy.texel) * (float)double_min(1, 1 - height);
}

float skin_joint_matter(const SkinMarch *march, Vec3 to_eye, float share) {
    TexelCopy copy;
    if (!knows(march) || !is_closed(march->skin->texels) || !any_copy(march, &copy)) return share;
    float lit = voxel_layer_lit_pair(main_layer(copy.texel), in_texel(march, &copy, to_eye), in_texel(march, &copy, march->cone->direction));
    return lit < 0 ? share : share + blurred(march, copy.texel) * (lit - share);
}
