/* Where in a picture only one thing can be seen, so that nobody needs to look: between lines of sight that meet the same, when nothing
 * else is near them. */
#ifndef VTS_RENDER_VISTA_H
#define VTS_RENDER_VISTA_H

#include "base/arena.h"
#include "base/vec.h"

/* A thing that has an end. */
typedef struct VistaPiece {
    Box3 box;
    double width;    /* of its thinnest part, as far as it is known */
    bool whole;      /* one solid, of which it is known */
    uint32_t object; /* from 1; of what is not convex, or not known to be: 0 */
} VistaPiece;

/* All that can be seen, but for planes. */
typedef struct VistaPieces {
    VistaPiece *items;
    size_t count;
    bool endless; /* there are more that have no end: nothing can be told */
} VistaPieces;

enum { VISTA_MOST = 16 };

/* Those of the pieces that are near a part of the picture. */
typedef struct Vista {
    const VistaPiece *near[VISTA_MOST];
    int count; /* beyond VISTA_MOST: nothing can be told */
} Vista;

/* `corners`: lines of sight, unit directions, through one point or parallel, all others of that part are between them; rows of two. */
Vista vista_of(const VistaPieces *pieces, const Ray corners[4]);
typedef enum VistaView {
    VISTA_OPEN, /* anything may be seen */
    VISTA_SOME, /* a few things may be seen besides planes, and holes in them */
    VISTA_WIDE, /* all see what the corners see, unless the edge of something goes through that is too wide to lie between them */
    VISTA_EVEN, /* all see what the corners see */
} VistaView;

/* How wide something is to count as wide: `spread` times its distance from where the lines begin, and `width` more. */
typedef struct VistaWidth {
    double spread, width;
} VistaWidth;

/* What may be seen between these lines, which are of the vista's part and all meet `object` first (0: nothing, or a plane). */
VistaView vista_view(const Vista *vista, const Ray corners[4], uint32_t object, VistaWidth wide);

/* Whether something may be seen between the lines that is not so wide there, and so may lie between pixels' middles. Of too many pieces nothing
 * is told. */
bool vista_has_thin(const VistaPieces *pieces, const Ray corners[4], VistaWidth wide);

#endif
