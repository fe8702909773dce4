/* Writing texels as files. */
#include "texel/texel_file.h"

#include "image/whole_file.h"
#include "texel/texel_format.h"
#include "texel/voxel_layer.h"
#include "texel/voxel_pairs.h"
#include "texel/voxel_trim.h"

#include <stdlib.h>
#include <string.h>

/* The file while it grows. Sections and bytes are counted first, with data NULL, then written. */
typedef struct Writer {
    unsigned char *data;
    FormatSection *table;
    size_t section_count;
    uint64_t end;
} Writer;

static void begin_section(Writer *w, SectionKind kind, size_t layer, int level) {
    w->end = format_align(w->end);
    if (w->table)
        w->table[w->section_count] = (FormatSection){
            .kind = kind, .layer = (uint32_t)layer, .level = (uint32_t)level, .offset = w->end};
    w->section_count++;
}

static void add_bytes(Writer *w, const void *bytes, size_t size) {
    if (w->data && size) memcpy(w->data + w->end, bytes, size);
    w->end += size;
}

static void end_section(Writer *w) {
    if (!w->table) return;
    FormatSection *section = &w->table[w->section_count - 1];
    section->size = w->end - section->offset;
    section->checksum = format_checksum(w->data + section->offset, section->size);
}

static void write_texel(Writer *w, const TexelFile *file) {
    const VoxelLevel *finest = &file->layers[0].voxels->level[0];
    const char *name = file->name ? file->name : "";
    FormatTexel texel = {.bounds = {file->bounds.min.x, file->bounds.min.y, file->bounds.min.z,
                                    file->bounds.max.x, file->bounds.max.y, file->bounds.max.z},
                         .asked = (uint32_t)file->asked,
                         .built = (uint32_t)file->built,
                         .cyclic = file->cyclic,
                         .layer_count = (uint32_t)file->layer_count,
                         .name_size = (uint32_t)size_min(strlen(name), TEXEL_NAME_LARGEST)};
    for (int i = 0; i < 3; i++) texel.size[i] = (uint32_t)finest->size[i];
    begin_section(w, SECTION_TEXEL, 0, 0);
    add_bytes(w, &texel, sizeof texel);
    add_bytes(w, name, texel.name_size);
    end_section(w);
}

static void write_look(Writer *w, const TexelFileLayer *layer, size_t index) {
    TexelFileLayer copy = *layer;
    double *numbers[LOOK_NUMBERS];
    FormatLook look = {.averaged = layer->averaged, .filtering = (uint32_t)layer->voxels->filtering};
    look_numbers(&copy, numbers);
    for (size_t i = 0; i < LOOK_NUMBERS - 1; i++) look.numbers[i] = *numbers[i];
    look.numbers[LOOK_NUMBERS - 1] = layer->finish.fresnel;
    begin_section(w, SECTION_LOOK, index, 0);
    add_bytes(w, &look, sizeof look);
    end_section(w);
}

static void write_level(Writer *w, const VoxelLevel *level, size_t layer, int number) {
    begin_section(w, SECTION_INDEX, layer, number);
    add_bytes(w, level->index, voxel_level_bricks(level) * sizeof *level->index);
    end_section(w);
    begin_section(w, SECTION_SLICES, layer, number);
    for (size_t i = 0; i < level->brick_count; i++)
        add_bytes(w, level->bricks[i].slice, sizeof level->bricks[i].slice);
    end_section(w);
    begin_section(w, SECTION_CODES, layer, number);
    add_bytes(w, level->codes, level->code_count * sizeof *level->codes);
    end_section(w);
}

static void write_trim(Writer *w, const VoxelLayer *voxels, size_t layer) {
    if (!voxel_layer_is_trimmed(voxels)) return;
    begin_section(w, SECTION_TRIM, layer, 0);
    add_bytes(w, voxels->trim, sizeof voxels->trim);
    end_section(w);
}

static void write_pairs(Writer *w, const VoxelLayer *voxels, size_t layer) {
    if (!voxel_layer_is_paired(voxels)) return;
    begin_section(w, SECTION_PAIRS, layer, 0);
    add_bytes(w, &voxels->pairs, sizeof voxels->pairs);
    end_section(w);
}

static void write_sections(Writer *w, const TexelFile *file) {
    write_texel(w, file);
    for (size_t i = 0; i < file->layer_count; i++) {
        const VoxelLayer *voxels = file->layers[i].voxels;
        write_look(w, &file->layers[i], i);
        for (int l = 0; l < voxels->levels; l++) write_level(w, &voxels->level[l], i, l);
        write_trim(w, voxels, i);
        write_pairs(w, voxels, i);
    }
}

unsigned char *texel_file_encode(const TexelFile *file, size_t *size) {
    Writer sizes = {.end = 0};
    write_sections(&sizes, file);
    size_t table_size = sizes.section_count * sizeof(FormatSection);
    sizes.end = sizeof(FormatHeader) + table_size;
    sizes.section_count = 0;
    write_sections(&sizes, file);
    unsigned char *data = calloc(1, sizes.end);
    FormatSection *table = calloc(sizes.section_count, sizeof *table);
    if (data && table) {
        Writer w = {.data = data, .table = table, .end = sizeof(FormatHeader) + table_size};
        write_sections(&w, file);
        FormatHeader header = {.version = TEXEL_FILE_VERSION,
                               .byte_order = TEXEL_BYTE_ORDER,
                               .file_size = sizes.end,
                               .section_count = (uint32_t)sizes.section_count,
                               .key = file->key};
        memcpy(header.magic, TEXEL_MAGIC, sizeof header.magic);
        header.checksum = format_header_checksum(&header, table, table_size);
        memcpy(data, &header, sizeof header);
        memcpy(data + sizeof header, table, table_size);
        *size = sizes.end;
    } else {
        free(data);
        data = NULL;
    }
    free(table);
    return data;
}

bool texel_file_save(const TexelFile *file, const char *path, StrBuf *error) {
    size_t size;
    unsigned char *data = texel_file_encode(file, &size);
    if (!data && error) strbuf_addf(error, "cannot write '%s': not enough memory", path);
    bool ok = data && whole_file_replace(path, data, size, error);
    free(data);
    return ok;
}

TexelFileStatus texel_file_load(const char *path, MemoryBudget *memory, TexelFile *out, StrBuf *error) {
    size_t size;
    *out = (TexelFile){0};
    unsigned char *data = whole_file_read(path, &size, error);
    if (!data) return TEXEL_FILE_REFUSED;
    TexelFileStatus status = TEXEL_FILE_NO_MEMORY;
    if (memory_budget_take(memory, size)) {
        status = texel_file_decode(data, size, memory, out, error);
        memory_budget_give_back(memory, size);
    }
    free(data);
    return status;
}

void texel_file_release(TexelFile *file) {
    for (size_t i = 0; i < file->layer_count; i++) voxel_layer_destroy(file->layers[i].voxels);
    free(file->layers);
    free(file->name);
    *file = (TexelFile){0};
}
