#include "cli/povray_options.h"

#include "cli/complaint.h"
#include "cli/spelling.h"
#include "cli/option_value.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* NULL, or what was wanted for a value. */
typedef const char *ApplyOption(Settings *settings, const char *value);

static const char *apply_width(Settings *s, const char *value) {
    return option_int(value, 1, 65536, &s->options.width) ? NULL : "a number of pixels";
}
static const char *apply_height(Settings *s, const char *value) {
    return option_int(value, 1, 65536, &s->options.height) ? NULL : "a number of pixels";
}
static const char *apply_clock(Settings *s, const char *value) {
    s->options.clock_set = true;
    return option_double(value, &s->options.clock) ? NULL : "a number";
}
static const char *apply_threads(Settings *s, const char *value) {
    return option_int(value, 1, 1024, &s->options.threads) ? NULL : "a number of threads";
}
static const char *apply_input(Settings *s, const char *value) {
    settings_add(&s->scenes, value);
    return *value ? NULL : "a file name";
}
static const char *apply_output(Settings *s, const char *value) {
    s->output = value;
    s->output_as_povray = true;
    return *value ? NULL : "a file name";
}
static const char *apply_library(Settings *s, const char *value) {
    settings_add(&s->includes, value);
    return *value ? NULL : "a folder";
}
static const char *apply_declare(Settings *s, const char *value) {
    return settings_add_pair(s, &s->declares, value) ? NULL : "NAME=VALUE";
}
static const char *apply_alpha(Settings *s, const char *value) {
    return option_truth(value, &s->options.alpha) ? NULL : "on or off";
}
static const char *alpha_on(Settings *s, const char *value) {
    (void)value;
    s->options.alpha = true;
    return NULL;
}
static const char *apply_file_type(Settings *s, const char *value) {
    static const char *const letters = "NEHJP";
    static const char *const suffixes[] = {".png", ".exr", ".hdr", ".jpg", ".ppm"};
    const char *found = *value ? strchr(letters, toupper((unsigned char)*value)) : NULL;
    if (found) s->suffix = suffixes[found - letters];
    return found ? NULL : "N (PNG), E (EXR), H (HDR), J (JPEG) or P (PPM)";
}
static const char *part(const char *value, double *out) {
    return option_double(value, out) && *out >= 0 ? NULL : "a row or column from 1, or a share below 1";
}
static const char *apply_start_row(Settings *s, const char *value) { return part(value, &s->rows[0]); }
static const char *apply_end_row(Settings *s, const char *value) { return part(value, &s->rows[1]); }
static const char *apply_start_column(Settings *s, const char *value) { return part(value, &s->columns[0]); }
static const char *apply_end_column(Settings *s, const char *value) { return part(value, &s->columns[1]); }

/* As POV-Ray reads it: a fraction is cut off, and no frame comes before 0. */
static const char *frame_number(Settings *s, const char *value, int *out) {
    double number;
    s->animation.on = true;
    if (!option_double(value, &number) || number > 1e9) return "the number of a frame";
    *out = number > 0 ? (int)number : 0;
    return NULL;
}
static const char *apply_frame_step(Settings *s, const char *value) {
    return option_int(value, 1, 1000000000, &s->animation.step) ? NULL : "a number of frames from 1";
}
static const char *apply_first_frame(Settings *s, const char *value) {
    s->animation.frames_given = true;
    return frame_number(s, value, &s->animation.first_frame);
}
static const char *apply_last_frame(Settings *s, const char *value) {
    s->animation.frames_given = true;
    return frame_number(s, value, &s->animation.last_frame);
}
static const char *subset(Settings *s, const char *value, double *out) {
    s->animation.on = true;
    return option_double(value, out) && *out >= 0 && *out <= 1e9
               ? NULL
               : "the number of a frame, or a share below 1";
}
static const char *apply_subset_first(Settings *s, const char *value) {
    return subset(s, value, &s->animation.subset_first);
}
static const char *apply_subset_last(Settings *s, const char *value) {
    return subset(s, value, &s->animation.subset_last);
}
static const char *apply_first_clock(Settings *s, const char *value) {
    s->animation.first_clock_given = true;
    return option_double(value, &s->animation.first_clock) ? NULL : "a number";
}
static const char *apply_last_clock(Settings *s, const char *value) {
    s->animation.last_clock_given = true;
    return option_double(value, &s->animation.last_clock) ? NULL : "a number";
}
static const char *apply_cyclic(Settings *s, const char *value) {
    s->animation.cyclic_given = true;
    return option_truth(value, &s->animation.cyclic) ? NULL : "on or off";
}
static const char *cyclic_on(Settings *s, const char *value) {
    s->animation.cyclic = s->animation.cyclic_given = true;
    return *value ? "nothing" : NULL;
}

