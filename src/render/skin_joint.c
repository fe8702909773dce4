#include "render/skin_joint.h"

#include "texel/voxel_pairs.h"

/* What is not matter counts as ground up to this height, less and less up to twice as high. */
static const double GROUND_HEIGHT = 0.1;
/* Voxels of so many levels above the coarsest tell by themselves where light falls. */
static const float LEVELS_BLURRED = 3;

/* A direction of the scene at the march's place, in a copy of a texel. */
static Vec3f in_texel(const SkinMarch *march, const TexelCopy *copy, Vec3 d) {
    const TexturePlace *place = &march->span.place;
    return texel_copy_rate(copy, vec3(vec3_dot(place->grad_u, d), vec3_dot(place->grad_v, d), vec3_dot(place->grad_w, d)));
}

static bool knows(const SkinMarch *march) { return !march->sheets && march->settings->opacity == OPACITY_CORRELATED && march->skin->texel_count == 1; }

/* 1 where the coarsest voxel is used, 0 from LEVELS_BLURRED below it on. */
static float blurred(const SkinMarch *march, const BuiltTexel *texel) {
    return float_clamp(1 - ((float)(texel->levels - 1) - march->span.fits[0].lod) / LEVELS_BLURRED, 0, 1);
}

/* Any copy will do: steep views of one that is turned are much the same. */
static bool any_copy(const SkinMarch *march, TexelCopy *copy) {
    const PlacedTexel *placed = march->skin->texels;
    for (int64_t i = 0; i < 4; i++)
        if (texel_copy_of(placed, i & 1, i >> 1, copy)) return copy->texel->matter_count == 1;
    return false;
}

float skin_joint_ground(const SkinMarch *march, Vec3 to_eye, float through) {
    double height = march->stretch.start.w / GROUND_HEIGHT - 1;
    TexelCopy copy;
    if (!knows(march) || march->entries != 1 || march->stretch.t0 > 1e-6 * (double)march->span.voxel_world || height >= 1 || !any_copy(march, &copy)) return through;
    float spot = voxel_layer_spot(copy.texel->matter[0].voxels, in_texel(march, &copy, to_eye), in_texel(march, &copy, march->cone->direction));
    return through + (1 - through) * spot * blurred(march, copy.texel) * (float)double_min(1, 1 - height);
}

float skin_joint_matter(const SkinMarch *march, Vec3 to_eye, float share) {
    TexelCopy copy;
    if (!knows(march) || !march->skin->texels->alike || !any_copy(march, &copy)) return share;
    float lit = voxel_layer_lit_pair(copy.texel->matter[0].voxels, in_texel(march, &copy, to_eye), in_texel(march, &copy, march->cone->direction));
    return lit < 0 ? share : share + blurred(march, copy.texel) * (lit - share);
}
