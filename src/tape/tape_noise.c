#include "tape/tape_noise.h"

#include "tape/tape_program.h"

enum { MOST_DEPTH = 64 };

/* by·p + plus, and the same of absolute values. */
typedef struct Linear {
    double by[3], plus, size[3], plus_size;
} Linear;

static void add_to(Linear *sum, const Linear *part, double scale) {
    for (int k = 0; k < 3; k++) sum->by[k] += scale * part->by[k], sum->size[k] += fabs(scale) * part->size[k];
    sum->plus += scale * part->plus, sum->plus_size += fabs(scale) * part->plus_size;
}

static bool constant_of(const Tape *tape, TapeRef ref, double *value) {
    if (tape->nodes[ref].op != TAPE_CONSTANT) return false;
    *value = tape_node_constant(&tape->nodes[ref]);
    return isfinite(*value);
}

/* Adds scale·node; false: it is not linear. `steps` counts operations that round. */
static bool find_linear(const Tape *tape, TapeRef ref, double scale, Linear *out, int *steps) {
    const TapeNode *node = &tape->nodes[ref];
    double k;
    if (++*steps > MOST_DEPTH || !isfinite(scale)) return false;
    if (constant_of(tape, ref, &k)) return add_to(out, &(Linear){.plus = k, .plus_size = fabs(k)}, scale), true;
    if (node->op == TAPE_INPUT) return out->by[node->a] += scale, out->size[node->a] += fabs(scale), true;
    if (node->op == TAPE_NEG) return find_linear(tape, node->a, -scale, out, steps);
    if (node->op == TAPE_ADD) return find_linear(tape, node->a, scale, out, steps) && find_linear(tape, node->b, scale, out, steps);
    if (node->op == TAPE_SUB) return find_linear(tape, node->a, scale, out, steps) && find_linear(tape, node->b, -scale, out, steps);
    if (node->op == TAPE_MUL && constant_of(tape, node->a, &k)) return find_linear(tape, node->b, scale * k, out, steps);
    if (node->op == TAPE_MUL && constant_of(tape, node->b, &k)) return find_linear(tape, node->a, scale * k, out, steps);
    if (node->op == TAPE_DIV && constant_of(tape, node->b, &k) && k != 0) return find_linear(tape, node->a, scale / k, out, steps);
    return false;
}

static bool is_plain(const Linear *l) {
    double sum = l->plus_size;
    for (int k = 0; k < 3; k++) sum += l->size[k];
    return sum < 0x1p500; /* what tiny factors lose is below 2⁻¹⁰⁰⁰ */
}

const TapeNoise *tape_noise_of(const Tape *tape, Arena *arena) {
    const TapeNode *node = &tape->nodes[tape->outputs[0]];
    if ((node->op != TAPE_PERLIN && node->op != TAPE_POV_NOISE) || tape->input_count != 3) return NULL;
    const TapeRef arguments[3] = {node->a, node->b, node->c};
    TapeNoise noise = {.kind = node->op == TAPE_PERLIN ? NOISE_IS_PERLIN : NOISE_IS_POV};
    int most = 0;
    for (int i = 0; i < 3; i++) {
        Linear linear = {{0}, 0, {0}, 0};
        int steps = 0;
        if (!find_linear(tape, arguments[i], 1, &linear, &steps) || !is_plain(&linear)) return NULL;
        for (int k = 0; k < 3; k++) noise.by[i][k] = linear.by[k], noise.size[i][k] = linear.size[k];
        noise.plus[i] = linear.plus, noise.plus_size[i] = linear.plus_size;
        most = steps > most ? steps : most;
    }
    /* Each step of the tape rounds twice at most, as it does here. */
    noise.rounding = 0x1p-48 + most * 0x1p-50;
    TapeNoise *out = arena_new(arena, TapeNoise);
    *out = noise;
    return out;
}

TapeNoiseWay tape_noise_along(const TapeNoise *noise, Vec3 origin, Vec3 direction) {
    const double from[3] = {origin.x, origin.y, origin.z}, along[3] = {direction.x, direction.y, direction.z};
    TapeNoiseWay way = {{0}, {0}, 0, 0x1p-1000, 0};
    for (int i = 0; i < 3; i++) {
        way.origin[i] = noise->plus[i], way.off += noise->rounding * noise->plus_size[i];
        for (int k = 0; k < 3; k++) {
            way.origin[i] += noise->by[i][k] * from[k], way.along[i] += noise->by[i][k] * along[k];
            way.off += noise->rounding * noise->size[i][k] * fabs(from[k]), way.off_by += noise->rounding * noise->size[i][k] * fabs(along[k]);
        }
        way.length += way.along[i] * way.along[i];
    }
    /* Forms' slopes may be off by as much as places are. */
    way.length = (sqrt(way.length) + way.off_by) * (1 + 0x1p-48);
    return way;
}

void tape_noise_lanes(const TapeNoise *noise, const TapeNoiseWay *way, const double *restrict middle, const double *restrict half,
                      AffineLanes *restrict out) {
    NoisePieces pieces;
    for (int k = 0; k < 3; k++) {
        const double origin = way->origin[k], along = way->along[k];
        AFFINE_EACH_LANE pieces.way.at[k][l] = origin + middle[l] * along, pieces.way.way[k][l] = half[l] * along;
    }
    const double length = way->length, off = way->off, off_by = way->off_by;
    AFFINE_EACH_LANE {
        double own = off + (fabs(middle[l]) + half[l]) * off_by;
        pieces.length[l] = half[l] * length, pieces.off[l] = own;
        pieces.unknown[l] = 0 * (own + (pieces.way.at[0][l] + pieces.way.at[1][l] + pieces.way.at[2][l]));
    }
    affine_noise_pieces(out, &pieces, noise->kind);
}
