/* The definitions are POV-Ray 3.7's: where they look odd (marble's and wood's triangle wave, the crackle's random numbers,
 * radial's hole at the axis), scenes rely on them. */
#include "pattern/values.h"

#include "tape/noise.h"

PatternTraits pattern_traits(PatternKind kind) {
    switch (kind) {
    case PATTERN_MARBLE:
    case PATTERN_WOOD: return (PatternTraits){.wave = WAVE_TRIANGLE, .warps_itself = true};
    case PATTERN_GRADIENT: return (PatternTraits){.restart = RESTART_PAST_ONE};
    case PATTERN_ONION: return (PatternTraits){.restart = RESTART_AT_ONE};
    case PATTERN_RADIAL:
    case PATTERN_FUNCTION: return (PatternTraits){.wave = WAVE_RAMP};
    default: return (PatternTraits){.bounded = true};
    }
}

static Spread exactly(double value) { return (Spread){value, 0}; }

/* The mean of sin over an interval of this width is this times its value at the centre. */
static double sine_kept(double width) { return width > 1e-6 ? sin(width / 2) / (width / 2) : 1; }

static double cycloidal(double value) { return sin(2 * VTS_PI * (value - floor(value))); }

/* ---- noises ---- */

static Spread faded(double value, double mean, double deviation, double size, double sharpness) {
    double kept = noise_kept(size, sharpness);
    if (kept == 1) return exactly(value);
    return (Spread){mean + kept * (value - mean), width_of_variance(variance_lost(deviation, kept))};
}

static Spread bozo(const Spot *spot) { return faded(noise_pov(spot->p), 0.506, 0.126, spot_size(spot), 0.4); }

/* Σ weightₖ · octave(frequencyₖ · p), the octaves fading one after the other. */
static Spread octave_sum(const Spot *spot, int count, double frequency, double (*octave)(Vec3 p), double mean,
                         double deviation, double sharpness) {
    double sum = 0, variance = 0, weight = 1, size = spot_size(spot);
    for (int k = 0; k < count; k++) {
        Spread part =
            faded(octave(vec3_scale(spot->p, frequency)), mean, deviation, size * frequency, sharpness);
        sum += weight * part.value;
        variance += weight * weight * part.width * part.width / 12;
        frequency *= 2;
        weight /= 2;
    }
    return (Spread){sum, width_of_variance(variance)};
}

static double granite_octave(Vec3 p) { return fmin(fabs(1 - 2 * noise_pov(p)), 0.5); }
static double wrinkle_octave(Vec3 p) { return double_clamp(2 * noise_pov(p) - 0.5, 0, 1); }

static Spread granite(const Spot *spot) { return octave_sum(spot, 6, 4, granite_octave, 0.201, 0.14, 1); }

static Spread wrinkles(const Spot *spot) {
    Spread sum = octave_sum(spot, 10, 1, wrinkle_octave, 0.512, 0.245, 0.4);
    return (Spread){sum.value / 2, sum.width / 2};
}

static Spread agate(const Pigment *pigment, const Spot *spot) {
    Octaves octaves = has_turbulence(pigment) ? octaves_of(pigment) : (Octaves){6, 2, 0.5F};
    Spread turb = turbulence(spot, octaves);
    double phase = 1.3 * turb.value + 1.1 * spot->p.z;
    double width = 2 * VTS_PI * hypot(1.3 * turb.width, 1.1 * spot_width(spot, vec3(0, 0, 1)));
    double kept = sine_kept(width);
    double value = 0.5 * (kept * cycloidal(phase) + 1);
    return (Spread){pow(double_clamp(value, 0, 1), 0.77), width_of_variance(0.125 * (1 - kept * kept))};
}

static Spread marble(const Pigment *pigment, const Spot *spot) {
    Spread value = {spot->p.x, spot_width(spot, vec3(1, 0, 0))};
    if (!has_turbulence(pigment)) return value;
    Spread turb = turbulence(spot, octaves_of(pigment));
    double amount = pigment->turbulence.x;
    return (Spread){value.value + amount * turb.value, hypot(value.width, amount * turb.width)};
}

