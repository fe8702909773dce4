#include "volume/grid.h"

#include "tape/noise.h"

enum { BLOCK = 8 };

/* The cell's number; 0 outside of axes that are not cyclic. */
static double cell(const DensityGrid *grid, unsigned cyclic, const long at[3]) {
    size_t index = 0;
    for (int k = 2; k >= 0; k--) {
        long size = grid->size[k], i = at[k];
        if (i < 0 || i >= size) {
            if (!(cyclic >> k & 1)) return 0;
            i = (i % size + size) % size;
        }
        index = index * (size_t)size + (size_t)i;
    }
    return (double)grid->values[index];
}

double grid_value(const DensityGrid *grid, unsigned cyclic, Vec3 p) {
    const double place[3] = {p.x, p.y, p.z};
    long first[3];
    double t[3], sum = 0;
    for (int k = 0; k < 3; k++) {
        double x = place[k];
        if (cyclic >> k & 1) x -= floor(x);
        if (!(x >= 0 && x <= 1)) return 0;
        x = x * grid->size[k] - 0.5;
        first[k] = (long)floor(x);
        t[k] = x - (double)first[k];
    }
    for (int corner = 0; corner < 8; corner++) {
        double weight = 1;
        long at[3];
        for (int k = 0; k < 3; k++) {
            int far = corner >> k & 1;
            at[k] = first[k] + far;
            weight *= far ? t[k] : 1 - t[k];
        }
        if (weight > 0) sum += weight * cell(grid, cyclic, at);
    }
    return sum;
}

/* ---- ranges ---- */

GridRange grid_range(const DensityGrid *grid, Arena *arena) {
    GridRange range = {.grid = grid};
    size_t count = 1;
    for (int k = 0; k < 3; k++) {
        range.size[k] = (grid->size[k] + BLOCK - 1) / BLOCK;
        count *= (size_t)range.size[k];
    }
    float *most = arena_new_array(arena, float, count);
    size_t i = 0;
    for (int z = 0; z < grid->size[2]; z++)
        for (int y = 0; y < grid->size[1]; y++)
            for (int x = 0; x < grid->size[0]; x++, i++) {
                size_t b = ((size_t)(z / BLOCK) * (size_t)range.size[1] + (size_t)(y / BLOCK)) * (size_t)range.size[0] + (size_t)(x / BLOCK);
                most[b] = float_max(most[b], grid->values[i]);
            }
    range.most = most;
    return range;
}

double grid_range_most(const GridRange *range, unsigned cyclic, Box3 box) {
    int lo[3], hi[3];
    for (int k = 0; k < 3; k++) {
        double size = range->grid->size[k], from = vec3_get(box.min, k) * size - 1, to = vec3_get(box.max, k) * size + 1;
        bool round = cyclic >> k & 1 && (from < 0 || to > size);
        lo[k] = round ? 0 : double_to_int(from / BLOCK, 0, range->size[k] - 1);
        hi[k] = round ? range->size[k] - 1 : double_to_int(to / BLOCK, 0, range->size[k] - 1);
    }
    double most = 0;
    for (int z = lo[2]; z <= hi[2]; z++)
        for (int y = lo[1]; y <= hi[1]; y++)
            for (int x = lo[0]; x <= hi[0]; x++)
                most = double_max(most, (double)range->most[((size_t)z * (size_t)range->size[1] + (size_t)y) * (size_t)range->size[0] + (size_t)x]);
    return most;
}

/* ---- fractal ---- */

enum { WAVES = 4, MOST_OCTAVES = 12 };

bool grid_fractal(const int size[3], double dimension, double threshold, uint32_t seed, const atomic_bool *interrupted, Arena *arena,
                  DensityGrid *out) {
    int longest = int_max(size[0], int_max(size[1], size[2]));
    double gain = exp2(-double_clamp(3 - dimension, 0, 1)), step = (double)WAVES / longest;
    int octaves = int_clamp((int)ceil(log2((double)longest / WAVES)), 1, MOST_OCTAVES);
    size_t count = (size_t)size[0] * (size_t)size[1] * (size_t)size[2], i = 0;
    float *values = arena_new_array(arena, float, count), lo = INFINITY, hi = -INFINITY;
    for (int z = 0; z < size[2]; z++)
        for (int y = 0; y < size[1]; y++) {
            if (interrupted && *interrupted) return false;
            for (int x = 0; x < size[0]; x++, i++) {
                Vec3 p = vec3((x + 0.5) * step, (y + 0.5) * step, (z + 0.5) * step);
                double sum = 0, weight = 1, scale = 1;
                for (int k = 0; k < octaves; k++, weight *= gain, scale *= 2)
                    sum += weight * noise_perlin_seeded(vec3_scale(p, scale), seed + (uint32_t)k);
                values[i] = (float)sum;
                lo = float_min(lo, values[i]), hi = float_max(hi, values[i]);
            }
        }
    float from = lo + (float)threshold * (hi - lo), unit = hi > from ? 1 / (hi - from) : 0;
    for (i = 0; i < count; i++) values[i] = float_max(0, (values[i] - from) * unit);
    *out = (DensityGrid){.hash = hash_begin(0x66726163), .values = values};
    for (int k = 0; k < 3; k++) {
        out->size[k] = size[k];
        hash_add_u64(&out->hash, (uint64_t)size[k]);
    }
    hash_add_double(&out->hash, dimension);
    hash_add_double(&out->hash, threshold);
    hash_add_u64(&out->hash, seed);
    return true;
}
