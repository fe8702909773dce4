/* Rays of POV-Ray's kinds of cameras (the formulas are those of its documentation, the constants of omnimax the OMNIMAX
 * lens's), and cones around them. */
#include "render/view.h"

#include "pattern/bump.h"

/* A line of sight; `direction` of any length. */
typedef struct Line {
    Vec3 origin, direction;
} Line;

/* The camera's axes, and lengths of those that frame the picture. */
typedef struct Frame {
    Vec3 right, up, forward; /* unit */
    double width, height;
} Frame;

static Frame frame_of(const Camera *c) {
    return (Frame){vec3_normalize(c->right), vec3_normalize(c->up), vec3_normalize(c->direction), vec3_length(c->right),
                   vec3_length(c->up)};
}

static Vec3 combine(const Frame *f, double right, double up, double forward) {
    return vec3_madd(vec3_madd(vec3_scale(f->right, right), f->up, up), f->forward, forward);
}

/* `away` degrees (radians here) from the axis, on the side where (x, y) is. */
static Vec3 around_axis(const Frame *f, double x, double y, double away) {
    double r = hypot(x, y), s = r > 0 ? sin(away) / r : 0;
    return combine(f, x * s, y * s, cos(away));
}

static bool fisheye_line(const Camera *c, const Frame *f, double s, double t, Vec3 *direction) {
    double x = 2 * s * f->width, y = 2 * t * f->height, r = hypot(x, y);
    *direction = around_axis(f, x, y, r * c->angle * VTS_RADIANS / 2);
    return r <= 1;
}

/* The film is wider than the dome's picture, which keeps its top, or is as wide; nothing lies more than 45 degrees below the axis. */
static bool omnimax_line(const Frame *f, double s, double t, Vec3 *direction) {
    const double tall = 1 / 1.283458;
    double aspect = f->height / f->width, scale_y = fmax(aspect, tall), scale_x = scale_y / aspect;
    double x = 2 * s * scale_x, y = 2 * t * scale_y + fmax(0, 1 - scale_y), r2 = x * x + y * y, r = sqrt(r2);
    *direction = around_axis(f, x, y, r * (1.411269 + r2 * (-0.09439 + r2 * 0.25674)));
    return r <= 1 && vec3_dot(*direction, f->up) >= -vec3_dot(*direction, f->forward);
}

static Vec3 wide_direction(const Camera *c, const Frame *f, double s, double t) {
    double a = s * c->angle * VTS_RADIANS, b = t * c->angle * VTS_RADIANS * f->height / f->width;
    return combine(f, sin(a), sin(b), cos(a) * cos(b));
}

/* The axes count with their lengths. */
static Vec3 panoramic_direction(const Camera *c, double s, double t) {
    double a = s * VTS_PI, b = double_clamp(t * VTS_PI, -VTS_PI / 2 + 1e-9, VTS_PI / 2 - 1e-9);
    return vec3_madd(vec3_madd(vec3_scale(c->right, sin(a)), c->up, tan(b)), c->direction, cos(a));
}

/* The axis, turned about `right`, and then about `up`. */
static Vec3 spherical_direction(const Camera *c, const Frame *f, double s, double t) {
    Transform pitch = transform_axis_rotate(f->right, -t * c->angle_v), turn = transform_axis_rotate(f->up, s * c->angle);
    return transform_vector(&turn, transform_vector(&pitch, f->forward));
}

/* Along one axis of the picture an angle, along the other a length: of the direction (1, 2), or of the origin (3, 4). */
static Line cylinder_line(const Camera *c, const Frame *f, double s, double t) {
    bool across = c->kind == CAMERA_CYLINDER_1 || c->kind == CAMERA_CYLINDER_3;
    double a = (across ? s : t) * c->angle * VTS_RADIANS, length = across ? t * f->height : s * f->width;
    Vec3 axis = across ? f->up : f->right, round = across ? combine(f, sin(a), 0, cos(a)) : combine(f, 0, sin(a), cos(a));
    if (c->kind == CAMERA_CYLINDER_1 || c->kind == CAMERA_CYLINDER_2) return (Line){c->location, vec3_madd(round, axis, length)};
    return (Line){vec3_madd(c->location, axis, length), round};
}

