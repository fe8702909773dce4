#define _GNU_SOURCE /* dladdr */
#include "base/module.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool add_folder_of(const char *path, StrBuf *out) {
    const char *slash = strrchr(path, '/');
    if (slash) strbuf_add(out, path, (size_t)(slash - path));
    return slash != NULL;
}

/* The folder of the running program; false where the system does not tell. */
static bool program_folder(StrBuf *out) {
    char path[MODULE_PATH_SIZE];
    ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    if (length <= 0) return false;
    path[length] = '\0';
    return add_folder_of(path, out);
}

/* The folder of the library or program that holds this code: of libvts.so, also where somebody else's program has loaded it, and also
 * where that is the one for newer processors, two folders deeper. */
static bool library_folder(StrBuf *out) {
    static const char here = 0;
    Dl_info info;
    if (!dladdr(&here, &info) || !info.dli_fname) return false;
    const char *deeper = strstr(info.dli_fname, "/glibc-hwcaps/");
    if (deeper) strbuf_add(out, info.dli_fname, (size_t)(deeper - info.dli_fname));
    return deeper || add_folder_of(info.dli_fname, out);
}

static bool folder_of_place(int place, StrBuf *out) {
    const char *chosen = getenv("VTS_MODULE_DIR");
    switch (place) {
    case 0:
        if (chosen) strbuf_adds(out, chosen);
        return chosen && *chosen;
    case 1: return program_folder(out);
    case 2:
        if (!program_folder(out)) return false;
        strbuf_adds(out, "/../" VTS_MODULE_SUBDIR);
        return true;
    case 3: return library_folder(out);
    case 4:
        if (!library_folder(out)) return false;
        strbuf_adds(out, "/vts");
        return true;
    case 5: strbuf_adds(out, VTS_MODULE_BUILD_DIR); return true;
    default: strbuf_adds(out, VTS_MODULE_INSTALL_DIR); return true;
    }
}

bool module_place(int place, const char *name, char path[MODULE_PATH_SIZE]) {
    StrBuf text = {0};
    bool known = folder_of_place(place, &text);
    strbuf_addf(&text, "/%s", name);
    known = known && text.size < MODULE_PATH_SIZE;
    if (known) memcpy(path, text.data, text.size + 1);
    strbuf_free(&text);
    return known && access(path, R_OK) == 0;
}

void module_load_apart(const char *libraries) {
    char name[MODULE_PATH_SIZE];
    while (libraries && *libraries) {
        size_t length = strcspn(libraries, ":");
        if (length > 0 && length < sizeof name) {
            memcpy(name, libraries, length);
            name[length] = '\0';
            void *library = dlopen(name, RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);
            if (library) dlclose(library);
        }
        libraries += length + (libraries[length] == ':');
    }
}

static int version_of(const void *table) {
    int version;
    memcpy(&version, table, sizeof version);
    return version;
}

static const void *load_from(const char *path, const char *entry, int version, StrBuf *why) {
    void *module = dlopen(path, RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);
    if (!module) {
        const char *reason = dlerror();
        strbuf_addf(why, "; %s", reason ? reason : path);
        return NULL;
    }
    /* ISO C has no cast from object to function pointer; POSIX defines this copy. */
    const void *(*function)(void) = NULL;
    void *symbol = dlsym(module, entry);
    if (symbol) memcpy(&function, &symbol, sizeof function);
    const void *table = function ? function() : NULL;
    bool fits = table && version_of(table) == version;
    if (!fits) strbuf_addf(why, "; '%s' is of another version", path);
    dlclose(module);
    return fits ? table : NULL;
}

const void *module_load(const char *name, const char *entry, int version, StrBuf *why) {
    const void *table = NULL;
    char path[MODULE_PATH_SIZE];
    for (int place = 0; place < MODULE_PLACES && !table; place++)
        if (module_place(place, name, path)) table = load_from(path, entry, version, why);
    if (!table && why->size == 0) strbuf_addf(why, "; there is no '%s' where vts looks for its modules", name);
    return table;
}
