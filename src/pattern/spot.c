#include "pattern/spot.h"

Spot spot_make(Vec3 point, Vec3 normal, double footprint) {
    Spot spot = {.p = point, .outer = point, .normal = normal};
    if (!(footprint > 0)) return spot;
    if (vec3_length_squared(normal) > 0) {
        vec3_frame(vec3_normalize(normal), &spot.axes[0], &spot.axes[1]);
    } else {
        spot.axes[0] = vec3(1, 0, 0), spot.axes[1] = vec3(0, 1, 0), spot.axes[2] = vec3(0, 0, 1);
    }
    for (int k = 0; k < 3; k++) spot.axes[k] = vec3_scale(spot.axes[k], footprint);
    return spot;
}

Spot spot_back(const Spot *spot, const Transform *t) {
    if (transform_is_unit(t)) return *spot;
    Spot back = {.p = transform_point_back(t, spot->p), .outer = spot->outer, .normal = spot->normal, .surface = spot->surface};
    for (int k = 0; k < 3; k++) back.axes[k] = transform_vector_back(t, spot->axes[k]);
    if (spot->blur > 0) /* by the mean scale of the axes' directions */
        back.blur = spot->blur * cbrt(fabs(mat3_determinant(&t->inverse_linear)));
    return back;
}

Spot spot_in_uv(const Spot *spot) {
    Spot plane = {.outer = spot->outer, .normal = spot->normal, .surface = spot->surface};
    if (!spot->surface) return plane;
    const SpotSurface *s = spot->surface;
    plane.p = vec3(s->uv[0], s->uv[1], 0);
    for (int k = 0; k < 2; k++) plane.axes[k] = vec3(s->uv_axes[k][0], s->uv_axes[k][1], 0);
    return plane;
}

double spot_width(const Spot *spot, Vec3 g) {
    double square = spot->blur * spot->blur * vec3_length_squared(g);
    for (int k = 0; k < 3; k++) square += vec3_dot(spot->axes[k], g) * vec3_dot(spot->axes[k], g);
    return sqrt(square);
}

double spot_width_along(const Spot *spot, int axis) {
    const Vec3 *a = spot->axes;
    double square = spot->blur * spot->blur;
    for (int k = 0; k < 3; k++) square += vec3_get(a[k], axis) * vec3_get(a[k], axis);
    return sqrt(square);
}

double spot_size(const Spot *spot) {
    double largest = 0;
    for (int k = 0; k < 3; k++) largest = fmax(largest, vec3_length_squared(spot->axes[k]));
    return sqrt(largest + spot->blur * spot->blur);
}
