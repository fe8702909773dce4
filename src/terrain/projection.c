#include "terrain/projection.h"

#include <string.h>

static const double WGS84_AXIS = 6378137, WGS84_FLATTENING = 1 / 298.257223563;

/* Degrees by which the outermost row of a map may miss the pole in its file's numbers. */
static const double POLE_ROUNDING = 1e-6;

/* ---- Lambert's azimuthal map of equal areas: Snyder, Map Projections (1987), eq. 24-2 to 24-26, on the authalic sphere ---- */

/* Angles on the sphere as sines and cosines. */
typedef struct Angle {
    double sine, cosine;
} Angle;
static Angle angle_of(double degrees) {
    double quarter = fabs(degrees) == 90 ? 0 : cos(degrees * VTS_RADIANS);
    return (Angle){sin(degrees * VTS_RADIANS), quarter};
}

static Angle azimuthal_origin(const Projection *p) { return angle_of(geodesy_authalic(&p->map, p->parameters.latitude)); }

static bool azimuthal_init(Projection *p) {
    const ProjectionParameters *a = &p->parameters;
    double e2 = a->flattening * (2 - a->flattening);
    if (!geodesy_map_init(&p->map, GEODESY_AUTHALIC, a->axis, a->flattening, a->parallels, 1)) return false;
    Angle geodetic = angle_of(a->latitude), middle = azimuthal_origin(p);
    p->constants[0] = geodesy_authalic_radius(&p->map);
    p->constants[1] = middle.cosine > 0 ? a->axis * geodetic.cosine / sqrt(1 - e2 * geodetic.sine * geodetic.sine) /
                                              (p->constants[0] * middle.cosine)
                                        : 1;
    return true;
}

static bool azimuthal_forward(const Projection *p, double latitude, double longitude, double out[2]) {
    Angle middle = azimuthal_origin(p), at = angle_of(geodesy_authalic(&p->map, latitude)), turn = angle_of(longitude - p->meridian);
    double reach = 1 + middle.sine * at.sine + middle.cosine * at.cosine * turn.cosine, stretch = p->constants[1];
    if (!(reach > 1e-12)) return false; /* the other side of the globe is a circle */
    double b = p->constants[0] * sqrt(2 / reach);
    out[0] = b * stretch * at.cosine * turn.sine;
    out[1] = b / stretch * (middle.cosine * at.sine - middle.sine * at.cosine * turn.cosine);
    return true;
}

static bool azimuthal_reverse(const Projection *p, double x, double y, double out[2]) {
    Angle middle = azimuthal_origin(p);
    double east = x / p->constants[1], north = y * p->constants[1], distance = hypot(east, north);
    if (!(distance <= 2 * p->constants[0])) return false;
    double angle = 2 * asin(distance / (2 * p->constants[0])), along = cos(angle), across = distance > 0 ? sin(angle) / distance : 0;
    double up = along * middle.sine + across * north * middle.cosine;
    double forward = along * middle.cosine - across * north * middle.sine, sideways = across * east;
    out[0] = geodesy_authalic_back(&p->map, atan2(up, hypot(forward, sideways)) / VTS_RADIANS);
    out[1] = p->meridian + atan2(sideways, forward) / VTS_RADIANS;
    return true;
}

/* ---- maps of the sphere ---- */

static double turn_from(double meridian, double longitude) { return remainder(longitude - meridian, 360); }

static void spherical_forward(const Projection *p, double latitude, double longitude, double out[2]) {
    const ProjectionParameters *a = &p->parameters;
    double east = turn_from(p->meridian, longitude) * VTS_RADIANS, north = latitude * VTS_RADIANS;
    bool mercator = a->kind == PROJECTION_WEB_MERCATOR;
    out[0] = a->axis * east * (mercator ? 1 : cos(a->parallels[0] * VTS_RADIANS));
    out[1] = a->axis * (mercator ? asinh(tan(north)) : north);
}

