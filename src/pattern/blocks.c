#include "pattern/blocks.h"

/* POV-Ray's: a surface that lies in the border between blocks belongs to the upper one. */
static const double border = 1e-7;

static double spot_along(const Spot *spot, int axis, double *width) {
    *width = spot_width(spot, vec3(axis == 0, axis == 1, axis == 2));
    return vec3_get(spot->p, axis);
}

/* ∫₀ˣ of the function of period 1 that is 1 below `duty` and 0 above. */
static double pulse_integral(double x, double duty) {
    double whole = floor(x);
    return whole * duty + fmin(x - whole, duty);
}

/* The share of [x - width/2, x + width/2] where that function is 1. */
static double pulse_share(double x, double width, double duty) {
    x -= floor(x);
    if (width < 1e-9) return x <= duty ? 1 : 0;
    return (pulse_integral(x + width / 2, duty) - pulse_integral(x - width / 2, duty)) / width;
}

/* ---- checker ---- */

void checker_shares(const Spot *spot, double shares[BLOCK_KINDS]) {
    /* The mean of a product of signs of x, y, z over a box is the product of their means. */
    double sign = 1;
    for (int k = 0; k < 3; k++) {
        double width, x = spot_along(spot, k, &width) + border;
        sign *= width < 1e-9 ? (fmod(floor(x), 2) == 0 ? 1 : -1) : 2 * pulse_share(x / 2, width / 2, 0.5) - 1;
    }
    shares[0] = (1 + sign) / 2, shares[1] = (1 - sign) / 2, shares[2] = 0;
}

/* ---- brick ---- */

static const double brick_size[3] = {8, 3, 4.5}, mortar = 0.5;

/* The share along an axis that is brick, in rows whose bricks are moved by `shift` of their length. */
static double brick_share(const Spot *spot, int axis, double shift) {
    double width, x = spot_along(spot, axis, &width), size = brick_size[axis];
    return pulse_share(x / size + shift, width / size, 1 - mortar / size);
}

void brick_shares(const Spot *spot, double shares[BLOCK_KINDS]) {
    double width, y = spot_along(spot, 1, &width), rows = 2 * brick_size[1],
                  duty = (1 - mortar / brick_size[1]) / 2;
    double even = pulse_share(y / rows, width / rows, duty),
           odd = pulse_share(y / rows + 0.5, width / rows, duty);
    shares[1] = even * brick_share(spot, 0, 0) * brick_share(spot, 2, 0.5) +
                odd * brick_share(spot, 0, 0.5) * brick_share(spot, 2, 0);
    shares[0] = 1 - shares[1], shares[2] = 0;
}

/* ---- hexagon ---- */

/* Regular hexagons of side 1 in x and z, corners on the x axis, coloured so that neighbours differ. */
static int hexagon_index(double x, double z) {
    double height = sqrt(3) / 2, column = floor(x / 1.5 + 0.5), best = (double)INFINITY;
    int index = 0;
    for (int side = -1; side <= 1; side++) {
        double i = column + side, j = floor((z / height - i) / 2 + 0.5);
        double dx = x - 1.5 * i, dz = z - height * (i + 2 * j), square = dx * dx + dz * dz;
        if (!(square < best)) continue;
        best = square;
        double colour = fmod(2 * i + j, 3);
        index = (int)(colour < 0 ? colour + 3 : colour);
    }
    return index;
}

void hexagon_shares(const Spot *spot, double shares[BLOCK_KINDS]) {
    enum { SIDE = 4 };
    double size = spot_size(spot), all_equal = double_clamp((size - 1) / 2, 0, 1);
    int side = size > 0 ? SIDE : 1;
    shares[0] = shares[1] = shares[2] = all_equal / 3;
    Vec3 u = spot->axes[0], v = spot->axes[1];
    if (spot->blur > 0 || vec3_length_squared(spot->axes[2]) > 0) u = vec3(size, 0, 0), v = vec3(0, 0, size);
    for (int k = 0; k < side * side; k++) {
        double s = (k % side + 0.5) / side - 0.5, t = (k / side + 0.5) / side - 0.5;
        Vec3 p = vec3_madd(vec3_madd(spot->p, u, s), v, t);
        shares[hexagon_index(p.x, p.z)] += (1 - all_equal) / (side * side);
    }
}
