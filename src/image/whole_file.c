#define _XOPEN_SOURCE 700 /* realpath() */

#include "image/whole_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { NAME_ATTEMPTS = 1000 };
#define MARK ".tmp-vts-"

static const char *error_text(int number, char *buffer, size_t size) {
    switch (number) {
    case ENOENT: return "no such file or folder";
    case ENOTDIR: return "a part of the path is not a folder";
    case EISDIR: return "it is a folder";
    case EEXIST: return "it is not a plain file";
    case EACCES: return "no permission";
    case EROFS: return "the file system is read-only";
    case ENOSPC: return "the disk is full";
    case EDQUOT: return "the disk quota is used up";
    case EFBIG: return "the file grows past what is allowed";
    case ENAMETOOLONG: return "the name is too long";
    case ENOMEM: return "not enough memory";
    default: return strerror_r(number, buffer, size) == 0 ? buffer : "unknown error";
    }
}

static bool fail(StrBuf *error, const char *verb, const char *path, int number) {
    char buffer[128];
    if (error)
        strbuf_addf(error, "cannot %s '%s': %s", verb, path, error_text(number, buffer, sizeof buffer));
    return false;
}

/* The folder part of a path in `folder`, "." when it has none. */
static bool folder_of(const char *path, char *folder, size_t size) {
    const char *slash = strrchr(path, '/');
    size_t length = slash ? size_max((size_t)(slash - path), 1) : 1;
    if (length >= size) return false;
    memcpy(folder, slash ? path : ".", length);
    folder[length] = '\0';
    return true;
}

bool whole_file_can_replace(const char *path, StrBuf *error) {
    char folder[PATH_MAX];
    struct stat info;
    const char *slash = strrchr(path, '/');
    if (!*(slash ? slash + 1 : path)) return fail(error, "write", path, EISDIR);
    if (!folder_of(path, folder, sizeof folder)) return fail(error, "write", path, ENAMETOOLONG);
    if (stat(folder, &info) != 0) {
        int number = errno;
        if (number != ENOENT) return fail(error, "write", path, number);
        if (error) strbuf_addf(error, "cannot write '%s': no such folder '%s'", path, folder);
        return false;
    }
    if (!S_ISDIR(info.st_mode)) return fail(error, "write", path, ENOTDIR);
    if (faccessat(AT_FDCWD, folder, W_OK | X_OK, AT_EACCESS) != 0) return fail(error, "write", path, errno);
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode))
        return fail(error, "write", path, S_ISDIR(info.st_mode) ? EISDIR : EEXIST);
    return true;
}

/* Names of unfinished files say whose they are: a number for the machine, and the process. */
static unsigned machine_number(void) {
    char name[256] = "";
    unsigned number = 2166136261u; /* FNV-1a */
    if (gethostname(name, sizeof name - 1) != 0) return 0;
    for (const char *c = name; *c; c++) number = (number ^ (unsigned char)*c) * 16777619u;
    return number;
}

static bool is_leftover(const char *tail) {
    unsigned machine;
    long process;
    int attempt;
    return sscanf(tail, "%8x-%ld-%d", &machine, &process, &attempt) == 3 && machine == machine_number() && process > 1 &&
           kill((pid_t)process, 0) != 0 && errno == ESRCH;
}

/* What a process that was killed on this machine has left of the same file. */
static void remove_leftovers(const char *path) {
    char folder[PATH_MAX];
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    size_t length = strlen(base);
    DIR *entries = folder_of(path, folder, sizeof folder) ? opendir(folder) : NULL;
    for (struct dirent *entry; entries && (entry = readdir(entries)) != NULL;) {
        const char *tail = entry->d_name + length;
        if (strncmp(entry->d_name, base, length) == 0 && strncmp(tail, MARK, sizeof MARK - 1) == 0 && is_leftover(tail + sizeof MARK - 1))
            unlinkat(dirfd(entries), entry->d_name, 0);
    }
    if (entries) closedir(entries);
}

