#include "render/matter_color.h"

/* Of a colour kept in 32 bits: nine for each of red, green and blue, and an exponent that they share. 0: not known. */
enum { MANTISSA_BITS = 9, MANTISSA_MOST = (1 << MANTISSA_BITS) - 1, EXPONENT_LEAST = 1, EXPONENT_MOST = 31, EXPONENT_ZERO = 13 };

void matter_colors_prepare(TexelMatter *matter, Arena *arena) {
    if (matter->look.uniform || !matter->voxels) return;
    for (int level = 1; level < voxel_layer_levels(matter->voxels); level++) {
        size_t count = voxel_layer_voxels(matter->voxels, level);
        matter->colors[level] = arena_new_array(arena, _Atomic uint32_t, count + 1);
        for (size_t i = 0; i <= count; i++) atomic_init(&matter->colors[level][i], 0);
    }
}

/* 0 where it cannot be told so: negative, larger than all that can be told, not a number. */
static uint32_t pack(Vec3f c) {
    float most = float_max(c.x, float_max(c.y, c.z));
    if (!(c.x >= 0 && c.y >= 0 && c.z >= 0 && most <= ldexpf(MANTISSA_MOST - 1, EXPONENT_MOST - EXPONENT_ZERO - MANTISSA_BITS))) return 0;
    int exponent;
    frexpf(most, &exponent); /* most < 2^exponent */
    int e = int_clamp(exponent + EXPONENT_ZERO, EXPONENT_LEAST, EXPONENT_MOST);
    float unit = ldexpf(1, MANTISSA_BITS + EXPONENT_ZERO - e);
    uint32_t out = (uint32_t)e << 3 * MANTISSA_BITS;
    const float part[3] = {c.x, c.y, c.z};
    for (int i = 0; i < 3; i++) out |= (uint32_t)int_min((int)lrintf(part[i] * unit), MANTISSA_MOST) << i * MANTISSA_BITS;
    return out;
}

static Vec3f unpack(uint32_t code) {
    float unit = ldexpf(1, (int)(code >> 3 * MANTISSA_BITS) - EXPONENT_ZERO - MANTISSA_BITS);
    return vec3f(unit * (float)(code & MANTISSA_MOST), unit * (float)(code >> MANTISSA_BITS & MANTISSA_MOST), unit * (float)(code >> 2 * MANTISSA_BITS & MANTISSA_MOST));
}

/* At a place of texel space, under a cone of this width there. */
static Vec3f color_at(const MatterHit *hit, Vec3f place, float width) {
    Box3 b = hit->texel->def->bounds;
    Vec3 size = vec3_sub(b.max, b.min);
    double unit = fmax(size.x, fmax(size.y, size.z)); /* of texel space */
    Vec3 part = vec3((double)(place.x / hit->texel->extent.x), (double)(place.y / hit->texel->extent.y), (double)(place.z / hit->texel->extent.z));
    return look_color(hit->look, vec3_add(b.min, vec3_mul(size, part)), vec3(0, 0, 0), unit * (double)width);
}

Vec3f matter_color(const MatterHit *hit, const Cone *cone, double t, float voxel_width) {
    if (hit->look->uniform) return hit->look->color;
    if (hit->look != &hit->matter->look) return look_color(hit->look, cone_point(cone, t), vec3(0, 0, 0), cone_diameter(cone, t));
    int level = (int)lrintf(hit->lod);
    _Atomic uint32_t *colors = level > 0 ? hit->matter->colors[level] : NULL;
    uint32_t voxel;
    Vec3f center;
    if (!colors || !voxel_layer_nearest(hit->matter->voxels, level, hit->place, &voxel, &center)) return color_at(hit, hit->place, hit->width);
    uint32_t kept = atomic_load_explicit(&colors[voxel], memory_order_relaxed);
    if (kept) return unpack(kept);
    Vec3f color = color_at(hit, center, ldexpf(hit->texel->voxel, level) / voxel_width);
    kept = pack(color);
    atomic_store_explicit(&colors[voxel], kept, memory_order_relaxed);
    return kept ? unpack(kept) : color; /* whoever asks first gets what all others get */
}
