/* vts_texel(): one texel built, told of, saved and drawn. */
#include "vts_session.h"

#include "image/whole_file.h"
#include "texel/texel_coverage.h"
#include "texel/texel_file.h"

#include <stdio.h>
#include <string.h>

enum { AUTO_RESOLUTION = 128 };

/* ---- which ---- */

static void list_names(const Scene *scene, StrBuf *out) {
    enum { MOST_LISTED = 40 };
    for (size_t i = 0; i < scene->named_texel_count && i < MOST_LISTED; i++)
        strbuf_addf(out, "%s%s", i ? ", " : "", scene->named_texels[i].name);
    if (scene->named_texel_count > MOST_LISTED) strbuf_adds(out, " …");
}

static void tell_unknown(VtsSession *session, const char *name) {
    const Scene *scene = session->scene;
    const char **names = arena_new_array(&session->parse, const char *, scene->named_texel_count);
    for (size_t i = 0; i < scene->named_texel_count; i++) names[i] = scene->named_texels[i].name;
    const char *best = closest_word(name, names, scene->named_texel_count);
    StrBuf list = {0};
    list_names(scene, &list);
    Diagnostic *d = diag_error(&session->diags, (Span){0}, "no texel is declared as '%s'", name);
    if (best) diag_hint(&session->diags, d, "did you mean '%s'?", best);
    if (list.size)
        diag_note(&session->diags, d, (Span){0}, "there are %s", list.data);
    else
        diag_note(&session->diags, d, (Span){0}, "the scene declares no texels");
    strbuf_free(&list);
}

static const TexelDef *find_texel(VtsSession *session, const char *name) {
    for (size_t i = 0; i < session->scene->named_texel_count; i++)
        if (strcmp(session->scene->named_texels[i].name, name) == 0)
            return session->scene->named_texels[i].texel;
    tell_unknown(session, name);
    return NULL;
}

/* A family has no voxels of its own. */
static bool is_single(VtsSession *session, const TexelDef *def, const char *name) {
    StrBuf list = {0};
    for (size_t i = 0; i < def->choice_count; i++)
        strbuf_addf(&list, "%s%s", i ? ", " : "", def->choices[i]->name);
    if (def->choice_count)
        diag_error(&session->diags, (Span){0}, "'%s' is a choice of texels: name one of %s", name, list.data);
    strbuf_free(&list);
    return def->choice_count == 0;
}

/* ---- alone in a scene ---- */

/* Seen from the front, the right and above, without perspective, as large as the picture allows. */
static Camera oblique_camera(Box3 box, double aspect) {
    Vec3 centre = vec3_lerp(box.min, box.max, 0.5), direction = vec3_normalize(vec3(-0.45, -0.5, 0.75));
    Vec3 right = vec3_normalize(vec3_cross(vec3(0, 1, 0), direction)), up = vec3_cross(direction, right);
    double width = 0, height = 0, depth = 0;
    static const double MARGIN = 1.06;
    for (int i = 0; i < 8; i++) {
        Vec3 corner = vec3_sub(
            vec3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z),
            centre);
        width = fmax(width, 2 * fabs(vec3_dot(corner, right)));
        height = fmax(height, 2 * fabs(vec3_dot(corner, up)));
        depth = fmax(depth, fabs(vec3_dot(corner, direction)));
    }
    height = MARGIN * fmax(height, width / aspect);
    return (Camera){.kind = CAMERA_ORTHOGRAPHIC,
                    .location = vec3_madd(centre, direction, -2 * depth),
                    .direction = direction,
                    .right = vec3_scale(right, height * aspect),
                    .up = vec3_scale(up, height)};
}

static const Light *default_lights(Arena *arena) {
    Light *lights = arena_new_array(arena, Light, 2);
    lights[0] = (Light){
        .kind = LIGHT_PARALLEL, .to_light = vec3_normalize(vec3(-0.3, 0.8, -0.6)), .color = {1, 1, 1, 0, 0}};
    lights[1] = (Light){.kind = LIGHT_PARALLEL,
                        .to_light = vec3_normalize(vec3(0.9, 0.3, -0.2)),
                        .color = {0.3, 0.32, 0.36, 0, 0},
                        .shadowless = true};
    return lights;
}

static void stand_alone(VtsSession *session, const TexelDef *def) {
    Arena *arena = &session->scene_arena;
    Scene *scene = arena_copy(arena, session->scene, sizeof *scene);
    const Object **objects = arena_new_array(arena, const Object *, 1);
    const Object object = {.span = def->span, .kind = OBJECT_TEXEL, .as.texel = def};
    objects[0] = object_keep(arena, &object, NULL);
    scene->objects = objects;
    scene->object_count = 1;
    scene->lights = default_lights(arena);
    scene->light_count = 2;
    scene->skin_count = scene->sky_layer_count = 0;
    scene->fog_count = 0;
    scene->background = (Color){0.62, 0.68, 0.75, 0, 0};
    scene->camera = oblique_camera(def->bounds, (double)session->options.width / session->options.height);
    session->scene = scene;
}

/* ---- the table ---- */

static void add_bytes(StrBuf *out, double bytes) {
    static const char *const units[] = {"bytes", "kB", "MB", "GB"};
    int unit = 0;
    for (; bytes >= 1000 && unit < 3; unit++) bytes /= 1000;
    strbuf_addf(out, "%.*f %s", unit && bytes < 100 ? 1 : 0, bytes, units[unit]);
}