static void spherical_reverse(const Projection *p, double x, double y, double out[2]) {
    const ProjectionParameters *a = &p->parameters;
    bool mercator = a->kind == PROJECTION_WEB_MERCATOR;
    double north = y / a->axis;
    out[0] = (mercator ? atan(sinh(north)) : north) / VTS_RADIANS;
    out[1] = p->meridian + x / (a->axis * (mercator ? 1 : cos(a->parallels[0] * VTS_RADIANS))) / VTS_RADIANS;
}

/* ---- all of them ---- */

static GeodesyMapKind map_kind(ProjectionKind kind) {
    switch (kind) {
    case PROJECTION_TRANSVERSE_MERCATOR: return GEODESY_TRANSVERSE_MERCATOR;
    case PROJECTION_ALBERS: return GEODESY_ALBERS;
    case PROJECTION_POLAR_STEREOGRAPHIC: return GEODESY_POLAR_STEREOGRAPHIC;
    default: return GEODESY_LAMBERT_CONFORMAL; /* of which Mercator is the case of opposite parallels */
    }
}

/* The pole that the map is made about. */
static bool is_northern(const ProjectionParameters *a) {
    return a->kind == PROJECTION_ALBERS ? a->parallels[0] + a->parallels[1] >= 0 : a->latitude > 0;
}

/* Metres, without the shift. */
static bool map_forward(const Projection *p, double latitude, double longitude, double out[2]) {
    switch (p->parameters.kind) {
    case PROJECTION_LAMBERT_AZIMUTHAL: return azimuthal_forward(p, latitude, longitude, out);
    case PROJECTION_WEB_MERCATOR:
    case PROJECTION_EQUIRECTANGULAR: spherical_forward(p, latitude, longitude, out); return true;
    default: return geodesy_map_forward(&p->map, map_kind(p->parameters.kind), is_northern(&p->parameters), p->meridian, latitude, longitude, out);
    }
}

static bool map_reverse(const Projection *p, double x, double y, double out[2]) {
    switch (p->parameters.kind) {
    case PROJECTION_LAMBERT_AZIMUTHAL: return azimuthal_reverse(p, x, y, out);
    case PROJECTION_WEB_MERCATOR:
    case PROJECTION_EQUIRECTANGULAR: spherical_reverse(p, x, y, out); return true;
    default: return geodesy_map_reverse(&p->map, map_kind(p->parameters.kind), is_northern(&p->parameters), p->meridian, x, y, out);
    }
}

static void fill_defaults(ProjectionParameters *a) {
    if (a->axis == 0) {
        a->axis = WGS84_AXIS;
        a->flattening = WGS84_FLATTENING;
    }
    if (a->unit == 0) a->unit = 1;
    if (a->scale == 0 && a->kind != PROJECTION_POLAR_STEREOGRAPHIC) a->scale = 1;
    if (a->scale == 0 && a->parallels[0] == 0) a->scale = 1;
}

static const char *parameters_fault(const ProjectionParameters *a) {
    const double all[] = {a->axis,      a->flattening,   a->unit,         a->prime_meridian, a->latitude,    a->longitude,
                          a->scale,     a->parallels[0], a->parallels[1], a->false_east,     a->false_north};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(all); i++)
        if (!isfinite(all[i])) return "a parameter of the map projection is no number";
    if (!(a->axis > 0 && a->flattening >= 0 && a->flattening < 0.1)) return "the map's ellipsoid has the shape of no planet";
    if (!(a->unit > 0)) return "the map's unit of length must be greater than 0";
    if (!(a->scale >= 0)) return "the map projection's scale must be greater than 0";
    if (fabs(a->latitude) > 90 || fabs(a->parallels[0]) > 90 || fabs(a->parallels[1]) > 90)
        return "a latitude of the map projection lies beyond a pole";
    if (a->kind == PROJECTION_POLAR_STEREOGRAPHIC && fabs(a->latitude) != 90) return "the middle of a polar map must be a pole";
    if (a->kind == PROJECTION_EQUIRECTANGULAR && fabs(a->parallels[0]) > 89.9) return "an equirectangular map has no true scale at a pole";
    return NULL;
}

