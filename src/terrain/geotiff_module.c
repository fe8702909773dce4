#include "terrain/geotiff_module.h"

#include "base/module.h"

#define MODULE_NAME "libvts_geotiff.so"

const GeotiffShim *geotiff_module_load(StrBuf *error) {
    StrBuf why = {0};
    const GeotiffShim *shim = module_load(MODULE_NAME, "vts_geotiff_shim", GEOTIFF_SHIM_VERSION, &why);
    if (!shim && error)
        strbuf_addf(error, "coordinate systems of maps need the module " MODULE_NAME ", which was not found or does not load%s", why.size ? why.data : "");
    strbuf_free(&why);
    return shim;
}
