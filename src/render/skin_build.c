/* From a skin of the scene graph to cells and built texels. */
#include "render/compile.h"

#include "base/random.h"
#include "base/stopwatch.h"
#include "grow/wind.h"
#include "pattern/pattern.h"
#include "render/beam_rigid.h"
#include "render/matter_color.h"
#include "render/skin_box.h"
#include "render/skin_joint.h"
#include "render/skin_rim.h"
#include "render/skin_wind.h"
#include "scene/scene_hash.h"
#include "tape/noise.h"
#include "texel/texel_content.h"
#include "texel/layer_views.h"
#include "texel/texel_field.h"

#include <string.h>

enum { MOST_SUPERIMPOSED = 8 };

/* ---- texels ---- */

/* Contents are tessellated to a fifth of a voxel: what is left of facets disappears in the voxels' own blur. */
static const double CONTENT_TOLERANCE_VOXELS = 0.2;
/* For the reference as the finest voxels would have it. */
static const double EXACT_TOLERANCE = 0.2 / TEXEL_LARGEST_RESOLUTION;

bool texel_mesh_layer(const BuiltTexel *texel, const TexelLayer *layer, const TexelFineness *fineness, CompiledScene *compiled, DiagList *diags,
                      TexelMesh *mesh) {
    const CompileOptions *options = compiled->options;
    const TexelMeshOptions how = {fineness->tolerance, options->interrupted, options->progress, fineness->flakes};
    ShapeRefusal refusal;
    if (!texel_layer_mesh(texel->def, layer, &how, &compiled->scratch, mesh, &refusal)) {
        if (options->interrupted && *options->interrupted) return false;
        diag_error(diags, refusal.span, "this cannot be part of a texel: %s", refusal.reason);
        return false;
    }
    if (refusal.reason) diag_warning(diags, refusal.span, "this is coarser than asked: %s", refusal.reason);
    if (mesh->triangle_count == 0) diag_warning(diags, layer->span, "this layer of the texel '%s' is empty", texel->def->name);
    return true;
}

/* Builds the voxels of a layer; NULL when that is not possible (see diags) or interrupted. `views`: of one of several layers, else NULL. */
static VoxelLayer *build_voxels(const BuiltTexel *texel, const TexelLayer *layer, LayerViews *views, const CompileOptions *options, CompiledScene *compiled,
                                DiagList *diags) {
    const TexelDef *def = texel->def;
    TexelBuildOptions build = {.resolution = texel->built, .extent = texel->extent, .cyclic = def->cyclic, .filtering = compiled->filtering,
                               .pool = options->pool, .memory = options->memory, .progress = options->progress,
                               .name = def->name, .views = views};
    TexelMesh mesh;
    ArenaMark mark = arena_mark(&compiled->scratch);
    if (layer->density) {
        mesh = (TexelMesh){0};
        build.field = texel_field_make(def, layer, &compiled->scratch);
    } else if (!texel_mesh_layer(texel, layer, &(TexelFineness){CONTENT_TOLERANCE_VOXELS / texel->built, 0}, compiled, diags, &mesh)) {
        return NULL;
    }
    VoxelLayer *voxels = voxel_layer_build(&mesh, &build, NULL);
    arena_reset_to(&compiled->scratch, mark);
    if (!voxels && (!options->interrupted || !*options->interrupted)) memory_budget_fail(options->memory);
    if (voxels && (mesh.triangle_count || layer->density) && voxel_layer_is_empty(voxels))
        diag_warning(diags, layer->span, "nothing of this layer of the texel '%s' lies within its bounds", def->name);
    return voxels;
}

/* Empty layers are built each time, so that their warnings come each time. */
static void remember(const BuiltTexel *texel, Hash128 key, VoxelLayer *voxels, const CompileOptions *options, DiagList *diags) {
    if (!options->texels || !voxels || voxel_layer_is_empty(voxels)) return;
    StrBuf error = {0};
    if (!texel_cache_add(options->texels, key, texel->def, texel->built, voxels, &error))
        diag_warning(diags, (Span){0}, "the cache stays as it is: %s", error.size ? error.data : "it cannot be written");
    strbuf_free(&error);
}

