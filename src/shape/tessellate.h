/* Any finite object as triangles: for texels, for skins on solids, for drawing.
 *
 * Flat and round shapes are placed so that what is seen of them is right on average: the vertices of round ones stand a
 * little outside the true surface, its faces a little inside. A convex body shows, averaged over directions, a quarter of
 * its area (Cauchy), so spheres, tori, cylinders and cones, open or closed, and discs have the true area, however coarse
 * they are. */
#ifndef VTS_SHAPE_TESSELLATE_H
#define VTS_SHAPE_TESSELLATE_H

#include "base/progress.h"
#include "scene/scene.h"
#include "shape/soup.h"

#include <stdatomic.h>

/* Why something has no triangles, or not those that were asked for. */
typedef struct ShapeRefusal {
    Span span;          /* of the object at fault */
    const char *reason; /* a clause for a diagnostic, static: "a plane has no end" */
} ShapeRefusal;

/* Appends particles to a soup, in their own space; `grow` supplies it (particles_tessellate). */
typedef void (*TessellateParticles)(const Particle *items, size_t count, double tolerance, Arena *arena,
                                    TriangleSoup *out);

/* The surfaces that sets consist of: triangles name them by number. */
typedef struct TessellateSurface {
    const Texture *texture; /* its own, or inherited within the set; NULL: that of the set's parent */
    Transform place;        /* of the object that has the texture (NULL: of the set), to the space of the output */
} TessellateSurface;

typedef struct TessellateSurfaces {
    TessellateSurface *items;
    size_t count, capacity;
} TessellateSurfaces;

typedef struct TessellateOptions {
    double tolerance; /* > 0: largest distance between surface and triangles, in the space of the output */
    int parts;        /* 0: by tolerance; N: N per quarter turn, and N along each edge of what is flat */
    TessellateParticles particles; /* NULL: particles are refused */
    ShapeRefusal *doubt;           /* its reason is set where something may be missing or is coarser than asked; or NULL */
    TessellateSurfaces *surfaces;  /* gets the surfaces of sets; NULL: not wanted */
    const atomic_bool *interrupted; /* set by others: give up; or NULL */
    const Progress *progress;      /* told how many surfaces of a set are cut; or NULL */
    const char *stage;             /* what it is told that they are for; needed with progress */
} TessellateOptions;

enum { TESSELLATE_MOST_PARTS = 256 }; /* per quarter turn; a tolerance that asks for more is not met */

/* Appends the object, with `transform` (NULL: none) after its own, to *out (start with {0}), in `arena`, which also keeps what was needed on
 * the way. Unions are their children, walls inside included; intersections, differences, merges and what is clipped have no walls
 * inside. All solids that have a boundary are solid: every edge belongs to two triangles that run along it in opposite ways, with
 * coordinates equal bit for bit (meshes: as given).
 *
 * Where surfaces of a set meet, triangles end within the tolerance of the curve; parts of the surfaces that are thinner than the
 * tolerance are kept, unless less than three times the tolerance of them is seen between two others.
 *
 * False, with *refusal filled, for what has no end, for texels and what is not modelled; *out is then incomplete. Also when interrupted,
 * within a tenth of a second. */
bool tessellate(const Object *object, const Transform *transform, const TessellateOptions *options,
                Arena *arena, TriangleSoup *out, ShapeRefusal *refusal);

/* The most that a matrix lengthens a vector: its largest singular value, rounded up a little. */
double tessellate_stretch(const Mat3 *m);

#endif
