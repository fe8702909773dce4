/* Where rays meet solids, exactly (to rounding), in double precision and object space: `object->transform` is the caller's
 * to apply, to the ray before and to the normal after. */
#ifndef VTS_SHAPE_INTERSECT_H
#define VTS_SHAPE_INTERSECT_H

#include "scene/scene.h"
#include "shape/soup.h"

typedef struct ShapeHit {
    double t;     /* in lengths of the ray's direction */
    Vec3 point;   /* origin + t·direction, moved onto the surface to rounding */
    Vec3 normal;  /* unit, to the outside (disc: its own; plane: its own; open cone: away from the axis) */
    TexCoord uv;  /* as tessellate_solids.h numbers them; planes: lengths along two axes of theirs */
    bool leaving; /* the ray goes from the inside out; false on sheets */
    uint8_t part; /* which of the surface's parts */
} ShapeHit;

/* A place where the ray's line crosses the surface. For solids they come in pairs, in and out, in ascending order. */
typedef struct ShapeCrossing {
    double t;
    uint8_t part; /* which of the surface's parts; for shape_hit_at() */
    bool leaving;
} ShapeCrossing;

enum { SHAPE_MOST_CROSSINGS = 4 };

/* The nearest hit with t_min < t < t_max, for OBJECT_SPHERE, _BOX, _CYLINDER, _CONE, _PLANE, _DISC, _TORUS; false for none
 * and for all other kinds. The direction may have any length but zero. A ray that starts on the surface may find its start
 * at a t of some roundings of the distance from the solid's middle: a t_min above that passes it by. Rays that touch in one
 * point may hit or miss; a solid without any extent is missed. */
bool shape_intersect(const Object *object, const Ray *ray, double t_min, double t_max, ShapeHit *hit);
/* Whether there is one. */
bool shape_crosses(const Object *object, const Ray *ray, double t_min, double t_max);
/* The same as shape_intersect(), but `uv` is left as it is. */
bool shape_meet(const Object *object, const Ray *ray, double t_min, double t_max, ShapeHit *hit);

/* All crossings of the whole line, ascending; returns their number. For a solid the line is inside between crossings
 * 2i and 2i + 1 (a plane's inside may begin or end at infinity). Used for CSG. */
int shape_crossings(const Object *object, const Ray *ray, ShapeCrossing out[SHAPE_MOST_CROSSINGS]);
/* All about one of these crossings. */
ShapeHit shape_hit_at(const Object *object, const Ray *ray, const ShapeCrossing *crossing);
/* Of that only the normal, at a point of the part. */
Vec3 shape_normal_at(const Object *object, Vec3 point, uint8_t part);

/* Whether the point is inside the object or on its boundary, in object space, `inverse` applied. Unions, merges,
 * intersections and differences as of their children; a plane's inside is p · normal <= distance; sheets, open cones,
 * meshes, particles, surfaces and texels have none. */
bool shape_inside(const Object *object, Vec3 point);

/* A box of object space that holds all of the object's surface, tight for single solids. Infinite for planes and for what
 * holds one, and for surfaces with a deform; empty for what has no surface. A child of an intersection whose inside is
 * unbounded (`inverse`) does not narrow it. */
Box3 shape_bounds(const Object *object);
Box3 shape_bounds_infinite(void);

#endif
