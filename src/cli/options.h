/* The options of vts: one table, which parsing and --help both read. */
#ifndef VTS_CLI_OPTIONS_H
#define VTS_CLI_OPTIONS_H

#include "cli/settings.h"

#include <stdio.h>

/* Bits: which sub-commands an option belongs to. */
enum {
    COMMAND_RENDER = 1,
    COMMAND_CHECK = 2,
    COMMAND_RUN = 4,
    COMMAND_COMPARE = 8,
    COMMAND_REFERENCE = 16,
    COMMAND_TEXEL = 32,
    COMMAND_CHART = 64,
    COMMAND_INFO = 128,
    COMMAND_STITCH = 256,
    COMMAND_FARM = 512, /* beside COMMAND_RENDER, whose options it hands on: these are its own */
    COMMAND_ALL = 119, /* that take scenes */
    COMMAND_DRAW = 49 /* that make pictures of them */
};

/* Reads the arguments of `command` (one bit), also in POV-Ray's spelling. 0, or VTS_ERROR_USAGE or VTS_ERROR_FILE after
 * saying why on stderr. */
int options_parse(Settings *settings, unsigned command, int count, char *const *arguments);

/* The table as users see it. */
void options_print_help(FILE *stream, unsigned command);

#endif
