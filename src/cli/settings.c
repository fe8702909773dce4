#include "cli/settings.h"

#include "cli/frames.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The command line is small: no memory for it is no memory for anything. */
static void *grown(void *items, size_t count, size_t item_size) {
    void *larger = realloc(items, (count + 1) * item_size);
    if (larger) return larger;
    fputs("vts: error: not enough memory\n", stderr);
    exit(VTS_ERROR_MEMORY);
}

void settings_init(Settings *settings, const char *program) {
    *settings = (Settings){.program = program,
                           .options = vts_options_default(),
                           .suffix = ".png",
                           .animation = {.first_frame = 1, .last_frame = 1, .step = 1, .last_clock = 1}};
}

void settings_free(Settings *settings) {
    for (size_t i = 0; i < settings->owned_count; i++) free(settings->owned[i]);
    free(settings->owned);
    PairList *pairs[] = {&settings->declares, &settings->limits, &settings->knobs,
                         &settings->sweeps};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) free(pairs[i]->items);
    TextList *texts[] = {&settings->scenes, &settings->includes, &settings->read_folders,
                         &settings->write_folders, &settings->references, &settings->methods, &settings->sbatch, &settings->passed};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) free(texts[i]->items);
    free(settings->animation.asked.items);
    *settings = (Settings){0};
}

void settings_add(TextList *list, const char *text) {
    list->items = grown(list->items, list->count, sizeof *list->items);
    list->items[list->count++] = text;
}

const char *settings_copy(Settings *settings, const char *text, size_t size) {
    char *copy = grown(NULL, size, 1);
    memcpy(copy, text, size);
    copy[size] = '\0';
    settings->owned = grown(settings->owned, settings->owned_count, sizeof *settings->owned);
    settings->owned[settings->owned_count++] = copy;
    return copy;
}

void settings_add_frames(Settings *settings, FrameRange range) {
    FrameList *list = &settings->animation.asked;
    list->items = grown(list->items, list->count, sizeof *list->items);
    list->items[list->count++] = range;
}

bool settings_add_pair(Settings *settings, PairList *list, const char *text) {
    const char *equals = strchr(text, '=');
    if (!equals || equals == text) return false;
    list->items = grown(list->items, list->count, sizeof *list->items);
    list->items[list->count++] =
        (VtsPair){settings_copy(settings, text, (size_t)(equals - text)), equals + 1};
    return true;
}

/* The folder of the running program; NULL where the system does not tell. */
static const char *program_folder(Settings *settings) {
    char path[PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", path, sizeof path);
    while (length > 0 && path[length - 1] != '/') length--;
    return length > 1 ? settings_copy(settings, path, (size_t)length - 1) : NULL;
}

/* POV-Ray counts rows and columns from 1 and includes the last; below 1 they are shares of the picture. */
static bool range_of(const double given[2], int size, int *begin, int *end) {
    *begin = given[0] <= 0 ? 0 : given[0] < 1 ? (int)floor(given[0] * size) : (int)given[0] - 1;
    *end = given[1] <= 0 ? size : given[1] <= 1 ? (int)floor(given[1] * size) : (int)given[1];
    if (*end > size) *end = size;
    return *begin < *end;
}

static const char *finish_region(Settings *settings) {
    if (settings->rows[0] + settings->rows[1] + settings->columns[0] + settings->columns[1] <= 0) return NULL;
    VtsOptions *options = &settings->options;
    int *region = options->region;
    if (!range_of(settings->columns, options->width, &region[0], &region[2]) ||
        !range_of(settings->rows, options->height, &region[1], &region[3]))
        return "the rows or columns asked for are not in the picture";
    return NULL;
}

const char *settings_finish(Settings *settings) {
    VtsOptions *options = &settings->options;
    options->declares = settings->declares.items;
    options->declare_count = settings->declares.count;
    options->limits = settings->limits.items;
    options->limit_count = settings->limits.count;
    options->settings = settings->knobs.items;
    options->setting_count = settings->knobs.count;
    options->include_dirs = settings->includes.items;
    options->include_dir_count = settings->includes.count;
    options->allow_read = settings->read_folders.items;
    options->allow_read_count = settings->read_folders.count;
    options->allow_write = settings->write_folders.items;
    options->allow_write_count = settings->write_folders.count;
    options->program_dir = program_folder(settings);
    const char *wrong = finish_region(settings);
    return wrong || !settings->animation.frames_given ? wrong : film_fault(settings);
}

static const char *file_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* `folder` (may be empty), the scene's name without its suffix, and the picture's suffix. */
static const char *named_after(Settings *settings, const char *folder, const char *scene) {
    const char *name = file_name(scene), *dot = strrchr(name, '.');
    int stem = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
    char path[PATH_MAX + 16];
    int length = snprintf(path, sizeof path, "%s%.*s%s", folder, stem, name, settings->suffix);
    return length > 0 && (size_t)length < sizeof path ? settings_copy(settings, path, (size_t)length) : "";
}

const char *settings_output_name(Settings *settings, const char *scene) {
    const char *output = settings->output;
    if (!output) return named_after(settings, "", scene);
    if (!settings->output_as_povray || strrchr(file_name(output), '.')) return output;
    if (!*file_name(output)) return named_after(settings, output, scene);
    char path[PATH_MAX + 16];
    int length = snprintf(path, sizeof path, "%s%s", output, settings->suffix);
    return length > 0 && (size_t)length < sizeof path ? settings_copy(settings, path, (size_t)length)
                                                      : output;
}

const char *settings_output(Settings *settings, const char *scene) {
    return film_output(settings, settings_output_name(settings, scene));
}
