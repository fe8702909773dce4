/* Light shot through volumes, and kept where it is scattered. */
#ifndef VTS_RENDER_VOLUME_SHOOT_H
#define VTS_RENDER_VOLUME_SHOOT_H

#include "render/integrate.h"
#include "render/volume_light.h"

/* Fills `kept` and `matter` of all volumes. `tracers`: one for each worker. The same for any number of workers. False when interrupted. */
bool volumes_shoot(CompiledScene *compiled, Tracer **tracers);

/* The place in the scene of one in the volume's unit cube. */
Vec3 volume_point(const CompiledVolume *volume, Vec3 unit);
/* The other way. */
Vec3 volume_unit(const CompiledVolume *volume, Vec3 point);

#endif
