/* Further channels of a picture (arbitrary output variables): what a pixel sees, beside how bright it is. */
#ifndef VTS_RENDER_AOV_H
#define VTS_RENDER_AOV_H

#include "base/strbuf.h"
#include "base/vec.h"

typedef enum AovKind {
    AOV_DEPTH, AOV_NORMAL, AOV_ALBEDO, AOV_ALPHA, AOV_POSITION, AOV_OBJECT, AOV_UV, AOV_TEXEL_LEVEL, AOV_SAMPLES, AOV_KINDS
} AovKind;

enum { AOV_MOST_CHANNELS = 17 };

/* The kinds that are wanted, in the order asked for, each once. */
typedef struct AovPlan {
    AovKind kinds[AOV_KINDS];
    int count;
    int channels;
    const char *names[AOV_MOST_CHANNELS]; /* of the channels, as EXR has them: "depth", "normal.X" …; static */
} AovPlan;

/* Reads "depth,normal,…". False with a line in `why` (may be NULL) when a name is none, or there is none. */
bool aov_plan_parse(const char *names, AovPlan *out, StrBuf *why);

/* What part of a ray or cone has met. */
typedef struct AovSample {
    float share;     /* of the ray, 0 to 1 */
    double depth;    /* distance from where the ray starts */
    Vec3 position;   /* in the scene */
    Vec3f normal;    /* towards the eye */
    Vec3f albedo;    /* pigment */
    float u, v;
    uint32_t object; /* number of the part, from 1; 0: none (matter of skins) */
    float level;     /* of the voxels; negative: none */
} AovSample;

/* Sums over a pixel. */
typedef struct AovSum {
    double covered, leveled;
    double depth, level, u, v;
    Vec3 position, normal, albedo;
    uint32_t object; /* of the first that was met */
    int samples;
} AovSum;

/* `weight`: samples that saw this. */
void aov_add(AovSum *sum, const AovSample *sample, double weight);
/* The channels of a pixel. Filtered as the colour is: normal and albedo are means over all samples, where nothing is seen 0; depth, position,
 * u, v and level are means over what was met; nothing: infinite depth, level -1, else 0. `alpha` is the picture's. */
void aov_write(const AovPlan *plan, const AovSum *sum, float alpha, float *channels);

#endif
