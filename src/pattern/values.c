/* The definitions are POV-Ray 3.7's: where they look odd (marble's and wood's triangle wave, the crackle's random numbers,
 * radial's hole at the axis), scenes rely on them. */
#include "pattern/values.h"

#include "pattern/numbers.h"
#include "pattern/pavement.h"
#include "pattern/picture_map.h"
#include "pattern/pigment.h"
#include "pattern/tiling.h"
#include "tape/noise.h"

PatternTraits pattern_traits(PatternKind kind) {
    switch (kind) {
    case PATTERN_MARBLE:
    case PATTERN_WOOD: return (PatternTraits){.wave = WAVE_TRIANGLE, .warps_itself = true};
    case PATTERN_SPIRAL1:
    case PATTERN_SPIRAL2: return (PatternTraits){.wave = WAVE_TRIANGLE, .sampled = true};
    case PATTERN_GRADIENT: return (PatternTraits){.restart = RESTART_PAST_ONE};
    case PATTERN_FUNCTION: return (PatternTraits){.restart = RESTART_PAST_ONE, .sampled = true};
    case PATTERN_ONION: return (PatternTraits){.restart = RESTART_AT_ONE};
    case PATTERN_RADIAL: return (PatternTraits){.bounded = false};
    case PATTERN_UV: return (PatternTraits){.blocks = 1};
    case PATTERN_CHECKER:
    case PATTERN_BRICK:
    case PATTERN_OBJECT: return (PatternTraits){.blocks = 2};
    case PATTERN_HEXAGON: return (PatternTraits){.blocks = 3};
    case PATTERN_SQUARE: return (PatternTraits){.blocks = 4};
    case PATTERN_CUBIC:
    case PATTERN_TRIANGULAR: return (PatternTraits){.blocks = 6};
    case PATTERN_QUILTED:
    case PATTERN_RIPPLES:
    case PATTERN_WAVES:
    case PATTERN_MANDEL:
    case PATTERN_JULIA:
    case PATTERN_MAGNET_MANDEL:
    case PATTERN_MAGNET_JULIA:
    case PATTERN_PIGMENT: return (PatternTraits){.sampled = true};
    case PATTERN_IMAGE: return (PatternTraits){.bounded = true};
    case PATTERN_DENSITY:
    case PATTERN_TILING:
    case PATTERN_PAVEMENT: return (PatternTraits){.sampled = true};
    default: return (PatternTraits){.bounded = true};
    }
}

WaveKind pigment_wave(const Pigment *pigment) {
    if (pigment->wave != WAVE_OWN) return pigment->wave;
    WaveKind own = pattern_traits(pigment->kind).wave;
    return own == WAVE_OWN ? WAVE_RAMP : own;
}

static Spread exactly(double value) { return (Spread){value, 0, false}; }

/* The mean of sin over an interval of this width is this times its value at the centre. */
static double sine_kept(double width) { return width > 1e-6 ? sin(width / 2) / (width / 2) : 1; }

static double cycloidal(double value) { return sin(2 * VTS_PI * (value - floor(value))); }

/* ---- noises ---- */

static Spread faded(double value, double mean, double deviation, double size, double sharpness) {
    double kept = noise_kept(size, sharpness);
    if (kept == 1) return exactly(value);
    return (Spread){mean + kept * (value - mean), width_of_variance(variance_lost(deviation, kept)), true};
}

static Spread bozo(const Pigment *pigment, const Spot *spot) {
    return faded(noise_generated(generator_of(pigment), spot->p), 0.506, 0.126, spot_size(spot), 0.4);
}

static Spread dents(const Pigment *pigment, const Spot *spot) {
    double noise = noise_generated(generator_of(pigment), spot->p);
    return faded(noise * noise * noise, 0.154, 0.105, spot_size(spot), 0.6);
}

/* Σ weightₖ · octave(frequencyₖ · p), the octaves fading one after the other. */
static Spread octave_sum(const Pigment *pigment, const Spot *spot, int count, double frequency,
                         double (*octave)(int generator, Vec3 p), double mean, double deviation,
                         double sharpness) {
    int generator = generator_of(pigment);
    double sum = 0, variance = 0, weight = 1, size = spot_size(spot);
    for (int k = 0; k < count; k++) {
        Spread part = faded(octave(generator, vec3_scale(spot->p, frequency)), mean, deviation,
                            size * frequency, sharpness);
        sum += weight * part.value;
        variance += weight * weight * part.width * part.width / 12;
        frequency *= 2;
        weight /= 2;
    }
    return (Spread){sum, width_of_variance(variance), true};
}

