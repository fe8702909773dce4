/* Texels: a reference volume as voxels of area density and normal distribution, prefiltered at every scale.
 *
 * A built texel has one VoxelLayer per material layer. Texel space: the texel's bounds scaled uniformly so that the
 * longest side is 1 and the smallest corner is the origin; w of the mapping is y. A layer fills [0, extent.x] ×
 * [0, extent.y] × [0, extent.z].
 *
 * Per voxel and level (design: texels.md; Neyret 1998 sec. IV with its errata; Heitz et al. 2015):
 *   density  surface area per unit volume of texel space, averaged over directions when seen: sigma(w) =
 *            density · sqrt(wᵗ S w) for unit w is the projected area per volume, and mean sigma over directions = density.
 *            The two walls of a solid count one each where it is thicker than two voxels, one together where it is
 *            thinner than one: a thin stem is seen once
 *   S        SGGX matrix normalised to unit mean projected area (within 0.6 %); axis ratios at least 0.01
 *   gamma    how far the voxel behaves as a sheet (> 0) or as clumps (< 0) rather than as random matter: for opacity.h
 * Voxels are centred: voxel (i, j, k) of level L covers [i, i+1)·h(L) … and its value stands at its centre. */
#ifndef VTS_TEXEL_TEXEL_H
#define VTS_TEXEL_TEXEL_H

#include "base/arena.h"
#include "base/hash.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/vec.h"

enum { TEXEL_CYCLIC_X = 1, TEXEL_CYCLIC_Y = 2, TEXEL_CYCLIC_Z = 4, TEXEL_LARGEST_RESOLUTION = 1024, TEXEL_MAX_LEVELS = 11 };

/* Source triangles of one layer in texel space. Content outside the extent wraps on cyclic axes and is cut off on others. */
typedef struct TexelMesh {
    const Vec3f *vertices;
    const uint32_t (*triangles)[3];
    size_t vertex_count, triangle_count;
    /* solid[t]: triangle t belongs to the boundary of a closed solid (its two walls hide each other); otherwise it is an
     * open sheet seen from both sides. NULL: all sheets. */
    const bool *solid;
    /* Per vertex, to the outside: unit, or zero where its triangles are as flat as they look. NULL: all of them are. */
    const Vec3f *normals;
} TexelMesh;

/* Matter that is no triangles, asked for by cells of texel space; its functions are called from any thread. What they give lies as random
 * matter in its voxel: gamma is 0. */
typedef struct TexelField {
    const void *context;
    /* Whether there may be any in the box. */
    bool (*touches)(const void *context, Vec3f lo, Vec3f hi);
    /* Adds the area in the box from `lo`, and the sum of area · n nᵗ: xx yy zz xy xz yz. */
    void (*fill)(const void *context, Vec3f lo, Vec3f sides, float *area, float normals[6]);
} TexelField;

typedef struct VoxelSample {
    float density; /* 1 / texel length; 0 = empty, the rest is then meaningless */
    float gamma;   /* −0.36 clumped, 0 random matter, 1 one sheet … 1.7 a part of one that goes on in the next voxel */
    float solid;   /* the share of it that is walls before the inside of a solid, or the inside: there gamma only serves opacity.h */
    Sym3f s;       /* unit mean projected area */
} VoxelSample;

typedef struct VoxelLayer VoxelLayer;

typedef struct TexelBuildStats {
    int levels;
    int size[3];            /* voxels of level 0 along x, y, z: powers of two */
    size_t voxels[TEXEL_MAX_LEVELS]; /* stored, not empty, per level */
    size_t bytes;
    double seconds;
} TexelBuildStats;

/* How the normal distributions of eight voxels become one. */
typedef enum TexelFiltering {
    TEXEL_FILTER_LINEAR,    /* the area-weighted mean of S: the default */
    TEXEL_FILTER_PUBLISHED, /* the area-weighted sum of Q⁻¹, as Neyret 1998 sec. IV-C has it; S is still scaled to unit mean area */
} TexelFiltering;

typedef struct TexelBuildOptions {
    int resolution;      /* along the longest side, 1 … 1024; rounded up to a power of two */
    Vec3f extent;        /* > 0, the longest 1 */
    unsigned cyclic;     /* TEXEL_CYCLIC_… bits */
    TexelFiltering filtering;
    Pool *pool;          /* may be NULL */
    MemoryBudget *memory;
    const Progress *progress; /* may be NULL */
    const char *name;    /* for progress */
    const TexelField *field; /* besides the triangles, or instead of them; NULL */
    struct LayerViews *views; /* of one of several layers: room for what voxel_layers_join() (voxel_trim.h) wants to know; NULL: the layer stands alone */
} TexelBuildOptions;

/* Builds a layer's pyramid down to one voxel along the longest side. Deterministic for any number of threads. NULL when
 * memory ran out or the pool was cancelled. Owned by the caller: voxel_layer_destroy(). */
VoxelLayer *voxel_layer_build(const TexelMesh *mesh, const TexelBuildOptions *options, TexelBuildStats *stats);
void voxel_layer_destroy(VoxelLayer *layer);
/* The same layer for one owner more, who destroys it too; from one thread at a time. */
VoxelLayer *voxel_layer_share(VoxelLayer *layer);

int voxel_layer_levels(const VoxelLayer *layer);
/* Stored at a level: voxels that are not empty, and the bricks of 8³ that hold them; bytes of memory in all. */
size_t voxel_layer_voxels(const VoxelLayer *layer, int level);
size_t voxel_layer_bricks(const VoxelLayer *layer, int level);
size_t voxel_layer_bytes(const VoxelLayer *layer);
bool voxel_layer_is_empty(const VoxelLayer *layer);
/* Voxels along the axes at a level; side lengths of its voxels are extent / size. */
void voxel_layer_size(const VoxelLayer *layer, int level, int size[3]);

/* The voxels around p, interpolated trilinearly within the level (wrapping on cyclic axes, empty beyond the others).
 * Returns false (density 0) where nothing is. */
bool voxel_layer_sample(const VoxelLayer *layer, int level, Vec3f p, VoxelSample *out);
/* Between the levels around `lod` (0 = finest; clamped to the range of levels), quadrilinear. */
bool voxel_layer_sample_lod(const VoxelLayer *layer, float lod, Vec3f p, VoxelSample *out);
/* Of the stored voxels of a level around p that are read there the one that counts most: its number in the level, below voxel_layer_voxels(), and its
 * middle. False where nothing is. */
bool voxel_layer_nearest(const VoxelLayer *layer, int level, Vec3f p, uint32_t *voxel, Vec3f *middle);
/* A length along the unit direction d from p (p inside the extent) over which voxel_layer_sample_lod(lod) is certainly
 * empty; 0 when it may not be. Never larger than `limit`. */
float voxel_layer_skip(const VoxelLayer *layer, float lod, Vec3f p, Vec3f d, float limit);

#endif
