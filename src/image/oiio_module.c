#include "image/oiio_module.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MODULE_NAME "libvts_oiio.so"

/* Tries one place. RTLD_NODELETE: the module stays once loaded, so that nobody needs to remember it. */
static const OiioShim *load_from(const char *folder, const char *subfolder, StrBuf *why) {
    char path[PATH_MAX + 64];
    StrBuf text = {0};
    strbuf_addf(&text, "%s/%s" MODULE_NAME, folder, subfolder);
    bool fits = text.size < sizeof path;
    if (fits) memcpy(path, text.data, text.size + 1);
    strbuf_free(&text);
    if (!fits || access(path, R_OK) != 0) return NULL;
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

/* The folder of the running program; false where the system does not tell. */
static bool program_folder(char folder[PATH_MAX]) {
    ssize_t length = readlink("/proc/self/exe", folder, PATH_MAX - 1);
    if (length <= 0) return false;
    folder[length] = '\0';
    char *slash = strrchr(folder, '/');
    if (!slash) return false;
    *slash = '\0';
    return true;
}

const OiioShim *oiio_module_load(StrBuf *error) {
    StrBuf why = {0};
    const OiioShim *shim = NULL;
    char folder[PATH_MAX];
    const char *chosen = getenv("VTS_MODULE_DIR");
    if (chosen && *chosen) shim = load_from(chosen, "", &why);
    if (!shim && program_folder(folder)) {
        shim = load_from(folder, "", &why);
        if (!shim) shim = load_from(folder, "../" VTS_MODULE_SUBDIR "/", &why);
    }
    if (!shim) shim = load_from(VTS_MODULE_BUILD_DIR, "", &why);
    if (!shim) shim = load_from(VTS_MODULE_INSTALL_DIR, "", &why);
    if (!shim && error)
        strbuf_addf(error,
                    "this picture format needs the module " MODULE_NAME
                    ", which was not found or does not load%s",
                    why.size ? why.data : "");
    strbuf_free(&why);
    return shim;
}
