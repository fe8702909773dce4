#include "volume/nanovdb.h"

#include "image/whole_file.h"

#include <string.h>
#include <zlib.h>

/* Sizes and places of what is in a file of version 32; all numbers are little-endian. */
enum { FILE_HEADER = 16, FILE_ENTRY = 176, ENTRY_SIZE = 0, ENTRY_STORED = 8, ENTRY_NAME_SIZE = 136, ENTRY_CODEC = 168 };
enum { GRID_HEADER = 672, GRID_VERSION = 16, GRID_MATRIX = 296 + 88, GRID_SHIFT = 296 + 232, GRID_TYPE = 636, TREE_HEADER = 64, TREE_ROOT = 24, VERSION = 32 };
enum { ROOT_TILES = 24, ROOT_SIZE = 64, TILE_SIZE = 32, TILE_CHILD = 8, TILE_VALUE = 20, TILE_BITS = 12 };
enum { LEAF_FLAGS = 15, LEAF_LEAST = 80, LEAF_QUANTUM = 84, LEAF_TABLE = 96, LEAF_BITS = 3 };
enum { CODEC_NONE, CODEC_ZIP };
enum { TYPE_FLOAT = 1, TYPE_FP4 = 13, TYPE_FP8 = 14, TYPE_FP16 = 15, TYPE_FPN = 16 };
enum { MOST_SIDE = 65536 };
static const size_t MOST_GRID_CELLS = (size_t)1 << 28;

/* The two kinds of nodes above leaves: tables of 2^(3 bits) entries, each a child or one number for all of its place. */
typedef struct NodeKind {
    int bits, child_bits; /* of the sides of the table, and of what an entry covers */
    size_t children, table, size;
} NodeKind;
static const NodeKind node_kinds[] = {{5, 7, 4128, 8256, 270400}, {4, 3, 544, 1088, 33856}};

typedef struct Tree {
    const unsigned char *bytes;
    size_t size;
    int type;
    int least[3], sides[3]; /* the box, in the grid's cells */
    float *values;
    const char *error;
} Tree;

static uint64_t whole(const unsigned char *at, int width) {
    uint64_t value = 0;
    for (int k = width; k-- > 0;) value = value << 8 | at[k];
    return value;
}

static int integer(const unsigned char *at) { return (int)(int32_t)(uint32_t)whole(at, 4); }

