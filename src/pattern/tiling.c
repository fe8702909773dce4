#include "pattern/tiling.h"

#include "scene/scene.h"

#define H     0.86602540378443865 /* height of the triangle of side 1 */
#define R     0.28867513459481288 /* radius of the circle within it */
#define ROOT3 (2 * H)
#define ROOT2 1.41421356237309505
#define Q     (H + 0.5)

/* A convex tile: its sides look away from the middle in directions of multiples of 15 degrees from x to z; sides of even number
 * are `even` from the middle, others `odd`. */
typedef struct Tile {
    int kind, sides;
    unsigned char ways[12];
    double x, z, even, odd;
    unsigned nearer; /* bits of sides that POV-Ray takes to be nearer, by the factor H */
} Tile;

#define REGULAR(kind, x, z, from_middle, sides, ...)                                                         \
    { kind, sides, {__VA_ARGS__}, x, z, from_middle, from_middle, 0 }
#define TRIANGLE(kind, x, z, first) REGULAR(kind, x, z, R, 3, first, first + 8, first + 16)
#define UP(kind, x, z)              TRIANGLE(kind, x, z, 2)
#define DOWN(kind, x, z)            TRIANGLE(kind, x, z, 6)
#define SQUARE(kind, x, z, first)   REGULAR(kind, x, z, 0.5, 4, first, first + 6, first + 12, first + 18)
#define HEXAGON(kind, x, z)         REGULAR(kind, x, z, H, 6, 2, 6, 10, 14, 18, 22)
#define OCTAGON(kind, x, z)         REGULAR(kind, x, z, (1 + ROOT2) / 2, 8, 0, 3, 6, 9, 12, 15, 18, 21)
#define DODECAGON(kind, x, z, nearer)                                                                        \
    { kind, 12, {0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22}, x, z, 1 + H, 1 + H, nearer }
#define BRICK(kind, x, z, half_x, half_z)                                                                    \
    { kind, 4, {0, 6, 12, 18}, x, z, half_x, half_z, 0 }
#define LOZENGE(kind, x, z, a, b) REGULAR(kind, x, z, H / 2, 4, a, b, (a + 12) % 24, (b + 12) % 24)
#define BEVEL(kind, x, z, way)                                                                               \
    { kind, 4, {way, (way + 9) % 24, (way + 12) % 24, (way + 15) % 24}, x, z, ROOT2 / 4, 0.75, 0 }

static const Tile squares[] = {SQUARE(0, 0.5, 0.5, 0)};
static const Tile hexagons[] = {HEXAGON(0, 0.5, H)};
static const Tile triangles[] = {UP(0, 0.5, R), DOWN(1, 0.5, -R)};
static const Tile lozenges[] = {LOZENGE(0, 0.75, H / 2, 18, 22)};
static const Tile cubes[] = {LOZENGE(0, 2.25, -H / 2, 10, 18), LOZENGE(1, 1.5, 0, 2, 10),
                             LOZENGE(2, 2.25, H / 2, 18, 2)};
static const Tile herringbone[] = {BRICK(0, 1, -0.5, 1, 0.5), BRICK(1, 0.5, 1, 0.5, 1)};
static const Tile octagons[] = {OCTAGON(1, 0, 0), SQUARE(0, (1 + ROOT2) / 2, (1 + ROOT2) / 2, 3)};
static const Tile rows[] = {SQUARE(2, 0.5, 0.5, 0), UP(0, 0.5, 1 + R), DOWN(1, 1, 1 + 2 * R)};
static const Tile trihexagonal[] = {HEXAGON(2, 0.5, H), DOWN(1, 1.5, H + 2 * R), UP(0, 1.5, R)};
/* Bricks about a square, mirrored by the signs. */
#define PINWHEEL(sx, sz)                                                                                     \
    BRICK(2, sx * 0.5, sz * 1.0, 0.5, 1), SQUARE(0, sx * 1.5, sz * 1.5, 0),                                  \
        BRICK(1, sx * 2.0, sz * 0.5, 1, 0.5), BRICK(2, sx * 2.5, sz * 2.0, 0.5, 1),                          \
        BRICK(1, sx * 1.0, sz * 2.5, 1, 0.5)
static const Tile pinwheels[] = {PINWHEEL(1, 1)};
static const Tile mirrored_pinwheels[] = {PINWHEEL(1, 1), PINWHEEL(-1, 1), PINWHEEL(1, -1), PINWHEEL(-1, -1)};
#define FRAME(inner, low, right, high, left)                                                                 \
    {inner, 4, {0, 6, 12, 18}, ROOT2, ROOT2, ROOT2 / 2, ROOT2 / 2, 0}, BEVEL(low, ROOT2, ROOT2 / 4, 18),     \
        BEVEL(right, 1.75 * ROOT2, ROOT2, 0), BEVEL(high, ROOT2, 1.75 * ROOT2, 6),                           \
        BEVEL(left, ROOT2 / 4, ROOT2, 12)
