/* The sub-commands: one file each. */
#ifndef VTS_CLI_COMMAND_H
#define VTS_CLI_COMMAND_H

#include "cli/console.h"
#include "cli/settings.h"

/* Each does its work for settings that options_parse() has read and returns the exit status. */
int command_render(Settings *settings);
int command_check(Settings *settings);
int command_run(Settings *settings);
int command_texel(Settings *settings);
int command_compare(Settings *settings);
int command_reference(Settings *settings);
int command_chart(Settings *settings);
int command_info(Settings *settings);
int command_stitch(Settings *settings);
int command_farm(Settings *settings);

/* Whether all of these comma-separated metrics are known to compare. */
bool compare_metrics_valid(const char *names);

/* Shared by them: one call of a session, from its creation to the last word on stderr. */
typedef VtsStatus SessionCall(VtsSession *session, const void *context);
/* Returns the exit status. `call` runs with signals watched; a failure that nothing was printed about gets a line. */
int command_with_session(Settings *settings, Console *console, const char *scene, SessionCall *call,
                         const void *context);

#endif
