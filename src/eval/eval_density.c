/* Density files of POV-Ray (.df3): three big-endian 16-bit sizes, then that many numbers of 1, 2 or 4 bytes, x fastest. */
#include "eval/build_pattern.h"

#include <stdio.h>
#include <sys/stat.h>

enum { HEADER = 6 };

/* The file in the arena, allocated before it is opened: running out of memory leaves no file open. */
static const unsigned char *read_file(Arena *arena, const char *path, size_t *size) {
    struct stat info;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode) || info.st_size < HEADER) return NULL;
    *size = (size_t)info.st_size;
    unsigned char *bytes = arena_push(arena, *size);
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    bool whole = fread(bytes, 1, *size, file) == *size;
    fclose(file);
    return whole ? bytes : NULL;
}

static float number(const unsigned char *bytes, size_t width) {
    static const double most[] = {0, 255, 65535, 0, 4294967295.};
    double value = 0;
    for (size_t k = 0; k < width; k++) value = 256 * value + bytes[k];
    return (float)(value / most[width]);
}

static bool read_grid(Arena *arena, const unsigned char *bytes, size_t size, DensityGrid *grid) {
    size_t count = 1;
    for (int k = 0; k < 3; k++) {
        grid->size[k] = bytes[2 * k] * 256 + bytes[2 * k + 1];
        count *= (size_t)grid->size[k];
    }
    size_t width = count ? (size - HEADER) / count : 0;
    if (width * count != size - HEADER || (width != 1 && width != 2 && width != 4)) return false;
    float *values = arena_new_array(arena, float, count);
    for (size_t i = 0; i < count; i++) values[i] = number(bytes + HEADER + i * width, width);
    grid->values = values;
    grid->hash = hash_begin(0x646633);
    hash_add(&grid->hash, bytes, size);
    return true;
}

const DensityGrid *density_load(const BuildContext *context, const char *name, Span span) {
    const char *path = data_file_find(context, "density file", name, span);
    if (!path) return NULL;
    size_t size = 0;
    const unsigned char *bytes = read_file(context->arena, path, &size);
    DensityGrid *grid = arena_new(context->arena, DensityGrid);
    if (bytes && read_grid(context->arena, bytes, size, grid)) return grid;
    diag_error(context->diags, span, "'%s' cannot be read as a density file (df3)", name);
    return NULL;
}
