#include "volume/grid_file.h"

#include "image/whole_file.h"

#include <string.h>

enum { DF3_HEADER = 6 };

static bool refuse(StrBuf *error, const char *why) {
    if (error) strbuf_adds(error, why);
    return false;
}

static double whole_number(const unsigned char *bytes, size_t width, bool big) {
    double value = 0;
    for (size_t k = 0; k < width; k++) value = 256 * value + bytes[big ? k : width - 1 - k];
    return value;
}

static float share(const unsigned char *bytes, size_t width, bool big) {
    static const double most[] = {0, 255, 65535, 0, 4294967295.};
    return (float)(whole_number(bytes, width, big) / most[width]);
}

static float float_number(const unsigned char *bytes, bool big, bool *sound) {
    uint32_t bits = 0;
    float value;
    for (int k = 0; k < 4; k++) bits = bits << 8 | bytes[big ? k : 3 - k];
    memcpy(&value, &bits, sizeof value);
    *sound = isfinite(value) && value >= 0;
    return *sound ? value : 0;
}

/* The product of the sides, or 0 when it is none or past `most`. */
static size_t cell_count(const int size[3], size_t most) {
    size_t count = 1;
    for (int k = 0; k < 3; k++) {
        if (size[k] < 1 || (size_t)size[k] > most / count) return 0;
        count *= (size_t)size[k];
    }
    return count;
}

static void finish(DensityGrid *out, const int size[3], const float *values, const unsigned char *bytes, size_t byte_count) {
    *out = (DensityGrid){.hash = hash_begin(0x646633), .values = values};
    for (int k = 0; k < 3; k++) {
        out->size[k] = size[k];
        hash_add_u64(&out->hash, (uint64_t)size[k]);
    }
    hash_add(&out->hash, bytes, byte_count);
}

bool grid_decode_df3(const unsigned char *bytes, size_t size, Arena *arena, DensityGrid *out, StrBuf *error) {
    int sides[3];
    if (size < DF3_HEADER) return refuse(error, "it ends within its header");
    for (int k = 0; k < 3; k++) sides[k] = bytes[2 * k] * 256 + bytes[2 * k + 1];
    size_t count = cell_count(sides, size - DF3_HEADER), width = count ? (size - DF3_HEADER) / count : 0;
    if (width * count != size - DF3_HEADER || (width != 1 && width != 2 && width != 4))
        return refuse(error, "its size is not what its header says");
    float *values = arena_new_array(arena, float, count);
    for (size_t i = 0; i < count; i++) values[i] = share(bytes + DF3_HEADER + i * width, width, true);
    finish(out, sides, values, bytes, size);
    return true;
}

bool grid_decode_raw(const unsigned char *bytes, size_t size, const GridRaw *raw, Arena *arena, DensityGrid *out, StrBuf *error) {
    static const size_t widths[] = {1, 2, 4};
    size_t bad = 0, width = widths[raw->sample], count = cell_count(raw->size, size / width);
    if (count == 0 || count * width != size) return refuse(error, "its size is not what the sides and the kind of number make");
    float *values = arena_new_array(arena, float, count);
    for (size_t i = 0; i < count; i++) {
        const unsigned char *at = bytes + i * width;
        bool sound = true;
        values[i] = raw->sample == GRID_FLOAT ? float_number(at, raw->big, &sound) : share(at, width, raw->big);
        if (!sound && !bad) bad = i + 1;
    }
    finish(out, raw->size, values, bytes, size);
    out->bad = bad;
    hash_add_u64(&out->hash, (uint64_t)raw->sample << 1 | raw->big);
    return true;
}

bool grid_load(const char *path, const GridRaw *raw, Arena *arena, DensityGrid *out, StrBuf *error) {
    size_t size = 0;
    const unsigned char *bytes = whole_file_read_into(arena, path, SIZE_MAX, &size);
    if (!bytes) return refuse(error, "it cannot be read");
    return raw ? grid_decode_raw(bytes, size, raw, arena, out, error) : grid_decode_df3(bytes, size, arena, out, error);
}
