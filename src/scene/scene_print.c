/* The graph as text: one node a line, two spaces of indent for what belongs to the node above, defaults left out. Numbers are
 * printed with %g: enough to compare, short enough to read. */
#include "scene/medium.h"

typedef struct Printer {
    StrBuf *out;
    int depth;
} Printer;

static void begin_line(const Printer *p, const char *word) {
    strbuf_repeat(p->out, ' ', 2 * (size_t)p->depth);
    strbuf_adds(p->out, word);
}

static void end_line(const Printer *p) { strbuf_addc(p->out, '\n'); }
static double plain(double x) { return x + 0.0; /* no "-0" */ }

static void add_number(const Printer *p, const char *name, double x) {
    strbuf_addf(p->out, " %s %g", name, plain(x));
}

static void add_unless(const Printer *p, const char *name, double x, double usual) {
    if (x != usual) add_number(p, name, x);
}

static void add_vector(const Printer *p, const char *name, Vec3 v) {
    strbuf_addf(p->out, " %s <%g, %g, %g>", name, plain(v.x), plain(v.y), plain(v.z));
}

static void add_color(const Printer *p, const char *name, Color c) {
    if (c.filter != 0 || c.transmit != 0)
        strbuf_addf(p->out, " %s rgbft <%g, %g, %g, %g, %g>", name, c.red, c.green, c.blue, c.filter,
                    c.transmit);
    else
        strbuf_addf(p->out, " %s rgb <%g, %g, %g>", name, c.red, c.green, c.blue);
}

static bool is_black(Color c) { return c.red == 0 && c.green == 0 && c.blue == 0; }
static void add_flag(const Printer *p, const char *name, bool on) {
    if (on) strbuf_addf(p->out, " %s", name);
}

static bool is_unit(const Mat3 *m) {
    const Mat3 unit = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int i = 0; i < 3; i++)
        if (vec3_length_squared(vec3_sub(m->c[i], unit.c[i])) != 0) return false;
    return true;
}

static void add_transform(const Printer *p, const Transform *t) {
    if (!is_unit(&t->linear)) {
        const Vec3 *c = t->linear.c;
        strbuf_addf(p->out, " matrix <%g, %g, %g, %g, %g, %g, %g, %g, %g, %g, %g, %g>", plain(c[0].x),
                    plain(c[0].y), plain(c[0].z), plain(c[1].x), plain(c[1].y), plain(c[1].z), plain(c[2].x),
                    plain(c[2].y), plain(c[2].z), plain(t->offset.x), plain(t->offset.y), plain(t->offset.z));
    } else if (vec3_length_squared(t->offset) != 0) {
        add_vector(p, "translate", t->offset);
    }
}

static void add_inert(const Printer *p, const InertNote *note) {
    for (; note; note = note->next) strbuf_addf(p->out, " (%s)", note->word);
}

/* ---- looks ---- */

static const char *const pattern_names[] = {
    "solid",         "gradient",     "checker",         "brick",   "hexagon",      "bozo",      "granite",
    "wrinkles",      "agate",        "marble",          "wood",    "crackle",      "leopard",   "onion",
    "radial",        "spotted",      "cells",           "boxed",   "cylindrical",  "spherical", "planar",
    "slope",         "function",     "cubic",           "square",  "triangular",   "object",    "dents",
    "quilted",       "ripples",      "waves",           "spiral1", "spiral2",      "mandel",    "julia",
    "magnet mandel", "magnet julia", "pigment_pattern", "average", "density_file", "tiling",
    "image_map",     "image_pattern", "uv_mapping",    "material_map", "aoi",      "pavement",
};
_Static_assert(VTS_ARRAY_COUNT(pattern_names) == PATTERN_PAVEMENT + 1, "a name for each pattern");

static void print_pigment(Printer *p, const char *word, const Pigment *pigment);

static void print_entry(Printer *p, const ColorMapEntry *entry) {
    strbuf_repeat(p->out, ' ', 2 * (size_t)p->depth);
    strbuf_addf(p->out, "[%g", plain(entry->position));
    if (!entry->pigment) add_color(p, "color", entry->color);
    strbuf_adds(p->out, "]\n");
    if (!entry->pigment) return;
    p->depth++;
    print_pigment(p, "pigment", entry->pigment);
    p->depth--;
}

