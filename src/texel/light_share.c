#include "texel/light_share.h"

#include "base/vec.h"

/* More hides nothing more. */
static const float MOST_AREA = 1e4f;

/* Of clumps that let less light fall on their matter than matter at random would get, the share `fall` of it, what is seen is no such matter: it
 * is the side of the clump that faces the eye. Of a ball the light falls on the share `facing` of that. */
static float seen_of_clumps(float fall, float facing) { return fall + (1 - fall) * facing; }

/* Blur spreads a blade over the voxels around it, and it must not shadow itself; but where many blades share a voxel they
 * shadow each other. What decides is that light is neither lost nor gained: what the beam loses, 1 − exp(−depth), falls on the
 * matter that is there. Its share of light is taken to fall as A·exp(−B·area passed), with A from that balance. B = 1 for matter at
 * random, depth = area; less where it hides itself in clumps; 0 for one sheet, which is lit all alike and has but been blurred: its area
 * is 1 at most, whatever is behind it, and what it hides. */
float light_share(const LightSurroundings *s) {
    float depth = float_min(s->depth, MOST_AREA), area = float_min(s->area, MOST_AREA), before = float_min(s->before, area), single = s->sheet * float_min(area, 1);
    if (!(area > 0.01f)) return area > 0 ? seen_of_clumps(float_clamp(depth / area, 0, 1), s->facing) : 1; /* too thin to shadow itself */
    float lost = float_max(1 - expf(-depth), single);
    float shrink = (single + (1 - s->sheet) * area) / area;
    float fall = (1 - s->sheet) * float_min(depth / area, 1), along = fall * area * shrink;
    float seen = (1 - s->sheet) * seen_of_clumps(float_min(depth / area, 1), s->facing);
    float share = along > 1e-3f ? lost * seen * expf(-fall * shrink * before) / (1 - expf(-along)) : lost / (area * shrink);
    return float_clamp(share, 0, 1);
}
