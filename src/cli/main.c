/* The program vts: finds the sub-command and lets it run. */
#include "cli/command.h"
#include "cli/complaint.h"
#include "cli/heap.h"
#include "cli/options.h"
#include "cli/povray_options.h"
#include "cli/spelling.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

typedef struct Command {
    const char *name, *program, *arguments, *summary;
    unsigned bit;
    int (*run)(Settings *settings); /* NULL: not available in this version */
} Command;

static const Command COMMANDS[] = {
    {"render", "vts render", "SCENE [options]", "renders a scene to a picture; the word may be left out",
     COMMAND_RENDER, command_render},
    {"check", "vts check", "SCENE… [options]",
     "reads and evaluates scenes, renders nothing; tells what is wrong", COMMAND_CHECK, command_check},
    {"run", "vts run", "PROGRAM [options]", "evaluates only: the language as a scripting language",
     COMMAND_RUN, command_run},
    {"texel", "vts texel", "SCENE NAME [options]", "builds one texel that a scene declares, tells what it takes, saves and draws it",
     COMMAND_TEXEL, command_texel},
    {"compare", "vts compare", "REFERENCE PICTURE [options]", "tells how far two pictures are apart",
     COMMAND_COMPARE, command_compare},
    {"reference", "vts reference", "SCENE [options]",
     "renders with nothing prefiltered, slowly: what renderings are compared with", COMMAND_REFERENCE, command_reference},
    {"chart", "vts chart", "SCENE --sweep KNOB=V,V,... [options]",
     "charts speed against accuracy: renders with several settings and measures each against the reference", COMMAND_CHART, command_chart},
    {"info", "vts info", "FILE… [options]", "tells what is in maps, texels, meshes, volumes and pictures", COMMAND_INFO, command_info},
    {"farm", "vts farm", "list|slurm SCENE [options]", "makes jobs for many machines of a film's frames or a picture's regions", COMMAND_FARM | COMMAND_RENDER,
     command_farm},
    {"stitch", "vts stitch", "PART… -o WHOLE [options]", "joins the parts of a picture that were drawn with --region", COMMAND_STITCH, command_stitch},
};
enum { COMMAND_COUNT = sizeof COMMANDS / sizeof *COMMANDS };

static const Command *find_command(const char *name) {
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(COMMANDS[i].name, name) == 0) return &COMMANDS[i];
    return NULL;
}

static void print_command_help(const Command *command) {
    printf("Usage: %s %s\n\n%s: %s.\n\n", command->program, command->arguments, command->name,
           command->summary);
    options_print_help(stdout, command->bit);
    puts("\nExit status: 0 done; 1 the scene is wrong; 2 the command line is wrong; 3 a file could not be "
         "read or written;\n"
         "4 the memory limit was hit; 130 interrupted.");
}

static void print_help(FILE *stream) {
    fputs("Usage: vts COMMAND …\n       vts SCENE [options of render]\n\n", stream);
    fputs("Renders scenes of grass, forest, fur and cloud from a script.\n\nCommands:\n", stream);
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (COMMANDS[i].run) fprintf(stream, "  %-9s %s\n", COMMANDS[i].name, COMMANDS[i].summary);
    fputs("  help      [COMMAND] this text, or a command's options\n  version   the program's version\n\n",
          stream);
    fputs("'vts COMMAND --help' lists a command's options.\n", stream);
}

static int run_command(const Command *command, int count, char *const *arguments) {
    Settings settings;
    settings_init(&settings, command->program);
    int status = options_parse(&settings, command->bit, count, arguments);
    if (status == 0 && settings.help)
        print_command_help(command);
    else if (status == 0)
        status = command->run(&settings);
    settings_free(&settings);
    return status;
}

static int help_about(const Settings *top, const char *name) {
    const Command *command = name ? find_command(name) : NULL;
    if (name && !command) return complain_unknown(top, "command", name, NULL);
    if (command && !command->run) return complain_usage(top, "'%s' is not available in this version", name);
    if (command)
        print_command_help(command);
    else
        print_help(stdout);
    return 0;
}

/* A word that is neither a command nor looks like a scene is a command mistyped. */
static bool is_like_scene(const char *word) {
    return word[0] == '-' || strpbrk(word, "./") || povray_recognizes(word) || access(word, F_OK) == 0;
}

static int unknown_command(const Settings *top, const char *word) {
    Spelling spelling = spelling_of(word);
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (COMMANDS[i].run) spelling_try(&spelling, COMMANDS[i].name);
    return complain_unknown(top, "command", word, spelling.best);
}

static int dispatch(int count, char **arguments) {
    Settings top = {.program = "vts"};
    const char *word = count > 0 ? arguments[0] : NULL;
    if (!word) {
        print_help(stderr);
        return VTS_ERROR_USAGE;
    }
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) return help_about(&top, NULL);
    if (strcmp(word, "help") == 0) return help_about(&top, count > 1 ? arguments[1] : NULL);
    if (strcmp(word, "--version") == 0 || strcmp(word, "version") == 0)
        return printf("vts %s\n", vts_version()) < 0;
    const Command *command = find_command(word);
    if (command && !command->run) return complain_usage(&top, "'%s' is not available in this version", word);
    if (command) return run_command(command, count - 1, arguments + 1);
    if (!is_like_scene(word)) return unknown_command(&top, word);
    return run_command(&COMMANDS[0], count, arguments);
}

int main(int argc, char **argv) {
    heap_begin();
    int status = dispatch(argc - 1, argv + 1);
    if (fflush(stdout) == 0 && !ferror(stdout)) return status;
    fputs("vts: error: cannot write the standard output\n", stderr);
    return status == 0 ? VTS_ERROR_FILE : status;
}
