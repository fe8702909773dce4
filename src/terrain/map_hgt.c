/* SRTM's .hgt: big-endian numbers of 16 bits, rows from the north, posts on the edges of a square of one degree. The file says nothing
 * else: its place is its name, its size that of the file. */
#include "terrain/map_file.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { VOID_SAMPLE = -32768 };

/* "N44W072" at the beginning of the name without folders. */
static bool place_of_name(const char *path, int *south, int *west) {
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    char ns = 0, ew = 0;
    int latitude = 0, longitude = 0, used = 0;
    if (!isalpha((unsigned char)name[0]) || !isdigit((unsigned char)name[1])) return false;
    if (sscanf(name, "%c%2d%c%3d%n", &ns, &latitude, &ew, &longitude, &used) != 4) return false;
    ns = (char)toupper((unsigned char)ns);
    ew = (char)toupper((unsigned char)ew);
    if (!strchr("NS", ns) || !strchr("EW", ew) || used != 7 || latitude > 90 || longitude > 180) return false;
    *south = ns == 'N' ? latitude : -latitude;
    *west = ew == 'E' ? longitude : -longitude;
    return *south >= -90 && *south < 90;
}

/* Square tiles of any number of posts; in high latitudes, where meridians are close, tiles of the usual numbers of rows with every
 * second, third … column. */
static bool size_of_count(size_t count, int *columns, int *rows) {
    static const int usual[] = {3601, 1201};
    int side = (int)sqrt((double)count);
    for (int s = int_max(side - 1, 1); s <= side + 1; s++)
        if ((size_t)s * (size_t)s == count) {
            *columns = *rows = s;
            return true;
        }
    for (size_t i = 0; i < VTS_ARRAY_COUNT(usual); i++) {
        size_t across = count / (size_t)usual[i];
        if (across * (size_t)usual[i] != count || across < 2 || (size_t)(usual[i] - 1) % (across - 1) != 0) continue;
        *columns = (int)across;
        *rows = usual[i];
        return true;
    }
    return false;
}

static bool hgt_read(MapFile *file, int count, float *samples, StrBuf *error) {
    unsigned char bytes[2 * 512];
    size_t left = (size_t)count * (size_t)file->columns;
    while (left > 0) {
        size_t now = size_min(left, sizeof bytes / 2);
        if (fread(bytes, 2, now, file->state) != now) return map_fail(error, "it cannot be read to its end");
        for (size_t i = 0; i < now; i++) {
            int sample = bytes[2 * i] << 8 | bytes[2 * i + 1];
            *samples++ = (float)(sample > 32767 ? sample - 65536 : sample);
        }
        left -= now;
    }
    return true;
}

static void hgt_close(MapFile *file) { fclose(file->state); }

static void place_hgt(MapFile *file) {
    int south, west;
    Projection lonlat;
    if (!place_of_name(file->path, &south, &west)) {
        map_fail(&file->misplaced, "its place is told by its name, such as N44W072.hgt, or by georeference");
        return;
    }
    projection_lonlat(&lonlat);
    georeference_from_corners(&file->place, &lonlat, (double[]){west, south}, (double[]){west + 1, south + 1}, file->columns, file->rows, false);
}

bool map_open_hgt(MapFile *file, StrBuf *error) {
    struct stat info;
    if (stat(file->path, &info) != 0) return map_fail(error, "it cannot be read");
    size_t bytes = (size_t)info.st_size;
    if (bytes % 2 != 0 || !size_of_count(bytes / 2, &file->columns, &file->rows))
        return map_fail(error, "its %zu bytes are no square of posts of two bytes: it is cut short, or no .hgt file", bytes);
    file->state = fopen(file->path, "rb");
    if (!file->state) return map_fail(error, "it cannot be opened");
    file->format = "SRTM .hgt";
    file->samples = "16-bit signed";
    file->small_samples = true;
    file->read = hgt_read;
    file->close = hgt_close;
    place_hgt(file);
    return true;
}
