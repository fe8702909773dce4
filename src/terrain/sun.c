/* The sun's apparent place: the earth's heliocentric longitude and distance by the largest terms of VSOP87 (Bretagnon & Francou 1988, as
 * Meeus, Astronomical Algorithms, 2nd ed. 1998, appendix III, tabulates them), nutation, obliquity, aberration and sidereal time by his
 * chapters 12, 22 and 25. What is left out is below 0.0005 degrees; so is the earth's distance from the ecliptic. */
#include "terrain/sun.h"

#include "terrain/geodesy_shim.h"

static const double METRES_OF_AU = 149597870700.0, CENTURY = 36525;

/* amplitude · cos(phase + rate · millennia), amplitudes in 1e-8 radians and astronomical units. */
typedef struct Term {
    double amplitude, phase, rate;
} Term;

static const Term longitude_0[] = {
    {175347046, 0, 0},          {3341656, 4.6692568, 6283.07585}, {34894, 4.6261, 12566.1517}, {3497, 2.7441, 5753.3849},   {3418, 2.8289, 3.5231},
    {3136, 3.6277, 77713.7715}, {2676, 4.4181, 7860.4194},        {2343, 6.1352, 3930.2097},   {1324, 0.7425, 11506.7698},  {1273, 2.0371, 529.691},
    {1199, 1.1096, 1577.3435},  {990, 5.233, 5884.927},           {902, 2.045, 26.298},        {857, 3.508, 398.149},       {780, 1.179, 5223.694},
    {753, 2.533, 5507.553},     {505, 4.583, 18849.228},          {492, 4.205, 775.523},       {357, 2.92, 0.067},          {317, 5.849, 11790.629},
    {284, 1.899, 796.298},      {271, 0.315, 10977.079},          {243, 0.345, 5486.778},      {206, 4.806, 2544.314},      {205, 1.869, 5573.143},
    {202, 2.458, 6069.777},     {156, 0.833, 213.299},            {132, 3.411, 2942.463},      {126, 1.083, 20.775},        {115, 0.645, 0.98},
};
static const Term longitude_1[] = {
    {628331966747, 0, 0}, {206059, 2.678235, 6283.07585}, {4303, 2.6351, 12566.1517}, {425, 1.59, 3.523}, {119, 5.796, 26.298}, {109, 2.966, 1577.344},
};
static const Term longitude_2[] = {{52919, 0, 0}, {8720, 1.0721, 6283.0758}, {309, 0.867, 12566.152}};
static const Term distance_0[] = {
    {100013989, 0, 0}, {1670700, 3.0984635, 6283.07585}, {13956, 3.05525, 12566.1517}, {3084, 5.1985, 77713.7715}, {1628, 1.1739, 5753.3849}, {1576, 2.8469, 7860.4194},
};

static double sum_terms(const Term *terms, size_t count, double millennia) {
    double sum = 0;
    for (size_t i = 0; i < count; i++) sum += terms[i].amplitude * cos(terms[i].phase + terms[i].rate * millennia);
    return sum * 1e-8;
}
#define SUM(terms, millennia) sum_terms(terms, VTS_ARRAY_COUNT(terms), millennia)

/* Seconds by which the earth's clock lags behind that of the planets: observed, then expected (Espenak & Meeus 2006). Straight lines
 * between; far away the parabola of the tides. */
static double clock_lag(double days) {
    static const struct {
        double year, seconds;
    } known[] = {{1800, 14}, {1850, 7}, {1875, -3}, {1900, -3}, {1920, 21}, {1950, 29}, {1970, 40}, {1985, 54}, {2000, 64}, {2010, 66}, {2025, 69}, {2050, 80}, {2100, 120}};
    double year = 2000 + days / 365.25, u = (year - 1820) / 100;
    size_t last = VTS_ARRAY_COUNT(known) - 1;
    if (!(year > known[0].year && year < known[last].year)) return -20 + 32 * u * u;
    size_t i = 0;
    while (year > known[i + 1].year) i++;
    double t = (year - known[i].year) / (known[i + 1].year - known[i].year);
    return known[i].seconds + t * (known[i + 1].seconds - known[i].seconds);
}

typedef struct Nutation {
    double longitude, obliquity; /* degrees */
} Nutation;

/* The four largest terms: half a second of arc. */
static Nutation nutation(double t) {
    double node = (125.04452 - 1934.136261 * t) * VTS_RADIANS;
    double sun = (280.4665 + 36000.7698 * t) * VTS_RADIANS, moon = (218.3165 + 481267.8813 * t) * VTS_RADIANS;
    double longitude = -17.20 * sin(node) - 1.32 * sin(2 * sun) - 0.23 * sin(2 * moon) + 0.21 * sin(2 * node);
    double obliquity = 9.20 * cos(node) + 0.57 * cos(2 * sun) + 0.10 * cos(2 * moon) - 0.09 * cos(2 * node);
    return (Nutation){longitude / 3600, obliquity / 3600};
}

/* From the earth's centre to the sun in metres, as the rotating earth has it: x to Greenwich on the equator, z north. */
static Vec3 sun_geocentric(double days) {
    double t = (days + clock_lag(days) / 86400) / CENTURY, millennia = t / 10;
    double earth = SUM(longitude_0, millennia) + millennia * (SUM(longitude_1, millennia) + millennia * SUM(longitude_2, millennia));
    double distance = SUM(distance_0, millennia);
    Nutation n = nutation(t);
    double obliquity = (23.4392911 - 0.0130042 * t - 1.64e-7 * t * t + 5.04e-7 * t * t * t + n.obliquity) * VTS_RADIANS;
    double longitude = earth + VTS_PI + (n.longitude - 20.4898 / 3600 / distance) * VTS_RADIANS;
    double rotation_days = days / CENTURY;
    double sidereal = 280.46061837 + fmod(360.98564736629 * days, 360) + 0.000387933 * rotation_days * rotation_days;
    double turn = (sidereal + n.longitude * cos(obliquity)) * VTS_RADIANS;
    Vec3 p = vec3_scale(vec3(cos(longitude), sin(longitude) * cos(obliquity), sin(longitude) * sin(obliquity)), distance * METRES_OF_AU);
    return vec3(p.x * cos(turn) + p.y * sin(turn), p.y * cos(turn) - p.x * sin(turn), p.z);
}

bool sun_direction(GeoPlace place, double days, Vec3 *out) {
    GeoFrame here;
    if (!(fabs(days) < 3652500) || !geo_frame_init(&here, place, false)) return false;
    *out = vec3_normalize(mat3_apply_transposed(&here.axes, vec3_sub(sun_geocentric(days), here.centre)));
    return true;
}
