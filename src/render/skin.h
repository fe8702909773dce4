/* Skins ready to be traced: cells that know their neighbours, texels built and placed.
 *
 * Skin space of a cell is (a, b, w): (a, b) in the unit square of a bilinear patch or the unit triangle, w from the foot
 * (0) to the top (1) of the layer. World = P(a, b) + w·H(a, b), P and H bilinear. Texture space is (u, v, w'): u and v count
 * tiles, w' is the height within the texel. A ray is followed by inverting the mapping step by step, each step starting from
 * the one before; a ray that leaves a cell's unit square goes on in the neighbour with the same point, so nothing can leak
 * through a wall (texels.md, "Mapping and traversal"). */
#ifndef VTS_RENDER_SKIN_H
#define VTS_RENDER_SKIN_H

#include <stdatomic.h>

#include "base/diag.h"
#include "render/cone.h"
#include "render/beam_texel.h"
#include "render/exact_texel.h"
#include "render/look.h"
#include "render/wang.h"
#include "scene/scene.h"
#include "shape/box_tree.h"
#include "shape/surface_mesh.h"
#include "texel/opacity.h"
#include "texel/texel_sky.h"

/* c[0] + c[1]·a + c[2]·b + c[3]·a·b */
typedef struct BilinearVec {
    Vec3 c[4];
} BilinearVec;
typedef struct Bilinear {
    double c[4];
} Bilinear;

/* Which way the mapping of a cell is turned: det J > 0 or < 0 all over it (but for zeros on its edges), of both signs, or 0 throughout. */
typedef enum CellSide { CELL_UPRIGHT, CELL_MIRRORED, CELL_FOLDED, CELL_FLAT } CellSide;

typedef struct SkinCell {
    BilinearVec foot, height;
    Bilinear u, v, w_foot, w_tip;
    SurfaceNeighbour neighbour[4];
    Box3 bounds;
    bool triangle;
    bool rim;      /* beyond the border of the surface: skin_rim.h */
    uint8_t side;  /* CellSide */
    uint32_t part; /* of the surface: those across a seam are others; 0 where there is no rim */
} SkinCell;

/* One layer of matter of a built texel. */
typedef struct TexelMatter {
    VoxelLayer *voxels; /* NULL in an exact texel */
    Look look;
    _Atomic uint32_t *colors[TEXEL_MAX_LEVELS]; /* matter_color.h; NULL: none are kept */
} TexelMatter;

typedef struct BuiltTexel {
    const TexelDef *def;
    Vec3f extent;        /* of texel space, longest side 1 */
    float voxel;         /* side of the finest voxel, geometric mean of the axes, texel space */
    int levels;
    TexelMatter *matter;
    size_t matter_count;
    int asked, needed, built; /* resolutions of voxels: asked 0 = auto, built 0 = none, as everything seen is exact */
    int finest_seen;          /* the resolution that the nearest place seen would ask for; in films a power of two above it */
    size_t voxel_count, bytes;
    double build_seconds;     /* or of loading */
    bool cached;              /* nothing of it had to be built */
    TexelSky *sky;            /* NULL: ambient light is the same everywhere */
    bool sky_is_kept;         /* it belongs to the cache of texels */
    ExactTexel *exact;        /* instead of voxels, for the reference; else NULL */
    const BeamTexel *beam;    /* its triangles, for beams; NULL where there are none */
    size_t triangles_known;   /* it has at least so many; all, if `beam` */
} BuiltTexel;

/* One `texel { … }` of a skin, or one part of it if the skin is tiled by wang.h. */
typedef struct PlacedTexel {
    BuiltTexel *const *family; /* one, or those of `choose` */
    size_t family_size;
    size_t blanks;       /* of wang: members that hold nothing here */
    Vec3f finest_extent; /* of the member with the smallest voxels, which sets the step */
    float finest_voxel;
    int levels;
    double density;      /* share of the tiles that hold a copy */
    bool cyclic;         /* across u or v: copies are never moved */
    const Look *look;    /* over the layers' own; NULL */
    uint64_t seed;
    InstanceJitter jitter; /* all zero for cyclic texels but for the tint */
    const WangBorders *borders; /* of wang: of the members that must fit; NULL: any do */
    int turns;           /* of wang: 4 ways to lie, by quarters, 2 or 1; 0: not tiled so */
    bool flips;          /* of wang: or mirrored */
    double shift_u, shift_v; /* of wang: of the grid of tiles, 0 or 1/2 */
    bool alike;          /* every tile holds the same: one copy, cyclic, without tint or gaps */
    int reach;           /* how many tiles away a copy may still cover a point: 0 when copies stay in their tile */
    double overhang;     /* how far one may reach out of its tile, in tiles */
} PlacedTexel;

