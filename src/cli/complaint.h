/* Errors and warnings about the command line itself, as GNU programs print them. */
#ifndef VTS_CLI_COMPLAINT_H
#define VTS_CLI_COMPLAINT_H

#include "cli/settings.h"

/* "vts render: error: …" and where help is; returns VTS_ERROR_USAGE. */
int complain_usage(const Settings *settings, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* "vts render: error: …". */
void complain(const Settings *settings, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* "vts render: warning: …". */
void complain_warning(const Settings *settings, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* "vts render: error: unknown WHAT 'word' (did you mean 'best'?)"; `best` may be NULL. Returns VTS_ERROR_USAGE. */
int complain_unknown(const Settings *settings, const char *what, const char *word, const char *best);

#endif
