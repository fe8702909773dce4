/* Files of meshes: what is read of them, and that damaged ones are refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"
#include "shape/mesh_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct Reading {
    Arena arena;
    MemoryBudget budget;
    char folder[64], path[128];
    MeshFile file;
    StrBuf error;
    bool ok;
} Reading;

static void begin(Reading *r) {
    *r = (Reading){0};
    strcpy(r->folder, "/tmp/vts_mesh_XXXXXX");
    assert_non_null(mkdtemp(r->folder));
}

static void write_file(Reading *r, const char *name, const void *data, size_t size) {
    snprintf(r->path, sizeof r->path, "%s/%s", r->folder, name);
    FILE *f = fopen(r->path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(data, 1, size, f), size);
    fclose(f);
}

static void remove_file(Reading *r, const char *name) {
    char path[128];
    snprintf(path, sizeof path, "%s/%s", r->folder, name);
    remove(path);
}

static void read_with(Reading *r, MeshFileOptions options) {
    arena_init(&r->arena, &r->budget, 0);
    r->ok = mesh_file_read(r->path, &options, &r->arena, &r->file, &r->error);
}

static void done_reading(Reading *r) {
    arena_destroy(&r->arena);
    assert_int_equal(r->budget.used, 0);
    strbuf_free(&r->error);
}

static void end(Reading *r) {
    remove(r->path);
    assert_int_equal(rmdir(r->folder), 0);
}

static void read_text(Reading *r, const char *name, const char *text, MeshFileOptions options) {
    begin(r);
    write_file(r, name, text, strlen(text));
    read_with(r, options);
}

static void finish(Reading *r) {
    done_reading(r);
    end(r);
}

/* A cube of quads; each corner is written three times, as exporters do. */
static void cube_text(StrBuf *out) {
    static const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int f = 0; f < 6; f++)
        for (int k = 0; k < 4; k++)
            strbuf_addf(out, "v %d %d %d\n", faces[f][k] & 1, faces[f][k] >> 1 & 1, faces[f][k] >> 2);
    for (int f = 0; f < 6; f++) strbuf_addf(out, "f %d %d %d %d\n", 4 * f + 1, 4 * f + 2, 4 * f + 3, 4 * f + 4);
}

static void equal_points_become_one(void **state) {
    (void)state;
    StrBuf text = {0};
    Reading r;
    cube_text(&text);
    read_text(&r, "cube.obj", text.data, (MeshFileOptions){0});
    assert_true(r.ok);
    assert_int_equal(r.file.part_count, 1);
    assert_int_equal(r.file.parts[0].mesh->vertex_count, 8);
    assert_int_equal(r.file.parts[0].mesh->triangle_count, 12);
    assert_null(r.file.parts[0].mesh->normals);
    assert_false(r.file.parts[0].colored);
    finish(&r);
    strbuf_free(&text);
}

/* At a cube's corner three right angles meet, however its faces are cut: the normal is the diagonal. */
static void smooth_normals_weigh_angles(void **state) {
    (void)state;
    StrBuf text = {0};
    Reading r;
    cube_text(&text);
    read_text(&r, "cube.obj", text.data, (MeshFileOptions){.smooth = true});
    assert_true(r.ok);
    const MeshData *m = r.file.parts[0].mesh;
    assert_int_equal(m->normal_count, 8);
    for (size_t i = 0; i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            Vec3 outward = vec3_normalize(vec3_sub(m->vertices[m->triangles[i][k]], vec3_splat(0.5)));
            assert_true(fabs(vec3_dot(outward, m->normals[m->normal_triangles[i][k]])) > 1 - 1e-12);
        }
    finish(&r);
    strbuf_free(&text);
}

static void normals_and_uvs_are_the_files(void **state) {
    (void)state;
    Reading r;
    read_text(&r, "t.obj",
              "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 -2\nvt 0.25 0.5\nvt 1 0\nvt 0 1\n"
              "f 1/1/1 2/2/1 3/3/1\nf 2/3/1 4/2/1 3/1/1\n",
              (MeshFileOptions){0});
    assert_true(r.ok);
    const MeshData *m = r.file.parts[0].mesh;
    assert_int_equal(m->vertex_count, 4);
    assert_int_equal(m->normal_count, 1);
    assert_true(m->normals[0].z == -1);
    assert_int_equal(m->uv_count, 3);
    assert_true(m->uvs[m->uv_triangles[0][0]].x == 0.25 && m->uvs[m->uv_triangles[0][0]].y == 0.5);
    assert_true(m->uvs[m->uv_triangles[1][0]].x == 0 && m->uvs[m->uv_triangles[1][0]].y == 1);
    finish(&r);
}

