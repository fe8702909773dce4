#include "cli/frames.h"

#include "cli/complaint.h"
#include "cli/movie.h"
#include "cli/option_value.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { LARGEST_FRAME = 1000000000, LONGEST_RANGE = 40 };

/* ---- which there are ---- */

/* "A", "A-B" or "A-BxSTEP" */
static bool parse_range(char *text, FrameRange *out) {
    char *step = strchr(text, 'x'), *dash = strchr(text, '-');
    *out = (FrameRange){.step = 1};
    if (step) *step++ = '\0';
    if (dash) *dash++ = '\0';
    if (step && !dash) return false;
    if (!option_int(text, 0, LARGEST_FRAME, &out->first)) return false;
    out->last = out->first;
    if (dash && !option_int(dash, 0, LARGEST_FRAME, &out->last)) return false;
    return out->last >= out->first && (!step || option_int(step, 1, LARGEST_FRAME, &out->step));
}

bool film_parse_frames(Settings *settings, const char *text) {
    settings->animation.asked.count = 0;
    for (bool more = true; more;) {
        char part[LONGEST_RANGE];
        size_t size = strcspn(text, ",");
        FrameRange range;
        if (size >= sizeof part) return false;
        snprintf(part, sizeof part, "%.*s", (int)size, text);
        if (!parse_range(part, &range)) return false;
        settings_add_frames(settings, range);
        more = text[size] == ',';
        text += size + more;
    }
    return true;
}

/* POV-Ray's rule: a share counts from 0, wherever the frames begin; what lies before them is cut off. */
static int subset_frame(const Animation *animation, double asked, int otherwise) {
    if (asked <= 0) return otherwise;
    int count = animation->last_frame - animation->first_frame + 1;
    int frame = asked < 1 ? (int)(asked * count) : (int)asked;
    return frame < animation->first_frame ? animation->first_frame : frame;
}

static FrameRange subset(const Animation *animation) {
    return (FrameRange){subset_frame(animation, animation->subset_first, animation->first_frame),
                        subset_frame(animation, animation->subset_last, animation->last_frame), animation->step};
}

const char *film_fault(const Settings *settings) {
    const Animation *animation = &settings->animation;
    FrameRange range = subset(animation);
    if (!animation->on) return NULL;
    if (animation->first_frame > animation->last_frame) return "the first frame comes after the last";
    if (range.first < animation->first_frame || range.last > animation->last_frame || range.first > range.last)
        return "the subset of frames is not within the animation";
    return NULL;
}

static VtsStatus check_asked(const Settings *settings) {
    const Animation *a = &settings->animation;
    const char *fault = film_fault(settings);
    if (fault) return (VtsStatus)complain_usage(settings, "%s", fault);
    for (size_t i = 0; i < a->asked.count; i++) {
        const FrameRange *r = &a->asked.items[i];
        if (r->first < a->first_frame || r->last > a->last_frame)
            return (VtsStatus)complain_usage(settings, "--frames: there is no frame %d, they are %d to %d",
                                             r->first < a->first_frame ? r->first : r->last, a->first_frame, a->last_frame);
    }
    return VTS_OK;
}

static void take_over(Animation *a, const VtsFilm *film) {
    if (!a->frames_given) a->first_frame = 1, a->last_frame = film->frames;
    if (!a->first_clock_given) a->first_clock = film->first_clock;
    if (!a->last_clock_given) a->last_clock = film->last_clock;
    if (!a->cyclic_given) a->cyclic = film->cyclic;
    if (a->fps == 0) a->fps = film->fps;
    if (!a->shutter_given) a->shutter = film->shutter;
    a->on = a->timed = true;
}

static int steps_of(const Animation *a) { return a->last_frame - a->first_frame + a->cyclic; }

static double cycle_of(const Animation *a) {
    if (!a->cyclic) return 0;
    return a->timed ? steps_of(a) / a->fps : a->last_clock > a->first_clock ? a->last_clock - a->first_clock : 0;
}

/* How far the frame's exposure goes; a film of one frame may pass all its time in it. */
static void open_shutter(Settings *settings) {
    const Animation *a = &settings->animation;
    VtsOptions *o = &settings->options;
    int steps = steps_of(a);
    double range = a->last_clock - a->first_clock;
    o->shutter_clock = a->shutter * (steps > 0 ? range / steps : range);
    o->shutter_time = a->timed ? a->shutter / a->fps : 0;
    if (!isfinite(o->shutter_clock)) o->shutter_clock = 0;
}

/* One picture, at a clock of its own, belongs to the moment of the film that has this clock. */
static void leave_film(Settings *settings) {
    Animation *a = &settings->animation;
    VtsOptions *o = &settings->options;
    double range = a->last_clock - a->first_clock, share = range != 0 ? (o->clock - a->first_clock) / range : 0;
    o->time = share * steps_of(a) / a->fps;
    if (!isfinite(o->time)) o->time = 0;
    o->time_set = true;
    o->cycle = cycle_of(a);
    open_shutter(settings);
    a->on = false;
}

