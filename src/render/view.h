/* The camera as cones: where the light comes from that a place of the picture shows. */
#ifndef VTS_RENDER_VIEW_H
#define VTS_RENDER_VIEW_H

#include "render/cone.h"
#include "scene/scene.h"

/* What one frame asks of a scene: its camera, and the size of the whole picture in pixels. */
typedef struct View {
    Camera camera;
    int width, height;
    /* Of flat pictures, by view_prepare(); before it they are zero, and calculated with every cone. */
    Vec3 axis;         /* unit, across the picture */
    double pixel_area; /* on the picture's plane */
    const struct BoxTree *mesh_tree; /* over the triangles in the plane of u and v, of a MESH_SPREAD_UV; by view_prepare() */
} View;

/* Once camera and size are known; `arena` for what cameras of meshes need (NULL: it is no such camera, or one without u and v). */
void view_prepare(View *view, Arena *arena);
/* view_mesh.c: the same as view_ray() of cameras of meshes; `u` chooses among a pixel's rays. */
bool view_mesh_ray(const View *view, double x, double y, double u, Cone *out);
void view_mesh_prepare(View *view, Arena *arena);

/* The cone through the picture's point (x, y), in pixels from the upper left corner, from the middle of the lens; `width_px` is its width
 * in pixels. Where the picture of a fisheye or omnimax camera shows nothing, its direction is zero. */
Cone view_cone(const View *view, double x, double y, double width_px);

/* The same through the lens at (u, v) of the unit square, which is mapped to the lens evenly: what is in focus stays where it is. False
 * where the picture shows nothing. */
bool view_ray(const View *view, double x, double y, double u, double v, double width_px, Cone *out);

/* Whether there is a lens: u and v matter. */
static inline bool view_has_lens(const View *view) { return view->camera.mesh ? view->camera.mesh->rays > 1 : view->camera.aperture > 0 && view->camera.focal_distance > 0; }
/* Whether the picture is a plane seen from a point or along one direction. */
static inline bool view_is_flat(const View *view) {
    if (view->camera.normal) return false;
    return view->camera.kind == CAMERA_PERSPECTIVE || view->camera.kind == CAMERA_ORTHOGRAPHIC;
}
/* Whether all lines of sight begin in one point and turn evenly from one to the next, but are on no plane. */
static inline bool view_is_round(const View *view) {
    switch (view->camera.kind) {
    case CAMERA_FISHEYE:
    case CAMERA_OMNIMAX:
    case CAMERA_ULTRA_WIDE:
    case CAMERA_PANORAMIC:
    case CAMERA_SPHERICAL:
    case CAMERA_CYLINDER_1:
    case CAMERA_CYLINDER_2: return !view->camera.normal;
    default: return false;
    }
}
/* Whether the box certainly is out of a perspective picture. */
bool view_misses(const View *view, Box3 box);

#endif
