/* Files that a scene reads and writes. */
#ifndef VTS_EVAL_EVAL_FILES_H
#define VTS_EVAL_EVAL_FILES_H

#include "eval/eval_state.h"

#include <stdio.h>

struct UserFile {
    UserFile *next;
    const char *path;
    Keyword mode; /* KW_read, KW_write, KW_append */
    bool open;
    FILE *stream;      /* writing to disk */
    StrBuf *memory;    /* writing to memory */
    TokenList *tokens; /* reading */
    uint32_t at;
    bool ended; /* reading: the end was reached */
};

/* Text that was written and is kept in memory: an entry outlives its handles. */
typedef struct MemoryFile {
    const char *name;
    StrBuf text;
    struct MemoryFile *next;
} MemoryFile;

/* The path of a file that the text at `from` names, in the places where includes are looked for; NULL when there is none (the places go
 * to *looked_in) or when it may not be read (reported to *refused, if asked for). In the parse arena. */
const char *path_find(Eval *ev, const char *name, Span from, Diagnostic **refused, StrBuf *looked_in);
/* The text of a file that the text at `span` names: one that the scene has written, or one of path_find(); NULL after an error. */
const SourceFile *eval_find_text(Eval *ev, const char *name, Span span);
bool path_may_write(Eval *ev, const char *path);
void eval_set_scene_path(Eval *ev, const char *path);
MemoryFile *files_in_memory(const Eval *ev, const char *name);

#endif
