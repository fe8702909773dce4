#include "pattern/numbers.h"
#include "pattern/warp.h"

#include "tape/noise.h"

/* Sums that order distances, of the nearest three points first. */
typedef struct Nearest {
    double sums[3];
    Vec3 point; /* the first */
} Nearest;

static double distance_sum(Vec3 d, double metric) {
    if (metric == 2) return vec3_length_squared(d);
    if (metric == 1) return fabs(d.x) + fabs(d.y) + fabs(d.z);
    return pow(fabs(d.x), metric) + pow(fabs(d.y), metric) + pow(fabs(d.z), metric);
}

static double length_of(double sum, double metric) {
    return metric == 2 ? sqrt(sum) : metric == 1 ? sum : pow(sum, 1 / metric);
}

static void insert(Nearest *nearest, double sum, Vec3 point) {
    double *s = nearest->sums;
    if (sum < s[0])
        s[2] = s[1], s[1] = s[0], s[0] = sum, nearest->point = point;
    else if (sum < s[1])
        s[2] = s[1], s[1] = sum;
    else if (sum < s[2])
        s[2] = sum;
}

/* Of the cells around a place those that are two away in one axis at most can hold the nearest points: by how far they are away. */
static const int8_t CELLS[][3] = {
#define ROW(x, y)                                                                                            \
    {x, y, 0}, {x, y, -1}, { x, y, 1 }
    ROW(0, 0),    ROW(-1, 0),  ROW(1, 0),   ROW(0, -1),  ROW(0, 1),
    ROW(-1, -1),  ROW(-1, 1),  ROW(1, -1),  ROW(1, 1),
#undef ROW
#define FACE(a, b)                                                                                           \
    {-2, a, b}, {2, a, b}, {a, -2, b}, {a, 2, b}, {a, b, -2}, { a, b, 2 }
    FACE(0, 0),   FACE(-1, 0), FACE(1, 0),  FACE(0, -1), FACE(0, 1),
    FACE(-1, -1), FACE(-1, 1), FACE(1, -1), FACE(1, 1),
#undef FACE
};

/* From x to the cell `step` cells away, x being in [0, 1). */
static double way_to(double x, int step) {
    return step > 0 ? double_max(step - x, 0) : step < 0 ? double_max(x - step - 1, 0) : 0;
}

/* One point in each cell. Of the nearest points so many are wanted. */
static Nearest find_nearest(Vec3 p, double metric, int wanted) {
    /* POV-Ray takes a place 10⁻⁷ below a cell's border for the next cell. */
    Vec3 corner = vec3(floor(p.x + 1e-7), floor(p.y + 1e-7), floor(p.z + 1e-7)), within = vec3_sub(p, corner);
    Nearest nearest = {.sums = {VTS_INFINITY, VTS_INFINITY, VTS_INFINITY}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(CELLS); i++) {
        const int8_t *cell = CELLS[i];
        Vec3 way = vec3(way_to(within.x, cell[0]), way_to(within.y, cell[1]), way_to(within.z, cell[2]));
        if (metric > 0 && isfinite(nearest.sums[wanted - 1]) &&
            distance_sum(way, metric) > nearest.sums[wanted - 1])
            continue;
        Vec3 point = noise_pov_cell_point(vec3_add(corner, vec3(cell[0], cell[1], cell[2])));
        insert(&nearest, distance_sum(vec3_sub(point, p), metric), point);
    }
    return nearest;
}

double crackle_number(const Pigment *pigment, Vec3 p) {
    const CrackleSettings *c = &pigment->crackle;
    Nearest nearest = find_nearest(p, c->metric,
                                   c->solid || (c->form.y == 0 && c->form.z == 0) ? 1
                                   : c->form.z == 0                               ? 2
                                                                                  : 3);
    if (c->solid) return double_clamp(noise_generated(generator_of(pigment), nearest.point), 0, 1);
    double value = 0, offset = c->offset == 0 ? 0 : distance_sum(vec3(c->offset, 0, 0), c->metric);
    const double form[3] = {c->form.x, c->form.y, c->form.z};
    for (int k = 0; k < 3; k++)
        if (form[k] != 0) value += form[k] * length_of(nearest.sums[k] + offset, c->metric);
    return isnan(value) ? 0 : double_clamp(value, 0, 1); /* with metric 0 all distances are infinite */
}

Vec3 crackle_point(Vec3 p, double metric) { return find_nearest(p, metric, 1).point; }
