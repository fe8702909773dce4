/* vts texel: builds one texel of a scene, prints what it takes, saves and draws it. */
#include "cli/command.h"
#include "cli/complaint.h"

#include <stdio.h>

static VtsStatus build_and_print(VtsSession *session, const void *context) {
    const Settings *settings = context;
    VtsStatus status = vts_texel(session, settings->scenes.items[0], settings->scenes.items[1],
                                 settings->save, settings->output);
    if (status == VTS_OK) fputs(vts_report(session), stdout);
    return status;
}

int command_texel(Settings *settings) {
    if (settings->scenes.count == 0) return complain_usage(settings, "no scene given");
    if (settings->scenes.count != 2)
        return complain_usage(settings, "a scene and the name of one of its texels are wanted, %zu given",
                              settings->scenes.count);
    Console console;
    console_init(&console, settings);
    return command_with_session(settings, &console, settings->scenes.items[0], build_and_print, settings);
}
