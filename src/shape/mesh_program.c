#include "shape/mesh_program.h"

#include "base/module.h"
#include "shape/mesh_stream.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#define PROGRAM_NAME "vts_mesh"
enum { BYTES_PER_VERTEX = 32 + 12 + 64, LONGEST_REFUSAL = 4096 };
#define OWN_BYTES (UINT64_C(128) << 20) /* what assimp itself takes, at most */

typedef struct Child {
    pid_t id;
    int from; /* the reading end of its output */
} Child;

static bool find_program(char path[MODULE_PATH_SIZE]) {
    for (int place = 0; place < MODULE_PLACES; place++)
        if (module_place(place, PROGRAM_NAME, path) && access(path, X_OK) == 0) return true;
    return false;
}

static bool make_pipe(int ends[2]) {
    if (pipe(ends) != 0) return false;
    for (int k = 0; k < 2; k++) fcntl(ends[k], F_SETFD, FD_CLOEXEC);
    return true;
}

static int spawn_with(const char *program, char *const arguments[], int output, pid_t *id) {
    static char *const no_environment[] = {NULL};
    posix_spawn_file_actions_t actions;
    int failed = posix_spawn_file_actions_init(&actions);
    if (failed) return failed;
    failed = posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    if (!failed) failed = posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    if (!failed) failed = posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    if (!failed) failed = posix_spawn(id, program, &actions, NULL, arguments, no_environment);
    posix_spawn_file_actions_destroy(&actions);
    return failed;
}

static bool child_start(Child *child, const char *program, const char *file, uint64_t most_vertices, uint64_t most_bytes) {
    int ends[2];
    StrBuf vertices = {0}, bytes = {0}, name = {0};
    if (!make_pipe(ends)) return false;
    strbuf_adds(&name, file);
    strbuf_addf(&vertices, "%" PRIu64, most_vertices);
    strbuf_addf(&bytes, "%" PRIu64, most_bytes);
    char own_name[] = PROGRAM_NAME;
    char *const arguments[] = {own_name, name.data, vertices.data, bytes.data, NULL};
    int failed = spawn_with(program, arguments, ends[1], &child->id);
    close(ends[1]);
    if (failed) close(ends[0]);
    child->from = ends[0];
    strbuf_free(&name);
    strbuf_free(&vertices);
    strbuf_free(&bytes);
    return failed == 0;
}

/* The number of the signal that ended it, or 0. */
static int child_end(const Child *child) {
    int status = 0;
    close(child->from);
    while (waitpid(child->id, &status, 0) < 0)
        if (errno != EINTR) return 0;
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

static bool read_all(int from, void *data, size_t size) {
    unsigned char *bytes = data;
    while (size > 0) {
        ssize_t n = read(from, bytes, size);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        bytes += n;
        size -= (size_t)n;
    }
    return true;
}

static void explain_end(int signal_number, StrBuf *error) {
    if (signal_number == SIGXCPU) strbuf_adds(error, "reading it takes too long");
    else if (signal_number == SIGINT || signal_number == SIGTERM) strbuf_adds(error, "reading it was interrupted");
    else if (signal_number) strbuf_addf(error, "it is damaged: its reader ended with signal %d", signal_number);
    else strbuf_adds(error, "it is damaged: its reader gave up");
}

static bool take_refusal(int from, size_t size, StrBuf *error) {
    char text[LONGEST_REFUSAL];
    size = size_min(size, sizeof text);
    if (!read_all(from, text, size)) return false;
    strbuf_add(error, text, size);
    return true;
}

/* The bytes behind the header. A refusal, too, is false with `error`. */
static bool take_parts(int from, const MeshStreamHeader *header, uint64_t most_bytes, MemoryBudget *memory, unsigned char **out,
                       StrBuf *error) {
    if (header->count > most_bytes || header->count > SIZE_MAX / 4) return false;
    size_t size = (size_t)header->count;
    if (!memory_budget_take(memory, size)) {
        strbuf_adds(error, "it does not fit into the memory limit");
        return false;
    }
    unsigned char *bytes = malloc(size ? size : 1);
    if (bytes && read_all(from, bytes, size)) return *out = bytes, true;
    if (!bytes) strbuf_adds(error, "there is not enough memory for it");
    free(bytes);
    memory_budget_give_back(memory, size);
    return false;
}

static bool take_stream(int from, uint64_t most_vertices, MemoryBudget *memory, unsigned char **bytes, size_t *size,
                        uint32_t *parts, StrBuf *error) {
    MeshStreamHeader header;
    if (!read_all(from, &header, sizeof header) || header.magic != MESH_STREAM_MAGIC) return false;
    *size = (size_t)header.count;
    *parts = header.part_count;
    switch (header.status) {
    case MESH_STREAM_REFUSED: take_refusal(from, *size, error); return false;
    case MESH_STREAM_TOO_LARGE:
        strbuf_addf(error, "it has %" PRIu64 " vertices or triangles, and %" PRIu64 " are allowed", header.count, most_vertices);
        return false;
    case MESH_STREAM_READ: break;
    default: return false;
    }
    uint64_t most_bytes = most_vertices > UINT64_MAX / BYTES_PER_VERTEX ? UINT64_MAX : most_vertices * BYTES_PER_VERTEX;
    return take_parts(from, &header, most_bytes, memory, bytes, error);
}

bool mesh_program_run(const char *path, uint64_t most_vertices, MemoryBudget *memory, unsigned char **bytes, size_t *size,
                      uint32_t *parts, StrBuf *error) {
    char program[MODULE_PATH_SIZE];
    Child child;
    uint64_t most_bytes = memory && memory->limit ? memory->limit + OWN_BYTES : 0;
    if (!find_program(program) || !child_start(&child, program, path, most_vertices, most_bytes)) {
        strbuf_adds(error, "the program " PROGRAM_NAME ", which reads it, was not found or does not start");
        return false;
    }
    bool done = take_stream(child.from, most_vertices, memory, bytes, size, parts, error);
    int signal_number = child_end(&child);
    if (!done && error->size == 0) explain_end(signal_number, error);
    return done;
}
