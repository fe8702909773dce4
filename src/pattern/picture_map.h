/* image_map and image_pattern: pictures laid over pattern space. */
#ifndef VTS_PATTERN_PICTURE_MAP_H
#define VTS_PATTERN_PICTURE_MAP_H

#include "pattern/spot.h"
#include "scene/scene.h"

/* The picture's colour at a spot of pattern space. */
Color picture_map_color(const ImageMap *image, const Spot *spot);
/* Its grey; 1 - alpha where the text asks for that and the picture has one. */
double picture_map_value(const ImageMap *image, const Spot *spot);
/* bump_map: the greys at a spot, a pixel to the left of and below it, and to the right and below; false outside of the picture. */
bool picture_map_heights(const ImageMap *image, const Spot *spot, double out[3]);
/* material_map: the picture's palette index, or the red of 256, at a spot's middle. */
size_t picture_map_index(const ImageMap *image, const Spot *spot);

#endif
