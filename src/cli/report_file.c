#include "cli/report_file.h"

#include "cli/complaint.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool fail(const Settings *settings, const char *path) {
    complain(settings, "cannot write '%s': %s", path, strerror(errno));
    return false;
}

static bool is_standard_output(const char *path) { return strcmp(path, "-") == 0; }

/* Pipes and devices are written to as they are. */
static bool is_special(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && !S_ISREG(info.st_mode);
}

bool report_file_possible(const Settings *settings, const char *path) {
    char folder[PATH_MAX];
    struct stat info;
    if (is_standard_output(path)) return true;
    if (stat(path, &info) == 0) {
        errno = EISDIR;
        if (S_ISDIR(info.st_mode)) return fail(settings, path);
        if (!S_ISREG(info.st_mode)) return access(path, W_OK) == 0 || fail(settings, path);
    }
    const char *slash = strrchr(path, '/');
    int length = slash ? (int)(slash - path) + 1 : 1;
    if (length >= PATH_MAX) return fail(settings, path);
    snprintf(folder, sizeof folder, "%.*s", length, slash ? path : ".");
    return access(folder, W_OK | X_OK) == 0 || fail(settings, path);
}

static bool write_text(FILE *stream, const char *text) {
    size_t size = strlen(text);
    bool done = fwrite(text, 1, size, stream) == size;
    if (done && (size == 0 || text[size - 1] != '\n')) done = fputc('\n', stream) != EOF;
    return fflush(stream) == 0 && done;
}

bool report_file_write(const Settings *settings, const char *path, const char *text) {
    char temporary[PATH_MAX];
    if (is_standard_output(path)) return write_text(stdout, text) || fail(settings, "the standard output");
    bool special = is_special(path);
    int length = special ? snprintf(temporary, sizeof temporary, "%s", path)
                         : snprintf(temporary, sizeof temporary, "%s.tmp-vts-%ld", path, (long)getpid());
    errno = ENAMETOOLONG;
    if (length < 0 || (size_t)length >= sizeof temporary) return fail(settings, path);
    FILE *stream = fopen(temporary, "w");
    if (!stream) return fail(settings, path);
    bool done = write_text(stream, text);
    done = fclose(stream) == 0 && done;
    if (special) return done || fail(settings, path);
    if (done && rename(temporary, path) == 0) return true;
    int number = errno;
    unlink(temporary);
    errno = number;
    return fail(settings, path);
}
