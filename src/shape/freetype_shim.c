/* The only file that links FreeType. */
#include "shape/freetype_shim.h"

const FreetypeShim *vts_freetype_shim(void) {
#define FREETYPE_ENTRY(name) .name = FT_##name,
    static const FreetypeShim shim = {.version = FREETYPE_SHIM_VERSION, FREETYPE_FUNCTIONS(FREETYPE_ENTRY)};
#undef FREETYPE_ENTRY
    return &shim;
}
