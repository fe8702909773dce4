/* The ground of a map as the scene has it: heights of a Heightmap, exaggerated, in a frame of the globe. */
#ifndef VTS_TERRAIN_GROUND_H
#define VTS_TERRAIN_GROUND_H

#include "scene/scene.h"
#include "terrain/ground_mesh.h"
#include "terrain/heightmap.h"

typedef struct Ground {
    const Heightmap *map;
    GeoFrame frame;
    double exaggeration;
    GroundSource source;
    Box3 bounds;
} Ground;

/* The map lives as long as the ground. NULL where no point of the map has a place in the frame. */
const Ground *ground_create(const Heightmap *map, const GeoFrame *frame, double exaggeration, Arena *arena);
Hash128 ground_hash(const Ground *ground);

/* All that follows is thread-safe; what it means stands in scene.h. */
extern const TerrainOps ground_ops;

#endif
