/* Reading texels from files that anybody may have written. */
#include "texel/texel_content.h"
#include "texel/texel_format.h"
#include "texel/voxel_layer.h"
#include "texel/voxel_pairs.h"
#include "texel/voxel_trim.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

typedef struct FormatReader {
    const unsigned char *data;
    size_t size;
    FormatHeader header;
    uint32_t next; /* section */
    uint64_t end;  /* of the section before it */
    FormatSection section;
    StrBuf *error;
    bool no_memory;
} FormatReader;

static bool VTS_PRINTF(2, 3) format_refuse(FormatReader *r, const char *format, ...) {
    va_list args;
    va_start(args, format);
    if (r->error) strbuf_vaddf(r->error, format, args);
    va_end(args);
    return false;
}

static bool lack_memory(FormatReader *r) {
    r->no_memory = true;
    return format_refuse(r, "it needs more memory than there is");
}

/* ---- header and table ---- */

static bool read_header(FormatReader *r) {
    FormatHeader *h = &r->header;
    if (r->size < sizeof h->magic || memcmp(r->data, TEXEL_MAGIC, sizeof h->magic) != 0)
        return format_refuse(r, "it is not a texel file");
    if (r->size < sizeof *h) return format_refuse(r, "it is damaged: it ends within its header");
    memcpy(h, r->data, sizeof *h);
    if (h->byte_order != TEXEL_BYTE_ORDER)
        return format_refuse(r, "it was written by a machine of another byte order, or is damaged");
    if (h->version < TEXEL_FILE_OLDEST || h->version > TEXEL_FILE_VERSION)
        return format_refuse(r, "its format is version %u; this program reads versions up to %d", h->version,
                             TEXEL_FILE_VERSION);
    if (h->file_size != r->size)
        return format_refuse(r, "it is damaged: it has %zu bytes and should have %llu", r->size,
                             (unsigned long long)h->file_size);
    size_t table_size = (size_t)h->section_count * sizeof(FormatSection);
    if (table_size > r->size - sizeof *h)
        return format_refuse(r, "it is damaged: its table of sections does not fit into it");
    if (!hash_equal(h->checksum, format_header_checksum(h, r->data + sizeof *h, table_size)))
        return format_refuse(r, "it is damaged: the checksum of its header is wrong");
    if (h->zero) return format_refuse(r, "it is damaged: its header holds what it should not");
    r->end = sizeof *h + table_size;
    return true;
}

static const char *section_name(uint32_t kind) {
    static const char *const names[] = {[SECTION_TEXEL] = "texel",
                                        [SECTION_LOOK] = "look",
                                        [SECTION_INDEX] = "index",
                                        [SECTION_SLICES] = "block of masks",
                                        [SECTION_CODES] = "block of voxels",
                                        [SECTION_TRIM] = "table of factors",
                                        [SECTION_PAIRS] = "table of pairs"};
    return kind < VTS_ARRAY_COUNT(names) && names[kind] ? names[kind] : "section";
}

static bool is_zero(const unsigned char *bytes, size_t size) {
    for (size_t i = 0; i < size; i++)
        if (bytes[i]) return false;
    return true;
}

/* `what` is wrong with the current section. */
static bool refuse_section(FormatReader *r, const char *what) {
    const FormatSection *s = &r->section;
    if (s->kind == SECTION_TEXEL) return format_refuse(r, "it is damaged: its description %s", what);
    if (s->kind == SECTION_LOOK)
        return format_refuse(r, "it is damaged: the look of layer %u %s", s->layer, what);
    return format_refuse(r, "it is damaged: the %s of layer %u, level %u, %s", section_name(s->kind),
                         s->layer, s->level, what);
}