/* All layers from the texel's file; false after a diagnostic. */
static bool take_from_file(BuiltTexel *texel, const CompileOptions *options, DiagList *diags) {
    const TexelDef *def = texel->def;
    const TexelFile *file = options->texels ? texel_cache_opened(options->texels, def->file_content) : NULL;
    if (!file) diag_error(diags, def->span, "the texel file '%s' is no longer there", def->file);
    for (size_t i = 0; file && i < def->layer_count; i++) texel->matter[i].voxels = voxel_layer_share(file->layers[i].voxels);
    return file != NULL;
}

/* All that a layer's voxels depend on: with those of other layers they are made to hide together what is hidden. */
static Hash128 layer_key(const BuiltTexel *texel, size_t index, const CompiledScene *compiled) {
    const TexelDef *def = texel->def;
    Hash128 key = texel_layer_key(def, &def->layers[index], texel->built, compiled->filtering);
    if (def->layer_count > 1) hash_add_u64(&key, index);
    for (size_t i = 0; i < def->layer_count; i++)
        if (i != index) hash_add_hash(&key, def->layers[i].hash);
    return key;
}

/* All layers from the cache, or none. */
static bool take_from_cache(BuiltTexel *texel, const CompileOptions *options, const CompiledScene *compiled) {
    const TexelDef *def = texel->def;
    size_t found = 0;
    for (; options->texels && found < def->layer_count; found++) {
        texel->matter[found].voxels = texel_cache_find(options->texels, layer_key(texel, found, compiled), def, texel->built);
        if (!texel->matter[found].voxels) break;
    }
    if (found == def->layer_count) return true;
    while (found > 0) {
        voxel_layer_destroy(texel->matter[--found].voxels);
        texel->matter[found].voxels = NULL;
    }
    return false;
}

static void join_layers(BuiltTexel *texel, LayerViews *const *views, const CompileOptions *options) {
    enum { MOST_JOINED = 8 };
    VoxelLayer *layers[MOST_JOINED];
    LayerViews *known[MOST_JOINED];
    size_t count = 0;
    for (size_t i = 0; i < texel->def->layer_count; i++) {
        if (!views[i]->known || count == MOST_JOINED) continue; /* a density, or nothing */
        layers[count] = texel->matter[i].voxels;
        known[count++] = views[i];
    }
    if (count) voxel_layers_join(layers, known, count, texel->extent, options->pool);
}

static bool build_layers(BuiltTexel *texel, const CompileOptions *options, CompiledScene *compiled, DiagList *diags) {
    const TexelDef *def = texel->def;
    ArenaMark mark = arena_mark(&compiled->scratch);
    bool several = def->layer_count > 1, done = true;
    LayerViews **views = arena_new_array(&compiled->scratch, LayerViews *, def->layer_count + 1);
    for (size_t i = 0; several && i < def->layer_count; i++) views[i] = arena_new(&compiled->scratch, LayerViews);
    for (size_t i = 0; done && i < def->layer_count; i++)
        done = (texel->matter[i].voxels = build_voxels(texel, &def->layers[i], views[i], options, compiled, diags)) != NULL;
    if (done && several) join_layers(texel, views, options);
    arena_reset_to(&compiled->scratch, mark);
    done = done && !(options->interrupted && *options->interrupted);
    for (size_t i = 0; done && i < def->layer_count; i++) remember(texel, layer_key(texel, i, compiled), texel->matter[i].voxels, options, diags);
    return done;
}

/* Sets the voxels of all layers; false after a diagnostic, or when interrupted. */
static bool get_voxels(BuiltTexel *texel, const CompileOptions *options, CompiledScene *compiled, DiagList *diags) {
    if (texel->def->file) return take_from_file(texel, options, diags);
    if (take_from_cache(texel, options, compiled)) return true;
    texel->cached = false;
    return build_layers(texel, options, compiled, diags);
}

