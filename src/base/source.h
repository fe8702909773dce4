/* Source files held in memory, and spans of their text. Lines and columns are computed on demand. */
#ifndef VTS_BASE_SOURCE_H
#define VTS_BASE_SOURCE_H

#include "base/arena.h"

/* A piece of a source file, in bytes: [begin, end). file 0 = nowhere (the program itself, the command line). */
typedef struct Span {
    uint32_t file, begin, end;
} Span;

typedef struct SourceFile {
    const char *path; /* as opened, for reading and for the includer's folder */
    const char *name; /* as shown in diagnostics */
    const char *text; /* size bytes and a terminating NUL */
    uint32_t size;
    uint32_t id;       /* its Span.file */
    uint32_t *lines;   /* offset of each line's first byte; made by the first source_locate() */
    uint32_t line_count;
    uint64_t device, inode; /* which file of the disk it was, 0 and 0 for text from memory */
    bool stale;             /* the file has been written since: source_load() reads it again */
} SourceFile;

typedef struct SourceSet {
    Arena *arena;
    SourceFile **items; /* items[id - 1] */
    size_t count, capacity;
} SourceSet;

typedef struct SourcePlace {
    const SourceFile *file; /* NULL for a span that is nowhere */
    uint32_t line, column;  /* from 1; column in characters (UTF-8 sequences count one), tabs count one */
} SourcePlace;

typedef enum SourceStatus { SOURCE_OK, SOURCE_NOT_FOUND, SOURCE_UNREADABLE, SOURCE_TOO_LARGE, SOURCE_BINARY } SourceStatus;

void source_set_init(SourceSet *set, Arena *arena);

/* Reads a file whole. SOURCE_BINARY when it holds a NUL byte; SOURCE_TOO_LARGE past 1 GiB. A file that the set
 * already holds (same path) is returned again. `name` is shown in diagnostics (copied; NULL: the path). */
SourceStatus source_load(SourceSet *set, const char *path, const char *name, const SourceFile **out);
/* To be called when a file is written: what the set holds of it, under whatever path, is not returned again. */
void source_forget(SourceSet *set, const char *path);
/* Whether the file at `path`, which may be a link, is one that the set was read from. */
bool source_holds(const SourceSet *set, const char *path);
/* Takes text that is already in memory (copied). */
const SourceFile *source_add_text(SourceSet *set, const char *name, const char *text, size_t size);

SourcePlace source_locate(SourceSet *set, Span span);
/* The text of line `line` (from 1) without its end; *size gets its length. */
const char *source_line(SourceSet *set, const SourceFile *file, uint32_t line, size_t *size);

/* Where POV-Ray blames what it finds wrong once `span` is read: at the token behind it, if that stands on another line than `span`
 * begins on; else `span`, and so it is where a directive or the end of the text follows. */
Span source_blame_after(SourceSet *set, Span span);

/* From the start of a to the end of b, when both lie in one file; otherwise a. */
Span span_join(Span a, Span b);

#endif
