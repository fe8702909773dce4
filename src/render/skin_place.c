/* Texture space: coordinates at a point of the skin, and the copies of a texel around a tile. */
#include "render/skin.h"

#include "base/random.h"
#include "render/skin_rim.h"

static double bilinear(const Bilinear *f, double a, double b) { return f->c[0] + f->c[1] * a + (f->c[2] + f->c[3] * a) * b; }

TexturePlace skin_texture_place(const SkinCell *cell, const SkinPoint *p) {
    Mat3 j;
    skin_cell_position(cell, p->a, p->b, p->w, &j);
    /* Rows of the inverse: ∂a/∂world, ∂b/∂world, ∂w/∂world. */
    Vec3 bc = vec3_cross(j.c[1], j.c[2]), ca = vec3_cross(j.c[2], j.c[0]), ab = vec3_cross(j.c[0], j.c[1]);
    double inverse = 1 / vec3_dot(j.c[0], bc);
    if (!isfinite(inverse)) inverse = 0;
    Vec3 da = vec3_scale(bc, inverse), db = vec3_scale(ca, inverse), dw = vec3_scale(ab, inverse);
    double foot = bilinear(&cell->w_foot, p->a, p->b), tip = bilinear(&cell->w_tip, p->a, p->b);
    TexturePlace out = {.u = bilinear(&cell->u, p->a, p->b),
                        .v = bilinear(&cell->v, p->a, p->b),
                        .w = foot + p->w * (tip - foot),
                        .grad_a = da,
                        .grad_b = db,
                        .grad_layer = dw};
    const Bilinear *u = &cell->u, *v = &cell->v, *f = &cell->w_foot, *t = &cell->w_tip;
    out.grad_u = vec3_madd(vec3_scale(da, u->c[1] + u->c[3] * p->b), db, u->c[2] + u->c[3] * p->a);
    out.grad_v = vec3_madd(vec3_scale(da, v->c[1] + v->c[3] * p->b), db, v->c[2] + v->c[3] * p->a);
    double w_a = (f->c[1] + f->c[3] * p->b) * (1 - p->w) + (t->c[1] + t->c[3] * p->b) * p->w;
    double w_b = (f->c[2] + f->c[3] * p->a) * (1 - p->w) + (t->c[2] + t->c[3] * p->a) * p->w;
    out.grad_w = vec3_madd(vec3_madd(vec3_scale(da, w_a), db, w_b), dw, tip - foot);
    return out;
}

Vec3 texel_normal_in_scene(const TexelCopy *copy, const TexturePlace *place, Vec3 n) {
    Vec3f e = copy->texel->extent;
    Vec3 x = vec3_madd(vec3_scale(place->grad_u, copy->xu), place->grad_v, copy->xv);
    Vec3 z = vec3_madd(vec3_scale(place->grad_u, copy->zu), place->grad_v, copy->zv);
    Vec3 out = vec3_scale(x, (double)e.x * n.x);
    out = vec3_madd(out, place->grad_w, copy->inverse_scale * (double)e.y * n.y);
    return vec3_madd(out, z, (double)e.z * n.z);
}

/* What a tile's hash decides about its copy. Each property reads its own bits, so that adding one changes no other. */
enum { CHANCE_DENSITY, CHANCE_FAMILY, CHANCE_U, CHANCE_V, CHANCE_ROTATE, CHANCE_SCALE, CHANCE_MIRROR, CHANCE_TINT,
       CHANCE_OTHER, CHANCE_ROW, CHANCE_COLUMN };

static double chance(const PlacedTexel *placed, int64_t iu, int64_t iv, uint64_t what) {
    return random_unit(random_hash((uint64_t)iu, (uint64_t)iv, what, placed->seed));
}

static void tint_copy(const PlacedTexel *placed, int64_t iu, int64_t iv, TexelCopy *copy) {
    if (!placed->jitter.tinted) return;
    float t = (float)chance(placed, iu, iv, CHANCE_TINT);
    Color a = placed->jitter.tint_a, b = placed->jitter.tint_b;
    copy->tint = vec3f_add(vec3f_scale(vec3f((float)a.red, (float)a.green, (float)a.blue), 1 - t),
                           vec3f_scale(vec3f((float)b.red, (float)b.green, (float)b.blue), t));
}

