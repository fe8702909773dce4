#include "render/compile.h"

#include "base/stopwatch.h"
#include "render/beam_choice.h"
#include "render/beam_rigid.h"
#include "render/beam_worth.h"
#include "render/exact_skin.h"
#include "render/radiosity.h"
#include "render/shone_through.h"
#include "render/terrain_view.h"
#include "render/volume_memo.h"
#include "render/volume_set.h"

#include <string.h>

/* A texel placed as an object is a skin of one tile over the bottom of its box. */
static const Skin *skin_of_texel(const Object *object, const Transform *to_world, const Texture *texture, Arena *arena) {
    Box3 b = object->as.texel->bounds;
    Vec3 *points = arena_new_array(arena, Vec3, 4), *heights = arena_new_array(arena, Vec3, 4);
    for (int i = 0; i < 4; i++) {
        points[i] = transform_point(to_world, vec3(i & 2 ? b.max.x : b.min.x, b.min.y, i & 1 ? b.max.z : b.min.z));
        heights[i] = transform_vector(to_world, vec3(0, b.max.y - b.min.y, 0));
    }
    Surface *surface = arena_new(arena, Surface);
    *surface = (Surface){.span = object->span, .kind = SURFACE_PATCHES, .nu = 1, .nv = 1, .points = points,
                         .height_vectors = heights, .transform = transform_identity()};
    SkinTexel *texel = arena_new(arena, SkinTexel);
    *texel = (SkinTexel){.span = object->span, .texel = object->as.texel, .texture = texture, .density = 1};
    Skin *skin = arena_new(arena, Skin);
    *skin = (Skin){.span = object->span, .surface = surface, .texels = texel, .texel_count = 1,
                   .mapping = {.repeat_u = 1, .repeat_v = 1, .height = 1, .w_tip = 1}};
    return skin;
}

typedef struct SkinList {
    const Skin **items;
    size_t count, capacity;
} SkinList;

static void find_placed_texels(const Object *object, const Transform *parent, const Texture *inherited, Arena *arena, SkinList *out) {
    if (object_has_group(object) && object->as.group->plain) return;
    Transform own = object_transform(object), to_world = transform_then(&own, parent);
    const Texture *texture = object->texture ? object->texture : inherited;
    if (object->kind == OBJECT_TEXEL) *list_push(arena, out) = skin_of_texel(object, &to_world, texture, arena);
    if (object->kind == OBJECT_UNION || object->kind == OBJECT_MERGE)
        for (size_t i = 0; i < object->as.group->count; i++)
            find_placed_texels(object->as.group->items[i], &to_world, texture, arena, out);
}

static Quadrature quadrature_of(const char *name) {
    if (name && strcmp(name, "grid16") == 0) return QUADRATURE_GRID16;
    if (name && strcmp(name, "ring16") == 0) return QUADRATURE_RING16;
    if (name && strcmp(name, "lune") == 0) return QUADRATURE_LUNE;
    return QUADRATURE_RING8;
}

static OpacityModel opacity_of(const char *name) {
    if (name && strcmp(name, "mean") == 0) return OPACITY_MEAN;
    if (name && strcmp(name, "exponential") == 0) return OPACITY_EXPONENTIAL;
    return OPACITY_CORRELATED;
}

static TexelFiltering filtering_of(const char *name) {
    return name && strcmp(name, "published") == 0 ? TEXEL_FILTER_PUBLISHED : TEXEL_FILTER_LINEAR;
}

static RayPath path_of(const char *name) {
    if (name && strcmp(name, "straight") == 0) return RAY_PATH_STRAIGHT;
    if (name && strcmp(name, "exact") == 0) return RAY_PATH_EXACT;
    return RAY_PATH_BOX;
}

static Detail detail_of(const char *name) {
    if (name && strcmp(name, "exact") == 0) return DETAIL_EXACT;
    if (name && strcmp(name, "voxels") == 0) return DETAIL_VOXELS;
    if (name && strcmp(name, "slab") == 0) return DETAIL_SLAB;
    return DETAIL_AUTO;
}

static const double DEFAULT_MAX_ERROR = 1.0 / 255;
/* Of max_error, in films: 1/√2, less what the estimates of errors are off by. */
static const double FILM_SHARE = 0.65;
/* A pixel of fur may want hundreds of samples: who does not ask for an error gets what is near it at a bearable cost. */
enum { MOST_SAMPLES = 256, MOST_SAMPLES_UNASKED = 64 };
/* The same of films with skins, asked or not: what is noise in a picture is flicker in them, which is seen sooner. */
enum { MOST_FILM_SAMPLES = 512 };

