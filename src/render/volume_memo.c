#include "render/volume_memo.h"

#include "render/volume_light.h"
#include "scene/scene_hash.h"
#include "tape/tape.h"

#include <stdlib.h>
#include <string.h>

struct VolumeMemo {
    bool known;
    Hash128 key;
    size_t count;
    VolumeLight *lights;
};

enum { LIGHT_SIZE = 88 };
_Static_assert(sizeof(void *) != 8 || sizeof(VolumeLight) == LIGHT_SIZE, "whoever adds an array to VolumeLight adds it to copy_arrays()");

typedef void *Copy(void *context, const void *data, size_t size);

/* Puts copies in the place of the arrays; NULL stays. */
static void copy_arrays(VolumeLight *light, size_t lamps, Copy *copy, void *context) {
    size_t nodes = lamps * light->nodes + 1, bins = light->kept ? volume_bins(light) : 0;
    light->depths = copy(context, light->depths, nodes * sizeof *light->depths);
    light->states = copy(context, light->states, nodes * sizeof *light->states);
    light->kept = copy(context, light->kept, bins * (size_t)light->harmonics * sizeof *light->kept);
    light->density = copy(context, light->density, bins * sizeof *light->density);
    light->source = light->again = NULL;
}

/* ---- what it depends on ---- */

/* All of the scene but the camera. */
static Hash128 key_of(const CompiledScene *compiled) {
    const Scene *scene = compiled->scene;
    Scene unseen = *scene;
    unseen.camera = (Camera){.kind = CAMERA_PERSPECTIVE};
    unseen.name = "", unseen.film = NULL, unseen.clock = 0;
    StrBuf text = {0};
    scene_print(&unseen, &text);
    Hash128 key = hash_begin(scene->light_count);
    hash_add(&key, text.data, text.size);
    strbuf_free(&text);
    for (size_t i = 0; i < scene->light_count; i++) {
        const Light *light = &scene->lights[i];
        if (light->goniometric) hash_add_hash(&key, tape_hash(light->goniometric));
        if (light->lamp) {
            hash_add_hash(&key, light->lamp->hash);
            hash_add(&key, light->lamp_turns, sizeof light->lamp_turns);
        }
        if (light->projected_through) hash_add_hash(&key, object_hash(light->projected_through));
    }
    for (size_t i = 0; i < scene->object_count; i++) hash_add_hash(&key, object_hash(scene->objects[i]));
    for (size_t i = 0; i < scene->sky_layer_count; i++) hash_add_hash(&key, scene->sky_layers[i]->hash);
    for (size_t i = 0; i < compiled->volumes->count; i++) {
        const CompiledVolume *v = &compiled->volumes->items[i];
        hash_add_hash(&key, v->volume->hash);
        hash_add(&key, v->lattice.size, sizeof v->lattice.size);
        hash_add(&key, &v->to_cells, sizeof v->to_cells);
    }
    hash_add_double(&key, compiled->max_error);
    return key;
}

/* Skins and terrains are built for the view: their shadows on volumes follow it. */
static bool follows_view(const CompiledScene *compiled) { return compiled->skin_count > 0 || compiled->scene->has_terrain || compiled->options->exact; }

/* ---- keeping ---- */

static void forget(VolumeMemo *memo) {
    for (size_t i = 0; i < memo->count; i++) {
        VolumeLight *light = &memo->lights[i];
        free(light->depths);
        free(light->states);
        free(light->kept);
        free(light->density);
    }
    free(memo->lights);
    *memo = (VolumeMemo){.known = false};
}

VolumeMemo *volume_memo_create(void) { return calloc(1, sizeof(VolumeMemo)); }

void volume_memo_destroy(VolumeMemo *memo) {
    if (!memo) return;
    forget(memo);
    free(memo);
}

static void *copy_to_heap(void *failed, const void *data, size_t size) {
    void *copy = data ? malloc(size + 1) : NULL;
    if (copy) memcpy(copy, data, size);
    else if (data) *(bool *)failed = true;
    return copy;
}

static void *copy_to_arena(void *arena, const void *data, size_t size) { return data ? arena_copy(arena, data, size) : NULL; }

static void keep(VolumeMemo *memo, Hash128 key, const CompiledScene *compiled) {
    const VolumeSet *set = compiled->volumes;
    forget(memo);
    memo->lights = calloc(set->count, sizeof *memo->lights);
    bool failed = memo->lights == NULL;
    for (size_t i = 0; i < set->count && !failed; i++) {
        memo->lights[i] = *set->items[i].light;
        copy_arrays(&memo->lights[i], compiled->scene->light_count, copy_to_heap, &failed);
        memo->count = i + 1;
    }
    memo->key = key, memo->known = !failed;
    if (failed) forget(memo);
}

static void take(const VolumeMemo *memo, CompiledScene *compiled) {
    for (size_t i = 0; i < memo->count; i++) {
        VolumeLight *light = compiled->volumes->items[i].light = arena_copy(compiled->arena, &memo->lights[i], sizeof *light);
        copy_arrays(light, compiled->scene->light_count, copy_to_arena, compiled->arena);
    }
}

bool volumes_light_kept(CompiledScene *compiled) {
    VolumeMemo *memo = compiled->options->volume_memo;
    if (!memo || follows_view(compiled) || compiled->volumes->method == VOLUME_PATH) return volumes_light(compiled);
    Hash128 key = key_of(compiled);
    if (memo->known && hash_equal(memo->key, key) && memo->count == compiled->volumes->count) {
        take(memo, compiled);
        compiled->volume_light_kept = true;
        return true;
    }
    if (!volumes_light(compiled)) return false;
    keep(memo, key, compiled);
    return true;
}