static void print_pigment(Printer *p, const char *word, const Pigment *pigment) {
    begin_line(p, word);
    strbuf_addf(p->out, " %s", pattern_names[pigment->kind]);
    if (pigment->kind == PATTERN_SOLID) add_color(p, "color", pigment->color);
    if (pigment->kind == PATTERN_GRADIENT || pigment->kind == PATTERN_SLOPE)
        add_vector(p, "direction", pigment->direction);
    if (pigment->kind == PATTERN_BRICK) {
        add_vector(p, "brick_size", pigment->brick_size);
        add_number(p, "mortar", pigment->mortar);
    }
    add_unless(p, "frequency", pigment->frequency, 1);
    add_unless(p, "phase", pigment->phase, 0);
    if (vec3_length_squared(pigment->turbulence) != 0) {
        add_vector(p, "turbulence", pigment->turbulence);
        add_number(p, "octaves", pigment->octaves);
        add_number(p, "lambda", pigment->lambda);
        add_number(p, "omega", pigment->omega);
    }
    add_transform(p, &pigment->transform);
    add_inert(p, pigment->inert);
    end_line(p);
    p->depth++;
    for (size_t i = 0; i < pigment->entry_count; i++) print_entry(p, &pigment->entries[i]);
    p->depth--;
}

static void print_finish(Printer *p, const Finish *f) {
    begin_line(p, "finish");
    add_color(p, "ambient", f->ambient);
    add_number(p, "diffuse", f->diffuse);
    add_unless(p, "transmission", f->transmission, 0);
    add_unless(p, "brilliance", f->brilliance, 1);
    if (f->specular != 0) {
        add_number(p, "specular", f->specular);
        add_number(p, "roughness", f->roughness);
    }
    if (f->phong != 0) {
        add_number(p, "phong", f->phong);
        add_number(p, "phong_size", f->phong_size);
    }
    add_unless(p, "metallic", f->metallic, 0);
    if (!is_black(f->emission)) add_color(p, "emission", f->emission);
    if (!is_black(f->reflection_max)) {
        add_color(p, "reflection", f->reflection_min);
        add_color(p, "to", f->reflection_max);
    }
    add_flag(p, "fresnel", f->fresnel);
    add_unless(p, "falloff", f->reflection_falloff, 1);
    add_unless(p, "exponent", f->reflection_exponent, 1);
    add_unless(p, "reflection_metallic", f->reflection_metallic, 0);
    add_flag(p, "diffuse_albedo", f->diffuse_albedo);
    add_flag(p, "specular_albedo", f->specular_albedo);
    add_flag(p, "phong_albedo", f->phong_albedo);
    add_flag(p, "conserve_energy", f->conserve_energy);
    add_unless(p, "crand", f->crand, 0);
    if (f->irid > 0) {
        add_number(p, "irid", f->irid);
        add_number(p, "thickness", f->irid_thickness);
        add_unless(p, "turbulence", f->irid_turbulence, 0);
    }
    end_line(p);
}

static void print_media(Printer *p, const MediaList *media) {
    for (size_t i = 0; i < media->count; i++) {
        begin_line(p, "media");
        medium_print(&media->items[i], p->out);
        end_line(p);
        p->depth++;
        for (size_t k = 0; k < media->items[i].density_count; k++) print_pigment(p, "density", media->items[i].densities[k].pattern);
        p->depth--;
    }
}

static void print_interior(Printer *p, const Interior *interior) {
    begin_line(p, "interior");
    add_number(p, "ior", interior->ior);
    add_unless(p, "caustics", interior->caustics, 0);
    if (interior->dispersion != 1) strbuf_addf(p->out, " dispersion %g in %d", interior->dispersion, interior->dispersion_samples);
    if (interior->fade_power > 0) {
        add_number(p, "fade_distance", interior->fade_distance);
        add_number(p, "fade_power", interior->fade_power);
        add_color(p, "fade_color", interior->fade_color);
    }
    add_inert(p, interior->inert);
    end_line(p);
    p->depth++;
    print_media(p, &interior->media);
    p->depth--;
}

static const char *const normal_forms[] = {"gradient", "bumps",  "dents",    "ripples", "waves",
                                           "wrinkles", "quilted", "facets", "bump_map", "normal_map"};

