#include "scene/solids.h"

#include "scene/scene_hash.h"

#include <string.h>

static const uint64_t KIND_SOLID = 0x501D;

size_t solid_polynomial_terms(int order) {
    size_t n = (size_t)order;
    return (n + 1) * (n + 2) * (n + 3) / 6;
}

static void add_doubles(Hash128 *h, const double *values, size_t count) {
    hash_add_u64(h, count);
    for (size_t i = 0; i < count; i++) hash_add_double(h, values[i]);
}

static void add_text(Hash128 *h, const char *text) {
    hash_add_u64(h, text ? strlen(text) + 1 : 0);
    if (text) hash_add(h, text, strlen(text));
}

static void add_object(Hash128 *h, const Object *object) {
    hash_add_u64(h, object != NULL);
    if (object) hash_add_hash(h, object_geometry_hash(object));
}

static void add_points(Hash128 *h, const Point2 *points, size_t count) {
    hash_add_u64(h, count);
    for (size_t i = 0; i < count; i++) add_doubles(h, (double[]){points[i].x, points[i].y}, 2);
}

static void add_vectors(Hash128 *h, const Vec3 *points, size_t count) {
    hash_add_u64(h, count);
    for (size_t i = 0; i < count; i++) hash_add_vec3(h, points[i]);
}

static void add_blob(Hash128 *h, const Solid *s) {
    hash_add_double(h, s->as.blob.threshold);
    hash_add_u64(h, s->as.blob.count);
    for (size_t i = 0; i < s->as.blob.count; i++) {
        const BlobPart *part = &s->as.blob.parts[i];
        hash_add_vec3(h, part->base);
        hash_add_vec3(h, part->cap);
        add_doubles(h, (double[]){part->radius, part->strength}, 2);
        hash_add_transform(h, &part->transform);
    }
}

static void add_sweep(Hash128 *h, const Solid *s) {
    hash_add_u64(h, s->as.sweep.curve);
    hash_add_u64(h, s->as.sweep.count);
    for (size_t i = 0; i < s->as.sweep.count; i++) {
        hash_add_vec3(h, s->as.sweep.spheres[i].center);
        hash_add_double(h, s->as.sweep.spheres[i].radius);
    }
}

static void add_prism(Hash128 *h, const Solid *s) {
    hash_add_u64(h, (uint64_t)s->as.prism.curve << 2 | (uint64_t)s->as.prism.conic << 1 |
                        (uint64_t)s->as.prism.open);
    add_doubles(h, (double[]){s->as.prism.low, s->as.prism.high}, 2);
    add_points(h, s->as.prism.points, s->as.prism.count);
}

static void add_julia(Hash128 *h, const Solid *s) {
    add_doubles(h, s->as.julia.c, 4);
    add_doubles(h, s->as.julia.slice, 4);
    add_doubles(h, s->as.julia.exponent, 2);
    add_doubles(h,
                (double[]){s->as.julia.distance, s->as.julia.hypercomplex, s->as.julia.function,
                           s->as.julia.iterations},
                4);
}

static void add_parametric(Hash128 *h, const Solid *s) {
    for (int i = 0; i < 3; i++) hash_add_hash(h, tape_hash(s->as.parametric.functions[i]));
    add_doubles(
        h, (double[]){s->as.parametric.u0, s->as.parametric.v0, s->as.parametric.u1, s->as.parametric.v1}, 4);
    add_object(h, s->as.parametric.container);
}

static void add_field(Hash128 *h, const Solid *s) {
    add_text(h, s->as.field.path);
    hash_add_double(h, s->as.field.water_level);
    hash_add_u64(h, s->as.field.smooth);
    hash_add_u64(h, s->as.field.potential);
    hash_add_u64(h, (uint64_t)s->as.field.columns << 32 | (uint64_t)s->as.field.rows);
    if (s->as.field.heights)
        add_doubles(h, s->as.field.heights, (size_t)s->as.field.columns * (size_t)s->as.field.rows);
}

void solid_rehash(Solid *s) {
    Hash128 h = hash_begin(KIND_SOLID);
    hash_add_u64(&h, s->kind);
    switch (s->kind) {
    case SOLID_POLYNOMIAL:
        hash_add_u64(&h, (uint64_t)s->as.polynomial.order);
        add_doubles(&h, s->as.polynomial.coefficients, s->as.polynomial.count);
        break;
    case SOLID_QUADRIC:
        add_vectors(&h, (Vec3[]){s->as.quadric.squares, s->as.quadric.mixed, s->as.quadric.linear}, 3);
        hash_add_double(&h, s->as.quadric.constant);
        break;
    case SOLID_POLYGON: add_vectors(&h, s->as.polygon.points, s->as.polygon.count); break;
    case SOLID_SUPERELLIPSOID:
        add_doubles(&h, (double[]){s->as.superellipsoid.east_west, s->as.superellipsoid.north_south}, 2);
        break;
    case SOLID_PATCH: add_vectors(&h, s->as.patch.points, 16); break;
    case SOLID_BLOB: add_blob(&h, s); break;
    case SOLID_LATHE:
    case SOLID_SOR:
        hash_add_u64(&h, (uint64_t)s->as.turned.curve << 1 | (uint64_t)s->as.turned.open);
        add_points(&h, s->as.turned.points, s->as.turned.count);
        break;
    case SOLID_PRISM: add_prism(&h, s); break;
    case SOLID_SWEEP: add_sweep(&h, s); break;
    case SOLID_TEXT:
        add_text(&h, s->as.text.font_path ? s->as.text.font_path : s->as.text.font_name);
        add_text(&h, s->as.text.text);
        hash_add_double(&h, s->as.text.thickness);
        hash_add_vec3(&h, s->as.text.offset);
        break;
    case SOLID_JULIA: add_julia(&h, s); break;
    case SOLID_OVUS: add_doubles(&h, (double[]){s->as.ovus.bottom, s->as.ovus.top}, 2); break;
    case SOLID_ISOSURFACE:
        hash_add_hash(&h, tape_hash(s->as.isosurface.function));
        add_object(&h, s->as.isosurface.container);
        add_doubles(
            &h,
            (double[]){s->as.isosurface.threshold, s->as.isosurface.accuracy, s->as.isosurface.max_gradient},
            3);
        hash_add_u64(&h, (uint64_t)s->as.isosurface.method << 2 | (uint64_t)s->as.isosurface.full_detail << 1 | (uint64_t)s->as.isosurface.open);
        break;
    case SOLID_PARAMETRIC: add_parametric(&h, s); break;
    case SOLID_HEIGHT_FIELD: add_field(&h, s); break;
    }
    s->hash = h;
}
