#include "render/skin.h"

float skin_sky_seen(const TexelCopy *copy, const TexturePlace *place, Vec3f at, Vec3 to_eye) {
    Vec3 up = vec3_normalize(place->grad_layer), s, t;
    Vec3f ways[SKY_WAYS];
    float gaps[SKY_WAYS];
    vec3_frame(up, &s, &t);
    for (int i = 0; i < SKY_WAYS; i++) {
        Vec3 d = vec3_from_f(texel_sky_way(i)), world = vec3_madd(vec3_madd(vec3_scale(s, d.x), t, d.z), up, d.y);
        Vec3f way = skin_way_in_texel(copy, place, world);
        float length = vec3f_length(way);
        ways[i] = length > 0 ? vec3f_scale(way, 1 / length) : vec3f(0, 0, 0);
        gaps[i] = sky_open_to_eye((float)vec3_dot(world, to_eye));
    }
    return texel_sky_seen(copy->texel->sky, at, ways, gaps, skin_way_in_texel(copy, place, to_eye));
}
