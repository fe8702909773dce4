#include "render/beam_texel.h"

#include <math.h>
#include <string.h>

typedef struct Facet {
    float at[3][3]; /* [corner][axis], box coordinates */
    uint16_t layer;
    uint32_t normals; /* 1 + their number; 0: flat */
} Facet;

typedef struct FacetList {
    Facet *items;
    size_t count, capacity;
} FacetList;

typedef struct NormalsList {
    FacetNormals *items;
    size_t count, capacity;
} NormalsList;

struct BeamTexelDraft {
    Arena *scratch;
    FacetList facets;
    NormalsList normals;
    float per_extent[3];
    bool cyclic[3];
    int layer_count;
};

/* A triangle is repeated at most so often along an axis; the voxels have the same limit. */
enum { MOST_WRAPS = 64, MOST_CUT_CORNERS = 9, MOST_LAYERS = UINT16_MAX };

BeamTexelDraft *beam_texel_begin(Vec3f extent, unsigned cyclic, Arena *scratch) {
    BeamTexelDraft *draft = arena_new(scratch, BeamTexelDraft);
    *draft = (BeamTexelDraft){.scratch = scratch, .per_extent = {1 / extent.x, 1 / extent.y, 1 / extent.z}};
    for (int k = 0; k < 3; k++) draft->cyclic[k] = cyclic >> k & 1;
    return draft;
}

/* ---- cutting at the walls ---- */

/* A corner of a polygon: its place, and the normal there (0 of flat ones). */
typedef struct Corner {
    float at[3], normal[3];
} Corner;

typedef struct Cut {
    Corner corner[MOST_CUT_CORNERS];
    int count;
    bool round;
} Cut;

static Corner between(const Corner *a, const Corner *b, float t) {
    Corner out;
    for (int k = 0; k < 3; k++) {
        out.at[k] = a->at[k] + t * (b->at[k] - a->at[k]);
        out.normal[k] = a->normal[k] + t * (b->normal[k] - a->normal[k]);
    }
    return out;
}

/* The part of the polygon with side·(x − wall) <= 0 along an axis. */
static void cut_at(Cut *p, int axis, float wall, float side) {
    Cut out = {.round = p->round};
    for (int i = 0; i < p->count; i++) {
        const Corner *a = &p->corner[i], *b = &p->corner[(i + 1) % p->count];
        float da = side * (a->at[axis] - wall), db = side * (b->at[axis] - wall);
        if (da <= 0) out.corner[out.count++] = *a;
        if ((da <= 0) == (db <= 0)) continue;
        out.corner[out.count] = between(a, b, da / (da - db));
        out.corner[out.count++].at[axis] = wall;
    }
    *p = out;
}

static void add_cut(BeamTexelDraft *draft, const Cut *p, uint16_t layer) {
    for (int i = 2; i < p->count; i++) {
        const Corner *corner[3] = {&p->corner[0], &p->corner[i - 1], &p->corner[i]};
        Facet *f = list_push_sole(draft->scratch, &draft->facets);
        Vec3f normals[3];
        for (int c = 0; c < 3; c++) {
            memcpy(f->at[c], corner[c]->at, sizeof f->at[c]);
            normals[c] = vec3f(corner[c]->normal[0], corner[c]->normal[1], corner[c]->normal[2]);
        }
        f->layer = layer;
        f->normals = 0;
        if (!p->round) continue;
        *list_push_sole(draft->scratch, &draft->normals) = facet_normals_pack(normals);
        f->normals = (uint32_t)draft->normals.count;
    }
}

/* One period of a triangle. */
static void add_moved(BeamTexelDraft *draft, const Cut *triangle, const int period[3], uint16_t layer) {
    Cut p = *triangle;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) p.corner[i].at[k] += (float)period[k];
    for (int k = 0; k < 3 && p.count; k++) {
        bool below = false, above = false;
        for (int i = 0; i < p.count; i++) below |= p.corner[i].at[k] < 0, above |= p.corner[i].at[k] > 1;
        if (below) cut_at(&p, k, 0, -1);
        if (above) cut_at(&p, k, 1, 1);
    }
    add_cut(draft, &p, layer);
}