static const char two_colors[] = "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\nusemtl a\nf 1 4 2\n";
static const char materials[] = "newmtl a\nKd 0.5 0.25 0\nnewmtl b\nKd 0 0 1\nd 0.25\n";

static void colors_make_parts(void **state) {
    (void)state;
    for (int by_color = 0; by_color < 2; by_color++) {
        Reading r;
        begin(&r);
        write_file(&r, "two.mtl", materials, strlen(materials));
        write_file(&r, "two.obj", two_colors, strlen(two_colors));
        read_with(&r, (MeshFileOptions){.by_color = by_color});
        assert_true(r.ok);
        assert_int_equal(r.file.part_count, by_color ? 2 : 1);
        assert_int_equal(r.file.parts[0].mesh->triangle_count, by_color ? 2 : 3);
        if (by_color) {
            assert_true(r.file.parts[0].color.red == 0.5 && r.file.parts[0].color.green == 0.25);
            assert_true(r.file.parts[1].color.blue == 1 && r.file.parts[1].color.transmit == 0.75);
        }
        remove_file(&r, "two.mtl");
        finish(&r);
    }
}

/* A file may not make us read what lies elsewhere. */
static void named_files_stay_in_the_folder(void **state) {
    (void)state;
    Reading r;
    begin(&r);
    char text[256], secret[] = "/tmp/vts_mesh_secret_XXXXXX";
    int other = mkstemp(secret);
    assert_true(other >= 0 && write(other, materials, strlen(materials)) > 0);
    close(other);
    snprintf(text, sizeof text, "mtllib %s\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n", secret);
    write_file(&r, "a.obj", text, strlen(text));
    read_with(&r, (MeshFileOptions){.by_color = true});
    assert_true(r.ok);
    assert_false(r.file.parts[0].colored && r.file.parts[0].color.red == 0.5);
    remove(secret);
    finish(&r);
}

static size_t binary_ply(unsigned char *out) {
    static const float corners[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}};
    static const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    size_t n = (size_t)sprintf((char *)out, "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                                            "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n");
    memcpy(out + n, corners, sizeof corners);
    n += sizeof corners;
    for (int f = 0; f < 4; f++) {
        out[n++] = 3;
        memcpy(out + n, faces[f], sizeof faces[f]);
        n += sizeof faces[f];
    }
    return n;
}

static void reads_binary_ply(void **state) {
    (void)state;
    unsigned char bytes[1024];
    Reading r;
    begin(&r);
    write_file(&r, "t.ply", bytes, binary_ply(bytes));
    read_with(&r, (MeshFileOptions){0});
    assert_true(r.ok);
    double volume = 0;
    const MeshData *m = r.file.parts[0].mesh;
    for (size_t i = 0; i < m->triangle_count; i++)
        volume += vec3_dot(m->vertices[m->triangles[i][0]],
                           vec3_cross(m->vertices[m->triangles[i][1]], m->vertices[m->triangles[i][2]])) / 6;
    assert_true(fabs(fabs(volume) - 4) < 1e-12);
    assert_false(r.file.parts[0].colored);
    finish(&r);
}

static char base64_digit(unsigned value) {
    return "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"[value & 63];
}

/* One triangle at two nodes, the second of which mirrors and moves it. */
static void gltf_text(StrBuf *out) {
    struct {
        float corners[3][3];
        uint16_t indices[4];
    } data = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2, 0}};
    const unsigned char *bytes = (const unsigned char *)&data;
    strbuf_adds(out, "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"mesh\":0,"
                     "\"translation\":[0,0,5],\"scale\":[-2,1,1]}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
                     "\"indices\":1}]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":6}],"
                     "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]},"
                     "{\"bufferView\":1,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"}],"
                     "\"buffers\":[{\"byteLength\":44,\"uri\":\"data:application/octet-stream;base64,");
    for (size_t i = 0; i < sizeof data; i += 3) {
        unsigned left = (unsigned)(sizeof data - i), b = (unsigned)bytes[i] << 16;
        if (left > 1) b |= (unsigned)bytes[i + 1] << 8;
        if (left > 2) b |= bytes[i + 2];
        strbuf_addc(out, base64_digit(b >> 18));
        strbuf_addc(out, base64_digit(b >> 12));
        strbuf_addc(out, left > 1 ? base64_digit(b >> 6) : '=');
        strbuf_addc(out, left > 2 ? base64_digit(b) : '=');
    }
    strbuf_adds(out, "\"}]}");
}

