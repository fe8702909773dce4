/* States of cloths, so that frames go on from each other, and a frame alone from the last second that was kept. */
#include "vts_session.h"

#include "grow/cloth.h"
#include "image/whole_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* One cloth's, at the tick of the first moment of the frame that asked last. */
typedef struct ClothState {
    struct ClothState *next;
    Hash128 key;
    uint64_t tick;
    size_t count;
    bool used; /* by the frame that is made */
    double numbers[];
} ClothState;

typedef struct ClothStates {
    ClothState *first;
} ClothStates;

/* Larger states are not worth a file of their own every second. */
enum { MOST_FILE_NUMBERS = 1 << 22 };

/* ---- files ---- */

typedef struct FileHeader {
    char magic[8];
    Hash128 key, checksum; /* of the numbers */
    uint64_t count;
} FileHeader;

static const char MAGIC[8] = "vtsclot1";

static void path_of(const VtsSession *session, Hash128 key, uint64_t tick, StrBuf *out) {
    strbuf_addf(out, "%s/%016llx%016llx-%llu.cloth", session->options.cache_dir, (unsigned long long)key.hi,
                (unsigned long long)key.lo, (unsigned long long)tick);
}

static FileHeader header_of(Hash128 key, const double *numbers, size_t count) {
    FileHeader header = {.key = key, .checksum = hash_begin(count), .count = count};
    memcpy(header.magic, MAGIC, sizeof MAGIC);
    hash_add(&header.checksum, numbers, count * sizeof *numbers);
    return header;
}

/* A folder that cannot be written costs time alone: no picture fails for it. */
static void save_file(const VtsSession *session, Hash128 key, uint64_t tick, const double *numbers,
                      size_t count) {
    StrBuf path = {0}, file = {0};
    path_of(session, key, tick, &path);
    mkdir(session->options.cache_dir, 0777);
    FileHeader header = header_of(key, numbers, count);
    strbuf_add(&file, (const char *)&header, sizeof header);
    strbuf_add(&file, (const char *)numbers, count * sizeof *numbers);
    if (access(path.data, F_OK) != 0) whole_file_replace(path.data, file.data, file.size, NULL);
    strbuf_free(&path);
    strbuf_free(&file);
}

static bool load_numbers(const unsigned char *bytes, size_t size, Hash128 key, Cloth *cloth) {
    size_t count = cloth_state_count(cloth);
    double *numbers =
        size == sizeof(FileHeader) + count * sizeof *numbers ? malloc(count * sizeof *numbers) : NULL;
    if (!numbers) return false;
    memcpy(numbers, bytes + sizeof(FileHeader), count * sizeof *numbers);
    FileHeader header = header_of(key, numbers, count);
    bool whole = memcmp(&header, bytes, sizeof header) == 0 && cloth_load_state(cloth, numbers);
    free(numbers);
    return whole;
}

static bool load_file(const VtsSession *session, Hash128 key, uint64_t tick, Cloth *cloth) {
    StrBuf path = {0};
    size_t size;
    path_of(session, key, tick, &path);
    unsigned char *bytes = access(path.data, R_OK) == 0 ? whole_file_read(path.data, &size, NULL) : NULL;
    bool loaded = bytes && load_numbers(bytes, size, key, cloth) && cloth_tick(cloth) == tick;
    free(bytes);
    strbuf_free(&path);
    return loaded;
}

/* ---- what is asked ---- */

static ClothState **place_of(ClothStates *states, Hash128 key) {
    ClothState **at = &states->first;
    while (*at && !hash_equal((*at)->key, key)) at = &(*at)->next;
    return at;
}

static void find(void *context, Hash128 key, uint64_t tick, Cloth *cloth) {
    VtsSession *session = context;
    ClothState *known = session->cloths ? *place_of(session->cloths, key) : NULL;
    uint64_t begins = 0;
    if (known && known->tick <= tick && known->count == cloth_state_count(cloth) &&
        cloth_load_state(cloth, known->numbers))
        begins = known->tick;
    if (known) known->used = true;
    if (!session->options.cache_dir) return;
    for (uint64_t second = tick / CLOTH_TICKS; second * CLOTH_TICKS > begins; second--)
        if (load_file(session, key, second * CLOTH_TICKS, cloth)) return;
}

/* Moments of a frame come after its first one, in any order: that one's state serves them all, and the next frame. */
static void keep_in_memory(VtsSession *session, Hash128 key, const Cloth *cloth) {
    if (!session->cloths) session->cloths = calloc(1, sizeof *session->cloths);
    if (!session->cloths) return;
    ClothState **at = place_of(session->cloths, key), *old = *at;
    size_t count = cloth_state_count(cloth);
    if (old && old->used && old->tick <= cloth_tick(cloth) && session->moment > 0) return;
    ClothState *state = malloc(sizeof *state + count * sizeof *state->numbers);
    if (!state) return;
    *state = (ClothState){
        .next = old ? old->next : NULL, .key = key, .tick = cloth_tick(cloth), .count = count, .used = true};
    cloth_save_state(cloth, state->numbers);
    *at = state;
    free(old);
}

static void keep(void *context, Hash128 key, const Cloth *cloth, bool asked) {
    VtsSession *session = context;
    size_t count = cloth_state_count(cloth);
    if (asked) {
        keep_in_memory(session, key, cloth);
        return;
    }
    double *numbers =
        session->options.cache_dir && count <= MOST_FILE_NUMBERS ? malloc(count * sizeof *numbers) : NULL;
    if (!numbers) return;
    cloth_save_state(cloth, numbers);
    save_file(session, key, cloth_tick(cloth), numbers, count);
    free(numbers);
}

EvalClothStates session_cloth_states(VtsSession *session) { return (EvalClothStates){find, keep, session}; }

void session_trim_cloths(VtsSession *session, bool all) {
    if (!session->cloths) return;
    for (ClothState **at = &session->cloths->first; *at;) {
        ClothState *state = *at;
        bool stays = state->used && !all;
        state->used = false;
        if (stays) {
            at = &state->next;
            continue;
        }
        *at = state->next;
        free(state);
    }
    if (!all) return;
    free(session->cloths);
    session->cloths = NULL;
}
