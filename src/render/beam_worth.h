/* What a sample is worth: a few blocks of pixels drawn before all others tell how noisy the picture is, and so how its samples should be shared out
 * (beam_allot.h) that it comes to max_error. */
#ifndef VTS_RENDER_BEAM_WORTH_H
#define VTS_RENDER_BEAM_WORTH_H

#include "render/compile.h"

/* Sets compiled->allot, of a scene whose skins are compiled and planned. */
void beam_worth(CompiledScene *compiled);

#endif
