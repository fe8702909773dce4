#include "render/vista.h"

/* What is seen of more pieces than this is looked at. */
enum { MOST_PIECES = 4096 };

/* The four planes that hold neighbouring corners; normals point inwards. */
typedef struct Shaft {
    Vec3 normals[4], origins[4];
} Shaft;

static Vec3 along(const Ray *ray) { return vec3_add(ray->origin, ray->direction); }

static bool shaft_of(const Ray corners[4], Shaft *shaft) {
    static const int around[] = {0, 1, 3, 2};
    for (int k = 0; k < 4; k++) {
        const Ray *a = &corners[around[k]], *b = &corners[around[(k + 1) % 4]],
                  *opposite = &corners[around[(k + 2) % 4]];
        Vec3 n = vec3_cross(a->direction, vec3_sub(along(b), along(a)));
        double inwards = vec3_dot(n, vec3_sub(along(opposite), a->origin));
        if (!(fabs(inwards) > 0)) return false;
        shaft->normals[k] = inwards > 0 ? n : vec3_negate(n);
        shaft->origins[k] = a->origin;
    }
    return true;
}

/* Boxes count as slightly larger than they are, for rounding. */
static bool may_touch(const Shaft *shaft, const Box3 *box) {
    Vec3 middle = vec3_lerp(box->min, box->max, 0.5), half = vec3_scale(vec3_sub(box->max, box->min), 0.5);
    for (int k = 0; k < 4; k++) {
        Vec3 n = shaft->normals[k], away = vec3_sub(middle, shaft->origins[k]);
        double reach = fabs(n.x) * (half.x + 1e-7 * fabs(away.x)) +
                       fabs(n.y) * (half.y + 1e-7 * fabs(away.y)) +
                       fabs(n.z) * (half.z + 1e-7 * fabs(away.z));
        if (vec3_dot(n, away) < -(1 + 1e-7) * reach) return false;
    }
    return true;
}

static bool holds(const Box3 *b, Vec3 p) {
    return p.x >= b->min.x && p.x <= b->max.x && p.y >= b->min.y && p.y <= b->max.y && p.z >= b->min.z &&
           p.z <= b->max.z;
}

Vista vista_of(const VistaPieces *pieces, const Ray corners[4]) {
    Vista vista = {.count = 0};
    Shaft shaft;
    if (pieces->endless || pieces->count > MOST_PIECES || !shaft_of(corners, &shaft))
        return (Vista){.count = VISTA_MOST + 1};
    for (size_t i = 0; i < pieces->count && vista.count <= VISTA_MOST; i++) {
        if (!may_touch(&shaft, &pieces->items[i].box)) continue;
        if (vista.count < VISTA_MOST) vista.near[vista.count] = &pieces->items[i];
        vista.count++;
    }
    return vista;
}

static double distance_to(const Box3 *box, Vec3 p) { return vec3_length(vec3_sub(vec3_max(box->min, vec3_min(box->max, p)), p)); }

/* How wide the piece is at least where it is nearest to the eye. What is flat along an axis, as a floor is, shows more than its thickness to an eye
 * that stands off its plane: with h from the eye to the plane and b between two edges, which are n and f away, the sine of the angle that it fills is
 * h·b/(n·f). */
static double width_seen(const VistaPiece *piece, Vec3 eye) {
    Vec3 size = vec3_sub(piece->box.max, piece->box.min), low = vec3_sub(piece->box.min, eye), high = vec3_sub(eye, piece->box.max);
    int flat = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
    double off = fmax(vec3_get(low, flat), vec3_get(high, flat)), side = fmin(vec3_get(size, (flat + 1) % 3), vec3_get(size, (flat + 2) % 3));
    if (piece->width < vec3_get(size, flat) || !(off > 0)) return piece->width; /* thin in other places than its box */
    Vec3 to_far = vec3(fmax(fabs(low.x), fabs(high.x)), fmax(fabs(low.y), fabs(high.y)), fmax(fabs(low.z), fabs(high.z)));
    return fmax(piece->width, off * side / vec3_length(to_far));
}

/* Lines that are parallel see what is flat from another side than their origins do. */
static bool is_thin(const VistaPiece *piece, Vec3 eye, VistaWidth wide) {
    const double seen = wide.spread > 0 ? width_seen(piece, eye) : piece->width;
    return seen < wide.width + wide.spread * distance_to(&piece->box, eye);
}

/* Of what is convex the points that the corners meet span a part, which is seen between them; planes that are behind its corners are
 * behind all of it. From within it is not what is met first. */
VistaView vista_view(const Vista *vista, const Ray corners[4], uint32_t object, VistaWidth wide) {
    Shaft shaft;
    const Vec3 eye = corners[0].origin;
    VistaView view = VISTA_EVEN;
    if (vista->count > VISTA_MOST || !shaft_of(corners, &shaft)) return VISTA_OPEN;
    for (int i = 0; i < vista->count && view != VISTA_SOME; i++) {
        const VistaPiece *piece = vista->near[i];
        const bool hides = piece->object && piece->object == object && !holds(&piece->box, eye);
        if (!hides && may_touch(&shaft, &piece->box)) view = piece->whole && !is_thin(piece, eye, wide) ? VISTA_WIDE : VISTA_SOME;
    }
    return view;
}

bool vista_has_thin(const VistaPieces *pieces, const Ray corners[4], VistaWidth wide) {
    Shaft shaft;
    if (pieces->count > MOST_PIECES || !shaft_of(corners, &shaft)) return false;
    for (size_t i = 0; i < pieces->count; i++)
        if (is_thin(&pieces->items[i], corners[0].origin, wide) && may_touch(&shaft, &pieces->items[i].box)) return true;
    return false;
}
