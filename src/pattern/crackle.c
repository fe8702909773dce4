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

/* One point in each cell: of the cells around, those that are two away in one axis at most can hold the nearest. */
static Nearest find_nearest(Vec3 p, double metric) {
    /* POV-Ray takes a place 10⁻⁷ below a cell's border for the next cell. */
    Vec3 corner = vec3(floor(p.x + 1e-7), floor(p.y + 1e-7), floor(p.z + 1e-7));
    Nearest nearest = {.sums = {VTS_INFINITY, VTS_INFINITY, VTS_INFINITY}};
    for (int cell = 0; cell < 125; cell++) {
        int x = cell / 25 - 2, y = cell / 5 % 5 - 2, z = cell % 5 - 2;
        if ((x * x == 4) + (y * y == 4) + (z * z == 4) > 1) continue;
        Vec3 point = noise_pov_cell_point(vec3_add(corner, vec3(x, y, z)));
        insert(&nearest, distance_sum(vec3_sub(point, p), metric), point);
    }
    return nearest;
}

double crackle_number(const Pigment *pigment, Vec3 p) {
    const CrackleSettings *c = &pigment->crackle;
    Nearest nearest = find_nearest(p, c->metric);
    if (c->solid) return double_clamp(noise_generated(generator_of(pigment), nearest.point), 0, 1);
    double value = 0, offset = c->offset == 0 ? 0 : distance_sum(vec3(c->offset, 0, 0), c->metric);
    const double form[3] = {c->form.x, c->form.y, c->form.z};
    for (int k = 0; k < 3; k++)
        if (form[k] != 0) value += form[k] * length_of(nearest.sums[k] + offset, c->metric);
    return isnan(value) ? 0 : double_clamp(value, 0, 1); /* with metric 0 all distances are infinite */
}

Vec3 crackle_point(Vec3 p, double metric) { return find_nearest(p, metric).point; }
