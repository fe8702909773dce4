#include "cli/command.h"
#include "cli/complaint.h"
#include "cli/report_file.h"

#include <stdio.h>

/* What one rendering is about. */
typedef struct Rendering {
    const char *scene, *output, *report;
    const Settings *settings;
    Console *console;
} Rendering;

static VtsStatus render(VtsSession *session, const void *context) {
    const Rendering *rendering = context;
    VtsStatus status = vts_render(session, rendering->scene, rendering->output);
    if (status != VTS_OK || !rendering->report) return status;
    console_clear(rendering->console);
    return report_file_write(rendering->settings, rendering->report, vts_report(session)) ? VTS_OK
                                                                                          : VTS_ERROR_FILE;
}

static int render_frame(Settings *settings, const char *scene) {
    Console console;
    console_init(&console, settings);
    Rendering rendering = {scene, settings_output(settings, scene), settings->report, settings, &console};
    double start = console_now();
    int status = command_with_session(settings, &console, scene, render, &rendering);
    if (status != VTS_OK) return status;
    /* Who looks at a bar likes to know where the picture is. */
    if (settings->verbose || console.style == PROGRESS_BAR)
        fprintf(stderr, "%s: %d x %d pixels in %.2f s\n", rendering.output, settings->options.width,
                settings->options.height, console_now() - start);
    return VTS_OK;
}

int command_render(Settings *settings) {
    if (settings->scenes.count == 0) return complain_usage(settings, "no scene given");
    if (settings->scenes.count > 1)
        return complain_usage(settings, "one scene at a time, not also '%s'", settings->scenes.items[1]);
    if (settings->report && !report_file_possible(settings, settings->report)) return VTS_ERROR_FILE;
    int first, last, status = VTS_OK;
    settings_frames(settings, &first, &last);
    for (int frame = first; frame <= last && status == VTS_OK;
         frame += settings->animation.step) {
        settings_enter_frame(settings, frame);
        status = render_frame(settings, settings->scenes.items[0]);
    }
    return status;
}