static void add_level(StrBuf *out, const VoxelLayer *layer, int level, OpacityModel model) {
    int size[3];
    char text[40];
    voxel_layer_size(layer, level, size);
    double all = (double)size[0] * size[1] * size[2];
    snprintf(text, sizeof text, "%d x %d x %d", size[0], size[1], size[2]);
    strbuf_addf(out, "%7d  %-18s %11zu %8.3f %%  %8zu", level, text, voxel_layer_voxels(layer, level),
                100 * (double)voxel_layer_voxels(layer, level) / all, voxel_layer_bricks(layer, level));
    for (int axis = 0; axis < 3; axis++)
        strbuf_addf(out, "  %6.3f", voxel_layer_coverage(layer, level, axis, model));
    strbuf_addc(out, '\n');
}

static void write_table(StrBuf *out, const BuiltTexel *texel, const char *name, OpacityModel model) {
    const TexelDef *def = texel->def;
    static const char *const axes[] = {"no axis", "x", "y", "x, y", "z", "x, z", "y, z", "x, y, z"};
    strbuf_clear(out);
    strbuf_addf(out, "texel %s: bounds <%g, %g, %g>, <%g, %g, %g>, cyclic: %s\n", name, def->bounds.min.x,
                def->bounds.min.y, def->bounds.min.z, def->bounds.max.x, def->bounds.max.y, def->bounds.max.z,
                axes[def->cyclic & 7]);
    for (size_t i = 0; i < texel->matter_count; i++) {
        const VoxelLayer *layer = texel->matter[i].voxels;
        strbuf_addf(out, "layer %zu of %zu\n", i + 1, texel->matter_count);
        strbuf_adds(
            out, "  level  voxels                  stored     filled    bricks  covers x       y       z\n");
        for (int l = 0; l < voxel_layer_levels(layer); l++) add_level(out, layer, l, model);
    }
    if (def->file || !texel->asked)
        strbuf_adds(out, "resolution: ");
    else
        strbuf_addf(out, "resolution: %d asked, ", texel->asked);
    strbuf_addf(out, "%d built\nstored: %zu voxels, ", texel->built, texel->voxel_count);
    add_bytes(out, (double)texel->bytes);
    strbuf_addf(out, "\n%s in %.3f s\n", texel->cached ? "loaded" : "built", texel->build_seconds);
}

/* ---- the file ---- */

static VtsStatus tell_unsaved(VtsSession *session, const StrBuf *why) {
    diag_error(&session->diags, (Span){0}, "no texel file: %s",
               why->size ? why->data : "it could not be written");
    return VTS_ERROR_FILE;
}

static VtsStatus save_texel(VtsSession *session, const BuiltTexel *texel, const char *name,
                            const char *path) {
    const TexelDef *def = texel->def;
    TexelFileLayer *layers = arena_new_array(&session->compiled_arena, TexelFileLayer, texel->matter_count);
    for (size_t i = 0; i < texel->matter_count; i++) {
        layers[i] = texel_file_layer(texel->matter[i].look.texture, def->bounds, texel->matter[i].voxels);
        if (layers[i].averaged)
            diag_warning(&session->diags, def->layers[i].span,
                         "the file keeps the mean colour of this layer's pattern, not the pattern");
    }
    TexelFile file = {.name = arena_strdup(&session->compiled_arena, name),
                      .bounds = def->bounds,
                      .asked = def->resolution,
                      .built = texel->built,
                      .cyclic = def->cyclic,
                      .layers = layers,
                      .layer_count = texel->matter_count};
    StrBuf why = {0};
    bool ok = texel_file_save(&file, path, &why);
    VtsStatus status = ok ? VTS_OK : tell_unsaved(session, &why);
    strbuf_free(&why);
    return status;
}

/* ---- the call ---- */

/* Before any work: whether the results can be put where they are wanted. */
static VtsStatus check_places(VtsSession *session, const char *save_path, const char *picture_path) {
    StrBuf why = {0};
    VtsStatus status = VTS_OK;
    if (save_path && !whole_file_can_replace(save_path, &why))
        status = tell_unsaved(session, &why);
    else if (picture_path && !image_can_write(picture_path, &why))
        status = session_file_error(session, &why);
    strbuf_free(&why);
    return status;
}

static VtsStatus draw(VtsSession *session, const char *scene_path, const char *picture_path) {
    RenderStats stats;
    VtsStatus status = session_draw(session, false, &(MomentPlan){0}, &stats);
    return status == VTS_OK ? session_save_picture(session, scene_path, picture_path) : status;
}

VtsStatus session_texel(VtsSession *session, const char *scene_path, const char *name, const char *save_path,
                        const char *picture_path) {
    VtsStatus status = check_places(session, save_path, picture_path);
    if (status == VTS_OK)
        status =
            session_evaluate(session, scene_path, (EvalMode){.is_program = true, .writes_in_memory = true});
    if (status == VTS_OK && save_path) status = session_spare_sources(session, save_path);
    if (status == VTS_OK && picture_path) status = session_spare_sources(session, picture_path);
    if (status != VTS_OK) return status;
    const TexelDef *def = find_texel(session, name);
    if (!def || !is_single(session, def, name)) return VTS_ERROR_USAGE;
    stand_alone(session, def);
    status = session_compile(session, false, def->resolution ? def->resolution : AUTO_RESOLUTION);
    if (status != VTS_OK) return status;
    const BuiltTexel *texel = session->compiled.texel_count ? session->compiled.texels[0] : NULL;
    if (!texel || texel->matter_count == 0) {
        diag_error(&session->diags, def->span, "nothing of the texel '%s' can be built in this version",
                   name);
        return VTS_ERROR_SCENE;
    }
    write_table(&session->report, texel, name, session->compiled.march.opacity);
    if (save_path) status = save_texel(session, texel, name, save_path);
    if (status == VTS_OK && picture_path) status = draw(session, scene_path, picture_path);
    return status;
}
