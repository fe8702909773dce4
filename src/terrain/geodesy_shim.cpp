/* The only C++ that touches GeographicLib. */
#include "terrain/geodesy_shim.h"

#include <GeographicLib/AlbersEqualArea.hpp>
#include <GeographicLib/Ellipsoid.hpp>
#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/LambertConformalConic.hpp>
#include <GeographicLib/PolarStereographic.hpp>
#include <GeographicLib/TransverseMercator.hpp>
#include <GeographicLib/UTMUPS.hpp>

#include <algorithm>
#include <cmath>
#include <new>
#include <type_traits>
#include <vector>

using GeographicLib::AlbersEqualArea;
using GeographicLib::Ellipsoid;
using GeographicLib::Geocentric;
using GeographicLib::Geodesic;
using GeographicLib::LambertConformalConic;
using GeographicLib::PolarStereographic;
using GeographicLib::TransverseMercator;
using GeographicLib::UTMUPS;

namespace {

/* GeographicLib takes NaN for an answer, and what is beyond the poles for NaN. */
bool is_place(double latitude, double longitude) {
    return std::isfinite(longitude) && latitude >= -90 && latitude <= 90;
}

bool all_finite(const double *values, int count) {
    return std::all_of(values, values + count, [](double v) { return std::isfinite(v); });
}

template <class Map> Map &map_of(GeodesyMap *map) { return *std::launder(reinterpret_cast<Map *>(map->state)); }
template <class Map> const Map &map_of(const GeodesyMap *map) { return *std::launder(reinterpret_cast<const Map *>(map->state)); }

/* Into storage that may be copied as bytes and needs no destructor. */
template <class Map, class... Arguments> void place(GeodesyMap *map, Arguments... arguments) {
    static_assert(sizeof(Map) <= sizeof map->state && alignof(Map) <= alignof(double), "GEODESY_MAP_SIZE is too small");
    static_assert(std::is_trivially_copyable_v<Map> && std::is_trivially_destructible_v<Map>, "a map must be a plain value");
    new (static_cast<void *>(map->state)) Map(arguments...);
}

} // namespace

bool geodesy_geocentric(double latitude, double longitude, double height, double out[3], double axes[9]) try {
    if (!is_place(latitude, longitude) || !std::isfinite(height)) return false;
    const Geocentric &earth = Geocentric::WGS84();
    double to[3];
    if (axes) {
        std::vector<double> matrix(9);
        earth.Forward(latitude, longitude, height, to[0], to[1], to[2], matrix);
        std::copy(matrix.begin(), matrix.end(), axes);
    } else
        earth.Forward(latitude, longitude, height, to[0], to[1], to[2]);
    std::copy(to, to + 3, out);
    return true;
} catch (...) {
    return false;
}

bool geodesy_geocentric_back(const double in[3], double out[3]) try {
    double to[3];
    if (!all_finite(in, 3)) return false;
    Geocentric::WGS84().Reverse(in[0], in[1], in[2], to[0], to[1], to[2]);
    if (!all_finite(to, 3)) return false;
    std::copy(to, to + 3, out);
    return true;
} catch (...) {
    return false;
}

bool geodesy_inverse(double latitude_a, double longitude_a, double latitude_b, double longitude_b, double out[3]) try {
    double to[3];
    if (!is_place(latitude_a, longitude_a) || !is_place(latitude_b, longitude_b)) return false;
    Geodesic::WGS84().Inverse(latitude_a, longitude_a, latitude_b, longitude_b, to[0], to[1], to[2]);
    if (!all_finite(to, 3)) return false;
    std::copy(to, to + 3, out);
    return true;
} catch (...) {
    return false;
}

bool geodesy_direct(double latitude, double longitude, double azimuth, double distance, double out[3]) try {
    double to[3];
    if (!is_place(latitude, longitude) || !std::isfinite(azimuth) || !std::isfinite(distance)) return false;
    Geodesic::WGS84().Direct(latitude, longitude, azimuth, distance, to[0], to[1], to[2]);
    if (!all_finite(to, 3)) return false;
    std::copy(to, to + 3, out);
    return true;
} catch (...) {
    return false;
}

