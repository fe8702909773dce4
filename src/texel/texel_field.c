#include "texel/texel_field.h"

#include "base/random.h"
#include "pattern/values.h"
#include "pattern/warp.h"
#include "texel/texel_content.h"
#include "volume/grid.h"

#include <stdint.h>

enum { MOST_SAMPLES = 8, LEAST_FLAKE_CELLS = 8, MOST_FLAKE_CELLS = 128 };
static const double FLAKES_A_CELL = 0.7;
/* What is thinner counts as nothing, so that the noise of scanners does not fill all voxels. */
static const double LEAST_DENSITY = 1.0 / 512;
/* Cells of this optical depth, all around, let nothing of what is within be seen: e to the power of its negative is 1/1000. */
static const double HIDING_DEPTH = 7;
/* Of one sample: denser than voxels can tell, and squares of sums of it are floats. */
static const double MOST_AREA = 1e12;

typedef struct FieldMatter {
    const DensityField *field;
    const Pigment *pattern;
    unsigned cyclic;
    bool warped, warps_itself;
    Transform place; /* texel space → the space that the pattern stands in */
    GridRange range; /* of a grid */
    double scale;    /* cells of the grid for one unit of texel space, where it is finest */
    double step;     /* for differences, texel space */
} FieldMatter;

typedef struct FieldValue {
    double value;
    Vec3 gradient; /* texel space */
} FieldValue;

static double raw_value(const FieldMatter *m, Vec3 p) {
    Spot outer = spot_make(transform_point(&m->place, p), vec3_splat(0), 0);
    Spot spot = spot_in_pattern(m->pattern, &outer, m->warps_itself);
    if (m->pattern->kind == PATTERN_DENSITY) return grid_value(m->pattern->density, m->cyclic, spot.p);
    return pattern_value(m->pattern, &spot).value;
}

static double value_at(const FieldMatter *m, Vec3 p) {
    double share = (raw_value(m, p) - m->field->low) / (m->field->high - m->field->low);
    return share > 0 ? double_min(share, 1) : 0; /* NaN is nothing */
}

static FieldValue look_at(const FieldMatter *m, Vec3 p) {
    FieldValue out = {.value = value_at(m, p)};
    if (!(out.value > 0)) return out;
    double h = m->step; /* to one side: half of the evaluations, and no more than half a step beside the place */
    Vec3 ahead = vec3(value_at(m, vec3(p.x + h, p.y, p.z)), value_at(m, vec3(p.x, p.y + h, p.z)), value_at(m, vec3(p.x, p.y, p.z + h)));
    out.gradient = vec3_scale(vec3_sub(ahead, vec3_splat(out.value)), 1 / h);
    return out;
}

/* The share of flakes that face along the gradient. */
static double facing_share(const FieldMatter *m, const FieldValue *v) {
    double change = vec3_length(v->gradient) / (m->field->extinction * v->value * v->value);
    return isfinite(change) ? change / (1 + change) : 1;
}

/* Adds matter of this area to the sums of a cell. */
static void add_matter(const FieldMatter *m, const FieldValue *v, double area, float *sum, float normals[6]) {
    Vec3 n = vec3_normalize(v->gradient);
    double facing = area * facing_share(m, v), rest = (area - facing) / 3;
    *sum += (float)area;
    normals[0] += (float)(rest + facing * n.x * n.x);
    normals[1] += (float)(rest + facing * n.y * n.y);
    normals[2] += (float)(rest + facing * n.z * n.z);
    normals[3] += (float)(facing * n.x * n.y);
    normals[4] += (float)(facing * n.x * n.z);
    normals[5] += (float)(facing * n.y * n.z);
}

/* Places along each axis of a cell at which the field is asked: as fine as the grid is, twice for what has no grid. */
static int samples_across(const FieldMatter *m, double side) {
    int least = m->pattern->kind == PATTERN_DENSITY && !m->warped ? 1 : 2;
    return int_clamp((int)ceil(m->scale * side - 1e-6), least, MOST_SAMPLES);
}

static Vec3 sample_place(Vec3f lo, Vec3f sides, const int n[3], int i, int j, int k) {
    return vec3((double)lo.x + (i + 0.5) / n[0] * (double)sides.x, (double)lo.y + (j + 0.5) / n[1] * (double)sides.y,
                (double)lo.z + (k + 0.5) / n[2] * (double)sides.z);
}

