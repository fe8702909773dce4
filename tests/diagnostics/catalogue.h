/* The messages that the sources can emit, those that doc/diagnostics.md explains, and those that the programs here provoke: three lists
 * that must agree. */
#ifndef VTS_TESTS_CATALOGUE_H
#define VTS_TESTS_CATALOGUE_H

#include "base/arena.h"

typedef struct CatalogueEntry {
    const char *message; /* each conversion of the format written as … */
    const char *place;   /* "eval/eval.c:82" */
} CatalogueEntry;

typedef struct Catalogue {
    CatalogueEntry *items;
    size_t count, capacity;
} Catalogue;

/* The form in which formats are compared: "'%s' is not declared" becomes "'…' is not declared". */
const char *catalogue_message(Arena *arena, const char *format);
void catalogue_add(Arena *arena, Catalogue *list, const char *message, const char *place);
const CatalogueEntry *catalogue_find(const Catalogue *list, const char *message);
/* All formats at calls that emit errors and warnings below `folder`. Prints what breaks the rules; false then. */
bool catalogue_read_sources(Arena *arena, const char *folder, Catalogue *out);
/* The first column of all rows of tables whose first cell is in backquotes. */
bool catalogue_read_page(Arena *arena, const char *path, Catalogue *out);
/* The lines of a text, without comments (#) and blank lines. */
bool catalogue_read_lines(Arena *arena, const char *path, Catalogue *out);

#endif