/* A switch (+…) and the Name= that POV-Ray gives the same meaning; either may be NULL. */
typedef struct PovrayOption {
    const char *plus, *name;
    ApplyOption *apply;
} PovrayOption;

static const PovrayOption OPTIONS[] = {
    {"W", "Width", apply_width},
    {"H", "Height", apply_height},
    {"K", "Clock", apply_clock},
    {"WT", "Work_Threads", apply_threads},
    {"I", "Input_File_Name", apply_input},
    {"O", "Output_File_Name", apply_output},
    {"L", "Library_Path", apply_library},
    {NULL, "Declare", apply_declare},
    {"UA", NULL, alpha_on},
    {NULL, "Output_Alpha", apply_alpha},
    {"F", "Output_File_Type", apply_file_type},
    {"SR", "Start_Row", apply_start_row},
    {"ER", "End_Row", apply_end_row},
    {"SC", "Start_Column", apply_start_column},
    {"EC", "End_Column", apply_end_column},
    {"KFI", "Initial_Frame", apply_first_frame},
    {"KFF", "Final_Frame", apply_last_frame},
    {NULL, "Frame_Step", apply_frame_step},
    {"KI", "Initial_Clock", apply_first_clock},
    {"KF", "Final_Clock", apply_last_clock},
    {"KC", NULL, cyclic_on},
    {NULL, "Cyclic_Animation", apply_cyclic},
    {"SF", "Subset_Start_Frame", apply_subset_first},
    {"EF", "Subset_End_Frame", apply_subset_last},
};

/* Without a meaning here. */
static const char *const IDLE_SWITCHES[] = {"A",  "B",    "C",  "D",  "G",  "HI", "HN", "HT", "HS",
                                            "J",  "M",    "NR", "P",  "Q",  "R",  "SP", "EP", "SS",
                                            "TH", "THFN", "U",  "UF", "UO", "V",  "X",  NULL};
