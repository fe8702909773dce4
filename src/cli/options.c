#include "cli/options.h"

#include "cli/command.h"
#include "cli/complaint.h"
#include "cli/farm.h"
#include "cli/frames.h"
#include "cli/povray_options.h"
#include "cli/spelling.h"
#include "cli/option_value.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Each returns NULL, or what it wanted: "WxH, such as 640x480". */
typedef const char *ApplyOption(Settings *settings, const char *value);

typedef struct Option {
    const char *name;
    char letter;          /* 0: none */
    const char *argument; /* as help shows it; NULL: takes none */
    unsigned commands;
    ApplyOption *apply; /* NULL: not available in this version */
    const char *help;
} Option;

static const char *apply_output(Settings *s, const char *value) {
    s->output = value;
    s->output_as_povray = false;
    return *value ? NULL : "a file name";
}
static const char *apply_size(Settings *s, const char *value) {
    return option_size(value, &s->options.width, &s->options.height) ? NULL : "WxH, such as 640x480";
}
static const char *apply_threads(Settings *s, const char *value) {
    return option_int(value, 0, 1024, &s->options.threads) ? NULL
                                                           : "a number from 0 (all processors) to 1024";
}
static const char *apply_clock(Settings *s, const char *value) {
    s->options.clock_set = true;
    return option_double(value, &s->options.clock) ? NULL : "a number";
}
static const char *apply_frames(Settings *s, const char *value) {
    return film_parse_frames(s, value) ? NULL : "frames from first to last, such as 1-48, 1-48x2 or 1,7,20-30";
}
static const char *apply_fps(Settings *s, const char *value) {
    return option_double(value, &s->animation.fps) && s->animation.fps > 0 ? NULL : "a number above 0";
}
static const char *apply_resume(Settings *s, const char *value) {
    (void)value;
    s->resume = s->options.resume = true;
    return NULL;
}
static const char *apply_quality(Settings *s, const char *value) {
    static const char *const names[] = {"draft", "good", "best", NULL};
    static const double errors[] = {4 / 255.0, 1 / 255.0, 0.25 / 255.0};
    int quality = option_word(value, names);
    if (quality >= 0) s->options.max_error = errors[quality];
    return quality >= 0 ? NULL : "draft, good or best";
}
static const char *apply_max_error(Settings *s, const char *value) {
    bool valid = option_quotient(value, &s->options.max_error) && s->options.max_error > 0 &&
                 s->options.max_error <= 1;
    return valid ? NULL : "a number in (0, 1], such as 1/255";
}
static const char *apply_samples(Settings *s, const char *value) {
    return option_int(value, 1, 256, &s->options.samples) ? NULL : "a number from 1 to 256";
}
static const char *apply_rays(Settings *s, const char *value) {
    return option_int(value, 1, 65536, &s->options.reference_samples) ? NULL : "a number from 1 to 65536";
}
static const char *apply_declare(Settings *s, const char *value) {
    return settings_add_pair(s, &s->declares, value) ? NULL : "NAME=VALUE";
}
static const char *apply_include(Settings *s, const char *value) {
    settings_add(&s->includes, value);
    return *value ? NULL : "a folder";
}
static const char *apply_region(Settings *s, const char *value) {
    return option_region(value, s->options.region) ? NULL : "x0,y0,x1,y1 in pixels, x0 < x1 and y0 < y1";
}
static const char *apply_report(Settings *s, const char *value) {
    s->report = value;
    return *value ? NULL : "a file name, or - for the standard output";
}
static const char *apply_progress(Settings *s, const char *value) {
    static const char *const names[] = {"auto", "bar", "plain", "none", NULL};
    int style = option_word(value, names);
    if (style >= 0) s->progress = (ProgressStyle)style;
    return style >= 0 ? NULL : "auto, bar, plain or none";
}
static const char *apply_seed(Settings *s, const char *value) {
    return option_unsigned(value, &s->options.seed) ? NULL : "a number from 0 to 2^64 - 1";
}
static const char *apply_set(Settings *s, const char *value) {
    return settings_add_pair(s, &s->knobs, value) ? NULL : "KNOB=VALUE";
}
static const char *apply_shutter(Settings *s, const char *value) {
    s->animation.shutter_given = true;
    return option_double(value, &s->animation.shutter) && s->animation.shutter >= 0 && s->animation.shutter <= 1 ? NULL : "a number from 0 to 1";
}
static const char *apply_exposure(Settings *s, const char *value) {
    return option_double(value, &s->options.exposure) ? NULL : "a number (in EV)";
}
static const char *apply_alpha(Settings *s, const char *value) {
    (void)value;
    s->options.alpha = true;
    return NULL;
}
static const char *apply_aov(Settings *s, const char *value) {
    s->options.aovs = value;
    return *value ? NULL : "names of channels, such as depth,normal";
}
static const char *apply_preview(Settings *s, const char *value) {
    s->options.preview = value;
    return *value ? NULL : "HOST:PORT";
}
static const char *apply_float_type(Settings *s, const char *value) {
    s->options.float_type = value;
    return strcmp(value, "half") == 0 || strcmp(value, "float") == 0 ? NULL : "half or float";
}
static const char *apply_limit(Settings *s, const char *value) {
    while (*value) {
        size_t size = strcspn(value, ",");
        if (!settings_add_pair(s, &s->limits, settings_copy(s, value, size))) return "NAME=N,…";
        value += size + (value[size] == ',');
    }
    return NULL;
}
static const char *apply_memory_limit(Settings *s, const char *value) {
    return option_bytes(value, &s->options.memory_limit) ? NULL : "a number of bytes, such as 8G or 512M";
}
static const char *apply_cache(Settings *s, const char *value) {
    s->options.cache_dir = strcmp(value, "off") == 0 ? NULL : value;
    return *value ? NULL : "a folder, or off";
}
static const char *apply_allow_read(Settings *s, const char *value) {
    settings_add(&s->read_folders, value);
    return *value ? NULL : "a folder";
}
static const char *apply_allow_write(Settings *s, const char *value) {
    settings_add(&s->write_folders, value);
    return *value ? NULL : "a folder";
}
static const char *apply_dump(Settings *s, const char *value) {
    static const char *const names[] = {"tokens", "ast", "scene", "tape", "compiled", NULL};
    int stage = option_word(value, names);
    if (stage >= 0) s->dump = (VtsDump)stage;
    s->dumps = true;
    return stage >= 0 ? NULL : "tokens, ast, scene, tape or compiled";
}
static const char *apply_verbose(Settings *s, const char *value) {
    (void)value;
    s->verbose = true;
    return NULL;
}
static const char *apply_quiet(Settings *s, const char *value) {
    (void)value;
    s->quiet = true;
    return NULL;
}
static const char *apply_metric(Settings *s, const char *value) {
    s->metrics = value;
    return compare_metrics_valid(value) ? NULL : "some of rmse,psnr,flip,max";
}
static const char *apply_diff(Settings *s, const char *value) {
    s->diff = value;
    return *value ? NULL : "a file name";
}
static const char *apply_sweep(Settings *s, const char *value) {
    return settings_add_pair(s, &s->sweeps, value) ? NULL : "KNOB=VALUE,VALUE,…";
}
static const char *apply_methods(Settings *s, const char *value) {
    settings_add(&s->methods, value);
    return *value && *value != '=' ? NULL : "names of knobs, such as quadrature,ray_path, or KNOB=VALUE,VALUE";
}
static const char *apply_axes(Settings *s, const char *value) {
    s->axes = value;
    return *value ? NULL : "two axes, such as cpu_s,rmse";
}
static const char *apply_reference(Settings *s, const char *value) {
    settings_add(&s->references, value);
    return *value && s->references.count <= 2 ? NULL : "a picture, or two halves by two options";
}
static const char *apply_keep(Settings *s, const char *value) {
    s->keep = value;
    return *value ? NULL : "a folder";
}
static const char *apply_repeat(Settings *s, const char *value) {
    return option_int(value, 1, 100, &s->repeats) ? NULL : "a number from 1 to 100";
}
static const char *apply_regions(Settings *s, const char *value) {
    bool valid = option_size(value, &s->regions[0], &s->regions[1]) && (long long)s->regions[0] * s->regions[1] <= FARM_MOST_REGIONS;
    return valid ? NULL : "NxM, columns and rows, at most 1000 together, such as 4x3";
}
static const char *apply_chunk(Settings *s, const char *value) {
    return option_int(value, 1, 1000000, &s->chunk) ? NULL : "a number from 1 to 1000000";
}
static const char *apply_at_once(Settings *s, const char *value) {
    return option_int(value, 1, 1000000, &s->at_once) ? NULL : "a number from 1 to 1000000";
}
static const char *apply_dry_run(Settings *s, const char *value) {
    (void)value;
    s->dry_run = true;
    return NULL;
}
static const char *apply_script(Settings *s, const char *value) {
    s->script = value;
    return *value ? NULL : "a file name";
}
static const char *apply_sbatch(Settings *s, const char *value) {
    settings_add(&s->sbatch, value);
    return value[0] == '-' && !strpbrk(value, "\r\n") ? NULL : "an option of sbatch, such as --partition=long";
}
static const char *apply_wait(Settings *s, const char *value) {
    return option_double(value, &s->wait) && s->wait >= 0 ? NULL : "a number of seconds";
}
static const char *apply_save(Settings *s, const char *value) {
    s->save = value;
    return *value ? NULL : "a file name";
}
static const char *apply_json(Settings *s, const char *value) {
    (void)value;
    s->json = true;
    return NULL;
}
static const char *apply_help(Settings *s, const char *value) {
    (void)value;
    s->help = true;
    return NULL;
}

