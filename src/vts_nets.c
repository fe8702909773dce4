/* States of cloths and springs, so that frames go on from each other, and a frame alone from the last second that was kept. */
#include "vts_session.h"

#include "grow/spring_net.h"
#include "image/whole_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* One net's, at the tick of the first moment of the frame that asked last. */
typedef struct KeptState {
    struct KeptState *next;
    Hash128 key;
    uint64_t tick;
    size_t count;
    bool used; /* by the frame that is made */
    double numbers[];
} KeptState;

typedef struct KeptStates {
    KeptState *first;
} KeptStates;

/* Larger states are not worth a file of their own every second. */
enum { MOST_FILE_NUMBERS = 1 << 22 };

/* ---- files ---- */

typedef struct FileHeader {
    char magic[8];
    Hash128 key, checksum; /* of the numbers */
    uint64_t count;
} FileHeader;

static const char MAGIC[8] = "vtsnets1";

static void path_of(const VtsSession *session, Hash128 key, uint64_t tick, StrBuf *out) {
    strbuf_addf(out, "%s/%016llx%016llx-%llu.springs", session->options.cache_dir, (unsigned long long)key.hi,
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

static bool load_numbers(const unsigned char *bytes, size_t size, Hash128 key, SpringNet *net) {
    size_t count = net_state_count(net);
    double *numbers =
        size == sizeof(FileHeader) + count * sizeof *numbers ? malloc(count * sizeof *numbers) : NULL;
    if (!numbers) return false;
    memcpy(numbers, bytes + sizeof(FileHeader), count * sizeof *numbers);
    FileHeader header = header_of(key, numbers, count);
    bool whole = memcmp(&header, bytes, sizeof header) == 0 && net_load_state(net, numbers);
    free(numbers);
    return whole;
}

static bool load_file(const VtsSession *session, Hash128 key, uint64_t tick, SpringNet *net) {
    StrBuf path = {0};
    size_t size;
    path_of(session, key, tick, &path);
    unsigned char *bytes = access(path.data, R_OK) == 0 ? whole_file_read(path.data, &size, NULL) : NULL;
    bool loaded = bytes && load_numbers(bytes, size, key, net) && net->tick == tick;
    free(bytes);
    strbuf_free(&path);
    return loaded;
}

/* ---- what is asked ---- */

static KeptState **place_of(KeptStates *states, Hash128 key) {
    KeptState **at = &states->first;
    while (*at && !hash_equal((*at)->key, key)) at = &(*at)->next;
    return at;
}

static void find(void *context, Hash128 key, uint64_t tick, SpringNet *net) {
    VtsSession *session = context;
    KeptState *known = session->nets ? *place_of(session->nets, key) : NULL;
    uint64_t begins = 0;
    if (known && known->tick <= tick && known->count == net_state_count(net) &&
        net_load_state(net, known->numbers))
        begins = known->tick;
    if (known) known->used = true;
    if (!session->options.cache_dir) return;
    for (uint64_t second = tick / NET_TICKS; second * NET_TICKS > begins; second--)
        if (load_file(session, key, second * NET_TICKS, net)) return;
}

/* Moments of a frame come after its first one, in any order: that one's state serves them all, and the next frame. */
static void keep_in_memory(VtsSession *session, Hash128 key, const SpringNet *net) {
    if (!session->nets) session->nets = calloc(1, sizeof *session->nets);
    if (!session->nets) return;
    KeptState **at = place_of(session->nets, key), *old = *at;
    size_t count = net_state_count(net);
    if (old && old->used && old->tick <= net->tick && session->moment > 0) return;
    KeptState *state = malloc(sizeof *state + count * sizeof *state->numbers);
    if (!state) return;
    *state = (KeptState){
        .next = old ? old->next : NULL, .key = key, .tick = net->tick, .count = count, .used = true};
    net_save_state(net, state->numbers);
    *at = state;
    free(old);
}

static void keep(void *context, Hash128 key, const SpringNet *net, bool asked) {
    VtsSession *session = context;
    size_t count = net_state_count(net);
    if (asked) {
        keep_in_memory(session, key, net);
        return;
    }
    double *numbers =
        session->options.cache_dir && count <= MOST_FILE_NUMBERS ? malloc(count * sizeof *numbers) : NULL;
    if (!numbers) return;
    net_save_state(net, numbers);
    save_file(session, key, net->tick, numbers, count);
    free(numbers);
}

NetStates session_net_states(VtsSession *session) { return (NetStates){find, keep, session}; }

void session_trim_nets(VtsSession *session, bool all) {
    if (!session->nets) return;
    for (KeptState **at = &session->nets->first; *at;) {
        KeptState *state = *at;
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
    free(session->nets);
    session->nets = NULL;
}
