#include "shape/surface_draft.h"

#include "shape/surface_uv.h"

/* Limits of `subdivide auto` under a deform. */
enum { MOST_PASSES = 3, MOST_SPLITS = 32, MOST_CELLS = 2000000, MOST_FINE_CELLS = 100000, SAMPLES = 4 };

/* ---- patches ---- */

static Vec3 grid_value(const Surface *surface, const Vec3 *values, int i, int j, int parts) {
    int i0 = int_min(i / parts, surface->nu - 1), j0 = int_min(j / parts, surface->nv - 1),
        row = surface->nv + 1;
    double s = (double)(i - i0 * parts) / parts, t = (double)(j - j0 * parts) / parts;
    const Vec3 *v = values + i0 * row + j0;
    Vec3 near = vec3_lerp(v[0], v[row], s), far = vec3_lerp(v[1], v[row + 1], s);
    return vec3_lerp(near, far, t);
}

static void push_grid_vertex(const Surface *surface, int i, int j, int parts, Arena *arena,
                             SurfaceDraft *out) {
    SoupVertex vertex = {.position = grid_value(surface, surface->points, i, j, parts),
                         .uv = {(double)i / (surface->nu * parts), (double)j / (surface->nv * parts)}};
    if (surface->height_vectors) {
        Vec3 height = grid_value(surface, surface->height_vectors, i, j, parts);
        vertex.height = arena_copy(arena, &height, sizeof height);
    }
    *list_push(arena, &out->vertices) = vertex;
}

static void draft_patches(const Surface *surface, int parts, Arena *arena, SurfaceDraft *out) {
    int nu = surface->nu * parts, nv = surface->nv * parts;
    size_t vertices = (size_t)(nu + 1) * (size_t)(nv + 1);
    *out = (SurfaceDraft){.cells = arena_new_array(arena, DraftCell, (size_t)nu * (size_t)nv)};
    out->vertices.items = arena_new_array(arena, SoupVertex, vertices);
    out->vertices.capacity = vertices;
    for (int i = 0; i <= nu; i++) {
        for (int j = 0; j <= nv; j++) push_grid_vertex(surface, i, j, parts, arena, out);
    }
    for (int i = 0; i < nu; i++) {
        for (int j = 0; j < nv; j++) {
            uint32_t a = (uint32_t)(i * (nv + 1) + j), d = a + (uint32_t)nv + 1;
            out->cells[out->cell_count++] = (DraftCell){{a, a + 1, d + 1, d}, 4, false};
        }
    }
}

/* ---- objects ---- */

static bool has_normals(const TriangleSoup *soup, const SoupTriangle *triangle) {
    double least = 1;
    for (int i = 0; i < 3; i++) {
        least = double_min(least, vec3_length_squared(soup->vertices.items[triangle->vertex[i]].normal));
    }
    return least > 0;
}

static void draft_soup(const TriangleSoup *soup, Arena *arena, SurfaceDraft *out) {
    *out = (SurfaceDraft){.vertices = soup->vertices, .cell_count = soup->triangles.count};
    out->cells = arena_new_array(arena, DraftCell, out->cell_count);
    for (size_t t = 0; t < out->cell_count; t++) {
        const SoupTriangle *triangle = &soup->triangles.items[t];
        const uint32_t *v = triangle->vertex;
        out->cells[t] = (DraftCell){{v[0], v[1], v[2], v[0]}, 3, has_normals(soup, triangle)};
    }
}

/* The surface's own height vectors win over those of its mesh. */
static bool tessellate_with_heights(const Surface *surface, const TessellateOptions *options, Arena *arena,
                                    TriangleSoup *soup, ShapeRefusal *refusal) {
    Object object = object_copy(surface->object);
    MeshData mesh;
    if (object.kind == OBJECT_TRIANGLES && surface->object_height_vectors) {
        mesh = *object.as.mesh;
        mesh.height_vectors = surface->object_height_vectors;
        object.as.mesh = &mesh;
    }
    return tessellate(&object, NULL, options, arena, soup, refusal);
}

static double stretched_tolerance(const Surface *surface, double tolerance) {
    double stretch = tessellate_stretch(&surface->transform.linear);
    return stretch > 0 ? tolerance / stretch : HUGE_VAL;
}

