/* The tips of height vectors as masses that springs hold: what a wind bends swings back, and on (Neyret 1998, section VII).
 *
 * A tip keeps its distance L from its foot. With d its direction, h that at rest, F the wind's force and s the wind's `stiffness`,
 *     d″ = K·(h − d + F/s) − C·d′ + what neighbours pull,
 * so that alone it comes to rest where wind_bend() has it, and swings √K/2π times a second about there. Tips at both ends of an edge are
 * joined by a spring as long as they are apart at rest, of the stiffness K·(L/edge)² for each unit of mass: what bends one bends those
 * within about its height, however fine the edges. */
#ifndef VTS_GROW_TIPS_H
#define VTS_GROW_TIPS_H

#include "grow/spring_net.h"
#include "scene/scene.h"

/* Two neighbours, by number. */
typedef struct TipsEdge {
    uint32_t a, b;
} TipsEdge;

typedef struct TipsSpec {
    size_t count;
    const Vec3 *feet, *heights; /* height vectors at rest; one without length stays so */
    const TipsEdge *edges;
    size_t edge_count;
    double stiffness, damping;  /* K > 0, C >= 0 */
    const WindField *wind;      /* NULL: none */
    double begins;              /* the wind's time at the start, seconds */
    const Vec3 *start;          /* height vectors at the start; NULL: as the wind bends them then */
} TipsSpec;

/* Mass number i is tip i. Lives in `arena`, and needs what the spec points to but the edges. */
SpringNet *tips_create(const TipsSpec *spec, Arena *arena);
/* Spring evaluations for one second: what following them costs, about 15 ns each. */
double tips_work(const TipsSpec *spec);
/* All that their movement depends on. */
Hash128 tips_hash(const TipsSpec *spec);
/* How long before time 0 springs must begin, in whole rounds of a wind that goes round, to be nearly at the end of a round what they were at its
 * beginning; 0 for other winds. */
double tips_lead(const SkinSprings *springs, const WindField *wind);
/* The height vector of a tip where it is, of one that stands as `height` at rest and that the wind alone would have at `bent`: this where it has
 * no direction, and never lower, as seen along `height`, than nearly flat: what swings that far lies on the ground meanwhile. */
Vec3 tips_height(Vec3 foot, Vec3 height, Vec3 tip, Vec3 bent);

#endif
