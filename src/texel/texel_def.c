/* Between definitions of texels and files. */
#include "texel/texel_file.h"

#include "pattern/pattern.h"
#include "scene/scene_hash.h"

#include <string.h>

static const Texture *texture_of(const TexelFileLayer *layer, Span span, Arena *arena) {
    Pigment *pigment = arena_new(arena, Pigment);
    Finish *finish = arena_new(arena, Finish);
    Texture *texture = arena_new(arena, Texture);
    *pigment = pigment_default();
    pigment->span = span;
    pigment->kind = PATTERN_SOLID;
    pigment->color = pigment->quick_color = layer->color;
    pigment_rehash(pigment);
    *finish = layer->finish;
    finish_rehash(finish);
    *texture =
        (Texture){.span = span, .pigment = pigment, .finish = finish, .transform = transform_identity()};
    texture_rehash(texture);
    return texture;
}

void texel_def_from_file(const TexelFile *file, const char *path, Span span, Arena *arena, TexelDef *out) {
    TexelLayer *layers = arena_new_array(arena, TexelLayer, file->layer_count);
    for (size_t i = 0; i < file->layer_count; i++) {
        layers[i] = (TexelLayer){
            .span = span, .texture = texture_of(&file->layers[i], span, arena), .hash = file->content};
        hash_add_u64(&layers[i].hash, i);
    }
    *out = (TexelDef){.span = span,
                      .name = arena_strdup(arena, file->name),
                      .bounds = file->bounds,
                      .resolution = file->built,
                      .cyclic = file->cyclic,
                      .layers = layers,
                      .layer_count = file->layer_count,
                      .file = arena_strdup(arena, path),
                      .file_content = file->content};
    texel_rehash(out);
}

/* ---- looks ---- */

enum { MEAN_SAMPLES = 24 };

/* A pattern has no place in a file: the mean of its colours over the texel's box, on a grid, stands for it. */
static Color mean_color(const Texture *texture, Box3 bounds) {
    Color sum = {0};
    double count = MEAN_SAMPLES * MEAN_SAMPLES * MEAN_SAMPLES;
    Vec3 size = vec3_scale(vec3_sub(bounds.max, bounds.min), 1.0 / MEAN_SAMPLES);
    for (int i = 0; i < MEAN_SAMPLES; i++)
        for (int j = 0; j < MEAN_SAMPLES; j++)
            for (int k = 0; k < MEAN_SAMPLES; k++) {
                Vec3 at = vec3_add(bounds.min, vec3_mul(size, vec3(i + 0.5, j + 0.5, k + 0.5)));
                Color c = texture_look(texture, at, vec3(0, 1, 0), size.y).color;
                if (!isfinite(c.red) || !isfinite(c.green) || !isfinite(c.blue)) continue;
                sum.red += c.red / count, sum.green += c.green / count, sum.blue += c.blue / count;
            }
    return sum;
}

TexelFileLayer texel_file_layer(const Texture *texture, Box3 bounds, VoxelLayer *voxels) {
    TexelFileLayer layer = {.voxels = voxels, .finish = *texture->finish};
    layer.averaged = texture->under || texture->map || !pigment_is_uniform(texture->pigment, &layer.color);
    if (layer.averaged) layer.color = mean_color(texture, bounds);
    return layer;
}
