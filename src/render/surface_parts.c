#include "render/surface_parts.h"

static double own_weight(const SurfaceHit *hit) {
    double weight = 1;
    for (int i = 0; i < hit->share_count; i++) weight -= hit->shares[i].weight;
    return weight;
}

static void add_look(const Look *look, double weight, SurfaceParts *out, const SurfacePlace *place) {
    TexturePart *parts = &out->parts[out->count];
    if (!(weight > 0)) return;
    size_t count = 1;
    if (look->even) parts[0].texture = look->texture, parts[0].weight = 1;
    else count = texture_parts(look->texture, place, parts, SURFACE_LOOK_PARTS);
    for (size_t i = 0; i < count; i++) parts[i].weight *= weight;
    out->count += count;
}

void surface_parts_find(const SurfaceHit *hit, SurfaceParts *out) {
    out->count = 0;
    add_look(hit->look, own_weight(hit), out, &out->places[0]);
    for (int i = 0; i < hit->share_count; i++) {
        out->places[i + 1] = out->places[0];
        out->places[i + 1].space = &hit->shares[i].space;
        add_look(hit->shares[i].look, hit->shares[i].weight, out, &out->places[i + 1]);
    }
}
