/* The scene under construction: takes what stands at top level, warns of what is used and not drawn. */
#include "eval/build_parts.h"
#include "scene/medium.h"

#include <string.h>

struct SceneDraft {
    const char *name;
    struct {
        const Object **items;
        size_t count, capacity;
    } objects;
    struct {
        Light *items;
        size_t count, capacity;
    } lights;
    struct {
        const Skin **items;
        size_t count, capacity;
    } skins;
    struct {
        const Pigment **items;
        size_t count, capacity;
    } sky;
    Color sky_emission;
    struct {
        const char **items;
        size_t count, capacity;
    } warned;             /* words named in a warning */
    const void **visited; /* nodes walked already: a set of pointers */
    size_t visited_count, visited_slots;
    uint32_t light_groups;
    const Texture *first_default;
    const Camera *camera;
    struct {
        Fog *items;
        size_t count, capacity;
    } fogs;
    struct {
        Rainbow *items;
        size_t count, capacity;
    } rainbows;
    Color background;
    GlobalSettings settings;
    const Film *film;
    MediaList media;
    bool has_terrain, has_media;
};

SceneDraft *scene_draft_create(BuildContext *context, const char *scene_name) {
    SceneDraft *draft = arena_new(context->arena, SceneDraft);
    if (!context->default_texture) context->default_texture = texture_default(context);
    *draft = (SceneDraft){.name = arena_strdup(context->arena, scene_name ? scene_name : "scene"),
                          .first_default = context->default_texture,
                          .settings = global_settings_default()};
    return draft;
}

/* ---- what is used and not drawn ---- */

static const void **visited_slot(const SceneDraft *draft, const void *node) {
    size_t mask = draft->visited_slots - 1;
    size_t i = (size_t)(((uintptr_t)node >> 4) * 0x9E3779B97F4A7C15u >> 32) & mask;
    while (draft->visited[i] && draft->visited[i] != node) i = (i + 1) & mask;
    return &draft->visited[i];
}

static void grow_visited(SceneDraft *draft, BuildContext *context) {
    SceneDraft old = *draft;
    draft->visited_slots = old.visited_slots ? 2 * old.visited_slots : 256;
    draft->visited = arena_new_array(context->arena, const void *, draft->visited_slots);
    for (size_t i = 0; i < old.visited_slots; i++)
        if (old.visited[i]) *visited_slot(draft, old.visited[i]) = old.visited[i];
}

/* True the first time that a node is met. */
static bool visit(SceneDraft *draft, BuildContext *context, const void *node) {
    if (!node) return false;
    if (2 * draft->visited_count >= draft->visited_slots) grow_visited(draft, context);
    const void **slot = visited_slot(draft, node);
    if (*slot) return false;
    *slot = node;
    draft->visited_count++;
    return true;
}

static bool warn_first(SceneDraft *draft, BuildContext *context, const char *word) {
    for (size_t i = 0; i < draft->warned.count; i++)
        if (strcmp(draft->warned.items[i], word) == 0) return false;
    *list_push(context->arena, &draft->warned) = word;
    return true;
}

static const char *what_happens(const BuildContext *context, const char *word) {
    static const struct {
        const char *word, *text;
    } effects[] = {
        {"area_light", "is drawn as a point light"},
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(effects); i++)
        if (strcmp(effects[i].word, word) == 0) return effects[i].text;
    bool known;
    BlockBuilder *builder = block_builder_find(context, intern_cstr(context->names, word), &known);
    return builder == build_unmodelled ? "is not modelled yet: it is left out"
                                       : "is not modelled yet: it has no effect";
}

static void warn_word(SceneDraft *draft, BuildContext *context, const char *word, Span span) {
    if (warn_first(draft, context, word))
        diag_warning(context->diags, span, "'%s' %s", word, what_happens(context, word));
}

/* The newest note is the first of its list: the text's order is from the end. */
static void warn_inert(SceneDraft *draft, BuildContext *context, const InertNote *notes) {
    if (!notes) return;
    warn_inert(draft, context, notes->next);
    warn_word(draft, context, notes->word, notes->span);
}

static void walk_pigment(SceneDraft *draft, BuildContext *context, const Pigment *pigment) {
    if (!visit(draft, context, pigment)) return;
    warn_inert(draft, context, pigment->inert);
    for (size_t i = 0; i < pigment->entry_count; i++)
        walk_pigment(draft, context, pigment->entries[i].pigment);
}

