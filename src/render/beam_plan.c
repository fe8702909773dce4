/* What is drawn as exact geometry, and from where on voxels are better. */
#include "render/beam_cell.h"
#include "render/compile.h"

#include <string.h>

/* What is round is tessellated to this part of the finest voxels that would be seen: a tenth of a pixel. */
static const double BEAM_TOLERANCE_VOXELS = 0.2;
/* As many triangles in a pixel's footprint cost as much as its voxels do. */
static const double MOST_TRIANGLES_A_PIXEL = 128;
/* The same where rays meet what is rigid, at the logarithm of that cost: measured on a forest, whose voxels are wrong by more at any price. */
static const double MOST_MET_A_PIXEL = 65536;
/* The share of a skin's cells that may be left away because their texture coordinates lie on a line: beams go from them back to places. */
static const double MOST_SINGULAR = 0.01;
/* Geometry is drawn up to so many times the distance at which voxels are planned to begin: beam_pilot.c may put them off. */
static const double BEYOND_PLAN = 1.42;
/* More triangles than this are left to the voxels. */
enum { MOST_BEAM_TRIANGLES = 12000000 };

/* Skins are drawn whole, however far they are, where no more triangles than this lie on what the view meets of all of them for each of the picture's pixels, once for the eye and once for each light: that
 * takes about as long as building voxels and marching through them. At the default max_error; an error that is larger is worth fewer of them. */
static const double ALL_TRIANGLES_A_PIXEL = 400, LEAST_WORTH = 0.1, MOST_WORTH = 2;

/* How many tiles lie on the cell, and its area. */
static double tiles_of_cell(const SkinCell *cell, double *area) {
    double middle = cell->triangle ? 1.0 / 3 : 0.5, share = cell->triangle ? 0.5 : 1;
    Mat3 j;
    skin_cell_position(cell, middle, middle, 0, &j);
    const double *u = cell->u.c, *v = cell->v.c;
    double ua = u[1] + u[3] * middle, ub = u[2] + u[3] * middle, va = v[1] + v[3] * middle, vb = v[2] + v[3] * middle;
    *area = share * vec3_length(vec3_cross(j.c[0], j.c[1]));
    return share * fabs(ua * vb - ub * va);
}

double skin_tile_size(const CompiledSkin *skin) {
    double area = 0, tiles = 0, one;
    for (size_t i = 0; i < skin->cell_count; i++) tiles += tiles_of_cell(&skin->cells[i], &one), area += one;
    return tiles > 0 && area > 0 ? sqrt(area / tiles) : 0;
}

/* Tiles on what the view meets of the skin. */
static double tiles_in_view(const CompiledSkin *skin, const View *view) {
    double tiles = 0, area;
    for (size_t i = 0; i < skin->cell_count; i++)
        if (!view_misses(view, skin->cells[i].bounds)) tiles += tiles_of_cell(&skin->cells[i], &area);
    return fmax(tiles, 1);
}

static bool coordinates_singular(const CompiledSkin *skin) {
    size_t singular = 0;
    for (size_t i = 0; i < skin->cell_count; i++) {
        const SkinCell *cell = &skin->cells[i];
        singular += cell->side != CELL_FLAT && cell_is_singular(cell);
    }
    return (double)singular > MOST_SINGULAR * (double)skin->cell_count;
}

/* Triangles over one tile, on the average. */
static double triangles_a_tile(const CompiledSkin *skin, bool *all) {
    double sum = 0;
    for (size_t i = 0; i < skin->texel_count; i++) {
        const PlacedTexel *placed = &skin->texels[i];
        double family = 0;
        for (size_t k = 0; k < placed->family_size; k++) {
            const BeamTexel *beam = placed->family[k]->beam;
            *all &= beam != NULL;
            if (beam) family += (double)beam->triangle_count / (double)placed->family_size;
        }
        sum += placed->density * family;
    }
    return sum;
}

