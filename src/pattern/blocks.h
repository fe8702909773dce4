/* The patterns that tile space with blocks: which share of a spot each kind of block has. */
#ifndef VTS_PATTERN_BLOCKS_H
#define VTS_PATTERN_BLOCKS_H

#include "pattern/spot.h"
#include "scene/scene.h"

enum { BLOCK_KINDS = 6 };

/* shares[] add up to 1; those of kinds that the pattern has not are 0. The pigment's kind is one that pattern_traits() gives a
 * number of blocks. */
void block_shares(const Pigment *pigment, const Spot *spot, double shares[BLOCK_KINDS]);
/* The kind of block at a place of pattern space. */
int block_index(const Pigment *pigment, Vec3 p);

#endif
