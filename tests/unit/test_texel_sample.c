/* Reading voxels: interpolation against brute force, wrapping, skipping. */
#include "texel_scenes.h"

#include "texel/voxel_layer.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static VoxelLayer *build(const TestMesh *mesh, int resolution, unsigned cyclic, Vec3f extent) {
    TexelMesh view = scene_view(mesh);
    TexelBuildOptions options = {.resolution = resolution, .extent = extent, .cyclic = cyclic};
    return voxel_layer_build(&view, &options, NULL);
}

/* A level as a plain array, x fastest; empty voxels have density 0. */
static VoxelSample *unpack_level(const VoxelLevel *level) {
    size_t n = (size_t)level->size[0] * (size_t)level->size[1] * (size_t)level->size[2];
    VoxelSample *dense = calloc(n, sizeof *dense);
    for (size_t b = 0; b < voxel_level_bricks(level); b++) {
        if (level->index[b] < 0) continue;
        const VoxelBrick *brick = &level->bricks[level->index[b]];
        size_t nx = (size_t)level->brick_size[0], ny = (size_t)level->brick_size[1];
        for (int z = 0; z < 8; z++) {
            const VoxelCode *code = level->codes + brick->first[z];
            for (int bit = 0; bit < 64; bit++) {
                if (!(brick->slice[z] >> bit & 1)) continue;
                size_t x = b % nx * 8 + (size_t)bit % 8, y = b / nx % ny * 8 + (size_t)bit / 8,
                       w = b / nx / ny * 8 + (size_t)z;
                assert_true(x < (size_t)level->size[0] && y < (size_t)level->size[1] &&
                            w < (size_t)level->size[2]);
                VoxelSample *v = &dense[(w * (size_t)level->size[1] + y) * (size_t)level->size[0] + x];
                voxel_code_unpack(*code++, v);
                v->density *= level->density_unit;
            }
        }
    }
    return dense;
}

typedef struct Sums {
    double density, gamma, s[6];
} Sums;

static void add_voxel(Sums *sums, const VoxelSample *v, double weight) {
    const double s[6] = {(double)v->s.xx, (double)v->s.yy, (double)v->s.zz,
                         (double)v->s.xy, (double)v->s.xz, (double)v->s.yz};
    double w = weight * (double)v->density;
    sums->density += w;
    sums->gamma += w * (double)v->gamma;
    for (int i = 0; i < 6; i++) sums->s[i] += w * s[i];
}

/* The definition: each voxel near enough, by the product of tents; on axes that are not cyclic nothing outside, and from the
 * outermost centres to the sides their values. */
static void brute_force(const VoxelLevel *level, const VoxelSample *dense, const bool cyclic[3], Vec3f p,
                        double factor, Sums *sums) {
    const float at[3] = {p.x, p.y, p.z};
    int first[3];
    double x[3];
    for (int k = 0; k < 3; k++) {
        x[k] = (double)(at[k] * level->per_side[k]);
        if (!cyclic[k]) {
            if (!(x[k] >= 0 && x[k] <= level->size[k])) return;
            x[k] = fmin(fmax(x[k], .5), level->size[k] - .5);
        }
        first[k] = (int)floor(x[k]) - 2;
    }
    for (int c = 0; c < 125; c++) {
        const int offset[3] = {c % 5, c / 5 % 5, c / 25};
        double weight = factor;
        size_t index = 0;
        for (int k = 2; k >= 0; k--) {
            int voxel = first[k] + offset[k], n = level->size[k];
            weight *= fmax(0, 1 - fabs(x[k] - .5 - voxel));
            if (cyclic[k]) voxel = ((voxel % n) + n) % n;
            if (voxel < 0 || voxel >= n) weight = 0, voxel = 0;
            index = index * (size_t)n + (size_t)voxel;
        }
        if (weight > 0) add_voxel(sums, &dense[index], weight);
    }
}

static void compare(const VoxelSample *got, bool found, const Sums *want) {
    assert_true(found == (got->density > 0));
    assert_true(fabs((double)got->density - want->density) <= 1e-4 * want->density + 1e-5);
    if (want->density < 1e-3) return; /* weights of rounding size */
    const double s[6] = {(double)got->s.xx, (double)got->s.yy, (double)got->s.zz,
                         (double)got->s.xy, (double)got->s.xz, (double)got->s.yz};
    assert_true(fabs((double)got->gamma - want->gamma / want->density) < 1e-3);
    for (int i = 0; i < 6; i++) assert_true(fabs(s[i] - want->s[i] / want->density) < 4e-3);
}

static Vec3f random_point(RandomStream *r, Vec3f extent, float margin) {
    float u[3];
    for (int k = 0; k < 3; k++) u[k] = (float)random_next_unit(r) * (1 + 2 * margin) - margin;
    return vec3f(u[0] * extent.x, u[1] * extent.y, u[2] * extent.z);
}

