#include "scene/scene_hash.h"

Finish finish_default(void) {
    Finish finish = {.ambient = {0.1, 0.1, 0.1, 0, 0},
                     .diffuse = 0.6,
                     .brilliance = 1,
                     .roughness = 0.05,
                     .phong_size = 40,
                     .reflection_falloff = 1,
                     .reflection_exponent = 1};
    finish_rehash(&finish);
    return finish;
}

Pigment pigment_default(void) {
    Pigment pigment = {.direction = {0, 1, 0},
                       .frequency = 1,
                       .octaves = 6,
                       .lambda = 2,
                       .omega = 0.5,
                       .brick_size = {8, 3, 4.5},
                       .mortar = 0.5,
                       .wave_exponent = 1,
                       .fractal = {.exponent = 2, .exterior = 1, .exterior_factor = 1, .interior_factor = 1},
                       .pavement = {.sides = 3, .tiles = 1, .pattern = 1},
                       .crackle = {.form = {-1, 1, 0}, .metric = 2},
                       .agate_turbulence = 1,
                       .control0 = 1,
                       .control1 = 1,
                       .wave_count = 10,
                       .transform = transform_identity()};
    pigment_measure(&pigment);
    pigment_rehash(&pigment);
    return pigment;
}

GlobalSettings global_settings_default(void) {
    return (GlobalSettings){
        .ambient_light = {1, 1, 1, 0, 0}, .assumed_gamma = 1, .max_trace_level = 5, .adc_bailout = 1.0 / 255,
        .irid_wavelength = {0.70, 0.52, 0.48}, .shadow_aperture = 2,
        .radiosity = {.brightness = 1, .bounces = 2}};
}

Interior interior_default(void) {
    Interior interior = {.ior = 1, .dispersion = 1, .dispersion_samples = 7};
    interior_rehash(&interior);
    return interior;
}

Camera camera_default(double aspect) {
    return (Camera){
        .kind = CAMERA_PERSPECTIVE, .direction = {0, 0, 1}, .right = {aspect, 0, 0}, .up = {0, 1, 0}};
}
