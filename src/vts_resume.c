/* Going on with a picture that another run has begun. */
#include "vts_session.h"

#include "base/hash.h"
#include "base/stopwatch.h"
#include "image/whole_file.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A picture that takes less is drawn again, and no file is written for it. */
static const double WORTH_KEEPING = 10;
/* Keeping what moments have made takes at most this part of the time. */
static const double KEEPING_SHARE = 0.05;

bool session_is_blurred(const VtsSession *session) {
    const VtsOptions *o = &session->options;
    return o->shutter_clock != 0 || o->shutter_time != 0;
}

/* Also of the sky light's and other files' contents no more is known than their names: they stand in the texts. */
static TileFileKey key_of(const VtsSession *session, const int region[4], bool aovs) {
    const VtsOptions *o = &session->options;
    TileFileKey key = {.picture = session->key, .channels = (o->alpha ? 4 : 3) + (o->aovs && aovs ? session->aovs.channels : 0)};
    for (int i = 0; i < 4; i++) key.region[i] = region[i];
    key.tiles = (uint32_t)film_tiles_x(region) * (uint32_t)film_tiles_y(region);
    return key;
}

void session_keep_tiles(VtsSession *session, const char *output_path) {
    const VtsOptions *o = &session->options;
    session->kept_at = output_path;
    session->keeps_from = stopwatch_wall() + (o->resume ? 0 : WORTH_KEEPING);
    if (session_is_blurred(session)) return;
    int region[4];
    session_region(session, region);
    TileFileKey key = key_of(session, region, true);
    session->kept = tile_file_open(output_path, &key, o->resume, o->resume ? 0 : WORTH_KEEPING);
}

void session_keep_moment(VtsSession *session, int moment, const int region[4]) {
    if (!session->kept_at) return;
    bool first = !session->kept;
    session->tiles_taken += tile_file_taken(session->kept);
    tile_file_close(session->kept, true);
    TileFileKey key = key_of(session, region, moment == 0);
    key.picture += 0x9e3779b97f4a7c15u * ((uint64_t)moment + 1);
    session->kept = tile_file_open(session->kept_at, &key, session->options.resume && first, session->keeps_from - stopwatch_wall());
}

/* ---- means of moments ---- */

enum { STATE_IMAGES = 4 };

typedef struct StateHeader {
    char magic[8];
    TileFileKey key;
    Hash128 checksum; /* of all that follows, and of the pixels and tiles behind it */
    int32_t moments, scouting, channels[STATE_IMAGES]; /* 0: no image */
    double error_estimate, noise_estimate;
} StateHeader;

static const char MAGIC[8] = "vtsmmnt2";

static void path_of(const VtsSession *session, StrBuf *out) { strbuf_addf(out, "%s.moments-vts", session->kept_at); }

static Hash128 checksum_of(const StateHeader *header, const unsigned char *bytes, size_t size) {
    const size_t from = offsetof(StateHeader, moments);
    Hash128 hash = hash_begin(size);
    hash_add(&hash, (const char *)header + from, sizeof *header - from);
    hash_add(&hash, bytes, size);
    return hash;
}

static Image *image_of(const ExposureState *state, int i) {
    MomentMean *m = i < 2 ? state->mean : state->scout;
    return i % 2 == 0 ? &m->mean : &m->between;
}

static size_t image_bytes(const MomentMean *m, int channels) {
    return (size_t)m->width * (size_t)m->height * (size_t)channels * sizeof(float);
}

static size_t tiles_of(const MomentMean *m) { return (size_t)m->tiles_x * (size_t)m->tiles_y; }

static size_t tile_bytes(const MomentMean *m) { return tiles_of(m) * (sizeof *m->noise + sizeof *m->noise_between + sizeof *m->open); }

static size_t size_of(const ExposureState *state, const StateHeader *header) {
    size_t size = tile_bytes(state->mean) + tile_bytes(state->scout);
    for (int i = 0; i < STATE_IMAGES; i++) size += image_bytes(i < 2 ? state->mean : state->scout, header->channels[i]);
    return size;
}

