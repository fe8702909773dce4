/* Who made the picture's error, for report.c. */
#ifndef VTS_RENDER_REPORT_ERRORS_H
#define VTS_RENDER_REPORT_ERRORS_H

#include "render/render.h"

/* Adds "errors": of each stage of the picture what it was allowed, what it is expected to have made, and what that took. */
void report_errors(StrBuf *out, const CompiledScene *compiled, const RenderStats *stats);

#endif
