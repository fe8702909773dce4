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

/* ---- moments ---- */

/* Means of mu, mu² and mu³. */
static void schlick_means(double k, double out[3]) {
    if (fabs(k) < 0.02) {
        out[0] = 2 * k / 3 + 2 * k * k * k / 15;
        out[1] = 1.0 / 3 + 4 * k * k / 15;
        out[2] = 2 * k / 5 + 6 * k * k * k / 35;
        return;
    }
    double log_ratio = log((1 + k) / (1 - k)), rest = 1 - k * k;
    out[0] = 1 / k - rest / (2 * k * k) * log_ratio;
    out[1] = rest / (k * k * k) * (k / rest + k - log_ratio);
    out[2] = rest / (2 * k * k * k * k) * (2 * k / rest - 3 * log_ratio + 4 * k);
}

static void lobe_moments(const PhaseLobe *lobe, double out[PHASE_MOMENTS]) {
    double k = lobe->k, means[3];
    out[0] = 1, out[1] = out[2] = out[3] = 0;
    switch (lobe->kind) {
    case PHASE_ISOTROPIC: break;
    case PHASE_RAYLEIGH: out[2] = 0.1; break;
    case PHASE_POWER:
        for (int l = 1; l < PHASE_MOMENTS; l++) out[l] = out[l - 1] * (k + 1 - l) / (k + 1 + l);
        break;
    case PHASE_HENYEY_GREENSTEIN: out[1] = k, out[2] = k * k, out[3] = k * k * k; break;
    case PHASE_SCHLICK:
        schlick_means(k, means);
        out[1] = means[0], out[2] = 1.5 * means[1] - 0.5, out[3] = 2.5 * means[2] - 1.5 * means[0];
        break;
    }
}

void phase_moments(const Phase *phase, double out[PHASE_MOMENTS]) {
    for (int l = 0; l < PHASE_MOMENTS; l++) out[l] = l == 0;
    for (int i = 0; i < phase->count; i++) {
        double lobe[PHASE_MOMENTS];
        lobe_moments(&phase->lobes[i], lobe);
        for (int l = 1; l < PHASE_MOMENTS; l++) out[l] += phase->lobes[i].weight * lobe[l];
    }
}

/* ---- without its peak ---- */

static const double LEAST_PEAK = 0.01, MOST_PEAK = 0.999999;

/* Two lobes of the same mean cosine whose second moments lie on either side of the wanted one; or, where light goes backwards too, one forwards and one backwards. */
static Phase phase_of_moments(double first, double second) {
    if (second >= first * first) {
        double k = double_min(sqrt(second), 0.999), forwards = k > 1e-6 ? double_clamp(0.5 + first / (2 * k), 0, 1) : 1;
        return (Phase){.lobes = {{PHASE_HENYEY_GREENSTEIN, k, forwards}, {PHASE_HENYEY_GREENSTEIN, -k, 1 - forwards}}, .count = 2};
    }
    double n = 2 * first / (1 - first), least = first * (n - 1) / (n + 3), share = double_clamp((first * first - second) / (first * first - least), 0, 1);
    return (Phase){.lobes = {{PHASE_POWER, n, share}, {PHASE_HENYEY_GREENSTEIN, first, 1 - share}}, .count = 2};
}

double phase_without_peak(const Phase *phase, Phase *rest) {
    double moments[PHASE_MOMENTS];
    phase_moments(phase, moments);
    double peak = double_min(moments[3], MOST_PEAK);
    *rest = *phase;
    if (!(peak > LEAST_PEAK) || !(moments[1] > peak)) return 0;
    *rest = phase_of_moments((moments[1] - peak) / (1 - peak), (moments[2] - peak) / (1 - peak));
    return peak;
}

Vec3 phase_turn(Vec3 direction, double mu, double turn) {
    Vec3 s, t;
    double r = sqrt(double_max(0, 1 - mu * mu)), angle = 2 * VTS_PI * turn;
    vec3_frame(direction, &s, &t);
    Vec3 out = vec3_madd(vec3_madd(vec3_scale(direction, mu), s, r * cos(angle)), t, r * sin(angle));
    return vec3_normalize(out);
}
