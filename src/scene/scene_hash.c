#include "scene/scene_hash.h"

#include "scene/medium.h"

#include <string.h>

/* One number for each type of node, so that nodes of different types with equal bytes differ. */
enum {
    KIND_PIGMENT = 1,
    KIND_FINISH,
    KIND_INTERIOR,
    KIND_TEXTURE,
    KIND_MESH,
    KIND_SHAPE,
    KIND_GEOMETRY,
    KIND_OBJECT,
    KIND_LAYER,
    KIND_TEXEL,
    KIND_SURFACE,
    KIND_SKIN,
    KIND_WIND,
    KIND_NORMAL
};

void hash_add_vec3(Hash128 *hash, Vec3 v) {
    double components[3] = {v.x + 0.0, v.y + 0.0, v.z + 0.0}; /* -0 becomes 0 */
    hash_add(hash, components, sizeof components);
}

void hash_add_color(Hash128 *hash, Color c) {
    double components[5] = {c.red + 0.0, c.green + 0.0, c.blue + 0.0, c.filter + 0.0, c.transmit + 0.0};
    hash_add(hash, components, sizeof components);
}

void hash_add_transform(Hash128 *hash, const Transform *t) {
    for (int i = 0; i < 3; i++) hash_add_vec3(hash, t->linear.c[i]);
    hash_add_vec3(hash, t->offset);
}

static void add_text(Hash128 *hash, const char *text) {
    hash_add_u64(hash, text ? strlen(text) + 1 : 0);
    if (text) hash_add(hash, text, strlen(text));
}

static void add_tape(Hash128 *hash, const Tape *tape) {
    hash_add_u64(hash, tape != NULL);
    if (tape) hash_add_hash(hash, tape_hash(tape));
}

static void add_texture(Hash128 *hash, const Texture *texture) {
    hash_add_u64(hash, texture != NULL);
    if (texture) hash_add_hash(hash, texture->hash);
}

/* A hash of many vectors at once; presence counts. */
static void add_vectors(Hash128 *hash, const Vec3 *vectors, size_t count) {
    hash_add_u64(hash, vectors ? count + 1 : 0);
    if (!vectors) return;
    for (size_t i = 0; i < count; i++) hash_add_vec3(hash, vectors[i]);
}

static void add_indices(Hash128 *hash, const uint32_t (*triangles)[3], size_t count) {
    hash_add_u64(hash, triangles ? count + 1 : 0);
    if (triangles) hash_add(hash, triangles, count * sizeof *triangles);
}

static void add_warp(Hash128 *h, const Warp *w) {
    const Vec3 vectors[] = {w->turbulence, w->flip, w->center, w->repeat, w->uncertainty, w->orientation};
    const double numbers[] = {w->kind,     w->octaves,  w->lambda,      w->omega,   w->axis,
                              w->width,    w->radius,   w->strength,    w->falloff, w->inverse,
                              w->repeated, w->exponent, w->major_radius};
    hash_add_transform(h, &w->inner);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(vectors); i++) hash_add_vec3(h, vectors[i]);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(numbers); i++) hash_add_double(h, numbers[i]);
}

/* What only some patterns use. */
static void add_settings(Hash128 *h, const Pigment *p) {
    const FractalSettings *f = &p->fractal;
    const double numbers[] = {p->wave,
                              p->wave_exponent,
                              p->noise_generator,
                              f->re,
                              f->im,
                              f->iterations,
                              f->exponent,
                              f->magnet,
                              f->exterior,
                              f->interior,
                              f->exterior_factor,
                              f->interior_factor,
                              p->pavement.sides,
                              p->pavement.tiles,
                              p->pavement.pattern,
                              p->pavement.exterior,
                              p->pavement.interior,
                              p->pavement.form,
                              p->crackle.metric,
                              p->crackle.offset,
                              p->crackle.solid,
                              p->agate_turbulence,
                              p->control0,
                              p->control1,
                              p->number,
                              p->wave_count,
                              p->slope_low,
                              p->slope_high,
                              p->points_at,
                              p->altitude_low,
                              p->altitude_high,
                              p->interpolation,
                              p->source != NULL,
                              p->density != NULL,
                              (double)p->warp_count};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(numbers); i++) hash_add_double(h, numbers[i]);
    hash_add_vec3(h, p->crackle.form);
    hash_add_vec3(h, p->altitude);
    if (p->source) hash_add_hash(h, p->source->hash);
    if (p->density) hash_add_hash(h, p->density->hash);
    for (size_t i = 0; i < p->warp_count; i++) add_warp(h, &p->warps[i]);
}

