#include "texel/voxel_cell.h"

#include "texel/opacity.h"
#include "texel/voxel_layer.h"

#include <math.h>

/* One of each two columns, by a pattern of one bit per pair; the result is the low nibble of each row. */
static uint64_t keep_columns(uint64_t rays, uint64_t pick) {
    rays &= pick;
    rays = (rays | rays >> 1) & 0x5555555555555555u;
    rays = (rays | rays >> 1) & 0x3333333333333333u;
    return (rays | rays >> 2) & 0x0f0f0f0f0f0f0f0fu;
}

/* One of each two rows, by a pattern of one byte per pair; the result is the four lowest rows. */
static uint64_t keep_rows(uint64_t rays, uint64_t pick) {
    rays &= pick;
    rays = (rays | rays >> 8) & 0x00ff00ff00ff00ffu;
    rays = (rays | rays >> 8) & 0x0000ffff0000ffffu;
    return (rays | rays >> 16) & 0x00000000ffffffffu;
}

static uint64_t place_rays(uint64_t rays, bool halve_columns, bool halve_rows, int column, int row,
                           int level) {
    static const uint64_t columns[4] = {0x9a65a95a6a9556a9u, 0x59a6956a96a9a655u, 0xa6596a9559966a9au,
                                        0x65a9569a5a6699a5u};
    static const uint64_t rows[4] = {0xff0000ff00ffff00u, 0x00ff00ffff00ff00u, 0x00ffff0000ff00ffu,
                                     0xff00ff00ff0000ffu};
    if (halve_columns) rays = keep_columns(rays, columns[level & 3]) << (4 * column);
    if (halve_rows) rays = keep_rows(rays, rows[level >> 1 & 3]) << (32 * row);
    return rays;
}

static void merge_rays(VoxelCell *parent, const VoxelCell *child, const VoxelMerge *step, const int corner[3],
                       int axis) {
    int u = voxel_ray_columns(axis), v = voxel_ray_rows(axis);
    bool hu = step->halved[u], hv = step->halved[v];
    uint64_t cover = place_rays(child->cover[axis], hu, hv, corner[u], corner[v], step->level);
    uint64_t inside = place_rays(child->inside[axis], hu, hv, corner[u], corner[v], step->level);
    parent->odd += (float)count_bits(inside) * step->rays[axis];
    parent->joined += 2 * (float)count_bits(parent->inside[axis] & inside) * step->rays[axis];
    parent->met[axis] += child->met[axis] * (hu ? 0.5f : 1) * (hv ? 0.5f : 1);
    parent->cover[axis] |= cover;
    parent->inside[axis] ^= inside;
}

/* Eigenvalues of a symmetric matrix by the trigonometric solution of the cubic. */
static void eigenvalues(const double m[6], double out[3]) {
    double q = (m[0] + m[1] + m[2]) / 3;
    double a = m[0] - q, b = m[1] - q, c = m[2] - q;
    double p2 = (a * a + b * b + c * c + 2 * (m[3] * m[3] + m[4] * m[4] + m[5] * m[5])) / 6, p = sqrt(p2);
    double det =
        a * (b * c - m[5] * m[5]) - m[3] * (m[3] * c - m[5] * m[4]) + m[4] * (m[3] * m[5] - b * m[4]);
    double r = p > 0 ? double_clamp(det / (2 * p2 * p), -1, 1) : 1;
    double phi = acos(r) / 3;
    /* cos(φ + 2π/3) of an angle whose sine is not negative */
    double cosine = cos(phi), sine = sqrt(double_max(0, 1 - cosine * cosine));
    out[0] = q + 2 * p * cosine;
    out[2] = q - p * (cosine + sqrt(3.0) * sine);
    out[1] = 3 * q - out[0] - out[2];
}

/* S of a closed cell up to scale, floored so that it can be inverted, and the roots of its eigenvalues, largest first. */
static void normal_matrix(const VoxelCell *cell, double m[6], double s[3]) {
    double trace = (double)cell->normals[0] + (double)cell->normals[1] + (double)cell->normals[2];
    for (int i = 0; i < 6; i++) m[i] = (double)cell->normals[i] / trace;
    eigenvalues(m, s);
    double floor = (double)(VOXEL_ROUGHNESS * VOXEL_ROUGHNESS) * s[0];
    for (int i = 0; i < 3; i++) {
        m[i] += floor;
        s[i] = sqrt(double_max(s[i], 0) + floor);
    }
}

/* ---- Neyret's filter ---- */

