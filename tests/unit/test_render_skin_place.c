/* Copies of texels around a tile, against all copies of a wide neighbourhood. */
#include "base/random.h"
#include "render/skin.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const TexelDef definition = {.name = "test"};
static BuiltTexel one = {.def = &definition, .extent = {1, 1, 1}}, two = {.def = &definition, .extent = {1, 1, 1}};
static BuiltTexel *const family[] = {&one, &two};

/* As the renderer places it: `reach` tiles away a copy may still cover a point. */
static PlacedTexel placed_texel(InstanceJitter jitter, int reach, uint64_t seed) {
    return (PlacedTexel){.family = family, .family_size = 1, .density = 1, .seed = seed, .jitter = jitter, .reach = reach};
}

static bool covers(const TexelCopy *copy, double u, double v) {
    double x = copy->xu * u + copy->xv * v + copy->x0, z = copy->zu * u + copy->zv * v + copy->z0;
    return x >= 0 && x <= 1 && z >= 0 && z <= 1;
}

static bool same_copy(const TexelCopy *a, const TexelCopy *b) { return memcmp(a, b, sizeof *a) == 0; }

/* The copy that belongs to tile (iu, iv) itself: of a wider reach, the candidate in the middle. */
static bool own_copy(const PlacedTexel *placed, int64_t iu, int64_t iv, TexelCopy *copy) {
    PlacedTexel alone = *placed;
    alone.reach = 0;
    return texel_copy_near(&alone, iu, iv, 0, copy);
}

static void no_copy_over_a_point_is_missed(void **state) {
    (void)state;
    static const struct { double displace, rotate, scale; bool mirror; int reach; } cases[] = {
        {0, 0, 0, false, 0}, {.3, 0, 0, false, 1}, {0, 360, 0, false, 1}, {.9, 360, .5, true, 1}, {.9, 90, 0, true, 1}, {1, 360, 1, true, 2}};
    RandomStream r = {1};
    for (size_t c = 0; c < VTS_ARRAY_COUNT(cases); c++) {
        InstanceJitter jitter = {.present = true, .displace = cases[c].displace, .rotate = cases[c].rotate, .scale = cases[c].scale,
                                 .mirror = cases[c].mirror, .density = 1};
        PlacedTexel placed = placed_texel(jitter, cases[c].reach, 77 + c);
        size_t found = 0, points = 0;
        for (int i = 0; i < 4000; i++) {
            int64_t far = i % 3 == 0 ? 0 : i % 3 == 1 ? 1000000 : -1000000;
            double u = (double)far + 20 * random_next_unit(&r) - 10, v = 20 * random_next_unit(&r) - 10 - (double)far;
            int64_t iu = (int64_t)floor(u), iv = (int64_t)floor(v);
            int candidates = (2 * placed.reach + 1) * (2 * placed.reach + 1);
            assert_true(candidates <= MOST_COPIES);
            for (int64_t dv = -3; dv <= 3; dv++)
                for (int64_t du = -3; du <= 3; du++) {
                    TexelCopy copy, near;
                    assert_true(own_copy(&placed, iu + du, iv + dv, &copy));
                    if (!covers(&copy, u, v)) continue;
                    bool listed = false;
                    for (int k = 0; k < candidates && !listed; k++)
                        listed = texel_copy_near(&placed, iu, iv, k, &near) && same_copy(&near, &copy);
                    assert_true(listed);
                    found++;
                }
            points++;
        }
        /* Copies have an area of scale² tiles, 1 + s²/12 on average: as many lie over a point. */
        double mean = (double)found / (double)points, expected = 1 + cases[c].scale * cases[c].scale / 12;
        assert_true(fabs(mean - expected) < .05);
    }
}

