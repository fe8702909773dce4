/* What is seen of a bin is flat within it, which lets too much light out of bins that are thick. What paths brought is right on the mean, if uncertain in
 * each. So what bins see is made as bright as what paths brought to many bins around: as much as they are thick. */
#include "render/volume_shoot.h"

enum { REACH = 2 };

/* Sums over the bins up to REACH away, axis by axis. */
static void blur(float *values, float *line, const int n[3]) {
    size_t stride = 1, all = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
    for (int k = 0; k < 3; stride *= (size_t)n[k++])
        for (size_t first = 0; first < all; first++) {
            if (first / stride % (size_t)n[k]) continue;
            for (int i = 0; i < n[k]; i++) line[i] = values[first + (size_t)i * stride];
            for (int i = 0; i < n[k]; i++) {
                float sum = 0;
                for (int j = int_max(i - REACH, 0); j <= int_min(i + REACH, n[k] - 1); j++) sum += line[j];
                values[first + (size_t)i * stride] = sum;
            }
        }
}

/* How much of the correction a bin takes. */
static double thickness(const CompiledVolume *v, double density, int c) {
    double size = cbrt(fabs(mat3_determinant(&v->from_cells)) * v->lattice.size[0] * v->lattice.size[1] * v->lattice.size[2] / (double)volume_bins(v->light));
    double depth = density * v->extinction[c] * size;
    return depth * depth / (depth * depth + 0.1);
}

static void balance_color(const CompiledVolume *v, int c, float *wanted, float *found, float *line) {
    VolumeLight *light = v->light;
    const int *n = light->bins;
    for (size_t bin = 0; bin < volume_bins(light); bin++) {
        double density = (double)light->density[bin], weight = thickness(v, density, c);
        wanted[bin] = (float)(weight * (double)light->reached[bin][c]);
        found[bin] = (float)(weight * density * (double)light->kept[bin * (size_t)light->harmonics][c]);
    }
    blur(wanted, line, n);
    blur(found, line, n);
    for (size_t bin = 0; bin < volume_bins(light); bin++) {
        double ratio = found[bin] > 0 ? double_clamp((double)wanted[bin] / (double)found[bin], 0.5, 2) : 1;
        double factor = 1 + thickness(v, (double)light->density[bin], c) * (ratio - 1);
        for (int h = 0; h < light->harmonics; h++) light->kept[bin * (size_t)light->harmonics + (size_t)h][c] *= (float)factor;
    }
}

void volumes_balance(CompiledScene *compiled) {
    ArenaMark mark = arena_mark(&compiled->scratch);
    for (size_t i = 0; i < compiled->volumes->count; i++) {
        const CompiledVolume *v = &compiled->volumes->items[i];
        const int *n = v->light->bins;
        float *wanted = arena_new_array(&compiled->scratch, float, volume_bins(v->light)), *found = arena_new_array(&compiled->scratch, float, volume_bins(v->light));
        float *line = arena_new_array(&compiled->scratch, float, (size_t)int_max(n[0], int_max(n[1], n[2])));
        for (int c = 0; c < 3 && v->light->reached; c++) balance_color(v, c, wanted, found, line);
    }
    arena_reset_to(&compiled->scratch, mark);
}
