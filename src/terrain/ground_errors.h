/* How far triangles between few posts are from the ground between all of them: a bound for each square of 2, 4, 8 … posts.
 *
 * The triangles are those of 4-8 meshes (right triangles, halved from the right angle to the middle of the longest side). A square of
 * the level l reaches over 2^l posts; it is two triangles whose common side is the diagonal between those of its corners whose numbers
 * of column and row, counted in such squares, have an even sum. */
#ifndef VTS_TERRAIN_GROUND_ERRORS_H
#define VTS_TERRAIN_GROUND_ERRORS_H

#include "base/arena.h"
#include "base/pool.h"
#include "terrain/ground_source.h"

enum { GROUND_MOST_LEVELS = 22 };

typedef struct GroundErrors {
    int levels; /* the last one is one square that holds the map */
    int columns[GROUND_MOST_LEVELS + 1], rows[GROUND_MOST_LEVELS + 1]; /* squares of each level; level 0 is not kept */
    uint8_t *codes[GROUND_MOST_LEVELS + 1];
} GroundErrors;

/* A third of a byte for each post, in `arena`. Beyond the map's last column and row stands what ground_source_beyond() tells. */
void ground_errors_build(const GroundSource *source, Pool *pool, Arena *arena, GroundErrors *out);

/* An upper bound in metres of what the square's two triangles miss; level from 1 on. Of a square with missing posts at least the side of
 * a part of it. 0 beyond the map, and where no post is. */
double ground_error(const GroundErrors *errors, int level, int column, int row);
/* Whether nothing stands in the square at all. */
bool ground_is_hole(const GroundErrors *errors, int level, int column, int row);

/* The same for the cell between four posts, which is bilinear; NaN beside a missing post. */
double ground_cell_error(const GroundSource *source, int column, int row);

#endif