typedef struct SkinBox SkinBox;   /* skin_box.h */
typedef struct CellTree CellTree; /* hierarchy over the cells' bounds, for entering the layer */
typedef struct TileSet TileSet; /* skin_rim.h */
typedef struct JointCopies JointCopies; /* skin_joint.h */
typedef struct ExactSkins ExactSkins; /* hierarchy over what is in the cells of all skins, for the reference: exact_skin.h */

typedef struct CompiledSkin {
    const Skin *def;
    SkinCell *cells;     /* those of the rim are the last */
    size_t cell_count;
    const TileSet *beyond; /* tiles whose copies are left out, as they stand beyond its border; NULL: none */
    double top;          /* height of the layer in w': more than w_tip when copies are scaled up */
    PlacedTexel *texels;
    size_t texel_count;
    bool overlaps;       /* sheets lie over one another: a cell is folded, or neighbours are turned opposite ways */
    const SkinBox *box; /* it is a straight one, else NULL */
    CellTree *tree;   /* NULL in the reference, and of a box */
    const JointCopies *joint; /* NULL: no voxels, or none that know what eye and light have in common */
    const BoxTree *boxes; /* over the cells' bounds, for beams; NULL: the skin is drawn from voxels alone */
    bool rigid;           /* its copies are whole and not bent: beam_rigid.h draws them */
    double exact_to;      /* distance from the eye at which voxels take the place of exact geometry; VTS_INFINITY: never */
    double tile_size;     /* of one texel on the surface, on the average, scene units */
    Box3 bounds;
} CompiledSkin;

/* A place in a skin. cell < 0: nowhere. */
typedef struct SkinPoint {
    int32_t cell;
    double a, b, w;
} SkinPoint;

/* ---- mapping: skin_map.c ---- */

/* What a cell interpolates between its corners; (a, b) is the corner's own. */
typedef struct SkinCorner {
    Vec3 foot, height;
    double u, v, w_foot, w_tip, a, b;
} SkinCorner;
/* Of corner 0 … 3 as the surface's cell numbers them. */
SkinCorner skin_cell_corner(const SkinCell *cell, int corner);
/* Sets what follows from three or four corners: all but the neighbours, the rim and the part. */
void skin_cell_fit(SkinCell *cell, const SkinCorner corner[4], bool triangle);

/* World position, and the columns of the Jacobian ∂world/∂(a, b, w) (may be NULL). */
Vec3 skin_cell_position(const SkinCell *cell, double a, double b, double w, Mat3 *jacobian);
Box3 skin_cell_bounds(const SkinCell *cell);
/* Finds (a, b, w) of the world point by Newton's method from the guess in *point, within or near the cell; `tolerance` in
 * world units. False when it does not converge. The result may lie outside the cell. */
bool skin_cell_invert(const SkinCell *cell, Vec3 world, double tolerance, SkinPoint *point);
/* Whether the world point lies in the cell (with a hair's margin), and where; `point->cell` is left alone. */
bool skin_cell_holds(const SkinCell *cell, Vec3 world, double tolerance, SkinPoint *point);
/* Goes on from *point (a guess, possibly outside its cell) to the cell that holds `world`. Returns SKIN_INSIDE, or how the
 * point is outside: beyond the top, below the foot, past a border, or lost (the mapping is folded there). */
typedef enum SkinSide { SKIN_INSIDE, SKIN_ABOVE, SKIN_BELOW, SKIN_BORDER, SKIN_LOST } SkinSide;
SkinSide skin_locate(const CompiledSkin *skin, Vec3 world, double tolerance, SkinPoint *point, bool *crossed_seam);
/* Takes a point on an edge of its cell to the neighbour across it; returns that cell's number of the edge. There must be a neighbour. */
int skin_cross_edge(const CompiledSkin *skin, int edge, SkinPoint *point);
/* The first t in [t_min, t_max] at which the ray is within the layer; unit direction. False when nowhere. */
bool skin_enter(const CompiledSkin *skin, const Ray *ray, double t_min, double t_max, SkinPoint *point, double *t);

