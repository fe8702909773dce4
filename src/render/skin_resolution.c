/* How fine the texels of skins are to be: what the view can see of them, and what the frames beside it see. */
#include "render/compile.h"

enum { LEAST_RESOLUTION = 8, LARGEST_AUTO_RESOLUTION = 512 };
/* The least that what triangles see of the sky is known with. */
enum { SKY_RESOLUTION = 32 };
/* Texels of films are built finer by so much than the frame asks for that tells: while a camera comes nearer by no more, none is built anew. */
static const double FILM_MARGIN = 1.25;

static int power_of_two_above(double x, int most) {
    int n = LEAST_RESOLUTION;
    while (n < most && (double)n < x) n *= 2;
    return n;
}

/* ---- what the view can see ---- */

/* Voxels along a unit of texel space that the nearest visible cell asks for, if that were a cube, at so many footprints of a pixel each; not nearer than
 * `from`. */
static double finest_seen(const CompiledSkin *skin, const View *view, double voxel_width, double from) {
    const Cone cone = view_cone(view, view->width / 2.0, view->height / 2.0, 1);
    double finest = 0;
    for (size_t i = 0; i < skin->cell_count; i++) {
        const SkinCell *cell = &skin->cells[i];
        Box3 box = cell->bounds;
        if (view_misses(view, box)) continue;
        Vec3 nearest = vec3_max(box.min, vec3_min(box.max, view->camera.location));
        double distance = fmax(from, vec3_length(vec3_sub(nearest, view->camera.location)));
        double footprint = cone_diameter(&cone, distance) * voxel_width;
        SkinPoint middle = {(int32_t)i, cell->triangle ? 1.0 / 3 : 0.5, cell->triangle ? 1.0 / 3 : 0.5, 0.5};
        TexturePlace place = skin_texture_place(cell, &middle);
        double volume = fabs(vec3_dot(place.grad_u, vec3_cross(place.grad_v, place.grad_w)));
        if (!(volume > 0)) continue;
        double side = cbrt(1 / volume); /* scene units for one unit of texel space */
        finest = fmax(finest, footprint > 0 ? side / footprint : HUGE_VAL);
    }
    return finest;
}

static int resolution_of(const BuiltTexel *texel, double finest) {
    const double volume = (double)(texel->extent.x * texel->extent.y * texel->extent.z);
    return (int)double_clamp(ceil(finest / cbrt(volume)), 1, TEXEL_LARGEST_RESOLUTION);
}

void skin_ask_triangles(CompiledSkin *skin, const CompiledScene *compiled) {
    const double finest = finest_seen(skin, &compiled->view, (double)compiled->march.voxel_width, 0);
    for (size_t i = 0; i < skin->texel_count; i++)
        for (size_t k = 0; k < skin->texels[i].family_size; k++) {
            BuiltTexel *texel = skin->texels[i].family[k];
            texel->finest_seen = int_max(texel->finest_seen, resolution_of(texel, finest));
        }
}

void skin_ask_voxels(CompiledSkin *skin, const CompileOptions *options, const CompiledScene *compiled) {
    const bool all_exact = skin->boxes && !isfinite(skin->exact_to) && !compiled->secondary, sky = compiled->scene->settings.sky_light;
    const double from = skin->boxes && isfinite(skin->exact_to) ? EARLIEST_VOXELS * 0.7 * skin->exact_to : 0;
    const bool asks_view = !options->texel_resolution && !(all_exact && sky);
    const double finest = asks_view ? finest_seen(skin, &compiled->view, (double)compiled->march.voxel_width, from) : 0;
    for (size_t i = 0; i < skin->texel_count; i++)
        for (size_t k = 0; k < skin->texels[i].family_size; k++) {
            BuiltTexel *texel = skin->texels[i].family[k];
            int needed = asks_view ? resolution_of(texel, finest) : options->texel_resolution ? options->texel_resolution : SKY_RESOLUTION;
            if (sky && skin->boxes) needed = int_max(needed, SKY_RESOLUTION);
            texel->needed = int_max(texel->needed, needed);
        }
}

/* ---- what is built ---- */

/* What another frame has told of the texel; NULL: nothing. */
static const TexelFrame *told_of(const CompiledScene *compiled, size_t texel) {
    const PilotResult *pilot = compiled->options->pilot;
    return pilot && pilot->texels && pilot->texel_count == compiled->texel_count ? &pilot->texels[texel] : NULL;
}

static int resolution_in_film(int own, int told, int most) {
    return told ? int_max(told, power_of_two_above(own, most)) : power_of_two_above(FILM_MARGIN * own, most);
}

void texels_settle_triangles(CompiledScene *compiled) {
    if (!compiled->options->film) return;
    for (size_t i = 0; i < compiled->texel_count; i++) {
        const TexelFrame *told = told_of(compiled, i);
        BuiltTexel *texel = compiled->texels[i];
        texel->finest_seen = resolution_in_film(texel->finest_seen, told ? told->finest_seen : 0, TEXEL_LARGEST_RESOLUTION);
    }
}

/* Whether their voxels are the same, at the same resolution. */
static bool hold_the_same(const TexelDef *a, const TexelDef *b, TexelFiltering filtering) {
    if (a->file || b->file || a->layer_count != b->layer_count || a->resolution != b->resolution) return false;
    for (size_t i = 0; i < a->layer_count; i++)
        if (!hash_equal(texel_layer_key(a, &a->layers[i], 0, filtering), texel_layer_key(b, &b->layers[i], 0, filtering))) return false;
    return true;
}

/* Texels that differ by their looks alone are built once, as fine as any of them needs: cones read the levels that fit them. */
static int needed_by_any(const BuiltTexel *texel, const CompiledScene *compiled) {
    int needed = texel->needed;
    for (size_t i = 0; i < compiled->texel_count; i++)
        if (hold_the_same(texel->def, compiled->texels[i]->def, compiled->filtering)) needed = int_max(needed, compiled->texels[i]->needed);
    return needed;
}

void texels_settle_voxels(CompiledScene *compiled) {
    for (size_t i = 0; i < compiled->texel_count; i++) {
        const TexelFrame *told = told_of(compiled, i);
        BuiltTexel *texel = compiled->texels[i];
        const int asked = texel->def->resolution, most = power_of_two_above(asked ? asked : LARGEST_AUTO_RESOLUTION, TEXEL_LARGEST_RESOLUTION);
        if (texel->def->file) texel->built = asked;
        else if (!compiled->options->film) texel->built = power_of_two_above(needed_by_any(texel, compiled), most);
        else texel->built = resolution_in_film(needed_by_any(texel, compiled), told ? told->built : 0, most);
    }
}
