/* Cameras whose rays leave the triangles of meshes (POV-Ray's mesh_camera; how pixels find their triangles is measured). */
#include "render/view.h"

#include "shape/box_tree.h"

/* A triangle, and a place in it by the shares of its corners. */
typedef struct MeshPlace {
    const CameraMesh *in;
    size_t triangle;
    double share[3];
} MeshPlace;

static const double MIDDLE[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3};

static bool place_in(const CameraMesh *in, size_t triangle, MeshPlace *out) {
    *out = (MeshPlace){in, triangle, {MIDDLE[0], MIDDLE[1], MIDDLE[2]}};
    return triangle < in->mesh->triangle_count;
}

/* The triangle of a number, of all meshes in a row. */
static bool place_in_sum(const MeshCamera *camera, size_t number, MeshPlace *out) {
    for (size_t i = 0; i < camera->mesh_count; number -= camera->meshes[i++].mesh->triangle_count)
        if (place_in(&camera->meshes[i], number, out)) return true;
    return false;
}

/* ---- by u and v ---- */

typedef struct UvSearch {
    const CameraMesh *in;
    double u, v;
    MeshPlace *out;
} UvSearch;

static const uint32_t *uv_corners(const MeshData *mesh, size_t triangle) {
    return mesh->uv_triangles ? mesh->uv_triangles[triangle] : mesh->triangles[triangle];
}

static bool holds(void *context, uint32_t item) {
    UvSearch *s = context;
    const MeshData *mesh = s->in->mesh;
    const uint32_t *corner = uv_corners(mesh, item);
    Vec3 a = mesh->uvs[corner[0]], b = mesh->uvs[corner[1]], c = mesh->uvs[corner[2]];
    double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (area == 0) return false;
    double second = ((s->u - a.x) * (c.y - a.y) - (s->v - a.y) * (c.x - a.x)) / area, third = ((b.x - a.x) * (s->v - a.y) - (b.y - a.y) * (s->u - a.x)) / area;
    if (!(second >= 0 && third >= 0 && second + third <= 1)) return false;
    *s->out = (MeshPlace){s->in, item, {1 - second - third, second, third}};
    return true;
}

static bool place_at_uv(const View *view, double u, double v, MeshPlace *out) {
    UvSearch search = {&view->camera.mesh->meshes[0], u, v, out};
    return view->mesh_tree && box_tree_point(view->mesh_tree, vec3(u, v, 0), holds, &search);
}

void view_mesh_prepare(View *view, Arena *arena) {
    const MeshCamera *camera = view->camera.mesh;
    if (!camera || camera->spread != MESH_SPREAD_UV || !camera->mesh_count) return;
    const MeshData *mesh = camera->meshes[0].mesh;
    if (!mesh->uvs || !mesh->triangle_count) return;
    Box3 *boxes = arena_new_array(arena, Box3, mesh->triangle_count);
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        boxes[i] = box3_empty();
        for (int k = 0; k < 3; k++) boxes[i] = box3_add_point(boxes[i], vec3(mesh->uvs[uv_corners(mesh, i)[k]].x, mesh->uvs[uv_corners(mesh, i)[k]].y, 0));
    }
    view->mesh_tree = box_tree_build(boxes, mesh->triangle_count, arena);
}

/* ---- rays ---- */

/* Pixels are counted in rows from the top, the first of which POV-Ray 3.7 sees twice; side by side, the columns of meshes on the left are counted,
 * too. Of u and v, the pixel's upper left corner counts, half a pixel from the upper and one and a half from the right rim at least. */
static bool find_place(const View *view, double x, double y, double u, MeshPlace *out) {
    const MeshCamera *camera = view->camera.mesh;
    if (!camera->mesh_count || !(x >= 0 && x < view->width && y >= 0 && y < view->height)) return false;
    size_t column = (size_t)x, row = y >= 1 ? (size_t)y - 1 : 0, width = (size_t)view->width, ray = (size_t)double_clamp(u * camera->rays, 0, camera->rays - 1);
    switch (camera->spread) {
    case MESH_SPREAD_RAYS: return ray < camera->mesh_count && place_in(&camera->meshes[ray], row * width + column, out);
    case MESH_SPREAD_SUM: return place_in_sum(camera, (ray * (size_t)view->height + row) * width + column, out);
    case MESH_SPREAD_ASIDE: {
        size_t part = width / camera->mesh_count > 0 ? width / camera->mesh_count : 1, mesh = column / part;
        return mesh < camera->mesh_count && place_in(&camera->meshes[mesh], row * part + column, out);
    }
    case MESH_SPREAD_UV: break;
    }
    double across = double_clamp(x - 0.5, 0, fmax(0, view->width - 1.5)), down = double_clamp(y - 0.5, 0.5, view->height);
    return place_at_uv(view, across / view->width, 1 - down / view->height, out);
}

static Vec3 normal_at(const MeshCamera *camera, const MeshPlace *place, const Vec3 corners[3]) {
    const MeshData *mesh = place->in->mesh;
    Vec3 flat = vec3_cross(vec3_sub(corners[2], corners[0]), vec3_sub(corners[1], corners[0]));
    if (!camera->smooth || camera->spread != MESH_SPREAD_UV || !mesh->normals) return flat;
    const uint32_t *at = mesh->normal_triangles ? mesh->normal_triangles[place->triangle] : mesh->triangles[place->triangle];
    Vec3 sum = vec3_splat(0);
    for (int k = 0; k < 3; k++) sum = vec3_madd(sum, mesh->normals[at[k]], place->share[k]);
    return transform_normal(&place->in->place, sum);
}

bool view_mesh_ray(const View *view, double x, double y, double u, Cone *out) {
    const MeshCamera *camera = view->camera.mesh;
    MeshPlace place;
    *out = (Cone){.width = 0};
    if (!find_place(view, x, y, u, &place)) return false;
    Vec3 corners[3], point = vec3_splat(0);
    for (int k = 0; k < 3; k++) {
        corners[k] = transform_point(&place.in->place, place.in->mesh->vertices[place.in->mesh->triangles[place.triangle][k]]);
        point = vec3_madd(point, corners[k], place.share[k]);
    }
    Vec3 normal = vec3_normalize(normal_at(camera, &place, corners));
    if (!vec3_is_finite(point) || !(vec3_length_squared(normal) > 0)) return false;
    *out = (Cone){vec3_madd(point, normal, camera->ahead), camera->backwards ? vec3_negate(normal) : normal, 0, 0};
    return true;
}
