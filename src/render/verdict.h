/* Whether a picture kept the error that was accepted, as far as it can tell. */
#ifndef VTS_RENDER_VERDICT_H
#define VTS_RENDER_VERDICT_H

#include "render/render.h"

/* Adds a warning that names the cause and a knob where stats->error_estimate is well above max_error. Nothing where the estimate is not known, the
 * scene says itself how many samples there are, or it takes voxels alone and names no error. */
void verdict_tell(const CompiledScene *compiled, const RenderStats *stats, DiagList *diags);

#endif