static const Option OPTIONS[] = {
    {"output", 'o', "F", COMMAND_DRAW | COMMAND_FARM, apply_output,
     "the picture; its suffix names the format (.exr .png .tif .jpg .hdr .pfm .ppm); default: the scene's "
     "name with .png"},
    {"output", 'o', "F", COMMAND_CHART, apply_output,
     "the plot, .svg, .png or .pdf, and beside it the numbers as .csv; default: the scene's name with .svg"},
    {"output", 'o', "F", COMMAND_STITCH, apply_output, "the whole; its suffix names the format"},
    {"size", 's', "WxH", COMMAND_ALL, apply_size, "size of the picture in pixels; default 768x576"},
    {"threads", 't', "N", COMMAND_ALL, apply_threads, "workers; default 0: all processors"},
    {"clock", 0, "V", COMMAND_ALL, apply_clock, "value of `clock` in the scene"},
    {"quality", 'q', "draft|good|best", COMMAND_RENDER | COMMAND_TEXEL, apply_quality,
     "--max-error 4/255, 1/255 or 0.25/255"},
    {"max-error", 0, "E", COMMAND_RENDER | COMMAND_TEXEL, apply_max_error,
     "accepted RMSE over pixels and channels, linear light in [0,1]"},
    {"samples", 0, "N", COMMAND_RENDER | COMMAND_TEXEL, apply_samples,
     "samples of a pixel where it needs several; default: by --max-error"},
    {"samples", 0, "N", COMMAND_REFERENCE, apply_rays, "rays of a pixel, 1 to 65536; default 64"},
    {"samples", 0, "N", COMMAND_CHART, apply_rays, "rays of a pixel of the reference, in two halves, 1 to 65536; default 64"},
    {"sweep", 0, "KNOB=V,V,...", COMMAND_CHART, apply_sweep, "a point of the chart for each value; may be given several times"},
    {"methods", 0, "KNOB,...", COMMAND_CHART, apply_methods, "a curve for each method that these knobs have names for, or for those of KNOB=VALUE,VALUE"},
    {"axes", 0, "X,Y", COMMAND_CHART, apply_axes, "X: cpu_s, wall_s, camera_rays, shadow_rays, steps, voxels_visited or texel_bytes; Y: rmse, flip, psnr or flicker; default cpu_s,rmse"},
    {"reference", 0, "F", COMMAND_CHART, apply_reference,
     "measures by this picture; given twice, by the mean of two whose noise their difference tells"},
    {"keep", 0, "DIR", COMMAND_CHART, apply_keep, "keeps the picture of each point, and the reference, in this folder"},
    {"repeat", 0, "N", COMMAND_CHART, apply_repeat, "renders each point N times and takes the least time; default 1"},
    {"declare", 'D', "NAME=VALUE", COMMAND_ALL, apply_declare,
     "declares a float, or a string if VALUE is no number"},
    {"include", 'I', "DIR", COMMAND_ALL, apply_include, "where includes and data are looked for as well"},
    {"region", 0, "x0,y0,x1,y1", COMMAND_RENDER | COMMAND_REFERENCE, apply_region,
     "renders this part only, in pixels, x1 and y1 exclusive"},
    {"report", 0, "F|-", COMMAND_RENDER | COMMAND_REFERENCE, apply_report, "writes what was modelled, counted and timed as JSON"},
    {"progress", 0, "auto|bar|plain|none", COMMAND_ALL, apply_progress,
     "how to show progress; auto: a bar on a terminal"},
    {"seed", 0, "N", COMMAND_DRAW | COMMAND_CHART, apply_seed, "of the sampling; default 0"},
    {"set", 0, "KNOB=VALUE", COMMAND_ALL, apply_set, "sets what global_settings would"},
    {"exposure", 0, "EV", COMMAND_DRAW | COMMAND_CHART, apply_exposure, "multiplies the picture by 2^EV"},
    {"alpha", 0, NULL, COMMAND_DRAW, apply_alpha, "leaves the background transparent"},
    {"float-type", 0, "half|float", COMMAND_DRAW, apply_float_type, "how EXR stores colours; default half"},
    {"limit", 0, "NAME=N,...", COMMAND_ALL, apply_limit, "limits of the language: loops, recursion ..."},
    {"memory-limit", 0, "SIZE", COMMAND_ALL | COMMAND_INFO, apply_memory_limit,
     "gives up with status 4 past this much memory (8G, 512M)"},
    {"allow-read", 0, "DIR", COMMAND_ALL, apply_allow_read, "lets scenes read files of this folder"},
    {"allow-write", 0, "DIR", COMMAND_ALL, apply_allow_write, "lets scenes write files of this folder"},
    {"dump", 0, "tokens|ast|scene|tape|compiled", COMMAND_RUN, apply_dump,
     "prints one stage of the program instead"},
    {"verbose", 'v', NULL, COMMAND_ALL, apply_verbose, "says more about what is done"},
    {"quiet", 0, NULL, COMMAND_ALL, apply_quiet, "says nothing of warnings"},
    {"regions", 0, "NxM", COMMAND_FARM, apply_regions, "cuts each picture into N columns and M rows, which another job joins"},
    {"chunk", 0, "N", COMMAND_FARM, apply_chunk, "frames of one job; default: 1, or what makes at most 1000 tasks of an array"},
    {"at-once", 0, "N", COMMAND_FARM, apply_at_once, "slurm: at most so many tasks run together"},
    {"sbatch", 0, "OPTION", COMMAND_FARM, apply_sbatch, "slurm: an option of sbatch, such as --partition=long; may be given several times"},
    {"script", 0, "F", COMMAND_FARM, apply_script, "slurm: the script; default: the scene's name with .slurm"},
    {"dry-run", 0, NULL, COMMAND_FARM, apply_dry_run, "slurm: writes the script and does not submit it"},
    {"wait", 0, "S", COMMAND_STITCH | COMMAND_FARM, apply_wait, "waits for parts that are not there yet, until none has come for so many seconds; default 0"},
    {"help", 'h', NULL, COMMAND_ALL | COMMAND_COMPARE | COMMAND_INFO | COMMAND_STITCH | COMMAND_FARM, apply_help, "this text"},
    {"frames", 'f', "A-B[xSTEP],...", COMMAND_ALL | COMMAND_FARM, apply_frames, "frames of the scene's animation; default: all, of other commands than render the first"},
    {"frames", 'f', "A-B[xSTEP],...", COMMAND_STITCH, apply_frames, "of these frames, whose numbers replace #### in all names"},
    {"shutter", 0, "F", COMMAND_ALL, apply_shutter, "part of a frame's time that it is exposed; default: as the scene's animation says, else 0"},
    {"fps", 0, "N", COMMAND_ALL, apply_fps, "frames a second; default: as the scene's animation says, else 24"},
    {"resume", 0, NULL, COMMAND_RENDER | COMMAND_REFERENCE | COMMAND_STITCH | COMMAND_FARM, apply_resume, "leaves out the pictures that are there, and goes on with one that was not finished"},
    {"resume", 0, NULL, COMMAND_CHART, apply_resume, "takes over the points that the .csv has from the same program, machine, scene and options"},
    {"aov", 0, "NAMES", COMMAND_RENDER | COMMAND_REFERENCE, apply_aov,
     "further channels of an EXR: some of depth,normal,albedo,alpha,position,object,uv,texel_level,samples"},
    {"preview", 0, "HOST:PORT", COMMAND_RENDER | COMMAND_REFERENCE, apply_preview,
     "shows the picture as it grows in a viewer that speaks tev's protocol"},
    {"cache", 0, "DIR|off", COMMAND_ALL & ~COMMAND_CHART, apply_cache,
     "keeps built texels in this folder from one run to the next; default: off"},
    {"metric", 0, "NAMES", COMMAND_COMPARE, apply_metric, "of rmse,psnr,flip,max; default rmse,psnr,flip"},
    {"diff", 0, "F", COMMAND_COMPARE, apply_diff,
     "a picture of FLIP's errors; numbers in .exr and .pfm, else colours"},
    {"json", 0, NULL, COMMAND_COMPARE | COMMAND_INFO, apply_json, "prints JSON"},
    {"save", 0, "F", COMMAND_TEXEL, apply_save, "writes the texel as a file, for texel { \"F\" } (.vtx)"},
};
enum { OPTION_COUNT = sizeof OPTIONS / sizeof *OPTIONS };

