/* From a compiled scene to a picture. */
#ifndef VTS_RENDER_RENDER_H
#define VTS_RENDER_RENDER_H

#include "image/image.h"
#include "render/compile.h"
#include "render/integrate.h"

typedef struct RenderOptions {
    Pool *pool;
    const Progress *progress;
    const atomic_bool *interrupted; /* may be NULL; pixels after it became true stay black */
    int region[4];   /* x0, y0, x1, y1 in pixels, x1 and y1 exclusive */
    int samples;     /* cones per pixel side where one is not enough; 0: by max_error */
    uint64_t seed;   /* of what is sampled */
    double exposure; /* EV */
    bool alpha;      /* keep the background transparent */
} RenderOptions;

typedef struct RenderStats {
    TraceCounters counters;
    uint64_t split_pixels; /* traced by several cones */
} RenderStats;

/* Renders the region into `out` (R G B, or R G B A with alpha; initialised here). The pixels do not depend on the number of
 * threads. False when cancelled or out of memory (text in `error`, which may be NULL). */
bool render_picture(const CompiledScene *compiled, const RenderOptions *options, MemoryBudget *memory, Image *out,
                    RenderStats *stats, StrBuf *error);

#endif
