/* The fixed parts of a .vtx file, as texel_file.h describes them. */
#ifndef VTS_TEXEL_TEXEL_FORMAT_H
#define VTS_TEXEL_TEXEL_FORMAT_H

#include "texel/texel_file.h"

#include <assert.h>

/* As PNG's: a byte with the high bit, a name, line ends that a transfer as text would change. */
static const unsigned char TEXEL_MAGIC[8] = {0x89, 'V', 'T', 'X', '\r', '\n', 0x1a, '\n'};
enum { TEXEL_BYTE_ORDER = 0x01020304, TEXEL_ALIGNMENT = 8, TEXEL_NAME_LARGEST = 4096 };

typedef struct FormatHeader {
    unsigned char magic[8];
    uint32_t version, byte_order;
    uint64_t file_size;
    uint32_t section_count, zero;
    Hash128 key;
    Hash128 checksum; /* of the bytes before it and of the table */
} FormatHeader;
static_assert(sizeof(FormatHeader) == 64, "the header has no gaps");

typedef enum SectionKind {
    SECTION_TEXEL = 1,
    SECTION_LOOK,
    SECTION_INDEX,
    SECTION_SLICES,
    SECTION_CODES,
    SECTION_TRIM,
    SECTION_PAIRS
} SectionKind;
enum { SECTIONS_PER_LEVEL = 3 };

typedef struct FormatSection {
    uint32_t kind, layer, level, zero;
    uint64_t offset, size;
    Hash128 checksum;
} FormatSection;
static_assert(sizeof(FormatSection) == 48, "sections have no gaps");

/* Followed by the name. */
typedef struct FormatTexel {
    double bounds[6];
    uint32_t asked, built, cyclic, layer_count;
    uint32_t size[3], name_size;
} FormatTexel;
static_assert(sizeof(FormatTexel) == 80, "the texel's section has no gaps");

enum { LOOK_NUMBERS = 34 };
typedef struct FormatLook {
    uint32_t averaged, filtering; /* TexelFiltering */
    double numbers[LOOK_NUMBERS]; /* look_numbers() */
} FormatLook;

/* Where the numbers of a look are: LOOK_NUMBERS of them, in the order of the file. */
static inline void look_numbers(TexelFileLayer *layer, double *out[LOOK_NUMBERS]) {
    Finish *f = &layer->finish;
    Color *colors[] = {&layer->color, &f->ambient, &f->emission, &f->reflection_min, &f->reflection_max};
    double *rest[] = {&f->diffuse,   &f->transmission, &f->brilliance, &f->specular,
                      &f->roughness, &f->phong,        &f->phong_size, &f->metallic};
    size_t n = 0;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(colors); i++) {
        double *parts[] = {&colors[i]->red, &colors[i]->green, &colors[i]->blue, &colors[i]->filter,
                           &colors[i]->transmit};
        for (size_t k = 0; k < VTS_ARRAY_COUNT(parts); k++) out[n++] = parts[k];
    }
    for (size_t i = 0; i < VTS_ARRAY_COUNT(rest); i++) out[n++] = rest[i];
    static_assert(VTS_ARRAY_COUNT(colors) * 5 + VTS_ARRAY_COUNT(rest) + 1 == LOOK_NUMBERS,
                  "every number has its place");
}

static inline Hash128 format_checksum(const void *data, size_t size) {
    Hash128 hash = hash_begin(0x767478);
    hash_add(&hash, data, size);
    return hash;
}
/* Of the header (but its last field) and the table. */
static inline Hash128 format_header_checksum(const FormatHeader *header, const void *table,
                                             size_t table_size) {
    Hash128 hash = format_checksum(header, offsetof(FormatHeader, checksum));
    hash_add(&hash, table, table_size);
    return hash;
}
static inline uint64_t format_align(uint64_t offset) {
    return (offset + TEXEL_ALIGNMENT - 1) / TEXEL_ALIGNMENT * TEXEL_ALIGNMENT;
}

#endif
