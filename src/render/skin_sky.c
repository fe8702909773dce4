#include "render/skin.h"

/* Directions over the hemisphere about y, each for the same solid angle: two rings at the middles of equal heights. */
static const Vec3 SKY_DIRECTIONS[] = {{0.9682, 0.25, 0},        {0, 0.25, 0.9682},       {-0.9682, 0.25, 0},       {0, 0.25, -0.9682},
                                      {0.4677, 0.75, 0.4677},   {-0.4677, 0.75, 0.4677}, {-0.4677, 0.75, -0.4677}, {0.4677, 0.75, -0.4677}};

float skin_open_to_eye(double cosine) {
    double near = 2 * cosine - 1;
    return near > 0 ? (float)(near * near) : 0;
}

float skin_sky_seen(const TexelCopy *copy, const TexturePlace *place, Vec3f at, Vec3 to_eye) {
    SkyView view = texel_sky_at(copy->texel->sky, at);
    Vec3 up = vec3_normalize(place->grad_layer), s, t;
    vec3_frame(up, &s, &t);
    float sum = 0;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(SKY_DIRECTIONS); i++) {
        Vec3 d = SKY_DIRECTIONS[i], world = vec3_madd(vec3_madd(vec3_scale(s, d.x), t, d.z), up, d.y);
        Vec3 rate = vec3(vec3_dot(place->grad_u, world), vec3_dot(place->grad_v, world), vec3_dot(place->grad_w, world));
        Vec3f way = texel_copy_rate(copy, rate);
        float length = vec3f_length(way);
        float open = length > 0 ? sky_view_toward(&view, vec3f_scale(way, 1 / length)) : view.mean;
        sum += open + (1 - open) * skin_open_to_eye(vec3_dot(world, to_eye));
    }
    return sum / (float)VTS_ARRAY_COUNT(SKY_DIRECTIONS);
}
