/* From what libgeotiff says of a coordinate system to a projection. */
#ifndef VTS_TERRAIN_PROJECTION_SYSTEM_H
#define VTS_TERRAIN_PROJECTION_SYSTEM_H

#include "terrain/geotiff_shim.h"
#include "terrain/projection.h"

/* False, with a line of text in `error`, for systems that are refused: see projection_from_epsg(). */
bool projection_from_system(Projection *projection, const GeotiffSystem *system, StrBuf *error);

#endif
