/* Normals at the corners of triangles: packing against the vectors themselves, and which triangles are flat. */
#include "base/random.h"
#include "texel/facet_normals.h"
#include "texel_scenes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

static void packing_keeps_directions(void **state) {
    (void)state;
    RandomStream r = {17};
    double worst = 0;
    for (int i = 0; i < 20000; i++) {
        Vec3f n[3];
        for (int k = 0; k < 3; k++) n[k] = vec3f_from(scene_direction(&r));
        if (i < 6) n[0] = vec3f(i == 0 ? 1 : i == 1 ? -1 : 0, i == 2 ? 1 : i == 3 ? -1 : 0, i == 4 ? 1 : i == 5 ? -1 : 0);
        FacetNormals packed = facet_normals_pack(n);
        for (int k = 0; k < 3; k++) worst = fmax(worst, (double)vec3f_length(vec3f_sub(facet_normals_at(&packed, k == 1, k == 2), n[k])));
        Vec3f middle = facet_normals_at(&packed, 0.25f, 0.5f), wanted = vec3f_madd(vec3f_madd(vec3f_scale(n[0], 0.25f), n[1], 0.25f), n[2], 0.5f);
        worst = fmax(worst, (double)vec3f_length(vec3f_sub(middle, wanted)));
    }
    print_message("directions are kept to %.1e\n", worst);
    assert_true(worst < 1e-4);
}

static void zero_stays_zero(void **state) {
    (void)state;
    const Vec3f none[3] = {{0, 0, 0}, {NAN, 0, 1}, {0, INFINITY, 0}};
    FacetNormals packed = facet_normals_pack(none);
    Vec3f at = facet_normals_at(&packed, 0.3f, 0.3f);
    assert_true(at.x == 0 && at.y == 0 && at.z == 0);
}

static void flat_triangles_are_told(void **state) {
    (void)state;
    const Vec3f vertices[3] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
    const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 1, 9}};
    Vec3f normals[3] = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}}, out[3];
    TexelMesh mesh = {vertices, triangles, 3, 2, NULL, NULL};
    assert_false(facet_normals_of(&mesh, 0, out)); /* none */
    mesh.normals = normals;
    assert_false(facet_normals_of(&mesh, 0, out)); /* its own */
    normals[2] = vec3f(0.6f, 0.8f, 0);
    assert_true(facet_normals_of(&mesh, 0, out));
    assert_true(out[2].x == 0.6f && out[0].y == 1);
    assert_false(facet_normals_of(&mesh, 1, out)); /* a corner that is not there */
    normals[1] = vec3f(0, 0, 0);
    assert_false(facet_normals_of(&mesh, 0, out)); /* one that is not known */
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(packing_keeps_directions), cmocka_unit_test(zero_stays_zero),
                                       cmocka_unit_test(flat_triangles_are_told)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