/* NULL when interrupted, or for want of matter. */
static TexelSky *build_sky(const BuiltTexel *texel, const CompileOptions *options, CompiledScene *compiled) {
    const TexelDef *def = texel->def;
    if (texel->matter_count == 0) return NULL;
    const VoxelLayer **layers = arena_new_array(compiled->arena, const VoxelLayer *, texel->matter_count);
    for (size_t i = 0; i < texel->matter_count; i++) layers[i] = texel->matter[i].voxels;
    TexelSkyOptions sky = {.opacity = compiled->march.opacity, .pool = options->pool, .memory = options->memory,
                           .repeated = def->cyclic ? def->cyclic : TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z}; /* copies stand side by side */
    TexelSky *built = texel_sky_build(layers, texel->matter_count, &sky);
    if (!built && (!options->interrupted || !*options->interrupted)) memory_budget_fail(options->memory);
    return built;
}

/* All that the view of the sky depends on. */
static Hash128 sky_key(const BuiltTexel *texel, const CompiledScene *compiled) {
    enum { KIND_SKY = 0x736b79 };
    Hash128 key = hash_begin(KIND_SKY);
    hash_add_u64(&key, compiled->march.opacity);
    hash_add_u64(&key, texel->def->cyclic);
    for (size_t i = 0; i < texel->def->layer_count; i++)
        hash_add_hash(&key, texel->def->file ? texel->def->file_content
                                             : layer_key(texel, i, compiled));
    return key;
}

static void find_or_build_sky(BuiltTexel *texel, const CompileOptions *options, CompiledScene *compiled) {
    Hash128 key = sky_key(texel, compiled);
    texel->sky = options->texels ? texel_cache_find_sky(options->texels, key) : NULL;
    texel->sky_is_kept = texel->sky != NULL;
    if (texel->sky) return;
    TexelSky *sky = build_sky(texel, options, compiled);
    texel->sky = sky;
    texel->sky_is_kept = sky && options->texels && texel_cache_add_sky(options->texels, key, sky);
}

static bool build_matter(BuiltTexel *texel, const CompileOptions *options, CompiledScene *compiled, DiagList *diags) {
    const TexelDef *def = texel->def;
    /* Phases come again. */
    if (options->texels) texel_cache_patience(options->texels, 2 * (uint64_t)def->phase_count * (def->layer_count + 1));
    double start = stopwatch_wall();
    texel->cached = def->layer_count > 0;
    if (!get_voxels(texel, options, compiled, diags)) return false;
    for (size_t i = 0; i < def->layer_count; i++) {
        matter_colors_prepare(&texel->matter[i], compiled->arena);
        VoxelLayer *voxels = texel->matter[i].voxels;
        for (int l = 0; l < voxel_layer_levels(voxels); l++) texel->voxel_count += voxel_layer_voxels(voxels, l);
        texel->bytes += voxel_layer_bytes(voxels);
    }
    if (compiled->scene->settings.sky_light) find_or_build_sky(texel, options, compiled);
    texel->build_seconds = stopwatch_wall() - start;
    return true;
}

static void list_texel(CompiledScene *compiled, BuiltTexel *texel) {
    /* The list is rebuilt at each addition: a scene has few texels. */
    BuiltTexel **list = arena_new_array(compiled->arena, BuiltTexel *, compiled->texel_count + 1);
    if (compiled->texel_count) memcpy(list, compiled->texels, compiled->texel_count * sizeof *list);
    list[compiled->texel_count] = texel;
    compiled->texels = list;
    compiled->texel_count++;
}

BuiltTexel *texel_ask(const TexelDef *def, CompiledScene *compiled) {
    for (size_t i = 0; i < compiled->texel_count; i++)
        if (compiled->texels[i]->def == def) return compiled->texels[i];
    BuiltTexel *texel = arena_new(compiled->arena, BuiltTexel);
    *texel = (BuiltTexel){.def = def, .extent = texel_extent(def), .asked = def->resolution};
    texel->matter = arena_new_array(compiled->arena, TexelMatter, def->layer_count);
    for (size_t i = 0; i < def->layer_count; i++) {
        const Texture *texture = def->layers[i].texture ? def->layers[i].texture : compiled->scene->default_texture;
        texel->matter[i].look = look_from_texture(texture, &compiled->scene->settings);
    }
    texel->matter_count = def->layer_count;
    list_texel(compiled, texel);
    return texel;
}

