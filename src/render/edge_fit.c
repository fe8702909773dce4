#include "render/edge_fit.h"

/* Directions around the circle. */
enum { TURNS = 48 };
/* Places and weights of Gauss's quadrature of two points, over [0, 1]. */
static const float GAUSS_AT[] = {0.2113249f, 0.7886751f}, GAUSS_WEIGHT = 0.5f;
/* Beyond it lines leave out the pixel. */
static const float FURTHEST = 0.7072f;

static const float DIRECTIONS_X[TURNS] = {
    1,           0.9914449f,  0.9659258f,  0.9238795f,  0.8660254f,  0.7933533f,  0.7071068f,  0.6087614f,  0.5f,        0.3826834f,  0.2588190f,  0.1305262f,
    0,           -0.1305262f, -0.2588190f, -0.3826834f, -0.5f,       -0.6087614f, -0.7071068f, -0.7933533f, -0.8660254f, -0.9238795f, -0.9659258f, -0.9914449f,
    -1,          -0.9914449f, -0.9659258f, -0.9238795f, -0.8660254f, -0.7933533f, -0.7071068f, -0.6087614f, -0.5f,       -0.3826834f, -0.2588190f, -0.1305262f,
    0,           0.1305262f,  0.2588190f,  0.3826834f,  0.5f,        0.6087614f,  0.7071068f,  0.7933533f,  0.8660254f,  0.9238795f,  0.9659258f,  0.9914449f};

static float direction_x(int turn) { return DIRECTIONS_X[turn]; }
static float direction_y(int turn) { return DIRECTIONS_X[(turn + 3 * TURNS / 4) % TURNS]; }

/* The part of the unit square about the origin that lies further along the unit direction than `distance`. */
static float share_beyond(float x, float y, float distance) {
    const float a = fabsf(x), b = fabsf(y), wide = float_max(a, b), narrow = float_min(a, b), d = fabsf(distance), corner = (a + b) / 2;
    float share = 0;
    if (d < (wide - narrow) / 2) share = 0.5f - d / wide;
    else if (d < corner) share = (corner - d) * (corner - d) / (2 * a * b);
    return distance < 0 ? 1 - share : share;
}

/* Between which distances lines of each direction part the points. Loops over arrays, which compilers turn into vectors. */
static void limits_of(const EdgePoints *points, float low[TURNS], float high[TURNS]) {
    float directions_y[TURNS];
    for (int k = 0; k < TURNS; k++) low[k] = -FURTHEST, high[k] = FURTHEST, directions_y[k] = direction_y(k);
    for (int i = 0; i < points->count; i++) {
        const float x = points->x[i], y = points->y[i];
        if (points->beyond[i])
            for (int k = 0; k < TURNS; k++) high[k] = float_min(x * DIRECTIONS_X[k] + y * directions_y[k], high[k]);
        else
            for (int k = 0; k < TURNS; k++) low[k] = float_max(x * DIRECTIONS_X[k] + y * directions_y[k], low[k]);
    }
}

bool edge_fit(const EdgePoints *points, EdgeFit *out) {
    float low[TURNS], high[TURNS], weight = 0, share = 0, square = 0;
    int beyond = 0;
    *out = (EdgeFit){.beyond = 0};
    for (int i = 0; i < points->count; i++) beyond += points->beyond[i];
    if (beyond == 0 || beyond == points->count) return false;
    limits_of(points, low, high);
    for (int turn = 0; turn < TURNS; turn++) {
        const float room = high[turn] - low[turn], x = direction_x(turn), y = direction_y(turn);
        if (!(room > 0)) continue;
        for (int k = 0; k < 2; k++) {
            const float one = share_beyond(x, y, low[turn] + room * GAUSS_AT[k]);
            share += GAUSS_WEIGHT * room * one;
            square += GAUSS_WEIGHT * room * one * one;
        }
        weight += room;
        out->x += room * x, out->y += room * y;
        out->along += room * (low[turn] + high[turn]) / 2;
    }
    if (!(weight > 0)) return false;
    const float length = sqrtf(out->x * out->x + out->y * out->y);
    out->beyond = share / weight;
    out->variance = float_max(square / weight - out->beyond * out->beyond, 0);
    if (length > 0) out->x /= length, out->y /= length;
    out->along /= weight;
    return length > 0;
}

void edge_place(const EdgeFit *fit, int number, float *x, float *y) {
    static const float ASIDE[] = {0, 0.35f, -0.35f, 0.15f};
    const float aside = ASIDE[number % 4];
    *x = float_clamp(fit->x * fit->along - fit->y * aside, -0.5f, 0.5f);
    *y = float_clamp(fit->y * fit->along + fit->x * aside, -0.5f, 0.5f);
}
