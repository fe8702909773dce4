/* Copies of texels that no mapping bends, met by rays.
 *
 * Where a skin is one affine map — a texel placed as an object, a flat field — its copies are rigid: one hierarchy over the texel's triangles serves all of them,
 * and a ray costs about the logarithm of what there is, where a beam maps every triangle that it meets. So samples of tiles, and what lies between them and
 * a light, ask Embree's instances; what they find is the same facets that beams draw. Where a copy reaches over the border of the surface, hits beyond it are taken
 * back. */
#ifndef VTS_RENDER_BEAM_RIGID_H
#define VTS_RENDER_BEAM_RIGID_H

#include "render/beam_shadow.h"

typedef struct RigidCopies RigidCopies;

/* Whether all copies of the skin are rigid, and end at most with the surface: to be known before its texels' triangles are. */
bool skin_is_rigid(const CompiledSkin *skin);
/* Of all skins that are so and are drawn by beams, which from then on draw none of them. NULL if there are none. The copies live in compiled->arena, the
 * rest until rigid_copies_destroy(). */
RigidCopies *rigid_copies_build(CompiledScene *compiled);
void rigid_copies_destroy(RigidCopies *copies);
/* Draws them into the samples of the draft's beam, which is the camera's and whose line through (x, y) is along corner + right·x + down·y, or from
 * there if it is not perspective. Returns how many rays that took. */
uint64_t rigid_see(const RigidCopies *copies, BeamDraft *draft, Vec3 corner, Vec3 right, Vec3 down, Vec3 direction);
/* Hides the points that they keep from the light. Returns how many rays that took. */
uint64_t rigid_hide(const RigidCopies *copies, const Light *light, const ShadowPoints *points);
/* False when certainly none of them is in the beam. */
bool rigid_meets(const RigidCopies *copies, const Beam *beam);

#endif
