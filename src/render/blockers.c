#include "render/blockers.h"

#include "render/hierarchy.h"
#include "scene/medium.h"

/* A box, or all on one side of a plane. */
typedef struct Blocker {
    Box3 box;
    bool is_plane;
    Vec3 normal; /* p · normal = distance */
    double distance;
    const MediaList *media; /* clear but for these; NULL: blocks on its own */
    double gentle;          /* convex and evenly filled: its shadow begins gently, and is as wide as it is, so much; 0: not so */
} Blocker;

/* Of more, all that is asked may be blocked: to ask each would take longer than shadow rays. */
enum { MOST_BLOCKERS = 256, DEEPEST = 64 };

struct Blockers {
    Blocker items[MOST_BLOCKERS];
    size_t count;
    bool too_many;
};

/* ---- what blocks ---- */

static bool channel_passes(double filter, double transmit, double value) { return fabs(filter * value + transmit - 1) < 1e-6; }

static bool texture_is_invisible(const Texture *texture) {
    for (; texture; texture = texture->under) {
        const Pigment *p = texture->pigment;
        Color c = p->color;
        if (texture->map || p->kind != PATTERN_SOLID) return false;
        if (!channel_passes(c.filter, c.transmit, c.red) || !channel_passes(c.filter, c.transmit, c.green) || !channel_passes(c.filter, c.transmit, c.blue))
            return false;
    }
    return true;
}

static const Interior *interior_of(const Object *object) { return object->rest ? object->rest->interior : NULL; }

/* Whether nothing within it has looks or an interior of its own. */
static bool is_of_one_look(const Object *object, int deep) {
    if (object->kind == OBJECT_TRIANGLES || object->kind == OBJECT_VOLUME || object->kind == OBJECT_TEXEL || deep > DEEPEST) return false;
    if (object->rest && object->rest->interior_texture) return false;
    if (deep && (object->texture || interior_of(object))) return false;
    if (!object_has_group(object)) return true;
    for (size_t i = 0; i < object->as.group->count; i++)
        if (!is_of_one_look(object->as.group->items[i], deep + 1)) return false;
    return true;
}

/* Light passes all of it alike but for media. */
static bool is_invisible(const Item *item) {
    if (item->cluster || item->inside || !item->look || !texture_is_invisible(item->look->texture)) return false;
    const Interior *interior = item->filled ? interior_of(item->filled) : interior_of(item->object);
    return is_of_one_look(item->object, 0) && (!interior || (interior->caustics == 0 && interior->fade_power == 0));
}

static const MediaList *media_of(const Item *item) {
    const Interior *interior = interior_of(item->filled ? item->filled : item->object);
    return interior && interior->media.count ? &interior->media : NULL;
}

static bool is_even(const MediaList *media) {
    for (size_t i = 0; i < media->count; i++)
        if (media->items[i].density_count) return false;
    return true;
}

static double gentle_width(const Item *item, const MediaList *media) {
    const int kind = item->object->kind;
    const bool convex = !item->body && (kind == OBJECT_SPHERE || kind == OBJECT_BOX || kind == OBJECT_CYLINDER || kind == OBJECT_CONE);
    if (!convex || !is_even(media)) return 0;
    const Box3 box = item_box(item);
    Vec3 size = vec3_sub(box.max, box.min);
    return double_min(size.x, double_min(size.y, size.z));
}

static bool has_plane(const Item *item, Blocker *out) {
    if (item->body || item->cluster || item->object->kind != OBJECT_PLANE) return false;
    const Vec3 normal = item->object->as.plane.normal;
    out->is_plane = true;
    out->normal = mat3_apply_transposed(&item->back.linear, normal);
    out->distance = item->object->as.plane.distance - vec3_dot(normal, item->back.offset);
    return true;
}

static void add(Blockers *all, const Item *item) {
    Blocker one = {.box = item_box(item)};
    if (item->hidden >> RAY_SHADOWS & 1) return;
    if (is_invisible(item)) {
        one.media = media_of(item);
        if (!one.media) return;
        one.gentle = gentle_width(item, one.media);
    }
    if (all->count == MOST_BLOCKERS) {
        all->too_many = true;
        return;
    }
    has_plane(item, &one);
    all->items[all->count++] = one;
}