static Spread distance_from(const Spot *spot, Vec3 p) {
    double r = vec3_length(p);
    Vec3 away = r > 0 ? vec3_scale(p, 1 / r) : vec3_splat(1 / sqrt(3));
    return (Spread){r, spot_width(spot, away)};
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

static double crackle_at(Vec3 p) {
    /* POV-Ray takes a place 10⁻⁷ below a cell's border for the next cell. */
    Vec3 corner = vec3(floor(p.x + 1e-7), floor(p.y + 1e-7), floor(p.z + 1e-7));
    double first = (double)INFINITY, second = (double)INFINITY;
    for (int cell = 0; cell < 125; cell++) {
        Vec3 at = vec3_add(corner, vec3(cell % 5 - 2, cell / 5 % 5 - 2, cell / 25 - 2));
        double square = vec3_length_squared(vec3_sub(noise_pov_cell_point(at), p));
        if (square < first)
            second = first, first = square;
        else if (square < second)
            second = square;
    }
    return double_clamp(sqrt(second) - sqrt(first), 0, 1);
}

static Spread crackle(const Spot *spot) {
    return faded(crackle_at(spot->p), 0.196, 0.158, spot_size(spot), 2);
}

/* ---- shapes ---- */

static Spread gradient(const Pigment *pigment, const Spot *spot) {
    Vec3 direction = vec3_normalize(pigment->direction);
    return (Spread){vec3_dot(spot->p, direction), spot_width(spot, direction)};
}

static Spread radial(const Spot *spot) {
    Vec3 p = spot->p;
    if (fabs(p.x) < 0.001 && fabs(p.z) < 0.001) return (Spread){0.25, fmin(spot_size(spot) * 1000, 1)};
    double square = p.x * p.x + p.z * p.z;
    double width = spot_width(spot, vec3(p.z / square, 0, -p.x / square)) / (2 * VTS_PI);
    return (Spread){0.25 + (atan2(p.x, p.z) + VTS_PI) / (2 * VTS_PI), fmin(width, 1)};
}

/* The square of the mean of three sines, each averaged over the footprint. */
static Spread leopard(const Spot *spot) {
    double sines[3], squares = 0, sum = 0, peak = 0;
    for (int k = 0; k < 3; k++) {
        Vec3 axis = vec3(k == 0, k == 1, k == 2);
        double width = spot_width(spot, axis), x = vec3_get(spot->p, k), once = sine_kept(width);
        sines[k] = once * sin(x);
        squares += (1 - sine_kept(2 * width) * cos(2 * x)) / 2 - sines[k] * sines[k];
        sum += sines[k];
        peak += (1 - once * once) / 2;
    }
    double value = (sum * sum + squares) / 9;
    return (Spread){value, width_of_variance((4 * sum * sum * peak + 2 * peak * peak) / 81)};
}

static Spread falling(Spread distance) {
    return (Spread){fmax(1 - distance.value, 0), fmin(distance.width, 1)};
}

static Spread boxed(const Spot *spot) {
    Vec3 p = vec3(fabs(spot->p.x), fabs(spot->p.y), fabs(spot->p.z));
    int axis = p.x >= p.y && p.x >= p.z ? 0 : p.y >= p.z ? 1 : 2;
    return falling((Spread){vec3_get(p, axis), spot_width(spot, vec3(axis == 0, axis == 1, axis == 2))});
}

/* From 0, facing against the direction, to 1, facing along it, by the angle. */
static double slope(const Pigment *pigment, const Spot *spot) {
    double cosine = vec3_dot(vec3_normalize(pigment->direction), vec3_normalize(spot->normal));
    return 0.5 + asin(double_clamp(cosine, -1, 1)) / VTS_PI;
}

static double function_at(const Pigment *pigment, Vec3 p) {
    double in[3] = {p.x, p.y, p.z}, out[8];
    if (!pigment->function || tape_output_count(pigment->function) != 1) return 0;
    tape_eval_once(pigment->function, in, out);
    return isfinite(out[0]) ? out[0] : 0;
}

Spread pattern_value(const Pigment *pigment, const Spot *spot) {
    switch (pigment->kind) {
    case PATTERN_GRADIENT: return gradient(pigment, spot);
    case PATTERN_BOZO:
    case PATTERN_SPOTTED: return bozo(spot);
    case PATTERN_GRANITE: return granite(spot);
    case PATTERN_WRINKLES: return wrinkles(spot);
    case PATTERN_AGATE: return agate(pigment, spot);
    case PATTERN_MARBLE: return marble(pigment, spot);
    case PATTERN_WOOD: return wood(pigment, spot);
    case PATTERN_CRACKLE: return crackle(spot);
    case PATTERN_LEOPARD: return leopard(spot);
    case PATTERN_RADIAL: return radial(spot);
    case PATTERN_BOXED: return boxed(spot);
    case PATTERN_CYLINDRICAL: return falling(distance_from(spot, vec3(spot->p.x, 0, spot->p.z)));
    case PATTERN_ONION: return distance_from(spot, spot->p);
    case PATTERN_SPHERICAL: return falling(distance_from(spot, spot->p));
    case PATTERN_PLANAR: return falling((Spread){fabs(spot->p.y), spot_width(spot, vec3(0, 1, 0))});
    case PATTERN_SLOPE: return exactly(slope(pigment, spot));
    case PATTERN_FUNCTION: return exactly(function_at(pigment, spot->p));
    default: return exactly(0);
    }
}
