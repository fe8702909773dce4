/* Embree on demand: with the libraries that it brings it takes 2 ms to load, longer than all else of a start, and scenes of a few things
 * need no tree. */
#ifndef VTS_RENDER_EMBREE_MODULE_H
#define VTS_RENDER_EMBREE_MODULE_H

#include "base/strbuf.h"
#include "render/embree_shim.h"

/* Embree as it runs: its functions, and its device. */
typedef struct Embree {
    const EmbreeShim *rtc;
    RTCDevice device;
} Embree;

/* Starts it on the calling thread alone. False where the module is not found or Embree refuses; reasons go to
 * `why`, places of the module as of module_load(). */
bool embree_start(Embree *embree, StrBuf *why);
void embree_stop(Embree *embree);

#endif
