/* OpenImageIO on demand: linking it costs every start of the program a fifth of a second (Debian's build pulls in some
 * 260 libraries), so its shim is a module that is loaded when the first picture is opened. */
#ifndef VTS_IMAGE_OIIO_MODULE_H
#define VTS_IMAGE_OIIO_MODULE_H

#include "base/strbuf.h"
#include "image/oiio_shim.h"

/* The shim, or NULL with a line in `error`. Looked for in the folder $VTS_MODULE_DIR names, beside the running program,
 * in ../lib…/vts from there, where it was built and where it is installed. Cheap after the first time; thread-safe. */
const OiioShim *oiio_module_load(StrBuf *error);

#endif