void pigment_rehash(Pigment *p) {
    Hash128 h = hash_begin(KIND_PIGMENT);
    hash_add_u64(&h, p->kind);
    hash_add_color(&h, p->color);
    hash_add_vec3(&h, p->direction);
    add_tape(&h, p->function);
    hash_add_u64(&h, p->entry_count);
    for (size_t i = 0; i < p->entry_count; i++) {
        hash_add_double(&h, p->entries[i].position);
        hash_add_color(&h, p->entries[i].color);
        hash_add_u64(&h, p->entries[i].pigment != NULL);
        if (p->entries[i].pigment) hash_add_hash(&h, p->entries[i].pigment->hash);
    }
    hash_add_vec3(&h, vec3(p->frequency, p->phase, p->mortar));
    hash_add_vec3(&h, p->turbulence);
    hash_add_vec3(&h, vec3(p->octaves, p->lambda, p->omega));
    hash_add_vec3(&h, p->brick_size);
    add_settings(&h, p);
    if (p->image) hash_add_hash(&h, p->image->hash);
    hash_add_transform(&h, &p->transform);
    p->hash = h;
}

void finish_rehash(Finish *f) {
    Hash128 h = hash_begin(KIND_FINISH);
    const double numbers[] = {f->diffuse, f->transmission, f->brilliance, f->specular, f->roughness, f->phong, f->phong_size, f->metallic,
                              f->fresnel ? 1 : 0, f->reflection_falloff, f->reflection_exponent, f->reflection_metallic,
                              f->diffuse_albedo + 2 * f->specular_albedo + 4 * f->phong_albedo + 8 * f->conserve_energy, f->crand,
                              f->irid, f->irid_thickness, f->irid_turbulence};
    hash_add_color(&h, f->ambient);
    hash_add_color(&h, f->emission);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(numbers); i++) hash_add_double(&h, numbers[i]);
    hash_add_color(&h, f->reflection_min);
    hash_add_color(&h, f->reflection_max);
    f->hash = h;
}

void interior_rehash(Interior *i) {
    Hash128 h = hash_begin(KIND_INTERIOR);
    const double numbers[] = {i->ior, i->caustics, i->dispersion, i->dispersion_samples, i->fade_distance, i->fade_power};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(numbers); k++) hash_add_double(&h, numbers[k]);
    hash_add_color(&h, i->fade_color);
    media_hash(&h, &i->media);
    i->hash = h;
}

void texture_rehash(Texture *t) {
    Hash128 h = hash_begin(KIND_TEXTURE);
    hash_add_hash(&h, t->pigment->hash);
    hash_add_hash(&h, t->finish->hash);
    hash_add_transform(&h, &t->transform);
    add_texture(&h, t->under);
    if (t->group) hash_add_u64(&h, t->group->number);
    if (t->normal) hash_add_hash(&h, t->normal->hash);
    if (t->map) {
        hash_add_hash(&h, t->map->pattern->hash);
        for (size_t i = 0; i < t->map->count; i++) add_texture(&h, t->map->textures[i]);
    }
    t->hash = h;
}

void normal_rehash(Normal *n) {
    Hash128 h = hash_begin(KIND_NORMAL);
    hash_add_u64(&h, n->form);
    hash_add_hash(&h, n->pattern->hash);
    hash_add_vec3(&h, vec3(n->amount, n->accuracy, n->unscaled));
    hash_add_vec3(&h, vec3(n->facet_coords, n->facet_size, 0));
    hash_add_u64(&h, n->normal_count);
    for (size_t i = 0; i < n->normal_count; i++) hash_add_hash(&h, n->normals[i]->hash);
    for (size_t i = 0; i < n->slope_count; i++)
        hash_add_vec3(&h, vec3(n->slopes[i].position, n->slopes[i].height, n->slopes[i].slope));
    n->hash = h;
}