static const char *const IDLE_NAMES[] = {"All_Console",
                                         "All_File",
                                         "Antialias",
                                         "Antialias_Confidence",
                                         "Antialias_Depth",
                                         "Antialias_Gamma",
                                         "Antialias_Threshold",
                                         "Append_Console_Files",
                                         "Bits_Per_Color",
                                         "Bounding",
                                         "Bounding_Method",
                                         "Bounding_Threshold",
                                         "BSP_BaseAccessCost",
                                         "BSP_ChildAccessCost",
                                         "BSP_ISectCost",
                                         "BSP_MaxDepth",
                                         "BSP_MissChance",
                                         "Buffer_Output",
                                         "Buffer_Size",
                                         "Compression",
                                         "Continue_Trace",
                                         "Create_Continue_Trace_Log",
                                         "Create_Histogram",
                                         "Create_Ini",
                                         "Debug_Console",
                                         "Debug_File",
                                         "Display",
                                         "Display_Gamma",
                                         "Dither",
                                         "Dither_Method",
                                         "Fatal_Console",
                                         "Fatal_Error_Command",
                                         "Fatal_Error_Return",
                                         "Fatal_File",
                                         "File_Gamma",
                                         "Grayscale_Output",
                                         "High_Reproducibility",
                                         "Histogram_Name",
                                         "Histogram_Type",
                                         "Include_Header",
                                         "Include_Ini",
                                         "Jitter",
                                         "Jitter_Amount",
                                         "Light_Buffer",
                                         "Output_To_File",
                                         "Palette",
                                         "Pause_When_Done",
                                         "Post_Frame_Command",
                                         "Post_Scene_Command",
                                         "Pre_Frame_Command",
                                         "Pre_Scene_Command",
                                         "Preview_End_Size",
                                         "Preview_Start_Size",
                                         "Quality",
                                         "Radiosity_File_Name",
                                         "Radiosity_From_File",
                                         "Radiosity_To_File",
                                         "Radiosity_Vain_Pretrace",
                                         "Real_Time_Raytracing",
                                         "Remove_Bounds",
                                         "Render_Block_Size",
                                         "Render_Block_Step",
                                         "Render_Console",
                                         "Render_File",
                                         "Render_Pattern",
                                         "Sampling_Method",
                                         "Split_Unions",
                                         "Statistic_Console",
                                         "Statistic_File",
                                         "Stochastic_Seed",
                                         "Test_Abort",
                                         "Test_Abort_Count",
                                         "User_Abort_Command",
                                         "User_Abort_Return",
                                         "Verbose",
                                         "Version",
                                         "Video_Mode",
                                         "Vista_Buffer",
                                         "Warning_Console",
                                         "Warning_File",
                                         "Warning_Level",
                                         NULL};

/* A name and '=' begin it: Declare=n=1. */
static size_t assignment_name(const char *argument) {
    size_t size = 0;
    if (!isalpha((unsigned char)argument[0])) return 0;
    while (isalnum((unsigned char)argument[size]) || argument[size] == '_') size++;
    return argument[size] == '=' ? size : 0;
}

/* name.ini or name.ini[section] */
static bool is_ini(const char *argument) {
    size_t size = strcspn(argument, "[");
    bool closed = !argument[size] || strchr(argument + size, ']');
    return closed && size > 4 && strncasecmp(argument + size - 4, ".ini", 4) == 0;
}

bool povray_recognizes(const char *argument) {
    return argument[0] == '+' || assignment_name(argument) > 0 || is_ini(argument);
}

static int finish(Settings *settings, const char *argument, const char *wanted) {
    return wanted ? complain_usage(settings, "the value of '%s' is not valid: wanted %s", argument, wanted)
                  : 0;
}

static int say_idle(const Settings *settings, const char *argument) {
    complain_warning(settings, "POV-Ray's option '%s' has no meaning here and is ignored", argument);
    return 0;
}

/* Whether a switch begins with `word`; *longest is the longest such word so far. */
static bool begins_longer(const char *text, const char *word, size_t *longest) {
    size_t size = word ? strlen(word) : 0;
    if (size <= *longest || strncasecmp(text, word, size) != 0) return false;
    *longest = size;
    return true;
}

/* The longest word of both tables that the switch begins with decides: +WT2 is not +W, +KFI1 not +K. */
static int apply_switch(Settings *settings, const char *argument) {
    const PovrayOption *option = NULL;
    bool idle = false;
    size_t longest = 0;
    for (size_t i = 0; i < sizeof OPTIONS / sizeof *OPTIONS; i++)
        if (begins_longer(argument + 1, OPTIONS[i].plus, &longest)) option = &OPTIONS[i];
    for (size_t i = 0; IDLE_SWITCHES[i]; i++)
        idle = begins_longer(argument + 1, IDLE_SWITCHES[i], &longest) || idle;
    if (idle) return say_idle(settings, argument);
    if (!option) return complain_unknown(settings, "option", argument, NULL);
    return finish(settings, argument, option->apply(settings, argument + 1 + longest));
}