/* ---- tiling wang ---- */

static size_t one_of(const PlacedTexel *placed, int64_t iu, int64_t iv, uint64_t what, size_t count) {
    return size_min((size_t)(chance(placed, iu, iv, what) * (double)count), count - 1);
}

/* What lies at a place of the grid, of `count` ways. Two that lie side by side are never the same: that alone would show as a period of one tile. A place
 * that drew what its left or lower neighbour drew takes another; those of odd places are odd and of even places even, so that no two such are the same. */
static size_t wang_draw(const PlacedTexel *placed, int64_t iu, int64_t iv, size_t count) {
    size_t own = one_of(placed, iu, iv, CHANCE_FAMILY, count);
    if (count < 2) return own;
    size_t beside[4] = {one_of(placed, iu - 1, iv, CHANCE_FAMILY, count), one_of(placed, iu, iv - 1, CHANCE_FAMILY, count)};
    if (own != beside[0] && own != beside[1]) return own;
    beside[2] = one_of(placed, iu + 1, iv, CHANCE_FAMILY, count), beside[3] = one_of(placed, iu, iv + 1, CHANCE_FAMILY, count);
    size_t first = one_of(placed, iu, iv, CHANCE_OTHER, count), odd = (size_t)((iu ^ iv) & 1);
    for (int strict = 1; strict >= 0; strict--) /* of few there may be none that is of one kind and unlike all four */
        for (size_t i = 0; i < count; i++) {
            size_t other = (first + i) % count;
            if (strict && other % 2 != odd) continue;
            if (other != beside[0] && other != beside[1] && other != beside[2] && other != beside[3]) return other;
        }
    return own;
}

/* Of members with borders: a row has one class along x, a column one along z; where no member has both, the row's counts. */
static size_t wang_fitting(const PlacedTexel *placed, int64_t iu, int64_t iv) {
    const WangBorders *borders = placed->borders;
    size_t count = placed->family_size + placed->blanks, first = one_of(placed, iu, iv, CHANCE_FAMILY, count);
    uint32_t row = borders->class_x[one_of(placed, 0, iv, CHANCE_ROW, count)], column = borders->class_z[one_of(placed, iu, 0, CHANCE_COLUMN, count)];
    for (size_t i = 0; i < count; i++) {
        size_t member = (first + i) % count;
        if (borders->class_x[member] == row && borders->class_z[member] == column) return member;
    }
    while (borders->class_x[first] != row) first = (first + 1) % count;
    return first;
}

static bool wang_copy_of(const PlacedTexel *placed, int64_t iu, int64_t iv, TexelCopy *copy) {
    static const double cosines[4] = {1, 0, -1, 0}, sines[4] = {0, 1, 0, -1};
    size_t members = placed->family_size + placed->blanks, turns = (size_t)placed->turns, flips = placed->flips ? 2 : 1;
    if (placed->density < 1 && chance(placed, iu, iv, CHANCE_DENSITY) >= placed->density) return false;
    size_t drawn = placed->borders ? wang_fitting(placed, iu, iv) : wang_draw(placed, iu, iv, members * turns * flips);
    size_t member = drawn % members, quarters = drawn / members % turns * (4 / turns);
    if (member >= placed->family_size) return false;
    double c = cosines[quarters], s = sines[quarters], flip = drawn >= members * turns ? -1 : 1;
    *copy = (TexelCopy){.texel = placed->family[member], .inverse_scale = 1, .tint = {1, 1, 1}};
    double center_u = (double)iu + 0.5 + placed->shift_u, center_v = (double)iv + 0.5 + placed->shift_v;
    copy->xu = flip * c, copy->xv = flip * s;
    copy->zu = -s, copy->zv = c;
    copy->x0 = 0.5 - (copy->xu * center_u + copy->xv * center_v);
    copy->z0 = 0.5 - (copy->zu * center_u + copy->zv * center_v);
    tint_copy(placed, iu, iv, copy);
    return true;
}

/* Whether the tile at (du, dv) from one reaches into it: along a moved grid its own and the one before. */
static bool wang_reaches(const PlacedTexel *placed, int64_t du, int64_t dv) {
    return (du == 0 || (du == -1 && placed->shift_u > 0)) && (dv == 0 || (dv == -1 && placed->shift_v > 0));
}

