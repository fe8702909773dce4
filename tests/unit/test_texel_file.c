/* Texels as files: what is written comes back to the bit, and whatever was altered is refused. */
#include "texel_scenes.h"

#include "base/random.h"
#include "texel/texel_format.h"
#include "texel/voxel_layer.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

#ifndef CASES
#define CASES 3000
#endif

static VoxelLayer *build(TestMesh mesh, int resolution, unsigned cyclic, Vec3f extent, MemoryBudget *memory) {
    TexelMesh view = scene_view(&mesh);
    TexelBuildOptions options = {
        .resolution = resolution, .extent = extent, .cyclic = cyclic, .memory = memory};
    VoxelLayer *layer = voxel_layer_build(&view, &options, NULL);
    scene_free(&mesh);
    return layer;
}

/* Leaves and grass in a box that is no cube. */
static TexelFile meadow(int resolution, unsigned cyclic) {
    Box3 bounds = {{-1, 0, 2}, {1, 1, 3.5}};
    Vec3f extent = vec3f(1, .5f, .75f);
    TexelFile file = {
        .bounds = bounds, .asked = resolution, .built = resolution, .cyclic = cyclic, .layer_count = 2};
    file.name = calloc(1, 7);
    memcpy(file.name, "Meadow", 7);
    file.layers = calloc(2, sizeof *file.layers);
    for (size_t i = 0; i < 2; i++) {
        TexelFileLayer *layer = &file.layers[i];
        double *numbers[LOOK_NUMBERS];
        look_numbers(layer, numbers);
        for (size_t k = 0; k < LOOK_NUMBERS - 1; k++) *numbers[k] = 0.125 * (double)k + (double)i;
        layer->finish.fresnel = layer->averaged = i == 1;
        layer->voxels = build(i ? scene_grass(40, .4, .02, 3) : scene_leaves(60, .05, 2), resolution, cyclic,
                              extent, NULL);
        assert_non_null(layer->voxels);
    }
    return file;
}

typedef struct Bytes {
    unsigned char *data;
    size_t size;
} Bytes;

static Bytes encode(const TexelFile *file) {
    Bytes b = {0};
    b.data = texel_file_encode(file, &b.size);
    assert_non_null(b.data);
    return b;
}

static TexelFileStatus decode(Bytes b, TexelFile *out, StrBuf *error) {
    return texel_file_decode(b.data, b.size, NULL, out, error);
}

static void test_what_is_written_comes_back(void **state) {
    (void)state;
    static const int resolutions[] = {1, 4, 8, 32, 64};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(resolutions); i++) {
        TexelFile file = meadow(resolutions[i], i % 2 ? TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z : 0), back;
        file.key = (Hash128){17, 42};
        file.layers[1].voxels->filtering = TEXEL_FILTER_PUBLISHED;
        Bytes bytes = encode(&file);
        assert_int_equal(decode(bytes, &back, NULL), TEXEL_FILE_OK);
        assert_string_equal(back.name, "Meadow");
        assert_int_equal(back.layers[0].voxels->filtering, TEXEL_FILTER_LINEAR);
        assert_int_equal(back.layers[1].voxels->filtering, TEXEL_FILTER_PUBLISHED);
        assert_memory_equal(&back.bounds, &file.bounds, sizeof back.bounds);
        assert_int_equal(back.asked, file.asked);
        assert_int_equal(back.built, file.built);
        assert_int_equal(back.cyclic, file.cyclic);
        assert_true(hash_equal(back.key, file.key));
        assert_int_equal(back.layer_count, 2);
        for (size_t k = 0; k < 2; k++) {
            assert_true(
                hash_equal(voxel_layer_hash(back.layers[k].voxels), voxel_layer_hash(file.layers[k].voxels)));
            assert_int_equal(voxel_layer_bytes(back.layers[k].voxels),
                             voxel_layer_bytes(file.layers[k].voxels));
            assert_memory_equal(&back.layers[k].color, &file.layers[k].color, sizeof(Color));
            assert_true(back.layers[k].finish.metallic == file.layers[k].finish.metallic);
            assert_true(back.layers[k].finish.reflection_max.transmit ==
                        file.layers[k].finish.reflection_max.transmit);
            assert_int_equal(back.layers[k].finish.fresnel, k == 1);
            assert_int_equal(back.layers[k].averaged, k == 1);
        }
        Bytes again = encode(&back);
        assert_int_equal(again.size, bytes.size);
        assert_memory_equal(again.data, bytes.data, bytes.size);
        free(bytes.data), free(again.data);
        texel_file_release(&file), texel_file_release(&back);
    }
}