/* As a normal of the picture's plane would be: measured. */
static void bend(const Normal *normal, double s, double t, Vec3 *direction) {
    const Spot spot = spot_make(vec3(s, t, 0), vec3(0, 0, 0), 0);
    const BumpPlace place = {.spot = &spot};
    Vec3 bent = bump_normal(normal, &place, vec3_normalize(*direction));
    if (vec3_is_finite(bent) && vec3_length_squared(bent) > 0) *direction = bent;
}

/* Without the camera's normal. */
static bool straight_line_at(const Camera *c, double s, double t, Line *out) {
    Frame f = frame_of(c);
    *out = (Line){.origin = c->location};
    switch (c->kind) {
    case CAMERA_ORTHOGRAPHIC:
        *out = (Line){vec3_madd(vec3_madd(c->location, c->right, s), c->up, t), c->direction};
        return true;
    case CAMERA_FISHEYE: return fisheye_line(c, &f, s, t, &out->direction);
    case CAMERA_OMNIMAX: return omnimax_line(&f, s, t, &out->direction);
    case CAMERA_ULTRA_WIDE: out->direction = wide_direction(c, &f, s, t); return true;
    case CAMERA_PANORAMIC: out->direction = panoramic_direction(c, s, t); return true;
    case CAMERA_SPHERICAL: out->direction = spherical_direction(c, &f, s, t); return true;
    case CAMERA_CYLINDER_1:
    case CAMERA_CYLINDER_2:
    case CAMERA_CYLINDER_3:
    case CAMERA_CYLINDER_4: *out = cylinder_line(c, &f, s, t); return true;
    case CAMERA_MESH:
    case CAMERA_PERSPECTIVE: break;
    }
    out->direction = vec3_madd(vec3_madd(c->direction, c->right, s), c->up, t);
    return true;
}

/* Through the middle of the lens; false where the picture shows nothing. */
static bool line_at(const Camera *c, double s, double t, Line *out) {
    bool shown = straight_line_at(c, s, t, out);
    if (shown && c->normal) bend(c->normal, s, t, &out->direction);
    return shown;
}

void view_prepare(View *view, Arena *arena) {
    if (arena) view_mesh_prepare(view, arena);
    const Vec3 across = vec3_cross(view->camera.right, view->camera.up);
    view->axis = vec3_normalize(across);
    view->pixel_area = vec3_length(across) / ((double)view->width * view->height);
}

/* Into `out` number by number: whoever copies what was just written waits for it. */
static void flat_cone(const View *given, double s, double t, double width_px, Cone *out) {
    View prepared;
    const View *view = given;
    if (!(view->pixel_area > 0)) prepared = *given, view_prepare(&prepared, NULL), view = &prepared;
    const Camera *c = &view->camera;
    const double pixel_area = view->pixel_area;
    const Vec3 offset = vec3_madd(vec3_scale(c->right, s), c->up, t);
    if (c->kind == CAMERA_ORTHOGRAPHIC) {
        *out = (Cone){vec3_add(c->location, offset), vec3_normalize(c->direction), sqrt(pixel_area) * width_px, 0};
        return;
    }
    const Vec3 d = vec3_add(c->direction, offset);
    /* The pixel's solid angle: its area on the image plane, foreshortened, over the distance squared. */
    const double shorter = 1 / vec3_length(d), cosine = fabs(vec3_dot(view->axis, d)) * shorter;
    out->origin.x = c->location.x, out->origin.y = c->location.y, out->origin.z = c->location.z;
    out->direction.x = d.x * shorter, out->direction.y = d.y * shorter, out->direction.z = d.z * shorter;
    out->width = 0;
    out->spread = sqrt(pixel_area * cosine) * shorter * width_px;
}

/* The pixel's solid angle, of lines that are not straight on the picture, from those beside it. Where origins move along one axis and
 * directions along the other a footprint is no square: the cone has the mean of its sides. */
