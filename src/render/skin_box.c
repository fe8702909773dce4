#include "render/skin_box.h"

/* What differs by less than this share of the box's size is straight. */
static const double STRAIGHT = 1e-12;

static bool is_straight(const Bilinear *f) { return fabs(f->c[3]) <= STRAIGHT * (fabs(f->c[0]) + fabs(f->c[1]) + fabs(f->c[2])); }

static bool is_constant(const Bilinear *f) {
    return is_straight(f) && fabs(f->c[1]) + fabs(f->c[2]) <= STRAIGHT * fabs(f->c[0]);
}

static bool is_box(const SkinCell *cell) {
    const Vec3 *foot = cell->foot.c, *height = cell->height.c;
    double size = vec3_length(foot[1]) + vec3_length(foot[2]) + vec3_length(height[0]);
    if (cell->triangle || cell->rim || (cell->side != CELL_UPRIGHT && cell->side != CELL_MIRRORED)) return false;
    for (int i = 0; i < 4; i++)
        if (cell->neighbour[i].cell >= 0) return false;
    return vec3_length(foot[3]) + vec3_length(height[1]) + vec3_length(height[2]) + vec3_length(height[3]) <= STRAIGHT * size &&
           is_straight(&cell->u) && is_straight(&cell->v) && is_constant(&cell->w_foot) && is_constant(&cell->w_tip);
}

const SkinBox *skin_box_of(const CompiledSkin *skin, Arena *arena) {
    if (skin->cell_count != 1 || skin->overlaps || !is_box(&skin->cells[0])) return NULL;
    Vec3 a = skin->cells[0].foot.c[1], b = skin->cells[0].foot.c[2], w = skin->cells[0].height.c[0];
    double inverse = 1 / vec3_dot(a, vec3_cross(b, w));
    SkinBox box = {skin->cells[0].foot.c[0],
                   {vec3_scale(vec3_cross(b, w), inverse), vec3_scale(vec3_cross(w, a), inverse), vec3_scale(vec3_cross(a, b), inverse)}};
    for (int i = 0; i < 3; i++)
        if (!isfinite(vec3_length_squared(box.row[i]))) return NULL;
    return arena_copy(arena, &box, sizeof box);
}

static SkinPoint point_at(const double from[3], const double rate[3], double t) {
    return (SkinPoint){0, from[0] + rate[0] * t, from[1] + rate[1] * t, from[2] + rate[2] * t};
}

bool skin_box_stretch(const SkinBox *box, const Ray *ray, double t_min, double t_max, SkinStretch *out) {
    static const int face[3][2] = {{3, 1}, {0, 2}, {FACE_FOOT, FACE_TOP}}; /* where a, b and w are 0 and 1 */
    Vec3 origin = vec3_sub(ray->origin, box->corner);
    double from[3], rate[3];
    out->t0 = t_min, out->t1 = t_max, out->exit = NO_FACE;
    for (int k = 0; k < 3; k++) {
        from[k] = vec3_dot(box->row[k], origin), rate[k] = vec3_dot(box->row[k], ray->direction);
        if (rate[k] == 0) {
            if (!(from[k] >= 0 && from[k] <= 1)) return false;
            continue;
        }
        double inverse = 1 / rate[k], first = -from[k] * inverse, second = (1 - from[k]) * inverse;
        bool up = rate[k] > 0;
        out->t0 = double_max(out->t0, up ? first : second);
        if ((up ? second : first) < out->t1) out->t1 = up ? second : first, out->exit = face[k][up];
    }
    if (!(out->t1 > out->t0) || !isfinite(out->t1)) return false;
    out->start = point_at(from, rate, out->t0);
    out->end = point_at(from, rate, out->t1);
    return true;
}
