/* Terrains as the triangles that a view needs: what the rest of the renderer gets to see of them. */
#ifndef VTS_RENDER_TERRAIN_VIEW_H
#define VTS_RENDER_TERRAIN_VIEW_H

#include "base/diag.h"
#include "base/pool.h"
#include "render/view.h"

typedef struct TerrainViewOptions {
    Pool *pool;
    double max_error;      /* of the picture, as the user accepts it */
    bool exact;            /* for the reference: to a small part of a pixel, wherever it is */
    size_t most_vertices;  /* of all posts */
    double (*skin_side)(const Skin *skin); /* the longest cells that a skin can do with; 0: none is short enough; HUGE_VAL: any */
} TerrainViewOptions;

/* A terrain as triangles, for the report. */
typedef struct BuiltTerrain {
    const Terrain *terrain;
    int columns, rows; /* posts of its map */
    size_t needed;     /* triangles that errors ask for; built are those too that keep cracks closed */
    size_t triangles, bytes;
    double seconds;    /* of building them */
} BuiltTerrain;

typedef struct BuiltTerrains {
    BuiltTerrain *items;
    size_t count, capacity;
} BuiltTerrains;

/* The scene with meshes in place of its terrains, in `arena` (`scratch` is another, and reset); the scene itself if it has none. What stands at the same place, the ground
 * and the surface of its skin, is the same mesh. Each one is added to `built`. NULL after a diagnostic. */
const Scene *terrains_as_seen(const Scene *scene, const View *view, const TerrainViewOptions *options, Arena *scratch, Arena *arena,
                              DiagList *diags, BuiltTerrains *built);

#endif
