/* libgeotiff on demand: it brings PROJ, which brings some forty libraries, and most scenes have no map. */
#ifndef VTS_TERRAIN_GEOTIFF_MODULE_H
#define VTS_TERRAIN_GEOTIFF_MODULE_H

#include "base/strbuf.h"
#include "terrain/geotiff_shim.h"

/* The shim, or NULL with a line in `error`; places and costs as of oiio_module_load(). */
const GeotiffShim *geotiff_module_load(StrBuf *error);

#endif