/* ---- copies ---- */

bool texel_copy_of(const PlacedTexel *placed, int64_t iu, int64_t iv, TexelCopy *copy) {
    if (placed->turns) return wang_copy_of(placed, iu, iv, copy);
    const InstanceJitter *jitter = &placed->jitter;
    double share = placed->density * (placed->cyclic || !jitter->present ? 1 : jitter->density);
    if (share < 1 && chance(placed, iu, iv, CHANCE_DENSITY) >= share) return false;
    size_t member = 0;
    if (placed->family_size > 1)
        member = size_min((size_t)(chance(placed, iu, iv, CHANCE_FAMILY) * (double)placed->family_size), placed->family_size - 1);
    *copy = (TexelCopy){.texel = placed->family[member], .xu = 1, .zv = 1, .x0 = -(double)iu, .z0 = -(double)iv,
                        .inverse_scale = 1, .tint = {1, 1, 1}};
    if (!jitter->present) return true;
    tint_copy(placed, iu, iv, copy);
    if (placed->cyclic) return true;
    double center_u = (double)iu + 0.5 + jitter->displace * (chance(placed, iu, iv, CHANCE_U) - 0.5);
    double center_v = (double)iv + 0.5 + jitter->displace * (chance(placed, iu, iv, CHANCE_V) - 0.5);
    double angle = jitter->rotate * VTS_RADIANS * (chance(placed, iu, iv, CHANCE_ROTATE) - 0.5);
    double scale = 1 + jitter->scale * (chance(placed, iu, iv, CHANCE_SCALE) - 0.5);
    double flip = jitter->mirror && chance(placed, iu, iv, CHANCE_MIRROR) < 0.5 ? -1 : 1;
    /* Copy's unit square → turned and scaled about its centre; here the way back. */
    double c = cos(angle) / scale, s = sin(angle) / scale;
    copy->xu = flip * c, copy->xv = flip * s;
    copy->zu = -s, copy->zv = c;
    copy->x0 = 0.5 - (copy->xu * center_u + copy->xv * center_v);
    copy->z0 = 0.5 - (copy->zu * center_u + copy->zv * center_v);
    copy->inverse_scale = 1 / scale;
    return true;
}

/* Whether the copy's unit square comes near the tile: distance of the centres against the half diagonals. */
static bool may_cover(const TexelCopy *copy, int64_t iu, int64_t iv) {
    double u = (double)iu + 0.5, v = (double)iv + 0.5;
    double x = copy->xu * u + copy->xv * v + copy->x0, z = copy->zu * u + copy->zv * v + copy->z0;
    double half = 0.5 + 0.70711 * copy->inverse_scale;
    return fabs(x - 0.5) <= half && fabs(z - 0.5) <= half;
}

bool texel_copy_near(const PlacedTexel *placed, int64_t iu, int64_t iv, int k, TexelCopy *copy) {
    int reach = placed->reach, side = 2 * reach + 1;
    int64_t du = k % side - reach, dv = k / side - reach;
    if (placed->turns) return wang_reaches(placed, du, dv) && texel_copy_of(placed, iu + du, iv + dv, copy);
    return texel_copy_of(placed, iu + du, iv + dv, copy) && (reach == 0 || may_cover(copy, iu, iv));
}

static bool stands_beyond(const CompiledSkin *skin, const SkinCell *cell, const PlacedTexel *placed, int64_t iu, int64_t iv) {
    return skin->beyond && placed->overhang > 0 && tile_set_has(skin->beyond, cell->part, iu, iv);
}

bool skin_copy_of(const CompiledSkin *skin, const SkinCell *cell, const PlacedTexel *placed, int64_t iu, int64_t iv, TexelCopy *copy) {
    return !stands_beyond(skin, cell, placed, iu, iv) && texel_copy_of(placed, iu, iv, copy);
}

bool skin_copy_near(const CompiledSkin *skin, const SkinCell *cell, const PlacedTexel *placed, int64_t iu, int64_t iv, int k, TexelCopy *copy) {
    int reach = placed->reach, side = 2 * reach + 1;
    return !stands_beyond(skin, cell, placed, iu + k % side - reach, iv + k / side - reach) && texel_copy_near(placed, iu, iv, k, copy);
}