/* Embree's bounds of the cell args->primID of the CompiledSkin args->geometryUserPtr. */
struct RTCBoundsFunctionArguments;
void skin_bound_cell(const struct RTCBoundsFunctionArguments *args);
struct Embree;
/* The tree is built when the layer is first entered, by whichever thread that is; NULL without memory. */
CellTree *cell_tree_create(const struct Embree *embree);
void cell_tree_destroy(CellTree *tree);

/* ---- texture space: skin_place.c ---- */

/* Texture coordinates at a point. */
typedef struct TexturePlace {
    double u, v, w;
    Vec3 grad_u, grad_v, grad_w; /* ∂/∂world; zero where the mapping is singular */
    Vec3 grad_a, grad_b, grad_layer; /* the same of skin space (a, b, w) */
} TexturePlace;
TexturePlace skin_texture_place(const SkinCell *cell, const SkinPoint *point);

/* A copy of a texel near a tile. From tile coordinates to the copy's own unit square: x = xu·u + xv·v + x0, likewise z; the
 * height is w'/scale. */
typedef struct TexelCopy {
    const BuiltTexel *texel;
    double xu, xv, x0, zu, zv, z0, inverse_scale;
    Vec3f tint; /* 1, 1, 1: none */
} TexelCopy;
/* The rate at which texture coordinates change, in the copy's texel space. */
static inline Vec3f texel_copy_rate(const TexelCopy *copy, Vec3 rate) {
    Vec3f e = copy->texel->extent;
    return vec3f((float)(copy->xu * rate.x + copy->xv * rate.y) * e.x, (float)(rate.z * copy->inverse_scale) * e.y,
                 (float)(copy->zu * rate.x + copy->zv * rate.y) * e.z);
}
/* A direction of the scene in the copy's texel space, of another length: zero where the mapping is singular. */
static inline Vec3f skin_way_in_texel(const TexelCopy *copy, const TexturePlace *place, Vec3 d) {
    return texel_copy_rate(copy, vec3(vec3_dot(place->grad_u, d), vec3_dot(place->grad_v, d), vec3_dot(place->grad_w, d)));
}
/* skin_sky.c. The share of the hemisphere over the layer that `at`, in the space of a texel that has a sky, sees past its texel's own matter, if
 * the eye, which is in the unit direction `to_eye` of the scene, sees it. */
float skin_sky_seen(const TexelCopy *copy, const TexturePlace *place, Vec3f at, Vec3 to_eye);
/* A normal of texel space at the place, in the scene: by the transposed map world → texel. Its length is that of texel space against the scene along it;
 * zero where the mapping is singular. */
Vec3 texel_normal_in_scene(const TexelCopy *copy, const TexturePlace *place, Vec3 normal);
enum { MOST_REACH = 2, MOST_COPIES = 25 };
/* The copy that is tile (iu, iv)'s own, wherever it was moved to; false when it has none. */
bool texel_copy_of(const PlacedTexel *placed, int64_t iu, int64_t iv, TexelCopy *copy);
/* Candidate k, 0 … (2·reach + 1)² − 1, of the copies whose unit squares may cover some point of tile (iu, iv); false when
 * there is none there. */
bool texel_copy_near(const PlacedTexel *placed, int64_t iu, int64_t iv, int k, TexelCopy *copy);
/* Whether a cell shows anything of the texel: those of the rim only what may leave its tile. */
static inline bool skin_cell_bears(const SkinCell *cell, const PlacedTexel *placed) { return placed->family_size && (!cell->rim || placed->overhang > 0); }
/* The same two for what stands on a skin: without copies beyond its border. */
bool skin_copy_of(const CompiledSkin *skin, const SkinCell *cell, const PlacedTexel *placed, int64_t iu, int64_t iv, TexelCopy *copy);
bool skin_copy_near(const CompiledSkin *skin, const SkinCell *cell, const PlacedTexel *placed, int64_t iu, int64_t iv, int k, TexelCopy *copy);

#endif
