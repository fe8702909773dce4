/* Triangles as tessellations leave them: indexed vertices, each with what is known about the surface there. Vertices are
 * split where normals or texture coordinates differ; equal places then have equal coordinates, bit for bit. */
#ifndef VTS_SHAPE_SOUP_H
#define VTS_SHAPE_SOUP_H

#include "base/arena.h"
#include "base/vec.h"

typedef struct TexCoord {
    double u, v;
} TexCoord;

typedef struct SoupVertex {
    Vec3 position;
    Vec3 normal;        /* unit; zero where the surface has none of its own (flat meshes) */
    TexCoord uv;        /* NAN where there is none */
    const Vec3 *height; /* a height vector given for this vertex, or NULL */
    const Vec3 *w;      /* <w at the foot, w at the tip, 0> given for this vertex, or NULL */
} SoupVertex;

typedef struct SoupTriangle {
    uint32_t
        vertex[3]; /* (b - a) × (c - a) points to the outside; to the side of the normals on open sheets */
    bool solid;    /* belongs to the boundary of a closed solid; else an open sheet seen from both sides */
    uint16_t surface; /* of a set: which of its surfaces it comes from (TessellateSurfaces); else 0 */
} SoupTriangle;

typedef struct SoupVertexList {
    SoupVertex *items;
    size_t count, capacity;
} SoupVertexList;

typedef struct SoupTriangleList {
    SoupTriangle *items;
    size_t count, capacity;
} SoupTriangleList;

/* Start with {0}. The lists grow in the arena that the functions are given: always the same one for one soup. They move as they grow: places in them
 * are known by number. */
typedef struct TriangleSoup {
    SoupVertexList vertices;
    SoupTriangleList triangles;
} TriangleSoup;

/* The state of a soup, to address what is appended later. */
typedef struct SoupMark {
    size_t vertex, triangle;
} SoupMark;

SoupMark soup_mark(const TriangleSoup *soup);
/* Room for so many more at once, where a tessellation knows roughly what comes: lists that grow by and by are copied. */
void soup_reserve(Arena *arena, TriangleSoup *soup, size_t vertices, size_t triangles);
/* Gives back the memory of both lists as far as it can be: nobody may use the soup any more. */
void soup_release(Arena *arena, TriangleSoup *soup);
/* Returns the vertex's index. */
uint32_t soup_vertex(Arena *arena, TriangleSoup *soup, Vec3 position, Vec3 normal, double u, double v);
/* Two equal indices: nothing is added. */
void soup_triangle(Arena *arena, TriangleSoup *soup, uint32_t a, uint32_t b, uint32_t c, bool solid);

/* What a grid of (rows + 1) × (columns + 1) vertices looks like: vertex (i, j). */
typedef SoupVertex (*SoupGridPoint)(const void *context, int i, int j);
/* Appends a grid, two triangles a mesh, outside where ∂/∂j × ∂/∂i points. A first or last row that is one single point
 * (`pinched`) makes single triangles. */
typedef struct SoupGrid {
    int rows, columns;
    bool first_pinched, last_pinched, solid;
} SoupGrid;
void soup_grid(Arena *arena, TriangleSoup *soup, const SoupGrid *grid, SoupGridPoint point,
               const void *context);

/* Moves all vertices after the mark; a mirror turns the triangles round, so that the outside stays outside. */
void soup_transform(Arena *arena, TriangleSoup *soup, SoupMark since, const Transform *transform);
/* Cuts each triangle after the mark into n² (n >= 1); everything at vertices is interpolated, edges stay closed. */
void soup_split(Arena *arena, TriangleSoup *soup, SoupMark since, int n);

#endif
