/* ESRI's ASCII grid (.asc): a header of five or six keys in any capitals, then rows from the north. */
#include "terrain/map_file.h"
#include "terrain/map_place.h"
#include "terrain/text_scan.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

typedef enum GridKey {
    GRID_COLUMNS,
    GRID_ROWS,
    GRID_X_CORNER,
    GRID_Y_CORNER,
    GRID_X_CENTRE,
    GRID_Y_CENTRE,
    GRID_SIZE,
    GRID_DX,
    GRID_DY,
    GRID_NODATA,
    GRID_KEY_COUNT
} GridKey;

typedef struct GridHeader {
    double value[GRID_KEY_COUNT];
    bool given[GRID_KEY_COUNT];
} GridHeader;

static int key_of(const char *word, size_t size) {
    static const struct {
        const char *name;
        GridKey key;
    } keys[] = {{"ncols", GRID_COLUMNS},       {"nrows", GRID_ROWS},          {"xllcorner", GRID_X_CORNER}, {"yllcorner", GRID_Y_CORNER},
                {"xllcenter", GRID_X_CENTRE},  {"yllcenter", GRID_Y_CENTRE},  {"xllcentre", GRID_X_CENTRE}, {"yllcentre", GRID_Y_CENTRE},
                {"cellsize", GRID_SIZE},       {"dx", GRID_DX},               {"dy", GRID_DY},              {"xdim", GRID_DX},
                {"ydim", GRID_DY},             {"nodata_value", GRID_NODATA}, {"nodata", GRID_NODATA}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(keys); i++)
        if (strlen(keys[i].name) == size && strncasecmp(keys[i].name, word, size) == 0) return (int)keys[i].key;
    return -1;
}

/* Up to the first word that is a number where a key could be. */
static bool read_header(TextScan *scan, GridHeader *header, StrBuf *error) {
    size_t size;
    const char *word;
    while ((word = text_scan_peek(scan, &size)) != NULL) {
        double value;
        if (size > 3 && memcmp(word, "\xEF\xBB\xBF", 3) == 0) {
            text_scan_skip(scan, 3);
            continue;
        }
        if (text_number(word, size, &value)) return true;
        int key = key_of(word, size);
        if (key < 0) return map_fail(error, "'%.*s' is no word of an ESRI grid's header", (int)size_min(size, 40), word);
        text_scan_skip(scan, size);
        word = text_scan_peek(scan, &size);
        if (!word || !text_number(word, size, &header->value[key])) return map_fail(error, "a number is missing in its header");
        text_scan_skip(scan, size);
        header->given[key] = true;
    }
    return map_fail(error, "it ends within its header");
}

static bool check_size(const GridHeader *header, size_t bytes, StrBuf *error) {
    double columns = header->value[GRID_COLUMNS], rows = header->value[GRID_ROWS];
    if (!header->given[GRID_COLUMNS] || !header->given[GRID_ROWS]) return map_fail(error, "its header says no ncols and nrows");
    if (!(columns >= 1 && rows >= 1 && columns == floor(columns) && rows == floor(rows)))
        return map_fail(error, "its header says %g x %g posts", columns, rows);
    if (columns * rows > (double)bytes / 2 + 1)
        return map_fail(error, "its header promises %.0f x %.0f posts, more than its %zu bytes can hold", columns, rows, bytes);
    return true;
}

/* The affine map by the outer edges of its cells; false where the header does not give it. */
static bool affine_of(const GridHeader *h, double x[3], double y[3]) {
    double dx = h->value[h->given[GRID_DX] ? GRID_DX : GRID_SIZE], dy = h->value[h->given[GRID_DY] ? GRID_DY : GRID_SIZE];
    bool across = h->given[GRID_X_CORNER] || h->given[GRID_X_CENTRE], along = h->given[GRID_Y_CORNER] || h->given[GRID_Y_CENTRE];
    if (!across || !along || !(dx > 0) || !(dy > 0)) return false;
    double west = h->given[GRID_X_CENTRE] ? h->value[GRID_X_CENTRE] : h->value[GRID_X_CORNER] + dx / 2;
    double south = h->given[GRID_Y_CENTRE] ? h->value[GRID_Y_CENTRE] : h->value[GRID_Y_CORNER] + dy / 2;
    x[0] = west, x[1] = dx, x[2] = 0;
    y[0] = south + dy * (h->value[GRID_ROWS] - 1), y[1] = 0, y[2] = -dy;
    return true;
}

static bool grid_read(MapFile *file, int count, float *samples, StrBuf *error) {
    size_t left = (size_t)count * (size_t)file->columns, size;
    for (; left > 0; left--) {
        double value;
        const char *word = text_scan_peek(file->state, &size);
        if (!word) return map_fail(error, "it ends before its last row");
        if (!text_number(word, size, &value)) return map_fail(error, "'%.*s' is no height", (int)size_min(size, 40), word);
        text_scan_skip(file->state, size);
        *samples++ = (float)value;
    }
    return true;
}

static void grid_close(MapFile *file) {
    TextScan *scan = file->state;
    fclose(scan->file);
    free(scan);
}

static bool open_scan(MapFile *file, size_t *bytes, StrBuf *error) {
    struct stat info;
    TextScan *scan = malloc(sizeof *scan);
    if (!scan) return map_fail(error, "not enough memory");
    scan->at = scan->size = 0;
    scan->file = stat(file->path, &info) == 0 ? fopen(file->path, "rb") : NULL;
    if (!scan->file) {
        free(scan);
        return map_fail(error, "it cannot be opened");
    }
    *bytes = (size_t)info.st_size;
    file->state = scan;
    file->close = grid_close;
    return true;
}

bool map_open_grid(MapFile *file, StrBuf *error) {
    GridHeader header = {0};
    size_t bytes = 0;
    double x[3], y[3];
    if (!open_scan(file, &bytes, error) || !read_header(file->state, &header, error) || !check_size(&header, bytes, error)) return false;
    file->format = "ESRI ASCII grid";
    file->samples = "decimal numbers";
    file->read = grid_read;
    if (header.value[GRID_COLUMNS] > MAP_LARGEST_SIDE || header.value[GRID_ROWS] > MAP_LARGEST_SIDE)
        return map_fail(error, "%.0f x %.0f posts are more than a map may have", header.value[GRID_COLUMNS], header.value[GRID_ROWS]);
    file->columns = (int)header.value[GRID_COLUMNS];
    file->rows = (int)header.value[GRID_ROWS];
    file->place.has_nodata = header.given[GRID_NODATA];
    file->place.nodata = header.value[GRID_NODATA];
    if (affine_of(&header, x, y))
        map_place_beside(file, x, y, true);
    else
        map_fail(&file->misplaced, "its header says no xllcorner, yllcorner and cellsize: place it with georeference");
    return true;
}
