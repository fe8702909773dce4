/* What the files that make triangles share while one object is being walked. */
#ifndef VTS_SHAPE_TESSELLATE_PARTS_H
#define VTS_SHAPE_TESSELLATE_PARTS_H

#include "shape/tessellate.h"
#include "shape/trace.h"

typedef struct TessellateWalk {
    const TessellateOptions *options;
    ShapeTracer *tracer; /* made when first needed */
    Arena *arena;
    TriangleSoup *out;
    ShapeRefusal *refusal;
} TessellateWalk;

/* Whether somebody wants it to end; then everything ends with tessellate_give_up(). */
static inline bool tessellate_interrupted(const TessellateWalk *walk) { return walk->options->interrupted && *walk->options->interrupted; }
bool tessellate_give_up(const TessellateWalk *walk);
ShapeTracer *tessellate_tracer(TessellateWalk *walk);
/* Fills the refusal and returns false. */
bool tessellate_refuse(const TessellateWalk *walk, const Object *object, const char *reason);
/* Tells whoever wants to know that what comes out is not all that was asked for. */
void tessellate_doubt(const TessellateWalk *walk, const Object *object, const char *reason);

/* Appends one solid or sheet, no group and without what clips it, in its own space. What has no end is made as far as `region`
 * reaches (a box of its own space; NULL: it is refused). */
bool tessellate_shape(TessellateWalk *walk, const Object *object, double tolerance, const Box3 *region);
/* Appends an object whose parts have to be cut (tessellate_is_set()) in the space that `outer` leads to. */
bool tessellate_set(TessellateWalk *walk, const Object *object, const Transform *outer);
/* Whether its triangles come from cutting those of its parts. */
bool tessellate_is_set(const Object *object);

#endif
