#include "cli/complaint.h"

#include <stdarg.h>
#include <stdio.h>

static void print(const Settings *settings, const char *kind, const char *format, va_list args) {
    fprintf(stderr, "%s: %s: ", settings->program, kind);
    vfprintf(stderr, format, args);
    fputc('\n', stderr);
}

static void point_to_help(const Settings *settings) {
    fprintf(stderr, "Try '%s --help'.\n", settings->program);
}

int complain_usage(const Settings *settings, const char *format, ...) {
    va_list args;
    va_start(args, format);
    print(settings, "error", format, args);
    va_end(args);
    point_to_help(settings);
    return VTS_ERROR_USAGE;
}

void complain(const Settings *settings, const char *format, ...) {
    va_list args;
    va_start(args, format);
    print(settings, "error", format, args);
    va_end(args);
}

void complain_warning(const Settings *settings, const char *format, ...) {
    va_list args;
    va_start(args, format);
    print(settings, "warning", format, args);
    va_end(args);
}

int complain_unknown(const Settings *settings, const char *what, const char *word, const char *best) {
    if (best) return complain_usage(settings, "unknown %s '%s' (did you mean '%s'?)", what, word, best);
    return complain_usage(settings, "unknown %s '%s'", what, word);
}
