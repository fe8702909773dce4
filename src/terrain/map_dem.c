/* The USGS's ASCII .dem (Standards for Digital Elevation Models, part 2): records of 1024 characters with fields of fixed width; a header,
 * then profiles from the south to the north, the first the westernmost, which begin and end where the quadrangle does. */
#include "terrain/map_file.h"

#include "base/decimal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RECORD = 1024, FIRST_HEIGHTS = 146, MORE_HEIGHTS = 170, MOST_PROFILES = 1 << 17 };

typedef struct Profile {
    double x, y; /* of its first, southernmost post */
    size_t first, count;
} Profile;

typedef struct DemReader {
    FILE *file;
    char record[RECORD + 1];
    Profile *profiles;
    size_t profile_count, profile_capacity;
    float *heights;
    size_t height_count, height_capacity;
    double dx, dy, dz;
    /* the grid that all profiles lie in */
    double west, south;
    int columns, rows, row;
} DemReader;

/* The next record, filled up with blanks where a line ends early. False at the end. */
static bool next_record(DemReader *dem) {
    int size = 0, c;
    memset(dem->record, ' ', RECORD);
    while (size < RECORD && (c = getc(dem->file)) != EOF) {
        if (c == '\r') continue;
        if (c == '\n' && size > 0) return true;
        if (c != '\n') dem->record[size++] = (char)c;
    }
    return size > 0;
}

/* A number in a field; `otherwise` where the field is blank, NaN where it holds anything else. Exponents are written with D. */
static double field(const DemReader *dem, int begin, int width, double otherwise) {
    char text[32];
    int used = 0;
    for (int i = begin; i < begin + width && i < RECORD; i++) {
        char c = dem->record[i];
        if (c != ' ') text[used++] = c == 'D' || c == 'd' ? 'e' : c;
    }
    text[used] = '\0';
    char *end;
    double value = decimal_strtod(text, &end);
    return used == 0 ? otherwise : *end || !isfinite(value) ? (double)NAN : value;
}

/* Whole and within [low, high], or -1. */
static int field_int(const DemReader *dem, int begin, int width, int otherwise, int high) {
    double value = field(dem, begin, width, otherwise);
    return value >= 0 && value <= high && value == floor(value) ? (int)value : -1;
}

static bool grow(void **items, size_t *capacity, size_t count, size_t size) {
    if (count < *capacity) return true;
    size_t wanted = *capacity ? *capacity * 2 : 1024;
    void *grown = realloc(*items, wanted * size);
    if (!grown) return false;
    *items = grown;
    *capacity = wanted;
    return true;
}

static bool add_height(DemReader *dem, double code, double datum) {
    enum { VOID_HEIGHT = -32767, VOID_TOO = -32766 };
    if (!grow((void **)&dem->heights, &dem->height_capacity, dem->height_count, sizeof *dem->heights)) return false;
    bool none = code == VOID_HEIGHT || code == VOID_TOO || code < VOID_HEIGHT;
    dem->heights[dem->height_count++] = none ? NAN : (float)(code * dem->dz + datum);
    return true;
}

/* The profile whose first record has been read. */
static bool read_profile(DemReader *dem, StrBuf *error) {
    int count = field_int(dem, 12, 6, -1, MAP_LARGEST_SIDE);
    double x = field(dem, 24, 24, (double)NAN), y = field(dem, 48, 24, (double)NAN), datum = field(dem, 72, 24, 0);
    size_t number = dem->profile_count + 1;
    if (count < 1 || !isfinite(x + y + datum)) return map_fail(error, "its profile %zu has no valid beginning", number);
    if (!grow((void **)&dem->profiles, &dem->profile_capacity, dem->profile_count, sizeof *dem->profiles)) return map_fail(error, "not enough memory");
    dem->profiles[dem->profile_count++] = (Profile){x, y, dem->height_count, (size_t)count};
    int at = 144, left = FIRST_HEIGHTS;
    for (; count > 0; count--, left--, at += 6) {
        if (left == 0) {
            if (!next_record(dem)) return map_fail(error, "it ends within its profile %zu", number);
            at = 0;
            left = MORE_HEIGHTS;
        }
        double code = field(dem, at, 6, (double)NAN);
        if (isnan(code)) return map_fail(error, "its profile %zu ends early, or holds what is no height", number);
        if (!add_height(dem, code, datum)) return map_fail(error, "not enough memory");
    }
    return true;
}

static bool read_profiles(DemReader *dem, int promised, StrBuf *error) {
    while ((int)dem->profile_count < promised) {
        if (!next_record(dem)) return map_fail(error, "it ends after %zu of %d profiles", dem->profile_count, promised);
        if (!read_profile(dem, error)) return false;
    }
    return true;
}

/* The rectangle of posts around all profiles; at most some times larger than what they hold. */
static bool find_grid(DemReader *dem, StrBuf *error) {
    double east = -VTS_INFINITY, north = -VTS_INFINITY;
    dem->west = dem->south = VTS_INFINITY;
    for (size_t i = 0; i < dem->profile_count; i++) {
        const Profile *p = &dem->profiles[i];
        dem->west = fmin(dem->west, p->x);
        dem->south = fmin(dem->south, p->y);
        east = fmax(east, p->x);
        north = fmax(north, p->y + (double)(p->count - 1) * dem->dy);
    }
    double columns = round((east - dem->west) / dem->dx) + 1, rows = round((north - dem->south) / dem->dy) + 1;
    if (!(columns <= MAP_LARGEST_SIDE && rows <= MAP_LARGEST_SIDE && columns * rows <= 16 * (double)dem->height_count + (1 << 20)))
        return map_fail(error, "its profiles lie too far from each other");
    dem->columns = (int)columns;
    dem->rows = (int)rows;
    return true;
}

