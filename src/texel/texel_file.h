/* Texels as files (.vtx): all layers and levels of one built texel, and how its layers look.
 *
 * Little is stored twice: what follows from the rest (where a brick's codes begin, the cells that interpolation can find
 * anything in, side lengths) is computed when a file is read. The layout, all numbers in the order of the processor that wrote
 * them, sections at multiples of 8 bytes with zeros between:
 *
 *   header    64 bytes: magic, version of the format, byte order, size of the file, number of sections, key, checksum of header and table
 *   table     48 bytes a section: kind, layer, level, offset and size (64 bits), checksum
 *   TEXEL     bounds, resolution asked for and built, cyclic axes, number of layers, voxels along the axes, name
 *   for each layer:  LOOK   colour and finish; how its levels were filtered
 *     for each level:  INDEX   the brick at each place, −1: none        SLICES  8 × 64 bits a brick: which voxels are occupied
 *                      CODES   8 bytes for each occupied voxel, brick by brick (voxel_code.h)
 *     where any of them is not 1: TRIM  7 × 9 × 9 factors of coarse levels (voxel_trim.h), 32 bits each
 *     where they are known: PAIRS  33 × 33 + 160 numbers (voxel_pairs.h), 32 bits each, 2 × 7 × 33 × 33 powers and as many factors (voxel_lit.h), 8 bits each
 *
 * The same texel gives the same bytes. A reader believes nothing: sizes and offsets must be what the header implies, so that
 * no more memory is asked for than a small multiple of the file's size, every index must be in its range, every checksum right. */
#ifndef VTS_TEXEL_TEXEL_FILE_H
#define VTS_TEXEL_TEXEL_FILE_H

#include "base/strbuf.h"
#include "scene/scene.h"
#include "texel/texel.h"

/* The format's version; and the builder's: to be raised when the same contents give other voxels than before, so that caches
 * do not keep the old ones. Version 1 had another law of opacity, from 0 to 1 in steps of 1/21: it is read, and its gammas become those that
 * hide as much. Versions before 3 have no factors of coarse levels: they are 1; those before 5 factors of four levels only. Those before 7
 * have no pairs, or of another kind, which are passed over. */
enum { TEXEL_FILE_VERSION = 7, TEXEL_FILE_OLDEST = 1, TEXEL_BUILDER_VERSION = 13, TEXEL_FILE_MOST_LAYERS = 256 };

typedef struct TexelFileLayer {
    VoxelLayer *voxels;
    Color color;   /* linear */
    Finish finish; /* its hash is not stored */
    bool averaged; /* `color` is the mean of a pattern */
} TexelFileLayer;

typedef struct TexelFile {
    char *name;
    Box3 bounds;      /* finite, with volume */
    int asked, built; /* resolutions; asked 0: auto */
    unsigned cyclic;  /* TEXEL_CYCLIC_… */
    Hash128 key;      /* of a cache: what the voxels were built from; else 0 */
    Hash128 content;  /* of all that the file holds; set by reading */
    TexelFileLayer *layers;
    size_t layer_count; /* 1 … TEXEL_FILE_MOST_LAYERS, all of one size and `cyclic` */
} TexelFile;

typedef enum TexelFileStatus {
    TEXEL_FILE_OK,
    TEXEL_FILE_REFUSED,  /* unreadable, damaged or something else: `error` says why */
    TEXEL_FILE_NO_MEMORY /* the budget or the machine has no more */
} TexelFileStatus;

/* The bytes of a file, to be freed by the caller; NULL when memory ran out. */
unsigned char *texel_file_encode(const TexelFile *file, size_t *size);
/* From the bytes of a file. On success the caller calls texel_file_release(); otherwise *out is empty and `error` (may be NULL)
 * has one line that begins "it …" or "the …". */
TexelFileStatus texel_file_decode(const unsigned char *data, size_t size, MemoryBudget *memory,
                                  TexelFile *out, StrBuf *error);

/* Writes the file whole or not at all; false with a line of text in `error` (may be NULL). */
bool texel_file_save(const TexelFile *file, const char *path, StrBuf *error);
TexelFileStatus texel_file_load(const char *path, MemoryBudget *memory, TexelFile *out, StrBuf *error);
/* The texel as a definition with that content, its looks as textures, in `arena`. */
void texel_def_from_file(const TexelFile *file, const char *path, Span span, Arena *arena, TexelDef *out);
/* A layer that looks like `texture`; of a pattern it keeps the mean of the colours within `bounds`. */
TexelFileLayer texel_file_layer(const Texture *texture, Box3 bounds, VoxelLayer *voxels);
/* Frees name and layers, with their voxels. */
void texel_file_release(TexelFile *file);

#endif
