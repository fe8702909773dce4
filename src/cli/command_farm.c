/* vts farm: jobs for queues. */
#include "cli/command.h"
#include "cli/complaint.h"
#include "cli/farm.h"
#include "cli/frames.h"
#include "cli/report_file.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

typedef enum FarmKind { FARM_LIST, FARM_SLURM, FARM_KINDS } FarmKind;
static const char *const KIND_NAMES[FARM_KINDS + 1] = {"list", "slurm", NULL};

typedef struct Farming {
    Farm farm;
    FarmKind kind;
} Farming;

/* ---- list ---- */

static bool print_job(void *context, long long number, const FarmJob *job) {
    (void)number;
    if (job->done) return true;
    farm_write_job(context, job, NULL, stdout);
    return fputc('\n', stdout) != EOF;
}

static int print_list(Farm *farm) {
    farm_each(farm, print_job, farm);
    if (!farm_is_cut(farm)) return 0;
    farm_write_stitch(farm, stdout);
    putchar('\n');
    return 0;
}

/* ---- what is to be done ---- */

static const char *running_program(Settings *settings) {
    char path[PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", path, sizeof path);
    return length > 0 ? settings_copy(settings, path, (size_t)length) : "vts";
}

static const char *suffix_of(const char *path) {
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash + 1 : path, '.');
    return dot ? dot : "";
}

/* With as many # as the last frame has digits where render would put its number. */
static const char *with_mark(Settings *settings, const char *path) {
    const char *slash = strrchr(path, '/'), *suffix = suffix_of(path);
    if (strchr(slash ? slash : path, '#')) return path;
    char marked[PATH_MAX + 64];
    int stem = (int)(strlen(path) - strlen(suffix)), digits = snprintf(NULL, 0, "%d", settings->animation.last_frame);
    int length = snprintf(marked, sizeof marked, "%.*s%.*s%s", stem, path, digits, "##########", suffix);
    return length > 0 && (size_t)length < sizeof marked ? settings_copy(settings, marked, (size_t)length) : path;
}

/* Formats that keep all of a picture, and those that do not: their parts are EXR. NULL: none that is known. */
static const char *format_of_parts(const char *output, bool *lossless) {
    static const char *const whole[] = {".exr", ".png", ".tif", ".tiff", ".pfm", ".ppm", ".pgm", NULL}, *const poorer[] = {".jpg", ".jpeg", ".hdr", NULL};
    const char *suffix = suffix_of(output);
    *lossless = false;
    for (int i = 0; poorer[i]; i++)
        if (strcasecmp(suffix, poorer[i]) == 0) return ".exr";
    *lossless = true;
    for (int i = 0; whole[i]; i++)
        if (strcasecmp(suffix, whole[i]) == 0) return suffix;
    return NULL;
}

static int plan(Farm *farm) {
    Settings *s = farm->settings;
    const char *output = settings_output_name(s, farm->scene);
    farm->output = s->animation.on ? with_mark(s, output) : output;
    farm->parts = format_of_parts(farm->output, &farm->lossless);
    farm->columns = s->regions[0] ? s->regions[0] : 1, farm->rows = s->regions[1] ? s->regions[1] : 1;
    farm->chunk = s->chunk ? s->chunk : 1;
    if (!farm->parts) return complain_usage(s, "'%s': no picture format has this suffix; of a film, jobs draw the frames", farm->output);
    if (farm->columns > s->options.width || farm->rows > s->options.height)
        return complain_usage(s, "--regions: there are no %d x %d regions in %d x %d pixels", farm->columns, farm->rows, s->options.width,
                              s->options.height);
    return report_file_possible(s, farm->output) ? 0 : VTS_ERROR_FILE;
}

/* A scene that is wrong is told of now, not by a thousand jobs. */
static VtsStatus make_jobs(VtsSession *session, const void *context) {
    Farming farming = *(const Farming *)context;
    Settings *s = farming.farm.settings;
    FrameCursor cursor = {0};
    VtsStatus status = film_join(session, s, farming.farm.scene, FILM_ALL);
    if (status != VTS_OK) return status;
    if (film_next(s, &cursor)) film_enter(s, s->animation.on ? session : NULL, cursor.frame);
    if ((status = vts_check(session, farming.farm.scene)) != VTS_OK) return status;
    int planned = plan(&farming.farm);
    if (planned == 0) planned = farming.kind == FARM_LIST ? print_list(&farming.farm) : farm_slurm(&farming.farm);
    return (VtsStatus)planned;
}

/* What jobs would do to each other. NULL, or an option that they cannot share. */
static const char *unshareable(const Settings *s) {
    if (s->report) return "--report: all jobs would write the same file";
    if (s->options.preview) return "--preview: jobs have nobody who looks on";
    if (s->regions[0] && (s->options.region[2] || s->options.region[3])) return "--region and --regions: one or the other";
    return NULL;
}

static int line_break_in(const Settings *s) {
    const TextList *lists[] = {&s->passed, &s->scenes};
    const char *found = s->output && strpbrk(s->output, "\r\n") ? s->output : NULL;
    for (size_t k = 0; k < 2; k++)
        for (size_t i = 0; i < lists[k]->count; i++)
            if (strpbrk(lists[k]->items[i], "\r\n")) found = lists[k]->items[i];
    return found ? complain_usage(s, "'%s' holds a line break, which cannot stand in a job", found) : 0;
}

int command_farm(Settings *settings) {
    const TextList *words = &settings->scenes;
    int kind = 0;
    while (kind < FARM_KINDS && (words->count == 0 || strcmp(words->items[0], KIND_NAMES[kind]) != 0)) kind++;
    if (kind == FARM_KINDS && words->count) return complain_unknown(settings, "kind of jobs", words->items[0], "list' or 'slurm");
    if (kind == FARM_KINDS) return complain_usage(settings, "what jobs are for is missing: list or slurm");
    if (words->count == 1) return complain_usage(settings, "no scene given");
    if (words->count > 2) return complain_usage(settings, "one scene at a time, not also '%s'", words->items[2]);
    const char *fault = unshareable(settings);
    if (fault) return complain_usage(settings, "%s", fault);
    if (line_break_in(settings) != 0) return VTS_ERROR_USAGE;
    Farming farming = {.farm = {.settings = settings, .program = running_program(settings), .scene = words->items[1]}, .kind = (FarmKind)kind};
    Console console;
    console_init(&console, settings);
    return command_with_session(settings, &console, farming.farm.scene, make_jobs, &farming);
}
