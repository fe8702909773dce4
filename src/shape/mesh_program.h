/* Runs vts_mesh, the program that reads files of meshes. */
#ifndef VTS_SHAPE_MESH_PROGRAM_H
#define VTS_SHAPE_MESH_PROGRAM_H

#include "base/arena.h"
#include "base/strbuf.h"

#include <stdint.h>

/* What the program found in the file at `path`, as mesh_stream.h describes it behind the header: *bytes, allocated with malloc(), *size of
 * them in *parts parts, charged to `memory` until memory_budget_give_back(). Nothing of it is checked yet. False with a line in `error`. */
bool mesh_program_run(const char *path, uint64_t most_vertices, MemoryBudget *memory, unsigned char **bytes, size_t *size,
                      uint32_t *parts, StrBuf *error);

#endif