static void print_normal(Printer *p, const Normal *normal) {
    begin_line(p, "normal");
    strbuf_addf(p->out, " %s", normal_forms[normal->form]);
    add_number(p, "bump_size", normal->amount);
    add_unless(p, "accuracy", normal->accuracy, 0.02);
    add_flag(p, "no_bump_scale", normal->unscaled);
    for (size_t i = 0; i < normal->slope_count; i++)
        strbuf_addf(p->out, " [%g <%g, %g>]", normal->slopes[i].position, normal->slopes[i].height, normal->slopes[i].slope);
    end_line(p);
    p->depth++;
    print_pigment(p, "pattern", normal->pattern);
    for (size_t i = 0; i < normal->normal_count; i++) print_normal(p, normal->normals[i]);
    p->depth--;
}

static void print_texture(Printer *p, const Texture *texture);

static void print_map(Printer *p, const TextureMap *map) {
    p->depth++;
    print_pigment(p, "pattern", map->pattern);
    for (size_t i = 0; i < map->count; i++) print_texture(p, map->textures[i]);
    p->depth--;
}

static void print_texture(Printer *p, const Texture *texture) {
    for (; texture; texture = texture->under) {
        begin_line(p, "texture");
        add_transform(p, &texture->transform);
        add_inert(p, texture->inert);
        end_line(p);
        if (texture->map) {
            print_map(p, texture->map);
            continue;
        }
        p->depth++;
        print_pigment(p, "pigment", texture->pigment);
        if (texture->normal) print_normal(p, texture->normal);
        print_finish(p, texture->finish);
        p->depth--;
    }
}

/* ---- objects ---- */

static void print_object(Printer *p, const Object *object);
static void print_surface(Printer *p, const Surface *surface);
static void print_light(Printer *p, const Light *light);

static void add_cone(const Printer *p, const Object *o) {
    add_vector(p, "base", o->as.cone.base);
    add_number(p, "radius", o->as.cone.base_radius);
    add_vector(p, "cap", o->as.cone.cap);
    add_number(p, "radius", o->as.cone.cap_radius);
    add_flag(p, "open", o->as.cone.open);
}

static void add_mesh(const Printer *p, const MeshData *m) {
    strbuf_addf(p->out, " vertices %zu triangles %zu", m->vertex_count, m->triangle_count);
    if (m->normals) strbuf_addf(p->out, " normals %zu", m->normal_count);
    if (m->uvs) strbuf_addf(p->out, " uvs %zu", m->uv_count);
    if (m->triangle_textures) strbuf_addf(p->out, " textures %zu%s", m->texture_count, m->corner_textures ? " blended" : "");
    add_flag(p, "height_vectors", m->height_vectors != NULL);
    add_flag(p, "w_vectors", m->w_vectors != NULL);
}

static void add_shape(const Printer *p, const Object *o) {
    switch (o->kind) {
    case OBJECT_SPHERE:
        add_vector(p, "center", o->as.sphere.center);
        add_number(p, "radius", o->as.sphere.radius);
        break;
    case OBJECT_BOX:
        add_vector(p, "from", o->as.box.corner1);
        add_vector(p, "to", o->as.box.corner2);
        break;
    case OBJECT_CYLINDER:
    case OBJECT_CONE: add_cone(p, o); break;
    case OBJECT_PLANE:
        add_vector(p, "normal", o->as.plane.normal);
        add_number(p, "distance", o->as.plane.distance);
        break;
    case OBJECT_DISC:
        add_vector(p, "center", o->as.disc.center);
        add_vector(p, "normal", o->as.disc.normal);
        add_number(p, "radius", o->as.disc.radius);
        add_unless(p, "hole", o->as.disc.hole_radius, 0);
        break;
    case OBJECT_TORUS:
        add_number(p, "major", o->as.torus.major_radius);
        add_number(p, "minor", o->as.torus.minor_radius);
        break;
    case OBJECT_TRIANGLES: add_mesh(p, o->as.mesh); break;
    case OBJECT_UNION:
    case OBJECT_MERGE:
    case OBJECT_INTERSECTION:
    case OBJECT_DIFFERENCE: strbuf_addf(p->out, " of %zu", o->as.group->count); break;
    case OBJECT_PARTICLES: strbuf_addf(p->out, " of %zu", o->as.particles.count); break;
    case OBJECT_BRANCHES: strbuf_addf(p->out, " of %zu branch nodes", o->as.branches.count); break;
    case OBJECT_TEXEL: strbuf_addf(p->out, " %s", o->as.texel->name); break;
    case OBJECT_VOLUME: volume_print(o->as.volume, p->out); break;
    case OBJECT_SURFACE:
    case OBJECT_SOLID:
    case OBJECT_UNMODELLED: break;
    }
}