/* The way back from the tile to the copy is a similarity: no shear, the height goes with the scale, mirrors flip x. */
static void copies_keep_their_shape(void **state) {
    (void)state;
    PlacedTexel placed = placed_texel((InstanceJitter){.present = true, .displace = .9, .rotate = 360, .scale = .5, .mirror = true, .density = 1}, 1, 5);
    int mirrored = 0, turned[4] = {0};
    double least = 9, most = 0, widest = 0;
    enum { TILES = 4000 };
    for (int i = 0; i < TILES; i++) {
        TexelCopy c;
        assert_true(own_copy(&placed, i, 3 * i, &c));
        double det = c.xu * c.zv - c.xv * c.zu;
        assert_true(fabs(c.xu * c.zu + c.xv * c.zv) < 1e-12);
        assert_true(fabs(hypot(c.xu, c.xv) - c.inverse_scale) < 1e-12 && fabs(hypot(c.zu, c.zv) - c.inverse_scale) < 1e-12);
        mirrored += det < 0;
        least = fmin(least, 1 / c.inverse_scale), most = fmax(most, 1 / c.inverse_scale);
        turned[(c.zv > 0) + 2 * (c.zu > 0)]++;
        /* Its centre lies within displace / 2 of the tile's. */
        double bu = .5 - c.x0, bv = .5 - c.z0;
        double u = (bu * c.zv - bv * c.xv) / det - (i + .5), v = (c.xu * bv - c.zu * bu) / det - (3 * i + .5);
        widest = fmax(widest, fmax(fabs(u), fabs(v)));
    }
    assert_true(abs(mirrored - TILES / 2) < 4 * sqrt(TILES) / 2);
    for (int k = 0; k < 4; k++) assert_true(abs(turned[k] - TILES / 4) < 4 * sqrt(TILES * 3.0 / 16));
    assert_true(least >= .75 && least < .76 && most <= 1.25 && most > 1.24);
    assert_true(widest <= .45 + 1e-6 && widest > .44);
}

/* χ² of the number of copies in blocks of tiles, and of members of a family; 63 and 1 degrees of freedom. */
static void density_and_choice_keep_their_shares(void **state) {
    (void)state;
    static const double shares[] = {.05, .3, .5, .9};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(shares); i++) {
        for (int by_jitter = 0; by_jitter < 2; by_jitter++) {
            PlacedTexel placed = placed_texel((InstanceJitter){.present = by_jitter == 1, .density = by_jitter ? shares[i] : 1}, 0, 100 + i);
            if (!by_jitter) placed.density = shares[i];
            placed.family_size = 2;
            enum { BLOCKS = 64, SIDE = 40 };
            double chi = 0, kept_all = 0, first = 0;
            for (int b = 0; b < BLOCKS; b++) {
                double kept = 0, expected = shares[i] * SIDE * SIDE;
                for (int t = 0; t < SIDE * SIDE; t++) {
                    TexelCopy copy;
                    if (!own_copy(&placed, b % 8 * SIDE + t % SIDE, b / 8 * SIDE + t / SIDE, &copy)) continue;
                    kept++;
                    first += copy.texel == &one;
                }
                chi += (kept - expected) * (kept - expected) / (expected * (1 - shares[i]));
                kept_all += kept;
            }
            assert_true(chi > 30 && chi < 110); /* 64 degrees: 99.98 % between */
            assert_true(fabs(first - kept_all / 2) < 4 * sqrt(kept_all) / 2);
        }
    }
}

static void tiles_are_the_same_again(void **state) {
    (void)state;
    PlacedTexel placed = placed_texel((InstanceJitter){.present = true, .displace = .5, .rotate = 360, .scale = .5, .mirror = true, .density = .5,
                                                       .tinted = true, .tint_b = {1, .5, .25, 0, 0}}, 1, 9);
    PlacedTexel other = placed;
    other.seed = 10;
    int differ = 0;
    for (int i = 0; i < 500; i++)
        for (int k = 0; k < 9; k++) {
            TexelCopy a, b, c;
            memset(&a, 0, sizeof a), memset(&b, 1, sizeof b);
            bool in_a = texel_copy_near(&placed, i, -i, k, &a), in_b = texel_copy_near(&placed, i, -i, k, &b);
            assert_int_equal(in_a, in_b);
            if (!in_a) continue;
            assert_true(a.xu == b.xu && a.x0 == b.x0 && a.tint.x == b.tint.x && a.texel == b.texel);
            assert_true(a.tint.x >= 0 && a.tint.x <= 1 && fabsf(a.tint.y - .5f * a.tint.x) < 1e-6f);
            differ += !texel_copy_near(&other, i, -i, k, &c) || c.xu != a.xu;
        }
    assert_true(differ > 500);
}

