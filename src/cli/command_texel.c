/* vts texel: builds one texel of a scene, prints what it takes, saves and draws it. */
#include "cli/command.h"
#include "cli/complaint.h"
#include "cli/frames.h"

#include <stdio.h>

static VtsStatus build_and_print(VtsSession *session, const void *context) {
    Settings *settings = *(Settings *const *)context;
    const char *scene = settings->scenes.items[0], *name = settings->scenes.items[1];
    VtsStatus status = film_enter_first(session, settings, scene);
    if (status == VTS_OK) status = vts_texel(session, scene, name, settings->save, settings->output);
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
    return command_with_session(settings, &console, settings->scenes.items[0], build_and_print, &settings);
}
