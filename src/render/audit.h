/* How wrong a picture is, by a few of its pixels: each is seen twice more as the reference sees it, by rays against what voxels, layers and light kept in bins
 * stand for. The noises of both know nothing of each other, so that the product of their differences from the picture is on the mean the square of its error,
 * whatever that comes from. */
#ifndef VTS_RENDER_AUDIT_H
#define VTS_RENDER_AUDIT_H

#include "render/render.h"

/* Corrects stats->error_estimate of the picture of the region that was drawn by these options. Takes about a tenth of the work that stats->counters tell of, and what it
 * takes to make triangles of texels, and no more memory than half of what is allowed: the estimate stays as it is where more is needed, and where interrupted. That of pictures without skins, volumes and media, whose samples tell their noise,
 * only grows, by what samples agree about and is wrong all the same. Counts, not clocks: equal pictures get equal estimates. */
void audit_picture(CompiledScene *compiled, const CompileOptions *how, const RenderOptions *options, const Image *picture, RenderStats *stats);

#endif
