/* Layers of a texel among each other: what they hide together, and what light makes of what is seen of them. */
#include "texel/layer_views.h"
#include "texel/voxel_lit.h"

#include "base/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

enum { LEAVES = 400 };

typedef struct Foliage {
    Vec3f vertices[3 * LEAVES];
    uint32_t triangles[LEAVES][3];
} Foliage;

static float lot(int i, int k) { return random_unitf(random_hash((uint64_t)i, (uint64_t)k, 0, 5)); }

/* Triangles of size `size` around anywhere between two heights, turned by lot; `flat`: all level, and facing up. */
static TexelMesh grow(Foliage *f, float low, float high, float size, bool flat) {
    for (int i = 0; i < LEAVES; i++) {
        Vec3f at = {lot(i, 0), low + (high - low) * lot(i, 1), lot(i, 2)};
        for (int k = 0; k < 3; k++) {
            float rise = flat ? 0 : size * (lot(i, 3 + k) - 0.5f), turn = 2.1f * (float)k + 6.28f * lot(i, 7);
            f->vertices[3 * i + k] = vec3f(at.x + size / 2 * cosf(turn), float_clamp(at.y + rise, 0, 1), at.z + size / 2 * sinf(turn));
            f->triangles[i][k] = (uint32_t)(3 * i + k);
        }
    }
    return (TexelMesh){.vertices = f->vertices, .vertex_count = 3 * LEAVES, .triangles = (const uint32_t(*)[3])f->triangles, .triangle_count = LEAVES};
}

static VoxelLayer *build(const TexelMesh *mesh, LayerViews *views) {
    TexelBuildOptions options = {.resolution = 32, .extent = {1, 1, 1}, .cyclic = TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z, .views = views};
    VoxelLayer *layer = voxel_layer_build(mesh, &options, NULL);
    assert_non_null(layer);
    return layer;
}

/* Twice the same leaves hide what they hide once: each counts half. What has nothing to do with each other keeps what it has. */
static void what_hides_the_same_counts_once(void **state) {
    (void)state;
    Foliage *same = malloc(sizeof *same), *other = malloc(sizeof *other);
    LayerViews *views[2] = {malloc(sizeof(LayerViews)), malloc(sizeof(LayerViews))};
    const Vec3f directions[] = {{0, 1, 0}, {0.5f, 1, 0.2f}, {-1, 1, 1}};
    for (int apart = 0; apart < 2; apart++) {
        TexelMesh mesh = grow(same, 0.1f, 0.4f, 0.1f, false), second = apart ? grow(other, 0.6f, 0.9f, 0.1f, false) : mesh;
        for (size_t i = 0; apart && i < second.vertex_count; i++) other->vertices[i].x += 0.37f;
        VoxelLayer *layers[2] = {build(&mesh, views[0]), build(&second, views[1])}, *alone = build(&mesh, NULL);
        voxel_layers_join(layers, views, 2, vec3f(1, 1, 1), NULL);
        for (size_t d = 0; d < VTS_ARRAY_COUNT(directions); d++)
            for (float lod = 2; lod < 6; lod++) {
                double factor = (double)(voxel_layer_trim_at(layers[0], lod, directions[d]) / voxel_layer_trim_at(alone, lod, directions[d]));
                print_message("%s, direction %zu, level %g: %.3f\n", apart ? "apart" : "the same", d, (double)lod, factor);
                assert_true(apart ? factor > 0.85 && factor < 1.15 : fabs(factor - 0.5) < 0.03);
            }
        voxel_layer_destroy(layers[0]), voxel_layer_destroy(layers[1]), voxel_layer_destroy(alone);
    }
    free(same), free(other), free(views[0]), free(views[1]);
}

/* Under a roof of level leaves others stand on edge, of which little is seen from above: together voxels take them all for the normals that are seen. */
static void what_is_hidden_faces_nothing(void **state) {
    (void)state;
    Foliage *roof = malloc(sizeof *roof), *under = malloc(sizeof *under);
    LayerViews *views[2] = {malloc(sizeof(LayerViews)), malloc(sizeof(LayerViews))};
    TexelMesh level = grow(roof, 0.75f, 0.8f, 0.16f, true), edges = grow(under, 0.1f, 0.3f, 0.08f, false);
    for (int i = 0; i < LEAVES; i++) under->vertices[3 * i].y = float_min(0.74f, under->vertices[3 * i].y + 0.4f); /* needles that stand */
    VoxelLayer *layers[2] = {build(&level, views[0]), build(&edges, views[1])};
    voxel_layers_join(layers, views, 2, vec3f(1, 1, 1), NULL);
    const VoxelLayer *main = voxel_layer_is_paired(layers[0]) ? layers[0] : layers[1];
    assert_true(voxel_layer_is_paired(main));
    float high[2], low[2];
    voxel_layer_facing(main, 5, vec3f(0, 1, 0), vec3f(0.5f, 1, 0.3f), high); /* falls on the roof */
    voxel_layer_facing(main, 5, vec3f(0, 1, 0), vec3f(1, 0.15f, 0.3f), low); /* from the side */
    print_message("light from above %.3f, %.3f; from the side %.3f, %.3f\n", (double)high[0], (double)high[1], (double)low[0], (double)low[1]);
    assert_true(high[0] > 1.02f && low[0] < 0.98f && low[1] < 0.8f);
    voxel_layer_destroy(layers[0]), voxel_layer_destroy(layers[1]);
    free(roof), free(under), free(views[0]), free(views[1]);
}

static void odd_directions_are_harmless(void **state) {
    (void)state;
    static const Vec3f odd[] = {{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, {NAN, 1, 0}, {INFINITY, 1, 0}, {0, 1e-30f, 0}, {1e30f, 1e30f, 0}, {0, 1, 0}};
    Foliage *f = malloc(sizeof *f);
    TexelMesh mesh = grow(f, 0.1f, 0.9f, 0.1f, false);
    VoxelLayer *layer = build(&mesh, NULL);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(odd); i++)
        for (size_t k = 0; k < VTS_ARRAY_COUNT(odd); k++)
            for (float lod = -20; lod <= 20; lod += 4) {
                float factor[2];
                voxel_layer_facing(layer, lod, odd[i], odd[k], factor);
                assert_true(factor[0] > 0 && factor[0] <= 16 && factor[1] > 0 && factor[1] <= 16);
            }
    voxel_layer_destroy(layer);
    free(f);
}

/* Each node is the direction that is looked up there. */
static void nodes_are_where_they_are_looked_for(void **state) {
    (void)state;
    for (int node = 0; node < PAIR_NODES; node++) {
        PairPlace place;
        float at = 0;
        assert_true(pair_place(pair_direction(node), vec3f(0, 1, 0), &place));
        for (int i = 0; i < PAIR_CORNERS; i++)
            if (place.entry[i] / PAIR_NODES == node) at += place.weight[i];
        assert_true(at > 0.999f);
        int around[PAIR_MOST_NEIGHBOURS], count = pair_neighbours(node, around);
        assert_in_range(count, 3, PAIR_MOST_NEIGHBOURS);
        for (int i = 0; i < count; i++) assert_true(around[i] != node && around[i] >= 0 && around[i] < PAIR_NODES);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_hides_the_same_counts_once), cmocka_unit_test(what_is_hidden_faces_nothing), cmocka_unit_test(odd_directions_are_harmless),
                                       cmocka_unit_test(nodes_are_where_they_are_looked_for)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
