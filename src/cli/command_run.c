#include "cli/command.h"
#include "cli/complaint.h"
#include "cli/frames.h"

typedef struct Program {
    const char *path;
    Settings *settings;
} Program;

static VtsStatus run(VtsSession *session, const void *context) {
    const Program *program = context;
    Settings *settings = program->settings;
    FrameCursor cursor = {0};
    VtsStatus status = film_join(session, settings, program->path, FILM_FIRST);
    while (status == VTS_OK && film_next(settings, &cursor)) {
        film_enter(settings, session, cursor.frame);
        status = settings->dumps ? vts_dump(session, program->path, settings->dump) : vts_run(session, program->path);
    }
    return status;
}

int command_run(Settings *settings) {
    if (settings->scenes.count == 0) return complain_usage(settings, "no program given");
    if (settings->scenes.count > 1)
        return complain_usage(settings, "one program at a time, not also '%s'", settings->scenes.items[1]);
    Program program = {settings->scenes.items[0], settings};
    Console console;
    console_init(&console, settings);
    return command_with_session(settings, &console, program.path, run, &program);
}
