#include "cli/command.h"
#include "cli/complaint.h"

static VtsStatus check(VtsSession *session, const void *context) { return vts_check(session, context); }

int command_check(Settings *settings) {
    if (settings->scenes.count == 0) return complain_usage(settings, "no scene given");
    int worst = VTS_OK;
    for (size_t i = 0; i < settings->scenes.count && worst != VTS_INTERRUPTED; i++) {
        Console console;
        console_init(&console, settings);
        const char *scene = settings->scenes.items[i];
        int status = command_with_session(settings, &console, scene, check, scene);
        if (status > worst) worst = status;
        if (status == VTS_OK) console_note(&console, "%s: no errors", scene);
    }
    return worst;
}
