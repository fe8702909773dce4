/* Light shot through volumes, and kept where it is scattered. */
#ifndef VTS_RENDER_VOLUME_SHOOT_H
#define VTS_RENDER_VOLUME_SHOOT_H

#include "render/integrate.h"
#include "render/volume_light.h"

/* Fills `density` and `source` of all volumes by paths, and tells by the set's `looks` how often bins are to look around. `tracers`: one for each worker. The same for any number of workers.
 * False when interrupted. */
bool volumes_shoot(CompiledScene *compiled, Tracer **tracers);
enum { VOLUME_LOOK_RAYS = 18 }; /* of each bin */
/* Fills `kept` of all volumes: for each bin the light is asked for that comes there from the others all around, and from the sky; what they get takes the place of what paths brought, and they
 * look again, set->looks times. volume_around.c */
bool volumes_look_around(CompiledScene *compiled, Tracer **tracers);
/* How many turns the paths may have behind them when they come to where they are kept; the look around adds one, and the view another. */
int volume_most_turns(const VolumeSet *set);

/* The place in the scene of one in the volume's unit cube. */
Vec3 volume_point(const CompiledVolume *volume, Vec3 unit);
/* How much matter is there. */
double volume_density(const CompiledVolume *volume, Vec3 unit);
/* A place in the unit cube, from one in the unit cube of a bin. */
Vec3 volume_bin_place(const VolumeLight *light, const int bin[3], const double in[3]);
/* The other way. */
Vec3 volume_unit(const CompiledVolume *volume, Vec3 point);

#endif
