#include "pattern/pavement.h"

#include <math.h>
#include <string.h>

#define H     0.86602540378443865 /* height of the triangle of side 1 */
#define ROOT3 (2 * H)

/* ---- which cells hold together ---- */

/* What repeats of a pavement: rows of `width` cells; so many rows further everything comes again `shift` cells to the right. Cell (i, j) lies at
 * i and j times the two vectors of its grid, and its digit tells which of its own sides are walls; the others are its neighbours' own:
 *   squares     1 below (towards −z), 2 left
 *   triangles   two a cell, divided from the left above to the right below: 1 below, 2 left, 4 that between them
 *   hexagons    1 below, 2 left below, 4 left above */
typedef struct Pavement {
    const char *walls;
    int width, shift;
} Pavement;

/* In the order of POV-Ray's numbers: by sides, tiles, pattern. The lattices are those of its pictures. */
static const Pavement pavements[] = {
#include "pattern/pavement_table.inc"
};

static const Pavement *find_pavement(const PavementSettings *s) {
    size_t index = (size_t)s->pattern - 1;
    for (int sides = 3; sides <= s->sides; sides++)
        for (int tiles = 1; tiles <= PAVEMENT_MOST_TILES && (sides < s->sides || tiles < s->tiles); tiles++)
            index += (size_t)pavement_count(sides, tiles);
    return &pavements[index];
}

typedef long long Index;

/* A cell; cell i, j of a pavement. */
typedef struct Cell {
    const Pavement *pavement;
    Index i, j;
} Cell;

static Index floor_div(Index a, Index b) { return a / b - (a % b < 0); }

/* Own walls of the cell that is so many further. */
static unsigned own_walls(const Cell *c, int di, int dj) {
    const Pavement *p = c->pavement;
    Index height = (Index)strlen(p->walls) / p->width, row = floor_div(c->j + dj, height);
    Index i = c->i + di - row * p->shift, j = c->j + dj - row * height;
    i -= floor_div(i, p->width) * p->width;
    return (unsigned)(p->walls[j * p->width + i] - '0');
}

/* ---- squares ---- */

/* The three looks of corners: sharp, bevelled, round. */
static double corner_distance(int look, double p, double q) { return look == 0 ? fmax(p, q) : look == 1 ? p + q : hypot(p, q); }

/* Whether any wall ends at the corner (i + di, j + dj). */
static bool square_corner_touched(const Cell *c, int di, int dj) {
    unsigned here = own_walls(c, di, dj), left = own_walls(c, di - 1, dj), below = own_walls(c, di, dj - 1);
    return here || (left & 1) || (below & 2);
}

/* A square with two walls that meet, and whose other corner juts in, is a bend; its look is `form`, unless that is 3. */
static bool bend_corner(const Cell *c, const bool walls[2][2], int *right, int *above) {
    if (walls[0][0] == walls[0][1] || walls[1][0] == walls[1][1]) return false;
    *right = walls[0][0], *above = walls[1][0];
    return square_corner_touched(c, *right, *above);
}

static double square_number(const PavementSettings *s, const Pavement *pavement, double x, double z) {
    const Cell cell = {pavement, (Index)floor(x), (Index)floor(z)};
    const unsigned own = own_walls(&cell, 0, 0);
    const bool walls[2][2] = {{own & 2, own_walls(&cell, 1, 0) & 2}, {own & 1, own_walls(&cell, 0, 1) & 1}}; /* left, right; below, above */
    int right, above;
    x -= floor(x), z -= floor(z);
    if (s->form < 3 && bend_corner(&cell, walls, &right, &above)) return fabs(1 - corner_distance(s->form, 2 * fabs(right - x), 2 * fabs(above - z)));
    right = x >= 0.5, above = z >= 0.5;
    double p = 2 * fabs(right - x), q = 2 * fabs(above - z); /* from the sides of this quarter */
    if (walls[0][right] && walls[1][above]) return corner_distance(s->exterior, 1 - p, 1 - q);
    if (walls[0][right]) return 1 - p;
    if (walls[1][above]) return 1 - q;
    return square_corner_touched(&cell, right, above) ? 1 - corner_distance(s->interior, p, q) : 0;
}

/* ---- triangles ---- */

/* A triangle: of its sides 0 lies along x, 1 at 60 degrees to it, 2 at 120. `up` stands on its side 0, its counterpart hangs from it. */
typedef struct Triangle {
    Cell cell;
    bool up;
} Triangle;

static bool triangle_wall(const Triangle *t, int side) {
    int away = !t->up;
    return own_walls(&t->cell, side == 1 ? away : 0, side == 0 ? away : 0) >> side & 1;
}

static Triangle triangle_beyond(const Triangle *t, int side) {
    int step = t->up ? -1 : 1;
    Triangle beyond = {t->cell, !t->up};
    if (side == 1) beyond.cell.i += step;
    if (side == 0) beyond.cell.j += step;
    return beyond;
}

/* Whether any wall ends at the corner that faces the side. */
static bool triangle_corner_touched(const Triangle *t, int side) {
    int di = t->up ? side == 1 : side != 1, dj = t->up ? side == 0 : side != 0;
    const Cell *c = &t->cell;
    unsigned here = own_walls(c, di, dj), left = own_walls(c, di - 1, dj), below = own_walls(c, di, dj - 1);
    return (here & 3) || (left & 5) || (below & 6);
}

