#include "cli/command.h"
#include "cli/complaint.h"
#include "cli/frames.h"

typedef struct Checking {
    const char *scene;
    Settings *settings;
} Checking;

static VtsStatus check(VtsSession *session, const void *context) {
    const Checking *checking = context;
    FrameCursor cursor = {0};
    VtsStatus status = film_join(session, checking->settings, checking->scene, FILM_FIRST);
    while (status == VTS_OK && film_next(checking->settings, &cursor)) {
        film_enter(checking->settings, session, cursor.frame);
        status = vts_check(session, checking->scene);
    }
    return status;
}

static int check_scene(Settings *settings, const char *scene) {
    Console console;
    console_init(&console, settings);
    Settings own = *settings; /* what one scene says of its film is not said of the next */
    int status = command_with_session(&own, &console, scene, check, &(Checking){scene, &own});
    if (status == VTS_OK) console_note(&console, "%s: no errors", scene);
    return status;
}

int command_check(Settings *settings) {
    if (settings->scenes.count == 0) return complain_usage(settings, "no scene given");
    int worst = VTS_OK;
    for (size_t i = 0; i < settings->scenes.count && worst != VTS_INTERRUPTED; i++) {
        int status = check_scene(settings, settings->scenes.items[i]);
        if (status > worst) worst = status;
    }
    return worst;
}