static const Tile frames[] = {FRAME(0, 1, 2, 1, 2)};
static const Tile lit_frames[] = {FRAME(4, 2, 0, 3, 1)};
static const Tile two_squares[] = {BRICK(1, 1, 2, 1, 1), SQUARE(0, 2.5, 1.5, 0)};
#define RHOMBITRIHEXAGONAL(hexagon, a, b, c, right, high)                                                    \
    HEXAGON(hexagon, -1, 0), SQUARE(a, -1 + Q * H, Q / 2, 2), SQUARE(b, -1, Q, 0),                           \
        SQUARE(c, -1 - Q * H, Q / 2, 4), TRIANGLE(right, 2 * R, 0, 0),                                       \
        TRIANGLE(high, -1 + (1 + 2 * R) / 2, (1 + 2 * R) * H, 4)
static const Tile rhombitrihexagonal[] = {RHOMBITRIHEXAGONAL(2, 0, 0, 0, 1, 1)};
static const Tile rhombitrihexagonal_apart[] = {RHOMBITRIHEXAGONAL(5, 1, 0, 2, 4, 3)};
static const Tile basket[] = {BRICK(1, 0.5, 1, 0.5, 1), BRICK(1, 1.5, 1, 0.5, 1), BRICK(0, 3, 0.5, 1, 0.5),
                              BRICK(0, 3, 1.5, 1, 0.5)};
static const Tile snub_hexagons[] = {
    HEXAGON(2, 1, 2 * H), UP(0, -6.5, R - 2 * H),   UP(0, -5.5, R),
    UP(0, -5, R + H),     UP(0, -4.5, R + 2 * H),   DOWN(1, -6.5, 2 * R - 3 * H),
    DOWN(1, -5, 2 * R),   DOWN(1, -4.5, 2 * R + H), DOWN(1, -4, 2 * R + 2 * H)};
static const Tile snub_hexagons_mirrored[] = {
    HEXAGON(2, -1, 4 * H),    UP(0, -9, R - H),           UP(0, -7.5, R + 2 * H),
    UP(0, -7, R + 3 * H),     UP(0, -6.5, R + 4 * H),     DOWN(1, -8.5, 2 * R - H),
    DOWN(1, -7.5, 2 * R + H), DOWN(1, -7, 2 * R + 2 * H), DOWN(1, -6.5, 2 * R + 3 * H)};
static const Tile snub_squares[] = {TRIANGLE(0, R, 0, 4),       TRIANGLE(2, -R, 0, 0),
                                    SQUARE(4, Q / 2, Q / 2, 4), SQUARE(5, -Q / 2, Q / 2, 2),
                                    DOWN(1, 0, 0.5 + 2 * R),    UP(3, 0, Q + R)};
static const Tile truncated_hexagons[] = {DODECAGON(2, 1 + H, 1 + H, 1U << 0 | 1U << 6 | 1U << 9),
                                          DOWN(1, 2 + 2 * H, (1 + H) * (1 + 2 * R)),
                                          UP(0, 2 + 2 * H, (1 + H) * (1 - 2 * R))};
#define GREAT(big, x, z, a, b, c)                                                                            \
    DODECAGON(big, x, z, 0), SQUARE(a, x + 1.5 + H, z, 0),                                                   \
        SQUARE(b, x + (1.5 + H) / 2, z + (1.5 + H) * H, 4),                                                  \
        SQUARE(c, x - (1.5 + H) / 2, z + (1.5 + H) * H, 2), HEXAGON(0, x + (1 + 2 * H) * H, z + (0.5 + H)),  \
        HEXAGON(0, x + (1 + 2 * H) * H, z - (0.5 + H))
static const Tile great[] = {GREAT(2, 1.5 + H, 1 + 2 * H, 1, 1, 1)};
static const Tile great_apart[] = {GREAT(4, 1.5 + H, 1 + 2 * H, 1, 2, 3)};