/* The arguments that are still to be read. */
typedef struct Arguments {
    char *const *at, *const *end;
} Arguments;

/* An option may have a meaning for each of several commands: that of `command`, if there is one. */
static const Option *find_long(const char *name, size_t size, unsigned command) {
    const Option *found = NULL;
    for (int i = 0; i < OPTION_COUNT; i++) {
        if (strlen(OPTIONS[i].name) != size || memcmp(OPTIONS[i].name, name, size) != 0) continue;
        if (!found || OPTIONS[i].commands & command) found = &OPTIONS[i];
    }
    return found;
}

static const Option *find_short(char letter, unsigned command) {
    const Option *found = NULL;
    for (int i = 0; i < OPTION_COUNT; i++) {
        if (!OPTIONS[i].letter || OPTIONS[i].letter != letter) continue;
        if (!found || OPTIONS[i].commands & command) found = &OPTIONS[i];
    }
    return found;
}

/* `argument` with its "--" and value, as typed. */
static int unknown_long(const Settings *settings, unsigned command, const char *argument, size_t name_size) {
    char typed[64], best[64];
    snprintf(typed, sizeof typed, "%.*s", (int)(name_size > 50 ? 50 : name_size), argument + 2);
    Spelling spelling = spelling_of(typed);
    for (int i = 0; i < OPTION_COUNT; i++)
        if (OPTIONS[i].apply && OPTIONS[i].commands & command) spelling_try(&spelling, OPTIONS[i].name);
    snprintf(best, sizeof best, "--%s", spelling.best ? spelling.best : "");
    char whole[80];
    snprintf(whole, sizeof whole, "--%s", typed);
    return complain_unknown(settings, "option", whole, spelling.best ? best : NULL);
}

