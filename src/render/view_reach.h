/* What may cast a shadow into the picture: all that lies between what the camera can see and a lamp. */
#ifndef VTS_RENDER_VIEW_REACH_H
#define VTS_RENDER_VIEW_REACH_H

#include "render/view.h"

enum { VIEW_REACH_FACES = 20 };

/* The convex hull of the camera's pyramid and of a lamp: outward normals, and what points on its faces have along them. */
typedef struct ViewReach {
    Vec3 normals[VIEW_REACH_FACES];
    double offsets[VIEW_REACH_FACES];
    int count;
} ViewReach;

/* Of a perspective picture without a normal, up to so far from the camera. */
ViewReach view_reach(const View *view, double far, Vec3 lamp);
/* Whether the box lies outside; may be false of some that do. */
bool view_reach_misses(const ViewReach *reach, Box3 box);

#endif