/* What the later noises are spread by, the first is not: POV-Ray's. */
static double granite_octave(int generator, Vec3 p) {
    double noise = noise_generated(generator, p);
    return generator < NOISE_CORRECTED ? fabs(0.5 - noise) : fmin(fabs(1 - 2 * noise), 0.5);
}

static double wrinkle_octave(int generator, Vec3 p) {
    double noise = noise_generated(generator, p);
    return generator < NOISE_CORRECTED ? noise : double_clamp(2 * noise - 0.5, 0, 1);
}

static Spread granite(const Pigment *pigment, const Spot *spot) {
    return octave_sum(pigment, spot, 6, 4, granite_octave, 0.201, 0.14, 1);
}

static Spread wrinkles(const Pigment *pigment, const Spot *spot) {
    Spread sum = octave_sum(pigment, spot, 10, 1, wrinkle_octave, 0.512, 0.245, 0.4);
    return (Spread){sum.value / 2, sum.width / 2, sum.bell};
}

static Spread agate(const Pigment *pigment, const Spot *spot) {
    Octaves octaves =
        has_turbulence(pigment) ? octaves_of(pigment) : (Octaves){6, 2, 0.5F, generator_of(pigment)};
    Spread turb = turbulence(spot, octaves);
    double amount = 1.3 * pigment->agate_turbulence, phase = amount * turb.value + 1.1 * spot->p.z;
    double width = 2 * VTS_PI * hypot(amount * turb.width, 1.1 * spot_width(spot, vec3(0, 0, 1)));
    double kept = sine_kept(width);
    double value = 0.5 * (kept * cycloidal(phase) + 1);
    return (Spread){pow(double_clamp(value, 0, 1), 0.77), width_of_variance(0.125 * (1 - kept * kept)), false};
}

static Spread marble(const Pigment *pigment, const Spot *spot) {
    Spread value = {spot->p.x, spot_width(spot, vec3(1, 0, 0)), false};
    if (!has_turbulence(pigment)) return value;
    Spread turb = turbulence(spot, octaves_of(pigment));
    double amount = pigment->turbulence.x;
    return (Spread){value.value + amount * turb.value, hypot(value.width, amount * turb.width), false};
}

static Spread distance_from(const Spot *spot, Vec3 p) {
    double r = vec3_length(p);
    Vec3 away = r > 0 ? vec3_scale(p, 1 / r) : vec3_splat(1 / sqrt(3));
    return (Spread){r, spot_width(spot, away), false};
}

static Spread wood(const Pigment *pigment, const Spot *spot) {
    Vec3 p = vec3(spot->p.x, spot->p.y, 0);
    if (!has_turbulence(pigment)) return distance_from(spot, p);
    double variance;
    Vec3 shift = turbulence_vector(spot, octaves_of(pigment), &variance), amount = pigment->turbulence;
    p.x += cycloidal((spot->p.x + shift.x) * amount.x);
    p.y += cycloidal((spot->p.y + shift.y) * amount.y);
    Spread value = distance_from(spot, p);
    /* the sine's argument varies; its result by no more than a whole sine does */
    double argument = 4 * VTS_PI * VTS_PI * (variance + pow(spot_size(spot), 2) / 12) *
                      (amount.x * amount.x + amount.y * amount.y) / 2;
    value.width = hypot(value.width, width_of_variance(fmin(argument, 0.5)));
    return value;
}

/* ---- cells ---- */

static Spread crackle(const Pigment *pigment, const Spot *spot) {
    return faded(crackle_number(pigment, spot->p), 0.196, 0.158, spot_size(spot), 2);
}

/* ---- shapes ---- */

static Spread gradient(const Pigment *pigment, const Spot *spot) {
    Vec3 direction = vec3_normalize(pigment->direction);
    return (Spread){vec3_dot(spot->p, direction), spot_width(spot, direction), false};
}

static Spread radial(const Spot *spot) {
    Vec3 p = spot->p;
    if (fabs(p.x) < 0.001 && fabs(p.z) < 0.001) return (Spread){0.25, fmin(spot_size(spot) * 1000, 1), false};
    double square = p.x * p.x + p.z * p.z;
    double width = spot_width(spot, vec3(p.z / square, 0, -p.x / square)) / (2 * VTS_PI);
    return (Spread){0.25 + (atan2(p.x, p.z) + VTS_PI) / (2 * VTS_PI), fmin(width, 1), false};
}