/* For the jobs of a farm, as one word. */
static void pass_on(Settings *settings, const char *name, const char *value) {
    size_t size = strlen(name) + (value ? strlen(value) : 0) + 4;
    char *text = malloc(size);
    if (!text) return;
    int length = snprintf(text, size, value ? "--%s=%s" : "--%s", name, value ? value : "");
    settings_add(&settings->passed, settings_copy(settings, text, (size_t)length));
    free(text);
}

/* `value` is what was glued to the option, or NULL; `typed` how the option was written. */
static int apply_option(Settings *settings, unsigned command, const Option *option, const char *typed,
                        const char *value, Arguments *rest) {
    if (!option->apply) return complain_usage(settings, "'%s' is not available in this version", typed);
    if (!(option->commands & command))
        return complain_usage(settings, "'%s' has no meaning for '%s'", typed, settings->program);
    if (!option->argument && value) return complain_usage(settings, "'%s' takes no value", typed);
    if (option->argument && !value) {
        if (rest->at == rest->end)
            return complain_usage(settings, "'%s' needs a value: %s", typed, option->argument);
        value = *rest->at++;
    }
    const char *wanted = option->apply(settings, value);
    if (!wanted && (command & COMMAND_FARM) && !(option->commands & COMMAND_FARM)) pass_on(settings, option->name, value);
    if (!wanted) return 0;
    return complain_usage(settings, "the value '%s' of '%s' is not valid: wanted %s", value, typed, wanted);
}

