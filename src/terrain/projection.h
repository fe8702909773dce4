/* Projected coordinate systems: what maps are drawn in. Angles in degrees; coordinates x, y in the system's own units (degrees or grads
 * of a geographic system, feet …), x to the east. Geographic places are those of the system's datum, which is taken for WGS84: only
 * datums that differ from it by metres at most are let in. A Projection is a plain value: copy it, share it between threads. */
#ifndef VTS_TERRAIN_PROJECTION_H
#define VTS_TERRAIN_PROJECTION_H

#include "base/strbuf.h"
#include "terrain/geodesy.h"
#include "terrain/geodesy_shim.h"

typedef enum ProjectionKind {
    PROJECTION_LONLAT, /* x is the longitude, y the latitude */
    PROJECTION_TRANSVERSE_MERCATOR,
    PROJECTION_LAMBERT_CONFORMAL, /* equal parallels: with one, and a scale on it */
    PROJECTION_ALBERS,
    PROJECTION_POLAR_STEREOGRAPHIC,
    PROJECTION_MERCATOR,
    PROJECTION_WEB_MERCATOR,
    PROJECTION_LAMBERT_AZIMUTHAL, /* equal areas */
    PROJECTION_EQUIRECTANGULAR,   /* of a sphere with the ellipsoid's axis */
} ProjectionKind;

typedef struct ProjectionParameters {
    ProjectionKind kind;
    double axis, flattening;     /* of the ellipsoid; axis 0: WGS84 */
    double unit;                 /* metres (geographic systems: degrees) of one unit; 0: 1 */
    double prime_meridian;       /* degrees east of Greenwich; longitudes below are counted from it */
    double latitude, longitude;  /* of the projection's origin; polar maps: 90 or -90, and the meridian that points down (up) from there */
    double parallels[2];         /* of conics; the first: of true scale, for polar (where scale is 0), Mercator and equirectangular maps */
    double scale;                /* on the central meridian, at the parallels, at the pole; 0: 1 */
    double false_east, false_north; /* metres */
} ProjectionParameters;

typedef struct Projection {
    ProjectionParameters parameters;
    double meridian;   /* of the origin, from Greenwich */
    double shift[2];   /* metres: added to what the map gives, so that the origin has the false easting and northing */
    double constants[2]; /* of Lambert's azimuthal map: radius of the sphere, stretch to the east */
    GeodesyMap map;
} Projection;

/* False, with a line of text in `error`, where the parameters make no map. */
bool projection_init(Projection *projection, const ProjectionParameters *parameters, StrBuf *error);
/* Longitude and latitude in degrees on WGS84. */
void projection_lonlat(Projection *projection);
/* On WGS84; zone 1 to 60, or 0 for UPS. */
bool projection_utm(Projection *projection, int zone, bool north);
/* A code of the EPSG's list. Some are arithmetic, the rest is looked up in PROJ's data. False, with a line of text in `error` that names
 * a way out, for codes that are not known, maps that are not modelled, and datums that are not WGS84's. */
bool projection_from_epsg(Projection *projection, int code, StrBuf *error);

/* False where the place is no point of the map. The height is not used. */
bool projection_forward(const Projection *projection, GeoPlace place, double *x, double *y);
/* The height is set to 0. Longitudes of a geographic system are given back as they are, beyond 180 degrees too. */
bool projection_reverse(const Projection *projection, double x, double y, GeoPlace *out);

/* "UTM zone 33 north", "longitude and latitude", "Lambert conformal conic, 1st parallel 45 …": one line. */
void projection_describe(const Projection *projection, StrBuf *out);

#endif