/* The next section, which has to be this one; NULL if it is not there, not where it has to be, or altered. */
static const unsigned char *open_section(FormatReader *r, SectionKind kind, size_t layer, int level) {
    FormatSection *s = &r->section;
    *s = (FormatSection){.kind = kind, .layer = (uint32_t)layer, .level = (uint32_t)level};
    if (r->next >= r->header.section_count) return refuse_section(r, "is missing"), NULL;
    FormatSection found;
    memcpy(&found, r->data + sizeof(FormatHeader) + (size_t)r->next++ * sizeof found, sizeof found);
    if (found.kind != s->kind || found.layer != s->layer || found.level != s->level || found.zero)
        return refuse_section(r, "is not where it has to be in the table"), NULL;
    uint64_t begin = format_align(r->end);
    if (begin > r->size || found.offset != begin || found.size > r->size - begin)
        return refuse_section(r, "lies outside of the file or over another part"), NULL;
    if (!is_zero(r->data + r->end, begin - r->end))
        return refuse_section(r, "has something written before it"), NULL;
    *s = found;
    r->end = begin + found.size;
    if (!hash_equal(found.checksum, format_checksum(r->data + begin, found.size)))
        return refuse_section(r, "does not match its checksum"), NULL;
    return r->data + begin;
}

/* ---- the texel and its looks ---- */

static bool bounds_are_valid(Box3 b) {
    Vec3 size = vec3_sub(b.max, b.min);
    if (!vec3_is_finite(b.min) || !vec3_is_finite(b.max) || !(size.x > 0 && size.y > 0 && size.z > 0))
        return false;
    return vec3_is_finite(vec3_from_f(texel_extent_of(b)));
}

static bool read_texel(FormatReader *r, TexelFile *out, FormatTexel *texel) {
    const unsigned char *at = open_section(r, SECTION_TEXEL, 0, 0);
    if (!at) return false;
    if (r->section.size < sizeof *texel) return refuse_section(r, "is too short");
    memcpy(texel, at, sizeof *texel);
    out->bounds = (Box3){{texel->bounds[0], texel->bounds[1], texel->bounds[2]},
                         {texel->bounds[3], texel->bounds[4], texel->bounds[5]}};
    if (texel->name_size > TEXEL_NAME_LARGEST || r->section.size - sizeof *texel != texel->name_size ||
        memchr(at + sizeof *texel, 0, texel->name_size))
        return refuse_section(r, "has a name that does not fit");
    if (!bounds_are_valid(out->bounds)) return refuse_section(r, "has bounds without a volume");
    if (texel->asked > TEXEL_LARGEST_RESOLUTION || texel->built < 1 ||
        texel->built > TEXEL_LARGEST_RESOLUTION)
        return refuse_section(r, "has no valid resolution");
    if (texel->cyclic > (TEXEL_CYCLIC_X | TEXEL_CYCLIC_Y | TEXEL_CYCLIC_Z))
        return refuse_section(r, "has cyclic axes that there are not");
    if (texel->layer_count < 1 || texel->layer_count > TEXEL_FILE_MOST_LAYERS)
        return refuse_section(r, "has no valid number of layers");
    out->asked = (int)texel->asked;
    out->built = (int)texel->built;
    out->cyclic = texel->cyclic;
    out->key = r->header.key;
    out->content = r->header.checksum;
    out->name = calloc((size_t)texel->name_size + 1, 1);
    out->layers = calloc(texel->layer_count, sizeof *out->layers);
    if (!out->name || !out->layers) return lack_memory(r);
    memcpy(out->name, at + sizeof *texel, texel->name_size);
    return true;
}

static bool read_look(FormatReader *r, size_t index, TexelFileLayer *layer, TexelFiltering *filtering) {
    const unsigned char *at = open_section(r, SECTION_LOOK, index, 0);
    FormatLook look;
    double *numbers[LOOK_NUMBERS];
    if (!at) return false;
    if (r->section.size != sizeof look) return refuse_section(r, "has not the size that it should have");
    memcpy(&look, at, sizeof look);
    look_numbers(layer, numbers);
    for (size_t i = 0; i < LOOK_NUMBERS; i++) {
        if (!isfinite(look.numbers[i])) return refuse_section(r, "holds what is not a number");
        if (i < LOOK_NUMBERS - 1) *numbers[i] = look.numbers[i];
    }
    if (look.averaged > 1 || look.filtering > TEXEL_FILTER_PUBLISHED) return refuse_section(r, "holds what it should not");
    layer->averaged = look.averaged;
    *filtering = (TexelFiltering)look.filtering;
    layer->finish.fresnel = look.numbers[LOOK_NUMBERS - 1] != 0;
    return true;
}