static float float_at(const unsigned char *at) {
    uint32_t bits = (uint32_t)whole(at, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static double double_at(const unsigned char *at) {
    uint64_t bits = whole(at, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static bool refuse(StrBuf *error, const char *why) {
    if (error) strbuf_adds(error, why);
    return false;
}

/* ---- the tree ---- */

/* Whether so many bytes stand at the place. */
static bool holds(Tree *tree, size_t at, size_t size) {
    if (at <= tree->size && size <= tree->size - at) return true;
    tree->error = "it is damaged: a node lies outside of the file";
    return false;
}

/* The part of a cube of cells that is in the box, counted from the box's corner; false where there is none. */
static bool part_of(const Tree *tree, const int64_t corner[3], int bits, int lo[3], int hi[3]) {
    for (int k = 0; k < 3; k++) {
        int64_t from = corner[k] - tree->least[k], to = from + ((int64_t)1 << bits);
        if (to <= 0 || from >= tree->sides[k]) return false;
        lo[k] = from > 0 ? (int)from : 0;
        hi[k] = to < tree->sides[k] ? (int)to : tree->sides[k];
    }
    return true;
}

static size_t cell_at(const Tree *tree, int x, int y, int z) { return ((size_t)z * (size_t)tree->sides[1] + (size_t)y) * (size_t)tree->sides[0] + (size_t)x; }

static void fill(Tree *tree, const int64_t corner[3], int bits, float value) {
    int lo[3], hi[3];
    if (value == 0 || !part_of(tree, corner, bits, lo, hi)) return;
    for (int z = lo[2]; z < hi[2]; z++)
        for (int y = lo[1]; y < hi[1]; y++)
            for (int x = lo[0]; x < hi[0]; x++) tree->values[cell_at(tree, x, y, z)] = value;
}

/* How many bits a number has in this leaf. */
static int width_of(const Tree *tree, const unsigned char *leaf) {
    switch (tree->type) {
    case TYPE_FLOAT: return 32;
    case TYPE_FP4: return 4;
    case TYPE_FP8: return 8;
    case TYPE_FP16: return 16;
    default: return 1 << (leaf[LEAF_FLAGS] >> 5); /* up to 16; more is refused */
    }
}

static float leaf_number(const unsigned char *leaf, int width, int i) {
    const unsigned char *at = leaf + LEAF_TABLE + (size_t)i * (size_t)width / 8;
    if (width == 32) return float_at(at);
    unsigned code = width == 16 ? (unsigned)whole(at, 2) : (unsigned)(*at >> (i * width % 8)) & ((1u << width) - 1);
    return float_at(leaf + LEAF_LEAST) + float_at(leaf + LEAF_QUANTUM) * (float)code;
}

static void read_leaf(Tree *tree, size_t at, const int64_t corner[3]) {
    int lo[3], hi[3];
    if (!part_of(tree, corner, LEAF_BITS, lo, hi) || !holds(tree, at, LEAF_TABLE)) return;
    const unsigned char *leaf = tree->bytes + at;
    int width = width_of(tree, leaf);
    if (width > 32) tree->error = "it is damaged: a leaf has numbers of no known size";
    if (width > 32 || !holds(tree, at, LEAF_TABLE + (size_t)width * 64)) return;
    for (int z = lo[2]; z < hi[2]; z++)
        for (int y = lo[1]; y < hi[1]; y++)
            for (int x = lo[0]; x < hi[0]; x++) {
                int64_t in[3] = {x + tree->least[0] - corner[0], y + tree->least[1] - corner[1], z + tree->least[2] - corner[2]};
                tree->values[cell_at(tree, x, y, z)] = leaf_number(leaf, width, (int)(in[0] << 6 | in[1] << 3 | in[2]));
            }
}

/* Entry by entry. Children lie at other places of space than each other, whatever their offsets say: what there is to do is bounded by the box. */
static void read_node(Tree *tree, size_t at, int level, const int64_t corner[3]) {
    const NodeKind *kind = &node_kinds[level];
    int lo[3], hi[3], side = 1 << kind->bits;
    if (!part_of(tree, corner, kind->bits + kind->child_bits, lo, hi) || !holds(tree, at, kind->size)) return;
    const unsigned char *node = tree->bytes + at;
    for (int i = 0; i < side * side * side && !tree->error; i++) {
        const int64_t in[3] = {i >> 2 * kind->bits, i >> kind->bits & (side - 1), i & (side - 1)};
        const int64_t place[3] = {corner[0] + in[0] * (1 << kind->child_bits), corner[1] + in[1] * (1 << kind->child_bits), corner[2] + in[2] * (1 << kind->child_bits)};
        const unsigned char *entry = node + kind->table + 8 * (size_t)i;
        if (!(node[kind->children + (size_t)i / 8] >> (i % 8) & 1)) fill(tree, place, kind->child_bits, float_at(entry));
        else if (level == 0) read_node(tree, at + (size_t)whole(entry, 8), 1, place); /* unsigned: what is outside is found there */
        else read_leaf(tree, at + (size_t)whole(entry, 8), place);
    }
}

/* Of the place that a tile's key says: three times the upper 20 bits of a coordinate. */
static void tile_corner(uint64_t key, int64_t corner[3]) {
    for (int k = 0; k < 3; k++) corner[k] = (int32_t)((uint32_t)(key >> (42 - 21 * k)) << TILE_BITS);
}

static bool read_root(Tree *tree, size_t at) {
    uint64_t tiles = whole(tree->bytes + at + ROOT_TILES, 4), blocks = 1, met = 0;
    if (!holds(tree, at + ROOT_SIZE, (size_t)tiles * TILE_SIZE)) return false;
    for (int k = 0; k < 3; k++) blocks *= (uint64_t)tree->sides[k] / (1 << TILE_BITS) + 2;
    for (uint64_t i = 0; i < tiles && !tree->error; i++) {
        const unsigned char *tile = tree->bytes + at + ROOT_SIZE + (size_t)i * TILE_SIZE;
        int64_t corner[3];
        int lo[3], hi[3];
        tile_corner(whole(tile, 8), corner);
        if (!part_of(tree, corner, TILE_BITS, lo, hi)) continue;
        if (++met > blocks) tree->error = "it is damaged: its root names a place twice";
        else if (whole(tile + TILE_CHILD, 8)) read_node(tree, at + (size_t)whole(tile + TILE_CHILD, 8), 0, corner);
        else fill(tree, corner, TILE_BITS, float_at(tile + TILE_VALUE));
    }
    return !tree->error;
}

/* ---- one grid ---- */

/* Unit cube → cells → where the file has them: middles of cells lie at whole numbers. */
static bool place_of(const Tree *tree, const unsigned char *grid, Affine *out) {
    Vec3 corner = vec3(tree->least[0] - 0.5, tree->least[1] - 0.5, tree->least[2] - 0.5);
    Mat3 cells;
    for (int k = 0; k < 3; k++) cells.c[k] = vec3(double_at(grid + GRID_MATRIX + 8 * k), double_at(grid + GRID_MATRIX + 24 + 8 * k), double_at(grid + GRID_MATRIX + 48 + 8 * k));
    Vec3 shift = vec3(double_at(grid + GRID_SHIFT), double_at(grid + GRID_SHIFT + 8), double_at(grid + GRID_SHIFT + 16));
    out->offset = vec3_add(mat3_apply(&cells, corner), shift);
    for (int k = 0; k < 3; k++) out->linear.c[k] = vec3_scale(cells.c[k], tree->sides[k]);
    bool sound = vec3_is_finite(out->offset) && fabs(mat3_determinant(&out->linear)) > 0 && isfinite(mat3_determinant(&out->linear));
    for (int k = 0; k < 3; k++) sound &= vec3_is_finite(out->linear.c[k]);
    return sound;
}

static bool measure_box(Tree *tree, const unsigned char *root) {
    size_t cells = 1;
    for (int k = 0; k < 3; k++) {
        int64_t least = integer(root + 4 * k), side = integer(root + 12 + 4 * k) - least + 1;
        if (side < 1 || side > MOST_SIDE || (uint64_t)side > MOST_GRID_CELLS / cells) return false;
        tree->least[k] = (int)least, tree->sides[k] = (int)side;
        cells *= (size_t)side;
    }
    return true;
}

static void note_bad(DensityGrid *out, float *values, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (values[i] >= 0 && isfinite(values[i])) continue;
        if (!out->bad) out->bad = i + 1;
        values[i] = 0;
    }
}

static bool decode_grid(const unsigned char *bytes, size_t size, Arena *arena, DensityGrid *out, StrBuf *error) {
    if (size < GRID_HEADER + TREE_HEADER || memcmp(bytes, "NanoVDB", 7) != 0 || whole(bytes + GRID_VERSION, 4) >> 21 != VERSION)
        return refuse(error, "its grid is damaged, or not of version 32");
    Tree tree = {.bytes = bytes, .size = size, .type = (int)double_clamp((double)whole(bytes + GRID_TYPE, 4), 0, 1000)};
    if (tree.type != TYPE_FLOAT && !(tree.type >= TYPE_FP4 && tree.type <= TYPE_FPN)) return refuse(error, "its numbers are no floats");
    size_t root = GRID_HEADER + (size_t)whole(bytes + GRID_HEADER + TREE_ROOT, 8);
    if (!holds(&tree, root, ROOT_SIZE)) return refuse(error, tree.error);
    if (!measure_box(&tree, bytes + root)) return refuse(error, "nothing is in its grid, or it has too many cells");
    size_t count = (size_t)tree.sides[0] * (size_t)tree.sides[1] * (size_t)tree.sides[2];
    *out = (DensityGrid){.hash = hash_begin(0x6e766462), .placed = true};
    if (!place_of(&tree, bytes, &out->place)) return refuse(error, "it does not say where it lies, or flat, or without end");
    tree.values = arena_new_array(arena, float, count);
    if (!read_root(&tree, root)) return refuse(error, tree.error);
    note_bad(out, tree.values, count);
    memcpy(out->size, tree.sides, sizeof out->size);
    out->values = tree.values;
    hash_add(&out->hash, bytes, size);
    return true;
}

/* ---- the file ---- */

typedef struct Entry {
    uint64_t size, stored; /* bytes in memory, and in the file */
    int codec;
    bool wanted;
} Entry;

/* Of a compressed grid its packed size stands before it. */
static bool unpack(const unsigned char *bytes, const Entry *entry, Arena *arena, DensityGrid *out, StrBuf *error) {
    if (entry->codec == CODEC_NONE) return entry->size <= entry->stored ? decode_grid(bytes, (size_t)entry->size, arena, out, error) : refuse(error, "it is damaged: a grid ends within itself");
    if (entry->codec != CODEC_ZIP) return refuse(error, "it is compressed by Blosc, which is not read here; ZIP is, and what is not compressed");
    uint64_t packed = entry->stored >= 8 ? whole(bytes, 8) : 0;
    if (packed == 0 || packed > entry->stored - 8 || entry->size / 1100 > packed) return refuse(error, "it is damaged: its compressed grid makes no sense");
    unsigned char *grid = arena_push_array_(arena, (size_t)entry->size, 1);
    uLongf found = (uLongf)entry->size;
    if (uncompress(grid, &found, bytes + 8, (uLong)packed) != Z_OK || found != entry->size) return refuse(error, "it is damaged: its compressed grid ends early, or is none");
    return decode_grid(grid, (size_t)entry->size, arena, out, error);
}

/* Segments follow each other: a header, an entry and a name for each grid, then the grids. */
static bool find_in_segment(const unsigned char *bytes, size_t size, size_t *at, const char *name, Entry *entry, size_t *grid_at, StrBuf *error) {
    size_t next = *at + FILE_HEADER, count = (size_t)whole(bytes + *at + 12, 2), skipped = 0;
    entry->wanted = false;
    for (size_t i = 0; i < count; i++) {
        if (next > size || size - next < FILE_ENTRY) return refuse(error, "it ends within its header");
        Entry here = {whole(bytes + next + ENTRY_SIZE, 8), whole(bytes + next + ENTRY_STORED, 8), (int)whole(bytes + next + ENTRY_CODEC, 2), false};
        size_t name_size = (size_t)whole(bytes + next + ENTRY_NAME_SIZE, 4);
        next += FILE_ENTRY;
        if (name_size > size - next || here.stored > size || skipped > size) return refuse(error, "it ends within its header, or that is damaged");
        size_t length = strnlen((const char *)bytes + next, name_size);
        if (!entry->wanted && (!name || (strlen(name) == length && memcmp(name, bytes + next, length) == 0))) {
            *entry = here;
            entry->wanted = true;
            *grid_at = skipped;
        }
        skipped += (size_t)here.stored;
        next += name_size;
    }
    *grid_at += next;
    *at = skipped <= size - next ? next + skipped : size;
    if (!entry->wanted) return true;
    return *grid_at <= size && entry->stored <= size - *grid_at ? true : refuse(error, "it is damaged: it ends within the grid");
}

bool nanovdb_decode(const unsigned char *bytes, size_t size, const char *name, Arena *arena, DensityGrid *out, StrBuf *error) {
    size_t at = 0, grid_at = 0;
    Entry entry = {0};
    do {
        if (size - at < FILE_HEADER || memcmp(bytes + at, "NanoVDB", 7) != 0) return refuse(error, at ? "it is damaged: a part of it is no NanoVDB" : "it is no NanoVDB file");
        if (!find_in_segment(bytes, size, &at, name, &entry, &grid_at, error)) return false;
        if (entry.wanted) return unpack(bytes + grid_at, &entry, arena, out, error);
    } while (at < size);
    return refuse(error, name ? "no grid in it has this name" : "there is no grid in it");
}

bool nanovdb_load(const char *path, const char *name, Arena *arena, DensityGrid *out, StrBuf *error) {
    size_t size = 0;
    const unsigned char *bytes = whole_file_read_into(arena, path, SIZE_MAX, &size);
    return bytes ? nanovdb_decode(bytes, size, name, arena, out, error) : refuse(error, "it cannot be read");
}