bool texel_build(BuiltTexel *texel, const CompileOptions *options, CompiledScene *compiled, DiagList *diags) {
    if (options->exact) {
        double start = stopwatch_wall();
        bool done = exact_build_texel(texel, &(ExactMaking){.tolerance = EXACT_TOLERANCE}, compiled, diags);
        texel->build_seconds = stopwatch_wall() - start;
        return done;
    }
    if (!build_matter(texel, options, compiled, diags)) return false;
    if (texel->matter_count == 0) return true;
    int size[3];
    voxel_layer_size(texel->matter[0].voxels, 0, size);
    Vec3f e = texel->extent;
    texel->voxel = cbrtf(e.x / (float)size[0] * e.y / (float)size[1] * e.z / (float)size[2]);
    texel->levels = voxel_layer_levels(texel->matter[0].voxels);
    return true;
}

/* ---- vertices: height vectors and texture coordinates, jittered ---- */

typedef struct SkinVertex {
    Vec3 height;
    double shift_u, shift_v, w_foot, w_tip;
} SkinVertex;

static double height_factor(const SkinMapping *mapping, Vec3 foot, Vec3 normal) {
    double factor = 1, in[3] = {foot.x, foot.y, foot.z};
    if (mapping->height_function) tape_eval_once(mapping->height_function, in, &factor);
    if (mapping->height_pigment) {
        Color c = pigment_color(mapping->height_pigment, foot, normal, 0);
        factor *= 0.297 * c.red + 0.589 * c.green + 0.114 * c.blue; /* POV-Ray's grey */
    }
    return isfinite(factor) ? factor : 0;
}

static Vec3 noise_at(Vec3 foot, const NoiseJitter *jitter, uint32_t seed) {
    return vec3_scale(noise_perlin3(vec3_scale(foot, 1 / jitter->scale), seed), jitter->amplitude);
}

/* Streams of the noises, so that one jitter does not repeat in another. */
enum { STREAM_COORDINATES = 0x11, STREAM_HEIGHT = 0x22, STREAM_DIRECTION = 0x33 };

/* Before the wind, and before the layer is made as high as copies reach. */
static SkinVertex make_vertex(const Skin *skin, const SurfaceMesh *mesh, size_t i) {
    const SkinMapping *mapping = &skin->mapping;
    const SkinJitter *jitter = &skin->jitter;
    Vec3 foot = mesh->vertices[i], normal = mesh->normals[i];
    double in[3] = {foot.x, foot.y, foot.z};
    Vec3 given = mesh->height_vectors ? mesh->height_vectors[i] : normal;
    double length = vec3_length(given);
    Vec3 direction = vec3_normalize(given), comb = mapping->comb;
    if (mapping->comb_function) {
        double c[3];
        tape_eval_once(mapping->comb_function, in, c);
        if (isfinite(c[0]) && isfinite(c[1]) && isfinite(c[2])) comb = vec3_add(comb, vec3(c[0], c[1], c[2]));
    }
    direction = vec3_add(direction, comb);
    if (jitter->direction.amplitude != 0) {
        Vec3 n = noise_at(foot, &jitter->direction, jitter->seed + STREAM_DIRECTION);
        direction = vec3_add(direction, vec3_madd(n, normal, -vec3_dot(n, normal)));
    }
    length *= mapping->height * height_factor(mapping, foot, normal);
    if (jitter->height.amplitude != 0) length *= 1 + noise_at(foot, &jitter->height, jitter->seed + STREAM_HEIGHT).x;
    SkinVertex out = {.w_foot = mapping->w_foot, .w_tip = mapping->w_tip};
    if (jitter->coordinates.amplitude != 0) {
        Vec3 shift = noise_at(foot, &jitter->coordinates, jitter->seed + STREAM_COORDINATES);
        out.shift_u = shift.x, out.shift_v = shift.y;
    }
    if (mesh->w_vectors) out.w_foot = mesh->w_vectors[i].x, out.w_tip = mesh->w_vectors[i].y;
    if (mapping->w_function) {
        double w[3];
        tape_eval_once(mapping->w_function, in, w);
        out.w_foot = w[0], out.w_tip = w[1];
    }
    out.height = vec3_scale(direction, length);
    return out;
}