static void print_particles(Printer *p, const Object *o) {
    static const char *const profiles[] = {"v", "round", "flat"};
    for (size_t i = 0; i < o->as.particles.count; i++) {
        const Particle *particle = &o->as.particles.items[i];
        begin_line(p, "particle");
        add_vector(p, "position", particle->position);
        add_vector(p, "velocity", particle->velocity);
        add_vector(p, "acceleration", particle->acceleration);
        add_number(p, "life", particle->life);
        strbuf_addf(p->out, " width %g, %g profile %s", particle->width_foot, particle->width_tip,
                    profiles[particle->profile]);
        add_unless(p, "twist", particle->twist, 0);
        end_line(p);
    }
}

static void print_object(Printer *p, const Object *o) {
    Transform place = object_transform(o);
    begin_line(p, o->kind == OBJECT_UNMODELLED ? "unmodelled" : object_word(o));
    add_shape(p, o);
    add_transform(p, &place);
    add_flag(p, "no_shadow", o->no_shadow);
    add_flag(p, "no_image", o->no_image);
    add_flag(p, "inverse", o->inverse);
    add_flag(p, "no_reflection", o->no_reflection);
    add_flag(p, "no_radiosity", o->no_radiosity);
    add_flag(p, "double_illuminate", o->double_illuminate);
    add_flag(p, "cutaway_textures", o->cutaway);
    add_inert(p, object_inert(o));
    end_line(p);
    p->depth++;
    print_texture(p, o->texture);
    if (o->rest && o->rest->interior_texture) {
        begin_line(p, "interior_texture");
        end_line(p);
        p->depth++;
        print_texture(p, o->rest->interior_texture);
        p->depth--;
    }
    if (o->rest && o->rest->interior) print_interior(p, o->rest->interior);
    if (o->kind == OBJECT_PARTICLES) print_particles(p, o);
    if (o->kind == OBJECT_SURFACE) print_surface(p, o->as.surface);
    if (object_has_group(o)) {
        for (size_t i = 0; i < o->as.group->count; i++) print_object(p, o->as.group->items[i]);
        for (size_t i = 0; i < o->as.group->light_count; i++) print_light(p, o->as.group->lights[i]);
    }
    p->depth--;
}

/* ---- volumetric textures ---- */

static void print_texel(Printer *p, const TexelDef *texel) {
    begin_line(p, "texel");
    strbuf_addf(p->out, " %s", texel->name);
    add_vector(p, "bounds", texel->bounds.min);
    add_vector(p, "to", texel->bounds.max);
    if (texel->resolution) add_number(p, "resolution", texel->resolution);
    if (texel->cyclic)
        strbuf_addf(p->out, " cyclic %s%s%s", texel->cyclic & 1 ? "x" : "", texel->cyclic & 2 ? "y" : "",
                    texel->cyclic & 4 ? "z" : "");
    if (texel->file) strbuf_adds(p->out, " from a file");
    if (texel->phase_count) strbuf_addf(p->out, " phase %d/%d", texel->phase, texel->phase_count);
    add_inert(p, texel->inert);
    end_line(p);
    p->depth++;
    for (size_t i = 0; i < texel->layer_count; i++) {
        begin_line(p, "layer");
        end_line(p);
        p->depth++;
        if (texel->layers[i].density) {
            const DensityField *density = texel->layers[i].density;
            begin_line(p, "density");
            strbuf_addf(p->out, " threshold %g, %g extinction %g", density->low, density->high, density->extinction);
            end_line(p);
        }
        for (size_t k = 0; k < texel->layers[i].content_count; k++)
            print_object(p, texel->layers[i].contents[k]);
        print_texture(p, texel->layers[i].texture);
        p->depth--;
    }
    for (size_t i = 0; i < texel->choice_count; i++) print_texel(p, texel->choices[i]);
    p->depth--;
}