static void fill(const void *context, Vec3f lo, Vec3f sides, float *area, float normals[6]) {
    const FieldMatter *m = context;
    const int n[3] = {samples_across(m, (double)sides.x), samples_across(m, (double)sides.y), samples_across(m, (double)sides.z)};
    double volume = (double)sides.x * (double)sides.y * (double)sides.z / (n[0] * n[1] * n[2]), sum = 0;
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++) {
                FieldValue v = look_at(m, sample_place(lo, sides, n, i, j, k));
                sum += v.value;
                /* Cauchy: flakes are seen with half of their area, on the mean over directions. */
                if (v.value > 0) add_matter(m, &v, double_min(2 * m->field->extinction * v.value * volume, MOST_AREA), area, normals);
            }
    if (sum >= LEAST_DENSITY * n[0] * n[1] * n[2]) return;
    *area = 0;
    for (int i = 0; i < 6; i++) normals[i] = 0;
}

/* Whether a box may hold matter: told for grids that are not warped. */
static bool touches(const void *context, Vec3f lo, Vec3f hi) {
    const FieldMatter *m = context;
    if (m->pattern->kind != PATTERN_DENSITY || m->warped) return true;
    Transform back = transform_inverse(&m->pattern->transform);
    Box3 box = box3_transform(&m->place, (Box3){vec3_from_f(lo), vec3_from_f(hi)});
    return grid_range_most(&m->range, m->cyclic, box3_transform(&back, box)) > m->field->low;
}

/* ---- set-up ---- */

static Transform place_of(const TexelDef *def, const DensityField *field, Vec3f extent) {
    if (field->in_bounds) return transform_scale(vec3(1 / (double)extent.x, 1 / (double)extent.y, 1 / (double)extent.z));
    Transform space = texel_space(def);
    return transform_inverse(&space);
}

static double finest_scale(const FieldMatter *m) {
    double finest = 0;
    for (int axis = 0; axis < 3; axis++) {
        Vec3 d = transform_vector_back(&m->pattern->transform, transform_vector(&m->place, vec3(axis == 0, axis == 1, axis == 2)));
        for (int k = 0; k < 3; k++) finest = double_max(finest, fabs(vec3_get(d, k)) * m->pattern->density->size[k]);
    }
    return finest;
}

const TexelField *texel_field_make(const TexelDef *def, const TexelLayer *layer, Arena *arena) {
    FieldMatter *m = arena_new(arena, FieldMatter);
    TexelField *field = arena_new(arena, TexelField);
    const Pigment *pattern = layer->density->pattern;
    Vec3f extent = texel_extent(def);
    *m = (FieldMatter){.field = layer->density,
                       .pattern = pattern,
                       .cyclic = layer->density->in_bounds ? def->cyclic : 0,
                       .warped = pattern->warp_count > 0 || vec3_length_squared(pattern->turbulence) > 0,
                       .warps_itself = pattern_traits(pattern->kind).warps_itself,
                       .place = place_of(def, layer->density, extent),
                       .step = 1.0 / 1024};
    if (pattern->kind == PATTERN_DENSITY) {
        m->range = grid_range(pattern->density, arena);
        m->scale = finest_scale(m);
        m->step = m->scale > 0 ? double_clamp(0.5 / m->scale, 1e-5, 0.1) : m->step;
    }
    *field = (TexelField){.context = m, .fill = fill, .touches = touches};
    return field;
}

/* ---- flakes ---- */

/* Cells that flakes are dealt out to, by the density there: n each way. */
typedef struct FlakeGrid {
    size_t n;
    Vec3f sides;
} FlakeGrid;

static FlakeGrid flake_grid(Vec3f extent, size_t flakes) {
    size_t n = (size_t)int_clamp((int)cbrt((double)flakes / FLAKES_A_CELL + 0.5), LEAST_FLAKE_CELLS, MOST_FLAKE_CELLS);
    return (FlakeGrid){n, vec3f_scale(extent, 1 / (float)n)};
}

static Vec3f cell_corner(const FlakeGrid *g, size_t cell) {
    Vec3f sides = g->sides;
    size_t n = g->n;
    return vec3f((float)(cell % n) * sides.x, (float)(cell / n % n) * sides.y,
                 (float)(cell / n / n) * sides.z);
}

static double cell_area(const TexelField *field, const FlakeGrid *g, size_t cell) {
    float area = 0, normals[6] = {0};
    Vec3f lo = cell_corner(g, cell);
    if (!field->touches(field->context, lo, vec3f_add(lo, g->sides))) return 0;
    field->fill(field->context, lo, g->sides, &area, normals);
    return (double)area;
}