void mesh_rehash(MeshData *m) {
    Hash128 h = hash_begin(KIND_MESH);
    add_vectors(&h, m->vertices, m->vertex_count);
    add_vectors(&h, m->normals, m->normal_count);
    add_vectors(&h, m->uvs, m->uv_count);
    add_indices(&h, m->triangles, m->triangle_count);
    add_indices(&h, m->normal_triangles, m->triangle_count);
    add_indices(&h, m->uv_triangles, m->triangle_count);
    hash_add_vec3(&h, m->inside_vector);
    add_vectors(&h, m->height_vectors, m->vertex_count);
    add_vectors(&h, m->w_vectors, m->vertex_count);
    m->hash = h;
}

static void add_particles(Hash128 *h, const Particle *items, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const Particle *p = &items[i];
        hash_add_vec3(h, p->position);
        hash_add_vec3(h, p->velocity);
        hash_add_vec3(h, p->acceleration);
        hash_add_vec3(h, vec3(p->life, p->width_foot, p->width_tip));
        hash_add_vec3(h, vec3((double)p->profile, p->twist, 0));
    }
}

static void add_branches(Hash128 *h, const BranchNode *items, size_t count) {
    for (size_t i = 0; i < count; i++) {
        hash_add_vec3(h, items[i].position);
        hash_add_double(h, items[i].radius);
        hash_add_u64(h, items[i].previous);
    }
}

static void add_objects(Hash128 *h, const ObjectList *list) {
    hash_add_u64(h, list->count);
    for (size_t i = 0; i < list->count; i++) hash_add_hash(h, object_geometry_hash(list->items[i]));
}

/* Groups are shared by their copies, which may be shared again: hashed once, however many ways lead to them. */
static const ObjectGroup *hashed_group(const ObjectGroup *group) {
    if (group->hashed) return group;
    ObjectGroup *g = (ObjectGroup *)(uintptr_t)group; /* the answers are kept in the group */
    g->shape_hash = hash_begin(KIND_SHAPE);
    g->hash = hash_begin(KIND_OBJECT);
    for (size_t i = 0; i < g->count; i++) {
        hash_add_hash(&g->shape_hash, object_geometry_hash(g->items[i]));
        hash_add_hash(&g->hash, object_hash(g->items[i]));
    }
    g->hashed = true;
    g->unhashed_depth = 0;
    return g;
}

enum { DEEPEST_UNHASHED = 64 };

void object_group_settle(ObjectGroup *group) {
    group->unhashed_depth = 1;
    group->plain = group->light_count == 0 && !group->light_group;
    for (size_t i = 0; i < group->count; i++) {
        const Object *object = group->items[i];
        if (object->kind == OBJECT_TEXEL || object->kind == OBJECT_VOLUME) group->plain = false;
        if (!object_has_group(object)) continue;
        group->plain = group->plain && object->as.group->plain;
        group->unhashed_depth = int_max(group->unhashed_depth, object->as.group->unhashed_depth + 1);
    }
    if (group->unhashed_depth > DEEPEST_UNHASHED) hashed_group(group);
}

Hash128 object_shape_hash(const Object *o) {
    Hash128 h = hash_begin(KIND_SHAPE);
    hash_add_u64(&h, o->kind);
    hash_add_u64(&h, o->inverse);
    ObjectList clipped_by = object_clipped_by(o), bounded_by = object_bounded_by(o);
    add_objects(&h, &clipped_by);
    add_objects(&h, &bounded_by);
    switch (o->kind) {
    case OBJECT_SPHERE:
        hash_add_vec3(&h, o->as.sphere.center);
        hash_add_double(&h, o->as.sphere.radius);
        break;
    case OBJECT_BOX:
        hash_add_vec3(&h, o->as.box.corner1);
        hash_add_vec3(&h, o->as.box.corner2);
        break;
    case OBJECT_CYLINDER:
    case OBJECT_CONE:
        hash_add_vec3(&h, o->as.cone.base);
        hash_add_vec3(&h, o->as.cone.cap);
        hash_add_vec3(&h, vec3(o->as.cone.base_radius, o->as.cone.cap_radius, o->as.cone.open));
        break;
    case OBJECT_PLANE:
        hash_add_vec3(&h, o->as.plane.normal);
        hash_add_double(&h, o->as.plane.distance);
        break;
    case OBJECT_DISC:
        hash_add_vec3(&h, o->as.disc.center);
        hash_add_vec3(&h, o->as.disc.normal);
        hash_add_vec3(&h, vec3(o->as.disc.radius, o->as.disc.hole_radius, 0));
        break;
    case OBJECT_TORUS: hash_add_vec3(&h, vec3(o->as.torus.major_radius, o->as.torus.minor_radius, 0)); break;
    case OBJECT_TRIANGLES: hash_add_hash(&h, o->as.mesh->hash); break;
    case OBJECT_UNION:
    case OBJECT_INTERSECTION:
    case OBJECT_DIFFERENCE:
    case OBJECT_MERGE:
        hash_add_hash(&h, hashed_group(o->as.group)->shape_hash);
        break;
    case OBJECT_PARTICLES: add_particles(&h, o->as.particles.items, o->as.particles.count); break;
    case OBJECT_BRANCHES: add_branches(&h, o->as.branches.items, o->as.branches.count); break;
    case OBJECT_SURFACE: hash_add_hash(&h, o->as.surface->hash); break;
    case OBJECT_TEXEL: hash_add_hash(&h, o->as.texel->hash); break;
    case OBJECT_SOLID: hash_add_hash(&h, o->as.solid->hash); break;
    case OBJECT_VOLUME: hash_add_hash(&h, o->as.volume->hash); break;
    case OBJECT_UNMODELLED: add_text(&h, o->as.word); break;
    }
    return h;
}

