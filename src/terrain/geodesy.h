/* Places on the globe and the scene's own frame. Latitudes and longitudes in degrees on WGS84, heights and lengths in metres; a height
 * is above the ellipsoid. Any longitude is taken, those given back lie in [-180, 180]. Functions that may fail return false for what
 * is no place (a latitude beyond a pole, what is not finite) and leave *out alone. Everything is thread-safe. */
#ifndef VTS_TERRAIN_GEODESY_H
#define VTS_TERRAIN_GEODESY_H

#include "base/vec.h"

typedef struct GeoPlace {
    double latitude, longitude, height;
} GeoPlace;

/* Where the scene lies: its origin is at a place, x points east there, y up, z north. Curved: the tangent frame, in which the earth
 * falls away from the plane y = 0. Flat: the map that keeps distances and directions from the origin (azimuthal equidistant), with
 * heights straight up. */
typedef struct GeoFrame {
    GeoPlace origin;
    bool flat;
    Vec3 centre; /* geocentric place of the origin */
    Mat3 axes;   /* its columns: the scene's x, y, z in geocentric coordinates */
} GeoFrame;

bool geo_place_is_valid(GeoPlace place);

bool geo_frame_init(GeoFrame *frame, GeoPlace origin, bool flat);
bool geo_to_scene(const GeoFrame *frame, GeoPlace place, Vec3 *out);
bool scene_to_geo(const GeoFrame *frame, Vec3 point, GeoPlace *out);
/* A direction that is known at `place` by its parts (east, up, north), as the scene has it. In a flat frame directions turn with the
 * map, and remain at the same height above the horizon. */
bool geo_direction_to_scene(const GeoFrame *frame, GeoPlace place, Vec3 east_up_north, Vec3 *out);

typedef struct GeodesicLine {
    double distance;     /* along the ellipsoid, whatever the heights */
    double azimuth;      /* at A, towards B: clockwise from north, in [-180, 180] */
    double azimuth_back; /* at B, towards A */
} GeodesicLine;
bool geodesic_inverse(GeoPlace a, GeoPlace b, GeodesicLine *out);
/* The place at a distance from A in the direction of an azimuth; its height is A's. */
bool geodesic_direct(GeoPlace a, double azimuth, double distance, GeoPlace *out);

typedef struct UtmPlace {
    double easting, northing;
    int zone; /* 1 to 60, with the exceptions of Norway and Svalbard; 0: UPS, north of 84 degrees and south of -80 */
    bool north;
} UtmPlace;
bool utm_from_geo(GeoPlace place, UtmPlace *out);

#endif
