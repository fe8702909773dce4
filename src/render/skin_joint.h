/* What eye and light have in common where both look through one layer: texel/voxel_pairs.h in the scene. */
#ifndef VTS_RENDER_SKIN_JOINT_H
#define VTS_RENDER_SKIN_JOINT_H

#include "render/skin_march.h"

/* The share of light that comes through the layer to the ground, `through` without regard to the eye: what is seen through gaps is lit through the
 * same, if eye and light are nearly one. The march goes to the light from a place on the ground and has met its first matter. */
float skin_joint_ground(const SkinMarch *march, Vec3 to_eye, float through);

/* The share of light that comes to matter of the skin, as the voxels have it (`share` of what comes through the rest of the layer, `transmittance`), made
 * more like that of what the eye sees, the more the coarser voxels are. The march is one to the light from a place in the layer. */
float skin_joint_matter(const SkinMarch *march, Vec3 to_eye, float share, float transmittance);

/* The layer of a skin that tells what eye and light have in common, and some copies of it that are turned differently: the mean of what these tell holds for all. */
enum { MOST_JOINT_COPIES = 4 };
struct JointCopies {
    const VoxelLayer *layer;
    size_t texel; /* of the skin, to which it belongs */
    int count;    /* of copies, at least 1 */
    const TexelCopy *copies;
};
/* Of a skin whose voxels are built; NULL where no layer tells. Lives in the arena. */
const JointCopies *skin_joint_copies(const CompiledSkin *skin, Arena *arena);

/* That at a place of the skin. */
typedef struct SkinJoint {
    const JointCopies *of; /* NULL: nothing tells */
    TexturePlace place;
    float lod; /* of the cone's voxels */
} SkinJoint;

/* At the march's place. */
void skin_joint_find(const SkinMarch *march, SkinJoint *joint);
/* How much more or less light than by the normals of the voxels alone matter gets on the side towards the eye, and on the other: factor[2], > 0. The place
 * was found by a march from the eye. */
void skin_joint_facing(const SkinJoint *joint, Vec3 to_eye, Vec3 to_light, float factor[2]);

#endif