/* Looks at all of a texel that a file with right checksums but hostile content gave. */
static void use(const TexelFile *file, RandomStream *random) {
    for (size_t i = 0; i < file->layer_count; i++)
        for (int k = 0; k < 20; k++) {
            VoxelSample sample;
            Vec3f p = vec3f_from(scene_point(random, 0)), d = vec3f_from(scene_direction(random));
            float lod = (float)(random_next_unit(random) * 7);
            voxel_layer_sample_lod(file->layers[i].voxels, lod, p, &sample);
            voxel_layer_skip(file->layers[i].voxels, lod, p, d, 2);
        }
}

/* Makes all checksums right again where the table can be read at all. */
static void sign(Bytes b) {
    FormatHeader header;
    if (b.size < sizeof header) return;
    memcpy(&header, b.data, sizeof header);
    header.file_size = b.size;
    size_t room = (b.size - sizeof header) / sizeof(FormatSection);
    if (header.section_count > room) header.section_count = (uint32_t)room;
    for (size_t i = 0; i < header.section_count; i++) {
        FormatSection section;
        unsigned char *at = b.data + sizeof header + i * sizeof section;
        memcpy(&section, at, sizeof section);
        if (section.offset > b.size || section.size > b.size - section.offset) continue;
        section.checksum = format_checksum(b.data + section.offset, (size_t)section.size);
        memcpy(at, &section, sizeof section);
    }
    header.checksum =
        format_header_checksum(&header, b.data + sizeof header, header.section_count * sizeof(FormatSection));
    memcpy(b.data, &header, sizeof header);
}

static void test_altered_files_are_refused(void **state) {
    (void)state;
    RandomStream random = {5};
    TexelFile file = meadow(16, TEXEL_CYCLIC_X), back;
    Bytes whole = encode(&file);
    for (int i = 0; i < CASES; i++) {
        Bytes b = {malloc(whole.size), whole.size};
        memcpy(b.data, whole.data, whole.size);
        if (i % 3 == 0) b.size = random_next(&random) % whole.size;
        if (i % 3 != 0)
            for (uint64_t flips = 1 + random_next(&random) % 3; flips; flips--)
                b.data[random_next(&random) % b.size] ^= (unsigned char)(1u << random_next(&random) % 8);
        StrBuf error = {0};
        bool same =
            b.size == whole.size && memcmp(b.data, whole.data, whole.size) == 0; /* a bit turned twice */
        /* Exactly as long as the file, so that a sanitizer sees what reads past it. */
        Bytes exact = {malloc(b.size ? b.size : 1), b.size};
        memcpy(exact.data, b.data, b.size);
        assert_int_equal(decode(exact, &back, &error), same ? TEXEL_FILE_OK : TEXEL_FILE_REFUSED);
        assert_true(same || error.size > 10);
        texel_file_release(&back);
        strbuf_free(&error);
        free(exact.data), free(b.data);
    }
    free(whole.data);
    texel_file_release(&file);
}

