/* The rim of a skin: cells beyond the border of its surface, for what reaches over it.
 *
 * A copy that is moved, turned or enlarged may leave its tile. Within a surface the tiles around show it; at a border nothing did, and it
 * was cut. So each edge of the border carries one more cell, straight on from the surface, as wide as copies reach. They hold nothing of their
 * own: a copy stands if the middle of its tile lies on the surface, and is then whole; one whose middle lies beyond a border is left out, on both sides. */
#ifndef VTS_RENDER_SKIN_RIM_H
#define VTS_RENDER_SKIN_RIM_H

#include "render/skin.h"

/* Adds the rim's cells to a skin whose cells and texels are made, where copies may reach over its border. Where the border is so bent that
 * a cell would fold, and where texture coordinates are singular, there is none. There is room behind the cells for one at each edge
 * without a neighbour; scratch may be reset afterwards. */
void skin_rim_add(CompiledSkin *skin, const SurfaceMesh *mesh, Arena *arena, Arena *scratch);

/* Numbers of tiles, each of one connected part of a surface. */
typedef struct TileSet TileSet;
/* Whether the middle of the tile lies beyond the border of that part. */
bool tile_set_has(const TileSet *beyond, uint32_t part, int64_t iu, int64_t iv);

#endif