static void test_interpolation(void **state) {
    (void)state;
    TestMesh mesh = scene_leaves(150, .1, 21);
    const struct {
        int resolution;
        unsigned cyclic;
        Vec3f extent;
    } cases[] = {{32, 0, {1, 1, 1}},     {32, 5, {1, 1, 1}}, {16, 7, {1, .5f, .2f}},
                 {64, 2, {.1f, 1, .3f}}, {1, 7, {1, 1, 1}},  {2, 0, {1, 1, 1}}};
    RandomStream r = {22};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        VoxelLayer *layer = build(&mesh, cases[i].resolution, cases[i].cyclic, cases[i].extent);
        VoxelSample *dense[TEXEL_MAX_LEVELS];
        for (int level = 0; level < layer->levels; level++) dense[level] = unpack_level(&layer->level[level]);
        for (int n = 0; n < 6000; n++) {
            Vec3f p = random_point(&r, cases[i].extent, n % 4 ? 0 : .3f);
            float lod = (float)random_next_unit(&r) * (float)(layer->levels - 1);
            int level = (int)lod;
            VoxelSample v;
            Sums sums = {0};
            brute_force(&layer->level[level], dense[level], layer->cyclic, p, 1, &sums);
            bool found = voxel_layer_sample(layer, level, p, &v);
            compare(&v, found, &sums);
            if (level + 1 == layer->levels) continue;
            double t = (double)(lod - (float)level);
            Sums mixed = {0};
            brute_force(&layer->level[level], dense[level], layer->cyclic, p, 1 - t, &mixed);
            brute_force(&layer->level[level + 1], dense[level + 1], layer->cyclic, p, t, &mixed);
            found = voxel_layer_sample_lod(layer, lod, p, &v);
            compare(&v, found, &mixed);
        }
        for (int level = 0; level < layer->levels; level++) free(dense[level]);
        voxel_layer_destroy(layer);
    }
    scene_free(&mesh);
}

static void test_clamped_levels_and_strange_points(void **state) {
    (void)state;
    TestMesh mesh = scene_leaves(50, .1, 23);
    VoxelLayer *layer = build(&mesh, 16, 7, vec3f(1, 1, 1));
    const Vec3f p = {.4f, .5f, .6f};
    VoxelSample a, b;
    assert_true(voxel_layer_sample_lod(layer, -3, p, &a) == voxel_layer_sample(layer, 0, p, &b));
    assert_true(a.density == b.density);
    assert_true(voxel_layer_sample_lod(layer, 99, p, &a) && voxel_layer_sample(layer, 99, p, &b));
    assert_true(a.density == b.density);
    voxel_layer_sample_lod(layer, NAN, p, &a);
    assert_true(a.density >= 0);
    const float strange[] = {NAN, INFINITY, -INFINITY, 1e30f, -1e12f, 1e6f};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(strange); i++) {
        voxel_layer_sample(layer, 0, vec3f(strange[i], .5f, .5f), &a);
        assert_true(a.density >= 0 && isfinite(a.density));
        float skip = voxel_layer_skip(layer, 0, vec3f(strange[i], .5f, .5f), vec3f(1, 0, 0), .5f);
        assert_true(skip >= 0 && skip <= .5f);
    }
    voxel_layer_destroy(layer);
    scene_free(&mesh);
}

/* The same content moved by half the extent gives the same samples half the extent away, through the border too. */
static void test_wrapping_is_seamless(void **state) {
    (void)state;
    TestMesh mesh = scene_leaves(60, .125, 24), moved = scene_leaves(60, .125, 24);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        /* coarse coordinates, so that moving is exact */
        mesh.vertices[i].x = floorf(mesh.vertices[i].x * 4096) / 4096;
        moved.vertices[i] = vec3f_add(mesh.vertices[i], vec3f(.5f, 0, 0));
    }
    VoxelLayer *here = build(&mesh, 32, TEXEL_CYCLIC_X, vec3f(1, 1, 1)),
               *there = build(&moved, 32, TEXEL_CYCLIC_X, vec3f(1, 1, 1));
    RandomStream r = {25};
    int found = 0;
    for (int i = 0; i < 20000; i++) {
        Vec3f p = vec3f_from(scene_point(&r, 0));
        p.x = floorf(p.x * 4096) / 4096;
        Vec3f q = vec3f(p.x < .5f ? p.x + .5f : p.x - .5f, p.y, p.z);
        VoxelSample a, b;
        bool in_a = voxel_layer_sample_lod(here, 1.5f, p, &a),
             in_b = voxel_layer_sample_lod(there, 1.5f, q, &b);
        assert_true(in_a == in_b);
        assert_true(fabsf(a.density - b.density) <= .02f * a.density + 1e-4f);
        found += in_a;
        VoxelSample left, right;
        voxel_layer_sample(there, 0, vec3f(1e-6f, p.y, p.z), &left);
        voxel_layer_sample(there, 0, vec3f(1 - 1e-6f, p.y, p.z), &right);
        assert_true(fabsf(left.density - right.density) < .001f * left.density + .001f);
    }
    assert_true(found > 1000);
    voxel_layer_destroy(here);
    voxel_layer_destroy(there);
    scene_free(&mesh);
    scene_free(&moved);
}

