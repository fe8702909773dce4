/* What is to be said of a picture once it is drawn. */
#ifndef VTS_RENDER_VERDICT_H
#define VTS_RENDER_VERDICT_H

#include "render/render.h"

/* Adds a warning where more objects lie within each other than are followed, and one that names the cause and a knob where stats->error_estimate is well above max_error. Nothing where the estimate is not known, the
 * scene says itself how many samples there are, or it takes voxels alone and names no error. */
void verdict_tell(const CompiledScene *compiled, const RenderStats *stats, DiagList *diags);

#endif