/* A new file beside `path`, open for writing; its name in `name`. -1 and errno on failure. */
static int open_beside(const char *path, char *name, size_t size) {
    for (int attempt = 0; attempt < NAME_ATTEMPTS; attempt++) {
        int length = snprintf(name, size, "%s" MARK "%08x-%ld-%d", path, machine_number(), (long)getpid(), attempt);
        if (length < 0 || (size_t)length >= size) {
            errno = ENAMETOOLONG;
            return -1;
        }
        int file = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0 || errno != EEXIST) return file;
    }
    return -1;
}

/* 0, or the errno of what failed. */
static int write_all(int file, const unsigned char *data, size_t size) {
    while (size > 0) {
        ssize_t written = write(file, data, size_min(size, (size_t)1 << 30));
        if (written < 0) {
            if (errno == EINTR) continue;
            return errno;
        }
        if (written == 0) return ENOSPC;
        data += written;
        size -= (size_t)written;
    }
    return 0;
}

bool whole_file_replace(const char *path, const void *data, size_t size, StrBuf *error) {
    return whole_file_replace_pieces(path, &(FilePiece){data, size}, 1, error);
}

bool whole_file_replace_pieces(const char *path, const FilePiece *pieces, size_t count, StrBuf *error) {
    char temporary[PATH_MAX], target[PATH_MAX];
    struct stat info;
    if (!whole_file_can_replace(path, error)) return false;
    bool is_link = lstat(path, &info) == 0 && S_ISLNK(info.st_mode);
    const char *place = is_link && realpath(path, target) ? target : path;
    remove_leftovers(place);
    int file = open_beside(place, temporary, sizeof temporary);
    if (file < 0) return fail(error, "write", path, errno);
    int number = 0;
    for (size_t i = 0; i < count && number == 0; i++) number = write_all(file, pieces[i].data, pieces[i].size);
    if (close(file) != 0 && number == 0) number = errno;
    if (number == 0 && rename(temporary, place) != 0) number = errno;
    if (number == 0) return true;
    unlink(temporary);
    return fail(error, "write", path, number);
}

static unsigned char *read_stream(FILE *stream, size_t capacity, size_t *size) {
    unsigned char *data = malloc(capacity);
    *size = 0;
    while (data) {
        *size += fread(data + *size, 1, capacity - *size, stream);
        if (*size < capacity) return data;
        unsigned char *larger = capacity > SIZE_MAX / 2 ? NULL : realloc(data, capacity * 2);
        if (!larger) free(data);
        data = larger;
        capacity *= 2;
    }
    errno = ENOMEM;
    return NULL;
}

unsigned char *whole_file_read(const char *path, size_t *size, StrBuf *error) {
    struct stat info;
    FILE *stream = fopen(path, "rb");
    if (!stream || fstat(fileno(stream), &info) != 0 || S_ISDIR(info.st_mode)) {
        int number = stream ? EISDIR : errno;
        if (stream) fclose(stream);
        fail(error, "read", path, number);
        return NULL;
    }
    /* One more than the size, so that the end shows; pipes tell no size and grow. */
    unsigned char *data = read_stream(stream, info.st_size > 0 ? (size_t)info.st_size + 1 : 65536, size);
    int number = !data ? ENOMEM : ferror(stream) ? EIO : 0;
    fclose(stream);
    if (number == 0) return data;
    free(data);
    fail(error, "read", path, number);
    return NULL;
}

const unsigned char *whole_file_read_into(Arena *arena, const char *path, size_t most, size_t *size) {
    struct stat info;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode) || (uint64_t)info.st_size > most) return NULL;
    *size = (size_t)info.st_size;
    unsigned char *bytes = arena_push(arena, *size);
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    bool whole = fread(bytes, 1, *size, file) == *size;
    fclose(file);
    return whole ? bytes : NULL;
}
