/* Where a function of the place changes its sign along a line: every place, found with bounds instead of samples.
 *
 * A piece of the line is given up when bounds prove that the function has no zero on it; else it is cut to where its linear
 * bounds allow one, and halved when that does not help (Gamito & Maddock 2007, figure 1 and equation 16; what is cut is
 * evaluated again before it counts: otherwise 3 % of their hits are false or early). */
#ifndef VTS_SHAPE_LINE_ROOTS_H
#define VTS_SHAPE_LINE_ROOTS_H

#include "scene/scene.h"
#include "tape/tape_lanes.h"

struct NodeCache;

/* How bounds are had: by intervals; by standard affine forms; by reduced ones without and with the cut of equation 16. */
typedef enum LineMethod { LINE_INTERVAL, LINE_STANDARD, LINE_AFFINE, LINE_AFFINE_OPTIMISED } LineMethod;

typedef struct Line {
    const Tape *tape;      /* of three inputs, the place, and one output */
    double level;          /* zeros of the function less this are sought */
    Vec3 origin, direction;
    LineMethod method;
    const TapeSum *sum; /* of the tape, over a box that the line does not leave: bounds of many pieces at once, by LINE_AFFINE_OPTIMISED; or NULL */
    /* With a sum that has levels of detail (tape_detail.h): the function is that of width.start + width.spread·t, in the tape's space. */
    RayWidth width;
    double start; /* the function less `level` where the search begins, which tells how long the first pieces may be; 0: it is not known */
    struct NodeCache *cells; /* what noises of points keep from line to line (node_cache.h), of one thread; NULL: nothing */
} Line;

typedef struct LineWork {
    uint64_t bounds, values; /* evaluations of either kind; added to */
    uint64_t unsettled;      /* pieces of which, after as many bounds as one root may cost, only the signs at their ends are known */
} LineWork;

/* The first place in (from, to) where the function passes from above `level` to not above it, or back; false: there is none. What
 * is no number counts as above. Places closer together than 2⁻⁴⁰ of the way there, or of its coordinates, count as one; where function and level only touch
 * there is none. *falling: it is not above behind the place. `work` may be NULL. */
bool line_first_root(const Line *line, double from, double to, double *t, bool *falling, LineWork *work);

/* Where the search goes on behind a root at t: far enough for the root not to be found again. */
double line_behind(const Line *line, double t);

#endif
