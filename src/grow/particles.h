/* Particles swept into blades, hairs and needles (Reeves & Blau 1985): p(t) = position + velocity·t + acceleration·t²/2. */
#ifndef VTS_GROW_PARTICLES_H
#define VTS_GROW_PARTICLES_H

#include "scene/scene.h"
#include "shape/soup.h"

/* Appends the particles to *out, in their own space; matches TessellateParticles. The width runs linearly in t from foot to
 * tip and is that of the material: a flat or folded blade has the area ∫ width ds, a round one the wall ∫ π width ds.
 *
 * Where a blade looks: it is widest across the horizontal direction of its velocity (of its mean velocity when it starts
 * upright; of a hash of position and velocity when all of it stands upright), so that its front is the side that is above
 * when it bends over. From there the frame turns with the tangent and no further (it minimises rotation: a parabola lies in
 * a plane, whose normal is constant); `twist` then turns it about the tangent in proportion to t.
 *   BLADE_V      two strips that meet in the mid-rib at 110 degrees and open to the front; the middle of the profile, halfway
 *                between rib and edges, follows the trajectory, so that bending does not change the area
 *   BLADE_FLAT   one strip
 *   BLADE_ROUND  a closed tube with flat ends, solid; its polygon has the perimeter of the circle
 * Texture coordinates: u across (round: turns), v = t/life. Segments are as many as `tolerance` asks, at most 256. Particles
 * of no life, length or width, or that are not finite, leave nothing. */
void particles_tessellate(const Particle *items, size_t count, double tolerance, Arena *arena,
                          TriangleSoup *out);

#endif