static int unknown_name(const Settings *settings, const char *name) {
    Spelling spelling = spelling_of(name);
    for (size_t i = 0; i < sizeof OPTIONS / sizeof *OPTIONS; i++)
        if (OPTIONS[i].name) spelling_try(&spelling, OPTIONS[i].name);
    for (size_t i = 0; IDLE_NAMES[i]; i++) spelling_try(&spelling, IDLE_NAMES[i]);
    return complain_unknown(settings, "option", name, spelling.best);
}

static int apply_assignment(Settings *settings, const char *argument, size_t name_size) {
    const char *name = settings_copy(settings, argument, name_size), *value = argument + name_size + 1;
    for (size_t i = 0; i < sizeof OPTIONS / sizeof *OPTIONS; i++)
        if (OPTIONS[i].name && strcasecmp(OPTIONS[i].name, name) == 0)
            return finish(settings, argument, OPTIONS[i].apply(settings, value));
    if (option_word(name, IDLE_NAMES) >= 0) return say_idle(settings, argument);
    return unknown_name(settings, name);
}

/* Without white space at the ends, a comment behind ';', and quotes around the value. */
static const char *tidy_line(Settings *settings, char *line) {
    line[strcspn(line, ";\r\n")] = '\0';
    line += strspn(line, " \t");
    size_t size = strlen(line);
    while (size > 0 && isspace((unsigned char)line[size - 1])) size--;
    size_t name = strcspn(line, "= \t"), equals = name + strspn(line + name, " \t");
    if (line[name] && line[equals] == '=') {
        size_t value = equals + 1 + strspn(line + equals + 1, " \t");
        bool quoted = size > value + 1 && line[value] == '"' && line[size - 1] == '"';
        char tidy[1024];
        int length = snprintf(tidy, sizeof tidy, "%.*s=%.*s", (int)name, line,
                              (int)(size - value) - 2 * quoted, line + value + quoted);
        if (length > 0 && (size_t)length < sizeof tidy) return settings_copy(settings, tidy, (size_t)length);
    }
    return settings_copy(settings, line, size);
}

static int apply_ini_line(Settings *settings, const char *line) {
    size_t name_size = assignment_name(line);
    if (!*line) return 0;
    if (name_size > 0) return apply_assignment(settings, line, name_size);
    if (*line == '+') return apply_switch(settings, line);
    return say_idle(settings, line);
}

static bool is_section(const char *line, const char *name, size_t size) {
    return name && strncasecmp(line + 1, name, size) == 0 && line[1 + size] == ']';
}

/* The lines before the first [section], and those of the section that is named behind the file's name. */
static int apply_ini(Settings *settings, const char *argument) {
    char line[1024];
    int status = 0;
    const char *path = settings_copy(settings, argument, strcspn(argument, "["));
    const char *section = strchr(argument, '[');
    size_t section_size = section ? strcspn(++section, "]") : 0;
    bool applies = true, found = !section;
    FILE *stream = fopen(path, "r");
    if (!stream) {
        complain(settings, "cannot read '%s'", path);
        return VTS_ERROR_FILE;
    }
    while (status == 0 && fgets(line, sizeof line, stream)) {
        const char *tidy = tidy_line(settings, line);
        if (*tidy == '[') {
            applies = is_section(tidy, section, section_size);
            found = found || applies;
        } else if (applies) {
            status = apply_ini_line(settings, tidy);
        }
    }
    fclose(stream);
    if (!found) complain_warning(settings, "'%s' has no section [%.*s]", path, (int)section_size, section);
    return status;
}

int povray_apply(Settings *settings, const char *argument) {
    if (argument[0] == '+') return apply_switch(settings, argument);
    size_t name_size = assignment_name(argument);
    return name_size > 0 ? apply_assignment(settings, argument, name_size) : apply_ini(settings, argument);
}
