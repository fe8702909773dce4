/* What tracing tells of what it meets, for further channels of the picture. */
#ifndef VTS_RENDER_AOV_TRACE_H
#define VTS_RENDER_AOV_TRACE_H

#include "render/aov.h"
#include "render/cone.h"
#include "render/hierarchy.h"
#include "render/skin_march.h"

/* An explicit hit of the cone that is seen with this share. */
AovSample aov_of_surface(const Cone *cone, const SurfaceHit *hit, float share);

/* Voxels that one cone sees, summed over segments. */
typedef struct MatterAov {
    float share;
    double depth, level;
    Vec3f albedo;   /* to be added by whoever knows colours: pigment times weight */
    Sym3f normals;
} MatterAov;

void matter_sum_begin(MatterAov *sum);
/* voxel_width: of MarchSettings. */
void matter_sum_add(MatterAov *sum, const SkinSegment *segment, float weight, float voxel_width);
/* Its normal is the direction that most of the matter faces. */
AovSample matter_sum_end(const MatterAov *sum, const Cone *cone);

#endif