const Blockers *blockers_find(const Cluster *cluster, Arena *arena) {
    Blockers *all = arena_new(arena, Blockers);
    *all = (Blockers){.count = 0};
    for (size_t i = 0; i < cluster->items.count && !all->too_many; i++) add(all, &cluster->items.items[i]);
    for (size_t i = 0; i < cluster->owners.count && !all->too_many; i++) add(all, &cluster->owners.items[i]);
    return all;
}

/* ---- hulls ---- */

static void hull_extent(const LightHull *hull, Vec3 axis, double *low, double *high) {
    *low = VTS_INFINITY, *high = -VTS_INFINITY;
    for (int i = 0; i < hull->count; i++) {
        double along = vec3_dot(hull->points[i], axis);
        *low = double_min(*low, along), *high = double_max(*high, along);
    }
}

/* Whether the axis has the hull on one side and the box on the other. Infinite boxes are on both. */
static bool parts(const LightHull *hull, Box3 box, Vec3 axis) {
    double low, high;
    hull_extent(hull, axis, &low, &high);
    Vec3 middle = vec3_scale(vec3_add(box.min, box.max), 0.5), half = vec3_scale(vec3_sub(box.max, box.min), 0.5);
    double at = vec3_dot(middle, axis), reach = fabs(half.x * axis.x) + fabs(half.y * axis.y) + fabs(half.z * axis.z);
    double margin = 1e-9 * (fabs(at) + reach + fabs(low) + fabs(high));
    return at + reach + margin < low || at - reach - margin > high;
}

static bool boxes_apart(Box3 a, Box3 b) {
    return a.max.x < b.min.x || b.max.x < a.min.x || a.max.y < b.min.y || b.max.y < a.min.y || a.max.z < b.min.z || b.max.z < a.min.z;
}

/* Axes that part a triangle from a box if any do (Akenine-Möller, Fast 3D triangle-box overlap testing, 2001); of other hulls, some that may. */
static bool is_apart(const LightHull *hull, Box3 bounds, Box3 box) {
    static const Vec3 sides[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    if (boxes_apart(bounds, box)) return true;
    if (!vec3_is_finite(box.min) || !vec3_is_finite(box.max)) return false;
    Vec3 edges[3];
    for (int i = 0; i < 3; i++) edges[i] = vec3_sub(hull->points[(i + 1) % 3], hull->points[i]);
    if (parts(hull, box, vec3_cross(edges[0], edges[1]))) return true;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            if (parts(hull, box, vec3_cross(edges[i], sides[k]))) return true;
    return false;
}

/* A shadow of a plane alone begins where the plane is; a hull that only touches it has none. */
static bool crosses_plane(const Blocker *plane, const LightHull *hull) {
    double low, high;
    hull_extent(hull, plane->normal, &low, &high);
    double margin = 1e-6 * (high - low);
    return low + margin < plane->distance && plane->distance < high - margin;
}

static bool fills(const MediaList *media, const LightHull *hull) {
    for (int i = 0; i < hull->media_count; i++)
        if (hull->media[i] >= media->items && hull->media[i] < media->items + media->count) return true;
    return false;
}

bool blockers_touch(const Blockers *all, const LightHull *hull) {
    Box3 bounds = box3_empty();
    if (all->too_many || hull->count < 3) return true;
    for (int i = 0; i < hull->count; i++) {
        if (!vec3_is_finite(hull->points[i])) return true;
        bounds = box3_add_point(bounds, hull->points[i]);
    }
    for (size_t i = 0; i < all->count; i++) {
        const Blocker *b = &all->items[i];
        bool apart = b->is_plane ? !crosses_plane(b, hull) : is_apart(hull, bounds, b->box);
        bool evenly = b->gentle > 0 && b->gentle >= hull->fine;
        if (!apart && !evenly && !(b->media && fills(b->media, hull))) return true;
    }
    return false;
}