/* Between the state and the bytes of a file, in their order. */
static void copy_state(const ExposureState *state, unsigned char *bytes, bool into_state) {
    for (int i = 0; i < STATE_IMAGES; i++) {
        Image *image = image_of(state, i);
        size_t size = image_bytes(i < 2 ? state->mean : state->scout, image->channels);
        if (size) memcpy(into_state ? (void *)image->pixels : bytes, into_state ? bytes : (void *)image->pixels, size);
        bytes += size;
    }
    const MomentMean *const means[] = {state->mean, state->scout};
    for (int i = 0; i < 2; i++) {
        void *const parts[] = {means[i]->noise, means[i]->noise_between, means[i]->open};
        const size_t each[] = {sizeof *means[i]->noise, sizeof *means[i]->noise_between, sizeof *means[i]->open};
        for (int k = 0; k < 3; k++) {
            size_t size = tiles_of(means[i]) * each[k];
            memcpy(into_state ? parts[k] : bytes, into_state ? bytes : parts[k], size);
            bytes += size;
        }
    }
}

static StateHeader header_of(const VtsSession *session, const ExposureState *state, const int region[4]) {
    StateHeader header;
    memset(&header, 0, sizeof header); /* what lies between its fields is hashed, too */
    header.key = key_of(session, region, true);
    header.moments = *state->moments, header.scouting = *state->scouting;
    for (int i = 0; i < STATE_IMAGES; i++) header.channels[i] = image_of(state, i)->channels;
    header.error_estimate = state->stats->error_estimate, header.noise_estimate = state->stats->noise_estimate;
    memcpy(header.magic, MAGIC, sizeof MAGIC);
    return header;
}

void session_save_moments(VtsSession *session, const ExposureState *state, const int region[4]) {
    double begun = stopwatch_wall();
    if (!session->kept_at || begun < session->keeps_from) return;
    StateHeader header = header_of(session, state, region);
    size_t size = size_of(state, &header);
    unsigned char *bytes = malloc(sizeof header + size);
    if (!bytes) return; /* the picture does without */
    copy_state(state, bytes + sizeof header, false);
    header.checksum = checksum_of(&header, bytes + sizeof header, size);
    memcpy(bytes, &header, sizeof header);
    StrBuf path = {0};
    path_of(session, &path);
    whole_file_replace(path.data, bytes, sizeof header + size, NULL);
    double now = stopwatch_wall();
    session->keeps_from = now + (now - begun) / KEEPING_SHARE;
    strbuf_free(&path);
    free(bytes);
}

/* Whether the file is what another run has kept of this picture. */
static bool is_ours(const VtsSession *session, const ExposureState *state, const int region[4], const unsigned char *bytes, size_t size,
                    StateHeader *header) {
    if (!bytes || size < sizeof *header) return false;
    memcpy(header, bytes, sizeof *header);
    StateHeader here = header_of(session, state, region);
    if (memcmp(header->magic, here.magic, sizeof here.magic) != 0 || memcmp(&header->key, &here.key, sizeof here.key) != 0) return false;
    for (int i = 0; i < STATE_IMAGES; i++)
        if (header->channels[i] < 0 || header->channels[i] > FILM_MOST_CHANNELS) return false;
    return header->moments > 0 && size - sizeof *header == size_of(state, header) &&
           hash_equal(header->checksum, checksum_of(header, bytes + sizeof *header, size - sizeof *header));
}

static bool make_images(VtsSession *session, const ExposureState *state, const StateHeader *header) {
    const char *names[FILM_MOST_CHANNELS];
    film_channels(session->options.alpha, session->options.aovs ? &session->aovs : NULL, names);
    for (int i = 0; i < STATE_IMAGES; i++) {
        const MomentMean *m = i < 2 ? state->mean : state->scout;
        if (header->channels[i] && !image_init(image_of(state, i), m->width, m->height, header->channels[i], names, &session->memory, NULL)) return false;
    }
    return true;
}

void session_restore_moments(VtsSession *session, const ExposureState *state, const int region[4]) {
    if (!session->kept_at || !session->options.resume) return;
    StrBuf path = {0};
    StateHeader header;
    size_t size = 0;
    path_of(session, &path);
    unsigned char *bytes = access(path.data, R_OK) == 0 ? whole_file_read(path.data, &size, NULL) : NULL;
    if (is_ours(session, state, region, bytes, size, &header) && make_images(session, state, &header)) {
        copy_state(state, bytes + sizeof header, true);
        *state->moments = header.moments, *state->scouting = header.scouting != 0;
        state->stats->error_estimate = header.error_estimate, state->stats->noise_estimate = header.noise_estimate;
        state->stats->kept_moments = (uint64_t)header.moments;
    }
    strbuf_free(&path);
    free(bytes);
}

void session_forget_tiles(VtsSession *session) {
    tile_file_close(session->kept, true);
    session->kept = NULL;
    if (!session->kept_at || !session_is_blurred(session)) return;
    StrBuf path = {0};
    path_of(session, &path);
    unlink(path.data);
    strbuf_free(&path);
}
