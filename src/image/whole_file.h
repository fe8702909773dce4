/* Files read and written whole. */
#ifndef VTS_IMAGE_WHOLE_FILE_H
#define VTS_IMAGE_WHOLE_FILE_H

#include "base/arena.h"
#include "base/strbuf.h"

/* Puts a file with this content in the place of `path`: written under a temporary name in the same folder, renamed when
 * whole. On failure nothing is left, an older file stays, and `error` (may be NULL) gets a line of text. A symbolic
 * link is followed. */
bool whole_file_replace(const char *path, const void *data, size_t size, StrBuf *error);

typedef struct FilePiece {
    const void *data;
    size_t size;
} FilePiece;
/* The same of content that lies in pieces, in the order of the file. */
bool whole_file_replace_pieces(const char *path, const FilePiece *pieces, size_t count, StrBuf *error);

/* Whether whole_file_replace() may succeed: the folder is there and can be written, the name is no folder's. */
bool whole_file_can_replace(const char *path, StrBuf *error);

/* The content of a file in memory that the caller frees; NULL on failure. */
unsigned char *whole_file_read(const char *path, size_t *size, StrBuf *error);
/* The same in an arena, of ordinary files of at most `most` bytes. Allocated before the file is opened: running out of memory leaves
 * none open. */
const unsigned char *whole_file_read_into(Arena *arena, const char *path, size_t most, size_t *size);

#endif