/* NULL after a diagnostic, or when interrupted. */
static const SkinVertex *make_vertices(const Skin *skin, const SurfaceMesh *mesh, double top, CompiledScene *compiled, DiagList *diags) {
    SkinVertex *vertex = arena_new_array(&compiled->scratch, SkinVertex, mesh->vertex_count);
    Vec3 *heights = arena_new_array(&compiled->scratch, Vec3, mesh->vertex_count);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        vertex[i] = make_vertex(skin, mesh, i);
        heights[i] = vertex[i].height;
    }
    if (!skin_bend(skin, mesh, compiled, diags, heights)) return NULL;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        SkinVertex *v = &vertex[i];
        v->height = vec3_scale(heights[i], top);
        v->w_tip = v->w_foot + (v->w_tip - v->w_foot) * top;
    }
    return vertex;
}

/* ---- cells ---- */

/* The mean length of the surface along u and v, weighted by area: what `tile` divides. */
static void mean_lengths(const SurfaceMesh *mesh, double *along_u, double *along_v) {
    double sum_u = 0, sum_v = 0, weight = 0;
    for (size_t i = 0; i < mesh->cell_count; i++) {
        const SurfaceCell *c = &mesh->cells[i];
        int last = c->corner_count - 1;
        Vec3 e1 = vec3_sub(mesh->vertices[c->vertex[1]], mesh->vertices[c->vertex[0]]);
        Vec3 e2 = vec3_sub(mesh->vertices[c->vertex[last]], mesh->vertices[c->vertex[0]]);
        TexCoord t0 = mesh->uvs[c->uv[0]], t1 = mesh->uvs[c->uv[1]], t2 = mesh->uvs[c->uv[last]];
        double du1 = t1.u - t0.u, dv1 = t1.v - t0.v, du2 = t2.u - t0.u, dv2 = t2.v - t0.v, det = du1 * dv2 - du2 * dv1;
        double area = vec3_length(vec3_cross(e1, e2));
        if (det == 0 || !(area > 0)) continue;
        Vec3 pu = vec3_scale(vec3_sub(vec3_scale(e1, dv2), vec3_scale(e2, dv1)), 1 / det);
        Vec3 pv = vec3_scale(vec3_sub(vec3_scale(e2, du1), vec3_scale(e1, du2)), 1 / det);
        sum_u += area * vec3_length(pu), sum_v += area * vec3_length(pv), weight += area;
    }
    *along_u = weight > 0 ? sum_u / weight : 1;
    *along_v = weight > 0 ? sum_v / weight : 1;
}

static void repeats(const SkinMapping *mapping, const Surface *surface, const SurfaceMesh *mesh, double *u, double *v) {
    *u = mapping->repeat_u, *v = mapping->repeat_v;
    if (surface->length_u > 0 && surface->length_v > 0) { /* u and v are lengths */
        *u = mapping->by_tile_size ? 1 / mapping->tile_size : *u / surface->length_u;
        *v = mapping->by_tile_size ? 1 / mapping->tile_size : *v / surface->length_v;
        return;
    }
    if (!mapping->by_tile_size) return;
    double along_u, along_v;
    mean_lengths(mesh, &along_u, &along_v);
    /* Whole numbers, so that tiles meet where a surface closes on itself. */
    *u = fmax(1, round(along_u / mapping->tile_size));
    *v = fmax(1, round(along_v / mapping->tile_size));
}

