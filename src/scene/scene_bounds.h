/* Axis-aligned boxes around objects. */
#ifndef VTS_SCENE_SCENE_BOUNDS_H
#define VTS_SCENE_SCENE_BOUNDS_H

#include "scene/scene.h"

/* A box around the object in its parent's space (with its transform applied). Tight for boxes, spheres, cylinders, cones,
 * discs, tori, meshes, particles' spines widened by half their width, and unions of them; infinite for planes; what an
 * intersection or difference can at most fill. Empty for nothing and for what is not modelled. */
Box3 object_bounds(const Object *object);

#endif