VtsStatus film_join(VtsSession *session, Settings *settings, const char *scene, FilmUse use) {
    Animation *a = &settings->animation;
    VtsFilm film;
    VtsStatus status = vts_film(session, scene, &film);
    if (status != VTS_OK) return status;
    bool picture = settings->options.clock_set && !a->frames_given; /* --clock */
    if (picture && a->asked.count)
        return (VtsStatus)complain_usage(settings, "--clock and --frames: a frame has its own clock");
    if (film.exists) take_over(a, &film);
    /* Not that it has no animation is what its user wants to know. */
    if (film.wrong && !a->on && (a->asked.count || (settings->output && movie_is(settings->output))) &&
        (status = vts_check(session, scene)) != VTS_OK)
        return status;
    if (!a->on && a->asked.count)
        return (VtsStatus)complain_usage(settings, "--frames: '%s' has no animation { … } that says how many there are", scene);
    a->first_only = use == FILM_FIRST && !a->frames_given && !a->asked.count && a->subset_first <= 0 && a->subset_last <= 0;
    if (film.exists && picture) {
        leave_film(settings);
        vts_set_frame(session, &settings->options);
    }
    return check_asked(settings);
}

/* ---- one after the other ---- */

static FrameRange range_at(const Animation *a, size_t index) {
    if (!a->on) return (FrameRange){1, 1, 1};
    FrameRange range = a->asked.count ? a->asked.items[index] : subset(a);
    if (a->first_only) range.last = range.first;
    return range;
}

bool film_next(const Settings *settings, FrameCursor *cursor) {
    const Animation *a = &settings->animation;
    size_t count = a->on && a->asked.count ? a->asked.count : 1;
    for (; cursor->range < count; cursor->range++, cursor->begun = false) {
        FrameRange range = range_at(a, cursor->range);
        if (!cursor->begun) cursor->next = range.first;
        cursor->begun = true;
        if (cursor->next > range.last) continue;
        cursor->frame = (int)cursor->next;
        cursor->next += range.step;
        return true;
    }
    return false;
}

long long film_count(const Settings *settings) {
    const Animation *a = &settings->animation;
    size_t count = a->on && a->asked.count ? a->asked.count : 1;
    long long frames = 0;
    for (size_t i = 0; i < count; i++) {
        FrameRange range = range_at(a, i);
        frames += ((long long)range.last - range.first) / range.step + 1;
    }
    return frames;
}

static void set_options(Settings *settings, int frame) {
    const Animation *a = &settings->animation;
    VtsOptions *o = &settings->options;
    int steps = steps_of(a), passed = frame - a->first_frame;
    bool film = a->last_frame > a->first_frame;
    o->frame = frame;
    o->first_frame = a->first_frame;
    /* Of a cycle POV-Ray counts the frame after the last one too, which is the first again. */
    o->last_frame = a->last_frame + (film && a->cyclic);
    o->first_clock = a->first_clock;
    o->last_clock = a->last_clock;
    o->clock_delta = steps > 0 ? (a->last_clock - a->first_clock) / steps : 0;
    o->clock = a->first_clock + passed * o->clock_delta;
    o->clock_set = o->clock_set || film;
    o->time_set = a->timed;
    o->fps = a->timed ? a->fps : 0;
    o->time = a->timed ? passed / a->fps : 0;
    o->cycle = cycle_of(a);
    open_shutter(settings);
}

void film_enter(Settings *settings, VtsSession *session, int frame) {
    if (settings->animation.on) set_options(settings, frame);
    if (session) vts_set_frame(session, &settings->options);
}

VtsStatus film_enter_first(VtsSession *session, Settings *settings, const char *scene) {
    FrameCursor cursor = {0};
    VtsStatus status = film_join(session, settings, scene, FILM_FIRST);
    if (status == VTS_OK && film_next(settings, &cursor)) film_enter(settings, session, cursor.frame);
    return status;
}

/* ---- names ---- */

static const char *file_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

const char *film_output(Settings *settings, const char *path) {
    if (!settings->animation.on || settings->animation.first_only) return path;
    const char *name = file_name(path), *mark = strrchr(name, '#'), *dot = strrchr(name, '.');
    const char *begin = dot ? dot : path + strlen(path), *end = begin;
    int digits = snprintf(NULL, 0, "%d", settings->animation.last_frame);
    if (mark) {
        begin = end = mark + 1;
        while (begin > name && begin[-1] == '#') begin--;
        digits = (int)(end - begin);
    }
    char numbered[PATH_MAX + 32];
    int length = snprintf(numbered, sizeof numbered, "%.*s%0*d%s", (int)(begin - path), path, digits, settings->options.frame, end);
    return length > 0 && (size_t)length < sizeof numbered ? settings_copy(settings, numbered, (size_t)length) : path;
}

bool film_is_drawn(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode) && info.st_size > 0;
}
