#include "volume/phase.h"

/* ---- values: each times 4 pi has the mean 1 ---- */

/* Backwards as forwards, so that nothing cancels. */
static double henyey_greenstein(double g, double mu) {
    if (g < 0) return henyey_greenstein(-g, -mu);
    double a = (1 - g) * (1 - g) + 2 * g * (1 - mu);
    return (1 - g * g) / (a * sqrt(a));
}

static double lobe_value(const PhaseLobe *lobe, double mu) {
    double k = lobe->k, a;
    switch (lobe->kind) {
    case PHASE_ISOTROPIC: return 1;
    case PHASE_RAYLEIGH: return 0.75 * (1 + mu * mu);
    case PHASE_POWER: return (k + 1) * pow(double_clamp((1 + mu) / 2, 0, 1), k);
    case PHASE_HENYEY_GREENSTEIN: return henyey_greenstein(k, mu);
    case PHASE_SCHLICK: a = 1 - k * mu; return (1 - k * k) / (a * a);
    }
    return 1;
}

double phase_value(const Phase *phase, double mu) {
    double sum = 0;
    for (int i = 0; i < phase->count; i++) sum += phase->lobes[i].weight * lobe_value(&phase->lobes[i], mu);
    return sum / (4 * VTS_PI);
}

/* ---- drawing: each by the inverse of its distribution ---- */

/* The real root of mu³ + 3 mu = 8 u - 4. */
static double rayleigh_draw(double u) {
    double half = 4 * u - 2, root = sqrt(half * half + 1);
    return cbrt(half + root) + cbrt(half - root);
}

static double henyey_greenstein_draw(double g, double u) {
    if (g < 0) return -henyey_greenstein_draw(-g, 1 - u);
    if (fabs(g) < 1e-4) return 2 * u - 1 + 1.5 * g * (1 - (2 * u - 1) * (2 * u - 1));
    double a = (1 - g * g) / (1 - g + 2 * g * u);
    return (1 + g * g - a * a) / (2 * g);
}

static double lobe_draw(const PhaseLobe *lobe, double u) {
    double k = lobe->k;
    switch (lobe->kind) {
    case PHASE_ISOTROPIC: break;
    case PHASE_RAYLEIGH: return rayleigh_draw(u);
    case PHASE_POWER: return 2 * pow(u, 1 / (k + 1)) - 1;
    case PHASE_HENYEY_GREENSTEIN: return henyey_greenstein_draw(k, u);
    case PHASE_SCHLICK: return (2 * u + k - 1) / (2 * k * u - k + 1); /* Blasi, Le Saec & Schlick 1993 eq. 23, k forwards */
    }
    return 2 * u - 1;
}

double phase_draw(const Phase *phase, double which, double u) {
    int i = 0;
    for (; i + 1 < phase->count && which >= phase->lobes[i].weight; i++) which -= phase->lobes[i].weight;
    return double_clamp(lobe_draw(&phase->lobes[i], u), -1, 1);
}

/* ---- means ---- */

/* Of mu and mu². */
static void schlick_means(double k, double *first, double *second) {
    if (fabs(k) < 0.02) {
        *first = 2 * k / 3 + 2 * k * k * k / 15;
        *second = 1.0 / 3 + 4 * k * k / 15;
        return;
    }
    double log_ratio = log((1 + k) / (1 - k)), rest = 1 - k * k;
    *first = 1 / k - rest / (2 * k * k) * log_ratio;
    *second = rest / (k * k * k) * (k / rest + k - log_ratio);
}

static void lobe_means(const PhaseLobe *lobe, double *first, double *second) {
    double k = lobe->k;
    *first = 0, *second = 1.0 / 3;
    switch (lobe->kind) {
    case PHASE_ISOTROPIC: break;
    case PHASE_RAYLEIGH: *second = 0.4; break;
    case PHASE_POWER:
        *first = k / (k + 2);
        *second = 4 * (k + 1) / (k + 3) - 4 * (k + 1) / (k + 2) + 1;
        break;
    case PHASE_HENYEY_GREENSTEIN: *first = k, *second = (1 + 2 * k * k) / 3; break;
    case PHASE_SCHLICK: schlick_means(k, first, second); break;
    }
}

void phase_moments(const Phase *phase, double out[PHASE_MOMENTS]) {
    out[0] = 1, out[1] = out[2] = 0;
    for (int i = 0; i < phase->count; i++) {
        double first, second;
        lobe_means(&phase->lobes[i], &first, &second);
        out[1] += phase->lobes[i].weight * first;
        out[2] += phase->lobes[i].weight * (1.5 * second - 0.5);
    }
}

Vec3 phase_turn(Vec3 direction, double mu, double turn) {
    Vec3 s, t;
    double r = sqrt(double_max(0, 1 - mu * mu)), angle = 2 * VTS_PI * turn;
    vec3_frame(direction, &s, &t);
    Vec3 out = vec3_madd(vec3_madd(vec3_scale(direction, mu), s, r * cos(angle)), t, r * sin(angle));
    return vec3_normalize(out);
}