/* What the error that a user accepts buys. At 1/255: voxels half as wide as the cone (with linear interpolation between their
 * centres that is the cone's own blur, and finer levels hold more air to skip), steps of one and a half of them, two for
 * shadows, and 4 × 4 cones where explicit edges cross a pixel. The error of steps falls with their length, that of edges with
 * the number of cones. What a cone hardly lets through differs from what it has seen by a fraction of a picture's range: a hundredth of the
 * light from there is some thousandths of that. */
static void choose_detail(double max_error, OpacityModel opacity, RayPath path, CompiledScene *out) {
    double e = max_error / DEFAULT_MAX_ERROR, root = pow(e, 0.25);
    out->march = (MarchSettings){.opacity = opacity, .path = path,
                                 .voxel_width = (float)double_clamp(0.5 * pow(e, 0.15), 0.5, 0.75),
                                 .step = (float)double_clamp(1.6 * root, 0.75, 2.5)};
    out->shadow_march = out->march;
    out->shadow_march.voxel_width *= 1.4f; /* shadows are parts of pixels (Neyret 1998 sec. IV-B: "a rougher level") */
    out->shadow_march.step = (float)double_clamp(2 * root, 1, 2.5);
    out->accepted_error = out->max_error = max_error;
    out->opaque_below = (float)double_clamp(2 * max_error, 1.0 / 256, 1.0 / 16);
    out->dark_below = (float)double_clamp(0.25 * max_error, 1.0 / 1024, 1.0 / 32);
    out->samples = (int)double_clamp(round(8 * pow(e, -1)), 2, 16);
    out->split = (int)double_clamp(round(4 * pow(e, -0.35)), 2, 12);
}

enum { MOST_TERRAIN_VERTICES = 64000000 };

static bool interrupted(const CompileOptions *options) { return options->interrupted && *options->interrupted; }

/* As fine as they may be seen; the reference's triangles. */
static CompileStatus build_voxels(const CompileOptions *options, DiagList *diags, CompiledScene *out) {
    for (size_t i = 0; i < out->skin_count && !options->exact; i++) skin_ask_voxels(&out->skins[i], options, out);
    if (!options->exact) texels_settle_voxels(out);
    for (size_t i = 0; i < out->texel_count; i++) {
        if (!texel_build(out->texels[i], options, out, diags)) return interrupted(options) ? COMPILE_INTERRUPTED : COMPILE_FAILED;
        if (interrupted(options)) return COMPILE_INTERRUPTED;
    }
    for (size_t i = 0; i < out->skin_count; i++)
        if (!skin_finish(&out->skins[i], options, out)) memory_budget_fail(options->memory);
    out->voxels = !options->exact;
    return COMPILE_OK;
}

/* Exact geometry where it may be seen, and voxels where the rest is; none of either that nothing needs. */
static CompileStatus build_texels(const CompileOptions *options, Detail detail, DiagList *diags, CompiledScene *out) {
    bool flat = view_is_flat(&out->view) && !view_has_lens(&out->view); /* beams know no other lines of sight */
    bool beams = flat && !options->exact && !options->texel_resolution && (detail == DETAIL_AUTO || detail == DETAIL_EXACT), voxels = !beams;
    out->exact_bounds = box3_empty();
    out->all_exact_to = out->nearest = VTS_INFINITY;
    bool whole = detail == DETAIL_EXACT, failed = beams && !whole && !beam_build_whole(out, diags, &whole);
    if (failed) return interrupted(options) ? COMPILE_INTERRUPTED : COMPILE_FAILED;
    for (size_t i = 0; i < out->skin_count && beams; i++) {
        if (!beam_build_skin(&out->skins[i], detail == DETAIL_EXACT || (whole && !out->skins[i].rigid), out, diags)) return interrupted(options) ? COMPILE_INTERRUPTED : COMPILE_FAILED;
        if (interrupted(options)) return COMPILE_INTERRUPTED;
    }
    for (size_t i = 0; i < out->skin_count && beams; i++) {
        beam_plan_skin(&out->skins[i], detail == DETAIL_EXACT || (whole && !out->skins[i].rigid), out);
    }
    if (beams) out->rigid = rigid_copies_build(out);
    for (size_t i = 0; i < out->skin_count && beams; i++) {
        voxels |= !out->skins[i].boxes || isfinite(out->skins[i].exact_to);
        out->all_exact_to = fmin(out->all_exact_to, out->skins[i].boxes ? out->skins[i].exact_to : 0);
        if (out->skins[i].boxes) out->nearest = fmin(out->nearest, 1e-6 * out->skins[i].tile_size);
        if (out->skins[i].boxes && !out->skins[i].rigid) out->exact_bounds = box3_union(out->exact_bounds, out->skins[i].bounds);
    }
    bool sky = out->scene->settings.sky_light && detail != DETAIL_EXACT; /* what triangles see of the sky, voxels know */
    if (!voxels && !out->secondary && !sky) return COMPILE_OK; /* mirrors show voxels */
    return build_voxels(options, diags, out);
}

