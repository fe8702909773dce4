/* What Embree does for us: the interface of the module vts_embree, which is loaded when there is something for it to do: whoever draws a
 * few spheres need not wait for it. */
#ifndef VTS_RENDER_EMBREE_SHIM_H
#define VTS_RENDER_EMBREE_SHIM_H

#include <embree3/rtcore.h>

/* Changes with every change of this file; a module with another number is not used. */
enum { EMBREE_SHIM_VERSION = 1 };

/* Embree's functions, without their "rtc". */
#define EMBREE_FUNCTIONS(F)                                                                                            \
    F(NewDevice) F(ReleaseDevice) F(GetDeviceError) F(GetDeviceProperty)                                               \
    F(NewScene) F(ReleaseScene) F(SetSceneFlags) F(CommitScene)                                                        \
    F(NewGeometry) F(ReleaseGeometry) F(CommitGeometry) F(AttachGeometry) F(AttachGeometryByID)                        \
    F(SetNewGeometryBuffer) F(SetSharedGeometryBuffer) F(SetGeometryUserData) F(SetGeometryUserPrimitiveCount)         \
    F(SetGeometryBoundsFunction)                                                                                       \
    F(SetGeometryIntersectFunction) F(SetGeometryOccludedFunction) F(SetGeometryIntersectFilterFunction)               \
    F(SetGeometryOccludedFilterFunction) F(SetGeometryInstancedScene) F(SetGeometryTransform)                          \
    F(Intersect1) F(Intersect8) F(Occluded1) F(Occluded8)

#define EMBREE_POINTER(name) __typeof__(rtc##name) *name;
typedef struct EmbreeShim {
    int version;
    EMBREE_FUNCTIONS(EMBREE_POINTER)
} EmbreeShim;
#undef EMBREE_POINTER

/* Embree at work. */
typedef struct EmbreeDevice {
    const EmbreeShim *shim;
    RTCDevice handle;
} EmbreeDevice;

#endif
