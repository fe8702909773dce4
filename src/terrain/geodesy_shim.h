/* What GeographicLib does for us, as C functions. No exception leaves them: where it throws, they return false. Angles in degrees,
 * lengths in metres; the ellipsoid is WGS84 unless one is given. All are thread-safe. */
#ifndef VTS_TERRAIN_GEODESY_SHIM_H
#define VTS_TERRAIN_GEODESY_SHIM_H

#include "base/common.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Geocentric coordinates of a place, and there the unit vectors east, north, up as columns (row-major; NULL: not wanted). */
bool geodesy_geocentric(double latitude, double longitude, double height, double out[3], double axes[9]);
/* The way back: latitude, longitude in [-180, 180], height. */
bool geodesy_geocentric_back(const double in[3], double out[3]);

/* The shortest line from A to B on the ellipsoid: distance, azimuth at A, azimuth of going on at B. */
bool geodesy_inverse(double latitude_a, double longitude_a, double latitude_b, double longitude_b, double out[3]);
/* Where one gets from A: latitude, longitude in [-180, 180], azimuth there. */
bool geodesy_direct(double latitude, double longitude, double azimuth, double distance, double out[3]);

/* Easting, northing; *zone in 1..60, 0: UPS, near the poles. */
bool geodesy_utm(double latitude, double longitude, int *zone, bool *north, double out[2]);

/* Projections that need constants of their own: what GeographicLib calls an object, held in place by whoever owns it. */
enum { GEODESY_MAP_SIZE = 128 };
typedef struct GeodesyMap {
    double state[GEODESY_MAP_SIZE];
} GeodesyMap;

typedef enum GeodesyMapKind {
    GEODESY_TRANSVERSE_MERCATOR,
    GEODESY_LAMBERT_CONFORMAL, /* first and second parallel; scale on them */
    GEODESY_ALBERS,            /* likewise */
    GEODESY_POLAR_STEREOGRAPHIC, /* scale at the pole or, where that is 0, true scale at the first parallel */
    GEODESY_AUTHALIC,            /* no map: authalic latitudes, see below */
} GeodesyMapKind;

/* Ellipsoid: semi-major axis and flattening. False where no such map exists. */
bool geodesy_map_init(GeodesyMap *map, GeodesyMapKind kind, double axis, double flattening, const double parallels[2], double scale);
/* From latitude and longitude to x east of the `meridian`, y north: of the equator for transverse Mercator, of the latitude where the
 * cone's scale is least for conics, of the pole itself for polar maps. `north`: which pole that is; for Albers' cones, whether the sum of
 * the parallels is 0 or more. */
bool geodesy_map_forward(const GeodesyMap *map, GeodesyMapKind kind, bool north, double meridian, double latitude, double longitude, double out[2]);
bool geodesy_map_reverse(const GeodesyMap *map, GeodesyMapKind kind, bool north, double meridian, double x, double y, double out[2]);

/* The latitude on the sphere of the same area, by a map of kind GEODESY_AUTHALIC; the way back; that sphere's radius. */
double geodesy_authalic(const GeodesyMap *map, double latitude);
double geodesy_authalic_back(const GeodesyMap *map, double latitude);
double geodesy_authalic_radius(const GeodesyMap *map);

#ifdef __cplusplus
}
#endif
#endif