/* Folded boxes as they are found: how many, the first of them, and up to which share of its height none folds. */
typedef struct Folds {
    size_t count, first;
    double unfolded;
} Folds;

static void note_fold(Folds *folds, const SkinCell *cell, size_t number) {
    if (cell->side != CELL_FOLDED) return;
    if (!folds->count++) folds->first = number;
    folds->unfolded = skin_cell_unfolded_height(cell, folds->unfolded);
}

static void report_folds(const Folds *folds, const Skin *skin, const SurfaceMesh *mesh, const SkinCell *cells, DiagList *diags) {
    if (!folds->count) return;
    const SkinCell *cell = &cells[folds->first];
    const uint32_t *v = mesh->cells[folds->first].vertex;
    Vec3 at = skin_cell_position(cell, cell->triangle ? 1.0 / 3 : 0.5, cell->triangle ? 1.0 / 3 : 0.5, 0, NULL);
    diag_warning(diags, skin->span,
                 "the skin folds over %zu of %zu boxes, where its height vectors cross, first over <%.4g, %.4g, %.4g> (vertices %u, %u, %u); "
                 "with its height times %.3g nothing would fold",
                 folds->count, mesh->cell_count, at.x, at.y, at.z, v[0], v[1], v[2], folds->unfolded);
}

/* Whether sheets lie over one another somewhere: in a cell, or where a wall stands between cells that are turned opposite ways. */
static bool sheets_overlap(const CompiledSkin *skin) {
    for (size_t i = 0; i < skin->cell_count; i++) {
        const SkinCell *cell = &skin->cells[i];
        if (cell->side == CELL_FOLDED) return true;
        for (int e = 0; e < (cell->triangle ? 3 : 4) && cell->side != CELL_FLAT; e++) {
            int32_t next = cell->neighbour[e].cell;
            if (next >= 0 && skin->cells[next].side != CELL_FLAT && skin->cells[next].side != cell->side) return true;
        }
    }
    return false;
}

static size_t open_edges(const SurfaceMesh *mesh) {
    size_t count = 0;
    for (size_t i = 0; i < mesh->cell_count; i++)
        for (int e = 0; e < mesh->cells[i].corner_count; e++) count += mesh->neighbours[i][e].cell < 0;
    return count;
}

static bool make_cells(const Skin *skin, const SurfaceMesh *mesh, CompiledScene *compiled, CompiledSkin *out, DiagList *diags) {
    const SkinVertex *vertex = make_vertices(skin, mesh, out->top, compiled, diags);
    if (!vertex) return false;
    double repeat_u, repeat_v;
    repeats(&skin->mapping, skin->surface, mesh, &repeat_u, &repeat_v);
    out->cells = arena_new_array(compiled->arena, SkinCell, mesh->cell_count + open_edges(mesh)); /* room for a rim */
    out->cell_count = mesh->cell_count;
    out->bounds = box3_empty();
    Folds folds = {.unfolded = 1};
    for (size_t i = 0; i < mesh->cell_count; i++) {
        const SurfaceCell *in = &mesh->cells[i];
        SkinCell *cell = &out->cells[i];
        SkinCorner corner[4] = {{.u = 0}};
        for (int k = 0; k < in->corner_count; k++) {
            const SkinVertex *at = &vertex[in->vertex[k]];
            TexCoord uv = mesh->uvs[in->uv[k]];
            corner[k] = (SkinCorner){.foot = mesh->vertices[in->vertex[k]], .height = at->height, .u = uv.u * repeat_u + at->shift_u,
                                     .v = uv.v * repeat_v + at->shift_v, .w_foot = at->w_foot, .w_tip = at->w_tip};
        }
        skin_cell_fit(cell, corner, in->corner_count == 3);
        memcpy(cell->neighbour, mesh->neighbours[i], sizeof cell->neighbour);
        out->bounds = box3_union(out->bounds, cell->bounds);
        note_fold(&folds, cell, i);
    }
    report_folds(&folds, skin, mesh, out->cells, diags);
    return true;
}

/* ---- placing ---- */

