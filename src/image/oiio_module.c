#include "image/oiio_module.h"

#include "base/module.h"

#define MODULE_NAME "libvts_oiio.so"

const OiioShim *oiio_module_load(StrBuf *error) {
    StrBuf why = {0};
    module_load_apart(VTS_OIIO_HEAVY_LIBRARIES);
    const OiioShim *shim = module_load(MODULE_NAME, "vts_oiio_shim", OIIO_SHIM_VERSION, &why);
    if (!shim && error)
        strbuf_addf(error,
                    "this picture format needs the module " MODULE_NAME
                    ", which was not found or does not load%s",
                    why.size ? why.data : "");
    strbuf_free(&why);
    return shim;
}
