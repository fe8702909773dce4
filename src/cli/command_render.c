#include "cli/command.h"
#include "cli/complaint.h"
#include "cli/frames.h"
#include "cli/movie.h"
#include "cli/report_file.h"

#include <stdio.h>

/* What a rendering is about: one picture, or those of a film. */
typedef struct Rendering {
    const char *scene;
    Settings *settings;
    Console *console;
} Rendering;

static VtsStatus render_frame(VtsSession *session, const Rendering *r, int frame) {
    Settings *settings = r->settings;
    film_enter(settings, settings->animation.on ? session : NULL, frame);
    const char *output = settings_output(settings, r->scene);
    if (settings->resume && film_is_drawn(output)) {
        console_skip_work(r->console);
        console_note(r->console, "%s: is there", output);
        return VTS_OK;
    }
    double start = console_now();
    console_begin_work(r->console);
    VtsStatus status = vts_render(session, r->scene, output);
    console_end_work(r->console);
    /* Who looks at a bar likes to know where the picture is. */
    if (status == VTS_OK && (settings->verbose || r->console->style == PROGRESS_BAR))
        fprintf(stderr, "%s: %d x %d pixels in %.2f s\n", output, settings->options.width,
                settings->options.height, console_now() - start);
    return status;
}

/* Frames that are done are reported of, whatever came after them. */
static VtsStatus write_report(VtsSession *session, const Rendering *r, VtsStatus status) {
    const char *report = vts_report(session), *path = r->settings->report;
    if (!path || (status != VTS_OK && !*report)) return status;
    console_clear(r->console);
    bool written = report_file_write(r->settings, path, report);
    return status != VTS_OK || written ? status : VTS_ERROR_FILE;
}

static VtsStatus render_frames(VtsSession *session, const Rendering *r) {
    FrameCursor cursor = {0};
    VtsStatus status = VTS_OK;
    if (r->settings->animation.on) console_expect_works(r->console, film_count(r->settings));
    while (status == VTS_OK && film_next(r->settings, &cursor)) status = render_frame(session, r, cursor.frame);
    return write_report(session, r, status);
}

static VtsStatus render_movie(VtsSession *session, const Rendering *r, const char *path) {
    Movie movie;
    if (r->settings->resume && film_is_drawn(path)) {
        console_note(r->console, "%s: is there", path);
        return VTS_OK;
    }
    VtsStatus status = movie_begin(&movie, r->settings, path);
    if (status != VTS_OK) return r->console->diagnostics_shown = true, status;
    r->settings->output = movie.frames;
    if ((status = render_frames(session, r)) == VTS_OK && (status = movie_end(&movie, r->settings)) == VTS_ERROR_FILE) r->console->diagnostics_shown = true;
    return status;
}

static VtsStatus render(VtsSession *session, const void *context) {
    const Rendering *r = context;
    VtsStatus status = film_join(session, r->settings, r->scene, FILM_ALL);
    if (status != VTS_OK) return status;
    const char *output = r->settings->output;
    return output && movie_is(output) ? render_movie(session, r, output) : render_frames(session, r);
}

int command_render(Settings *settings) {
    if (settings->scenes.count == 0) return complain_usage(settings, "no scene given");
    if (settings->scenes.count > 1)
        return complain_usage(settings, "one scene at a time, not also '%s'", settings->scenes.items[1]);
    if (settings->report && !report_file_possible(settings, settings->report)) return VTS_ERROR_FILE;
    settings->options.unreported = !settings->report;
    Console console;
    console_init(&console, settings);
    Rendering rendering = {settings->scenes.items[0], settings, &console};
    return command_with_session(settings, &console, rendering.scene, render, &rendering);
}