static int parse_long(Settings *settings, unsigned command, const char *argument, Arguments *rest) {
    size_t size = strcspn(argument + 2, "=");
    const char *value = argument[2 + size] == '=' ? argument + 2 + size + 1 : NULL;
    const Option *option = find_long(argument + 2, size, command);
    if (!option) return unknown_long(settings, command, argument, size);
    char typed[64];
    snprintf(typed, sizeof typed, "--%s", option->name);
    return apply_option(settings, command, option, typed, value, rest);
}

static int parse_short(Settings *settings, unsigned command, const char *argument, Arguments *rest) {
    char typed[3] = {'-', argument[1], '\0'};
    const Option *option = find_short(argument[1], command);
    if (!option) return complain_unknown(settings, "option", argument, NULL);
    return apply_option(settings, command, option, typed, argument[2] ? argument + 2 : NULL, rest);
}

int options_parse(Settings *settings, unsigned command, int count, char *const *arguments) {
    Arguments rest = {arguments, arguments + count};
    bool only_files = false;
    while (rest.at < rest.end) {
        const char *argument = *rest.at++;
        int status = 0;
        if (only_files)
            settings_add(&settings->scenes, argument);
        else if (strcmp(argument, "--") == 0)
            only_files = true;
        else if (argument[0] == '-' && argument[1] == '-')
            status = parse_long(settings, command, argument, &rest);
        else if (argument[0] == '-' && argument[1])
            status = parse_short(settings, command, argument, &rest);
        else if (povray_recognizes(argument)) {
            size_t scenes = settings->scenes.count;
            status = povray_apply(settings, argument);
            settings_add(&settings->passed, argument);
            settings->scene_passed |= settings->scenes.count > scenes;
        }
        else
            settings_add(&settings->scenes, argument);
        if (status != 0 || settings->help) return status;
    }
    const char *wrong = settings_finish(settings);
    return wrong ? complain_usage(settings, "%s", wrong) : 0;
}

void options_print_help(FILE *stream, unsigned command) {
    enum { COLUMN = 30 };
    const unsigned shown = command & COMMAND_FARM ? COMMAND_FARM : command;
    fputs("Options:\n", stream);
    for (int i = 0; i < OPTION_COUNT; i++) {
        const Option *option = &OPTIONS[i];
        if (!option->apply || !(option->commands & shown)) continue;
        char left[80];
        const char *argument = option->argument ? option->argument : "";
        int length = option->letter ? snprintf(left, sizeof left, "  -%c, --%s %s", option->letter,
                                               option->name, argument)
                                    : snprintf(left, sizeof left, "      --%s %s", option->name, argument);
        if (length > COLUMN)
            fprintf(stream, "%s\n%*s %s\n", left, COLUMN, "", option->help);
        else
            fprintf(stream, "%-*s %s\n", COLUMN, left, option->help);
    }
    if (command & COMMAND_FARM) fputs("and those of 'vts render', which the jobs get.\n", stream);
    if (command & COMMAND_ALL && !(command & COMMAND_FARM))
        fputs("POV-Ray's spelling (+W640 +H480 +Ofile +Lfolder +K0.5 Declare=n=1 Width=640 scene.ini) is "
          "understood too.\n",
          stream);
}