/* Cyclic copies stay in place: across all tiles they make one pattern. */
static void cyclic_copies_are_never_moved(void **state) {
    (void)state;
    PlacedTexel placed = placed_texel((InstanceJitter){.present = true, .displace = .9, .rotate = 360, .scale = .5, .mirror = true, .density = .1}, 0, 9);
    placed.cyclic = true;
    for (int i = -50; i < 50; i++) {
        TexelCopy c;
        assert_true(texel_copy_near(&placed, i, 7 * i, 0, &c));
        assert_true(c.xu == 1 && c.zv == 1 && c.xv == 0 && c.zu == 0 && c.inverse_scale == 1);
        assert_true(c.x0 == -i && c.z0 == -7 * i && c.tint.x == 1);
    }
}

/* ∂(u, v, w)/∂world against differences of neighbouring points. */
static void gradients_are_derivatives(void **state) {
    (void)state;
    RandomStream r = {4};
    for (int i = 0; i < 300; i++) {
        SkinCell cell = {.triangle = i & 1};
        double n[60];
        for (int k = 0; k < 60; k++) n[k] = .3 * (2 * random_next_unit(&r) - 1);
        Vec3 foot[4] = {{n[0], n[1], n[2]}, {1 + n[3], n[4], n[5]}, {n[6], n[7], 1 + n[8]}, {n[9], n[10], n[11]}};
        Vec3 height[4] = {{n[12], 1 + n[13], n[14]}, {n[15], n[16], n[17]}, {n[18], n[19], n[20]}, {n[21], n[22], n[23]}};
        for (int k = 0; k < (cell.triangle ? 3 : 4); k++) {
            cell.foot.c[k] = foot[k], cell.height.c[k] = height[k];
            cell.u.c[k] = 5 * n[24 + k], cell.v.c[k] = 5 * n[28 + k], cell.w_foot.c[k] = n[32 + k], cell.w_tip.c[k] = 1 + n[36 + k];
        }
        SkinPoint p = {0, random_next_unit(&r) / 2, random_next_unit(&r) / 2, random_next_unit(&r)};
        Vec3 world = skin_cell_position(&cell, p.a, p.b, p.w, NULL);
        TexturePlace place = skin_texture_place(&cell, &p);
        for (int axis = 0; axis < 3; axis++) {
            const double d = 1e-5;
            Vec3 step = vec3(axis == 0 ? d : 0, axis == 1 ? d : 0, axis == 2 ? d : 0);
            SkinPoint hi = p, lo = p;
            if (!skin_cell_invert(&cell, vec3_add(world, step), 1e-9, &hi) || !skin_cell_invert(&cell, vec3_sub(world, step), 1e-9, &lo)) continue;
            TexturePlace a = skin_texture_place(&cell, &hi), b = skin_texture_place(&cell, &lo);
            double size = 1 + vec3_length(place.grad_u) + vec3_length(place.grad_v) + vec3_length(place.grad_w);
            if (size > 30) continue; /* nearly singular */
            assert_true(fabs((a.u - b.u) / (2 * d) - vec3_get(place.grad_u, axis)) < 1e-5 * size * size);
            assert_true(fabs((a.v - b.v) / (2 * d) - vec3_get(place.grad_v, axis)) < 1e-5 * size * size);
            assert_true(fabs((a.w - b.w) / (2 * d) - vec3_get(place.grad_w, axis)) < 1e-5 * size * size);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_copy_over_a_point_is_missed),       cmocka_unit_test(copies_keep_their_shape),
        cmocka_unit_test(density_and_choice_keep_their_shares), cmocka_unit_test(tiles_are_the_same_again),
        cmocka_unit_test(cyclic_copies_are_never_moved),        cmocka_unit_test(gradients_are_derivatives),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
