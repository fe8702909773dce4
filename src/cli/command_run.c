#include "cli/command.h"
#include "cli/complaint.h"

typedef struct Program {
    const char *path;
    const Settings *settings;
} Program;

static VtsStatus run(VtsSession *session, const void *context) {
    const Program *program = context;
    if (program->settings->dumps) return vts_dump(session, program->path, program->settings->dump);
    return vts_run(session, program->path);
}

int command_run(Settings *settings) {
    if (settings->scenes.count == 0) return complain_usage(settings, "no program given");
    if (settings->scenes.count > 1)
        return complain_usage(settings, "one program at a time, not also '%s'", settings->scenes.items[1]);
    Program program = {settings->scenes.items[0], settings};
    int first, last, status = VTS_OK;
    settings_frames(settings, &first, &last);
    for (int frame = first; frame <= last && status == VTS_OK;
         frame += settings->animation.step) {
        Console console;
        console_init(&console, settings);
        settings_enter_frame(settings, frame);
        status = command_with_session(settings, &console, program.path, run, &program);
    }
    return status;
}
