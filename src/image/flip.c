#include "image/flip.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A picture of three planes of doubles. */
typedef struct Planes {
    int width, height;
    double *at[3];
} Planes;

typedef struct Triple {
    double v[3];
} Triple;

static size_t pixel_count(const Planes *p) { return (size_t)p->width * (size_t)p->height; }

static bool planes_init(Planes *p, int width, int height) {
    *p = (Planes){.width = width, .height = height};
    bool good = true;
    for (int c = 0; c < 3; c++) {
        p->at[c] = malloc(pixel_count(p) * sizeof(double));
        good = good && p->at[c];
    }
    return good;
}

static void planes_free(Planes *p) {
    for (int c = 0; c < 3; c++) free(p->at[c]);
}

/* ---- colour spaces ---- */

/* Linear sRGB to CIE XYZ, from the primaries and the white point of IEC 61966-2-1. */
static const double RGB_TO_XYZ[3][3] = {
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382},
};

static double white(int row) { return RGB_TO_XYZ[row][0] + RGB_TO_XYZ[row][1] + RGB_TO_XYZ[row][2]; }

/* XYZ relative to white. */
static Triple xyz_of(Triple rgb) {
    Triple out;
    for (int i = 0; i < 3; i++)
        out.v[i] = (RGB_TO_XYZ[i][0] * rgb.v[0] + RGB_TO_XYZ[i][1] * rgb.v[1] + RGB_TO_XYZ[i][2] * rgb.v[2]) / white(i);
    return out;
}

/* The matrix's inverse by cofactors. */
static Triple rgb_of(Triple xyz) {
    const double(*m)[3] = RGB_TO_XYZ;
    double cofactor[3][3], determinant = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
            cofactor[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        }
    for (int j = 0; j < 3; j++) determinant += m[0][j] * cofactor[0][j];
    Triple out = {{0, 0, 0}};
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) out.v[j] += cofactor[i][j] * xyz.v[i] * white(i) / determinant;
    return out;
}

/* YCxCz, the linear opponent space in which the eye's contrast sensitivity is measured. */
static Triple opponent_of(Triple rgb) {
    Triple xyz = xyz_of(rgb);
    return (Triple){{116 * xyz.v[1] - 16, 500 * (xyz.v[0] - xyz.v[1]), 200 * (xyz.v[1] - xyz.v[2])}};
}

static Triple rgb_of_opponent(Triple o) {
    double y = (o.v[0] + 16) / 116;
    return rgb_of((Triple){{y + o.v[1] / 500, y, y - o.v[2] / 200}});
}

static double lab_curve(double t) {
    const double delta = 6.0 / 29;
    return t > delta * delta * delta ? cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}

/* CIELAB, its chroma lessened where it is dark (Hunt's effect; section 4.1 of the paper). */
static Triple hunt_lab(Triple rgb) {
    Triple xyz = xyz_of(rgb);
    double fx = lab_curve(xyz.v[0]), fy = lab_curve(xyz.v[1]), fz = lab_curve(xyz.v[2]);
    double lightness = 116 * fy - 16;
    return (Triple){{lightness, 0.01 * lightness * 500 * (fx - fy), 0.01 * lightness * 200 * (fy - fz)}};
}

/* Distance for large differences: city block in lightness, Euclid in chroma. */
static double hyab(Triple a, Triple b) { return fabs(a.v[0] - b.v[0]) + hypot(a.v[1] - b.v[1], a.v[2] - b.v[2]); }

/* ---- filters ---- */

/* One-dimensional kernels from -radius to radius. */
enum { LARGEST_RADIUS = 512 };
typedef struct Kernel {
    int radius;
    double weight[2 * LARGEST_RADIUS + 1];
} Kernel;

/* Convolution along rows (step_x 1) or columns; pictures go on beyond their borders as at the border. */
static void convolve(const double *in, double *out, int width, int height, const Kernel *k, bool along_rows) {
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double sum = 0;
            for (int i = -k->radius; i <= k->radius; i++) {
                int column = along_rows ? int_clamp(x + i, 0, width - 1) : x;
                int row = along_rows ? y : int_clamp(y + i, 0, height - 1);
                sum += k->weight[i + k->radius] * in[(size_t)row * (size_t)width + (size_t)column];
            }
            out[(size_t)y * (size_t)width + (size_t)x] = sum;
        }
}

/* out = horizontal ∗ vertical ∗ in, by way of `between`. */
static void convolve_both(const double *in, double *between, double *out, const Planes *size, const Kernel *horizontal,
                          const Kernel *vertical) {
    convolve(in, between, size->width, size->height, horizontal, true);
    convolve(between, out, size->width, size->height, vertical, false);
}

