/* Pictures of the ground that say where they lie: which of their points a point of the scene has. */
#ifndef VTS_TERRAIN_DRAPE_H
#define VTS_TERRAIN_DRAPE_H

#include "base/arena.h"
#include "base/strbuf.h"
#include "scene/scene.h"
#include "terrain/geodesy.h"

/* The place of a picture of columns x rows pixels, by the tags of a GeoTIFF or a world file beside it. NULL with a line in `error`, which
 * is without the path. */
const PicturePlace *drape_open(const char *path, int columns, int rows, const GeoFrame *frame, Arena *arena, StrBuf *error);

#endif
