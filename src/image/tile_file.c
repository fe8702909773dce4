#include "image/tile_file.h"

#include "base/hash.h"
#include "base/stopwatch.h"
#include "base/strbuf.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { TILE_FILE_VERSION = 1, LARGEST_TILE = 1 << 22 };

typedef struct Header {
    char magic[8];
    uint32_t version, tiles;
    uint64_t picture;
    int32_t region[4], channels;
    uint32_t spare;
} Header;

/* Before the samples of a tile. */
typedef struct Record {
    uint32_t tile, count;
    uint64_t checksum; /* of both, and of the samples */
} Record;

struct TileFile {
    pthread_mutex_t lock;
    char *path;
    Header header;
    int file;      /* -1: not made yet */
    off_t size;    /* of what is whole */
    bool full;     /* nothing more can be written */
    double begins; /* to be written */
    uint32_t tiles, taken;
    off_t places[]; /* of the tiles' records; 0: not there */
};

static uint64_t checksum_of(const Record *record, const float *samples) {
    Hash128 hash = hash_begin(TILE_FILE_VERSION);
    hash_add_u64(&hash, (uint64_t)record->tile << 32 | record->count);
    hash_add(&hash, samples, record->count * sizeof *samples);
    return hash.lo;
}

static Header header_of(const TileFileKey *key) {
    Header header = {.magic = "vtstile",
                     .version = TILE_FILE_VERSION,
                     .tiles = key->tiles,
                     .picture = key->picture,
                     .channels = key->channels};
    memcpy(header.region, key->region, sizeof header.region);
    return header;
}

static bool write_at(int file, const void *data, size_t size, off_t at) {
    for (const char *bytes = data; size > 0;) {
        ssize_t n = pwrite(file, bytes, size, at);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        bytes += n, at += n;
        size -= (size_t)n;
    }
    return true;
}

static bool read_at(int file, void *data, size_t size, off_t at) {
    for (char *bytes = data; size > 0;) {
        ssize_t n = pread(file, bytes, size, at);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        bytes += n, at += n;
        size -= (size_t)n;
    }
    return true;
}

/* Under the lock, or before others know of the file. */
static bool append(TileFile *t, uint32_t tile, const float *samples, size_t count) {
    Record record = {.tile = tile, .count = (uint32_t)count};
    record.checksum = checksum_of(&record, samples);
    if (!write_at(t->file, &record, sizeof record, t->size) ||
        !write_at(t->file, samples, count * sizeof *samples, t->size + (off_t)sizeof record))
        return false;
    t->places[tile] = t->size;
    t->size += (off_t)(sizeof record + count * sizeof *samples);
    return true;
}

/* The samples of the record there, which the caller frees; NULL when it is not whole. */
static float *read_record(int file, off_t at, Record *record) {
    if (!read_at(file, record, sizeof *record, at) || record->count > LARGEST_TILE) return NULL;
    float *samples = malloc(record->count * sizeof *samples + 1);
    if (samples && read_at(file, samples, record->count * sizeof *samples, at + (off_t)sizeof *record) &&
        checksum_of(record, samples) == record->checksum)
        return samples;
    free(samples);
    return NULL;
}

/* A run that still writes its own file, or one that is killed now, does not meet ours: it is a copy. */
static void take_over(TileFile *t, int old, const Header *header) {
    Header found;
    if (!read_at(old, &found, sizeof found, 0) || memcmp(&found, header, sizeof found) != 0) return;
    Record record;
    float *samples;
    for (off_t at = sizeof found; (samples = read_record(old, at, &record)) != NULL;
         at += (off_t)(sizeof record + record.count * sizeof *samples)) {
        bool wanted = record.tile < t->tiles && !t->places[record.tile] && !t->full;
        if (wanted) t->full = !append(t, record.tile, samples, record.count);
        t->taken += wanted && !t->full;
        free(samples);
    }
}

/* Its own name until what was there is taken over. */
static bool make(TileFile *t, bool resume) {
    StrBuf name = {0};
    strbuf_addf(&name, "%s.new", t->path);
    t->file = open(name.data, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    int old = resume && t->file >= 0 ? open(t->path, O_RDONLY | O_CLOEXEC) : -1;
    bool good = t->file >= 0 && write_at(t->file, &t->header, sizeof t->header, 0);
    t->size = sizeof t->header;
    if (good && old >= 0) take_over(t, old, &t->header);
    if (old >= 0) close(old);
    good = good && rename(name.data, t->path) == 0;
    if (!good && t->file >= 0) {
        unlink(name.data);
        close(t->file);
        t->file = -1;
    }
    strbuf_free(&name);
    return good;
}

TileFile *tile_file_open(const char *picture_path, const TileFileKey *key, bool resume, double delay) {
    TileFile *t = calloc(1, sizeof *t + key->tiles * sizeof *t->places);
    StrBuf path = {0};
    if (!t) return NULL;
    strbuf_addf(&path, "%s.tiles-vts", picture_path);
    *t = (TileFile){.path = path.data, .header = header_of(key), .file = -1, .begins = stopwatch_wall() + delay, .tiles = key->tiles};
    pthread_mutex_init(&t->lock, NULL);
    if (!resume) unlink(t->path); /* most pictures are finished before one is written */
    if (!resume || make(t, true)) return t;
    tile_file_close(t, false);
    return NULL;
}

uint32_t tile_file_taken(const TileFile *file) { return file ? file->taken : 0; }

bool tile_file_read(TileFile *t, uint32_t tile, float *samples, size_t count) {
    if (tile >= t->tiles) return false;
    pthread_mutex_lock(&t->lock);
    off_t at = t->places[tile];
    pthread_mutex_unlock(&t->lock);
    Record record;
    float *found = at ? read_record(t->file, at, &record) : NULL;
    bool fits = found && record.count == count;
    if (fits) memcpy(samples, found, count * sizeof *samples);
    free(found);
    return fits;
}

void tile_file_write(TileFile *t, uint32_t tile, const float *samples, size_t count) {
    if (tile >= t->tiles || count > LARGEST_TILE || stopwatch_wall() < t->begins) return;
    pthread_mutex_lock(&t->lock);
    if (t->file < 0 && !t->full) t->full = !make(t, false);
    if (!t->full && !t->places[tile]) t->full = !append(t, tile, samples, count);
    pthread_mutex_unlock(&t->lock);
}

void tile_file_close(TileFile *t, bool finished) {
    if (!t) return;
    if (t->file >= 0 && (finished || t->size == (off_t)sizeof(Header))) unlink(t->path);
    if (t->file >= 0) close(t->file);
    pthread_mutex_destroy(&t->lock);
    free(t->path);
    free(t);
}