/* The periods by which it is to be moved so that some of it is in the box; false when none is. */
static bool find_periods(const BeamTexelDraft *draft, const Cut *triangle, int from[3], int to[3]) {
    for (int k = 0; k < 3; k++) {
        float a = triangle->corner[0].at[k], b = triangle->corner[1].at[k], c = triangle->corner[2].at[k];
        float lo = float_min(a, float_min(b, c)), hi = float_max(a, float_max(b, c));
        from[k] = to[k] = 0;
        if (!isfinite(lo) || !isfinite(hi)) return false;
        if (draft->cyclic[k]) {
            if (hi - lo > MOST_WRAPS || fabsf(lo) > 1e6f) return false;
            from[k] = (int)ceilf(-hi);
            to[k] = (int)floorf(1 - lo);
        } else if (hi < 0 || lo > 1) {
            return false;
        }
    }
    return true;
}

static bool load(const BeamTexelDraft *draft, const TexelMesh *mesh, size_t triangle, Cut *out) {
    Vec3f normals[3];
    *out = (Cut){.count = 3, .round = facet_normals_of(mesh, triangle, normals)};
    for (int i = 0; i < 3; i++) {
        uint32_t v = mesh->triangles[triangle][i];
        if (v >= mesh->vertex_count) return false;
        Vec3f p = mesh->vertices[v], n = out->round ? normals[i] : vec3f(0, 0, 0);
        out->corner[i] = (Corner){{p.x * draft->per_extent[0], p.y * draft->per_extent[1], p.z * draft->per_extent[2]}, {n.x, n.y, n.z}};
    }
    return true;
}

void beam_texel_add_layer(BeamTexelDraft *draft, const TexelMesh *mesh) {
    uint16_t layer = (uint16_t)int_min(draft->layer_count++, MOST_LAYERS);
    Cut triangle;
    int from[3], to[3], period[3];
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        if (!load(draft, mesh, i, &triangle) || !find_periods(draft, &triangle, from, to)) continue;
        for (period[2] = from[2]; period[2] <= to[2]; period[2]++)
            for (period[1] = from[1]; period[1] <= to[1]; period[1]++)
                for (period[0] = from[0]; period[0] <= to[0]; period[0]++) add_moved(draft, &triangle, period, layer);
    }
}

/* ---- the tree ---- */

typedef struct Tree {
    Facet *facets;
    const FacetNormals *normals;
    ClusterNode *nodes;
    TexelCluster *clusters;
    size_t node_count, cluster_count, bytes;
    Arena *arena;
} Tree;

static float middle(const Facet *f, int axis) { return (f->at[0][axis] + f->at[1][axis] + f->at[2][axis]) / 3; }

static void bound(const Facet *facets, size_t count, ClusterNode *node) {
    for (int k = 0; k < 3; k++) {
        node->min[k] = INFINITY, node->max[k] = -INFINITY;
        for (size_t i = 0; i < count; i++)
            for (int c = 0; c < 3; c++) {
                node->min[k] = float_min(node->min[k], facets[i].at[c][k]);
                node->max[k] = float_max(node->max[k], facets[i].at[c][k]);
            }
    }
}

/* NULL where all of them are flat. */
static const FacetNormals *normals_of(Tree *tree, const Facet *facets, int count) {
    static const Vec3f none[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    bool any = false;
    for (int i = 0; i < count; i++) any |= facets[i].normals != 0;
    if (!any) return NULL;
    FacetNormals *out = arena_new_array(tree->arena, FacetNormals, (size_t)count);
    for (int i = 0; i < count; i++) out[i] = facets[i].normals ? tree->normals[facets[i].normals - 1] : facet_normals_pack(none);
    tree->bytes += (size_t)count * sizeof *out;
    return out;
}

static float longest_edge(const Facet *facets, int count, int axis) {
    float longest = 0;
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) longest = float_max(longest, fabsf(facets[i].at[(c + 1) % 3][axis] - facets[i].at[c][axis]));
    return longest;
}