static void reads_gltf_with_its_nodes(void **state) {
    (void)state;
    StrBuf text = {0};
    Reading r;
    gltf_text(&text);
    read_text(&r, "t.gltf", text.data, (MeshFileOptions){0});
    assert_true(r.ok);
    const MeshData *m = r.file.parts[0].mesh;
    assert_int_equal(m->triangle_count, 2);
    assert_int_equal(m->vertex_count, 6);
    for (size_t i = 0; i < 2; i++) { /* mirrored or not, the front is the same */
        Vec3 area = vec3_cross(vec3_sub(m->vertices[m->triangles[i][1]], m->vertices[m->triangles[i][0]]),
                               vec3_sub(m->vertices[m->triangles[i][2]], m->vertices[m->triangles[i][0]]));
        assert_true(area.z == (m->vertices[m->triangles[i][0]].z > 0 ? 2 : 1));
    }
    finish(&r);
    strbuf_free(&text);
}

static void bad_files_are_refused(void **state) {
    (void)state;
    static const struct {
        const char *name, *text;
    } bad[] = {{"empty.obj", ""},
               {"words.obj", "this is no mesh, but it is longer than nothing at all"},
               {"points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n# no face at all here\n"},
               {"index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"},
               {"nan.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n"},
               {"flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"},
               {"head.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\n"}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(bad); i++) {
        Reading r;
        read_text(&r, bad[i].name, bad[i].text, (MeshFileOptions){.smooth = true, .by_color = true});
        assert_false(r.ok);
        assert_true(r.error.size > 0);
        finish(&r);
    }
}

static void large_files_are_refused(void **state) {
    (void)state;
    StrBuf text = {0};
    Reading r;
    cube_text(&text);
    read_text(&r, "cube.obj", text.data, (MeshFileOptions){.most_vertices = 23});
    assert_false(r.ok);
    assert_non_null(strstr(r.error.data, "24 vertices"));
    done_reading(&r);
    r.error = (StrBuf){0};
    r.budget.limit = 200;
    read_with(&r, (MeshFileOptions){0});
    assert_false(r.ok);
    assert_non_null(strstr(r.error.data, "memory"));
    finish(&r);
    strbuf_free(&text);
}

/* Whatever becomes of the reader, we go on; what it gives us is a mesh or a refusal. */
static void damage_does_no_harm(void **state) {
    (void)state;
    unsigned char good[1024], bad[1024];
    size_t size = binary_ply(good);
    RandomStream random = {7};
    Reading r;
    begin(&r);
    for (int i = 0; i < 24; i++) {
        memcpy(bad, good, size);
        for (uint64_t k = 0; k < 1 + (uint64_t)i % 4; k++) bad[random_next(&random) % size] ^= (unsigned char)(1u << random_next(&random) % 8);
        write_file(&r, "t.ply", bad, i % 3 ? size : random_next(&random) % size);
        read_with(&r, (MeshFileOptions){.most_vertices = 1000, .smooth = i % 2});
        assert_true(r.ok || r.error.size > 0);
        for (size_t p = 0; r.ok && p < r.file.part_count; p++)
            for (size_t t = 0; t < r.file.parts[p].mesh->triangle_count; t++)
                for (int k = 0; k < 3; k++)
                    assert_true(r.file.parts[p].mesh->triangles[t][k] < r.file.parts[p].mesh->vertex_count);
        done_reading(&r);
        r.error = (StrBuf){0};
    }
    end(&r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_points_become_one),  cmocka_unit_test(smooth_normals_weigh_angles),
        cmocka_unit_test(normals_and_uvs_are_the_files), cmocka_unit_test(colors_make_parts),
        cmocka_unit_test(named_files_stay_in_the_folder), cmocka_unit_test(reads_binary_ply),
        cmocka_unit_test(reads_gltf_with_its_nodes), cmocka_unit_test(bad_files_are_refused),
        cmocka_unit_test(large_files_are_refused),  cmocka_unit_test(damage_does_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