bool geodesy_utm(double latitude, double longitude, int *zone, bool *north, double out[2]) try {
    if (!is_place(latitude, longitude)) return false;
    double x, y;
    UTMUPS::Forward(latitude, longitude, *zone, *north, x, y);
    out[0] = x;
    out[1] = y;
    return true;
} catch (...) {
    return false;
}

bool geodesy_map_init(GeodesyMap *map, GeodesyMapKind kind, double axis, double flattening, const double parallels[2], double scale) try {
    switch (kind) {
    case GEODESY_TRANSVERSE_MERCATOR: place<TransverseMercator>(map, axis, flattening, scale); return true;
    case GEODESY_LAMBERT_CONFORMAL: place<LambertConformalConic>(map, axis, flattening, parallels[0], parallels[1], scale); return true;
    case GEODESY_ALBERS: {
        double sign = parallels[0] + parallels[1] < 0 ? -1 : 1;
        place<AlbersEqualArea>(map, axis, flattening, sign * parallels[0], sign * parallels[1], scale);
        return true;
    }
    case GEODESY_POLAR_STEREOGRAPHIC:
        place<PolarStereographic>(map, axis, flattening, scale > 0 ? scale : 1);
        if (!(scale > 0)) map_of<PolarStereographic>(map).SetScale(std::abs(parallels[0]), 1);
        return true;
    case GEODESY_AUTHALIC: place<Ellipsoid>(map, axis, flattening); return true;
    }
    return false;
} catch (...) {
    return false;
}

bool geodesy_map_forward(const GeodesyMap *map, GeodesyMapKind kind, bool north, double meridian, double latitude, double longitude, double out[2]) try {
    double to[2];
    if (!is_place(latitude, longitude)) return false;
    switch (kind) {
    case GEODESY_TRANSVERSE_MERCATOR: map_of<TransverseMercator>(map).Forward(meridian, latitude, longitude, to[0], to[1]); break;
    case GEODESY_LAMBERT_CONFORMAL: map_of<LambertConformalConic>(map).Forward(meridian, latitude, longitude, to[0], to[1]); break;
    case GEODESY_ALBERS: /* GeographicLib 2.1 errs on cones about the south pole: they are mirrored */
        map_of<AlbersEqualArea>(map).Forward(meridian, north ? latitude : -latitude, longitude, to[0], to[1]);
        if (!north) to[1] = -to[1];
        break;
    default: map_of<PolarStereographic>(map).Forward(north, latitude, longitude - meridian, to[0], to[1]); break;
    }
    if (!all_finite(to, 2)) return false;
    std::copy(to, to + 2, out);
    return true;
} catch (...) {
    return false;
}

bool geodesy_map_reverse(const GeodesyMap *map, GeodesyMapKind kind, bool north, double meridian, double x, double y, double out[2]) try {
    double to[2];
    if (!std::isfinite(x) || !std::isfinite(y)) return false;
    switch (kind) {
    case GEODESY_TRANSVERSE_MERCATOR: map_of<TransverseMercator>(map).Reverse(meridian, x, y, to[0], to[1]); break;
    case GEODESY_LAMBERT_CONFORMAL: map_of<LambertConformalConic>(map).Reverse(meridian, x, y, to[0], to[1]); break;
    case GEODESY_ALBERS:
        map_of<AlbersEqualArea>(map).Reverse(meridian, x, north ? y : -y, to[0], to[1]);
        if (!north) to[0] = -to[0];
        break;
    default:
        map_of<PolarStereographic>(map).Reverse(north, x, y, to[0], to[1]);
        to[1] += meridian;
        break;
    }
    if (!all_finite(to, 2)) return false;
    std::copy(to, to + 2, out);
    return true;
} catch (...) {
    return false;
}

double geodesy_authalic(const GeodesyMap *map, double latitude) { return map_of<Ellipsoid>(map).AuthalicLatitude(latitude); }

double geodesy_authalic_back(const GeodesyMap *map, double latitude) { return map_of<Ellipsoid>(map).InverseAuthalicLatitude(latitude); }

double geodesy_authalic_radius(const GeodesyMap *map) { return std::sqrt(map_of<Ellipsoid>(map).Area() / (4 * VTS_PI)); }
