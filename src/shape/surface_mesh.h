/* The surface that carries a skin, as cells that know their neighbours: what the renderer of skins walks.
 *
 * Positions are shared wherever they coincide, also across uv seams, so that the boxes raised over two neighbouring cells
 * share their wall exactly; texture coordinates are kept per corner, so that a seam can hold two values at one place.
 *
 * Corners go round the cell. Edge e joins corner e and corner (e + 1) mod n. A cell of four corners is the bilinear patch
 *     P(s, t) = (1-s)(1-t)·c0 + s(1-t)·c1 + s·t·c2 + (1-s)·t·c3,
 * one of three the triangle (c0, c1, c2). The front, where normals point and texels grow, is the side of
 * (c1 - c0) × (last - c0) in the algebraic cross product of vec3_cross(). */
#ifndef VTS_SHAPE_SURFACE_MESH_H
#define VTS_SHAPE_SURFACE_MESH_H

#include "base/arena.h"
#include "scene/scene.h"
#include "shape/tessellate.h"

typedef struct SurfaceCell {
    uint32_t vertex[4]; /* corners; [3] repeats [0] when there are three */
    uint32_t uv[4];     /* into SurfaceMesh.uvs, per corner */
    uint8_t corner_count;
    bool
        degenerate; /* no area: two corners coincide or all lie on a line; kept, so that indices stay those of the input */
} SurfaceCell;

typedef struct SurfaceNeighbour {
    int32_t
        cell; /* -1: a border, an edge of three or more cells, or one where no consistent front exists (Möbius strip) */
    uint8_t edge; /* the same edge as `cell` numbers it; it runs the other way round */
    bool seam;    /* texture coordinates differ on the two sides */
} SurfaceNeighbour;

typedef struct SurfaceMesh {
    const Vec3 *vertices;
    const Vec3 *normals; /* one per vertex: unit vectors to the front; <0, 1, 0> where nothing defines one */
    const Vec3
        *height_vectors; /* one per vertex, with their own length; NULL: none given, the unit normal holds */
    const Vec3 *w_vectors; /* one per vertex, <w at the foot, w at the tip, 0>; NULL: the mapping's */
    size_t vertex_count;
    const TexCoord
        *uvs; /* one turn of the surface is 1; generated ones may pass 1 where a cell crosses the seam */
    size_t uv_count;
    const SurfaceCell *cells;
    size_t cell_count;
    const SurfaceNeighbour (*neighbours)[4]; /* per cell and edge; symmetric */
    Box3 bounds;                             /* of the vertices */
    double shortest_cut; /* > 0: cells were to be cut finer, and had to stay about this long, as there would have been too many; scene units */
} SurfaceMesh;

typedef struct SurfaceMeshOptions {
    double
        tolerance; /* > 0: largest distance of curved solids and deformed faces from the cells, scene units, for `subdivide` auto */
    double longest_edge; /* > 0: cells of `subdivide` auto are cut until none is longer, or there are too many; scene units */
} SurfaceMeshOptions;

/* Builds the mesh in scene space in `arena`: tessellation, subdivision, deform, the surface's transform, in this order.
 *   patches   one cell for each patch, in the order i·nv + j; uv = (i/nu, j/nv). The front is that of ∂P/∂v × ∂P/∂u, or
 *             the opposite when that one looks down on average.
 *   objects   triangles. Winding is made consistent; the front of a closed part is its outside, that of an open one with
 *             given or natural normals (disc, open cylinder) theirs, of one that is nearly closed its outside, of any other open one the side that looks up on average.
 *   heights   given height vectors win: the front of a part is the side to which they point.
 *   subdivide N cuts flat faces and mesh triangles N times along each edge, curved solids N times per quarter turn.
 *   uv        natural or given ones; planar: the two axes across uv_axis, cylindrical and spherical: turns about it and
 *             the way along it (from pole to pole); all scaled to [0, 1] over the bounding box of the undeformed surface, so
 *             that a texture does not slide while a deform moves.
 * Vertex normals are the angle-weighted mean of the cells around (given normals win unless there is a deform); height
 * vectors and w vectors given with the scene are interpolated to subdivided vertices and follow deform and transform.
 * What is needed on the way stays in the arena too: about 450 bytes a cell in all.
 * False, with *refusal filled, for what has no finite boundary or is not modelled. */
bool surface_mesh_build(const Surface *surface, const SurfaceMeshOptions *options, Arena *arena,
                        SurfaceMesh *out, ShapeRefusal *refusal);

#endif
