#include "terrain/geodesy.h"

#include "terrain/geodesy_shim.h"

bool geo_place_is_valid(GeoPlace place) {
    return place.latitude >= -90 && place.latitude <= 90 && isfinite(place.longitude) && isfinite(place.height);
}

bool geo_frame_init(GeoFrame *frame, GeoPlace origin, bool flat) {
    double centre[3], m[9];
    if (!geodesy_geocentric(origin.latitude, origin.longitude, origin.height, centre, m)) return false;
    *frame = (GeoFrame){.origin = origin, .flat = flat, .centre = vec3(centre[0], centre[1], centre[2])};
    frame->axes = (Mat3){{vec3(m[0], m[3], m[6]), vec3(m[2], m[5], m[8]), vec3(m[1], m[4], m[7])}};
    return true;
}

static bool to_flat(const GeoFrame *frame, GeoPlace place, Vec3 *out) {
    double line[3];
    if (!geodesy_inverse(frame->origin.latitude, frame->origin.longitude, place.latitude, place.longitude, line)) return false;
    double azimuth = line[1] * VTS_RADIANS;
    *out = vec3(line[0] * sin(azimuth), place.height - frame->origin.height, line[0] * cos(azimuth));
    return true;
}

bool geo_to_scene(const GeoFrame *frame, GeoPlace place, Vec3 *out) {
    double p[3];
    if (!geo_place_is_valid(place)) return false;
    if (frame->flat) return to_flat(frame, place, out);
    if (!geodesy_geocentric(place.latitude, place.longitude, place.height, p, NULL)) return false;
    *out = mat3_apply_transposed(&frame->axes, vec3_sub(vec3(p[0], p[1], p[2]), frame->centre));
    return true;
}

static bool from_flat(const GeoFrame *frame, Vec3 point, GeoPlace *out) {
    double to[3], azimuth = atan2(point.x, point.z) / VTS_RADIANS;
    if (!geodesy_direct(frame->origin.latitude, frame->origin.longitude, azimuth, hypot(point.x, point.z), to)) return false;
    *out = (GeoPlace){to[0], to[1], point.y + frame->origin.height};
    return true;
}

bool scene_to_geo(const GeoFrame *frame, Vec3 point, GeoPlace *out) {
    double to[3];
    if (!vec3_is_finite(point)) return false;
    if (frame->flat) return from_flat(frame, point, out);
    Vec3 p = vec3_add(mat3_apply(&frame->axes, point), frame->centre);
    if (!geodesy_geocentric_back((double[]){p.x, p.y, p.z}, to)) return false;
    *out = (GeoPlace){to[0], to[1], to[2]};
    return true;
}

/* What is forward along the line from the origin is forward on the map. */
static bool direction_to_flat(const GeoFrame *frame, GeoPlace place, Vec3 d, Vec3 *out) {
    double line[3];
    if (!geodesy_inverse(frame->origin.latitude, frame->origin.longitude, place.latitude, place.longitude, line)) return false;
    double turn = line[0] > 0 ? (line[1] - line[2]) * VTS_RADIANS : 0, c = cos(turn), s = sin(turn);
    *out = vec3(c * d.x + s * d.z, d.y, c * d.z - s * d.x);
    return true;
}

bool geo_direction_to_scene(const GeoFrame *frame, GeoPlace place, Vec3 east_up_north, Vec3 *out) {
    GeoFrame there;
    if (!geo_place_is_valid(place)) return false;
    if (frame->flat) return direction_to_flat(frame, place, east_up_north, out);
    if (!geo_frame_init(&there, place, false)) return false;
    *out = mat3_apply_transposed(&frame->axes, mat3_apply(&there.axes, east_up_north));
    return true;
}

bool geodesic_inverse(GeoPlace a, GeoPlace b, GeodesicLine *out) {
    double line[3];
    if (!geodesy_inverse(a.latitude, a.longitude, b.latitude, b.longitude, line)) return false;
    *out = (GeodesicLine){line[0], line[1], line[2] > 0 ? line[2] - 180 : line[2] + 180};
    return true;
}

bool geodesic_direct(GeoPlace a, double azimuth, double distance, GeoPlace *out) {
    double to[3];
    if (!geodesy_direct(a.latitude, a.longitude, azimuth, distance, to)) return false;
    *out = (GeoPlace){to[0], to[1], a.height};
    return true;
}

bool utm_from_geo(GeoPlace place, UtmPlace *out) {
    double at[2];
    int zone;
    bool north;
    if (!geodesy_utm(place.latitude, place.longitude, &zone, &north, at)) return false;
    *out = (UtmPlace){at[0], at[1], zone, north};
    return true;
}
