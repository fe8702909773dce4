#include "render/contrast.h"

#include <math.h>

/* An edge of contrast C that crosses a pixel anywhere leaves an error of C/√12 in its middle's sample; of two pixels whose second
 * difference it makes C it crosses one. */
static const float STEP_TO_ERROR = 0.408f;
/* Where light changes alike on both sides a second difference is that of something smooth, of which the middle has but a small error. */
static const float SMOOTH = 0.05f;

/* With the pixels `away` before and after. A loop that compilers turn into vectors. */
static inline void add_direction(const LightPlanes *light, int first, int away, int count, float *restrict most) {
    for (int i = 0; i < count; i++) {
        float after = 0, before = 0, both = 0, second = 0;
        for (int c = 0; c < 3; c++) {
            const float *here = light->channels[c] + first + i;
            const float a = here[away] - here[0], b = here[0] - here[-away], bend = a - b;
            after += a * a;
            before += b * b;
            both += a * b;
            second += bend * bend;
        }
        const float larger = float_max(after, before);
        const float step = float_max(SMOOTH, float_min(1, 1.4f - 2 * both / float_max(larger, 1e-37f)));
        most[i] = float_max(most[i], second * step);
    }
}

static inline void add_all(const LightPlanes *light, int first, int count, float *out) {
    static const int across[] = {1, CONTRAST_EDGE, CONTRAST_EDGE + 1, CONTRAST_EDGE - 1};
    for (int i = 0; i < count; i++) out[i] = 0;
    for (int k = 0; k < 4; k++) add_direction(light, first, across[k], count, out);
    for (int i = 0; i < count; i++) out[i] *= STEP_TO_ERROR * STEP_TO_ERROR / 12;
}

void contrast_row(const LightPlanes *light, int first, int count, float *out) { add_all(light, first, count, out); }

float contrast_at(const LightPlanes *light, int place) {
    float out;
    add_all(light, place, 1, &out); /* for which the compiler leaves the arrays out */
    return out;
}

int contrast_class(float contrast) {
    int exponent;
    if (!(contrast > 0)) return CONTRAST_CLASSES - 1;
    bool power = frexpf(contrast, &exponent) == 0.5f;
    return exponent > 0 ? 0 : int_min((power - exponent) / 2, CONTRAST_CLASSES - 1);
}
