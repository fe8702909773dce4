#include "texel/opacity.h"

#include <float.h>

/* No segment is quite opaque, so that shares of it have a meaning. */
#define LEAST_TRANSMITTANCE (1.0f / 512)

/* Opacity of the voxel as stored in Neyret 1998: the same for all directions; its anisotropy scales optical depth (E16). */
static float transmit_mean(float mean_tau, float ratio) {
    float through = float_max(1 - mean_tau, LEAST_TRANSMITTANCE);
    return powf(through, ratio);
}

static float transmit_correlated(float tau, float gamma) {
    return gamma * float_max(0, 1 - tau) + (1 - gamma) * expf(-tau);
}

float opacity_transmittance(OpacityModel model, const VoxelSample *v, float h, Vec3f step) {
    if (!(v->density > 0)) return 1;
    float projected = sqrtf(float_max(0, sym3f_quadratic(&v->s, step))); /* |step|·sigma(d) / density */
    if (model == OPACITY_EXPONENTIAL) return float_max(expf(-v->density * projected), FLT_MIN);
    /* |step| / l, l = h / (|dx| + |dy| + |dz|) the mean crossing of a voxel */
    float crossings = (fabsf(step.x) + fabsf(step.y) + fabsf(step.z)) / h;
    if (!(crossings > 0)) return 1;
    float tau = v->density * projected / crossings;
    float through = model == OPACITY_MEAN ? transmit_mean(v->density * h, tau / (v->density * h))
                                          : transmit_correlated(tau, v->gamma);
    return float_max(powf(float_max(through, LEAST_TRANSMITTANCE), crossings), FLT_MIN);
}
