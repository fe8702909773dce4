/* The patterns that tile space with blocks: which share of a spot each kind of block has. */
#ifndef VTS_PATTERN_BLOCKS_H
#define VTS_PATTERN_BLOCKS_H

#include "pattern/spot.h"

enum { BLOCK_KINDS = 3 };

/* shares[] add up to 1; [0 .. kinds) are used. */
void checker_shares(const Spot *spot, double shares[BLOCK_KINDS]); /* 2: even, odd */
void brick_shares(const Spot *spot, double shares[BLOCK_KINDS]);   /* 2: mortar, brick */
void hexagon_shares(const Spot *spot, double shares[BLOCK_KINDS]); /* 3 */

#endif