static bool map_init(Projection *p) {
    const ProjectionParameters *a = &p->parameters;
    const double opposite[2] = {a->parallels[0], -a->parallels[0]};
    switch (a->kind) {
    case PROJECTION_LONLAT:
    case PROJECTION_WEB_MERCATOR:
    case PROJECTION_EQUIRECTANGULAR: return true;
    case PROJECTION_LAMBERT_AZIMUTHAL: return azimuthal_init(p);
    case PROJECTION_MERCATOR: return geodesy_map_init(&p->map, GEODESY_LAMBERT_CONFORMAL, a->axis, a->flattening, opposite, a->scale);
    default: return geodesy_map_init(&p->map, map_kind(a->kind), a->axis, a->flattening, a->parallels, a->scale);
    }
}

/* Where the map has its origin, before any shift; polar maps and azimuthal ones have it in their middle. */
static bool origin_of(const Projection *p, double out[2]) {
    ProjectionKind kind = p->parameters.kind;
    out[0] = out[1] = 0;
    bool conic = kind == PROJECTION_LAMBERT_CONFORMAL || kind == PROJECTION_ALBERS;
    if (!conic && kind != PROJECTION_TRANSVERSE_MERCATOR && kind != PROJECTION_MERCATOR) return true;
    return map_forward(p, p->parameters.latitude, p->meridian, out);
}

bool projection_init(Projection *projection, const ProjectionParameters *parameters, StrBuf *error) {
    Projection p = {.parameters = *parameters};
    double origin[2];
    fill_defaults(&p.parameters);
    p.meridian = p.parameters.longitude + p.parameters.prime_meridian;
    const char *fault = parameters_fault(&p.parameters);
    if (!fault && !(map_init(&p) && origin_of(&p, origin))) fault = "the parameters of the map projection make no map";
    if (fault) {
        if (error) strbuf_adds(error, fault);
        return false;
    }
    p.shift[0] = p.parameters.false_east - origin[0];
    p.shift[1] = p.parameters.false_north - origin[1];
    *projection = p;
    return true;
}

void projection_lonlat(Projection *projection) { projection_init(projection, &(ProjectionParameters){.kind = PROJECTION_LONLAT}, NULL); }

bool projection_utm(Projection *projection, int zone, bool north) {
    ProjectionParameters a = {.kind = PROJECTION_TRANSVERSE_MERCATOR, .longitude = 6 * zone - 183, .scale = 0.9996, .false_east = 500000};
    a.false_north = north ? 0 : 10000000;
    if (zone < 0 || zone > 60) return false;
    if (zone == 0)
        a = (ProjectionParameters){.kind = PROJECTION_POLAR_STEREOGRAPHIC, .latitude = north ? 90 : -90, .scale = 0.994, .false_east = 2000000, .false_north = 2000000};
    return projection_init(projection, &a, NULL);
}

bool projection_forward(const Projection *projection, GeoPlace place, double *x, double *y) {
    const ProjectionParameters *a = &projection->parameters;
    double to[2] = {place.longitude - a->prime_meridian, place.latitude};
    if (!(fabs(place.latitude) <= 90) || !isfinite(place.longitude)) return false;
    if (a->kind != PROJECTION_LONLAT && !map_forward(projection, place.latitude, place.longitude, to)) return false;
    to[0] = (to[0] + projection->shift[0]) / a->unit;
    to[1] = (to[1] + projection->shift[1]) / a->unit;
    if (!isfinite(to[0]) || !isfinite(to[1])) return false;
    *x = to[0];
    *y = to[1];
    return true;
}

bool projection_reverse(const Projection *projection, double x, double y, GeoPlace *out) {
    const ProjectionParameters *a = &projection->parameters;
    double east = x * a->unit - projection->shift[0], north = y * a->unit - projection->shift[1];
    double to[2] = {north, east + a->prime_meridian};
    if (!isfinite(east) || !isfinite(north)) return false;
    if (a->kind != PROJECTION_LONLAT && !map_reverse(projection, east, north, to)) return false;
    if (!(fabs(to[0]) < 90 + POLE_ROUNDING) || !isfinite(to[1])) return false;
    to[0] = double_clamp(to[0], -90, 90);
    *out = (GeoPlace){to[0], to[1], 0};
    return true;
}
