#include "render/ray_bundle.h"

#include "render/embree_ray.h"

#include <string.h>

/* Sixteen at once are a tenth faster where the machine has them, but coherent ones never came back from rtcOccluded16 of Embree 3.13 among mirrored copies. */
int bundle_lanes(const Embree *embree) {
    return embree->rtc->GetDeviceProperty(embree->device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? MOST_LANES : 1;
}

RayBundle bundle_for(int lanes) {
    RayBundle bundle;
    memset(&bundle, 0, sizeof bundle);
    bundle.lanes = lanes;
    return bundle;
}

void bundle_clear(RayBundle *bundle) {
    bundle->count = 0;
    memset(bundle->valid, 0, sizeof bundle->valid);
}

static void put_vector(RayBundle *bundle, int field, int ray, Vec3f v) {
    bundle_cell(bundle, field, ray)->real = v.x;
    bundle_cell(bundle, field + 1, ray)->real = v.y;
    bundle_cell(bundle, field + 2, ray)->real = v.z;
}

void bundle_add(RayBundle *bundle, Vec3f origin, Vec3f direction, float near, float far, uint32_t sample) {
    struct RTCRay one = {.org_x = origin.x, .org_y = origin.y, .org_z = origin.z, .dir_x = direction.x, .dir_y = direction.y, .dir_z = direction.z,
                         .tnear = near, .tfar = far};
    bool near_enough = fabsf(origin.x) < BUNDLE_FARTHEST && fabsf(origin.y) < BUNDLE_FARTHEST && fabsf(origin.z) < BUNDLE_FARTHEST;
    if (!near_enough || !embree_takes(&one)) return;
    int i = bundle->count++;
    put_vector(bundle, RAY_ORIGIN, i, origin);
    put_vector(bundle, RAY_DIRECTION, i, direction);
    bundle_cell(bundle, RAY_NEAR, i)->real = near;
    bundle_cell(bundle, RAY_FAR, i)->real = far;
    bundle_cell(bundle, RAY_MASK, i)->number = UINT32_MAX;
    bundle_hit(bundle, HIT_GEOMETRY, i)->number = RTC_INVALID_GEOMETRY_ID;
    bundle_hit(bundle, HIT_COPY, i)->number = RTC_INVALID_GEOMETRY_ID;
    bundle->sample[i] = sample;
    bundle->valid[i] = -1;
}

void bundle_intersect(RayBundle *bundle, const EmbreeShim *rtc, RTCScene scene) {
    struct RTCIntersectContext context;
    void *rays = bundle->cells;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT; /* in place of a half more time */
    if (bundle->lanes == MOST_LANES) rtc->Intersect8(bundle->valid, scene, &context, rays);
    else rtc->Intersect1(scene, &context, rays);
}

void bundle_occlude(RayBundle *bundle, const EmbreeShim *rtc, RTCScene scene) {
    struct RTCIntersectContext context;
    void *rays = bundle->cells;
    rtcInitIntersectContext(&context); /* ways from places behind each other are not coherent: taken so, they take a seventh longer */
    if (bundle->lanes == MOST_LANES) rtc->Occluded8(bundle->valid, scene, &context, rays);
    else rtc->Occluded1(scene, &context, rays);
}
