#include "cli/farm.h"
#include "cli/frames.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* Pixels of a tile hang on each other: a region that cuts one costs all of it. */
enum { TILE = 32 };

bool farm_is_cut(const Farm *farm) { return farm->columns * farm->rows > 1; }

/* ---- words ---- */

void farm_write_word(const char *word, FILE *out) {
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./,:=@%+-";
    if (*word && word[strspn(word, plain)] == '\0') {
        fputs(word, out);
        return;
    }
    fputc('\'', out);
    for (; *word; word++)
        if (*word == '\'') fputs("'\\''", out);
        else fputc(*word, out);
    fputc('\'', out);
}

static void write_next(const char *word, FILE *out) {
    fputc(' ', out);
    farm_write_word(word, out);
}

/* ---- regions ---- */

static int edge(int size, int parts, int number) {
    int at = (int)((long long)size * number / parts);
    return number < parts && size / parts >= TILE ? at / TILE * TILE : at;
}

static const char *part_name(const Farm *farm, int region) {
    const char *slash = strrchr(farm->output, '/'), *name = slash ? slash + 1 : farm->output, *dot = strrchr(name, '.');
    int stem = dot ? (int)(dot - farm->output) : (int)strlen(farm->output);
    char path[PATH_MAX + 64];
    int rows = snprintf(NULL, 0, "%d", farm->rows - 1), columns = snprintf(NULL, 0, "%d", farm->columns - 1);
    int length = snprintf(path, sizeof path, "%.*s.r%0*dc%0*d%s", stem, farm->output, rows, region / farm->columns, columns, region % farm->columns,
                          farm->parts);
    return length > 0 && (size_t)length < sizeof path ? settings_copy(farm->settings, path, (size_t)length) : farm->output;
}

static const char *job_output(const Farm *farm, int region) { return farm_is_cut(farm) ? part_name(farm, region) : farm->output; }

/* ---- jobs ---- */

typedef struct Chunk {
    int *frames;
    int count;
} Chunk;

/* "7", "1-9", "1-9x2" where they go in steps, else "1,5,6". */
static char *chunk_text(const Chunk *chunk) {
    char *text = NULL;
    size_t size;
    const int *f = chunk->frames;
    bool even = true;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    for (int i = 2; i < chunk->count; i++) even &= f[i] - f[i - 1] == f[1] - f[0];
    int step = chunk->count > 1 ? f[1] - f[0] : 0;
    if (chunk->count > 1 && even && step > 0) fprintf(out, step > 1 ? "%d-%dx%d" : "%d-%d", f[0], f[chunk->count - 1], step);
    else
        for (int i = 0; i < chunk->count; i++) fprintf(out, i ? ",%d" : "%d", f[i]);
    fclose(out);
    return text;
}

static bool is_done(const Farm *farm, const Chunk *chunk, int region) {
    const char *output = job_output(farm, region);
    if (!farm->settings->resume) return false;
    for (int i = 0; i < chunk->count; i++) {
        farm->settings->options.frame = chunk->frames[i];
        if (!film_is_drawn(film_output(farm->settings, output))) return false;
    }
    return chunk->count > 0 || film_is_drawn(output);
}

static bool emit_chunk(const Farm *farm, const Chunk *chunk, long long *number, FarmEmit *emit, void *context) {
    char *frames = chunk->count ? chunk_text(chunk) : NULL;
    bool more = true;
    for (int region = 0; region < farm->columns * farm->rows && more; region++) {
        FarmJob job = {frames, region, is_done(farm, chunk, region)};
        more = emit(context, (*number)++, &job);
    }
    free(frames);
    return more;
}

bool farm_each(const Farm *farm, FarmEmit *emit, void *context) {
    FrameCursor cursor = {0};
    long long number = 0;
    Chunk chunk = {calloc((size_t)farm->chunk, sizeof *chunk.frames), 0};
    bool more = chunk.frames != NULL, film = farm->settings->animation.on;
    if (more && !film) more = emit_chunk(farm, &chunk, &number, emit, context);
    while (more && film && film_next(farm->settings, &cursor)) {
        chunk.frames[chunk.count++] = cursor.frame;
        if (chunk.count < farm->chunk) continue;
        more = emit_chunk(farm, &chunk, &number, emit, context);
        chunk.count = 0;
    }
    if (more && chunk.count) more = emit_chunk(farm, &chunk, &number, emit, context);
    free(chunk.frames);
    return more;
}

/* ---- commands ---- */

void farm_write_job(const Farm *farm, const FarmJob *job, const char *threads, FILE *out) {
    const Settings *s = farm->settings;
    farm_write_word(farm->program, out);
    fputs(" render", out);
    for (size_t i = 0; i < s->passed.count; i++) write_next(s->passed.items[i], out);
    if (threads && !s->options.threads) fprintf(out, " %s", threads);
    if (s->progress == PROGRESS_AUTO) fputs(" --progress=none", out);
    if (job->frames) fprintf(out, " -f %s", job->frames);
    if (farm_is_cut(farm)) {
        int column = job->region % farm->columns, row = job->region / farm->columns;
        fprintf(out, " --region %d,%d,%d,%d", edge(s->options.width, farm->columns, column), edge(s->options.height, farm->rows, row),
                edge(s->options.width, farm->columns, column + 1), edge(s->options.height, farm->rows, row + 1));
        if (!farm->lossless) fputs(" --float-type float", out);
    }
    fputs(" --resume -o", out);
    write_next(job_output(farm, job->region), out);
    if (s->scene_passed) return;
    fputs(" --", out);
    write_next(farm->scene, out);
}

static const char *write_run(int first, int last, const char *between, FILE *out) {
    fprintf(out, last > first ? "%s%d-%d" : "%s%d", between, first, last);
    return ",";
}

/* All frames, neighbours as ranges: a line of a million numbers is none that a shell takes. */
static void write_frames(const Farm *farm, FILE *out) {
    FrameCursor cursor = {0};
    const char *between = " -f ";
    int first = 0, last = -1;
    for (; film_next(farm->settings, &cursor); last = cursor.frame) {
        if (last >= first && cursor.frame == last + 1) continue;
        if (last >= first) between = write_run(first, last, between, out);
        first = cursor.frame;
    }
    if (last >= first) write_run(first, last, between, out);
}

void farm_write_stitch(const Farm *farm, FILE *out) {
    farm_write_word(farm->program, out);
    fputs(" stitch", out);
    if (farm->settings->wait > 0) fprintf(out, " --wait %.17g", farm->settings->wait);
    if (farm->settings->animation.on) write_frames(farm, out);
    fputs(" --resume -o", out);
    write_next(farm->output, out);
    fputs(" --", out);
    for (int i = 0; i < farm->columns * farm->rows; i++) write_next(part_name(farm, i), out);
}
