/* Drawing the matter of skins into a beam: cells, copies, clusters and triangles that the beam meets, nearest first, each mapped on
 * the way from texel space to the beam. Nothing mapped is kept but the triangles that some sample saw. */
#ifndef VTS_RENDER_BEAM_SKIN_H
#define VTS_RENDER_BEAM_SKIN_H

#include "render/beam.h"
#include "render/compile.h"

#include <stdatomic.h>

/* A triangle of a copy that some sample saw. */
typedef struct BeamFacet {
    const CompiledSkin *skin;
    const SkinCell *cell;
    const PlacedTexel *placed;
    TexelCopy copy;
    const TexelCluster *cluster; /* the triangle of the texel that it is, or a part of */
    uint8_t triangle;
    bool round;      /* it stands for what is not as flat */
    uint16_t layer;
    int period;      /* of cyclic y: how many boxes above the foot's */
    Vec3f corner[3]; /* (a, b, w) of the part of the cell that was drawn: its (a, b) times `size`, plus `from` */
    double from_a, from_b, size;
} BeamFacet;

/* The unit normal in texel space, at a place in the copy's box, of what the facet stands for; zero of a line. Which side is the front is not told. */
Vec3 beam_facet_normal(const BeamFacet *f, Vec3 in);

typedef struct BeamCell {
    uint32_t skin, cell;
    float nearest; /* q.z */
} BeamCell;

/* What drawing needs, of one worker. */
typedef struct BeamDraft {
    Beam *beam;
    Vec3 eye;                 /* the camera's; and what a pixel is wide, at the eye and for each unit of distance from it */
    double width, spread;
    double tolerance;         /* in pixels: how far triangles may leave what the mapping makes of them. All beams of a picture cut them alike */
    BeamFacet *facets;        /* of the camera's beam: samples' marks are 1 + their numbers here. Of a light's NULL */
    uint32_t facet_count, facet_capacity;
    uint32_t *renumber;       /* [facet_capacity + 1] */
    BeamCell *cells;          /* room for as many cells as all skins have */
    uint64_t triangles, nodes; /* mapped and drawn, and boxes around some that were looked at: counted up */
    const atomic_bool *interrupted; /* may be NULL; what is not drawn when it becomes true is left out */
} BeamDraft;

static inline bool beam_is_interrupted(const BeamDraft *draft) { return draft->interrupted && *draft->interrupted; }

/* How many cells all skins have that are drawn by beams. */
size_t beam_most_cells(const CompiledScene *compiled);
/* The cells with exact geometry that lie in the beam; returns how many. */
uint32_t beam_gather(BeamDraft *draft, const CompiledScene *compiled);
/* Draws those cells, nearest first. */
void beam_draw_cells(BeamDraft *draft, const CompiledScene *compiled, uint32_t count);

#endif
