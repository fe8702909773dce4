/* POV-Ray's media: matter that glows, absorbs and scatters light once, in hollow objects and between them. */
#ifndef VTS_SCENE_MEDIUM_H
#define VTS_SCENE_MEDIUM_H

#include "scene/volumes.h"

/* A factor of a medium's density: the colour of a pattern. */
typedef struct MediumDensity {
    const Pigment *pattern;
    Transform place; /* the pattern's space → the medium's */
} MediumDensity;

/* Where its density is d, light that goes a length ds loses the part (absorption + loss·scattering)·d·ds and gets emission·d·ds, and lamps add
 * scattering·d·ds of their light. All of it colour by colour; numbers may be negative, and are finite. */
struct Medium {
    Span span;
    Color absorption, emission, scattering;
    double loss;  /* `extinction`: what part of scattered light is lost to its ray; 1 */
    Phase phase;  /* of scattering */
    double gain;  /* POV-Ray's phase functions are this many times phase · 4π */
    const MediumDensity *densities; /* multiplied; none: 1 everywhere */
    size_t density_count;
    double samples; /* on a line of sight, as the scene asks for them at least; 0: nothing said */
};

/* scene_media.c */
void media_hash(Hash128 *hash, const MediaList *media);
/* Its fields after its word, on the same line. */
void medium_print(const Medium *medium, StrBuf *out);

#endif
