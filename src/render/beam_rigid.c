#include "render/beam_rigid.h"

#include "render/beam_cell.h"
#include "render/ray_bundle.h"

#include <string.h>

/* Copies in all: each takes some hundred bytes. */
enum { MOST_RIGID_COPIES = 1 << 18, KEPT_FACETS = 1024 };
/* What is affine but for rounding, in parts of the cell. */
static const double ROUNDING = 1e-7;
/* A tile that ends no farther than this before or behind the surface's border, in tiles, ends with it. */
static const double TILE_HAIR = 1e-6;

/* A surface in texture space, and the tiles that it touches: [u0, u1) × [v0, v1). */
typedef struct TileRect {
    double lo[2], hi[2];
    int64_t u0, u1, v0, v1;
} TileRect;

typedef struct RigidTexel RigidTexel;

/* A copy: box coordinates of its texel → (a, b, w) of the cell. */
typedef struct RigidCopy {
    const RigidTexel *texel;
    const CompiledSkin *skin;
    const SkinCell *cell;
    const PlacedTexel *placed;
    TexelCopy copy;
    double a_x, a_z, a_0, b_x, b_z, b_0, w_y, w_0;
    double u_x, u_z, u_0, v_x, v_z, v_0; /* and → (u, v) */
    const TileRect *cut;                 /* the surface, if it ends within the copy; else NULL */
} RigidCopy;

/* Of a triangle, what facets have. */
typedef struct RigidFacet {
    uint32_t cluster;
    uint16_t layer;
    uint8_t triangle;
    bool round;
} RigidFacet;

/* A texel's triangles. Hits are random ones, and what is asked of them lies side by side: memory is what they wait for. */
struct RigidTexel {
    const BeamTexel *beam;
    RTCScene scene;
    bool cut; /* some copy of it is */
    const float (*corners)[3][3];
    const RigidFacet *facets;
    const RigidCopies *copies;
    RigidTexel *next;
};

struct RigidCopies {
    const EmbreeShim *rtc;
    RTCScene scene;
    Vec3 origin;         /* from which places count: the eye, around which they must be finest */
    Box3 bounds;
    const RigidCopy *items; /* by the numbers of Embree's instances */
    size_t count;
    const CompiledSkin *skin; /* one of these: exact_to of all */
    RigidTexel *texels;
    int lanes;           /* rays that the machine takes at once: 16, 8 or 1 */
};

/* ---- which skins ---- */

static bool vanishes(Vec3 v, double scale) { return vec3_length(v) <= ROUNDING * scale; }

static bool cell_is_affine(const SkinCell *cell) {
    const Vec3 *p = cell->foot.c, *h = cell->height.c;
    double size = vec3_length(p[1]) + vec3_length(p[2]), high = vec3_length(h[0]), tiles = 0;
    for (int i = 1; i < 3; i++) tiles += fabs(cell->u.c[i]) + fabs(cell->v.c[i]);
    for (int i = 1; i < 4; i++)
        if (!vanishes(h[i], high) || fabs(cell->w_foot.c[i]) > ROUNDING || fabs(cell->w_tip.c[i]) > ROUNDING) return false;
    return high > 0 && vanishes(p[3], size) && fabs(cell->u.c[3]) <= ROUNDING * tiles && fabs(cell->v.c[3]) <= ROUNDING * tiles;
}

/* The place in the cell with those texture coordinates; false where they are singular. */
static bool place_in_cell(const SkinCell *cell, double u, double v, double *a, double *b) {
    const double *p = cell->u.c, *q = cell->v.c;
    double det = p[1] * q[2] - p[2] * q[1], du = u - p[0], dv = v - q[0];
    if (!(fabs(det) > 0)) return false;
    *a = (q[2] * du - p[2] * dv) / det, *b = (p[1] * dv - q[1] * du) / det;
    return isfinite(*a) && isfinite(*b);
}

