/* vts reference: the same scene with nothing prefiltered, which renderings are compared with. */
#include "cli/command.h"
#include "cli/complaint.h"
#include "cli/frames.h"
#include "cli/report_file.h"

#include <stdio.h>

typedef struct Referencing {
    const char *scene;
    Settings *settings;
    Console *console;
} Referencing;

static VtsStatus make_frame(VtsSession *session, const Referencing *r, int frame) {
    Settings *settings = r->settings;
    film_enter(settings, settings->animation.on ? session : NULL, frame);
    const char *output = settings_output(settings, r->scene);
    if (settings->resume && film_is_drawn(output)) return VTS_OK;
    double start = console_now();
    VtsStatus status = vts_reference(session, r->scene, output);
    console_clear(r->console);
    if (status == VTS_OK && (settings->verbose || r->console->style == PROGRESS_BAR))
        fprintf(stderr, "%s: %d x %d pixels of %d rays in %.2f s\n", output, settings->options.width,
                settings->options.height, settings->options.reference_samples, console_now() - start);
    return status;
}

static VtsStatus make_reference(VtsSession *session, const void *context) {
    const Referencing *r = context;
    FrameCursor cursor = {0};
    VtsStatus status = film_join(session, r->settings, r->scene, FILM_FIRST);
    while (status == VTS_OK && film_next(r->settings, &cursor)) status = make_frame(session, r, cursor.frame);
    if (status != VTS_OK || !r->settings->report) return status;
    return report_file_write(r->settings, r->settings->report, vts_report(session)) ? VTS_OK : VTS_ERROR_FILE;
}

int command_reference(Settings *settings) {
    if (settings->scenes.count == 0) return complain_usage(settings, "no scene given");
    if (settings->scenes.count > 1)
        return complain_usage(settings, "one scene at a time, not also '%s'", settings->scenes.items[1]);
    if (settings->report && !report_file_possible(settings, settings->report)) return VTS_ERROR_FILE;
    Console console;
    console_init(&console, settings);
    Referencing referencing = {settings->scenes.items[0], settings, &console};
    return command_with_session(settings, &console, referencing.scene, make_reference, &referencing);
}