/* The square of the mean of three sines, each averaged over the footprint. */
static Spread leopard(const Spot *spot) {
    double sines[3], squares = 0, sum = 0, peak = 0;
    for (int k = 0; k < 3; k++) {
        Vec3 axis = vec3(k == 0, k == 1, k == 2);
        double width = spot_width(spot, axis), sine = sin(vec3_get(spot->p, k)), once = sine_kept(width);
        sines[k] = once * sine;
        squares += (1 - sine_kept(2 * width) * (1 - 2 * sine * sine)) / 2 - sines[k] * sines[k];
        sum += sines[k];
        peak += (1 - once * once) / 2;
    }
    double value = (sum * sum + squares) / 9;
    return (Spread){value, width_of_variance((4 * sum * sum * peak + 2 * peak * peak) / 81), false};
}

static Spread falling(Spread distance) {
    return (Spread){fmax(1 - distance.value, 0), fmin(distance.width, 1), distance.bell};
}

static Spread boxed(const Spot *spot) {
    Vec3 p = vec3(fabs(spot->p.x), fabs(spot->p.y), fabs(spot->p.z));
    int axis = p.x >= p.y && p.x >= p.z ? 0 : p.y >= p.z ? 1 : 2;
    return falling((Spread){vec3_get(p, axis), spot_width(spot, vec3(axis == 0, axis == 1, axis == 2)), false});
}

static double unwrapped(double value) { return value < 0 ? 1 + fmod(value, 1) : fmod(value, 1); }

/* From 0, facing against the direction, to 1, facing along it, by the angle; with the altitude's share. */
static double slope(const Pigment *pigment, const Spot *spot) {
    if (vec3_length_squared(spot->normal) == 0) return 0;
    Vec3 direction = pigment->points_at ? vec3_sub(pigment->direction, spot->outer) : pigment->direction;
    double cosine = vec3_dot(vec3_normalize(direction), vec3_normalize(spot->normal));
    double value = 0.5 + asin(double_clamp(cosine, -1, 1)) / VTS_PI;
    if (pigment->slope_high != pigment->slope_low)
        value = (value - pigment->slope_low) / (pigment->slope_high - pigment->slope_low);
    double share = vec3_length(pigment->altitude), own = vec3_length(pigment->direction);
    if (share == 0) return value == 1 ? 1 - 1e-10 : unwrapped(value);
    double height = vec3_dot(spot->p, pigment->altitude) / share;
    if (pigment->altitude_high != pigment->altitude_low)
        height = (height - pigment->altitude_low) / (pigment->altitude_high - pigment->altitude_low);
    value = (own * value + share * height) / (own + share);
    return value >= 1 && value < 1 + 1e-10 ? value - 1e-10 : unwrapped(value);
}

/* From 0.5, along the surface, to 1, straight at it: the normal looks towards the ray's origin. */
static double incidence(const Spot *spot) {
    if (!spot->surface) return 1;
    double cosine = vec3_dot(vec3_normalize(spot->normal), vec3_normalize(spot->surface->direction));
    return acos(double_clamp(cosine, -1, 1)) / VTS_PI;
}

/* ---- others ---- */

double quilt_curve(const Pigment *pigment, double t) {
    double rest = 1 - t;
    return t * t * t + 3 * t * rest * (rest * pigment->control0 + t * pigment->control1);
}

/* From 0 to 1, stretched to the cell's corners. */
static double quilted(const Pigment *pigment, Vec3 p) {
    Vec3 d = vec3(p.x - floor(p.x) - 0.5, p.y - floor(p.y) - 0.5, p.z - floor(p.z) - 0.5);
    return quilt_curve(pigment, vec3_length(d)) * 1.154700538 * (fabs(d.x) + fabs(d.y) + fabs(d.z)) / 3;
}

static double triangle(double x) {
    x -= floor(x);
    return x >= 0.5 ? 2 * (1 - x) : 2 * x;
}