static double kernel_sum(const Kernel *k) {
    double sum = 0;
    for (int i = 0; i <= 2 * k->radius; i++) sum += k->weight[i];
    return sum;
}

/* Contrast sensitivity of the three channels as sums of two Gaussians a·exp(-π²x²/b)·sqrt(π/b), x in degrees (Table 1 of the paper). */
typedef struct Sensitivity {
    double a[2], b[2];
} Sensitivity;
static const Sensitivity SENSITIVITIES[3] = {
    {{1, 0}, {0.0047, 1e-5}},       /* achromatic */
    {{1, 0}, {0.0053, 1e-5}},       /* red to green */
    {{34.1, 13.5}, {0.04, 0.025}},  /* blue to yellow */
};

static int sensitivity_radius(double per_degree) {
    return int_min((int)ceil(3 * sqrt(0.04 / (2 * VTS_PI * VTS_PI)) * per_degree), LARGEST_RADIUS);
}

static void gaussian_of_sensitivity(Kernel *k, double b, double per_degree) {
    k->radius = sensitivity_radius(per_degree);
    for (int i = -k->radius; i <= k->radius; i++) {
        double x = i / per_degree;
        k->weight[i + k->radius] = exp(-VTS_PI * VTS_PI * x * x / b);
    }
}

/* What the eye resolves of a channel. Each Gaussian is separable; their sum is normalised as a whole. */
static void filter_channel(const double *in, double *between, double *one, double *out, const Planes *size,
                           const Sensitivity *s, double per_degree) {
    Kernel k;
    double total = 0, share[2];
    memset(out, 0, pixel_count(size) * sizeof *out);
    for (int g = 0; g < 2; g++) {
        gaussian_of_sensitivity(&k, s->b[g], per_degree);
        double sum = kernel_sum(&k);
        share[g] = s->a[g] * sqrt(VTS_PI / s->b[g]);
        total += share[g] * sum * sum;
    }
    for (int g = 0; g < 2; g++) {
        if (share[g] == 0) continue;
        gaussian_of_sensitivity(&k, s->b[g], per_degree);
        convolve_both(in, between, one, size, &k, &k);
        for (size_t i = 0; i < pixel_count(size); i++) out[i] += share[g] / total * one[i];
    }
}

/* ---- features ---- */

/* Gaussian and its first (edges) or second (points) derivative, σ half the width of a line of 0.082 degrees; positive weights of the
 * two-dimensional kernel sum to 1, negative ones to -1 (section 4.2). */
static void feature_kernels(double per_degree, int order, Kernel *derivative, Kernel *smooth) {
    double sigma = 0.5 * 0.082 * per_degree;
    int radius = int_clamp((int)ceil(3 * sigma), 1, LARGEST_RADIUS);
    double positive = 0, negative = 0;
    derivative->radius = smooth->radius = radius;
    for (int i = -radius; i <= radius; i++) {
        double gauss = exp(-(double)i * i / (2 * sigma * sigma));
        double w = order == 1 ? -i * gauss : (i * i / (sigma * sigma) - 1) * gauss;
        smooth->weight[i + radius] = gauss;
        derivative->weight[i + radius] = w;
        *(w > 0 ? &positive : &negative) += fabs(w);
    }
    double sum = kernel_sum(smooth);
    for (int i = 0; i <= 2 * radius; i++) {
        double *w = &derivative->weight[i];
        *w /= *w > 0 ? positive : negative;
        smooth->weight[i] /= sum;
    }
}

/* Length of the vector of both directions' responses, into `out`. */
static void feature_strength(const double *in, double *between, double *across, double *out, const Planes *size, double per_degree,
                             int order) {
    Kernel derivative, smooth;
    feature_kernels(per_degree, order, &derivative, &smooth);
    convolve_both(in, between, across, size, &derivative, &smooth);
    convolve_both(in, between, out, size, &smooth, &derivative);
    for (size_t i = 0; i < pixel_count(size); i++) out[i] = hypot(out[i], across[i]);
}

/* ---- the evaluator ---- */

/* A picture's planes on the way through the evaluator. */
typedef struct View {
    Planes opponent, seen, strength; /* strength: edges, points, room for one more */
} View;

static bool view_init(View *v, int width, int height) {
    bool a = planes_init(&v->opponent, width, height), b = planes_init(&v->seen, width, height);
    return planes_init(&v->strength, width, height) && a && b;
}

static void view_free(View *v) {
    planes_free(&v->opponent);
    planes_free(&v->seen);
    planes_free(&v->strength);
}