/* The adjoint: det · m⁻¹. */
static void adjoint(const double m[6], double out[6]) {
    double xx = m[0], yy = m[1], zz = m[2], xy = m[3], xz = m[4], yz = m[5];
    out[0] = yy * zz - yz * yz, out[1] = xx * zz - xz * xz, out[2] = xx * yy - xy * xy;
    out[3] = xz * yz - xy * zz, out[4] = xy * yz - xz * yy, out[5] = xy * xz - xx * yz;
}

/* Q is proportional to S; its ellipsoid has unit size, that is, longest radius 1. */
static void add_inverse(VoxelCell *parent, const VoxelCell *child) {
    double m[6], s[3], inverse[6], area = (double)(child->sheet + child->solid);
    if (!(area > 0)) return; /* the inside of a solid */
    normal_matrix(child, m, s);
    adjoint(m, inverse);
    double longest = s[0] * s[1]; /* root of the largest eigenvalue of the adjoint */
    for (int i = 0; i < 6; i++) parent->normals[i] += (float)(area * inverse[i] / (longest * longest));
}

/* From the sum of Q⁻¹ to a matrix like the sum of area · n nᵗ, whose trace is the area. */
static void close_published(VoxelCell *cell) {
    double sum[6], q[6];
    for (int i = 0; i < 6; i++) sum[i] = (double)cell->normals[i];
    adjoint(sum, q);
    double trace = q[0] + q[1] + q[2], area = (double)(cell->sheet + cell->solid);
    for (int i = 0; i < 6; i++) cell->normals[i] = i < 3 ? (float)(area / 3) : 0; /* where so little is there that it is lost */
    if (!(trace > 0 && isfinite(trace))) return;
    for (int i = 0; i < 6; i++) cell->normals[i] = (float)(area * q[i] / trace);
}

static void add_normals(VoxelCell *parent, const VoxelCell *child, TexelFiltering filtering) {
    if (filtering == TEXEL_FILTER_PUBLISHED) add_inverse(parent, child);
    else
        for (int i = 0; i < 6; i++) parent->normals[i] += child->normals[i];
}

void voxel_cell_merge(VoxelCell *parent, const VoxelCell *child, const VoxelMerge *step,
                      const int corner[3]) {
    parent->fill += child->fill * step->share;
    parent->sheet += child->sheet;
    parent->solid += child->solid;
    add_normals(parent, child, step->filtering);
    parent->walls += child->walls;
    parent->apart += child->single;
    for (int axis = 0; axis < 3; axis++) merge_rays(parent, child, step, corner, axis);
}

/* How many times the same sheet lies in the cell: 1 unless its matter is flat, and each ray that meets any meets as many, all of which
 * face one way if they are walls. What repeats itself, or is modelled twice, may lie upon itself; nobody can see more than one. */
static float count_coincident(const VoxelCell *cell) {
    static const double FLAT = 0.05;
    static const float WHOLE = 0.02f;
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (cell->met[k] > cell->met[axis]) axis = k;
    float rays = (float)count_bits(cell->cover[axis]), met = cell->met[axis], times = rays > 0 ? rintf(met / rays) : 1;
    if (times < 2 || fabsf(met - times * rays) > WHOLE * met) return 1;
    if (cell->solid > 0 && (cell->sheet > 0 || fabsf(cell->net[axis]) < (1 - WHOLE) * met)) return 1;
    double m[6], s[3];
    normal_matrix(cell, m, s);
    return s[1] < FLAT * s[0] ? times : 1;
}

static void take_once(VoxelCell *cell, float times) {
    cell->sheet /= times;
    cell->solid /= times;
    cell->walls /= times;
    for (int i = 0; i < 6; i++) cell->normals[i] /= times;
    for (int axis = 0; axis < 3; axis++) {
        cell->met[axis] /= times;
        if (cell->solid > 0) cell->inside[axis] = cell->cover[axis];
    }
}

void voxel_cell_close_finest(VoxelCell *cell) {
    float times = count_coincident(cell);
    if (times > 1) take_once(cell, times);
    for (int axis = 0; axis < 3; axis++) cell->met[axis] /= 64;
    for (int axis = 0; axis < 3; axis++) cell->single += (float)count_bits(cell->inside[axis]);
    cell->apart = cell->walls;
}

void voxel_cell_close_merged(VoxelCell *cell, TexelFiltering filtering) {
    if (filtering == TEXEL_FILTER_PUBLISHED) close_published(cell);
    /* The share of rays that met their pair is applied to the exact count: few rays are kept at coarse levels. If none of
     * them is left inside a solid, the walls here are slivers or very thin solids. */
    cell->single = cell->odd > 0 ? cell->apart * (1 - cell->joined / cell->odd) : 0;
}

