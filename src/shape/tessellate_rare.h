/* Triangles of the rarer solids and sheets (solids.h), in object space. What is closed is solid, and looks outwards. */
#ifndef VTS_SHAPE_TESSELLATE_RARE_H
#define VTS_SHAPE_TESSELLATE_RARE_H

#include "shape/solid_project.h"
#include "shape/tessellate_parts.h"

/* What each of the functions gets. */
typedef struct RareShape {
    TessellateWalk *walk;
    ExactSurface surface;
    double tolerance; /* in object space */
    int parts;        /* as in TessellateOptions */
    const Box3 *region; /* where it is wanted if it has no end; or NULL */
} RareShape;

bool tessellate_rare(const RareShape *shape);

/* ---- by kinds; each appends to the walk's output ---- */

void tessellate_lathe(const RareShape *shape);
void tessellate_sor(const RareShape *shape);
void tessellate_prism(const RareShape *shape);
void tessellate_polygon(const RareShape *shape);
void tessellate_text(const RareShape *shape);
/* bicubic_patch, parametric (its container not regarded) */
void tessellate_grid(const RareShape *shape);
void tessellate_height_field(const RareShape *shape);
/* Whatever has an inside; false where no end is known. */
bool tessellate_field(const RareShape *shape);

/* Marks what is closed since the mark, and turns it so that its volume counts positive; points nearer than `weld` become one before. */
void tessellate_close(const RareShape *shape, SoupMark since, double weld);

#endif