static void seen_range(const CompiledSkin *skin, const View *view, double *nearest, double *farthest) {
    Vec3 eye = view->camera.location;
    *nearest = VTS_INFINITY, *farthest = 0;
    for (size_t i = 0; i < skin->cell_count; i++) {
        Box3 box = skin->cells[i].bounds;
        if (view_misses(view, box)) continue;
        Vec3 near = vec3_max(box.min, vec3_min(box.max, eye));
        Vec3 far = vec3_max(vec3_sub(box.max, eye), vec3_sub(eye, box.min));
        *nearest = fmin(*nearest, vec3_length(vec3_sub(near, eye)));
        *farthest = fmax(*farthest, vec3_length(far));
    }
}

/* Whether their triangles are the same, whatever they look like. */
static bool same_contents(const TexelDef *a, const TexelDef *b) {
    bool same = !a->file && !b->file && a->cyclic == b->cyclic && a->layer_count == b->layer_count && memcmp(&a->bounds, &b->bounds, sizeof a->bounds) == 0;
    for (size_t i = 0; same && i < a->layer_count; i++) same = hash_equal(a->layers[i].hash, b->layers[i].hash);
    return same;
}

/* Trees that differ by their colours alone have one list of triangles, as fine as the nearest of them asks, which takes less time and less room in caches
 * than several. */
static void share_triangles(const BuiltTexel *texel, const CompiledScene *compiled) {
    for (size_t i = 0; i < compiled->texel_count; i++) {
        BuiltTexel *other = compiled->texels[i];
        if (other->beam || !same_contents(texel->def, other->def)) continue;
        other->beam = texel->beam;
        other->triangles_known = texel->triangles_known;
    }
}

static int finest_of_contents(const BuiltTexel *texel, const CompiledScene *compiled) {
    int finest = 16;
    for (size_t i = 0; i < compiled->texel_count; i++)
        if (compiled->texels[i]->finest_seen > finest && same_contents(texel->def, compiled->texels[i]->def)) finest = compiled->texels[i]->finest_seen;
    return finest;
}

/* Triangles of a texel for beams, unless there are more than `most` or none that beams can draw; false after a diagnostic. */
static bool build_texel(BuiltTexel *texel, size_t most, CompiledScene *compiled, DiagList *diags) {
    const TexelDef *def = texel->def;
    if (texel->beam || texel->triangles_known > most || def->file || def->layer_count == 0) return true;
    for (size_t i = 0; i < def->layer_count; i++)
        if (def->layers[i].density) return true; /* flakes only stand for it; voxels are what it is drawn with */
    ArenaMark mark = arena_mark(&compiled->scratch);
    BeamTexelDraft *draft = beam_texel_begin(texel->extent, def->cyclic, &compiled->scratch);
    const TexelFineness fineness = {BEAM_TOLERANCE_VOXELS / finest_of_contents(texel, compiled), 0};
    size_t triangles = 0;
    for (size_t i = 0; i < def->layer_count && triangles <= most; i++) {
        TexelMesh mesh;
        if (!texel_mesh_layer(texel, &def->layers[i], &fineness, compiled, diags, &mesh)) return false;
        triangles += mesh.triangle_count;
        if (triangles <= most) beam_texel_add_layer(draft, &mesh);
    }
    texel->triangles_known = triangles;
    if (triangles <= most) {
        texel->beam = beam_texel_finish(draft, compiled->arena);
        share_triangles(texel, compiled);
    }
    arena_reset_to(&compiled->scratch, mark);
    return true;
}

/* Triangles a pixel that cost as much as voxels do. */
static double most_a_pixel(const CompiledSkin *skin) { return skin->rigid ? MOST_MET_A_PIXEL : MOST_TRIANGLES_A_PIXEL; }

/* More triangles over a tile than this, and all that is seen of the skin lies where voxels are better. */
static double most_a_tile(const CompiledSkin *skin, bool everything, const View *view) {
    double nearest, farthest;
    seen_range(skin, view, &nearest, &farthest);
    double width = view_cone(view, view->width / 2.0, view->height / 2.0, 1).spread * nearest / BEYOND_PLAN;
    if (everything || farthest == 0 || !(width > 0)) return VTS_INFINITY;
    return most_a_pixel(skin) * (skin->tile_size / width) * (skin->tile_size / width);
}

