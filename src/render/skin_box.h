/* Skins that are one straight box, as texels placed as objects: ways through them need no search. */
#ifndef VTS_RENDER_SKIN_BOX_H
#define VTS_RENDER_SKIN_BOX_H

#include "render/skin_fold.h"
#include "render/skin_walk.h"

/* Skin space of the only cell from the scene's: (a, b, w) = to_cell · (p − corner). */
struct SkinBox {
    Vec3 corner;
    Vec3 row[3];
};

/* NULL where the skin is no such box: of several cells, bent, flat, or with texture coordinates that are not straight. In `arena`. */
const SkinBox *skin_box_of(const CompiledSkin *skin, Arena *arena);
/* The way of the ray within the box between t_min and t_max; false when there is none. */
bool skin_box_stretch(const SkinBox *box, const Ray *ray, double t_min, double t_max, SkinStretch *out);

#endif
