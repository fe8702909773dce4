/* Two voxels become one: what is left of their normals, and of what is seen of them. Figures 19 and 20 of Neyret 1998, for both filters.
 * Prints a block of lines for each angle between the two: direction in the plane of their axes (radians); the distribution of normals of
 * each, their mean, and that of the merged voxel by `published` and by `linear`; the same five for the area seen. To standard error: the
 * root mean square error of both over all directions, relative to the mean. `bench/ndf.sh` draws them. */
#include "texel/voxel_cell.h"

#include <math.h>
#include <stdio.h>

static const double PI = 3.14159265358979324;

/* An ellipsoid by its S, scaled so that the mean area seen is 1, and by S⁻¹. */
typedef struct Ellipsoid {
    Mat3 s, inverse;
    double root_determinant;
} Ellipsoid;

typedef struct Curves {
    Ellipsoid one, other, published, linear;
} Curves;

static double quadratic(const Mat3 *m, Vec3 v) { return vec3_dot(v, mat3_apply(m, v)); }

static double area_seen(const Ellipsoid *e, Vec3 w) { return sqrt(quadratic(&e->s, w)); }

/* Heitz et al. 2015, equation 6: N98's f_Q, as the areas of S are those of the ellipsoid's shadow. */
static double normals_at(const Ellipsoid *e, Vec3 n) {
    double q = quadratic(&e->inverse, n);
    return 1 / (PI * e->root_determinant * q * q);
}

/* Direction i of `count` that are spread evenly over the sphere. */
static Vec3 spread(int i, int count) {
    double y = 1 - (2 * i + 1) / (double)count, r = sqrt(1 - y * y), angle = PI * (3 - sqrt(5)) * i;
    return vec3(r * cos(angle), y, r * sin(angle));
}

enum { DIRECTIONS = 20000 };

static Mat3 mat3_scaled(const Mat3 *m, double f) {
    return (Mat3){{vec3_scale(m->c[0], f), vec3_scale(m->c[1], f), vec3_scale(m->c[2], f)}};
}

static Ellipsoid of_matrix(const Mat3 *s) {
    Ellipsoid e = {.s = *s};
    double mean = 0;
    for (int i = 0; i < DIRECTIONS; i++) mean += area_seen(&e, spread(i, DIRECTIONS)) / DIRECTIONS;
    e.s = mat3_scaled(s, 1 / (mean * mean));
    mat3_invert(&e.s, &e.inverse);
    e.root_determinant = sqrt(mat3_determinant(&e.s));
    return e;
}

static Mat3 as_matrix(const Sym3f *m) {
    return (Mat3){{vec3((double)m->xx, (double)m->xy, (double)m->xz),
                   vec3((double)m->xy, (double)m->yy, (double)m->yz),
                   vec3((double)m->xz, (double)m->yz, (double)m->zz)}};
}

/* A voxel as the builder draws it. */
static Ellipsoid of_cell(const VoxelCell *cell) {
    const VoxelSurround nothing = {0};
    const float sides[3] = {1, 1, 1};
    VoxelMatter matter = voxel_cell_matter(cell, &nothing, sides, 1, 1);
    Mat3 root = as_matrix(&matter.root), s = mat3_multiply(&root, &root);
    return of_matrix(&s);
}

/* The ellipsoid of radii 1 × 2 × 2, its short axis turned by `angle` from x in the plane of x and y. */
static VoxelCell turned_cell(double angle) {
    const double q[3] = {1, 0.25, 0.25}, c = cos(angle), s = sin(angle), trace = 1.5;
    VoxelCell cell = {.sheet = 1};
    cell.normals[0] = (float)((q[0] * c * c + q[1] * s * s) / trace);
    cell.normals[1] = (float)((q[0] * s * s + q[1] * c * c) / trace);
    cell.normals[2] = (float)(q[2] / trace);
    cell.normals[3] = (float)((q[0] - q[1]) * c * s / trace);
    return cell;
}

static Ellipsoid merged(const VoxelCell *one, const VoxelCell *other, TexelFiltering filtering) {
    const VoxelMerge step = {
        .level = 1, .share = 0.5f, .filtering = filtering, .halved = {true, false, false}, .rays = {1, 1, 1}};
    VoxelCell parent = {0};
    voxel_cell_merge(&parent, one, &step, (const int[3]){0, 0, 0});
    voxel_cell_merge(&parent, other, &step, (const int[3]){1, 0, 0});
    voxel_cell_close_merged(&parent, filtering);
    return of_cell(&parent);
}

static void print_five(const Curves *c, double (*value)(const Ellipsoid *, Vec3), Vec3 w) {
    double one = value(&c->one, w), other = value(&c->other, w);
    printf(" %.5f %.5f %.5f %.5f %.5f", one, other, (one + other) / 2, value(&c->published, w),
           value(&c->linear, w));
}

static double error_of(const Curves *c, const Ellipsoid *e, double (*value)(const Ellipsoid *, Vec3)) {
    double square = 0, mean = 0;
    for (int i = 0; i < DIRECTIONS; i++) {
        Vec3 w = spread(i, DIRECTIONS);
        double truth = (value(&c->one, w) + value(&c->other, w)) / 2, off = value(e, w) - truth;
        square += off * off / DIRECTIONS;
        mean += truth / DIRECTIONS;
    }
    return sqrt(square) / mean;
}

static void print_angle(double angle) {
    VoxelCell one = turned_cell(-angle / 2), other = turned_cell(angle / 2);
    voxel_cell_close_finest(&one);
    voxel_cell_close_finest(&other);
    const Curves c = {of_cell(&one), of_cell(&other), merged(&one, &other, TEXEL_FILTER_PUBLISHED),
                      merged(&one, &other, TEXEL_FILTER_LINEAR)};
    for (int i = 0; i <= 360; i += 4) {
        double phi = PI * i / 180;
        printf("%.5f", phi);
        print_five(&c, normals_at, vec3(cos(phi), sin(phi), 0));
        print_five(&c, area_seen, vec3(cos(phi), sin(phi), 0));
        printf("\n");
    }
    printf("\n\n");
    fprintf(stderr,
            "%4.0f degrees: normals: published %.3f, linear %.3f; area seen: published %.4f, linear %.4f\n",
            angle * 180 / PI, error_of(&c, &c.published, normals_at), error_of(&c, &c.linear, normals_at),
            error_of(&c, &c.published, area_seen), error_of(&c, &c.linear, area_seen));
}

int main(void) {
    const double angles[] = {PI / 8, 3 * PI / 16, PI / 4, PI / 2};
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) print_angle(angles[i]);
    return 0;
}