static void print_surface(Printer *p, const Surface *s) {
    static const char *const uv_names[] = {"mesh", "planar", "cylindrical", "spherical"};
    begin_line(p, "surface");
    if (s->kind == SURFACE_PATCHES) {
        strbuf_addf(p->out, " patches %d x %d", s->nu, s->nv);
        add_vector(p, "from", s->points[0]);
        add_vector(p, "to", s->points[((size_t)s->nu + 1) * ((size_t)s->nv + 1) - 1]);
        add_flag(p, "height_vectors", s->height_vectors != NULL);
    } else if (s->kind == SURFACE_TERRAIN) {
        const Terrain *terrain = s->terrain;
        strbuf_addf(p->out, " terrain \"%s\"", terrain->file);
        add_vector(p, "origin", terrain->origin);
        add_vector(p, "from", terrain->bounds.min);
        add_vector(p, "to", terrain->bounds.max);
        add_flag(p, "full", terrain->every_post);
        add_flag(p, "deform", s->deform != NULL);
    } else {
        strbuf_addf(p->out, " uv %s", uv_names[s->uv]);
        if (s->uv == SURFACE_UV_PLANAR || s->uv == SURFACE_UV_CYLINDRICAL) add_vector(p, "axis", s->uv_axis);
        if (s->subdivide) add_number(p, "subdivide", s->subdivide);
        add_flag(p, "deform", s->deform != NULL);
        add_flag(p, "height_vectors", s->object_height_vectors != NULL);
    }
    add_transform(p, &s->transform);
    add_inert(p, s->inert);
    end_line(p);
    p->depth++;
    if (s->object) print_object(p, s->object);
    print_texture(p, s->texture);
    p->depth--;
}

static void print_mapping(Printer *p, const SkinMapping *m) {
    begin_line(p, "mapping");
    if (m->by_tile_size)
        add_number(p, "tile", m->tile_size);
    else
        strbuf_addf(p->out, " repeat <%g, %g>", m->repeat_u, m->repeat_v);
    add_number(p, "height", m->height);
    add_flag(p, "function", m->height_function != NULL);
    if (vec3_length_squared(m->comb) != 0) add_vector(p, "comb", m->comb);
    add_flag(p, "comb function", m->comb_function != NULL);
    if (m->w_foot != 0 || m->w_tip != 1) strbuf_addf(p->out, " w %g, %g", m->w_foot, m->w_tip);
    add_flag(p, "w function", m->w_function != NULL);
    end_line(p);
    if (!m->height_pigment) return;
    p->depth++;
    print_pigment(p, "pigment", m->height_pigment);
    p->depth--;
}

static void add_noise(const Printer *p, const char *name, const NoiseJitter *noise) {
    if (noise->amplitude != 0) strbuf_addf(p->out, " %s %g scale %g", name, noise->amplitude, noise->scale);
}

static void print_jitter(Printer *p, const SkinJitter *j) {
    const InstanceJitter *c = &j->instance;
    begin_line(p, "jitter");
    add_noise(p, "coordinates", &j->coordinates);
    add_noise(p, "height", &j->height);
    add_noise(p, "direction", &j->direction);
    add_unless(p, "seed", j->seed, 0);
    if (c->present) {
        strbuf_adds(p->out, " instance");
        add_unless(p, "displace", c->displace, 0);
        add_unless(p, "rotate", c->rotate, 0);
        add_unless(p, "scale", c->scale, 0);
        add_flag(p, "mirror", c->mirror);
        add_unless(p, "density", c->density, 1);
        if (c->tinted) {
            add_color(p, "tint", c->tint_a);
            add_color(p, "to", c->tint_b);
        }
    }
    end_line(p);
}

static void print_wind(Printer *p, const WindField *w) {
    if (!w) return;
    begin_line(p, "wind_field");
    add_vector(p, "direction", w->direction);
    add_number(p, "speed", w->speed);
    add_number(p, "strength", w->strength);
    if (w->gust_amplitude != 0)
        strbuf_addf(p->out, " gust wavelength %g amplitude %g sharpness %g", w->gust_wavelength, w->gust_amplitude, w->gust_sharpness);
    if (w->turbulence_amplitude != 0)
        strbuf_addf(p->out, " turbulence amplitude %g scale %g octaves %d seed %u", w->turbulence_amplitude, w->turbulence_scale,
                    w->turbulence_octaves, w->turbulence_seed);
    add_number(p, "stiffness", w->stiffness);
    if (w->cycle > 0) add_number(p, "cycle", w->cycle);
    add_flag(p, "function", w->function != NULL);
    end_line(p);
}

static void print_springs(Printer *p, const SkinSprings *springs) {
    if (!springs->present) return;
    begin_line(p, "springs");
    add_number(p, "stiffness", springs->stiffness);
    add_number(p, "damping", springs->damping);
    end_line(p);
}

