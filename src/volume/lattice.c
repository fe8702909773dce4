#include "volume/lattice.h"

enum { BLOCK = 4 };

static size_t node_index(const Lattice *l, int x, int y, int z) {
    return ((size_t)z * (size_t)l->nodes[1] + (size_t)y) * (size_t)l->nodes[0] + (size_t)x;
}

static size_t block_index(const Lattice *l, const int cell[3]) {
    return ((size_t)(cell[2] / BLOCK) * (size_t)l->blocks[1] + (size_t)(cell[1] / BLOCK)) * (size_t)l->blocks[0] + (size_t)(cell[0] / BLOCK);
}

void lattice_init(Lattice *l, const int size[3], Arena *arena) {
    size_t nodes = 1, blocks = 1;
    for (int k = 0; k < 3; k++) {
        l->size[k] = size[k];
        l->nodes[k] = size[k] + 2;
        l->blocks[k] = (size[k] + 1 + BLOCK - 1) / BLOCK;
        nodes *= (size_t)l->nodes[k], blocks *= (size_t)l->blocks[k];
    }
    l->values = arena_new_array(arena, float, nodes);
    l->block_most = arena_new_array(arena, float, blocks);
    l->most = 0;
}

void lattice_set(Lattice *l, int x, int y, int z, float value) { l->values[node_index(l, x + 1, y + 1, z + 1)] = value; }

/* Into all blocks of cells that have the node for a corner. */
static void raise_blocks(Lattice *l, const int node[3], float value) {
    for (int corner = 0; corner < 8; corner++) {
        int cell[3];
        bool within = true;
        for (int k = 0; k < 3; k++) {
            cell[k] = node[k] - (corner >> k & 1);
            within &= cell[k] >= 0 && cell[k] <= l->size[k];
        }
        if (!within) continue;
        float *most = &l->block_most[block_index(l, cell)];
        *most = float_max(*most, value);
    }
}

void lattice_finish(Lattice *l) {
    for (int z = 0; z < l->nodes[2]; z++)
        for (int y = 0; y < l->nodes[1]; y++)
            for (int x = 0; x < l->nodes[0]; x++) {
                int in[3] = {int_clamp(x, 1, l->size[0]), int_clamp(y, 1, l->size[1]), int_clamp(z, 1, l->size[2])};
                float value = l->values[node_index(l, in[0], in[1], in[2])];
                l->values[node_index(l, x, y, z)] = value;
                l->most = float_max(l->most, value);
                if (value > 0) raise_blocks(l, (int[3]){x, y, z}, value);
            }
}

/* The mean over the cells of `from` whose middles lie in this one. */
static float mean_of_block(const Lattice *l, const Lattice *from, const int at[3]) {
    int low[3], high[3];
    double sum = 0, count = 0;
    for (int k = 0; k < 3; k++) {
        double width = (double)from->size[k] / l->size[k];
        low[k] = int_clamp((int)ceil(at[k] * width - 0.5), 0, from->size[k] - 1);
        high[k] = int_clamp((int)ceil((at[k] + 1) * width - 0.5), low[k] + 1, from->size[k]);
    }
    for (int z = low[2]; z < high[2]; z++)
        for (int y = low[1]; y < high[1]; y++)
            for (int x = low[0]; x < high[0]; x++) sum += (double)from->values[node_index(from, x + 1, y + 1, z + 1)], count++;
    return (float)(sum / count);
}

void lattice_coarsen(Lattice *l, const Lattice *from, const int size[3], Arena *arena) {
    int at[3];
    lattice_init(l, size, arena);
    for (at[2] = 0; at[2] < size[2]; at[2]++)
        for (at[1] = 0; at[1] < size[1]; at[1]++)
            for (at[0] = 0; at[0] < size[0]; at[0]++) lattice_set(l, at[0], at[1], at[2], mean_of_block(l, from, at));
    lattice_finish(l);
}

void lattice_clamp(Lattice *l, const Lattice *from, float most, Arena *arena) {
    const size_t count = (size_t)from->nodes[0] * (size_t)from->nodes[1] * (size_t)from->nodes[2];
    lattice_init(l, from->size, arena);
    for (size_t i = 0; i < count; i++) l->values[i] = float_min(from->values[i], most);
    lattice_finish(l);
}

double lattice_mean(const Lattice *l) {
    double sum = 0;
    for (int z = 1; z <= l->size[2]; z++)
        for (int y = 1; y <= l->size[1]; y++)
            for (int x = 1; x <= l->size[0]; x++) sum += (double)l->values[node_index(l, x, y, z)];
    return sum / ((double)l->size[0] * l->size[1] * l->size[2]);
}

static double between(const float *v, double x) { return (double)v[0] + x * ((double)v[1] - (double)v[0]); }

/* Within a cell, also a little beside it. */
static double cell_value(const Lattice *l, const int cell[3], Vec3 p) {
    const float *v = l->values + node_index(l, cell[0], cell[1], cell[2]);
    size_t row = (size_t)l->nodes[0], slice = row * (size_t)l->nodes[1];
    double x = p.x - cell[0], y = p.y - cell[1], z = p.z - cell[2];
    double c00 = between(v, x), c10 = between(v + row, x), c01 = between(v + slice, x), c11 = between(v + slice + row, x);
    double c0 = c00 + y * (c10 - c00), c1 = c01 + y * (c11 - c01);
    return double_max(0, c0 + z * (c1 - c0));
}