/* For those who have no view. */
static bool draft_terrain(const Surface *surface, double tolerance, int parts, Arena *arena, SurfaceDraft *out, ShapeRefusal *refusal) {
    const Terrain *terrain = surface->terrain;
    MeshData mesh;
    *refusal = (ShapeRefusal){surface->span, "the terrain has too many triangles"};
    if (!terrain->ops->mesh(terrain->ground, tolerance, MOST_CELLS, arena, &mesh)) return false;
    const Object triangles = {.span = surface->span, .kind = OBJECT_TRIANGLES, .as.mesh = &mesh};
    const TessellateOptions options = {.tolerance = tolerance};
    TriangleSoup soup = {0};
    if (!tessellate(&triangles, NULL, &options, arena, &soup, refusal)) return false;
    soup_split(arena, &soup, (SoupMark){0, 0}, parts);
    draft_soup(&soup, arena, out);
    return true;
}

static bool draft_object(const Surface *surface, double tolerance, int parts, Arena *arena, SurfaceDraft *out,
                         ShapeRefusal *refusal) {
    TessellateOptions options = {.tolerance = tolerance, .parts = surface->subdivide};
    TriangleSoup soup = {0};
    if (!tessellate_with_heights(surface, &options, arena, &soup, refusal)) return false;
    soup_split(arena, &soup, (SoupMark){0, 0}, parts);
    surface_uv_generate(surface, arena, &soup);
    draft_soup(&soup, arena, out);
    return true;
}

/* ---- deform ---- */

static Vec3 deformed(const Tape *tape, Vec3 p, double *scratch) {
    const double in[3] = {p.x, p.y, p.z};
    double out[3];
    tape_eval(tape, in, out, scratch);
    return vec3(out[0], out[1], out[2]);
}

static Vec3 cell_point(const SurfaceDraft *draft, const DraftCell *cell, double s, double t) {
    Vec3 c[4];
    for (int i = 0; i < 4; i++) c[i] = draft->vertices.items[cell->vertex[i]].position;
    if (cell->corner_count == 4) return vec3_lerp(vec3_lerp(c[0], c[1], s), vec3_lerp(c[3], c[2], s), t);
    return vec3_madd(vec3_madd(c[0], vec3_sub(c[1], c[0]), s), vec3_sub(c[2], c[0]), t * (1 - s));
}

/* The largest distance between the deformed cell and the cell of its deformed corners, at a few places. */
static double cell_deviation(const SurfaceDraft *draft, const SurfaceDraft *moved, const DraftCell *cell,
                             const Tape *tape, double *scratch) {
    double largest = 0;
    for (int i = 0; i <= SAMPLES; i++) {
        for (int j = 0; j <= SAMPLES; j++) {
            double s = (double)i / SAMPLES, t = (double)j / SAMPLES;
            Vec3 there = deformed(tape, cell_point(draft, cell, s, t), scratch);
            largest = fmax(largest, vec3_length(vec3_sub(there, cell_point(moved, cell, s, t))));
        }
    }
    return largest;
}

/* Into how many parts the cells' edges must be cut: distances go as the square. */
static int parts_wanted(const Surface *surface, const SurfaceDraft *draft, double tolerance, Arena *arena) {
    double *scratch = arena_new_array(arena, double, tape_scratch_size(surface->deform)), largest = 0;
    SurfaceDraft moved = *draft;
    moved.vertices.items =
        arena_copy(arena, draft->vertices.items, draft->vertices.count * sizeof(SoupVertex));
    for (size_t i = 0; i < moved.vertices.count; i++) {
        moved.vertices.items[i].position =
            deformed(surface->deform, moved.vertices.items[i].position, scratch);
    }
    for (size_t i = 0; i < draft->cell_count; i++) {
        largest = fmax(largest, cell_deviation(draft, &moved, &draft->cells[i], surface->deform, scratch));
    }
    double most = double_min(MOST_SPLITS, sqrt((double)MOST_CELLS / (double)draft->cell_count));
    double wanted = ceil(sqrt(largest / tolerance));
    return wanted > 1 && most >= 2 ? (int)double_min(wanted, most) : 1;
}

static void deform_draft(const Tape *tape, Arena *arena, SurfaceDraft *draft) {
    double *scratch = arena_new_array(arena, double, tape_scratch_size(tape));
    for (size_t i = 0; i < draft->vertices.count; i++) {
        SoupVertex *vertex = &draft->vertices.items[i];
        Vec3 place = vertex->position;
        vertex->position = deformed(tape, place, scratch);
        vertex->normal = vec3_splat(0);
        if (!vertex->height) continue;
        /* A vector follows by the derivative: central difference over a step that balances rounding and curvature. */
        double step = 1e-5 * (1 + vec3_length(place)) / (1e-300 + vec3_length(*vertex->height));
        Vec3 ahead = deformed(tape, vec3_madd(place, *vertex->height, step), scratch);
        Vec3 behind = deformed(tape, vec3_madd(place, *vertex->height, -step), scratch);
        Vec3 height = vec3_scale(vec3_sub(ahead, behind), 0.5 / step);
        vertex->height = arena_copy(arena, &height, sizeof height);
    }
}

