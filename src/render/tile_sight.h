/* What can lie between lines of sight of a tile's pixels: where nothing else can, nobody needs to look. */
#ifndef VTS_RENDER_TILE_SIGHT_H
#define VTS_RENDER_TILE_SIGHT_H

#include "render/middles.h"
#include "render/vista.h"

typedef struct TileSight {
    const CompiledScene *compiled;
    int x0, y0;
    Vista vista;
    bool fine; /* something in it is narrower than three pixels */
} TileSight;

/* Of the tile whose first pixel is (x0, y0). */
TileSight tile_sight(const CompiledScene *compiled, int x0, int y0, int columns, int rows);
/* What can be seen between four of its pixels, which all see `object`, as Middle has it. */
VistaView tile_sight_view(const TileSight *sight, int x0, int y0, int x1, int y1, uint32_t object);

/* Whether anything narrower than a pixel may be seen in it, or near. */
bool tile_sight_thin(const CompiledScene *compiled, int x0, int y0, int columns, int rows);

#endif
