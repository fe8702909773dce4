#include "render/hit.h"

#include "base/random.h"
#include "shape/intersect.h"
#include "shape/solid_parts.h"

/* ---- triangles ---- */

typedef struct MetTriangle {
    const MeshData *mesh;
    const Item *owner;
    uint32_t number;
} MetTriangle;

static MetTriangle met_triangle(const Found *found) {
    MetTriangle met;
    met.mesh = cluster_triangle(found->cluster, found->triangle, &met.number, &met.owner);
    return met;
}

/* Smooth normals where the triangles have them. */
static void smooth_normal(Found *found, const MetTriangle *met) {
    const MeshData *mesh = met->mesh;
    if (!mesh->normals) return;
    const uint32_t *n = mesh->normal_triangles ? mesh->normal_triangles[met->number] : mesh->triangles[met->number];
    Vec3 smooth = vec3_scale(vec3_normalize(mesh->normals[n[0]]), 1 - found->u - found->v);
    smooth = vec3_madd(smooth, vec3_normalize(mesh->normals[n[1]]), found->u);
    smooth = vec3_madd(smooth, vec3_normalize(mesh->normals[n[2]]), found->v);
    if (!(vec3_length_squared(smooth) > 1e-4)) return;
    found->normal = found->cluster->mesh ? smooth : mat3_apply_transposed(&met->owner->back.linear, smooth);
}

static const Texture *texture_of_triangle(const MeshData *mesh, uint32_t triangle) {
    return mesh->triangle_textures && mesh->texture_count ? mesh->textures[mesh->triangle_textures[triangle]] : NULL;
}

/* ---- looks ---- */

static const Texture *texture_in_body(const BodyHit *body, bool inside) {
    const Object *looked = body->looked;
    if (!looked) return NULL;
    if (looked == body->leaf && looked->kind == OBJECT_TRIANGLES) {
        const Texture *own = texture_of_triangle(looked->as.mesh, body->tag.part);
        if (own) return own;
    }
    return inside && looked->rest && looked->rest->interior_texture ? looked->rest->interior_texture : looked->texture;
}

static void place_in_scene(const Found *found, int depth, Transform *space) {
    for (int i = depth; i >= 0; i--) {
        const Transform place = item_place(found->path[i]);
        *space = transform_then(space, &place);
    }
}

/* The look that leaves least to be done must not stand for the others. */
static void put_first(SurfaceHit *out, int share, double own_weight) {
    const LookShare first = {out->look, own_weight, out->space};
    out->look = out->shares[share].look;
    out->space = out->shares[share].space;
    out->shares[share] = first;
}

static int demands_of(const Look *look) { return 2 * !look->opaque + !look->plain; }

static void order_shares(SurfaceHit *out) {
    double weight = 1;
    for (int i = 0; i < out->share_count; i++) weight -= out->shares[i].weight;
    for (int i = 0; i < out->share_count; i++) {
        double own = out->shares[i].weight;
        if (demands_of(out->shares[i].look) <= demands_of(out->look)) continue;
        put_first(out, i, weight);
        weight = own;
    }
}

/* Textures of the corners blend as smooth normals do. */
static void blend_corners(const ClusterSet *set, const MeshData *mesh, uint32_t triangle, double u, double v, SurfaceHit *out) {
    const uint32_t *corners = mesh->corner_textures[triangle];
    const double weight[2] = {u, v};
    if (corners[0] == corners[1] && corners[0] == corners[2]) return;
    for (int k = 0; k < 2; k++) {
        const Texture *texture = mesh->textures[corners[k + 1]];
        const Look *look = texture ? look_table_find(&set->looks, texture) : NULL;
        if (look) out->shares[out->share_count++] = (LookShare){look, weight[k], out->space};
    }
}

/* Surfaces without a texture in sets with cutaway_textures; false where nothing that holds the place has one. */
static bool share_cut(const ClusterSet *set, const Found *found, const Ray *ray, SurfaceHit *out) {
    const BodyHit *body = &found->body;
    BodyTexture textures[LOOK_SHARES + 1];
    Transform to_scene = body->cut_place;
    place_in_scene(found, found->depth - 1, &to_scene);
    Vec3 point = transform_point_back(&to_scene, vec3_madd(ray->origin, ray->direction, found->t));
    size_t count = body_textures(body->cut, body->cut_object, point, textures, LOOK_SHARES + 1);
    for (size_t i = 0; i < count; i++) {
        LookShare share = {look_table_find(&set->looks, textures[i].texture), 1.0 / (double)count, transform_then(&textures[i].place, &to_scene)};
        if (i == 0) out->look = share.look, out->space = share.space;
        else out->shares[out->share_count++] = share;
    }
    return count > 0;
}

