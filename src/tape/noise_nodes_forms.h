/* Noises made of scattered points as reduced affine forms (affine.h) on pieces of a line.
 *
 * place[k·count + i]: coordinate k of piece i of `count`, at most 8; pieces that lie together share the search for points. `cells` (node_cache.h) may be
 * NULL; else it is asked for cells, and keeps what was worked out. */
#ifndef VTS_TAPE_NOISE_NODES_FORMS_H
#define VTS_TAPE_NOISE_NODES_FORMS_H

#include "tape/affine.h"

struct NodeCache;

/* noise_worley() of the nodes number 0 … last: out[k·count + i] is that to node k. Squares of distances to nodes along a line differ by
 * linear functions, so that what the next one, the second … is made of is known but for the corners where two change places. */
void affine_worley(int count, const AffineForm *place, int last, AffineForm *out, struct NodeCache *cells);

/* noise_sparse_convolution(): second order. Of more impulses a cell than this only the range is found. */
enum { SPARSE_FEW = 10 };
void affine_sparse_convolution(int count, const AffineForm *place, int impulses, AffineForm *out, struct NodeCache *cells);

#endif
