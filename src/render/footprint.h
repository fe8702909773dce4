/* What a cone covers of a surface, and how wide it is after a mirror or a lens.
 *
 * A cone stands for the bundle of rays of a pixel: its diameter is that of the bundle across its axis. Igehy 1999, "Tracing Ray Differentials"
 * (SIGGRAPH), sec. 3, gives what becomes of the bundle; here its two principal directions are taken as equally wide. */
#ifndef VTS_RENDER_FOOTPRINT_H
#define VTS_RENDER_FOOTPRINT_H

#include "render/cone.h"
#include "render/hierarchy.h"

/* The two axes, of full width, of the cone's section at t with a plane of this unit normal: along the plane the way the cone goes, and
 * across. At grazing angles the first ends at 100 diameters. */
void footprint_axes(const Cone *cone, double t, Vec3 normal, Vec3 axes[2]);

/* How much the surface is bent about a hit of the cone at hit->t, 1/length: positive where it bulges towards the eye, the mean of two
 * directions, found by two rays beside the axis, of a sphere by one; 0 where these meet something else, or of what is flat. */
double footprint_curvature(const Hierarchy *hierarchy, RayPurpose purpose, const Cone *cone, const SurfaceHit *hit);

/* The cone that leaves the hit at t in unit direction `direction` from a place beside it, `origin`. `bend`: by how much the direction turns
 * when the normal turns by 1: 2 of a mirror; n cos i − cos t of a boundary with n = n1/n2 under the angles i and t, negative where the
 * bundle is gathered. */
Cone footprint_leave(const Cone *cone, double t, Vec3 origin, Vec3 direction, double curvature, double bend);

#endif