/* The innermost object with a texture gives it, and its space, which nobody asks for where the look is even. */
static void find_look(const ClusterSet *set, const Found *found, const Ray *ray, bool places, SurfaceHit *out) {
    int i = found->depth - 1;
    const Item *item = found->path[i];
    const Texture *texture = NULL;
    const MeshData *blended = NULL;
    out->share_count = 0;
    if (found->cluster) {
        MetTriangle met = met_triangle(found);
        texture = texture_of_triangle(met.mesh, met.number);
        if (met.mesh->corner_textures) blended = met.mesh;
    } else {
        texture = texture_in_body(&found->body, out->leaving);
    }
    out->look = texture ? look_table_find(&set->looks, texture) : NULL;
    if (out->look) {
        if (out->look->even && !places && !blended) return;
        const Transform place = item_place(item);
        out->space = found->cluster ? place : transform_then(&found->body.looked_place, &place);
        place_in_scene(found, i - 1, &out->space);
        if (blended) blend_corners(set, blended, met_triangle(found).number, found->u, found->v, out);
        order_shares(out);
        return;
    }
    for (; i >= 0 && !out->look; i--) {
        const Item *at = found->path[i];
        out->look = out->leaving && at->inside ? at->inside : at->look;
        if (!out->look) continue;
        if (out->look->even && !places) return;
        out->space = at->look_place ? *at->look_place : item_place(at);
        place_in_scene(found, i - 1, &out->space);
        return;
    }
    if (!found->cluster && found->body.cut && share_cut(set, found, ray, out)) {
        order_shares(out);
        return;
    }
    out->look = set->default_look;
    out->space = transform_identity();
}

/* Parts of a blob with textures of their own share it by their densities; what is left has the blob's. */
static void share_parts(const ClusterSet *set, const Found *found, SurfaceHit *out) {
    BlobShare parts[LOOK_SHARES + 1];
    const Solid *blob = found->body.leaf->as.solid;
    Transform to_scene = found->body.leaf_place;
    place_in_scene(found, found->depth - 1, &to_scene);
    size_t count = solid_blob_shares(blob, found->body.place, parts, LOOK_SHARES + 1);
    bool own = parts[count - 1].part < 0;
    for (size_t i = 0; i < count; i++) {
        if (parts[i].part < 0) continue;
        const BlobPart *part = &blob->as.blob.parts[parts[i].part];
        const LookShare share = {look_table_find(&set->looks, part->texture), parts[i].weight, transform_then(&part->transform, &to_scene)};
        if (i == 0 && !own) out->look = share.look, out->space = share.space;
        else out->shares[out->share_count++] = share;
    }
    order_shares(out);
}

/* ---- interiors ---- */

static uint64_t path_step(uint64_t path, const void *next) { return random_mix(path ^ (uintptr_t)next); }

uint32_t hit_object_of(const Item *item) { return (uint32_t)path_step(path_step(0, item), item->object); }

/* Parts that are drawn once have numbers of their own; parts of sets and of copies get larger ones, of their way there. */
static uint32_t part_number(const Found *found) {
    enum { HASHES = 1 << 23 };
    const Item *item = found->path[found->depth - 1];
    const Object *solid = found->cluster ? item->object : found->body.leaf;
    if (found->depth == 1 && solid == item->object && item->number < HASHES) return item->number;
    uint64_t path = random_hash(solid->span.file, solid->span.begin, solid->span.end, 0);
    for (int i = 0; i < found->depth; i++) path = random_mix(path ^ found->path[i]->number);
    return HASHES + (uint32_t)(path % HASHES);
}

/* From the object that has the interior, in the space of path[depth] or the cluster that that one is in, to the scene. */
static Affine back_from(const Found *found, int depth, const Transform *place) {
    Transform to_scene = *place;
    place_in_scene(found, depth, &to_scene);
    const Transform back = transform_inverse(&to_scene);
    return (Affine){back.linear, back.offset};
}

static Transform filled_place(const Item *item) { return item->filled_place ? *item->filled_place : item_place(item); }

static void find_filling(const Found *found, SurfaceHit *out) {
    uint64_t path = 0;
    int at = -1, last = found->depth - 1;
    out->interior = NULL;
    out->filled = 0;
    out->hollow = !found->cluster && found->body.hollow;
    for (int i = 0; i < found->depth; i++) {
        const Object *filled = found->path[i]->filled;
        out->hollow |= found->path[i]->hollow;
        if (filled) {
            out->interior = filled->rest->interior;
            out->filled = path_step(path, filled);
            at = i;
        }
        path = path_step(path, found->path[i]);
    }
    bool within = !found->cluster && found->body.filled && found->body.filled != found->path[last]->filled;
    if (within) {
        out->interior = found->body.filled->rest->interior;
        out->filled = path_step(path, found->body.filled);
    }
    out->solid = found->cluster ? found->path[last]->object : found->body.leaf;
    out->object = (uint32_t)path_step(path, out->solid);
    out->number = part_number(found);
    if (!out->interior) out->filled = path;
    else if (out->interior->media.count && within) out->to_interior = back_from(found, last, &found->body.filled_place);
    else if (out->interior->media.count) {
        const Transform place = filled_place(found->path[at]);
        out->to_interior = back_from(found, at - 1, &place);
    }
}

