#include "render/skin_walk.h"

#include "render/skin_box.h"

double skin_hair(const SkinCell *cell, const Ray *ray, double t) {
    Vec3 size = vec3_sub(cell->bounds.max, cell->bounds.min), far = vec3_madd(ray->origin, ray->direction, t);
    double extent = fabs(size.x) + fabs(size.y) + fabs(size.z), place = fabs(far.x) + fabs(far.y) + fabs(far.z) + fabs(t);
    return 1e-9 * extent + 4e-15 * place;
}

/* Leaves through the first face that the ray crosses outwards, but not at once through the one by which it came. */
static SkinStretch stretch_through(const CompiledSkin *skin, const Ray *ray, SkinPoint start, int entry, double t, double t_max) {
    const SkinCell *cell = &skin->cells[start.cell];
    SkinStretch out = {t, t, start, start, NO_FACE};
    SkinCrossing cross[MOST_CROSSINGS];
    double hair = skin_hair(cell, ray, t), turned = cell->side == CELL_MIRRORED ? -1 : 1;
    int count = skin_cell_cross(cell, ray, t - hair, t_max, cross);
    for (int i = 0; i < count; i++) {
        if (!(cross[i].outward * turned > 0) || (cross[i].face == entry && cross[i].t <= t + hair)) continue;
        out.t1 = double_max(t, cross[i].t);
        out.end = (SkinPoint){start.cell, cross[i].a, cross[i].b, cross[i].w};
        out.exit = cross[i].face;
        break;
    }
    return out;
}

/* Where the ray ends within the cell. */
static void end_within(const CompiledSkin *skin, const Ray *ray, double t_max, SkinStretch *s) {
    if (s->exit != NO_FACE || !isfinite(t_max)) return;
    SkinPoint end = s->start;
    const SkinCell *cell = &skin->cells[end.cell];
    Vec3 world = vec3_madd(ray->origin, ray->direction, t_max);
    if (!skin_cell_holds(cell, world, 1e-9 * vec3_length(vec3_sub(cell->bounds.max, cell->bounds.min)), &end)) return;
    s->t1 = t_max;
    s->end = end;
}

SkinStretch skin_stretch_from(const CompiledSkin *skin, const Ray *ray, SkinPoint start, double t, double t_max) {
    SkinStretch s;
    if (skin->box) {
        if (skin_box_stretch(skin->box, ray, t, t_max, &s)) return s;
        return (SkinStretch){t, t, start, start, NO_FACE};
    }
    s = stretch_through(skin, ray, start, NO_FACE, t, t_max);
    end_within(skin, ray, t_max, &s);
    return s;
}

bool skin_stretch_goes_on(const CompiledSkin *skin, const SkinStretch *s) {
    if (s->exit == NO_FACE || s->exit >= FACE_FOOT) return false;
    int32_t next = skin->cells[s->end.cell].neighbour[s->exit].cell;
    return next >= 0 && skin->cells[next].side == skin->cells[s->end.cell].side;
}

SkinStretch skin_stretch_next(const CompiledSkin *skin, const Ray *ray, const SkinStretch *last, double t_max) {
    SkinPoint start = last->end;
    int entry = skin_cross_edge(skin, last->exit, &start);
    SkinStretch s = stretch_through(skin, ray, start, entry, last->t1, t_max);
    end_within(skin, ray, t_max, &s);
    return s;
}

bool skin_stretch_first(const CompiledSkin *skin, const Ray *ray, double t_min, double t_max, SkinStretch *out) {
    if (skin->box) return skin_box_stretch(skin->box, ray, t_min, t_max, out);
    SkinPiece piece;
    if (!skin_first_pieces(skin, ray, double_max(t_min, 0), t_max, &piece, 1)) return false; /* Embree's rays begin at 0 or later */
    const SkinCell *cell = &skin->cells[piece.middle.cell];
    SkinPoint start = piece.middle;
    double tolerance = 1e-9 * vec3_length(vec3_sub(cell->bounds.max, cell->bounds.min));
    if (!skin_cell_invert(cell, vec3_madd(ray->origin, ray->direction, piece.t0), tolerance, &start)) start = piece.middle;
    start.w = double_clamp(start.w, 0, 1);
    *out = skin_stretch_from(skin, ray, start, piece.t0, t_max);
    if (out->exit == NO_FACE && out->t1 < piece.t1) { /* it touches the exit: as far as it is known to be inside */
        out->t1 = piece.t1;
        out->end = piece.middle;
        SkinPoint end = piece.middle;
        if (skin_cell_invert(cell, vec3_madd(ray->origin, ray->direction, piece.t1), tolerance, &end)) out->end = end;
    }
    return true;
}

bool skin_stretch_again(const CompiledSkin *skin, const Ray *ray, const SkinStretch *last, double t_max, SkinStretch *out) {
    double behind = last->t1 + skin_hair(&skin->cells[last->start.cell], ray, last->t1); /* not the same exit again */
    return behind < t_max && skin_stretch_first(skin, ray, behind, t_max, out);
}
