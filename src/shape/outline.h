/* Curves in a plane, piece by piece polynomials: what prisms, lathes, polygons and letters are made of. */
#ifndef VTS_SHAPE_OUTLINE_H
#define VTS_SHAPE_OUTLINE_H

#include "base/arena.h"
#include "scene/solids.h"

/* (x(s), y(s)) for s in [0, 1], x(s) = x[0] + x[1] s + x[2] s² + x[3] s³. */
typedef struct OutlinePiece {
    double x[4], y[4];
    Point2 min, max;
} OutlinePiece;

typedef struct Outline {
    OutlinePiece *items;
    size_t count, capacity;
    Point2 min, max; /* of all pieces */
} Outline;

Point2 outline_at(const OutlinePiece *piece, double s);
Point2 outline_tangent(const OutlinePiece *piece, double s);
/* Appends a piece given by its coefficients. */
void outline_add(Arena *arena, Outline *outline, const double x[4], const double y[4]);
void outline_add_line(Arena *arena, Outline *outline, Point2 a, Point2 b);
void outline_add_bezier(Arena *arena, Outline *outline, const Point2 points[4]);
/* The pieces of POV-Ray's splines: quadratic ones begin at the second point, cubic (Catmull-Rom) ones reach from the second to the
 * last but one. */
void outline_add_curve(Arena *arena, Outline *outline, CurveKind kind, const Point2 *points, size_t count);
/* The same for prisms: several closed curves, each until its first point (linear), or its first but one, returns. */
void outline_add_closed(Arena *arena, Outline *outline, CurveKind kind, const Point2 *points, size_t count);
/* Coefficients of one piece of a spline through p[1] and p[2]; p[3] is read by cubic kinds, p[0] not by linear ones. */
void outline_coefficients(CurveKind kind, const double p[4], double c[4]);

/* Where a·x + b·y + c = 0 on the piece: parameters in [0, 1]; returns their number, at most 3. */
int outline_meet(const OutlinePiece *piece, double a, double b, double c, double s[3]);
/* Turns of the outline about the point, counted by crossings to the right of it. */
int outline_winding(const Outline *outline, Point2 p);
/* Whether an odd number of crossings lies to the right of it. */
bool outline_odd(const Outline *outline, Point2 p);

#endif
