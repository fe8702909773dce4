/* The copies of texels on the way of a march, and how far they leave it empty. */
#ifndef VTS_RENDER_SKIN_COPIES_H
#define VTS_RENDER_SKIN_COPIES_H

#include "render/skin_march.h"

/* Texture coordinates at t of a span. */
Vec3 skin_span_at(const MarchSpan *span, double t);
/* Texture coordinates in the space of the copy's texel, wrapped on its cyclic axes. */
Vec3f skin_copy_place(const TexelCopy *copy, Vec3 x);
/* The copies of texel `i` around the tile of x, in the part of the surface where the march is. They stay until the place is needed for another tile. */
TileCopies *skin_copies_at(SkinMarch *march, size_t i, Vec3 x);
/* The length of empty way from t in all copies of all texels, within the span. Brings what is known of all of them up to date. */
double skin_copies_empty_way(SkinMarch *march, double t);

#endif