Hash128 object_geometry_hash(const Object *o) {
    Hash128 h = hash_begin(KIND_GEOMETRY);
    Transform place = object_transform(o);
    hash_add_hash(&h, object_shape_hash(o));
    hash_add_transform(&h, &place);
    return h;
}

Hash128 object_hash(const Object *o) {
    Hash128 h = hash_begin(KIND_OBJECT);
    hash_add_hash(&h, object_geometry_hash(o));
    add_texture(&h, o->texture);
    hash_add_u64(&h, (uint64_t)o->no_shadow | (uint64_t)o->no_image << 1 | (uint64_t)(o->rest && o->rest->hollow) << 2 |
                         (uint64_t)o->no_reflection << 3 | (uint64_t)o->double_illuminate << 4 | (uint64_t)o->cutaway << 5 | (uint64_t)o->no_radiosity << 6);
    if (o->rest) add_texture(&h, o->rest->interior_texture);
    if (o->rest && o->rest->interior) hash_add_hash(&h, o->rest->interior->hash);
    if (object_has_group(o)) hash_add_hash(&h, hashed_group(o->as.group)->hash);
    if (o->kind == OBJECT_TRIANGLES && o->as.mesh->triangle_textures) {
        hash_add(&h, o->as.mesh->triangle_textures, o->as.mesh->triangle_count * sizeof(uint32_t));
        if (o->as.mesh->corner_textures)
            hash_add(&h, o->as.mesh->corner_textures, o->as.mesh->triangle_count * sizeof *o->as.mesh->corner_textures);
        for (size_t i = 0; i < o->as.mesh->texture_count; i++) add_texture(&h, o->as.mesh->textures[i]);
    }
    size_t count;
    const BlobPart *parts = object_textured_parts(o, &count);
    for (size_t i = 0; i < count; i++) add_texture(&h, parts[i].texture);
    return h;
}

void layer_rehash(TexelLayer *layer) {
    Hash128 h = hash_begin(KIND_LAYER);
    for (size_t i = 0; i < layer->content_count; i++)
        hash_add_hash(&h, object_geometry_hash(layer->contents[i]));
    if (layer->density) hash_add_hash(&h, layer->density->hash);
    layer->hash = h;
}

void texel_rehash(TexelDef *texel) {
    Hash128 h = hash_begin(KIND_TEXEL);
    hash_add_vec3(&h, texel->bounds.min);
    hash_add_vec3(&h, texel->bounds.max);
    hash_add_u64(&h, (uint64_t)texel->resolution);
    hash_add_u64(&h, texel->cyclic);
    hash_add_u64(&h, texel->layer_count);
    for (size_t i = 0; i < texel->layer_count; i++) {
        const TexelLayer *layer = &texel->layers[i];
        hash_add_hash(&h, layer->hash);
        add_texture(&h, layer->texture);
        for (size_t k = 0; k < layer->content_count; k++) hash_add_hash(&h, object_hash(layer->contents[k]));
    }
    for (size_t i = 0; i < texel->choice_count; i++) hash_add_hash(&h, texel->choices[i]->hash);
    texel->hash = h;
}