static const BoxTree *tree_over_skins(const CompiledScene *compiled) {
    Box3 *bounds = arena_new_array(compiled->arena, Box3, compiled->skin_count);
    for (size_t i = 0; i < compiled->skin_count; i++) bounds[i] = compiled->skins[i].bounds;
    return box_tree_build(bounds, compiled->skin_count, compiled->arena);
}

typedef struct SkinsMet {
    const CompiledScene *compiled;
    const Ray *ray;
    double t_max;
    SkinMet *list;
    size_t count;
} SkinsMet;

static void meet_skin(void *context, uint32_t skin) {
    SkinsMet *met = context;
    double near = 0, far = met->t_max;
    box_tree_clip(&met->compiled->skins[skin].bounds, met->ray, &near, &far);
    size_t i = met->count++;
    for (; i > 0 && (met->list[i - 1].t > near || (met->list[i - 1].t == near && met->list[i - 1].skin > skin)); i--) met->list[i] = met->list[i - 1];
    met->list[i] = (SkinMet){skin, near};
}

size_t compiled_skins_met(const CompiledScene *compiled, const Ray *ray, double t_max, SkinMet *skins) {
    SkinsMet met = {compiled, ray, t_max, skins, 0};
    box_tree_ray(compiled->skin_tree, ray, 0, &t_max, meet_skin, &met);
    return met.count;
}

/* Whether another frame of the film has to be compiled first. */
static bool asks_elsewhere(const CompiledScene *compiled) {
    const CompileOptions *options = compiled->options;
    PilotResult *pilot = options->pilot;
    if (!pilot || !pilot->elsewhere || options->exact || !compiled->texel_count) return false;
    return pilot->asked = true;
}

/* Voxels alone, where auto would take longer for no less error. */
static CompileStatus choose_detail_by_price(const CompileOptions *options, DiagList *diags, CompiledScene *out) {
    BeamPrice planned;
    if (!beam_choice_open(out, &planned)) return COMPILE_OK;
    bool built = out->voxels;
    CompileStatus status = built ? COMPILE_OK : build_voxels(options, diags, out);
    if (status == COMPILE_OK && !beam_choose_voxels(out, &planned)) out->voxels = built;
    return status;
}

CompileStatus compile_scene(const Scene *scene, const CompileOptions *options, Arena *arena, DiagList *diags, CompiledScene *out) {
    double start = stopwatch_wall();
    size_t errors = diags->error_count;
    *out = (CompiledScene){.scene = scene, .options = options, .arena = arena, .view = {.camera = scene->camera, .width = options->width, .height = options->height}};
    view_prepare(&out->view, arena);
    budget_begin(&out->budget);
    arena_init(&out->scratch, options->memory, 0);
    out->quadrature = quadrature_of(scene->settings.quadrature);
    out->filtering = filtering_of(scene->settings.filtering);
    out->shadow_aperture = scene->settings.shadow_aperture;
    OpacityModel opacity = opacity_of(scene->settings.opacity_model);
    choose_detail(scene->settings.max_error > 0 ? scene->settings.max_error : DEFAULT_MAX_ERROR, opacity,
                  path_of(scene->settings.ray_path), out);
    out->march.slab = out->shadow_march.slab = detail_of(scene->settings.detail) == DETAIL_SLAB;
    const TerrainViewOptions terrains = {options->pool, out->max_error, options->exact, MOST_TERRAIN_VERTICES, skin_longest_cell};
    out->scene = scene = terrains_as_seen(scene, &out->view, &terrains, &out->scratch, arena, diags, &out->terrains);
    if (!scene) return COMPILE_FAILED;
    const double pixels = (double)options->width * options->height, rays = options->exact ? VTS_INFINITY : pixels * int_max(scene->settings.samples, 1);
    out->hierarchy = hierarchy_build(scene, rays, arena, diags);
    if (!out->hierarchy) return COMPILE_FAILED;
    out->clear_shadows = hierarchy_is_clear(out->hierarchy);
    out->solids_matter = scene->fog_count || scene->rainbow_count || scene->has_media;
    out->clear_shadows |= scene->has_media;
    out->eye_filling_count = hierarchy_inside(out->hierarchy, scene->camera.location, out->eye_fillings, EYE_FILLINGS);
    if (!volumes_compile(out, diags)) return COMPILE_FAILED;
    out->exact_paths = options->exact;
    out->projections = projections_prepare(scene, arena);
    out->clear_shadows |= out->projections != NULL; /* which some light does not come through */
    out->clear_shadows |= out->volumes != NULL; /* which let some light through, too */
    out->secondary = !hierarchy_is_plain(out->hierarchy) || out->volumes; /* which ask the voxels of skins for their shadows */
    SkinList skins = {0};
    for (size_t i = 0; i < scene->skin_count; i++) *list_push(arena, &skins) = scene->skins[i];
    Transform identity = transform_identity();
    for (size_t i = 0; i < scene->object_count; i++) find_placed_texels(scene->objects[i], &identity, NULL, arena, &skins);
    if (skins.count && !hierarchy_start_embree(out->hierarchy, diags)) return COMPILE_FAILED;
    out->skins = arena_new_array(arena, CompiledSkin, skins.count);
    for (size_t i = 0; i < skins.count; i++)
        if (skin_compile(skins.items[i], out, diags, &out->skins[out->skin_count])) out->skin_count++;
    out->least_tile = VTS_INFINITY;
    for (size_t i = 0; i < out->skin_count; i++)
        if (out->skins[i].tile_size > 0) out->least_tile = fmin(out->least_tile, out->skins[i].tile_size);
    if (interrupted(options)) return COMPILE_INTERRUPTED;
    if (diags->error_count > errors) return COMPILE_FAILED;
    if (asks_elsewhere(out)) return COMPILE_OK;
    texels_settle_triangles(out);
    out->most_samples = scene->settings.max_error > 0 ? MOST_SAMPLES : MOST_SAMPLES_UNASKED;
    if (options->film && out->skin_count) { /* errors of two frames add up in their difference, and few of those of skins are the same */
        out->max_error *= FILM_SHARE;
        out->most_samples = MOST_FILM_SAMPLES;
    }
    Detail detail = detail_of(scene->settings.detail);
    CompileStatus status = build_texels(options, detail, diags, out);
    if (status != COMPILE_OK) return status;
    out->skin_tree = tree_over_skins(out);
    if (out->volumes && !options->exact && !volumes_light_kept(out)) return COMPILE_INTERRUPTED;
    if (!radiosity_build(out)) return COMPILE_INTERRUPTED;
    beam_pilot(out);
    beam_worth(out);
    status = detail == DETAIL_AUTO ? choose_detail_by_price(options, diags, out) : COMPILE_OK;
    if (status != COMPILE_OK) return status;
    budget_trial(out);
    if (options->exact && out->skin_count) out->exact = exact_skins_build(out->skins, out->skin_count, hierarchy_embree(out->hierarchy));
    if (options->exact && out->skin_count && !out->exact) memory_budget_fail(options->memory);
    out->build_seconds = stopwatch_wall() - start;
    out->options = NULL;
    return diags->error_count > errors ? COMPILE_FAILED : COMPILE_OK;
}