/* ---- voxels ---- */

/* Bits of a slice of a brick for voxels that exist: levels of fewer than 8 voxels fill bricks in part. */
static uint64_t existing_voxels(const VoxelLevel *level, int z) {
    if (z >= level->size[2]) return 0;
    int columns = int_min(level->size[0], BRICK_SIDE), rows = int_min(level->size[1], BRICK_SIDE);
    uint64_t row = ((uint64_t)1 << columns) - 1, bits = 0;
    for (int y = 0; y < rows; y++) bits |= row << (BRICK_SIDE * y);
    return bits;
}

/* Every brick has one place. */
static bool check_index(FormatReader *r, const VoxelLevel *level) {
    bool *placed = calloc(level->brick_count + 1, sizeof *placed);
    size_t bricks = 0;
    bool ok = true;
    if (!placed) return lack_memory(r);
    for (size_t i = 0; i < voxel_level_bricks(level) && ok; i++) {
        int32_t brick = level->index[i];
        if (brick == -1) continue;
        ok = brick >= 0 && (size_t)brick < level->brick_count && !placed[brick];
        if (ok) placed[brick] = true, bricks++;
    }
    free(placed);
    return (ok && bricks == level->brick_count) || refuse_section(r, "does not fit the index");
}

static bool read_index(FormatReader *r, VoxelLayer *layer, size_t number, int l) {
    VoxelLevel *level = &layer->level[l];
    const unsigned char *at = open_section(r, SECTION_INDEX, number, l);
    size_t bricks = voxel_level_bricks(level);
    if (!at) return false;
    if (r->section.size != bricks * sizeof *level->index)
        return refuse_section(r, "has not the size that it should have");
    level->index = voxel_layer_allocate(layer, bricks, sizeof *level->index);
    if (!level->index) return lack_memory(r);
    memcpy(level->index, at, bricks * sizeof *level->index);
    return true;
}

static bool read_slices(FormatReader *r, VoxelLayer *layer, size_t number, int l) {
    VoxelLevel *level = &layer->level[l];
    const unsigned char *at = open_section(r, SECTION_SLICES, number, l);
    enum { SLICES_SIZE = BRICK_SIDE * sizeof(uint64_t) };
    if (!at) return false;
    size_t count = (size_t)r->section.size / SLICES_SIZE;
    if (r->section.size % SLICES_SIZE || count > voxel_level_bricks(level))
        return refuse_section(r, "has not the size that it should have");
    level->bricks = voxel_layer_allocate(layer, count, sizeof *level->bricks);
    if (!level->bricks) return lack_memory(r);
    level->brick_count = count;
    uint64_t codes = 0, existing[BRICK_SIDE];
    for (int z = 0; z < BRICK_SIDE; z++) existing[z] = existing_voxels(level, z);
    for (size_t i = 0; i < count; i++) {
        VoxelBrick *brick = &level->bricks[i];
        memcpy(brick->slice, at + i * SLICES_SIZE, SLICES_SIZE);
        for (int z = 0; z < BRICK_SIDE; z++) {
            if (brick->slice[z] & ~existing[z]) return refuse_section(r, "has voxels outside of the texel");
            brick->first[z] = (uint32_t)codes;
            codes += count_bits(brick->slice[z]);
        }
    }
    if (codes >= UINT32_MAX) return refuse_section(r, "has too many voxels");
    level->code_count = (size_t)codes;
    return check_index(r, level);
}

static bool read_codes(FormatReader *r, VoxelLayer *layer, size_t number, int l) {
    VoxelLevel *level = &layer->level[l];
    const unsigned char *at = open_section(r, SECTION_CODES, number, l);
    if (!at) return false;
    if (r->section.size != level->code_count * sizeof *level->codes)
        return refuse_section(r, "has not the size that the masks ask for");
    level->codes = voxel_layer_allocate(layer, level->code_count + 2, sizeof *level->codes);
    if (!level->codes) return lack_memory(r);
    memcpy(level->codes, at, (size_t)r->section.size);
    for (size_t i = 0; r->header.version == 1 && i < level->code_count; i++)
        level->codes[i] = voxel_code_from_first(level->codes[i]);
    return voxel_level_mark_support(layer, level) || lack_memory(r);
}