static bool item_holds(const Item *item, Vec3 point) {
    if (item->body) return body_inside(item->body, point);
    const SolidOps *ops = solid_ops(item->object);
    return ops->inside && ops->inside(item->object, point) != item->object->inverse;
}

static Affine affine_then(const Affine *first, const Affine *then) {
    return (Affine){mat3_multiply(&then->linear, &first->linear), vec3_add(mat3_apply(&then->linear, first->offset), then->offset)};
}

/* The search within a copy; the interior of the item, if it has one, is nearer than those of the copies around it. */
static InsideSearch search_in(const InsideSearch *outer, const Item *item) {
    InsideSearch inner = *outer;
    if (item->filled) {
        const Transform place = filled_place(item), back = transform_inverse(&place);
        inner.filled = item->filled;
        inner.number = path_step(outer->path, item->filled);
        inner.to_filled = affine_then(&outer->to_cluster, &(Affine){back.linear, back.offset});
    }
    inner.cluster = item->cluster;
    inner.path = path_step(outer->path, item);
    inner.to_cluster = affine_then(&outer->to_cluster, &item->back);
    inner.point = vec3_add(mat3_apply(&item->back.linear, outer->point), item->back.offset);
    inner.hollow |= item->hollow;
    return inner;
}

static size_t add_filling(const InsideSearch *search, Filling *out, size_t count, size_t most) {
    for (size_t i = 0; i < count; i++)
        if (out[i].filled == search->number) return count;
    if (count < most) out[count++] = (Filling){search->filled->rest->interior, search->number, search->hollow, search->to_filled};
    return count;
}

size_t inside_gather(const InsideSearch *search, Filling *out, size_t count, size_t most) {
    const Cluster *cluster = search->cluster;
    size_t candidates = search->filled ? cluster->items.count : cluster->filled.count;
    for (size_t i = 0; i < candidates; i++) {
        const Item *item = &cluster->items.items[search->filled ? i : cluster->filled.items[i]];
        const InsideSearch inner = search_in(search, item);
        if (item->cluster)
            count = inside_gather(&inner, out, count, most);
        else if (item_holds(item, inner.point))
            count = add_filling(&inner, out, count, most);
    }
    return count;
}

/* ---- all about a hit ---- */

static TexCoord hit_uv(const Found *found, Vec3 point) {
    const BodyHit *body = &found->body;
    if (found->cluster) {
        MetTriangle met = met_triangle(found);
        if (met.mesh->single) return (TexCoord){point.x, point.y};
        return solid_mesh_uv(met.mesh, met.number, found->u, found->v);
    }
    const SolidOps *ops = solid_ops(body->leaf);
    return ops->uv ? ops->uv(body->data, body->place, &body->tag) : (TexCoord){point.x, point.y};
}

void hit_finish(const ClusterSet *set, Found *found, const Ray *ray, bool places, SurfaceHit *out) {
    if (found->cluster) {
        MetTriangle met = met_triangle(found);
        smooth_normal(found, &met);
    }
    Vec3 normal = found->normal, flat = found->flat;
    for (int i = found->depth - 2; i >= 0; i--) {
        normal = mat3_apply_transposed(&found->path[i]->back.linear, normal);
        flat = mat3_apply_transposed(&found->path[i]->back.linear, flat);
    }
    bool same = normal.x == flat.x && normal.y == flat.y && normal.z == flat.z;
    normal = vec3_normalize(normal);
    flat = same ? normal : vec3_normalize(flat);
    out->t = found->t;
    out->leaving = vec3_dot(flat, ray->direction) > 0;
    out->flat = out->leaving ? vec3_negate(flat) : flat;
    out->normal = vec3_dot(normal, ray->direction) > 0 ? vec3_negate(normal) : normal;
    size_t parts = 0;
    bool parted = !found->cluster && found->body.leaf->kind == OBJECT_SOLID && object_textured_parts(found->body.leaf, &parts);
    find_look(set, found, ray, places || parted, out);
    if (parted) share_parts(set, found, out);
    if (places || out->share_count || !out->look->even) out->uv = hit_uv(found, vec3_madd(ray->origin, ray->direction, found->t));
    find_filling(found, out);
    out->both_sides = out->solid->double_illuminate;
    for (int i = 0; i < found->depth; i++) out->both_sides |= found->path[i]->both_sides;
}
