#include "base/source.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { LARGEST_SOURCE = 1 << 30 };

void source_set_init(SourceSet *set, Arena *arena) { *set = (SourceSet){.arena = arena}; }

static SourceFile *add_file(SourceSet *set, const char *path, const char *name, char *text, size_t size) {
    SourceFile *file = arena_new(set->arena, SourceFile);
    file->path = arena_strdup(set->arena, path);
    file->name = arena_strdup(set->arena, name ? name : path);
    file->text = text;
    file->size = (uint32_t)size;
    *list_push(set->arena, set) = file;
    file->id = (uint32_t)set->count;
    return file;
}

SourceStatus source_load(SourceSet *set, const char *path, const char *name, const SourceFile **out) {
    for (size_t i = 0; i < set->count; i++)
        if (!set->items[i]->stale && strcmp(set->items[i]->path, path) == 0) {
            *out = set->items[i];
            return SOURCE_OK;
        }
    struct stat info;
    if (stat(path, &info) != 0) return errno == ENOENT || errno == ENOTDIR ? SOURCE_NOT_FOUND : SOURCE_UNREADABLE;
    if (S_ISDIR(info.st_mode)) return SOURCE_UNREADABLE;
    FILE *stream = fopen(path, "rb");
    if (!stream) return SOURCE_UNREADABLE;
    /* Pipes have no size: read in growing pieces rather than trust st_size. */
    size_t size = 0, capacity = info.st_size > 0 && info.st_size < LARGEST_SOURCE ? (size_t)info.st_size + 1 : 4096;
    ArenaMark mark = arena_mark(set->arena);
    char *text = arena_push(set->arena, capacity + 1);
    for (;;) {
        size_t got = fread(text + size, 1, capacity - size, stream);
        size += got;
        if (got == 0 || size > LARGEST_SOURCE) break;
        if (size == capacity) {
            char *larger = arena_push(set->arena, capacity * 2 + 1);
            memcpy(larger, text, size);
            text = larger;
            capacity *= 2;
        }
    }
    bool failed = ferror(stream) != 0;
    fclose(stream);
    SourceStatus status = failed                       ? SOURCE_UNREADABLE
                          : size > LARGEST_SOURCE      ? SOURCE_TOO_LARGE
                          : memchr(text, '\0', size)   ? SOURCE_BINARY
                                                       : SOURCE_OK;
    if (status != SOURCE_OK) {
        arena_reset_to(set->arena, mark);
        return status;
    }
    text[size] = '\0';
    SourceFile *file = add_file(set, path, name, text, size);
    file->device = (uint64_t)info.st_dev;
    file->inode = (uint64_t)info.st_ino;
    *out = file;
    return SOURCE_OK;
}

static bool is_file(const SourceFile *file, const struct stat *info) {
    return file->inode == (uint64_t)info->st_ino && file->device == (uint64_t)info->st_dev;
}

void source_forget(SourceSet *set, const char *path) {
    struct stat info;
    if (stat(path, &info) != 0) return;
    for (size_t i = 0; i < set->count; i++)
        if (is_file(set->items[i], &info)) set->items[i]->stale = true;
}

bool source_holds(const SourceSet *set, const char *path) {
    struct stat info;
    if (stat(path, &info) != 0) return false;
    for (size_t i = 0; i < set->count; i++)
        if (is_file(set->items[i], &info)) return true;
    return false;
}

const SourceFile *source_add_text(SourceSet *set, const char *name, const char *text, size_t size) {
    char *copy = arena_push(set->arena, size + 1);
    if (size) memcpy(copy, text, size);
    return add_file(set, name, name, copy, size);
}

/* Where the line after the one that holds the place begins; NULL: it is the last. */
static const char *next_line(const SourceFile *file, const char *from) {
    const char *end = memchr(from, '\n', file->size - (size_t)(from - file->text));
    return end ? end + 1 : NULL;
}

static void index_lines(SourceSet *set, SourceFile *file) {
    uint32_t count = 0;
    for (const char *at = file->text; at; at = next_line(file, at)) count++;
    file->lines = arena_new_array(set->arena, uint32_t, count);
    file->line_count = count;
    uint32_t line = 0;
    for (const char *at = file->text; at; at = next_line(file, at)) file->lines[line++] = (uint32_t)(at - file->text);
    /* A byte order mark is no part of the first line. */
    if (file->size >= 3 && memcmp(file->text, "\xEF\xBB\xBF", 3) == 0) file->lines[0] = 3;
}

SourcePlace source_locate(SourceSet *set, Span span) {
    if (span.file == 0 || span.file > set->count) return (SourcePlace){0};
    SourceFile *file = set->items[span.file - 1];
    if (!file->lines) index_lines(set, file);
    uint32_t offset = span.begin < file->size ? span.begin : file->size;
    uint32_t low = 0, high = file->line_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (file->lines[middle] <= offset) low = middle;
        else high = middle;
    }
    uint32_t column = 1;
    for (uint32_t i = file->lines[low]; i < offset; i++) column += ((unsigned char)file->text[i] & 0xC0u) != 0x80u;
    return (SourcePlace){file, low + 1, column};
}

const char *source_line(SourceSet *set, const SourceFile *file, uint32_t line, size_t *size) {
    SourceFile *own = set->items[file->id - 1];
    if (!own->lines) index_lines(set, own);
    uint32_t begin = own->lines[line - 1];
    uint32_t end = line < own->line_count ? own->lines[line] - 1 : own->size;
    if (end > begin && own->text[end - 1] == '\r') end--;
    *size = end - begin;
    return own->text + begin;
}

/* Past blanks and comments. */
static uint32_t skip_to_token(const SourceFile *file, uint32_t at) {
    const char *text = file->text;
    for (uint32_t depth = 0; at < file->size; at++) {
        bool blank = text[at] == ' ' || text[at] == '\t' || text[at] == '\r' || text[at] == '\n';
        if (text[at] == '/' && text[at + 1] == '*') {
            depth++, at++;
        } else if (depth && text[at] == '*' && text[at + 1] == '/') {
            depth--, at++;
        } else if (!depth && text[at] == '/' && text[at + 1] == '/') {
            while (at < file->size && text[at] != '\n') at++;
        } else if (!depth && !blank) {
            break;
        }
    }
    return at;
}

Span source_blame_after(SourceSet *set, Span span) {
    if (span.file == 0 || span.file > set->count) return span;
    const SourceFile *file = set->items[span.file - 1];
    uint32_t at = skip_to_token(file, span.end), end = at + 1;
    if (at >= file->size || file->text[at] == '#') return span;
    while (end < file->size && (isalnum((unsigned char)file->text[end - 1]) || file->text[end - 1] == '_') &&
           (isalnum((unsigned char)file->text[end]) || file->text[end] == '_'))
        end++;
    Span after = {span.file, at, end};
    return source_locate(set, after).line == source_locate(set, span).line ? span : after;
}

Span span_join(Span a, Span b) {
    if (a.file != b.file || b.end < a.begin) return a;
    return (Span){a.file, a.begin, b.end};
}