static void walk_texture(SceneDraft *draft, BuildContext *context, const Texture *texture) {
    for (; visit(draft, context, texture); texture = texture->under) {
        warn_inert(draft, context, texture->inert);
        walk_pigment(draft, context, texture->pigment);
        if (texture->map) walk_pigment(draft, context, texture->map->pattern);
        for (size_t i = 0; texture->map && i < texture->map->count; i++)
            walk_texture(draft, context, texture->map->textures[i]);
        if (texture->normal) walk_pigment(draft, context, texture->normal->pattern);
    }
}

static void walk_object(SceneDraft *draft, BuildContext *context, const Object *object);

static void walk_texel(SceneDraft *draft, BuildContext *context, const TexelDef *texel) {
    if (!visit(draft, context, texel)) return;
    warn_inert(draft, context, texel->inert);
    for (size_t i = 0; i < texel->layer_count; i++) {
        walk_texture(draft, context, texel->layers[i].texture);
        for (size_t k = 0; k < texel->layers[i].content_count; k++)
            walk_object(draft, context, texel->layers[i].contents[k]);
    }
    for (size_t i = 0; i < texel->choice_count; i++) walk_texel(draft, context, texel->choices[i]);
}

static void walk_surface(SceneDraft *draft, BuildContext *context, const Surface *surface) {
    if (!visit(draft, context, surface)) return;
    warn_inert(draft, context, surface->inert);
    draft->has_terrain |= surface->kind == SURFACE_TERRAIN;
    walk_texture(draft, context, surface->texture);
    if (surface->object) walk_object(draft, context, surface->object);
}

static void walk_volume(SceneDraft *draft, BuildContext *context, const Volume *volume) {
    if (!visit(draft, context, volume)) return;
    if (volume->density) walk_pigment(draft, context, volume->density->pattern);
    walk_object(draft, context, volume->container);
}

static void walk_media(SceneDraft *draft, BuildContext *context, const MediaList *media) {
    draft->has_media |= media->count > 0;
    for (size_t i = 0; i < media->count; i++)
        for (size_t k = 0; k < media->items[i].density_count; k++) walk_pigment(draft, context, media->items[i].densities[k].pattern);
}

static void walk_interior(SceneDraft *draft, BuildContext *context, const Interior *interior) {
    if (!visit(draft, context, interior)) return;
    warn_inert(draft, context, interior->inert);
    walk_media(draft, context, &interior->media);
}

static void walk_object(SceneDraft *draft, BuildContext *context, const Object *object) {
    if (!visit(draft, context, object)) return;
    warn_inert(draft, context, object_inert(object));
    walk_texture(draft, context, object->texture);
    if (object->rest) walk_texture(draft, context, object->rest->interior_texture);
    if (object->rest) walk_interior(draft, context, object->rest->interior);
    if (object_has_group(object) &&
        visit(draft, context, object->as.group))
        for (size_t i = 0; i < object->as.group->count; i++)
            walk_object(draft, context, object->as.group->items[i]);
    if (object->kind == OBJECT_TRIANGLES && visit(draft, context, object->as.mesh))
        for (size_t i = 0; i < object->as.mesh->texture_count; i++)
            walk_texture(draft, context, object->as.mesh->textures[i]);
    size_t count;
    const BlobPart *parts = object_textured_parts(object, &count);
    for (size_t i = 0; i < count; i++) walk_texture(draft, context, parts[i].texture);
    if (object->kind == OBJECT_SURFACE) walk_surface(draft, context, object->as.surface);
    if (object->kind == OBJECT_TEXEL) walk_texel(draft, context, object->as.texel);
    if (object->kind == OBJECT_VOLUME) walk_volume(draft, context, object->as.volume);
}

/* ---- adding ---- */

static void add_object(SceneDraft *draft, BuildContext *context, const Object *object);

/* The object that a light looks like stands where it is, and keeps none of its light. */
static void add_looks(SceneDraft *draft, BuildContext *context, const Light *light) {
    if (!light->looks_like) return;
    Object shape = object_copy(light->looks_like);
    shape.no_shadow = true;
    add_object(draft, context, object_keep(context->arena, &shape, NULL));
}

static void add_light(void *target, BuildContext *context, const Light *light) {
    SceneDraft *draft = target;
    *list_push(context->arena, &draft->lights) = *light;
    add_looks(draft, context, light);
}

static bool surface_is_modelled(const Surface *surface) {
    return surface->kind != SURFACE_OBJECT || surface->object->kind != OBJECT_UNMODELLED;
}

static bool texel_is_modelled(const TexelDef *texel) { return texel->layer_count || texel->choice_count; }

static bool object_is_modelled(const Object *object) {
    switch (object->kind) {
    case OBJECT_UNMODELLED: return false;
    case OBJECT_SURFACE: return surface_is_modelled(object->as.surface);
    case OBJECT_TEXEL: return texel_is_modelled(object->as.texel);
    default: return true;
    }
}