/* Whether a cell goes on as the first does: then it is the same map within, whatever the shape of the cell. */
static bool goes_on(const SkinCell *first, const SkinCell *cell) {
    double size = vec3_length(first->foot.c[1]) + vec3_length(first->foot.c[2]), a, b;
    for (int i = 0; i < (cell->triangle ? 3 : 4); i++) {
        SkinCorner corner = skin_cell_corner(cell, i);
        if (!place_in_cell(first, corner.u, corner.v, &a, &b)) return false;
        Vec3 there = skin_cell_position(first, a, b, 0, NULL), high = first->height.c[0];
        if (!vanishes(vec3_sub(there, corner.foot), size * (1 + fabs(a) + fabs(b))) || !vanishes(vec3_sub(corner.height, high), vec3_length(high))) return false;
        if (fabs(corner.w_foot - first->w_foot.c[0]) > ROUNDING || fabs(corner.w_tip - first->w_tip.c[0]) > ROUNDING) return false;
    }
    return true;
}

/* Of a cell in texture space. */
static double tiles_in_cell(const SkinCell *cell) {
    int corners = cell->triangle ? 3 : 4;
    double twice = 0;
    for (int i = 0; i < corners; i++) {
        SkinCorner p = skin_cell_corner(cell, i), q = skin_cell_corner(cell, (i + 1) % corners);
        twice += p.u * q.v - q.u * p.v;
    }
    return fabs(twice) / 2;
}

/* False of a surface that is no rectangle of texture space. */
static bool tile_rect(const CompiledSkin *skin, TileRect *rect) {
    double lo[2] = {VTS_INFINITY, VTS_INFINITY}, hi[2] = {-VTS_INFINITY, -VTS_INFINITY}, area = 0;
    for (size_t i = 0; i < skin->cell_count; i++) {
        const SkinCell *cell = &skin->cells[i];
        if (cell->rim) continue;
        area += tiles_in_cell(cell);
        for (int k = 0; k < (cell->triangle ? 3 : 4); k++) {
            SkinCorner corner = skin_cell_corner(cell, k);
            lo[0] = fmin(lo[0], corner.u), hi[0] = fmax(hi[0], corner.u);
            lo[1] = fmin(lo[1], corner.v), hi[1] = fmax(hi[1], corner.v);
        }
    }
    double all = (hi[0] - lo[0]) * (hi[1] - lo[1]);
    if (!(all <= MOST_RIGID_COPIES) || fabs(area - all) > 1e-6 * all) return false;
    if (!(fabs(lo[0]) < 1e9 && fabs(lo[1]) < 1e9)) return false;
    *rect = (TileRect){.lo = {lo[0], lo[1]}, .hi = {hi[0], hi[1]},
                       .u0 = (int64_t)floor(lo[0] + TILE_HAIR), .u1 = (int64_t)ceil(hi[0] - TILE_HAIR),
                       .v0 = (int64_t)floor(lo[1] + TILE_HAIR), .v1 = (int64_t)ceil(hi[1] - TILE_HAIR)};
    return true;
}

/* Whether none of its copies ends at the layer's foot or top, or within the surface, or where the tile_rect() would not tell. */
static bool copies_are_whole(const CompiledSkin *skin, const PlacedTexel *placed) {
    if (placed->overhang > 0 && !skin->beyond) return false;
    for (size_t i = 0; i < placed->family_size; i++)
        if (placed->family[i]->def->cyclic & TEXEL_CYCLIC_Y) return false;
    return true;
}

/* Embree takes rays into a copy's own space in floats, and ends the program where they have no room there: copies must not be so thin
 * that lengths up to BUNDLE_FARTHEST leave it, nor so large. */
static const double THINNEST = 1e-7, LARGEST = 1e7;

static bool has_room(const SkinCell *cell) {
    const Vec3 *p = cell->foot.c, h = cell->height.c[0];
    double volume = fabs(vec3_dot(vec3_cross(p[1], p[2]), h));
    double side = fmax(vec3_length(vec3_cross(p[1], p[2])), fmax(vec3_length(vec3_cross(p[2], h)), vec3_length(vec3_cross(h, p[1]))));
    double longest = fmax(vec3_length(p[1]), fmax(vec3_length(p[2]), vec3_length(h)));
    return volume >= THINNEST * side && longest <= LARGEST;
}

