/* The reference picture: nothing prefiltered, rays of no width. */
#ifndef VTS_RENDER_REFERENCE_H
#define VTS_RENDER_REFERENCE_H

#include "render/render.h"

enum { REFERENCE_DEFAULT_SAMPLES = 64, REFERENCE_MOST_SAMPLES = 1 << 16 };

/* Renders the region of a scene that was compiled as `exact`, as render_picture() does, but each pixel is the mean of
 * options->samples rays (at least 1), one in each of as many parts of the pixel's square, at random places given by pixel,
 * sample and seed. Lights cast hard shadows by one ray each. */
bool reference_picture(const CompiledScene *compiled, const RenderOptions *options, MemoryBudget *memory, Image *out,
                       RenderStats *stats, StrBuf *error);
/* One pixel, as a number of the scene's gamma. */
Radiance reference_pixel(const CompiledScene *compiled, const RenderOptions *options, int x, int y, TraceCounters *counters);

#endif
