/* The only file that links Embree. */
#include "render/embree_shim.h"

const EmbreeShim *vts_embree_shim(void) {
#define EMBREE_ENTRY(name) .name = rtc##name,
    static const EmbreeShim shim = {.version = EMBREE_SHIM_VERSION, EMBREE_FUNCTIONS(EMBREE_ENTRY)};
#undef EMBREE_ENTRY
    return &shim;
}