static bool next_is(const FormatReader *r, SectionKind kind) {
    FormatSection next;
    if (r->next >= r->header.section_count) return false;
    memcpy(&next, r->data + sizeof(FormatHeader) + (size_t)r->next * sizeof next, sizeof next);
    return next.kind == (uint32_t)kind;
}

/* Factors of coarse levels, if the file has any. */
static bool read_trim(FormatReader *r, VoxelLayer *layer, size_t number) {
    if (!next_is(r, SECTION_TRIM)) return true;
    const unsigned char *at = open_section(r, SECTION_TRIM, number, 0);
    if (!at) return false;
    size_t size = (size_t)r->section.size; /* older files have fewer levels */
    if (size > sizeof layer->trim || size % sizeof *layer->trim) return refuse_section(r, "has not the size that it should have");
    memcpy(layer->trim[0], at, size);
    const float *factors = layer->trim[0];
    for (size_t i = 0; i < size / sizeof(float); i++)
        if (!(factors[i] >= TRIM_LEAST && factors[i] <= TRIM_MOST)) return refuse_section(r, "holds what it should not");
    return true;
}

/* What eye and sun have in common, if the file says so. */
static bool read_pairs(FormatReader *r, VoxelLayer *layer, size_t number) {
    if (!next_is(r, SECTION_PAIRS)) return true;
    const unsigned char *at = open_section(r, SECTION_PAIRS, number, 0);
    if (!at) return false;
    if (r->header.version < 7) return true;
    if (r->section.size != sizeof layer->pairs) return refuse_section(r, "has not the size that it should have");
    memcpy(&layer->pairs, at, sizeof layer->pairs);
    return voxel_pairs_are_sound(&layer->pairs) || refuse_section(r, "holds what it should not");
}

static bool read_voxels(FormatReader *r, const FormatTexel *texel, size_t number,
                        const TexelBuildOptions *options, TexelFileLayer *out) {
    VoxelLayer *layer = out->voxels = voxel_layer_create(options);
    if (!layer) return lack_memory(r);
    r->section = (FormatSection){.kind = SECTION_TEXEL};
    for (int i = 0; i < 3; i++)
        if (texel->size[i] != (uint32_t)layer->level[0].size[i])
            return refuse_section(r, "has other sizes than its bounds and resolution give");
    for (int l = 0; l < layer->levels; l++)
        if (!read_index(r, layer, number, l) || !read_slices(r, layer, number, l) ||
            !read_codes(r, layer, number, l))
            return false;
    return read_trim(r, layer, number) && read_pairs(r, layer, number);
}

static bool read_file(FormatReader *r, MemoryBudget *memory, TexelFile *out) {
    FormatTexel texel;
    if (!read_header(r) || !read_texel(r, out, &texel)) return false;
    TexelBuildOptions options = {.resolution = out->built,
                                 .extent = texel_extent_of(out->bounds),
                                 .cyclic = out->cyclic,
                                 .memory = memory};
    for (size_t i = 0; i < texel.layer_count; i++) {
        out->layer_count = i + 1;
        if (!read_look(r, i, &out->layers[i], &options.filtering) ||
            !read_voxels(r, &texel, i, &options, &out->layers[i]))
            return false;
    }
    if (r->next != r->header.section_count || r->end != r->size)
        return format_refuse(r, "it is damaged: there is more in it than there should be");
    return true;
}

TexelFileStatus texel_file_decode(const unsigned char *data, size_t size, MemoryBudget *memory,
                                  TexelFile *out, StrBuf *error) {
    FormatReader reader = {.data = data, .size = size, .error = error};
    *out = (TexelFile){0};
    if (read_file(&reader, memory, out)) return TEXEL_FILE_OK;
    texel_file_release(out);
    return reader.no_memory ? TEXEL_FILE_NO_MEMORY : TEXEL_FILE_REFUSED;
}
