/* vts reference: the same scene with nothing prefiltered, which renderings are compared with. */
#include "cli/command.h"
#include "cli/complaint.h"
#include "cli/report_file.h"

#include <stdio.h>

typedef struct Referencing {
    const char *scene, *output;
    const Settings *settings;
    Console *console;
} Referencing;

static VtsStatus make_reference(VtsSession *session, const void *context) {
    const Referencing *r = context;
    VtsStatus status = vts_reference(session, r->scene, r->output);
    if (status != VTS_OK || !r->settings->report) return status;
    console_clear(r->console);
    return report_file_write(r->settings, r->settings->report, vts_report(session)) ? VTS_OK : VTS_ERROR_FILE;
}

int command_reference(Settings *settings) {
    if (settings->scenes.count == 0) return complain_usage(settings, "no scene given");
    if (settings->scenes.count > 1)
        return complain_usage(settings, "one scene at a time, not also '%s'", settings->scenes.items[1]);
    if (settings->report && !report_file_possible(settings, settings->report)) return VTS_ERROR_FILE;
    int first, last;
    settings_frames(settings, &first, &last); /* of an animation the first frame */
    settings_enter_frame(settings, first);
    Console console;
    console_init(&console, settings);
    const char *scene = settings->scenes.items[0];
    Referencing referencing = {scene, settings_output(settings, scene), settings, &console};
    double start = console_now();
    int status = command_with_session(settings, &console, scene, make_reference, &referencing);
    if (status == VTS_OK && (settings->verbose || console.style == PROGRESS_BAR))
        fprintf(stderr, "%s: %d x %d pixels of %d rays in %.2f s\n", referencing.output, settings->options.width,
                settings->options.height, settings->options.reference_samples, console_now() - start);
    return status;
}