float voxel_cell_thinness(const VoxelCell *parent, bool fine) {
    /* What is thin is at most all; but that the noise of many rays may average out, estimates may be beyond that, by the more the thicker
     * it is. Of few rays the noise is worse than what cutting it off is wrong by. */
    static const float BEYOND = 0.22f, LEAST_PAIRED = 0.25f;
    if (!(parent->walls > 0)) return 1; /* met by no ray: very thin */
    /* A pair at distance c is in the same cell of side h with probability 1 − c/h, in the same one of side 2h with
     * 1 − c/2h: extrapolating gives 1 for all c < h. */
    float small = 1 - parent->apart / parent->walls, large = 1 - parent->single / parent->walls;
    float beyond = fine && small > LEAST_PAIRED ? BEYOND * (1 - small) : 0;
    return float_clamp(2 * large - small, 0, 1 + beyond);
}

/* Mean over directions of sqrt(dᵗ S d), from the axis projections, largest first: Thomsen's formula (erratum E15 of Neyret
 * 1998 sec. IV-B), whose exponent 1.6075 we let go from ln 3 / ln 2, exact for discs, to ln 1.5 / ln(4/π), exact for
 * needles: at most 0.54 % wrong instead of 1.06 %. */
static double mean_projection(const double s[3]) {
    double middle = s[1] / s[0];
    float p = (float)(1.58496 + 0.0935 * middle * middle),
          sum = 1 + powf((float)middle, p) + powf((float)(s[2] / s[0]), p);
    return s[0] * (double)powf(sum / 3, 1 / p);
}

/* The square root of m, whose eigenvalues' roots are s: by Cayley and Hamilton, (I₁I₂ − I₃)·√m = I₁I₃·1 + (I₁² − I₂)·m − m². */
static Sym3f square_root(const double m[6], const double s[3], double scale) {
    double i1 = s[0] + s[1] + s[2], i2 = s[0] * s[1] + s[1] * s[2] + s[2] * s[0], i3 = s[0] * s[1] * s[2];
    double k = scale / (i1 * i2 - i3), a = k * i1 * i3, b = k * (i1 * i1 - i2);
    double xx = m[0], yy = m[1], zz = m[2], xy = m[3], xz = m[4], yz = m[5];
    return (Sym3f){
        .xx = (float)(a + b * xx - k * (xx * xx + xy * xy + xz * xz)),
        .yy = (float)(a + b * yy - k * (xy * xy + yy * yy + yz * yz)),
        .zz = (float)(a + b * zz - k * (xz * xz + yz * yz + zz * zz)),
        .xy = (float)(b * xy - k * (xx * xy + xy * yy + xz * yz)),
        .xz = (float)(b * xz - k * (xx * xz + xy * yz + xz * zz)),
        .yz = (float)(b * yz - k * (xy * xz + yy * yz + yz * zz)),
    };
}

static Sym3f unit_root(const VoxelCell *cell) {
    double m[6], s[3];
    normal_matrix(cell, m, s);
    return square_root(m, s, 1 / mean_projection(s));
}

/* A sheet goes on in the next voxel if the two hide more than this, and surely if they hide all. */
static const float MOST_CONTINUATION = 2, LEAST_INTACT = 0.7f;

static const float ROUNDING = 0.02f;

Sym3f voxel_cell_root_inside(const VoxelCell *parent) {
    VoxelCell walls = {.normals = {1, 1, 1}};
    float trace = parent->normals[0] + parent->normals[1] + parent->normals[2];
    for (int i = 0; i < 6 && trace > 0; i++)
        walls.normals[i] = parent->normals[i] / trace + (i < 3 ? ROUNDING : 0);
    return unit_root(&walls);
}

/* Per axis: τ of a crossing of length `side`, and what the rays say is let through over such a length. */
typedef struct AxisLight {
    float tau[3], through[3];
} AxisLight;

static AxisLight axis_light(const VoxelCell *cell, const Sym3f *root, float density, const float sides[3],
                            float side) {
    AxisLight light = {
        .tau = {density * sqrtf(root->xx * root->xx + root->xy * root->xy + root->xz * root->xz),
                density * sqrtf(root->xy * root->xy + root->yy * root->yy + root->yz * root->yz),
                density * sqrtf(root->xz * root->xz + root->yz * root->yz + root->zz * root->zz)},
    };
    for (int axis = 0; axis < 3; axis++) {
        float through = 1 - (float)count_bits(cell->cover[axis]) / 64;
        light.through[axis] = sides[axis] == side ? through : powf(through, side / sides[axis]);
    }
    return light;
}

/* A sheet goes over from one layer of voxels to the next, and is whole with those before and behind: by how much more of the rays they
 * hide together. Each axis counts as it meets the matter. */
