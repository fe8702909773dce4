#include "render/cell.h"

/* The squared error of a mean from the squared difference of its halves: 1/4 if they were random, less where they are parts of a net. */
static const double HALVES_TO_ERROR = 0.2;

/* Number by number: a tile has a thousand of them, and clearing one as a whole takes longer. */
void cell_begin(Cell *cell, const Middle *m) {
    cell->error = 0, cell->contrast = 0, cell->class = 0;
    cell->net = cell->late_count = 0;
    cell->probe = cell->checked = cell->misled = cell->edged = cell->traced = false;
    cell->edge_error = cell->squares = 0;
    cell->sum = cell->edge = (Radiance){{0, 0, 0}, 0};
    cell->shown = cell->late = vec3f(0, 0, 0);
    cell->centred = true;
    cell->refinable = m->refinable;
    cell->doubt = m->doubt;
    cell->object = m->object;
    cell->normal = m->normal;
    cell->tint = m->tint;
    cell->middle = m->seen;
    cell->first = cell->mean = light_shown(m->seen.color);
}

void cell_add(Cell *cell, const Radiance *seen) {
    Vec3f light = light_shown(seen->color);
    cell->net++;
    cell->sum.color = vec3f_add(cell->sum.color, seen->color);
    cell->sum.alpha += seen->alpha;
    cell->shown = vec3f_add(cell->shown, light);
    cell->squares += vec3f_dot(light, light);
    cell->late = vec3f_add(cell->late, light);
    cell->late_count++;
}

/* Clamped, over all that counts. */
Vec3f cell_shown_sum(const Cell *cell) {
    return cell_counts_middle(cell) ? vec3f_add(cell->shown, cell->first) : cell->shown;
}
float cell_squares_sum(const Cell *cell) {
    return cell->squares + (cell_counts_middle(cell) ? vec3f_dot(cell->first, cell->first) : 0);
}

Radiance cell_light(const Cell *cell) {
    if (cell->edged) return cell->edge;
    int count = cell_count(cell);
    float share = count ? 1 / (float)count : 0;
    Radiance sum = cell->sum;
    if (cell_counts_middle(cell))
        sum = (Radiance){vec3f_add(sum.color, cell->middle.color), sum.alpha + cell->middle.alpha};
    return (Radiance){vec3f_scale(sum.color, share), sum.alpha * share};
}

double cell_halves_error(const Cell *cell) {
    int early = cell_count(cell) - cell->late_count;
    if (early < 1 || cell->late_count < 1) return 0;
    Vec3f a = vec3f_scale(cell->late, 1 / (float)cell->late_count),
          b = vec3f_scale(vec3f_sub(cell_shown_sum(cell), cell->late), 1 / (float)early);
    return HALVES_TO_ERROR * (double)light_mean_square(vec3f_sub(a, b));
}

double cell_variance(const Cell *cell) {
    double n = cell_count(cell), squares = (double)cell_squares_sum(cell) / n,
           mean = (double)vec3f_dot(cell->mean, cell->mean);
    return fmax(squares - mean, 0) * n / (n - 1) / 3;
}