void compiled_scene_destroy(CompiledScene *compiled) {
    exact_skins_destroy(compiled->exact);
    for (size_t i = 0; i < compiled->skin_count; i++) cell_tree_destroy(compiled->skins[i].tree);
    for (size_t i = 0; i < compiled->texel_count; i++) {
        if (compiled->texels[i]->sky && !compiled->texels[i]->sky_is_kept) texel_sky_destroy(compiled->texels[i]->sky);
        for (size_t k = 0; k < compiled->texels[i]->matter_count; k++) voxel_layer_destroy(compiled->texels[i]->matter[k].voxels);
    }
    rigid_copies_destroy(compiled->rigid);
    hierarchy_destroy(compiled->hierarchy);
    arena_destroy(&compiled->scratch);
    compiled->skin_count = compiled->texel_count = 0;
    compiled->exact = NULL;
    compiled->hierarchy = NULL;
    compiled->rigid = NULL;
}

void compiled_scene_print(const CompiledScene *compiled, StrBuf *out) {
    strbuf_addf(out, "explicit parts %zu\n", hierarchy_object_count(compiled->hierarchy));
    for (size_t i = 0; i < compiled->texel_count; i++) {
        const BuiltTexel *t = compiled->texels[i];
        strbuf_addf(out, "texel %s asked %d needed %d built %d layers %zu voxels %zu bytes %zu\n", t->def->name, t->asked,
                    t->needed, t->built, t->matter_count, t->voxel_count, t->bytes);
    }
    for (size_t i = 0; i < compiled->terrains.count; i++) {
        const BuiltTerrain *t = &compiled->terrains.items[i];
        strbuf_addf(out, "terrain %s posts %dx%d triangles needed %zu built %zu bytes %zu\n", t->terrain->file, t->columns, t->rows, t->needed, t->triangles, t->bytes);
    }
    for (size_t i = 0; i < compiled->skin_count; i++) {
        const CompiledSkin *s = &compiled->skins[i];
        strbuf_addf(out, "skin cells %zu texels %zu top %.4g bounds <%.4g, %.4g, %.4g> <%.4g, %.4g, %.4g>\n", s->cell_count,
                    s->texel_count, s->top, s->bounds.min.x, s->bounds.min.y, s->bounds.min.z, s->bounds.max.x,
                    s->bounds.max.y, s->bounds.max.z);
    }
}
