#include "terrain/map_place.h"

#include "terrain/text_scan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_SIZE = 4096, MOST_TEXT = 1 << 16 };

/* The file with another suffix, as it is or in capitals. */
static FILE *open_beside(const char *path, const char *suffix) {
    char other[PATH_SIZE];
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    int stem = (int)(dot ? (size_t)(dot - path) : strlen(path));
    for (int capitals = 0; capitals < 2; capitals++) {
        int size = snprintf(other, sizeof other, "%.*s.%s", stem, path, suffix);
        if (size < 0 || size >= (int)sizeof other) return NULL;
        for (int i = stem; capitals && i < size; i++)
            if (other[i] >= 'a' && other[i] <= 'z') other[i] = (char)(other[i] - 'a' + 'A');
        FILE *file = fopen(other, "rb");
        if (file) return file;
    }
    return NULL;
}

static bool read_six(FILE *file, double out[6]) {
    TextScan *scan = malloc(sizeof *scan);
    bool good = scan != NULL;
    if (good) {
        scan->file = file;
        scan->at = scan->size = 0;
    }
    for (int i = 0; good && i < 6; i++) {
        size_t size = 0;
        const char *word = text_scan_peek(scan, &size);
        good = word && text_number(word, size, &out[i]) && isfinite(out[i]);
        if (good) text_scan_skip(scan, size);
    }
    free(scan);
    return good;
}

bool map_read_world_file(const char *path, double x[3], double y[3]) {
    char suffixes[3][16] = {"", "", "wld"};
    const char *dot = strrchr(path, '.');
    size_t size = dot ? strlen(dot + 1) : 0;
    if (size >= 2 && size < 8) {
        snprintf(suffixes[0], sizeof suffixes[0], "%c%cw", dot[1], dot[size]);
        snprintf(suffixes[1], sizeof suffixes[1], "%.8sw", dot + 1);
    }
    for (int i = 0; i < 3; i++) {
        double n[6]; /* in the file's order: x by column, y by column, x by row, y by row, x, y of the first pixel's middle */
        FILE *file = suffixes[i][0] ? open_beside(path, suffixes[i]) : NULL;
        if (!file) continue;
        bool good = read_six(file, n);
        fclose(file);
        if (!good) continue;
        x[0] = n[4], x[1] = n[0], x[2] = n[2];
        y[0] = n[5], y[1] = n[1], y[2] = n[3];
        return true;
    }
    return false;
}

typedef enum Beside { BESIDE_NONE, BESIDE_GOOD, BESIDE_BAD } Beside;

static Beside read_system(const char *path, Projection *projection, StrBuf *error) {
    FILE *file = open_beside(path, "prj");
    if (!file) return BESIDE_NONE;
    char *text = malloc(MOST_TEXT);
    size_t size = text ? fread(text, 1, MOST_TEXT, file) : 0;
    fclose(file);
    strbuf_adds(error, "the .prj file beside it: ");
    bool good = text && map_parse_system(text, size, projection, error);
    free(text);
    return good ? BESIDE_GOOD : BESIDE_BAD;
}

/* Whether posts lie as in maps of longitudes and latitudes: metres from a local origin are taken for what they are. Steps of many degrees
 * are those of maps of the globe. */
static bool looks_geographic(const MapFile *file, const double x[3], const double y[3]) {
    double post = fmax(fmax(fabs(x[1]), fabs(x[2])), fmax(fabs(y[1]), fabs(y[2])));
    bool dense = post <= 2.5 || fabs(x[1]) * file->columns >= 350;
    return dense && (x[0] != 0 || y[0] != 0) && georeference_looks_like_degrees(x, y, file->columns, file->rows);
}

void map_place_beside(MapFile *file, const double x[3], const double y[3], bool area) {
    Projection projection;
    StrBuf why = {0};
    Beside beside = read_system(file->path, &projection, &why);
    if (beside == BESIDE_NONE && file->place.has_projection) {
        projection = file->place.projection; /* a TIFF whose tags tell the system, and a world file the rest */
        beside = BESIDE_GOOD;
    }
    bool guessed = beside == BESIDE_NONE && looks_geographic(file, x, y);
    if (guessed) projection_lonlat(&projection);
    if (beside == BESIDE_BAD)
        map_fail(&file->misplaced, "%s", why.data);
    else if (beside == BESIDE_NONE && !guessed)
        map_fail(&file->misplaced, "nothing tells the system of its coordinates: place it with georeference, or with a .prj file beside it");
    else if (!georeference_from_affine(&file->place, &projection, x, y, file->columns, file->rows, area))
        map_fail(&file->misplaced, "its posts do not lie apart from each other: place it with georeference");
    else if (guessed)
        map_fail(&file->misplaced, "its coordinates are taken for longitudes and latitudes on WGS84: nothing tells their system");
    strbuf_free(&why);
}

/* By a world file; the samples' meaning stays what it is. */
static void place_by_world_file(MapFile *file) {
    double x[3], y[3];
    if (map_read_world_file(file->path, x, y))
        map_place_beside(file, x, y, true);
    else if (!file->misplaced.size)
        map_fail(&file->misplaced, "it says nothing of its place, and no world file lies beside it: place it with georeference");
}

static bool is_tiff(const char *path) {
    char head[4] = "";
    FILE *file = fopen(path, "rb");
    bool read = file && fread(head, 1, 4, file) == 4;
    if (file) fclose(file);
    return read && (memcmp(head, "II", 2) == 0 || memcmp(head, "MM", 2) == 0);
}

void map_place_picture(MapFile *file) {
    StrBuf why = {0};
    bool refused = is_tiff(file->path) && georeference_read_tiff(file->path, &file->place, NULL, &why) != GEOREFERENCE_OK;
    if (refused) map_fail(&file->misplaced, "%s", why.data ? why.data : "its place cannot be used");
    if (!refused && !file->place.placed) place_by_world_file(file);
    strbuf_free(&why);
}
