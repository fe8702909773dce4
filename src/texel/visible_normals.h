/* The normals of matter that are seen, of all that its matrix S stands for. */
#ifndef VTS_TEXEL_VISIBLE_NORMALS_H
#define VTS_TEXEL_VISIBLE_NORMALS_H

#include "base/vec.h"

/* The linear map that takes the unit hemisphere over the apparent disc to (unnormalised) visible normals: the rows of
 * Heitz et al. 2015, supplemental code of SGGX sampling, derived from the Cholesky factor of S in the view's frame. */
typedef struct VisibleNormals {
    Vec3f m[3]; /* normal = disc.x·m[0] + disc.y·m[1] + height·m[2] */
} VisibleNormals;

/* `any`: S of any scale, positive definite; `view`: unit, to the eye. */
VisibleNormals visible_normals(const Sym3f *any, Vec3f view);

#endif
