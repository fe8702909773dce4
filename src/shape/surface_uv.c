#include "shape/surface_uv.h"

typedef struct UvFrame {
    Vec3 across, up, axis; /* u and v of planar coordinates; the axis looked along or turned about */
    Vec3 center;
    double lo[3], size[3]; /* of the surface along across, up, axis */
} UvFrame;

static void choose_axes(Vec3 axis, UvFrame *frame) {
    frame->axis = vec3_normalize(vec3_length_squared(axis) > 0 ? axis : vec3(0, 1, 0));
    Vec3 size = vec3(fabs(frame->axis.x), fabs(frame->axis.y), fabs(frame->axis.z));
    if (size.y == 1)
        frame->across = vec3(1, 0, 0), frame->up = vec3(0, 0, 1);
    else if (size.z == 1)
        frame->across = vec3(1, 0, 0), frame->up = vec3(0, 1, 0);
    else if (size.x == 1)
        frame->across = vec3(0, 0, 1), frame->up = vec3(0, 1, 0);
    else
        vec3_frame(frame->axis, &frame->across, &frame->up);
}

static UvFrame uv_frame(Vec3 axis, const TriangleSoup *soup) {
    UvFrame frame = {.lo = {HUGE_VAL, HUGE_VAL, HUGE_VAL}};
    double hi[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    choose_axes(axis, &frame);
    for (size_t i = 0; i < soup->vertices.count; i++) {
        Vec3 p = soup->vertices.items[i].position;
        const double place[3] = {vec3_dot(p, frame.across), vec3_dot(p, frame.up), vec3_dot(p, frame.axis)};
        for (int k = 0; k < 3; k++) {
            frame.lo[k] = double_min(frame.lo[k], place[k]);
            hi[k] = double_max(hi[k], place[k]);
        }
    }
    for (int k = 0; k < 3; k++) frame.size[k] = hi[k] - frame.lo[k];
    frame.center = vec3_scale(frame.across, frame.lo[0] + frame.size[0] / 2);
    frame.center = vec3_madd(frame.center, frame.up, frame.lo[1] + frame.size[1] / 2);
    frame.center = vec3_madd(frame.center, frame.axis, frame.lo[2] + frame.size[2] / 2);
    return frame;
}

static double share(double x, double lo, double size) {
    return size > 0 ? double_clamp((x - lo) / size, 0, 1) : 0;
}

static TexCoord planar(const UvFrame *frame, Vec3 p) {
    return (TexCoord){share(vec3_dot(p, frame->across), frame->lo[0], frame->size[0]),
                      share(vec3_dot(p, frame->up), frame->lo[1], frame->size[1])};
}

/* u is NAN on the axis. */
static TexCoord turned(const UvFrame *frame, Vec3 p, bool spherical) {
    Vec3 d = vec3_sub(p, frame->center);
    double x = vec3_dot(d, frame->across), y = vec3_dot(d, frame->up), z = vec3_dot(d, frame->axis),
           r = hypot(x, y);
    double turn = atan2(y, -x) / (2 * VTS_PI);
    bool on_axis = r <= 1e-12 * (frame->size[0] + frame->size[1] + frame->size[2]);
    double v = spherical ? 0.5 + atan2(z, r) / VTS_PI
                         : share(vec3_dot(p, frame->axis), frame->lo[2], frame->size[2]);
    return (TexCoord){on_axis ? (double)NAN : turn < 0 ? turn + 1 : turn, v};
}

/* Brings the three within half a turn of each other; a corner on the axis gets the mean of the others. */
static void close_seam(TexCoord uv[3]) {
    double lo = fmin(uv[0].u, fmin(uv[1].u, uv[2].u)), sum = 0;
    double hi = fmax(uv[0].u, fmax(uv[1].u, uv[2].u));
    int count = 0;
    for (int i = 0; i < 3; i++) {
        if (isnan(uv[i].u)) continue;
        if (hi - lo > 0.5 && uv[i].u < 0.5) uv[i].u += 1;
        sum += uv[i].u;
        count++;
    }
    for (int i = 0; i < 3; i++) {
        if (isnan(uv[i].u)) uv[i].u = count ? sum / count : 0;
    }
}

static void turn_all(const UvFrame *frame, bool spherical, Arena *arena, TriangleSoup *soup) {
    for (size_t t = 0; t < soup->triangles.count; t++) {
        uint32_t *corner = soup->triangles.items[t].vertex;
        TexCoord uv[3];
        for (int i = 0; i < 3; i++)
            uv[i] = turned(frame, soup->vertices.items[corner[i]].position, spherical);
        close_seam(uv);
        for (int i = 0; i < 3; i++) {
            SoupVertex vertex = soup->vertices.items[corner[i]];
            vertex.uv = uv[i];
            corner[i] = (uint32_t)soup->vertices.count;
            *list_push(arena, &soup->vertices) = vertex;
        }
    }
}

void surface_uv_generate(const Surface *surface, Arena *arena, TriangleSoup *soup) {
    UvFrame frame = uv_frame(surface->uv_axis, soup);
    if (surface->uv == SURFACE_UV_CYLINDRICAL || surface->uv == SURFACE_UV_SPHERICAL) {
        turn_all(&frame, surface->uv == SURFACE_UV_SPHERICAL, arena, soup);
    }
    for (size_t i = 0; i < soup->vertices.count; i++) {
        SoupVertex *vertex = &soup->vertices.items[i];
        bool missing = isnan(vertex->uv.u) || isnan(vertex->uv.v);
        if (surface->uv == SURFACE_UV_PLANAR || missing) vertex->uv = planar(&frame, vertex->position);
    }
}
