/* Ripples and waves: circular waves from a number of sources about the origin. */
#include "pattern/numbers.h"

#include "tape/noise.h"

/* POV-Ray's generator, from its own start: frequencies in [0.01, 1.01). */
static double next_frequency(uint32_t *state) {
    *state = *state * 1812433253u + 12345u;
    return (*state >> 16 & 0x7FFF) * 0.000030518509476 + 0.01;
}

/* Where the sources lie that waves have by default: the directions of the vector noise at (i, 0, 0). */
static const Vec3 FIRST_SOURCES[] = {
    {-0.60437821325775842, 0.49204840803398064, -0.62659024848028477},
    {-0.55257310417457395, -0.24607533873593257, -0.79631017336768428},
    {-0.44455108505476548, 0.62332898483857657, 0.64330032600391274},
    {0.49658606690988161, 0.6689481632688099, 0.55309188478069393},
    {-0.064371814202767927, -0.80595157786206306, -0.58847117489125611},
    {0.24619021440605479, -0.91455678347985547, -0.32089915568863925},
    {-0.66608895218544739, -0.59187856314479337, -0.4538780389775951},
    {-0.52048920247506592, -0.38602713558619201, -0.76162591913483979},
    {0.13794944733959097, -0.70464210668186833, -0.69602403081333342},
    {0.5648967309620444, 0.72204051406461378, -0.39943607673531945},
};

Vec3 water_source(int i) {
    if (i < (int)VTS_ARRAY_COUNT(FIRST_SOURCES)) return FIRST_SOURCES[i];
    return vec3_normalize(noise_pov_vector(vec3(i, 0, 0)));
}

static double cycloid(double x) { return sin(2 * VTS_PI * (x - floor(x))); }

typedef struct WaveSource {
    Vec3 away;     /* unit, from the source to the place */
    double length; /* distance in wavelengths, phase added */
    double frequency, rise;
} WaveSource;

static WaveSource wave_source(const Pigment *pigment, Vec3 p, int i, double frequency) {
    Vec3 away = vec3_sub(p, water_source(i));
    double length = vec3_length(away);
    if (length == 0) length = 1;
    return (WaveSource){vec3_scale(away, 1 / length), length, frequency,
                        cycloid(length * pigment->frequency * frequency + pigment->phase) / frequency};
}

double water_number(const Pigment *pigment, Vec3 p, bool waves) {
    uint32_t state = 3734115329u; /* -560851967 */
    double sum = 0;
    for (int i = 0; i < pigment->wave_count; i++)
        sum += wave_source(pigment, p, i, waves ? next_frequency(&state) : 1).rise;
    double mean = sum / int_max(pigment->wave_count, 1);
    return waves ? 0.2 * (2.5 + mean) : 0.5 * (1 + mean);
}

/* The mean of a sine over an interval of `width` periods, relative to the sine in its middle. */
static double sine_kept(double width) {
    double half = VTS_PI * fmin(fabs(width), 1);
    return half > 1e-6 ? sin(half) / half : 1;
}

Vec3 water_bump(const Pigment *pigment, const Spot *spot, bool waves) {
    uint32_t state = 3734115329u;
    Vec3 sum = {0, 0, 0};
    for (int i = 0; i < pigment->wave_count; i++) {
        WaveSource s = wave_source(pigment, spot->p, i, waves ? next_frequency(&state) : 1);
        double kept = sine_kept(spot_width(spot, s.away) * pigment->frequency * s.frequency);
        sum = vec3_madd(sum, s.away, kept * s.rise);
    }
    return vec3_scale(sum, 1.0 / int_max(pigment->wave_count, 1));
}