/* Rows from the north; each takes from all profiles the post that lies in it. */
static bool dem_read(MapFile *file, int count, float *samples, StrBuf *error) {
    DemReader *dem = file->state;
    (void)error;
    for (; count > 0; count--, dem->row++, samples += dem->columns) {
        int from_south = dem->rows - 1 - dem->row;
        for (int c = 0; c < dem->columns; c++) samples[c] = NAN;
        for (size_t i = 0; i < dem->profile_count; i++) {
            const Profile *p = &dem->profiles[i];
            double k = from_south - round((p->y - dem->south) / dem->dy);
            int column = int_clamp((int)round((p->x - dem->west) / dem->dx), 0, dem->columns - 1);
            if (k >= 0 && k < (double)p->count) samples[column] = dem->heights[p->first + (size_t)k];
        }
    }
    return true;
}

static void dem_close(MapFile *file) {
    DemReader *dem = file->state;
    if (dem->file) fclose(dem->file);
    free(dem->profiles);
    free(dem->heights);
    free(dem);
}

enum { SYSTEM_GEOGRAPHIC = 0, SYSTEM_UTM = 1, UNIT_FEET = 1, UNIT_METRES = 2, UNIT_ARC_SECONDS = 3, DATUM_NAD27 = 1, DATUM_WGS72 = 2 };

/* Where the grid lies, by the header, which is in the record; the system's unit is the projection's. */
static bool system_of(const DemReader *dem, Projection *projection, double *unit, StrBuf *why) {
    int system = field_int(dem, 156, 6, -1, 20), ground = field_int(dem, 528, 6, -1, 3), datum = field_int(dem, 890, 2, DATUM_NAD27, 99);
    double zone = field(dem, 162, 6, 0);
    if (datum <= DATUM_NAD27 || datum == DATUM_WGS72)
        return map_fail(why, "its datum is %s, apart from WGS84 by up to 100 m in the continental United States, and no shift is known here: convert "
                             "it (gdalwarp -t_srs EPSG:4326), or place it with georeference",
                        datum == DATUM_WGS72 ? "WGS72" : "NAD27");
    if (system == SYSTEM_GEOGRAPHIC && ground == UNIT_ARC_SECONDS) {
        *unit = 1 / 3600.0;
        projection_lonlat(projection);
        return true;
    }
    if (system == SYSTEM_UTM && (ground == UNIT_METRES || ground == UNIT_FEET) && fabs(zone) >= 1 && fabs(zone) <= 60) {
        *unit = ground == UNIT_FEET ? 0.3048 : 1;
        return projection_utm(projection, abs((int)zone), zone > 0);
    }
    return map_fail(why, "its system of coordinates (code %d) is not modelled: place it with georeference", system);
}

/* The header must be in dem->record. */
static bool read_header(MapFile *file, DemReader *dem, int *profiles, Projection *projection, double *unit, StrBuf *error) {
    dem->dx = field(dem, 816, 12, 0);
    dem->dy = field(dem, 828, 12, 0);
    dem->dz = field(dem, 840, 12, 1);
    *profiles = field_int(dem, 858, 6, -1, MOST_PROFILES);
    int heights_in = field_int(dem, 534, 6, -1, 2);
    if (!(dem->dx > 0 && dem->dy > 0 && dem->dz > 0) || *profiles < 1 || heights_in < UNIT_FEET)
        return map_fail(error, "it has no header of a USGS ASCII DEM");
    file->place.unit = heights_in == UNIT_FEET ? 0.3048 : 1;
    file->place.placed = system_of(dem, projection, unit, &file->misplaced);
    return true;
}

static void place_dem(MapFile *file, const DemReader *dem, const Projection *projection, double unit) {
    double x[3] = {dem->west * unit, dem->dx * unit, 0};
    double y[3] = {(dem->south + dem->dy * (dem->rows - 1)) * unit, 0, -dem->dy * unit};
    if (file->place.placed && !georeference_from_affine(&file->place, projection, x, y, dem->columns, dem->rows, false)) {
        file->place.placed = false;
        map_fail(&file->misplaced, "its header places it nowhere on the globe: place it with georeference");
    }
}

bool map_open_dem(MapFile *file, StrBuf *error) {
    Projection projection;
    double unit = 1;
    int profiles = 0;
    DemReader *dem = calloc(1, sizeof *dem);
    if (!dem) return map_fail(error, "not enough memory");
    file->state = dem;
    file->close = dem_close;
    file->read = dem_read;
    file->format = "USGS ASCII DEM";
    file->samples = "decimal numbers";
    dem->file = fopen(file->path, "rb");
    if (!dem->file) return map_fail(error, "it cannot be opened");
    if (!next_record(dem) || !read_header(file, dem, &profiles, &projection, &unit, error)) return error->size ? false : map_fail(error, "it is empty");
    if (!read_profiles(dem, profiles, error) || !find_grid(dem, error)) return false;
    file->columns = dem->columns;
    file->rows = dem->rows;
    place_dem(file, dem, &projection, unit);
    return true;
}