/* How far copies may reach out of their tiles. */
static double copy_overhang(const InstanceJitter *jitter) {
    double largest = 1 + jitter->scale / 2, half = jitter->rotate != 0 ? 0.70711 : 0.5;
    return double_clamp(jitter->displace / 2 + half * largest - 0.5, 0, MOST_REACH);
}

static const Look *look_over(const Skin *skin, const SkinTexel *in, CompiledScene *compiled) {
    const Texture *texture = in->texture ? in->texture : skin->texture;
    if (!texture) return NULL;
    Look *look = arena_new(compiled->arena, Look);
    *look = look_from_texture(texture, &compiled->scene->settings);
    return look;
}

PlacedTexel *skin_place_family(CompiledSkin *skin, size_t index, const TexelDef *const *defs, size_t count, CompiledScene *compiled) {
    const SkinTexel *in = &skin->def->texels[index];
    PlacedTexel *placed = &skin->texels[skin->texel_count];
    BuiltTexel **members = arena_new_array(compiled->arena, BuiltTexel *, count);
    *placed = (PlacedTexel){.family = members, .density = in->density, .finest_voxel = INFINITY, .look = look_over(skin->def, in, compiled)};
    placed->seed = random_hash(skin->def->jitter.seed, index, 0, 0);
    for (size_t k = 0; k < count; k++) {
        BuiltTexel *texel = texel_ask(defs[k], compiled);
        if (texel->matter_count == 0) continue;
        members[placed->family_size++] = texel;
        placed->cyclic |= (defs[k]->cyclic & (TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z)) != 0;
    }
    placed->jitter = skin->def->jitter.instance;
    if (placed->family_size) skin->texel_count++;
    return placed;
}

static void place_texel(size_t index, CompiledScene *compiled, DiagList *diags, CompiledSkin *out) {
    const TexelDef *texel = out->def->texels[index].texel;
    const TexelDef *const *family = texel->choice_count ? texel->choices : &texel;
    size_t count = texel->choice_count ? texel->choice_count : 1;
    if (out->def->wang && skin_place_wang(out, index, family, count, compiled, diags)) return;
    PlacedTexel *placed = skin_place_family(out, index, family, count, compiled);
    placed->overhang = placed->cyclic || !placed->jitter.present ? 0 : copy_overhang(&placed->jitter);
    placed->reach = (int)ceil(placed->overhang - 1e-9);
    if (!placed->reach) placed->overhang = 0;
    placed->alike = placed->cyclic && placed->family_size == 1 && placed->density >= 1 &&
                    !(placed->jitter.present && placed->jitter.tinted);
}

static double tallest_copy(const Skin *skin) {
    const InstanceJitter *jitter = &skin->jitter.instance;
    bool scaled = false;
    for (size_t i = 0; i < skin->texel_count; i++) {
        const TexelDef *def = skin->texels[i].texel;
        if (def->choice_count) def = def->choices[0];
        scaled |= (def->cyclic & (TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z)) == 0;
    }
    return jitter->present && scaled ? 1 + jitter->scale / 2 : 1;
}

/* The longest cell that still shows what changes along the surface: a quarter of the shortest wave. */
static double longest_cell(const Skin *skin) {
    const NoiseJitter *noise[] = {&skin->jitter.coordinates, &skin->jitter.height, &skin->jitter.direction};
    double shortest = skin->wind ? wind_wavelength(skin->wind) : HUGE_VAL;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(noise); i++)
        if (noise[i]->amplitude != 0) shortest = fmin(shortest, noise[i]->scale);
    return isfinite(shortest) ? shortest / 4 : 0;
}

double skin_longest_cell(const Skin *skin) {
    const SkinMapping *m = &skin->mapping;
    if (m->height_function || m->height_pigment || m->comb_function || m->w_function) return 0;
    double wave = longest_cell(skin);
    return wave > 0 ? wave : HUGE_VAL;
}

