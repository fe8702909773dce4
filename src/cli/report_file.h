/* --report: JSON into a file that appears whole, or to stdout. */
#ifndef VTS_CLI_REPORT_FILE_H
#define VTS_CLI_REPORT_FILE_H

#include "cli/settings.h"

/* Both say why on stderr and return false when it cannot be. The first creates nothing and is for asking before hours of
 * work. `path` may be "-". */
bool report_file_possible(const Settings *settings, const char *path);
bool report_file_write(const Settings *settings, const char *path, const char *text);

#endif
