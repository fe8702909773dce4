/* Volumes: clouds, haze and smoke, which scatter and absorb light on its way and have no surface. */
#ifndef VTS_SCENE_VOLUMES_H
#define VTS_SCENE_VOLUMES_H

#include "scene/scene.h"

/* How light is turned aside; mu is the cosine between the ways before and after. All are normalised over the sphere. */
typedef enum PhaseKind {
    PHASE_ISOTROPIC,
    PHASE_RAYLEIGH,          /* 1 + mu² */
    PHASE_POWER,             /* ((1 + mu)/2)^k: half of the Mie scattering of hazes (k 8) and of murky ones (k 32) */
    PHASE_HENYEY_GREENSTEIN, /* k: the mean of mu */
    PHASE_SCHLICK            /* (1 - k mu)^-2; k > 0: forwards */
} PhaseKind;

typedef struct PhaseLobe {
    PhaseKind kind;
    double k;      /* |k| < 1, but the power of PHASE_POWER */
    double weight; /* > 0; those of all lobes sum to 1 */
} PhaseLobe;

enum { PHASE_MOST_LOBES = 16 };
typedef struct Phase {
    PhaseLobe lobes[PHASE_MOST_LOBES];
    int count; /* at least 1 */
} Phase;

typedef enum VolumeMethod {
    VOLUME_TWO_PASS,  /* light is shot and kept once, and gathered by lines of sight */
    VOLUME_PUBLISHED, /* as printed in Blasi, Le Saec & Schlick 1993, its errors included */
    VOLUME_PATH       /* paths from the eye, nothing kept */
} VolumeMethod;

typedef enum VolumeStorage { VOLUME_STORAGE_AUTO, VOLUME_STORAGE_ISOTROPIC, VOLUME_STORAGE_DIRECTIONAL } VolumeStorage;

/* Light that goes a length ds through the density d is scattered with the probability scattering·d·ds, and absorbed with absorption·d·ds. Lengths are the
 * scene's, however the volume is scaled. */
struct Volume {
    Span span;
    Hash128 hash;
    const DensityField *density; /* NULL: 1 everywhere. in_bounds: the container's box is the unit cube; else the volume's space */
    const Object *container;     /* a solid with bounds; never NULL */
    Color scattering, absorption;
    Phase phase;
    int orders;                  /* how often light is scattered at most; 0: as often as it is */
    double rays;                 /* shot by the light pass, or paths of a line of sight; 0: auto */
    double step;                 /* side of the cells that a density without a grid is sampled in, scene units; 0: auto */
    VolumeMethod method;
    VolumeStorage storage;
};

/* scene_volume.c */
void volume_rehash(Volume *volume);
/* The volume's fields after its word, on the same line. */
void volume_print(const Volume *volume, StrBuf *out);
void phase_hash(Hash128 *hash, const Phase *phase);
/* " phase" and its lobes. */
void phase_print(const Phase *phase, StrBuf *out);

#endif
