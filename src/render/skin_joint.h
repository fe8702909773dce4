/* What eye and light have in common where both look through one layer: texel/voxel_pairs.h in the scene. */
#ifndef VTS_RENDER_SKIN_JOINT_H
#define VTS_RENDER_SKIN_JOINT_H

#include "render/skin_march.h"

/* The share of light that comes through the layer to the ground, `through` without regard to the eye: what is seen through gaps is lit through the
 * same, if eye and light are nearly one. The march goes to the light from a place on the ground and has met its first matter. */
float skin_joint_ground(const SkinMarch *march, Vec3 to_eye, float through);

/* The share of light that comes to matter of the skin, as the voxels have it, made more like that of what the eye sees, the more the coarser
 * voxels are. The march is one to the light from a place in the layer. */
float skin_joint_matter(const SkinMarch *march, Vec3 to_eye, float share);

#endif
