/* min_extent() and max_extent(): the boxes that POV-Ray keeps around objects, which programs rely on to place things. They are
 * not always tight; shape_bounds() and what traces rays have their own. */
#ifndef VTS_SHAPE_EXTENT_H
#define VTS_SHAPE_EXTENT_H

#include "shape/trace.h"

/* With the object's transform applied, in POV-Ray's single precision. What has no end is ±1e10 along all axes. */
Box3 shape_extent(ShapeTracer *tracer, const Object *object);

#endif
