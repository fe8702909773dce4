/* Plane curves: extruded along z or, where the function's parameter says so, swept round the y axis. */
#include "tape/internal.h"

typedef struct Section {
    double x, y, x2, y2;
} Section;

/* sweep[0] > 0: the curve goes round the y axis at the distance sweep[1], turned by sweep[2] degrees. */
static Section section(const double *p, const double *sweep) {
    Section s = {.x = p[0], .y = p[1]};
    if (sweep[0] > 0) {
        double across = sqrt(p[0] * p[0] + p[2] * p[2]) - sweep[1], angle = sweep[2] * VTS_RADIANS;
        s.x = across * cos(angle) - p[1] * sin(angle);
        s.y = across * sin(angle) + p[1] * cos(angle);
    }
    s.x2 = s.x * s.x, s.y2 = s.y * s.y;
    return s;
}

static double scaled(const double *p, double value) { return double_clamp(p[3] * value, -10, 10); }

/* The cylinders' limit is a parameter; a negative one wins over what it should bound, as in POV-Ray. */
static double limited(const double *p, double value) {
    double low = -p[4], product = p[3] * value, high = product > low ? product : low;
    return high < p[4] ? high : p[4];
}

double internal_algbr_cyl1(const double *p) {
    Section s = section(p, p + 5);
    return -limited(p, s.x2 * (1 - fabs(s.x)) - s.y2);
}

double internal_algbr_cyl2(const double *p) {
    Section s = section(p, p + 5);
    return limited(p, 3 * s.x2 * s.y + 2 * s.y2 * s.y - 2 * s.x2 * s.x2 - s.y2 * s.y2 - s.y2);
}

double internal_algbr_cyl3(const double *p) {
    Section s = section(p, p + 5);
    return limited(p, 2 * s.x2 * s.y + s.x * s.y2 - s.x2 * s.x2 - s.x2 * s.y2 - s.y2);
}

double internal_algbr_cyl4(const double *p) {
    Section s = section(p, p + 5);
    double r2 = s.x2 + s.y2;
    return limited(p, s.y2 * s.y - 3 * s.x2 * s.y - r2 * r2);
}

double internal_devils_curve_2d(const double *p) {
    Section s = section(p, p + 6);
    return scaled(p, s.y2 * (s.y2 - p[5] * p[5]) - s.x2 * (s.x2 - p[4] * p[4]));
}

double internal_folium_surface_2d(const double *p) {
    Section s = section(p, p + 6);
    return scaled(p, -s.y2 * (1 + (p[5] - 4 * p[4]) * s.x) - s.x2 * (1 + p[5]));
}

/* The plane curve multiplies its two parameters where the surface squares the first: POV-Ray's. */
double internal_kampyle_of_eudoxus_2d(const double *p) {
    Section s = section(p, p + 6);
    return scaled(p, p[5] * p[5] * s.x2 * (s.x2 - p[4] * p[5]) - s.y2);
}

double internal_lemniscate_of_gerono_2d(const double *p) {
    Section s = section(p, p + 6);
    return scaled(p, p[5] * p[5] * s.x2 * (p[4] * p[4] - s.x2) - s.y2);
}

double internal_piriform_2d(const double *p) {
    Section s = section(p, p + 7);
    return scaled(p, p[6] * p[6] * s.x2 * (p[4] * s.x + p[5] * s.x2) - s.y2);
}

double internal_strophoid_2d(const double *p) {
    Section s = section(p, p + 7);
    return scaled(p, p[6] * p[6] * s.x2 * (p[4] + s.x) - (p[5] - s.x) * s.y2);
}

double internal_witch_of_agnesi_2d(const double *p) {
    Section s = section(p, p + 6);
    return scaled(p, p[5] - s.y * (p[4] * p[4] + s.x2));
}
