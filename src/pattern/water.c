/* Ripples and waves: circular waves from a number of sources about the origin. */
#include "pattern/numbers.h"

#include "tape/noise.h"

/* POV-Ray's generator, from its own start: frequencies in [0.01, 1.01). */
static double next_frequency(uint32_t *state) {
    *state = *state * 1812433253u + 12345u;
    return (*state >> 16 & 0x7FFF) * 0.000030518509476 + 0.01;
}

static double cycloid(double x) { return sin(2 * VTS_PI * (x - floor(x))); }

double water_number(const Pigment *pigment, Vec3 p, bool waves) {
    uint32_t state = 3734115329u; /* -560851967 */
    double sum = 0;
    for (int i = 0; i < pigment->wave_count; i++) {
        Vec3 source = vec3_normalize(noise_pov_vector(vec3(i, 0, 0)));
        double length = vec3_length(vec3_sub(p, source)), frequency = waves ? next_frequency(&state) : 1;
        if (length == 0) length = 1;
        sum += cycloid(length * pigment->frequency * frequency + pigment->phase) / frequency;
    }
    double mean = sum / int_max(pigment->wave_count, 1);
    return waves ? 0.2 * (2.5 + mean) : 0.5 * (1 + mean);
}