static int cell_of(const Lattice *l, int k, double place) { return double_to_int(floor(place), 0, l->size[k]); }

double lattice_value(const Lattice *l, Vec3 p) {
    p = vec3(double_clamp(p.x, 0.5, l->size[0] + 0.5), double_clamp(p.y, 0.5, l->size[1] + 0.5), double_clamp(p.z, 0.5, l->size[2] + 0.5));
    const int cell[3] = {cell_of(l, 0, p.x), cell_of(l, 1, p.y), cell_of(l, 2, p.z)};
    return cell_value(l, cell, p);
}

/* ---- walking ---- */

/* Sets cells and walls for the place at t. */
static void settle(LatticeWalk *w) {
    for (int k = 0; k < 3; k++) {
        double o = vec3_get(w->ray.origin, k), d = vec3_get(w->ray.direction, k), place = o + w->t * d;
        w->cell[k] = cell_of(w->lattice, k, place);
        if (d < 0 && place == w->cell[k] && w->cell[k] > 0) w->cell[k]--;
        w->step[k] = d > 0 ? 1 : -1;
        w->width[k] = d != 0 ? 1 / fabs(d) : VTS_INFINITY;
        w->next[k] = d != 0 ? (w->cell[k] + (d > 0) - o) / d : VTS_INFINITY;
    }
}

void lattice_walk_begin(LatticeWalk *w, const Lattice *lattice, const Ray *ray, double t0, double t1) {
    *w = (LatticeWalk){.lattice = lattice, .ray = *ray, .t = t0, .t_end = t1};
    if (t0 < t1) settle(w);
}

/* Past the empty block around the cell; false at the end of the ray. */
static bool skip_block(LatticeWalk *w) {
    double out = w->t_end;
    int axis = -1;
    for (int k = 0; k < 3; k++) {
        double o = vec3_get(w->ray.origin, k), d = vec3_get(w->ray.direction, k);
        if (d == 0) continue;
        double wall = w->cell[k] / BLOCK * BLOCK + (d > 0 ? BLOCK : 0), t = (wall - o) / d;
        if (t < out) out = t, axis = k;
    }
    if (axis < 0) return false;
    int wall = w->cell[axis] / BLOCK * BLOCK + (w->step[axis] > 0 ? BLOCK : -1);
    int before[3] = {w->cell[0], w->cell[1], w->cell[2]};
    before[axis] = int_clamp(wall, 0, w->lattice->size[axis]);
    w->t = double_max(w->t, out);
    settle(w);
    for (int k = 0; k < 3; k++) { /* never back, whatever rounding says: where two walls meet the ray would go to and fro between empty blocks */
        if (k != axis && (w->step[k] > 0 ? w->cell[k] >= before[k] : w->cell[k] <= before[k])) continue;
        double o = vec3_get(w->ray.origin, k), d = vec3_get(w->ray.direction, k);
        w->cell[k] = before[k];
        w->next[k] = d != 0 ? (w->cell[k] + (d > 0) - o) / d : VTS_INFINITY;
    }
    return wall == w->cell[axis];
}

static double density_at(const LatticeWalk *w, const int cell[3], double t) {
    return cell_value(w->lattice, cell, vec3_madd(w->ray.origin, w->ray.direction, t));
}

static double integral(const LatticeWalk *w, const int cell[3], double t0, double t1) {
    static const double node = 0.57735026918962576451; /* 1/sqrt 3 */
    double middle = (t0 + t1) / 2, half = (t1 - t0) / 2;
    return half * (density_at(w, cell, middle - node * half) + density_at(w, cell, middle + node * half));
}

bool lattice_walk_next(LatticeWalk *w, LatticePiece *piece) {
    while (w->t < w->t_end) {
        if (!(w->lattice->block_most[block_index(w->lattice, w->cell)] > 0)) {
            if (!skip_block(w)) break;
            continue;
        }
        int axis = w->next[0] < w->next[1] ? (w->next[0] < w->next[2] ? 0 : 2) : (w->next[1] < w->next[2] ? 1 : 2);
        double t0 = w->t, t1 = double_min(double_max(w->next[axis], t0), w->t_end);
        *piece = (LatticePiece){.t0 = t0, .t1 = t1, .cell = {w->cell[0], w->cell[1], w->cell[2]}};
        if (t1 > t0) piece->length = integral(w, piece->cell, t0, t1);
        int moved = w->cell[axis] + w->step[axis];
        if (w->next[axis] >= w->t_end || moved < 0 || moved > w->lattice->size[axis]) {
            w->t = w->t_end;
        } else {
            w->cell[axis] = moved;
            w->next[axis] += w->width[axis];
            w->t = t1;
        }
        if (piece->length > 0) return true;
    }
    w->t = w->t_end;
    return false;
}

double lattice_piece_invert(const LatticeWalk *w, const LatticePiece *piece, double length) {
    double lo = piece->t0, hi = piece->t1, t = lo + (hi - lo) * length / piece->length;
    for (int i = 0; i < 40 && hi - lo > 1e-12 * (piece->t1 - piece->t0); i++) {
        double over = integral(w, piece->cell, piece->t0, t) - length, density = density_at(w, piece->cell, t);
        if (fabs(over) <= 1e-12 * piece->length) break;
        if (over > 0) hi = t;
        else lo = t;
        double newton = density > 0 ? t - over / density : lo;
        t = newton > lo && newton < hi ? newton : (lo + hi) / 2;
    }
    return t;
}
