#include "terrain/map_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

bool map_fail(StrBuf *error, const char *format, ...) {
    va_list args;
    va_start(args, format);
    if (error) strbuf_vaddf(error, format, args);
    va_end(args);
    return false;
}

typedef bool OpenMap(MapFile *file, StrBuf *error);

static bool is_tiff(const char *head, size_t size) {
    return size >= 4 && (memcmp(head, "II*\0", 4) == 0 || memcmp(head, "MM\0*", 4) == 0 || memcmp(head, "II+\0", 4) == 0 ||
                         memcmp(head, "MM\0+", 4) == 0);
}

/* Keys may come in any order, but no grid is without one of these in front. */
static bool is_grid(const char *head, size_t size) {
    static const char *const keys[] = {"ncols", "nrows", "xllcorner", "yllcorner", "xllcenter", "yllcenter", "cellsize"};
    size_t at = 0;
    while (at < size && (strchr(" \t\r\n", head[at]) || (unsigned char)head[at] >= 0x80)) at++; /* some begin with a byte order mark */
    for (size_t i = 0; i < VTS_ARRAY_COUNT(keys); i++)
        if (size - at > strlen(keys[i]) && strncasecmp(head + at, keys[i], strlen(keys[i])) == 0) return true;
    return false;
}

static bool has_suffix(const char *path, const char *suffix) {
    size_t size = strlen(path), end = strlen(suffix);
    return size > end && strcasecmp(path + size - end, suffix) == 0;
}

static OpenMap *reader_of(const char *path, const char *head, size_t size) {
    static const struct {
        const char *suffix;
        OpenMap *open;
    } by_name[] = {{".hgt", map_open_hgt}, {".dem", map_open_dem}, {".asc", map_open_grid}, {".tif", map_open_tiff}, {".tiff", map_open_tiff}};
    if (is_tiff(head, size)) return map_open_tiff;
    if (is_grid(head, size)) return map_open_grid;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(by_name); i++)
        if (has_suffix(path, by_name[i].suffix)) return by_name[i].open;
    return map_open_picture;
}

/* The first bytes; -1 with a line of text when there is no such file to read. */
static long read_head(const char *path, char *head, size_t size, StrBuf *error) {
    struct stat info;
    bool there = stat(path, &info) == 0;
    FILE *file = there && S_ISREG(info.st_mode) ? fopen(path, "rb") : NULL;
    size_t got = file ? fread(head, 1, size, file) : 0;
    if (there && !S_ISREG(info.st_mode))
        map_fail(error, S_ISDIR(info.st_mode) ? "it is a folder" : "it is no regular file");
    else if (!file)
        map_fail(error, "%s", strerror(errno));
    else if (got == 0)
        map_fail(error, "it is empty");
    if (file) fclose(file);
    return got ? (long)got : -1;
}

bool map_file_open(MapFile *file, const char *path, StrBuf *error) {
    char head[256];
    *file = (MapFile){.path = path};
    georeference_init(&file->place);
    long size = read_head(path, head, sizeof head, error);
    if (size < 0) return false;
    bool opened = reader_of(path, head, (size_t)size)(file, error);
    if (opened && (file->columns < 1 || file->rows < 1 || file->columns > MAP_LARGEST_SIDE || file->rows > MAP_LARGEST_SIDE ||
                   (size_t)file->columns * (size_t)file->rows > MAP_LARGEST_COUNT))
        opened = map_fail(error, "%d x %d posts are none, or more than a map may have", file->columns, file->rows);
    if (!opened) map_file_close(file);
    return opened;
}

static float known_or_nan(const MapFile *file, const double *nodata, float sample) {
    enum { LEAST_SHORT = -32768 };
    bool none = !(fabsf(sample) < 1e30f) || (file->place.has_nodata && sample == (float)file->place.nodata) ||
                (nodata && sample == (float)*nodata) || (file->small_samples && sample == LEAST_SHORT);
    return none ? NAN : sample;
}

bool map_file_read(MapFile *file, int count, const double *nodata, float *samples, StrBuf *error) {
    if (!file->read(file, count, samples, error)) return false;
    size_t all = (size_t)count * (size_t)file->columns;
    for (size_t i = 0; i < all; i++) samples[i] = known_or_nan(file, nodata, samples[i]);
    return true;
}

void map_file_close(MapFile *file) {
    if (file->close) file->close(file);
    strbuf_free(&file->misplaced);
    *file = (MapFile){0};
}