static void test_skipping_is_conservative(void **state) {
    (void)state;
    TestMesh mesh = scene_leaves(12, .06, 26);
    const unsigned cyclic[] = {0, 5, 7};
    RandomStream r = {27};
    for (size_t c = 0; c < VTS_ARRAY_COUNT(cyclic); c++) {
        const Vec3f extent = c == 2 ? vec3f(1, .4f, .7f) : vec3f(1, 1, 1);
        VoxelLayer *layer = build(&mesh, 128, cyclic[c], extent);
        double skipped = 0, asked = 0;
        for (int i = 0; i < 8000; i++) {
            Vec3f p = random_point(&r, extent, 0), d = vec3f_from(scene_direction(&r));
            if (i % 5 == 0) d = vec3f(i % 2 ? 1.0f : -1.0f, 0, 0); /* along the grid */
            float lod = i % 3 ? (float)random_next_unit(&r) * 7.5f : (float)(i % 8),
                  limit = (float)random_next_unit(&r);
            float skip = voxel_layer_skip(layer, lod, p, d, limit);
            assert_true(skip >= 0 && skip <= limit);
            for (int k = 0; k <= 40; k++) {
                VoxelSample v;
                voxel_layer_sample_lod(layer, lod, vec3f_madd(p, d, skip * (float)k / 40), &v);
                if (skip > 0) assert_true(v.density < 1e-3f); /* at the end only what rounding lets in */
            }
            if (lod == 0) {
                skipped += (double)skip;
                asked += (double)limit;
            }
        }
        print_message("cyclic %u: skips %.0f %% of the way asked for at once\n", cyclic[c],
                      100 * skipped / asked);
        assert_true(skipped > .4 * asked);
        voxel_layer_destroy(layer);
    }
    scene_free(&mesh);
}

/* A march that skips sees what a march without skipping sees. */
static void test_march_with_skipping(void **state) {
    (void)state;
    TestMesh mesh = scene_leaves(40, .06, 28);
    VoxelLayer *layer = build(&mesh, 64, 0, vec3f(1, 1, 1));
    RandomStream r = {29};
    for (int i = 0; i < 300; i++) {
        Vec3f d = vec3f_from(scene_direction(&r)), p = random_point(&r, vec3f(1, 1, 1), 0);
        float lod = (float)random_next_unit(&r) * 3, step = .002f, end = 1;
        const float at[3] = {p.x, p.y, p.z}, along[3] = {d.x, d.y, d.z};
        for (int k = 0; k < 3; k++)
            end = float_min(end, along[k] > 0   ? (1 - at[k]) / along[k]
                                 : along[k] < 0 ? -at[k] / along[k]
                                                : 1);
        double plain = 0, skipping = 0;
        VoxelSample v;
        for (int k = 0; (float)k * step < end; k++)
            if (voxel_layer_sample_lod(layer, lod, vec3f_madd(p, d, (float)k * step), &v))
                plain += (double)v.density;
        for (int k = 0; (float)k * step < end; k++) {
            float t = (float)k * step, skip = voxel_layer_skip(layer, lod, vec3f_madd(p, d, t), d, end - t);
            k += (int)(skip / step);
            if (voxel_layer_sample_lod(layer, lod, vec3f_madd(p, d, (float)k * step), &v) &&
                (float)k * step < end)
                skipping += (double)v.density;
        }
        assert_true(fabs(plain - skipping) < 1e-3 * plain + 1e-2);
    }
    voxel_layer_destroy(layer);
    scene_free(&mesh);
}

/* The weight with which interpolation at x, in voxels, reads the voxel. */
static double tent(double x, int voxel, int n, bool cyclic) {
    if (!cyclic) x = fmin(fmax(x, .5), n - .5);
    double away = fabs(x - .5 - voxel);
    return fmax(0, 1 - (cyclic ? fmin(away, n - away) : away));
}

