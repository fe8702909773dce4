/* How thin things are: what is narrower than a pixel may lie between all lines of sight through the middles of pixels. */
#ifndef VTS_RENDER_THIN_H
#define VTS_RENDER_THIN_H

#include "render/cluster.h"

/* The least width of the item in its cluster, or of what it holds, as far as it is known; of triangles, whose widths tell nothing: infinite. Those of the
 * clusters that it is a copy of are known before. */
double thin_item(const Item *item);
/* Whether the item is one solid whose least width is known, from wherever it is seen. */
bool thin_is_known(const Item *item);
/* Sets the widths of all clusters. */
void thin_clusters(const ClusterSet *set);

#endif