/* An object without a texture takes the default of the moment when it enters the scene, where it lies in the scene: it has been turned and moved by then. */
static void add_object(SceneDraft *draft, BuildContext *context, const Object *object) {
    LightFinder finder = {context, add_light, draft, draft->light_groups};
    walk_object(draft, context, object);
    object = lights_find(&finder, object);
    draft->light_groups = finder.group_count;
    if (!object_is_modelled(object)) return;
    if (!object->texture && context->default_texture != draft->first_default) {
        const Transform place = object_transform(object);
        const Transform back = transform_is_singular(&place) ? transform_identity() : transform_inverse(&place);
        Object colored = object_copy(object);
        colored.texture = texture_placed(context, context->default_texture, &back);
        object = object_keep(context->arena, &colored, NULL);
    }
    *list_push(context->arena, &draft->objects) = object;
}

/* Texels and surfaces that are not drawn yet take their skins with them. */
static void add_skin(SceneDraft *draft, BuildContext *context, const Skin *skin) {
    warn_inert(draft, context, skin->inert);
    walk_surface(draft, context, skin->surface);
    walk_texture(draft, context, skin->texture);
    if (skin->mapping.height_pigment) walk_pigment(draft, context, skin->mapping.height_pigment);
    SkinTexel *texels = arena_new_array(context->arena, SkinTexel, skin->texel_count);
    size_t count = 0;
    for (size_t i = 0; i < skin->texel_count; i++) {
        walk_texel(draft, context, skin->texels[i].texel);
        walk_texture(draft, context, skin->texels[i].texture);
        if (texel_is_modelled(skin->texels[i].texel)) texels[count++] = skin->texels[i];
    }
    if (count == 0 || !surface_is_modelled(skin->surface)) return;
    Skin *kept = arena_copy(context->arena, skin, sizeof *skin);
    kept->texels = texels;
    kept->texel_count = count;
    *list_push(context->arena, &draft->skins) = kept;
}

static void add_camera(SceneDraft *draft, BuildContext *context, const Camera *camera) {
    warn_inert(draft, context, camera->inert);
    if (draft->camera) {
        Diagnostic *d = diag_warning(context->diags, camera->span, "a second camera: this one is used");
        diag_note(context->diags, d, draft->camera->span, "instead of this one");
    }
    draft->camera = camera;
}

static void add_sky(SceneDraft *draft, BuildContext *context, const SkySphere *sky) {
    draft->sky_emission = sky->emission;
    draft->sky.count = 0; /* the last sky_sphere counts */
    for (size_t i = 0; i < sky->count; i++) {
        walk_pigment(draft, context, sky->layers[i]);
        *list_push(context->arena, &draft->sky) = sky->layers[i];
    }
}

static void add_rainbow(SceneDraft *draft, BuildContext *context, const Rainbow *bow) {
    if (bow->distance > 0 && bow->width > 0 && bow->colors)
        *list_push(context->arena, &draft->rainbows) = *bow;
    else
        diag_warning(context->diags, bow->span,
                     "a rainbow without a distance and a width greater than 0 and a colour map is not seen");
}

static bool add_film(SceneDraft *draft, BuildContext *context, const EvalBlock *block) {
    Film film;
    if (!film_read(context, block, &film)) return false;
    if (draft->film) {
        Diagnostic *d = diag_error(context->diags, film.span, "a second 'animation'");
        diag_note(context->diags, d, draft->film->span, "the first one");
        return false;
    }
    draft->film = arena_copy(context->arena, &film, sizeof film);
    return true;
}

bool scene_draft_has_film(const SceneDraft *draft) { return draft->film != NULL; }

static bool add_media(SceneDraft *draft, BuildContext *context, const EvalBlock *block) {
    Reader reader = reader_begin(context, block);
    Medium medium;
    if (!medium_read(&reader, block, &medium)) return false;
    draft->media = media_joined(context->arena, draft->media, &medium);
    walk_media(draft, context, &draft->media);
    return true;
}

static bool add_block(SceneDraft *draft, BuildContext *context, const EvalBlock *block, Span span) {
    const char *word = block->word->text;
    if (strcmp(word, "background") == 0) return background_read(context, block, &draft->background);
    if (strcmp(word, "global_settings") == 0) return settings_read(context, block, &draft->settings);
    if (strcmp(word, "animation") == 0) return add_film(draft, context, block);
    if (strcmp(word, "media") == 0) return add_media(draft, context, block);
    diag_error(context->diags, span, "'%s' cannot stand at top level: it belongs into another block", word);
    return false;
}

