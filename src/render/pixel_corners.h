/* What the corners of a pixel see, where its middle does not tell all of it. Places are those of the picture, in pixels. */
#ifndef VTS_RENDER_PIXEL_CORNERS_H
#define VTS_RENDER_PIXEL_CORNERS_H

#include "render/compile.h"
#include "render/cone.h"
#include "render/hierarchy.h"

/* The nearest surface on the cone's axis; `places`: also where on the surface, whatever it looks like. */
bool pixel_surface(const CompiledScene *compiled, const Cone *cone, bool places, SurfaceHit *hit);

/* Whether explicit surfaces do not look the same all over the pixel about (x, y), whose middle meets `hit` (NULL: nothing). */
bool pixel_surfaces_vary(const CompiledScene *compiled, double x, double y, const SurfaceHit *hit);

/* Whether the pixel holds much that a skin's matter along its line of sight does not tell of. Of crests, over whose ground that line goes, a corner
 * tells how far they are. */
bool pixel_is_wide(const CompiledScene *compiled, double x, double y, const SurfaceHit *hit);

#endif