static void test_nearest_is_what_counts_most(void **state) {
    (void)state;
    TestMesh mesh = scene_leaves(40, .06, 8);
    RandomStream random = {8};
    VoxelLayer *layer = build(&mesh, 32, TEXEL_CYCLIC_X, vec3f(1, .5f, 1));
    int found = 0;
    for (int i = 0; i < 4000; i++) {
        int level = i % layer->levels;
        const VoxelLevel *l = &layer->level[level];
        Vec3f p = vec3f((float)random_next_unit(&random), .5f * (float)random_next_unit(&random), (float)random_next_unit(&random)), middle;
        const float at[3] = {p.x, p.y, p.z};
        uint32_t voxel = UINT32_MAX, best = UINT32_MAX;
        double most = 0;
        int place[3] = {0, 0, 0};
        for (size_t b = 0; b < voxel_level_bricks(l); b++)
            for (int z = 0; l->index[b] >= 0 && z < 8; z++) {
                const VoxelBrick *brick = &l->bricks[l->index[b]];
                uint32_t number = brick->first[z];
                for (int bit = 0; bit < 64; bit++) {
                    if (!(brick->slice[z] >> bit & 1)) continue;
                    int nx = l->brick_size[0], ny = l->brick_size[1];
                    const int v[3] = {(int)b % nx * 8 + bit % 8, (int)b / nx % ny * 8 + bit / 8, (int)b / nx / ny * 8 + z};
                    double weight = 1;
                    for (int k = 0; k < 3; k++) weight *= tent((double)(at[k] * l->per_side[k]), v[k], l->size[k], layer->cyclic[k]);
                    if (weight > most) most = weight, best = number, memcpy(place, v, sizeof v);
                    number++;
                }
            }
        bool any = voxel_layer_nearest(layer, level, p, &voxel, &middle);
        if (fabs(most) < 1e-5) continue; /* a hair's weight is rounding */
        assert_true(any);
        found++;
        const float m[3] = {middle.x, middle.y, middle.z};
        double weight = 1;
        for (int k = 0; k < 3; k++) {
            int v = (int)(m[k] * l->per_side[k]);
            assert_true(fabsf(m[k] * l->per_side[k] - (float)v - .5f) < 1e-3f);
            weight *= tent((double)(at[k] * l->per_side[k]), v, l->size[k], layer->cyclic[k]);
        }
        assert_true(weight > most - 1e-4);
        assert_true(voxel < l->code_count);
        if (voxel == best)
            for (int k = 0; k < 3; k++) assert_int_equal((int)(m[k] * l->per_side[k]), place[k]);
        else assert_true(weight < most + 1e-4); /* two count the same */
    }
    assert_true(found > 400);
    voxel_layer_destroy(layer);
    scene_free(&mesh);
}

/* Levels that are taken apart read as they did, to the bit, also beyond their sides. */
static void test_unpacked_reads_the_same(void **state) {
    (void)state;
    enum { PLACES = 20000 };
    TestMesh mesh = scene_leaves(40, .06, 8);
    static VoxelSample before[PLACES], after;
    static bool was[PLACES];
    const unsigned cyclic[] = {0, TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z, TEXEL_CYCLIC_Y};
    int found = 0, unpacked = 0;
    for (int kind = 0; kind < 3; kind++) {
        VoxelLayer *layer = build(&mesh, 64, cyclic[kind], vec3f(1, .5f, 1));
        for (int pass = 0; pass < 2; pass++) {
            RandomStream random = {(uint64_t)kind};
            if (pass) voxel_layer_unpack(layer);
            for (int i = 0; i < PLACES; i++) {
                Vec3f p = {(float)(1.4 * random_next_unit(&random) - .2), (float)(.8 * random_next_unit(&random) - .15), (float)(1.4 * random_next_unit(&random) - .2)};
                if (i % 50 == 0) p = vec3f((float)(i / 50 % 2), (float)(i / 100 % 2) * .5f, (float)(i / 200 % 2));
                const float lod = (float)(7 * random_next_unit(&random));
                VoxelSample *v = pass ? &after : &before[i];
                const bool any = voxel_layer_sample_lod(layer, lod, p, v);
                if (!pass) {
                    was[i] = any;
                    continue;
                }
                assert_int_equal(any, was[i]);
                assert_memory_equal(v, &before[i], sizeof *v);
                found += any;
            }
        }
        for (int level = 0; level < layer->levels; level++) unpacked += layer->level[level].plain != NULL;
        voxel_layer_pack(layer);
        for (int level = 0; level < layer->levels; level++) assert_null(layer->level[level].plain);
        voxel_layer_destroy(layer);
    }
    assert_true(found > PLACES / 4 && unpacked >= 3 * 6);
    scene_free(&mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_interpolation),        cmocka_unit_test(test_clamped_levels_and_strange_points),
        cmocka_unit_test(test_wrapping_is_seamless), cmocka_unit_test(test_skipping_is_conservative),
        cmocka_unit_test(test_march_with_skipping), cmocka_unit_test(test_nearest_is_what_counts_most),
        cmocka_unit_test(test_unpacked_reads_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
