#include "terrain/posts.h"

#include <string.h>

/* height = post_scale_apply(scale, base + code); the code VOID stands for no height. */
typedef enum PostKind { POSTS_EQUAL, POSTS_CODES, POSTS_FLOATS } PostKind;
enum { CODE_VOID = 65535 };

struct PostBlock {
    PostKind kind;
    PostScale scale;
    double base;
    union {
        float equal;
        const uint16_t *codes;
        const float *floats;
    } as;
};

void posts_init(Posts *posts, Arena *arena, int columns, int rows) {
    *posts = (Posts){.columns = columns, .rows = rows};
    posts->block_columns = (columns + POST_BLOCK - 1) / POST_BLOCK;
    posts->block_rows = (rows + POST_BLOCK - 1) / POST_BLOCK;
    posts->blocks = arena_new_array(arena, const PostBlock *, (size_t)posts->block_columns * (size_t)posts->block_rows);
}

static size_t block_index(const Posts *posts, int block_column, int block_row) {
    return (size_t)block_row * (size_t)posts->block_columns + (size_t)block_column;
}

static float block_height(const PostBlock *block, size_t at) {
    switch (block->kind) {
    case POSTS_EQUAL: return block->as.equal;
    case POSTS_FLOATS: return block->as.floats[at];
    case POSTS_CODES: break;
    }
    uint16_t code = block->as.codes[at];
    return code == CODE_VOID ? NAN : post_scale_apply(&block->scale, block->base + code);
}

float posts_get(const Posts *posts, int column, int row) {
    if (column < 0 || row < 0 || column >= posts->columns || row >= posts->rows) return NAN;
    const PostBlock *block = posts->blocks[block_index(posts, column / POST_BLOCK, row / POST_BLOCK)];
    return block ? block_height(block, (size_t)(row % POST_BLOCK) * POST_BLOCK + (size_t)(column % POST_BLOCK)) : NAN;
}

/* `count` neighbours within one row of one block. */
static void block_read(const PostBlock *block, size_t at, size_t count, float *out) {
    if (!block) {
        for (size_t i = 0; i < count; i++) out[i] = NAN;
    } else if (block->kind == POSTS_FLOATS) {
        memcpy(out, block->as.floats + at, count * sizeof *out);
    } else {
        for (size_t i = 0; i < count; i++) out[i] = block_height(block, at + i);
    }
}

static void read_row(const Posts *posts, int column, int row, int columns, float *out) {
    for (int c = column; c < column + columns;) {
        bool inside = row >= 0 && row < posts->rows && c >= 0 && c < posts->columns;
        int block_end = inside ? int_min((c / POST_BLOCK + 1) * POST_BLOCK, posts->columns) : c < 0 && row >= 0 && row < posts->rows ? 0 : column + columns;
        int end = int_min(block_end, column + columns);
        const PostBlock *block = inside ? posts->blocks[block_index(posts, c / POST_BLOCK, row / POST_BLOCK)] : NULL;
        size_t at = inside ? (size_t)(row % POST_BLOCK) * POST_BLOCK + (size_t)(c % POST_BLOCK) : 0;
        block_read(block, at, (size_t)(end - c), out + (c - column));
        c = end;
    }
}

void posts_read(const Posts *posts, int column, int row, int step, int columns, int rows, float *out, size_t stride) {
    for (int r = 0; r < rows; r++, out += stride) {
        if (step == 1)
            read_row(posts, column, row + r, columns, out);
        else
            for (int c = 0; c < columns; c++) out[c] = posts_get(posts, column + c * step, row + r * step);
    }
}

void posts_load_block(const Posts *posts, int block_column, int block_row, float out[POST_BLOCK_COUNT]) {
    posts_read(posts, block_column * POST_BLOCK, block_row * POST_BLOCK, 1, POST_BLOCK, POST_BLOCK, out, POST_BLOCK);
}

typedef struct BlockFacts {
    float low, high; /* low > high: all is void */
    bool voids;
} BlockFacts;

static BlockFacts facts_of(const float heights[POST_BLOCK_COUNT]) {
    BlockFacts facts = {INFINITY, -INFINITY, false};
    for (size_t i = 0; i < POST_BLOCK_COUNT; i++) {
        if (isnan(heights[i])) {
            facts.voids = true;
            continue;
        }
        facts.low = float_min(facts.low, heights[i]);
        facts.high = float_max(facts.high, heights[i]);
    }
    return facts;
}

/* The sample that became this height; it is only as good as the test of who asks. */
static double sample_of(const PostScale *scale, float height) {
    return round(((double)height / scale->unit - scale->offset) / scale->scale);
}

/* False where some height is no whole sample in the reach of codes. */
static bool encode(const float heights[POST_BLOCK_COUNT], const BlockFacts *facts, PostBlock *block, uint16_t codes[POST_BLOCK_COUNT]) {
    const PostScale *scale = &block->scale;
    block->base = double_min(sample_of(scale, facts->low), sample_of(scale, facts->high));
    for (size_t i = 0; i < POST_BLOCK_COUNT; i++) {
        if (isnan(heights[i])) {
            codes[i] = CODE_VOID;
            continue;
        }
        double code = sample_of(scale, heights[i]) - block->base;
        if (!(code >= 0 && code < CODE_VOID) || post_scale_apply(scale, block->base + code) != heights[i]) return false;
        codes[i] = (uint16_t)code;
    }
    return true;
}

void posts_store_block(Posts *posts, Arena *arena, int block_column, int block_row, const float heights[POST_BLOCK_COUNT],
                       const PostScale *scale) {
    BlockFacts facts = facts_of(heights);
    const PostBlock **place = &posts->blocks[block_index(posts, block_column, block_row)];
    *place = NULL;
    if (facts.low > facts.high) return;
    PostBlock *block = arena_new(arena, PostBlock);
    uint16_t codes[POST_BLOCK_COUNT];
    block->scale = *scale;
    if (facts.low == facts.high && !facts.voids) {
        block->kind = POSTS_EQUAL;
        block->as.equal = facts.low;
    } else if (encode(heights, &facts, block, codes)) {
        block->kind = POSTS_CODES;
        block->as.codes = arena_copy(arena, codes, sizeof codes);
    } else {
        block->kind = POSTS_FLOATS;
        block->as.floats = arena_copy(arena, heights, POST_BLOCK_COUNT * sizeof *heights);
    }
    *place = block;
}

bool posts_have_room(const Arena *arena, size_t size) {
    enum { GROWTH = 2 << 20 }; /* an arena takes more at a time than it is asked for */
    if (!memory_budget_take(arena->budget, size + GROWTH)) return false;
    memory_budget_give_back(arena->budget, size + GROWTH);
    return true;
}

size_t posts_voids_in(const Posts *posts, int block_column, int block_row) {
    int columns = int_min(POST_BLOCK, posts->columns - block_column * POST_BLOCK);
    int rows = int_min(POST_BLOCK, posts->rows - block_row * POST_BLOCK);
    const PostBlock *block = posts->blocks[block_index(posts, block_column, block_row)];
    size_t count = 0;
    if (!block) return (size_t)columns * (size_t)rows;
    if (block->kind == POSTS_EQUAL) return 0;
    for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++) count += isnan(block_height(block, (size_t)r * POST_BLOCK + (size_t)c)) ? 1 : 0;
    return count;
}