/* Repeated by both vectors. What is `rim` or further within a tile has its kind's least value. */
static const struct Tiling {
    const Tile *tiles;
    size_t count;
    int kinds;
    double rim, ax, az, bx, bz;
} tilings[] = {
#define TILING(tiles, kinds, rim, ax, az, bx, bz)                                                            \
    { tiles, VTS_ARRAY_COUNT(tiles), kinds, rim, ax, az, bx, bz }
    TILING(squares, 1, 0.5, 1, 0, 0, 1),
    TILING(hexagons, 1, H, 1.5, H, 1.5, -H),
    TILING(triangles, 2, R, 1, 0, 0.5, H),
    TILING(lozenges, 1, H / 2, 1, 0, 0.5, H),
    TILING(cubes, 3, H / 2, 1.5, H, 1.5, -H),
    TILING(herringbone, 2, 0.5, 1, 1, 4, 0),
    TILING(octagons, 2, 0.5, 1 + ROOT2, 0, 0, 1 + ROOT2),
    TILING(rows, 3, R, 1, 0, 0.5, 1 + H),
    TILING(trihexagonal, 3, R, 2, 0, 1, ROOT3),
    TILING(squares, 1, 0.5, 1, 0, 0.5, 1),
    TILING(pinwheels, 3, 0.5, 3, 0, 0, 3),
    TILING(mirrored_pinwheels, 3, 0.5, 6, 0, 0, 6),
    TILING(frames, 3, ROOT2 / 4, 2 * ROOT2, 0, 0, 2 * ROOT2),
    TILING(lit_frames, 5, ROOT2 / 4, 2 * ROOT2, 0, 0, 2 * ROOT2),
    TILING(two_squares, 2, 0.5, 2, 1, -1, 2),
    TILING(rhombitrihexagonal, 3, R, 0, 2 * Q, 2 * Q * H, Q),
    TILING(rhombitrihexagonal_apart, 6, R, 0, 2 * Q, 2 * Q * H, Q),
    TILING(basket, 2, 0.5, 2, 2, 4, 0),
    TILING(snub_hexagons, 3, R, 2, ROOT3, -0.5, 1.5 * ROOT3),
    TILING(snub_hexagons_mirrored, 3, R, -2, ROOT3, 0.5, 1.5 * ROOT3),
    TILING(snub_squares, 6, R, 2 * Q, 0, Q, Q),
    TILING(truncated_hexagons, 3, R, 2 + ROOT3, 0, 1 + H, (2 + ROOT3) * H),
    TILING(great, 3, 0.5, 3 + ROOT3, 0, 1.5 + H, (3 + ROOT3) * H),
    TILING(great_apart, 5, 0.5, 3 + ROOT3, 0, 1.5 + H, (3 + ROOT3) * H),
};
_Static_assert(VTS_ARRAY_COUNT(tilings) == TILING_MOST, "as many as the scene promises");

/* Unit vectors at multiples of 15 degrees. */
#define S15 0.25881904510252076
#define C15 0.96592582628906829
static const double directions[24][2] = {
    {1, 0},  {C15, S15},   {H, 0.5},   {ROOT2 / 2, ROOT2 / 2},   {0.5, H},   {S15, C15},
    {0, 1},  {-S15, C15},  {-0.5, H},  {-ROOT2 / 2, ROOT2 / 2},  {-H, 0.5},  {-C15, S15},
    {-1, 0}, {-C15, -S15}, {-H, -0.5}, {-ROOT2 / 2, -ROOT2 / 2}, {-0.5, -H}, {-S15, -C15},
    {0, -1}, {S15, -C15},  {0.5, -H},  {ROOT2 / 2, -ROOT2 / 2},  {H, -0.5},  {C15, -S15}};

/* How far within the tile the place is that lies at (x, z) from its middle; negative outside of it. */
static double depth_in(const Tile *tile, double x, double z) {
    double least = HUGE_VAL;
    for (int i = 0; i < tile->sides; i++) {
        const double *way = directions[tile->ways[i]];
        double depth = (i & 1 ? tile->odd : tile->even) - (x * way[0] + z * way[1]);
        if (tile->nearer >> i & 1) depth *= H;
        least = fmin(least, depth);
    }
    return least;
}

/* The tile's copies are one lattice apart, and none reaches further than that from its middle: of a place, at most four count. */
static double depth_in_copies(const struct Tiling *t, const Tile *tile, double x, double z) {
    double across = t->ax * t->bz - t->az * t->bx;
    x -= tile->x, z -= tile->z;
    double u = floor((x * t->bz - z * t->bx) / across), v = floor((t->ax * z - t->az * x) / across),
           most = -HUGE_VAL;
    for (int copy = 0; copy < 4; copy++) {
        double i = u + (copy & 1), j = v + (copy >> 1);
        most = fmax(most, depth_in(tile, x - i * t->ax - j * t->bx, z - i * t->az - j * t->bz));
    }
    return most;
}

double tiling_number(int tiling, Vec3 p) {
    if (tiling < 1 || tiling > TILING_MOST) return 0.5;
    const struct Tiling *t = &tilings[tiling - 1];
    double most = -HUGE_VAL;
    int kind = 0;
    for (size_t i = 0; i < t->count; i++) {
        double depth = depth_in_copies(t, &t->tiles[i], p.x, p.z);
        if (depth > most) most = depth, kind = t->tiles[i].kind;
    }
    double value = (kind + 1 - double_clamp(most / t->rim, 0, 1)) / t->kinds;
    return value >= 0 && value <= 1 ? value : 0.5; /* of what is no number */
}
