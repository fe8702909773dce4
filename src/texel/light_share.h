/* How much of a beam of light the matter at a place on its way gets, by what is known of the matter around the place. */
#ifndef VTS_TEXEL_LIGHT_SHARE_H
#define VTS_TEXEL_LIGHT_SHARE_H

/* The surroundings of a place: a way along the beam with the place in its middle. */
typedef struct LightSurroundings {
    float depth;  /* optical */
    float area;   /* of matter, for each unit of area across the beam; >= 0 */
    float before; /* of it, what the beam meets before the place */
    float sheet;  /* how much of it is one sheet and not many pieces: 0 to 1 */
    float facing; /* of a ball that is seen as the place is, which share of what is seen the beam falls on: 0 to 1 */
} LightSurroundings;

/* To both sides of the place, in voxels of the light's cone: the blur of a blade. */
#define LIGHT_SURROUNDINGS 1.5
/* From this mean gamma on, matter is one sheet, or the wall of a solid (whose two walls have less). */
#define LIGHT_SHEET_GAMMA 0.6f

/* What comes through more than this optical depth counts as if it came through so much: of what is left powers of light make a share that shows. */
#define LIGHT_DEEPEST 5.0f

/* light_facing() of unit directions to the eye and to the light, by their cosine. */
static inline float light_facing(float cosine) { return cosine > -1 ? cosine < 1 ? (1 + cosine) / 2 : 1 : 0; }

/* The share of the light at the beginning of that way that the matter seen at the place gets. In [0, 1]. */
float light_share(const LightSurroundings *around);

#endif
