#include "render/skin_joint.h"

#include "texel/light_share.h"
#include "texel/voxel_lit.h"

#include <string.h>

/* What is not matter counts as ground up to this height, less and less up to twice as high. */
static const double GROUND_HEIGHT = 0.1;

/* A direction of the scene, in a copy of the texel. */
static Vec3f in_texel(const SkinJoint *at, int copy, Vec3 d) {
    return skin_way_in_texel(&at->of->copies[copy], &at->place, d);
}

static bool turned_alike(const TexelCopy *a, const TexelCopy *b) { return a->xu == b->xu && a->xv == b->xv && a->zu == b->zu && a->zv == b->zv; }

/* Some copies of the first that there is, and how many: another member of the family is much the same. */
static int some_copies(const PlacedTexel *placed, TexelCopy copies[MOST_JOINT_COPIES]) {
    int count = 0;
    for (int64_t i = 0; i < MOST_JOINT_COPIES; i++) {
        TexelCopy *copy = &copies[count];
        if (!texel_copy_of(placed, i & 1, i >> 1, copy) || copy->texel->matter_count == 0) continue;
        if (count == 0 || (copy->texel == copies[0].texel && !turned_alike(copy, &copies[0]))) count++;
    }
    return count;
}

static size_t voxels_of(const VoxelLayer *layer) { return layer->level[0].code_count; }

/* The layer that most of it is in stands for all: of a wood its leaves. */
static const VoxelLayer *main_layer(const BuiltTexel *texel) {
    const VoxelLayer *most = texel->matter[0].voxels;
    for (size_t i = 1; i < texel->matter_count; i++)
        if (voxels_of(texel->matter[i].voxels) > voxels_of(most)) most = texel->matter[i].voxels;
    return most;
}

const JointCopies *skin_joint_copies(const CompiledSkin *skin, Arena *arena) {
    JointCopies best = {.count = 0};
    TexelCopy copies[MOST_JOINT_COPIES], of_best[MOST_JOINT_COPIES];
    for (size_t i = 0; i < skin->texel_count; i++) {
        int count = some_copies(&skin->texels[i], copies);
        if (!count) continue;
        const VoxelLayer *layer = main_layer(copies[0].texel);
        if (best.count && voxels_of(layer) <= voxels_of(best.layer)) continue;
        best = (JointCopies){.layer = layer, .texel = i, .count = count};
        memcpy(of_best, copies, (size_t)count * sizeof *copies);
    }
    if (!best.count) return NULL;
    TexelCopy *kept = arena_new_array(arena, TexelCopy, (size_t)best.count);
    memcpy(kept, of_best, (size_t)best.count * sizeof *kept);
    JointCopies *joint = arena_new(arena, JointCopies);
    *joint = best;
    joint->copies = kept;
    return joint;
}

void skin_joint_find(const SkinMarch *march, SkinJoint *joint) {
    joint->of = NULL;
    if (march->sheets || march->settings->opacity != OPACITY_CORRELATED || !march->skin->joint) return;
    joint->of = march->skin->joint;
    joint->lod = march->span.fits[joint->of->texel].lod;
    joint->place = march->span.place;
}

float skin_joint_ground(const SkinMarch *march, Vec3 to_eye, float through) {
    double height = march->stretch.start.w / GROUND_HEIGHT - 1;
    SkinJoint joint;
    if (march->entries != 1 || march->stretch.t0 > 1e-6 * (double)march->span.voxel_world || height >= 1) return through;
    skin_joint_find(march, &joint);
    if (!joint.of) return through;
    float seen = 0;
    for (int i = 0; i < joint.of->count; i++)
        seen += voxel_layer_light_on_ground(joint.of->layer, joint.lod, in_texel(&joint, i, to_eye), in_texel(&joint, i, march->cone->direction), through) / (float)joint.of->count;
    return through + (seen - through) * (float)double_min(1, 1 - height);
}

float skin_joint_matter(const SkinMarch *march, Vec3 to_eye, float share, float transmittance) {
    SkinJoint joint;
    float mean = 0;
    skin_joint_find(march, &joint);
    share *= joint.of && voxel_layer_is_paired(joint.of->layer) ? float_max(transmittance, expf(-LIGHT_DEEPEST)) : transmittance;
    if (!joint.of) return share;
    for (int i = 0; i < joint.of->count; i++)
        mean += voxel_layer_light_on_matter(joint.of->layer, joint.lod, in_texel(&joint, i, to_eye), in_texel(&joint, i, march->cone->direction), share) / (float)joint.of->count;
    return mean;
}

void skin_joint_facing(const SkinJoint *joint, Vec3 to_eye, Vec3 to_light, float factor[2]) {
    factor[0] = factor[1] = joint->of ? 0 : 1;
    for (int i = 0; joint->of && i < joint->of->count; i++) {
        float of_copy[2];
        voxel_layer_facing(joint->of->layer, joint->lod, in_texel(joint, i, to_eye), in_texel(joint, i, to_light), of_copy);
        for (int side = 0; side < 2; side++) factor[side] += of_copy[side] / (float)joint->of->count;
    }
}