static double clamped(double value) { return value > 0 ? double_min(value, 1) : 0; }

static void take_picture(View *v, const Image *image) {
    int rgb[3] = {image_channel(image, "R"), image_channel(image, "G"), image_channel(image, "B")};
    int grey = int_max(image_channel(image, "Y"), 0);
    bool coloured = rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0;
    for (size_t i = 0; i < pixel_count(&v->opponent); i++) {
        const float *pixel = image->pixels + i * (size_t)image->channels;
        Triple color;
        for (int c = 0; c < 3; c++) color.v[c] = clamped((double)pixel[coloured ? rgb[c] : grey]);
        Triple o = opponent_of(color);
        for (int c = 0; c < 3; c++) v->opponent.at[c][i] = o.v[c];
    }
}

/* Fills `seen` (in Hunt-adjusted CIELAB) and `strength`. */
static void look_at_picture(View *v, double per_degree) {
    const Planes *size = &v->opponent;
    double *between = v->strength.at[0], *one = v->strength.at[1];
    for (int c = 0; c < 3; c++)
        filter_channel(v->opponent.at[c], between, one, v->seen.at[c], size, &SENSITIVITIES[c], per_degree);
    for (size_t i = 0; i < pixel_count(size); i++) {
        Triple rgb = rgb_of_opponent((Triple){{v->seen.at[0][i], v->seen.at[1][i], v->seen.at[2][i]}});
        for (int c = 0; c < 3; c++) rgb.v[c] = clamped(rgb.v[c]);
        Triple lab = hunt_lab(rgb);
        for (int c = 0; c < 3; c++) v->seen.at[c][i] = lab.v[c];
    }
    double *lightness = v->opponent.at[0], *room = v->opponent.at[1], *room2 = v->opponent.at[2];
    for (size_t i = 0; i < pixel_count(size); i++) lightness[i] = (lightness[i] + 16) / 116;
    feature_strength(lightness, room, room2, v->strength.at[0], size, per_degree, 1);
    feature_strength(lightness, room, room2, v->strength.at[1], size, per_degree, 2);
}

/* Differences of colour, compressed so that small ones take most of the range (section 4.1.4). */
static double color_error(double distance, double largest) {
    const double exponent = 0.7, knee = 0.4, at_knee = 0.95;
    double e = pow(distance, exponent), limit = pow(largest, exponent);
    if (e < knee * limit) return at_knee / (knee * limit) * e;
    return at_knee + (e - knee * limit) / (limit - knee * limit) * (1 - at_knee);
}

static double largest_distance(void) {
    return hyab(hunt_lab((Triple){{0, 1, 0}}), hunt_lab((Triple){{0, 0, 1}}));
}

static double pixel_error(const View *a, const View *b, size_t i, double largest) {
    Triple seen_a = {{a->seen.at[0][i], a->seen.at[1][i], a->seen.at[2][i]}};
    Triple seen_b = {{b->seen.at[0][i], b->seen.at[1][i], b->seen.at[2][i]}};
    double edges = fabs(a->strength.at[0][i] - b->strength.at[0][i]);
    double points = fabs(a->strength.at[1][i] - b->strength.at[1][i]);
    double feature = sqrt(double_max(edges, points) / sqrt(2));
    return pow(color_error(hyab(seen_a, seen_b), largest), 1 - double_min(feature, 1));
}

float *flip_map(const Image *reference, const Image *test, double pixels_per_degree, double *mean, StrBuf *error) {
    if (reference->width != test->width || reference->height != test->height) {
        if (error)
            strbuf_addf(error, "pictures of different size: %d x %d and %d x %d", reference->width, reference->height, test->width,
                        test->height);
        return NULL;
    }
    View a = {0}, b = {0};
    bool good_a = view_init(&a, test->width, test->height), good_b = view_init(&b, test->width, test->height);
    size_t count = pixel_count(&a.seen);
    float *map = good_a && good_b ? malloc(count * sizeof *map) : NULL;
    if (map) {
        take_picture(&a, reference);
        take_picture(&b, test);
        look_at_picture(&a, pixels_per_degree);
        look_at_picture(&b, pixels_per_degree);
        double sum = 0, largest = largest_distance();
        for (size_t i = 0; i < count; i++) {
            double e = pixel_error(&a, &b, i, largest);
            map[i] = (float)e;
            sum += e;
        }
        *mean = sum / (double)count;
    } else if (error) {
        strbuf_adds(error, "no memory for comparing the pictures");
    }
    view_free(&a);
    view_free(&b);
    return map;
}