bool skin_is_rigid(const CompiledSkin *skin) {
    TileRect rect;
    const SkinCell *first = &skin->cells[0];
    if (!skin->cell_count || first->rim || first->side == CELL_FLAT || !cell_is_affine(first) || !has_room(first)) return false;
    if (fabs(first->w_foot.c[0]) > ROUNDING || fabs(first->w_tip.c[0] - skin->top) > ROUNDING) return false;
    for (size_t i = 0; i < skin->texel_count; i++)
        if (!copies_are_whole(skin, &skin->texels[i])) return false;
    for (size_t i = 1; i < skin->cell_count; i++)
        if (!goes_on(first, &skin->cells[i])) return false;
    return tile_rect(skin, &rect);
}

/* ---- building ---- */

typedef struct Building {
    CompiledScene *compiled;
    const Embree *embree;
    RigidCopies *out;
    struct {
        RigidCopy *items;
        size_t count, capacity;
    } copies;
} Building;

static void fill_texel(const BeamTexel *beam, float (*corners)[3][3], RigidFacet *facets) {
    size_t triangle = 0;
    for (size_t c = 0; c < beam->cluster_count; c++) {
        const TexelCluster *cluster = &beam->clusters[c];
        for (int i = 0; i < cluster->triangle_count; i++, triangle++) {
            for (int k = 0; k < 3; k++) {
                int v = cluster->triangles[i][k];
                corners[triangle][k][0] = cluster->x[v], corners[triangle][k][1] = cluster->y[v], corners[triangle][k][2] = cluster->z[v];
            }
            facets[triangle] = (RigidFacet){.cluster = (uint32_t)c, .layer = cluster->layers[i], .triangle = (uint8_t)i, .round = cluster->normals};
        }
    }
}

/* Whether the surface goes on where a ray meets a triangle of a copy that it ends in. */
static bool is_on_surface(const RigidTexel *texel, const RigidCopy *copy, unsigned triangle, double s, double t) {
    const float(*p)[3] = texel->corners[triangle];
    double x = (1 - s - t) * (double)p[0][0] + s * (double)p[1][0] + t * (double)p[2][0];
    double z = (1 - s - t) * (double)p[0][2] + s * (double)p[1][2] + t * (double)p[2][2];
    double at[2] = {copy->u_x * x + copy->u_z * z + copy->u_0, copy->v_x * x + copy->v_z * z + copy->v_0};
    for (int k = 0; k < 2; k++)
        if (at[k] < copy->cut->lo[k] || at[k] > copy->cut->hi[k]) return false;
    return true;
}

/* Of Embree: takes back hits beyond the border. */
static void leave_cut_off(const struct RTCFilterFunctionNArguments *args) {
    const RigidTexel *texel = args->geometryUserPtr;
    const float *reals = (const float *)(const void *)args->hit;
    const unsigned *numbers = (const unsigned *)(const void *)args->hit;
    for (unsigned i = 0; i < args->N; i++) {
        if (args->valid[i] != -1) continue;
        const RigidCopy *copy = &texel->copies->items[numbers[HIT_COPY * args->N + i]];
        double s = (double)reals[HIT_U * args->N + i], t = (double)reals[HIT_V * args->N + i];
        if (copy->cut && !is_on_surface(texel, copy, numbers[HIT_TRIANGLE * args->N + i], s, t)) args->valid[i] = 0;
    }
}

