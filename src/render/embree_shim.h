/* What vts asks of Embree: the interface of the module vts_embree, which is loaded when a scene needs a tree (embree_module.h). */
#ifndef VTS_RENDER_EMBREE_SHIM_H
#define VTS_RENDER_EMBREE_SHIM_H

#include "base/common.h"

#include <embree3/rtcore.h>

/* Changes with every change of the list; a module with another number is not used. */
enum { EMBREE_SHIM_VERSION = 2 };

/* Embree's functions, each under its name without rtc. */
#define EMBREE_FUNCTIONS(X) \
    X(AttachGeometry) X(AttachGeometryByID) X(CommitGeometry) X(CommitScene) X(GetDeviceError) X(GetDeviceProperty) X(GetGeometry) \
    X(Intersect1) X(Intersect8) X(NewDevice) X(NewGeometry) X(NewScene) X(Occluded1) X(Occluded8) X(ReleaseDevice) X(ReleaseGeometry) \
    X(ReleaseScene) X(SetGeometryBoundsFunction) X(SetGeometryInstancedScene) X(SetGeometryIntersectFilterFunction) \
    X(SetGeometryIntersectFunction) X(SetGeometryOccludedFilterFunction) X(SetGeometryOccludedFunction) X(SetGeometryTransform) \
    X(SetGeometryBuildQuality) X(SetSceneBuildQuality) X(SetGeometryUserData) X(SetGeometryUserPrimitiveCount) X(SetNewGeometryBuffer) X(SetSceneFlags) X(SetSharedGeometryBuffer)

typedef struct EmbreeShim {
    int version; /* EMBREE_SHIM_VERSION */
#define EMBREE_POINTER(name) __typeof__(&rtc##name) name;
    EMBREE_FUNCTIONS(EMBREE_POINTER)
#undef EMBREE_POINTER
} EmbreeShim;

/* What the module exports. */
VTS_EXPORT const EmbreeShim *vts_embree_shim(void);

#endif
