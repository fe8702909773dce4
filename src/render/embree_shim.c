#include "render/embree_shim.h"

__attribute__((visibility("default"))) const void *vts_embree_shim(void);

const void *vts_embree_shim(void) {
#define EMBREE_FUNCTION(name) .name = rtc##name,
    static const EmbreeShim shim = {.version = EMBREE_SHIM_VERSION, EMBREE_FUNCTIONS(EMBREE_FUNCTION)};
#undef EMBREE_FUNCTION
    return &shim;
}
