/* Where parts of vts that are no part of its library lie: what links large foreign libraries is loaded or run when it is needed. */
#ifndef VTS_BASE_MODULE_H
#define VTS_BASE_MODULE_H

#include "base/strbuf.h"

enum { MODULE_PLACES = 7, MODULE_PATH_SIZE = 4096 };

/* The path of the file `name` in the place-th of MODULE_PLACES folders: the one that $VTS_MODULE_DIR names, the running program's,
 * ../lib…/vts from there, that of libvts.so, vts in it, where it was built, where it is installed. False where that folder is not known or has no such file. */
bool module_place(int place, const char *name, char path[MODULE_PATH_SIZE]);

/* Loads each of `libraries`, names separated by ':', by itself and for good, as a module that needs them will find them. For modules with
 * hundreds of libraries behind them: of what is loaded together every symbol is looked for in all, one after another; what is loaded
 * alone looks in its own only. Those that are not there are left out. NULL: none. Cheap after the first time; thread-safe. */
void module_load_apart(const char *libraries);

/* What the function `entry` (of no arguments) of the shared library `name` gives: a table of functions that begins with an int, its
 * version. NULL, with the reasons in `why`, where no such library is found in those folders that loads and has this version. It stays
 * once loaded, so that nobody needs to remember it: cheap after the first time; thread-safe. */
const void *module_load(const char *name, const char *entry, int version, StrBuf *why);

#endif