static RigidTexel *texel_of(Building *b, const BeamTexel *beam) {
    const EmbreeShim *rtc = b->embree->rtc;
    for (RigidTexel *t = b->out->texels; t; t = t->next)
        if (t->beam == beam) return t;
    RigidTexel *texel = arena_new(b->compiled->arena, RigidTexel);
    size_t count = beam->triangle_count;
    float(*corners)[3][3] = arena_push_array_(b->compiled->arena, count + 1, sizeof *corners); /* Embree reads past the last */
    RigidFacet *facets = arena_new_array(b->compiled->arena, RigidFacet, count);
    fill_texel(beam, corners, facets);
    *texel = (RigidTexel){.beam = beam, .scene = rtc->NewScene(b->embree->device), .corners = (const float(*)[3][3])corners, .facets = facets, .copies = b->out, .next = b->out->texels};
    b->out->texels = texel;
    RTCGeometry geometry = rtc->NewGeometry(b->embree->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtc->SetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, corners, 0, sizeof **corners, 3 * count);
    unsigned *indices = rtc->SetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), count);
    for (unsigned i = 0; indices && i < 3 * count; i++) indices[i] = i;
    rtc->SetGeometryUserData(geometry, texel);
    rtc->SetSceneFlags(texel->scene, RTC_SCENE_FLAG_ROBUST);
    rtc->CommitGeometry(geometry);
    rtc->AttachGeometryByID(texel->scene, geometry, 0);
    rtc->ReleaseGeometry(geometry);
    rtc->CommitScene(texel->scene);
    return texel;
}

/* Hits of whole copies are not asked for: that takes time. */
static void have_cut(RigidTexel *texel) {
    const EmbreeShim *rtc = texel->copies->rtc;
    RTCGeometry geometry = rtc->GetGeometry(texel->scene, 0);
    rtc->SetGeometryIntersectFilterFunction(geometry, leave_cut_off);
    rtc->SetGeometryOccludedFilterFunction(geometry, leave_cut_off);
    rtc->CommitGeometry(geometry);
    rtc->CommitScene(texel->scene);
    texel->cut = true;
}

/* The copy's place in its cell; false where it has none. */
static bool place_copy(RigidCopy *r) {
    const TexelCopy *c = &r->copy;
    double det = c->xu * c->zv - c->xv * c->zu, a0, b0, ax, bx, az, bz;
    if (!(fabs(det) > 0) || !(c->inverse_scale > 0)) return false;
    double u_x = c->zv / det, u_z = -c->xv / det, u_0 = -(u_x * c->x0 + u_z * c->z0);
    double v_x = -c->zu / det, v_z = c->xu / det, v_0 = -(v_x * c->x0 + v_z * c->z0);
    if (!place_in_cell(r->cell, u_0, v_0, &a0, &b0)) return false;
    if (!place_in_cell(r->cell, u_0 + u_x, v_0 + v_x, &ax, &bx) || !place_in_cell(r->cell, u_0 + u_z, v_0 + v_z, &az, &bz)) return false;
    double foot = r->cell->w_foot.c[0], per = 1 / (r->cell->w_tip.c[0] - foot);
    r->u_x = u_x, r->u_z = u_z, r->u_0 = u_0;
    r->v_x = v_x, r->v_z = v_z, r->v_0 = v_0;
    r->a_0 = a0, r->a_x = ax - a0, r->a_z = az - a0;
    r->b_0 = b0, r->b_x = bx - b0, r->b_z = bz - b0;
    r->w_y = per / c->inverse_scale, r->w_0 = -foot * per;
    return true;
}

static void put_column(float *out, Vec3 v) {
    Vec3f f = vec3f_from(v);
    out[0] = f.x, out[1] = f.y, out[2] = f.z;
}