static bool make_mesh(const Skin *skin, CompiledScene *compiled, DiagList *diags, SurfaceMesh *mesh) {
    SurfaceMeshOptions options = {.tolerance = 0.02 * skin->mapping.height, .longest_edge = longest_cell(skin)};
    ShapeRefusal refusal;
    if (surface_mesh_build(skin->surface, &options, &compiled->scratch, mesh, &refusal)) return true;
    diag_error(diags, refusal.span, "this surface cannot carry a skin: %s", refusal.reason);
    return false;
}

/* Waves shorter than two cells would not be drawn but sampled at random, and those of up to four, to which cells are cut, badly; both bend each cell's
 * corners apart at great cost: the skin in a wind without the former, in which the latter are weaker. NULL: there are none. */
static const Skin *without_short_waves(const Skin *skin, const SurfaceMesh *mesh, Arena *arena, DiagList *diags) {
    double shortest = 4 * mesh->shortest_cut;
    if (!skin->wind || !(wind_wavelength(skin->wind) < shortest)) return NULL;
    diag_warning(diags, skin->span, "the wind changes over %.3g units, less than four of the surface's cells, which cannot be cut below %.3g: "
                 "such short waves are weaker, and below two cells their mean takes their place", wind_wavelength(skin->wind), mesh->shortest_cut);
    WindField *wind = arena_copy(arena, skin->wind, sizeof *wind);
    wind_smooth(wind, shortest);
    wind_rehash(wind);
    Skin *smooth = arena_copy(arena, skin, sizeof *smooth);
    smooth->wind = wind;
    return smooth;
}

static bool compile_skin(const Skin *skin, CompiledScene *compiled, DiagList *diags, CompiledSkin *out) {
    SurfaceMesh mesh;
    *out = (CompiledSkin){.def = skin, .top = tallest_copy(skin)};
    if (skin->texel_count > MOST_SUPERIMPOSED) {
        diag_error(diags, skin->texels[MOST_SUPERIMPOSED].span, "a skin holds at most %d superimposed texels", MOST_SUPERIMPOSED);
        return false;
    }
    if (!make_mesh(skin, compiled, diags, &mesh)) return false;
    const Skin *smooth = without_short_waves(skin, &mesh, compiled->arena, diags);
    if (smooth && !make_mesh(smooth, compiled, diags, &mesh)) return false;
    if (!make_cells(smooth ? smooth : skin, &mesh, compiled, out, diags)) return false;
    out->texels = arena_new_array(compiled->arena, PlacedTexel, skin->texel_count * (skin->wang ? WANG_GRIDS + 1 : 1));
    for (size_t i = 0; i < skin->texel_count; i++) place_texel(i, compiled, diags, out);
    skin_ask_triangles(out, compiled);
    skin_rim_add(out, &mesh, compiled->arena, &compiled->scratch);
    out->tile_size = skin_tile_size(out);
    out->rigid = skin_is_rigid(out);
    out->overlaps = sheets_overlap(out);
    out->box = skin_box_of(out, compiled->arena);
    return true;
}

bool skin_compile(const Skin *skin, CompiledScene *compiled, DiagList *diags, CompiledSkin *out) {
    ArenaMark mark = arena_mark(&compiled->scratch); /* of the surface's mesh, of which the skin has its own cells */
    bool good = compile_skin(skin, compiled, diags, out);
    arena_reset_to(&compiled->scratch, mark);
    return good;
}

bool skin_finish(CompiledSkin *skin, const CompileOptions *options, CompiledScene *compiled) {
    for (size_t i = 0; i < skin->texel_count; i++) {
        PlacedTexel *placed = &skin->texels[i];
        for (size_t k = 0; k < placed->family_size; k++) {
            const BuiltTexel *texel = placed->family[k];
            placed->levels = int_max(placed->levels, texel->levels);
            if (!(texel->voxel < placed->finest_voxel)) continue;
            placed->finest_voxel = texel->voxel;
            placed->finest_extent = texel->extent;
        }
    }
    if (!options->exact) skin->joint = skin_joint_copies(skin, compiled->arena);
    return options->exact || skin->box || (skin->tree = cell_tree_create(hierarchy_embree(compiled->hierarchy))) != NULL;
}