/* An attacker knows the checksum: then every index and size has to be checked for itself, and memory stays in proportion. */
static void test_hostile_files_do_no_harm(void **state) {
    (void)state;
    RandomStream random = {6};
    TexelFile file = meadow(16, TEXEL_CYCLIC_Z), back;
    Bytes whole = encode(&file);
    size_t header_end = sizeof(FormatHeader) + (1 + 2 * (1 + SECTIONS_PER_LEVEL * 5)) * sizeof(FormatSection),
           accepted = 0;
    for (int i = 0; i < CASES; i++) {
        Bytes b = {malloc(whole.size), whole.size};
        memcpy(b.data, whole.data, whole.size);
        if (i % 8 == 0) b.size = random_next(&random) % whole.size;
        for (uint64_t changes = 1 + random_next(&random) % 4; b.size && changes; changes--) {
            size_t at = random_next(&random) % (i % 2 ? size_min(b.size, header_end + 400) : b.size);
            static const uint32_t words[] = {0, 1, 7, 0x7fffffff, 0x80000000u, 0xffffffffu, 1024, 65535};
            uint32_t word = words[random_next(&random) % VTS_ARRAY_COUNT(words)];
            if (at + 4 <= b.size && random_next(&random) % 2)
                memcpy(b.data + at / 4 * 4, &word, 4);
            else
                b.data[at] ^= (unsigned char)(1u << random_next(&random) % 8);
        }
        sign(b);
        MemoryBudget memory = {.limit = 80 * b.size + 65536};
        TexelFileStatus status = texel_file_decode(b.data, b.size, &memory, &back, NULL);
        assert_int_not_equal(status, TEXEL_FILE_NO_MEMORY);
        if (status == TEXEL_FILE_OK) use(&back, &random), accepted++;
        texel_file_release(&back);
        assert_int_equal(memory.used, 0);
        free(b.data);
    }
    assert_true(accepted > CASES / 100); /* voxels and looks may be anything */
    free(whole.data);
    texel_file_release(&file);
}

static void overwrite(Bytes b, size_t section, size_t offset, uint32_t value) {
    FormatSection s;
    memcpy(&s, b.data + sizeof(FormatHeader) + section * sizeof s, sizeof s);
    memcpy(b.data + s.offset + offset, &value, sizeof value);
    sign(b);
}

static void test_refusals_name_what_is_wrong(void **state) {
    (void)state;
    static const struct {
        size_t section, offset;
        uint32_t value;
        const char *says;
    } cases[] = {
        {0, offsetof(FormatTexel, built), 0, "no valid resolution"},
        {0, offsetof(FormatTexel, built), 32, "other sizes than its bounds"},
        {0, offsetof(FormatTexel, cyclic), 9, "cyclic axes"},
        {0, offsetof(FormatTexel, layer_count), 0, "number of layers"},
        {0, offsetof(FormatTexel, layer_count), 3, "the look of layer 2 is missing"},
        {0, offsetof(FormatTexel, layer_count), 1, "more in it"},
        {0, offsetof(FormatTexel, name_size), 5, "a name that does not fit"},
        {0, offsetof(FormatTexel, bounds) + 28, 0x7ff00000, "bounds without a volume"},
        {1, offsetof(FormatLook, numbers) + 4, 0x7ff00000, "the look of layer 0 holds what is not a number"},
        {2, 0, 99, "does not fit the index"},
        {2, 4, 0, "does not fit the index"},
        {9, 0, 0xffffffff, "voxels outside of the texel"},
    };
    TexelFile file = meadow(16, 0), back;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        Bytes b = encode(&file);
        StrBuf error = {0};
        overwrite(b, cases[i].section, cases[i].offset, cases[i].value);
        assert_int_equal(decode(b, &back, &error), TEXEL_FILE_REFUSED);
        if (!strstr(error.data, cases[i].says)) fail_msg("case %zu says: %s", i, error.data);
        strbuf_free(&error);
        free(b.data);
    }
    texel_file_release(&file);
}

static void test_headers_of_others(void **state) {
    (void)state;
    TexelFile file = meadow(4, 0), back;
    static const struct {
        size_t at;
        unsigned char value;
        const char *says;
    } cases[] = {{0, 'P', "not a texel file"},
                 {8, TEXEL_FILE_VERSION + 1, "its format is version"},
                 {12, 1, "byte order"},
                 {16, 1, "should have"},
                 {48, 7, "checksum of its header"}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        Bytes b = encode(&file);
        StrBuf error = {0};
        b.data[cases[i].at] = (unsigned char)(cases[i].value + (b.data[cases[i].at] == cases[i].value));
        assert_int_equal(decode(b, &back, &error), TEXEL_FILE_REFUSED);
        if (!strstr(error.data, cases[i].says)) fail_msg("case %zu says: %s", i, error.data);
        strbuf_free(&error);
        free(b.data);
    }
    texel_file_release(&file);
}