/* ---- cells no longer than asked ---- */

static double longest_edge(const SurfaceDraft *draft) {
    double longest = 0;
    for (size_t i = 0; i < draft->cell_count; i++) {
        const DraftCell *cell = &draft->cells[i];
        for (int k = 0; k < cell->corner_count; k++) {
            Vec3 a = draft->vertices.items[cell->vertex[k]].position;
            Vec3 b = draft->vertices.items[cell->vertex[(k + 1) % cell->corner_count]].position;
            longest = fmax(longest, vec3_length(vec3_sub(b, a)));
        }
    }
    return longest;
}

static int parts_for_edges(const Surface *surface, const SurfaceDraft *draft, double longest, double *shortest_cut) {
    *shortest_cut = 0;
    if (!(longest > 0) || surface->subdivide > 0 || draft->cell_count == 0) return 1;
    double edge = longest_edge(draft) * tessellate_stretch(&surface->transform.linear), wanted = ceil(edge / longest);
    double most = fmax(1, floor(sqrt((double)MOST_FINE_CELLS / (double)draft->cell_count)));
    if (wanted > most) *shortest_cut = edge / most;
    return (int)fmax(1, fmin(wanted, most));
}

/* ---- all of it ---- */

static bool draft_parts(const Surface *surface, double tolerance, int parts, Arena *arena, SurfaceDraft *out,
                        ShapeRefusal *refusal) {
    if (surface->kind == SURFACE_OBJECT) return draft_object(surface, tolerance, parts, arena, out, refusal);
    if (surface->kind == SURFACE_TERRAIN) return draft_terrain(surface, tolerance, parts, arena, out, refusal);
    draft_patches(surface, parts * int_max(surface->subdivide, 1), arena, out);
    return true;
}

static void turn_directed_cells(SurfaceDraft *draft) {
    for (size_t i = 0; i < draft->cell_count; i++) {
        DraftCell *cell = &draft->cells[i];
        if (!cell->directed) continue;
        uint32_t second = cell->vertex[1];
        cell->vertex[1] = cell->vertex[cell->corner_count - 1];
        cell->vertex[cell->corner_count - 1] = second;
    }
}

static void transform_draft(const Transform *transform, Arena *arena, SurfaceDraft *draft) {
    TriangleSoup vertices = {.vertices = draft->vertices};
    soup_transform(arena, &vertices, (SoupMark){0, 0}, transform);
    if (mat3_determinant(&transform->linear) < 0) turn_directed_cells(draft);
}

static bool draft_is_finite(const SurfaceDraft *draft) {
    for (size_t i = 0; i < draft->vertices.count; i++) {
        const SoupVertex *vertex = &draft->vertices.items[i];
        if (!vec3_is_finite(vertex->position) || (vertex->height && !vec3_is_finite(*vertex->height)))
            return false;
    }
    return true;
}

bool surface_draft_build(const Surface *surface, const SurfaceMeshOptions *options, Arena *arena,
                         SurfaceDraft *out, ShapeRefusal *refusal) {
    double tolerance = stretched_tolerance(surface, options->tolerance);
    int parts = 1;
    for (int pass = 0;; pass++) {
        if (!draft_parts(surface, tolerance, parts, arena, out, refusal)) return false;
        if (!surface->deform || surface->subdivide > 0 || pass == MOST_PASSES || out->cell_count == 0) break;
        int more = parts_wanted(surface, out, tolerance, arena);
        if (more == 1) break;
        parts *= more;
    }
    double shortest_cut;
    int finer = parts_for_edges(surface, out, options->longest_edge, &shortest_cut);
    if (finer > 1 && !draft_parts(surface, tolerance, parts * finer, arena, out, refusal)) return false;
    out->shortest_cut = shortest_cut;
    if (surface->deform) deform_draft(surface->deform, arena, out);
    transform_draft(&surface->transform, arena, out);
    *refusal = (ShapeRefusal){surface->span, "a point of the surface is not a finite number"};
    return draft_is_finite(out);
}
