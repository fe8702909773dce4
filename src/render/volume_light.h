/* The light pass of volumes: what does not depend on where it is seen from. */
#ifndef VTS_RENDER_VOLUME_LIGHT_H
#define VTS_RENDER_VOLUME_LIGHT_H

#include "render/volume_set.h"

enum { VOLUME_HARMONICS = 9 };

/* Whether surfaces hide a light at a node. */
typedef enum LightState { LIGHT_HIDDEN, LIGHT_SEEN, LIGHT_PARTLY } LightState;

/* Light within one volume. */
struct VolumeLight {
    /* What comes from each light, at nodes over the unit cube of the volume: optical depth for each colour, and what surfaces hide. */
    int cells[3]; /* nodes: one more */
    size_t nodes;
    float (*depths)[3]; /* [light][node] */
    uint8_t *states;    /* LightState */
    /* Light that was scattered before it is scattered again, from all lamps, and all of the sky's: for each bin its part of the spherical harmonics, as
     * what a unit of density there sends in all directions; the bin's mean density beside it, 0 where there is none. */
    int bins[3];
    int harmonics;    /* 1 or VOLUME_HARMONICS */
    float (*kept)[3]; /* [bin][harmonic]; NULL: none */
    float *density;
    /* While the light pass runs: what each length of the way through a bin sends, and what of it was not scattered once alone. */
    float (*source)[3], (*again)[3]; /* [bin][harmonic] */
};

/* Fills the set's lights by the scene's lamps and sky. False when interrupted. */
bool volumes_light(CompiledScene *compiled);

/* Real spherical harmonics of degrees 0 to 2 in a unit direction, normalised over the sphere. */
void volume_harmonics(Vec3 direction, int count, double out[VOLUME_HARMONICS]);
/* Of which degree each is. */
static inline int volume_harmonic_degree(int i) { return i == 0 ? 0 : i < 4 ? 1 : 2; }

static inline size_t volume_bins(const VolumeLight *light) {
    return (size_t)light->bins[0] * (size_t)light->bins[1] * (size_t)light->bins[2];
}

/* The share of a lamp that comes to a place of the volume, `unit` in its unit cube. */
Vec3f volume_lamp(const CompiledVolume *volume, SurfaceTracer *tracer, size_t light, const LightRay *way,
                  Vec3 unit, Vec3 point);
/* Whether there is about as much matter in the bins around as in this one. */
bool volume_bin_is_even(const VolumeLight *light, const int at[3]);
/* What a unit of density at the place sends along a direction of light that was kept, `shape` being the direction's harmonics. */
Vec3f volume_kept(const CompiledVolume *volume, Vec3 unit, const double shape[VOLUME_HARMONICS]);

#endif
