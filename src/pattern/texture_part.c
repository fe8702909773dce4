/* Textures that are made of textures, and the layers of plain ones. */
#include "pattern/bump.h"
#include "pattern/pattern.h"
#include "pattern/pigment.h"
#include "pattern/values.h"

#include <string.h>

typedef struct PartList {
    TexturePart *items;
    size_t count, most;
} PartList;

static bool same_part(const TexturePart *a, const TexturePart *b) {
    return a->texture == b->texture && a->space == b->space && memcmp(&a->spot.p, &b->spot.p, sizeof a->spot.p) == 0;
}

/* Shares of one texture, from places of the footprint or pieces of its map, are one part. A full list loses its lightest. */
static void add_part(PartList *list, const TexturePart *part) {
    for (size_t i = 0; i < list->count; i++)
        if (same_part(&list->items[i], part)) {
            list->items[i].weight += part->weight;
            return;
        }
    if (list->count < list->most) {
        list->items[list->count++] = *part;
        return;
    }
    size_t lightest = 0;
    for (size_t i = 1; i < list->count; i++)
        if (list->items[i].weight < list->items[lightest].weight) lightest = i;
    if (list->items[lightest].weight < part->weight) list->items[lightest] = *part;
}

typedef struct Choice {
    PartList *list;
    const TextureMap *map;
    TexturePart inner;
    double weight;
} Choice;

static void collect(PartList *list, const TexturePart *part);

static void take_choice(void *target, size_t entry, double share) {
    Choice *choice = target;
    TexturePart part = choice->inner;
    if (!(share > 0)) return;
    part.texture = choice->map->textures[size_min(entry, choice->map->count - 1)];
    part.weight = choice->weight * share;
    collect(choice->list, &part);
}

static void collect(PartList *list, const TexturePart *part) {
    const Texture *texture = part->texture;
    const TextureMap *map = texture->map;
    if (!map) {
        add_part(list, part);
        return;
    }
    Spot spot = part->spot;
    Mat3 linear = part->linear;
    const Transform *chain[] = {part->space, &texture->transform, &map->pattern->transform};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(chain); i++)
        if (chain[i]) linear = mat3_multiply(&linear, &chain[i]->linear);
    for (size_t i = map->pattern->warp_count; i-- > 0;) linear = mat3_multiply(&linear, &map->pattern->warps[i].inner.linear);
    for (size_t i = 0; i < 2; i++)
        if (chain[i]) spot = spot_back(&spot, chain[i]);
    spot = spot_in_pattern(map->pattern, &spot, pattern_traits(map->pattern->kind).warps_itself);
    Choice choice = {list, map, {.spot = spot, .linear = linear}, part->weight};
    pattern_blend(map->pattern, &spot, take_choice, &choice);
}

static Spot spot_of_place(const SurfacePlace *place) {
    bool known = vec3_length_squared(place->axes[0]) + vec3_length_squared(place->axes[1]) > 0;
    Spot spot = spot_make(place->point, place->normal, known ? 0 : place->footprint);
    if (known) spot.axes[0] = place->axes[0], spot.axes[1] = place->axes[1];
    spot.surface = &place->surface;
    return spot;
}

size_t texture_parts(const Texture *texture, const SurfacePlace *place, TexturePart *out, size_t most) {
    static const Mat3 identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    if (!texture->map) {
        *out = (TexturePart){texture, 1, spot_of_place(place), place->space, identity};
        return 1;
    }
    PartList list = {.items = out, .most = most};
    TexturePart whole = {texture, 1, spot_of_place(place), place->space, identity};
    collect(&list, &whole);
    double sum = 0;
    for (size_t i = 0; i < list.count; i++) sum += out[i].weight;
    if (!(sum > 0)) { /* `average` with weights of no sum, values that are no numbers */
        whole.texture = texture->map ? texture->map->textures[0] : texture;
        for (int k = 0; whole.texture->map && k < PIGMENT_DEEPEST; k++) whole.texture = whole.texture->map->textures[0];
        out[0] = whole;
        return 1;
    }
    for (size_t i = 0; i < list.count; i++) out[i].weight /= sum;
    return list.count;
}

Color texture_layer_color(const TexturePart *part, const Texture *layer, Vec3 normal) {
    if (layer->pigment->kind == PATTERN_SOLID) return layer->pigment->color;
    Spot spot = part->space ? spot_back(&part->spot, part->space) : part->spot;
    spot = spot_back(&spot, &layer->transform);
    spot.normal = normal;
    return pigment_color_at(layer->pigment, &spot);
}

static Spot narrowed(Spot spot, double width) {
    for (int k = 0; k < 3; k++) spot.axes[k] = vec3_scale(spot.axes[k], width);
    spot.blur *= width;
    return spot;
}

Vec3 texture_layer_normal(const TexturePart *part, const Texture *layer, Vec3 normal, double width) {
    if (!layer->normal) return normal;
    const Spot spot = narrowed(part->spot, width);
    BumpPlace place = {.spot = &spot, .outer = {part->space, &layer->transform}};
    Vec3 n = vec3_normalize(mat3_apply_transposed(&part->linear, normal));
    Mat3 back;
    if (!mat3_invert(&part->linear, &back)) return normal;
    Vec3 bent = vec3_normalize(mat3_apply_transposed(&back, bump_normal(layer->normal, &place, n)));
    return vec3_is_finite(bent) && vec3_length_squared(bent) > 0 ? bent : normal;
}