/* A file of version 1 hides as much as it did: its gammas meant 1 + (4γρh)². */
static void test_files_of_version_1(void **state) {
    (void)state;
    TexelFile file = meadow(32, 0), back;
    VoxelLevel *level = &file.layers[0].voxels->level[0];
    RandomStream r = {5};
    for (size_t i = 0; i < level->code_count; i++)
        level->codes[i].rest = (level->codes[i].rest & 0x7ffffffu) | (uint32_t)(random_next(&r) % 32) << VOXEL_GAMMA_SHIFT;
    Bytes b = encode(&file);
    FormatHeader header;
    memcpy(&header, b.data, sizeof header);
    header.version = 1;
    header.checksum = format_header_checksum(&header, b.data + sizeof header, header.section_count * sizeof(FormatSection));
    memcpy(b.data, &header, sizeof header);
    assert_int_equal(decode(b, &back, NULL), TEXEL_FILE_OK);
    for (size_t i = 0; i < level->code_count; i++) {
        uint32_t was = level->codes[i].rest, now = back.layers[0].voxels->level[0].codes[i].rest;
        double density = (double)voxel_code_density(was), gamma = ((was >> VOXEL_GAMMA_SHIFT) - 10.0) / 21;
        double before = gamma < 0 ? 1 + gamma : 1 + 16 * gamma * gamma * density * density;
        double after = (double)opacity_enhancement(voxel_code_gamma(now), voxel_code_density(now));
        assert_int_equal(was & 0x7ffffffu, now & 0x7ffffffu);
        assert_false(voxel_code_is_inside(back.layers[0].voxels->level[0].codes[i]));
        /* by half a step of the coarser code, or as far as it reaches */
        if (before > .63 && before < 0.95 * (double)opacity_enhancement(1.73f, (float)density)) assert_true(fabs(after / before - 1) < .2);
    }
    free(b.data);
    texel_file_release(&file);
    texel_file_release(&back);
}

static void test_memory_that_runs_out(void **state) {
    (void)state;
    TexelFile file = meadow(32, 0), back;
    Bytes b = encode(&file);
    size_t steps = 0;
    MemoryBudget memory = {.limit = 1};
    for (; texel_file_decode(b.data, b.size, &memory, &back, NULL) == TEXEL_FILE_NO_MEMORY; steps++) {
        assert_int_equal(memory.used, 0);
        memory.limit += b.size / 50;
    }
    assert_true(steps > 20);
    texel_file_release(&back);
    assert_int_equal(memory.used, 0);
    free(b.data);
    texel_file_release(&file);
}

static void test_files_on_disk(void **state) {
    (void)state;
    char path[64], before[64];
    snprintf(path, sizeof path, "test_texel_file-%ld.vtx", (long)getpid());
    snprintf(before, sizeof before, "none-%ld/x.vtx", (long)getpid());
    TexelFile file = meadow(8, 0), back;
    StrBuf error = {0};
    assert_false(texel_file_save(&file, before, &error));
    assert_non_null(strstr(error.data, "no such folder"));
    assert_true(texel_file_save(&file, path, NULL));
    assert_int_equal(texel_file_load(path, NULL, &back, NULL), TEXEL_FILE_OK);
    texel_file_release(&back);
    unlink(path);
    strbuf_clear(&error);
    assert_int_equal(texel_file_load(path, NULL, &back, &error), TEXEL_FILE_REFUSED);
    assert_non_null(strstr(error.data, "no such file"));
    strbuf_free(&error);
    texel_file_release(&file);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_written_comes_back),
        cmocka_unit_test(test_altered_files_are_refused),
        cmocka_unit_test(test_hostile_files_do_no_harm),
        cmocka_unit_test(test_refusals_name_what_is_wrong),
        cmocka_unit_test(test_headers_of_others),
        cmocka_unit_test(test_files_of_version_1),
        cmocka_unit_test(test_memory_that_runs_out),
        cmocka_unit_test(test_files_on_disk),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