static bool refuse(BuildContext *context, const Value *value, Span span) {
    if (value->kind == VALUE_ERROR) return false;
    Diagnostic *d =
        diag_error(context->diags, span, "%s has no meaning at top level", value_kind_text(value->kind));
    switch (value->kind) {
    case VALUE_TEXEL:
        diag_hint(context->diags, d, "give it a name with #declare, then lay it on a surface by a skin");
        break;
    case VALUE_SURFACE: diag_hint(context->diags, d, "write object { surface { … } } to draw it"); break;
    case VALUE_TEXTURE:
    case VALUE_PIGMENT:
    case VALUE_FINISH:
        diag_hint(context->diags, d, "it belongs into an object, or give it a name with #declare");
        break;
    default: break;
    }
    return false;
}

bool scene_draft_add(SceneDraft *draft, BuildContext *context, const Value *value, Span span) {
    switch (value->kind) {
    case VALUE_OBJECT: add_object(draft, context, value->as.object); return true;
    case VALUE_LIGHT: add_light(draft, context, value->as.light); return true;
    case VALUE_CAMERA: add_camera(draft, context, value->as.camera); return true;
    case VALUE_SKIN: add_skin(draft, context, value->as.skin); return true;
    case VALUE_SKY_SPHERE: add_sky(draft, context, value->as.sky_sphere); return true;
    case VALUE_FOG:
        if (value->as.fog->distance <= 0) return true;
        warn_inert(draft, context, value->as.fog->inert);
        *list_push(context->arena, &draft->fogs) = *value->as.fog;
        return true;
    case VALUE_RAINBOW: add_rainbow(draft, context, value->as.rainbow); return true;
    case VALUE_BLOCK: return add_block(draft, context, value->as.block, span);
    default: return refuse(context, value, span);
    }
}

/* ---- #default ---- */

static bool on_default_value(Reader *reader, const Argument *value, void *target) {
    const Texture **texture = target;
    static const Mat3 unit = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const Transform here = {unit, {0, 0, 0}, unit};
    const InertNote *ignored = NULL;
    if (value->value.kind == VALUE_CAMERA) return true;
    if (value->value.kind == VALUE_TEXTURE) {
        *texture = value->value.as.texture;
        return true;
    }
    return value->value.kind != VALUE_INTERIOR && value->value.kind != VALUE_MATERIAL &&
           take_looks(reader->context, value, texture, &ignored, &here);
}

bool scene_draft_default(SceneDraft *draft, BuildContext *context, const EvalBlock *block) {
    static const WordRule rules[] = {{"radiosity", WORD_IGNORED, 0, NULL, false}};
    (void)draft;
    const Texture *texture = context->default_texture;
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), NULL);
    reader.on_value = on_default_value;
    reader.value_target = &texture;
    if (!reader_run(&reader)) return false;
    context->default_texture = texture;
    return true;
}

/* ---- the finished scene ---- */

const Scene *scene_draft_finish(SceneDraft *draft, BuildContext *context) {
    Scene *scene = arena_new(context->arena, Scene);
    if (!draft->objects.count && !draft->skins.count && !context->is_program)
        diag_warning(context->diags, (Span){0},
                     "the scene holds nothing to draw: the picture is its background");
    double aspect = context->image_aspect > 0 ? context->image_aspect : 4.0 / 3;
    *scene = (Scene){.name = draft->name,
                     .camera = draft->camera ? *draft->camera : camera_default(aspect),
                     .has_camera = draft->camera != NULL,
                     .lights = draft->lights.items,
                     .light_count = draft->lights.count,
                     .objects = draft->objects.items,
                     .object_count = draft->objects.count,
                     .skins = draft->skins.items,
                     .skin_count = draft->skins.count,
                     .sky_emission = draft->sky_emission,
                     .old_sky = context->old_gamma,
                     .sky_layers = draft->sky.items,
                     .sky_layer_count = draft->sky.count,
                     .background = draft->background,
                     .fogs = draft->fogs.items,
                     .fog_count = draft->fogs.count,
                     .rainbows = draft->rainbows.items,
                     .rainbow_count = draft->rainbows.count,
                     .media = draft->media,
                     .has_media = draft->has_media,
                     .default_texture = draft->first_default,
                     .settings = draft->settings,
                     .has_terrain = draft->has_terrain,
                     .film = draft->film};
    scene->settings.assumed_gamma = build_assumed_gamma(context);
    scene->settings.geo_origin = context->geo_origin;
    if (scene->skin_count) scene->settings.sky_light |= scene->settings.radiosity.on; /* what is drawn of it beside skins */
    return scene;
}
