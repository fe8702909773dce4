/* Places of maps whose files say only half of it: world files, and .prj files beside a map. */
#ifndef VTS_TERRAIN_MAP_PLACE_H
#define VTS_TERRAIN_MAP_PLACE_H

#include "terrain/map_file.h"

/* Sets the place of a map that lies by x[3] and y[3] (see Georeference) in a system that a .prj file beside it tells; without one,
 * numbers that are longitudes and latitudes are taken for them. When neither helps, file->misplaced says so. */
void map_place_beside(MapFile *file, const double x[3], const double y[3], bool area);

/* The six numbers of a world file beside `path` ("a.tfw" for "a.tif", "a.tifw", "a.wld"); they say where the middle of the first pixel
 * lies. False where there is none, or it is not one. */
bool map_read_world_file(const char *path, double x[3], double y[3]);

/* Sets the place of a picture whose path and size are set: by the tags of a GeoTIFF, else by a world file beside it. */
void map_place_picture(MapFile *file);

/* The projection that the text of a .prj file describes: well-known text, as ESRI, OGC and ISO 19162 have it, or Arc/Info's older keywords.
 * False with a line in `error`, which names a way out. */
bool map_parse_system(const char *text, size_t size, Projection *projection, StrBuf *error);

#endif
