/* POV-Ray's habits: +W640, Width=640, scene.ini. */
#ifndef VTS_CLI_POVRAY_OPTIONS_H
#define VTS_CLI_POVRAY_OPTIONS_H

#include "cli/settings.h"

/* Whether an argument is written so: +…, Name=…, or the name of an .ini file. */
bool povray_recognizes(const char *argument);

/* Does what it says. What means nothing here is named in a warning. 0, or VTS_ERROR_USAGE or VTS_ERROR_FILE after saying
 * why on stderr. The argument must live as long as the settings. */
int povray_apply(Settings *settings, const char *argument);

#endif
