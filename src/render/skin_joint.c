#include "render/skin_joint.h"

#include "texel/voxel_lit.h"

/* What is not matter counts as ground up to this height, less and less up to twice as high. */
static const double GROUND_HEIGHT = 0.1;
/* Voxels of so many levels below the coarsest tell by themselves where light falls, at least: where they are about as small as triangles, of
 * which there are N in a tile, log4(N) levels down. */
static const float LEVELS_BLURRED = 3, MOST_LEVELS_BLURRED = 8, LEVELS_OF_TRIANGLES = 1.3f;

/* The layer that tells what eye and light have in common at the march's place, seen in one copy of its texel. */
typedef struct Joint {
    const VoxelLayer *layer;
    Vec3f to_eye, to_light; /* in texel space */
    float lod, blurred; /* 1 where the coarsest voxel is used, 0 where they tell by themselves */
} Joint;

/* A direction of the scene at the march's place, in a copy of a texel. */
static Vec3f in_texel(const SkinMarch *march, const TexelCopy *copy, Vec3 d) {
    const TexturePlace *place = &march->span.place;
    return texel_copy_rate(copy, vec3(vec3_dot(place->grad_u, d), vec3_dot(place->grad_v, d), vec3_dot(place->grad_w, d)));
}

static float blurred(float levels_from_top, const BuiltTexel *texel) {
    float structure = 0.5f * log2f((float)texel->triangles_known + 1) - LEVELS_OF_TRIANGLES;
    return float_clamp(1 - levels_from_top / float_clamp(structure, LEVELS_BLURRED, MOST_LEVELS_BLURRED), 0, 1);
}

/* Any copy will do: steep views of one that is turned, or of another of the family, are much the same. */
static bool any_copy(const PlacedTexel *placed, TexelCopy *copy) {
    for (int64_t i = 0; i < 4; i++)
        if (texel_copy_of(placed, i & 1, i >> 1, copy)) return copy->texel->matter_count > 0;
    return false;
}

static size_t voxels_of(const VoxelLayer *layer) { return layer->level[0].code_count; }

/* The layer that most of it is in stands for all: of a wood its leaves. */
static const VoxelLayer *main_layer(const BuiltTexel *texel) {
    const VoxelLayer *most = texel->matter[0].voxels;
    for (size_t i = 1; i < texel->matter_count; i++)
        if (voxels_of(texel->matter[i].voxels) > voxels_of(most)) most = texel->matter[i].voxels;
    return most;
}

static bool find_joint(const SkinMarch *march, Vec3 to_eye, Joint *joint) {
    TexelCopy copy, most = {0};
    size_t which = 0;
    joint->layer = NULL;
    if (march->sheets || march->settings->opacity != OPACITY_CORRELATED) return false;
    for (size_t i = 0; i < march->skin->texel_count; i++) {
        if (!any_copy(&march->skin->texels[i], &copy)) continue;
        const VoxelLayer *layer = main_layer(copy.texel);
        if (!joint->layer || voxels_of(layer) > voxels_of(joint->layer)) joint->layer = layer, most = copy, which = i;
    }
    if (!joint->layer) return false;
    joint->to_eye = in_texel(march, &most, to_eye);
    joint->to_light = in_texel(march, &most, march->cone->direction);
    joint->lod = float_clamp(march->span.fits[which].lod, 0, (float)(joint->layer->levels - 1));
    joint->blurred = blurred((float)(joint->layer->levels - 1) - joint->lod, most.texel);
    return true;
}

static float brighter(const Joint *joint, float share) {
    return share + (1 - share) * voxel_layer_spot(joint->layer, joint->to_eye, joint->to_light) * joint->blurred;
}

float skin_joint_ground(const SkinMarch *march, Vec3 to_eye, float through) {
    double height = march->stretch.start.w / GROUND_HEIGHT - 1;
    Joint joint;
    if (march->entries != 1 || march->stretch.t0 > 1e-6 * (double)march->span.voxel_world || height >= 1 || !find_joint(march, to_eye, &joint)) return through;
    float power = voxel_layer_ground_power(joint.layer, joint.lod, joint.to_eye, joint.to_light);
    float seen = brighter(&joint, powf(through, power));
    return through + (seen - through) * (float)double_min(1, 1 - height);
}

float skin_joint_matter(const SkinMarch *march, Vec3 to_eye, float share) {
    Joint joint;
    if (!find_joint(march, to_eye, &joint)) return share;
    return powf(share, voxel_layer_matter_power(joint.layer, joint.lod, joint.to_eye, joint.to_light));
}