static float fit_continuation(const VoxelCell *cell, const VoxelSurround *around) {
    float alone = 0, together = 0;
    for (int axis = 0; axis < 3; axis++) {
        uint64_t cover = cell->cover[axis];
        float w = cell->met[axis], all = cell->met[axis];
        for (int i = 0; i < 2; i++) {
            const VoxelCell *near = around->near[axis][i];
            if (near) cover |= near->cover[axis], all += near->met[axis];
        }
        /* More than one sheet is none that goes on. */
        float whole = (float)count_bits(cover), own = (float)count_bits(cell->cover[axis]),
              one = float_clamp(2 - all, 0, 1) *
                    float_clamp((whole / 64 - LEAST_INTACT) / (1 - LEAST_INTACT), 0, 1);
        alone += w * own;
        together += w * (own + one * (whole - own));
    }
    return alone > 0 ? float_min(together / alone, MOST_CONTINUATION) : 1;
}

/* How much of the matter is one sheet: least squares of T = gamma·max(0, 1 − τ) + (1 − gamma)·exp(−τ) along the axes. */
static float fit_sheet(const AxisLight *light) {
    float above = 0, below = 1e-9f;
    for (int axis = 0; axis < 3; axis++) {
        float random = 1 - expf(-light->tau[axis]), sheet = float_min(1, light->tau[axis]);
        above += (1 - light->through[axis] - random) * (sheet - random);
        below += (sheet - random) * (sheet - random);
    }
    return float_clamp(above / below, 0, 1);
}

/* The gamma by which the voxel by itself, without neighbours that continue it, lets through what the rays say: least squares
 * of exp(−τ·enhancement), linearised. */
static float fit_alone(const AxisLight *light, float density) {
    float above = 0, below = 1e-9f;
    for (int axis = 0; axis < 3; axis++) {
        float t = float_max(light->through[axis], 1.0f / 64), weighted = t * t * light->tau[axis];
        above -= weighted * logf(t);
        below += weighted * light->tau[axis];
    }
    return float_min(1, opacity_gamma_for(above / below, density));
}

/* Walls before the inside of a solid, which stops the light, only smooth its outline: at full strength they would fatten it by nearly
 * half a voxel all around. Thin solids have no inside; a ray meets both walls, and at full strength each would count twice. Flat walls whose inside no voxel
 * of their level stands for, as those of a floor that is half a voxel thick, are sheets. */
static const float BACKED_WALL = -0.43f, THIN_WALL = 0.6f, MOSTLY_THICK = 0.2f;

/* 1 where all faces one way, 0 for an eighth of a sphere and what is rounder. */
static float flatness(const VoxelCell *cell) {
    static const float ROUND = 0.6f;
    const float *n = cell->normals;
    float trace = n[0] + n[1] + n[2];
    float squares = n[0] * n[0] + n[1] * n[1] + n[2] * n[2] + 2 * (n[3] * n[3] + n[4] * n[4] + n[5] * n[5]);
    return trace > 0 ? float_clamp((squares / (trace * trace) - ROUND) / (1 - ROUND), 0, 1) : 0;
}

/* Sheets go on into the next voxels; thin solids and clumps end in this one. */
static float fit_gamma(const VoxelCell *cell, const VoxelSurround *around, const AxisLight *light,
                       float density, float thin, bool backed) {
    float sheet = fit_sheet(light), alone = fit_alone(light, density),
          solid = cell->solid / (cell->solid + cell->sheet);
    float ending = sheet > 0 ? float_min(THIN_WALL * sheet, alone) : float_min(alone, 0);
    float whole = sheet > 0 ? sheet * fit_continuation(cell, around) : ending;
    float thick = BACKED_WALL + (backed ? 0 : flatness(cell) * (whole - BACKED_WALL)), wall = thick + thin * (ending - thick);
    return whole + solid * (wall - whole);
}

VoxelMatter voxel_cell_matter(const VoxelCell *cell, const VoxelSurround *around, const float sides[3],
                              float side, float thin, bool backed) {
    VoxelMatter matter = {.root = unit_root(cell)};
    float area = cell->sheet + cell->solid * (1 - 0.5f * thin);
    /* Cauchy: an area is seen as half of itself, on the mean over directions. */
    matter.density = area / (2 * sides[0] * sides[1] * sides[2]) * side;
    AxisLight light = axis_light(cell, &matter.root, matter.density, sides, side);
    matter.gamma = fit_gamma(cell, around, &light, matter.density, float_min(thin, 1), backed);
    matter.wall = backed && thin < MOSTLY_THICK && cell->solid > cell->sheet;
    return matter;
}
