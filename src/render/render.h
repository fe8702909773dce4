/* From a compiled scene to a picture. */
#ifndef VTS_RENDER_RENDER_H
#define VTS_RENDER_RENDER_H

#include "render/compile.h"
#include "render/film.h"
#include "render/integrate.h"

typedef struct RenderStats {
    TraceCounters counters;
    uint64_t kept_tiles;   /* that another run had seen; they are counted nowhere else */
    uint64_t kept_moments; /* the same of pictures of moments */
    uint64_t moments;      /* that a blurred picture is the mean of; 0: sharp */
    uint64_t split_pixels; /* traced by several cones */
    double noise_estimate; /* the RMSE to be expected from samples alone */
    double voxels_estimate; /* the RMSE to be expected of voxels that stand for geometry; negative: not known */
    uint64_t pixels;        /* drawn */
    double error_estimate; /* the RMSE to be expected; negative: not known, as voxels are seen */
} RenderStats;

/* What functions have cost the scene's rays since `before`, an earlier answer of hierarchy_work(). */
SolidWork render_functions_since(const CompiledScene *compiled, const SolidWork *before);

/* Renders the region into `out` (R G B, or R G B A with alpha; initialised here). The pixels do not depend on the number of
 * threads. False when cancelled or out of memory (text in `error`, which may be NULL). */
bool render_picture(const CompiledScene *compiled, const RenderOptions *options, MemoryBudget *memory, Image *out,
                    RenderStats *stats, StrBuf *error);

#endif
