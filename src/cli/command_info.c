/* vts info: what is in files of heights, voxels, densities and pixels. */
#include "cli/command.h"
#include "cli/complaint.h"

#include <stdio.h>

static VtsStatus tell(VtsSession *session, const void *context) {
    const Settings *settings = context;
    VtsStatus worst = VTS_OK;
    bool list = settings->json && settings->scenes.count > 1;
    if (list) fputs("[", stdout);
    for (size_t i = 0, told = 0; i < settings->scenes.count; i++) {
        VtsStatus status = vts_info(session, settings->scenes.items[i], settings->json);
        if (status == VTS_INTERRUPTED || status == VTS_ERROR_MEMORY) return status;
        worst = status != VTS_OK ? status : worst;
        if (status != VTS_OK) continue;
        if (list && told++) fputs(",", stdout);
        fputs(vts_report(session), stdout);
    }
    if (list) puts("]");
    return worst;
}

int command_info(Settings *settings) {
    if (settings->scenes.count == 0) return complain_usage(settings, "no file given");
    Console console;
    console_init(&console, settings);
    return command_with_session(settings, &console, settings->scenes.items[0], tell, settings);
}
