#include "render/look.h"

#include "pattern/pattern.h"

Look look_from_texture(const Texture *texture, const GlobalSettings *settings) {
    const Finish *f = texture->finish;
    Look look = {.texture = texture, .metallic = (float)f->metallic};
    look.sheet = (SheetLook){.diffuse = (float)f->diffuse,
                             .transmission = (float)f->transmission,
                             .brilliance = (float)f->brilliance,
                             .specular = (float)f->specular,
                             .inverse_roughness = f->roughness > 0 ? (float)(1 / f->roughness) : 1e4f,
                             .phong = (float)f->phong,
                             .phong_size = (float)f->phong_size};
    look.ambient = vec3f_mul(vec3f_from_color(f->ambient), vec3f_from_color(settings->ambient_light));
    look.emission = vec3f_from_color(f->emission);
    Color color;
    look.uniform = !texture->under && !texture->map && pigment_is_uniform(texture->pigment, &color);
    if (look.uniform) look.color = vec3f_from_color(color);
    look.even = texture_is_even(texture);
    look.opaque = texture_is_opaque(texture);
    look.plain = look.opaque && !texture_mirrors(texture);
    return look;
}

Vec3f look_color(const Look *look, Vec3 point, Vec3 normal, double footprint) {
    if (look->uniform) return look->color;
    return vec3f_from_color(texture_look(look->texture, point, normal, footprint).color);
}
