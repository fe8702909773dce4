#include "render/shared_light.h"

#include "render/contrast.h"

/* Of the middles two at least have to see as smooth a part of the same surface, and agree. */
static const double SAME_NORMAL = 0.98, SHARED_RANGE = 4;
static const float NEAREST = 0.05f;

static float most_of(Vec3f c) { return float_max(c.x, float_max(c.y, c.z)); }

/* The middles around a sample that see the same as it. */
typedef struct Shared {
    Vec3f color, least, most;
    float alpha, weight;
    int count;
} Shared;

static void share_middle(Shared *shared, const Cell *cell, Vec3f color, float dx, float dy) {
    float weight = 1 / (dx * dx + dy * dy + NEAREST);
    Vec3f light = light_shown(color);
    if (shared->count++ == 0) shared->least = shared->most = light;
    shared->least = vec3f(float_min(shared->least.x, light.x), float_min(shared->least.y, light.y),
                          float_min(shared->least.z, light.z));
    shared->most = vec3f(float_max(shared->most.x, light.x), float_max(shared->most.y, light.y),
                         float_max(shared->most.z, light.z));
    shared->color = vec3f_madd(shared->color, color, weight);
    shared->alpha += cell->middle.alpha * weight;
    shared->weight += weight;
}

typedef struct Near {
    const Cell *cell;
    int column, row; /* from that which is asked about */
} Near;

/* The middles about a cell that see as smooth a part of the same surface as a sample. */
static int same_around(const Cell *cell, const SurfaceHit *hit, Near out[9]) {
    uint32_t object = hit ? hit->object + 1 : 0;
    Vec3f normal = hit ? vec3f_from(hit->normal) : vec3f(0, 0, 0);
    int count = 0;
    for (int row = -1; row <= 1; row++)
        for (int column = -1; column <= 1; column++) {
            const Cell *other = cell + row * CONTRAST_EDGE + column;
            if (other->object == object && (!object || (double)vec3f_dot(other->normal, normal) >= SAME_NORMAL)) out[count++] = (Near){other, column, row};
        }
    return count;
}

/* Where the averages of a pattern over several pixels are exactly the same there is no other colour. */
static SurfaceTint tint_among(const Near same[9], int count, const SharedPlace *place) {
    enum { ENOUGH_EQUAL = 4 };
    SurfaceTint tint = same[0].cell->tint;
    bool tinted = false, equal = count >= ENOUGH_EQUAL;
    for (int i = 0; i < count; i++) {
        const SurfaceTint *other = &same[i].cell->tint;
        tinted |= other->texture != NULL;
        equal &= other->texture == tint.texture && other->color.x == tint.color.x && other->color.y == tint.color.y && other->color.z == tint.color.z;
    }
    if (!tinted) tint.texture = NULL;
    else if (!equal) surface_tint(place->cone, place->hit, &tint);
    return tint;
}

bool shared_light(const Cell *cell, const SharedPlace *place, double max_error, Radiance *out) {
    Near same[9];
    Shared shared = {.count = 0};
    int count = same_around(cell, place->hit, same);
    if (count < 2) return false;
    const float x = (float)place->x - 0.5f, y = (float)place->y - 0.5f;
    const SurfaceTint tint = tint_among(same, count, place);
    for (int i = 0; i < count; i++) {
        const Cell *other = same[i].cell;
        if (other->tint.texture != tint.texture) continue;
        share_middle(&shared, other, middle_as(other->middle.color, &other->tint, &tint), x - (float)same[i].column, y - (float)same[i].row);
    }
    Vec3f range = vec3f_sub(shared.most, shared.least);
    if (shared.count < 2 || (double)most_of(range) > SHARED_RANGE * max_error)
        return false;
    *out = (Radiance){vec3f_scale(shared.color, 1 / shared.weight), shared.alpha / shared.weight};
    return true;
}

bool shared_but_pattern(const Cell *cell, double max_error) {
    if (!cell->tint.texture) return false;
    for (int row = -1; row <= 1; row++)
        for (int column = -1; column <= 1; column++) {
            const Cell *other = cell + row * CONTRAST_EDGE + column;
            if (other->object != cell->object || other->tint.texture != cell->tint.texture) return false;
            Vec3f apart = vec3f_sub(middle_as(other->middle.color, &other->tint, &cell->tint), cell->middle.color);
            if (!((double)most_of(vec3f(fabsf(apart.x), fabsf(apart.y), fabsf(apart.z))) <= SHARED_RANGE * max_error)) return false;
        }
    return true;
}
