/* Texture coordinates of surfaces that have none of their own. */
#ifndef VTS_SHAPE_SURFACE_UV_H
#define VTS_SHAPE_SURFACE_UV_H

#include "scene/scene.h"
#include "shape/soup.h"

/* Replaces the texture coordinates of all triangles (SURFACE_UV_MESH: only missing ones, by planar ones) with those of
 * surface->uv over the bounding box of the soup. Triangles that cross the seam of a turn get their own vertices, with u past 1. */
void surface_uv_generate(const Surface *surface, Arena *arena, TriangleSoup *soup);

#endif
