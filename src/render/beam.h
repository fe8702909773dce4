/* Beams: bundles of sample lines that share a projection, and triangles drawn into them.
 *
 * The camera's lines through a tile of the picture are a beam, and so are the lines from what the tile shows to a light. A
 * triangle covers those samples whose line it crosses; of the camera's each keeps the nearest, of a light's each learns whether
 * anything lies before it. Samples lie anywhere, sorted into square bins, so that shadows are as exact as rays (an irregular
 * z-buffer: Johnson et al. 2005, Aila & Laine 2004).
 *
 * Beam space of a point P: q = rows·(P − origin) + shift. A perspective beam sees it at (q.x/q.z, q.y/q.z) with the key 1/q.z,
 * a parallel one at (q.x, q.y) with the key q.z. Keys grow towards the eye or the light and are linear over a triangle. */
#ifndef VTS_RENDER_BEAM_H
#define VTS_RENDER_BEAM_H

#include "base/arena.h"
#include "base/vec.h"

/* Samples are taken so many at a time, or triangles; and so many triangles of a mesh at most, before so many samples. */
enum { BEAM_LANES = 4, BEAM_MESH = 32, BEAM_FEW_SAMPLES = 96 };

/* Sorted by bin: those of bin (column, row) are numbers first[row·columns + column] up to the next bin's. */
typedef struct BeamSamples {
    int columns, rows; /* behind the samples the other arrays have BEAM_LANES − 1 more entries, of keys that are INFINITY */
    uint32_t *first; /* [columns·rows + 1] */
    float *x, *y;    /* in bins */
    float *key;      /* of the nearest so far; of a light's beam, of the point itself */
    float *limit;    /* how exact_to bounds what is drawn: of the eye's samples key · exact_to, of a light's points exact_to alone must
                        be at least this much */
    uint32_t *mark;  /* of the nearest facet; of a light's beam, whether something lies before the point */
} BeamSamples;

typedef struct BeamPlane {
    Vec3 normal;
    double offset; /* inside: normal · P + offset >= 0 */
} BeamPlane;

typedef struct Beam {
    Vec3 origin, rows[3], shift;
    bool perspective;
    bool light;       /* a light's beam */
    double nearest;   /* perspective: smallest q.z; parallel: no matter of larger q.z counts */
    double farthest;  /* the other end */
    float exact_to;   /* of what is drawn now: the distance up to which it is drawn as exact geometry; INFINITY */
    BeamPlane planes[6];
    BeamSamples samples;
} Beam;

/* Finishes a beam whose projection, limits and samples are set: planes for culling. */
void beam_close(Beam *beam);
/* False when the box certainly is out of the beam. */
bool beam_meets_box(const Beam *beam, const Box3 *box);
/* The beam-space point of P, in doubles. */
Vec3 beam_point(const Beam *beam, Vec3 p);
/* Its linear part. */
Vec3 beam_vector(const Beam *beam, Vec3 v);

enum { MOST_CORNERS = 16 };
/* Draws a convex polygon given in beam space; false when no sample sees it. Those that do get `mark`. */
bool beam_draw(Beam *beam, const Vec3f *corners, int count, uint32_t mark);
/* The same of a triangle that lies before the beam's near end, its corners as they are seen: (x, y, key). */
bool beam_draw_seen(Beam *beam, Vec3f a, Vec3f b, Vec3f c, uint32_t mark);

/* Triangles that share corners, which lie before the beam's near end, as they are seen. */
typedef struct BeamMesh {
    const float *x, *y, *key;
    int corners;              /* how many there are, if all of them are corners of what is drawn; else 0 */
    const uint8_t (*triangles)[3];
    uint8_t which[BEAM_MESH]; /* of the triangles: those to be drawn */
    int count;
} BeamMesh;
/* That a sample sees a triangle of a mesh. */
typedef struct BeamSeen {
    uint32_t sample;
    uint8_t triangle;
} BeamSeen;
/* Draws a mesh that lies before few samples, each of which is held against all of its triangles at once: a far lawn takes a quarter less
 * time so. What they see of it is told, their marks are not set; a light's are, as if `mark` were 1, and nothing is told. Returns how many see
 * something, or -1 if too many might: nothing is done then. */
int beam_draw_mesh(Beam *beam, const BeamMesh *mesh, BeamSeen seen[BEAM_FEW_SAMPLES]);

#endif
