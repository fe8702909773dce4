#include "pattern/blocks.h"

/* POV-Ray's: a surface that lies in the border between blocks belongs to the upper one. */
static const double border = 1e-7;

static double spot_along(const Spot *spot, int axis, double *width) {
    *width = spot_width_along(spot, axis);
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

static void checker_shares(const Spot *spot, double shares[BLOCK_KINDS]) {
    /* The mean of a product of signs of x, y, z over a box is the product of their means. */
    double sign = 1;
    for (int k = 0; k < 3; k++) {
        double width, x = spot_along(spot, k, &width) + border;
        sign *= width < 1e-9 ? (fmod(floor(x), 2) == 0 ? 1 : -1) : 2 * pulse_share(x / 2, width / 2, 0.5) - 1;
    }
    shares[0] = (1 + sign) / 2, shares[1] = (1 - sign) / 2;
}

/* ---- brick ---- */

/* The share along an axis that is brick, in rows whose bricks are moved by `shift` of their length. */
static double brick_share(const Pigment *pigment, const Spot *spot, int axis, double shift) {
    double width, x = spot_along(spot, axis, &width), size = vec3_get(pigment->brick_size, axis);
    return pulse_share(x / size + shift, width / size, 1 - pigment->mortar / size);
}

static void brick_shares(const Pigment *pigment, const Spot *spot, double shares[BLOCK_KINDS]) {
    double width, y = spot_along(spot, 1, &width), height = pigment->brick_size.y, rows = 2 * height,
                  duty = (1 - pigment->mortar / height) / 2;
    double even = pulse_share(y / rows, width / rows, duty),
           odd = pulse_share(y / rows + 0.5, width / rows, duty);
    shares[1] = even * brick_share(pigment, spot, 0, 0) * brick_share(pigment, spot, 2, 0.5) +
                odd * brick_share(pigment, spot, 0, 0.5) * brick_share(pigment, spot, 2, 0);
    shares[0] = 1 - shares[1];
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

/* ---- the others ---- */

/* The six pyramids about the half axes x, y, z, -x, -y, -z. */
static int cubic_index(Vec3 p) {
    double x = fabs(p.x), y = fabs(p.y), z = fabs(p.z);
    if (p.x >= 0 && x >= y && x >= z) return 0;
    if (p.y >= 0 && y >= x && y >= z) return 1;
    if (p.z >= 0 && z >= x && z >= y) return 2;
    return x >= y && x >= z ? 3 : y >= x && y >= z ? 4 : 5;
}

static bool is_odd(double whole) { return fmod(whole, 2) != 0; }

/* Counter-clockwise in x and z from the square at the origin. */
static int square_index(Vec3 p) {
    bool x = is_odd(floor(p.x)), z = is_odd(floor(p.z));
    return x ? (z ? 2 : 3) : (z ? 1 : 0);
}

/* Triangles of side 1 in x and z, six about a corner: rows of up and down triangles, each row mirrored in the next. */
static int triangular_index(Vec3 p) {
    double height = sqrt(3) / 2, x = p.x - 3 * floor(p.x / 3),
           z = p.z - 2 * height * floor(p.z / (2 * height));
    int column = (int)double_min(floor(x), 2);
    bool mirrored = z >= height;
    if (mirrored) z = 2 * height - z;
    x -= column;
    bool left = z >= sqrt(3) * x, right = z >= sqrt(3) * (1 - x);
    int kind = x == 0 || left ? 1 : right ? 3 : 0;
    kind = kind % 2 ? (kind + 2 * column) % 6 : (6 + kind - 2 * column) % 6;
    return mirrored ? 5 - kind : kind;
}

static int object_index(const Pigment *pigment, Vec3 p) {
    double in[3] = {p.x, p.y, p.z}, out = 0;
    if (pigment->function) tape_eval_once(pigment->function, in, &out);
    return out > 0.5 ? 1 : 0;
}

int block_index(const Pigment *pigment, Vec3 p) {
    switch (pigment->kind) {
    case PATTERN_UV: return 0;
    case PATTERN_HEXAGON: return hexagon_index(p.x, p.z);
    case PATTERN_CUBIC: return cubic_index(p);
    case PATTERN_SQUARE: return square_index(p);
    case PATTERN_TRIANGULAR: return triangular_index(p);
    case PATTERN_OBJECT: return object_index(pigment, p);
    default: {
        double shares[BLOCK_KINDS];
        Spot spot = spot_make(p, vec3_splat(0), 0);
        block_shares(pigment, &spot, shares);
        return shares[1] > 0;
    }
    }
}

/* How many kinds a footprint far larger than a block shows alike; 0: blocks are not repeated. */
static int repeated_kinds(PatternKind kind) {
    return kind == PATTERN_HEXAGON ? 3 : kind == PATTERN_SQUARE ? 4 : kind == PATTERN_TRIANGULAR ? 6 : 0;
}

/* From 16 places of the footprint. */
static void sampled_shares(const Pigment *pigment, const Spot *spot, double shares[BLOCK_KINDS]) {
    enum { SIDE = 4 };
    int kinds = repeated_kinds(pigment->kind);
    double size = spot_size(spot), all_equal = kinds ? double_clamp((size - 1) / 2, 0, 1) : 0;
    int side = size > 0 ? SIDE : 1;
    for (int k = 0; k < kinds; k++) shares[k] = all_equal / kinds;
    Vec3 u = spot->axes[0], v = spot->axes[1];
    if (spot->blur > 0 || vec3_length_squared(spot->axes[2]) > 0) u = vec3(size, 0, 0), v = vec3(0, 0, size);
    for (int k = 0; k < side * side; k++) {
        double s = (k % side + 0.5) / side - 0.5, t = (k / side + 0.5) / side - 0.5;
        Vec3 p = vec3_madd(vec3_madd(spot->p, u, s), v, t);
        shares[block_index(pigment, p)] += (1 - all_equal) / (side * side);
    }
}

void block_shares(const Pigment *pigment, const Spot *spot, double shares[BLOCK_KINDS]) {
    for (int k = 0; k < BLOCK_KINDS; k++) shares[k] = 0;
    if (pigment->kind == PATTERN_CHECKER)
        checker_shares(spot, shares);
    else if (pigment->kind == PATTERN_BRICK)
        brick_shares(pigment, spot, shares);
    else
        sampled_shares(pigment, spot, shares);
}
