/* Colours of matter that are asked of the pigment once for each voxel: against the pigment itself. */
#include "skin_scenes.h"

#include "render/matter_color.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

static Vec3 foot(double u, double v) { return vec3(u, 0, v); }

/* A texel of unit size, full of leaves, whose colour changes from `to` in a corner to `from` at the distance 1. */
static void make(SkinScene *s, ColorMapEntry map[2], Color from, Color to) {
    skin_scene_begin(s);
    map[0] = (ColorMapEntry){.position = 0, .color = from};
    map[1] = (ColorMapEntry){.position = 1, .color = to};
    s->pigment.kind = PATTERN_SPHERICAL;
    s->pigment.entries = map;
    s->pigment.entry_count = 2;
    skin_scene_fill(s, 32, 4000, .03, 0, 5);
    skin_scene_grid(s, 1, 1, foot, NULL);
    skin_scene_compile(s);
}

static MatterHit hit_at(const SkinScene *s, Vec3f place, float lod) {
    const BuiltTexel *texel = s->compiled.texels[0];
    float side = texel->voxel * exp2f(lod);
    return (MatterHit){.matter = &texel->matter[0], .look = &texel->matter[0].look, .texel = texel, .place = place, .lod = lod, .width = 2 * side};
}

static float farthest(Vec3f a, Vec3f b) { return float_max(fabsf(a.x - b.x), float_max(fabsf(a.y - b.y), fabsf(a.z - b.z))); }

/* The largest difference from the pigment at the place itself, in voxels' worth of change. */
static void check(Color from, Color to, double change, double precision) {
    SkinScene s;
    ColorMapEntry map[2];
    make(&s, map, from, to);
    RandomStream r = {3};
    const Cone cone = {{0, 0, -5}, {0, 0, 1}, 0, 0.001};
    int differ = 0;
    for (int i = 0; i < 4000; i++) {
        float lod = (float)between(&r, 0, 3.4);
        Vec3f p = vec3f((float)random_next_unit(&r), (float)random_next_unit(&r), (float)random_next_unit(&r));
        MatterHit hit = hit_at(&s, p, lod);
        Vec3f first = matter_color(&hit, &cone, 5, .5f), again = matter_color(&hit, &cone, 5, .5f);
        Vec3f exact = look_color(hit.look, vec3_from_f(p), vec3(0, 0, 0), 0);
        double side = (double)hit.texel->voxel * exp2(round((double)lod)); /* a voxel that counts is at most one away along each axis */
        double most = lod < .5f ? 0 : 1.9 * side * change;
        assert_memory_equal(&first, &again, sizeof first);
        assert_true((double)farthest(first, exact) <= most + precision);
        differ += farthest(first, exact) > 0;
    }
    assert_true(differ > 1000); /* else nothing was kept */
    skin_scene_end(&s);
}

static void colors_of_voxels_are_those_of_the_pigment(void **state) {
    (void)state;
    check((Color){.red = 0.1, .green = 0.5, .blue = 0}, (Color){.red = 0.9, .green = 0.5, .blue = 0.2}, 0.8, 0.002);
    check((Color){.red = 0, .green = 0, .blue = 0}, (Color){.red = 2000, .green = 0.001, .blue = 0}, 2000, 4);
}

static void what_cannot_be_kept_is_asked_again(void **state) {
    (void)state;
    check((Color){.red = -1, .green = 0.5, .blue = 0}, (Color){.red = -0.1, .green = 0.5, .blue = 1e30}, 1e30, 1e27);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colors_of_voxels_are_those_of_the_pigment),
        cmocka_unit_test(what_cannot_be_kept_is_asked_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
