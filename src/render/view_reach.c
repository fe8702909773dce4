#include "render/view_reach.h"

enum { POINTS = 6 };
/* Points are on a face that are no farther from it than this part of the hull's size. */
static const double FLAT = 1e-9;

/* The plane of three points, if all others lie on one side of it. */
static void add_face(ViewReach *reach, const Vec3 points[POINTS], const int at[3], double size) {
    Vec3 n = vec3_normalize(
        vec3_cross(vec3_sub(points[at[1]], points[at[0]]), vec3_sub(points[at[2]], points[at[0]])));
    double least = 0, most = 0;
    if (!vec3_is_finite(n) || !(vec3_length_squared(n) > 0)) return;
    for (int i = 0; i < POINTS; i++) {
        double side = vec3_dot(n, vec3_sub(points[i], points[at[0]]));
        least = fmin(least, side), most = fmax(most, side);
    }
    if (least < -FLAT * size && most > FLAT * size) return;
    if (most > FLAT * size) n = vec3_negate(n);
    reach->normals[reach->count] = n;
    reach->offsets[reach->count++] = vec3_dot(n, points[at[0]]) + FLAT * size;
}

ViewReach view_reach(const View *view, double far, Vec3 lamp) {
    const Camera *c = &view->camera;
    Vec3 points[POINTS] = {c->location, lamp};
    double size = vec3_length(vec3_sub(lamp, c->location));
    for (int k = 0; k < 4; k++) {
        Vec3 to = vec3_madd(vec3_madd(c->direction, c->right, k & 1 ? 0.5 : -0.5), c->up, k & 2 ? 0.5 : -0.5);
        points[2 + k] = vec3_madd(c->location, to, far / vec3_length(c->direction));
        size = fmax(size, vec3_length(vec3_sub(points[2 + k], c->location)));
    }
    ViewReach reach = {.count = 0};
    for (int i = 0; i < POINTS; i++)
        for (int j = i + 1; j < POINTS; j++)
            for (int k = j + 1; k < POINTS; k++) add_face(&reach, points, (const int[3]){i, j, k}, size);
    return reach;
}

bool view_reach_misses(const ViewReach *reach, Box3 box) {
    for (int i = 0; i < reach->count; i++) {
        Vec3 n = reach->normals[i];
        Vec3 near = vec3(n.x > 0 ? box.min.x : box.max.x, n.y > 0 ? box.min.y : box.max.y,
                         n.z > 0 ? box.min.z : box.max.z);
        if (vec3_dot(n, near) > reach->offsets[i]) return true;
    }
    return false;
}