void surface_rehash(Surface *s) {
    Hash128 h = hash_begin(KIND_SURFACE);
    hash_add_u64(&h, s->kind);
    if (s->kind == SURFACE_PATCHES) {
        size_t count = ((size_t)s->nu + 1) * ((size_t)s->nv + 1);
        hash_add_u64(&h, (uint64_t)s->nu << 32 | (uint64_t)s->nv);
        add_vectors(&h, s->points, count);
        add_vectors(&h, s->height_vectors, count);
    } else if (s->kind == SURFACE_TERRAIN) {
        hash_add_hash(&h, s->terrain->hash);
        hash_add_u64(&h, (uint64_t)s->subdivide);
        add_tape(&h, s->deform);
    } else {
        hash_add_hash(&h, object_geometry_hash(s->object));
        hash_add_u64(&h, s->uv);
        hash_add_vec3(&h, s->uv_axis);
        hash_add_u64(&h, (uint64_t)s->subdivide);
        add_tape(&h, s->deform);
        add_vectors(&h, s->object_height_vectors,
                    s->object->kind == OBJECT_TRIANGLES ? s->object->as.mesh->vertex_count : 0);
    }
    hash_add_transform(&h, &s->transform);
    add_texture(&h, s->texture);
    s->hash = h;
}

static void add_mapping(Hash128 *h, const SkinMapping *m) {
    const double numbers[] = {m->by_tile_size, m->repeat_u, m->repeat_v, m->tile_size,
                              m->height,       m->w_foot,   m->w_tip};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(numbers); i++) hash_add_double(h, numbers[i]);
    add_tape(h, m->height_function);
    hash_add_u64(h, m->height_pigment != NULL);
    if (m->height_pigment) hash_add_hash(h, m->height_pigment->hash);
    hash_add_vec3(h, m->comb);
    add_tape(h, m->comb_function);
    add_tape(h, m->w_function);
}

static void add_jitter(Hash128 *h, const SkinJitter *j) {
    const NoiseJitter *noise[] = {&j->coordinates, &j->height, &j->direction};
    const InstanceJitter *c = &j->instance;
    for (int i = 0; i < 3; i++) {
        hash_add_double(h, noise[i]->amplitude);
        hash_add_double(h, noise[i]->scale);
    }
    const double numbers[] = {c->displace, c->rotate, c->scale, c->density};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(numbers); i++) hash_add_double(h, numbers[i]);
    hash_add_u64(h, (uint64_t)c->present | (uint64_t)c->mirror << 1 | (uint64_t)c->tinted << 2 |
                        (uint64_t)c->turned << 3 | (uint64_t)j->seed << 8);
    hash_add_color(h, c->tint_a);
    hash_add_color(h, c->tint_b);
}

void wind_rehash(WindField *w) {
    Hash128 h = hash_begin(KIND_WIND);
    const double numbers[] = {w->speed, w->strength, w->gust_wavelength, w->gust_amplitude, w->gust_sharpness, w->gust_mean, w->turbulence_amplitude,
                              w->turbulence_scale, w->turbulence_octaves, w->turbulence_seed, w->stiffness, w->cycle};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(numbers); i++) hash_add_double(&h, numbers[i]);
    hash_add_vec3(&h, w->direction);
    add_tape(&h, w->function);
    w->hash = h;
}

void skin_rehash(Skin *skin) {
    Hash128 h = hash_begin(KIND_SKIN);
    hash_add_hash(&h, skin->surface->hash);
    for (size_t i = 0; i < skin->texel_count; i++) {
        hash_add_hash(&h, skin->texels[i].texel->hash);
        add_texture(&h, skin->texels[i].texture);
        hash_add_double(&h, skin->texels[i].density);
    }
    add_mapping(&h, &skin->mapping);
    add_jitter(&h, &skin->jitter);
    hash_add_u64(&h, skin->wind != NULL);
    if (skin->wind) hash_add_hash(&h, skin->wind->hash);
    if (skin->springs.present) {
        hash_add_double(&h, skin->springs.stiffness);
        hash_add_double(&h, skin->springs.damping);
    }
    hash_add_u64(&h, skin->wang);
    add_texture(&h, skin->texture);
    skin->hash = h;
}