static void print_skin(Printer *p, const Skin *skin) {
    begin_line(p, "skin");
    if (skin->wang) strbuf_adds(p->out, " tiling wang");
    add_inert(p, skin->inert);
    end_line(p);
    p->depth++;
    print_surface(p, skin->surface);
    for (size_t i = 0; i < skin->texel_count; i++) {
        const SkinTexel *t = &skin->texels[i];
        begin_line(p, "copies");
        add_number(p, "density", t->density);
        end_line(p);
        p->depth++;
        print_texel(p, t->texel);
        print_texture(p, t->texture);
        p->depth--;
    }
    print_mapping(p, &skin->mapping);
    print_jitter(p, &skin->jitter);
    print_wind(p, skin->wind);
    print_springs(p, &skin->springs);
    print_texture(p, skin->texture);
    p->depth--;
}

/* ---- the scene ---- */

static void print_camera(Printer *p, const Camera *c) {
    static const char *const names[] = {"",           " orthographic", " fisheye",    " ultra_wide_angle",
                                        " omnimax",   " panoramic",    " spherical",  " cylinder 1",
                                        " cylinder 2", " cylinder 3",  " cylinder 4", " mesh_camera"};
    begin_line(p, "camera");
    strbuf_adds(p->out, names[c->kind]);
    add_vector(p, "location", c->location);
    add_vector(p, "direction", c->direction);
    add_vector(p, "right", c->right);
    add_vector(p, "up", c->up);
    if (c->kind > CAMERA_ORTHOGRAPHIC) add_number(p, "angle", c->angle);
    if (c->kind == CAMERA_SPHERICAL) add_number(p, "angle_v", c->angle_v);
    if (c->mesh) {
        strbuf_addf(p->out, " rays %d spread %d meshes %zu ahead %g", c->mesh->rays, (int)c->mesh->spread, c->mesh->mesh_count, c->mesh->ahead);
        add_flag(p, "smooth", c->mesh->smooth);
        add_flag(p, "backwards", c->mesh->backwards);
    }
    if (c->normal) strbuf_adds(p->out, " normal");
    if (c->aperture > 0) strbuf_addf(p->out, " aperture %g focus %g", c->aperture, c->focal_distance);
    end_line(p);
}

static void print_light(Printer *p, const Light *light) {
    static const char *const names[] = {"light", "light parallel", "light spot", "light cylinder"};
    begin_line(p, names[light->kind]);
    if (light->kind == LIGHT_PARALLEL)
        add_vector(p, "towards", light->to_light);
    else
        add_vector(p, "location", light->location);
    add_color(p, "color", light->color);
    if (light->kind == LIGHT_SPOT || light->kind == LIGHT_CYLINDER) {
        add_vector(p, "point_at", light->point_at);
        strbuf_addf(p->out, " radius %g falloff %g tightness %g", light->radius, light->falloff,
                    light->tightness);
    }
    if (light->fade_power != 0) strbuf_addf(p->out, " fade %g ^ %g", light->fade_distance, light->fade_power);
    if (light->size_u) {
        add_vector(p, "area", light->axis_u);
        add_vector(p, "by", light->axis_v);
        strbuf_addf(p->out, " %d %d", light->size_u, light->size_v);
        add_flag(p, "jitter", light->jitter);
        add_flag(p, "circular", light->circular);
        add_flag(p, "area_illumination", light->area_illumination);
        add_flag(p, "orient", light->orient);
    }
    add_flag(p, "goniometric function", light->goniometric != NULL);
    if (light->lamp) add_vector(p, "ies, turned to", light->lamp_turns[0]);
    if ((light->goniometric || light->lamp) && light->kind == LIGHT_POINT) add_vector(p, "point_at", light->point_at);
    add_flag(p, "media_interaction off", light->unscattered);
    add_flag(p, "media_attenuation", light->through_air);
    add_flag(p, "parallel", light->parallel && light->kind != LIGHT_PARALLEL);
    add_flag(p, "shadowless", light->shadowless);
    add_flag(p, "grouped", light->group != NULL);
    add_flag(p, "projected", light->projected_through != NULL);
    end_line(p);
}

static void add_radiosity(Printer *p, const Radiosity *r) {
    if (!r->on) return;
    strbuf_addf(p->out, " radiosity recursion_limit %d", r->bounces);
    add_unless(p, "brightness", r->brightness, 1);
    add_unless(p, "gray_threshold", r->gray_threshold, 0);
    add_unless(p, "max_sample", r->max_sample, 0);
    add_flag(p, "normal", r->bumps);
    add_flag(p, "media", r->media);
    add_flag(p, "with ambient", r->with_ambient);
}

