#include "image/oiio_module.h"

#include "base/module.h"

#include <dlfcn.h>
#include <string.h>

#define MODULE_NAME "libvts_oiio.so"

/* Tries one place. RTLD_NODELETE: the module stays once loaded, so that nobody needs to remember it. */
static const OiioShim *load_from(const char *path, StrBuf *why) {
    void *module = dlopen(path, RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);
    if (!module) {
        const char *reason = dlerror();
        strbuf_addf(why, "; %s", reason ? reason : path);
        return NULL;
    }
    /* ISO C has no cast from object to function pointer; POSIX defines this copy. */
    const OiioShim *(*entry)(void) = NULL;
    void *symbol = dlsym(module, "vts_oiio_shim");
    if (symbol) memcpy(&entry, &symbol, sizeof entry);
    const OiioShim *shim = entry ? entry() : NULL;
    if (!shim || shim->version != OIIO_SHIM_VERSION) strbuf_addf(why, "; '%s' is of another version", path);
    dlclose(module);
    return shim && shim->version == OIIO_SHIM_VERSION ? shim : NULL;
}

const OiioShim *oiio_module_load(StrBuf *error) {
    StrBuf why = {0};
    const OiioShim *shim = NULL;
    char path[MODULE_PATH_SIZE];
    for (int place = 0; place < MODULE_PLACES && !shim; place++)
        if (module_place(place, MODULE_NAME, path)) shim = load_from(path, &why);
    if (!shim && error)
        strbuf_addf(error,
                    "this picture format needs the module " MODULE_NAME
                    ", which was not found or does not load%s",
                    why.size ? why.data : "");
    strbuf_free(&why);
    return shim;
}
