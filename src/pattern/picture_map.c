#include "pattern/picture_map.h"

#include "base/gamma.h"
#include "image/picture.h"

enum { MAP_PLANAR = 0, MAP_SPHERICAL = 1, MAP_CYLINDRICAL = 2, MAP_TOROIDAL = 5, MAP_ANGULAR = 7 };

typedef struct Place {
    double u, v;
    bool outside;
} Place;

/* From the x axis by way of the z axis, in turns. */
static double turn(double x, double z) {
    double length = hypot(x, z);
    if (length == 0) return 0;
    double angle = acos(double_clamp(x / length, -1, 1)) / (2 * VTS_PI);
    return z < 0 ? 1 - angle : angle;
}

static Place planar(Vec3 p, bool once) { return (Place){p.x, p.y, once && !(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1)}; }

static Place spherical(Vec3 p) {
    double up = atan2(p.y, hypot(p.x, p.z));
    return (Place){turn(p.x, p.z), 0.5 + up / VTS_PI, false};
}

static Place cylindrical(Vec3 p, bool once) { return (Place){turn(p.x, p.z), p.y, once && !(p.y >= 0 && p.y < 1)}; }

/* Around a torus of radius 1. */
static Place toroidal(Vec3 p) {
    double across = hypot(p.x, p.z) - 1, minor = hypot(across, p.y);
    double around = minor > 0 ? acos(double_clamp(-across / minor, -1, 1)) / (2 * VTS_PI) : 0;
    return (Place){turn(p.x, p.z), p.y > 0 ? 1 - around : around, false};
}

/* A light probe: the middle is straight ahead along z, the rim behind. */
static Place angular(Vec3 p) {
    double length = vec3_length(p), across = hypot(p.x, p.y);
    if (length == 0) return (Place){0.5, 0.5, false};
    double r = acos(double_clamp(p.z / length, -1, 1)) / VTS_PI / 2;
    return across > 0 ? (Place){0.5 + r * p.x / across, 0.5 + r * p.y / across, false} : (Place){0.5, 0.5 + r, false};
}

static Place on_the_globe(const PicturePlace *place, Vec3 p) {
    double u, v;
    if (!place->find(place, p, &u, &v)) return (Place){0, 0, true};
    return (Place){u, v, !(u >= 0 && u < 1 && v >= 0 && v < 1)};
}

static Place place_of(const ImageMap *image, Vec3 p) {
    if (image->place) return on_the_globe(image->place, p);
    switch (image->map_type) {
    case MAP_SPHERICAL: return spherical(p);
    case MAP_CYLINDRICAL: return cylindrical(p, image->once);
    case MAP_TOROIDAL: return toroidal(p);
    case MAP_ANGULAR: return angular(p);
    default: return planar(p, image->once);
    }
}

static double shorter_way(double turns) { return turns - floor(turns + 0.5); }

/* What one axis of the spot is in the picture: half the way of its ends from each other, doubled, across a seam the short way. */
static void project(const ImageMap *image, Vec3 p, Vec3 axis, double out[2]) {
    if (image->map_type == MAP_PLANAR && !image->place) {
        out[0] = axis.x, out[1] = axis.y;
        return;
    }
    Place a = place_of(image, vec3_madd(p, axis, -0.5)), b = place_of(image, vec3_madd(p, axis, 0.5));
    if (image->place) {
        out[0] = b.u - a.u, out[1] = b.v - a.v;
        return;
    }
    out[0] = shorter_way(b.u - a.u);
    out[1] = image->map_type == MAP_CYLINDRICAL ? b.v - a.v : shorter_way(b.v - a.v);
}

/* Two axes with the covariance of all. */
static void footprint(const ImageMap *image, const Spot *spot, double out[2][2]) {
    double uu = 0, uv = 0, vv = 0;
    Vec3 axes[6] = {spot->axes[0], spot->axes[1], spot->axes[2], vec3(spot->blur, 0, 0), vec3(0, spot->blur, 0), vec3(0, 0, spot->blur)};
    for (int k = 0; k < (spot->blur > 0 ? 6 : 3); k++) {
        double d[2];
        if (vec3_length_squared(axes[k]) == 0) continue;
        project(image, spot->p, axes[k], d);
        uu += d[0] * d[0], uv += d[0] * d[1], vv += d[1] * d[1];
    }
    out[0][0] = sqrt(uu); /* Cholesky's factors */
    out[0][1] = uu > 0 ? uv / sqrt(uu) : 0;
    out[1][0] = 0;
    out[1][1] = sqrt(fmax(vv - out[0][1] * out[0][1], 0));
}

static bool find_place(const ImageMap *image, const Spot *spot, PictureSpot *at) {
    Place place = place_of(image, spot->p);
    if (place.outside || !image->picture || !isfinite(place.u) || !isfinite(place.v)) return false;
    *at = (PictureSpot){.u = place.u, .v = place.v};
    if (!spot_is_point(spot)) footprint(image, spot, at->axes);
    return true;
}

static PictureColor color_at(const ImageMap *image, const Picture *picture, const PictureSpot *at) {
    return picture_color(picture, at, (PictureFilter)image->interpolate, image->once || image->place);
}

static bool look_up(const ImageMap *image, const Spot *spot, PictureColor *out) {
    PictureSpot at;
    if (!find_place(image, spot, &at)) return false;
    *out = color_at(image, image->picture, &at);
    return true;
}

Color picture_map_color(const ImageMap *image, const Spot *spot) {
    PictureSpot at;
    if (!find_place(image, spot, &at)) return (Color){1, 1, 1, 0, 1};
    PictureColor c = color_at(image, image->picture, &at), share = {0, 0, 0, 1};
    if (image->shares) share = color_at(image, image->shares, &at);
    double transmit = image->picture->has_alpha ? 1 - c.alpha : 0;
    double gamma = image->assumed_gamma;
    return (Color){gamma_from_light(c.red, gamma), gamma_from_light(c.green, gamma), gamma_from_light(c.blue, gamma), image->filter_all + share.red, transmit + image->transmit_all + share.green};
}

double picture_map_value(const ImageMap *image, const Spot *spot) {
    PictureColor c;
    if (!look_up(image, spot, &c)) return 0;
    if (image->use_alpha && image->picture->has_alpha) return 1 - c.alpha; /* as POV-Ray */
    return 0.297 * c.red + 0.589 * c.green + 0.114 * c.blue;
}

size_t picture_map_index(const ImageMap *image, const Spot *spot) {
    PictureColor c;
    Spot middle = {.p = spot->p};
    if (!look_up(image, &middle, &c)) return 0;
    return (size_t)(255 * double_clamp(c.red, 0, 1) + 1e-3);
}

bool picture_map_heights(const ImageMap *image, const Spot *spot, double out[3]) {
    static const int steps[3][2] = {{0, 0}, {-1, -1}, {1, -1}};
    PictureSpot at;
    if (!find_place(image, spot, &at)) return false;
    const PictureLevel *level = &image->picture->levels[0];
    double scale = image->by_index ? 255 : 1; /* numbers are as high as they are: POV-Ray's */
    for (int k = 0; k < 3; k++) {
        PictureSpot beside = at;
        beside.u += (double)steps[k][0] / level->width;
        beside.v += (double)steps[k][1] / level->height;
        PictureColor c = picture_color(image->picture, &beside, (PictureFilter)image->interpolate, false);
        out[k] = scale * (0.297 * c.red + 0.589 * c.green + 0.114 * c.blue);
    }
    return true;
}