static void add_copy(Building *b, RigidCopy *r) {
    const EmbreeShim *rtc = b->embree->rtc;
    const Vec3 *foot = r->cell->foot.c, high = r->cell->height.c[0];
    float columns[12];
    Vec3 from = vec3_madd(vec3_madd(vec3_madd(foot[0], foot[1], r->a_0), foot[2], r->b_0), high, r->w_0);
    put_column(columns, vec3_madd(vec3_scale(foot[1], r->a_x), foot[2], r->b_x));
    put_column(columns + 3, vec3_scale(high, r->w_y));
    put_column(columns + 6, vec3_madd(vec3_scale(foot[1], r->a_z), foot[2], r->b_z));
    put_column(columns + 9, vec3_sub(from, b->out->origin));
    RigidTexel *texel = texel_of(b, r->copy.texel->beam);
    r->texel = texel;
    if (r->cut && !texel->cut) have_cut(texel);
    RTCGeometry geometry = rtc->NewGeometry(b->embree->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtc->SetGeometryInstancedScene(geometry, texel->scene);
    rtc->SetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    rtc->CommitGeometry(geometry);
    rtc->AttachGeometryByID(b->out->scene, geometry, (unsigned)b->copies.count);
    rtc->ReleaseGeometry(geometry);
    *list_push_sole(b->compiled->arena, &b->copies) = *r;
}

/* Whether the surface has a part of the tile; *cut: not all of it. */
static bool meets_tile(const TileRect *rect, double u, double v, bool *cut) {
    const double from[2] = {u, v};
    *cut = false;
    for (int k = 0; k < 2; k++) {
        if (from[k] + 1 <= rect->lo[k] + TILE_HAIR || from[k] >= rect->hi[k] - TILE_HAIR) return false;
        *cut |= from[k] < rect->lo[k] - TILE_HAIR || from[k] + 1 > rect->hi[k] + TILE_HAIR;
    }
    return true;
}

/* A copy that may leave its tile stands, as a whole, where the middle of its tile does (skin_rim.h); others end with the surface. */
static void add_texel(Building *b, const CompiledSkin *skin, const PlacedTexel *placed, const TileRect *rect) {
    int64_t u0 = rect->u0 - (placed->shift_u > 0), v0 = rect->v0 - (placed->shift_v > 0);
    for (int64_t iu = u0; iu < rect->u1; iu++)
        for (int64_t iv = v0; iv < rect->v1; iv++) {
            bool cut;
            RigidCopy r = {.skin = skin, .cell = &skin->cells[0], .placed = placed};
            if (!meets_tile(rect, (double)iu + placed->shift_u, (double)iv + placed->shift_v, &cut)) continue;
            if (cut && !(placed->overhang > 0)) r.cut = rect;
            if (skin_copy_of(skin, r.cell, placed, iu, iv, &r.copy) && r.copy.texel->beam->triangle_count && place_copy(&r)) add_copy(b, &r);
        }
}

static void add_skin(Building *b, const CompiledSkin *skin) {
    TileRect *rect = arena_new(b->compiled->arena, TileRect);
    if (!tile_rect(skin, rect)) return;
    for (size_t i = 0; i < skin->texel_count; i++) add_texel(b, skin, &skin->texels[i], rect);
    b->out->bounds = box3_union(b->out->bounds, skin->bounds);
}

static size_t tiles_of(const CompiledSkin *skin) {
    TileRect rect;
    return tile_rect(skin, &rect) ? (size_t)((rect.u1 - rect.u0 + 1) * (rect.v1 - rect.v0 + 1)) * skin->texel_count : 0;
}

RigidCopies *rigid_copies_build(CompiledScene *compiled) {
    size_t tiles = 0;
    double exact_to = 0;
    for (size_t i = 0; i < compiled->skin_count; i++) {
        CompiledSkin *skin = &compiled->skins[i];
        skin->rigid &= skin->boxes != NULL;
        if (!skin->rigid) continue;
        tiles += tiles_of(skin);
        exact_to = fmax(exact_to, skin->exact_to);
    }
    bool too_many = tiles > MOST_RIGID_COPIES;
    for (size_t i = 0; i < compiled->skin_count; i++) {
        CompiledSkin *skin = &compiled->skins[i];
        skin->rigid &= !too_many;
        if (skin->rigid) skin->exact_to = exact_to; /* a ray ends at one distance */
    }
    if (!tiles || too_many) return NULL;
    const Embree *embree = hierarchy_embree(compiled->hierarchy);
    RigidCopies *out = arena_new(compiled->arena, RigidCopies);
    *out = (RigidCopies){.rtc = embree->rtc, .scene = embree->rtc->NewScene(embree->device), .origin = compiled->view.camera.location, .bounds = box3_empty(),
                         .lanes = bundle_lanes(embree)};
    Building b = {.compiled = compiled, .embree = embree, .out = out};
    embree->rtc->SetSceneFlags(out->scene, RTC_SCENE_FLAG_ROBUST);
    for (size_t i = 0; i < compiled->skin_count; i++)
        if (compiled->skins[i].rigid) add_skin(&b, out->skin = &compiled->skins[i]);
    embree->rtc->CommitScene(out->scene);
    out->items = b.copies.items;
    out->count = b.copies.count;
    return out;
}

void rigid_copies_destroy(RigidCopies *copies) {
    if (!copies) return;
    copies->rtc->ReleaseScene(copies->scene);
    for (RigidTexel *t = copies->texels; t; t = t->next) copies->rtc->ReleaseScene(t->scene);
}

bool rigid_meets(const RigidCopies *copies, const Beam *beam) { return beam_meets_box(beam, &copies->bounds); }

/* ---- what samples see ---- */

/* Facets that were met of late, and their marks. */
typedef struct Seeing {
    const RigidCopies *copies;
    BeamDraft *draft;
    struct {
        uint32_t copy, triangle, mark;
    } kept[KEPT_FACETS];
} Seeing;

static uint32_t new_facet(const Seeing *s, const RigidCopy *copy, uint32_t triangle) {
    BeamDraft *draft = s->draft;
    const float(*p)[3] = copy->texel->corners[triangle];
    const RigidFacet *is = &copy->texel->facets[triangle];
    BeamFacet *f = &draft->facets[draft->facet_count++];
    *f = (BeamFacet){.skin = copy->skin, .cell = copy->cell, .placed = copy->placed, .copy = copy->copy, .cluster = &copy->texel->beam->clusters[is->cluster],
                     .triangle = is->triangle, .round = is->round, .layer = is->layer, .from_a = copy->a_0, .from_b = copy->b_0, .size = 1};
    for (int i = 0; i < 3; i++) {
        double x = (double)p[i][0], y = (double)p[i][1], z = (double)p[i][2];
        f->corner[i] = vec3f((float)(copy->a_x * x + copy->a_z * z), (float)(copy->b_x * x + copy->b_z * z), (float)(copy->w_y * y + copy->w_0));
    }
    return draft->facet_count;
}

static uint32_t mark_of(Seeing *s, uint32_t copy, uint32_t triangle) {
    size_t at = (copy * 0x9E3779B1u + triangle) % KEPT_FACETS;
    if (s->kept[at].mark && s->kept[at].copy == copy && s->kept[at].triangle == triangle) return s->kept[at].mark;
    s->kept[at].copy = copy, s->kept[at].triangle = triangle;
    return s->kept[at].mark = new_facet(s, &s->copies->items[copy], triangle);
}

static void take_hits(Seeing *s, RayBundle *bundle) {
    BeamSamples *samples = &s->draft->beam->samples;
    if (bundle->count) bundle_intersect(bundle, s->copies->rtc, s->copies->scene);
    for (int i = 0; i < bundle->count; i++) {
        uint32_t at = bundle->sample[i], copy = bundle_hit(bundle, HIT_COPY, i)->number;
        float t = bundle_cell(bundle, RAY_FAR, i)->real, key = s->draft->beam->perspective ? 1 / t : -t;
        if (bundle_hit(bundle, HIT_GEOMETRY, i)->number == RTC_INVALID_GEOMETRY_ID || !(key > samples->key[at])) continue;
        samples->mark[at] = mark_of(s, copy, bundle_hit(bundle, HIT_TRIANGLE, i)->number);
        samples->key[at] = key;
    }
    bundle_clear(bundle);
}

/* Lines of samples: `shift` is from the origin of the copies to that of the lines. */
typedef struct SampleLines {
    Vec3 corner, right, down, direction, shift;
} SampleLines;

static void add_sample(const RigidCopies *copies, const Beam *beam, const SampleLines *lines, uint32_t i, RayBundle *bundle) {
    const BeamSamples *s = &beam->samples;
    Vec3 to = vec3_madd(vec3_madd(lines->corner, lines->right, (double)s->x[i]), lines->down, (double)s->y[i]);
    if (!beam->perspective) {
        bundle_add(bundle, vec3f_from(vec3_add(to, lines->shift)), vec3f_from(lines->direction), 0, -s->key[i], i);
        return;
    }
    float far = 1 / s->key[i];
    if (s->limit[i] > 0) far = float_min(far, (float)(copies->skin->exact_to / (double)s->limit[i]));
    bundle_add(bundle, vec3f_from(lines->shift), vec3f_from(to), (float)beam->nearest, far, i);
}

uint64_t rigid_see(const RigidCopies *copies, BeamDraft *draft, Vec3 corner, Vec3 right, Vec3 down, Vec3 direction) {
    const Beam *beam = draft->beam;
    const BeamSamples *s = &beam->samples;
    Seeing seeing = {.copies = copies, .draft = draft};
    uint64_t rays = 0;
    if (!rigid_meets(copies, beam)) return 0;
    RayBundle bundle = bundle_for(copies->lanes);
    const SampleLines lines = {corner, right, down, direction, beam->perspective ? vec3_sub(beam->origin, copies->origin) : vec3_negate(copies->origin)};
    for (int pixel = 0; pixel < s->columns * s->rows && !beam_is_interrupted(draft); pixel++) {
        float middle_x = (float)(pixel % s->columns) + 0.5f, middle_y = (float)(pixel / s->columns) + 0.5f;
        for (int quarter = 0; quarter < 4; quarter++) /* those that lie together go the same ways */
            for (uint32_t i = s->first[pixel]; i < s->first[pixel + 1]; i++) {
                if (2 * (s->y[i] >= middle_y) + (s->x[i] >= middle_x) != quarter) continue;
                add_sample(copies, beam, &lines, i, &bundle);
                if (bundle.count < bundle.lanes) continue;
                rays += (uint64_t)bundle.lanes;
                take_hits(&seeing, &bundle);
            }
    }
    rays += (uint64_t)bundle.count;
    take_hits(&seeing, &bundle);
    return rays;
}

/* ---- shadows ---- */

static void hide_hits(const RigidCopies *copies, RayBundle *bundle, uint8_t *hidden) {
    if (bundle->count) bundle_occlude(bundle, copies->rtc, copies->scene);
    for (int i = 0; i < bundle->count; i++)
        if (bundle_cell(bundle, RAY_FAR, i)->real < 0) hidden[bundle->sample[i]] = 1;
    bundle_clear(bundle);
}

uint64_t rigid_hide(const RigidCopies *copies, const Light *light, const ShadowPoints *points) {
    bool parallel = light_is_parallel(light);
    Vec3 shift = vec3_sub(points->origin, copies->origin);
    uint64_t rays = 0;
    RayBundle bundle = bundle_for(copies->lanes);
    for (uint32_t i = 0; i < points->count; i++) {
        if (points->hidden[i] || !(copies->skin->exact_to >= (double)points->distance[i])) continue;
        Vec3 from = vec3_add(shift, vec3_from_f(points->points[i]));
        Vec3 to = parallel ? light->to_light : vec3_sub(vec3_sub(light->location, copies->origin), from);
        bundle_add(&bundle, vec3f_from(from), vec3f_from(to), 0, parallel ? INFINITY : 1, i);
        if (bundle.count < bundle.lanes) continue;
        rays += (uint64_t)bundle.lanes;
        hide_hits(copies, &bundle, points->hidden);
    }
    rays += (uint64_t)bundle.count;
    hide_hits(copies, &bundle, points->hidden);
    return rays;
}
