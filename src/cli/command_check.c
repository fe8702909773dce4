#include "cli/command.h"
#include "cli/complaint.h"

static VtsStatus check(VtsSession *session, const void *context) { return vts_check(session, context); }

static int check_frames(Settings *settings, const char *scene) {
    int first, last, status = VTS_OK;
    settings_frames(settings, &first, &last);
    for (int frame = first; frame <= last && status == VTS_OK;
         frame += settings->animation.step) {
        Console console;
        console_init(&console, settings);
        settings_enter_frame(settings, frame);
        status = command_with_session(settings, &console, scene, check, scene);
        if (status == VTS_OK) console_note(&console, "%s: no errors", scene);
    }
    return status;
}

int command_check(Settings *settings) {
    if (settings->scenes.count == 0) return complain_usage(settings, "no scene given");
    int worst = VTS_OK;
    for (size_t i = 0; i < settings->scenes.count && worst != VTS_INTERRUPTED; i++) {
        int status = check_frames(settings, settings->scenes.items[i]);
        if (status > worst) worst = status;
    }
    return worst;
}
