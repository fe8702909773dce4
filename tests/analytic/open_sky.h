/* Closed forms of the share of an even sky that a plane sees beside what stands on it, for whatever gathers light: the picture is eight units wide, from above. */
#ifndef VTS_TESTS_OPEN_SKY_H
#define VTS_TESTS_OPEN_SKY_H

#include <math.h>

/* At (x, z) of the plane, weighed by the cosine; NaN where the picture shows something else or there is no closed form. */
typedef double (*OpenSky)(double x, double z);

/* A wall without end, two high, whose face is at z = -4. */
static inline double open_beside_low_wall(double x, double z) { return (void)x, (1 + (z + 4) / hypot(z + 4, 2)) / 2; }
static inline double open_beside_high_wall(double x, double z) { return (void)x, (void)z, 0.5; }
/* A groove two wide along x, one deep, with the plane for its floor: at a of its width the mean of the sines to both rims. */
static inline double open_in_groove(double x, double z) {
    return (void)x, fabs(z) > 1 ? (double)NAN : ((1 - z) / hypot(1 - z, 1) + (1 + z) / hypot(1 + z, 1)) / 2;
}
static inline double open_under_disc(double x, double z) { return hypot(x, z) > 0.3 ? (double)NAN : 1 - 4.0 / (4 + 1); }
static inline double open_beside_sphere(double x, double z) {
    double r = hypot(x, z);
    return r < 0.5 || r > 3.5 ? (double)NAN : 1 - pow(1 / hypot(r, 1), 3);
}
static inline double open_plain(double x, double z) { return (void)x, (void)z, 1; }

typedef struct SkyCase {
    const char *name, *objects;
    OpenSky truth;
} SkyCase;

/* What stands there, with a texture of its own. */
#define OPEN_SKY_CASES(TEXTURE) \
    {"open", "", open_plain}, \
    {"low wall", "box { <-5000, -1, -5>, <5000, 2, -4> " TEXTURE " no_image }", open_beside_low_wall}, \
    {"high wall", "box { <-3000, -1, -5>, <3000, 3000, -4.1> no_image " TEXTURE " }", open_beside_high_wall}, \
    {"groove", "box { <-5000, -1, 1>, <5000, 1, 5> no_image " TEXTURE " } box { <-5000, -1, -5>, <5000, 1, -1> no_image " TEXTURE " }", open_in_groove}, \
    {"disc", "disc { y, y, 2 no_image " TEXTURE " }", open_under_disc}, \
    {"sphere", "sphere { y, 1 no_image " TEXTURE " }", open_beside_sphere}

#endif