static void make_cluster(Tree *tree, const Facet *facets, int count, ClusterNode *node) {
    float at[3][CLUSTER_VERTICES];
    uint8_t(*triangles)[3] = arena_push_array_(tree->arena, (size_t)count, sizeof *triangles);
    uint16_t *layers = arena_new_array(tree->arena, uint16_t, (size_t)count);
    int vertices = 0;
    for (int i = 0; i < count; i++) {
        layers[i] = facets[i].layer;
        for (int c = 0; c < 3; c++) {
            const float *p = facets[i].at[c];
            int v = 0;
            while (v < vertices && !(at[0][v] == p[0] && at[1][v] == p[1] && at[2][v] == p[2])) v++;
            if (v == vertices) {
                for (int k = 0; k < 3; k++) at[k][v] = p[k];
                vertices++;
            }
            triangles[i][c] = (uint8_t)v;
        }
    }
    size_t row = (size_t)vertices * sizeof(float);
    tree->clusters[tree->cluster_count] = (TexelCluster){
        .x = arena_copy(tree->arena, at[0], row), .y = arena_copy(tree->arena, at[1], row), .z = arena_copy(tree->arena, at[2], row),
        .triangles = (const uint8_t(*)[3])triangles, .layers = layers, .normals = normals_of(tree, facets, count), .vertex_count = vertices, .triangle_count = count,
        .longest = {longest_edge(facets, count, 0), longest_edge(facets, count, 1), longest_edge(facets, count, 2)}};
    node->leaf = true;
    node->first = (uint32_t)tree->cluster_count++;
    tree->bytes += 3 * row + 4 * (size_t)count + sizeof(TexelCluster);
}

/* Moves those with a smaller middle to the front; returns how many. */
static size_t partition(Facet *facets, size_t count, int axis, float at) {
    size_t low = 0, high = count;
    while (low < high) {
        if (middle(&facets[low], axis) < at) {
            low++;
        } else {
            Facet other = facets[--high];
            facets[high] = facets[low];
            facets[low] = other;
        }
    }
    return low;
}

static size_t split(Facet *facets, size_t count) {
    float lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            float m = middle(&facets[i], k);
            lo[k] = float_min(lo[k], m), hi[k] = float_max(hi[k], m);
        }
    int axis = hi[0] - lo[0] >= hi[1] - lo[1] ? 0 : 1;
    if (hi[2] - lo[2] > hi[axis] - lo[axis]) axis = 2;
    size_t low = partition(facets, count, axis, (lo[axis] + hi[axis]) / 2);
    return low == 0 || low == count ? count / 2 : low;
}

static void grow(Tree *tree, size_t index, Facet *facets, size_t count) {
    ClusterNode *node = &tree->nodes[index];
    bound(facets, count, node);
    if (count <= CLUSTER_TRIANGLES) {
        make_cluster(tree, facets, (int)count, node);
        return;
    }
    size_t low = split(facets, count), children = tree->node_count;
    tree->node_count += 2;
    node->first = (uint32_t)children;
    grow(tree, children, facets, low);
    grow(tree, children + 1, facets + low, count - low);
}

const BeamTexel *beam_texel_finish(BeamTexelDraft *draft, Arena *arena) {
    size_t count = draft->facets.count;
    BeamTexel *out = arena_new(arena, BeamTexel);
    /* Every split leaves at least one facet on each side. */
    Tree tree = {.facets = draft->facets.items, .normals = draft->normals.items, .arena = arena, .nodes = arena_new_array(draft->scratch, ClusterNode, 2 * count + 1),
                 .clusters = arena_new_array(draft->scratch, TexelCluster, count)};
    if (count) {
        tree.node_count = 1;
        grow(&tree, 0, draft->facets.items, count);
    }
    size_t nodes = tree.node_count * sizeof(ClusterNode), clusters = tree.cluster_count * sizeof(TexelCluster);
    *out = (BeamTexel){.nodes = arena_copy(arena, tree.nodes, nodes), .node_count = tree.node_count,
                       .clusters = arena_copy(arena, tree.clusters, clusters), .cluster_count = tree.cluster_count, .triangle_count = count,
                       .bytes = tree.bytes + nodes};
    for (int k = 0; k < 3; k++) out->cyclic[k] = draft->cyclic[k];
    return out;
}