bool beam_build_skin(CompiledSkin *skin, bool everything, CompiledScene *compiled, DiagList *diags) {
    if (!(skin->tile_size > 0) || coordinates_singular(skin)) return true;
    double most = most_a_tile(skin, everything, &compiled->view), triangles = 0;
    for (size_t i = 0; i < skin->texel_count; i++) {
        const PlacedTexel *placed = &skin->texels[i];
        double share = placed->density / (double)placed->family_size;
        for (size_t k = 0; k < placed->family_size && share > 0; k++) {
            size_t left = (size_t)fmin((most - triangles) / share, MOST_BEAM_TRIANGLES);
            if (!build_texel(placed->family[k], left, compiled, diags)) return false;
            if (!placed->family[k]->beam) return true; /* voxels, whatever the others hold */
            triangles += share * (double)placed->family[k]->beam->triangle_count;
            if (triangles > most) return true;
        }
    }
    return true;
}

/* Triangles that the picture is worth, each counted as often as it is drawn: for the eye, and for each light that casts shadows. */
static double triangles_worth(const CompiledScene *compiled) {
    const View *view = &compiled->view;
    double worth = double_clamp(1 / (255 * compiled->max_error), LEAST_WORTH, MOST_WORTH);
    int times = 1;
    for (size_t i = 0; i < compiled->scene->light_count; i++) times += !compiled->scene->lights[i].shadowless;
    return worth * ALL_TRIANGLES_A_PIXEL * view->width * view->height / times;
}

/* Takes the triangles on what the view meets of the skin from *left; *whole: there were as many. */
static bool build_whole(CompiledSkin *skin, double *left, CompiledScene *compiled, DiagList *diags, bool *whole) {
    double tiles = tiles_in_view(skin, &compiled->view), size = skin->tile_size;
    *whole = size > 0 && !coordinates_singular(skin);
    for (size_t i = 0; i < skin->texel_count && *whole; i++) {
        const PlacedTexel *placed = &skin->texels[i];
        double share = tiles * placed->density / (double)placed->family_size;
        for (size_t k = 0; k < placed->family_size && share > 0 && *whole; k++) {
            if (!build_texel(placed->family[k], (size_t)fmin(*left / share, MOST_BEAM_TRIANGLES), compiled, diags)) return false;
            if (placed->family[k]->beam) *left -= share * (double)placed->family[k]->beam->triangle_count;
            *whole = placed->family[k]->beam && *left >= 0;
        }
    }
    return true;
}

bool beam_build_whole(CompiledScene *compiled, DiagList *diags, bool *whole) {
    double left = triangles_worth(compiled);
    *whole = true;
    for (size_t i = 0; i < compiled->skin_count && *whole; i++)
        if (!compiled->skins[i].rigid && !build_whole(&compiled->skins[i], &left, compiled, diags, whole)) return false;
    return true;
}

void beam_plan_skin(CompiledSkin *skin, bool everything, CompiledScene *compiled) {
    const View *view = &compiled->view;
    bool all = true;
    double triangles = triangles_a_tile(skin, &all), nearest, farthest;
    if (!all || !(skin->tile_size > 0) || coordinates_singular(skin)) return;
    Cone cone = view_cone(view, view->width / 2.0, view->height / 2.0, 1);
    double width = skin->tile_size * sqrt(most_a_pixel(skin) / fmax(triangles, 1));
    double to = cone.spread > 0 ? width / cone.spread : cone.width <= width ? VTS_INFINITY : 0;
    seen_range(skin, view, &nearest, &farthest);
    bool out_of_sight = farthest == 0; /* its shadows may be seen */
    if (everything || out_of_sight || 0.7 * to >= farthest ) to = VTS_INFINITY;
    if (BEYOND_PLAN * to <= nearest && !out_of_sight) return;
    ArenaMark mark = arena_mark(&compiled->scratch);
    Box3 *boxes = arena_new_array(&compiled->scratch, Box3, skin->cell_count);
    for (size_t i = 0; i < skin->cell_count; i++) boxes[i] = skin->cells[i].bounds;
    skin->boxes = box_tree_build(boxes, skin->cell_count, compiled->arena);
    arena_reset_to(&compiled->scratch, mark);
    skin->exact_to = to;
}
