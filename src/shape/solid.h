/* What every kind of solid or sheet can do for rays and points, in its own space. One table of functions for each kind;
 * sets, copies, clips and transforms are trace.c's. */
#ifndef VTS_SHAPE_SOLID_H
#define VTS_SHAPE_SOLID_H

#include "base/arena.h"
#include "scene/scene.h"
#include "shape/soup.h"

/* Where on the surface: what the kind needs to tell the normal of a crossing. */
typedef struct SolidTag {
    uint32_t part;
    double u, v;
} SolidTag;

/* Takes crossings, in any order; only those with t_min < t < t_max are wanted. t_max may shrink with each one taken. */
typedef struct SolidSink SolidSink;
struct SolidSink {
    double t_min, t_max;
    RayWidth width; /* what is finer need not be met as it is */
    void (*take)(SolidSink *sink, double t, const SolidTag *tag);
};

static inline void solid_offer(SolidSink *sink, double t, SolidTag tag) {
    if (t > sink->t_min && t < sink->t_max) sink->take(sink, t, &tag);
}

/* What functions have cost the rays that asked. */
typedef struct SolidWork {
    uint64_t lines;       /* that were searched for zeros */
    uint64_t evaluations; /* of values and of bounds */
    uint64_t unsettled;   /* pieces that bounds did not settle: a pair of zeros may be missed in each */
    bool sampled;         /* there are functions without bounds */
} SolidWork;

static inline void solid_work_add(SolidWork *sum, const SolidWork *work) {
    sum->lines += work->lines;
    sum->evaluations += work->evaluations;
    sum->unsettled += work->unsettled;
    sum->sampled |= work->sampled;
}

typedef struct SolidOps {
    /* What the functions below get as `data`, made once, in `arena`; NULL member: the object itself. NULL: nothing to meet. */
    const void *(*prepare)(const Object *object, Arena *arena);
    /* Offers all crossings of the ray with the surface (at least those within the sink's bounds). t in lengths of the
     * ray's direction, which may have any length but 0. */
    void (*cross)(const void *data, const Ray *ray, SolidSink *sink);
    /* The unit normal at a crossing, as POV-Ray directs it: for solids to the outside. Zero where there is none. */
    Vec3 (*normal)(const void *data, Vec3 point, const SolidTag *tag);
    /* NULL: nothing is inside. The boundary may count either way. */
    bool (*inside)(const void *data, Vec3 point);
    /* The normal of the surface itself, where `normal` is interpolated; NULL: the same. */
    Vec3 (*flat)(const void *data, Vec3 point, const SolidTag *tag);
    /* u and v of a crossing, as POV-Ray's uv_mapping has them; NULL: they are x and y of the scene. */
    TexCoord (*uv)(const void *data, Vec3 point, const SolidTag *tag);
    /* Holds all of the surface; infinite where there is no end. */
    Box3 (*bounds)(const void *data);
    /* Adds what all rays have cost so far, those of other threads as well; NULL: nothing is counted. */
    void (*work)(const void *data, SolidWork *sum);
    bool keeps_normal; /* `inverse` does not turn its normals, as in POV-Ray */
} SolidOps;

/* Turns from x towards z, in [0, 1). */
static inline double solid_turn(double x, double z) {
    double turn = atan2(z, x) / (2 * VTS_PI);
    return turn < 0 ? turn + 1 : turn;
}

/* Never NULL; sets and what has no surface have a table without functions. */
const SolidOps *solid_ops(const Object *object);

extern const SolidOps solid_sphere_ops, solid_box_ops, solid_torus_ops, solid_plain_ops; /* solid_plain.c: sphere box cylinder cone plane disc torus */
extern const SolidOps solid_mesh_ops, solid_triangle_ops;      /* solid_mesh.c: triangles of all kinds */
extern const SolidOps solid_surface_ops;                       /* solid_surface.c: what skins lie on */
extern const SolidOps solid_terrain_ops;                       /* solid_terrain.c */
extern const SolidOps solid_prism_ops, solid_polygon_ops;      /* solid_flat.c */
extern const SolidOps solid_lathe_ops, solid_sor_ops;          /* solid_turned.c */
extern const SolidOps solid_quadric_ops, solid_polynomial_ops; /* solid_algebraic.c */
extern const SolidOps solid_ovus_ops, solid_super_ops;         /* solid_round.c */
extern const SolidOps solid_sweep_ops, solid_blob_ops;         /* solid_sweep.c, solid_blob.c */
extern const SolidOps solid_isosurface_ops, solid_height_ops;  /* solid_field.c, solid_height.c */
extern const SolidOps solid_patch_ops, solid_parametric_ops;   /* solid_patch.c */
extern const SolidOps solid_text_ops, solid_julia_ops;         /* solid_text.c, solid_julia.c */

#endif