static void print_settings(Printer *p, const GlobalSettings *s) {
    const char *const texts[][2] = {{"opacity_model", s->opacity_model},
                                    {"quadrature", s->quadrature},
                                    {"filtering", s->filtering},
                                    {"ray_path", s->ray_path},
                                    {"detail", s->detail}};
    begin_line(p, "settings");
    add_color(p, "ambient_light", s->ambient_light);
    add_number(p, "assumed_gamma", s->assumed_gamma);
    add_number(p, "max_trace_level", s->max_trace_level);
    add_unless(p, "max_error", s->max_error, 0);
    add_unless(p, "samples", s->samples, 0);
    add_unless(p, "shadow_aperture", s->shadow_aperture, 2);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(texts); i++)
        if (texts[i][1]) strbuf_addf(p->out, " %s %s", texts[i][0], texts[i][1]);
    add_flag(p, "sky_light", s->sky_light);
    add_radiosity(p, &s->radiosity);
    if (s->geo_origin.set) strbuf_addf(p->out, " geo_origin <%.10g,%.10g,%g>", s->geo_origin.place.x, s->geo_origin.place.y, s->geo_origin.place.z);
    add_flag(p, "flat", s->geo_origin.flat);
    end_line(p);
}

static void print_fog(Printer *p, const Fog *fog) {
    begin_line(p, "fog");
    add_number(p, "distance", fog->distance);
    add_color(p, "color", fog->color);
    if (fog->ground) strbuf_addf(p->out, " offset %g altitude %g", fog->offset, fog->altitude);
    if (fog->turbulence) add_number(p, "turb_depth", fog->turbulence_depth);
    end_line(p);
}

static void print_rainbow(Printer *p, const Rainbow *bow) {
    begin_line(p, "rainbow");
    add_number(p, "angle", bow->angle);
    add_number(p, "width", bow->width);
    add_number(p, "distance", bow->distance);
    add_unless(p, "jitter", bow->jitter, 0);
    if (bow->arc >= 0) strbuf_addf(p->out, " arc %g falloff %g", bow->arc, bow->falloff);
    end_line(p);
    if (bow->colors) print_pigment(p, "colors", bow->colors);
}

static void print_film(Printer *p, const Film *film) {
    if (!film) return;
    begin_line(p, "animation");
    add_number(p, "frames", film->frames);
    add_number(p, "fps", film->fps);
    strbuf_addf(p->out, " clock %g %g", plain(film->first_clock), plain(film->last_clock));
    add_flag(p, "cyclic", film->cyclic);
    add_unless(p, "shutter", film->shutter, 0);
    end_line(p);
}

void scene_print(const Scene *scene, StrBuf *out) {
    Printer printer = {out, 1}, *p = &printer;
    strbuf_addf(out, "scene %s clock %g\n", scene->name, scene->clock);
    print_settings(p, &scene->settings);
    print_camera(p, &scene->camera);
    print_film(p, scene->film);
    begin_line(p, "background");
    add_color(p, "color", scene->background);
    end_line(p);
    for (size_t i = 0; i < scene->sky_layer_count; i++) print_pigment(p, "sky", scene->sky_layers[i]);
    const Color *bright = &scene->sky_emission;
    if (scene->sky_layer_count && (bright->red != 1 || bright->green != 1 || bright->blue != 1)) {
        begin_line(p, "sky");
        add_color(p, "emission", *bright);
        end_line(p);
    }
    if (scene->old_sky && scene->sky_layer_count > 1) {
        begin_line(p, "sky");
        add_flag(p, "layers_as_before_3.7", true);
        end_line(p);
    }
    for (size_t i = 0; i < scene->fog_count; i++) print_fog(p, &scene->fogs[i]);
    for (size_t i = 0; i < scene->rainbow_count; i++) print_rainbow(p, &scene->rainbows[i]);
    print_media(p, &scene->media);
    for (size_t i = 0; i < scene->light_count; i++) print_light(p, &scene->lights[i]);
    for (size_t i = 0; i < scene->object_count; i++) print_object(p, scene->objects[i]);
    for (size_t i = 0; i < scene->skin_count; i++) print_skin(p, scene->skins[i]);
}