static double triangle_number(const PavementSettings *s, const Pavement *pavement, double x, double z) {
    double v = z / H, u = x - 0.5 * v;
    Triangle t = {{pavement, (Index)floor(u), (Index)floor(v)}, false};
    u -= floor(u), v -= floor(v);
    t.up = u + v < 1;
    /* From the sides, in radii of the circle within: together 3. */
    const double away[3] = {t.up ? 3 * v : 3 - 3 * v, t.up ? 3 * u : 3 - 3 * u, 3 * fabs(1 - u - v)};
    int corner = away[0] >= away[1] && away[0] >= away[2] ? 0 : away[1] >= away[2] ? 1 : 2;
    int m = (corner + 1) % 3, n = (corner + 2) % 3;
    if (!triangle_wall(&t, m)) m = n, n = (corner + 1) % 3;
    bool wall_m = triangle_wall(&t, m), wall_n = triangle_wall(&t, n);
    double p = away[m], q = away[n], k = away[corner];
    if (wall_m && wall_n) {
        double sharp = 1 - fmin(p, q);
        return s->exterior == 0 ? sharp : s->exterior == 1 ? fmax(sharp, k - 1) : hypot(k - 1, (p - q) / ROOT3);
    }
    if (wall_m) { /* the piece goes on past n: straight on, or bent where the wall turns */
        Triangle beyond = triangle_beyond(&t, n);
        int form = triangle_wall(&beyond, corner) ? s->form % 3 : 0;
        return form == 0 ? 1 - p : form == 1 ? fmax(1 - p, (k - p) * 2 / 3) : hypot(3 - p, (k - q) / ROOT3) - 2;
    }
    if (!triangle_corner_touched(&t, corner)) return 0;
    return s->interior == 0 ? k - 2 : s->interior == 1 ? 1 - fmax(p, q) - fmin(p, q) / 2 : 1 - sqrt(p * p + q * q + p * q);
}

/* ---- hexagons ---- */

/* Directions of the sides, 30 degrees from x and every 60 after, and the cells beyond. */
static const double hexagon_ways[6][2] = {{H, 0.5}, {0, 1}, {-H, 0.5}, {-H, -0.5}, {0, -1}, {H, -0.5}};

static bool hexagon_wall(const Cell *c, int side) {
    switch (side) {
    case 0: return own_walls(c, 1, 0) & 2;
    case 1: return own_walls(c, 0, 1) & 1;
    case 2: return own_walls(c, 0, 0) & 4;
    case 3: return own_walls(c, 0, 0) & 2;
    case 4: return own_walls(c, 0, 0) & 1;
    default: return own_walls(c, 1, -1) & 4;
    }
}

/* The hexagon around a place, which becomes one from its middle: that of three columns and their nearest rows whose middle is nearest. */
static Cell hexagon_around(const Pavement *pavement, double *x, double *z) {
    Cell best = {pavement, 0, 0};
    double column = floor((*x - 1) / 1.5 + 0.5), least = HUGE_VAL, from_x = 0, from_z = 0;
    for (int k = -1; k <= 1; k++) {
        double i = column + k, j = floor((*z - H * i) / (2 * H) + 0.5), dx = *x - 1 - 1.5 * i, dz = *z - H * i - 2 * H * j;
        if (dx * dx + dz * dz >= least) continue;
        least = dx * dx + dz * dz, from_x = dx, from_z = dz;
        best.i = (Index)i, best.j = (Index)j;
    }
    *x = from_x, *z = from_z;
    return best;
}

static double hexagon_number(const PavementSettings *s, const Pavement *pavement, double x, double z) {
    const Cell cell = hexagon_around(pavement, &x, &z);
    double away[6]; /* from the sides, in thirds of the radius of the circle within */
    int m = 0;
    for (int side = 0; side < 6; side++) away[side] = 3 - (x * hexagon_ways[side][0] + z * hexagon_ways[side][1]) * 3 / H;
    for (int side = 1; side < 6; side++)
        if (away[side] + away[(side + 1) % 6] < away[m] + away[(m + 1) % 6]) m = side;
    int n = (m + 1) % 6; /* the nearest corner is that of m and n */
    if (!hexagon_wall(&cell, m)) n = m, m = (m + 1) % 6;
    if (!hexagon_wall(&cell, m)) return 0;
    double p = away[m], q = away[n];
    if (hexagon_wall(&cell, n)) {
        double sharp = 1 - fmin(p, q);
        return s->form % 3 == 0 ? sharp : s->form % 3 == 1 ? fmax(sharp, 2 - (p + q) * 2 / 3) : hypot(x, z) * 3 / H - 2;
    }
    if (s->interior == 0) return 1 - p;
    return fmax(1 - p, s->interior == 1 ? fmin(1 - p + q / 2, 1 - (p + q) / 2) : 1 - sqrt(p * p + q * q - p * q));
}

double pavement_number(const PavementSettings *settings, Vec3 p) {
    if (!(fabs(p.x) <= 1e12 && fabs(p.z) <= 1e12)) return 0.5;
    const Pavement *pavement = find_pavement(settings);
    double number = settings->sides == 4   ? square_number(settings, pavement, p.x, p.z)
                    : settings->sides == 3 ? triangle_number(settings, pavement, p.x, p.z)
                                           : hexagon_number(settings, pavement, p.x, p.z);
    return double_clamp(number, 0, 1);
}