static Cone round_cone(const View *view, double s, double t, double width_px) {
    const double step = 1e-3;
    double ds = step / view->width, dt = step / view->height;
    Line line, right, down;
    if (!line_at(&view->camera, s, t, &line)) return (Cone){.origin = line.origin};
    line_at(&view->camera, s + (s > 0 ? -ds : ds), t, &right);
    line_at(&view->camera, s, t + (t > 0 ? -dt : dt), &down);
    Vec3 d = vec3_normalize(line.direction);
    Vec3 turn_s = vec3_sub(vec3_normalize(right.direction), d), turn_t = vec3_sub(vec3_normalize(down.direction), d);
    double moved = vec3_length(vec3_sub(right.origin, line.origin)) + vec3_length(vec3_sub(down.origin, line.origin));
    double spread = sqrt(vec3_length(vec3_cross(turn_s, turn_t)));
    if (moved > 0) spread = (vec3_length(turn_s) + vec3_length(turn_t)) / 2;
    return (Cone){line.origin, d, moved / 2 / step * width_px, spread / step * width_px};
}

static void cone_at(const View *view, double x, double y, double width_px, Cone *out) {
    const double s = x / view->width - 0.5, t = 0.5 - y / view->height;
    if (view_is_flat(view)) flat_cone(view, s, t, width_px, out);
    else if (view->camera.kind != CAMERA_MESH) *out = round_cone(view, s, t, width_px);
    else if (!view_mesh_ray(view, x, y, 0, out)) *out = (Cone){.width = 0};
}

Cone view_cone(const View *view, double x, double y, double width_px) {
    Cone seen;
    cone_at(view, x, y, width_px, &seen);
    return seen;
}

/* The unit square onto the unit disc, evenly (Shirley & Chiu 1997). */
static void disc_of_square(double u, double v, double *x, double *y) {
    double a = 2 * u - 1, b = 2 * v - 1, r = fabs(a) > fabs(b) ? a : b;
    double angle = r == 0 ? 0 : fabs(a) > fabs(b) ? VTS_PI / 4 * (b / a) : VTS_PI / 2 - VTS_PI / 4 * (a / b);
    *x = r * cos(angle), *y = r * sin(angle);
}

/* Where the line of sight is in focus: flat pictures on a plane, others on a sphere. */
static double focus_of(const Camera *c, const Cone *cone) {
    if (c->kind != CAMERA_PERSPECTIVE) return c->focal_distance;
    return c->focal_distance / fmax(1e-6, fabs(vec3_dot(vec3_normalize(c->direction), cone->direction)));
}

/* POV-Ray's lens is a disc across the line of sight; its radius is a quarter of `aperture`. */
bool view_ray(const View *view, double x, double y, double u, double v, double width_px, Cone *out) {
    if (view->camera.kind == CAMERA_MESH) return view_mesh_ray(view, x, y, u, out);
    cone_at(view, x, y, width_px, out);
    if (!view_has_lens(view)) return view_is_flat(view) || vec3_length_squared(out->direction) > 0;
    if (vec3_length_squared(out->direction) == 0) return false;
    double a, b, focus = focus_of(&view->camera, out), radius = view->camera.aperture / 4;
    disc_of_square(u, v, &a, &b);
    Vec3 s, t, in_focus = cone_point(out, focus);
    vec3_frame(out->direction, &s, &t);
    out->origin = vec3_madd(vec3_madd(out->origin, s, a * radius), t, b * radius);
    Vec3 to = vec3_sub(in_focus, out->origin);
    out->direction = vec3_normalize(to);
    out->spread *= focus / vec3_length(to);
    return true;
}

bool view_misses(const View *view, Box3 box) {
    const Camera *c = &view->camera;
    if (c->kind != CAMERA_PERSPECTIVE || c->normal) return false;
    Vec3 r = vec3_scale(c->right, 0.5), u = vec3_scale(c->up, 0.5);
    Vec3 corner[4] = {vec3_sub(vec3_sub(c->direction, r), u), vec3_sub(vec3_add(c->direction, r), u),
                      vec3_add(vec3_add(c->direction, r), u), vec3_add(vec3_sub(c->direction, r), u)};
    for (int i = 0; i < 4; i++) {
        Vec3 n = vec3_cross(corner[i], corner[(i + 1) % 4]);
        if (vec3_dot(n, c->direction) < 0) n = vec3_negate(n); /* inwards */
        Vec3 far = vec3(n.x > 0 ? box.max.x : box.min.x, n.y > 0 ? box.max.y : box.min.y, n.z > 0 ? box.max.z : box.min.z);
        if (vec3_dot(n, vec3_sub(far, c->location)) < 0) return true;
    }
    return false;
}
