#include "render/pixel_edge.h"

#include "render/contrast.h"

/* Lights are the same that differ by so much of what the two differ. */
static const float ALIKE = 0.2f;

static float difference(Vec3f a, Vec3f b) {
    Vec3f off = vec3f_sub(a, b);
    return vec3f_dot(off, off);
}

/* Patterns are averaged over each pixel already. */
static bool differ_by_pattern(const Cell *a, const Cell *b) {
    const Vec3f c = a->tint.color, d = b->tint.color;
    return a->object == b->object && a->tint.texture && a->tint.texture == b->tint.texture && (c.x != d.x || c.y != d.y || c.z != d.z);
}

static const Cell *cell_around(const Cell *cell, int k) { return cell + (k / 3 - 1) * CONTRAST_EDGE + k % 3 - 1; }

/* The middle whose light is the furthest from the cell's; the cell itself if all have the same. */
static const Cell *other_light(const Cell *cell, float *apart) {
    const Cell *other = cell;
    *apart = 0;
    for (int k = 0; k < 9; k++) {
        const float off = difference(cell_around(cell, k)->first, cell->first);
        if (off > *apart) *apart = off, other = cell_around(cell, k);
    }
    return other;
}

/* On which side the light lies; -1: it is neither. */
static int side_of(const PixelEdge *edge, Vec3f shown) {
    const float here = difference(shown, edge->cell->first), there = difference(shown, edge->other->first);
    return !(float_min(here, there) <= ALIKE * ALIKE * edge->apart) ? -1 : there < here;
}

static void add_point(PixelEdge *edge, float x, float y, int side, const Radiance *seen) {
    EdgePoints *points = &edge->points;
    Radiance *sum = &edge->sums[side];
    points->x[points->count] = x, points->y[points->count] = y;
    points->beyond[points->count++] = side == 1;
    sum->color = vec3f_add(sum->color, seen->color);
    sum->alpha += seen->alpha;
    edge->counts[side]++;
}

bool pixel_edge_begin(const Cell *cell, PixelEdge *edge) {
    edge->cell = cell;
    edge->other = other_light(cell, &edge->apart);
    edge->points.count = 0;
    edge->sums[0] = edge->sums[1] = (Radiance){{0, 0, 0}, 0};
    edge->counts[0] = edge->counts[1] = 0;
    if (edge->other == cell) return false;
    for (int k = 0; k < 9; k++) {
        const Cell *around = cell_around(cell, k);
        const int side = side_of(edge, around->first);
        if (side < 0 || (side == 1 && differ_by_pattern(cell, around))) return false;
        add_point(edge, (float)(k % 3 - 1), (float)(k / 3 - 1), side, &around->middle);
    }
    return edge_fit(&edge->points, &edge->fit);
}

bool pixel_edge_add(PixelEdge *edge, float x, float y, const Radiance *seen) {
    const int side = side_of(edge, light_shown(seen->color));
    if (side < 0 || edge->points.count == EDGE_POINTS) return false;
    add_point(edge, x, y, side, seen);
    return edge_fit(&edge->points, &edge->fit);
}

Radiance pixel_edge_light(const PixelEdge *edge) {
    const float here = (1 - edge->fit.beyond) / (float)edge->counts[0], beyond = edge->fit.beyond / (float)edge->counts[1];
    const Radiance *sums = edge->sums;
    return (Radiance){vec3f_madd(vec3f_scale(sums[0].color, here), sums[1].color, beyond), sums[0].alpha * here + sums[1].alpha * beyond};
}

float pixel_edge_error(const PixelEdge *edge) { return edge->fit.variance * edge->apart / 3; }
