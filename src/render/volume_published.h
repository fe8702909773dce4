/* The method of Blasi, Le Saec & Schlick 1993 to the letter, its misprints included, for comparison. doc/volumes.md lists them. */
#ifndef VTS_RENDER_VOLUME_PUBLISHED_H
#define VTS_RENDER_VOLUME_PUBLISHED_H

#include "render/volume_light.h"

/* As far as volumes dim what is behind them and beyond them, they do so by absorption only: sets `extinction`. */
void volumes_publish(VolumeSet *set);
/* Their first pass: fills the set's lights, a bin for each voxel, by rays from the lamps. False when interrupted. */
bool volumes_light_published(CompiledScene *compiled);
/* Their second pass. */
Air volumes_gather_published(SurfaceTracer *tracer, const Cone *cone, double t_max, double *mean_t);

#endif