static Vec3 random_direction(RandomStream *random) {
    double z = 2 * random_next_unit(random) - 1, turn = 2 * VTS_PI * random_next_unit(random), r = sqrt(1 - z * z);
    return vec3(r * cos(turn), r * sin(turn), z);
}

/* A place in the cell, taken in proportion to the density there. */
static Vec3 flake_place(const FieldMatter *m, Vec3f lo, Vec3f sides, RandomStream *random, FieldValue *value) {
    enum { TRIES = 16 };
    Vec3 place = vec3_splat(0);
    for (int i = 0; i < TRIES; i++) {
        double x = random_next_unit(random), y = random_next_unit(random), z = random_next_unit(random), limit = random_next_unit(random);
        place = vec3_add(vec3_from_f(lo), vec3(x * (double)sides.x, y * (double)sides.y, z * (double)sides.z));
        if (value_at(m, place) >= limit) break;
    }
    *value = look_at(m, place);
    return place;
}

/* An equilateral triangle about a place. */
static void add_flake(const FieldMatter *m, Vec3f lo, Vec3f sides, double area, RandomStream *random, Vec3f corners[3]) {
    FieldValue value;
    Vec3 place = flake_place(m, lo, sides, random, &value), s, t;
    bool faces = random_next_unit(random) < facing_share(m, &value) && vec3_length_squared(value.gradient) > 0;
    vec3_frame(faces ? vec3_normalize(value.gradient) : random_direction(random), &s, &t);
    double radius = sqrt(4 * area / (3 * sqrt(3))), turn = 2 * VTS_PI * random_next_unit(random);
    for (int k = 0; k < 3; k++) {
        double angle = turn + 2 * VTS_PI * k / 3;
        corners[k] = vec3f_from(vec3_madd(vec3_madd(place, s, radius * cos(angle)), t, radius * sin(angle)));
    }
}

/* Whether no ray comes into the cell: all around it others take what light there is. */
static bool is_hidden(const double *areas, size_t n, size_t cell, double opaque) {
    const int at[3] = {(int)(cell % n), (int)(cell / n % n), (int)(cell / n / n)};
    for (int k = 0; k < 3; k++)
        if (at[k] == 0 || at[k] == (int)n - 1) return false;
    for (int z = -1; z <= 1; z++)
        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++)
                if (areas[((size_t)(at[2] + z) * n + (size_t)(at[1] + y)) * n + (size_t)(at[0] + x)] < opaque) return false;
    return true;
}

/* The area in each cell, but for those that cannot be seen; returns the sum. */
static double seen_areas(const TexelField *field, const FlakeGrid *g, Arena *arena, double **out) {
    const size_t cells = g->n * g->n * g->n;
    Vec3f sides = g->sides;
    double *areas = arena_new_array(arena, double, cells), *seen = arena_new_array(arena, double, cells), total = 0;
    double shortest = (double)float_min(sides.x, float_min(sides.y, sides.z));
    double opaque = 2 * HIDING_DEPTH / shortest * (double)sides.x * (double)sides.y * (double)sides.z;
    for (size_t c = 0; c < cells; c++) areas[c] = cell_area(field, g, c);
    for (size_t c = 0; c < cells; c++) total += seen[c] = is_hidden(areas, g->n, c, opaque) ? 0 : areas[c];
    *out = seen;
    return total;
}

void texel_field_flakes(const TexelField *field, Vec3f extent, size_t count, Arena *arena, TexelMesh *out) {
    const FlakeGrid g = flake_grid(extent, count);
    const size_t cells = g.n * g.n * g.n;
    const Vec3f sides = g.sides;
    double *areas, total = seen_areas(field, &g, arena, &areas);
    *out = (TexelMesh){0};
    if (!(total > 0)) return;
    Vec3f *vertices = arena_new_array(arena, Vec3f, 3 * (count + 1));
    uint32_t(*triangles)[3] = arena_push_array_(arena, count + 1, sizeof *triangles);
    double before = 0;
    for (size_t c = 0; c < cells; c++) {
        double after = before + areas[c] / total * (double)count;
        RandomStream random = {random_hash(c, 0xF1A, 0, 0)};
        for (double n = floor(before); n < floor(after) && out->triangle_count <= count; n++) {
            size_t i = out->triangle_count++;
            add_flake(field->context, cell_corner(&g, c), sides, total / (double)count, &random, &vertices[3 * i]);
            for (uint32_t k = 0; k < 3; k++) triangles[i][k] = (uint32_t)(3 * i) + k;
        }
        before = after;
    }
    out->vertices = vertices;
    out->vertex_count = 3 * out->triangle_count;
    out->triangles = (const uint32_t(*)[3])triangles;
}
