#include "texel/opacity.h"

/* The crossing law's: no voxel is quite opaque, so that shares of a crossing have a meaning. */
#define LEAST_TRANSMITTANCE (1.0f / 512)

/* |step|·sqrt(dᵗ S d) for its direction d. */
static float projected(const VoxelSample *v, Vec3f step) {
    return sqrtf(float_max(0, sym3f_quadratic(&v->s, step)));
}

/* |step| in mean crossings h/(|dx| + |dy| + |dz|) of a voxel. */
static float crossings(Vec3f step, float h) { return (fabsf(step.x) + fabsf(step.y) + fabsf(step.z)) / h; }

/* The most that a transmittance above 0 can stand for. */
#define LARGEST_DEPTH 87.0f

float opacity_depth_mean(const VoxelSample *v, float finest, float h, Vec3f step) {
    if (!(v->density > 0)) return 0;
    /* The anisotropy scales optical depth, not opacity (erratum E16). */
    float through = float_max(1 - v->density * finest, LEAST_TRANSMITTANCE);
    return -logf(through) * projected(v, step) / h;
}

static float crossing_depth(const VoxelSample *v, float h, Vec3f step) {
    float n = crossings(step, h);
    if (!(n > 0)) return 0;
    float tau = v->density * projected(v, step) / n;
    float gamma = float_max(0, v->gamma), through = gamma * float_max(0, 1 - tau) + (1 - gamma) * expf(-tau);
    return -n * logf(float_max(through, LEAST_TRANSMITTANCE));
}

float opacity_area(const VoxelSample *v, Vec3f step) { return v->density * projected(v, step); }

float opacity_depth(OpacityModel model, const VoxelSample *v, float h, Vec3f step) {
    if (!(v->density > 0)) return 0;
    switch (model) {
    case OPACITY_MEAN: return opacity_depth_mean(v, h, h, step);
    case OPACITY_EXPONENTIAL: return v->density * projected(v, step);
    case OPACITY_CROSSING: return crossing_depth(v, h, step);
    case OPACITY_CORRELATED: break;
    }
    return v->density * projected(v, step) * opacity_enhancement(v->gamma, v->density * h);
}

float opacity_transmittance(OpacityModel model, const VoxelSample *v, float h, Vec3f step) {
    return expf(-float_min(opacity_depth(model, v, h, step), LARGEST_DEPTH));
}

float opacity_transmittance_mean(const VoxelSample *v, float finest, float h, Vec3f step) {
    return expf(-float_min(opacity_depth_mean(v, finest, h, step), LARGEST_DEPTH));
}