static double spiral(const Pigment *pigment, Vec3 p) {
    Spot spot = spot_make(p, vec3_splat(0), 0);
    double turb =
        has_turbulence(pigment) ? pigment->turbulence.x * turbulence(&spot, octaves_of(pigment)).value : 0;
    double r = sqrt(p.x * p.x + p.y * p.y), angle = r > 0 ? asin(p.y / r) : 0;
    angle = r == 0 ? 0 : p.x < 0 ? 1.5 * VTS_PI - angle : 0.5 * VTS_PI + angle;
    double value = p.z + r + pigment->number * angle / (2 * VTS_PI) + turb;
    return pigment->kind == PATTERN_SPIRAL1 ? value : triangle(r) + triangle(value);
}

static double source_gray(const Pigment *pigment, const Spot *spot) {
    Color c = pigment->source ? pigment_color_at(pigment->source, spot) : (Color){0};
    return 0.297 * c.red + 0.589 * c.green + 0.114 * c.blue;
}

static double function_at(const Pigment *pigment, Vec3 p) {
    double in[3] = {p.x, p.y, p.z}, out[8];
    if (!pigment->function || tape_output_count(pigment->function) != 1) return 0;
    tape_eval_once(pigment->function, in, out);
    return isnan(out[0]) ? 0 : double_clamp(out[0], -1e300, 1e300);
}

Spread pattern_value(const Pigment *pigment, const Spot *spot) {
    switch (pigment->kind) {
    case PATTERN_GRADIENT: return gradient(pigment, spot);
    case PATTERN_BOZO:
    case PATTERN_SPOTTED: return bozo(pigment, spot);
    case PATTERN_DENTS: return dents(pigment, spot);
    case PATTERN_GRANITE: return granite(pigment, spot);
    case PATTERN_WRINKLES: return wrinkles(pigment, spot);
    case PATTERN_AGATE: return agate(pigment, spot);
    case PATTERN_MARBLE: return marble(pigment, spot);
    case PATTERN_WOOD: return wood(pigment, spot);
    case PATTERN_CRACKLE: return crackle(pigment, spot);
    case PATTERN_LEOPARD: return leopard(spot);
    case PATTERN_RADIAL: return radial(spot);
    case PATTERN_BOXED: return boxed(spot);
    case PATTERN_CYLINDRICAL: return falling(distance_from(spot, vec3(spot->p.x, 0, spot->p.z)));
    case PATTERN_ONION: return distance_from(spot, spot->p);
    case PATTERN_SPHERICAL: return falling(distance_from(spot, spot->p));
    case PATTERN_PLANAR: return falling((Spread){fabs(spot->p.y), spot_width(spot, vec3(0, 1, 0)), false});
    case PATTERN_SLOPE: return exactly(slope(pigment, spot));
    case PATTERN_AOI: return exactly(incidence(spot));
    case PATTERN_FUNCTION: return exactly(function_at(pigment, spot->p));
    case PATTERN_QUILTED: return exactly(quilted(pigment, spot->p));
    case PATTERN_RIPPLES:
    case PATTERN_WAVES: return exactly(water_number(pigment, spot->p, pigment->kind == PATTERN_WAVES));
    case PATTERN_SPIRAL1:
    case PATTERN_SPIRAL2: return exactly(spiral(pigment, spot->p));
    case PATTERN_MANDEL:
    case PATTERN_JULIA:
    case PATTERN_MAGNET_MANDEL:
    case PATTERN_MAGNET_JULIA: return exactly(fractal_number(pigment, spot->p));
    case PATTERN_PIGMENT: return exactly(source_gray(pigment, spot));
    case PATTERN_DENSITY: return exactly(density_number(pigment, spot->p));
    case PATTERN_TILING: return exactly(tiling_number(pigment->number, spot->p));
    case PATTERN_PAVEMENT: return exactly(pavement_number(&pigment->pavement, spot->p));
    case PATTERN_IMAGE: return exactly(pigment->image ? picture_map_value(pigment->image, spot) : 0);
    default: return exactly(0);
    }
}

void pattern_values(const Pigment *pigment, const Spot places[PATTERN_PLACES], double values[PATTERN_PLACES]) {
    if (pigment->kind == PATTERN_MANDEL || pigment->kind == PATTERN_JULIA) {
        _Static_assert((int)PATTERN_PLACES == (int)FRACTAL_LANES, "as many places as lanes");
        Vec3 points[FRACTAL_LANES];
        for (int k = 0; k < FRACTAL_LANES; k++) points[k] = places[k].p;
        fractal_numbers(pigment, points, values);
        return;
    }
    for (int k = 0; k < PATTERN_PLACES; k++) values[k] = pattern_value(pigment, &places[k]).value;
}
