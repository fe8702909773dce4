/* vts stitch: parts of a picture, drawn with --region, joined into the whole. */
#include "cli/command.h"
#include "cli/complaint.h"
#include "cli/frames.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* ---- waiting for parts that others still draw ---- */

static size_t count_missing(const TextList *parts, const char **first) {
    size_t missing = 0;
    for (size_t i = parts->count; i-- > 0;)
        if (!film_is_drawn(parts->items[i])) *first = parts->items[i], missing++;
    return missing;
}

/* Until all are there, or none has come for so many seconds. */
static int wait_for(const Settings *settings, const TextList *parts) {
    const struct timespec pause = {0, 200000000};
    const char *first = NULL;
    size_t missing = count_missing(parts, &first), before = missing;
    for (double since = console_now(); missing && console_now() - since < settings->wait; missing = count_missing(parts, &first)) {
        if (missing < before) since = console_now();
        before = missing;
        nanosleep(&pause, NULL);
    }
    if (!missing) return 0;
    complain(settings, "%zu of %zu parts have not come, the first of them '%s'", missing, parts->count, first);
    return VTS_ERROR_FILE;
}

/* ---- one picture, or those of a film ---- */

static int join(const Settings *settings, const TextList *parts, const char *output) {
    char why[2048];
    if (settings->resume && film_is_drawn(output)) return 0;
    int waited = settings->wait > 0 ? wait_for(settings, parts) : 0;
    if (waited != 0) return waited;
    VtsStatus status = vts_stitch(parts->items, parts->count, output, why, sizeof why);
    if (status != VTS_OK) complain(settings, "%s", why);
    return (int)status;
}

static bool has_mark(const char *path) {
    const char *slash = strrchr(path, '/');
    return strchr(slash ? slash : path, '#') != NULL;
}

static int join_frame(Settings *settings, int frame) {
    TextList parts = {0};
    settings->options.frame = frame;
    for (size_t i = 0; i < settings->scenes.count; i++) settings_add(&parts, film_output(settings, settings->scenes.items[i]));
    int status = join(settings, &parts, film_output(settings, settings->output));
    free(parts.items);
    return status;
}

static int join_film(Settings *settings) {
    FrameCursor cursor = {0};
    int status = 0;
    for (size_t i = 0; i <= settings->scenes.count; i++) {
        const char *name = i ? settings->scenes.items[i - 1] : settings->output;
        if (!has_mark(name)) return complain_usage(settings, "--frames: '%s' has no #### for the frame's number", name);
    }
    settings->animation.on = true;
    while (status == 0 && film_next(settings, &cursor)) status = join_frame(settings, cursor.frame);
    return status;
}

int command_stitch(Settings *settings) {
    if (settings->scenes.count == 0) return complain_usage(settings, "no parts given");
    if (!settings->output) return complain_usage(settings, "where the whole goes is missing: -o F");
    return settings->animation.asked.count ? join_film(settings) : join(settings, &settings->scenes, settings->output);
}
