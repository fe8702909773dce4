#include "terrain/geoid.h"

#include "image/whole_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { HEADER = 40, PATH_SIZE = 4096, MOST_BYTES = 1 << 28 };

static uint64_t big_endian(const unsigned char *bytes, int count) {
    uint64_t value = 0;
    for (int i = 0; i < count; i++) value = value << 8 | bytes[i];
    return value;
}

static double double_at(const unsigned char *bytes) {
    uint64_t bits = big_endian(bytes, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static float float_at(const unsigned char *bytes) {
    uint32_t bits = (uint32_t)big_endian(bytes, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value > -88.88f && value < -88.87f ? NAN : fabsf(value) < 1000 ? value : NAN; /* -88.8888 says "not known" */
}

static bool refuse(StrBuf *error, const char *path, const char *why) {
    strbuf_addf(error, "'%s': %s", path, why);
    return false;
}

static bool decode(Geoid *geoid, const char *path, const unsigned char *bytes, size_t size, Arena *arena, StrBuf *error) {
    if (size < HEADER) return refuse(error, path, "it ends within its header");
    *geoid = (Geoid){.south = double_at(bytes), .west = double_at(bytes + 8), .step_north = double_at(bytes + 16), .step_east = double_at(bytes + 24)};
    uint64_t rows = big_endian(bytes + 32, 4), columns = big_endian(bytes + 36, 4), count = (size - HEADER) / 4;
    if (rows < 2 || columns < 2 || columns > count || rows != count / columns || rows * columns * 4 != size - HEADER)
        return refuse(error, path, "its size is not what its header says: it is no .gtx file, or cut short");
    if (!(geoid->step_north > 0 && geoid->step_east > 0 && geoid->step_north <= 90 && geoid->step_east <= 180 && fabs(geoid->south) <= 90 &&
          fabs(geoid->west) <= 720))
        return refuse(error, path, "its header makes no grid");
    float *nodes = arena_new_array(arena, float, (size_t)count);
    for (size_t i = 0; i < count; i++) nodes[i] = float_at(bytes + HEADER + 4 * i);
    geoid->columns = (int)columns;
    geoid->rows = (int)rows;
    geoid->around = fabs((double)columns * geoid->step_east - 360) < geoid->step_east / 2;
    geoid->nodes = nodes;
    geoid->path = arena_strdup(arena, path);
    geoid->hash = hash_begin(0x677478);
    hash_add(&geoid->hash, bytes, size);
    return true;
}

static bool is_file(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode);
}

static bool found_in(const char *folder, const char *name, char path[PATH_SIZE]) {
    static const char *const suffixes[] = {"", ".gtx"};
    for (int i = 0; i < 2; i++) {
        int size = folder ? snprintf(path, PATH_SIZE, "%s/%s%s", folder, name, suffixes[i]) : snprintf(path, PATH_SIZE, "%s%s", name, suffixes[i]);
        if (size > 0 && size < PATH_SIZE && is_file(path)) return true;
    }
    return false;
}

/* PROJ looks in the folder that $PROJ_DATA or $PROJ_LIB names, and where it was installed. */
static bool find(const char *name, const char *const *folders, size_t folder_count, char path[PATH_SIZE]) {
    const char *const proj[] = {getenv("PROJ_DATA"), getenv("PROJ_LIB"), "/usr/share/proj", "/usr/local/share/proj"};
    for (size_t i = 0; i < folder_count; i++)
        if (found_in(folders[i], name, path)) return true;
    if (strchr(name, '/')) return found_in(NULL, name, path);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(proj); i++)
        if (proj[i] && found_in(proj[i], name, path)) return true;
    return false;
}

bool geoid_load(Geoid *geoid, const char *name, const char *const *folders, size_t folder_count, Arena *arena, StrBuf *error) {
    char path[PATH_SIZE];
    size_t size = 0;
    if (!name[0] || !find(name, folders, folder_count, path)) {
        strbuf_addf(error, "the geoid '%s' is not found: Debian has 'egm96_15' in its package proj-data; other .gtx files are named by their path", name);
        return false;
    }
    const unsigned char *bytes = whole_file_read_into(arena, path, MOST_BYTES, &size);
    return bytes ? decode(geoid, path, bytes, size, arena, error) : refuse(error, path, "it cannot be read");
}

bool geoid_undulation(const Geoid *geoid, double latitude, double longitude, double *out) {
    double x = (longitude - geoid->west) / geoid->step_east, y = (latitude - geoid->south) / geoid->step_north;
    double turn = 360 / geoid->step_east;
    x -= turn * floor((x + 1e-9) / turn);
    int columns = geoid->columns, last = geoid->around ? columns : columns - 1;
    if (!(y >= -1e-9 && y <= geoid->rows - 1 + 1e-9 && x <= last + 1e-9)) return false;
    int c = int_clamp((int)x, 0, last - 1), r = int_clamp((int)y, 0, geoid->rows - 2);
    double u = double_clamp(x - c, 0, 1), v = double_clamp(y - r, 0, 1);
    const float *row = geoid->nodes + (size_t)r * (size_t)columns;
    int next = (c + 1) % columns;
    double low = (1 - u) * (double)row[c] + u * (double)row[next];
    double high = (1 - u) * (double)row[columns + c] + u * (double)row[columns + next];
    *out = (1 - v) * low + v * high;
    return isfinite(*out);
}
