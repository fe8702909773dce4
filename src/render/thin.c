#include "render/thin.h"

#include "shape/tessellate.h"

static double least_of(Vec3 size) { return fmin(size.x, fmin(size.y, size.z)); }

static double cone_width(const Object *object) {
    double widest = 2 * fmax(fabs(object->as.cone.base_radius), fabs(object->as.cone.cap_radius));
    return fmin(widest, vec3_length(vec3_sub(object->as.cone.cap, object->as.cone.base)));
}

/* In its own space; negative: not known. */
static double solid_width(const Object *object) {
    switch (object->kind) {
    case OBJECT_SPHERE: return 2 * fabs(object->as.sphere.radius);
    case OBJECT_BOX:
        return least_of(vec3_sub(vec3_max(object->as.box.corner1, object->as.box.corner2),
                                 vec3_min(object->as.box.corner1, object->as.box.corner2)));
    case OBJECT_CYLINDER:
    case OBJECT_CONE: return cone_width(object);
    case OBJECT_TORUS: return 2 * fabs(object->as.torus.minor_radius);
    default: return -1;
    }
}

double thin_item(const Item *item) {
    const Box3 box = item_box(item);
    double own = item->cluster ? item->cluster->width : item->body ? -1 : solid_width(item->object);
    if (own < 0)
        own = VTS_INFINITY;
    else
        own /= fmax(tessellate_stretch(&item->back.linear), 1e-300);
    return item->cluster ? own : fmin(own, fmax(least_of(vec3_sub(box.max, box.min)), 0));
}

/* Along their axes open cylinders and cones show the edges of their walls alone. */
static bool is_sheet(const Object *object) { return (object->kind == OBJECT_CYLINDER || object->kind == OBJECT_CONE) && object->as.cone.open; }

bool thin_is_known(const Item *item) { return !item->cluster && !item->body && solid_width(item->object) >= 0 && !is_sheet(item->object); }

/* Those that a cluster holds come before it. */
void thin_clusters(const ClusterSet *set) {
    for (size_t i = 0; i < set->clusters.count; i++) {
        Cluster *cluster = set->clusters.items[i];
        cluster->width = VTS_INFINITY;
        for (size_t k = 0; k < cluster->items.count; k++)
            cluster->width = fmin(cluster->width, thin_item(&cluster->items.items[k]));
    }
}
